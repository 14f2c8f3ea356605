//! What the C driver knows of cards: the whole register map, and the texts of what a card tells. Of no configuration, so that one driver
//! serves every card; what a card has, it says itself.

use super::{header, Map, MapBlock, MapRegister};
use endat_config::names;
use endat_console::artifact::Artifact;
use endat_regs::protocols::t_format::RESETS_IN_A_ROW;
use endat_regs::service::{request_state, NAME_PLATE, STEPS};
use endat_regs::{
    causes, Named, Protocol, BLOCKS, CHANNELS_MAX, ID, INFO_FIRST, MAP_BYTES, VERSION,
};
use std::fmt::Write;

/// What all macros begin with; a card's own header has the card's name there.
const PREFIX: &str = "ENDAT_MAP";
const ORIGIN: &str =
    "Written by endat-gen from its register table. Do not edit: UPDATE_EXPECT=1 cargo test --test cards driver writes it again.";

/// Map and texts, as they lie beside the driver.
pub fn artifacts() -> Vec<Artifact> {
    vec![
        Artifact::new("endat_map.h", map()),
        Artifact::new("endat_texts.c", texts()),
    ]
}

/// Every block with every word, of as many channels as a card can have.
fn all_blocks() -> Vec<MapBlock> {
    let register = |register| MapRegister {
        register,
        resets: vec![],
        spoken: Protocol::ALL.to_vec(),
    };
    BLOCKS
        .iter()
        .map(|block| MapBlock {
            block,
            copies: if block.per_channel {
                CHANNELS_MAX as u32
            } else {
                1
            },
            registers: block.registers.iter().map(register).collect(),
        })
        .collect()
}

fn map() -> String {
    let map = Map {
        name: PREFIX.to_ascii_lowercase(),
        origin: ORIGIN.into(),
        version: VERSION,
        protocols: names(Protocol::ALL.iter().copied()),
        channels: CHANNELS_MAX as u32,
        base_address: 0,
        blocks: all_blocks(),
    };
    let [major, minor, patch] = map.version;
    let mut text = format!(
        "/**
 * @file endat_map.h
 * Register map {version} of every card, whatever its configuration.
 *
 * {ORIGIN}
 *
 * ..._WORD counts words of 32 bits, ..._BYTE bytes: 4 * ..._WORD. Of blocks that each channel has, both take the channel.
 */
#ifndef {PREFIX}_H
#define {PREFIX}_H

/* Version of the register map; within a major version no address and no field moves. */
#define {PREFIX}_MAJOR {major}u
#define {PREFIX}_MINOR {minor}u
#define {PREFIX}_PATCH {patch}u
/* Encoder ports of the largest card */
#define {PREFIX}_CHANNELS_MAX {CHANNELS_MAX}u
/* Bytes that the largest map takes */
#define {PREFIX}_BYTES 0x{MAP_BYTES:04X}u
/* What card.id reads as */
#define {PREFIX}_ID 0x{ID:08X}u
/* Words of a result; on cards with requests its additional data follow */
#define {PREFIX}_RESULT_WORDS {INFO_FIRST}u
#define {PREFIX}_RESULT_WORDS_WITH_INFOS {with_infos}u

/* How often in a row a T-format encoder takes a request that clears something */
#define {PREFIX}_T_FORMAT_RESETS_IN_A_ROW {RESETS_IN_A_ROW}u

/* Content of a field in a word that was read, and a field's content as part of a word to be written. */
#define {PREFIX}_GET(field, word) (((word) & field##_MASK) >> field##_SHIFT)
#define {PREFIX}_PUT(field, value) (((value) << field##_SHIFT) & field##_MASK)
",
        version = map.version(),
        with_infos = endat_regs::RESULT.registers.len(),
    );
    for block in &map.blocks {
        header::write_block(&mut text, block, PREFIX);
        write_limits(&mut text, block);
    }
    write_causes(&mut text);
    // Writing to a String cannot fail.
    let _ = writeln!(text, "\n#endif");
    text
}

/// Causes as the driver tells them.
fn write_causes(text: &mut String) {
    text.push_str("\n/* What a channel speaks */\n");
    for protocol in Protocol::ALL {
        let (name, number) = (protocol.row().word.to_ascii_uppercase(), *protocol as u8);
        let _ = writeln!(
            text,
            "#define ENDAT_PROTOCOL_{name} {number}u /* {} */",
            protocol.row().means
        );
    }
    text.push_str("\n/* Causes as the driver tells them, of all protocols */\n");
    for cause in causes::ALL {
        let name = named(cause.number as u8);
        let _ = writeln!(
            text,
            "#define ENDAT_CAUSE_{name} {}u /* {} */",
            cause.number, cause.meaning
        );
    }
}

/// Least and greatest number that a channel of each protocol takes, where one range says it.
fn write_limits(text: &mut String, block: &MapBlock) {
    for entry in &block.registers {
        for field in entry.register.fields {
            let name = [block.block.name, entry.register.name, field.name].join("_");
            let name = name.to_ascii_uppercase();
            for protocol in Protocol::ALL {
                let [(least, greatest)] = field.ranges(*protocol) else {
                    continue;
                };
                let is_as_in_endat = *protocol != Protocol::Endat && protocol.own(field).is_none();
                let is_all = (*least, *greatest) == (0, field.mask() >> field.lsb);
                if is_as_in_endat || is_all {
                    continue;
                }
                let (channel, suffix) = match protocol {
                    Protocol::Endat => Default::default(),
                    other => (
                        format!(" on {}", other.row().channel),
                        format!("_{}", other.row().word.to_ascii_uppercase()),
                    ),
                };
                // Writing to a String cannot fail.
                let _ = writeln!(
                    text,
                    "\n/* What {} takes{channel} */\n#define {PREFIX}_{name}{suffix}_MIN {least}u\n#define {PREFIX}_{name}{suffix}_MAX {greatest}u",
                    field.name
                );
            }
        }
    }
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// An array of texts, each at its number; a hole is no text.
fn list(text: &mut String, name: &str, about: &str, rows: &[(u32, String)]) {
    let _ = writeln!(
        text,
        "\n/* {about} */\nstatic const char *const {name}[] = {{"
    );
    let greatest = rows.iter().map(|row| row.0).max().unwrap_or(0);
    for number in 0..=greatest {
        let row = rows.iter().find(|row| row.0 == number);
        let row = row.map_or("NULL".into(), |row| row.1.clone());
        let _ = writeln!(text, "    {row},");
    }
    text.push_str("};\n");
}

fn meanings(named: &[Named]) -> Vec<(u32, String)> {
    named
        .iter()
        .map(|n| (n.number, quoted(n.meaning)))
        .collect()
}

/// What each channel speaks, and the function that makes one list of the causes of all protocols.
fn write_protocols(text: &mut String) {
    let others = || Protocol::ALL.iter().filter(|p| **p != Protocol::Endat);
    for protocol in others() {
        let number = |code: &Named| causes::number(code.number as u8, *protocol);
        let numbers = protocol.row().coded.iter();
        let numbers: Vec<String> = numbers
            .map(|code| format!("    ENDAT_CAUSE_{},", named(number(code))))
            .collect();
        let _ = write!(
            text,
            "\n/* Causes of {}, each at its code */\nstatic const uint8_t {}_causes[] = {{\n{}\n}};\n",
            protocol.name(),
            protocol.row().word,
            numbers.join("\n")
        );
    }
    let mut cases = String::new();
    let mut speaks = String::new();
    for protocol in others() {
        let word = protocol.row().word;
        let name = word.to_ascii_uppercase();
        let _ = write!(
            cases,
            "    if (protocol == ENDAT_PROTOCOL_{name}) {{\n        cause = (code < (uint32_t)sizeof {word}_causes) ? {word}_causes[code] : ({}u + code);\n    }}\n",
            u32::from(causes::CODES) * *protocol as u32
        );
        let _ = write!(
            speaks,
            "    if (((ENDAT_MAP_GET(ENDAT_MAP_CARD_PROTOCOLS_{name}, word) >> channel) & 1u) != 0u) {{\n        protocol = ENDAT_PROTOCOL_{name};\n    }}\n",
        );
    }
    let _ = write!(
        text,
        "\nuint8_t endat_cause_of(uint32_t code, uint32_t protocol)\n{{\n    uint32_t cause = code;\n\n{cases}    return (uint8_t)cause;\n}}\n\n\
         uint32_t endat_protocol_of(uint32_t word, uint32_t channel)\n{{\n    uint32_t protocol = ENDAT_PROTOCOL_ENDAT;\n\n{speaks}    return protocol;\n}}\n",
    );
}

/// How the constant of a cause is called behind its prefix.
fn named(number: u8) -> String {
    causes::of(number).map_or_else(String::new, |cause| cause.name.to_ascii_uppercase())
}

/// One function that hands out the texts of a list.
fn function(text: &mut String, name: &str, list: &str) {
    let _ = write!(
        text,
        "\nconst char *{name}(uint32_t number)\n{{\n    const char *text = NULL;\n\n    \
         if (number < (uint32_t)(sizeof {list} / sizeof {list}[0])) {{\n        text = {list}[number];\n    }}\n    \
         return (text != NULL) ? text : \"unknown\";\n}}\n"
    );
}

fn texts() -> String {
    let mut text = format!(
        "/**\n * @file endat_texts.c\n * What the numbers of a card say, and what to do about them.\n *\n * {ORIGIN}\n */\n\
         #include \"endat.h\"\n#include \"endat_internal.h\"\n#include <stddef.h>\n"
    );
    write_protocols(&mut text);
    let advice = |which: usize| -> Vec<(u32, String)> {
        let of = |cause: &Named| {
            let advice = causes::advice(cause.name).map_or("", |both| both[which]);
            (cause.number, quoted(advice))
        };
        causes::ALL.iter().map(of).collect()
    };
    let words = |word: &endat_regs::service::PlateEntry| quoted(word.meaning);
    let plate: Vec<(u32, String)> = (0..).zip(NAME_PLATE.iter().map(words)).collect();
    for (function_name, list_name, about, rows) in [
        (
            "endat_cause_text",
            "causes",
            "Causes of a result",
            meanings(causes::ALL),
        ),
        (
            "endat_cause_meaning",
            "meanings",
            "What they mean",
            advice(0),
        ),
        (
            "endat_cause_remedy",
            "remedies",
            "What to do about them",
            advice(1),
        ),
        (
            "endat_refusal_text",
            "refusals",
            "What became of a request",
            meanings(request_state::ERRORS),
        ),
        (
            "endat_step_text",
            "steps",
            "Steps of the initialisation",
            meanings(STEPS),
        ),
        (
            "endat_plate_text",
            "plate",
            "Words of the name plate",
            plate,
        ),
    ] {
        list(&mut text, list_name, about, &rows);
        function(&mut text, function_name, list_name);
    }
    text
}
