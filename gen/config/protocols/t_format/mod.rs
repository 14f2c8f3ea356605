//! T-format in a configuration: keys, checks and reports of channels and of a receiver alone.

mod channel_report;
pub mod keys;
pub mod reading;

use super::{OtherConfig, OtherReport, Wanted};
use crate::reader::Table;
use channel_report::TFormatReport;
use endat_hdl::config::{CardConfig, ChannelConfig};
use endat_hdl::protocols::TFormatSpec;
use endat_regs::Protocol;

/// See the module.
pub struct TFormat;

/// The settings of a T-format channel.
pub fn asked(channel: &ChannelConfig) -> &TFormatSpec {
    let asked = channel.spoken.t_format();
    asked.expect("the registry asks for channels of this protocol")
}

impl OtherConfig for TFormat {
    fn protocol(&self) -> Protocol {
        Protocol::TFormat
    }

    fn read(&self, table: &Table<'_, '_>, system_hz: Option<u64>) -> Option<Wanted> {
        reading::read(table, system_hz)
    }

    fn canonical(&self, channel: &ChannelConfig) -> String {
        reading::canonical(asked(channel), channel)
    }

    fn report(&self, card: &CardConfig, index: usize, encoder: &str) -> OtherReport {
        let channel = &card.channels[index];
        TFormatReport::new(card, channel, asked(channel), encoder).as_channel(index)
    }
}
