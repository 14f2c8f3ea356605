//! The register map as a package of SystemVerilog, for benches and for logic that reads the card.

use super::constants::{self, Form, Item};
use super::Map;
use std::fmt::Write;

/// The package.
pub fn write(map: &Map) -> String {
    let name = &map.name;
    let mut text = format!(
        "// {}
//
// {}
//
// ..._WORD is the address that the host link (UART) takes: it counts words of 32 bits.
// ..._BYTE is the same place on a bus that counts bytes: 4 * ..._WORD.
// Registers that each channel has take the channel: ..._WORD(0) is that of channel 0; ..._BASE_... of such a block is that of channel 0.
// Content of a field in a word that was read: (word & ..._MASK) >> ..._SHIFT.
package {name}_registers;

    // Nobody needs all of it.
    /* verilator lint_off UNUSEDPARAM */

",
        map.title(),
        map.origin
    );
    let blocks = map.blocks.iter().flat_map(constants::block);
    for item in constants::head(map).into_iter().chain(blocks) {
        write_item(&mut text, &item);
    }
    text.push_str("\n    /* verilator lint_on UNUSEDPARAM */\nendpackage\n");
    text
}

fn number(value: u32, form: Form) -> String {
    match form {
        Form::Decimal => format!("32'd{value}"),
        Form::Hex(digits) => format!("32'h{value:0digits$X}"),
    }
}

fn write_item(text: &mut String, item: &Item) {
    // Writing to a String cannot fail.
    let _ = match item {
        Item::Blank => writeln!(text),
        Item::Heading(name) => writeln!(text, "\n    // ---- {name}\n"),
        Item::Comment(comment) => writeln!(text, "    // {comment}"),
        Item::Constant {
            name,
            value,
            form,
            meaning,
        } => {
            let comment = match *meaning {
                "" => String::new(),
                meaning => format!(" // {meaning}"),
            };
            let value = number(*value, *form);
            writeln!(
                text,
                "    localparam logic [31:0] {name} = {value};{comment}"
            )
        }
        Item::OfChannel {
            name,
            value,
            stride,
            form,
        } => writeln!(
            text,
            "    function automatic logic [31:0] {name}(input logic [31:0] channel);\n        \
             {name} = {} + 32'd{stride} * channel;\n    endfunction",
            number(*value, *form)
        ),
    };
}
