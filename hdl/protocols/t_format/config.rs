//! Converts requests for T-format channels to cycles, and computes the length of an exchange.

use super::asked::{is_rate, is_triggered, TFormatSpec};
use super::protocol::{
    Content, BIT_HZ, CARD_BIT_CYCLES_MIN, FAST_BIT_HZ, RATE_TOLERANCE_PPM, REST_US,
};
use crate::config::{
    check_filter, limits, microseconds, ChannelConfig, ChannelSpec, Check, TooLong,
};
use crate::endat::timing::{cycles_at_least, deviation_ppm, period_cycles};
use crate::protocols::Spoken;

/// Position bits of a T-format channel: multi-turn in bits 47..24, single-turn in 23..0.
const POSITION_BITS: u32 = 48;

impl TFormatSpec {
    /// The longest exchange within the pauses: half a bit, request, reply, and the rest before the next one.
    pub(crate) fn cycle_max_cycles(&self, channel: &ChannelConfig, system_hz: u64) -> u64 {
        let bit_cycles = channel.period_cycles;
        let pauses = self.request.reply().len() as u64 - 1;
        let gaps_us = self.reply_gap_us + self.field_gap_us * pauses;
        // One microsecond for all synchronisation.
        let waits_ns = 1_000 * (gaps_us + REST_US + 1);
        bit_cycles * (self.request.wire_bits() + 1) + cycles_at_least(waits_ns, system_hz)
    }
}

impl TFormatSpec {
    /// Converts and checks a channel.
    pub(crate) fn resolve(
        &self,
        check: &mut Check<'_>,
        request: &ChannelSpec,
        system_hz: u64,
    ) -> Option<ChannelConfig> {
        let mut within = |key, value| check.within(key, value, &limits(key, Some(system_hz)));
        let gaps_good = [
            within("reply_gap_us", self.reply_gap_us),
            within("field_gap_us", self.field_gap_us),
        ];
        if !is_rate(self.bit_hz) {
            check.fail(
                "bit_hz",
                self.bit_hz,
                format!("is no rate of T-format encoders; use {BIT_HZ} or {FAST_BIT_HZ}"),
            );
            return None;
        }
        if !is_triggered(self.request) {
            check.fail(
                "request",
                u64::from(self.request.id()),
                "accesses the EEPROM, which a trigger must not; use 3, and the word t_format<n>.send for the EEPROM".into(),
            );
        }
        self.check_range(check, request);
        let bit_cycles = check_rate(check, self.bit_hz, system_hz)?;
        // Less than half a bit.
        let filter_cycles =
            check_filter(check, request, (bit_cycles - 1) / 2, 1, system_hz, "a bit");
        (gaps_good == [true, true]).then(|| ChannelConfig {
            period_cycles: bit_cycles,
            first_low_extra_cycles: 0,
            command: request.command,
            position_bits: POSITION_BITS,
            filter_cycles,
            filter_half: false,
            start_window_cycles: 0,
            start_timeout_us: self.reply_gap_us,
            recovery_limit_cycles: 0,
            ready_low_cycles: 0,
            abort_us: 0,
            spoken: Spoken::TFormat(*self),
            spec: request.clone(),
        })
    }

    /// Rejects bits of a part that a trigger does not bring.
    fn check_range(&self, check: &mut Check<'_>, request: &ChannelSpec) {
        let id = self.request.id();
        let brings = |content| self.request.reply().contains(&content);
        let Some([single, multi]) = request.range.and_then(|range| range.bits(0)) else {
            if request.range.is_some() && brings(Content::MultiTurn) {
                let text = format!("request = {id} brings turns, and a scale has none; remove it, or set request to 0");
                check.fail("linear", true, text);
            }
            return;
        };
        if !brings(Content::SingleTurn) {
            let text = format!("request = {id} brings no angle; remove it, or set request to 3");
            check.fail("single_turn_bits", single, text);
        } else if multi > 0 && !brings(Content::MultiTurn) {
            let text = format!("request = {id} brings no turns; remove it, or set request to 3");
            check.fail("multi_turn_bits", multi, text);
        }
    }

    /// Message for a trigger that comes before the channel is ready, with the remedy.
    pub(crate) fn too_long(&self, index: usize, _: &ChannelConfig, times: TooLong) -> String {
        let highest = times.highest_hz();
        format!(
            "an exchange of T-format channel {index} takes up to {} us with its pauses, so at most {highest} Hz; lower it to {highest}, or make the exchange shorter: lower reply_gap_us = {} and field_gap_us = {}, or ask for less with request = 0",
            microseconds(times.cycles, times.system_hz),
            self.reply_gap_us,
            self.field_gap_us
        )
    }
}

/// The cycles of a bit, if the rate is accurate enough.
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
