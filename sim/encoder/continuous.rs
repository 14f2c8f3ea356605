//! Continuous clock mode: the clock continues after an EnDat 2.1 position, and further positions follow without a mode command.

use super::{Command, Drive, Encoder, LatchEdge, Phase, State, Symbol};
use crate::Time;

impl Encoder {
    /// The edge at which this encoder would latch the next position, if the clock may continue now.
    pub(super) fn next_latch(&self) -> Option<LatchEdge> {
        let position = self.work.command == Some(Command::SendPosition);
        self.config.continuous.filter(|_| position)
    }

    pub(super) fn begin_continuous(&mut self, time: Time) {
        let nominal = self.work.nominal;
        let period = self.log().period;
        let command = self.log().command;
        self.new_frame(time);
        self.work.nominal = nominal;
        self.work.command = Some(Command::SendPosition);
        self.work.phase = Phase::Wait;
        self.work.ready = time + self.work.tcal;
        let log = self.log();
        log.continuous = true;
        log.period = period;
        log.command = command;
        self.state = State::Frame;
    }

    /// DATA must have been LOW for one cell before the start bit.
    pub(super) fn earliest_continuous_start(&self) -> u32 {
        match self.config.continuous {
            Some(LatchEdge::InHigh) => 2,
            _ => 1,
        }
    }

    /// The HIGH cell after an answer ends.
    pub(super) fn rise_in_gap(&mut self, time: Time, width: Time) {
        self.check_low(time, width);
        self.launch(time, Drive::Low, Symbol::Lead);
    }

    /// True if the clock has been HIGH long enough to end the mode.
    pub(super) fn is_left(&self) -> bool {
        self.clock && self.in_continuous_mode()
    }

    pub(super) fn in_continuous_mode(&self) -> bool {
        let frame = self.frames.last().is_some_and(|f| f.continuous);
        self.state == State::Gap || self.state == State::Frame && frame
    }
}
