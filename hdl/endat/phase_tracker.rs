//! Phase tracker: measures the place of the data edges to a fraction of a cycle, as the mean of many edges.
//!
//! ```text
//! edge of this cell: places after the tracked one -->(+)--> 1/8, 1/32 or 1/512 of it --> phase (12 bits before the point, 12 after)
//!                                                   - ^                                    |
//!                                                     +------------ fraction --------------+--> delay for the cells
//! ```
//!
//! A place is one sampling time of the data line: a system clock cycle, or half of one. The start edge of the first frame sets the phase.
//! The edges after it in that frame count for an eighth, those of the other frames at the calibration clock for a 32nd, and
//! from then on for a 512th. So jitter averages out, and the phase follows temperature drift of the cable.
//!
//! In mode `fixed` the delay comes from a register, and the phase does not change.

use crate::endat::features::Features;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Fraction bits of the phase.
pub const FRACTION_BITS: u32 = 12;

/// Mean place of the data edges of one channel.
#[derive(LogicBlock, Block)]
pub struct PhaseTracker {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe: the start edge of the frame that measures the delay, `measured_places` after its clock edge.
    pub acquired: Signal<In, Bit>,
    /// Delay of this edge.
    pub measured_places: Signal<In, Bits<12>>,
    /// Strobe: the first cell begins, at the delay for the cells or one place later.
    pub starts: Signal<In, Bit>,
    /// With `starts`: one place later.
    pub is_later: Signal<In, Bit>,
    /// Strobe: a cell with a good edge ends.
    pub edge_strobe: Signal<In, Bit>,
    /// Places from the middle of its expected place to the edge, minus one (two's complement).
    pub offset: Signal<In, Bits<8>>,
    /// The frame measures the delay.
    pub acquire: Signal<In, Bit>,
    /// The frame runs at the calibration clock, or its phase comes from its start bit.
    pub quick: Signal<In, Bit>,
    /// The delay comes from `fixed_delay`.
    pub is_fixed: Signal<In, Bit>,
    /// The delay in mode `fixed`, in sixteenths of a system clock cycle.
    pub fixed_delay: Signal<In, Bits<15>>,
    /// Delay for the cells, rounded down.
    pub delay_places: Signal<Out, Bits<12>>,
    /// The delay is more than half a place above `delay_places`.
    pub past_half: Signal<Out, Bit>,
    /// The delay may change in the next cycle.
    pub moves: Signal<Out, Bit>,
    /// Tracked delay, in sixteenths of a system clock cycle.
    pub phase: Signal<Out, Bits<15>>,
    /// Tracked phase in places, 12 bits before the point and 12 after it.
    place: Reg<Bits<24>>,
    /// High for one cycle: the phase moves towards the edge of the last cell.
    take: Reg<Bit>,
    /// `offset`, one cycle later.
    by: Reg<Bits<8>>,
    /// Place from which the cells of the frame are timed, modulo 32.
    middle: Reg<Bits<5>>,
    has_double: Constant<Bit>,
    /// Upper bits of a negative distance.
    negative: Constant<Bits<32>>,
    /// Upper bits of a negative step.
    top: Constant<Bits<24>>,
    /// Distance from the phase to the edge, with 12 bits after the point; one less in the last place.
    innovation: Signal<Local, Bits<32>>,
    /// Step of the phase: a part of this distance, minus one.
    step: Signal<Local, Bits<24>>,
    /// Places from the phase to the middle of the cells, modulo 32.
    moved: Signal<Local, Bits<5>>,
    /// The same number with its sign extended.
    moved_by: Signal<Local, Bits<8>>,
    /// Places from the phase, rounded down, to the edge, minus one.
    distance: Signal<Local, Bits<8>>,
}

impl PhaseTracker {
    /// A tracker with these features.
    pub fn new(features: Features) -> Self {
        Self::from_parts(PhaseTrackerParts {
            has_double: Constant::new(features.double_edge),
            negative: Constant::new(0xFFF0_0000u64.into()),
            top: Constant::new(0x80_0000u64.into()),
        })
    }
}

#[kernel]
impl Logic for PhaseTracker {
    fn update(&mut self) {
        self.take.d.next = self.edge_strobe.val() & !self.is_fixed.val();
        self.by.d.next = self.offset.val();

        // The phase moves while the cells keep their start.
        if self.starts.val() {
            self.middle.d.next = self.delay_places.val().get_bits::<5>(0)
                + bit_cast::<5, 1>(self.is_later.val().into());
        }
        if self.acquired.val() {
            self.middle.d.next = self.measured_places.val().get_bits::<5>(0);
        }
        self.moved.next = self.middle.q.val() - self.place.q.val().get_bits::<5>(12);
        self.moved_by.next = bit_cast::<8, 5>(self.moved.val());
        if self.moved.val().get_bit(4) {
            self.moved_by.next = bit_cast::<8, 5>(self.moved.val()) | 0xE0;
        }
        self.distance.next = self.by.q.val() + self.moved_by.val();

        // Edge minus phase: the integer part is counted, the fraction is known. Each is one less, compensated below.
        self.innovation.next = bit_cast::<32, 12>(!self.place.q.val().get_bits::<12>(0))
            | (bit_cast::<32, 8>(self.distance.val()) << 12);
        if self.distance.val().get_bit(7) {
            self.innovation.next = bit_cast::<32, 12>(!self.place.q.val().get_bits::<12>(0))
                | (bit_cast::<32, 8>(self.distance.val()) << 12)
                | self.negative.val();
        }
        self.step.next = bit_cast::<24, 23>(self.innovation.val().get_bits::<23>(9));
        if self.distance.val().get_bit(7) {
            self.step.next =
                bit_cast::<24, 23>(self.innovation.val().get_bits::<23>(9)) | self.top.val();
        }
        if self.quick.val() {
            self.step.next = self.innovation.val().get_bits::<24>(5);
        }
        if self.acquire.val() {
            self.step.next = self.innovation.val().get_bits::<24>(3);
        }
        if self.take.q.val() {
            self.place.d.next = self.place.q.val() - !self.step.val();
        }
        if self.acquired.val() {
            self.place.d.next = bit_cast::<24, 12>(self.measured_places.val()) << 12;
        }

        self.moves.next = self.take.q.val() | self.acquired.val() | self.is_fixed.val();
        self.past_half.next = self.place.q.val().get_bit(11);
        self.delay_places.next = self.place.q.val().get_bits::<12>(12);
        self.phase.next = self.place.q.val().get_bits::<15>(8);
        if self.is_fixed.val() {
            self.past_half.next = self.fixed_delay.val().get_bit(3);
            self.delay_places.next = bit_cast::<12, 11>(self.fixed_delay.val().get_bits::<11>(4));
        }
        if self.has_double.val() {
            self.phase.next = self.place.q.val().get_bits::<15>(9);
            if self.is_fixed.val() {
                self.delay_places.next = self.fixed_delay.val().get_bits::<12>(3);
            }
        }
    }
}
