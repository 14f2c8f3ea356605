//! The cards whose flip-flops are inverted: names, configurations, designs.

use super::host::{BIT_CYCLES, TIMEOUT_US};
use endat_config as config;
use endat_console::error::CommandError;
use endat_hdl::card::{service_times, Card};
use endat_hdl::config::CardConfig;
use endat_hdl::endat::service::program::ServiceTimes;
use endat_sim::campaign::ABORT_US;
use rtl_design::elaborate::{elaborate, Design};
use rust_hdl::prelude::Block;

const CONFIGURATION: &str = include_str!("card.toml");
/// What both cards have.
const GUARDS: &str = "[safety]\nupset_guards = true\n";
/// What the card with every monitor has besides.
const MONITORS: &str =
    "parts = [\"recovery_counter\", \"second_interface\", \"second_receiver\", \"error_test\"]\n";
/// Longest wait of a request for its frame: one at least, as milliseconds are counted.
const REQUEST_MS: u16 = 2;
/// The service waits for one millisecond more than it is told: with this one for none.
const NO_WAIT: u16 = u16::MAX;
/// And the longest wait is 16 ms.
const WAIT_MASK: u16 = 0x000F;

/// A card whose flip-flops are inverted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CardSubject {
    /// Without monitors.
    Plain,
    /// With all that `[safety]` has, and a second controller.
    Safety,
}

impl CardSubject {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Plain, Self::Safety];

    /// Its name in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Plain => "card",
            Self::Safety => "card_safety",
        }
    }

    /// That with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|subject| subject.name() == name)
    }

    pub(super) fn has_monitors(self) -> bool {
        self == Self::Safety
    }
}

/// The part of a register's name behind the one of its channel, if it is in one.
pub fn in_channel(name: &str) -> Option<&str> {
    let (_, behind) = name.split_once(".channel_0.")?;
    Some(behind)
}

/// The card's configuration.
pub(super) fn configuration(subject: CardSubject) -> Result<CardConfig, CommandError> {
    let monitors = if subject.has_monitors() { MONITORS } else { "" };
    let text = format!("{CONFIGURATION}{GUARDS}{monitors}");
    let project = config::parse("card.toml", &text).map_err(|all| {
        let all: Vec<String> = all.iter().map(|d| d.to_string()).collect();
        CommandError::input(all.join("; "))
    })?;
    // Shorter than a board and an encoder allow, so that a case takes little time.
    let mut card = project.card;
    card.uart_bit_cycles = BIT_CYCLES;
    card.channels.iter_mut().for_each(|c| c.abort_us = ABORT_US);
    Ok(card)
}

/// A card's design.
pub(super) fn design(card: &CardConfig) -> Result<Design, CommandError> {
    let times = ServiceTimes {
        request_ms: REQUEST_MS,
        busy_ms: REQUEST_MS,
        reset_ms: NO_WAIT,
        write_ms: NO_WAIT,
        gap_ms: NO_WAIT,
        stuck_ms: REQUEST_MS,
        wait_mask: WAIT_MASK,
        ..service_times(card)
    };
    let mut block = Card::with_times(card, TIMEOUT_US, &times);
    block.connect_all();
    elaborate(&block, "card").map_err(|e| CommandError::fault("campaign", &e))
}
