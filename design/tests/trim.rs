//! Small blocks, and what is left of them where something is off.

use rtl_design::elaborate::{elaborate, Design, Module, NetId};
use rtl_design::reg::Reg;
use rtl_design::verilog::{print, Header};
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Counts what comes, doubled if it has the part for it; says which it was.
#[derive(LogicBlock, Block)]
struct Adder {
    clock: Signal<In, Clock>,
    reset: Signal<In, Bit>,
    doubles: Signal<In, Bit>,
    other: Signal<In, Bits<4>>,
    value: Signal<In, Bits<4>>,
    sum: Signal<Out, Bits<4>>,
    spare: Signal<Out, Bits<4>>,
    total: Reg<Bits<4>>,
    was_double: Reg<Bit>,
    has_other: Constant<Bit>,
}

impl Adder {
    fn new(has_other: bool) -> Self {
        Self::from_parts(AdderParts {
            has_other: Constant::new(has_other),
        })
    }
}

#[kernel]
impl Logic for Adder {
    fn update(&mut self) {
        self.total.d.next = self.total.q.val() + self.value.val();
        if self.doubles.val() {
            self.total.d.next = self.total.q.val() + (self.value.val() << 1);
            self.was_double.d.next = true;
        }
        if self.has_other.val() {
            self.total.d.next = self.other.val();
        }
        self.sum.next = self.total.q.val();
        if self.was_double.q.val() {
            self.sum.next = 0.into();
        }
        self.spare.next = self.total.q.val() + 1;
    }
}

/// Tells why there is no answer; of a line that is watched, another reason.
#[derive(LogicBlock, Block)]
struct Teller {
    fails: Signal<In, Bit>,
    stuck: Signal<In, Bit>,
    told: Signal<Out, Bits<4>>,
    cause: Signal<Local, Bits<4>>,
    no_answer: Constant<Bits<4>>,
    is_watched: Constant<Bit>,
}

#[kernel]
impl Logic for Teller {
    fn update(&mut self) {
        self.cause.next = self.no_answer.val();
        if self.is_watched.val() & self.stuck.val() {
            self.cause.next = self.no_answer.val() | 1;
        }
        self.told.next = 0.into();
        if self.fails.val() {
            self.told.next = self.cause.val();
        }
    }
}

/// Two of them; the first never doubles.
#[derive(LogicBlock, Block)]
struct Pair {
    clock: Signal<In, Clock>,
    reset: Signal<In, Bit>,
    doubles: Signal<In, Bit>,
    value: Signal<In, Bits<4>>,
    first_sum: Signal<Out, Bits<4>>,
    second_sum: Signal<Out, Bits<4>>,
    #[given]
    first: Adder,
    #[given]
    second: Adder,
    first_may: Constant<Bit>,
}

impl Pair {
    fn new(first_has_other: bool, first_may: bool) -> Self {
        Self::from_parts(PairParts {
            first: Adder::new(first_has_other),
            second: Adder::new(false),
            first_may: Constant::new(first_may),
        })
    }
}

#[kernel]
impl Logic for Pair {
    fn update(&mut self) {
        clock!(self, clock, first, second);
        self.first.reset.next = self.reset.val();
        self.second.reset.next = self.reset.val();
        self.first.value.next = self.value.val();
        self.second.value.next = self.value.val();
        self.first.other.next = self.value.val();
        self.second.other.next = self.value.val();
        self.first.doubles.next = self.doubles.val() & self.first_may.val();
        self.second.doubles.next = self.doubles.val();
        self.first_sum.next = self.first.sum.val();
        self.second_sum.next = self.second.sum.val();
    }
}

fn trimmed(first_has_other: bool, first_may: bool) -> Design {
    elaborate(&Pair::new(first_has_other, first_may), "pair")
        .unwrap()
        .trimmed()
}

fn names(nets: impl Iterator<Item = NetId>, module: &Module) -> Vec<&str> {
    nets.map(|net| module.nets[net].name.as_str()).collect()
}

fn ports(module: &Module) -> Vec<&str> {
    names(module.ports.iter().map(|port| port.net), module)
}

fn registers(module: &Module) -> Vec<&str> {
    names(module.registers.iter().map(|register| register.q), module)
}

#[test]
fn a_flag_that_is_off_takes_its_branch_and_its_port_with_it() {
    let design = trimmed(false, true);
    assert_eq!(design.modules.len(), 2);
    let adder = &design.modules[1];
    assert_eq!(ports(adder), ["clock", "reset", "doubles", "value", "sum"]);
    assert_eq!(registers(adder), ["total", "was_double"]);
}

/// Catches a module specialised for one of its instances while the other one needs it whole.
#[test]
fn what_one_instance_needs_stays_in_both() {
    let design = trimmed(false, false);
    assert_eq!(design.modules.len(), 2);
    assert!(ports(&design.modules[1]).contains(&"doubles"));
    assert_eq!(registers(&design.modules[1]), ["total", "was_double"]);
}

#[test]
fn a_register_that_never_moves_is_none() {
    let design = trimmed(true, false);
    let [_, first, second] = &design.modules[..] else {
        panic!("{} modules", design.modules.len());
    };
    // Ties and the flag: the first takes `other`, and never doubles.
    assert_eq!(ports(first), ["clock", "reset", "other", "sum"]);
    assert_eq!(registers(first), ["total"]);
    assert_eq!(registers(second), ["total", "was_double"]);
}

/// Without start values a register is known from its reset on only.
#[test]
fn without_reset_and_start_value_nothing_is_known() {
    let mut design = elaborate(&Pair::new(true, false), "pair").unwrap();
    design.has_initial_values = false;
    for register in design.modules.iter_mut().flat_map(|m| &mut m.registers) {
        register.reset = None;
    }
    let first = &design.trimmed().modules[1];
    assert_eq!(registers(first), ["total", "was_double"]);
}

/// Properties keep their registers; they see the value of a register that never changes.
#[test]
fn properties_keep_what_they_speak_of() {
    let mut design = elaborate(&Pair::new(true, false), "pair").unwrap();
    design.modules[1].properties = "always @* p: assert (!was_double & spare != 4'd3);\n".into();
    let trimmed = design.trimmed();
    let first = &trimmed.modules[1];
    assert_eq!(ports(first), ["clock", "reset", "other", "sum", "spare"]);
    assert_eq!(registers(first), ["total"]);
    let text = &first.properties;
    assert!(
        text.starts_with("wire [0:0] was_double = 1'd0;\nalways"),
        "{text}"
    );
}

#[test]
fn nothing_is_left_to_trim() {
    let once = trimmed(true, false);
    assert_eq!(once.trimmed(), once);
}

#[test]
fn a_constant_keeps_its_name_where_a_net_was() {
    let mut teller = Teller::from_parts(TellerParts {
        no_answer: Constant::new(12.into()),
        is_watched: Constant::new(false),
    });
    teller.connect_all();
    let design = elaborate(&teller, "teller").unwrap();
    let text = print(&design, &Header::default());
    assert!(text.contains("told = NO_ANSWER;"), "{text}");
    assert!(
        !text.contains("cause") && !text.contains("IS_WATCHED"),
        "{text}"
    );
}
