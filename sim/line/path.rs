//! Edges in transit from one end of a path to the other.

use super::PathConfig;
use crate::{encoder::Drive, rng::Rng, Time, US};
use std::collections::VecDeque;

/// A value with a distinction between changes to LOW and to HIGH.
pub(super) trait Edge: Copy + PartialEq {
    fn falls(self) -> bool;
}

impl Edge for bool {
    fn falls(self) -> bool {
        !self
    }
}

impl Edge for Drive {
    fn falls(self) -> bool {
        self == Drive::Low
    }
}

impl Edge for crate::encoder::Output {
    fn falls(self) -> bool {
        self.drive.falls()
    }
}

/// A delay line. Edges keep their order; pulses that are too short vanish.
#[derive(Clone)]
pub(super) struct Path<T> {
    config: PathConfig,
    flight: Time,
    rng: Rng,
    underway: VecDeque<(Time, T)>,
    /// Time of the first arrival.
    next: Time,
    arrived: T,
}

impl<T: Edge> Path<T> {
    pub(super) fn new(config: PathConfig, flight: Time, seed: u64, at_rest: T) -> Self {
        Self {
            config,
            flight,
            rng: Rng::new(seed),
            underway: VecDeque::new(),
            next: Time::MAX,
            arrived: at_rest,
        }
    }

    /// From now on edges have this jitter.
    pub(super) fn set_jitter(&mut self, jitter: super::Jitter, seed: u64) {
        self.config.jitter = jitter;
        self.rng = Rng::new(seed);
    }

    /// A change enters at `time`.
    pub(super) fn send(&mut self, time: Time, value: T) {
        let mut delay = (self.flight + self.config.transceivers) as i64;
        if value.falls() {
            delay += self.config.fall_later;
        }
        delay += self.config.drift * (time / US) as i64;
        delay += match self.config.step {
            Some((from, step)) if from <= time => step,
            _ => 0,
        };
        delay += self.config.jitter.draw(&mut self.rng);
        let arrival = time.saturating_add_signed(delay.max(0));
        let earliest = |p: &(Time, T)| p.0 + self.config.shortest_pulse;
        if self.underway.back().is_some_and(|p| arrival < earliest(p)) {
            self.underway.pop_back();
        }
        let before = self.underway.back().map_or(self.arrived, |p| p.1);
        if before != value {
            self.underway.push_back((arrival, value));
        }
        self.next = self.underway.front().map_or(Time::MAX, |p| p.0);
    }

    /// Time of the next arrival; [`Time::MAX`] if there is none.
    pub(super) fn next(&self) -> Time {
        self.next
    }

    /// Applies a change that has arrived by `time`.
    pub(super) fn arrive(&mut self, time: Time) -> Option<T> {
        if self.next > time {
            return None;
        }
        self.arrived = self.underway.pop_front()?.1;
        self.next = self.underway.front().map_or(Time::MAX, |p| p.0);
        Some(self.arrived)
    }

    /// The value at the far end.
    pub(super) fn arrived(&self) -> T {
        self.arrived
    }
}
