//! One T-format encoder at the end of one line.

use super::pins::DataPins;
use crate::{
    encoder::Drive,
    t_format::{Encoder, EncoderConfig},
    Time,
};
use rtl_design::engine::Engine;
use std::collections::VecDeque;
use std::sync::Arc;

/// Single-turn and multi-turn position at a time.
pub type TFormatMotion = Arc<dyn Fn(Time) -> (u32, u32) + Send + Sync>;

/// A line with its encoder; each way takes the same time. It is HIGH while nobody drives it, and the receiver does not hear itself.
pub struct TFormatLink {
    encoder: Encoder,
    delay: Time,
    motion: Option<TFormatMotion>,
    to_encoder: VecDeque<(Time, Drive)>,
    to_receiver: VecDeque<(Time, bool)>,
    /// What the receiver does, at its pins.
    receiver: Drive,
    /// When the encoder heard the last change.
    heard: Option<Time>,
    /// What the encoder does, at its pins.
    sent: bool,
    data: bool,
    /// Nobody is plugged in.
    is_open: bool,
    /// What the receiver does, at the encoder's pins.
    arrived: Drive,
    /// The line at the encoder's pins, if it is kept: changes with their times.
    trace: Option<Vec<(Time, bool)>>,
}

impl TFormatLink {
    /// An encoder `delay` away.
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

    /// Its shaft moves like this; it latches with the start bit of a request.
    pub fn set_motion(&mut self, motion: TFormatMotion) {
        self.motion = Some(motion);
    }

    /// From now on every change of the line at the encoder is kept.
    pub fn record(&mut self) {
        self.trace = Some(vec![(0, true)]);
    }

    /// The line at the encoder's pins, HIGH where nobody drives it; empty unless it is recorded.
    pub fn trace(&self) -> &[(Time, bool)] {
        self.trace.as_deref().unwrap_or_default()
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

    /// Puts it in again.
    pub fn plug(&mut self) {
        self.is_open = false;
    }

    /// The encoder.
    pub fn encoder(&self) -> &Encoder {
        &self.encoder
    }

    /// The encoder, to make something wrong with it, or to move its shaft.
    pub fn encoder_mut(&mut self) -> &mut Encoder {
        &mut self.encoder
    }

    /// The receiver does this from `time` on.
    fn set_receiver(&mut self, time: Time, drive: Drive) {
        if drive != self.receiver {
            self.receiver = drive;
            self.to_encoder.push_back((time + self.delay, drive));
        }
    }

    /// Lets everything happen that is due by `time`; gives DATA at the receiver's pin.
    fn advance_to(&mut self, time: Time) -> bool {
        let at = |event: Option<Time>| event.unwrap_or(Time::MAX);
        // What was changed from outside acts at once.
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

    /// What the encoder does to the line goes on its way.
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

/// A link on the pins of a design.
pub(super) struct TFormatPort {
    pub(super) link: TFormatLink,
    pub(super) ids: DataPins,
    data: Option<bool>,
}

impl TFormatPort {
    pub(super) fn new(link: TFormatLink, ids: DataPins) -> Self {
        Self {
            link,
            ids,
            data: None,
        }
    }

    /// Lets everything happen up to now, and drives DATA into the design.
    pub(super) fn drive_data(&mut self, engine: &mut impl Engine, now: Time) {
        let data = self.link.advance_to(now);
        if self.data != Some(data) {
            self.data = Some(data);
            engine.set(self.ids.data_i, u128::from(data));
        }
    }

    /// Takes the design's pins to the line.
    pub(super) fn take_pins(&mut self, engine: &mut impl Engine, now: Time) {
        let drive = match engine.get(self.ids.data_oe) != 0 {
            true => Drive::level(engine.get(self.ids.data_o) != 0),
            false => Drive::Released,
        };
        self.link.set_receiver(now, drive);
    }
}
