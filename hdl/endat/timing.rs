//! Times and rates of EnDat; all conversions from hertz and nanoseconds to system clock cycles.
//!
//! Ref: HEIDENHAIN PWM 20 user's manual (Nov 2014), table of times; HEIDENHAIN Technical Information 383942.

/// Slowest EnDat clock, in hertz (PWM 20).
pub const ENDAT_HZ_MIN: u64 = 100_000;
/// Fastest EnDat clock with propagation-delay compensation, in hertz (PWM 20).
pub const ENDAT_HZ_MAX: u64 = 16_000_000;
/// Clock of the frame that measures the propagation delay, in hertz, unless configured otherwise: its period is longer than
/// the delay of any usual cable (TI, C2000).
pub const CALIBRATION_HZ: u64 = 200_000;
/// Clock for measuring cables whose delay is near that period, in hertz: the slowest EnDat clock.
pub const LONG_CALIBRATION_HZ: u64 = ENDAT_HZ_MIN;
/// Longest delay that can be measured with a period of [`CALIBRATION_HZ`], in ns, including pins and filter.
pub const CALIBRATION_DELAY_MAX_NS: u64 = 4_000;
/// Shortest start time tST that receivers offer, in ns (Renesas; PWM 20: 2 us).
pub const TST_MIN_NS: u64 = 500;
/// Start time tST that receivers use (TI: 2 us from 1 MHz up), in ns.
pub const TST_USUAL_NS: u64 = 2_000;
/// Longest start time tST, in ns (PWM 20).
pub const TST_MAX_NS: u64 = 10_000;
/// The clock from which TI's receiver uses tST, in hertz.
pub const TST_FROM_HZ: u64 = 1_000_000;
/// Shortest recovery time tm, in ns (PWM 20; default range).
pub const RECOVERY_MIN_NS: u64 = 10_000;
/// Longest recovery time tm, in ns (PWM 20; default range).
pub const RECOVERY_MAX_NS: u64 = 30_000;
/// Shortest programmed recovery time, in ns (PWM 20; EnDat 2.2 commands above 1 MHz only).
pub const SHORT_RECOVERY_MIN_NS: u64 = 1_250;
/// From the edge after an answer to the look for additional data, in ns, if the middle of the cell
/// comes later: half the shortest recovery time, so the recovery time is still running.
pub const SEPARATOR_NS: u64 = SHORT_RECOVERY_MIN_NS / 2;
/// Data must have been low for longer than tR before the next frame, in ns (PWM 20).
pub const READY_LOW_NS: u64 = 500;
/// Quiet time after an aborted transfer, in microseconds (S2 block, ADDI driver).
pub const ABORT_US: u64 = 30_000;
/// Longest wait within a frame, except for a start bit, in microseconds: more than the longest answer at the slowest clock.
/// Only a receiver that has lost its place waits for so long. It is a power of two, so that one bit of the timer is enough.
pub const FRAME_US: u64 = 1 << 12;
/// Time that DATA is driven LOW at rest to see whether it follows, in microseconds (chosen: transceivers take well below one).
pub const PROBE_US: u64 = 2;
/// Time for an open line to rise again after that, in microseconds (chosen: cable of 100 m with ordinary bias resistors).
pub const SETTLE_US: u64 = 20;
/// Clock HIGH at the end of continuous clock, in microseconds: longer than the longest recovery time and the longest cable's delay.
pub const LEAVE_US: u64 = 40;
/// Clock LOW between an answer and its supplement, in ns: as tST; up to 30 us are allowed (no source names a shortest time).
pub const PARK_NS: u64 = 2_000;
/// Longest wait for the answer to a command with a parameter, in microseconds: access takes up to 12 ms (PWM 20), TI waits 50 ms.
pub const PARAMETER_TIMEOUT_US: u64 = 50_000;
/// Clock HIGH after power-up, in ms, until the pulse that follows (TI: at least 800).
pub const POWER_UP_MS: u16 = 1_000;
/// Clock HIGH after that pulse, in ms (TI: 380 to 420).
pub const AFTER_PULSE_MS: u16 = 400;
/// Wait after a reset, in ms (TI, ADDI driver).
pub const RESET_MS: u16 = 50;
/// Wait after a word has been written or a memory area selected, in ms (PWM 20: access takes up to 12 ms).
pub const WRITE_MS: u16 = 12;
/// Wait between other EnDat 2.1 commands with a parameter, in ms (TI, ADDI driver: for old encoders).
pub const PARAMETER_GAP_MS: u16 = 1;
/// Longest Busy before a request fails, in ms: access takes up to 12 ms (PWM 20).
pub const BUSY_MS: u16 = 50;
/// Longest wait of a request for its trigger, in ms, unless the host changes it (chosen: triggers slower
/// than one a second are manual).
pub const REQUEST_WAIT_MS: u16 = 2_000;
/// Fastest clock of an encoder that supports EnDat 2.1 only, in kHz (PWM 20).
pub const ENDAT21_MAX_KHZ: u16 = 2_000;
/// Largest deviation of the EnDat clock from the one asked for, in parts per million.
pub const CLOCK_TOLERANCE_PPM: i64 = 5_000;
/// How much longer or shorter than half a period a pulse may be, in per cent of the period (PWM 20).
pub const PULSE_TOLERANCE_PERCENT: u64 = 10;
/// Fewest system clock cycles in one EnDat clock period that the core can time.
pub const PERIOD_CYCLES_MIN: u64 = 4;
/// Fewest system clock cycles if data is sampled on both edges of the system clock.
pub const PERIOD_CYCLES_MIN_DOUBLE: u64 = 2;

/// Cycles of a `system_hz` clock that last at least `ns` (rounded up: for minimum times).
pub const fn cycles_at_least(ns: u64, system_hz: u64) -> u64 {
    ((ns as u128 * system_hz as u128).div_ceil(1_000_000_000)) as u64
}

/// Cycles of a `system_hz` clock that last at most `ns` (rounded down: for maximum times).
pub const fn cycles_at_most(ns: u64, system_hz: u64) -> u64 {
    (ns as u128 * system_hz as u128 / 1_000_000_000) as u64
}

/// Sixteenths of a system clock cycle that are nearest to `ns` nanoseconds.
pub const fn sixteenths(ns: u64, system_hz: u64) -> u64 {
    ((16 * ns as u128 * system_hz as u128 + 500_000_000) / 1_000_000_000) as u64
}

/// Cycles of a `system_hz` clock in one period of `hz`, to the nearest cycle.
pub const fn period_cycles(hz: u64, system_hz: u64) -> u64 {
    (system_hz + hz / 2) / hz
}

/// Period of the clock that measures a delay of at most `delay_ns`, in cycles of a `system_hz` clock.
pub const fn calibration_period_cycles(delay_ns: u64, system_hz: u64) -> u64 {
    period_cycles(calibration_hz(delay_ns), system_hz)
}

/// The clock that measures a delay of at most `delay_ns`, in hertz.
pub const fn calibration_hz(delay_ns: u64) -> u64 {
    match delay_ns > CALIBRATION_DELAY_MAX_NS {
        true => LONG_CALIBRATION_HZ,
        false => CALIBRATION_HZ,
    }
}

/// The shortest measured recovery time that is accepted for `ns`: a sixteenth less, for jitter and measurement.
pub const fn recovery_min_cycles(ns: u64, system_hz: u64) -> u64 {
    cycles_at_most(ns - ns / 16, system_hz)
}

/// The fastest clock that measures a delay of at most `delay_ns`: it leaves the same part of its period for pins and edges as the default.
pub const fn calibration_most_hz(delay_ns: u64) -> u64 {
    CALIBRATION_HZ * CALIBRATION_DELAY_MAX_NS / delay_ns
}

/// Duration of `cycles` of a `system_hz` clock in nanoseconds, rounded to the nearest.
pub const fn cycles_to_ns(cycles: u64, system_hz: u64) -> u64 {
    ((cycles as u128 * 1_000_000_000 + system_hz as u128 / 2) / system_hz as u128) as u64
}

/// Deviation of `actual` from `wanted` in parts per million, towards zero.
pub const fn deviation_ppm(actual_hz: f64, wanted_hz: f64) -> f64 {
    (actual_hz / wanted_hz - 1.0) * 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minimum_times_round_up_and_maximum_times_down() {
        assert_eq!(cycles_at_least(500, 100_000_000), 50);
        assert_eq!(cycles_at_least(501, 100_000_000), 51);
        assert_eq!(cycles_at_most(509, 100_000_000), 50);
        assert_eq!(cycles_at_least(31, 128_000_000), 4);
    }

    #[test]
    fn four_megahertz_from_a_hundred_is_an_odd_number_of_cycles() {
        assert_eq!(period_cycles(4_000_000, 100_000_000), 25);
        assert_eq!(period_cycles(3_125_000, 100_000_000), 32);
        assert_eq!(period_cycles(8_333_333, 100_000_000), 12);
    }
}
