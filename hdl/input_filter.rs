//! Input filter: synchronises the asynchronous data line and removes short pulses.
//!
//! ```text
//! pin --[SyncReg x3]--> majority of 3 --> stable for filter_cycles + 1 samples? --[Reg]--> level, edge_strobe
//!   \--[FallReg, SyncReg x3]--^   (two samples in each cycle: `level_first` is half a cycle older than `level`)
//! ```
//!
//! Its delay is part of the measured propagation delay, so it needs no correction.

use crate::endat::features::Features;
use rtl_design::reg::{FallReg, Reg, SyncReg};
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Synchroniser of three stages and a run-time filter for one input pin.
#[derive(LogicBlock, Block)]
#[properties("properties/input_filter.sv")]
pub struct InputFilter {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// The pin, asynchronous.
    pub pin: Signal<In, Bit>,
    /// A pulse of at most this many system clock cycles is ignored; 0 switches the filter off.
    pub filter_cycles: Signal<In, Bits<4>>,
    /// Half a cycle more; with two samples in each cycle.
    pub filter_half: Signal<In, Bit>,
    /// Each sample is the majority of itself and its two neighbours.
    pub majority: Signal<In, Bit>,
    /// Falling edges count, too.
    pub both_edges: Signal<In, Bit>,
    /// The level after synchroniser and filter.
    pub level: Signal<Out, Bit>,
    /// The level half a cycle before; equal to `level` with one sample in each cycle.
    pub level_first: Signal<Out, Bit>,
    /// High in the first cycle in which `level` is high, or has changed.
    pub edge_strobe: Signal<Out, Bit>,
    /// This edge is between `level_first` and `level`, not before both.
    pub edge_second: Signal<Out, Bit>,
    /// Strobe: a pulse has been removed.
    pub glitch: Signal<Out, Bit>,
    /// Pin, first synchroniser stage.
    sync1: SyncReg<Bit>,
    /// Pin, second synchroniser stage.
    sync2: SyncReg<Bit>,
    /// Pin, third synchroniser stage.
    sync3: SyncReg<Bit>,
    /// Pin at the falling clock edge.
    fall1: Vec<FallReg<Bit>>,
    /// Sample of the falling edge, first stage at the rising edge.
    fall2: Vec<SyncReg<Bit>>,
    /// Sample of the falling edge, second stage.
    fall3: Vec<SyncReg<Bit>>,
    /// Sample of the falling edge, third stage: half a cycle older than `sync3`.
    fall4: Vec<SyncReg<Bit>>,
    /// Sample of one cycle ago, for the majority.
    earlier: Reg<Bit>,
    /// Sample of two cycles ago; with two samples in each cycle the one half a cycle before `earlier`.
    earlier_first: Reg<Bit>,
    /// Consecutive samples that differ from the filtered level; 0 when one agrees with it.
    different: Reg<Bits<5>>,
    /// Level after the filter.
    filtered: Reg<Bit>,
    /// Level after the filter, half a cycle before `filtered`; 0 with one sample in each cycle.
    filtered_first: Reg<Bit>,
    /// High for one cycle when the filtered level has risen; with `both_edges` also when it has fallen.
    edge_found: Reg<Bit>,
    /// With `edge_found`: the edge is between the two samples of the cycle, not before both.
    edge_is_second: Reg<Bit>,
    /// High for one cycle when the filter has removed a pulse.
    removed: Reg<Bit>,
    /// 1 if majority, edges of both directions and removed pulses are available.
    has_alignment: Constant<Bit>,
    /// 1 if the pin is sampled at both clock edges.
    has_double: Constant<Bit>,
    /// Samples in a row that the filter ignores.
    limit: Signal<Local, Bits<5>>,
    /// First sample of the cycle, from the synchroniser.
    first: Signal<Local, Bit>,
    /// First sample of the cycle, after the majority.
    sample_first: Signal<Local, Bit>,
    /// Sample of the cycle, after the majority; with two samples in each cycle the second one.
    sample: Signal<Local, Bit>,
    /// Filtered level between the two samples of the cycle.
    middle: Signal<Local, Bit>,
    /// `different` between the two samples of the cycle.
    middle_different: Signal<Local, Bits<5>>,
    /// Filtered level after this cycle.
    settled: Signal<Local, Bit>,
    /// High if falling edges count, too.
    both: Signal<Local, Bit>,
    /// High if an edge is before both samples of the cycle.
    edge_first: Signal<Local, Bit>,
    _doubles: usize,
}

impl InputFilter {
    /// A filter with these features.
    pub fn new(features: Features) -> Self {
        let doubles = usize::from(features.double_edge);
        Self::from_parts(InputFilterParts {
            fall1: (0..doubles).map(|_| Default::default()).collect(),
            fall2: (0..doubles).map(|_| Default::default()).collect(),
            fall3: (0..doubles).map(|_| Default::default()).collect(),
            fall4: (0..doubles).map(|_| Default::default()).collect(),
            has_alignment: Constant::new(features.alignment),
            has_double: Constant::new(features.double_edge),
            _doubles: doubles,
        })
    }
}

#[kernel]
impl Logic for InputFilter {
    fn update(&mut self) {
        self.sync1.d.next = self.pin.val();
        self.sync2.d.next = self.sync1.q.val();
        self.sync3.d.next = self.sync2.q.val();
        self.first.next = false;
        for i in 0..self._doubles {
            self.fall1[i].clock.next = self.clock.val();
            self.fall2[i].clock.next = self.clock.val();
            self.fall3[i].clock.next = self.clock.val();
            self.fall4[i].clock.next = self.clock.val();
            self.fall1[i].reset.next = false;
            self.fall2[i].reset.next = self.reset.val();
            self.fall3[i].reset.next = self.reset.val();
            self.fall4[i].reset.next = self.reset.val();
            self.fall1[i].d.next = self.pin.val();
            self.fall2[i].d.next = self.fall1[i].q.val();
            self.fall3[i].d.next = self.fall2[i].q.val();
            self.fall4[i].d.next = self.fall3[i].q.val();
            self.first.next = self.fall4[i].q.val();
        }

        // The majority waits for the next sample.
        self.earlier.d.next = self.sync3.q.val() & self.has_alignment.val();
        self.earlier_first.d.next = self.earlier.q.val();
        self.sample.next = self.sync3.q.val();
        self.sample_first.next = self.first.val();
        if self.has_double.val() {
            self.earlier_first.d.next = self.first.val();
        }
        if self.has_alignment.val() & self.majority.val() {
            self.sample.next = (self.sync3.q.val() & self.earlier.q.val())
                | (self.sync3.q.val() & self.earlier_first.q.val())
                | (self.earlier.q.val() & self.earlier_first.q.val());
            if self.has_double.val() {
                self.sample_first.next = (self.earlier_first.q.val() & self.earlier.q.val())
                    | (self.earlier_first.q.val() & self.first.val())
                    | (self.earlier.q.val() & self.first.val());
                self.sample.next = (self.earlier.q.val() & self.first.val())
                    | (self.earlier.q.val() & self.sync3.q.val())
                    | (self.first.val() & self.sync3.q.val());
            }
        }

        // One step of the filter, or two.
        self.limit.next = bit_cast::<5, 4>(self.filter_cycles.val());
        self.middle.next = self.filtered.q.val();
        self.middle_different.next = self.different.q.val();
        self.removed.d.next = false;
        if self.has_double.val() {
            self.limit.next = (bit_cast::<5, 4>(self.filter_cycles.val()) << 1)
                | bit_cast::<5, 1>(self.filter_half.val().into());
            self.middle_different.next = 0.into();
            if self.sample_first.val() != self.filtered.q.val() {
                if self.different.q.val() == self.limit.val() {
                    self.middle.next = self.sample_first.val();
                } else {
                    self.middle_different.next = self.different.q.val() + 1;
                }
            } else {
                self.removed.d.next = self.different.q.val().any();
            }
        }
        self.settled.next = self.middle.val();
        self.different.d.next = 0.into();
        if self.sample.val() != self.middle.val() {
            if self.middle_different.val() == self.limit.val() {
                self.settled.next = self.sample.val();
            } else {
                self.different.d.next = self.middle_different.val() + 1;
                if !self.has_double.val() {
                    self.different.d.next = (self.middle_different.val() + 1).replace_bit(4, false);
                }
            }
        } else {
            if self.middle_different.val().any() {
                self.removed.d.next = true;
            }
        }
        if !self.has_alignment.val() {
            self.removed.d.next = false;
        }
        self.filtered_first.d.next = self.middle.val() & self.has_double.val();
        self.filtered.d.next = self.settled.val();

        self.both.next = self.has_alignment.val() & self.both_edges.val();
        self.edge_first.next = (self.middle.val() & !self.filtered.q.val())
            | (self.both.val() & !self.middle.val() & self.filtered.q.val());
        self.edge_found.d.next = self.edge_first.val()
            | (self.settled.val() & !self.middle.val())
            | (self.both.val() & !self.settled.val() & self.middle.val());
        self.edge_is_second.d.next = !self.edge_first.val() & self.has_double.val();
        self.level.next = self.filtered.q.val();
        self.level_first.next = self.filtered_first.q.val();
        self.edge_strobe.next = self.edge_found.q.val();
        self.edge_second.next = self.edge_is_second.q.val();
        self.glitch.next = self.removed.q.val();
    }
}
