//! A T-format encoder with its line.

use super::other::OtherEncoder;
use super::{Bench, PinNames};
use crate::{
    encoder::Drive,
    t_format::{Encoder, EncoderConfig},
    Time,
};
use endat_hdl::regs::Protocol;
use rtl_design::engine::Engine;
use std::any::Any;
use std::collections::VecDeque;
use std::sync::Arc;

/// Single-turn and multi-turn position at a time.
pub type TFormatMotion = Arc<dyn Fn(Time) -> (u32, u32) + Send + Sync>;

/// A line with its encoder; both directions have the same delay. The idle line is HIGH, and the receiver does not receive its own output.
pub struct TFormatLink {
    encoder: Encoder,
    delay: Time,
    motion: Option<TFormatMotion>,
    to_encoder: VecDeque<(Time, Drive)>,
    to_receiver: VecDeque<(Time, bool)>,
    /// Drive of the receiver, at its pins.
    receiver: Drive,
    /// Time of the last change at the encoder.
    heard: Option<Time>,
    /// Drive of the encoder, at its pins.
    sent: bool,
    data: bool,
    /// No encoder is connected.
    is_open: bool,
    /// Drive of the receiver, at the encoder's pins.
    arrived: Drive,
    /// The line at the encoder's pins, if recorded: changes with their times.
    trace: Option<Vec<(Time, bool)>>,
}

impl TFormatLink {
    /// An encoder with the line delay `delay`.
    pub fn new(config: EncoderConfig, delay: Time) -> Self {
        Self {
            encoder: Encoder::new(config),
            delay,
            motion: None,
            to_encoder: VecDeque::new(),
            to_receiver: VecDeque::new(),
            receiver: Drive::Released,
            heard: None,
            sent: true,
            data: true,
            is_open: false,
            arrived: Drive::Released,
            trace: None,
        }
    }

    /// Sets the motion of the shaft; the encoder latches with the start bit of a request.
    pub fn set_motion(&mut self, motion: TFormatMotion) {
        self.motion = Some(motion);
    }

    /// From now on every change of the line at the encoder is recorded.
    pub fn record(&mut self) {
        self.trace = Some(vec![(0, true)]);
    }

    fn note(&mut self, time: Time) {
        let level = self.arrived != Drive::Low && self.encoder.output() != Drive::Low;
        if let Some(trace) = &mut self.trace {
            if trace.last().is_none_or(|(_, last)| *last != level) {
                trace.push((time, level));
            }
        }
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
        let level = self.encoder.output() != Drive::Low;
        if level != self.sent {
            self.sent = level;
            self.to_receiver.push_back((time + self.delay, level));
        }
        self.note(time);
    }

    fn hear(&mut self, time: Time, drive: Drive) {
        // No request has a pause of two fields.
        let field = 10 * self.encoder.config.nominal_bit();
        let is_first = self.heard.is_none_or(|t| time > t + 2 * field);
        if drive == Drive::Low {
            if let (true, Some(motion)) = (is_first, &self.motion) {
                let (single_turn, multi_turn) = motion(time);
                self.encoder.config.single_turn = single_turn;
                self.encoder.config.multi_turn = multi_turn;
            }
            self.heard = Some(time);
        }
        self.arrived = drive;
        self.encoder.receiver(time, drive);
    }
}

impl OtherEncoder for TFormatLink {
    fn protocol(&self) -> Protocol {
        Protocol::TFormat
    }

    fn set_receiver(&mut self, time: Time, drive: Drive) {
        if drive != self.receiver {
            self.receiver = drive;
            self.to_encoder.push_back((time + self.delay, drive));
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
                if let Some((_, drive)) = self.to_encoder.pop_front() {
                    self.hear(next, drive);
                }
            } else {
                self.encoder.advance(next);
            }
            self.listen(next);
        }
    }

    fn trace(&self) -> &[(Time, bool)] {
        self.trace.as_deref().unwrap_or_default()
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

impl<E: Engine> Bench<E> {
    /// Adds a T-format encoder to a set of pins; returns its number among these.
    pub fn add_t_format(&mut self, names: &PinNames, link: TFormatLink) -> usize {
        let number = self.t_format_count();
        self.add_other(names, Box::new(link));
        number
    }

    /// T-format encoder `index`.
    ///
    /// # Panics
    /// If the bench has fewer of them.
    pub fn t_format(&self, index: usize) -> &TFormatLink {
        (self.others_as().nth(index)).expect("a T-format encoder of that number")
    }

    /// T-format encoder `index`, to disturb it.
    ///
    /// # Panics
    /// If the bench has fewer of them.
    pub fn t_format_mut(&mut self, index: usize) -> &mut TFormatLink {
        (self.others_as_mut().nth(index)).expect("a T-format encoder of that number")
    }

    /// Number of T-format encoders.
    pub fn t_format_count(&self) -> usize {
        self.others_as::<TFormatLink>().count()
    }
}
