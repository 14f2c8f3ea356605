//! T-format in the benches of an emission.

use super::super::{BenchParts, OtherBench, VhdlParts};
use super::{bench_parts, encoder};
use endat_config::protocols::t_format::asked;
use endat_console::error::CommandError;
use endat_hdl::config::{CardConfig, ChannelConfig};
use endat_regs::Protocol;
use endat_sim::bench::OtherEncoder;

/// See the module.
pub struct TFormat;

impl OtherBench for TFormat {
    fn protocol(&self) -> Protocol {
        Protocol::TFormat
    }

    fn bench(
        &self,
        name: &str,
        card: &CardConfig,
        sleeps: bool,
    ) -> Result<BenchParts, CommandError> {
        bench_parts::parts(name, card, sleeps)
    }

    fn vhdl_bench(&self, name: &str, card: &CardConfig) -> Result<VhdlParts, CommandError> {
        bench_parts::vhdl_parts(name, card)
    }

    fn idle_ns(&self) -> u64 {
        bench_parts::IDLE_NS
    }

    fn sound(&self, channel: &ChannelConfig, n: usize) -> Box<dyn OtherEncoder> {
        Box::new(encoder::sound(asked(channel).bit_hz, n))
    }
}
