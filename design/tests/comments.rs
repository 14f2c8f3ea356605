//! Comments of kernels in the emitted text.

use rtl_design::elaborate::elaborate;
use rtl_design::reg::Reg;
use rtl_design::verilog::Header;
use rtl_design::{kernel, verilog, vhdl, Block};
use rust_hdl::prelude::*;

/// Two lamps.
#[derive(LogicBlock, Block)]
struct Lamps {
    pub clock: Signal<In, Clock>,
    pub reset: Signal<In, Bit>,
    pub wanted: Signal<In, Bits<2>>,
    pub lamp: Vec<Signal<Out, Bit>>,
    pub count: Signal<Out, Bits<4>>,
    pub shown: Signal<Out, Bits<2>>,
    pub level: Signal<Out, Bit>,
    pub same: Signal<Out, Bit>,
    counter: Reg<Bits<4>>,
    seen: Reg<Bit>,
    has_all: Constant<Bit>,
}

impl Lamps {
    fn new(has_all: bool) -> Self {
        Self::from_parts(LampsParts {
            lamp: vec![Signal::default(); 2],
            has_all: Constant::new(has_all),
        })
    }
}

#[path = "comments/elsewhere.rs"]
mod elsewhere;

#[kernel(parts = elsewhere::counting)]
impl Logic for Lamps {
    fn update(&mut self) {
        for i in 0..2 {
            // Said once.
            self.lamp[i].next = self.wanted.val().get_bit(i);
        }
        self.count_lamps();
        // Kept in a "register".
        self.seen.d.next = self.wanted.val().any();
        // Replaced right away.
        self.level.next = false;
        // Whatever comes.
        self.level.next = self.seen.q.val();
        if self.has_all.val() {
            // Only with `has_all`.
            self.same.next = self.wanted.val().all();
        } else {
            // Only without.
            self.same.next = false;
        }

        // Says nothing about any statement.
    }

    /// Nothing is wanted.
    fn dark(&mut self) {
        self.shown.next = 0.into();
    }
}

/// Each comment of a text with the line after it, without spaces.
fn comments(text: &str, mark: &str) -> Vec<String> {
    let body: Vec<&str> = text
        .lines()
        .skip_while(|line| !line.starts_with(");") && !line.starts_with("begin"))
        .map(str::trim)
        .collect();
    let pairs = body.windows(2).filter(|pair| pair[0].starts_with(mark));
    pairs.map(|pair| pair.join(" ")).collect()
}

fn check(has_all: bool, in_verilog: &[&str], in_vhdl: &[&str]) {
    let mut block = Lamps::new(has_all);
    block.connect_all();
    let design = elaborate(&block, "lamps").unwrap().trimmed();
    let header = Header::default();
    let verilog = &verilog::print_files(&design, &header)[0].1;
    assert_eq!(comments(verilog, "//"), in_verilog, "{verilog}");
    let files = vhdl::print_files(&design, &header);
    let (_, vhdl) = files
        .iter()
        .find(|(name, _)| name.starts_with("lamps."))
        .unwrap();
    assert_eq!(comments(vhdl, "--"), in_vhdl, "{vhdl}");
}

/// Catches a comment that is lost, is misplaced, is repeated for each round of a loop, or belongs to a disabled feature.
#[test]
fn a_comment_stands_before_what_it_is_about() {
    let in_verilog = [
        "// Two cases. case (wanted)",
        "// Nothing is wanted. shown = 2'd0;",
        "// Something is wanted. shown = wanted;",
        "// Both. counter_next = counter + 4'd1;",
        "// Said once. assign lamp_0 = wanted[0];",
        "// Counts, and // shows.",
        "// shows. assign count = counter;",
        "// Whatever comes. assign level = seen;",
        "// Only with has_all. assign same = &wanted;",
        "// Kept in a \"register\". seen <= |wanted;",
    ];
    let in_vhdl = [
        "-- Two cases. subject := unsigned(wanted);",
        "-- Nothing is wanted. shown_sig <= (others => '0');",
        "-- Something is wanted. shown_sig <= unsigned(wanted);",
        "-- Both. counter_next <= counter + 1;",
        "-- Said once. lamp_0 <= wanted(0);",
        "-- Counts, and -- shows.",
        "-- shows. count_sig <= counter;",
        "-- Whatever comes. level <= seen;",
        "-- Only with has_all. same <= and_reduce(unsigned(wanted));",
        "-- Kept in a \"register\". seen <= to_sl(unsigned(wanted) /= 0);",
    ];
    check(true, &in_verilog, &in_vhdl);
    let without = |mut all: [&'static str; 10], same| {
        *all.iter_mut()
            .find(|line| line.contains("has_all"))
            .unwrap() = same;
        all
    };
    check(
        false,
        &without(in_verilog, "// Only without. assign same = 1'b0;"),
        &without(in_vhdl, "-- Only without. same <= '0';"),
    );
}

/// Private fields with a line of documentation each, and fields without one. Its head is so long that no file may have it in a single line: the
/// printed text wraps a comment where it has more columns than a reader sees, which is so in this line and not in any other one of it, as all others are short.
#[derive(LogicBlock, Block)]
struct Fields {
    pub clock: Signal<In, Clock>,
    pub reset: Signal<In, Bit>,
    /// A port whose documentation is one line of the source that is longer than a line of the emitted text may be, so that it goes on below.
    pub enable: Signal<In, Bit>,
    pub value: Signal<Out, Bits<4>>,
    /// Cycles since reset, wrapping.
    count: Reg<Bits<4>>,
    plain: Reg<Bits<4>>,
    /// Sum before the register.
    sum: Signal<Local, Bits<4>>,
    /// Step of the count.
    step: Constant<Bits<4>>,
}

#[kernel]
impl Logic for Fields {
    fn update(&mut self) {
        self.sum.next = self.count.q.val() + self.step.val();
        if self.enable.val() {
            self.count.d.next = self.sum.val();
            self.plain.d.next = self.count.q.val();
        }
        self.value.next = self.count.q.val() ^ self.plain.q.val() ^ self.sum.val();
    }
}

fn fields() -> [String; 2] {
    let mut block = Fields::from_parts(FieldsParts {
        step: Constant::new(3.into()),
    });
    block.connect_all();
    let design = elaborate(&block, "fields").unwrap();
    let header = Header::default();
    [
        verilog::print(&design, &header),
        vhdl::print(&design, &header),
    ]
}

/// Catches documentation of a private register, signal or constant that is lost or printed for another one.
#[test]
fn documentation_of_a_private_field_is_above_its_declaration() {
    let [verilog, vhdl] = fields();
    for lines in [
        "    // Cycles since reset, wrapping.\n    reg    [3:0] count;",
        "    // Sum before the register.\n    wire   [3:0] sum;",
        "    // Step of the count.\n    localparam   [3:0] STEP = 4'd3;",
        ";\n    reg    [3:0] plain;",
    ] {
        assert!(verilog.contains(lines), "{lines}\n{verilog}");
    }
    for lines in [
        "    -- Cycles since reset, wrapping.\n    signal count ",
        "    -- Sum before the register.\n    signal sum ",
        "    -- Step of the count.\n    constant STEP ",
        ";\n    signal plain ",
    ] {
        assert!(vhdl.contains(lines), "{lines}\n{vhdl}");
    }
}

/// Catches a comment in the head, at a module or at a port that is longer than a line may be, or that loses a word.
#[test]
fn comments_have_at_most_132_columns() {
    for (text, mark) in fields().iter().zip(["//", "--"]) {
        let long = text.lines().find(|line| line.len() > 132);
        assert!(long.is_none(), "{long:?}");
        let words: Vec<&str> = text.split_whitespace().filter(|w| *w != mark).collect();
        let words = words.join(" ");
        let port = "A port whose documentation is one line of the source that is longer than a line of the emitted text may be, so that it goes on below.";
        assert_eq!(words.matches(port).count(), 2, "{text}");
        assert!(
            words.contains("any other one of it, as all others are short."),
            "{text}"
        );
    }
}
