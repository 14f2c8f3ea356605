//! SSI protocol facts. Plain Rust, no hardware.
//!
//! Ref: HEIDENHAIN, PWM 20 operating instructions, 2014, interface description (order of a frame, same value again within the recovery time);
//! POSITAL, "SSI", technology page (n + 1 clocks, LOW after the last bit and between copies); Kuebler, "Synchronous Serial Interface" (monoflop
//! time up to 40 us); TR-Electronic, COK-65 interface description (delay tV from clock to bit, pause of twice the monoflop time).

use crate::endat::timing::cycles_to_ns;

/// Typical longest time from a rising clock edge to its bit, at the encoder, in ns. Data sheets give 100 ns and more; no source has an upper
/// limit for all encoders.
pub const BIT_DELAY_NS: u64 = 400;
/// Longest configurable bit delay, in ns: most of a period of the slowest clock.
pub const BIT_DELAY_NS_MAX: u64 = 10_000;
/// Slowest clock, in hertz. Ref: TR-Electronic, data sheets of SSI encoders (80 kHz to 1 MHz).
pub const CLOCK_HZ_MIN: u64 = 80_000;
/// System clock cycles from a pin to the sampled level, without the filter: synchroniser, level, and the clock's register.
pub const LATENCY_CYCLES: u64 = 6;
/// Shortest period, in system clock cycles.
pub const PERIOD_CYCLES_MIN: u64 = 4;

/// Part of a period that is left for cable and encoder, in ns.
pub const fn bit_delay_most_ns(period: u64, filter_cycles: u64, system_hz: u64) -> u64 {
    cycles_to_ns(
        period.saturating_sub(LATENCY_CYCLES + filter_cycles),
        system_hz,
    )
}

/// Converts Gray code to a number.
pub const fn from_gray(gray: u64) -> u64 {
    let mut value = gray;
    let mut shift = 1;
    while shift < 64 {
        value ^= value >> shift;
        shift *= 2;
    }
    value
}
