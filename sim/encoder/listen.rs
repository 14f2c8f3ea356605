//! From the first falling clock edge to the last bit of the command.

use super::{
    clock_check::PERIOD_EDGES, Command, Defect, Drive, Encoder, ErrorSource, FrameLog, Phase,
    State, Symbol, Violation, Work,
};
use crate::{frame::Parameter, Time};

/// Edges of a frame, numbered as in the drawing of the parent module.
mod edge {
    /// The rising edges that sample the first and the last bit of the mode command.
    pub const COMMAND: std::ops::RangeInclusive<u32> = 3..=8;
    /// The rising edges that sample the first and the last bit of a parameter.
    pub const PARAMETER: std::ops::RangeInclusive<u32> = 9..=32;
    /// The falling edge after which the encoder drives LOW: one period after the receiver's release.
    pub const DRIVE_LOW: u32 = 10;
    /// The earliest rising edge that can launch a start bit.
    pub const EARLIEST_START: u32 = 11;
    /// Shift of all edges after a parameter.
    pub const PARAMETER_BITS: u32 = 24;
}

impl Encoder {
    pub(super) fn fall(&mut self, time: Time, width: Time) {
        match self.state {
            State::Idle => self.first_fall(time),
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
                self.fall_in_frame(time);
            }
            State::Gap => {
                self.check_high(time, width);
                self.begin_continuous(time);
            }
            State::Recovery => self.fall_in_recovery(time, width),
            State::Deaf | State::Off => {}
        }
    }

    fn first_fall(&mut self, time: Time) {
        if let Some((begin, end)) = self.reset.take() {
            if time < end {
                self.reset = Some((begin, end));
                let after = time - begin;
                self.violate(time, Violation::DuringReset { after });
                self.state = State::Deaf;
                return;
            }
        }
        if time < self.ready_at {
            let after = self.frames.last().map_or(0, |f| time - f.last_rise);
            self.violate(time, Violation::EarlyRestart { after });
        }
        self.begin(time);
    }

    fn fall_in_frame(&mut self, time: Time) {
        match self.work.phase {
            Phase::Listen | Phase::Wait if self.work.falls == self.later(edge::DRIVE_LOW) => {
                self.launch(time, Drive::Low, Symbol::Lead);
            }
            Phase::Answer(bit) => self.park(time, bit),
            Phase::Supplement => self.fall_in_supplement(time),
            _ => {}
        }
    }

    /// Converts an edge of a frame without parameter to this frame.
    fn later(&self, edge: u32) -> u32 {
        match self.work.command {
            Some(c) if c.has_parameter() => edge + edge::PARAMETER_BITS,
            _ => edge,
        }
    }

    pub(super) fn rise(&mut self, time: Time, width: Time, data: Drive) {
        if self.state == State::Gap {
            return self.rise_in_gap(time, width);
        }
        if self.state != State::Frame || std::mem::take(&mut self.work.missed) {
            return;
        }
        self.check_low(time, width);
        self.count_rise(time, width, data);
        let edge = self.log().rising_edges;
        if self.state == State::Frame && self.has(|d| *d == Defect::DoubleEdge(edge)) {
            self.work.falls += 1;
            self.count_rise(time, width, data);
        }
    }

    fn count_rise(&mut self, time: Time, width: Time, data: Drive) {
        let log = self.log();
        log.rising_edges += 1;
        log.last_rise = time;
        let edge = log.rising_edges;
        if edge == *PERIOD_EDGES.start() {
            log.first_rise = time;
        }
        if edge == *PERIOD_EDGES.end() {
            self.check_rate(time);
        }
        match self.work.phase {
            Phase::Listen => self.listen(time, edge, data),
            Phase::Wait => {
                if edge == 1 {
                    self.launch(time, Drive::Low, Symbol::Lead); // ends a HIGH cell in continuous mode
                }
            }
            Phase::Answer(bit) => self.next_answer_bit(time, bit),
            Phase::Park { release } => self.begin_supplement(time, width, release),
            Phase::Supplement => self.rise_in_supplement(time, edge, data),
        }
        if self.work.phase == Phase::Wait && self.starts_at(time, edge) {
            self.start(time, edge);
        }
    }

    fn listen(&mut self, time: Time, edge: u32, data: Drive) {
        if edge::COMMAND.contains(&edge) {
            self.shift_in(time, edge, data);
            if edge == *edge::COMMAND.end() {
                self.take_command(time);
            }
        } else if self.work.command.is_some() && edge::PARAMETER.contains(&edge) {
            self.shift_in(time, edge, data);
            if edge == *edge::PARAMETER.end() {
                self.take_parameter_bits(time);
            }
        }
    }

    /// Samples one bit from the receiver.
    pub(super) fn shift_in(&mut self, time: Time, edge: u32, data: Drive) {
        if data == Drive::Released {
            self.violate(time, Violation::CommandNotDriven { edge });
        }
        self.work.shift = self.work.shift << 1 | u64::from(data != Drive::Low);
    }

    fn take_command(&mut self, time: Time) {
        let code = self.work.shift as u8;
        self.log().command = Some(code);
        let command = Command::decode(code, self.config.endat22);
        self.work.command = command;
        match command {
            None => {
                self.violate(time, Violation::UnknownCommand(code));
                self.refuse(ErrorSource::ModeCommand);
            }
            Some(c) if c.has_parameter() => self.check_gap(time),
            Some(_) => {
                self.work.ready = self.log().first_fall + self.work.tcal;
                self.work.phase = Phase::Wait;
            }
        }
    }

    fn check_gap(&mut self, time: Time) {
        let now = self.frames.len() - 1;
        let before = self.frames[..now].iter().rfind(|f| f.parameter.is_some());
        let Some(before) = before else {
            return;
        };
        let after = self.frames[now].first_fall - before.last_rise;
        if after < self.config.parameter_gap {
            self.violate(time, Violation::ParameterGap { after });
        }
    }

    fn take_parameter_bits(&mut self, time: Time) {
        let Some(command) = self.work.command else {
            return;
        };
        let fields = Parameter::from_word(self.work.shift as u32);
        self.log().parameter = Some(fields);
        match self.take_parameter(time, command, fields) {
            Ok(reply) => {
                self.log().reply = Some(reply.fields);
                self.work.ready = reply.ready;
                self.work.phase = Phase::Wait;
            }
            // The response to a refused access is not published: no answer, as after an unknown command.
            Err(source) => self.refuse(source),
        }
    }

    fn starts_at(&self, time: Time, edge: u32) -> bool {
        if self.has(|d| *d == Defect::NoStartBit) {
            return false;
        }
        for defect in &self.work.defects {
            if let Defect::StartAtEdge(at) = defect {
                return edge >= *at;
            }
        }
        let continuous = self.frames.last().is_some_and(|f| f.continuous);
        let earliest = if continuous {
            self.earliest_continuous_start()
        } else {
            self.later(edge::EARLIEST_START)
        };
        edge >= earliest && time >= self.work.ready
    }

    fn begin(&mut self, time: Time) {
        self.new_frame(time);
        self.state = State::Frame;
        self.pending.clear();
        self.emit(
            time + self.config.release,
            Drive::Released,
            Symbol::Listening,
        );
    }

    /// Latches a position and draws the random values of its frame.
    pub(super) fn new_frame(&mut self, time: Time) {
        self.settle(time);
        let index = self.frames.count();
        let defects = self.config.defects_of(index);
        let mut tcal = self.config.tcal + self.rng.in_range(0, self.config.tcal_jitter);
        let short = self
            .config
            .tm_short
            .clone()
            .unwrap_or(self.config.tm.clone());
        // The same random number in both ranges: the selection must not affect later values.
        let mut tm_short = self.rng.clone().in_range(*short.start(), *short.end());
        let mut tm = self
            .rng
            .in_range(*self.config.tm.start(), *self.config.tm.end());
        let position = self.config.position.at(index, time, &mut self.rng);
        let shifted = position.wrapping_add_signed(self.memory.datum_shift().into());
        let position = shifted & (u64::MAX >> (64 - self.config.position_bits));
        self.glitch_ends.clear();
        self.glitching = false;
        for defect in &defects {
            match defect {
                Defect::LateStart(more) => tcal += more,
                Defect::LateFall(more) => {
                    tm += more;
                    tm_short += more;
                }
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
        let width = self.config.position_bits;
        self.frames
            .push(FrameLog::new(index, time, position, width));
        self.work = Work {
            falls: 1,
            true_falls: 1,
            tcal,
            tm,
            tm_short,
            defects,
            ..Work::default()
        };
    }
}
