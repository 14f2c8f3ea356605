//! The protocols that a channel may speak. One row has all that card and host agree on of a protocol: who works with results, registers and
//! causes asks it, and knows none by name.

pub mod ssi;
pub mod t_format;

use crate::causes::endat;
use crate::protocol_row::{OwnField, ProtocolRow};
use crate::register::is_same;
use crate::{Block, Field, Values};

/// What a channel speaks.
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
    /// All of them; EnDat is the first.
    pub const ALL: &[Self] = &[Self::Endat, Self::TFormat, Self::Ssi];

    /// What card and host agree on of it.
    pub const fn row(self) -> &'static ProtocolRow {
        match self {
            Self::Endat => &ENDAT,
            Self::TFormat => &t_format::PROTOCOL,
            Self::Ssi => &ssi::PROTOCOL,
        }
    }

    /// Its name.
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// Code of its cause of that name; without one it does not compile, or panics.
    pub const fn code_of(self, name: &str) -> u64 {
        let causes = self.row().causes;
        let mut at = 0;
        while !is_same(causes[at].name, name) {
            at += 1;
        }
        causes[at].code
    }

    /// Whether its channels have such a block; blocks that no protocol claims are those of all.
    pub fn has(self, block: &Block) -> bool {
        let claims = |p: &&Self| p.row().blocks.contains(&block.name);
        let owner = Self::ALL.iter().find(claims);
        owner.is_none_or(|owner| *owner == self)
    }

    /// What a field is in it, if that is something else than in EnDat.
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

/// Which protocol each channel of a card speaks: the word `card.protocols`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Protocols(u32);

impl Protocols {
    /// Of a card whose channels all speak EnDat.
    pub const ENDAT: Self = Self(0);

    /// As the word says.
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

    /// With one channel that speaks a protocol.
    pub const fn with(self, channel: usize, protocol: Protocol) -> Self {
        match &protocol.row().channels {
            Some(channels) => Self(self.0 | 1 << (channels.lsb + channel as u32)),
            None => self,
        }
    }

    /// The word's bits.
    pub const fn word(self) -> u32 {
        self.0
    }

    /// What a channel speaks.
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

    /// Bit n: channel n speaks this protocol; of EnDat none has a bit.
    pub const fn channels(self, protocol: Protocol) -> u64 {
        match &protocol.row().channels {
            Some(field) => field.of(self.0) as u64,
            None => 0,
        }
    }
}

/// Fields of a word that says which channels speak what, beside `others`; lowest first.
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
    /// Whether it takes this number in a channel that speaks this protocol.
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

    /// What single numbers or bits stand for in a channel that speaks this protocol.
    pub const fn values_in(&self, protocol: Protocol) -> Values {
        match protocol.own(self) {
            Some(own) => own.values,
            None => self.values,
        }
    }

    /// What it takes in a channel that speaks this protocol; none = all that fit.
    pub const fn ranges(&self, protocol: Protocol) -> &'static [(u32, u32)] {
        match protocol.own(self) {
            Some(own) => own.takes,
            None => self.takes,
        }
    }

    /// Whether some protocol takes only some of the numbers that fit.
    pub fn is_limited(&self) -> bool {
        let mut all = Protocol::ALL.iter();
        all.any(|protocol| !self.ranges(*protocol).is_empty())
    }

    /// Protocols in which single numbers or bits stand for something else than in EnDat, and for what.
    pub fn values_elsewhere(&self) -> impl Iterator<Item = (Protocol, Values)> + '_ {
        let all = Protocol::ALL.iter();
        all.filter_map(|protocol| Some((*protocol, protocol.own(self)?.values)))
            .filter(|(_, values)| *values != Values::Plain && *values != self.values)
    }
}
