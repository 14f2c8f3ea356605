//! Requests for T-format channels into cycles, and the length of an exchange.

use super::channel::check_filter;
use super::*;
use crate::endat::timing::*;
use crate::t_format::protocol::{
    Request, BIT_HZ, CARD_BIT_CYCLES_MIN, FAST_BIT_HZ, RATE_TOLERANCE_PPM, REST_US,
};

/// Position bits of a T-format channel: multi-turn in bits 47..24, single-turn in 23..0.
const POSITION_BITS: u32 = 48;

/// What is asked of a T-format channel besides its input filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TFormatRequest {
    /// Bit rate, in bits per second.
    pub bit_hz: u64,
    /// Request that a trigger sends.
    pub request: Request,
    /// Longest pause before the reply, in microseconds.
    pub reply_gap_us: u64,
    /// Longest pause between two fields, in microseconds.
    pub field_gap_us: u64,
}

impl Default for TFormatRequest {
    fn default() -> Self {
        let usual = crate::t_format::dsp::TFormatStart::default();
        Self {
            bit_hz: BIT_HZ,
            request: Request::Everything,
            reply_gap_us: usual.reply_gap_us,
            field_gap_us: usual.field_gap_us,
        }
    }
}

impl TFormatRequest {
    /// The longest exchange that is within the pauses: half a bit, request, reply, and the rest before the next one.
    fn exchange_cycles(&self, bit_cycles: u64, system_hz: u64) -> u64 {
        let pauses = self.request.reply().len() as u64 - 1;
        let gaps_us = self.reply_gap_us + self.field_gap_us * pauses;
        // A microsecond for all that is synchronised.
        let waits_ns = 1_000 * (gaps_us + REST_US + 1);
        bit_cycles * (self.request.wire_bits() + 1) + cycles_at_least(waits_ns, system_hz)
    }
}

/// A rate that T-format encoders have.
pub fn is_rate(bit_hz: u64) -> bool {
    [BIT_HZ, FAST_BIT_HZ].contains(&bit_hz)
}

/// Whether a trigger may send the request: it must not wear the EEPROM out.
pub const fn is_triggered(request: Request) -> bool {
    !matches!(request, Request::ReadEeprom | Request::WriteEeprom)
}

impl ChannelConfig {
    /// Converts and checks a channel that speaks T-format.
    pub(super) fn resolve_t_format(
        check: &mut Check<'_>,
        request: &ChannelRequest,
        wanted: &TFormatRequest,
        system_hz: u64,
    ) -> Option<Self> {
        let mut within = |key, value| check.within(key, value, &limits(key, Some(system_hz)));
        let gaps_good = [
            within("reply_gap_us", wanted.reply_gap_us),
            within("field_gap_us", wanted.field_gap_us),
        ];
        if !is_rate(wanted.bit_hz) {
            check.fail(
                "bit_hz",
                wanted.bit_hz,
                format!("is no rate of T-format encoders; use {BIT_HZ} or {FAST_BIT_HZ}"),
            );
            return None;
        }
        if !is_triggered(wanted.request) {
            check.fail(
                "request",
                u64::from(wanted.request.id()),
                "goes to the EEPROM, which a trigger must not; use 3, and the word t_format<n>.send for the EEPROM".into(),
            );
        }
        let bit_cycles = check_rate(check, wanted.bit_hz, system_hz)?;
        // Less than half a bit.
        let filter_cycles =
            check_filter(check, request, (bit_cycles - 1) / 2, 1, system_hz, "a bit");
        (gaps_good == [true, true]).then(|| Self {
            period_cycles: bit_cycles,
            first_low_extra_cycles: 0,
            command: request.command,
            position_bits: POSITION_BITS,
            filter_cycles,
            filter_half: false,
            start_window_cycles: 0,
            start_timeout_us: wanted.reply_gap_us,
            recovery_limit_cycles: 0,
            ready_low_cycles: 0,
            abort_us: 0,
            t_format: Some(*wanted),
            request: request.clone(),
        })
    }

    /// Shortest time between two triggers in the worst case, in system clock cycles, of either protocol.
    pub fn cycle_max_cycles(&self, system_hz: u64) -> u64 {
        match &self.t_format {
            Some(t_format) => t_format.exchange_cycles(self.period_cycles, system_hz),
            None => self.frame_cycle_max_cycles(system_hz),
        }
    }
}

/// The cycles of a bit, if the rate can be made well enough.
fn check_rate(check: &mut Check<'_>, bit_hz: u64, system_hz: u64) -> Option<u64> {
    let bit_cycles = period_cycles(bit_hz, system_hz);
    if bit_cycles < CARD_BIT_CYCLES_MIN {
        let slowest_hz = bit_hz * CARD_BIT_CYCLES_MIN;
        check.fail(
            "bit_hz",
            bit_hz,
            format!("has {bit_cycles} cycles of clock.system_hz = {system_hz} in a bit, {CARD_BIT_CYCLES_MIN} are needed; use a system clock of at least {slowest_hz} Hz"),
        );
        return None;
    }
    let actual_hz = system_hz as f64 / bit_cycles as f64;
    let ppm = deviation_ppm(actual_hz, bit_hz as f64);
    if ppm.abs() > RATE_TOLERANCE_PPM as f64 {
        check.fail(
            "bit_hz",
            bit_hz,
            format!("would become {actual_hz:.0} bit/s ({ppm:+.0} ppm), more than the allowed {RATE_TOLERANCE_PPM} ppm; use a multiple of {bit_hz} Hz for clock.system_hz, for example {}", bit_hz * bit_cycles),
        );
        return None;
    }
    Some(bit_cycles)
}

impl CardConfig {
    /// Numbers of the channels that speak T-format.
    pub fn t_format_numbers(&self) -> impl Iterator<Item = usize> + '_ {
        let channels = self.channels.iter().enumerate();
        let t_format = channels.filter(|(_, c)| !c.is_endat());
        t_format.map(|(n, _)| n)
    }

    /// The same as a mask: bit n for channel n.
    pub fn t_format_channels(&self) -> u64 {
        self.t_format_numbers().fold(0, |mask, n| mask | 1 << n)
    }

    /// Channels that speak EnDat, with their numbers.
    pub fn endat_channels(&self) -> impl Iterator<Item = (usize, &ChannelConfig)> {
        let channels = self.channels.iter().enumerate();
        channels.filter(|(_, c)| c.is_endat())
    }
}
