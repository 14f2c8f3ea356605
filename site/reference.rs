//! Pages that tables and the program itself fill.

use crate::Page;
use clap::Command;
use endat_gen::cli::command_line;
use endat_gen::config::load_preset;
use endat_gen::error::GenError;
use endat_regs::{causes, Protocol};
use std::fmt::Write;

/// All of them.
pub fn pages() -> Result<Vec<Page>, GenError> {
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
    let mut command = command_line().disable_help_subcommand(true).term_width(100);
    command.build();
    let mut text = String::from("# Every command and option\n\nAs `--help` has them.\n");
    all(&mut command, &mut text);
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
fn registers(preset: &str, title: &str) -> Result<String, GenError> {
    let files = endat_gen::emit(&load_preset(preset)?)?;
    let map = files
        .iter()
        .find(|file| file.path.ends_with("_registers.md"));
    let map = map.map_or("", |file| &file.text);
    let (_, map) = map.split_once('\n').unwrap_or_default();
    Ok(format!(
        "# {title}\n\nThose of the card `{preset}`; each card is emitted with its own.\n{map}"
    ))
}
