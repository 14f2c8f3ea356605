//! Leaves out of an emission the files that nobody has asked for.

use crate::language::Language;
use crate::{driver, protocols};
use endat_config::extras::{ALL, DRIVER, EXTRAS};
use endat_config::{Configuration, Project};
use endat_console::artifact::{self, Artifact};
use endat_console::error::CommandError;
use endat_hdl::card::bus::HostBus;
use std::collections::BTreeSet;

/// Extras that a core in VHDL always has: its instantiation template.
const OF_VHDL: [&str; 2] = ["_component.vhd", "_instance.vho"];

/// An emission with all extras.
pub struct Whole {
    name: String,
    language: Language,
    artifacts: Vec<Artifact>,
}

impl Whole {
    /// The emission of a configuration in a language.
    pub fn of(configuration: &Configuration, language: Language) -> Result<Self, CommandError> {
        match configuration {
            Configuration::Card(card) => Self::of_card(card, language),
            Configuration::Receiver(receiver) => Ok(Self {
                name: receiver.name.clone(),
                language,
                artifacts: protocols::t_format::emit_in(receiver, language)?,
            }),
        }
    }

    /// The emission of a card.
    pub fn of_card(card: &Project, language: Language) -> Result<Self, CommandError> {
        let mut artifacts = crate::emit_in(card, language)?;
        // A port without registers has nothing for the driver.
        if card.bus != HostBus::Bare {
            artifacts.extend(driver::artifacts());
            let last = format!("| `{}` |", artifact::MANIFEST);
            for page in pages(&mut artifacts) {
                let rows = format!("{}\n{last}", driver::ROW);
                page.text = page.text.replacen(&last, &rows, 1);
            }
        }
        Ok(Self {
            name: card.name.clone(),
            language,
            artifacts,
        })
    }

    /// All its files.
    pub fn artifacts(&self) -> &[Artifact] {
        &self.artifacts
    }

    /// Files of the card, and those of the extras in `with`; the MANIFEST is last.
    pub fn with(&self, with: &[String]) -> Result<Vec<Artifact>, CommandError> {
        let is_asked = |word: &str| with.iter().any(|asked| [ALL, word].contains(&&asked[..]));
        let (mut dropped, mut left_out) = (BTreeSet::new(), Vec::new());
        for extra in EXTRAS {
            let is_of = |path: &str| {
                let is_driver = extra.word == DRIVER && driver::is_of(path);
                is_driver || self.end(path).is_some_and(|end| extra.ends.contains(&end))
            };
            let paths = self.artifacts.iter().map(|file| file.path.as_str());
            let files: Vec<&str> = paths.filter(|path| is_of(path)).collect();
            if files.is_empty() && with.iter().any(|word| word == extra.word) {
                return Err(CommandError::input(format!(
                    "with = {:?}: {} has no such file ({}); leave it out, or give a configuration with another bus",
                    extra.word, self.name, extra.means
                )));
            }
            if !is_asked(extra.word) && !files.is_empty() {
                left_out.push(extra.word);
                dropped.extend(files.into_iter().filter(|path| !self.is_usual(path)));
            }
        }
        let is_kept = |file: &&Artifact| {
            file.path != artifact::MANIFEST && !dropped.contains(file.path.as_str())
        };
        let mut artifacts: Vec<Artifact> = self.artifacts.iter().filter(is_kept).cloned().collect();
        for page in pages(&mut artifacts) {
            page.text = rows(&page.text, &dropped, &left_out);
        }
        artifacts.push(artifact::manifest(&artifacts));
        Ok(artifacts)
    }

    /// The end of a file's name, after the name of the card.
    fn end<'a>(&self, path: &'a str) -> Option<&'a str> {
        path.strip_prefix(self.name.as_str())
    }

    fn is_usual(&self, path: &str) -> bool {
        let end = self.end(path);
        self.language == Language::Vhdl && end.is_some_and(|end| OF_VHDL.contains(&end))
    }
}

fn pages(artifacts: &mut [Artifact]) -> impl Iterator<Item = &mut Artifact> {
    let is_page = |file: &&mut Artifact| file.path == artifact::README;
    artifacts.iter_mut().filter(is_page)
}

/// The page without the rows of these files, and with the words of the extras that are left out.
fn rows(page: &str, dropped: &BTreeSet<&str>, left_out: &[&str]) -> String {
    let mut text = String::with_capacity(page.len());
    for line in page.split_inclusive('\n') {
        let row = line.strip_prefix("| `").and_then(|row| row.split_once('`'));
        let file = row.map_or("", |(file, _)| file);
        if dropped.contains(file) {
            continue;
        }
        text += line;
        if file == artifact::MANIFEST && !left_out.is_empty() {
            text += &format!(
                "\n`emit --with WORD,...` adds files for other tools: {}.\n",
                left_out.join(", ")
            );
        }
    }
    text
}
