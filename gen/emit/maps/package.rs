//! The register map as a package of SystemVerilog, for benches and for logic that reads the card.

use super::constants::{self, Form, Language};
use super::Map;

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
    let mut items = constants::head(map);
    items.extend(map.blocks.iter().flat_map(constants::block));
    text.push_str(&SystemVerilog.print(&items));
    text.push_str("\n    /* verilator lint_on UNUSEDPARAM */\nendpackage\n");
    text
}

struct SystemVerilog;

impl Language for SystemVerilog {
    const INDENT: &'static str = "    ";

    fn heading(&self, name: &str) -> String {
        format!("// ---- {name}")
    }

    fn comment(&self, text: &str) -> String {
        format!("// {text}")
    }

    fn number(&self, value: u32, form: Form) -> String {
        match form {
            Form::Decimal => format!("32'd{value}"),
            Form::Hex(digits) => format!("32'h{value:0digits$X}"),
        }
    }

    fn constant(&self, name: &str, number: &str) -> String {
        format!("localparam logic [31:0] {name} = {number};")
    }

    fn of_channel(&self, name: &str, number: &str, stride: u32) -> String {
        format!(
            "function automatic logic [31:0] {name}(input logic [31:0] channel);\n        \
             {name} = {number} + 32'd{stride} * channel;\n    endfunction"
        )
    }
}
