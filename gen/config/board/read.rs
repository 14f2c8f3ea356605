//! The way from a board's file to a [`Board`]; every complaint with its line.

use super::banks::{self, Lines, Stands};
use super::family::Family;
use super::keys::{self, WORD_MAX};
use super::package::{Package, Word};
use super::ports::{bus_ports, signals, BUSES};
use super::BOARD_KEYS;
use super::{Board, Start, NO_PIN};
use crate::form::document::parse;
use crate::form::key::Key;
use crate::form::reader::{At, Source, Table};
use endat_console::did_you_mean::guess;
use endat_console::error::Diagnostic;
use endat_hdl::card::bus::HostBus;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use toml::de::DeTable;

/// Reads a board's file; `folder` is where it stands.
pub fn read(name: &str, file: &str, text: &str, folder: &Path) -> Result<Board, Vec<Diagnostic>> {
    let source = Source::new(file, text);
    match read_board(&source, name, folder) {
        Some(board) if source.is_good() => Ok(board),
        _ => Err(source.into_diagnostics()),
    }
}

/// A pin or place, where it stands, and its line.
struct Place {
    key: String,
    at: At<String>,
}

/// Tables of a board's file.
struct Tables<'s, 't> {
    root: Table<'s, 't>,
    connectors: Table<'s, 't>,
    fixed: Table<'s, 't>,
    wing: Table<'s, 't>,
    iostandards: Table<'s, 't>,
    banks: Table<'s, 't>,
    device: Table<'s, 't>,
    start: Table<'s, 't>,
}

fn read_board(source: &Source<'_>, name: &str, folder: &Path) -> Option<Board> {
    let document = parse(source, BOARD_KEYS)?;
    let empty = DeTable::new();
    let root = Table::root(source, &document);
    let table = |key| root.table(key, &empty);
    let t = Tables {
        connectors: table("connectors"),
        fixed: table("fixed"),
        wing: table("wing"),
        iostandards: table("iostandards"),
        banks: table("banks"),
        device: table("device"),
        start: table("start"),
        root,
    };
    let title = read_word(&t.root, &keys::TITLE, " ()-+.,/");
    let part = read_word(&t.root, &keys::PART, "-/._");
    let family = read_family(source, &t.root, folder);
    let package = read_package(&t.root, family.as_ref());
    let oscillator_pin = t.root.required_string(&keys::OSCILLATOR_PIN);
    let oscillator_hz = t.root.number(&keys::OSCILLATOR_HZ);
    let uart_baud_max = t.root.number(&keys::UART_BAUD_MAX);
    let iostandard = read_word(&t.root, &keys::IOSTANDARD, STANDARD);
    let loader = t.root.string(&keys::LOADER).and_then(|word| {
        check_word(&t.root, keys::LOADER.name, &word, "-_")?;
        if word.value.starts_with('-') {
            let text =
                "begins like an option; write the name that `openFPGALoader --list-boards` has";
            let value = format!("{:?}", word.value);
            t.root.complain(word.line, keys::LOADER.name, &value, text);
        }
        Some(word.value)
    });
    let low_active = t.root.strings(&keys::LOW_ACTIVE).unwrap_or_default();
    let connectors = t.connectors.free_lists();
    let fixed = places(&t.fixed);
    let wing = places(&t.wing);
    let iostandards = places(&t.iostandards);
    let banks = banks::read(&t.banks);
    let device = read_device(&t.device, family.as_ref());
    let start = read_start(&t.start);
    t.root.finish();
    let (family, package, oscillator_hz) = (family?, package?, oscillator_hz?);
    let manager = &family.clock_manager;
    if !manager.takes(oscillator_hz.value) {
        let (low, high) = (manager.detector_hz.start(), manager.detector_hz.end());
        let text = format!(
            "the clock manager of {} makes no system clock of it; its phase detector takes {low}..{high} Hz, the input divided by {} at most",
            family.title,
            manager.divide.end()
        );
        let value = oscillator_hz.value.to_string();
        t.root
            .complain(oscillator_hz.line, "oscillator_hz", &value, &text);
    }
    let iostandard = iostandard?;
    let mut board = Board {
        name: name.into(),
        file: None,
        title: title?.value,
        part: part?.value,
        device: device?,
        oscillator_pin: String::new(),
        oscillator_hz: oscillator_hz.value,
        uart_baud_max: uart_baud_max?.value,
        iostandard: iostandard.value,
        iostandards: BTreeMap::new(),
        loader,
        low_active: BTreeSet::new(),
        connectors: BTreeMap::new(),
        fixed: BTreeMap::new(),
        wing: BTreeMap::new(),
        start: None,
        family,
        package,
    };
    let pins = take_pins(&t, &mut board, oscillator_pin?, connectors, fixed);
    let standards = take_words_of_pins(&t, &mut board, &low_active, iostandards);
    let standard = Stands::new(&t.root, keys::IOSTANDARD.name, iostandard.line);
    banks::check(
        &t.banks,
        &board,
        banks,
        &Lines {
            standard,
            pins,
            standards,
        },
    );
    take_wing(&t, &mut board, wing);
    board.start = take_start(&t.start, &board, start);
    Some(board)
}

/// What an I/O standard has besides letters and digits, as `3.3-V LVTTL`.
const STANDARD: &str = "_-. ";

/// A word that goes into emitted files: letters, digits, and what else is allowed.
fn read_word(table: &Table<'_, '_>, key: &'static Key, more: &str) -> Option<At<String>> {
    let word = table.required_string(key)?;
    check_word(table, key.name, &word, more)?;
    Some(word)
}

fn check_word(table: &Table<'_, '_>, key: &str, word: &At<String>, more: &str) -> Option<()> {
    let value = &word.value;
    let bad = |c: &char| !c.is_ascii_alphanumeric() && !more.contains(*c);
    let text = match value.chars().find(bad) {
        Some(bad) => format!("has the character {bad:?}; use letters, digits and any of {more:?}"),
        None if value.is_empty() => "is empty; write what the vendor calls it".into(),
        None if value.len() > WORD_MAX => format!(
            "has {} characters, at most {WORD_MAX} are allowed; shorten it",
            value.len()
        ),
        None => return Some(()),
    };
    table.complain(word.line, key, &format!("{value:?}"), &text);
    None
}

fn read_family(source: &Source<'_>, root: &Table<'_, '_>, folder: &Path) -> Option<Family> {
    let name = root.required_string(&keys::FAMILY)?;
    match Family::named(&name.value, folder) {
        Ok(family) => Some(family),
        Err(wrong) => {
            let (own, others) = wrong
                .into_iter()
                .partition::<Vec<_>, _>(|d| d.file.is_empty());
            for diagnostic in own {
                let value = format!("{:?}", name.value);
                root.complain(name.line, "family", &value, &diagnostic.text);
            }
            source.adopt(others);
            None
        }
    }
}

/// Pins by number, or a grid of balls.
fn read_package(root: &Table<'_, '_>, family: Option<&Family>) -> Option<Package> {
    root.know(&[
        &keys::PACKAGE_PINS,
        &keys::PACKAGE_ROWS,
        &keys::PACKAGE_COLUMNS,
    ]);
    if root.has(keys::PACKAGE_ROWS.name) || root.has(keys::PACKAGE_COLUMNS.name) {
        let text = "a grid of balls has package_rows and package_columns; remove it";
        root.refuse(&keys::PACKAGE_PINS, text);
        let columns = root.number(&keys::PACKAGE_COLUMNS);
        let rows = root.required_string(&keys::PACKAGE_ROWS)?;
        let letters: Vec<String> = rows.value.split_whitespace().map(str::to_owned).collect();
        let letters = match letters.len() {
            1 => rows.value.trim().chars().map(String::from).collect(),
            _ => letters,
        };
        let good = |row: &String| {
            (1..=2).contains(&row.len()) && row.bytes().all(|b| b.is_ascii_uppercase())
        };
        if letters.is_empty() || !letters.iter().all(good) {
            let text = "is no list of rows; write their capital letters, with blanks between if any has two";
            root.complain(
                rows.line,
                "package_rows",
                &format!("{:?}", rows.value),
                text,
            );
            return None;
        }
        return Some(Package::Grid {
            rows: letters,
            columns: u32::try_from(columns?.value).unwrap_or(u32::MAX),
        });
    }
    let pins = root.number(&keys::PACKAGE_PINS)?;
    Some(Package::Numbered {
        prefix: family?.pin_prefix.clone(),
        pins: u32::try_from(pins.value).unwrap_or(u32::MAX),
    })
}

fn places(table: &Table<'_, '_>) -> Vec<Place> {
    let all = table.free_strings().into_iter();
    let mut all: Vec<Place> = all.map(|(key, at)| Place { key, at }).collect();
    // The one further down is the one to complain about.
    all.sort_by_key(|place| place.at.line);
    all
}

/// What the family wants to know of the device.
fn read_device(table: &Table<'_, '_>, family: Option<&Family>) -> Option<BTreeMap<String, String>> {
    let family = family?;
    let mut device = BTreeMap::new();
    for (key, at) in table.free_strings() {
        if !family.device.contains_key(&key) {
            let known: Vec<&str> = family.device.keys().map(String::as_str).collect();
            let text = format!("unknown key; known keys here: {}", known.join(", "));
            table.complain(at.line, &key, &format!("{:?}", at.value), &text);
        } else if check_word(table, &key, &at, "-/._").is_some() {
            device.insert(key, at.value);
        }
    }
    for (key, example) in &family.device {
        if !table.has(key) {
            let text = format!(
                "device.{key}: is missing, {} asks for it; add, for example, `{key} = {example:?}` below `[device]`",
                family.title
            );
            table.complain_plain(text);
        }
    }
    Some(device)
}

/// What to start from.
struct StartAt {
    system: At<u64>,
    clock_hz: u64,
    channels: u64,
}

fn read_start(table: &Table<'_, '_>) -> Option<StartAt> {
    if table.line == 0 {
        return None;
    }
    let [system, clock] = [&keys::SYSTEM_HZ, &keys::CLOCK_HZ].map(|key| {
        let limits = key.limits(None);
        let found = table.required_integer(key, &limits)?;
        table.check(key, &found, &limits);
        Some(found)
    });
    let limits = keys::CHANNELS.limits(None);
    let channels = table.integer(&keys::CHANNELS, &limits);
    if let Some(channels) = &channels {
        table.check(&keys::CHANNELS, channels, &limits);
    }
    table.finish();
    Some(StartAt {
        system: system?,
        clock_hz: clock?.value,
        channels: channels.map_or(keys::CHANNELS.usual_number(), |c| c.value),
    })
}

fn take_start(table: &Table<'_, '_>, board: &Board, start: Option<StartAt>) -> Option<Start> {
    let StartAt {
        system,
        clock_hz,
        channels,
    } = start?;
    if let Err(text) = board.pll(system.value) {
        table.complain(system.line, "system_hz", &system.value.to_string(), &text);
    }
    Some(Start {
        system_hz: system.value,
        clock_hz,
        channels: channels as usize,
    })
}

/// Pins of connectors, oscillator and signals that are wired: each is in the package, and none stands twice. Where they stand.
fn take_pins(
    t: &Tables<'_, '_>,
    board: &mut Board,
    oscillator: At<String>,
    connectors: Vec<(String, Vec<At<String>>)>,
    fixed: Vec<Place>,
) -> BTreeMap<String, Stands> {
    let mut seen: BTreeMap<String, Stands> = BTreeMap::new();
    let mut take = |board: &Board, table: &Table<'_, '_>, key: &str, at: &At<String>| {
        let told = |text: &str| table.complain(at.line, key, &format!("{:?}", at.value), text);
        match board.package.look_up(&at.value.to_ascii_uppercase()) {
            Word::Pin(pin) => {
                let here = Stands::new(table, key, at.line);
                if let Some(other) = seen.insert(pin.clone(), here) {
                    told(&format!(
                        "already stands at {}; a pin has one place, remove one of the two",
                        other.name
                    ));
                }
                Some(pin)
            }
            _ => {
                told(&board.no_such_pin());
                None
            }
        }
    };
    board.oscillator_pin = take(board, &t.root, "oscillator_pin", &oscillator).unwrap_or_default();
    for (name, pins) in connectors {
        let line = pins.first().map_or(t.connectors.line, |at| at.line);
        let plain = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_';
        if !name.chars().all(plain) || name.ends_with(|c: char| c.is_ascii_digit()) {
            let text = format!("connectors.{name}: is no name of a connector; use capital letters, digits and _, no digit last: the position comes behind it");
            t.connectors.complain_at(line, text);
            continue;
        }
        let is_pin =
            |n: usize| matches!(board.package.look_up(&format!("{name}{n}")), Word::Pin(_));
        if let Some(n) = (0..pins.len()).find(|n| is_pin(*n)) {
            let text = format!("connectors.{name}: {name}{n} is a pin of the package, too; give the connector another name, {name}_ for example");
            t.connectors.complain_at(line, text);
        }
        let mut pin = |at: &At<String>| match at.value.as_str() {
            NO_PIN => NO_PIN.to_owned(),
            _ => take(board, &t.connectors, &name, at).unwrap_or_default(),
        };
        let pins = pins.iter().map(&mut pin).collect();
        board.connectors.insert(name, pins);
    }
    let known = signals();
    for Place { key, at } in fixed {
        check_signal(&t.fixed, &key, &at, &known);
        if let Some(pin) = take(board, &t.fixed, &key, &at) {
            board.fixed.insert(key, pin);
        }
    }
    seen
}

/// I/O standards of pins, and lights that shine when low; where the standards stand.
fn take_words_of_pins(
    t: &Tables<'_, '_>,
    board: &mut Board,
    low_active: &[At<String>],
    iostandards: Vec<Place>,
) -> BTreeMap<String, Stands> {
    let known = |pin: &str| board.is_free(pin) || pin == board.oscillator_pin;
    let mut standards = BTreeMap::new();
    let mut lines = BTreeMap::new();
    for Place { key, at } in iostandards {
        let pin = key.to_ascii_uppercase();
        if !known(&pin) {
            let text = "no pin of this file's connectors and signals; remove the line";
            t.iostandards
                .complain(at.line, &key, &format!("{:?}", at.value), text);
        } else if check_word(&t.iostandards, &key, &at, STANDARD).is_some() {
            lines.insert(pin.clone(), Stands::new(&t.iostandards, &key, at.line));
            standards.insert(pin, at.value);
        }
    }
    let mut low = BTreeSet::new();
    for at in low_active {
        let pin = at.value.to_ascii_uppercase();
        if !known(&pin) {
            let text = "no pin of this file's connectors and signals; remove it from the list";
            t.root
                .complain(at.line, "low_active", &format!("{:?}", at.value), text);
        }
        low.insert(pin);
    }
    board.iostandards = standards;
    board.low_active = low;
    lines
}

fn check_signal(table: &Table<'_, '_>, key: &str, at: &At<String>, known: &[String]) {
    if !known.iter().any(|signal| signal == key) {
        let near = guess(key, known.iter().map(String::as_str));
        let near = near.unwrap_or_else(|| format!("signals: {}", known.join(", ")));
        table.complain(
            at.line,
            key,
            &format!("{:?}", at.value),
            &format!("no such signal; {near}"),
        );
    }
}

/// The bus that a signal belongs to: signals of two of them are never there together.
fn bus_of(signal: &str) -> Option<HostBus> {
    let has = |bus: &HostBus| bus_ports(*bus).iter().any(|(port, _)| port == signal);
    BUSES.into_iter().find(has)
}

/// Usual places: each is a free pin, and no two signals of one card share it.
fn take_wing(t: &Tables<'_, '_>, board: &mut Board, wing: Vec<Place>) {
    let mut taken: Vec<(String, String)> = board
        .fixed
        .iter()
        .map(|(s, p)| (s.clone(), p.clone()))
        .collect();
    let known = signals();
    for Place { key, at } in wing {
        let told = |text: &str| {
            t.wing
                .complain(at.line, &key, &format!("{:?}", at.value), text)
        };
        check_signal(&t.wing, &key, &at, &known);
        let pin = match board.pin(&at.value) {
            Ok(pin) => pin,
            Err(text) => {
                told(&text);
                continue;
            }
        };
        let meets = |other: &str| match (bus_of(&key), bus_of(other)) {
            (Some(one), Some(two)) => one == two,
            _ => true,
        };
        if let Some((other, _)) = taken.iter().find(|(signal, p)| *p == pin && meets(signal)) {
            told(&format!(
                "{pin} already carries {other}; choose a free pin for one of the two"
            ));
        }
        taken.push((key.clone(), pin));
        board.wing.insert(key, at.value);
    }
}
