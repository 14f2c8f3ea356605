//! The configuration of a card: what a user asks for in hertz and nanoseconds, and what the blocks get in cycles.
//!
//! ```text
//! CardRequest (Hz, ns, bits) --CardConfig::resolve--> CardConfig (cycles, checked) --> blocks, explain, files
//! ```
//!
//! The conversion happens here and nowhere else. Every problem is reported, not only the first; each names the
//! key, its value, the limit and what to do.

use crate::protocol::{ModeCommand, LEAD_PULSES, MAX_POSITION_BITS, POSITION_BITS};
use crate::timing::*;
use std::fmt;
use std::ops::RangeInclusive;

/// Channels a card may have.
pub const CHANNELS: RangeInclusive<usize> = 1..=4;
/// Bits of the EnDat period and of the first low phase, in the blocks.
pub const PERIOD_BITS: u32 = 11;
/// Bits of the input filter length, in the blocks.
pub const FILTER_BITS: u32 = 4;
/// Bits of the start window, in the blocks.
pub const START_WINDOW_BITS: u32 = 6;
/// Bits of the recovery limit, in the blocks.
pub const RECOVERY_LIMIT_BITS: u32 = 16;
/// Bits of the ready time tR, in the blocks.
pub const READY_LOW_BITS: u32 = 8;
/// Bits of the period of the sampling timer, in the blocks.
pub const TIMER_BITS: u32 = 24;
/// Slowest system clock that leaves the UART and the filters room, in hertz.
pub const SYSTEM_HZ_MIN: u64 = 8_000_000;
/// Fastest system clock that the time stamps and counters are made for, in hertz.
pub const SYSTEM_HZ_MAX: u64 = 250_000_000;
/// Fewest system clock cycles in one bit of the host UART.
pub const UART_BIT_CYCLES_MIN: u64 = 8;
/// Largest deviation of the UART rate from the one asked for, in parts per million: half of what 8N1 stands.
pub const UART_TOLERANCE_PPM: u64 = 20_000;
/// Bits on the line for one byte (8N1).
pub const UART_BITS_PER_BYTE: u64 = 10;
/// Bytes of a UARTBone read request (command, length, address).
pub const READ_REQUEST_BYTES: u64 = 6;
/// Words of one channel that a host reads per result: position (2), time stamp, status with sequence number.
pub const RESULT_WORDS: u64 = 4;
/// Longest cable that the delay budget is made for, in metres.
pub const CABLE_M_MAX: u64 = 150;
/// Constant part of the propagation delay, in ns (PWM 20: tD = 0.2 us + 0.01 us/m).
pub const DELAY_BASE_NS: u64 = 200;
/// Propagation delay of a metre of cable, there and back, worst case, in ns (PWM 20).
pub const DELAY_NS_PER_M: u64 = 10;
/// Cycles between a pin and the logic that judges it: synchroniser, longest filter, edge detection.
pub const INPUT_LATENCY_CYCLES: u64 = 32;
/// Shortest programmed recovery time, in ns (PWM 20; EnDat 2.2 commands above 1 MHz only).
pub const SHORT_RECOVERY_MIN_NS: u64 = 1_250;

/// What is asked of one channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChannelRequest {
    /// EnDat clock, in hertz.
    pub clock_hz: u64,
    /// Shortest first low phase tST, in ns; 0 = an ordinary half period.
    pub tst_ns: u64,
    /// Mode command sent with every trigger.
    pub command: ModeCommand,
    /// Position bits of the encoder.
    pub position_bits: u64,
    /// DATA must be stable this long before it counts, in ns; 0 = no filter.
    pub filter_ns: u64,
    /// The start edge must come within plus or minus this of its expected phase, in ns.
    pub start_window_ns: u64,
    /// Longest calculation time tcal of the encoder, in ns.
    pub tcal_max_ns: u64,
    /// Shortest recovery time tm of the encoder, in ns.
    pub recovery_min_ns: u64,
    /// Longest recovery time tm of the encoder, in ns.
    pub recovery_max_ns: u64,
    /// Longest cable, in metres.
    pub cable_m: u64,
}

/// What is asked of a card.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CardRequest {
    /// System clock of the core, in hertz.
    pub system_hz: u64,
    /// The encoder ports.
    pub channels: Vec<ChannelRequest>,
    /// Sampling rate of the timer trigger, in hertz.
    pub sample_hz: u64,
    /// Which triggers are enabled after reset.
    pub sources: TriggerSources,
    /// Rate of the host UART, in bit/s.
    pub baud: u64,
    /// How often the host reads the results of all channels, in hertz.
    pub read_hz: u64,
}

/// Trigger sources enabled after reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TriggerSources {
    /// Rising edge of the trigger pin.
    pub pin: bool,
    /// Periodic timer.
    pub timer: bool,
    /// Strobe written by the host.
    pub register: bool,
}

/// Part of the configuration that a problem belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// `[clock]`
    Clock,
    /// The channel with this index.
    Channel(usize),
    /// `[trigger]`
    Trigger,
    /// `[link]`
    Link,
}

/// One thing that is wrong with a request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Where.
    pub section: Section,
    /// Key, named as the field of the request.
    pub key: &'static str,
    /// The value as given.
    pub value: String,
    /// What is wrong, the limit, and the remedy.
    pub text: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}: {}", self.key, self.value, self.text)
    }
}

/// One channel in the units of the blocks; each field fits its configuration input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChannelConfig {
    /// EnDat clock period; the high phase is the longer one when odd.
    pub period_cycles: u64,
    /// First low phase minus half a period (tST).
    pub first_low_extra_cycles: u64,
    /// Mode command.
    pub command: ModeCommand,
    /// Position bits.
    pub position_bits: u32,
    /// Input filter; 0 = off.
    pub filter_cycles: u64,
    /// Half width of the start window.
    pub start_window_cycles: u64,
    /// Longest wait for the start bit from the end of the turnaround, also at the calibration clock, in microseconds.
    pub start_timeout_us: u64,
    /// DATA must have fallen by then, counted from the last rising clock edge at the receiver.
    pub recovery_limit_cycles: u64,
    /// DATA must be low this long before the next frame (tR).
    pub ready_low_cycles: u64,
    /// Quiet time after an aborted transfer, in microseconds.
    pub abort_us: u64,
    /// What was asked for, for reports.
    pub request: ChannelRequest,
}

/// A checked card in the units of the blocks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CardConfig {
    /// System clock, in hertz.
    pub system_hz: u64,
    /// The encoder ports.
    pub channels: Vec<ChannelConfig>,
    /// Period of the sampling timer.
    pub sample_period_cycles: u64,
    /// Sampling rate asked for, in hertz.
    pub sample_hz: u64,
    /// Triggers enabled after reset.
    pub sources: TriggerSources,
    /// System clock cycles in a UART bit.
    pub uart_bit_cycles: u64,
    /// UART rate asked for, in bit/s.
    pub baud: u64,
    /// How often the host reads, in hertz.
    pub read_hz: u64,
    /// First 48 bits of the SHA-256 of the canonical configuration (0 until a generator sets it).
    pub hash: u64,
}

/// Lengths of one position frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameTime {
    /// First low phase.
    pub first_low_cycles: u64,
    /// Complete pulses before the start bit (`N_pre`) with the longest tcal.
    pub lead_pulses: u64,
    /// Bits from the start bit to the last CRC bit (`L`).
    pub answer_bits: u64,
    /// Rising edges that the encoder sees (`P = N_pre + L + 1`).
    pub pulses: u64,
    /// First falling to last rising clock edge.
    pub frame_cycles: u64,
}

impl ChannelRequest {
    /// Longest propagation delay tD of the line, in ns (PWM 20).
    pub const fn delay_max_ns(&self) -> u64 {
        DELAY_BASE_NS + DELAY_NS_PER_M * self.cable_m
    }

    /// The start time tST that receivers use at a clock rate: none below 1 MHz.
    pub const fn usual_tst_ns(clock_hz: u64) -> u64 {
        if clock_hz >= TST_FROM_HZ {
            TST_MIN_NS
        } else {
            0
        }
    }
}

/// Largest number in `bits` bits.
const fn max_of(bits: u32) -> u64 {
    (1 << bits) - 1
}

/// Collects the problems of one section.
struct Check<'a> {
    section: Section,
    problems: &'a mut Vec<Problem>,
}

impl Check<'_> {
    fn fail(&mut self, key: &'static str, value: impl fmt::Display, text: String) {
        self.problems.push(Problem {
            section: self.section,
            key,
            value: value.to_string(),
            text,
        });
    }

    /// Whether `value` is in `range`; reports it when not.
    fn range(&mut self, key: &'static str, value: u64, range: RangeInclusive<u64>) -> bool {
        let inside = range.contains(&value);
        if !inside {
            let (low, high) = (range.start(), range.end());
            self.fail(
                key,
                value,
                format!("outside {low}..{high}; choose a value in that range"),
            );
        }
        inside
    }
}

impl ChannelConfig {
    /// Converts and checks one channel; `Err` has every problem found.
    pub fn resolve(
        request: &ChannelRequest,
        system_hz: u64,
        index: usize,
    ) -> Result<Self, Vec<Problem>> {
        let mut problems = Vec::new();
        let mut check = Check {
            section: Section::Channel(index),
            problems: &mut problems,
        };
        let position_good = check.range(
            "position_bits",
            request.position_bits,
            u64::from(*POSITION_BITS.start())..=u64::from(MAX_POSITION_BITS),
        );
        let cable_good = check.range("cable_m", request.cable_m, 0..=CABLE_M_MAX);
        // One second is far beyond any encoder and keeps every sum below in range.
        let tcal_good = check.range("tcal_max_ns", request.tcal_max_ns, 1..=50_000_000);
        check_recovery(&mut check, request);
        let period = check_clock(&mut check, request.clock_hz, system_hz);
        let mut resolved = period.map(|period_cycles| {
            let half = period_cycles / 2;
            Self {
                period_cycles,
                first_low_extra_cycles: check_tst(&mut check, request, half, system_hz),
                command: request.command,
                position_bits: 0,
                filter_cycles: check_filter(&mut check, request, half, system_hz),
                start_window_cycles: check_window(&mut check, request, half, system_hz),
                start_timeout_us: 0,
                recovery_limit_cycles: 0,
                // DATA must be low for longer than tR.
                ready_low_cycles: cycles_at_least(READY_LOW_NS, system_hz) + 1,
                abort_us: ABORT_US,
                request: request.clone(),
            }
        });
        if let (Some(config), true) = (resolved.as_mut(), position_good && cable_good && tcal_good)
        {
            config.position_bits = request.position_bits as u32;
            // The calibration frame is the slow one: two of its periods may pass before a start edge is seen.
            let slowest_hz = request.clock_hz.min(CALIBRATION_HZ);
            let wait_ns = request.tcal_max_ns
                + request.delay_max_ns()
                + 2 * 1_000_000_000u64.div_ceil(slowest_hz);
            config.start_timeout_us = wait_ns.div_ceil(1_000) + 1;
            let limit_ns = request.recovery_max_ns.min(1_000_000_000) + request.delay_max_ns();
            config.recovery_limit_cycles =
                cycles_at_least(limit_ns, system_hz) + INPUT_LATENCY_CYCLES;
            let limit_cycles_max = max_of(RECOVERY_LIMIT_BITS);
            if config.recovery_limit_cycles > limit_cycles_max {
                let most_us =
                    cycles_to_ns(limit_cycles_max - INPUT_LATENCY_CYCLES, system_hz) / 1_000;
                check.fail(
                    "recovery_max_ns",
                    request.recovery_max_ns,
                    format!("with the cable delay more than {most_us} us, the longest the counter can time at this system clock; lower it"),
                );
            }
        }
        match resolved {
            Some(config) if problems.is_empty() => Ok(config),
            _ => Err(problems),
        }
    }

    /// EnDat clock that the core really makes, in hertz.
    pub fn actual_hz(&self, system_hz: u64) -> f64 {
        system_hz as f64 / self.period_cycles as f64
    }

    /// Lengths of one frame when the encoder needs its longest calculation time.
    pub fn frame_time(&self, system_hz: u64) -> FrameTime {
        let first_low_cycles = self.period_cycles / 2 + self.first_low_extra_cycles;
        let tcal_cycles = cycles_at_least(self.request.tcal_max_ns, system_hz);
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

    /// Shortest time between two triggers in the worst case: frame, line delay, longest recovery time, tR.
    pub fn cycle_max_cycles(&self, system_hz: u64) -> u64 {
        self.frame_time(system_hz).frame_cycles
            + cycles_at_least(
                self.request.delay_max_ns() + self.request.recovery_max_ns,
                system_hz,
            )
            + self.ready_low_cycles
            + INPUT_LATENCY_CYCLES
    }
}

fn check_recovery(check: &mut Check<'_>, request: &ChannelRequest) {
    let (low, high) = (request.recovery_min_ns, request.recovery_max_ns);
    if low > high {
        check.fail(
            "recovery_min_ns",
            low,
            format!("above recovery_max_ns = {high}; exchange the two"),
        );
    }
    if low < SHORT_RECOVERY_MIN_NS {
        check.fail(
            "recovery_min_ns",
            low,
            format!("below {SHORT_RECOVERY_MIN_NS} ns, the shortest an encoder can be set to; use {RECOVERY_MIN_NS} or {SHORT_RECOVERY_MIN_NS}"),
        );
    } else if low < RECOVERY_MIN_NS
        && (!request.command.has_f2() || request.clock_hz <= TST_FROM_HZ)
    {
        check.fail(
            "recovery_min_ns",
            low,
            format!("a recovery time below {RECOVERY_MIN_NS} ns exists only with the command 111000 and a clock above {TST_FROM_HZ} Hz; use {RECOVERY_MIN_NS}"),
        );
    }
}

/// The period in cycles, if the rate can be made well enough.
fn check_clock(check: &mut Check<'_>, clock_hz: u64, system_hz: u64) -> Option<u64> {
    if !check.range("clock_hz", clock_hz, ENDAT_HZ_MIN..=ENDAT_HZ_MAX) || system_hz == 0 {
        return None;
    }
    let period = period_cycles(clock_hz, system_hz);
    if period < PERIOD_CYCLES_MIN {
        check.fail(
            "clock_hz",
            clock_hz,
            format!(
                "needs a system clock of at least {} Hz, clock.system_hz is {system_hz}; use at most {} Hz or a faster system clock",
                clock_hz * PERIOD_CYCLES_MIN,
                system_hz / PERIOD_CYCLES_MIN
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
        let below = system_hz.div_ceil(clock_hz).max(PERIOD_CYCLES_MIN);
        let above = (system_hz / clock_hz).max(PERIOD_CYCLES_MIN);
        let rate = |cycles: u64| (system_hz + cycles / 2) / cycles;
        let remedy = match (rate(below), rate(above)) {
            (low, high) if low == high => format!("{low} Hz"),
            (low, high) => format!("{low} or {high} Hz"),
        };
        check.fail(
            "clock_hz",
            clock_hz,
            format!("would become {} Hz ({ppm:+.0} ppm), more than the allowed {CLOCK_TOLERANCE_PPM} ppm; use {remedy}, or another system clock", rate(period)),
        );
        return None;
    }
    Some(period)
}

/// Cycles that tST adds to the first half period.
fn check_tst(check: &mut Check<'_>, request: &ChannelRequest, half: u64, system_hz: u64) -> u64 {
    let tst = request.tst_ns;
    if tst == 0 {
        return 0;
    }
    if !check.range("tst_ns", tst, TST_MIN_NS..=TST_MAX_NS) {
        return 0;
    }
    let extra = cycles_at_least(tst, system_hz).saturating_sub(half);
    if extra > max_of(PERIOD_BITS) {
        let most_ns = cycles_to_ns(max_of(PERIOD_BITS) + half, system_hz);
        check.fail("tst_ns", tst, format!("more than {most_ns} ns, the longest the counter can time at this system clock; lower it"));
    }
    extra
}

fn check_filter(check: &mut Check<'_>, request: &ChannelRequest, half: u64, system_hz: u64) -> u64 {
    let cycles = cycles_at_least(request.filter_ns, system_hz);
    let most = half.min(max_of(FILTER_BITS));
    if cycles > most {
        check.fail(
            "filter_ns",
            request.filter_ns,
            format!(
                "is {cycles} cycles, more than {most} (half an EnDat period, and {} at most); use {} ns or less",
                max_of(FILTER_BITS),
                cycles_at_most_ns(most, system_hz)
            ),
        );
    }
    cycles
}

fn check_window(check: &mut Check<'_>, request: &ChannelRequest, half: u64, system_hz: u64) -> u64 {
    let cycles = cycles_at_most(request.start_window_ns, system_hz);
    let most = (half - 1).min(max_of(START_WINDOW_BITS));
    if !(1..=most).contains(&cycles) {
        check.fail(
            "start_window_ns",
            request.start_window_ns,
            format!(
                "is {cycles} cycles, outside 1..{most} (less than half an EnDat period, and {} at most); use {}..{} ns",
                max_of(START_WINDOW_BITS),
                cycles_to_ns_up(1, system_hz),
                cycles_to_ns_up(most, system_hz)
            ),
        );
    }
    cycles
}

/// Longest whole number of ns that [`cycles_at_least`] turns into no more than `cycles`.
fn cycles_at_most_ns(cycles: u64, system_hz: u64) -> u64 {
    (u128::from(cycles) * 1_000_000_000 / u128::from(system_hz.max(1))) as u64
}

/// Shortest whole number of ns that [`cycles_at_most`] turns into no fewer than `cycles`.
fn cycles_to_ns_up(cycles: u64, system_hz: u64) -> u64 {
    (u128::from(cycles) * 1_000_000_000).div_ceil(u128::from(system_hz.max(1))) as u64
}

impl CardConfig {
    /// Converts and checks a whole card; `Err` has every problem found.
    pub fn resolve(request: &CardRequest) -> Result<Self, Vec<Problem>> {
        let mut problems = Vec::new();
        let system_hz = request.system_hz;
        let mut check = Check {
            section: Section::Clock,
            problems: &mut problems,
        };
        let clock_good = check.range("system_hz", system_hz, SYSTEM_HZ_MIN..=SYSTEM_HZ_MAX);
        if !CHANNELS.contains(&request.channels.len()) {
            let (low, high) = (CHANNELS.start(), CHANNELS.end());
            check.section = Section::Channel(0);
            check.fail(
                "channel",
                format!("{} tables", request.channels.len()),
                format!("a card has {low}..{high} channels; write one [[channel]] table for each"),
            );
        }
        if !clock_good {
            // Without a believable system clock every other number would only repeat this complaint.
            return Err(problems);
        }
        let mut channels = Vec::new();
        for (index, channel) in request.channels.iter().enumerate() {
            match ChannelConfig::resolve(channel, system_hz, index) {
                Ok(channel) => channels.push(channel),
                Err(more) => problems.extend(more),
            }
        }
        let sample_period_cycles = check_sampling(&mut problems, request, &channels);
        let uart_bit_cycles = check_link(&mut problems, request);
        if !problems.is_empty() {
            return Err(problems);
        }
        Ok(Self {
            system_hz,
            channels,
            sample_period_cycles,
            sample_hz: request.sample_hz,
            sources: request.sources,
            uart_bit_cycles,
            baud: request.baud,
            read_hz: request.read_hz,
            hash: 0,
        })
    }

    /// Sampling rate that the timer really makes, in hertz.
    pub fn actual_sample_hz(&self) -> f64 {
        self.system_hz as f64 / self.sample_period_cycles as f64
    }

    /// UART rate that the core really makes, in bit/s.
    pub fn actual_baud(&self) -> f64 {
        self.system_hz as f64 / self.uart_bit_cycles as f64
    }

    /// UART rate that reading every channel `read_hz` times a second takes, in bit/s.
    pub fn needed_baud(&self) -> u64 {
        needed_baud(self.read_hz, self.channels.len())
    }

    /// How often the host can read every channel over this link, in hertz.
    pub fn highest_read_hz(&self) -> f64 {
        self.actual_baud() / needed_baud(1, self.channels.len()) as f64
    }
}

/// Bits per second of `read_hz` reads of `channels` results, request and answer one after the other.
pub const fn needed_baud(read_hz: u64, channels: usize) -> u64 {
    let bytes = READ_REQUEST_BYTES + 4 * RESULT_WORDS * channels as u64;
    read_hz.saturating_mul(bytes * UART_BITS_PER_BYTE)
}

fn check_sampling(
    problems: &mut Vec<Problem>,
    request: &CardRequest,
    channels: &[ChannelConfig],
) -> u64 {
    let mut check = Check {
        section: Section::Trigger,
        problems,
    };
    let system_hz = request.system_hz;
    let slowest_hz = system_hz.div_ceil(max_of(TIMER_BITS));
    if !check.range("sample_hz", request.sample_hz, slowest_hz..=1_000_000) {
        return 0;
    }
    let period = period_cycles(request.sample_hz, system_hz);
    let longest = channels.iter().map(|c| c.cycle_max_cycles(system_hz)).max();
    match longest {
        Some(longest) if request.sources.timer && longest > period => {
            check.fail(
                "sample_hz",
                request.sample_hz,
                format!(
                    "a frame with its recovery time takes up to {:.1} us, so at most {} Hz; lower it, or raise clock_hz, or shorten recovery_max_ns",
                    longest as f64 * 1e6 / system_hz as f64,
                    system_hz / longest
                ),
            );
        }
        _ => {}
    }
    period
}

fn check_link(problems: &mut Vec<Problem>, request: &CardRequest) -> u64 {
    let mut check = Check {
        section: Section::Link,
        problems,
    };
    let system_hz = request.system_hz;
    if !check.range(
        "baud",
        request.baud,
        9_600..=system_hz / UART_BIT_CYCLES_MIN,
    ) {
        return 0;
    }
    let bit_cycles = period_cycles(request.baud, system_hz);
    let ppm = deviation_ppm(system_hz as f64 / bit_cycles as f64, request.baud as f64);
    if ppm.abs() > UART_TOLERANCE_PPM as f64 {
        let nearest = (system_hz + bit_cycles / 2) / bit_cycles;
        check.fail(
            "baud",
            request.baud,
            format!("would become {nearest} bit/s ({ppm:+.0} ppm), more than the allowed {UART_TOLERANCE_PPM} ppm; use a rate that divides clock.system_hz = {system_hz}"),
        );
    }
    if !check.range("read_hz", request.read_hz, 1..=1_000_000) {
        return bit_cycles;
    }
    let needed = needed_baud(request.read_hz, request.channels.len());
    if needed > request.baud {
        let most = request.baud / needed_baud(1, request.channels.len());
        check.fail(
            "baud",
            request.baud,
            format!(
                "the link is too slow: reading {} channels {} times a second takes {needed} bit/s; raise baud, or set link.read_hz to {most} or less",
                request.channels.len(),
                request.read_hz
            ),
        );
    }
    bit_cycles
}

#[cfg(test)]
#[path = "config_tests.rs"]
mod tests;
