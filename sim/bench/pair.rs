//! Two designs at the two ends of a line: a receiver, and an encoder in hardware. Each has its own system clock.

use super::pins::{find, DataPins, Pins, TimeBase};
use super::record::ResultPorts;
use super::{edge_time, ChannelResult, PinNames};
use crate::{
    encoder::{Drive, Output, Symbol},
    line::{Conflict, Line, LineConfig},
    Time,
};
use rtl_design::engine::{Engine, PortId};

/// A design with its clock.
struct End<E> {
    engine: E,
    system_hz: u64,
    /// When its clock begins.
    begin: Time,
    cycle: u64,
    base: TimeBase,
}

impl<E: Engine> End<E> {
    fn new(engine: E, system_hz: u64, begin: Time) -> Self {
        Self {
            base: TimeBase::find(engine.ports()),
            engine,
            system_hz,
            begin,
            cycle: 0,
        }
    }

    /// The next edge of its clock.
    fn next_edge(&self) -> Time {
        self.begin + edge_time(self.cycle + 1, self.system_hz)
    }

    /// Drives the inputs that count time.
    fn drive_base(&mut self) {
        self.cycle += 1;
        self.base
            .drive(&mut self.engine, self.cycle, self.system_hz);
    }

    /// What the design does to DATA.
    fn drive(&mut self, pins: &DataPins) -> Drive {
        match self.engine.get(pins.data_oe) {
            0 => Drive::Released,
            _ => Drive::level(self.engine.get(pins.data_o) != 0),
        }
    }
}

/// The pins of an encoder.
struct EncoderPins {
    clock: PortId,
    data: DataPins,
}

/// A receiver (block `Channel`, or one with its ports) and an encoder (block `Encoder`), joined by a line.
pub struct Pair<R, E> {
    receiver: End<R>,
    encoder: End<E>,
    receiver_pins: Pins,
    encoder_pins: EncoderPins,
    line: Line,
    /// CLOCK as the receiver drives it.
    clock: bool,
    now: Time,
    triggers: bool,
    result_ports: ResultPorts,
    results: Vec<ChannelResult>,
}

impl<R: Engine, E: Engine> Pair<R, E> {
    /// Both with the frequencies of their clocks; that of the encoder begins `after`.
    ///
    /// # Panics
    /// If a design does not have the ports.
    pub fn new(receiver: (R, u64), encoder: (E, u64), after: Time, line: LineConfig) -> Self {
        let names = PinNames::channel();
        let receiver = End::new(receiver.0, receiver.1, 0);
        let encoder = End::new(encoder.0, encoder.1, after);
        let ports = encoder.engine.ports();
        let encoder_pins = EncoderPins {
            clock: find(ports, &names.clock).expect("an encoder has CLOCK"),
            data: DataPins::find(&names, ports),
        };
        let ports = receiver.engine.ports();
        let off = Output {
            drive: Drive::Released,
            symbol: Symbol::Absent,
        };
        Self {
            receiver_pins: Pins::find(&names, ports),
            result_ports: ResultPorts::find(ports).expect("a receiver has results"),
            line: Line::new(line, off),
            receiver,
            encoder,
            encoder_pins,
            clock: true,
            now: 0,
            triggers: false,
            results: vec![],
        }
    }

    /// Drives an input of the receiver, if it has one of this name.
    pub fn set_receiver(&mut self, name: &str, value: u128) {
        if let Some(port) = find(self.receiver.engine.ports(), name) {
            self.receiver.engine.set(port, value);
        }
    }

    /// Drives an input of the encoder.
    pub fn set_encoder(&mut self, name: &str, value: u128) {
        let port = self.encoder.engine.port(name);
        self.encoder.engine.set(port, value);
    }

    /// Reads a port of the receiver.
    pub fn receiver(&mut self, name: &str) -> u128 {
        let port = self.receiver.engine.port(name);
        self.receiver.engine.get(port)
    }

    /// Reads a port of the encoder.
    pub fn encoder(&mut self, name: &str) -> u128 {
        let port = self.encoder.engine.port(name);
        self.encoder.engine.get(port)
    }

    /// Raises the receiver's trigger for one cycle.
    pub fn trigger(&mut self) {
        self.triggers = true;
    }

    /// The results that the receiver delivered.
    pub fn results(&self) -> &[ChannelResult] {
        &self.results
    }

    /// Moments when DATA was driven from both ends.
    pub fn conflicts(&self) -> Vec<Conflict> {
        self.line.conflicts(self.now)
    }

    /// Runs for a span of time.
    pub fn run_for(&mut self, span: Time) {
        let end = self.now + span;
        while self.now < end {
            self.step();
        }
    }

    /// Runs until `done` says so; false if it has not within `span`.
    pub fn run_until_done(&mut self, span: Time, mut done: impl FnMut(&mut Self) -> bool) -> bool {
        let end = self.now + span;
        while !done(self) {
            if self.now >= end {
                return false;
            }
            self.step();
        }
        true
    }

    /// Up to the next clock edge of one of the designs.
    fn step(&mut self) {
        let (receiver, encoder) = (self.receiver.next_edge(), self.encoder.next_edge());
        self.now = receiver.min(encoder);
        while self.line.next_event() <= self.now {
            let next = self.line.next_event();
            self.line.advance(next);
        }
        // Inputs of both before outputs of one: edges at the same time do not see each other.
        let pins = &self.encoder_pins;
        let engine = &mut self.encoder.engine;
        engine.set(pins.clock, self.line.clock_at_encoder().into());
        engine.set(pins.data.data_i, self.line.data_at_encoder().into());
        if receiver == self.now {
            self.tick_receiver();
        }
        if encoder == self.now {
            self.encoder.drive_base();
            self.encoder.engine.tick();
            let drive = self.encoder.drive(&self.encoder_pins.data);
            let symbol = match drive {
                Drive::Released => Symbol::Listening,
                Drive::Low => Symbol::Idle,
                Drive::High => Symbol::Tail,
            };
            self.line.set_encoder(self.now, Output { drive, symbol });
        }
    }

    fn tick_receiver(&mut self) {
        let pins = self.receiver_pins.clone();
        self.receiver.drive_base();
        let data = self.line.data_at_receiver();
        self.receiver.engine.set(pins.data.data_i, data.into());
        if let Some(trigger) = self.receiver.base.trigger {
            let triggers = std::mem::take(&mut self.triggers);
            self.receiver.engine.set(trigger, triggers.into());
        }
        self.receiver.engine.tick();
        let clock = self.receiver.engine.get(pins.clock) != 0;
        if clock != self.clock {
            self.clock = clock;
            self.line.set_clock(self.now, clock);
        }
        let drive = self.receiver.drive(&pins.data);
        self.line.set_receiver(self.now, drive);
        let (engine, ports) = (&mut self.receiver.engine, &self.result_ports);
        if engine.get(ports.strobe()) != 0 {
            let result = ports.result(|id| engine.get(id), self.receiver.cycle, self.now);
            self.results.push(result);
        } else if let Some(last) = self.results.last_mut() {
            let cause = ports.cause(|id| engine.get(id));
            if cause != last.cause {
                last.late_cause = Some(cause);
            }
        }
        let now = self.now;
        self.line.forget_before(now);
    }
}

#[cfg(test)]
mod tests;
