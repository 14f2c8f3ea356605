//! Line delay: measures how long an answer takes to come back, and times the samples.
//!
//! ```text
//! rise        /\_________/\_________/\______      clock edges leaving the receiver
//!             |<-- tD -->|
//! center      ___________/\_________/\______      where a data edge is expected
//! sample      ________________/\_________/\_      half a period later: the middle of the bit, the end of its cell
//! ```
//!
//! The propagation delay tD is measured once, in a frame whose period is longer than any cable's delay
//! (`acquire`), and followed by one cycle per frame afterwards. Sampling from this tracked phase tolerates twice
//! the jitter that sampling from the start edge of the same frame would.
//!
//! A rising edge of the clock and the cell that it launched are one delay apart: `pulse` and `sample` mark when each counts.
//!
//! Ref: HEIDENHAIN PWM 20 user's manual, propagation delay compensation; TI motor-control SDK, `endat_main.asm`.

mod kernel;

use crate::endat::features::Features;
use crate::endat::phase_tracker::PhaseTracker;
use crate::endat::ports::{CellControlIn, CellsOut};
use crate::half_period::HalfPeriod;
use rtl_design::reg::Reg;
use rtl_design::Block;
use rust_hdl::prelude::*;

/// Sample strobes and start edge window of one channel.
#[derive(LogicBlock, Block)]
pub struct LineDelay {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// How the cells of a frame run.
    #[bundle]
    pub control: CellControlIn,
    /// The cells of all clock pulses that were sent have ended.
    pub none_under_way: Signal<In, Bit>,
    /// This frame measures the delay instead of using it.
    pub acquire: Signal<In, Bit>,
    /// The start bit may come now.
    pub hunting: Signal<In, Bit>,
    /// Strobe one cycle before each rising clock edge.
    pub will_rise: Signal<In, Bit>,
    /// Strobe of each rising clock edge.
    pub rise: Signal<In, Bit>,
    /// Strobe: the data line has just gone high, or has changed within the answer.
    pub data_edge: Signal<In, Bit>,
    /// This edge is half a cycle later than normal (double edge only).
    pub edge_second: Signal<In, Bit>,
    /// The cell belongs to the answer after the start bit: its edge counts (alignment only).
    pub in_answer: Signal<In, Bit>,
    /// Source of the phase (alignment only): 0 mean of many edges, 1 fixed delay, 2 start bit of each frame.
    pub mode: Signal<In, Bits<2>>,
    /// Delay in mode `fixed`, in sixteenths of a system clock cycle.
    pub fixed_delay: Signal<In, Bits<15>>,
    /// Strobe, together with `sample`: this sample is a good start bit, follow its edge.
    pub follow: Signal<In, Bit>,
    /// The clock continues after the frame: the phase of the running cells follows, too.
    pub going_on: Signal<In, Bit>,
    /// EnDat clock period, in system clock cycles.
    pub period_cycles: Signal<In, Bits<11>>,
    /// Largest distance of the start edge from its expected place, in system clock cycles.
    pub start_window_cycles: Signal<In, Bits<6>>,
    /// With `sample`: half a cycle later than normal (double edge only).
    pub sample_second: Signal<Out, Bit>,
    /// Places of the answer's cells.
    #[bundle]
    pub cells: CellsOut,
    /// Strobe: the middle of the expected place of a data edge.
    pub center: Signal<Out, Bit>,
    /// The tracked delay differs from the measured one: a register was upset. Cleared by the next measurement.
    pub is_upset: Signal<Out, Bit>,
    /// Tracked propagation delay tD including synchroniser and filter, in system clock cycles.
    pub delay_cycles: Signal<Out, Bits<11>>,
    /// Tracked delay as the mean of many edges, in sixteenths of a cycle (alignment only).
    pub phase: Signal<Out, Bits<15>>,
    /// Strobe one cycle after `sample`: an edge of the answer has been measured (alignment only).
    pub measured: Signal<Out, Bit>,
    /// Places from the tracked one to this edge, minus one, in two's complement.
    pub offset: Signal<Out, Bits<8>>,
    half: HalfPeriod,
    /// Tracked propagation delay tD, in system clock cycles; 0 if a phase tracker has it.
    delay: Reg<Bits<11>>,
    /// Cycles since the first rising edge of the burst, plus 2; since the last one if the delay is measured.
    since_rise: Reg<Bits<11>>,
    /// Set with the first rising edge of a burst; cleared when the cells of the burst have ended.
    timing_armed: Reg<Bit>,
    /// High for one cycle when the tracked delay has passed since the first rising edge.
    delay_over: Reg<Bit>,
    /// High from the expected data edge of the first cell until the cells of the burst have ended.
    cells_run: Reg<Bit>,
    /// High from the sample of a cell to the expected data edge of the next one.
    second_half: Reg<Bit>,
    /// High for one cycle where the data line is sampled, half a period after `center_strobe`.
    sample_strobe: Reg<Bit>,
    /// High for one cycle at the expected place of a data edge.
    center_strobe: Reg<Bit>,
    /// Set at the expected place of a data edge; cleared with the sample.
    center_seen: Reg<Bit>,
    /// High if no data edge counts: no cells run, or the start bit of a measuring frame cannot come yet.
    not_yet: Reg<Bit>,
    /// `over`, one cycle later: the cells stop.
    afresh: Reg<Bit>,
    /// High for one cycle after a good start bit whose edge was not at its expected place.
    follow_now: Reg<Bit>,
    /// Set with the first data edge of a cell; cleared with its sample.
    edge_seen: Reg<Bit>,
    /// High if that edge came after its expected place.
    edge_late: Reg<Bit>,
    /// Cycles between the data edge of a cell and its expected place; one less if it is late.
    edge_error: Reg<Bits<6>>,
    /// Set when that distance exceeds the start window; cleared with the sample.
    edge_outside: Reg<Bit>,
    /// High for one cycle after a clock pulse was sent whose cell counts.
    pulse_leaves: Reg<Bit>,
    /// Set if the start edge of a running clock was early: the next half of a cell is one cycle shorter.
    shorten: Reg<Bit>,
    /// Set if the start edge of a running clock was late: the next half of a cell is one cycle longer.
    lengthen: Reg<Bit>,
    /// Parity of the tracked delay when it was set (upset guards only).
    parity: Reg<Bit>,
    /// High in the first cycle of a new tracked delay: its parity is stored.
    moved: Reg<Bit>,
    /// Set when the parity of the tracked delay changes by itself; cleared when the delay is measured or fixed.
    wrong: Reg<Bit>,
    /// Parity of the tracked delay.
    parity_now: Signal<Local, Bit>,
    /// High for one cycle: the delay counts from this rising edge of the clock.
    first_rise: Signal<Local, Bit>,
    /// High for one cycle: the start edge of a frame that measures the delay.
    acquired: Signal<Local, Bit>,
    /// High for one cycle at the expected, or measured, data edge of the first cell.
    first_center: Signal<Local, Bit>,
    /// High for one cycle at the middle of the place of a data edge.
    center_now: Signal<Local, Bit>,
    /// High for one cycle: the data line is sampled.
    sample_now: Signal<Local, Bit>,
    /// Change of the tracked delay, in cycles: 1 or -1.
    step: Signal<Local, Bits<11>>,
    /// High if the data edge of the cell has come.
    edge_now: Signal<Local, Bit>,
    /// High if no frame runs, or if the clock is stopped and the cells of all its pulses have ended.
    over: Signal<Local, Bit>,
    tracker: Vec<PhaseTracker>,
    /// Places from the expected place to the data edge of the last cell, minus one, in two's complement.
    offset_now: Reg<Bits<8>>,
    /// High for one cycle after the sample of a cell whose data edge counts.
    measured_now: Reg<Bit>,
    /// High if the half of a cell began half a cycle later than normal (double edge only).
    second: Reg<Bit>,
    /// High if the data edge of the cell came half a cycle later than normal (double edge only).
    edge_place: Reg<Bit>,
    has_guards: Constant<Bit>,
    has_alignment: Constant<Bit>,
    has_double: Constant<Bit>,
    frame_mode: Constant<Bits<2>>,
    fixed_mode: Constant<Bits<2>>,
    /// Tracked delay in places: system clock cycles, or half ones with the double edge.
    places: Signal<Local, Bits<12>>,
    /// Tracked delay, in system clock cycles.
    delay_now: Signal<Local, Bits<11>>,
    /// High if the start bit of each frame sets the phase.
    is_frame: Signal<Local, Bit>,
    /// High for one cycle: the start edge sets the middle of its cell.
    snap: Signal<Local, Bit>,
    /// High if a data edge in this cycle belongs to the cell after this sample.
    next_cell: Signal<Local, Bit>,
    /// High if the data edge of the cell is after its expected place.
    late_now: Signal<Local, Bit>,
    /// High if the data edge of the cell comes half a cycle later than normal.
    place_now: Signal<Local, Bit>,
    /// High if the expected place is half a cycle later than normal.
    center_place: Signal<Local, Bit>,
    /// Places between the data edge and its expected place; one less if it is late.
    distance: Signal<Local, Bits<8>>,
    /// High with a sample if the data edge of the cell counts.
    good_edge: Signal<Local, Bit>,
    /// High while the phase is still unknown: every data edge counts.
    is_open: Signal<Local, Bit>,
    /// High if the first cell begins a cycle later: the period is odd and the delay past half a cycle.
    is_later: Signal<Local, Bit>,
    /// High for one cycle: the first cell begins.
    due: Signal<Local, Bit>,
    /// `delay_over`, one cycle later.
    was_over: Reg<Bit>,
    _trackers: usize,
}

pub use endat_regs::line::mode;

impl LineDelay {
    /// A line delay with these features.
    pub fn new(features: Features) -> Self {
        let trackers = usize::from(features.alignment);
        Self::from_parts(LineDelayParts {
            half: HalfPeriod::new(features.alignment, features.double_edge),
            tracker: (0..trackers).map(|_| PhaseTracker::new(features)).collect(),
            has_guards: Constant::new(features.upset_guards),
            has_alignment: Constant::new(features.alignment),
            has_double: Constant::new(features.double_edge),
            frame_mode: Constant::new(mode::FRAME.into()),
            fixed_mode: Constant::new(mode::FIXED.into()),
            _trackers: trackers,
        })
    }
}
