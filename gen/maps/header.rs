//! The register map as a header for C99 and C++: macros only, so that it asks for nothing and fits any way of access.

use super::constants::{self, Form, Item};
use super::{Map, MapBlock};
use std::fmt::Write;

/// The header.
pub fn write(map: &Map) -> String {
    let prefix = map.name.to_ascii_uppercase();
    let mut text = preamble(map, &prefix);
    for block in &map.blocks {
        write_block(&mut text, block, &prefix);
    }
    // Writing to a String cannot fail.
    let _ = writeln!(text, "\n#endif");
    text
}

fn preamble(map: &Map, prefix: &str) -> String {
    let mut head = String::new();
    constants::head(map)
        .iter()
        .for_each(|item| write_item(&mut head, item, prefix));
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
    constants::block(block)
        .iter()
        .for_each(|item| write_item(text, item, prefix));
}

/// A number, unsigned.
fn number(value: u32, form: Form) -> String {
    match form {
        Form::Decimal => format!("{value}u"),
        Form::Hex(digits) => format!("0x{value:0digits$X}u"),
    }
}

fn write_item(text: &mut String, item: &Item, prefix: &str) {
    let _ = match item {
        Item::Blank => writeln!(text),
        Item::Heading(name) => writeln!(text, "\n/* ---- {name} {} */\n", dashes(name)),
        Item::Comment(comment) => writeln!(text, "/* {comment} */"),
        Item::Constant {
            name,
            value,
            form,
            meaning,
        } => {
            let comment = match *meaning {
                "" => String::new(),
                meaning => format!(" /* {meaning} */"),
            };
            writeln!(
                text,
                "#define {prefix}_{name} {}{comment}",
                number(*value, *form)
            )
        }
        Item::OfChannel {
            name,
            value,
            stride,
            form,
        } => writeln!(
            text,
            "#define {prefix}_{name}(channel) ({} + {stride}u * (channel))",
            number(*value, *form)
        ),
    };
}

/// Fills the line of a heading.
fn dashes(heading: &str) -> String {
    "-".repeat(70usize.saturating_sub(heading.len()))
}
