//! The protocols of a channel. One row describes each protocol; code for results, registers and causes reads the row and names no
//! protocol.

pub mod ssi;
pub mod t_format;

use crate::causes::endat;
use crate::protocol_row::{OwnField, ProtocolRow};
use crate::register::is_same;
use crate::{Block, Field, Values};

/// Protocol of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Protocol {
    /// EnDat 2.1 or 2.2.
    Endat,
    /// T-format.
    TFormat,
    /// SSI.
    Ssi,
}

const ENDAT: ProtocolRow = ProtocolRow {
    name: "EnDat",
    word: "endat",
    means: "EnDat 2.1/2.2",
    channel: "an EnDat channel",
    has_clock: true,
    causes: endat::ALL,
    coded: endat::CODED,
    blocks: &["service", "line", "recovery"],
    fields: &[],
    channels: None,
    part: None,
    turns_at: None,
    turns_with: None,
    has_special_bits: false,
};

impl Protocol {
    /// All protocols; EnDat is the first.
    pub const ALL: &[Self] = &[Self::Endat, Self::TFormat, Self::Ssi];

    /// Facts that card and host share.
    pub const fn row(self) -> &'static ProtocolRow {
        match self {
            Self::Endat => &ENDAT,
            Self::TFormat => &t_format::PROTOCOL,
            Self::Ssi => &ssi::PROTOCOL,
        }
    }

    /// Name.
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// Code of the cause with this name; a missing cause fails compilation, or panics.
    pub const fn code_of(self, name: &str) -> u64 {
        let causes = self.row().causes;
        let mut at = 0;
        while !is_same(causes[at].name, name) {
            at += 1;
        }
        causes[at].code
    }

    /// True if channels with this protocol have the block. Every channel has the blocks that no protocol claims.
    pub fn has(self, block: &Block) -> bool {
        let claims = |p: &&Self| p.row().blocks.contains(&block.name);
        let owner = Self::ALL.iter().find(claims);
        owner.is_none_or(|owner| *owner == self)
    }

    /// Values of a field in this protocol, if they differ from EnDat.
    pub const fn own(self, field: &Field) -> Option<&'static OwnField> {
        let Some(key) = field.by_protocol else {
            return None;
        };
        let fields = self.row().fields;
        let mut at = 0;
        while at < fields.len() {
            if is_same(fields[at].field, key) {
                return Some(&fields[at]);
            }
            at += 1;
        }
        None
    }
}

/// Protocol of each channel of a card: the word `card.protocols`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Protocols(u32);

impl Protocols {
    /// All channels speak EnDat.
    pub const ENDAT: Self = Self(0);

    /// Decodes the word.
    pub const fn of_word(word: u32) -> Self {
        let mut fields = 0;
        let mut at = 0;
        while at < Protocol::ALL.len() {
            if let Some(channels) = &Protocol::ALL[at].row().channels {
                fields |= channels.mask();
            }
            at += 1;
        }
        Self(word & fields)
    }

    /// Sets the protocol of one channel.
    pub const fn with(self, channel: usize, protocol: Protocol) -> Self {
        match &protocol.row().channels {
            Some(channels) => Self(self.0 | 1 << (channels.lsb + channel as u32)),
            None => self,
        }
    }

    /// Encodes the word.
    pub const fn word(self) -> u32 {
        self.0
    }

    /// Protocol of a channel.
    pub const fn of(self, channel: usize) -> Protocol {
        let mut at = 0;
        while at < Protocol::ALL.len() {
            if self.channels(Protocol::ALL[at]) >> channel & 1 == 1 {
                return Protocol::ALL[at];
            }
            at += 1;
        }
        Protocol::Endat
    }

    /// Bit mask of the channels with this protocol; 0 for EnDat, which has no bits.
    pub const fn channels(self, protocol: Protocol) -> u64 {
        match &protocol.row().channels {
            Some(field) => field.of(self.0) as u64,
            None => 0,
        }
    }
}

/// Fields of the protocol word, together with `others`; lowest first.
pub(crate) const fn fields<const N: usize>(others: &[Field]) -> [Field; N] {
    let mut fields = [others[0]; N];
    let (mut count, mut at) = (0, 0);
    while at < Protocol::ALL.len() + others.len() {
        let next = match at < others.len() {
            true => Some(others[at]),
            false => Protocol::ALL[at - others.len()].row().channels,
        };
        at += 1;
        let Some(next) = next else { continue };
        let mut place = count;
        while place > 0 && fields[place - 1].lsb > next.lsb {
            fields[place] = fields[place - 1];
            place -= 1;
        }
        fields[place] = next;
        count += 1;
    }
    assert!(count == N);
    fields
}

impl Field {
    /// True if the field accepts this number in a channel with this protocol.
    pub fn allows(&self, value: u32, protocol: Protocol) -> bool {
        let ranges = self.ranges(protocol);
        match self.values_in(protocol) {
            _ if !ranges.is_empty() => ranges
                .iter()
                .any(|(low, high)| (*low..=*high).contains(&value)),
            Values::Codes(codes) => codes.iter().any(|c| c.number == value),
            _ => true,
        }
    }

    /// Named numbers or bits in a channel with this protocol.
    pub const fn values_in(&self, protocol: Protocol) -> Values {
        match protocol.own(self) {
            Some(own) => own.values,
            None => self.values,
        }
    }

    /// Allowed ranges in a channel with this protocol; empty if all numbers are allowed.
    pub const fn ranges(&self, protocol: Protocol) -> &'static [(u32, u32)] {
        match protocol.own(self) {
            Some(own) => own.takes,
            None => self.takes,
        }
    }

    /// True if at least one protocol limits the numbers.
    pub fn is_limited(&self) -> bool {
        let mut all = Protocol::ALL.iter();
        all.any(|protocol| !self.ranges(*protocol).is_empty())
    }

    /// Protocols whose named numbers or bits differ from EnDat, with these names.
    pub fn values_elsewhere(&self) -> impl Iterator<Item = (Protocol, Values)> + '_ {
        let all = Protocol::ALL.iter();
        all.filter_map(|protocol| Some((*protocol, protocol.own(self)?.values)))
            .filter(|(_, values)| *values != Values::Plain && *values != self.values)
    }

    /// Those of them in which the numbers or bits stand for anything.
    pub fn named_elsewhere(&self) -> impl Iterator<Item = (Protocol, Values)> + '_ {
        let all = self.values_elsewhere();
        all.filter(|(_, values)| !matches!(values, Values::Codes([]) | Values::Bits([])))
    }
}
