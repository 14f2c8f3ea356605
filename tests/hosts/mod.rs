//! The host's side of a card, against virtual cards: library, commands, and programs that are not ours.

mod again;
mod buses;
mod clients;
mod commands;
mod continued;
mod crowds;
mod damaged;
pub mod desk;
mod disturbed;
mod few_cycles;
mod injected;
mod logged_replies;
mod logs;
mod ports;
mod recordings;
mod requests;
mod slow;
#[cfg(unix)]
mod terminal;
mod ti_menu;

pub use ports::{slow_card, Served};

use endat_card::{VirtualCard, VirtualConfig};
use endat_config::{load_preset, parse, preset, Project};
use endat_host::{Bridge, Card};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// A preset with other line parts or numbers: pairs of texts that are replaced.
fn changed(name: &str, changes: &[(&str, &str)]) -> Project {
    parse("changed.toml", &changed_text(name, changes)).unwrap()
}

fn changed_text(name: &str, changes: &[(&str, &str)]) -> String {
    let mut text = preset(name).unwrap().to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    text
}

/// A preset of 100 MHz at a clock that takes a fifth of the time to simulate.
pub fn quick(name: &str) -> Project {
    changed(name, &QUICK)
}

/// Its text.
pub fn quick_text(name: &str) -> String {
    changed_text(name, &QUICK)
}

/// The one with a service.
pub const SERVICE: &str = "s6_two_channel_service";
/// What makes it quick.
const QUICK: [(&str, &str); 6] = [
    ("system_hz = 100_000_000", "system_hz = 20_000_000"),
    ("clock_hz = 3_125_000", "clock_hz = 2_000_000"),
    ("filter_ns = 20", "filter_ns = 50"),
    ("start_window_ns = 80", "start_window_ns = 100"),
    ("baud = 3_000_000", "baud = 2_000_000"),
    ("sample_hz = 10_000", "sample_hz = 5_000"),
];

/// Half as many cycles in a millisecond: for what waits for an initialisation.
const QUICKER: [(&str, &str); 6] = [
    ("system_hz = 100_000_000", "system_hz = 10_000_000"),
    ("clock_hz = 3_125_000", "clock_hz = 1_000_000"),
    ("filter_ns = 20", "filter_ns = 100"),
    ("start_window_ns = 80", "start_window_ns = 200"),
    ("baud = 3_000_000", "baud = 1_000_000"),
    ("sample_hz = 10_000", "sample_hz = 2_500"),
];

fn service_file(name: &str, changes: &[(&str, &str)]) -> PathBuf {
    let file = crate::tools::folder(name).join(format!("{name}.toml"));
    std::fs::write(&file, changed_text(SERVICE, changes)).unwrap();
    file
}

/// The quick card with a service, as a file.
pub fn quick_service_file() -> &'static Path {
    static FILE: LazyLock<PathBuf> = LazyLock::new(|| service_file("quick_service", &QUICK));
    &FILE
}

/// The card with a service that is initialised soonest, as a file.
pub fn quicker_service_file() -> &'static Path {
    static FILE: LazyLock<PathBuf> = LazyLock::new(|| service_file("quicker_service", &QUICKER));
    &FILE
}

/// Its port.
pub fn quicker_service_port() -> &'static str {
    static PORT: LazyLock<String> =
        LazyLock::new(|| format!("virtual:{}", quicker_service_file().display()));
    &PORT
}

/// Its port.
pub fn quick_service_port() -> &'static str {
    static PORT: LazyLock<String> =
        LazyLock::new(|| format!("virtual:{}", quick_service_file().display()));
    &PORT
}

fn card_of(project: &Project) -> VirtualCard {
    VirtualCard::new(project, &VirtualConfig::default()).unwrap()
}

/// A host at the virtual card of a preset.
fn host(preset: &str) -> Card<VirtualCard> {
    found(&load_preset(preset).unwrap())
}

/// A host at the virtual card of a project.
fn found(project: &Project) -> Card<VirtualCard> {
    Card::find(Bridge::new(card_of(project))).unwrap()
}
