//! Types of the register table.

use crate::part::Part;
use crate::{Named, Values};

/// Access of a host to a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Read only: a write does nothing.
    ReadOnly,
    /// Read and write.
    ReadWrite,
    /// Write only: writing 1 acts once; reads return 0.
    Strobe,
}

impl Access {
    /// Short form for tables.
    pub const fn short(self) -> &'static str {
        match self {
            Self::ReadOnly => "ro",
            Self::ReadWrite => "rw",
            Self::Strobe => "strobe",
        }
    }
}

/// A bit field of a word.
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
    /// Meaning.
    pub meaning: &'static str,
    /// Named numbers or bits.
    pub values: Values,
    /// Allowed ranges, both ends included; empty if all numbers are allowed.
    pub takes: &'static [(u32, u32)],
    /// Key under which a protocol may replace `values` and `takes` (`Protocol::own`); `None` if all protocols share them.
    pub by_protocol: Option<&'static str>,
}

impl Field {
    /// The field's number in a word.
    pub const fn of(&self, word: u32) -> u32 {
        (word & self.mask()) >> self.lsb
    }

    /// The word with this field changed; `None` if `value` does not fit.
    pub fn put(&self, word: u32, value: u32) -> Option<u32> {
        let is_fitting = u64::from(value) < 1u64 << self.width;
        is_fitting.then(|| word & !self.mask() | value << self.lsb)
    }

    /// The field's bits within its word.
    pub const fn mask(&self) -> u32 {
        (((1u64 << self.width) - 1) << self.lsb) as u32
    }

    /// Adds named numbers.
    pub(crate) const fn codes(mut self, codes: &'static [Named]) -> Self {
        self.values = Values::Codes(codes);
        self
    }

    /// Adds allowed ranges.
    pub(crate) const fn takes(mut self, ranges: &'static [(u32, u32)]) -> Self {
        self.takes = ranges;
        self
    }

    /// Lets protocols replace values and ranges under this key.
    pub(crate) const fn by_protocol(mut self, name: &'static str) -> Self {
        self.by_protocol = Some(name);
        self
    }

    /// Adds named bits.
    pub(crate) const fn bits(mut self, bits: &'static [Named]) -> Self {
        self.values = Values::Bits(bits);
        self
    }
}

/// A word of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Register {
    /// Name, unique in its block.
    pub name: &'static str,
    /// Word offset in its block.
    pub offset: u16,
    /// Access of a host.
    pub access: Access,
    /// One sentence.
    pub meaning: &'static str,
    /// Part that a card needs for this word, in addition to that of the block.
    pub part: Option<Part>,
    /// Fields, lowest first. Other bits read 0, except in configuration words, which keep the written value.
    pub fields: &'static [Field],
}

impl Register {
    /// Makes the word optional: only cards with this part have it.
    pub(crate) const fn of(mut self, part: Part) -> Self {
        self.part = Some(part);
        self
    }

    /// The field called `name`.
    pub fn field(&self, name: &str) -> Option<&'static Field> {
        self.fields.iter().find(|f| f.name == name)
    }
}

/// A field without named values or limits.
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

/// Group of words, once in the card or once for each channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// Name; registers of a channel are called `<name><channel>_<register>`.
    pub name: &'static str,
    /// First word, for channel 0.
    pub base: u16,
    /// Words from one channel's block to the next.
    pub stride: u16,
    /// True if every channel has a block.
    pub per_channel: bool,
    /// One sentence.
    pub meaning: &'static str,
    /// True for RAM: 0 after power-up, not cleared by reset.
    pub is_ram: bool,
    /// Part that a card needs for this block.
    pub part: Option<Part>,
    /// Words, lowest offset first.
    pub registers: &'static [Register],
}

impl Block {
    /// Word address of a register of this block.
    pub const fn address(&self, register: &Register, channel: usize) -> u16 {
        let block = if self.per_channel { channel as u16 } else { 0 };
        self.base + self.stride * block + register.offset
    }

    /// A field by register and field name; a missing one fails compilation.
    pub const fn field(&self, register: &str, field: &str) -> &'static Field {
        let fields = self.word(register).fields;
        let mut f = 0;
        while !is_same(fields[f].name, field) {
            f += 1;
        }
        &fields[f]
    }

    /// A register by name; a missing one fails compilation.
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
