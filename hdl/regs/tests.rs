use super::*;
use crate::config::{CardSpec, ChannelConfig, ChannelSpec, TriggerSources};
use crate::endat::service::program::{self, step_name};
use crate::protocol::ModeCommand;
use crate::protocols::{Spoken, TFormatSpec};

/// The card of the tests: two different channels, a UART with 8 cycles per bit.
pub fn test_config() -> CardConfig {
    let first = ChannelSpec {
        clock_hz: 3_125_000,
        calibration_hz: None,
        tst_ns: 2_000,
        command: ModeCommand::SendPositionAddInfo,
        position_bits: 29,
        filter_ns: 20,
        start_window_ns: 50,
        tcal_max_ns: 5_000,
        recovery_min_ns: 10_000,
        recovery_max_ns: 30_000,
        cable_m: 20,
        spoken: Spoken::Endat,
        trigger: None,
        range: None,
    };
    let second = ChannelSpec {
        clock_hz: 2_000_000,
        command: ModeCommand::SendPosition,
        position_bits: 25,
        ..first.clone()
    };
    let mut config = CardConfig::resolve(&CardSpec {
        system_hz: 100_000_000,
        channels: vec![first, second],
        sample_hz: 10_000,
        sources: TriggerSources {
            pin: true,
            timer: false,
            register: true,
        },
        baud: 12_500_000,
        read_hz: 1_000,
        service: Default::default(),
        line: Default::default(),
        stream: Default::default(),
        outputs: Default::default(),
        safety: Default::default(),
    })
    .unwrap();
    config.hash = 0x0123_4567_89ab;
    config
}

/// The same card with a T-format encoder on its second channel.
pub fn mixed_config() -> CardConfig {
    let mut config = test_config();
    let request = ChannelSpec {
        spoken: Spoken::TFormat(TFormatSpec::default()),
        ..config.channels[1].spec.clone()
    };
    config.channels[1] = ChannelConfig::resolve(&request, config.system_hz, false, 1).unwrap();
    config
}

#[test]
fn start_values_are_those_of_the_configuration() {
    let config = test_config();
    assert_eq!(config_words(&config, None), [0b101, 10_000, 0]);
    for (i, channel) in config.channels.iter().enumerate() {
        let words = config_words(&config, Some(i));
        assert_eq!(u64::from(words[0] & 0x7ff), channel.period_cycles);
        assert_eq!(words[0] >> 16 & 0x3f, channel.position_bits);
        assert_eq!(words[0] >> 24, u32::from(channel.command.code()));
        assert_eq!(u64::from(words[1] & 0x7ff), channel.first_low_extra_cycles);
        assert_eq!(
            u64::from(words[1] >> 16 & 0x3f),
            channel.start_window_cycles
        );
        assert_eq!(u64::from(words[1] >> 24), channel.filter_cycles);
        assert_eq!(u64::from(words[2] & 0xffff), channel.start_timeout_us);
        assert_eq!(u64::from(words[2] >> 16), channel.recovery_limit_cycles);
    }
}

#[test]
fn a_t_format_channel_starts_with_its_own_numbers() {
    let of = |config, name| start(&CARD, CARD.register(name).unwrap(), config, 0);
    let config = mixed_config();
    let words = config_words(&config, Some(1));
    // 40 cycles in a bit, filter of 2, request 3; no mode command, no window, no recovery time.
    assert_eq!(words, [40 | 48 << 16, 2 << 24 | 3 << 28, 20 | 2 << 29]);
    assert_eq!(of(&config, "protocols"), 2);
    let features = of(&config, "capabilities") >> 16;
    assert_eq!(features >> 14 & 1, 1);
    assert_eq!(features & 3, 3, "EnDat and its line delay");
    let mut alone = config.clone();
    alone.channels.retain(|c| !c.is_endat());
    let features = of(&alone, "capabilities") >> 16;
    assert_eq!(features & 3, 0, "no EnDat");
    assert!(blocks(&config).any(|b| b.name == "t_format"));
    assert!(blocks(&test_config()).all(|b| b.name != "t_format"));
}

/// Catches a start value for a renamed field, which would be 0 without an error.
#[test]
fn every_start_value_is_of_a_field() {
    for (index, (path, _)) in STARTS.iter().enumerate() {
        let [block, register, field] = path.split('.').collect::<Vec<_>>()[..] else {
            panic!("{path}");
        };
        let block = BLOCKS.iter().find(|b| b.name == block).expect(path);
        let register = block.register(register).expect(path);
        assert!(register.field(field).is_some(), "{path}");
        assert!(STARTS[..index].iter().all(|(other, _)| other != path));
    }
}

/// Catches a step that one list has and the other has not.
#[test]
fn steps_are_those_of_the_initialisation() {
    let steps = service::STEPS;
    let listed = steps[1..].iter().map(|s| s.meaning.to_owned());
    let done: Vec<String> = program::steps().into_iter().map(step_name).collect();
    assert_eq!(listed.collect::<Vec<_>>(), done);
    assert!((0..).zip(steps).all(|(number, step)| step.number == number));
}

/// Catches a word that the bridge cannot reach.
#[test]
fn the_bridge_reaches_every_word() {
    for block in BLOCKS {
        let last = block.registers.last().unwrap();
        let channel = if block.per_channel {
            CHANNELS_MAX - 1
        } else {
            0
        };
        let address = block.address(last, channel);
        assert!(
            address < 1 << crate::card::uart_bridge::ADDRESS_BITS,
            "{}",
            block.name
        );
    }
}
