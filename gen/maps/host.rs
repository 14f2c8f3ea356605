//! The register table as Rust, for the host library, which knows nothing of the hardware description.

use super::map_id;
use endat_hdl::regs::values::{Named, Values};
use endat_hdl::regs::{Access, Block, Field, Limits, Register, BLOCKS, VERSION};
use std::fmt::Write;

/// The whole map, with every part that a card may have.
pub fn write() -> String {
    let mut text = format!(
        "//! The register map that the cards of this version have, with every part; which of them a card has, its capabilities tell.\n\
         //!\n\
         //! Generated from the card's own table. Do not edit; `UPDATE_EXPECT=1 cargo test --test system -- maps::the_host` renews it.\n\n\
         use crate::registers::{{Access, Block, Field, Limits, Named, Register, Values}};\n\n\
         /// Major, minor and patch version of the map.\n\
         pub const VERSION: [u8; 3] = {VERSION:?};\n\n\
         /// All blocks, lowest base first.\n\
         pub const BLOCKS: &[Block] = &[\n"
    );
    for each in &BLOCKS {
        block(&mut text, each);
    }
    text.push_str("];\n");
    text
}

fn block(text: &mut String, block: &Block) {
    let _ = writeln!(
        text,
        "    Block {{ name: {:?}, base: {:#05X}, stride: {}, per_channel: {}, meaning: {:?}, registers: &[",
        map_id(block, &BLOCKS),
        block.base,
        block.stride,
        block.per_channel,
        block.meaning
    );
    for each in block.registers {
        register(text, each);
    }
    text.push_str("    ] },\n");
}

fn register(text: &mut String, register: &Register) {
    let access = match register.access {
        Access::ReadOnly => "ReadOnly",
        Access::ReadWrite => "ReadWrite",
        Access::Strobe => "Strobe",
    };
    let _ = writeln!(
        text,
        "        Register {{ name: {:?}, offset: {}, access: Access::{access}, meaning: {:?}, fields: &[",
        register.name, register.offset, register.meaning
    );
    for each in register.fields {
        field(text, each);
    }
    text.push_str("        ] },\n");
}

fn field(text: &mut String, field: &Field) {
    let _ = writeln!(
        text,
        "            Field {{ name: {:?}, lsb: {}, width: {}, unit: {:?}, meaning: {:?}, values: {}, limits: {} }},",
        field.name,
        field.lsb,
        field.width,
        field.unit,
        field.meaning,
        values(field.values),
        limits(&field.limits)
    );
}

fn limits(limits: &Limits) -> String {
    match (limits.endat, limits.t_format) {
        ([], []) => "Limits::ANY".into(),
        (endat, t_format) => format!("Limits {{ endat: &{endat:?}, t_format: &{t_format:?} }}"),
    }
}

fn values(values: Values) -> String {
    let list = |kind: &str, named: &[Named]| {
        let items = named.iter().map(|v| {
            format!(
                "Named {{ name: {:?}, number: {}, meaning: {:?} }}",
                v.name, v.number, v.meaning
            )
        });
        format!(
            "Values::{kind}(&[{}])",
            items.collect::<Vec<_>>().join(", ")
        )
    };
    match values {
        Values::Plain => "Values::Plain".into(),
        Values::Codes(named) => list("Codes", named),
        Values::Bits(named) => list("Bits", named),
    }
}
