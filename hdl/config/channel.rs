//! Converts channel requests to cycles, and computes the length of a frame.

use super::limits::{
    cycles_at_most_ns, cycles_to_ns_up, recovery_most_ns, start_wait_ns, tcal_most_ns,
};
use super::*;
use crate::endat::timing::*;
use crate::protocol::{INFO_BITS, LEAD_PULSES, SUPPLEMENT_PULSES};
use crate::protocols::Spoken;

impl ChannelConfig {
    /// Converts and checks a channel that speaks EnDat.
    pub(crate) fn of_endat(
        check: &mut Check<'_>,
        request: &ChannelSpec,
        system_hz: u64,
        double_edge: bool,
    ) -> Option<Self> {
        let system = Some(system_hz);
        let mut check_one = |key, value| check.within(key, value, &limits(key, system));
        let position_good = check_one("position_bits", request.position_bits);
        let cable_good = check_one("cable_m", request.cable_m);
        let clock_good = check_one("clock_hz", request.clock_hz);
        // An invalid value must not narrow the limits of another one.
        let cable_m = if cable_good { request.cable_m } else { 0 };
        let calibration_good =
            !(cable_good && clock_good) || check_calibration(check, request, system_hz);
        let slowest_hz = match (clock_good, calibration_good) {
            (true, true) => request.clock_hz.min(request.calibration_hz()),
            _ => CALIBRATION_HZ,
        };
        let tcal_most_ns = tcal_most_ns(slowest_hz, cable_m);
        check.within(
            "tcal_max_ns",
            request.tcal_max_ns,
            &Limits::new(1..=tcal_most_ns),
        );
        check_recovery(check, request, recovery_most_ns(system_hz, cable_m));
        let period = clock_good
            .then(|| check_clock(check, request.clock_hz, system_hz, Some(double_edge)))
            .flatten();
        period.map(|period_cycles| {
            let half = period_cycles / 2;
            let places = 1 + u64::from(double_edge);
            let filter_places =
                check_filter(check, request, half, places, system_hz, "an EnDat period");
            Self {
                period_cycles,
                first_low_extra_cycles: check_tst(check, request, half, system_hz),
                command: request.command,
                position_bits: if position_good {
                    request.position_bits as u32
                } else {
                    0
                },
                filter_cycles: filter_places / places,
                filter_half: filter_places % places == 1,
                start_window_cycles: check_window(check, request, period_cycles, system_hz),
                start_timeout_us: request
                    .tcal_max_ns
                    .saturating_add(start_wait_ns(slowest_hz, cable_m))
                    .div_ceil(1_000)
                    + 1,
                recovery_limit_cycles: cycles_at_least(
                    request.recovery_max_ns.min(1_000_000_000) + delay_max_ns(cable_m),
                    system_hz,
                ) + INPUT_LATENCY_CYCLES,
                // DATA must be low for longer than tR.
                ready_low_cycles: cycles_at_least(READY_LOW_NS, system_hz) + 1,
                abort_us: ABORT_US,
                spoken: Spoken::Endat,
                spec: request.clone(),
            }
        })
    }

    /// Longest useful input filter: an edge and the longest removed pulse fit into half a bit.
    pub const fn filter_recommended_cycles(&self) -> u64 {
        let most = (self.period_cycles / 4).saturating_sub(1);
        if most < max_of(FILTER_BITS) {
            most
        } else {
            max_of(FILTER_BITS)
        }
    }

    /// True if the encoder is to be set to the short recovery time.
    pub const fn wants_short_recovery(&self) -> bool {
        self.spec.recovery_min_ns < RECOVERY_MIN_NS
    }

    /// Actual EnDat clock of the core, in hertz.
    pub fn actual_hz(&self, system_hz: u64) -> f64 {
        system_hz as f64 / self.period_cycles as f64
    }

    /// Lengths of one frame when the encoder needs its longest calculation time.
    pub fn frame_time(&self, system_hz: u64) -> FrameTime {
        let first_low_cycles = self.period_cycles / 2 + self.first_low_extra_cycles;
        let tcal_cycles = cycles_at_least(self.spec.tcal_max_ns, system_hz);
        let needed = tcal_cycles
            .saturating_sub(first_low_cycles)
            .div_ceil(self.period_cycles);
        let lead_pulses = needed.max(u64::from(LEAD_PULSES));
        let answer_bits = u64::from(self.command.answer_bits(self.position_bits));
        let pulses = lead_pulses + answer_bits + 1;
        FrameTime {
            first_low_cycles,
            lead_pulses,
            answer_bits,
            pulses,
            frame_cycles: first_low_cycles + (pulses - 1) * self.period_cycles,
        }
    }

    /// The longest frame of a channel with requests: additional data 1 and 2 and a supplement (command 111000 only).
    pub fn longest_frame_cycles(&self, system_hz: u64) -> u64 {
        let frame = self.frame_time(system_hz).frame_cycles;
        if !self.command.has_f2() {
            return frame;
        }
        let additional_data = 2 * u64::from(INFO_BITS) * self.period_cycles;
        // Parked half a period after the last bit, and one delay before the receiver samples that bit.
        let supplement = u64::from(SUPPLEMENT_PULSES - 1) * self.period_cycles
            + cycles_at_least(PARK_NS + self.spec.delay_max_ns(), system_hz)
            + INPUT_LATENCY_CYCLES;
        frame + additional_data + supplement
    }

    /// Clock period of the frame that measures the propagation delay: at least that of other frames.
    pub fn calibration_period_cycles(&self, system_hz: u64) -> u64 {
        period_cycles(self.spec.calibration_hz(), system_hz).max(self.period_cycles)
    }

    /// True if that period differs from the default.
    pub fn has_own_calibration(&self, system_hz: u64) -> bool {
        let usual = calibration_period_cycles(self.spec.delay_max_ns(), system_hz);
        self.calibration_period_cycles(system_hz) != usual.max(self.period_cycles)
    }

    /// First falling to last rising edge of the frame that measures the propagation delay.
    pub fn calibration_cycles(&self, system_hz: u64) -> u64 {
        let period = self.calibration_period_cycles(system_hz);
        let first_low = period / 2 + self.first_low_extra_cycles;
        let tcal_cycles = cycles_at_least(self.spec.tcal_max_ns, system_hz);
        let lead = tcal_cycles
            .saturating_sub(first_low)
            .div_ceil(period)
            .max(u64::from(LEAD_PULSES));
        first_low + (lead + u64::from(self.command.answer_bits(self.position_bits))) * period
    }

    /// Shortest time between two frames in the worst case: frame, line delay, longest recovery time, tR.
    pub(crate) fn frame_cycle_max_cycles(&self, system_hz: u64) -> u64 {
        self.frame_time(system_hz).frame_cycles
            + cycles_at_least(
                self.spec.delay_max_ns() + self.spec.recovery_max_ns,
                system_hz,
            )
            + self.ready_low_cycles
            + INPUT_LATENCY_CYCLES
    }
}

/// Cycles that a period of the measuring clock needs in addition to the delay: from the pin to the receiver, which must sample a bit
/// before the next one comes.
const CALIBRATION_FREE_CYCLES: u64 = 7;

/// The clock that measures the delay: its period must be longer than the delay, and within the range of the timer.
fn check_calibration(check: &mut Check<'_>, request: &ChannelSpec, system_hz: u64) -> bool {
    let held_ns = request.delay_max_ns() + request.filter_ns.min(1_000_000);
    let held_cycles = cycles_at_least(held_ns, system_hz) + CALIBRATION_FREE_CYCLES;
    let fits_hz = system_hz / held_cycles;
    let made = request.calibration_hz().min(request.clock_hz);
    if made > fits_hz && fits_hz < calibration_most_hz(held_ns) {
        let remedy = match fits_hz {
            ENDAT_HZ_MIN.. => format!("use at most {fits_hz} Hz"),
            _ => "shorten cable or filter".into(),
        };
        let text = format!("its period must be {held_cycles} cycles of clock.system_hz = {system_hz}, {held_ns} ns for cable and filter and {CALIBRATION_FREE_CYCLES} cycles for the receiver; {remedy}, or use a faster system clock");
        check.fail("calibration_hz", made, text);
        return false;
    }
    let Some(hz) = request.calibration_hz else {
        return true;
    };
    let low = ENDAT_HZ_MIN.max(system_hz.div_ceil(max_of(PERIOD_BITS)));
    let high = calibration_most_hz(held_ns).max(low);
    if !(low..=high).contains(&hz) {
        let text = format!("outside {low}..{high} (four fifths of its period must hold the {held_ns} ns of cable and filter, and {} cycles of clock.system_hz the whole of it); choose a value in that range", max_of(PERIOD_BITS));
        check.fail("calibration_hz", hz, text);
        return false;
    }
    if hz > request.clock_hz {
        let text = format!(
            "above clock_hz = {}, and the delay is measured at the clock of the other frames or a slower one; lower it to {}",
            request.clock_hz, request.clock_hz
        );
        check.fail("calibration_hz", hz, text);
        return false;
    }
    true
}

fn check_recovery(check: &mut Check<'_>, request: &ChannelSpec, most_ns: u64) {
    let (low, high) = (request.recovery_min_ns, request.recovery_max_ns);
    let limits = Limits::new(SHORT_RECOVERY_MIN_NS..=most_ns);
    let low_good = check.within("recovery_min_ns", low, &limits);
    let high_good = check.within("recovery_max_ns", high, &limits);
    let may_be_short = request.command.has_f2() && request.clock_hz > TST_FROM_HZ;
    let condition = format!("a recovery time below {RECOVERY_MIN_NS} ns exists only with the command 111000 and a clock above {TST_FROM_HZ} Hz");
    if low_good && low < RECOVERY_MIN_NS && !may_be_short {
        let text = format!("{condition}; use {RECOVERY_MIN_NS}");
        check.fail("recovery_min_ns", low, text);
    } else if low_good && high_good && low > high {
        // The default shortest time need not be in the file.
        let (key, value, text) = match low == RECOVERY_MIN_NS {
            true if may_be_short => (
                "recovery_max_ns",
                high,
                format!("below recovery_min_ns = {low}; use at least {low}, or add recovery_min_ns = {SHORT_RECOVERY_MIN_NS}, if the encoder is set to short"),
            ),
            true => (
                "recovery_max_ns",
                high,
                format!("{condition}; use at least {RECOVERY_MIN_NS}"),
            ),
            false => {
                // The remedy must itself be valid.
                let lower = match high < RECOVERY_MIN_NS && !may_be_short {
                    true => String::new(),
                    false => format!("lower it to {high}, or "),
                };
                (
                    "recovery_min_ns",
                    low,
                    format!("above recovery_max_ns = {high}; {lower}raise recovery_max_ns to {low}"),
                )
            }
        };
        check.fail(key, value, text);
    }
}

/// True if the shorter half of a period is too short for an encoder.
pub(crate) const fn is_uneven(period: u64) -> bool {
    100 * (period / 2) < (50 - PULSE_TOLERANCE_PERCENT) * period
}

/// The period in cycles, if the rate is accurate enough; without `double_edge` if the protocol has no such feature.
pub(crate) fn check_clock(
    check: &mut Check<'_>,
    clock_hz: u64,
    system_hz: u64,
    double_edge: Option<bool>,
) -> Option<u64> {
    let period = period_cycles(clock_hz, system_hz);
    let (cycles_min, remedy) = match double_edge {
        Some(true) => (PERIOD_CYCLES_MIN_DOUBLE, ""),
        None => (PERIOD_CYCLES_MIN, ""),
        // The remedy must itself be valid.
        Some(false) if period < PERIOD_CYCLES_MIN_DOUBLE => (PERIOD_CYCLES_MIN, ""),
        Some(false) => (
            PERIOD_CYCLES_MIN,
            ", or line.parts = [\"alignment\", \"double_edge\"], which needs half of that on a card without requests",
        ),
    };
    if period < cycles_min {
        check.fail(
            "clock_hz",
            clock_hz,
            format!(
                "needs a system clock of at least {} Hz, clock.system_hz is {system_hz}; use at most {} Hz or a faster system clock{remedy}",
                clock_hz * cycles_min,
                system_hz / cycles_min
            ),
        );
        return None;
    }
    if period > max_of(PERIOD_BITS) {
        let slowest = system_hz.div_ceil(max_of(PERIOD_BITS));
        check.fail(
            "clock_hz",
            clock_hz,
            format!("its period is {period} cycles of clock.system_hz = {system_hz}, at most {} can be timed; use at least {slowest} Hz or a slower system clock", max_of(PERIOD_BITS)),
        );
        return None;
    }
    let ppm = deviation_ppm(system_hz as f64 / period as f64, clock_hz as f64);
    if ppm.abs() > CLOCK_TOLERANCE_PPM as f64 {
        let below = system_hz.div_ceil(clock_hz).max(cycles_min);
        let above = (system_hz / clock_hz).max(cycles_min);
        let rate = |cycles: u64| (system_hz + cycles / 2) / cycles;
        // The remedy must itself be valid.
        let is_good =
            |cycles: &u64| limits("clock_hz", None).contains(rate(*cycles)) && !is_uneven(*cycles);
        let mut rates: Vec<_> = [below, above]
            .into_iter()
            .filter(is_good)
            .map(rate)
            .collect();
        rates.dedup();
        let remedy = match rates.as_slice() {
            [] => "another rate".into(),
            [one] => format!("{one} Hz"),
            all => format!("{} or {} Hz", all[0], all[1]),
        };
        check.fail(
            "clock_hz",
            clock_hz,
            format!("would become {} Hz ({ppm:+.0} ppm), more than the allowed {CLOCK_TOLERANCE_PPM} ppm; use {remedy}, or another system clock", rate(period)),
        );
        return None;
    }
    // The first half of an odd period is the shorter one.
    if is_uneven(period) {
        check.fail(
            "clock_hz",
            clock_hz,
            format!(
                "its period of {period} cycles of clock.system_hz = {system_hz} has pulses of {} and {} cycles, encoders allow {PULSE_TOLERANCE_PERCENT} % of the period more or less than half of it; use a system clock of {} or {} Hz",
                period / 2,
                period - period / 2,
                clock_hz * (period - 1),
                clock_hz * (period + 1)
            ),
        );
        return None;
    }
    Some(period)
}

/// Cycles that tST adds to the first half period.
pub(crate) fn check_tst(
    check: &mut Check<'_>,
    request: &ChannelSpec,
    half: u64,
    system_hz: u64,
) -> u64 {
    let tst = request.tst_ns;
    if tst == 0 {
        return 0;
    }
    if !check.within("tst_ns", tst, &limits("tst_ns", Some(system_hz))) {
        return 0;
    }
    let extra = match cycles_at_least(tst, system_hz).saturating_sub(half) {
        0 => 0,
        extra => extra.max(FIRST_LOW_EXTRA_MIN),
    };
    if extra > max_of(PERIOD_BITS) {
        let most_ns = cycles_to_ns(max_of(PERIOD_BITS) + half, system_hz);
        check.fail("tst_ns", tst, format!("more than {most_ns} ns, the longest the counter can time at this system clock; lower it to {most_ns}"));
    }
    extra
}

pub(crate) fn check_filter(
    check: &mut Check<'_>,
    request: &ChannelSpec,
    half: u64,
    places: u64,
    system_hz: u64,
    whole: &str,
) -> u64 {
    // Samples of DATA in a second.
    let place_hz = places * system_hz;
    let cycles = cycles_at_least(request.filter_ns, place_hz);
    let longest = filter_longest(places);
    let most = (places * half).min(longest);
    if cycles > most {
        let unit = if places == 1 { "cycles" } else { "half cycles" };
        check.fail(
            "filter_ns",
            request.filter_ns,
            format!(
                "is {cycles} {unit}, more than {most} (half {whole}, and {longest} at most); use {} ns or less",
                cycles_at_most_ns(most, place_hz)
            ),
        );
    }
    cycles
}

fn check_window(check: &mut Check<'_>, request: &ChannelSpec, period: u64, system_hz: u64) -> u64 {
    let cycles = cycles_at_most(request.start_window_ns, system_hz);
    let most = (period / 2).min(max_of(START_WINDOW_BITS));
    if !(1..=most).contains(&cycles) {
        check.fail(
            "start_window_ns",
            request.start_window_ns,
            format!(
                "is {cycles} cycles, outside 1..{most} (half an EnDat period, and {} at most); use {}..{} ns",
                max_of(START_WINDOW_BITS),
                cycles_to_ns_up(1, system_hz),
                cycles_to_ns_up(most, system_hz)
            ),
        );
    }
    cycles
}
