//! The emitted test bench of cards with T-format channels: encoders of both kinds.

use super::quick;
use super::t_format_mutations::{MIXED_MUTATIONS, T_FORMAT_MUTATIONS};
use super::testbench::{bench_passes, check_mutations, check_some, fit};
use endat_config::{load_preset, parse};
use endat_console::artifact::Artifact;

const PRESET: &str = "mixed_protocols";
const ENDAT: &str = "[[channel]]\nposition_bits = 29\ncommand = \"111000\"\n";

fn t_format(keys: &str) -> String {
    format!("[[channel]]\nprotocol = \"t_format\"\n{keys}\n")
}

/// A card behind APB, at a clock that is quick to simulate, with these channels and `more`.
fn card(channels: &[String], more: &str) -> Vec<Artifact> {
    let endat = match channels.iter().any(|c| c == ENDAT) {
        true => "[endat]\nclock_hz = 2_500_000\nstart_window_ns = 80\n",
        false => "",
    };
    let text = format!(
        "name = \"mixed\"\n[clock]\nsystem_hz = 40_000_000\n{endat}{}\
         [trigger]\nsample_hz = 1_000\nsources = [\"pin\"]\n{more}[host]\nbus = \"apb\"\n",
        channels.concat(),
    );
    endat_emit::emit(&parse("card.toml", &text).unwrap()).unwrap()
}

fn passes(name: &str, channels: &[String], more: &str) {
    bench_passes(name, &card(channels, more), &[]);
}

/// As it is emitted: slow link, timer.
#[test]
#[ignore = "slow: bench of the preset"]
fn it_passes_on_the_mixed_preset() {
    let files = endat_emit::emit(&load_preset(PRESET).unwrap()).unwrap();
    bench_passes("mixed-preset", &files, &[]);
}

/// Every request that a trigger may send, both rates, every order of the channels, the shortest and the longest pauses.
#[test]
#[ignore = "slow: benches of other cards"]
fn it_passes_on_other_cards() {
    let endat = || ENDAT.to_owned();
    passes(
        "t-format-first",
        &[
            t_format("bit_hz = 5_000_000\nrequest = 0\nreply_gap_us = 1\nfield_gap_us = 0"),
            endat(),
        ],
        "",
    );
    passes(
        "t-format-three",
        &[
            t_format("request = 1\nreply_gap_us = 63\nfield_gap_us = 7"),
            t_format("request = 2\nbit_hz = 5_000_000"),
            t_format("request = 12\nfilter_ns = 0"),
        ],
        "",
    );
    passes(
        "t-format-between",
        &[endat(), t_format("request = 7"), endat()],
        "",
    );
}

/// A card that initialises its EnDat encoders has them asleep first, and T-format encoders as well.
#[test]
#[ignore = "slow: bench with initialisation"]
fn it_passes_on_a_card_with_initialisation() {
    let parts =
        "[service]\nparts = [\"requests\", \"diagnosis\", \"continuous\", \"initialise\"]\n";
    let channels = [t_format("request = 8"), ENDAT.to_owned()];
    passes("t-format-initialise", &channels, parts);
}

/// One channel alone: the least that has everything, so the quickest to simulate.
fn alone() -> Vec<Artifact> {
    card(&[t_format("request = 3")], "")
}

fn mixed() -> Vec<Artifact> {
    endat_emit::emit(&quick(load_preset(PRESET).unwrap())).unwrap()
}

#[test]
fn it_passes_on_one_channel_and_fails_on_broken_cards() {
    fit(&mixed(), MIXED_MUTATIONS);
    let names = [
        "reply gap too short",
        "single-turn position MSB first",
        "a bad reply replaces the position",
    ];
    check_some("t-format-quick", &alone(), T_FORMAT_MUTATIONS, &names);
}

#[test]
#[ignore = "slow: every mutation of a T-format channel"]
fn it_fails_on_every_broken_card() {
    check_mutations("t-format-only", &alone(), T_FORMAT_MUTATIONS);
}

#[test]
#[ignore = "slow: mutations of a card with both protocols"]
fn it_fails_on_every_broken_card_with_both_protocols() {
    check_mutations("mixed", &mixed(), MIXED_MUTATIONS);
}
