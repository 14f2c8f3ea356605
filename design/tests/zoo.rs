//! Every construct of the kernel language in ordinary blocks, three ways.

use crate::stimulus::random_stimulus;
use crate::three_way::three_way;
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::engine::{Engine, Number};
use rtl_design::kernel_engine;
use rtl_design::reg::{Reg, SyncReg};
use rust_hdl::prelude::*;

/// Random stimulus through [`three_way`].
pub fn check(name: &str, design: &Design, mut engine: impl Engine, cycles: usize) {
    let stimulus = random_stimulus(&engine, cycles, 1);
    three_way(name, &mut engine, design, &stimulus).unwrap();
}

/// As in rust-hdl's widgets; its kernels know it by name.
macro_rules! dff_setup {
    ($self:ident, $clock:ident, $($register:ident),+) => {
        $($self.$register.clock.next = $self.$clock.val();)+
        $($self.$register.d.next = $self.$register.q.val();)+
    };
}

/// States of the machine under test.
#[derive(Copy, Clone, Debug, PartialEq, LogicState)]
pub enum Phase {
    Idle,
    Run,
    Hold,
    Stop,
    Fault,
}

/// An enum state, constants, nested conditions, a match on numbers.
#[derive(LogicBlock)]
pub struct Machine {
    pub clock: Signal<In, Clock>,
    pub reset: Signal<In, Bit>,
    pub go: Signal<In, Bit>,
    pub code: Signal<In, Bits<3>>,
    pub busy: Signal<Out, Bit>,
    pub count_out: Signal<Out, Bits<5>>,
    pub decoded: Signal<Out, Bits<4>>,
    phase: Reg<Phase>,
    count: Reg<Bits<5>>,
    limit: Constant<Bits<5>>,
    is_wide: Constant<Bit>,
}

impl Machine {
    pub fn new(limit: u64) -> Self {
        Self {
            clock: Default::default(),
            reset: Default::default(),
            go: Default::default(),
            code: Default::default(),
            busy: Default::default(),
            count_out: Default::default(),
            decoded: Default::default(),
            phase: Reg::new(Phase::Stop),
            count: Reg::new(3.into()),
            limit: Constant::new(limit.into()),
            is_wide: Constant::new(limit > 9),
        }
    }
}

impl Logic for Machine {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, phase, count);
        self.phase.reset.next = self.reset.val();
        self.count.reset.next = self.reset.val();
        self.busy.next = true;
        match self.phase.q.val() {
            Phase::Idle => {
                self.busy.next = false;
                self.count.d.next = 0.into();
                if self.go.val() {
                    self.phase.d.next = Phase::Run;
                } else if self.code.val() == 5 {
                    self.phase.d.next = Phase::Fault;
                }
            }
            Phase::Run => {
                self.count.d.next = self.count.q.val() + 1;
                if self.count.q.val() >= self.limit.val() {
                    self.phase.d.next = Phase::Hold;
                }
            }
            Phase::Hold => {
                if !self.go.val() & (self.is_wide.val() | (self.code.val() != 0)) {
                    self.phase.d.next = Phase::Stop;
                }
            }
            Phase::Stop => self.phase.d.next = Phase::Idle,
            _ => self.phase.d.next = Phase::Idle,
        }
        match self.code.val().index() {
            0 => self.decoded.next = 1.into(),
            1 => self.decoded.next = 2.into(),
            0x3 => self.decoded.next = 4.into(),
            _ => self.decoded.next = bit_cast::<4, 5>(self.count.q.val()),
        }
        if self.phase.q.val() == Phase::Fault {
            self.decoded.next = 15.into();
        }
        self.count_out.next = self.count.q.val();
    }
}

#[test]
fn a_state_machine_agrees() {
    for limit in [3, 30] {
        let mut block = Machine::new(limit);
        block.connect_all();
        let design = elaborate(&block, "machine").unwrap();
        let engine = kernel_engine!(block; clock; in reset, go, code; out busy, count_out, decoded);
        check(&format!("machine{limit}"), &design, engine, 2000);
    }
}

/// A struct in a signal.
#[derive(Copy, Clone, Debug, Default, PartialEq, LogicStruct)]
pub struct Pair {
    pub low: Bits<5>,
    pub flag: Bit,
    pub high: Bits<12>,
}

/// An interface, driven by one block and taken by another.
#[derive(LogicInterface, Clone, Debug, Default)]
#[join = "Taker"]
pub struct Giver {
    pub value: Signal<Out, Bits<7>>,
    pub ready: Signal<In, Bit>,
}

/// The other end of [`Giver`].
#[derive(LogicInterface, Clone, Debug, Default)]
#[join = "Giver"]
pub struct Taker {
    pub value: Signal<In, Bits<7>>,
    pub ready: Signal<Out, Bit>,
}

/// Counts while the other end is ready.
#[derive(LogicBlock, Default)]
struct Source {
    pub clock: Signal<In, Clock>,
    pub reset: Signal<In, Bit>,
    pub port: Giver,
    state: Reg<Bits<7>>,
}

impl Logic for Source {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, state);
        self.state.reset.next = self.reset.val();
        if self.port.ready.val() {
            self.state.d.next = self.state.q.val() + 1;
        }
        self.port.value.next = self.state.q.val();
    }
}

/// Ready if the value has its bit in a mask; shows what it takes, inverted.
#[derive(LogicBlock, Default)]
struct Sink {
    pub port: Taker,
    pub mask: Signal<In, Bits<128>>,
    pub seen: Signal<Out, Bits<7>>,
}

impl Logic for Sink {
    #[hdl_gen]
    fn update(&mut self) {
        self.port.ready.next = self.mask.val().get_bit(self.port.value.val().index());
        self.seen.next = !self.port.value.val();
    }
}

/// A stage of `W` bits; two widths are two modules.
#[derive(LogicBlock, Default)]
struct Stage<const W: usize> {
    pub clock: Signal<In, Clock>,
    pub reset: Signal<In, Bit>,
    pub data: Signal<In, Bits<W>>,
    pub out: Signal<Out, Bits<W>>,
    pub any_set: Signal<Out, Bit>,
    state: SyncReg<Bits<W>>,
}

impl<const W: usize> Logic for Stage<W> {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, state);
        self.state.reset.next = false;
        self.state.d.next = self.data.val();
        self.out.next = self.state.q.val();
        self.any_set.next = self.data.val().any();
    }
}

/// Arrays of blocks and signals, loops, interfaces, structs, a link through hierarchy.
#[derive(LogicBlock)]
pub struct Everything {
    pub clock: Signal<In, Clock>,
    pub reset: Signal<In, Bit>,
    pub data_i: Vec<Signal<In, Bits<6>>>,
    pub data_o: Vec<Signal<Out, Bits<6>>>,
    pub wide: Signal<In, Bits<48>>,
    pub mask: Signal<In, Bits<128>>,
    pub index: Signal<In, Bits<6>>,
    pub amount: Signal<In, Bits<4>>,
    pub pair: Signal<In, Pair>,
    pub pair_out: Signal<Out, Pair>,
    pub parts: Signal<Out, Bits<12>>,
    pub bits_out: Signal<Out, Bits<8>>,
    pub replaced: Signal<Out, Bits<48>>,
    pub one_hot: Signal<Out, Bits<64>>,
    pub product: Signal<Out, Bits<32>>,
    pub parity: Signal<Out, Bit>,
    pub seen: Signal<Out, Bits<7>>,
    pub early: Signal<Out, Bits<6>>,
    stages: Vec<Stage<6>>,
    wide_stage: Stage<9>,
    source: Source,
    sink: Sink,
    sum: Signal<Local, Bits<6>>,
    accumulated: Signal<Local, Bits<8>>,
    late: Signal<Local, Bits<6>>,
    _n: usize,
}

impl Everything {
    pub fn new(n: usize) -> Self {
        Self {
            clock: Default::default(),
            reset: Default::default(),
            data_i: vec![Default::default(); n],
            data_o: vec![Default::default(); n],
            wide: Default::default(),
            mask: Default::default(),
            index: Default::default(),
            amount: Default::default(),
            pair: Default::default(),
            pair_out: Default::default(),
            parts: Default::default(),
            bits_out: Default::default(),
            replaced: Default::default(),
            one_hot: Default::default(),
            product: Default::default(),
            parity: Default::default(),
            seen: Default::default(),
            early: Default::default(),
            stages: (0..n).map(|_| Stage::default()).collect(),
            wide_stage: Default::default(),
            source: Default::default(),
            sink: Default::default(),
            sum: Default::default(),
            accumulated: Default::default(),
            late: Default::default(),
            _n: n,
        }
    }
}

impl Logic for Everything {
    #[hdl_gen]
    fn update(&mut self) {
        self.sum.next = 1.into();
        for i in 0..self._n {
            self.stages[i].clock.next = self.clock.val();
            self.stages[i].reset.next = self.reset.val();
            self.stages[i].data.next = self.data_i[i].val();
            self.sum.next = self.sum.val() + self.data_i[i].val();
        }
        for i in 0..(self._n - 1) {
            self.data_o[i + 1].next = self.stages[i].out.val() ^ self.stages[i + 1].out.val();
        }
        self.data_o[0].next = self.sum.val();
        self.accumulated.next = 0.into();
        for i in 0..8 {
            self.accumulated.next = self
                .accumulated
                .val()
                .replace_bit(7 - i, self.wide.val().get_bit(i * 5 + 3));
        }
        self.bits_out.next = self.accumulated.val();
        if self.stages[0].any_set.val() & !self.stages[1].any_set.val() {
            self.bits_out.next = self.wide.val().get_bits::<8>(self.index.val().index() & 31);
        }
        self.wide_stage.clock.next = self.clock.val();
        self.wide_stage.reset.next = self.reset.val();
        self.wide_stage.data.next = self.wide.val().get_bits::<9>(7);
        self.parity.next = self.wide_stage.out.val().xor() ^ self.wide_stage.any_set.val();
        self.replaced.next = self.wide.val().replace_bit(17, self.reset.val()) >> self.amount.val();
        self.one_hot.next = 1 << self.index.val();
        self.product.next = self.wide.val().get_bits::<16>(3) * self.wide.val().get_bits::<16>(32);
        self.pair_out.next = self.pair.val();
        self.pair_out.next.low = self.pair.val().low + 3;
        if self.pair.val().flag {
            self.pair_out.next.high = self.pair.val().high - 1;
        }
        self.parts.next = self.pair.val().high ^ bit_cast::<12, 5>(self.pair.val().low);
        clock!(self, clock, source);
        self.source.reset.next = self.reset.val();
        Giver::join(&mut self.source.port, &mut self.sink.port);
        self.sink.mask.next = self.mask.val();
        self.seen.next = self.sink.seen.val();
        // read before it is assigned: the final value counts
        self.early.next = self.late.val() + 1;
        self.late.next = self.index.val();
    }
}

impl Number for Pair {
    fn from_u128(value: u128) -> Self {
        let value = value as u64;
        Self {
            low: (value & 31).into(),
            flag: value >> 5 & 1 != 0,
            high: (value >> 6 & 0xfff).into(),
        }
    }
    fn to_u128(self) -> u128 {
        self.low.to_u128() | (self.flag as u128) << 5 | self.high.to_u128() << 6
    }
}

#[test]
fn arrays_loops_structs_and_interfaces_agree() {
    let mut block = Everything::new(3);
    block.connect_all();
    let design = elaborate(&block, "everything").unwrap();
    let names: Vec<&str> = design.modules.iter().map(|m| m.name.as_str()).collect();
    // three equal stages are one module, the wide one another
    assert_eq!(
        names,
        [
            "everything",
            "everything_stages",
            "everything_wide_stage",
            "everything_source",
            "everything_sink"
        ]
    );
    let engine = kernel_engine!(block; clock; in reset, wide, mask, index, amount, pair;
        out pair_out, parts, bits_out, replaced, one_hot, product, parity, seen, early)
    .input("data0_i", |b| &mut b.data_i[0])
    .input("data1_i", |b| &mut b.data_i[1])
    .input("data2_i", |b| &mut b.data_i[2])
    .output("data0_o", |b| &mut b.data_o[0])
    .output("data1_o", |b| &mut b.data_o[1])
    .output("data2_o", |b| &mut b.data_o[2]);
    check("everything", &design, engine, 500);
}

/// Two ways through, under one condition: one process, unless the surroundings join the ways.
#[derive(LogicBlock, Default)]
struct TwoWays {
    pub swap: Signal<In, Bit>,
    pub a: Signal<In, Bits<6>>,
    pub b: Signal<In, Bits<6>>,
    pub a_out: Signal<Out, Bits<6>>,
    pub b_out: Signal<Out, Bits<6>>,
}

impl Logic for TwoWays {
    #[hdl_gen]
    fn update(&mut self) {
        self.a_out.next = self.a.val();
        self.b_out.next = self.b.val();
        if self.swap.val() {
            self.a_out.next = !self.a.val();
            self.b_out.next = self.b.val() + 1;
        }
    }
}

/// Sends a value through both ways of one child, one after the other: no loop, although one process feeds itself.
#[derive(LogicBlock, Default)]
pub struct ThereAndBack {
    pub clock: Signal<In, Clock>,
    pub swap: Signal<In, Bit>,
    pub value: Signal<In, Bits<6>>,
    pub out: Signal<Out, Bits<6>>,
    pub doubled: Signal<Out, Bits<6>>,
    ways: TwoWays,
    between: Signal<Local, Bits<6>>,
}

impl Logic for ThereAndBack {
    #[hdl_gen]
    fn update(&mut self) {
        self.ways.swap.next = self.swap.val();
        self.ways.a.next = self.value.val();
        self.between.next = 0.into();
        self.doubled.next = 0.into();
        if self.value.val().any() {
            self.between.next = self.ways.a_out.val() ^ 3;
            self.doubled.next = self.ways.b_out.val() << 1;
        }
        self.ways.b.next = self.between.val();
        self.out.next = self.ways.b_out.val();
    }
}

#[test]
fn ways_through_a_child_that_follow_each_other_agree() {
    let mut block = ThereAndBack::default();
    block.connect_all();
    let design = elaborate(&block, "there_and_back").unwrap();
    let engine = kernel_engine!(block; clock; in swap, value; out out, doubled);
    check("there_and_back", &design, engine, 300);
}
