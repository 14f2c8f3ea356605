//! Constructs without an exact meaning are rejected, with block, field and remedy.

use rtl_design::elaborate::{elaborate, ElaborateError};
use rtl_design::reg::Reg;
use rust_hdl::prelude::*;

/// A block with the given kernel; the fields are the same for all.
macro_rules! block {
    ($name:ident, $($kernel:tt)*) => {
        #[derive(LogicBlock, Default)]
        struct $name {
            clock: Signal<In, Clock>,
            a: Signal<In, Bits<6>>,
            b: Signal<In, Bits<6>>,
            f: Signal<In, Bit>,
            out: Signal<Out, Bits<6>>,
            x: Signal<Local, Bits<6>>,
            y: Signal<Local, Bits<6>>,
            state: Reg<Bits<6>>,
            _n: usize,
        }
        impl Logic for $name {
            $($kernel)*
        }
    };
}

fn error_of<B: Block>(mut block: B) -> ElaborateError {
    block.connect_all();
    elaborate(&block, "top").unwrap_err()
}

fn check<B: Block>(block: B, field: &str, problem: &str) {
    let error = error_of(block);
    assert_eq!(
        (error.block.as_str(), error.field.as_str()),
        ("top", field),
        "{error}"
    );
    assert!(error.problem.contains(problem), "{error}");
    assert!(!error.remedy.is_empty(), "{error}");
}

block!(
    PlainField,
    #[hdl_gen]
    fn update(&mut self) {
        self.out.next = self.a.val() + _limit;
    }
);

block!(
    TooLarge,
    #[hdl_gen]
    fn update(&mut self) {
        self.out.next = self.a.val() + 64;
    }
);

block!(
    Latch,
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, state);
        self.state.reset.next = self.f.val();
        self.state.d.next = self.a.val();
        if self.f.val() {
            self.out.next = self.a.val();
        }
    }
);

block!(
    Undriven,
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, state);
        self.state.d.next = self.a.val();
        self.out.next = self.a.val();
    }
);

block!(
    Loop,
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, state);
        self.state.reset.next = self.f.val();
        self.state.d.next = self.a.val();
        self.x.next = self.y.val() + 1;
        self.y.next = self.x.val() ^ self.a.val();
        self.out.next = self.y.val();
    }
);

block!(
    Early,
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, state);
        self.state.reset.next = self.f.val();
        self.state.d.next = self.a.val();
        if self.f.val() {
            self.x.next = self.x.val() + 1;
        }
        self.x.next = 3.into();
        self.out.next = self.x.val();
    }
);

block!(
    UndrivenLocal,
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, state);
        self.state.reset.next = self.f.val();
        self.state.d.next = self.a.val();
        self.out.next = self.a.val() + self.x.val();
    }
);

block!(
    UndrivenOutput,
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, state);
        self.state.reset.next = self.f.val();
        self.state.d.next = self.a.val();
    }
);

block!(
    OutOfRange,
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, state);
        self.state.reset.next = self.f.val();
        self.state.d.next = self.a.val();
        self.out.next = 0.into();
        if self.a.val().get_bit(6) {
            self.out.next = self.b.val();
        }
    }
);

#[allow(non_upper_case_globals)]
const _limit: LiteralType = 5;

#[test]
fn each_is_refused_with_its_place_and_remedy() {
    check(PlainField::default(), "out", "neither a signal nor a state");
    check(
        TooLarge::default(),
        "out",
        "literal = 64: does not fit into 6 bits",
    );
    check(Latch::default(), "out", "latch");
    check(Undriven::default(), "state.reset", "is not driven");
    check(UndrivenLocal::default(), "x", "is not driven");
    check(UndrivenOutput::default(), "out", "is not driven");
    check(Loop::default(), "x", "combinational loop: x -> y");
    check(Early::default(), "x", "read before it is assigned");
    check(
        OutOfRange::default(),
        "if",
        "bit index = 6: the value has 6 bits",
    );
}

#[derive(LogicBlock, Default)]
struct Keyword {
    signed: Signal<In, Bit>,
    out: Signal<Out, Bit>,
}

impl Logic for Keyword {
    #[hdl_gen]
    fn update(&mut self) {
        self.out.next = self.signed.val();
    }
}

#[derive(LogicBlock, Default)]
#[allow(non_snake_case)]
struct OnlyCase {
    data: Signal<In, Bit>,
    Data: Signal<Out, Bit>,
}

impl Logic for OnlyCase {
    #[hdl_gen]
    fn update(&mut self) {
        self.Data.next = self.data.val();
    }
}

#[derive(LogicBlock, Default)]
struct NoKernel {
    data: Signal<In, Bit>,
    out: Signal<Out, Bit>,
}

impl Logic for NoKernel {
    fn update(&mut self) {
        self.out.next = self.data.val();
    }
}

#[derive(LogicBlock, Default)]
struct SignedSum {
    data: Signal<In, Signed<8>>,
    out: Signal<Out, Signed<8>>,
}

impl Logic for SignedSum {
    #[hdl_gen]
    fn update(&mut self) {
        self.out.next = self.data.val();
    }
}

#[derive(LogicBlock, Default)]
struct Bidirectional {
    pin: Signal<InOut, Bit>,
    out: Signal<Out, Bit>,
}

impl Logic for Bidirectional {
    #[hdl_gen]
    fn update(&mut self) {
        self.out.next = self.pin.val();
    }
}

#[test]
fn names_and_kinds_of_signals_are_checked() {
    check(Keyword::default(), "signed", "is a Verilog keyword");
    check(OnlyCase::default(), "Data", "differ only by case");
    check(NoKernel::default(), "update", "no kernel");
    check(SignedSum::default(), "data", "is signed");
    check(Bidirectional::default(), "pin", "bidirectional");
}
