//! What the program has to know of a protocol besides EnDat: one implementation is all of it, [`crate::protocols`] lists them.

use crate::config::reader::Table;
use crate::error::GenError;
use crate::template;
use crate::virtual_card::deed::Deed;
use crate::virtual_card::sets::Motion;
use crate::virtual_card::settings::VirtualConfig;
use endat_hdl::config::{CardConfig, ChannelConfig, ChannelSpec};
use endat_regs::Protocol;
use endat_sim::bench::OtherEncoder;
use minijinja::{context, Value};
use serde::Serialize;
use std::collections::BTreeMap;

/// A protocol besides EnDat.
pub trait Other: Sync {
    /// Which it is.
    fn protocol(&self) -> Protocol;

    /// Reads a `[[channel]]` of a card; none if what is wrong leaves nothing to judge.
    fn read(&self, table: &Table<'_, '_>, system_hz: Option<u64>) -> Option<Wanted>;

    /// What decides what a channel does, for the hash of a card.
    fn canonical(&self, channel: &ChannelConfig) -> String;

    /// What `explain` tells of channel `index`.
    fn report(&self, card: &CardConfig, index: usize, encoder: &str) -> OtherReport;

    /// What the emitted bench has for its channels; `sleeps`: the card does something else first.
    fn bench(&self, name: &str, card: &CardConfig, sleeps: bool) -> Result<BenchParts, GenError>;

    /// The parts of the VHDL bench for its channels.
    fn vhdl_bench(&self, name: &str, card: &CardConfig) -> Result<VhdlParts, GenError>;

    /// After an exchange without a reply the line of the bench's encoder is idle at the latest after this, in ns.
    fn idle_ns(&self) -> u64;

    /// Encoders that `--encoder` knows.
    fn devices(&self) -> &'static [&'static str];

    /// An encoder at channel `n` of a virtual card; `is_open`: not plugged in.
    fn plug(
        &self,
        channel: &ChannelConfig,
        n: usize,
        is_open: bool,
        config: &VirtualConfig,
    ) -> Plugged;

    /// An encoder without a fault at channel `n`, of a run that is recorded.
    fn sound(&self, channel: &ChannelConfig, n: usize) -> Box<dyn OtherEncoder>;
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
    /// Text for each place of the bench that is in [`VHDL_PLACES`].
    #[serde(flatten)]
    pub texts: BTreeMap<&'static str, String>,
}

impl VhdlParts {
    /// Renders the template of a protocol for each place.
    pub fn texts(
        template: &str,
        facts: &Value,
    ) -> Result<BTreeMap<&'static str, String>, GenError> {
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

/// An encoder that is plugged in.
pub struct Plugged {
    /// The encoder on its line.
    pub encoder: Box<dyn OtherEncoder>,
    /// Its position, as a result has it.
    pub motion: Motion,
    /// What can be wrong with it.
    pub faults: Box<dyn OtherFaults>,
}

/// What can be wrong with an encoder of a virtual card.
pub trait OtherFaults: Send {
    /// Faults that it knows, in words.
    fn known(&self) -> Vec<String>;

    /// Makes one; none if there is no such fault.
    fn make(&mut self, encoder: &mut dyn OtherEncoder, deed: Deed) -> Option<()>;

    /// Ends what was to spoil some replies only; whether something of that kind goes on.
    fn mend(&mut self, encoder: &mut dyn OtherEncoder) -> bool;
}

/// Replies that are spoilt, up to some number of them.
#[derive(Default)]
pub struct Spoilt(Option<u64>);

impl Spoilt {
    /// All replies until the encoder has counted so many; none if something lasts.
    pub fn until(count: Option<u64>) -> Self {
        Self(count)
    }

    /// Whether they come to their end with so many counted.
    pub fn ends_at(&mut self, count: u64) -> bool {
        let ends = self.0.is_some_and(|until| count >= until);
        self.0 = self.0.filter(|_| !ends);
        ends
    }

    /// Whether more will be spoilt.
    pub fn goes_on(&self) -> bool {
        self.0.is_some()
    }
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
