//! The register table of a configured card: its words, and their values after reset.

pub use endat_regs::*;

use crate::card::config_ring::RING_WORDS;
use crate::config::{CardConfig, ChannelConfig, OwnTrigger, PositionRange};
use crate::endat::line_monitor::LineStart;
use protocol::MAX_POSITION_BITS;

/// True if a card with this configuration has a part.
pub fn has(config: &CardConfig, part: Part) -> bool {
    let speaks = |p: &&Protocol| p.row().part == Some(part) && config.speaks(**p);
    match part {
        Part::EnDat22 | Part::LineDelay => config.endat_channels().next().is_some(),
        Part::TriggerPin | Part::TriggerTimer => true,
        Part::Requests => config.service.requests,
        Part::Initialise => config.service.initialise,
        Part::Diagnosis => config.service.diagnosis,
        Part::Continuous => config.service.continuous,
        Part::Alignment => config.line.alignment,
        Part::Margin => config.line.margin,
        Part::DoubleEdge => config.line.double_edge,
        Part::Stream => config.stream.fifo_bytes != 0,
        Part::Direct => config.outputs.any(),
        Part::Interrupt => config.outputs.interrupt,
        Part::RecoveryCounter => config.safety.recovery_counter,
        Part::SecondInterface => config.safety.second_interface,
        Part::SecondReceiver => config.safety.second_receiver,
        Part::ErrorTest => config.safety.error_test_ms != 0,
        Part::OwnTrigger => config.own_triggers(),
        // Parts of protocols.
        _ => Protocol::ALL.iter().any(|p| speaks(&p)),
    }
}

/// The blocks of a card.
pub fn blocks(config: &CardConfig) -> impl Iterator<Item = &'static Block> + '_ {
    let is_there = |block: &&Block| block.part.is_none_or(|part| has(config, part));
    BLOCKS.iter().filter(is_there)
}

/// The words of a block on a card; words of missing parts are left out.
pub fn present<'a>(
    block: &Block,
    config: &'a CardConfig,
) -> impl Iterator<Item = &'static Register> + 'a {
    let is_there = |register: &&Register| register.part.is_none_or(|part| has(config, part));
    block.registers.iter().filter(is_there)
}

/// A word of a card.
#[derive(Clone, Copy, Debug)]
pub struct Word {
    /// Block of the word.
    pub block: &'static Block,
    /// Register of the word.
    pub register: &'static Register,
    /// Channel of the word; 0 for words of the card.
    pub channel: usize,
    /// Word address.
    pub address: u16,
    /// Value after reset; in RAM only after power-up.
    pub start: u32,
}

/// All words of a card.
pub fn words(config: &CardConfig) -> Vec<Word> {
    let mut words = Vec::new();
    for block in blocks(config) {
        let copies = if block.per_channel {
            config.channels.len()
        } else {
            1
        };
        for channel in 0..copies {
            words.extend(present(block, config).map(|register| Word {
                block,
                register,
                channel,
                address: block.address(register, channel),
                start: start(block, register, config, channel),
            }));
        }
    }
    words
}

/// Value of a field after reset; the channel is 0 for words of the card.
type Start = fn(&CardConfig, usize) -> u64;

/// The channel's start values; zeros for an absent channel.
fn of(config: &CardConfig, channel: usize, value: impl Fn(&ChannelConfig) -> u64) -> u64 {
    config.channels.get(channel).map(value).unwrap_or_default()
}

/// The trigger settings of a channel.
fn own(channel: &ChannelConfig) -> OwnTrigger {
    channel.spec.trigger.unwrap_or_default()
}

fn line(config: &CardConfig) -> LineStart {
    config.line.start(config.system_hz)
}

/// The parts of a card, one bit each.
fn features(config: &CardConfig) -> u64 {
    let bit = |part: &Part| u64::from(has(config, *part)) << *part as u32;
    Part::ALL.iter().map(bit).sum()
}

/// Fields that are not 0 after reset: `block.register.field`.
const STARTS: &[(&str, Start)] = &[
    ("card.id.value", |_, _| ID.into()),
    ("card.version.patch", |_, _| VERSION[2].into()),
    ("card.version.minor", |_, _| VERSION[1].into()),
    ("card.version.major", |_, _| VERSION[0].into()),
    ("card.capabilities.channels", |s, _| s.channels.len() as u64),
    ("card.capabilities.max_position_bits", |_, _| {
        MAX_POSITION_BITS as u64
    }),
    ("card.capabilities.features", |s, _| {
        features(s) & ((1 << FEATURES_BITS) - 1)
    }),
    ("card.system_hz.value", |s, _| s.system_hz),
    ("card.configuration_hash.value", |s, _| s.hash >> 16),
    ("card.protocols.stream_additional_data", |s, _| {
        s.stream.additional_data.into()
    }),
    ("card.protocols.features", |s, _| {
        features(s) >> FEATURES_BITS
    }),
    ("recovery.counter.value", |_, n| {
        u64::from(COUNTER_SPACING) * n as u64
    }),
    ("card.stream_control.collect", |s, _| {
        s.stream.start.collects().into()
    }),
    ("card.stream_control.push", |s, _| {
        s.stream.start.pushes().into()
    }),
    ("card_config.trigger_sources.pin", |s, _| {
        s.sources.pin.into()
    }),
    ("card_config.trigger_sources.timer", |s, _| {
        s.sources.timer.into()
    }),
    ("card_config.trigger_sources.register", |s, _| {
        s.sources.register.into()
    }),
    ("card_config.trigger_sources.disabled", |s, _| {
        let off = |c: &ChannelConfig| c.spec.trigger.is_some_and(|t| !t.enabled);
        let channels = s.channels.iter().enumerate();
        channels.map(|(n, c)| u64::from(off(c)) << n).sum()
    }),
    ("card_config.trigger_period.value", |s, _| {
        s.sample_period_cycles
    }),
    ("config.frame.period_cycles", |s, c| {
        of(s, c, |v| v.period_cycles)
    }),
    ("config.frame.skip", |s, c| of(s, c, |v| own(v).skip())),
    ("config.frame.position_bits", |s, c| {
        of(s, c, ChannelConfig::told_position_bits)
    }),
    ("config.timing.multi_turn_bits", |s, c| {
        of(s, c, ChannelConfig::multi_turn_bits)
    }),
    ("config.limits.range", |s, c| {
        of(s, c, |v| PositionRange::kind(v.spec.range))
    }),
    ("config.frame.ignore_pin", |s, c| {
        of(s, c, |v| own(v).ignored() & 1)
    }),
    ("config.frame.ignore_timer", |s, c| {
        of(s, c, |v| own(v).ignored() >> 1 & 1)
    }),
    ("config.frame.command", |s, c| {
        of(s, c, |v| match v.protocol() {
            Protocol::Endat => v.command.code().into(),
            _ => 0,
        })
    }),
    ("config.frame.ignore_register", |s, c| {
        of(s, c, |v| own(v).ignored() >> 2 & 1)
    }),
    ("config.timing.first_low_extra_cycles", |s, c| {
        of(s, c, |v| v.first_low_extra_cycles)
    }),
    ("config.timing.start_window_cycles", |s, c| {
        of(s, c, |v| v.start_window_cycles)
    }),
    ("config.timing.filter_half", |s, c| {
        of(s, c, |v| v.filter_half.into())
    }),
    ("config.timing.filter_cycles", |s, c| {
        of(s, c, |v| v.filter_cycles)
    }),
    ("config.limits.start_timeout_us", |s, c| {
        of(s, c, |v| v.start_timeout_us)
    }),
    ("config.limits.recovery_limit_cycles", |s, c| {
        of(s, c, |v| v.recovery_limit_cycles)
    }),
    ("line.alignment.mode", |s, _| line(s).phase_mode),
    ("line.alignment.majority", |s, _| line(s).majority.into()),
    ("line.fixed_delay.value", |s, _| line(s).fixed_delay),
    ("line.limits.drift", |s, _| line(s).drift_limit),
    ("direct.crop.length_bits", |s, c| {
        of(s, c, |v| v.position_bits.min(32).into())
    }),
    ("direct.error_causes.causes", |_, _| ERROR_CAUSES.into()),
];

/// Value of a word after reset; the channel is 0 for words of the card.
pub fn start(block: &Block, register: &Register, config: &CardConfig, channel: usize) -> u32 {
    let value = |field: &Field| {
        if let Some(own) = of_protocol(block, register, field, config, channel) {
            return own;
        }
        let path = format!("{}.{}.{}", block.name, register.name, field.name);
        let usual = STARTS.iter().find(|(place, _)| *place == path);
        usual.map_or(0, |(_, start)| start(config, channel))
    };
    let parts = register.fields.iter();
    parts.fold(0, |word, f| word | (value(f) << f.lsb) as u32 & f.mask())
}

/// Start value of a field with a protocol-specific meaning, or of a field of the word `protocols`.
fn of_protocol(
    block: &Block,
    register: &Register,
    field: &Field,
    config: &CardConfig,
    channel: usize,
) -> Option<u64> {
    let spoken = || config.channels.get(channel).map(|c| c.spoken);
    match block.name {
        "config" => spoken()?.start(register.name, field.name),
        "card" => {
            let tells = |p: &&Protocol| p.row().channels.as_ref() == Some(field);
            let protocol = Protocol::ALL.iter().find(tells)?;
            Some(config.protocols().channels(*protocol))
        }
        _ => None,
    }
}

/// The words of a configuration block after reset; `channel` is `None` for the card's own.
pub fn config_words(config: &CardConfig, channel: Option<usize>) -> [u32; RING_WORDS] {
    let mut words = [0; RING_WORDS];
    let block = match channel {
        Some(_) => &CHANNEL_CONFIG,
        None => &CARD_CONFIG,
    };
    for register in block.registers {
        words[register.offset as usize] = start(block, register, config, channel.unwrap_or(0));
    }
    words
}

#[cfg(test)]
pub(crate) mod tests;
