//! Boards: which pins one has, and what is on them. A board is a file, and so is what its family of devices is.

mod banks;
mod clock;
mod family;
mod keys;
mod making;
mod package;
mod ports;
mod read;

pub use clock::{ClockManager, Feedback, Pll};
pub use endat_constraints::names;
pub use family::{Family, CLOCK, CLOCK_VHDL, CONSTRAINTS, FUSESOC, README, TIMING, VENDOR};
pub use keys::{page, BOARD_KEYS};
pub use making::{Build, Placed, ReadBack, Vendor};
pub use package::Package;
pub use ports::{
    card_ports, signals, Assignment, Kind, MorePorts, OSCILLATOR_PORT, PARALLEL_ADDRESS_LINES,
    PARALLEL_DATA_LINES,
};

use crate::form::with_text;
use endat_console::error::CommandError;
use endat_console::error::Diagnostic;
use package::Word;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Stands in a connector's list for a position without a pin.
const NO_PIN: &str = "-";

/// What suits a board: the shipped configuration is started from with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Start {
    /// System clock, in hertz.
    pub system_hz: u64,
    /// EnDat clock, in hertz.
    pub clock_hz: u64,
    /// Encoder ports.
    pub channels: usize,
}

/// Encoder ports of the shipped configuration.
pub const SHIPPED_CHANNELS: u64 = 2;

/// A board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Board {
    /// Name by which a configuration asks for it, or that of its file.
    pub name: String,
    /// Its file, if it did not come with the program.
    pub file: Option<String>,
    /// Name for people.
    pub title: String,
    /// The family of its device.
    pub family: Family,
    /// Device, speed grade and package, as the vendor's tools spell it.
    pub part: String,
    /// What the family's tools want to know about the device besides.
    pub device: BTreeMap<String, String>,
    /// Pins of the package.
    pub package: Package,
    /// Pin of the oscillator.
    pub oscillator_pin: String,
    /// Frequency of the oscillator, in hertz.
    pub oscillator_hz: u64,
    /// Fastest host UART of the board, in bit/s.
    pub uart_baud_max: u64,
    /// I/O standard of all pins but those of `iostandards`.
    pub iostandard: String,
    /// Pins with another I/O standard.
    pub iostandards: BTreeMap<String, String>,
    /// How openFPGALoader calls it.
    pub loader: Option<String>,
    /// Pins whose light shines when they are low.
    pub low_active: BTreeSet<String>,
    /// Free pins by connector, position 0 first.
    pub connectors: BTreeMap<String, Vec<String>>,
    /// Signals that the board itself wires.
    pub fixed: BTreeMap<String, String>,
    /// Usual places of the other signals.
    pub wing: BTreeMap<String, String>,
    /// Clocks to start from, if those of the shipped configuration do not suit it.
    pub start: Option<Start>,
}

/// Connector and position of a word like `A0`.
fn parts(word: &str) -> Option<(&str, usize)> {
    let split = word.rfind(|c: char| !c.is_ascii_digit())? + 1;
    let (name, position) = (word.get(..split)?, word.get(split..)?);
    Some((name, position.parse().ok()?))
}

impl Board {
    /// The board of this name; `Err` has the message.
    pub fn named(name: &str) -> Result<Self, String> {
        static READ: Mutex<BTreeMap<String, Board>> = Mutex::new(BTreeMap::new());
        let read = || READ.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(board) = read().get(name) {
            return Ok(board.clone());
        }
        let board = Self::read_shipped(name)?;
        read().insert(name.into(), board.clone());
        Ok(board)
    }

    /// The same, read anew.
    /// All that come with the program.
    pub fn all() -> Result<Vec<Self>, CommandError> {
        let boards = names().into_iter().map(Self::named);
        let boards = boards.collect::<Result<Vec<_>, _>>();
        boards.map_err(|e| CommandError::fault("boards", &e))
    }

    fn read_shipped(name: &str) -> Result<Self, String> {
        let Some(text) = endat_constraints::board(name) else {
            return Err(format!(
                "unknown board; known boards: {}",
                names().join(", ")
            ));
        };
        let file = format!("constraints/boards/{name}.toml");
        let board = read::read(name, &file, text, Path::new(""));
        board.map_err(|wrong| {
            wrong
                .iter()
                .map(ToString::to_string)
                .collect::<Vec<_>>()
                .join("; ")
        })
    }

    /// The board in this file; `Err` has all that is wrong with it.
    pub fn from_file(path: &Path) -> Result<Self, Vec<Diagnostic>> {
        let remedy =
            "give a board's TOML file; `endat-gen boards --show NAME` prints one to start from";
        // The name goes into comments of emitted files.
        let plain = |c: char| {
            if c.is_ascii_alphanumeric() || c == '-' {
                c
            } else {
                '_'
            }
        };
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let name: String = name.chars().map(plain).collect();
        let folder = path.parent().unwrap_or(Path::new(""));
        let read = |file: &str, text: &str| Ok(read::read(&name, file, text, folder));
        let board = with_text(path, remedy, read).map_err(|error| {
            let plain = |text: &String| Diagnostic {
                file: String::new(),
                line: 0,
                text: text.clone(),
            };
            error.messages().iter().map(plain).collect::<Vec<_>>()
        })??;
        Ok(Self {
            file: Some(path.display().to_string()),
            ..board
        })
    }

    /// Text of the file of a board that comes with the program.
    pub fn text(name: &str) -> Option<&'static str> {
        endat_constraints::board(name)
    }

    /// The package pin that a user's word means (`P48` or `A0`); `Err` has the message.
    pub fn pin(&self, word: &str) -> Result<String, String> {
        let word = word.to_ascii_uppercase();
        if let Some(pin) = self.by_position(&word) {
            return Ok(pin.clone());
        }
        let is_of_connector =
            parts(&word).is_some_and(|(name, _)| self.connectors.contains_key(name));
        match self.package.look_up(&word) {
            Word::NoPin if !is_of_connector => {
                let what = self.no_such_pin().replacen(';', ",", 1);
                Err(format!("{what}; {}", self.free_pins()))
            }
            Word::Pin(pin) if self.is_free(&pin) => Ok(pin),
            Word::NoPin | Word::Pin(_) => Err(format!(
                "is not on a connector of {}; {}",
                self.name,
                self.free_pins()
            )),
            Word::Other => {
                let first = self.places().next();
                let (position, pin) =
                    first.map_or(("A0".into(), "1"), |(place, pin)| (place, pin.as_str()));
                Err(format!(
                    "is neither a pin ({pin}) nor a connector position ({position}); {}",
                    self.free_pins()
                ))
            }
        }
    }

    fn no_such_pin(&self) -> String {
        format!(
            "no such pin; the package of {} has {}",
            self.part,
            self.package.ends()
        )
    }

    fn by_position(&self, word: &str) -> Option<&String> {
        let (name, position) = parts(word)?;
        self.connectors
            .get(name)?
            .get(position)
            .filter(|pin| *pin != NO_PIN)
    }

    fn is_free(&self, pin: &str) -> bool {
        self.places().any(|(_, p)| p == pin) || self.fixed.values().any(|p| p == pin)
    }

    fn free_pins(&self) -> String {
        let ranges = self.connectors.iter().map(|(name, pins)| {
            let first = pins.iter().position(|pin| pin != NO_PIN).unwrap_or(0);
            format!("{name}{first}..{name}{}", pins.len().saturating_sub(1))
        });
        format!("use {}", ranges.collect::<Vec<_>>().join(", "))
    }

    /// Every connector position with its pin.
    pub fn places(&self) -> impl Iterator<Item = (String, &String)> {
        self.connectors.iter().flat_map(|(name, pins)| {
            let pins = pins.iter().enumerate();
            let pins = pins.filter(|(_, pin)| *pin != NO_PIN);
            pins.map(move |(n, pin)| (format!("{name}{n}"), pin))
        })
    }

    /// Connector and position of a pin, such as `C3`.
    pub fn position(&self, pin: &str) -> String {
        let found = self.places().find(|(_, p)| *p == pin);
        found.map_or_else(String::new, |(place, _)| place)
    }

    /// The usual word for the place of a signal.
    pub fn usual_place(&self, signal: &str) -> Option<&String> {
        self.fixed.get(signal).or_else(|| self.wing.get(signal))
    }

    /// Connector positions that none of these words takes.
    pub fn free_places<'w>(&self, words: impl Iterator<Item = &'w String>) -> Vec<String> {
        let taken: BTreeSet<String> = words.filter_map(|word| self.pin(word).ok()).collect();
        let free = self.places().filter(|(_, pin)| !taken.contains(*pin));
        free.map(|(place, _)| place).collect()
    }

    /// Free connector positions for the ports that have no usual one, in their order; `None` if too few are free.
    pub fn spare_places(&self, ports: &[(String, Kind)]) -> Option<Vec<(String, String)>> {
        let signals = || ports.iter().map(|(signal, _)| signal);
        let without = signals().filter(|signal| self.usual_place(signal).is_none());
        let mut free = self
            .free_places(signals().filter_map(|s| self.usual_place(s)))
            .into_iter();
        without.map(|s| Some((s.clone(), free.next()?))).collect()
    }

    /// The I/O standard of a pin.
    pub fn iostandard_of(&self, pin: &str) -> &str {
        self.iostandards.get(pin).unwrap_or(&self.iostandard)
    }

    /// Whether it is a light whose pin is low while it shines.
    pub fn inverts(&self, pin: &Assignment) -> bool {
        pin.kind == Kind::Led && self.low_active.contains(&pin.pin)
    }

    /// Factors that make exactly this system clock; `Err` has the message with the nearest frequencies.
    pub fn pll(&self, system_hz: u64) -> Result<Pll, String> {
        self.family.clock_manager.pll(self.oscillator_hz, system_hz)
    }
}

#[cfg(test)]
mod tests;
