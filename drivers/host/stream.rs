//! Decodes sample sets from the byte stream: COBS frames with a CRC-16, resynchronised after any garbage.

use crate::causes;
use crc::{Crc, CRC_16_IBM_3740};
use endat_driver::AdditionalData as Info;
use endat_regs::Protocol;
use std::mem;

/// Check sum of a frame.
const CHECK: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);
/// Type of a frame with a sample set, in bits 7..4 of its first byte.
const SAMPLE_SET: u8 = 1;
/// Type of a frame with a sample set and additional data.
const INFO_SET: u8 = 2;
/// A position of a running clock; bits 3..0 are its channel.
const RUN_SET: u8 = 3;
/// Bytes before the channels.
const HEAD_BYTES: usize = 8;
/// Bytes of a channel.
const CHANNEL_BYTES: usize = 8;
/// Bytes of its additional data.
const INFO_BYTES: usize = 8;
/// Most channels of a card.
const CHANNELS_MAX: usize = 8;
/// Bytes of the check sum.
const CHECK_BYTES: usize = 2;
/// Longest frame, COBS included; longer ones are garbage.
const ENCODED_MAX: usize =
    HEAD_BYTES + CHANNELS_MAX * (CHANNEL_BYTES + INFO_BYTES) + CHECK_BYTES + 1;

/// A channel's part of a sample set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sample {
    /// Last good position.
    pub position: u64,
    /// Code of the primary cause, of the channel's protocol; 0 = none.
    pub cause: u8,
    /// A good position is available.
    pub valid: bool,
    /// This trigger brought the position.
    pub fresh: bool,
    /// The channel took this trigger.
    pub taken: bool,
    /// The channel took this trigger, but the next trigger came before its result.
    pub missing: bool,
    /// Raw flags, as `result.status.line`.
    pub line: u8,
    /// Additional data 1 and 2 of the same frame, if sets have them.
    pub infos: Option<[Info; 2]>,
}

impl Sample {
    /// Position and status belong to an earlier trigger: the last one that the channel took, whose set has `missing`.
    pub fn is_late(&self) -> bool {
        (!self.taken || self.missing) && (self.valid || self.fresh || self.cause != 0)
    }

    fn status(&self) -> u16 {
        let flag = |is_set: bool, bit: u16| if is_set { bit } else { 0 };
        u16::from(self.cause) & status::CAUSE
            | flag(self.taken, status::TAKEN)
            | flag(self.valid, status::VALID)
            | flag(self.fresh, status::FRESH)
            | (u16::from(self.line) & status::LINE) << status::LINE_LSB
            | flag(self.missing, status::MISSING)
    }

    /// Name of the primary cause, on a channel with this protocol.
    pub fn cause_name(&self, protocol: Protocol) -> &'static str {
        causes::name(causes::of_code(self.cause, protocol))
    }
}

/// Results of one trigger, or one position of a running clock.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SampleSet {
    /// The channel whose running clock brought the only sample, without a trigger.
    pub run: Option<usize>,
    /// Sample sets that the card dropped just before this one; 255 = that many or more.
    pub lost: u8,
    /// Number of the trigger, wrapping; for a running clock of the channel's result.
    pub sequence: u16,
    /// System clock cycle of the trigger, wrapping; for a running clock of the position.
    pub timestamp: u32,
    /// One for each channel.
    pub channels: Vec<Sample>,
}

/// Fields of a sample's status: the upper half of the word `result.status` and two more bits.
mod status {
    /// Primary cause.
    pub const CAUSE: u16 = 0x1F;
    /// The channel took this trigger.
    pub const TAKEN: u16 = 1 << 5;
    /// A good position is available.
    pub const VALID: u16 = 1 << 6;
    /// This trigger brought the position.
    pub const FRESH: u16 = 1 << 7;
    /// Raw flags of the line.
    pub const LINE_LSB: u32 = 8;
    /// Flags of the line.
    pub const LINE: u16 = 0x7F;
    /// The set was closed before the channel's result.
    pub const MISSING: u16 = 1 << 15;
}

/// The additional data of a channel from their bytes.
fn infos(bytes: &[u8]) -> [Info; 2] {
    [0, 1].map(|n: usize| {
        let word = u32::from_le_bytes([bytes[3 * n], bytes[3 * n + 1], bytes[3 * n + 2], 0]);
        let state = bytes[6] >> (2 * n);
        Info::new(word, state & 1 != 0, state & 2 != 0, bytes[6] & 0x10 != 0)
    })
}

impl SampleSet {
    /// A frame without COBS; `None` if it is not a sample set, or damaged.
    fn new(frame: &[u8]) -> Option<Self> {
        let (body, check) = frame.split_at_checked(frame.len().checked_sub(CHECK_BYTES)?)?;
        let (kind, low) = (body.first()? >> 4, usize::from(body[0] & 0xF));
        let (channels, of_each) = match kind {
            SAMPLE_SET => (low, CHANNEL_BYTES),
            INFO_SET => (low, CHANNEL_BYTES + INFO_BYTES),
            RUN_SET if low < CHANNELS_MAX => (1, CHANNEL_BYTES),
            _ => return None,
        };
        let is_whole = (1..=CHANNELS_MAX).contains(&channels)
            && body.len() == HEAD_BYTES + of_each * channels
            && check == CHECK.checksum(body).to_le_bytes();
        if !is_whole {
            return None;
        }
        let sample = |bytes: &[u8]| {
            let mut word = [0; 8];
            word[..6].copy_from_slice(&bytes[..6]);
            let status = u16::from_le_bytes([bytes[6], bytes[7]]);
            Sample {
                position: u64::from_le_bytes(word),
                cause: (status & status::CAUSE) as u8,
                valid: status & status::VALID != 0,
                fresh: status & status::FRESH != 0,
                taken: status & status::TAKEN != 0,
                missing: status & status::MISSING != 0,
                line: (status >> status::LINE_LSB & status::LINE) as u8,
                infos: bytes
                    .get(CHANNEL_BYTES..CHANNEL_BYTES + INFO_BYTES)
                    .map(infos),
            }
        };
        Some(Self {
            run: (kind == RUN_SET).then_some(low),
            lost: body[1],
            sequence: u16::from_le_bytes([body[2], body[3]]),
            timestamp: u32::from_le_bytes([body[4], body[5], body[6], body[7]]),
            channels: body[HEAD_BYTES..]
                .chunks_exact(of_each)
                .map(sample)
                .collect(),
        })
    }

    /// The frame as a card sends it: type 1, or 2 with additional data, or 3 for a running clock.
    pub fn to_frame(&self) -> Vec<u8> {
        let has_infos = self.channels.iter().any(|c| c.infos.is_some());
        let (kind, low) = match (self.run, has_infos) {
            (Some(channel), _) => (RUN_SET, channel),
            (None, true) => (INFO_SET, self.channels.len()),
            (None, false) => (SAMPLE_SET, self.channels.len()),
        };
        let mut body = vec![kind << 4 | low as u8, self.lost];
        body.extend(self.sequence.to_le_bytes());
        body.extend(self.timestamp.to_le_bytes());
        for sample in &self.channels {
            body.extend(&sample.position.to_le_bytes()[..6]);
            body.extend(sample.status().to_le_bytes());
            if let (Some(infos), None) = (sample.infos, self.run) {
                let mut state = u8::from(infos[0].due) << 4;
                for (n, info) in infos.iter().enumerate() {
                    body.extend(info.content.to_le_bytes());
                    body.push(info.status);
                    state |= (u8::from(info.came) | u8::from(info.good) << 1) << (2 * n);
                }
                body.extend([state, 0]);
            }
        }
        body.extend(CHECK.checksum(&body).to_le_bytes());
        let mut frame = cobs::encode_vec(&body);
        frame.push(0);
        frame
    }
}

/// Counters of a stream.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Sample sets.
    pub sets: u64,
    /// Sample sets that the card dropped, according to the card.
    pub lost_in_card: u64,
    /// Frames that were damaged on the way.
    pub damaged: u64,
    /// Triggers without a sample set, for any reason.
    pub missing: u64,
}

/// Finds sample sets in received bytes.
#[derive(Clone, Debug, Default)]
pub struct Decoder {
    frame: Vec<u8>,
    is_too_long: bool,
    /// Clear if earlier bytes are unknown: the first frame may be incomplete.
    is_settled: bool,
    last_sequence: Option<u16>,
    counts: Counts,
    sets: Vec<SampleSet>,
}

impl Decoder {
    /// Processes a byte.
    pub fn push(&mut self, byte: u8) {
        if byte != 0 {
            if self.frame.len() < ENCODED_MAX {
                self.frame.push(byte);
            } else {
                self.is_too_long = true;
            }
            return;
        }
        let frame = mem::take(&mut self.frame);
        let is_too_long = mem::take(&mut self.is_too_long);
        let was_settled = mem::replace(&mut self.is_settled, true);
        if frame.is_empty() && !is_too_long {
            return;
        }
        let set = (!is_too_long)
            .then(|| cobs::decode_vec(&frame).ok())
            .flatten()
            .and_then(|frame| SampleSet::new(&frame));
        match set {
            Some(set) => self.note(set),
            None if was_settled => self.counts.damaged += 1,
            None => {}
        }
    }

    fn note(&mut self, set: SampleSet) {
        self.counts.sets += 1;
        self.counts.lost_in_card += u64::from(set.lost);
        if set.run.is_some() {
            self.sets.push(set);
            return;
        }
        if let Some(last) = self.last_sequence {
            self.counts.missing += u64::from(set.sequence.wrapping_sub(last).wrapping_sub(1));
        }
        self.last_sequence = Some(set.sequence);
        self.sets.push(set);
    }

    /// Removes and returns the received sets.
    pub fn take(&mut self) -> Vec<SampleSet> {
        mem::take(&mut self.sets)
    }

    /// Number of damaged frames so far.
    pub fn damaged(&self) -> u64 {
        self.counts.damaged
    }

    /// Discounts bytes that were not frames: `damaged` frames were damaged before them.
    pub(crate) fn forgive(&mut self, damaged: u64) {
        self.counts.damaged = damaged;
    }

    /// Drops the frame under way, the queued sets and the last sequence number: another stream begins.
    pub fn forget(&mut self) {
        self.frame.clear();
        self.sets.clear();
        self.is_too_long = false;
        self.is_settled = false;
        self.last_sequence = None;
    }

    /// Counters.
    pub fn counts(&self) -> Counts {
        self.counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The example of the stream page.
    const FRAME: &str =
        "02 12 06 34 12 EF CD AB 05 67 45 23 01 01 02 E0 01 01 01 01 01 01 05 20 80 1D D6 00";

    fn bytes(hex: &str) -> Vec<u8> {
        hex.split(' ')
            .map(|b| u8::from_str_radix(b, 16).unwrap())
            .collect()
    }

    fn decode(bytes: &[u8]) -> (Vec<SampleSet>, Counts) {
        let mut decoder = Decoder::default();
        bytes.iter().for_each(|b| decoder.push(*b));
        (decoder.take(), decoder.counts())
    }

    fn set(sequence: u16) -> SampleSet {
        let channel = |n: u64| Sample {
            position: u64::from(sequence) * 1_000_003 % (1 << 29) + n,
            fresh: true,
            valid: true,
            taken: true,
            ..Sample::default()
        };
        SampleSet {
            sequence,
            timestamp: u32::from(sequence).wrapping_mul(10_000),
            channels: vec![channel(0), channel(1)],
            ..SampleSet::default()
        }
    }

    #[test]
    fn the_example_of_the_page() {
        assert!(include_str!("../../docs/stream.md").contains(FRAME));
        let (sets, counts) = decode(&bytes(FRAME));
        let whole = Sample {
            position: 0x0123_4567,
            valid: true,
            fresh: true,
            taken: true,
            ..Sample::default()
        };
        let missing = Sample {
            taken: true,
            missing: true,
            ..Sample::default()
        };
        let expected = SampleSet {
            run: None,
            lost: 0,
            sequence: 0x1234,
            timestamp: 0x00AB_CDEF,
            channels: vec![whole, missing],
        };
        assert_eq!(sets, std::slice::from_ref(&expected));
        assert_eq!((counts.sets, counts.damaged), (1, 0));
        assert_eq!(expected.to_frame(), bytes(FRAME));
    }

    /// Damage in one place loses at most two frames.
    #[test]
    fn after_loss_insertion_and_corruption_it_is_there_again() {
        let frames: Vec<Vec<u8>> = (0..6).map(|n| set(n).to_frame()).collect();
        let stream: Vec<u8> = frames.concat();
        let all: Vec<SampleSet> = (0..6).map(set).collect();
        for place in 0..stream.len() {
            for change in 0..4 {
                let mut damaged = stream.clone();
                match change {
                    0 => drop(damaged.remove(place)),
                    1 => damaged.insert(place, 0x00),
                    2 => damaged.insert(place, 0x5A),
                    _ => damaged[place] ^= 0x10,
                }
                let (sets, counts) = decode(&damaged);
                assert!(sets.iter().all(|s| all.contains(s)), "{place}: a wrong set");
                assert!(sets.len() >= 4, "{place}, {change}: {} sets", sets.len());
                let seen = counts.sets + counts.missing;
                let ends = u64::from(!sets.contains(&all[5])) + u64::from(!sets.contains(&all[0]));
                assert!(seen + ends >= 5, "{place}, {change}: {counts:?}");
            }
        }
    }

    #[test]
    fn ten_megabytes_of_garbage_are_no_sample_and_do_not_stop_it() {
        let mut state = 0x1234_5678_9ABC_DEF1u64;
        let mut decoder = Decoder::default();
        for _ in 0..10_000_000 {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            decoder.push(state as u8);
        }
        // 40 000 frames end in it; each has to get past type, length and CRC-16.
        assert!(decoder.take().len() <= 1, "garbage was taken for samples");
        assert!(decoder.frame.len() <= ENCODED_MAX);
        decoder.push(0);
        set(3).to_frame().iter().for_each(|b| decoder.push(*b));
        assert_eq!(decoder.take(), [set(3)]);
    }

    #[test]
    fn what_the_card_dropped_and_what_the_line_dropped_are_counted_apart() {
        let mut late = set(9);
        late.lost = 3;
        let stream = [set(5).to_frame(), late.to_frame()].concat();
        let counts = decode(&stream).1;
        assert_eq!(
            (counts.sets, counts.lost_in_card, counts.missing),
            (2, 3, 3)
        );
        let wrapped = [set(0xFFFF).to_frame(), set(0).to_frame()].concat();
        assert_eq!(decode(&wrapped).1.missing, 0);
    }

    proptest! {
        #[test]
        fn any_set_comes_back(
            channels in prop::collection::vec((0u64..1 << 48, 0u8..32, any::<[bool; 4]>(), 0u8..128, any::<[(u8, u16, bool, bool); 2]>()), 1..=8),
            lost: u8, sequence: u16, timestamp: u32, due: bool, kind in 0..3,
        ) {
            let run = (kind == 2).then_some(channels.len() - 1);
            let infos = |infos: [(u8, u16, bool, bool); 2]| (kind == 1).then_some(
                infos.map(|(status, content, came, good)| Info { came, good, due, status, content })
            );
            let count = if kind == 2 { 1 } else { channels.len() };
            let channels = channels.into_iter().take(count).map(|(position, cause, flags, line, of)| Sample {
                position, cause, line, taken: flags[0], valid: flags[1], fresh: flags[2], missing: flags[3], infos: infos(of),
            });
            let set = SampleSet { run, lost, sequence, timestamp, channels: channels.collect() };
            let frame = set.to_frame();
            prop_assert!(frame[0] <= 139 && !frame[..frame.len() - 1].contains(&0));
            prop_assert_eq!(decode(&frame).0, vec![set]);
        }
    }
}
