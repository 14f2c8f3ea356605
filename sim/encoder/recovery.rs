//! The end of a frame: recovery time, a clock that stops or continues illegally, loss of supply.

use super::{
    Command, Defect, Drive, Encoder, ErrorSource, FrameEnd, LatchEdge, Output, State, Symbol,
    Violation,
};
use crate::{Time, US};

impl Encoder {
    /// The last rising edge of a frame.
    pub(super) fn complete(&mut self, time: Time) {
        let short = self.short_recovery() && self.work.command.is_some_and(Command::is_endat22);
        let tm = if short {
            self.work.tm_short
        } else {
            self.work.tm
        };
        self.log().end = FrameEnd::Complete;
        self.state = State::Recovery;
        self.recovery_end = Some(time + tm);
        if self.work.command == Some(Command::ReceiveReset) {
            self.restart(time);
            self.reset = Some((time, time + self.config.reset_time));
        }
    }

    pub(super) fn end_recovery(&mut self, time: Time) {
        self.recovery_end = None;
        self.log().data_fall = Some(time);
        self.state = State::Idle;
        self.ready_at = time + self.config.ready_low;
        self.emit(time, Drive::Low, Symbol::Idle);
        let high = self.work.defects.iter().find_map(|d| match d {
            Defect::HighWhenIdle(length) => Some(*length),
            _ => None,
        });
        if let Some(length) = high {
            self.emit(time + US, Drive::High, Symbol::Idle);
            self.emit(time + US + length, Drive::Low, Symbol::Idle);
            self.ready_at = time + US + length + self.config.ready_low;
        }
    }

    pub(super) fn fall_in_recovery(&mut self, time: Time, width: Time) {
        self.recovery_end = None;
        match self.next_latch() {
            Some(edge) => {
                self.check_high(time, width);
                match edge {
                    LatchEdge::InHigh => self.begin_continuous(time),
                    LatchEdge::AfterLow => self.state = State::Gap,
                }
            }
            None => self.overrun(time),
        }
    }

    fn overrun(&mut self, time: Time) {
        let f = self.log();
        f.end = FrameEnd::Overrun;
        let after = time - f.last_rise;
        let violation = if after < f.period {
            Violation::TooManyPulses {
                expected: f.rising_edges,
            }
        } else {
            Violation::EarlyRestart { after }
        };
        self.violate(time, violation);
        self.state = State::Deaf;
    }

    /// Longest time for which the clock may keep its level from now on.
    pub(super) fn patience(&self) -> Option<Time> {
        match self.state {
            State::Frame | State::Gap if !self.clock => Some(self.config.max_clock_low),
            State::Frame | State::Gap if self.in_continuous_mode() => Some(self.work.tm),
            State::Frame | State::Deaf if self.clock => Some(self.config.max_clock_high),
            _ => None,
        }
    }

    pub(super) fn clock_stopped(&mut self, time: Time) {
        if self.is_left() {
            let log = self.log();
            if log.end == FrameEnd::Running {
                log.end = FrameEnd::Stopped;
            }
            return self.back_to_idle(time);
        }
        match self.state {
            State::Frame | State::Gap => {
                let awaits_supplement = self.awaits_supplement();
                let low = !self.clock;
                let log = self.log();
                log.end = FrameEnd::Stopped;
                let seen = log.rising_edges;
                let violation = match log.expected_rising_edges() {
                    _ if low => Violation::ClockLowTooLong,
                    _ if awaits_supplement => Violation::NoSupplement { seen },
                    Some(expected) => Violation::TooFewPulses { seen, expected },
                    None => Violation::StoppedBeforeAnswer { seen },
                };
                self.violate(time, violation);
                if self.log().refused.is_none() {
                    self.refuse(ErrorSource::NotCompleted);
                }
                self.back_to_idle(time);
                if low {
                    self.state = State::Deaf;
                }
            }
            State::Deaf => self.back_to_idle(time),
            _ => {}
        }
    }

    fn back_to_idle(&mut self, time: Time) {
        self.state = State::Idle;
        self.ready_at = time + self.config.ready_low;
        self.emit(time, Drive::Low, Symbol::Idle);
    }

    /// Switches supply or plug off or on.
    pub(super) fn switch(&mut self, time: Time, on: bool) {
        self.pending.clear();
        self.recovery_end = None;
        self.watchdog = None;
        self.settle(time); // earlier writes are kept
        if let Some(f) = self.frames.last_mut() {
            if f.end == FrameEnd::Running {
                f.end = FrameEnd::Lost;
            }
        }
        self.work.defects.clear();
        self.restart(time);
        self.reset = None;
        if on {
            self.state = if self.clock { State::Idle } else { State::Deaf };
            self.ready_at = time + self.config.ready_low;
            self.output = Output {
                drive: Drive::Low,
                symbol: Symbol::Idle,
            };
        } else {
            self.state = State::Off;
            self.output = Output {
                drive: Drive::Released,
                symbol: Symbol::Absent,
            };
        }
    }
}
