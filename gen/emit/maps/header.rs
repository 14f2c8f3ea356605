//! The register map as a header for C99 and C++: macros only, so that it asks for nothing and fits any way of access.

use super::constants::{self, Form, Language};
use super::{Map, MapBlock};

/// The header.
pub fn write(map: &Map) -> String {
    let prefix = map.name.to_ascii_uppercase();
    let mut text = preamble(map, &prefix);
    for block in &map.blocks {
        write_block(&mut text, block, &prefix);
    }
    text.push_str("\n#endif\n");
    text
}

fn preamble(map: &Map, prefix: &str) -> String {
    let head = Macros { prefix }.print(&constants::head(map));
    format!(
        "/*
 * {title}
 *
 * {origin}
 *
 * ..._WORD is the address that the host link (UART) takes: it counts words of 32 bits.
 * ..._BYTE is the same place on a bus that counts bytes, and in the SVD and RDL files: 4 * ..._WORD.
 * Of blocks that each channel has, both take the channel: ..._WORD(0) is that of channel 0.
 */
#ifndef {prefix}_REGISTERS_H
#define {prefix}_REGISTERS_H

{head}
/* Content of a field in a word that was read, and a field's content as part of a word to be written: */
/* {prefix}_GET({prefix}_RESULT_STATUS_CAUSE, word) */
#define {prefix}_GET(field, word) (((word) & field##_MASK) >> field##_SHIFT)
#define {prefix}_PUT(field, value) (((value) << field##_SHIFT) & field##_MASK)
",
        title = map.title(),
        origin = map.origin,
    )
}

pub(super) fn write_block(text: &mut String, block: &MapBlock, prefix: &str) {
    text.push_str(&Macros { prefix }.print(&constants::block(block)));
}

/// Macros whose names begin with the card's.
struct Macros<'a> {
    prefix: &'a str,
}

impl Language for Macros<'_> {
    const INDENT: &'static str = "";

    fn heading(&self, name: &str) -> String {
        format!("/* ---- {name} {} */", dashes(name))
    }

    fn comment(&self, text: &str) -> String {
        format!("/* {text} */")
    }

    fn number(&self, value: u32, form: Form) -> String {
        match form {
            Form::Decimal => format!("{value}u"),
            Form::Hex(digits) => format!("0x{value:0digits$X}u"),
        }
    }

    fn constant(&self, name: &str, number: &str) -> String {
        format!("#define {}_{name} {number}", self.prefix)
    }

    fn of_channel(&self, name: &str, number: &str, stride: u32) -> String {
        format!(
            "#define {}_{name}(channel) ({number} + {stride}u * (channel))",
            self.prefix
        )
    }
}

/// Fills the line of a heading.
fn dashes(heading: &str) -> String {
    "-".repeat(70usize.saturating_sub(heading.len()))
}
