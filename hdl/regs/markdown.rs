//! The register map as a Markdown page.

use super::{blocks, Block, Register, SERVICE_BASE};
use crate::config::CardConfig;
use crate::service::map::{word, COUNTER_POSITION_2};
use crate::service::program::{step_name, steps};
use crate::transaction::cause;
use std::fmt::Write;

/// The register map of a card.
pub fn markdown(config: &CardConfig) -> String {
    let mut text = String::from(
        "# Register map\n\n\
         Word addresses; words are 32 bits wide. Bits of no field read as 0, except in configuration words, which keep what is\n\
         written there (write 0). Addresses not listed read as 0 and writing them does nothing.\n",
    );
    for block in blocks(config) {
        write_block(&mut text, &block, config);
    }
    if config.service.initialise {
        text.push_str("\n## Steps of the initialisation\n\n| step | |\n|---|---|\n");
        for (index, step) in steps().into_iter().enumerate() {
            let _ = writeln!(text, "| {} | {} |", index + 1, step_name(step));
        }
    }
    text
}

fn write_block(text: &mut String, block: &Block, config: &CardConfig) {
    // Writing to a String cannot fail.
    let _ = if block.per_channel {
        writeln!(
            text,
            "\n## `{}<n>`: channel n at 0x{:03X} + {} n\n",
            block.name, block.base, block.stride
        )
    } else {
        writeln!(text, "\n## `{}` at 0x{:03X}\n", block.name, block.base)
    };
    let channels = if block.per_channel {
        config.channels.len()
    } else {
        1
    };
    let _ = writeln!(
        text,
        "| word | register | access | bits | field | unit | reset | meaning |"
    );
    let _ = writeln!(text, "|---|---|---|---|---|---|---|---|");
    let registers = block.registers.iter();
    for register in registers.filter(|r| has_register(block, r, config)) {
        let place = if block.per_channel {
            format!("+{}", register.offset)
        } else {
            format!("0x{:03X}", block.base + register.offset)
        };
        let _ = writeln!(
            text,
            "| {place} | `{}` | {} | | | | | {} |",
            register.name,
            register.access.short(),
            register.meaning
        );
        for field in register.fields {
            let bits = match field.width {
                1 => field.lsb.to_string(),
                width => format!("{}:{}", field.lsb + width - 1, field.lsb),
            };
            let mask = field.mask() >> field.lsb;
            let mut resets: Vec<String> = (0..channels)
                .map(|channel| number((field.start)(config, channel) as u32 & mask))
                .collect();
            resets.dedup();
            let _ = writeln!(
                text,
                "| | | | {bits} | `{}` | {} | {} | {} |",
                field.name,
                field.unit,
                resets.join(", "),
                field.meaning
            );
        }
    }
}

/// What only parts fill that the card does not have is left out.
fn has_register(block: &Block, register: &Register, config: &CardConfig) -> bool {
    let parts = config.service;
    let first_line = u16::from(word::COUNTERS) + cause::NO_ENCODER as u16;
    let past_line = u16::from(word::COUNTERS + COUNTER_POSITION_2);
    let at = |word: u8| register.offset == u16::from(word);
    block.base != SERVICE_BASE
        || if at(word::PROGRESS) || register.offset >= u16::from(word::NAME_PLATE) {
            parts.initialise
        } else if at(word::LIMITS) || (first_line..past_line).contains(&register.offset) {
            parts.diagnosis
        } else {
            !at(word::CONTINUOUS) || parts.continuous
        }
}

/// Small numbers in decimal, large ones that are no round decimal number in hexadecimal.
fn number(value: u32) -> String {
    if value < 0x1_0000 || value.is_multiple_of(1_000) {
        value.to_string()
    } else {
        format!("0x{value:08X}")
    }
}
