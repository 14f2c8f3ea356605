//! Transaction: the order of one frame, all its time-outs, and what went wrong.
//!
//! ```text
//! wire      NotReady Ready FirstLow Frame ................ Tail Recovery NotReady Ready
//! endat_clk ~~~~~~~~~~~~~~\________/~\_/~\_ ... _/~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~
//! data      \_____________? command    0 S F1 .. CRC ~~~~~~~~~~~~~~~\_________________
//! done      _______________________________________________/\_________________________
//! ```
//!
//! Nothing waits without a limit. Whatever ends a frame before its CRC follows the abort rule: clock HIGH, driver
//! off, 30 ms, then data low for longer than tR.
//!
//! Ref: HEIDENHAIN PWM 20 user's manual (times); ArtInChip ENDAT-IF, watchdog (abort rule).

pub mod cause;
mod new;

use crate::reg::Reg;
use rust_hdl::prelude::*;

/// What the wire is doing.
#[derive(Copy, Clone, PartialEq, Debug, LogicState)]
pub enum Phase {
    /// Idle, but data has not yet been low for tR.
    NotReady,
    /// Idle and ready for a trigger.
    Ready,
    /// First low phase, held for tST.
    FirstLow,
    /// Mode command, turnaround, waiting for the start bit, answer.
    Frame,
    /// The last CRC bit has been taken; the cell after it must be high.
    Tail,
    /// Clock and data high: recovery time tm.
    Recovery,
    /// Quiet after an aborted frame.
    Abort,
}

/// Sequence, time-outs and verdict of one channel.
#[derive(LogicBlock)]
pub struct Transaction {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// One-cycle strobe: take a position.
    pub trigger: Signal<In, Bit>,
    /// Strobe: measure the propagation delay again with the next frame.
    pub calibrate: Signal<In, Bit>,
    /// The data line.
    pub level: Signal<In, Bit>,
    /// Strobe: the data line is sampled.
    pub sample: Signal<In, Bit>,
    /// Strobe: middle of the expected place of a data edge.
    pub center: Signal<In, Bit>,
    /// The receiver waits for the start bit.
    pub hunting: Signal<In, Bit>,
    /// The start bit has been taken.
    pub started: Signal<In, Bit>,
    /// Strobe: a start bit outside its window.
    pub start_refused: Signal<In, Bit>,
    /// Strobe: the frame has been taken whole.
    pub frame_done: Signal<In, Bit>,
    /// Serial CRC verdict.
    pub serial_ok: Signal<In, Bit>,
    /// Parallel CRC verdict.
    pub parallel_ok: Signal<In, Bit>,
    /// Error bit 1, high = alarm.
    pub f1: Signal<In, Bit>,
    /// Error bit 2, low = alarm.
    pub f2: Signal<In, Bit>,
    /// Clock pulses whose cell has not ended.
    pub outstanding: Signal<In, Bits<6>>,
    /// Cells still to come.
    pub cells_left: Signal<In, Bits<7>>,
    /// How much longer than half a period the first low phase is; 0, or at least 4 cycles.
    pub first_low_extra_cycles: Signal<In, Bits<11>>,
    /// Longest wait for the start bit after the turnaround.
    pub start_timeout_us: Signal<In, Bits<12>>,
    /// Data must fall within this after the frame.
    pub recovery_limit_cycles: Signal<In, Bits<13>>,
    /// One-cycle strobe: the first falling clock edge comes at the end of this cycle.
    pub start: Signal<Out, Bit>,
    /// A frame is under way on the wire.
    pub run: Signal<Out, Bit>,
    /// Driver off, at once.
    pub abort: Signal<Out, Bit>,
    /// Keeps the clock low.
    pub hold_low: Signal<Out, Bit>,
    /// The clock waits for the cells of all pulses sent.
    pub drain: Signal<Out, Bit>,
    /// Keeps the clock high: no frame, or all its edges have been sent.
    pub stop: Signal<Out, Bit>,
    /// This frame measures the propagation delay.
    pub acquire: Signal<Out, Bit>,
    /// A trigger would not be taken.
    pub busy: Signal<Out, Bit>,
    /// Strobe: result of a trigger, `cause` and `flags` are valid.
    pub publish: Signal<Out, Bit>,
    /// With `publish`: the position is good.
    pub good: Signal<Out, Bit>,
    /// Strobe: data did not fall after a frame that has been published.
    pub late_fault: Signal<Out, Bit>,
    /// Primary cause, with `publish` or `late_fault`.
    pub cause: Signal<Out, Bits<4>>,
    /// Raw flags in the order of the cause codes: bit k stands for cause k + 1; bit 8 parallel CRC, bit 9 tail not high.
    pub flags: Signal<Out, Bits<10>>,
    /// Recovery time tm of the last frame, in system clock cycles.
    pub recovery_cycles: Signal<Out, Bits<13>>,
    ready_low_cycles: Constant<Bits<15>>,
    abort_us: Constant<Bits<15>>,
    phase: Reg<Phase>,
    timer: Reg<Bits<15>>,
    timer_limit: Reg<Bits<15>>,
    timer_hit: Reg<Bit>,
    timer_step: Reg<Bit>,
    hold: Reg<Bit>,
    start_now: Reg<Bit>,
    run_now: Reg<Bit>,
    extra: Reg<Bit>,
    stop_now: Reg<Bit>,
    calibrated: Reg<Bit>,
    acquiring: Reg<Bit>,
    overrun: Reg<Bit>,
    stalled: Reg<Bit>,
    all_sent: Reg<Bit>,
    tail_sampled: Reg<Bit>,
    recovery: Reg<Bits<13>>,
    seen: Reg<Bits<10>>,
    taken: Reg<Bit>,
    gave_up: Reg<Bit>,
    gave_up_late: Reg<Bit>,
    publish_now: Reg<Bit>,
    good_now: Reg<Bit>,
    late_now: Reg<Bit>,
    cause_now: Reg<Bits<4>>,
    flags_now: Reg<Bits<10>>,
    limit: Signal<Local, Bits<15>>,
    in_us: Signal<Local, Bit>,
    timer_clear: Signal<Local, Bit>,
    accept: Signal<Local, Bit>,
    give_up: Signal<Local, Bit>,
    idle: Signal<Local, Bit>,
    found: Signal<Local, Bits<10>>,
    told: Signal<Local, Bits<10>>,
    crc_bad: Signal<Local, Bit>,
    verdict: Signal<Local, Bit>,
    primary: Signal<Local, Bits<4>>,
    lost: Signal<Local, Bit>,
}

impl Logic for Transaction {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self,
            clock,
            phase,
            timer,
            timer_limit,
            timer_hit,
            timer_step,
            hold,
            start_now,
            run_now,
            extra,
            stop_now,
            calibrated,
            acquiring,
            overrun,
            stalled,
            all_sent
        );
        dff_setup!(
            self,
            clock,
            tail_sampled,
            recovery,
            seen,
            taken,
            gave_up,
            gave_up_late,
            publish_now,
            good_now,
            late_now,
            cause_now,
            flags_now
        );
        self.phase.reset.next = self.reset.val();
        self.timer.reset.next = self.reset.val();
        self.timer_step.reset.next = self.reset.val();
        self.timer_hit.reset.next = self.reset.val();
        self.timer_limit.reset.next = self.reset.val();
        self.stop_now.reset.next = self.reset.val();
        self.extra.reset.next = self.reset.val();
        self.extra.d.next = self.first_low_extra_cycles.val().any();
        self.run_now.reset.next = self.reset.val();
        self.start_now.reset.next = self.reset.val();
        self.hold.reset.next = self.reset.val();
        self.calibrated.reset.next = self.reset.val();
        self.acquiring.reset.next = self.reset.val();
        self.overrun.reset.next = self.reset.val();
        self.stalled.reset.next = self.reset.val();
        self.all_sent.reset.next = self.reset.val();
        self.tail_sampled.reset.next = self.reset.val();
        self.recovery.reset.next = self.reset.val();
        self.seen.reset.next = self.reset.val();
        self.taken.reset.next = self.reset.val();
        self.gave_up.reset.next = self.reset.val();
        self.gave_up_late.reset.next = self.reset.val();
        self.publish_now.reset.next = self.reset.val();
        self.good_now.reset.next = self.reset.val();
        self.late_now.reset.next = self.reset.val();
        self.cause_now.reset.next = self.reset.val();
        self.flags_now.reset.next = self.reset.val();

        self.limit.next = bit_cast::<15, 12>(self.start_timeout_us.val());
        self.in_us.next = false;
        self.timer_clear.next = false;
        self.accept.next = false;
        self.give_up.next = false;
        self.idle.next = false;
        self.verdict.next = false;
        self.found.next = 0.into();
        self.run_now.d.next = false;
        self.crc_bad.next = !(self.serial_ok.val() & self.parallel_ok.val());

        match self.phase.q.val() {
            Phase::NotReady => {
                self.limit.next = self.ready_low_cycles.val();
                self.timer_clear.next = self.level.val();
                self.idle.next = self.level.val();
                if self.timer_hit.q.val() {
                    self.phase.d.next = Phase::Ready;
                }
                if self.level.val() {
                    self.phase.d.next = Phase::NotReady;
                    if self.trigger.val() {
                        self.found.next = 1.into();
                        self.give_up.next = true;
                    }
                }
            }
            Phase::Ready => {
                self.timer_clear.next = true;
                self.idle.next = true;
                if self.level.val() {
                    self.phase.d.next = Phase::NotReady;
                    if self.trigger.val() {
                        self.found.next = 1.into();
                        self.give_up.next = true;
                    }
                } else {
                    if self.trigger.val() {
                        self.accept.next = true;
                        self.phase.d.next = Phase::Frame;
                        if self.extra.q.val() {
                            self.phase.d.next = Phase::FirstLow;
                        }
                    }
                }
            }
            Phase::FirstLow => {
                self.run_now.d.next = true;
                self.limit.next = bit_cast::<15, 11>(self.first_low_extra_cycles.val());
                if self.timer_hit.q.val() {
                    self.phase.d.next = Phase::Frame;
                    self.timer_clear.next = true;
                }
            }
            Phase::Frame => {
                self.run_now.d.next = true;
                self.in_us.next = true;
                self.timer_clear.next = !self.hunting.val();
                if self.timer_hit.q.val() & self.hunting.val() {
                    self.found.next = 2.into();
                    self.give_up.next = true;
                }
                if self.start_refused.val() {
                    self.found.next = 4.into();
                    self.give_up.next = true;
                }
                if self.frame_done.val() {
                    self.verdict.next = true;
                    self.phase.d.next = Phase::Tail;
                }
            }
            Phase::Tail => {
                self.run_now.d.next = true;
                self.timer_clear.next = true;
                if self.center.val() {
                    self.phase.d.next = Phase::Recovery;
                    // From here on the full clock's times again: a short tm ends before half a slow period does.
                    self.acquiring.d.next = false;
                }
            }
            Phase::Recovery => {
                self.run_now.d.next = !self.tail_sampled.q.val();
                self.limit.next = bit_cast::<15, 13>(self.recovery_limit_cycles.val());
                if self.sample.val() {
                    self.tail_sampled.d.next = true;
                }
                if self.tail_sampled.q.val() & !self.level.val() {
                    self.recovery.d.next = self.timer.q.val().get_bits::<13>(0);
                    self.timer_clear.next = true;
                    self.phase.d.next = Phase::NotReady;
                } else {
                    if self.timer_hit.q.val() {
                        self.found.next = 64.into();
                        self.give_up.next = true;
                    }
                }
                // The encoder still sends, or has stopped early: its frame has another length than ours.
                if self.sample.val() & !self.tail_sampled.q.val() & !self.level.val() {
                    self.found.next = 512.into();
                    self.give_up.next = true;
                }
            }
            Phase::Abort => {
                self.in_us.next = true;
                self.limit.next = self.abort_us.val();
                if self.timer_hit.q.val() {
                    self.phase.d.next = Phase::NotReady;
                    self.timer_clear.next = true;
                }
            }
            _ => {
                self.give_up.next = true;
            }
        }
        // Giving up takes effect one cycle later, which keeps the decision out of the longest paths.
        if self.gave_up.q.val() {
            self.phase.d.next = Phase::Abort;
            self.timer_clear.next = true;
            self.accept.next = false;
            self.calibrated.d.next = false;
        }

        self.timer_step.d.next = !self.in_us.val() | self.tick_us.val();
        if self.timer_step.q.val() {
            self.timer.d.next = self.timer.q.val() + 1;
        }
        self.timer_limit.d.next = self.limit.val();
        self.timer_hit.d.next = self.timer.q.val() == self.timer_limit.q.val();
        if self.timer_clear.val() {
            self.timer.d.next = 0.into();
            self.timer_hit.d.next = false;
        }
        // Cycles that pass before the timer sees the beginning of its span.
        if self.accept.val() {
            self.timer.d.next = 2.into();
        }
        if (self.phase.q.val() == Phase::Tail) & self.center.val() {
            self.timer.d.next = 1.into();
        }

        // Pulses: never more on the cable than the answer needs.
        self.all_sent.d.next = bit_cast::<7, 6>(self.outstanding.val()) == self.cells_left.val();
        if self.all_sent.q.val() & !self.started.val() {
            self.stalled.d.next = true;
        }
        if !self.outstanding.val().any() {
            self.stalled.d.next = false;
        }

        // What happened is registered, then told: the frame's bits stay where they are.
        self.seen.d.next = self.found.val();
        self.taken.d.next = self.verdict.val();
        self.gave_up.d.next = self.give_up.val() & !self.gave_up.q.val();
        self.gave_up_late.d.next =
            self.give_up.val() & !self.gave_up.q.val() & (self.phase.q.val() == Phase::Recovery);
        self.told.next = self.seen.q.val();
        self.good_now.d.next = false;
        if self.taken.q.val() {
            if self.crc_bad.val() {
                self.told.next = self.told.val() | 8;
            } else {
                self.calibrated.d.next = true;
                self.good_now.d.next = !self.f1.val() & self.f2.val();
            }
            if self.f1.val() {
                self.told.next = self.told.val() | 16;
            }
            if !self.f2.val() {
                self.told.next = self.told.val() | 32;
            }
            if !self.parallel_ok.val() {
                self.told.next = self.told.val() | 256;
            }
        }
        if self.overrun.q.val() {
            self.told.next = self.told.val() | 128;
        }
        self.publish_now.d.next =
            self.taken.q.val() | (self.gave_up.q.val() & !self.gave_up_late.q.val());
        self.late_now.d.next = self.gave_up_late.q.val();
        // One primary cause: CRC before F1 before F2, since error bits of a spoilt frame mean nothing.
        self.primary.next = 0.into();
        if self.told.val().get_bit(7) {
            self.primary.next = 8.into();
        }
        if self.told.val().get_bit(5) {
            self.primary.next = 6.into();
        }
        if self.told.val().get_bit(4) {
            self.primary.next = 5.into();
        }
        if self.told.val().get_bit(3) {
            self.primary.next = 4.into();
        }
        if self.told.val().get_bit(6) | self.told.val().get_bit(9) {
            self.primary.next = 7.into();
        }
        if self.told.val().get_bit(2) {
            self.primary.next = 3.into();
        }
        if self.told.val().get_bit(1) {
            self.primary.next = 2.into();
        }
        if self.told.val().get_bit(0) {
            self.primary.next = 1.into();
        }
        if self.taken.q.val() | self.gave_up.q.val() {
            self.flags_now.d.next = self.told.val();
            self.cause_now.d.next = self.primary.val();
            self.overrun.d.next = false;
        }
        self.lost.next = self.trigger.val() & !self.accept.val() & !self.idle.val();
        if self.lost.val() {
            self.overrun.d.next = true;
        }
        if self.accept.val() {
            self.acquiring.d.next = !self.calibrated.q.val();
            self.tail_sampled.d.next = false;
        }
        if self.calibrate.val() {
            self.calibrated.d.next = false;
        }
        self.run.next = self.run_now.q.val();
        self.start_now.d.next = self.accept.val();
        self.start.next = self.start_now.q.val();
        self.abort.next = self.gave_up.q.val();
        self.hold.d.next = (self.phase.q.val() == Phase::FirstLow) | self.stalled.q.val();
        self.hold_low.next = self.hold.q.val();
        self.drain.next = self.stalled.q.val();
        // Taking the start bit ends its cell; `started` comes when the comparison knows that.
        self.stop_now.d.next = (self.all_sent.q.val() & self.started.val()) | !self.run_now.q.val();
        self.stop.next = self.stop_now.q.val();
        self.acquire.next = self.acquiring.q.val();
        self.busy.next = !self.idle.val();
        self.publish.next = self.publish_now.q.val();
        self.good.next = self.good_now.q.val();
        self.late_fault.next = self.late_now.q.val();
        self.cause.next = self.cause_now.q.val();
        self.flags.next = self.flags_now.q.val();
        self.recovery_cycles.next = self.recovery.q.val();
    }
}
