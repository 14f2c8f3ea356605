//! Line delay: knows how long an answer takes to come back, and says when to sample.
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
//! `outstanding` counts clock pulses whose cell has not yet ended. It tells which rising edge launched a bit, and
//! so how many more pulses the encoder needs.
//!
//! Ref: HEIDENHAIN PWM 20 user's manual, propagation delay compensation; TI motor-control SDK, `endat_main.asm`.

use crate::half_period::HalfPeriod;
use crate::reg::Reg;
use rust_hdl::prelude::*;

/// Sample strobes, start edge window and pulses in flight of one channel.
#[derive(LogicBlock)]
pub struct LineDelay {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Low between frames: forgets everything but the delay.
    pub run: Signal<In, Bit>,
    /// The clock waits: when all cells have ended, a new burst of pulses begins.
    pub drain: Signal<In, Bit>,
    /// This frame measures the delay instead of using it.
    pub acquire: Signal<In, Bit>,
    /// Strobe: the next sample comes half a period after this, which may be that of another clock.
    pub last_cell: Signal<In, Bit>,
    /// The start bit may come now.
    pub hunting: Signal<In, Bit>,
    /// Strobe one cycle before each rising clock edge.
    pub will_rise: Signal<In, Bit>,
    /// Strobe of each rising clock edge.
    pub rise: Signal<In, Bit>,
    /// Strobe: the data line has just gone high, or has changed within the answer.
    pub data_edge: Signal<In, Bit>,
    /// Strobe, together with `sample`: this sample is a good start bit, follow its edge.
    pub follow: Signal<In, Bit>,
    /// The clock goes on after the frame: the phase of the running cells follows, too.
    pub going_on: Signal<In, Bit>,
    /// EnDat clock period, in system clock cycles.
    pub period_cycles: Signal<In, Bits<11>>,
    /// Largest distance of the start edge from its expected place, in system clock cycles.
    pub start_window_cycles: Signal<In, Bits<6>>,
    /// Strobe: sample the data line.
    pub sample: Signal<Out, Bit>,
    /// Strobe: the middle of the expected place of a data edge.
    pub center: Signal<Out, Bit>,
    /// A rising data edge lies within the window of this cell.
    pub edge_in_window: Signal<Out, Bit>,
    /// Clock pulses sent whose cell has not ended.
    pub outstanding: Signal<Out, Bits<7>>,
    /// Tracked propagation delay tD including synchroniser and filter, in system clock cycles.
    pub delay_cycles: Signal<Out, Bits<11>>,
    half: HalfPeriod,
    delay: Reg<Bits<11>>,
    since_rise: Reg<Bits<11>>,
    timing_armed: Reg<Bit>,
    delay_over: Reg<Bit>,
    cells_run: Reg<Bit>,
    second_half: Reg<Bit>,
    sample_strobe: Reg<Bit>,
    center_strobe: Reg<Bit>,
    pulses: Reg<Bits<7>>,
    center_seen: Reg<Bit>,
    not_yet: Reg<Bit>,
    afresh: Reg<Bit>,
    follow_now: Reg<Bit>,
    edge_seen: Reg<Bit>,
    edge_late: Reg<Bit>,
    edge_error: Reg<Bits<6>>,
    edge_outside: Reg<Bit>,
    shorten: Reg<Bit>,
    lengthen: Reg<Bit>,
    first_rise: Signal<Local, Bit>,
    acquired: Signal<Local, Bit>,
    first_center: Signal<Local, Bit>,
    center_now: Signal<Local, Bit>,
    sample_now: Signal<Local, Bit>,
    step: Signal<Local, Bits<11>>,
    edge_now: Signal<Local, Bit>,
    over: Signal<Local, Bit>,
}

impl Default for LineDelay {
    fn default() -> Self {
        Self {
            clock: Default::default(),
            reset: Default::default(),
            run: Default::default(),
            drain: Default::default(),
            acquire: Default::default(),
            last_cell: Default::default(),
            hunting: Default::default(),
            will_rise: Default::default(),
            rise: Default::default(),
            data_edge: Default::default(),
            follow: Default::default(),
            going_on: Default::default(),
            period_cycles: Default::default(),
            start_window_cycles: Default::default(),
            sample: Default::default(),
            center: Default::default(),
            edge_in_window: Default::default(),
            outstanding: Default::default(),
            delay_cycles: Default::default(),
            half: Default::default(),
            delay: Default::default(),
            since_rise: Default::default(),
            timing_armed: Default::default(),
            delay_over: Default::default(),
            cells_run: Default::default(),
            second_half: Default::default(),
            sample_strobe: Default::default(),
            center_strobe: Default::default(),
            pulses: Default::default(),
            center_seen: Default::default(),
            not_yet: Default::default(),
            afresh: Default::default(),
            follow_now: Default::default(),
            edge_seen: Default::default(),
            edge_late: Default::default(),
            edge_error: Default::default(),
            edge_outside: Default::default(),
            shorten: Default::default(),
            lengthen: Default::default(),
            first_rise: Default::default(),
            acquired: Default::default(),
            first_center: Default::default(),
            center_now: Default::default(),
            sample_now: Default::default(),
            step: Default::default(),
            edge_now: Default::default(),
            over: Default::default(),
        }
    }
}

impl Logic for LineDelay {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self,
            clock,
            delay,
            since_rise,
            timing_armed,
            delay_over,
            cells_run,
            second_half,
            sample_strobe,
            center_strobe,
            pulses
        );
        dff_setup!(
            self,
            clock,
            center_seen,
            edge_seen,
            edge_late,
            edge_error,
            edge_outside,
            shorten,
            lengthen
        );
        clock!(self, clock, half);
        self.delay.reset.next = self.reset.val();
        self.since_rise.reset.next = self.reset.val();
        self.timing_armed.reset.next = self.reset.val();
        self.delay_over.reset.next = self.reset.val();
        self.cells_run.reset.next = self.reset.val();
        self.second_half.reset.next = self.reset.val();
        self.sample_strobe.reset.next = self.reset.val();
        self.center_strobe.reset.next = self.reset.val();
        self.pulses.reset.next = self.reset.val();
        self.center_seen.reset.next = self.reset.val();
        self.not_yet.reset.next = self.reset.val();
        self.follow_now.reset.next = self.reset.val();
        self.afresh.reset.next = self.reset.val();
        clock!(self, clock, afresh, not_yet, follow_now);
        self.edge_seen.reset.next = self.reset.val();
        self.edge_late.reset.next = self.reset.val();
        self.edge_error.reset.next = self.reset.val();
        self.edge_outside.reset.next = self.reset.val();
        self.half.reset.next = self.reset.val();
        self.shorten.reset.next = self.reset.val();
        self.lengthen.reset.next = self.reset.val();

        // tD from the first rising edge of a burst to the first cell; in an acquiring frame from every rising edge.
        self.first_rise.next = self.rise.val() & (self.acquire.val() | !self.timing_armed.q.val());
        self.since_rise.d.next = self.since_rise.q.val() + 1;
        if self.first_rise.val() {
            self.timing_armed.d.next = true;
            // The comparison with the tracked delay is registered, and what follows from it as well: it starts two cycles earlier.
            self.since_rise.d.next = 3.into();
            if self.acquire.val() {
                self.since_rise.d.next = 1.into();
            }
        }
        self.delay_over.d.next =
            self.timing_armed.q.val() & (self.since_rise.q.val() == self.delay.q.val());

        self.acquired.next = self.acquire.val()
            & self.hunting.val()
            & self.data_edge.val()
            & !self.cells_run.q.val();
        self.first_center.next = self.acquired.val()
            | (self.delay_over.q.val() & !self.cells_run.q.val() & !self.acquire.val());
        // The half period timer runs one cycle ahead: its ticks are registered before they are used.
        self.sample_strobe.d.next =
            self.half.tick.val() & !self.second_half.q.val() & self.cells_run.q.val();
        self.center_strobe.d.next = (self.half.tick.val() & self.second_half.q.val())
            | (self.first_center.val() & !self.acquired.val());
        self.sample_now.next = self.sample_strobe.q.val();
        self.center_now.next = self.acquired.val() | self.center_strobe.q.val();

        self.half.period_cycles.next = self.period_cycles.val();
        self.half.second.next = self.second_half.q.val();
        self.half.restart.next = !self.cells_run.q.val() | self.last_cell.val();
        self.half.began.next = self.acquired.val();
        if self.half.tick.val() & self.cells_run.q.val() {
            self.second_half.d.next = !self.second_half.q.val();
        }
        if self.first_center.val() {
            self.cells_run.d.next = true;
            self.second_half.d.next = false;
        }

        // Pulses whose cell has not ended. The edge that launched an acquired start bit is the only one.
        if self.will_rise.val() & !self.sample_now.val() {
            self.pulses.d.next = self.pulses.q.val() + 1;
        }
        if self.sample_now.val() & !self.will_rise.val() {
            self.pulses.d.next = self.pulses.q.val() - 1;
        }
        if self.acquire.val() & !self.cells_run.q.val() {
            self.pulses.d.next = 0.into();
        }
        if self.acquired.val() {
            self.pulses.d.next = 1.into();
        }

        // Distance between the data edge and the middle of its place. An edge that is first seen one cycle after the middle
        // is as good as one that is seen with it: the limits of the bit are as far from both.
        if self.center_now.val() {
            self.center_seen.d.next = true;
        }
        self.edge_now.next = self.edge_seen.q.val() | self.data_edge.val();
        if self.data_edge.val() {
            self.edge_seen.d.next = true;
            if !self.edge_seen.q.val() {
                self.edge_late.d.next = self.center_seen.q.val();
            }
        }
        if (self.center_seen.q.val() & !self.edge_now.val())
            | (self.edge_seen.q.val() & !self.center_seen.q.val())
        {
            self.edge_error.d.next = self.edge_error.q.val() + 1;
            if self.edge_error.q.val() == self.start_window_cycles.val() {
                self.edge_outside.d.next = true;
            }
        }
        self.follow_now.d.next = self.follow.val() & self.edge_error.q.val().any();
        self.half.shorten.next = self.shorten.q.val();
        self.half.lengthen.next = self.lengthen.q.val();
        if self.half.tick.val() {
            self.shorten.d.next = false;
            self.lengthen.d.next = false;
        }
        if self.follow_now.q.val() {
            self.delay.d.next = self.delay.q.val() + self.step.val();
            self.shorten.d.next = self.going_on.val() & !self.edge_late.q.val();
            self.lengthen.d.next = self.going_on.val() & self.edge_late.q.val();
        }
        self.step.next = 0x7FF.into();
        if self.edge_late.q.val() {
            self.step.next = 1.into();
        }
        if self.acquired.val() {
            self.delay.d.next = self.since_rise.q.val();
        }

        // All cells of a burst have ended: the next rising edge begins a new one.
        self.over.next = !self.run.val() | (self.drain.val() & !self.pulses.q.val().any());
        self.afresh.d.next = self.over.val();
        if self.afresh.q.val() {
            self.cells_run.d.next = false;
            self.second_half.d.next = false;
            self.timing_armed.d.next = false;
            self.delay_over.d.next = false;
            self.sample_strobe.d.next = false;
            self.center_strobe.d.next = false;
            self.pulses.d.next = 0.into();
        }
        self.not_yet.d.next = self.over.val() | (self.acquire.val() & !self.hunting.val());
        if self.sample_now.val() | self.not_yet.q.val() {
            self.center_seen.d.next = false;
            self.edge_seen.d.next = false;
            self.edge_error.d.next = 0.into();
            self.edge_outside.d.next = false;
        }
        self.sample.next = self.sample_now.val();
        self.center.next = self.center_now.val();
        self.edge_in_window.next = self.edge_now.val() & !self.edge_outside.q.val();
        self.outstanding.next = self.pulses.q.val();
        self.delay_cycles.next = self.delay.q.val();
    }
}
