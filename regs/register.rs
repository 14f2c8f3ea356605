//! What a table of registers is made of.

use crate::part::Part;
use crate::{Named, Values};

/// What a host may do with a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Read only: a write does nothing.
    ReadOnly,
    /// Read and write.
    ReadWrite,
    /// Write only: ones act once, a read gives 0.
    Strobe,
}

impl Access {
    /// Short form used in tables.
    pub const fn short(self) -> &'static str {
        match self {
            Self::ReadOnly => "ro",
            Self::ReadWrite => "rw",
            Self::Strobe => "strobe",
        }
    }
}

/// Some bits of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Name, unique in its word.
    pub name: &'static str,
    /// Lowest bit.
    pub lsb: u32,
    /// Number of bits.
    pub width: u32,
    /// Unit of the number, or "".
    pub unit: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// What single numbers or bits stand for.
    pub values: Values,
    /// Numbers that the card takes, each range from and to; none = all that fit.
    pub takes: &'static [(u32, u32)],
    /// Name under which protocols may have `values` and `takes` of their own for it (`Protocol::own`); none: it is the same in all of them.
    pub by_protocol: Option<&'static str>,
}

impl Field {
    /// The field's number in a word.
    pub const fn of(&self, word: u32) -> u32 {
        (word & self.mask()) >> self.lsb
    }

    /// A word with this field changed; none if `value` does not fit.
    pub fn put(&self, word: u32, value: u32) -> Option<u32> {
        let is_fitting = u64::from(value) < 1u64 << self.width;
        is_fitting.then(|| word & !self.mask() | value << self.lsb)
    }

    /// The field's bits within its word.
    pub const fn mask(&self) -> u32 {
        (((1u64 << self.width) - 1) << self.lsb) as u32
    }

    /// The same field, with a list of what its numbers stand for.
    pub(crate) const fn codes(mut self, codes: &'static [Named]) -> Self {
        self.values = Values::Codes(codes);
        self
    }

    /// The same field, which takes these numbers only.
    pub(crate) const fn takes(mut self, ranges: &'static [(u32, u32)]) -> Self {
        self.takes = ranges;
        self
    }

    /// The same field, for which protocols may have something of their own under this name.
    pub(crate) const fn by_protocol(mut self, name: &'static str) -> Self {
        self.by_protocol = Some(name);
        self
    }

    /// The same field, with a list of what its bits stand for.
    pub(crate) const fn bits(mut self, bits: &'static [Named]) -> Self {
        self.values = Values::Bits(bits);
        self
    }
}

/// One word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Register {
    /// Name, unique in its block.
    pub name: &'static str,
    /// Word offset in its block.
    pub offset: u16,
    /// What a host may do with it.
    pub access: Access,
    /// One sentence.
    pub meaning: &'static str,
    /// Part that a card must have for it, beside that of its block.
    pub part: Option<Part>,
    /// Fields, lowest first; bits of no field read as 0, except in configuration words, which keep what is written.
    pub fields: &'static [Field],
}

impl Register {
    /// The same word, which only cards with this part have.
    pub(crate) const fn of(mut self, part: Part) -> Self {
        self.part = Some(part);
        self
    }

    /// The field called `name`.
    pub fn field(&self, name: &str) -> Option<&'static Field> {
        self.fields.iter().find(|f| f.name == name)
    }
}

/// A field without list or limits.
pub(crate) const fn field(
    name: &'static str,
    lsb: u32,
    width: u32,
    unit: &'static str,
    meaning: &'static str,
) -> Field {
    Field {
        name,
        lsb,
        width,
        unit,
        meaning,
        values: Values::Plain,
        takes: &[],
        by_protocol: None,
    }
}

pub(crate) const fn word(
    name: &'static str,
    offset: u8,
    access: Access,
    meaning: &'static str,
    fields: &'static [Field],
) -> Register {
    Register {
        name,
        offset: offset as u16,
        access,
        meaning,
        part: None,
        fields,
    }
}

/// Words that stand together, once in the card or once for each channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// Name; registers of a channel are called `<name><channel>_<register>`.
    pub name: &'static str,
    /// First word, for channel 0.
    pub base: u16,
    /// Words from one channel's to the next one's.
    pub stride: u16,
    /// Whether every channel has one.
    pub per_channel: bool,
    /// One sentence.
    pub meaning: &'static str,
    /// Whether it is RAM: 0 after power-up, and no reset clears it.
    pub is_ram: bool,
    /// Part that a card must have for it.
    pub part: Option<Part>,
    /// Its words, lowest offset first.
    pub registers: &'static [Register],
}

impl Block {
    /// Word address of one of its registers.
    pub const fn address(&self, register: &Register, channel: usize) -> u16 {
        let block = if self.per_channel { channel as u16 } else { 0 };
        self.base + self.stride * block + register.offset
    }

    /// A field that is known to be there, by the names of its register and its own; else it does not compile.
    pub const fn field(&self, register: &str, field: &str) -> &'static Field {
        let fields = self.word(register).fields;
        let mut f = 0;
        while !is_same(fields[f].name, field) {
            f += 1;
        }
        &fields[f]
    }

    /// A register that is known to be there, by its name; else it does not compile.
    pub const fn word(&self, register: &str) -> &'static Register {
        let registers = self.registers;
        let mut r = 0;
        while !is_same(registers[r].name, register) {
            r += 1;
        }
        &registers[r]
    }

    /// The register called `name`.
    pub fn register(&self, name: &str) -> Option<&'static Register> {
        self.registers.iter().find(|r| r.name == name)
    }
}

pub(crate) const fn is_same(one: &str, other: &str) -> bool {
    let (one, other) = (one.as_bytes(), other.as_bytes());
    if one.len() != other.len() {
        return false;
    }
    let mut at = 0;
    while at < one.len() {
        if one[at] != other[at] {
            return false;
        }
        at += 1;
    }
    true
}
