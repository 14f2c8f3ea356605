//! An SSI encoder with its line.

use super::{Encoder, EncoderConfig, Violation};
use crate::bench::OtherEncoder;
use crate::{encoder::Drive, Time};
use endat_hdl::regs::Protocol;
use std::any::Any;
use std::collections::VecDeque;
use std::sync::Arc;

/// Position at a time.
pub type SsiMotion = Arc<dyn Fn(Time) -> u64 + Send + Sync>;

/// A line with its encoder; both directions have the same delay. Undriven DATA is HIGH.
pub struct SsiLink {
    encoder: Encoder,
    delay: Time,
    motion: Option<SsiMotion>,
    to_encoder: VecDeque<(Time, bool)>,
    to_receiver: VecDeque<(Time, bool)>,
    clock: bool,
    sent: bool,
    data: bool,
    is_open: bool,
}

impl SsiLink {
    /// An encoder with the line delay `delay`.
    pub fn new(config: EncoderConfig, delay: Time) -> Self {
        Self {
            encoder: Encoder::new(config),
            delay,
            motion: None,
            to_encoder: VecDeque::new(),
            to_receiver: VecDeque::new(),
            clock: true,
            sent: true,
            data: true,
            is_open: false,
        }
    }

    /// Sets the motion of the shaft; a position is latched at the first falling edge of a frame.
    pub fn set_motion(&mut self, motion: SsiMotion) {
        self.motion = Some(motion);
    }

    /// Unplugs the encoder.
    pub fn unplug(&mut self) {
        self.is_open = true;
    }

    /// Plugs it in again.
    pub fn plug(&mut self) {
        self.is_open = false;
    }

    /// The encoder.
    pub fn encoder(&self) -> &Encoder {
        &self.encoder
    }

    /// The encoder, to disturb it, or to move its shaft.
    pub fn encoder_mut(&mut self) -> &mut Encoder {
        &mut self.encoder
    }

    /// Puts the encoder's output on the line.
    fn listen(&mut self, time: Time) {
        let level = self.encoder.data();
        if level != self.sent {
            self.sent = level;
            self.to_receiver.push_back((time + self.delay, level));
        }
    }

    fn hear(&mut self, time: Time, level: bool) {
        self.encoder.advance(time);
        if let (false, true, Some(motion)) = (level, self.encoder.is_ready(), &self.motion) {
            let mask = (1u64 << self.encoder.config.position_bits) - 1;
            self.encoder.config.position = motion(time) & mask;
        }
        self.encoder.clock(time, level);
    }
}

impl OtherEncoder for SsiLink {
    fn protocol(&self) -> Protocol {
        Protocol::Ssi
    }

    fn set_receiver(&mut self, _: Time, drive: Drive) {
        if drive != Drive::Released {
            self.encoder.note(Violation::Conflict);
        }
    }

    fn set_clock(&mut self, time: Time, level: bool) {
        if level != self.clock {
            self.clock = level;
            self.to_encoder.push_back((time + self.delay, level));
        }
    }

    fn advance_to(&mut self, time: Time) -> bool {
        let at = |event: Option<Time>| event.unwrap_or(Time::MAX);
        // A change from outside takes effect at once.
        self.listen(time);
        loop {
            let heard = at(self.to_encoder.front().map(|(t, _)| *t));
            let acts = at(self.encoder.next_event());
            let arrives = at(self.to_receiver.front().map(|(t, _)| *t));
            let next = heard.min(acts).min(arrives);
            if next > time {
                return self.data || self.is_open;
            }
            if arrives == next {
                self.data = self.to_receiver.pop_front().is_none_or(|(_, level)| level);
                continue;
            }
            if heard == next {
                if let (Some((_, level)), false) = (self.to_encoder.pop_front(), self.is_open) {
                    self.hear(next, level);
                }
            } else {
                self.encoder.advance(next);
            }
            self.listen(next);
        }
    }

    fn trace(&self) -> &[(Time, bool)] {
        &[]
    }

    fn keep(&mut self, most: usize) {
        self.encoder.keep(most);
    }

    fn complaints(&self) -> Vec<String> {
        let violations = self.encoder.violations().iter();
        violations.map(ToString::to_string).collect()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }
}
