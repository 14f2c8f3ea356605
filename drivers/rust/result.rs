//! Results of each channel's last trigger.

use crate::facts::Facts;
use crate::frame::crc5;
use crate::map::field;
use endat_regs::causes::{self, endat};
use endat_regs::{Field, Part, Protocol, Protocols, Values, BLOCK_STRIDE, CHANNELS_MAX, RESULT};

/// Words of a result, including additional data.
pub const RESULT_WORDS: usize = RESULT.registers.len();
/// Words of the longest burst that reads all results.
pub const MOMENT_WORDS: usize = BLOCK_STRIDE as usize * CHANNELS_MAX;

/// Fields of the raw flags, lowest first.
const FLAGS: [&Field; 2] = [field!(RESULT.evidence.flags), field!(RESULT.status.line)];

/// A block of additional data.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AdditionalData {
    /// The frame included this block.
    pub came: bool,
    /// The CRC is right; otherwise content and status are 0.
    pub good: bool,
    /// The frame was not over when its set was closed, so the block may have come since. Never set in a result.
    pub due: bool,
    /// WRN, RM, Busy, I4..I0.
    pub status: u8,
    /// Content.
    pub content: u16,
}

impl AdditionalData {
    /// Decodes 24 bits: status, content.
    pub const fn new(word: u32, came: bool, good: bool, due: bool) -> Self {
        Self {
            came,
            good,
            due,
            status: (word >> u16::BITS) as u8,
            content: word as u16,
        }
    }

    /// Decodes its word of a result; 1 and 2 have the same fields.
    fn of_word(word: u32) -> Self {
        let came = field!(RESULT.info_1.came).of(word) != 0;
        Self::new(word, came, field!(RESULT.info_1.good).of(word) != 0, false)
    }

    /// The block, if its CRC is right.
    pub fn good(self) -> Option<Self> {
        self.good.then_some(self)
    }

    /// Number of the content: I4..I0, the low bits of the MRS code that selects it.
    pub const fn number(self) -> u8 {
        field!(RESULT.info_1.sign).of((self.status as u32) << u16::BITS) as u8
    }

    /// The encoder is busy with a request.
    pub const fn is_busy(self) -> bool {
        field!(RESULT.info_1.busy).of((self.status as u32) << u16::BITS) != 0
    }

    /// RM: the reference mark has been passed.
    pub const fn has_reference_mark(self) -> bool {
        field!(RESULT.info_1.reference_mark).of((self.status as u32) << u16::BITS) != 0
    }

    /// WRN: a warning of the encoder is set.
    pub const fn has_warning(self) -> bool {
        field!(RESULT.info_1.warning).of((self.status as u32) << u16::BITS) != 0
    }
}

/// Result of a channel's last trigger.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// Last good position; bit 0 is the LSB.
    pub position: u64,
    /// Width of the position; 0: no position yet, or T-format.
    pub width_bits: u32,
    /// First falling clock edge of the frame that brought the position; T-format: start bit of the request. System clock cycles, wrapping.
    pub timestamp: u32,
    /// Number of results, wrapping.
    pub sequence: u16,
    /// Age of the position in microseconds; stops at 65535.
    pub age_us: u16,
    /// Tracked line delay.
    pub delay_cycles: u16,
    /// Recovery time of the last frame.
    pub recovery_cycles: u16,
    /// Shown special bits of the last frame, the last one in bit 0, if the protocol has special bits.
    pub special_bits: Option<u8>,
    /// Primary cause, a number of [`causes::ALL`]; 0 = none.
    pub cause: u8,
    /// All faults of the frame, a bit for each: see [`Self::flag_names`].
    pub flags: u32,
    /// A good position is available.
    pub valid: bool,
    /// The last result brought the position: test this, not the cause.
    pub fresh: bool,
    /// A trigger has come since this result.
    pub stale: bool,
    /// The position as read matches the CRC sent by the encoder, or has none.
    pub fits: bool,
    /// CRC of the last frame, as received and as computed.
    pub crc: [u8; 2],
    /// Additional data 1 and 2 of the same frame; empty on a card without requests.
    pub infos: [AdditionalData; 2],
}

impl Reading {
    /// Decodes the words of a result in a channel with this protocol; missing words count as 0.
    pub fn new(words: &[u32], protocol: Protocol) -> Self {
        let word = |offset: usize| words.get(offset).copied().unwrap_or(0);
        let [status, low, high, timestamp, evidence, age, info_1, info_2] =
            core::array::from_fn(word);
        let is = |word: u32, field: &Field| field.of(word) != 0;
        let upper = field!(RESULT.position_high.value).of(high);
        let position = u64::from(upper) << 32 | u64::from(low);
        let width_bits = field!(RESULT.position_high.width).of(high);
        let delay_high = field!(RESULT.age_recovery.delay_high).of(age);
        let delay_low = field!(RESULT.evidence.delay_cycles);
        // Special bits use the place of the upper flags.
        let has_special_bits = protocol.row().has_special_bits;
        let line = FLAGS[1].of(status);
        let upper_flags = if has_special_bits { 0 } else { line };
        Self {
            position,
            width_bits,
            timestamp,
            sequence: field!(RESULT.status.sequence).of(status) as u16,
            age_us: field!(RESULT.age_recovery.age_us).of(age) as u16,
            delay_cycles: (delay_high << delay_low.width | delay_low.of(evidence)) as u16,
            recovery_cycles: field!(RESULT.age_recovery.recovery_cycles).of(age) as u16,
            special_bits: has_special_bits.then_some(line as u8),
            cause: causes::number(field!(RESULT.status.cause).of(status) as u8, protocol),
            flags: FLAGS[0].of(evidence) | upper_flags << FLAGS[0].width,
            valid: is(status, field!(RESULT.status.valid)),
            fresh: is(status, field!(RESULT.status.fresh)),
            stale: is(age, field!(RESULT.age_recovery.stale)),
            fits: fits(position, high),
            crc: [
                field!(RESULT.evidence.crc_received).of(evidence) as u8,
                field!(RESULT.evidence.crc_computed).of(evidence) as u8,
            ],
            infos: [info_1, info_2].map(AdditionalData::of_word),
        }
    }

    /// The reading, without its position if that does not match its CRC: it was corrupted after the card's check.
    pub fn checked(self) -> Self {
        match self.fits {
            true => self,
            false => Self {
                valid: false,
                fresh: false,
                cause: endat::UPSET as u8,
                ..self
            },
        }
    }

    /// True if a result has come since reset.
    pub const fn has_come(&self) -> bool {
        self.sequence != 0 || self.valid || self.cause != 0
    }

    /// Name of the primary cause.
    pub fn cause_name(&self) -> &'static str {
        causes::of(self.cause).map_or("unknown", |cause| cause.name)
    }

    /// Names of all faults of the frame, in a channel with this protocol; the primary cause is one of them.
    pub fn flag_names(&self, protocol: Protocol) -> impl Iterator<Item = &'static str> {
        let [beside, above] = [self.flags, self.flags >> FLAGS[0].width];
        let fields = FLAGS.into_iter().zip([beside, above]);
        fields.flat_map(move |(field, flags)| {
            let named = match field.values_in(protocol) {
                Values::Bits(named) => named,
                Values::Plain | Values::Codes(_) => &[],
            };
            let set = named.iter().filter(move |bit| flags >> bit.number & 1 != 0);
            set.map(|bit| bit.name)
        })
    }

    /// Meaning of the cause.
    pub fn cause_meaning(&self) -> &'static str {
        causes::of(self.cause).map_or("unknown", |cause| cause.meaning)
    }

    /// Remedy for the cause.
    pub fn cause_remedy(&self) -> Option<&'static str> {
        causes::advice(causes::of(self.cause)?.name).map(|[_, remedy]| remedy)
    }
}

// The order in `Reading::new`.
const _: () = {
    let names = [
        "status",
        "position_low",
        "position_high",
        "timestamp",
        "evidence",
        "age_recovery",
        "info_1",
        "info_2",
    ];
    let mut n = 0;
    while n < names.len() {
        assert!(RESULT.word(names[n]).offset as usize == n);
        n += 1;
    }
};

/// True if a position matches the CRC received with it, over F1 = 0, F2 = 1 if it was sent, and the position, LSB first.
fn fits(position: u64, high: u32) -> bool {
    let width = field!(RESULT.position_high.width).of(high);
    let error_bits = 1 + field!(RESULT.position_high.f2).of(high) as usize;
    let covered = [false, true].into_iter().take(error_bits);
    let covered = covered.chain((0..width).map(|bit| position >> bit & 1 == 1));
    width == 0
        || position >> width == 0 && crc5(covered) == field!(RESULT.position_high.crc).of(high)
}

/// Decodes the results in consecutive words from the first one on; words between two results are ignored. `protocols` has the protocol of each
/// channel.
pub fn readings(
    words: &[u32],
    has_infos: bool,
    protocols: Protocols,
) -> impl Iterator<Item = Reading> + '_ {
    let each = endat_regs::result_words(1, has_infos) as usize;
    let blocks = words.chunks(BLOCK_STRIDE.into()).enumerate();
    blocks.map(move |(channel, block)| {
        Reading::new(&block[..each.min(block.len())], protocols.of(channel))
    })
}

/// Results of all channels, from one instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moment {
    results: [Reading; CHANNELS_MAX],
    channels: usize,
}

impl Moment {
    /// Decodes a card's words from the first result on.
    pub(crate) fn new(words: &[u32; MOMENT_WORDS], facts: &Facts) -> Self {
        let (channels, has_infos) = (facts.channels, facts.has(Part::Requests));
        let mut results = [Reading::default(); CHANNELS_MAX];
        let read = readings(words, has_infos, facts.protocols).take(channels);
        for (result, reading) in results.iter_mut().zip(read) {
            *result = reading.checked();
        }
        Self { results, channels }
    }

    /// Clears `stale` of results whose trigger came after this earlier moment; other trigger sources may continue.
    pub(crate) fn since(&mut self, before: &Self) {
        for (now, then) in self.results.iter_mut().zip(&before.results) {
            // The first result after it may belong to a trigger before it.
            if now.sequence.wrapping_sub(then.sequence) > u16::from(then.stale) {
                now.stale = false;
            }
        }
    }

    /// Results, by channel.
    pub fn results(&self) -> &[Reading] {
        &self.results[..self.channels]
    }
}

/// A position as a signed number, in two's complement of its width; 0 if the width is 0, as in T-format: use the position itself.
pub const fn signed(position: u64, width_bits: u32) -> i64 {
    match width_bits {
        0 => 0,
        64.. => position as i64,
        width => (position << (64 - width)) as i64 >> (64 - width),
    }
}

/// Distance from one position to another, the shorter way round.
pub const fn difference(from: u64, to: u64, width_bits: u32) -> i64 {
    signed(to.wrapping_sub(from), width_bits)
}
