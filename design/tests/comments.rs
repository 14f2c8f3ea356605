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

/// Each comment of a text with the line behind it, spaces aside.
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

/// Catches a comment that is lost, stands elsewhere, is there for each round of a loop, or is about what this design does not have.
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
