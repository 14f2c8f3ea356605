//! What an emission has for a protocol besides EnDat: its part of the benches.

pub mod ssi;
pub mod t_format;

use endat_config::template;
use endat_console::error::CommandError;
use endat_hdl::config::{CardConfig, ChannelConfig};
use endat_regs::Protocol;
use endat_sim::bench::OtherEncoder;
use minijinja::{context, Value};
use serde::Serialize;
use std::collections::BTreeMap;

/// A protocol besides EnDat in the benches of an emission.
pub trait OtherBench: Sync {
    /// Which it is.
    fn protocol(&self) -> Protocol;

    /// What the emitted bench has for its channels; `sleeps`: the card does something else first.
    fn bench(
        &self,
        name: &str,
        card: &CardConfig,
        sleeps: bool,
    ) -> Result<BenchParts, CommandError>;

    /// The parts of the VHDL bench for its channels.
    fn vhdl_bench(&self, name: &str, card: &CardConfig) -> Result<VhdlParts, CommandError>;

    /// After an exchange without a reply the line of the bench's encoder is idle at the latest after this, in ns.
    fn idle_ns(&self) -> u64;

    /// An encoder without a fault at channel `n`, of a run that is recorded.
    fn sound(&self, channel: &ChannelConfig, n: usize) -> Box<dyn OtherEncoder>;
}

const OTHERS: &[&dyn OtherBench] = &[&t_format::TFormat, &ssi::Ssi];

/// Those that channels of a card speak.
pub fn others_on(card: &CardConfig) -> impl Iterator<Item = &'static dyn OtherBench> + '_ {
    let all = OTHERS.iter().copied();
    all.filter(|other| card.speaks(other.protocol()))
}

/// The benches of a protocol; none of EnDat.
pub fn other(protocol: Protocol) -> Option<&'static dyn OtherBench> {
    let mut all = OTHERS.iter().copied();
    all.find(|other| other.protocol() == protocol)
}

/// What a bench has for the channels of a protocol: text, and what the rest of the bench must know of them.
///
/// In the text of a protocol called `x` the rest of the bench counts on the task `x_new_fields` (other content, and no fault),
/// `x_check_requests` (behind the start of a trigger), `x_check` (a channel and the status of its result), `x_check_stamps`, the functions
/// `x_start_cycles` (from the time stamp of an EnDat channel to that of this one; 0 of others) `x_withdrawn` (the position of a channel has been withdrawn), and the parameter `X_TRIGGER_OVERRUN`.
#[derive(Serialize)]
pub struct BenchParts {
    /// Name of the protocol, and as an identifier.
    pub name: &'static str,
    /// See `name`.
    pub word: &'static str,
    /// The channels that speak it.
    pub channels: Vec<usize>,
    /// The module of the encoder.
    pub encoder: String,
    /// Encoders at the channels, and tasks.
    pub ports: String,
    /// What is tried.
    pub steps: String,
    /// Channels whose results bring no position.
    pub silent: Vec<usize>,
    /// The bits of the position that results of each channel bring.
    pub masks: Vec<(usize, String)>,
    /// The shortest exchange, in system clock cycles.
    pub shortest_cycles: u64,
}

/// The parts of the VHDL bench for the channels of a protocol.
#[derive(Serialize)]
pub struct VhdlParts {
    /// Name of the protocol as an identifier.
    pub word: &'static str,
    /// The longest exchange, in system clock cycles.
    pub longest_cycles: u64,
    /// The shortest exchange.
    pub shortest_cycles: u64,
    /// A part of the channels that the bench does not check.
    pub unchecked: Option<&'static str>,
    /// Text for each place of the bench that is in `VHDL_PLACES`.
    #[serde(flatten)]
    pub texts: BTreeMap<&'static str, String>,
}

impl VhdlParts {
    /// Renders the template of a protocol for each place.
    pub fn texts(
        template: &str,
        facts: &Value,
    ) -> Result<BTreeMap<&'static str, String>, CommandError> {
        let text = |place: &'static str| {
            let context = context! { part => place, ..facts.clone() };
            Ok((place, template::render("vhdl_parts", template, &context)?))
        };
        VHDL_PLACES.into_iter().map(text).collect()
    }
}

/// Places of the bench in VHDL at which a protocol has text: its encoder, signals, what the encoder sends next, checks.
const VHDL_PLACES: [&str; 13] = [
    "encoder",
    "signals",
    "cables",
    "variables",
    "procedures",
    "new_positions",
    "give",
    "results",
    "read",
    "restart",
    "overrun",
    "cut",
    "steps",
];
