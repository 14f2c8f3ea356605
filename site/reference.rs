//! Pages that tables and the program itself fill.

use crate::Page;
use clap::Command;
use endat_config::load_preset;
use endat_console::error::CommandError;
use endat_regs::{causes, Protocol};
use std::fmt::Write;

/// All of them.
pub fn pages() -> Result<Vec<Page>, CommandError> {
    Ok(vec![
        Page::new("commands", commands()),
        Page::new("causes", causes_page()),
        Page::new(
            "registers",
            registers("s6_two_channel_service", "Registers")?,
        ),
        Page::new(
            "registers_of_t_format",
            registers("mixed_protocols", "Registers with T-format")?,
        ),
    ])
}

/// What `--help` says of each command.
fn commands() -> String {
    let mut text = String::from("# Every command and option\n\nAs `--help` has them.\n");
    for program in [endat_gen::cli::command_line(), endat::command_line()] {
        let mut command = program.disable_help_subcommand(true).term_width(100);
        command.build();
        all(&mut command, &mut text);
    }
    text
}

fn all(command: &mut Command, text: &mut String) {
    let name = command
        .get_bin_name()
        .unwrap_or(command.get_name())
        .to_owned();
    let help = command.render_long_help();
    let _ = write!(
        text,
        "\n## {name}\n\n```text\n{}\n```\n",
        help.to_string().trim_end()
    );
    for command in command.get_subcommands_mut().filter(|c| !c.is_hide_set()) {
        all(command, text);
    }
}

/// Every cause, with what to do.
fn causes_page() -> String {
    let mut text = String::from(
        "# Causes\n\nWhy a trigger brought no position, or what there is to say about the one that it brought. `explain CAUSE` tells the same.\n",
    );
    for protocol in Protocol::ALL {
        let (title, all) = (protocol.name(), protocol.row().causes);
        let _ = write!(
            text,
            "\n## {title}\n\n| code | cause | meaning | what it means | what to do |\n|---|---|---|---|---|\n"
        );
        for cause in all {
            let [means, helps] = causes::advice(cause.name).unwrap_or_default();
            let _ = writeln!(
                text,
                "| {} | `{}` | {} | {means} | {helps} |",
                cause.code, cause.name, cause.meaning
            );
        }
    }
    text
}

/// The register map of a preset's card, as it is emitted beside the card.
fn registers(preset: &str, title: &str) -> Result<String, CommandError> {
    let files = endat_emit::emit(&load_preset(preset)?)?;
    let map = files
        .iter()
        .find(|file| file.path.ends_with("_registers.md"));
    let map = map.map_or("", |file| &file.text);
    let (_, map) = map.split_once('\n').unwrap_or_default();
    Ok(format!(
        "# {title}\n\nThose of the card `{preset}`; each card is emitted with its own.\n{map}"
    ))
}
