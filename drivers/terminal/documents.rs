//! `completions` and `man`: what shells and manual readers know of the command line, from its own description.

use crate::outcome::Outcome;
use clap::{Args, Command};
use clap_complete::Shell;
use clap_mangen::Man;
use endat_console::artifact::{self, Artifact};
use endat_console::error::CommandError;
use std::path::PathBuf;

/// Arguments of `completions`.
#[derive(Args)]
pub struct CompletionsArgs {
    /// For which shell
    shell: Shell,
}

/// Arguments of `man`.
#[derive(Args)]
pub struct ManArgs {
    /// Write the pages of all commands into this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

fn fault(e: &dyn std::fmt::Display) -> CommandError {
    CommandError::fault("man", e)
}

/// Prints the completions for a shell.
pub fn completions(
    mut command: Command,
    arguments: &CompletionsArgs,
) -> Result<Outcome, CommandError> {
    let name = command.get_name().to_owned();
    let mut text = vec![];
    clap_complete::generate(arguments.shell, &mut command, name, &mut text);
    String::from_utf8(text)
        .map(Outcome::good)
        .map_err(|e| fault(&e))
}

/// Prints the manual page of the program, or writes those of all its commands.
pub fn man(command: Command, arguments: &ManArgs) -> Result<Outcome, CommandError> {
    let mut command = command.disable_help_subcommand(true);
    command.build();
    let Some(out) = &arguments.out else {
        return Ok(Outcome::good(page(&command)?.text));
    };
    let mut pages = vec![];
    all_pages(&command, &mut pages)?;
    let written = artifact::write(out, &pages, "give another folder with --out")?;
    let lines = written.iter().map(|path| format!("{}\n", path.display()));
    Ok(Outcome::good(lines.collect::<String>()))
}

fn page(command: &Command) -> Result<Artifact, CommandError> {
    let man = Man::new(command.clone());
    let mut text = vec![];
    man.render(&mut text).map_err(|e| fault(&e))?;
    let text = String::from_utf8(text).map_err(|e| fault(&e))?;
    Ok(Artifact::new(man.get_filename(), text))
}

/// The page of a command, and those of the commands in it.
fn all_pages(command: &Command, pages: &mut Vec<Artifact>) -> Result<(), CommandError> {
    pages.push(page(command)?);
    let commands = command.get_subcommands().filter(|c| !c.is_hide_set());
    commands
        .into_iter()
        .try_for_each(|command| all_pages(command, pages))
}
