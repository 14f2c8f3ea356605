//! SSI in a configuration: keys, checks and report of a channel.

mod channel_report;
pub mod keys;
pub mod reading;

use super::{OtherConfig, OtherReport, Wanted};
use crate::reader::Table;
use channel_report::SsiReport;
use endat_hdl::config::{CardConfig, ChannelConfig};
use endat_hdl::protocols::SsiSpec;
use endat_regs::Protocol;

/// See the module.
pub struct Ssi;

/// The settings of an SSI channel.
pub fn asked(channel: &ChannelConfig) -> &SsiSpec {
    let asked = channel.spoken.ssi();
    asked.expect("the registry asks for channels of this protocol")
}

impl OtherConfig for Ssi {
    fn protocol(&self) -> Protocol {
        Protocol::Ssi
    }

    fn read(&self, table: &Table<'_, '_>, system_hz: Option<u64>) -> Option<Wanted> {
        reading::read(table, system_hz)
    }

    fn canonical(&self, channel: &ChannelConfig) -> String {
        reading::canonical(asked(channel), channel)
    }

    fn report(&self, card: &CardConfig, index: usize, encoder: &str) -> OtherReport {
        let channel = &card.channels[index];
        SsiReport::new(card, channel, asked(channel), encoder).as_channel(index)
    }
}
