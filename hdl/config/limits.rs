//! Allowed range of each key, independent of the other keys.

use super::*;
use crate::card::channel_trigger::SKIP_BITS;
use crate::card::stream::buffer::BUFFER_BYTES;
use crate::endat::timing::*;
use crate::protocol::POSITION_BITS;
use crate::protocols;
use endat_regs::service::{ERROR_TEST_MS_MAX, ERROR_TEST_PATIENCE_MS};

/// System clock cycles in the shortest period of the serial clock, with SPI.
pub const SCK_CYCLES_MIN: u64 = 8;

/// Allowed values of a key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limits {
    range: RangeInclusive<u64>,
    /// 0 is allowed, too, and means "none".
    or_zero: bool,
    note: &'static str,
}

impl Limits {
    /// A range.
    pub const fn new(range: RangeInclusive<u64>) -> Self {
        Self {
            range,
            or_zero: false,
            note: "",
        }
    }

    /// The same range with another upper end, if that is lower; `note` names its source.
    pub fn at_most(self, high: u64, note: &'static str) -> Self {
        match high < *self.range.end() {
            true => Self {
                range: *self.range.start()..=high,
                note,
                ..self
            },
            false => self,
        }
    }

    /// The range.
    pub fn range(&self) -> RangeInclusive<u64> {
        self.range.clone()
    }

    /// True if 0 is allowed, too, and means "none".
    pub const fn or_zero(&self) -> bool {
        self.or_zero
    }

    /// True if a value is allowed.
    pub fn contains(&self, value: u64) -> bool {
        self.range.contains(&value) || (self.or_zero && value == 0)
    }
}

/// Problem of a value outside the range, and the remedy.
impl fmt::Display for Limits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (low, high) = (self.range.start(), self.range.end());
        match self.or_zero {
            true => write!(f, "neither 0 nor in {low}..{high}")?,
            false => write!(f, "outside {low}..{high}")?,
        }
        if !self.note.is_empty() {
            write!(f, " ({})", self.note)?;
        }
        write!(f, "; choose a value in that range")
    }
}

/// Limits of `clock_hz` over all protocols.
pub fn clock_limits() -> Limits {
    let slowest = ENDAT_HZ_MIN.min(protocols::CLOCK_HZ_MIN);
    Limits::new(slowest..=ENDAT_HZ_MAX)
}

/// Allowed range of a key at this system clock; `None` = at any.
pub fn limits(key: &str, system_hz: Option<u64>) -> Limits {
    let (slow, fast) = system_hz.map_or((SYSTEM_HZ_MIN, SYSTEM_HZ_MAX), |hz| (hz, hz));
    let range = match key {
        "system_hz" => SYSTEM_HZ_MIN..=SYSTEM_HZ_MAX,
        "clock_hz" => ENDAT_HZ_MIN..=ENDAT_HZ_MAX,
        "calibration_hz" => ENDAT_HZ_MIN..=calibration_most_hz(DELAY_BASE_NS),
        "tst_ns" => TST_MIN_NS..=TST_MAX_NS,
        "position_bits" => u64::from(*POSITION_BITS.start())..=u64::from(*POSITION_BITS.end()),
        "single_turn_bits" => 1..=u64::from(*POSITION_BITS.end()),
        "multi_turn_bits" => 0..=max_of(MULTI_TURN_BITS),
        "cable_m" => 0..=cable_most_m(slow),
        "tcal_max_ns" => 1..=tcal_most_ns(calibration_most_hz(DELAY_BASE_NS), 0),
        "recovery_min_ns" | "recovery_max_ns" => SHORT_RECOVERY_MIN_NS..=recovery_most_ns(slow, 0),
        "filter_ns" => 0..=cycles_at_most_ns(max_of(FILTER_BITS), slow),
        "start_window_ns" => {
            cycles_to_ns_up(1, fast)..=cycles_to_ns_up(max_of(START_WINDOW_BITS), slow)
        }
        "sample_hz" => slow.div_ceil(max_of(TIMER_BITS))..=1_000_000,
        "baud" => 9_600..=fast / UART_BIT_CYCLES_MIN,
        "read_hz" => 1..=1_000_000,
        "fifo_bytes" => BUFFER_BYTES[0]..=BUFFER_BYTES[BUFFER_BYTES.len() - 1],
        "fixed_delay_ns" => 0..=cycles_at_most_ns(max_of(DELAY_BITS), slow),
        "drift_limit_ns" => 0..=cycles_at_most_ns(max_of(DRIFT_LIMIT_BITS) >> 4, slow),
        "base_address" => 0..=u64::from(u32::MAX),
        "sck_hz" => 1..=fast / SCK_CYCLES_MIN,
        "samples" => 1..=3,
        "divider" => 1..=1 << SKIP_BITS,
        "error_test_ms" => ERROR_TEST_PATIENCE_MS.into()..=ERROR_TEST_MS_MAX.into(),
        _ => protocols::range(key).unwrap_or(0..=u64::MAX),
    };
    Limits {
        or_zero: key == "tst_ns" || key == "fifo_bytes",
        ..Limits::new(range)
    }
}

/// Range of a key that is valid for every value of the other keys.
pub fn narrowest(key: &str, system_hz: Option<u64>) -> Limits {
    let slow = system_hz.unwrap_or(SYSTEM_HZ_MAX);
    let whole = limits(key, system_hz);
    match key {
        "tcal_max_ns" => whole.at_most(tcal_most_ns(ENDAT_HZ_MIN, CABLE_M_MAX), ""),
        "recovery_min_ns" | "recovery_max_ns" => {
            whole.at_most(recovery_most_ns(slow, CABLE_M_MAX), "")
        }
        _ => whole,
    }
}

/// Longest calculation time for which the wait for the start bit fits the timer, also in the calibration frame.
pub(super) fn tcal_most_ns(slowest_hz: u64, cable_m: u64) -> u64 {
    let wait_ns = 1_000 * (max_of(START_TIMEOUT_BITS) - 1);
    wait_ns - start_wait_ns(slowest_hz, cable_m)
}

/// Time by which the wait for a start bit may exceed tcal: cable, and two periods of the slowest frame, which may
/// pass before a start edge is detected.
pub(super) fn start_wait_ns(slowest_hz: u64, cable_m: u64) -> u64 {
    delay_max_ns(cable_m) + 2 * 1_000_000_000u64.div_ceil(slowest_hz)
}

/// Longest cable for which the counters hold the delay and the period of the measuring clock.
fn cable_most_m(system_hz: u64) -> u64 {
    let counted_ns = cycles_at_most_ns(max_of(DELAY_BITS) - INPUT_LATENCY_CYCLES, system_hz);
    let measured_ns = match period_cycles(LONG_CALIBRATION_HZ, system_hz) > max_of(PERIOD_BITS) {
        true => CALIBRATION_DELAY_MAX_NS,
        false => u64::MAX,
    };
    let longest_ns = counted_ns.min(measured_ns).saturating_sub(DELAY_BASE_NS);
    CABLE_M_MAX.min(longest_ns / DELAY_NS_PER_M)
}

/// Longest recovery time that fits the timer with this cable.
pub(crate) fn recovery_most_ns(system_hz: u64, cable_m: u64) -> u64 {
    let cycles = max_of(RECOVERY_LIMIT_BITS) - INPUT_LATENCY_CYCLES;
    cycles_at_most_ns(cycles, system_hz) - delay_max_ns(cable_m)
}

/// Longest whole number of ns for which [`cycles_at_least`] gives no more than `cycles`.
pub(super) fn cycles_at_most_ns(cycles: u64, system_hz: u64) -> u64 {
    (u128::from(cycles) * 1_000_000_000 / u128::from(system_hz.max(1))) as u64
}

/// Shortest whole number of ns for which [`cycles_at_most`] gives no fewer than `cycles`.
pub(super) fn cycles_to_ns_up(cycles: u64, system_hz: u64) -> u64 {
    (u128::from(cycles) * 1_000_000_000).div_ceil(u128::from(system_hz.max(1))) as u64
}
