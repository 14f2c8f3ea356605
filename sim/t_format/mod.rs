//! T-format encoder, written from the encoder's side of the interface.
//!
//! It works in picoseconds and only at edges: [`Encoder::receiver`] receives the receiver's drive,
//! [`Encoder::next_event`] returns the time of its next action, [`Encoder::advance`] executes it, [`Encoder::output`] is its
//! drive on the line. It is strict: every error of the receiver is noted as a [`Violation`]. It shares no code with the core.
//!
//! ```text
//! receiver ~~~~\__request__/~|                                        |~~
//! encoder                    |<- reply gap ->|\___reply fields___/~~~~|
//!                                                                     |<- rest ->
//! ```

mod config;
mod memory;
#[cfg(test)]
mod tests;
mod violation;
mod wire;

pub use config::{Defect, EncoderConfig};
pub use violation::Violation;
pub use wire::{edges, Wire};

use crate::{encoder::Drive, rng::Rng, Journal, Time};
use memory::Eeprom;
use std::collections::VecDeque;

/// Consecutive requests of a reset.
pub const RESET_REQUESTS: u32 = 10;
/// Error bit in the status field: parity of the request.
pub const COMPLAINT_PARITY: u8 = 1 << 6;
/// Error bit in the status field: delimiter of the request.
pub const COMPLAINT_DELIMITER: u8 = 1 << 7;

/// The received part of a request.
#[derive(Clone, Debug, Default)]
struct Hearing {
    /// Start of the field under way.
    start: Option<Time>,
    /// Its bits so far.
    bits: Vec<bool>,
    /// Fields before it.
    bytes: Vec<u8>,
    complaints: u8,
}

/// The encoder.
#[derive(Clone)]
pub struct Encoder {
    /// Configuration; may be changed between two exchanges.
    pub config: EncoderConfig,
    rng: Rng,
    now: Time,
    receiver: Drive,
    output: Drive,
    hearing: Hearing,
    /// Time when an unfinished request is dropped.
    give_up: Option<Time>,
    /// End of the time in which the driver must be on.
    drive_until: Option<Time>,
    planned: VecDeque<(Time, Drive)>,
    /// End of the last reply.
    ended: Option<Time>,
    resets: (u8, u32),
    /// Origin of its reported positions.
    zero: (u32, u32),
    eeprom: Eeprom,
    violations: Journal<Violation>,
    requests: Journal<Vec<u8>>,
    replies: Journal<Vec<u8>>,
}

impl Encoder {
    /// An encoder on an idle line.
    pub fn new(config: EncoderConfig) -> Self {
        Self {
            rng: Rng::new(config.seed),
            eeprom: Eeprom::new(config.eeprom_pages),
            config,
            now: 0,
            receiver: Drive::Released,
            output: Drive::Released,
            hearing: Hearing::default(),
            give_up: None,
            drive_until: None,
            planned: VecDeque::new(),
            ended: None,
            resets: (0, 0),
            zero: (0, 0),
            violations: Journal::default(),
            requests: Journal::default(),
            replies: Journal::default(),
        }
    }

    /// Drive on the line.
    pub fn output(&self) -> Drive {
        match self.config.defect {
            Defect::StuckLow => Drive::Low,
            _ => self.output,
        }
    }

    /// Keeps only the last `most` requests, replies and violations.
    pub fn keep(&mut self, most: usize) {
        self.violations.keep(most);
        self.requests.keep(most);
        self.replies.keep(most);
    }

    /// Number of whole requests.
    pub fn request_count(&self) -> u64 {
        self.requests.count()
    }

    /// Violations of the receiver.
    pub fn violations(&self) -> &[Violation] {
        &self.violations
    }

    /// Bytes of each whole request.
    pub fn requests(&self) -> &[Vec<u8>] {
        &self.requests
    }

    /// Bytes of each reply, before corruption.
    pub fn replies(&self) -> &[Vec<u8>] {
        &self.replies
    }

    /// A byte of the EEPROM.
    pub fn eeprom(&self, page: u8, address: u8) -> u8 {
        self.eeprom.byte(page, address)
    }

    /// Duration of a bit of the encoder.
    fn bit(&self) -> Time {
        self.config.wire().bit
    }

    /// Time of its next action.
    pub fn next_event(&self) -> Option<Time> {
        let sample = self.hearing.start.map(|start| {
            let bits = self.hearing.bits.len() as u64;
            start + self.bit() * bits + self.bit() / 2
        });
        let planned = self.planned.front().map(|(time, _)| *time);
        [sample, planned, self.give_up].into_iter().flatten().min()
    }

    /// Executes its actions up to `time`.
    pub fn advance(&mut self, time: Time) {
        while let Some(event) = self.next_event().filter(|event| *event <= time) {
            self.now = event;
            if self.give_up == Some(event) {
                self.violations.push(Violation::Incomplete);
                self.forget();
            } else if self.planned.front().is_some_and(|(at, _)| *at == event) {
                let (_, drive) = self.planned.pop_front().unwrap_or((0, Drive::Released));
                if self.receiver != Drive::Released && drive != Drive::Released {
                    self.note(Violation::Conflict);
                }
                self.output = drive;
                if self.planned.is_empty() {
                    self.ended = Some(event);
                }
            } else {
                self.sample();
            }
        }
        self.now = time;
    }

    /// The receiver drives the line from `time` on.
    pub fn receiver(&mut self, time: Time, drive: Drive) {
        self.advance(time);
        let before = self.receiver;
        self.receiver = drive;
        if before == drive {
            return;
        }
        if drive == Drive::Released {
            if self.drive_until.is_some_and(|until| time < until) {
                self.violations.push(Violation::ReleasedEarly);
            }
            return;
        }
        if self.output != Drive::Released {
            self.note(Violation::Conflict);
            return;
        }
        match self.hearing.start {
            Some(start) => {
                // Whole cells of the nominal rate, for any rate of the encoder.
                let cell = self.config.nominal_bit();
                let off = (time - start + cell / 2) % cell;
                if off.abs_diff(cell / 2) > cell / 16 {
                    self.note(Violation::BitWidth);
                }
            }
            None if drive == Drive::Low => {
                if !self.planned.is_empty() {
                    self.note(Violation::Impatient);
                    return;
                }
                let rest = self.config.rest;
                if self.hearing.bytes.is_empty() && self.ended.is_some_and(|e| time < e + rest) {
                    self.violations.push(Violation::TooEarly);
                }
                self.give_up = None;
                self.hearing.start = Some(time);
                let cell = self.config.nominal_bit();
                self.drive_until = Some(time + 10 * cell - cell / 16);
            }
            None => {}
        }
    }

    /// Notes a violation once instead of at each edge.
    fn note(&mut self, violation: Violation) {
        if self.violations.last() != Some(&violation) {
            self.violations.push(violation);
        }
    }

    fn forget(&mut self) {
        self.hearing = Hearing::default();
        self.give_up = None;
    }

    /// The middle of a bit of the request.
    fn sample(&mut self) {
        self.hearing.bits.push(self.receiver != Drive::Low);
        if self.hearing.bits.len() == 10 {
            let bits = std::mem::take(&mut self.hearing.bits);
            let start = self.hearing.start.take().unwrap_or(self.now);
            let byte = (0..8).fold(0, |byte, i| byte | u8::from(bits[i + 1]) << i);
            if !bits[9] {
                self.violations.push(Violation::Delimiter);
                self.hearing.complaints |= COMPLAINT_DELIMITER;
            }
            self.hearing.bytes.push(byte);
            self.field(start + 10 * self.config.nominal_bit());
        }
    }

    /// A field of the request has ended at `end`.
    fn field(&mut self, end: Time) {
        let control = self.hearing.bytes[0];
        let id = control >> 3 & 15;
        if self.hearing.bytes.len() == 1 {
            if control & 7 != 0b010 {
                self.violations.push(Violation::Sync);
                return self.forget();
            }
            if (control >> 3).count_ones() & 1 == 1 {
                self.violations.push(Violation::Parity);
                self.hearing.complaints |= COMPLAINT_PARITY;
            }
        }
        let fields = match id {
            0..=3 | 7 | 8 | 0xC => 1,
            6 => 4,
            0xD => 3,
            _ => {
                self.violations.push(Violation::UnknownId(id));
                return self.forget();
            }
        };
        if self.hearing.bytes.len() < fields {
            self.give_up = Some(end + 10 * self.bit());
            return;
        }
        let bytes = std::mem::take(&mut self.hearing.bytes);
        let complaints = self.hearing.complaints;
        self.forget();
        if fields > 1 && bytes.iter().fold(0, |sum, byte| sum ^ byte) != 0 {
            self.violations.push(Violation::Crc);
            return;
        }
        self.requests.push(bytes.clone());
        let reply = self.reply(id, &bytes, complaints, end);
        self.send(&reply, end + self.config.reply_gap);
    }

    /// Makes the reply.
    fn reply(&mut self, id: u8, request: &[u8], complaints: u8, end: Time) -> Vec<u8> {
        self.count_resets(id);
        let control = match self.config.defect {
            Defect::OtherId(id) => 0b010 | id << 3 | (id.count_ones() as u8 & 1) << 7,
            _ => request[0],
        };
        let config = &self.config;
        let (single, multi) = self.told();
        let single = &single.to_le_bytes()[..3];
        let multi = &multi.to_le_bytes()[..3];
        let mut status = config.status | complaints;
        if let Defect::Status(more) = config.defect {
            status |= more;
        }
        let mut bytes = match id {
            1 => [&[control, status], multi].concat(),
            2 => vec![control, status, config.encoder_id],
            3 => [
                &[control, status],
                single,
                &[config.encoder_id],
                multi,
                &[config.alarm],
            ]
            .concat(),
            6 | 0xD => {
                let written = (id == 6).then(|| request[2]);
                let (address, data) =
                    self.eeprom
                        .access(request[1], written, end, config.write_time);
                vec![control, address, data]
            }
            _ => [&[control, status], single].concat(),
        };
        bytes.push(bytes.iter().fold(0, |sum, byte| sum ^ byte));
        bytes
    }

    /// Reported single- and multi-turn position: relative to their reset.
    pub fn told(&self) -> (u32, u32) {
        let from = |place: u32, zero: u32| place.wrapping_sub(zero) & 0xFF_FFFF;
        let config = &self.config;
        (
            from(config.single_turn, self.zero.0),
            from(config.multi_turn, self.zero.1),
        )
    }

    fn count_resets(&mut self, id: u8) {
        self.resets = if self.resets.0 == id {
            (id, self.resets.1 + 1)
        } else {
            (id, 1)
        };
        if self.resets.1 != RESET_REQUESTS {
            return;
        }
        // The shaft does not move; this place becomes the origin.
        if id == 8 {
            self.zero.0 = self.config.single_turn;
        }
        if id == 0xC {
            self.zero.1 = self.config.multi_turn;
        }
        if id == 7 || id == 0xC {
            self.config.status &= 0x0F;
            self.config.alarm = 0;
        }
    }

    fn send(&mut self, bytes: &[u8], start: Time) {
        self.replies.push(bytes.to_vec());
        if matches!(self.config.defect, Defect::Silent) {
            return;
        }
        let wire = self.config.wire();
        let (changes, end) = wire::spoilt(bytes, &wire, &self.config.defect, start, &mut self.rng);
        let level = |(time, level)| (time, Drive::level(level));
        self.planned.extend(changes.into_iter().map(level));
        self.planned.push_back((end, Drive::Released));
    }
}
