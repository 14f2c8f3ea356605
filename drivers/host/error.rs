//! Errors between a host and a card.

use std::io;

/// Error of an access to a card.
#[derive(Debug, thiserror::Error)]
pub enum HostError {
    /// The port cannot be opened, or was disconnected.
    #[error("{address}: {action}: {error}; {remedy}")]
    Link {
        /// Port as the user named it.
        address: String,
        /// Attempted action.
        action: &'static str,
        /// Error of the operating system.
        error: io::Error,
        /// Remedy.
        remedy: &'static str,
    },
    /// No answer, several times.
    #[error("no answer from the card in {tries} tries of {wait_ms} ms; is another program connected to it, is it powered, is the baud rate the card's (--baud)?")]
    Silent {
        /// Number of tries.
        tries: u32,
        /// Timeout of each answer.
        wait_ms: u64,
    },
    /// No sample arrives during a recording.
    #[error("no sample for {seconds} s; is a trigger enabled (card_config.trigger_sources), is the card plugged in?")]
    NoSample {
        /// Waiting time.
        seconds: u64,
    },
    /// The answer does not come from a card, or from one with another map.
    #[error("{0}")]
    NoCard(String),
    /// A wrong name or number from the user.
    #[error("{0}")]
    Name(String),
    /// The card has no such part.
    #[error("{what}: the card has no part `{part}`; emit it with {remedy}")]
    Part {
        /// Requested function.
        what: &'static str,
        /// Missing part.
        part: &'static str,
        /// Configuration that selects it.
        remedy: &'static str,
    },
    /// The encoder, or the line to it, rejected the request.
    #[error("{0}")]
    Refused(String),
}
