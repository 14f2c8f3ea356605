//! Parts of a card, built from its configuration.

use crate::card::channel_trigger::ChannelTrigger;
use crate::config::{CardConfig, ChannelConfig};
use crate::encoder_port::EncoderPort;
use crate::endat::features::{Features, FixedTimes};
use crate::endat::line_monitor::LineStart;
use crate::endat::service::program::ServiceTimes;
use crate::endat::service::CHANNELS_SERVED;

/// Time stamp bit that toggles about `hz` times a second.
pub(super) fn blink_bit(system_hz: u64, hz: u64) -> u64 {
    u64::from((system_hz / (2 * hz)).max(1).ilog2())
}

/// Trigger logic of each channel, for `channels` channels.
pub(super) fn channel_triggers(card: &CardConfig, channels: usize) -> Vec<ChannelTrigger> {
    let of = |channel: &ChannelConfig| {
        let own = channel.spec.trigger.unwrap_or_default();
        ChannelTrigger::new(own.ignored(), own.skip(), !own.enabled)
    };
    card.channels.iter().take(channels).map(of).collect()
}

/// Fixed times of a channel.
fn times(card: &CardConfig, channel: &ChannelConfig) -> FixedTimes {
    FixedTimes {
        ready_low_cycles: channel.ready_low_cycles,
        abort_us: channel.abort_us,
        calibration_period_cycles: channel.calibration_period_cycles(card.system_hz),
        ..FixedTimes::at(card.system_hz)
    }
}

/// Features of the channels, without those of a service.
fn line(card: &CardConfig) -> Features {
    Features {
        alignment: card.line.alignment,
        margin: card.line.margin,
        double_edge: card.line.double_edge,
        second_receiver: card.safety.second_receiver,
        upset_guards: card.safety.upset_guards,
        restore: true,
        ..Features::NONE
    }
}

fn line_start(card: &CardConfig) -> LineStart {
    LineStart {
        clears: !card.initial_values,
        ..card.line.start(card.system_hz)
    }
}

/// Features and waiting times of a card's services.
pub fn service_times(config: &CardConfig) -> ServiceTimes {
    ServiceTimes {
        initialise: config.service.initialise,
        diagnosis: config.service.diagnosis,
        continuous: config.service.continuous,
        infos: config.service.infos,
        error_test_ms: config.safety.error_test_ms,
        second_receiver: config.safety.second_receiver,
        clears_ram: !config.initial_values,
        ..ServiceTimes::at(config.system_hz)
    }
}

/// Number of channels with a place at a service: up to the last one that speaks EnDat.
pub(super) fn served_channels(card: &CardConfig) -> usize {
    let last = card.endat_channels().last();
    last.filter(|_| card.service.requests)
        .map_or(0, |(index, _)| index + 1)
}

/// Number of services of a card; each serves up to [`CHANNELS_SERVED`] consecutive channels.
pub fn services(card: &CardConfig) -> usize {
    served_channels(card).div_ceil(CHANNELS_SERVED)
}

/// The port of a channel, connected to a service if the card has one.
pub(super) fn port(card: &CardConfig, index: usize, service: &ServiceTimes) -> EncoderPort {
    let channel = &card.channels[index];
    if !channel.is_endat() {
        let has_io = index < served_channels(card);
        return EncoderPort::asked(&channel.spoken, card.safety.upset_guards, has_io);
    }
    let service = card.service.requests.then_some(service);
    EncoderPort::served(
        times(card, channel),
        service,
        channel.wants_short_recovery(),
        line(card),
        line_start(card),
    )
}

/// The first channel's port alone, for a design with separate registers and triggers.
pub fn bare_port(card: &CardConfig) -> EncoderPort {
    let (channel, service) = (&card.channels[0], service_times(card));
    if !channel.is_endat() {
        return EncoderPort::asked(&channel.spoken, card.safety.upset_guards, false);
    }
    EncoderPort::with_line(
        times(card, channel),
        card.service.requests.then_some(&service),
        channel.wants_short_recovery(),
        Features {
            restore: card.safety.restore,
            ..line(card)
        },
        line_start(card),
    )
}
