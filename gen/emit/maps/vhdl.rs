//! The register map as a package of VHDL, for benches and for logic that reads the card.

use super::constants::{self, Form, Item, Language};
use super::Map;

/// The package and its body.
pub fn write(map: &Map) -> String {
    let name = &map.name;
    let mut items = constants::head(map);
    items.extend(map.blocks.iter().flat_map(constants::block));
    let is_function = |item: &&Item| matches!(item, Item::OfChannel { .. });
    let functions: Vec<Item> = items.iter().filter(is_function).cloned().collect();
    let text = format!(
        "-- {}
--
-- {}
--
-- ..._WORD is the address that the host link (UART) takes: it counts words of 32 bits.
-- ..._BYTE is the same place on a bus that counts bytes: 4 * ..._WORD.
-- Registers that each channel has take the channel: ..._WORD(0) is that of channel 0; ..._BASE_... of such a block is that of channel 0.
-- Places, numbers of bits and codes are of type natural; what a word may contain (..._MASK, ..._RESET, single bits) is a vector of 32 bits.
library ieee;
use ieee.std_logic_1164.all;

package {name}_registers is

    subtype word_t is std_logic_vector(31 downto 0);

{}
end package;

package body {name}_registers is

{}
end package body;
",
        map.title(),
        map.origin,
        Vhdl { bodies: false }.print(&items),
        Vhdl { bodies: true }.print(&functions),
    );
    // Blocks and functions end with an empty line each, whatever follows.
    let mut lines: Vec<&str> = text.lines().collect();
    lines.dedup_by(|one, before| one.is_empty() && before.is_empty());
    lines.join("\n") + "\n"
}

struct Vhdl {
    /// Functions are defined; declared otherwise.
    bodies: bool,
}

impl Language for Vhdl {
    const INDENT: &'static str = "    ";

    fn heading(&self, name: &str) -> String {
        format!("-- ---- {name}")
    }

    fn comment(&self, text: &str) -> String {
        format!("-- {text}")
    }

    fn number(&self, value: u32, form: Form) -> String {
        match form {
            Form::Decimal => value.to_string(),
            _ if form.is_content() => format!("x\"{value:08X}\""),
            Form::Hex(digits) => format!("16#{value:0digits$X}#"),
        }
    }

    fn constant(&self, name: &str, number: &str) -> String {
        let kind = match number.starts_with('x') {
            true => "word_t",
            false => "natural",
        };
        format!("constant {name} : {kind} := {number};")
    }

    fn of_channel(&self, name: &str, number: &str, stride: u32) -> String {
        let head = format!("function {name}(channel : natural) return natural");
        match self.bodies {
            false => format!("{head};"),
            true => format!(
                "{head} is\n    begin\n        return {number} + {stride} * channel;\n    end function;\n"
            ),
        }
    }
}
