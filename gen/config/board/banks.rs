//! Banks of a device: pins with one supply, and whether the I/O standards of these pins go with it.

use super::family::Family;
use super::keys;
use super::package::Word;
use super::Board;
use crate::form::reader::{At, Table};
use std::collections::{BTreeMap, BTreeSet};

/// Where something stands in the file.
#[derive(Clone, Debug)]
pub struct Stands {
    /// Its key, with that of its table.
    pub name: String,
    /// Its line, counted from 1.
    pub line: usize,
}

/// Where a board's pins and standards stand.
pub struct Lines {
    /// The standard of all pins but those with their own.
    pub standard: Stands,
    /// Pins that are used.
    pub pins: BTreeMap<String, Stands>,
    /// Standards of pins that have their own.
    pub standards: BTreeMap<String, Stands>,
}

impl Stands {
    /// A key of a table, at this line.
    pub fn new(table: &Table<'_, '_>, key: &str, line: usize) -> Self {
        let name = table.name(key);
        Self { name, line }
    }
}

/// A bank as its table has it.
pub struct Bank {
    /// Its name with that of the tables, `banks.3`.
    name: String,
    supply_mv: At<u64>,
    pins: Vec<At<String>>,
}

/// Reads all banks; those that are complete.
pub fn read(banks: &Table<'_, '_>) -> Vec<Bank> {
    let mut all = Vec::new();
    for (name, table) in banks.free_tables() {
        let supply = table.number(&keys::SUPPLY);
        let pins = table.strings(&keys::BANK_PINS);
        table.require(&keys::BANK_PINS);
        table.finish();
        all.extend(supply.zip(pins).map(|(supply, pins)| Bank {
            name: banks.name(&name),
            supply_mv: supply,
            pins,
        }));
    }
    all
}

/// Standards that need this supply.
fn of_supply(family: &Family, supply_mv: u64) -> Vec<&str> {
    let all = family.supplies.iter();
    all.filter(|(_, mv)| **mv == supply_mv)
        .map(|(standard, _)| standard.as_str())
        .collect()
}

/// Every standard is one of the family's, and needs the supply of its pin's bank.
pub fn check(table: &Table<'_, '_>, board: &Board, banks: Vec<Bank>, lines: &Lines) {
    let family = &board.family;
    if family.supplies.is_empty() {
        if !banks.is_empty() {
            let text = format!(
                "banks: {} does not say which supplies its I/O standards need; add, for example, `LVCMOS18 = 1800` below `[supplies]` of its family.toml",
                family.title
            );
            table.complain_plain(text);
        }
        return;
    }
    check_standards(table, board, lines);
    check_supplies(table, family, &banks);
    let told = |line: usize, text: String| table.complain_at(line, text);
    let bank_of = check_pins(table, board, &banks);
    for (pin, place) in &lines.pins {
        let Some(bank) = bank_of.get(pin) else {
            continue;
        };
        let standard = board.iostandard_of(pin);
        let (name, supply) = (&bank.name, bank.supply_mv.value);
        let good = of_supply(family, supply);
        let needs = family.supplies.get(standard);
        let Some(needs) = needs.filter(|mv| **mv != supply && !good.is_empty()) else {
            continue;
        };
        let wrong = format!(
            "needs a supply of {needs} mV, and {name} has {supply} mV; give the pin one for that in [iostandards]: {}",
            good.join(", ")
        );
        match lines.standards.get(pin) {
            Some(own) => told(own.line, format!("{} = {standard:?}: {wrong}", own.name)),
            None => told(
                place.line,
                format!(
                    "{} = {pin:?}: {standard}, its standard by `iostandard`, {wrong}",
                    place.name
                ),
            ),
        }
    }
}

/// Supplies that no standard of the family is for.
fn check_supplies(table: &Table<'_, '_>, family: &Family, banks: &[Bank]) {
    let known: BTreeSet<u64> = family.supplies.values().copied().collect();
    let strange = banks.iter().filter(|b| !known.contains(&b.supply_mv.value));
    for Bank {
        name, supply_mv, ..
    } in strange
    {
        let known: Vec<String> = known.iter().map(u64::to_string).collect();
        let text = format!(
            "{name}.supply_mv = {}: no I/O standard of {} is for that; write one of: {}",
            supply_mv.value,
            family.title,
            known.join(", ")
        );
        table.complain_at(supply_mv.line, text);
    }
}

/// Standards that the family has not.
fn check_standards(table: &Table<'_, '_>, board: &Board, lines: &Lines) {
    let own = lines.standards.iter().filter_map(|(pin, stands)| {
        let standard = board.iostandards.get(pin)?;
        Some((stands, standard))
    });
    for (stands, standard) in own.chain([(&lines.standard, &board.iostandard)]) {
        let known = &board.family.supplies;
        if !known.contains_key(standard) {
            let known: Vec<&str> = known.keys().map(String::as_str).collect();
            let text = format!(
                "{} = {standard:?}: {} has no such standard; write one of its: {}",
                stands.name,
                board.family.title,
                known.join(", ")
            );
            table.complain_at(stands.line, text);
        }
    }
}

/// The bank of each pin: pins are in the package, and in one bank.
fn check_pins<'b>(
    table: &Table<'_, '_>,
    board: &Board,
    banks: &'b [Bank],
) -> BTreeMap<String, &'b Bank> {
    let mut bank_of: BTreeMap<String, &Bank> = BTreeMap::new();
    for bank in banks {
        for at in &bank.pins {
            let told = |text: &str| {
                let text = format!("{}.pins = {:?}: {text}", bank.name, at.value);
                table.complain_at(at.line, text);
            };
            let Word::Pin(pin) = board.package.look_up(&at.value.to_ascii_uppercase()) else {
                told(&board.no_such_pin());
                continue;
            };
            if let Some(other) = bank_of.insert(pin, bank) {
                told(&format!(
                    "already stands at {}.pins; a pin has one bank, remove one of the two",
                    other.name
                ));
            }
        }
    }
    bank_of
}
