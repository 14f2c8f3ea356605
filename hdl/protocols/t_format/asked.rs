//! Request for a T-format channel of a card.

use super::dsp::TFormatStart;
use super::protocol::{
    Request, BIT_HZ, FAST_BIT_HZ, FIELD_GAP_US_MAX, FILTER_CYCLES_MAX, REPLY_GAP_US_MAX,
};
use std::ops::RangeInclusive;

/// Request for a T-format channel, in addition to its input filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TFormatSpec {
    /// Bit rate, in bits per second.
    pub bit_hz: u64,
    /// Request that a trigger sends.
    pub request: Request,
    /// Longest pause before the reply, in microseconds.
    pub reply_gap_us: u64,
    /// Longest pause between two fields, in microseconds.
    pub field_gap_us: u64,
}

impl Default for TFormatSpec {
    fn default() -> Self {
        let default = TFormatStart::default();
        Self {
            bit_hz: BIT_HZ,
            request: Request::Everything,
            reply_gap_us: default.reply_gap_us,
            field_gap_us: default.field_gap_us,
        }
    }
}

impl TFormatSpec {
    /// Value after reset of a field that only T-format has.
    pub(crate) fn start(&self, register: &str, field: &str) -> Option<u64> {
        match (register, field) {
            ("timing", "request_id") => Some(self.request.id().into()),
            ("limits", "field_gap_us") => Some(self.field_gap_us),
            _ => None,
        }
    }
}

/// True if T-format encoders support the rate.
pub fn is_rate(bit_hz: u64) -> bool {
    [BIT_HZ, FAST_BIT_HZ].contains(&bit_hz)
}

/// True if a trigger may send the request; EEPROM requests would wear the EEPROM out.
pub const fn is_triggered(request: Request) -> bool {
    !matches!(request, Request::ReadEeprom | Request::WriteEeprom)
}

/// Range of a key of T-format.
pub(crate) fn range(key: &str) -> Option<RangeInclusive<u64>> {
    Some(match key {
        "bit_hz" => BIT_HZ..=FAST_BIT_HZ,
        "request" => 0..=15,
        "reply_gap_us" => 1..=REPLY_GAP_US_MAX,
        "field_gap_us" => 0..=FIELD_GAP_US_MAX,
        "filter_cycles" => 0..=FILTER_CYCLES_MAX,
        _ => return None,
    })
}
