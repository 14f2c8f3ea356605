//! The register map of a card, written in several formats.
//!
//! ```text
//! endat_regs (table) -> Map -> markdown.rs  for people
//!                                -> header.rs    C and C++
//!                                -> package.rs   SystemVerilog
//!                                -> vhdl.rs      VHDL
//!                                -> svd.rs       CMSIS-SVD
//!                                -> rdl.rs       SystemRDL
//!                                -> csr.rs       LiteX
//! ```
//!
//! [`Map::new`] is the only walk over the table: what the card has, under which names, with which start values. A writer
//! adds the form of its language and nothing else.

mod constants;
mod csr;
pub mod driver;
mod header;
mod markdown;
mod package;
mod rdl;
mod svd;
mod vhdl;

use endat_config::protocols::spoken;
use endat_config::Project;
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use endat_hdl::regs;
use endat_regs::{Block, Field, Named, Protocol, Register, Values};

pub use endat_regs::WORD_BYTES;

/// The registers that a card has.
#[derive(Clone, Debug)]
pub struct Map {
    /// Name of the card.
    pub name: String,
    /// Program and configuration that it comes from.
    pub origin: String,
    /// Major, minor and patch version of the register map.
    pub version: [u8; 3],
    /// What its channels speak.
    pub protocols: String,
    /// Encoder ports.
    pub channels: u32,
    /// Where it begins in the address space of a system, in bytes.
    pub base_address: u32,
    /// Blocks, lowest base first.
    pub blocks: Vec<MapBlock>,
}

/// A block of the card, or one that each channel has.
#[derive(Clone, Debug)]
pub struct MapBlock {
    /// Its place in the table.
    pub block: &'static Block,
    /// How many there are, [`Block::stride`] words apart.
    pub copies: u32,
    /// Its words, lowest offset first.
    pub registers: Vec<MapRegister>,
}

/// A word of a block.
#[derive(Clone, Debug)]
pub struct MapRegister {
    /// Its place in the table.
    pub register: &'static Register,
    /// Value after reset in each copy of the block; empty for RAM, which a reset leaves alone.
    pub resets: Vec<u32>,
    /// What the card's channels speak.
    pub spoken: Vec<Protocol>,
}

impl Map {
    /// The map of a project.
    pub fn new(project: &Project) -> Self {
        let config = &project.card;
        let spoken: Vec<Protocol> = spoken(config).collect();
        let map_block = |block: &'static Block| {
            let copies = if block.per_channel {
                config.channels.len()
            } else {
                1
            };
            let registers = regs::present(block, config).map(|register| MapRegister {
                register,
                resets: (0..copies)
                    .filter(|_| !block.is_ram)
                    .map(|channel| regs::start(block, register, config, channel))
                    .collect(),
                spoken: spoken.clone(),
            });
            MapBlock {
                block,
                copies: copies as u32,
                registers: registers.collect(),
            }
        };
        Self {
            name: project.name.clone(),
            origin: crate::sources::origin(&project.hash),
            version: regs::VERSION,
            protocols: project.protocols(),
            channels: config.channels.len() as u32,
            base_address: project.base_address,
            blocks: regs::blocks(config).map(map_block).collect(),
        }
    }

    /// Version as text.
    pub fn version(&self) -> String {
        self.version.map(|n| n.to_string()).join(".")
    }

    /// What the map is of.
    pub fn title(&self) -> String {
        let channels = match self.channels {
            1 => "1 channel".to_owned(),
            n => format!("{n} channels"),
        };
        format!(
            "{}: {} acquisition card, {channels}, register map {}.",
            self.name,
            self.protocols,
            self.version()
        )
    }
}

/// What a map with byte addresses says about them.
const ADDRESSES: &str = "Addresses here count bytes. The host link (UART) counts words of 32 bits: its address is the byte address divided by 4.";

/// What every map says about bits and addresses that it does not list.
const UNLISTED: &str = "Bits of no field read as 0, except in configuration words, which keep what is written there (write 0). \
                        Addresses not listed read as 0 and writing them does nothing.";

impl MapBlock {
    /// First byte, for channel 0.
    pub fn base_bytes(&self) -> u32 {
        u32::from(self.block.base) * WORD_BYTES
    }

    /// Bytes from one copy to the next.
    pub fn stride_bytes(&self) -> u32 {
        u32::from(self.block.stride) * WORD_BYTES
    }

    /// Bytes from the beginning of the map to the end of the block's last copy.
    pub fn end_bytes(&self) -> u32 {
        let words = self
            .registers
            .last()
            .map_or(0, |r| u32::from(r.register.offset) + 1);
        self.base_bytes() + (self.copies - 1) * self.stride_bytes() + words * WORD_BYTES
    }
}

impl MapRegister {
    /// Bits of its word that have one known value after reset, in all copies.
    pub fn reset_mask(&self) -> u32 {
        self.resets.iter().fold(
            if self.resets.is_empty() { 0 } else { u32::MAX },
            |mask, reset| mask & !(reset ^ self.resets[0]),
        )
    }

    /// Value after reset of the bits that [`Self::reset_mask`] has.
    pub fn reset(&self) -> u32 {
        self.resets.first().map_or(0, |r| r & self.reset_mask())
    }

    /// What a field's numbers or bits stand for on a channel that speaks another protocol than EnDat, if that is something else.
    pub fn values_elsewhere(&self, field: &Field) -> Vec<(Protocol, Values)> {
        let all = field.named_elsewhere();
        all.filter(|(p, _)| self.spoken.contains(p)).collect()
    }

    /// The same in words, behind a description.
    pub fn elsewhere(&self, field: &Field) -> String {
        let all = self.values_elsewhere(field).into_iter();
        let shown = |(protocol, values): (Protocol, Values)| {
            format!("; on {} {}", protocol.row().channel, listed(values))
        };
        all.map(shown).collect()
    }

    /// Values of a field after reset, one for each copy, or one if they are equal; empty for RAM.
    pub fn field_resets(&self, field: &Field) -> Vec<u32> {
        let part = |reset: &u32| (reset & field.mask()) >> field.lsb;
        let mut resets: Vec<u32> = self.resets.iter().map(part).collect();
        if resets.windows(2).all(|pair| pair[0] == pair[1]) {
            resets.truncate(1);
        }
        resets
    }
}

/// Meaning of a field, with its unit.
fn with_unit(field: &Field) -> String {
    match field.unit {
        "" => field.meaning.to_owned(),
        unit => format!("{} ({unit})", field.meaning),
    }
}

/// A list of what the numbers or bits of a field stand for, in words; empty when there is none.
fn listed(values: Values) -> String {
    let list = |named: &[Named], form: fn(&Named) -> String| {
        let items: Vec<String> = named.iter().map(form).collect();
        items.join(", ")
    };
    match values {
        Values::Plain => String::new(),
        Values::Codes(named) => list(named, |v| format!("{} = {}", v.number, v.meaning)),
        Values::Bits(named) => list(named, |v| format!("bit {}: {}", v.number, v.meaning)),
    }
}

/// Small numbers in decimal, large ones that are no round decimal number in hexadecimal.
fn number(value: u32) -> String {
    if value < 0x1_0000 || value.is_multiple_of(1_000) {
        value.to_string()
    } else {
        format!("0x{value:08X}")
    }
}

/// The register map of a project in every format.
pub fn artifacts(project: &Project) -> Result<Vec<Artifact>, CommandError> {
    let map = Map::new(project);
    let name = &project.name;
    Ok(vec![
        Artifact::new(format!("{name}_registers.md"), markdown::write(&map)),
        Artifact::new(format!("{name}_registers.h"), header::write(&map)),
        Artifact::new(format!("{name}_registers.sv"), package::write(&map)),
        Artifact::new(format!("{name}_registers.vhd"), vhdl::write(&map)),
        Artifact::new(format!("{name}.svd"), svd::write(&map)?),
        Artifact::new(format!("{name}.rdl"), rdl::write(&map)),
        Artifact::new(
            format!("{name}_csr.csv"),
            csr::write(&map, project.card.system_hz),
        ),
    ])
}
