//! An encoder with its line.

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
    /// Drive of the receiver on DATA.
    pub receiver: Vec<(Time, Drive)>,
    /// Drive of the receiver as it arrives at the encoder.
    pub receiver_at_encoder: Vec<(Time, Drive)>,
    /// Drive of the encoder on DATA.
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

/// A line with its encoder. Between two system clock edges it advances independently, in picoseconds.
#[derive(Clone)]
pub struct Link {
    line: Line,
    encoder: Encoder,
    clock: bool,
    /// Next event time of the line and of the encoder.
    line_due: Time,
    encoder_due: Time,
    /// The encoder was changed from outside.
    is_changed: bool,
    trace: Option<LinkTrace>,
}

impl Link {
    /// An encoder on a line, both at rest.
    pub fn new(line: LineConfig, encoder: EncoderConfig) -> Self {
        let encoder = Encoder::new(encoder);
        let line = Line::new(line, encoder.output());
        Self {
            line_due: line.next_event(),
            encoder_due: encoder.next_event().unwrap_or(Time::MAX),
            line,
            encoder,
            clock: true,
            is_changed: false,
            trace: None,
        }
    }

    /// The line.
    pub fn line(&self) -> &Line {
        &self.line
    }

    /// The line, to drop old samples.
    pub fn line_mut(&mut self) -> &mut Line {
        &mut self.line
    }

    /// The line, to disturb it.
    pub fn disturb(&mut self, change: impl FnOnce(&mut Line)) {
        change(&mut self.line);
        self.line_due = self.line.next_event();
    }

    /// The encoder.
    pub fn encoder(&self) -> &Encoder {
        &self.encoder
    }

    /// The encoder, to disturb it.
    pub fn encoder_mut(&mut self) -> &mut Encoder {
        self.is_changed = true;
        &mut self.encoder
    }

    /// Keeps only the last `most` frames, violations and conflicts.
    pub fn keep(&mut self, most: usize) {
        self.encoder.keep(most);
        self.line.keep(most);
    }

    /// From now on every change is recorded.
    pub fn record(&mut self) {
        self.trace = Some(LinkTrace::default());
        self.note(0);
    }

    /// The recorded changes.
    pub fn trace(&self) -> Option<&LinkTrace> {
        self.trace.as_ref()
    }

    /// Time of the next event if the receiver does not change its pins.
    pub fn next_event(&self) -> Time {
        self.line_due.min(self.encoder_due)
    }

    /// Processes all events up to `time`.
    pub fn advance_to(&mut self, time: Time) {
        if std::mem::take(&mut self.is_changed) {
            self.ask_encoder(time);
        }
        loop {
            let next = self.next_event();
            if next > time {
                return;
            }
            if self.encoder_due <= self.line_due {
                self.encoder.advance(next);
                self.ask_encoder(next);
            } else if let Some(Arrival::Clock(level)) = self.line.advance(next) {
                let data = self.line.receiver_at_encoder();
                self.encoder.clock_edge(next, level, data);
                self.ask_encoder(next);
            }
            self.line_due = self.line.next_event();
            if self.trace.is_some() {
                self.note(next);
            }
        }
    }

    fn ask_encoder(&mut self, time: Time) {
        self.line.set_encoder(time, self.encoder.output());
        self.encoder_due = self.encoder.next_event().unwrap_or(Time::MAX);
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
        self.line_due = self.line.next_event();
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
