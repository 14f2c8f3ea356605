//! Changes of designs: what each kind makes of a block, and that a design with all of them is each of them.

use crate::stimulus::stimulus;
use crate::three_way::{agree, record, replay, Recording, Stimulus};
use crate::tools;
use crate::zoo::{Everything, Machine};
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::engine::Interpreter;
use rtl_design::mutate::{mutated, mutations, schema, Kind, Mutation, CHOICE_BITS};
use rtl_design::reg::{Reg, SyncReg};
use rtl_design::verilog::{self, Header};
use rust_hdl::prelude::*;

/// Something for each kind to change.
#[derive(LogicBlock, Default)]
struct Sample {
    clock: Signal<In, Clock>,
    reset: Signal<In, Bit>,
    pin: Signal<In, Bit>,
    go: Signal<In, Bit>,
    a: Signal<In, Bits<4>>,
    sum: Signal<Out, Bits<4>>,
    level: Signal<Out, Bit>,
    sync0: SyncReg<Bit>,
    sync1: SyncReg<Bit>,
    total: Reg<Bits<4>>,
}

impl Logic for Sample {
    #[hdl_gen]
    fn update(&mut self) {
        self.sync0.clock.next = self.clock.val();
        self.sync1.clock.next = self.clock.val();
        self.total.clock.next = self.clock.val();
        self.sync0.reset.next = self.reset.val();
        self.sync1.reset.next = self.reset.val();
        self.total.reset.next = self.reset.val();
        self.sync0.d.next = self.pin.val();
        self.sync1.d.next = self.sync0.q.val();
        self.total.d.next = self.total.q.val();
        if self.go.val() {
            self.total.d.next = self.total.q.val() + self.a.val();
        }
        if self.level.val() {
            self.total.d.next = 5.into();
        }
        self.sum.next = self.total.q.val();
        self.level.next = self.sync1.q.val() & self.go.val();
    }
}

fn sample() -> Design {
    let mut block = Sample::default();
    block.connect_all();
    elaborate(&block, "sample").unwrap()
}

fn everything() -> Design {
    let mut block = Everything::new(3);
    block.connect_all();
    elaborate(&block, "everything").unwrap()
}

fn machine() -> Design {
    let mut block = Machine::new(7);
    block.connect_all();
    elaborate(&block, "machine").unwrap()
}

fn all(design: &Design) -> Vec<Mutation> {
    let modules = 0..design.modules.len();
    modules.flat_map(|id| mutations(design, id)).collect()
}

/// Lines of the text that the other text does not have.
fn only_in(text: &str, other: &str) -> Vec<String> {
    let lines = text.lines().map(str::trim);
    let missing = lines.filter(|line| !other.lines().any(|l| l.trim() == *line));
    missing.map(str::to_owned).collect()
}

/// Lines that mutations of one kind remove and add.
fn edits(kind: Kind) -> Vec<(Vec<String>, Vec<String>)> {
    let design = sample();
    let print = |design: &Design| verilog::print(design, &Header::default());
    let right = print(&design);
    let of_kind = all(&design).into_iter().filter(|m| m.kind == kind);
    let edit = |mutation: Mutation| {
        let wrong = print(&mutated(&design, &mutation));
        (only_in(&right, &wrong), only_in(&wrong, &right))
    };
    of_kind.map(edit).collect()
}

fn has(kind: Kind, removed: &[&str], added: &[&str]) {
    let edits = edits(kind);
    let is_it = |(before, after): &(Vec<String>, Vec<String>)| before == removed && after == added;
    assert!(edits.iter().any(is_it), "{edits:#?}");
}

#[test]
fn stuck_bits_have_one_level() {
    let right = "total <= total + a;";
    has(Kind::Stuck, &[right], &["total <= (total + a) & 4'd13;"]);
    has(Kind::Stuck, &[right], &["total <= (total + a) | 4'd2;"]);
    // Two levels of each bit of six values, and the level that each bit of a constant does not have.
    assert_eq!(edits(Kind::Stuck).len(), 2 * 15 + 4);
}

#[test]
fn inverted_bits_and_conditions_are_complemented() {
    has(
        Kind::Inverted,
        &["total <= total + a;"],
        &["total <= (total + a) ^ 4'd1;"],
    );
    has(Kind::Inverted, &["if (go) begin"], &["if (!go) begin"]);
}

#[test]
fn operators_are_taken_for_others() {
    has(
        Kind::Operator,
        &["total <= total + a;"],
        &["total <= total - a;"],
    );
    has(
        Kind::Operator,
        &["assign level = sync1 & go;"],
        &["assign level = sync1 | go;"],
    );
}

#[test]
fn constants_differ_by_one() {
    for value in ["4'd4", "4'd6"] {
        has(
            Kind::Constant,
            &["total <= 4'd5;"],
            &[&format!("total <= {value};")],
        );
    }
}

#[test]
fn conditions_are_left_out() {
    has(
        Kind::Condition,
        &["assign level = sync1 & go;"],
        &["assign level = sync1;"],
    );
    // The branch is always taken, or never.
    has(Kind::Condition, &["if (level) begin"], &[]);
    has(
        Kind::Condition,
        &["if (level) begin", "total <= 4'd5;"],
        &[],
    );
    // Two branches, and two operands: the second one alone leaves no use for the synchroniser.
    assert_eq!(edits(Kind::Condition).len(), 6);
}

#[test]
fn assignments_are_left_out_where_no_latch_follows() {
    has(
        Kind::Assignment,
        &["if (level) begin", "total <= 4'd5;"],
        &[],
    );
    let design = sample();
    let missing: Vec<String> = (all(&design).into_iter())
        .filter(|m| m.kind == Kind::Assignment)
        .map(|m| m.about)
        .collect();
    assert_eq!(missing, ["total_next", "total_next"]);
}

#[test]
fn registers_lose_their_reset() {
    let design = sample();
    let resets: Vec<Mutation> = (all(&design).into_iter())
        .filter(|m| m.kind == Kind::Reset)
        .collect();
    assert_eq!(resets.len(), 3);
    for mutation in resets {
        let wrong = mutated(&design, &mutation);
        let module = wrong.top();
        let without = module.registers.iter().filter(|r| r.reset.is_none());
        let names: Vec<&str> = without.map(|r| module.nets[r.q].name.as_str()).collect();
        assert_eq!(names, [mutation.about.as_str()]);
    }
}

#[test]
fn stages_of_synchronisers_become_wires() {
    let design = sample();
    let stages: Vec<Mutation> = (all(&design).into_iter())
        .filter(|m| m.kind == Kind::Stage)
        .collect();
    let names: Vec<&str> = stages.iter().map(|m| m.about.as_str()).collect();
    assert_eq!(names, ["sync0", "sync1"]);
    let rows = |design: &Design| {
        let stimulus = Stimulus {
            inputs: ["reset", "pin", "go", "a"].map(String::from).into(),
            cycles: (0..6).map(|_| vec![0, 1, 1, 0]).collect(),
            middle: vec![],
        };
        record(&mut Interpreter::new(design).unwrap(), &stimulus).output("level")
    };
    assert_eq!(rows(&design), [0, 0, 1, 1, 1, 1]);
    for mutation in &stages {
        assert_eq!(rows(&mutated(&design, mutation)), [0, 1, 1, 1, 1, 1]);
    }
}

fn recorded(design: &Design, stimulus: &Stimulus) -> Recording {
    record(&mut Interpreter::new(design).unwrap(), stimulus)
}

fn with_choice(stimulus: &Stimulus, name: &str, number: usize) -> Stimulus {
    let mut chosen = stimulus.clone();
    chosen.inputs.push(name.to_owned());
    for row in &mut chosen.cycles {
        row.push(number as u128);
    }
    chosen
}

/// Every mutant of a design alone, and in the design that has all of them.
fn is_each(design: &Design, cycles: usize) {
    let mutations = all(design);
    assert!(mutations.len() < 1 << CHOICE_BITS);
    let (whole, choice) = schema(design, &mutations);
    let stimulus = stimulus(design, cycles, 1);
    let right = recorded(design, &stimulus);
    let mut engine = Interpreter::new(&whole).unwrap();
    let start = engine.clone();
    let mut seen = 0;
    for number in 0..=mutations.len() {
        let wrong = match number.checked_sub(1) {
            None => design.clone(),
            Some(index) => mutated(design, &mutations[index]),
        };
        let alone = recorded(&wrong, &stimulus);
        engine.clone_from(&start);
        let chosen = record(&mut engine, &with_choice(&stimulus, &choice, number));
        let name = format!("mutant {number}");
        agree(&name, &alone, &chosen).unwrap();
        seen += usize::from(alone.cycles != right.cycles);
    }
    assert!(seen * 2 > mutations.len(), "{seen} of {}", mutations.len());
}

#[test]
fn a_design_with_all_mutants_is_each_of_them() {
    is_each(&sample(), 300);
    is_each(&machine(), 300);
    is_each(&everything(), 100);
}

/// The printed text of all mutants does in iverilog what one mutant does in the engine.
#[test]
fn the_verilog_of_all_mutants_is_each_of_them() {
    if !tools::require("iverilog", "mutants of a block") {
        return;
    }
    let design = machine();
    let mutations = all(&design);
    let (whole, choice) = schema(&design, &mutations);
    let stimulus = stimulus(&design, 100, 1);
    for index in (0..mutations.len()).step_by(mutations.len() / 4) {
        let expected = recorded(&mutated(&design, &mutations[index]), &stimulus);
        let chosen = with_choice(&stimulus, &choice, index + 1);
        replay("all_mutants", &whole, &chosen, &expected).unwrap();
    }
}
