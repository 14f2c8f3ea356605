//! Card requests into cycles: sampling timer and host link.

use super::*;
use crate::timing::*;

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
