//! Converts requests for SSI channels to cycles, and computes the length of a frame.

use super::asked::SsiSpec;
use super::protocol::{bit_delay_most_ns, CLOCK_HZ_MIN, LATENCY_CYCLES, PERIOD_CYCLES_MIN};
use super::specials::{Places, Special, SHOWN_MAX, SPECIALS_MAX};
use crate::config::{
    check_clock, check_filter, check_tst, is_uneven, limits, max_of, microseconds,
    recovery_most_ns, ChannelConfig, ChannelSpec, Check, Limits, TooLong, CABLE_M_MAX,
    DELAY_NS_PER_M, FILTER_BITS, INPUT_LATENCY_CYCLES,
};
use crate::endat::timing::{cycles_at_least, cycles_at_most, cycles_to_ns, ENDAT_HZ_MAX};
use crate::protocols::Spoken;

impl SsiSpec {
    /// Time from a frame to the earliest next one, at most.
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
            within("bit_delay_ns", self.bit_delay_ns),
            check.within(
                "recovery_max_ns",
                request.recovery_max_ns,
                &recovery_limits(request.cable_m, system_hz),
            ),
            check.within(
                "clock_hz",
                request.clock_hz,
                &Limits::new(CLOCK_HZ_MIN..=ENDAT_HZ_MAX),
            ),
        ];
        if are_good != [true; 6] {
            return None;
        }
        let period = check_clock(check, request.clock_hz, system_hz, None)?;
        let half = period / 2;
        let filter_cycles = check_filter(check, request, half, 1, system_hz, "a clock period");
        // A filter that is too long is already reported, and must not narrow other limits.
        let counted = filter_cycles.min(half).min(max_of(FILTER_BITS));
        self.check_bit_delay(check, request, [period, counted], system_hz);
        self.check_specials(check);
        let needed = self.needed_cycles(request, counted, system_hz);
        match self.holds_end {
            true => self.check_held_end(check),
            false => check_recovery_low(check, request, [period, needed], system_hz),
        }
        check_recovery(check, request);
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

    /// Checks that the special bits fit the port and the result.
    fn check_specials(&self, check: &mut Check<'_>) {
        let lists = [("bits_before", &self.before), ("bits_after", &self.after)];
        if let Some(special) = self.before.iter().find(|s| s.is_check()) {
            let text = format!(
                "{:?} is of the bits before it, and the position comes after these; move it to bits_after, or {}",
                special.word(),
                match special {
                    Special::Crc6 => "call its six bits \"ignored\"",
                    _ => "call it \"ignored\"",
                }
            );
            check.fail("bits_before", self.before, text);
            return;
        }
        let count = |is: fn(&Special) -> bool| self.after.iter().filter(is).count();
        let parities = count(|s| s.is_parity());
        let twice = match parities > 1 {
            true => Some("has two parity bits; call the first of them \"ignored\""),
            false if count(|s| *s == Special::Crc6) > 1 => {
                Some("has two CRCs; call the six bits of the first one \"ignored\"")
            }
            false => None,
        };
        if let Some(text) = twice {
            check.fail("bits_after", self.after, text.into());
            return;
        }
        let bits = self.before.bits() + self.after.bits();
        let (key, list) = lists[usize::from(!self.after.is_empty())];
        if bits > SPECIALS_MAX {
            let text = format!("{bits} bits of a frame are not position, bits_before and bits_after together; at most {SPECIALS_MAX} (without the last ones an encoder needs end_low = false); leave the last ones out");
            check.fail(key, list, text);
            return;
        }
        let places = Places::new(&self.before, &self.after);
        let shown = self.specials().filter(|s| s.is_shown());
        let hidden =
            |(special, place): (Special, &usize)| special == Special::Shown && *place >= SHOWN_MAX;
        if shown.zip(&places.shown).any(hidden) {
            let text = format!("a result has room for the last {SHOWN_MAX} special bits, counted from the last one that is not ignored, and a \"shown\" one is before these; call it \"ignored\"");
            let is_before = self.before.iter().any(|s| s == Special::Shown);
            let (key, list) = lists[usize::from(!is_before)];
            check.fail(key, list, text);
        }
    }

    /// A LOW bit separates two copies, so one follows the last copy, too.
    fn check_held_end(&self, check: &mut Check<'_>) {
        if self.twice {
            let text = "an encoder that sends its position twice is LOW after each copy; leave end_low out, or leave twice out";
            check.fail("end_low", false, text.into());
        }
    }

    /// The shortest period that a bit fits into.
    fn needed_cycles(&self, request: &ChannelSpec, filter_cycles: u64, system_hz: u64) -> u64 {
        let needed_ns = self.bit_delay_ns + cable_ns(request);
        let needed = cycles_at_least(needed_ns, system_hz) + LATENCY_CYCLES + filter_cycles;
        let mut cycles = needed.max(PERIOD_CYCLES_MIN);
        while is_uneven(cycles) {
            cycles += 1;
        }
        cycles
    }

    /// A bit must be stable before the next clock edge.
    fn check_bit_delay(
        &self,
        check: &mut Check<'_>,
        request: &ChannelSpec,
        [period, filter_cycles]: [u64; 2],
        system_hz: u64,
    ) {
        let (own_ns, cable_ns) = (self.bit_delay_ns, cable_ns(request));
        let most_ns = bit_delay_most_ns(period, filter_cycles, system_hz);
        if most_ns >= own_ns + cable_ns {
            return;
        }
        let input_cycles = LATENCY_CYCLES + filter_cycles;
        let cycles = self.needed_cycles(request, filter_cycles, system_hz);
        // The remedy must itself be valid.
        let mut remedies = Vec::new();
        if system_hz / cycles >= CLOCK_HZ_MIN {
            remedies.push(format!("use at most {} Hz", system_hz / cycles));
        }
        if let (1.., Some(left_ns)) = (request.cable_m, most_ns.checked_sub(own_ns)) {
            remedies.push(format!("lower cable_m to {}", left_ns / DELAY_NS_PER_M));
        }
        if let Some(left_ns) = most_ns.checked_sub(cable_ns) {
            remedies.push(format!(
                "lower bit_delay_ns to {left_ns}, if that is the encoder's"
            ));
        }
        let remedy = match (remedies.is_empty(), most_ns) {
            (false, _) => remedies.join(", or "),
            (true, 0) => format!(
                "no period with clock.system_hz = {system_hz} holds both; use a faster system clock"
            ),
            (true, _) => "lower bit_delay_ns and cable_m".into(),
        };
        let text = format!(
            "a bit takes up to {} ns of a period from its clock edge ({own_ns} ns in the encoder, the rest in {} m of cable), and the input {input_cycles} cycles; {remedy}",
            own_ns + cable_ns,
            request.cable_m
        );
        check.fail("clock_hz", request.clock_hz, text);
    }

    /// Message for a trigger that comes before the channel is ready, with the remedy.
    pub(crate) fn too_long(&self, index: usize, channel: &ChannelConfig, times: TooLong) -> String {
        let highest = times.highest_hz();
        let twice = match self.twice {
            true => ", leave twice out",
            false => "",
        };
        format!(
            "a frame of SSI channel {index} takes up to {} us with the recovery time, so at most {highest} Hz; lower it to {highest}, or make the frame shorter: raise clock_hz = {}{twice}, or shorten recovery_max_ns = {} if the data sheet allows it",
            microseconds(times.cycles, times.system_hz),
            channel.spec.clock_hz,
            channel.spec.recovery_max_ns
        )
    }
}

/// Checks that the shortest recovery time is at most the longest.
fn check_recovery(check: &mut Check<'_>, request: &ChannelSpec) {
    let (least_ns, most_ns) = (request.recovery_min_ns, request.recovery_max_ns);
    if least_ns > most_ns {
        let text = format!(
            "above recovery_max_ns = {most_ns}; lower it to {most_ns}, or raise recovery_max_ns to {least_ns}"
        );
        check.fail("recovery_min_ns", least_ns, text);
    }
}

/// DATA must still be LOW when it is checked, a period after the last rising edge.
fn check_recovery_low(
    check: &mut Check<'_>,
    request: &ChannelSpec,
    [period, needed]: [u64; 2],
    system_hz: u64,
) {
    let (least_ns, most_ns) = (request.recovery_min_ns, request.recovery_max_ns);
    if least_ns > most_ns {
        return;
    }
    let end_cycles = period / 2 + period;
    let end_ns = cycles_to_ns(end_cycles, system_hz);
    if end_ns > least_ns {
        // Three halves of an even period.
        let longest = cycles_at_most(least_ns, system_hz) / 3 * 2;
        let clock = match longest {
            // The remedy must itself be valid.
            PERIOD_CYCLES_MIN.. if longest >= needed => {
                format!("use at least {} Hz, or ", system_hz.div_ceil(longest))
            }
            _ => String::new(),
        };
        let raised = match end_ns > most_ns {
            true => "recovery_min_ns and recovery_max_ns",
            false => "recovery_min_ns",
        };
        let text = format!(
            "DATA is checked for LOW {end_ns} ns after the last falling edge, but recovery_min_ns = {least_ns} ends the LOW sooner; {clock}raise {raised} to {end_ns}, if the encoder's is as long"
        );
        check.fail("clock_hz", request.clock_hz, text);
    }
}

/// One timer counts the longest recovery time and the cable.
fn recovery_limits(cable_m: u64, system_hz: u64) -> Limits {
    let limits = limits("recovery_max_ns", Some(system_hz));
    let cable_m = cable_m.min(CABLE_M_MAX);
    limits.at_most(
        recovery_most_ns(system_hz, cable_m),
        "less with a longer cable_m",
    )
}

/// Both ways along the cable, in ns.
fn cable_ns(request: &ChannelSpec) -> u64 {
    DELAY_NS_PER_M * request.cable_m
}
