//! `explain`: what a configuration really becomes, as text and as data.

use crate::board::Pll;
use crate::protocols::other;
use crate::protocols::OtherReport;
use crate::{phase_name, Project};
use endat_hdl::card::bus::HostBus;
use endat_hdl::config::{read_bytes, CardConfig, ChannelConfig};
use rate::us_of;
pub use rate::Rate;
use serde::Serialize;
use stream::StreamReport;

pub mod rate;
pub mod receiver;
mod stream;
mod text;

/// One channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChannelReport {
    /// Encoder, for people.
    pub encoder: String,
    /// Mode command, six binary digits.
    pub command: String,
    /// Position bits.
    pub position_bits: u32,
    /// EnDat clock.
    pub clock: Rate,
    /// EnDat period in system clock cycles.
    pub period_cycles: u64,
    /// Start time tST asked for, in ns.
    pub tst_ns: u64,
    /// First low phase, in ns.
    pub first_low_ns: f64,
    /// Pulses before the start bit, with the longest tcal.
    pub lead_pulses: u64,
    /// Bits from start bit to the last CRC bit.
    pub answer_bits: u64,
    /// Rising edges that the encoder sees in a frame.
    pub pulses: u64,
    /// First falling to last rising edge, in microseconds.
    pub frame_us: f64,
    /// Longest frame with additional data and supplement, in microseconds; none without requests.
    pub longest_frame_us: Option<f64>,
    /// Frame and shortest recovery time, in microseconds.
    pub cycle_min_us: f64,
    /// Frame and longest recovery time, in microseconds.
    pub cycle_max_us: f64,
    /// Highest sampling rate with the shortest recovery time, in hertz.
    pub highest_sampling_hz: f64,
    /// Sampling rate that is reached with the longest recovery time, in hertz.
    pub sure_sampling_hz: f64,
    /// The same with the longest cable, tR and the latency of the core: what the configuration is checked against.
    pub worst_case_sampling_hz: f64,
    /// Clock of the first frame, which measures the propagation delay, in hertz.
    pub calibration_hz: f64,
    /// Length of that frame, in microseconds.
    pub calibration_us: f64,
    /// Longest propagation delay planned for, in ns.
    pub delay_max_ns: u64,
    /// Input filter, in ns.
    pub filter_ns: f64,
    /// Longest filter behind which a pulse that it removes cannot spoil a bit, in ns.
    pub filter_recommended_ns: f64,
    /// Half width of the start window, in ns.
    pub start_window_ns: f64,
    /// Longest wait for the start bit, in microseconds.
    pub start_timeout_us: u64,
}

/// A channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum AnyChannelReport {
    /// EnDat.
    Endat(Box<ChannelReport>),
    /// Another protocol.
    Other(OtherReport),
}

/// The host link.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinkReport {
    /// UART rate.
    pub baud: Rate,
    /// How often the host reads all channels, in hertz.
    pub read_hz: u64,
    /// Bytes of one read, request and answer.
    pub bytes_per_read: u64,
    /// UART rate that the reading takes, in bit/s.
    pub needed_baud: u64,
    /// Share of the link that the reading takes, in percent.
    pub used_percent: f64,
    /// Most reads per second that the link carries.
    pub highest_read_hz: f64,
}

/// Everything that `explain` shows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Name of the configuration.
    pub name: String,
    /// First 12 hexadecimal digits of the SHA-256 of the resolved configuration.
    pub config_hash: String,
    /// Board; none when the card has another bus than the UART.
    pub board: Option<String>,
    /// Oscillator of the board, in hertz.
    pub oscillator_hz: Option<u64>,
    /// Factors of the clock manager: multiply, divide, divide again.
    pub clock_manager: Option<[u64; 3]>,
    /// System clock, in hertz.
    pub system_hz: u64,
    /// The channels.
    pub channels: Vec<AnyChannelReport>,
    /// Timer trigger.
    pub sampling: Rate,
    /// Triggers enabled after reset.
    pub sources: Vec<&'static str>,
    /// Which triggers each channel takes after reset; empty where all take all of them.
    pub own_triggers: Vec<String>,
    /// The range of each channel's position; none where the file gives none.
    pub ranges: Vec<Option<String>>,
    /// What each channel does besides positions.
    pub service: Vec<&'static str>,
    /// What stands between the registers and the host.
    pub bus: &'static str,
    /// Host link; none without a UART.
    pub link: Option<LinkReport>,
    /// Stream of sample sets; none without a buffer.
    pub stream: Option<StreamReport>,
    /// What each channel does about its line delay besides following it.
    pub line: Vec<&'static str>,
    /// Source of the phase after reset; none without alignment.
    pub phase: Option<&'static str>,
    /// Outputs to logic and to a processor in the same device.
    pub outputs: Vec<&'static str>,
    /// What watches each channel beside it.
    pub safety: Vec<&'static str>,
    /// Time between two forced errors of a channel, in milliseconds.
    pub error_test_ms: Option<u16>,
}

impl Report {
    /// The channels that speak EnDat, with their numbers.
    pub fn endat_channels(&self) -> impl Iterator<Item = (usize, &ChannelReport)> {
        let channels = self.channels.iter().enumerate();
        channels.filter_map(|(n, channel)| match channel {
            AnyChannelReport::Endat(channel) => Some((n, channel.as_ref())),
            AnyChannelReport::Other(_) => None,
        })
    }
}

/// The names of what is on.
fn present(parts: &[(bool, &'static str)]) -> Vec<&'static str> {
    let on = parts.iter().filter(|(on, _)| *on);
    on.map(|(_, name)| *name).collect()
}

fn channel(card: &CardConfig, config: &ChannelConfig, encoder: &str) -> ChannelReport {
    let system_hz = card.system_hz;
    let longest = || us_of(config.longest_frame_cycles(system_hz), system_hz);
    let us = |cycles: u64| us_of(cycles, system_hz);
    let time = config.frame_time(system_hz);
    let request = &config.spec;
    let frame_us = us(time.frame_cycles);
    let cycle_min_us = frame_us + request.recovery_min_ns as f64 / 1e3;
    let cycle_max_us = frame_us + request.recovery_max_ns as f64 / 1e3;
    ChannelReport {
        encoder: encoder.into(),
        command: format!("{:06b}", config.command.code()),
        position_bits: config.position_bits,
        clock: Rate::new(request.clock_hz, config.actual_hz(system_hz)),
        period_cycles: config.period_cycles,
        tst_ns: request.tst_ns,
        first_low_ns: us(time.first_low_cycles) * 1e3,
        lead_pulses: time.lead_pulses,
        answer_bits: time.answer_bits,
        pulses: time.pulses,
        frame_us,
        longest_frame_us: (card.service.requests && config.command.has_f2()).then(longest),
        cycle_min_us,
        cycle_max_us,
        highest_sampling_hz: 1e6 / cycle_min_us,
        sure_sampling_hz: 1e6 / cycle_max_us,
        worst_case_sampling_hz: 1e6 / us(config.cycle_max_cycles(system_hz)),
        calibration_hz: 1e6 / us(config.calibration_period_cycles(system_hz)),
        calibration_us: us(config.calibration_cycles(system_hz)),
        delay_max_ns: request.delay_max_ns(),
        filter_ns: us(2 * config.filter_cycles + u64::from(config.filter_half)) * 1e3 / 2.0,
        filter_recommended_ns: us(config.filter_recommended_cycles()) * 1e3,
        start_window_ns: us(config.start_window_cycles) * 1e3,
        start_timeout_us: config.start_timeout_us,
    }
}

/// The range of a channel's position.
fn range(channel: &ChannelConfig) -> Option<String> {
    match channel.turn_bits() {
        Some([single, 0]) => Some(format!("{single} bits of angle")),
        Some([single, multi]) => Some(format!("{single} bits of angle, {multi} that count turns")),
        None => channel.spec.range.map(|_| "none: a scale".into()),
    }
}

/// What each channel of a card with own triggers takes.
fn own_triggers(card: &CardConfig) -> Vec<String> {
    if !card.own_triggers() {
        return vec![];
    }
    let own = card.channels.iter().map(|c| {
        let own = c.spec.trigger.unwrap_or_default();
        let sources = present(&[
            (own.sources.pin, "pin"),
            (own.sources.timer, "timer"),
            (own.sources.register, "register"),
        ]);
        match (own.enabled, own.divider) {
            (false, _) => "disabled".into(),
            (_, 1) => text::list(&sources),
            (_, n) => format!("one of {n}, from {}", text::list(&sources)),
        }
    });
    own.collect()
}

/// The report of a project.
pub fn report(project: &Project) -> Report {
    let card = &project.card;
    let system_hz = card.system_hz;
    let channels = card
        .channels
        .iter()
        .enumerate()
        .zip(&project.encoders)
        .map(|((n, c), encoder)| match other(c.protocol()) {
            Some(other) => AnyChannelReport::Other(other.report(card, n, encoder)),
            None => AnyChannelReport::Endat(channel(card, c, encoder).into()),
        })
        .collect();
    let sources = [
        (card.sources.pin, "pin"),
        (card.sources.timer, "timer"),
        (card.sources.register, "register"),
    ];
    let needed_baud = card.needed_baud();
    Report {
        name: project.name.clone(),
        config_hash: project.hash.clone(),
        board: project.board.as_ref().map(|board| board.name.clone()),
        oscillator_hz: project.board.as_ref().map(|board| board.oscillator_hz),
        clock_manager: project.pll.as_ref().map(Pll::factors),
        system_hz,
        channels,
        sampling: Rate::new(card.sample_hz, card.actual_sample_hz()),
        sources: sources
            .into_iter()
            .filter(|(on, _)| *on)
            .map(|(_, name)| name)
            .collect(),
        own_triggers: own_triggers(card),
        ranges: card.channels.iter().map(range).collect(),
        service: present(&[
            (card.service.requests, "requests"),
            (card.service.diagnosis, "diagnosis"),
            (card.service.continuous, "continuous"),
            (card.service.initialise, "initialise"),
        ]),
        line: present(&[
            (card.line.alignment, "alignment"),
            (card.line.margin, "margin"),
            (card.line.double_edge, "double_edge"),
        ]),
        phase: card.line.alignment.then(|| phase_name(card.line.phase)),
        outputs: present(&[
            (card.outputs.position, "position"),
            (card.outputs.interrupt, "interrupt"),
        ]),
        safety: present(&[
            (card.safety.recovery_counter, "recovery_counter"),
            (card.safety.second_interface, "second_interface"),
            (card.safety.second_receiver, "second_receiver"),
            (card.safety.error_test_ms != 0, "error_test"),
            (card.safety.upset_guards, "upset_guards"),
            (card.safety.restore, "restore"),
        ]),
        error_test_ms: Some(card.safety.error_test_ms).filter(|ms| *ms != 0),
        bus: project.bus.name(),
        stream: StreamReport::of(card, project.bus == HostBus::Uart),
        link: (project.bus == HostBus::Uart).then(|| LinkReport {
            baud: Rate::new(card.baud, card.actual_baud()),
            read_hz: card.read_hz,
            bytes_per_read: read_bytes(card.channels.len(), card.service.requests),
            needed_baud,
            used_percent: needed_baud as f64 * 100.0 / card.actual_baud(),
            highest_read_hz: card.highest_read_hz(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load_preset;

    #[test]
    fn the_preset_is_explained_with_the_figures_of_the_timing_table() {
        let report = report(&load_preset("s6_two_channel").unwrap());
        assert_eq!(report.endat_channels().count(), 2);
        for (_, channel) in report.endat_channels() {
            assert_eq!(
                (channel.pulses, channel.lead_pulses, channel.answer_bits),
                (48, 10, 37)
            );
            assert!((channel.frame_us - 17.04).abs() < 1e-9);
            assert!((channel.cycle_min_us - 27.04).abs() < 1e-9);
            assert!((channel.cycle_max_us - 47.04).abs() < 1e-9);
            assert_eq!(channel.highest_sampling_hz.floor(), 36_982.0);
            assert_eq!(channel.clock.deviation_ppm, 0.0);
            // As long as the first frame of the scenario `paper` on the elaborated channel.
            assert!((channel.calibration_us - 239.34).abs() < 1e-9);
        }
        let link = report.link.unwrap();
        assert_eq!(link.bytes_per_read, 62);
        // 33 cycles of 100 MHz in a bit.
        assert!((link.used_percent - 20.46).abs() < 1e-9);
    }
}
