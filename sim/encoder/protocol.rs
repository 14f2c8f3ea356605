//! What the encoder does from the first falling clock edge to the end of the recovery time.

use super::{Defect, Drive, Encoder, FrameEnd, FrameLog, State, Symbol, Violation, Work};
use crate::{
    frame::{AnswerBits, PositionAnswer},
    Time, US,
};

/// Edges of a frame, numbered as in the drawing of the parent module.
mod edge {
    /// The rising edges that take the first and the last bit of the mode command.
    pub const COMMAND: std::ops::RangeInclusive<u32> = 3..=8;
    /// The falling edge after which the encoder drives LOW: one period after the receiver's release.
    pub const DRIVE_LOW: u32 = 10;
    /// The earliest rising edge that can launch a start bit.
    pub const EARLIEST_START: u32 = 11;
    /// The rising edges between which the clock period is measured.
    pub const PERIOD: std::ops::RangeInclusive<u32> = 1..=10;
}

/// Slowest clock of the interface: 100 kHz.
const LONGEST_PERIOD: Time = 10 * US;
/// Part of the clock period by which a mean rate may miss its limit.
const RATE_TOLERANCE: f64 = 0.005;

/// What a known mode command asks for.
#[derive(Clone, Copy)]
pub(super) enum Request {
    /// A position, with F2 or without.
    Position { f2: bool },
}

fn decode(command: u8, endat22: bool) -> Option<Request> {
    match command {
        0b000_111 => Some(Request::Position { f2: false }),
        0b111_000 if endat22 => Some(Request::Position { f2: true }),
        _ => None,
    }
}

impl Encoder {
    pub(super) fn fall(&mut self, time: Time, width: Time) {
        match self.state {
            State::Idle => {
                if time < self.ready_at {
                    let after = self.frames.last().map_or(0, |f| time - f.last_rise);
                    self.violate(time, Violation::EarlyRestart { after });
                }
                self.begin(time);
            }
            State::Frame => {
                self.work.true_falls += 1;
                if self.has(|d| *d == Defect::MissEdge(self.work.true_falls)) {
                    self.work.missed = true;
                    return;
                }
                self.work.falls += 1;
                self.work.last_high = width;
                if self.work.nominal > 0 {
                    self.check_high(time, width);
                }
                if self.work.falls == edge::DRIVE_LOW && self.work.next_bit.is_none() {
                    self.launch(time, Drive::Low, Symbol::Lead);
                }
            }
            State::Recovery => {
                let f = self.frames.last_mut().expect("a frame came before");
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
                self.recovery_end = None;
                self.state = State::Deaf;
            }
            State::Deaf | State::Off => {}
        }
    }

    pub(super) fn rise(&mut self, time: Time, width: Time, data: Drive) {
        if self.state != State::Frame {
            return;
        }
        if std::mem::take(&mut self.work.missed) {
            return;
        }
        self.check_low(time, width);
        self.count_rise(time, data);
        let edge = self.log().rising_edges;
        if self.state == State::Frame && self.has(|d| *d == Defect::DoubleEdge(edge)) {
            self.work.falls += 1;
            self.count_rise(time, data);
        }
    }

    fn count_rise(&mut self, time: Time, data: Drive) {
        let log = self.frames.last_mut().expect("a frame is running");
        log.rising_edges += 1;
        log.last_rise = time;
        let edge = log.rising_edges;
        if edge == *edge::PERIOD.start() {
            log.first_rise = time;
        }
        if edge == *edge::PERIOD.end() {
            log.period = (time - log.first_rise) / Time::from(edge - edge::PERIOD.start());
            let period = log.period as f64;
            let shortest = 1e12 / self.config.max_clock_hz as f64;
            if period < shortest * (1.0 - RATE_TOLERANCE)
                || period > LONGEST_PERIOD as f64 * (1.0 + RATE_TOLERANCE)
            {
                let period = log.period;
                self.violate(time, Violation::ClockRate { period });
            }
        }
        if edge::COMMAND.contains(&edge) {
            self.take_command_bit(time, edge, data);
        }
        if let Some(bit) = self.work.next_bit {
            self.next_answer_bit(time, bit);
        } else if self.starts_at(time, edge) {
            self.start(time, edge);
        }
    }

    fn take_command_bit(&mut self, time: Time, edge: u32, data: Drive) {
        if data == Drive::Released {
            self.violate(time, Violation::CommandNotDriven { edge });
        }
        self.work.command = self.work.command << 1 | u8::from(data != Drive::Low);
        if edge == *edge::COMMAND.end() {
            let command = self.work.command;
            self.log().command = Some(command);
            self.work.request = decode(command, self.config.endat22);
            if self.work.request.is_none() {
                self.violate(time, Violation::UnknownCommand(command));
            }
        }
    }

    fn starts_at(&self, time: Time, edge: u32) -> bool {
        if self.work.request.is_none() || self.has(|d| *d == Defect::NoStartBit) {
            return false;
        }
        for defect in &self.work.defects {
            if let Defect::StartAtEdge(at) = defect {
                return edge >= *at;
            }
        }
        let first_fall = self.frames.last().map_or(0, |f| f.first_fall);
        edge >= edge::EARLIEST_START && time - first_fall >= self.work.tcal
    }

    fn start(&mut self, time: Time, edge: u32) {
        let Some(Request::Position { mut f2 }) = self.work.request else {
            return;
        };
        let mut position_bits = self.config.position_bits;
        let mut error = (false, true);
        for defect in &self.work.defects {
            match defect {
                Defect::WiderBy(n) => position_bits = position_bits.saturating_add_signed(*n),
                Defect::WithoutF2 => f2 = false,
                Defect::ErrorBits { f1, f2 } => error = (*f1, *f2),
                _ => {}
            }
        }
        let position = self.log().position;
        let answer = PositionAnswer {
            f1: error.0,
            f2: f2.then_some(error.1),
            position,
            position_bits,
        };
        let crc_xor = self.sum_defects(|d| match d {
            Defect::CrcXor(x) => u128::from(*x),
            _ => 0,
        });
        let mut bits = answer.bits_with_crc(answer.crc() ^ crc_xor as u8);
        let valid = (1u128 << bits.len) - 1;
        bits.word ^= valid
            & self.sum_defects(|d| match d {
                Defect::FlipBits(mask) => *mask,
                _ => 0,
            });
        let log = self.log();
        log.answer = bits;
        log.has_f2 = f2;
        log.position_bits = position_bits;
        log.start_edge = Some(edge);
        log.start_time = time;
        self.next_answer_bit(time, 0);
    }

    fn next_answer_bit(&mut self, time: Time, bit: u32) {
        let answer = self.log().answer;
        if bit < answer.len {
            self.launch(time, Drive::level(answer.get(bit)), Symbol::Bit(bit as u8));
            self.work.next_bit = Some(bit + 1);
        } else {
            self.launch(time, Drive::High, Symbol::Tail);
            self.log().end = FrameEnd::Complete;
            self.state = State::Recovery;
            self.recovery_end = Some(time + self.work.tm);
        }
    }

    fn begin(&mut self, time: Time) {
        let index = self.frames.len() as u64;
        let defects = self.config.defects_of(index);
        let mut tcal = self.config.tcal + self.rng.in_range(0, self.config.tcal_jitter);
        let mut tm = self
            .rng
            .in_range(*self.config.tm.start(), *self.config.tm.end());
        let position = self.config.position.at(index, time, &mut self.rng)
            & (u64::MAX >> (64 - self.config.position_bits));
        self.glitch_ends.clear();
        self.glitching = false;
        for defect in &defects {
            match defect {
                Defect::LateStart(more) => tcal += more,
                Defect::LateFall(more) => tm += more,
                Defect::Glitch { after, width } => {
                    self.glitch_ends.push_back((time + after, true));
                    self.glitch_ends.push_back((time + after + width, false));
                }
                Defect::BrownOut { after, length } => {
                    self.supply.push_back((time + after, false));
                    self.supply.push_back((time + after + length, true));
                }
                _ => {}
            }
        }
        self.supply.make_contiguous().sort_by_key(|s| s.0);
        self.glitch_ends.make_contiguous().sort_by_key(|g| g.0);
        self.frames.push(FrameLog {
            index,
            first_fall: time,
            first_rise: time,
            last_rise: time,
            rising_edges: 0,
            period: 0,
            command: None,
            position,
            start_edge: None,
            start_time: 0,
            answer: AnswerBits::default(),
            has_f2: false,
            position_bits: self.config.position_bits,
            data_fall: None,
            end: FrameEnd::Running,
        });
        self.work = Work {
            falls: 1,
            true_falls: 1,
            tcal,
            tm,
            defects,
            ..Work::default()
        };
        self.state = State::Frame;
        self.pending.clear();
        self.emit(
            time + self.config.release,
            Drive::Released,
            Symbol::Listening,
        );
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

    fn check_high(&mut self, time: Time, width: Time) {
        let (half, slack) = self.half_period();
        if width.abs_diff(half) > slack {
            let edge = self.log().rising_edges;
            self.violate(
                time,
                Violation::PulseWidth {
                    high: true,
                    width,
                    edge,
                },
            );
        }
    }

    /// A long LOW is a pause, which is allowed; a short one is not.
    fn check_low(&mut self, time: Time, width: Time) {
        let edge = self.log().rising_edges + 1;
        if edge == 2 {
            self.work.nominal = width + self.work.last_high;
            self.check_high(time, self.work.last_high);
        }
        let (half, slack) = self.half_period();
        if width + slack < half {
            self.violate(
                time,
                Violation::PulseWidth {
                    high: false,
                    width,
                    edge,
                },
            );
        }
    }

    /// Half a clock period and how far from it a phase may be; before the period is known, for the fastest clock.
    fn half_period(&self) -> (Time, Time) {
        let period = match self.work.nominal {
            0 => 1_000_000_000_000 / self.config.max_clock_hz,
            known => known,
        };
        (
            period / 2,
            (period as f64 * self.config.pulse_variation) as Time + 1,
        )
    }

    fn launch(&mut self, clock_edge: Time, drive: Drive, symbol: Symbol) {
        self.emit(clock_edge + self.config.clock_to_data, drive, symbol);
    }
}
