//! T-format, as a channel of a card speaks it.

use super::channel_report::TFormatReport;
use super::{bench_parts, encoder, reading};
use crate::config::reader::Table;
use crate::error::GenError;
use crate::other_protocol::{BenchParts, Other, OtherReport, Plugged, VhdlParts, Wanted};
use crate::virtual_card::settings::VirtualConfig;
use endat_hdl::config::{CardConfig, ChannelConfig};
use endat_hdl::protocols::TFormatSpec;
use endat_regs::Protocol;
use endat_sim::bench::OtherEncoder;

/// See the module.
pub struct TFormat;

/// What is asked of a channel that speaks it.
fn asked(channel: &ChannelConfig) -> &TFormatSpec {
    let asked = channel.spoken.t_format();
    asked.expect("the registry asks for channels of this protocol")
}

impl Other for TFormat {
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

    fn bench(&self, name: &str, card: &CardConfig, sleeps: bool) -> Result<BenchParts, GenError> {
        bench_parts::parts(name, card, sleeps)
    }

    fn vhdl_bench(&self, name: &str, card: &CardConfig) -> Result<VhdlParts, GenError> {
        bench_parts::vhdl_parts(name, card)
    }

    fn idle_ns(&self) -> u64 {
        bench_parts::IDLE_NS
    }

    fn devices(&self) -> &'static [&'static str] {
        encoder::DEVICES
    }

    fn plug(
        &self,
        channel: &ChannelConfig,
        n: usize,
        is_open: bool,
        config: &VirtualConfig,
    ) -> Plugged {
        encoder::plug(
            asked(channel).bit_hz,
            channel.turn_bits(),
            n,
            is_open,
            config,
        )
    }

    fn sound(&self, channel: &ChannelConfig, n: usize) -> Box<dyn OtherEncoder> {
        Box::new(encoder::sound(asked(channel).bit_hz, n))
    }
}
