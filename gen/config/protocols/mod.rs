//! Other protocols than EnDat in a configuration: keys of their channels, checks and reports.

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

    /// The settings of a channel as text, for the hash of a card.
    fn canonical(&self, channel: &ChannelConfig) -> String;

    /// The report of `explain` about channel `index`.
    fn report(&self, card: &CardConfig, index: usize, encoder: &str) -> OtherReport;
}

const OTHERS: &[&dyn OtherConfig] = &[&t_format::TFormat, &ssi::Ssi];

/// The configuration of a protocol; `None` for EnDat, which has separate keys.
pub fn other(protocol: Protocol) -> Option<&'static dyn OtherConfig> {
    let mut all = OTHERS.iter().copied();
    all.find(|other| other.protocol() == protocol)
}

/// All protocols that channels of a card speak.
pub fn spoken(card: &CardConfig) -> impl Iterator<Item = Protocol> + '_ {
    let all = Protocol::ALL.iter().copied();
    all.filter(|protocol| card.speaks(*protocol))
}

/// The settings that a channel asks for.
pub struct Wanted {
    /// All but its triggers.
    pub spec: ChannelSpec,
    /// The keys, with their lines.
    pub lines: Vec<(&'static str, usize)>,
}

/// The report of `explain` about a channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct OtherReport {
    /// As data.
    pub data: serde_json::Value,
    /// As lines of text.
    #[serde(skip)]
    pub text: String,
}
