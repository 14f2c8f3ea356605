//! A T-format encoder that fits a channel.

use endat_sim::bench::TFormatLink;
use endat_sim::t_format::EncoderConfig;
use endat_sim::NS;

/// One without a fault at channel `n`, for a run that is recorded: 10 m away.
pub fn sound(bit_hz: u64, n: usize) -> TFormatLink {
    let config = EncoderConfig {
        bit_hz,
        status: 0,
        alarm: 0,
        seed: n as u64 + 1,
        ..EncoderConfig::default()
    };
    TFormatLink::new(config, 50 * NS)
}
