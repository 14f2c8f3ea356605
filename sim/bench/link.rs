//! One encoder at the end of one line.

use crate::{
    encoder::{Drive, Encoder, EncoderConfig, Output},
    line::{Arrival, DataChange, Line, LineConfig},
    Time,
};

/// Everything that changed on a link, for waveforms and drawings.
#[derive(Clone, Debug, Default)]
pub struct LinkTrace {
    /// CLOCK at the receiver's pin.
    pub clock_at_receiver: Vec<(Time, bool)>,
    /// CLOCK at the encoder's pin.
    pub clock_at_encoder: Vec<(Time, bool)>,
    /// What the receiver does to DATA.
    pub receiver: Vec<(Time, Drive)>,
    /// The same as heard at the encoder.
    pub receiver_at_encoder: Vec<(Time, Drive)>,
    /// What the encoder does to DATA.
    pub encoder: Vec<(Time, Output)>,
    /// DATA at the receiver's pin.
    pub data_at_receiver: Vec<DataChange>,
    /// DATA at the encoder's pin.
    pub data_at_encoder: Vec<(Time, bool)>,
}

fn note<T: PartialEq>(track: &mut Vec<(Time, T)>, time: Time, value: T) {
    if track.last().is_none_or(|last| last.1 != value) {
        track.push((time, value));
    }
}

/// A line with its encoder. Between two system clock edges it runs by itself, in picoseconds.
pub struct Link {
    line: Line,
    encoder: Encoder,
    clock: bool,
    trace: Option<LinkTrace>,
}

impl Link {
    /// An encoder on a line, both at rest.
    pub fn new(line: LineConfig, encoder: EncoderConfig) -> Self {
        let encoder = Encoder::new(encoder);
        Self {
            line: Line::new(line, encoder.output()),
            encoder,
            clock: true,
            trace: None,
        }
    }

    /// The line.
    pub fn line(&self) -> &Line {
        &self.line
    }

    /// The line, to forget old samples.
    pub fn line_mut(&mut self) -> &mut Line {
        &mut self.line
    }

    /// The encoder.
    pub fn encoder(&self) -> &Encoder {
        &self.encoder
    }

    /// The encoder, to make something wrong with it.
    pub fn encoder_mut(&mut self) -> &mut Encoder {
        &mut self.encoder
    }

    /// From now on every change is kept.
    pub fn record(&mut self) {
        self.trace = Some(LinkTrace::default());
        self.note(0);
    }

    /// What was recorded.
    pub fn trace(&self) -> Option<&LinkTrace> {
        self.trace.as_ref()
    }

    /// Lets everything happen that is due by `time`.
    pub fn advance_to(&mut self, time: Time) {
        loop {
            let line = self.line.next_event().unwrap_or(Time::MAX);
            let encoder = self.encoder.next_event().unwrap_or(Time::MAX);
            let next = line.min(encoder);
            if next > time {
                return;
            }
            if encoder <= line {
                self.encoder.advance(next);
            } else if let Some(Arrival::Clock(level)) = self.line.advance(next) {
                let data = self.line.receiver_at_encoder();
                self.encoder.clock_edge(next, level, data);
            }
            self.line.set_encoder(next, self.encoder.output());
            if self.trace.is_some() {
                self.note(next);
            }
        }
    }

    /// The receiver's pins at `time`.
    pub fn set_pins(&mut self, time: Time, clock: bool, data: Drive) {
        if clock == self.clock && data == self.line.receiver() {
            return;
        }
        if clock != self.clock {
            self.clock = clock;
            self.line.set_clock(time, clock);
        }
        self.line.set_receiver(time, data);
        if self.trace.is_some() {
            self.note(time);
        }
    }

    /// DATA at the receiver's pin.
    pub fn data(&self) -> bool {
        self.line.data_at_receiver()
    }

    fn note(&mut self, time: Time) {
        let (line, Some(trace)) = (&self.line, self.trace.as_mut()) else {
            return;
        };
        note(&mut trace.clock_at_receiver, time, self.clock);
        note(&mut trace.clock_at_encoder, time, line.clock_at_encoder());
        note(&mut trace.receiver, time, line.receiver());
        let heard = line.receiver_at_encoder();
        note(&mut trace.receiver_at_encoder, time, heard);
        note(&mut trace.encoder, time, line.encoder());
        note(&mut trace.data_at_encoder, time, line.data_at_encoder());
        if let Some(change) = line.history().last() {
            if trace.data_at_receiver.last() != Some(change) {
                trace.data_at_receiver.push(*change);
            }
        }
    }
}
