//! The host's side of a card, against virtual cards: library, commands, and programs that are not ours.

mod again;
mod clients;
mod commands;
mod continued;
pub mod desk;
mod disturbed;
mod few_cycles;
mod injected;
mod logs;
mod ports;
mod recordings;
mod requests;
mod slow;
#[cfg(unix)]
mod terminal;
mod ti_menu;

pub use ports::{slow_card, Served};

use endat_gen::config::{load_preset, parse, preset, Project};
use endat_gen::virtual_card::{VirtualCard, VirtualConfig};
use endat_host::{Bridge, Card};

/// A preset with other line parts or numbers: pairs of texts that are replaced.
fn changed(name: &str, changes: &[(&str, &str)]) -> Project {
    let mut text = preset(name).unwrap().to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    parse("changed.toml", &text).unwrap()
}

fn card_of(project: &Project) -> VirtualCard {
    VirtualCard::new(project, &VirtualConfig::default()).unwrap()
}

/// A host at the virtual card of a preset.
fn host(preset: &str) -> Card<VirtualCard> {
    let card = card_of(&load_preset(preset).unwrap());
    Card::find(Bridge::new(card)).unwrap()
}
