//! What a configuration has to know of a protocol besides EnDat: keys of its channels, their checks, their report.

pub mod ssi;
pub mod t_format;

use crate::reader::Table;
use endat_hdl::config::{CardConfig, ChannelConfig, ChannelSpec};
use endat_regs::Protocol;
use serde::Serialize;

/// A protocol besides EnDat in a configuration.
pub trait OtherConfig: Sync {
    /// Which it is.
    fn protocol(&self) -> Protocol;

    /// Reads a `[[channel]]` of a card; none if what is wrong leaves nothing to judge.
    fn read(&self, table: &Table<'_, '_>, system_hz: Option<u64>) -> Option<Wanted>;

    /// What decides what a channel does, for the hash of a card.
    fn canonical(&self, channel: &ChannelConfig) -> String;

    /// What `explain` says of channel `index`.
    fn report(&self, card: &CardConfig, index: usize, encoder: &str) -> OtherReport;
}

const OTHERS: &[&dyn OtherConfig] = &[&t_format::TFormat, &ssi::Ssi];

/// The configuration of a protocol; none of EnDat, which has keys of its own.
pub fn other(protocol: Protocol) -> Option<&'static dyn OtherConfig> {
    let mut all = OTHERS.iter().copied();
    all.find(|other| other.protocol() == protocol)
}

/// All protocols that channels of a card speak.
pub fn spoken(card: &CardConfig) -> impl Iterator<Item = Protocol> + '_ {
    let all = Protocol::ALL.iter().copied();
    all.filter(|protocol| card.speaks(*protocol))
}

/// What is asked of a channel.
pub struct Wanted {
    /// All but its triggers.
    pub spec: ChannelSpec,
    /// The keys, with their lines.
    pub lines: Vec<(&'static str, usize)>,
}

/// What `explain` tells of a channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct OtherReport {
    /// As data.
    pub data: serde_json::Value,
    /// As lines of text.
    #[serde(skip)]
    pub text: String,
}
