//! Rates and times, as data and in words.

use endat_draw::decimal;
use endat_hdl::endat::timing::deviation_ppm;
use serde::Serialize;

/// A rate that was asked for and the one the card makes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rate {
    /// Asked for, in hertz.
    pub requested_hz: u64,
    /// Made, in hertz.
    pub actual_hz: f64,
    /// Deviation, in parts per million.
    pub deviation_ppm: f64,
}

impl Rate {
    /// What was asked for, and what it becomes.
    pub fn new(requested_hz: u64, actual_hz: f64) -> Self {
        // A deviation below a thousandth of a ppm is the rounding of this very division.
        let deviation_ppm = (deviation_ppm(actual_hz, requested_hz as f64) * 1e3).round() / 1e3;
        Self {
            requested_hz,
            actual_hz,
            deviation_ppm: deviation_ppm + 0.0,
        }
    }
}

/// A rate, and what was asked for if it is another.
pub fn rate(rate: &Rate, unit: &str) -> String {
    let actual = decimal(rate.actual_hz, 1);
    match rate.deviation_ppm == 0.0 {
        true => format!("{actual} {unit}, as asked"),
        false => format!(
            "{actual} {unit}, asked {}, {:+.0} ppm",
            rate.requested_hz, rate.deviation_ppm
        ),
    }
}

/// Cycles of the system clock in microseconds.
pub fn us_of(cycles: u64, system_hz: u64) -> f64 {
    cycles as f64 * 1e6 / system_hz as f64
}
