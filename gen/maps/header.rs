//! The register map as a header for C99 and C++: macros only, so that it asks for nothing and fits any way of access.

use super::{with_unit, Map, MapBlock, MapRegister};
use endat_regs::Values;
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
    let [major, minor, patch] = map.version;
    let base_address = match map.base_address {
        0 => String::new(),
        base => format!(
            "/* Where a system has the registers: a register is at this and its ..._BYTE */\n#define {prefix}_BASE_ADDRESS 0x{base:08X}u\n"
        ),
    };
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

/* Version of the register map; within a major version no address and no field moves. */
#define {prefix}_MAP_MAJOR {major}u
#define {prefix}_MAP_MINOR {minor}u
#define {prefix}_MAP_PATCH {patch}u
/* Encoder ports */
#define {prefix}_CHANNELS {channels}u
{base_address}
/* Content of a field in a word that was read, and a field's content as part of a word to be written: */
/* {prefix}_GET({prefix}_RESULT_STATUS_CAUSE, word) */
#define {prefix}_GET(field, word) (((word) & field##_MASK) >> field##_SHIFT)
#define {prefix}_PUT(field, value) (((value) << field##_SHIFT) & field##_MASK)
",
        title = map.title(),
        origin = map.origin,
        channels = map.channels,
    )
}

pub(super) fn write_block(text: &mut String, block: &MapBlock, prefix: &str) {
    let (table, base_bytes) = (&block.block, block.base_bytes());
    let name = format!("{prefix}_{}", block.block.name.to_ascii_uppercase());
    let _ = writeln!(
        text,
        "\n/* ---- {} {} */\n",
        block.block.name,
        dashes(block.block.name)
    );
    let _ = writeln!(text, "/* {} */", table.meaning);
    let _ = writeln!(text, "#define {name}_BASE_WORD 0x{:03X}u", table.base);
    let _ = writeln!(text, "#define {name}_BASE_BYTE 0x{base_bytes:04X}u");
    if table.per_channel {
        let _ = writeln!(text, "#define {name}_STRIDE_WORDS {}u", table.stride);
        let _ = writeln!(
            text,
            "#define {name}_STRIDE_BYTES {}u",
            block.stride_bytes()
        );
    }
    for entry in &block.registers {
        let register = entry.register;
        let name = format!("{name}_{}", register.name.to_ascii_uppercase());
        let word = table.address(register, 0);
        let byte = u32::from(word) * super::WORD_BYTES;
        let access = register.access.short();
        let _ = writeln!(text, "\n/* {access}: {} */", register.meaning);
        let _ = match table.per_channel {
            true => writeln!(
                text,
                "#define {name}_WORD(channel) (0x{word:03X}u + {}u * (channel))\n\
                 #define {name}_BYTE(channel) (0x{byte:04X}u + {}u * (channel))",
                table.stride,
                block.stride_bytes()
            ),
            false => writeln!(
                text,
                "#define {name}_WORD 0x{word:03X}u\n#define {name}_BYTE 0x{byte:04X}u"
            ),
        };
        write_resets(text, entry, &name);
        write_fields(text, entry, &name);
    }
}

/// Fills the line of a heading.
fn dashes(heading: &str) -> String {
    "-".repeat(70usize.saturating_sub(heading.len()))
}

/// One value, or one for each channel where they differ.
fn write_resets(text: &mut String, entry: &MapRegister, name: &str) {
    if entry.reset_mask() == u32::MAX {
        let _ = writeln!(text, "#define {name}_RESET 0x{:08X}u", entry.reset());
        return;
    }
    for (channel, reset) in entry.resets.iter().enumerate() {
        let _ = writeln!(text, "#define {name}_RESET_{channel} 0x{reset:08X}u");
    }
}

fn write_fields(text: &mut String, entry: &MapRegister, register: &str) {
    for field in entry.register.fields {
        let name = format!("{register}_{}", field.name.to_ascii_uppercase());
        let _ = writeln!(text, "/* {}: {} */", field.name, with_unit(field));
        let _ = writeln!(text, "#define {name}_SHIFT {}u", field.lsb);
        let _ = writeln!(text, "#define {name}_MASK 0x{:08X}u", field.mask());
        write_values(text, &name, field.values);
        if let Some(values) = entry.t_format_values(field) {
            let _ = writeln!(text, "/* {}: on a T-format channel */", field.name);
            write_values(text, &format!("{name}_T_FORMAT"), values);
        }
    }
}

fn write_values(text: &mut String, name: &str, values: Values) {
    let (listed, is_bits) = match values {
        Values::Plain => return,
        Values::Codes(listed) => (listed, false),
        Values::Bits(listed) => (listed, true),
    };
    for value in listed {
        let constant = match is_bits {
            // As the content of the field: after ..._GET.
            true => format!("0x{:X}u", 1u32 << value.number),
            false => format!("{}u", value.number),
        };
        let _ = writeln!(
            text,
            "#define {name}_{} {constant} /* {} */",
            value.name.to_ascii_uppercase(),
            value.meaning
        );
    }
}
