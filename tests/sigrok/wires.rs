//! Frames of an encoder with a plain receiver, and the two wires as a logic analyser sees them.

use super::vcd;
use endat_sim::encoder::{Drive, Encoder, EncoderConfig, FrameEnd};
use endat_sim::{Time, NS, US};
use std::collections::VecDeque;

pub const POSITION_21: u8 = 0b000111;
pub const POSITION_22: u8 = 0b111000;
/// Selects additional data in a supplement.
pub const SELECT: u8 = 0b001001;

/// CLOCK is parked LOW for so much longer than half a period before a supplement.
const PARK: Time = 2 * US;
/// The first LOW from 1 MHz up.
const FIRST_LOW: Time = 2 * US;
/// No frame has more clock pulses.
const MOST: u32 = 1_000;
/// LOW bits of a supplement before its start bit, and pulses after its last bit.
const ZEROS: usize = 7;
const LAST_PULSES: usize = 2;

/// What the receiver sends.
#[derive(Clone, Copy)]
pub struct Frame {
    pub hz: u64,
    pub command: u8,
    /// Address and data of the supplement.
    pub fields: u32,
    /// Clock pulses after those that the encoder needs.
    pub surplus: u32,
    /// Clock pulses at most.
    pub most: u32,
    /// After so many pulses, again and again, CLOCK is HIGH for so much longer.
    pub pause: (u32, Time),
    /// From the last rising edge to the next frame; none: as soon as the encoder is ready.
    pub gap: Option<Time>,
}

impl Frame {
    pub fn new(hz: u64, command: u8) -> Self {
        Self {
            hz,
            command,
            fields: 0,
            surplus: 0,
            most: u32::MAX,
            pause: (u32::MAX, 0),
            gap: None,
        }
    }

    pub fn select(hz: u64, code: u8) -> Self {
        Self {
            fields: u32::from(code) << 16,
            ..Self::new(hz, SELECT)
        }
    }

    fn half(&self) -> Time {
        500_000_000_000 / self.hz
    }

    /// What the receiver does before this rising edge of the mode command.
    fn bit(&self, rise: u32) -> Drive {
        match rise {
            2 => Drive::Low,
            3..=8 => Drive::level(self.command >> (8 - rise) & 1 != 0),
            _ => Drive::Released,
        }
    }

    /// Bits of its supplement, zeros and start bit included.
    fn supplement(&self) -> Vec<Drive> {
        let fields = (0..24).rev().map(|i| self.fields >> i & 1 != 0);
        let bits = [false; ZEROS].into_iter().chain([true]).chain(fields);
        let bits = bits.map(Drive::level);
        bits.chain([Drive::Released; LAST_PULSES]).collect()
    }
}

fn is_whole(end: FrameEnd) -> bool {
    matches!(end, FrameEnd::Complete | FrameEnd::Overrun)
}

/// The wires of encoders, one after the other on the same probes.
pub struct Wires {
    pub encoder: Encoder,
    /// Positions of all whole frames.
    pub sent: Vec<u64>,
    now: Time,
    clock: Vec<(Time, bool)>,
    receiver: Vec<(Time, Drive)>,
    outputs: Vec<(Time, Drive)>,
}

impl Wires {
    pub fn of(config: EncoderConfig) -> Self {
        Self {
            encoder: Encoder::new(config),
            sent: vec![],
            now: 20 * US,
            clock: vec![(0, true)],
            receiver: vec![(0, Drive::Released)],
            outputs: vec![(0, Drive::Low)],
        }
    }

    /// Another encoder takes the place of this one.
    pub fn plug(&mut self, config: EncoderConfig) {
        self.encoder = Encoder::new(config);
    }

    pub fn now(&self) -> Time {
        self.now
    }

    fn wait(&mut self, span: Time) {
        let end = self.now + span;
        while let Some(time) = self.encoder.next_event().filter(|t| *t <= end) {
            self.encoder.advance(time);
            self.outputs.push((time, self.encoder.output().drive));
        }
        self.now = end;
    }

    fn edge(&mut self, level: bool, data: Drive) {
        self.clock.push((self.now, level));
        self.receiver.push((self.now, data));
        self.encoder.clock_edge(self.now, level, data);
        self.outputs.push((self.now, self.encoder.output().drive));
    }

    fn pulse(&mut self, data: Drive, low: Time) {
        self.edge(false, data);
        self.wait(low);
        self.edge(true, data);
    }

    /// Whether all of the answer has been launched but for the HIGH cell, and whether that has been, too. Surplus pulses are an overrun.
    fn progress(&self) -> (bool, bool) {
        let log = self.encoder.frames().last().expect("a frame");
        let launched = log.start_edge.map(|edge| log.rising_edges + 1 - edge);
        let is_answered = launched.is_some_and(|n| n == log.answer.len);
        (is_answered, is_whole(log.end))
    }

    pub fn frame(&mut self, frame: &Frame) {
        let half = frame.half();
        let first_low = if frame.hz < 1_000_000 {
            half
        } else {
            FIRST_LOW
        };
        let mut surplus = frame.surplus;
        for rise in 1..=frame.most.min(MOST) {
            self.pulse(frame.bit(rise), if rise == 1 { first_low } else { half });
            let (is_answered, is_complete) = self.progress();
            if is_complete && surplus == 0 || rise == frame.most.min(MOST) {
                break;
            }
            surplus -= u32::from(is_complete);
            self.wait(half);
            if is_answered && frame.command == SELECT {
                self.pulse(Drive::Released, half + PARK);
                for bit in frame.supplement() {
                    self.wait(half);
                    self.pulse(bit, half);
                }
                break;
            }
            if rise % frame.pause.0 == 0 {
                self.wait(frame.pause.1);
            }
        }
        match frame.gap {
            Some(gap) => self.wait(gap),
            None => {
                while !self.encoder.is_ready(self.now) {
                    self.wait(50 * NS);
                }
            }
        }
        let log = self.encoder.frames().last().expect("a frame");
        if is_whole(log.end) {
            self.sent.push(log.position);
        }
    }

    /// CLOCK and DATA from a time on, for an analyser at the encoder, or at the receiver, `flight` away.
    pub fn write(&self, name: &str, flight: Time, from: Time) -> std::path::PathBuf {
        let early = |t: Time| t.saturating_sub(flight);
        let mut events: VecDeque<(Time, usize, Drive)> = VecDeque::new();
        events.extend((self.clock.iter()).map(|(t, level)| (early(*t), 0, Drive::level(*level))));
        events.extend(
            self.receiver
                .iter()
                .map(|(t, drive)| (early(*t), 1, *drive)),
        );
        events.extend(
            self.outputs
                .iter()
                .map(|(t, drive)| (t + flight, 2, *drive)),
        );
        events.make_contiguous().sort_by_key(|event| event.0);
        let mut drives = [Drive::High, Drive::Released, Drive::Low];
        let mut rows: Vec<(Time, [bool; 2])> = vec![];
        for (time, who, drive) in events {
            drives[who] = drive;
            let data = match drives {
                [_, Drive::Released, encoder] => encoder,
                [_, receiver, _] => receiver,
            };
            let levels = [data != Drive::Low, drives[0] == Drive::High];
            let time = time.max(from) / NS;
            if rows.last().is_some_and(|row| row.0 == time) {
                rows.pop();
            }
            rows.push((time, levels));
        }
        vcd::write(name, &["data", "clk"], &rows, (self.now + flight) / NS)
    }
}
