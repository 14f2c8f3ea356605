//! Numbers, words and fields as the text of a bench has them.

use endat_hdl::regs::Block;
use serde::Serialize;

/// Added to every wait, in ns: time for the last steps inside the card, and for lights to be looked at.
pub const MARGIN_NS: u64 = 3_000;

/// A word of the register map.
#[derive(Serialize)]
pub struct Word {
    pub name: String,
    pub address: String,
}

/// Some bits of a word.
#[derive(Serialize)]
pub struct Bits {
    pub name: String,
    pub lsb: u32,
    pub width: u32,
}

/// A literal of type `real`.
pub fn real(ns: f64) -> String {
    let text = format!("{ns:.3}");
    let plain = text.trim_end_matches('0');
    let zero = if plain.ends_with('.') { "0" } else { "" };
    format!("{plain}{zero}")
}

pub fn whole(ns: u64) -> String {
    real(ns as f64)
}

/// Period of the bench's clock, in ns: two halves of whole picoseconds, which are the steps of the simulator. A period that is none
/// would be told wrong to everything that counts cycles by it.
pub fn clock_ns(hz: u64) -> f64 {
    2.0 * (5e11 / hz as f64).round() / 1e3
}

pub fn words(block: &Block) -> impl Iterator<Item = Word> + '_ {
    block.registers.iter().map(|register| Word {
        name: format!("{}_{}", block.name, register.name).to_uppercase(),
        address: format!("{:03X}", block.address(register, 0)),
    })
}

pub fn fields(block: &Block) -> impl Iterator<Item = Bits> + '_ {
    block.registers.iter().flat_map(|register| {
        register.fields.iter().map(|field| Bits {
            name: format!("{}_{}", register.name, field.name).to_uppercase(),
            lsb: field.lsb,
            width: field.width,
        })
    })
}

/// Where a word of a channel's block stands.
pub fn word_address(block: &Block, name: &str, channel: usize) -> String {
    let register = block.register(name).expect("a word of the block");
    format!("{:03X}", block.address(register, channel))
}
