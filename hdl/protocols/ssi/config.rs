//! Requests for SSI channels into cycles, and the length of a frame.

use super::asked::SsiSpec;
use super::protocol::{bit_delay_most_ns, BIT_DELAY_NS, LATENCY_CYCLES, PERIOD_CYCLES_MIN};
use crate::config::{
    check_clock, check_filter, check_tst, limits, microseconds, ChannelConfig, ChannelSpec, Check,
    TooLong, DELAY_NS_PER_M, INPUT_LATENCY_CYCLES,
};
use crate::endat::timing::{cycles_at_least, cycles_to_ns};
use crate::protocols::Spoken;

impl SsiSpec {
    /// The longest frame, up to where the next one may begin.
    pub(crate) fn cycle_max_cycles(&self, channel: &ChannelConfig, _: u64) -> u64 {
        let clocks = self.clocks(channel.position_bits);
        channel.first_low_extra_cycles
            + (clocks + 1) * channel.period_cycles
            + channel.recovery_limit_cycles
    }

    /// Converts and checks a channel.
    pub(crate) fn resolve(
        &self,
        check: &mut Check<'_>,
        request: &ChannelSpec,
        system_hz: u64,
    ) -> Option<ChannelConfig> {
        let mut within = |key, value| check.within(key, value, &limits(key, Some(system_hz)));
        let are_good = [
            within("position_bits", request.position_bits),
            within("cable_m", request.cable_m),
            within("recovery_min_ns", request.recovery_min_ns),
            within("recovery_max_ns", request.recovery_max_ns),
            within("clock_hz", request.clock_hz),
        ];
        if are_good != [true; 5] {
            return None;
        }
        let period = check_clock(check, request.clock_hz, system_hz, false)?;
        let half = period / 2;
        let filter_cycles = check_filter(check, request, half, 1, system_hz, "a clock period");
        check_bit_delay(check, request, [period, filter_cycles], system_hz);
        check_recovery(check, request, period, system_hz);
        Some(ChannelConfig {
            period_cycles: period,
            first_low_extra_cycles: check_tst(check, request, half, system_hz),
            command: request.command,
            position_bits: request.position_bits as u32,
            filter_cycles,
            filter_half: false,
            start_window_cycles: 0,
            start_timeout_us: 0,
            recovery_limit_cycles: cycles_at_least(
                request.recovery_max_ns + cable_ns(request),
                system_hz,
            ) + INPUT_LATENCY_CYCLES,
            ready_low_cycles: 0,
            abort_us: 0,
            spoken: Spoken::Ssi(*self),
            spec: request.clone(),
        })
    }

    /// Why a trigger would come before the channel is ready, and the remedy.
    pub(crate) fn too_long(&self, index: usize, channel: &ChannelConfig, times: TooLong) -> String {
        let twice = match self.twice {
            true => ", leave twice out",
            false => "",
        };
        format!(
            "a frame of SSI channel {index} takes up to {} us with the recovery time, so at most {} Hz; lower it, raise clock_hz = {}{twice}, or shorten recovery_max_ns = {} if the data sheet allows it",
            microseconds(times.cycles, times.system_hz),
            times.highest_hz(),
            channel.spec.clock_hz,
            channel.spec.recovery_max_ns
        )
    }
}

/// The LOW behind the last bit must still be there where it is looked at: a period behind the last rising edge.
fn check_recovery(check: &mut Check<'_>, request: &ChannelSpec, period: u64, system_hz: u64) {
    let (least_ns, most_ns) = (request.recovery_min_ns, request.recovery_max_ns);
    if least_ns > most_ns {
        let text = format!("above recovery_max_ns = {most_ns}; lower it, or raise recovery_max_ns");
        check.fail("recovery_min_ns", least_ns, text);
        return;
    }
    let end_cycles = period / 2 + period;
    let end_ns = cycles_to_ns(end_cycles, system_hz);
    if end_ns > least_ns {
        let text = format!(
            "the LOW behind the last bit is looked at {end_ns} ns after the last falling edge, recovery_min_ns = {least_ns} ends it sooner; use at least {} Hz, or raise recovery_min_ns to the encoder's",
            // Three halves of a period.
            3_000_000_000u64.div_ceil(2 * least_ns)
        );
        check.fail("clock_hz", request.clock_hz, text);
    }
}

/// Both ways along the cable, in ns.
fn cable_ns(request: &ChannelSpec) -> u64 {
    DELAY_NS_PER_M * request.cable_m
}

/// A bit must be there before the next one is asked for.
fn check_bit_delay(
    check: &mut Check<'_>,
    request: &ChannelSpec,
    [period, filter_cycles]: [u64; 2],
    system_hz: u64,
) {
    let needed_ns = BIT_DELAY_NS + cable_ns(request);
    if bit_delay_most_ns(period, filter_cycles, system_hz) >= needed_ns {
        return;
    }
    let cycles = cycles_at_least(needed_ns, system_hz) + LATENCY_CYCLES + filter_cycles;
    let text = format!(
        "a bit takes up to {needed_ns} ns of a period from its clock edge ({BIT_DELAY_NS} ns in the encoder, the rest in {} m of cable), and the input {} cycles; use at most {} Hz, or a shorter cable_m",
        request.cable_m,
        LATENCY_CYCLES + filter_cycles,
        system_hz / cycles.max(PERIOD_CYCLES_MIN)
    );
    check.fail("clock_hz", request.clock_hz, text);
}
