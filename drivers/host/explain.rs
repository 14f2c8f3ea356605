//! What a cause, a register, a field or a value is, in words.

use crate::causes;
use crate::feed::NO_CAUSES;
use crate::registers::{Access, Block, Field, Register, Values};
use endat_regs::{Named, Protocol, BLOCKS};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Whether the services count frames with this cause.
fn is_counted(counter: &str) -> bool {
    let service = BLOCKS.iter().filter(|block| block.name == "service");
    let mut registers = service.flat_map(|block| block.registers);
    registers.any(|register| register.name == counter)
}

/// Causes of all protocols; what one shares with EnDat is told once.
fn own_causes() -> impl Iterator<Item = (&'static Named, Protocol)> {
    let of = |protocol: &Protocol| {
        let (protocol, row) = (*protocol, protocol.row());
        let own = row.causes.iter().zip(row.coded);
        let own = own.filter(|(cause, _)| cause.advice.is_some());
        own.map(move |(_, named)| (named, protocol))
    };
    Protocol::ALL.iter().flat_map(of)
}

/// Codes of the same cause in other protocols, where they are others.
fn elsewhere(cause: &'static Named, protocol: Protocol) -> impl Iterator<Item = String> {
    let others = Protocol::ALL
        .iter()
        .filter(move |other| **other != protocol);
    let same = |other: &Protocol| {
        let found = other.row().coded.iter().find(|c| c.name == cause.name)?;
        (found.number != cause.number).then(|| format!(", of {} {}", other.name(), found.number))
    };
    others.filter_map(same)
}

/// Everything called `name`, in lower case: causes, registers, fields, values, with or without block and channel in front; empty if nothing
/// is.
pub fn text(name: &str) -> String {
    let mut text = String::new();
    // Behind everything that has the name itself.
    let mut values = String::new();
    let is_meant = |c: &&Named| c.name == name || c.number.to_string() == name;
    for (cause, protocol) in own_causes().filter(|(c, _)| is_meant(c)) {
        let [means, then] = causes::advice(cause.name).unwrap_or([cause.meaning, ""]);
        let of = match protocol {
            Protocol::Endat => String::new(),
            other => format!(" of {}", other.name()),
        };
        let other: String = elsewhere(cause, protocol).collect();
        let _ = writeln!(
            text,
            "cause {}{of}{other} ({}): {}\n  {means}\n  {then}",
            cause.number, cause.name, cause.meaning
        );
        let counter = match cause.name {
            "none" => "frames_good".to_owned(),
            name => format!("frames_{name}"),
        };
        if of.is_empty() && is_counted(&counter) {
            let _ = writeln!(
                text,
                "  counted in service<n>.{counter}, on cards with the part requests"
            );
        }
    }
    for (_, means) in NO_CAUSES.iter().filter(|(n, _)| *n == name) {
        let _ = writeln!(text, "in rows of log and serve, {name}: {means}");
    }
    let parts: Vec<&str> = name.split('.').collect();
    for block in BLOCKS {
        let block_matches = |part: &str| {
            part == block.name
                || part == "config" && block.name == "card_config"
                || block.per_channel
                    && part.trim_end_matches(|c: char| c.is_ascii_digit()) == block.name
        };
        if parts.len() == 1 && block_matches(name) {
            let _ = writeln!(text, "block {}: {}", block.name, block.meaning);
            let names: Vec<&str> = block.registers.iter().map(|r| r.name).collect();
            let _ = writeln!(text, "  registers: {}", names.join(", "));
        }
        for register in block.registers {
            let is_meant = match parts[..] {
                [one] => one == register.name,
                [first, second] => block_matches(first) && second == register.name,
                _ => false,
            };
            if is_meant {
                describe(&mut text, block, register);
            }
            for field in register.fields {
                let is_meant = match parts[..] {
                    [one] => one == field.name && field.name != "value",
                    [first, second] => first == register.name && second == field.name,
                    [first, second, third] => {
                        block_matches(first) && second == register.name && third == field.name
                    }
                    _ => false,
                };
                if is_meant {
                    let _ = writeln!(text, "field of {}", full(block, register));
                    field_text(&mut text, field);
                }
                if parts.len() == 1 && field.name != "cause" {
                    let own = &full(block, register);
                    value_text(&mut values, name, own, field, field.values);
                    for (protocol, others) in field.named_elsewhere() {
                        let own = format!("{}'s {own}", protocol.row().channel);
                        value_text(&mut values, name, &own, field, others);
                    }
                }
            }
        }
    }
    text + &values
}

/// All that may be asked for, each once.
pub fn names() -> BTreeSet<String> {
    let causes = causes::ALL.iter().map(|c| c.name.to_owned());
    let registers = BLOCKS.iter().flat_map(|block| {
        let of_register = |r: &Register| {
            let fields = r.fields.iter().map(|f| f.name.to_owned());
            let own = [r.name.to_owned(), full(block, r)];
            fields.chain(own).collect::<Vec<_>>()
        };
        let all = block.registers.iter().flat_map(of_register);
        all.chain([block.name.to_owned()]).collect::<Vec<_>>()
    });
    causes.chain(registers).collect()
}

/// What `name` stands for in a field: a number, or a bit.
fn value_text(text: &mut String, name: &str, register: &str, field: &Field, values: Values) {
    let (kind, values) = match values {
        Values::Plain => return,
        Values::Codes(values) => ("value", values),
        Values::Bits(values) => ("bit", values),
    };
    // A field of each channel is told once.
    let field_name = match field.name.strip_prefix("channel_") {
        Some("0") => "channel_<n>",
        Some(_) => return,
        None => field.name,
    };
    for value in values.iter().filter(|v| v.name == name) {
        let _ = writeln!(
            text,
            "{kind} {} of {register}.{field_name}: {}",
            value.number, value.meaning
        );
    }
}

fn full(block: &Block, register: &Register) -> String {
    let number = if block.per_channel { "<n>" } else { "" };
    format!("{}{number}.{}", block.name, register.name)
}

fn describe(text: &mut String, block: &Block, register: &Register) {
    let access = match register.access {
        Access::ReadOnly => "read only",
        Access::ReadWrite => "read and write",
        Access::Strobe => "write only, acts once",
    };
    let address = block.base + register.offset;
    let place = match block.per_channel {
        true => format!("word 0x{address:03X} + {} n", block.stride),
        false => format!("word 0x{address:03X}"),
    };
    let _ = writeln!(
        text,
        "{}: {}\n  {place}, {access}",
        full(block, register),
        register.meaning
    );
    for field in register.fields {
        field_text(text, field);
    }
}

fn field_text(text: &mut String, field: &Field) {
    let unit = match field.unit {
        "" => String::new(),
        unit => format!(" ({unit})"),
    };
    let _ = writeln!(
        text,
        "  {:>5}  {}: {}{unit}",
        field.bit_range(),
        field.name,
        field.meaning
    );
    values_text(text, field.values);
    for (protocol, values) in field.named_elsewhere() {
        let _ = writeln!(text, "         on {}:", protocol.row().channel);
        values_text(text, values);
    }
}

fn values_text(text: &mut String, values: Values) {
    let (kind, values) = match values {
        Values::Plain => return,
        Values::Codes(values) => ("", values),
        Values::Bits(values) => ("bit ", values),
    };
    for value in values {
        let _ = writeln!(
            text,
            "           {kind}{} {}: {}",
            value.number, value.name, value.meaning
        );
    }
}
