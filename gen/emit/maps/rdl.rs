//! The register map as SystemRDL 2.0.

use super::{listed, with_unit, Map, MapBlock, MapRegister, ADDRESSES, UNLISTED, WORD_BYTES};
use endat_regs::{Access, Field};
use endat_regs::{Named, Values};
use std::fmt::Write;

/// Words that SystemRDL keeps for itself (2.0, clause 4.4); as a name they get a backslash.
const KEYWORDS: &str =
    "abstract accesstype addressingtype addrmap alias all alternate bit boolean bothedge byte \
     component componentwidth constraint default encode enum external false field hw inside int \
     internal level longint mem na negedge nonsticky number onreadtype onwritetype posedge \
     precedencetype property r rclr real ref reg regfile rset ruser rw rw1 shortint shortreal signal \
     signed string struct sw this true type unsigned w w1 wclr with within woclr woset wot wr wset \
     wuser wzc wzs wzt";

/// The RDL file.
pub fn write(map: &Map) -> String {
    let mut text = format!(
        "// {}\n//\n// {}\n// {ADDRESSES}\n\naddrmap {} {{\n",
        map.title(),
        map.origin,
        identifier(&map.name)
    );
    // Writing to a String cannot fail.
    let _ = writeln!(text, "    name = {};", quoted(&map.title()));
    let about = format!("{ADDRESSES} {UNLISTED}");
    let _ = writeln!(text, "    desc = {};", quoted(&about));
    let _ = writeln!(text, "    addressing = regalign;");
    let _ = writeln!(text, "    default regwidth = 32;");
    for block in &map.blocks {
        write_block(&mut text, block, map.base_address);
    }
    text.push_str("};\n");
    text
}

fn write_block(text: &mut String, block: &MapBlock, base_address: u32) {
    let _ = writeln!(text, "\n    regfile {{");
    let _ = writeln!(text, "        desc = {};", quoted(block.block.meaning));
    for entry in &block.registers {
        write_register(text, entry);
    }
    let name = identifier(block.block.name);
    // The outermost map has no address of its own: a system's stands at each block.
    let base = base_address + block.base_bytes();
    let _ = match block.block.per_channel {
        true => writeln!(
            text,
            "    }} {name}[{}] @ 0x{base:04X} += {};",
            block.copies,
            block.stride_bytes()
        ),
        false => writeln!(text, "    }} {name} @ 0x{base:04X};"),
    };
}

fn write_register(text: &mut String, entry: &MapRegister) {
    let register = entry.register;
    let _ = writeln!(text, "\n        reg {{");
    let _ = writeln!(text, "            desc = {};", quoted(register.meaning));
    let sw = match register.access {
        Access::ReadOnly => "r",
        Access::ReadWrite => "rw",
        Access::Strobe => "w",
    };
    let _ = writeln!(text, "            default sw = {sw};");
    // An enumeration has to stand before the fields.
    for field in register.fields {
        if let Values::Codes(codes) = field.values {
            write_enumeration(text, field, codes);
        }
    }
    for field in register.fields {
        write_field(text, entry, field);
    }
    let _ = writeln!(
        text,
        "        }} {} @ 0x{:03X};",
        identifier(register.name),
        u32::from(register.offset) * WORD_BYTES
    );
}

/// The name of a field's enumeration; it must not be the field's.
fn enumeration_name(field: &Field) -> String {
    format!("{}_values", field.name)
}

fn write_enumeration(text: &mut String, field: &Field, codes: &[Named]) {
    let _ = writeln!(text, "            enum {} {{", enumeration_name(field));
    for code in codes {
        let _ = writeln!(
            text,
            "                {} = {}'d{} {{ desc = {}; }};",
            identifier(code.name),
            field.width,
            code.number,
            quoted(code.meaning)
        );
    }
    let _ = writeln!(text, "            }};");
}

fn write_field(text: &mut String, entry: &MapRegister, field: &Field) {
    let mut meaning = with_unit(field);
    if matches!(field.values, Values::Bits(_)) {
        meaning = format!("{meaning}: {}", listed(field.values));
    }
    meaning += &entry.elsewhere(field);
    let mut reset = String::new();
    match &entry.field_resets(field)[..] {
        [] => {}
        [one] => reset = format!(" = 0x{one:X}"),
        // A regfile has one definition for all channels: what differs can only be told.
        more => {
            let more: Vec<String> = more.iter().map(u32::to_string).collect();
            meaning = format!("{meaning}; after reset {}", more.join(", "));
        }
    }
    let mut properties = format!("desc = {};", quoted(&meaning));
    if matches!(field.values, Values::Codes(_)) {
        properties.push_str(&format!(" encode = {};", enumeration_name(field)));
    }
    let _ = writeln!(
        text,
        "            field {{ {properties} }} {}[{}:{}]{reset};",
        identifier(field.name),
        field.lsb + field.width - 1,
        field.lsb
    );
}

fn identifier(name: &str) -> String {
    match KEYWORDS.split_ascii_whitespace().any(|word| word == name) {
        true => format!("\\{name}"),
        false => name.to_owned(),
    }
}

/// A string of SystemRDL.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
