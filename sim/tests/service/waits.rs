//! Short waiting times of card and encoder, so that a test takes less time than a power-up.

use endat_hdl::endat::service::program::ServiceTimes;
use endat_sim::{encoder::EncoderConfig, MS};

/// System clock of these tests.
pub const SYSTEM_HZ: u64 = 16_000_000;

/// Short waiting times, so that a test takes less time than a power-up.
pub fn times(initialise: bool) -> ServiceTimes {
    ServiceTimes {
        initialise,
        power_up_ms: 2,
        after_pulse_ms: 2,
        reset_ms: 3,
        write_ms: 2,
        gap_ms: 1,
        busy_ms: 30,
        request_ms: 60,
        ..ServiceTimes::at(SYSTEM_HZ)
    }
}

/// An encoder with waiting times for these tests.
pub fn quick(mut encoder: EncoderConfig) -> EncoderConfig {
    encoder.tac = 0..=100_000_000;
    encoder.write_time = 0..=MS;
    encoder.reset_time = 2 * MS;
    encoder.parameter_gap = encoder.parameter_gap.min(MS);
    encoder
}
