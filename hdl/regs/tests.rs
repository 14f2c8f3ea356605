use super::*;
use crate::config::{CardRequest, ChannelRequest, TriggerSources};
use crate::protocol::ModeCommand;

/// The card of the tests: two unlike channels, a UART of 8 cycles per bit.
pub fn test_config() -> CardConfig {
    let first = ChannelRequest {
        clock_hz: 3_125_000,
        tst_ns: 2_000,
        command: ModeCommand::SendPositionAddInfo,
        position_bits: 29,
        filter_ns: 20,
        start_window_ns: 50,
        tcal_max_ns: 5_000,
        recovery_min_ns: 10_000,
        recovery_max_ns: 30_000,
        cable_m: 20,
    };
    let second = ChannelRequest {
        clock_hz: 2_000_000,
        command: ModeCommand::SendPosition,
        position_bits: 25,
        ..first.clone()
    };
    let mut config = CardConfig::resolve(&CardRequest {
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
    })
    .unwrap();
    config.hash = 0x0123_4567_89ab;
    config
}

/// Every word of a card with two channels: name, address, access.
fn words() -> Vec<(String, u16, &'static str)> {
    let mut words = Vec::new();
    for block in BLOCKS {
        for channel in 0..if block.per_channel { 2 } else { 1 } {
            for r in block.registers {
                let n = if block.per_channel {
                    channel.to_string()
                } else {
                    String::new()
                };
                let name = format!("{}{n}_{}", block.name, r.name);
                words.push((name, block.address(r, channel), r.access.short()));
            }
        }
    }
    words
}

/// Within a major version this list only grows.
const GOLDEN: &str = "\
card_id 000 ro
card_version 001 ro
card_capabilities 002 ro
card_system_hz 003 ro
card_configuration_hash 004 ro
card_trigger_count 008 ro
card_trigger_now 009 strobe
card_calibrate 00A strobe
config_trigger_sources 100 rw
config_trigger_period 101 rw
config_hold 102 rw
config0_frame 108 rw
config0_timing 109 rw
config0_limits 10A rw
config1_frame 110 rw
config1_timing 111 rw
config1_limits 112 rw
result0_status 180 ro
result0_position_low 181 ro
result0_position_high 182 ro
result0_timestamp 183 ro
result0_evidence 184 ro
result0_age_recovery 185 ro
result1_status 188 ro
result1_position_low 189 ro
result1_position_high 18A ro
result1_timestamp 18B ro
result1_evidence 18C ro
result1_age_recovery 18D ro
";

/// Fields of the words: within a major version this list only grows, too.
const GOLDEN_FIELDS: &str = "\
id value 31:0
version patch 15:0
version minor 23:16
version major 31:24
capabilities channels 7:0
capabilities max_position_bits 15:8
capabilities features 31:16
system_hz value 31:0
configuration_hash value 31:0
trigger_count value 31:0
trigger_now trigger 0:0
calibrate channels 7:0
trigger_sources pin 0:0
trigger_sources timer 1:1
trigger_sources register 2:2
trigger_period value 23:0
hold hold 0:0
hold scratch 31:8
frame period_cycles 10:0
frame position_bits 21:16
frame command 29:24
timing first_low_extra_cycles 10:0
timing start_window_cycles 21:16
timing filter_cycles 27:24
limits start_timeout_us 11:0
limits recovery_limit_cycles 28:16
status sequence 15:0
status cause 19:16
status valid 20:20
status fresh 21:21
position_low value 31:0
position_high value 15:0
timestamp value 31:0
evidence crc_received 4:0
evidence crc_computed 9:5
evidence delay_cycles 19:10
evidence flags 31:20
age_recovery age_us 15:0
age_recovery recovery_cycles 28:16
";

#[test]
fn offsets_and_fields_are_where_they_have_always_been() {
    let text: String = words()
        .iter()
        .map(|(name, address, access)| format!("{name} {address:03X} {access}\n"))
        .collect();
    assert_eq!(text, GOLDEN);
    let registers = BLOCKS.iter().flat_map(|b| b.registers);
    let fields: String = registers
        .flat_map(|r| r.fields.iter().map(move |f| (r, f)))
        .map(|(r, f)| format!("{} {} {}:{}\n", r.name, f.name, f.lsb + f.width - 1, f.lsb))
        .collect();
    assert_eq!(fields, GOLDEN_FIELDS);
}

#[test]
fn no_two_words_share_an_address_and_no_two_fields_a_bit() {
    let mut addresses: Vec<u16> = BLOCKS
        .iter()
        .flat_map(|b| {
            let channels = if b.per_channel { CHANNELS_MAX } else { 1 };
            (0..channels).flat_map(move |c| b.registers.iter().map(move |r| b.address(r, c)))
        })
        .collect();
    let n = addresses.len();
    addresses.sort_unstable();
    addresses.dedup();
    assert_eq!(addresses.len(), n);
    assert!(addresses
        .iter()
        .all(|a| *a < 1 << crate::uart_bridge::ADDRESS_BITS));
    for register in BLOCKS.iter().flat_map(|b| b.registers) {
        let mut used = 0u32;
        for field in register.fields {
            assert!(field.lsb + field.width <= 32, "{}", register.name);
            assert_eq!(used & field.mask(), 0, "{} {}", register.name, field.name);
            used |= field.mask();
        }
    }
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
fn map_lists_every_word_and_field() {
    let text = markdown(&test_config());
    for register in BLOCKS.iter().flat_map(|b| b.registers) {
        assert!(text.contains(&format!("`{}`", register.name)));
        for field in register.fields {
            assert!(text.contains(&format!("`{}`", field.name)));
        }
    }
    assert!(
        text.contains("| 10:0 | `period_cycles` | cycles | 32, 50 |"),
        "{text}"
    );
    assert!(text.contains("0x456E4474"));
}
