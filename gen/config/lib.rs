//! Configuration files: TOML text in, a checked [`Project`] out, or every complaint with file, line and remedy.

pub mod arguments;
pub mod base;
pub mod board;
mod canonical;
mod channel;
mod device;
pub mod explain;
pub mod extras;
pub mod form;
pub mod forms;
pub mod json_schema;
pub mod keys;
mod line;
mod names;
mod outputs;
mod parts;
pub mod pins;
mod protocol;
pub mod protocols;
mod receiver;
mod safety;
pub mod schema;
mod service;
mod start;
mod stream;
pub mod template;
mod trigger;
pub mod words;

pub use names::{check_name, NAME_MAX};
pub use start::preset_for;

use crate::board::{Assignment, Board, Pll};
pub use crate::form::asked;
use crate::form::with_text;
pub use crate::form::{document, reader};
use endat_console::error::{shown, CommandError, Diagnostic};
use endat_hdl::card::bus::HostBus;
use endat_hdl::config::CardConfig;
use endat_regs::Protocol;
pub use receiver::Receiver;
use std::path::Path;
pub use words::{phase_name, start_name, RECEIVER_BUS};

/// The presets that come with the program: name and text.
pub const PRESETS: &[(&str, &str)] = &[
    (
        "s6_two_channel",
        include_str!("presets/s6_two_channel.toml"),
    ),
    (
        "s6_two_channel_service",
        include_str!("presets/s6_two_channel_service.toml"),
    ),
    (
        "safe_two_channel",
        include_str!("presets/safe_two_channel.toml"),
    ),
    ("clb_2mhz", include_str!("presets/clb_2mhz.toml")),
    (
        "ti_three_channel",
        include_str!("presets/ti_three_channel.toml"),
    ),
    (
        "artinchip_endat_if",
        include_str!("presets/artinchip_endat_if.toml"),
    ),
    (
        "mixed_protocols",
        include_str!("presets/mixed_protocols.toml"),
    ),
    (
        "ssi_two_channel",
        include_str!("presets/ssi_two_channel.toml"),
    ),
    ("demo", include_str!("presets/demo.toml")),
];
/// The presets of T-format receivers.
pub const RECEIVER_PRESETS: &[(&str, &str)] =
    &[("async_dsp", include_str!("presets/async_dsp.toml"))];
/// The preset that the program emits when nothing else is asked for.
pub const DEFAULT_PRESET: &str = "s6_two_channel";
/// What to do when a configuration cannot be read.
const REMEDY: &str = "give a TOML file; `endat-gen presets --show NAME` prints one to start from";

/// A checked configuration and all that follows from it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Project {
    /// Name of the folder, the files and the top module.
    pub name: String,
    /// The configuration file as the user named it.
    pub source: String,
    /// The card in the units of the blocks.
    pub card: CardConfig,
    /// What stands between the registers and the host.
    pub bus: HostBus,
    /// Where the registers begin in the address space of a system, in bytes; 0 behind a bus without one.
    pub base_address: u32,
    /// Encoder of each channel, for people; may be empty.
    pub encoders: Vec<String>,
    /// The board; none when somebody else's top holds the card.
    pub board: Option<Board>,
    /// The clock manager of the board.
    pub pll: Option<Pll>,
    /// Pin of every port of the board top, in the order of the ports; empty without a board.
    pub pins: Vec<Assignment>,
    /// First 12 hexadecimal digits of the SHA-256 of the resolved configuration.
    pub hash: String,
    /// What its emission has besides, as words of [`extras`].
    pub with: Vec<String>,
}

impl Project {
    /// What its channels speak, for titles.
    pub fn protocols(&self) -> String {
        let spoken = Protocol::ALL.iter().copied();
        names(spoken.filter(|p| self.card.speaks(*p)))
    }
}

/// Names of protocols, for titles.
pub fn names(protocols: impl IntoIterator<Item = Protocol>) -> String {
    let mut names: Vec<&str> = protocols.into_iter().map(|p| p.name()).collect();
    let last = names.pop().unwrap_or_default();
    match names.is_empty() {
        true => last.into(),
        false => format!("{} and {last}", names.join(", ")),
    }
}

/// Text of the preset with this name.
pub fn preset(name: &str) -> Result<&'static str, CommandError> {
    preset_of("--preset", name)
}

/// The text of the preset that an option asked for.
pub fn preset_of(option: &str, name: &str) -> Result<&'static str, CommandError> {
    let all = || PRESETS.iter().chain(RECEIVER_PRESETS);
    let found = all().find(|(n, _)| *n == name);
    found.map(|(_, text)| *text).ok_or_else(|| {
        let known: Vec<&str> = all().map(|(n, _)| *n).collect();
        CommandError::input(format!(
            "{option} = {}: unknown preset; known presets: {}",
            shown(name),
            known.join(", ")
        ))
    })
}

/// The shipped card on a board.
pub fn shipped_on(board: &Board) -> Result<Project, CommandError> {
    let text = preset_for("--preset", DEFAULT_PRESET, board)?;
    Ok(parse_on(&board.name, &text, Some(board))?)
}

/// A preset, checked.
pub fn load_preset(name: &str) -> Result<Project, CommandError> {
    Ok(parse(&format!("{name}.toml"), preset(name)?)?)
}

/// A configuration of either kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Configuration {
    /// A card.
    Card(Box<Project>),
    /// A T-format receiver.
    Receiver(Receiver),
}

impl Configuration {
    /// What its emission has besides, as words of [`extras`].
    pub fn with(&self) -> &[String] {
        match self {
            Self::Card(card) => &card.with,
            Self::Receiver(receiver) => &receiver.with,
        }
    }
}

/// A preset of either kind, checked.
pub fn load_any_preset(name: &str) -> Result<Configuration, CommandError> {
    Ok(parse_any(&format!("{name}.toml"), preset(name)?)?)
}

/// A configuration file of either kind, read and checked; a card comes onto `board`, if one is given.
pub fn load_any_file(path: &Path, board: Option<&Board>) -> Result<Configuration, CommandError> {
    with_text(path, REMEDY, |file, text| {
        Ok(parse_any_on(file, text, board)?)
    })
}

/// A configuration file, read and checked.
pub fn load_file(path: &Path) -> Result<Project, CommandError> {
    with_text(path, REMEDY, |file, text| Ok(parse(file, text)?))
}

/// Refuses text that is no TOML at first sight, where a parser's first complaint would mislead.
fn check_form(file: &str, text: &str) -> Result<(), Vec<Diagnostic>> {
    const REMEDY: &str =
        "`endat-gen presets --show s6_two_channel` prints a configuration to start from";
    let fail = |line, what: &str, remedy: &str| {
        Err(vec![Diagnostic {
            file: file.into(),
            line,
            text: format!("{what}; {remedy}"),
        }])
    };
    let start = text.trim_start();
    // A list of JSON begins like the head of a table, but no head has a brace or a number.
    let of_list = start.strip_prefix('[').map_or("", str::trim_start);
    if start.is_empty() {
        return fail(0, "is empty", REMEDY);
    }
    if start.starts_with('{') || of_list.starts_with('{') {
        return fail(1, "is JSON; configurations are TOML", REMEDY);
    }
    if text.contains('\r') && !text.contains('\n') {
        let remedy = "save it with line ends of LF or CR LF";
        return fail(1, "has lines that end with CR alone", remedy);
    }
    Ok(())
}

/// Checks the text of a configuration of either kind; `file` names it in the messages.
pub fn parse_any(file: &str, text: &str) -> Result<Configuration, Vec<Diagnostic>> {
    parse_any_on(file, text, None)
}

/// The same, and a card comes onto `board`, if one is given.
pub fn parse_any_on(
    file: &str,
    text: &str,
    board: Option<&Board>,
) -> Result<Configuration, Vec<Diagnostic>> {
    let Some(line) = receiver::receiver_line(text) else {
        return parse_on(file, text, board).map(|card| Configuration::Card(card.into()));
    };
    if let Some(board) = board {
        let bus = RECEIVER_BUS;
        let text = format!("host.bus = \"{bus}\": is a T-format receiver, which has no board top; leave --board {} out", board.name);
        return Err(vec![Diagnostic {
            file: file.into(),
            line,
            text,
        }]);
    }
    check_form(file, text)?;
    let source = reader::Source::new(file, text);
    match receiver::read(&source) {
        Some(receiver) if source.is_good() => Ok(Configuration::Receiver(receiver)),
        _ => Err(source.into_diagnostics()),
    }
}

/// Checks the text of a card's configuration; `file` names it in the messages.
pub fn parse(file: &str, text: &str) -> Result<Project, Vec<Diagnostic>> {
    parse_on(file, text, None)
}

/// The same on a board that is not asked for in the text.
pub fn parse_on(file: &str, text: &str, board: Option<&Board>) -> Result<Project, Vec<Diagnostic>> {
    check_form(file, text)?;
    if let Some(line) = receiver::receiver_line(text) {
        let known = HostBus::ALL.map(HostBus::name).join(", ");
        let text = format!("host.bus = \"{}\": is a T-format receiver, and this command works on cards; use emit or explain, or choose a card's bus: {known}", RECEIVER_BUS);
        return Err(vec![Diagnostic {
            file: file.into(),
            line,
            text,
        }]);
    }
    let source = reader::Source::new(file, text);
    match schema::read(&source, board) {
        Some(project) if source.is_good() => Ok(project),
        _ => Err(source.into_diagnostics()),
    }
}

/// All that the reader asks a text for, and what it complains about.
pub fn asked_of(text: &str) -> (Vec<asked::Asked>, Vec<Diagnostic>) {
    let source = reader::Source::new("", text);
    // What was read does not matter here; what is wrong is among the complaints.
    match receiver::receiver_line(text) {
        Some(_) => drop(receiver::read(&source)),
        None => drop(schema::read(&source, None)),
    }
    source.into_asked()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_good_and_carries_its_own_name() {
        for (name, _) in PRESETS {
            assert_eq!(load_preset(name).unwrap().name, *name);
        }
        assert!(PRESETS.iter().any(|(n, _)| *n == DEFAULT_PRESET));
        for (name, _) in RECEIVER_PRESETS {
            match load_any_preset(name).unwrap() {
                Configuration::Receiver(receiver) => assert_eq!(receiver.name, *name),
                Configuration::Card(_) => panic!("{name} is a card"),
            }
        }
    }

    #[test]
    fn text_that_is_no_toml_is_called_what_it_is() {
        let told = |text: &str| parse_any("f", text).unwrap_err()[0].to_string();
        assert!(told("\n{\"name\": \"a\"}").starts_with("f:1: is JSON; configurations are TOML;"));
        assert!(told("[\n{\"name\": 1}]").starts_with("f:1: is JSON"));
        assert!(told("name = \"a\"\r[host]\rbus = \"dsp\"\r")
            .starts_with("f:1: has lines that end with CR alone; save it"));
        assert!(told(" \n").starts_with("f: is empty"));
    }
}
