//! Next values that are assigned in the clocked block, and those that keep a net.

use crate::zoo::check;
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::kernel_engine;
use rtl_design::reg::Reg;
use rtl_design::verilog::Header;
use rtl_design::{kernel, verilog, vhdl, Block};
use rust_hdl::prelude::*;

/// Registers with simple next values, and registers whose next value must keep a net.
#[derive(LogicBlock, Block)]
#[properties("clocked.sv")]
struct Taps {
    pub clock: Signal<In, Clock>,
    pub reset: Signal<In, Bit>,
    pub clear: Signal<In, Bit>,
    pub load: Signal<In, Bit>,
    pub code: Signal<In, Bits<4>>,
    pub sum: Signal<Out, Bits<4>>,
    pub steps: Signal<Out, Bits<4>>,
    pub above: Signal<Out, Bit>,
    pub busy: Signal<Out, Bit>,
    held: Reg<Bits<4>>,
    #[start(5.into())]
    count: Reg<Bits<4>>,
    proven: Reg<Bit>,
    cleared: Reg<Bits<4>>,
    mixed: Reg<Bits<4>>,
    apart: Reg<Bits<4>>,
    limit: Signal<Local, Bits<4>>,
}

#[kernel]
impl Logic for Taps {
    fn update(&mut self) {
        // Load wins over the count.
        if self.code.val() == self.count.q.val() {
            self.count.d.next = 0.into();
        }
        if self.load.val() {
            // The code is held.
            self.held.d.next = self.code.val();
            self.count.d.next = self.held.q.val();
        }
        match self.code.val().index() {
            0 => self.proven.d.next = true,
            1 => self.proven.d.next = false,
            _ => {}
        }
        self.cleared.reset.next = self.clear.val();
        if self.load.val() {
            self.cleared.d.next = self.cleared.q.val() + 1;
        }
        // An intermediate value of the limit.
        self.limit.next = self.code.val();
        if self.limit.val() == 3 {
            self.mixed.d.next = self.limit.val();
        }
        if self.load.val() {
            self.limit.next = 9.into();
        }
        // The last value of the limit.
        self.apart.d.next = self.limit.val();
        if self.load.val() {
            self.busy.next = true;
            self.steps.next = self.cleared.q.val();
        } else {
            self.busy.next = false;
            self.steps.next = self.mixed.q.val() ^ self.apart.q.val();
        }
        self.above.next = self.proven.q.val() & (self.limit.val() == 9);
        self.sum.next = self.held.q.val() + self.count.q.val();
    }
}

fn taps() -> (Taps, Design) {
    let mut block = Taps::default();
    block.connect_all();
    let design = elaborate(&block, "taps").unwrap();
    (block, design)
}

/// Lines of a text from the one that begins with `from` up to one that is `to`, without their indentation.
fn part(text: &str, from: &str, to: &str) -> Vec<String> {
    let lines = text.lines().map(str::trim);
    let lines = lines.skip_while(|line| !line.starts_with(from));
    let lines = lines.take_while(|line| *line != to);
    lines.map(String::from).collect()
}

/// Catches a hold that remains, an assignment in another order, a comment that is lost, and a next value that a property names without a net.
#[test]
fn simple_next_values_are_assigned_in_the_clocked_block() {
    let (_, design) = taps();
    let verilog = verilog::print(&design, &Header::default());
    for gone in ["held_next", "count_next", "cleared_next", "apart_next"] {
        assert!(!verilog.contains(gone), "{gone}\n{verilog}");
    }
    for kept in ["proven <= proven_next;", "mixed <= mixed_next;"] {
        assert!(verilog.contains(kept), "{kept}\n{verilog}");
    }
    let clocked = part(&verilog, "// Load wins", "proven <= proven_next;");
    let expected = [
        "// Load wins over the count.",
        "if (code == count) begin",
        "count <= 4'd0;",
        "end",
        "if (load) begin",
        "// The code is held.",
        "held <= code;",
        "count <= held;",
        "end",
    ];
    assert_eq!(clocked, expected, "{verilog}");
    let own_reset = part(&verilog, "if (clear) begin", "endmodule");
    let expected = [
        "if (clear) begin",
        "cleared <= 4'd0;",
        "end else begin",
        "if (load) begin",
        "cleared <= cleared + 4'd1;",
    ];
    assert_eq!(own_reset[..5], expected, "{verilog}");

    let vhdl = vhdl::print(&design, &Header::default());
    let clocked = part(&vhdl, "-- Load wins", "proven <= proven_next;");
    let expected = [
        "-- Load wins over the count.",
        "if unsigned(code) = count then",
        "count <= (others => '0');",
        "end if;",
        "if load = '1' then",
        "-- The code is held.",
        "held <= unsigned(code);",
        "count <= held;",
        "end if;",
    ];
    assert_eq!(clocked, expected, "{vhdl}");
    assert!(!vhdl.contains("count_next"), "{vhdl}");
}

/// Catches a statement that is moved although it reads a wire before the last assignment to the wire.
#[test]
fn next_values_in_clocked_blocks_agree() {
    let (block, design) = taps();
    let engine =
        kernel_engine!(block; clock; in reset, clear, load, code; out sum, steps, above, busy);
    check("taps", &design, engine, 2000);
}
