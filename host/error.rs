//! What can go wrong between a host and a card.

use std::io;

/// Why something could not be had from a card.
#[derive(Debug, thiserror::Error)]
pub enum HostError {
    /// The port cannot be opened, or is gone.
    #[error("{address}: {action}: {error}; {remedy}")]
    Link {
        /// Port as the user named it.
        address: String,
        /// What was tried.
        action: &'static str,
        /// What the system says.
        error: io::Error,
        /// What helps.
        remedy: &'static str,
    },
    /// No answer, several times.
    #[error("no answer from the card in {tries} tries of {wait_ms} ms; is another program connected to it, is it powered, is the baud rate the card's (--baud)?")]
    Silent {
        /// How often it was asked.
        tries: u32,
        /// How long each answer was waited for.
        wait_ms: u64,
    },
    /// Nothing is recorded, though it should be.
    #[error("no sample for {seconds} s; is a trigger enabled (card_config.trigger_sources), is the card plugged in?")]
    NoSample {
        /// How long it was waited for.
        seconds: u64,
    },
    /// What answers is no card, or one of another time.
    #[error("{0}")]
    NoCard(String),
    /// A name or number that the user gave.
    #[error("{0}")]
    Name(String),
    /// The card has no such part.
    #[error("{what}: the card has no part `{part}`; emit it with {remedy}")]
    Part {
        /// What was wanted.
        what: &'static str,
        /// What is missing.
        part: &'static str,
        /// Configuration that has it.
        remedy: &'static str,
    },
    /// The encoder, or the line to it, refused.
    #[error("{0}")]
    Refused(String),
}
