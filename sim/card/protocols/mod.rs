//! Other protocols than EnDat on a virtual card: encoders and their faults.

pub mod ssi;
pub mod t_format;

use crate::deed::Deed;
use crate::sets::Motion;
use crate::settings::VirtualConfig;
use endat_hdl::config::ChannelConfig;
use endat_regs::Protocol;
use endat_sim::bench::OtherEncoder;

/// The encoders of a protocol besides EnDat.
pub trait OtherEncoders: Sync {
    /// Which it is.
    fn protocol(&self) -> Protocol;

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
}

/// All of them.
pub const OTHERS: &[&dyn OtherEncoders] = &[&t_format::TFormat, &ssi::Ssi];

/// The encoders of a protocol; none of EnDat.
pub fn other(protocol: Protocol) -> Option<&'static dyn OtherEncoders> {
    let mut all = OTHERS.iter().copied();
    all.find(|other| other.protocol() == protocol)
}

/// An encoder that is plugged in.
pub struct Plugged {
    /// The encoder on its line.
    pub encoder: Box<dyn OtherEncoder>,
    /// Its position, as a result has it.
    pub motion: Motion,
    /// Its faults.
    pub faults: Box<dyn OtherFaults>,
}

/// Faults of an encoder of a virtual card.
pub trait OtherFaults: Send {
    /// Faults that it knows, in words.
    fn known(&self) -> Vec<String>;

    /// Makes a fault; `None` if the encoder has no such fault.
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
