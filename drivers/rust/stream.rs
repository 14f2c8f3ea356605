//! The stream of sample sets, read word by word from the card's buffer: over any bus.

use crate::card::Card;
use crate::error::Error;
use crate::frame::{crc16, CRC16_START};
use crate::link::Link;
use crate::map::{field, word};
use embedded_hal::delay::DelayNs;
use endat_regs::{causes, Part, Protocols, CHANNELS_MAX, WORD_BYTES};

/// Bytes before the samples, of a sample, of its additional data, and of the check sum.
const HEAD_BYTES: usize = 8;
const SAMPLE_BYTES: usize = 8;
const INFO_BYTES: usize = 8;
const CRC_BYTES: usize = 2;
/// Longest set, with its check sum.
pub const SET_BYTES: usize = HEAD_BYTES + (SAMPLE_BYTES + INFO_BYTES) * CHANNELS_MAX + CRC_BYTES;
/// Types of a set.
const TYPE_PLAIN: u8 = 1;
const TYPE_INFOS: u8 = 2;
const TYPE_RUN: u8 = 3;
/// Bits of a sample's status: those of the upper half of `result.status`, and two in unused places.
const STATUS_SHIFT: u32 = 16;
const TAKEN: u16 = 0x0020;
const MISSING: u16 = 0x8000;

/// Received part of a set.
#[derive(Clone, Debug)]
pub struct Stream {
    /// Encoded bytes; one more than the longest set, because COBS adds one byte.
    bytes: [u8; SET_BYTES + 1],
    /// Number of bytes.
    count: usize,
    /// Protocol of each channel.
    protocols: Protocols,
    /// Word read, not processed yet.
    word: u32,
    /// Bytes left in it.
    left: u32,
}

/// A channel's part of a set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sample {
    /// Position; from this trigger if fresh.
    pub position: u64,
    /// Primary cause, a number of [`causes::ALL`].
    pub cause: u8,
    /// The channel took this trigger.
    pub taken: bool,
    /// A good position is available.
    pub valid: bool,
    /// This trigger brought the position.
    pub fresh: bool,
    /// The set was closed before the channel's result.
    pub missing: bool,
}

/// Results of a trigger.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Set {
    /// A position of a running clock: one channel, and `sequence` is the number of its result.
    pub of_run: bool,
    /// Channel of the first sample.
    pub first: u8,
    /// Sets lost before this one; 255 = 255 or more.
    pub lost: u8,
    /// Low half of `trigger_count`.
    pub sequence: u16,
    /// System clock cycles at the trigger, wrapping.
    pub timestamp: u32,
    samples: [Sample; CHANNELS_MAX],
    count: u8,
}

impl Set {
    /// Samples of the channels from `first` on.
    pub fn samples(&self) -> &[Sample] {
        &self.samples[..usize::from(self.count)]
    }
}

impl Stream {
    fn new(protocols: Protocols) -> Self {
        Self {
            bytes: [0; SET_BYTES + 1],
            count: 0,
            protocols,
            word: 0,
            left: 0,
        }
    }

    /// Processes a byte; returns a set if it was the last byte.
    fn take(&mut self, byte: u8) -> Option<Result<Set, Damaged>> {
        if byte != 0 {
            let Some(place) = self.bytes.get_mut(self.count) else {
                self.count = 0;
                return Some(Err(Damaged));
            };
            *place = byte;
            self.count += 1;
            return None;
        }
        match core::mem::take(&mut self.count) {
            // Empty frame between two zeros.
            0 => None,
            count => set_of(&mut self.bytes[..count], self.protocols).transpose(),
        }
    }
}

/// A set with a wrong check sum or an invalid length.
struct Damaged;

/// Decodes COBS in place; returns the number of bytes.
fn decode(bytes: &mut [u8]) -> Option<usize> {
    let (mut from, mut to) = (0, 0);
    while from < bytes.len() {
        let code = usize::from(bytes[from]);
        let end = from + code;
        if code == 0 || end > bytes.len() {
            return None;
        }
        bytes.copy_within(from + 1..end, to);
        to += code - 1;
        from = end;
        if from < bytes.len() {
            bytes[to] = 0;
            to += 1;
        }
    }
    Some(to)
}

/// Little-endian number.
fn number(bytes: &[u8]) -> u64 {
    let with = |value: u64, byte: &u8| value << 8 | u64::from(*byte);
    bytes.iter().rev().fold(0, with)
}

/// The set in these bytes; `None` for types of later cards.
fn set_of(bytes: &mut [u8], protocols: Protocols) -> Result<Option<Set>, Damaged> {
    let length = decode(bytes).ok_or(Damaged)?;
    let bytes = &bytes[..length];
    let (body, crc) = bytes
        .split_at_checked(length.wrapping_sub(CRC_BYTES))
        .ok_or(Damaged)?;
    if crc != crc16(CRC16_START, body).to_le_bytes() {
        return Err(Damaged);
    }
    let (head, samples) = body.split_at_checked(HEAD_BYTES).ok_or(Damaged)?;
    let (kind, low) = (head[0] >> 4, head[0] & 0x0F);
    let (first, count, each) = match kind {
        TYPE_PLAIN => (0, low, SAMPLE_BYTES),
        TYPE_INFOS => (0, low, SAMPLE_BYTES + INFO_BYTES),
        TYPE_RUN => (low, 1, SAMPLE_BYTES),
        _ => return Ok(None),
    };
    let is_there = (1..=CHANNELS_MAX).contains(&count.into()) && usize::from(first) < CHANNELS_MAX;
    if !is_there || samples.len() != each * usize::from(count) {
        return Err(Damaged);
    }
    let mut set = Set {
        of_run: kind == TYPE_RUN,
        first,
        lost: head[1],
        sequence: number(&head[2..4]) as u16,
        timestamp: number(&head[4..]) as u32,
        samples: Default::default(),
        count,
    };
    let own = samples.chunks_exact(each);
    for (channel, (sample, own)) in (first..).zip(set.samples.iter_mut().zip(own)) {
        let status = number(&own[6..8]) as u16;
        let word = u32::from(status) << STATUS_SHIFT;
        *sample = Sample {
            position: number(&own[..6]),
            cause: causes::number(
                field!(RESULT.status.cause).of(word) as u8,
                protocols.of(channel.into()),
            ),
            taken: status & TAKEN != 0,
            valid: field!(RESULT.status.valid).of(word) != 0,
            fresh: field!(RESULT.status.fresh).of(word) != 0,
            missing: status & MISSING != 0,
        };
    }
    Ok(Some(set))
}

impl<L: Link, D: DelayNs> Card<L, D> {
    /// Empties the buffer, and sets whether triggers produce sets.
    pub fn start_stream(&mut self, collects: bool) -> Result<Stream, Error<L::Error>> {
        self.needs(Part::Stream)?;
        let control = word!(CARD.stream_control);
        self.write_checked(control, 0)?;
        let clear = field!(CARD.stream_clear.clear).mask();
        self.link.write(word!(CARD.stream_clear), clear)?;
        let collect = field!(CARD.stream_control.collect).mask();
        self.write_checked(control, if collects { collect } else { 0 })?;
        Ok(Stream::new(self.facts().protocols))
    }

    /// Reads the next set; `None` if none is available, [`Error::Set`] for a damaged one.
    pub fn next_set(&mut self, stream: &mut Stream) -> Result<Option<Set>, Error<L::Error>> {
        self.needs(Part::Stream)?;
        // At most the bytes of the longest set in a call, so that it returns even if the card writes faster than the host reads.
        for _ in 0..SET_BYTES {
            while stream.left > 0 {
                let [byte, ..] = stream.word.to_be_bytes();
                stream.word <<= 8;
                stream.left -= 1;
                match stream.take(byte) {
                    Some(Ok(set)) => return Ok(Some(set)),
                    Some(Err(Damaged)) => return Err(Error::Set),
                    None => {}
                }
            }
            let state = self.link.read(word!(CARD.stream_state))?;
            if field!(CARD.stream_state.bytes).of(state) == 0 {
                return Ok(None);
            }
            // Missing bytes read 0, which separates sets.
            stream.word = self.link.read(word!(CARD.stream_data))?;
            stream.left = WORD_BYTES;
        }
        Ok(None)
    }
}
