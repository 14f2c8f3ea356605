//! Converts card requests to cycles: sampling timer and host link.

use super::*;
use crate::card::stream::buffer::{frame_bytes, frame_cycles, BUFFER_BYTES};
use crate::endat::timing::*;
use crate::protocol::LEAD_PULSES;
use crate::protocols::Spoken;
use endat_regs::result_words;

/// Source of the upper limit of the UART rate if it is not the system clock.
pub const BAUD_NOTE: &str = "the fastest rate that the board passes on to the host";

/// Fewest system clock cycles in an EnDat period with which the phase can follow a continuous clock.
const CONTINUOUS_PERIOD_MIN: u64 = 8;
/// Fewest cycles in a period with which the position is stored before the first bit of additional data: 16 shifts in the five bits
/// of the CRC.
const REQUESTS_PERIOD_MIN: u64 = 4;

/// Slowest system clock at which the initialisation program ends the pulse after power-up in time, in hertz.
const INITIALISE_HZ_MIN: u64 = 8_000_000;

/// A feature that needs more cycles in a period than the channel has.
fn too_fast_for(
    index: usize,
    channel: &ChannelConfig,
    system_hz: u64,
    (part, what, cycles_min): (&str, &str, u64),
) -> Problem {
    Problem {
        section: Section::Channel(index),
        key: "clock_hz",
        value: channel.spec.clock_hz.to_string(),
        text: format!(
            "its period is {} cycles of clock.system_hz = {system_hz}, {what} {cycles_min}; use at most {} Hz, or leave \"{part}\" out of service.parts",
            channel.period_cycles,
            system_hz / cycles_min
        ),
    }
}

impl CardDraft {
    /// Converts and checks the given values; `Err` has every problem found, or none if values are only missing.
    pub fn resolve(&self) -> Result<CardConfig, Vec<Problem>> {
        let mut problems = Vec::new();
        let mut check = Check {
            section: Section::Clock,
            problems: &mut problems,
        };
        let clock = self
            .system_hz
            .filter(|hz| check.within("system_hz", *hz, &limits("system_hz", None)));
        let count = self.channels.as_ref().map(Vec::len);
        let count = count.filter(|count| {
            let good = CHANNELS.contains(count);
            if !good {
                let (low, high) = (CHANNELS.start(), CHANNELS.end());
                check.section = Section::Channel(*high);
                check.fail(
                    "channel",
                    format!("{count} tables"),
                    format!(
                        "a card has {low}..{high} channels; write one [[channel]] table for each"
                    ),
                );
            }
            good
        });
        let Some(system_hz) = clock else {
            // Without a valid system clock every other message would only repeat this one.
            return Err(problems);
        };
        if self.service.initialise && system_hz < INITIALISE_HZ_MIN {
            check.section = Section::Clock;
            check.fail(
                "system_hz",
                system_hz.to_string(),
                format!("is too slow for the steps of an initialisation; use at least {INITIALISE_HZ_MIN} Hz, or leave \"initialise\" out of service.parts"),
            );
        }
        let channels = self.resolve_channels(&mut problems, system_hz);
        let sample_period_cycles = self.check_sampling(&mut problems, system_hz, &channels);
        let uart_bit_cycles = self.check_link(&mut problems, system_hz, count);
        // A rejected rate says nothing about the other limits.
        let rates = sample_period_cycles.is_some() && uart_bit_cycles.is_some();
        self.check_stream(&mut problems, system_hz, count.filter(|_| rates));
        let whole = count == Some(channels.len());
        match (sample_period_cycles, uart_bit_cycles, self) {
            (
                Some(sample_period_cycles),
                Some(uart_bit_cycles),
                &Self {
                    sample_hz: Some(sample_hz),
                    sources: Some(sources),
                    baud: Some(baud),
                    read_hz: Some(read_hz),
                    service,
                    line,
                    stream,
                    outputs,
                    safety,
                    initial_values,
                    ..
                },
            ) if whole && problems.is_empty() => Ok(CardConfig {
                system_hz,
                channels: channels.into_iter().map(|(_, c)| c).collect(),
                sample_period_cycles,
                sample_hz,
                sources,
                uart_bit_cycles,
                baud,
                read_hz,
                service,
                line,
                stream,
                outputs,
                safety,
                initial_values,
                hash: 0,
            }),
            _ => Err(problems),
        }
    }

    /// The valid channels, with their numbers.
    fn resolve_channels(
        &self,
        problems: &mut Vec<Problem>,
        system_hz: u64,
    ) -> Vec<(usize, ChannelConfig)> {
        let mut channels = Vec::new();
        for (index, channel) in self.channels.iter().flatten().enumerate() {
            let own = channel.as_ref().and_then(|c| c.trigger);
            if let Some(own) = own {
                let mut check = Check {
                    section: Section::Channel(index),
                    problems,
                };
                check.within("divider", own.divider, &limits("divider", None));
            }
            match channel
                .as_ref()
                .map(|c| ChannelConfig::resolve(c, system_hz, self.line.double_edge, index))
            {
                Some(Ok(channel)) => {
                    let parts = [
                        (
                            self.service.requests,
                            ("requests", "additional data need", REQUESTS_PERIOD_MIN),
                        ),
                        (
                            self.service.continuous,
                            (
                                "continuous",
                                "continuous clock needs",
                                CONTINUOUS_PERIOD_MIN,
                            ),
                        ),
                    ];
                    let is_endat = channel.is_endat();
                    for (is_wanted, part) in parts {
                        if is_endat && is_wanted && channel.period_cycles < part.2 {
                            problems.push(too_fast_for(index, &channel, system_hz, part));
                        }
                    }
                    channels.push((index, channel));
                }
                Some(Err(more)) => problems.extend(more),
                None => {}
            }
        }
        channels
    }

    fn check_sampling(
        &self,
        problems: &mut Vec<Problem>,
        system_hz: u64,
        channels: &[(usize, ChannelConfig)],
    ) -> Option<u64> {
        let mut check = Check {
            section: Section::Trigger,
            problems,
        };
        let sample_hz = self.sample_hz?;
        if !check.within(
            "sample_hz",
            sample_hz,
            &limits("sample_hz", Some(system_hz)),
        ) {
            return None;
        }
        let period = period_cycles(sample_hz, system_hz);
        // A channel that takes one of several triggers has that many times as long.
        let share = |channel: &ChannelConfig| {
            let own = channel.spec.trigger.unwrap_or_default();
            let divider = own.timer_divider()?.max(1);
            let cycles = channel.cycle_max_cycles(system_hz);
            Some((cycles.div_ceil(divider), cycles, divider))
        };
        let timed = channels.iter().rev();
        let longest = timed
            .filter_map(|(index, c)| Some((share(c)?, index, c)))
            .max_by_key(|((share, ..), ..)| *share);
        let timer = self.sources.is_some_and(|s| s.timer);
        if let Some(((share, cycles, divider), index, channel)) = longest.filter(|_| timer) {
            if share > period {
                let times = TooLong {
                    cycles,
                    divider,
                    system_hz,
                };
                let mut text = channel.too_long(*index, times);
                if divider > 1 {
                    text += &format!(", or raise divider = {divider} of the channel");
                }
                check.fail("sample_hz", sample_hz, text);
            }
        }
        Some(period)
    }

    fn check_link(
        &self,
        problems: &mut Vec<Problem>,
        system_hz: u64,
        channels: Option<usize>,
    ) -> Option<u64> {
        let mut check = Check {
            section: Section::Link,
            problems,
        };
        let system = Some(system_hz);
        let read_hz = self
            .read_hz
            .filter(|hz| check.within("read_hz", *hz, &limits("read_hz", system)));
        let baud = self.baud?;
        let most = self.baud_max.unwrap_or(u64::MAX);
        let baud_limits = limits("baud", system).at_most(most, BAUD_NOTE);
        if !check.within("baud", baud, &baud_limits) {
            return None;
        }
        let bit_cycles = period_cycles(baud, system_hz);
        let ppm = deviation_ppm(system_hz as f64 / bit_cycles as f64, baud as f64);
        if ppm.abs() > UART_TOLERANCE_PPM as f64 {
            let nearest = (system_hz + bit_cycles / 2) / bit_cycles;
            // The remedy must itself be valid.
            let slower = (system_hz + bit_cycles.div_ceil(2)) / (bit_cycles + 1);
            let good = [nearest, slower];
            let good = good.into_iter().find(|hz| baud_limits.contains(*hz));
            let remedy = good.map_or("use another system clock".into(), |hz| {
                format!("use {hz} bit/s")
            });
            check.fail(
                "baud",
                baud,
                format!("would become {nearest} bit/s ({ppm:+.0} ppm), more than the allowed {UART_TOLERANCE_PPM} ppm with clock.system_hz = {system_hz}; {remedy}"),
            );
        }
        if let (Some(read_hz), Some(channels)) = (read_hz, channels) {
            let requests = self.service.requests;
            let needed = needed_baud(read_hz, channels, requests);
            if needed > baud {
                let most = baud / needed_baud(1, channels, requests);
                let mut remedies = Vec::new();
                if let Some(faster) = baud_from(needed, system_hz, &baud_limits) {
                    remedies.push(format!("raise it to {faster}"));
                }
                if most > 0 {
                    remedies.push(format!("set link.read_hz to {most} or less"));
                }
                if remedies.is_empty() {
                    remedies.push("use another system clock".into());
                }
                let text = format!(
                    "the link is too slow: reading {} bytes {read_hz} times a second takes {needed} bit/s; {}",
                    read_bytes(channels, requests),
                    remedies.join(", or ")
                );
                check.fail("baud", baud, text);
            }
        }
        Some(bit_cycles)
    }
}

impl CardDraft {
    /// Checks that the buffer exists, and that the sets of all triggers fit into it and onto the line.
    fn check_stream(
        &self,
        problems: &mut Vec<Problem>,
        system_hz: u64,
        channels: Option<usize>,
    ) -> Option<()> {
        let bytes = self.stream.fifo_bytes;
        let mut check = Check {
            section: Section::Stream,
            problems,
        };
        if self.stream.additional_data && !self.service.requests {
            let mut channels = self.channels.iter().flatten();
            let is_endat =
                |c: &Option<ChannelSpec>| c.as_ref().is_none_or(|c| c.spoken == Spoken::Endat);
            let text = match channels.any(is_endat) {
                true => "a card without requests has no additional data; add \"requests\" to service.parts, or set stream.additional_data = false",
                false => "no channel of this card speaks EnDat; set stream.additional_data = false",
            };
            check.fail("additional_data", true, text.into());
        }
        if self.stream.additional_data && bytes == 0 {
            let text = "a stream without a buffer; set stream.fifo_bytes = 2048, or stream.additional_data = false";
            check.fail("additional_data", true, text.into());
        }
        if bytes == 0 {
            if self.stream.start.collects() {
                let start = if self.stream.start.pushes() {
                    "\"push\""
                } else {
                    "\"collect\""
                };
                check.fail(
                    "start",
                    start,
                    "a stream without a buffer; set stream.fifo_bytes = 2048, or start = \"off\""
                        .into(),
                );
            }
            return None;
        }
        if !BUFFER_BYTES.contains(&bytes) {
            let sizes = BUFFER_BYTES.map(|b| b.to_string()).join(", ");
            let text = format!("not a buffer size; use 0 (no stream), {sizes}");
            check.fail("fifo_bytes", bytes, text);
        }
        if self.without_uart && self.stream.start.pushes() {
            let text = "only a UART pushes; use \"collect\", the host reads stream_data";
            check.fail("start", "\"push\"", text.into());
        }
        let (sample_hz, baud, channels) = (self.sample_hz?, self.baud?, channels?);
        let additional_data = self.stream.additional_data;
        let frame = frame_bytes(channels, additional_data);
        let needed = stream_baud(sample_hz, channels, additional_data);
        if needed > baud && !self.without_uart {
            let most = baud / stream_baud(1, channels, additional_data);
            let baud_limits = limits("baud", Some(system_hz));
            let baud_limits = baud_limits.at_most(self.baud_max.unwrap_or(u64::MAX), BAUD_NOTE);
            // The remedy must itself be valid.
            let faster = baud_from(needed, system_hz, &baud_limits);
            let is_rate = limits("sample_hz", Some(system_hz)).contains(most);
            let mut remedies = Vec::new();
            remedies.extend(is_rate.then(|| format!("lower it to {most} or less, ")));
            remedies.extend(faster.map(|hz| format!("raise link.baud to {hz}, ")));
            let or = if remedies.is_empty() { "" } else { "or " };
            let text = format!("the stream does not fit: {sample_hz} sets a second of {frame} bytes take {needed} bit/s, link.baud is {baud}; {}{or}set stream.fifo_bytes = 0", remedies.concat());
            check.section = Section::Trigger;
            check.fail("sample_hz", sample_hz, text);
        }
        let cycles = frame_cycles(channels, additional_data);
        if sample_hz.saturating_mul(cycles) > system_hz {
            let most = system_hz / cycles;
            check.section = Section::Trigger;
            check.fail(
                "sample_hz",
                sample_hz,
                format!("the stream writes a set of {channels} channels in {cycles} cycles of clock.system_hz = {system_hz}; lower it to {most} or less, or set stream.fifo_bytes = 0"),
            );
        }
        Some(())
    }
}

/// A channel that is not ready at the next trigger.
#[derive(Clone, Copy)]
pub(crate) struct TooLong {
    /// Longest time that the channel needs.
    pub(crate) cycles: u64,
    /// The channel takes one of `divider` triggers.
    pub(crate) divider: u64,
    pub(crate) system_hz: u64,
}

impl TooLong {
    /// The highest trigger rate that the channel supports.
    pub(crate) fn highest_hz(self) -> u64 {
        self.system_hz.saturating_mul(self.divider) / self.cycles
    }
}

/// Message for a trigger that comes before an EnDat channel is ready, with the parts that can be shortened, the longest first.
pub(crate) fn frame_too_long(index: usize, channel: &ChannelConfig, times: TooLong) -> String {
    let system_hz = times.system_hz;
    let frame = channel.frame_time(system_hz);
    let waiting = (frame.lead_pulses - u64::from(LEAD_PULSES)) * channel.period_cycles;
    let request = &channel.spec;
    let recovery = cycles_at_least(request.recovery_max_ns, system_hz);
    let mut shares = [
        (
            waiting,
            "shorten tcal_max_ns",
            "tcal_max_ns",
            request.tcal_max_ns,
        ),
        (
            frame.frame_cycles - waiting,
            "raise clock_hz",
            "clock_hz",
            request.clock_hz,
        ),
        (
            recovery,
            "shorten recovery_max_ns",
            "recovery_max_ns",
            request.recovery_max_ns,
        ),
    ];
    shares.sort_by_key(|(cycles, ..)| std::cmp::Reverse(*cycles));
    let (_, _, key, value) = shares[0];
    let highest = times.highest_hz();
    let remedies: Vec<&str> = shares
        .iter()
        .filter(|(cycles, ..)| *cycles > 0)
        .map(|(_, remedy, ..)| *remedy)
        .collect();
    format!(
        "a frame of channel {index} with its recovery time takes up to {} us, the largest part from {key} = {value}, so at most {highest} Hz; lower it to {highest}, or make the frame shorter: {}",
        microseconds(times.cycles, system_hz),
        remedies.join(", or ")
    )
}

/// Rounded up to nanoseconds, without trailing zeros.
pub(crate) fn microseconds(cycles: u64, system_hz: u64) -> String {
    let ns = (u128::from(cycles) * 1_000_000_000).div_ceil(u128::from(system_hz));
    let text = format!("{}.{:03}", ns / 1_000, ns % 1_000);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

impl CardConfig {
    /// Converts and checks a whole card; `Err` has every problem found.
    pub fn resolve(request: &CardSpec) -> Result<Self, Vec<Problem>> {
        CardDraft::from(request).resolve()
    }

    /// True if each channel has its own enable, divider and sources.
    pub fn own_triggers(&self) -> bool {
        self.channels.iter().any(|c| c.spec.trigger.is_some())
    }

    /// Actual sampling rate of the timer, in hertz.
    pub fn actual_sample_hz(&self) -> f64 {
        self.system_hz as f64 / self.sample_period_cycles as f64
    }

    /// Actual UART rate of the core, in bit/s.
    pub fn actual_baud(&self) -> f64 {
        self.system_hz as f64 / self.uart_bit_cycles as f64
    }

    /// UART rate for reading every channel `read_hz` times a second, in bit/s.
    pub fn needed_baud(&self) -> u64 {
        needed_baud(self.read_hz, self.channels.len(), self.service.requests)
    }

    /// Highest rate at which the host can read every channel over this link, in hertz.
    pub fn highest_read_hz(&self) -> f64 {
        self.actual_baud() / needed_baud(1, self.channels.len(), self.service.requests) as f64
    }
}

/// The slowest UART rate of at least `needed` that the system clock can generate; `None` if it is outside the limits.
fn baud_from(needed: u64, system_hz: u64, limits: &Limits) -> Option<u64> {
    let cycles = system_hz / needed.max(1);
    let made = |cycles: u64| (cycles > 0).then(|| system_hz / cycles);
    let good = |hz: &u64| *hz >= needed && limits.contains(*hz);
    [cycles, cycles.saturating_sub(1)]
        .into_iter()
        .find_map(|c| made(c).filter(good))
}

/// Bytes on the line when a host reads the results of all channels in one burst: request, then every word from the
/// first result to the last (`docs/host-link.md`).
pub const fn read_bytes(channels: usize, requests: bool) -> u64 {
    READ_REQUEST_BYTES + 4 * result_words(channels, requests)
}

/// Bits per second of `read_hz` such reads, request and answer one after the other.
pub const fn needed_baud(read_hz: u64, channels: usize, requests: bool) -> u64 {
    read_hz.saturating_mul(read_bytes(channels, requests) * UART_BITS_PER_BYTE)
}

/// Bits per second of `sample_hz` frames of the stream.
pub const fn stream_baud(sample_hz: u64, channels: usize, additional_data: bool) -> u64 {
    sample_hz.saturating_mul(frame_bytes(channels, additional_data) * UART_BITS_PER_BYTE)
}
