//! SSI in the benches of an emission.

mod bench_parts;
pub mod encoder;

use super::{BenchParts, OtherBench, VhdlParts};
use endat_config::protocols::ssi::asked;
use endat_console::error::CommandError;
use endat_hdl::config::{CardConfig, ChannelConfig};
use endat_regs::Protocol;
use endat_sim::bench::OtherEncoder;

/// See the module.
pub struct Ssi;

impl OtherBench for Ssi {
    fn protocol(&self) -> Protocol {
        Protocol::Ssi
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
        Box::new(encoder::sound(channel, asked(channel), n))
    }
}
