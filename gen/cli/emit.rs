//! `emit`: writes the files of a card, or checks them.

use super::{to_json, EmissionArgs, Outcome};
use clap::Args;
use endat_config::extras::{named, DRIVER};
use endat_config::Configuration;
use endat_console::artifact;
use endat_console::error::CommandError;
use endat_emit::with::Whole;
use endat_terminal::work::{interrupted, say};
use serde_json::json;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

/// Arguments of `emit`.
#[derive(Args, Default)]
pub struct EmitArgs {
    #[command(flatten)]
    emission: EmissionArgs,
    /// Files besides those of the card, as `endat-gen explain with` lists them; adds to the key `with` of the configuration
    #[arg(long, value_name = "EXTRA", value_delimiter = ',')]
    with: Vec<String>,
    /// Old spelling of --with driver
    #[arg(long, hide = true)]
    driver: bool,
    /// Overwrite files that have been changed, or that were not written by this command
    #[arg(long, conflicts_with = "check")]
    force: bool,
    /// Write nothing; exit with 1 when a file is not what the configuration gives
    #[arg(long)]
    check: bool,
    /// What has been written, as JSON
    #[arg(long, conflicts_with = "check")]
    json: bool,
}

impl EmitArgs {
    /// What the command line asks for besides the card.
    fn asked(&self) -> Vec<String> {
        let old = self.driver.then(|| DRIVER.to_owned());
        self.with.iter().cloned().chain(old).collect()
    }

    /// What is asked for besides the card: there, and in the configuration.
    fn with(&self, configuration: &Configuration) -> Result<Vec<String>, CommandError> {
        let asked = named(&self.asked())?;
        Ok([configuration.with(), &asked].concat())
    }
}

/// Runs the command.
pub fn run(arguments: &EmitArgs) -> Result<Outcome, CommandError> {
    let stop = interrupted();
    let language = arguments.emission.language()?;
    let (configuration, folder) = arguments.emission.load()?;
    let with = arguments.with(&configuration)?;
    let artifacts = Whole::of(&configuration, language)?.with(&with)?;
    if arguments.driver {
        say("--driver is --with driver now");
    }
    if arguments.check {
        let mut found = artifact::differences(&folder, &artifacts);
        if found.is_empty() {
            return Ok(Outcome::good(format!(
                "{}: {} files, up to date\n",
                folder.display(),
                artifacts.len()
            )));
        }
        let is_foreign = !artifact::foreign(&folder, &artifacts).is_empty();
        found.push(format!(
            "renew with: {}",
            repair(&program(), arguments, is_foreign)
        ));
        return Err(CommandError::CheckFailed(found));
    }
    if !arguments.force {
        let foreign = artifact::foreign(&folder, &artifacts);
        if !foreign.is_empty() {
            return Err(CommandError::Input(foreign));
        }
    }
    let left = artifact::leftovers(&folder, &artifacts);
    let is_stopped = || stop.load(Ordering::Relaxed);
    let remedy = "give another folder with --out";
    let written = artifact::write_unless(&folder, &artifacts, remedy, &is_stopped)?;
    let mut lines: String = written
        .iter()
        .map(|path| format!("{}\n", path.display()))
        .collect();
    let mut messages = left.kept;
    let mut removed = vec![];
    for path in left.removable {
        match std::fs::remove_file(&path) {
            Ok(()) if arguments.json => removed.push(path.display().to_string()),
            Ok(()) => lines.push_str(&format!("{}: removed\n", path.display())),
            Err(e) => messages.push(format!(
                "{}: is no longer emitted, and cannot be removed: {e}; delete it",
                path.display()
            )),
        }
    }
    if arguments.json {
        let written = written.iter().map(|path| path.display().to_string());
        let files = artifacts.iter().map(|file| &file.path);
        lines = to_json(&json!({
            "folder": folder.display().to_string(),
            "files": files.collect::<Vec<_>>(),
            "written": written.collect::<Vec<_>>(),
            "removed": removed,
        }))?;
    }
    if lines.is_empty() {
        lines = format!(
            "{}: {} files, up to date\n",
            folder.display(),
            artifacts.len()
        );
    }
    Ok(Outcome {
        messages,
        ..Outcome::good(lines)
    })
}

/// The command that makes the check pass; `force` if files would be lost by it.
fn repair(program: &str, arguments: &EmitArgs, force: bool) -> String {
    let emission = &arguments.emission;
    let mut words = Vec::new();
    let mut add = |flag: &str, value: Option<String>| {
        if let Some(value) = value {
            words.push(format!("{flag} {}", quoted(&value)));
        }
    };
    add(
        "--config",
        emission
            .source
            .config
            .as_ref()
            .map(|p| p.display().to_string()),
    );
    add("--preset", emission.source.preset.clone());
    add("--board", emission.target.board.clone());
    add(
        "--out",
        emission.out.as_ref().map(|p| p.display().to_string()),
    );
    add("--name", emission.name.clone());
    add("--language", emission.language.clone());
    let with = arguments.asked();
    if !with.is_empty() {
        words.push(format!("--with {}", with.join(",")));
    }
    if force {
        words.push("--force".into());
    }
    words.insert(0, format!("{program} emit"));
    words.join(" ")
}

/// This program as it was called: `cargo run --` from the sources' target folder, its own name where it is installed.
pub(super) fn program() -> String {
    called(std::env::args_os().next().map(PathBuf::from))
}

fn called(name: Option<PathBuf>) -> String {
    let name = name.unwrap_or_else(|| "endat-gen".into());
    let folders = [name.parent(), name.ancestors().nth(2)];
    let is_built = |profile: &str| {
        let target = format!("target/{profile}");
        folders
            .into_iter()
            .flatten()
            .any(|folder| folder.ends_with(&target))
    };
    match () {
        () if is_built("debug") => "cargo run --".into(),
        () if is_built("release") => "cargo run --release --".into(),
        () => quoted(&name.to_string_lossy()),
    }
}

/// A word for a POSIX shell.
pub(super) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./=:,+".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.into()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_installed_program_names_itself() {
        let called = |name: &str| called(Some(name.into()));
        assert_eq!(called("/src/core/target/debug/endat-gen"), "cargo run --");
        assert_eq!(called("target/release/endat-gen"), "cargo run --release --");
        assert_eq!(called("endat-gen"), "endat-gen");
        assert_eq!(called("/my tools/endat-gen"), "'/my tools/endat-gen'");
    }

    #[test]
    fn the_repair_command_can_be_pasted_into_a_shell() {
        let repair = |arguments: &EmitArgs, force| repair("cargo run --", arguments, force);
        assert_eq!(repair(&EmitArgs::default(), false), "cargo run -- emit");
        assert_eq!(
            repair(&EmitArgs::default(), true),
            "cargo run -- emit --force"
        );
        let out = Some(PathBuf::from("my 'files'"));
        let arguments = EmitArgs {
            emission: EmissionArgs {
                out,
                name: Some("a".into()),
                ..EmissionArgs::default()
            },
            ..EmitArgs::default()
        };
        assert_eq!(
            repair(&arguments, false),
            r"cargo run -- emit --out 'my '\''files'\''' --name a"
        );
    }
}
