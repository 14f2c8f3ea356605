//! The register map as a Markdown page.

use super::{listed, number, Map, MapBlock, MapRegister, UNLISTED};
use endat_regs::{Field, Named, Protocol, Values};
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
    text
}

/// Codes that a field lists itself; more of them get a table of their own.
const INLINE: usize = 16;

/// The codes of a field that get a table of their own.
fn long_list(values: Values) -> Option<&'static [Named]> {
    match values {
        Values::Codes(codes) if codes.len() > INLINE => Some(codes),
        _ => None,
    }
}

/// A table for each long list of codes in the block; fields that have the same share it.
fn write_long_lists(text: &mut String, block: &MapBlock) {
    let mut lists: Vec<(&[Named], Vec<String>)> = Vec::new();
    for entry in &block.registers {
        for field in entry.register.fields {
            // A short list of another protocol beside a long one is a table, too.
            let is_long = long_list(field.values).is_some();
            let others = entry.values_elsewhere(field);
            let own = match others.is_empty() {
                true => format!("`{}`", field.name),
                false => format!("`{}` on {}", field.name, Protocol::Endat.row().channel),
            };
            let others = others.into_iter().map(|(protocol, values)| {
                let name = format!("`{}` on {}", field.name, protocol.row().channel);
                (values, name)
            });
            for (values, name) in std::iter::once((field.values, own)).chain(others) {
                let Values::Codes(codes) = values else {
                    continue;
                };
                if !is_long && long_list(values).is_none() {
                    continue;
                }
                match lists.iter_mut().find(|(known, _)| *known == codes) {
                    Some((_, names)) => names.push(name),
                    None => lists.push((codes, vec![name])),
                }
            }
        }
    }
    for (codes, names) in lists {
        let _ = writeln!(text, "\n| {} | name | |\n|---|---|---|", names.join(", "));
        for code in codes {
            let _ = writeln!(
                text,
                "| {} | `{}` | {} |",
                code.number, code.name, code.meaning
            );
        }
    }
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
                meaning(entry, field)
            );
        }
    }
    write_long_lists(text, block);
}

fn meaning(entry: &MapRegister, field: &Field) -> String {
    if long_list(field.values).is_some() {
        return format!("{}: see the table below", field.meaning);
    }
    let others = entry.elsewhere(field);
    match listed(field.values).as_str() {
        "" => format!("{}{others}", field.meaning),
        list => format!("{}: {list}{others}", field.meaning),
    }
}
