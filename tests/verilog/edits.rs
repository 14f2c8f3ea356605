//! Wrong edits of the emitted Verilog that the card's own bench must see: `tests/data/edits.toml`.

use super::bus_bench;
use super::testbench::{bench_passes, run_bench};
use crate::strangers::on_both_cores;
use crate::tools;
use endat_console::artifact::Artifact;
use endat_hdl::card::bus::HostBus;
use endat_tools::readers::passes;
use endat_workshop::mutants::Emission;
use std::collections::BTreeMap;

/// Keys of an edit.
const KEYS: [&str; 5] = ["after", "before", "breaks", "card", "file"];
/// The bench sees these in its first steps.
const QUICK: [&str; 2] = [
    "the trigger pin has a synchroniser stage less",
    "the clock never stops",
];

struct Edit {
    card: String,
    file: String,
    before: String,
    after: String,
    breaks: String,
}

/// The edits that the bench must see.
fn edits() -> Vec<Edit> {
    let table: toml::Table = include_str!("../data/edits.toml").parse().unwrap();
    let rows = table["edit"].as_array().unwrap().iter().map(|row| {
        let row = row.as_table().unwrap();
        let mut keys: Vec<&str> = row.keys().map(String::as_str).collect();
        keys.sort_unstable();
        assert_eq!(keys, KEYS, "{row}");
        let text = |key: &str| row[key].as_str().unwrap().to_owned();
        Edit {
            card: text("card"),
            file: text("file"),
            before: text("before"),
            after: text("after"),
            breaks: text("breaks"),
        }
    });
    rows.filter(|edit| !edit.breaks.starts_with("prove: "))
        .collect()
}

/// Emits a card of the table.
fn emitted(card: &str) -> Vec<Artifact> {
    let is_of = |bus: &HostBus| card.strip_suffix("_card") == Some(bus.name());
    if let Some(bus) = HostBus::ALL.into_iter().find(is_of) {
        return bus_bench::files(bus);
    }
    let Emission { subject, bench } = Emission::named(card).unwrap();
    let mut files = subject.files;
    files.push(bench);
    files
}

/// Each card of the edits, emitted once.
fn cards(edits: &[Edit]) -> BTreeMap<&str, Vec<Artifact>> {
    let names = edits.iter().map(|edit| edit.card.as_str());
    let mut cards = BTreeMap::new();
    for name in names {
        cards.entry(name).or_insert_with(|| emitted(name));
    }
    cards
}

/// The files with an edit.
fn edited(files: &[Artifact], edit: &Edit) -> Vec<Artifact> {
    let mut files = files.to_vec();
    let file = files.iter_mut().find(|f| f.path == edit.file);
    let file = file.unwrap_or_else(|| panic!("{}: no file {}", edit.card, edit.file));
    let count = file.text.matches(&edit.before).count();
    assert_eq!(count, 1, "{}: {:?}", edit.file, edit.before);
    file.text = file.text.replace(&edit.before, &edit.after);
    files
}

/// Checks that the bench of each card complains about each edit.
fn seen(edits: &[&Edit], cards: &BTreeMap<&str, Vec<Artifact>>) {
    let survivors = on_both_cores(edits, |index, edit| {
        let files = edited(&cards[edit.card.as_str()], edit);
        let text = run_bench(&format!("edit{index}"), &files, &["+first"]);
        passes(&text).then(|| format!("{}: {text}", edit.breaks))
    });
    assert!(survivors.is_empty(), "not seen: {survivors:?}");
}

#[test]
fn every_edit_fits_and_the_bench_sees_two_in_its_first_steps() {
    let edits = edits();
    let cards = cards(&edits);
    for edit in &edits {
        edited(&cards[edit.card.as_str()], edit);
    }
    let first = edits.iter().filter(|e| QUICK.contains(&e.breaks.as_str()));
    let first: Vec<_> = first.collect();
    assert_eq!(first.len(), QUICK.len());
    if tools::require("iverilog", "wrong edits of a card") {
        seen(&first, &cards);
    }
}

#[test]
#[ignore = "slow: every wrong edit of emitted cards, and their benches"]
fn bench_sees_every_wrong_edit() {
    let edits = edits();
    let cards = cards(&edits);
    for (name, files) in &cards {
        bench_passes(&format!("edits-{name}"), files, &[]);
    }
    if tools::require("iverilog", "wrong edits of a card") {
        seen(&edits.iter().collect::<Vec<_>>(), &cards);
    }
}
