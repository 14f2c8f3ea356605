//! The register map as a Markdown page.

use super::{listed, number, Map, MapBlock, UNLISTED};
use endat_hdl::regs::Field;
use std::fmt::Write;

/// The page; addresses are words.
pub fn write(map: &Map) -> String {
    let mut text = format!(
        "# Register map\n\nVersion {}. Word addresses; words are 32 bits wide. {UNLISTED}\n",
        map.version()
    );
    for block in &map.blocks {
        write_block(&mut text, block);
    }
    if !map.steps.is_empty() {
        text.push_str("\n## Steps of the initialisation\n\n| step | |\n|---|---|\n");
        for (index, step) in map.steps.iter().enumerate() {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "| {} | {step} |", index + 1);
        }
    }
    text
}

fn write_block(text: &mut String, block: &MapBlock) {
    let table = &block.block;
    let (name, base) = (table.name, table.base);
    let _ = match table.per_channel {
        true => writeln!(
            text,
            "\n## `{name}<n>`: channel n at 0x{base:03X} + {} n\n",
            table.stride
        ),
        false => writeln!(text, "\n## `{name}` at 0x{base:03X}\n"),
    };
    let _ = writeln!(text, "{}\n", table.meaning);
    let _ = writeln!(
        text,
        "| word | register | access | bits | field | unit | reset | meaning |"
    );
    let _ = writeln!(text, "|---|---|---|---|---|---|---|---|");
    for entry in &block.registers {
        let register = entry.register;
        let place = match table.per_channel {
            true => format!("+{}", register.offset),
            false => format!("0x{:03X}", base + register.offset),
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
            let resets: Vec<String> = entry
                .field_resets(field)
                .iter()
                .map(|r| number(*r))
                .collect();
            let _ = writeln!(
                text,
                "| | | | {bits} | `{}` | {} | {} | {} |",
                field.name,
                field.unit,
                resets.join(", "),
                meaning(field)
            );
        }
    }
}

fn meaning(field: &Field) -> String {
    match listed(field.values).as_str() {
        "" => field.meaning.to_owned(),
        list => format!("{}: {list}", field.meaning),
    }
}
