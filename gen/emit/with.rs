//! Leaves out of an emission what nobody has asked for.

use crate::language::Language;
use endat_config::extras::{ALL, DRIVER, EXTRAS};
use endat_config::Configuration;
use endat_console::artifact::{self, Artifact};
use endat_console::error::CommandError;
use endat_hdl::card::bus::HostBus;
use std::collections::BTreeSet;

/// What is asked for as files of a VHDL core anyway: its instantiation template.
const OF_VHDL: [&str; 2] = ["_component.vhd", "_instance.vho"];

/// The files of a configuration in a language: those of the card, and the extras that are asked for; the MANIFEST last.
pub fn emit_with(
    configuration: &Configuration,
    language: Language,
    with: &[String],
) -> Result<Vec<Artifact>, CommandError> {
    let (name, mut artifacts, has_map) = match configuration {
        Configuration::Card(card) => {
            let has_map = card.bus != HostBus::Bare;
            (&card.name, crate::emit_in(card, language)?, has_map)
        }
        Configuration::Receiver(receiver) => {
            let artifacts = crate::protocols::t_format::emit_in(receiver, language)?;
            (&receiver.name, artifacts, false)
        }
    };
    let asks_all = with.iter().any(|word| word == ALL);
    let is_asked = |word: &str| asks_all || with.iter().any(|asked| asked == word);
    if is_asked(DRIVER) && has_map {
        artifacts.extend(crate::driver::artifacts());
    }
    let (mut dropped, mut left_out) = (BTreeSet::new(), Vec::new());
    for extra in EXTRAS {
        let is_of = |file: &&Artifact| {
            let end = file.path.strip_prefix(name.as_str());
            let is_driver = extra.word == DRIVER && crate::driver::is_of(&file.path);
            is_driver || end.is_some_and(|end| extra.ends.contains(&end))
        };
        let files: Vec<String> = artifacts
            .iter()
            .filter(is_of)
            .map(|file| file.path.clone())
            .collect();
        if files.is_empty() && with.iter().any(|word| word == extra.word) {
            return Err(CommandError::input(format!(
                "with = {:?}: {name} has no such file ({}); leave it out, or give a configuration with another bus",
                extra.word, extra.means
            )));
        }
        let is_usual = |file: &String| {
            let end = file.strip_prefix(name.as_str()).unwrap_or_default();
            language == Language::Vhdl && OF_VHDL.contains(&end)
        };
        if !is_asked(extra.word) {
            let is_one = !files.is_empty() || extra.word == DRIVER && has_map;
            left_out.extend(is_one.then_some(extra.word));
            dropped.extend(files.into_iter().filter(|file| !is_usual(file)));
        }
    }
    artifacts.retain(|file| file.path != artifact::MANIFEST && !dropped.contains(&file.path));
    for readme in artifacts
        .iter_mut()
        .filter(|file| file.path == artifact::README)
    {
        readme.text = rows(
            &readme.text,
            &dropped,
            is_asked(DRIVER) && has_map,
            &left_out,
        );
    }
    artifacts.push(artifact::manifest(&artifacts));
    Ok(artifacts)
}

/// The page without the rows of these files, with that of the driver, and with the words for what is left out.
fn rows(page: &str, dropped: &BTreeSet<String>, has_driver: bool, left_out: &[&str]) -> String {
    let mut text = String::with_capacity(page.len());
    for line in page.split_inclusive('\n') {
        let row = line.strip_prefix("| `").and_then(|row| row.split_once('`'));
        let file = row.map_or("", |(file, _)| file);
        if dropped.contains(file) {
            continue;
        }
        let is_last = file == artifact::MANIFEST;
        if is_last && has_driver {
            text += crate::driver::ROW;
            text.push('\n');
        }
        text += line;
        if is_last && !left_out.is_empty() {
            text += &format!(
                "\n`emit --with WORD,...` adds files for other tools: {}.\n",
                left_out.join(", ")
            );
        }
    }
    text
}
