//! Descriptions of fields, for hosts with a heap.

use crate::{Field, Protocol, Values};
use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

impl Field {
    /// Description of the accepted numbers, if a channel with this protocol rejects `value`.
    pub fn refusal(&self, value: u32, protocol: Protocol) -> Option<String> {
        if self.allows(value, protocol) {
            return None;
        }
        let shown = |(low, high): &(u32, u32)| match low == high {
            true => low.to_string(),
            false => format!("{low}..{high}"),
        };
        let ranges = self.ranges(protocol);
        Some(match self.values_in(protocol) {
            Values::Codes(codes) if ranges.is_empty() => list(codes.iter().map(|c| c.name)),
            _ => ranges.iter().map(shown).collect::<Vec<_>>().join(", "),
        })
    }

    /// Description of the field's number in a word, in a channel with this protocol; `None` if the number has no name.
    pub fn told(&self, word: u32, protocol: Protocol) -> Option<String> {
        let value = self.of(word);
        match self.values_in(protocol) {
            Values::Plain => None,
            Values::Codes(codes) => {
                let code = codes.iter().find(|c| c.number == value);
                code.map(|c| c.meaning.to_owned())
            }
            Values::Bits(bits) => {
                let set = bits.iter().filter(|b| value >> b.number & 1 == 1);
                let names = list(set.map(|b| b.meaning));
                (!names.is_empty()).then_some(names)
            }
        }
    }

    /// Bits as `15:0`, or `3`.
    pub fn bit_range(&self) -> String {
        match self.width {
            1 => self.lsb.to_string(),
            width => format!("{}:{}", self.lsb + width - 1, self.lsb),
        }
    }
}

fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}
