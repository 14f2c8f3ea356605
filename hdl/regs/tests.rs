use super::*;
use crate::config::TFormatRequest;
use crate::config::{CardRequest, ChannelConfig, ChannelRequest, TriggerSources};
use crate::protocol::ModeCommand;

/// The card of the tests: two unlike channels, a UART of 8 cycles per bit.
pub fn test_config() -> CardConfig {
    let first = ChannelRequest {
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
        t_format: None,
        trigger: None,
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
        service: Default::default(),
        line: Default::default(),
        stream: Default::default(),
        outputs: Default::default(),
    })
    .unwrap();
    config.hash = 0x0123_4567_89ab;
    config
}

/// The same card with a T-format encoder on its second channel.
pub fn mixed_config() -> CardConfig {
    let mut config = test_config();
    let request = ChannelRequest {
        t_format: Some(TFormatRequest::default()),
        ..config.channels[1].request.clone()
    };
    config.channels[1] = ChannelConfig::resolve(&request, config.system_hz, false, 1).unwrap();
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
card_protocols 005 ro
card_trigger_count 008 ro
card_trigger_now 009 strobe
card_calibrate 00A strobe
card_stream_control 00C rw
card_stream_state 00D ro
card_stream_data 00E ro
card_stream_clear 00F strobe
interrupt_status 010 ro
interrupt_mask 011 rw
interrupt_clear 012 strobe
direct0_crop 080 rw
direct0_error_causes 081 rw
direct1_crop 088 rw
direct1_error_causes 089 rw
t_format0_send 0C0 strobe
t_format0_answer 0C1 ro
t_format0_fields 0C2 ro
t_format0_parts 0C3 ro
t_format1_send 0C8 strobe
t_format1_answer 0C9 ro
t_format1_fields 0CA ro
t_format1_parts 0CB ro
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
result0_info_1 186 ro
result0_info_2 187 ro
result1_status 188 ro
result1_position_low 189 ro
result1_position_high 18A ro
result1_timestamp 18B ro
result1_evidence 18C ro
result1_age_recovery 18D ro
result1_info_1 18E ro
result1_info_2 18F ro
line0_edges_0 200 ro
line0_edges_1 201 ro
line0_edges_2 202 ro
line0_edges_3 203 ro
line0_edges_4 204 ro
line0_edges_5 205 ro
line0_edges_6 206 ro
line0_edges_7 207 ro
line0_edges_8 208 ro
line0_edges_9 209 ro
line0_edges_10 20A ro
line0_edges_11 20B ro
line0_edges_12 20C ro
line0_edges_13 20D ro
line0_edges_14 20E ro
line0_edges_15 20F ro
line0_edges_16 210 ro
line0_edges_17 211 ro
line0_edges_18 212 ro
line0_edges_19 213 ro
line0_edges_20 214 ro
line0_edges_21 215 ro
line0_edges_22 216 ro
line0_edges_23 217 ro
line0_edges_24 218 ro
line0_edges_25 219 ro
line0_edges_26 21A ro
line0_edges_27 21B ro
line0_edges_28 21C ro
line0_edges_29 21D ro
line0_edges_30 21E ro
line0_edges_31 21F ro
line0_alignment 220 rw
line0_fixed_delay 221 rw
line0_limits 222 rw
line0_clear 223 strobe
line0_frame 228 ro
line0_worst 229 ro
line0_phase 22A ro
line0_counts 22B ro
line0_frames 22C ro
line1_edges_0 240 ro
line1_edges_1 241 ro
line1_edges_2 242 ro
line1_edges_3 243 ro
line1_edges_4 244 ro
line1_edges_5 245 ro
line1_edges_6 246 ro
line1_edges_7 247 ro
line1_edges_8 248 ro
line1_edges_9 249 ro
line1_edges_10 24A ro
line1_edges_11 24B ro
line1_edges_12 24C ro
line1_edges_13 24D ro
line1_edges_14 24E ro
line1_edges_15 24F ro
line1_edges_16 250 ro
line1_edges_17 251 ro
line1_edges_18 252 ro
line1_edges_19 253 ro
line1_edges_20 254 ro
line1_edges_21 255 ro
line1_edges_22 256 ro
line1_edges_23 257 ro
line1_edges_24 258 ro
line1_edges_25 259 ro
line1_edges_26 25A ro
line1_edges_27 25B ro
line1_edges_28 25C ro
line1_edges_29 25D ro
line1_edges_30 25E ro
line1_edges_31 25F ro
line1_alignment 260 rw
line1_fixed_delay 261 rw
line1_limits 262 rw
line1_clear 263 strobe
line1_frame 268 ro
line1_worst 269 ro
line1_phase 26A ro
line1_counts 26B ro
line1_frames 26C ro
service0_request 400 rw
service0_request_state 401 ro
service0_answer 402 ro
service0_answer_more 403 ro
service0_duration 404 ro
service0_control 405 rw
service0_force 406 rw
service0_progress 407 ro
service0_state 408 ro
service0_lost 409 ro
service0_threshold 40A rw
service0_bad_frames 40B ro
service0_offset_low 40C rw
service0_offset_high 40D rw
service0_tolerance 40E rw
service0_difference_low 40F ro
service0_difference_high 410 ro
service0_comparisons 411 ro
service0_position_2_low 412 ro
service0_position_2_high 413 ro
service0_list_length 414 rw
service0_info_status 415 ro
service0_limits 416 rw
service0_continuous 417 rw
service0_list_0 418 rw
service0_list_1 419 rw
service0_list_2 41A rw
service0_list_3 41B rw
service0_list_4 41C rw
service0_list_5 41D rw
service0_list_6 41E rw
service0_list_7 41F rw
service0_slot_0 420 ro
service0_slot_1 421 ro
service0_slot_2 422 ro
service0_slot_3 423 ro
service0_slot_4 424 ro
service0_slot_5 425 ro
service0_slot_6 426 ro
service0_slot_7 427 ro
service0_request_wait 428 rw
service0_frames_good 430 ro
service0_frames_data_not_low 431 ro
service0_frames_no_start_bit 432 ro
service0_frames_start_window 433 ro
service0_frames_crc 434 ro
service0_frames_f1 435 ro
service0_frames_f2 436 ro
service0_frames_data_not_falling 437 ro
service0_frames_trigger_overrun 438 ro
service0_frames_unknown_command 439 ro
service0_frames_info_missing 43A ro
service0_frames_no_encoder 43B ro
service0_frames_stuck_high 43C ro
service0_frames_stuck_low 43D ro
service0_frames_late_start 43E ro
service0_frames_watchdog 43F ro
service0_frames_own_echo 440 ro
service0_frames_recovery_too_short 441 ro
service0_frames_position_2 442 ro
service0_bad_infos 443 ro
service0_alarms 444 ro
service0_warnings 445 ro
service0_position_bits 446 ro
service0_encoder_type 447 ro
service0_signal_periods_low 448 ro
service0_signal_periods_high 449 ro
service0_revolutions 44A ro
service0_steps_low 44B ro
service0_steps_high 44C ro
service0_id_0 44D ro
service0_id_1 44E ro
service0_id_2 44F ro
service0_serial_0 450 ro
service0_serial_1 451 ro
service0_serial_2 452 ro
service0_commands 453 ro
service0_tcal 454 ro
service0_infos_1 455 ro
service0_infos_2 456 ro
service0_clock_max_khz 457 ro
service0_recovery 458 ro
service0_delay 459 ro
service1_request 480 rw
service1_request_state 481 ro
service1_answer 482 ro
service1_answer_more 483 ro
service1_duration 484 ro
service1_control 485 rw
service1_force 486 rw
service1_progress 487 ro
service1_state 488 ro
service1_lost 489 ro
service1_threshold 48A rw
service1_bad_frames 48B ro
service1_offset_low 48C rw
service1_offset_high 48D rw
service1_tolerance 48E rw
service1_difference_low 48F ro
service1_difference_high 490 ro
service1_comparisons 491 ro
service1_position_2_low 492 ro
service1_position_2_high 493 ro
service1_list_length 494 rw
service1_info_status 495 ro
service1_limits 496 rw
service1_continuous 497 rw
service1_list_0 498 rw
service1_list_1 499 rw
service1_list_2 49A rw
service1_list_3 49B rw
service1_list_4 49C rw
service1_list_5 49D rw
service1_list_6 49E rw
service1_list_7 49F rw
service1_slot_0 4A0 ro
service1_slot_1 4A1 ro
service1_slot_2 4A2 ro
service1_slot_3 4A3 ro
service1_slot_4 4A4 ro
service1_slot_5 4A5 ro
service1_slot_6 4A6 ro
service1_slot_7 4A7 ro
service1_request_wait 4A8 rw
service1_frames_good 4B0 ro
service1_frames_data_not_low 4B1 ro
service1_frames_no_start_bit 4B2 ro
service1_frames_start_window 4B3 ro
service1_frames_crc 4B4 ro
service1_frames_f1 4B5 ro
service1_frames_f2 4B6 ro
service1_frames_data_not_falling 4B7 ro
service1_frames_trigger_overrun 4B8 ro
service1_frames_unknown_command 4B9 ro
service1_frames_info_missing 4BA ro
service1_frames_no_encoder 4BB ro
service1_frames_stuck_high 4BC ro
service1_frames_stuck_low 4BD ro
service1_frames_late_start 4BE ro
service1_frames_watchdog 4BF ro
service1_frames_own_echo 4C0 ro
service1_frames_recovery_too_short 4C1 ro
service1_frames_position_2 4C2 ro
service1_bad_infos 4C3 ro
service1_alarms 4C4 ro
service1_warnings 4C5 ro
service1_position_bits 4C6 ro
service1_encoder_type 4C7 ro
service1_signal_periods_low 4C8 ro
service1_signal_periods_high 4C9 ro
service1_revolutions 4CA ro
service1_steps_low 4CB ro
service1_steps_high 4CC ro
service1_id_0 4CD ro
service1_id_1 4CE ro
service1_id_2 4CF ro
service1_serial_0 4D0 ro
service1_serial_1 4D1 ro
service1_serial_2 4D2 ro
service1_commands 4D3 ro
service1_tcal 4D4 ro
service1_infos_1 4D5 ro
service1_infos_2 4D6 ro
service1_clock_max_khz 4D7 ro
service1_recovery 4D8 ro
service1_delay 4D9 ro
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
protocols t_format 7:0
protocols stream_informations 8:8
trigger_count value 31:0
trigger_now trigger 0:0
calibrate channels 7:0
stream_control collect 0:0
stream_control push 1:1
stream_state bytes 15:0
stream_state lost 31:16
stream_data bytes 31:0
stream_clear clear 0:0
status channel_0 3:0
status channel_1 7:4
status channel_2 11:8
status channel_3 15:12
status channel_4 19:16
status channel_5 23:20
status channel_6 27:24
status channel_7 31:28
mask channel_0 3:0
mask channel_1 7:4
mask channel_2 11:8
mask channel_3 15:12
mask channel_4 19:16
mask channel_5 23:20
mask channel_6 27:24
mask channel_7 31:28
clear channel_0 3:0
clear channel_1 7:4
clear channel_2 11:8
clear channel_3 15:12
clear channel_4 19:16
clear channel_5 23:20
clear channel_6 27:24
clear channel_7 31:28
crop first_bit 5:0
crop length_bits 13:8
error_causes causes 31:0
send data 7:0
send address 14:8
send id 19:16
answer data 7:0
answer id 11:8
answer cause 15:12
answer done 16:16
answer busy 17:17
fields status 7:0
fields encoder_id 15:8
fields alarm 23:16
fields crc 31:24
parts single_valid 0:0
parts multi_valid 1:1
trigger_sources pin 0:0
trigger_sources timer 1:1
trigger_sources register 2:2
trigger_sources disabled 15:8
trigger_period value 23:0
hold hold 0:0
hold scratch 31:8
frame period_cycles 10:0
frame skip 15:11
frame position_bits 21:16
frame ignore_pin 22:22
frame ignore_timer 23:23
frame command 29:24
frame ignore_register 30:30
timing first_low_extra_cycles 10:0
timing start_window_cycles 21:16
timing filter_half 23:23
timing filter_cycles 27:24
timing request_id 31:28
limits start_timeout_us 11:0
limits recovery_limit_cycles 28:16
limits field_gap_us 31:29
status sequence 15:0
status cause 20:16
status valid 22:22
status fresh 23:23
status line 31:24
position_low value 31:0
position_high value 15:0
position_high crc 20:16
position_high f2 22:22
position_high width 29:24
timestamp value 31:0
evidence crc_received 4:0
evidence crc_computed 9:5
evidence delay_cycles 19:10
evidence flags 31:20
age_recovery age_us 15:0
age_recovery recovery_cycles 28:16
age_recovery delay_high 29:29
age_recovery stale 30:30
info_1 content 15:0
info_1 sign 20:16
info_1 busy 21:21
info_1 reference_mark 22:22
info_1 warning 23:23
info_1 came 24:24
info_1 good 25:25
info_2 content 15:0
info_2 sign 20:16
info_2 busy 21:21
info_2 reference_mark 22:22
info_2 warning 23:23
info_2 came 24:24
info_2 good 25:25
edges_0 edges 31:0
edges_1 edges 31:0
edges_2 edges 31:0
edges_3 edges 31:0
edges_4 edges 31:0
edges_5 edges 31:0
edges_6 edges 31:0
edges_7 edges 31:0
edges_8 edges 31:0
edges_9 edges 31:0
edges_10 edges 31:0
edges_11 edges 31:0
edges_12 edges 31:0
edges_13 edges 31:0
edges_14 edges 31:0
edges_15 edges 31:0
edges_16 edges 31:0
edges_17 edges 31:0
edges_18 edges 31:0
edges_19 edges 31:0
edges_20 edges 31:0
edges_21 edges 31:0
edges_22 edges 31:0
edges_23 edges 31:0
edges_24 edges 31:0
edges_25 edges 31:0
edges_26 edges 31:0
edges_27 edges 31:0
edges_28 edges 31:0
edges_29 edges 31:0
edges_30 edges 31:0
edges_31 edges 31:0
alignment mode 1:0
alignment majority 4:4
alignment bin_shift 9:8
fixed_delay value 14:0
limits drift 11:0
limits offset 22:16
clear clear 0:0
clear reference 1:1
frame earliest 7:0
frame latest 15:8
frame start 23:16
worst earliest 7:0
worst latest 15:8
worst valid 16:16
worst drift_alarm 24:24
worst offset_alarm 25:25
phase tracked 14:0
phase reference 30:16
counts glitches 15:0
counts bad_frames 31:16
frames value 31:0
request data 15:0
request address 23:16
request command 29:24
request_state busy 0:0
request_state error 7:4
request_state finished 31:16
answer data 15:0
answer address 23:16
answer_more value 15:0
duration us 15:0
duration ms 31:16
control initialise 0:0
control clear 1:1
control cancel 2:2
force f1 0:0
force f2 1:1
force crc 2:2
progress step 15:0
progress failed 31:16
state initialised 0:0
state alarm 1:1
state position_2 2:2
state endat22 3:3
state other_width 4:4
state slower 5:5
state unplugged 6:6
state initialising 7:7
state starts 31:16
lost triggers 15:0
lost ends 31:16
threshold n 15:0
threshold m 31:16
bad_frames count 15:0
bad_frames which 31:16
offset_low value 31:0
offset_high value 15:0
tolerance value 31:0
difference_low value 31:0
difference_high value 15:0
comparisons all 15:0
comparisons failed 31:16
position_2_low value 31:0
position_2_high value 15:0
list_length length 3:0
info_status info_1 7:0
info_status crc_1 8:8
info_status info_2 23:16
info_status crc_2 24:24
limits watchdog_us 11:0
limits recovery_min_cycles 28:16
continuous go_on 0:0
continuous stop_at_error 1:1
list_0 mrs 7:0
list_1 mrs 7:0
list_2 mrs 7:0
list_3 mrs 7:0
list_4 mrs 7:0
list_5 mrs 7:0
list_6 mrs 7:0
list_7 mrs 7:0
slot_0 value 15:0
slot_0 sequence 31:16
slot_1 value 15:0
slot_1 sequence 31:16
slot_2 value 15:0
slot_2 sequence 31:16
slot_3 value 15:0
slot_3 sequence 31:16
slot_4 value 15:0
slot_4 sequence 31:16
slot_5 value 15:0
slot_5 sequence 31:16
slot_6 value 15:0
slot_6 sequence 31:16
slot_7 value 15:0
slot_7 sequence 31:16
request_wait ms 15:0
frames_good frames 31:0
frames_data_not_low frames 31:0
frames_no_start_bit frames 31:0
frames_start_window frames 31:0
frames_crc frames 31:0
frames_f1 frames 31:0
frames_f2 frames 31:0
frames_data_not_falling frames 31:0
frames_trigger_overrun frames 31:0
frames_unknown_command frames 31:0
frames_info_missing frames 31:0
frames_no_encoder frames 31:0
frames_stuck_high frames 31:0
frames_stuck_low frames 31:0
frames_late_start frames 31:0
frames_watchdog frames 31:0
frames_own_echo frames 31:0
frames_recovery_too_short frames 31:0
frames_position_2 frames 31:0
bad_infos count 31:0
alarms value 15:0
alarms is_read 16:16
warnings value 15:0
warnings is_read 16:16
position_bits value 15:0
position_bits is_read 16:16
encoder_type value 15:0
encoder_type is_read 16:16
signal_periods_low value 15:0
signal_periods_low is_read 16:16
signal_periods_high value 15:0
signal_periods_high is_read 16:16
revolutions value 15:0
revolutions is_read 16:16
steps_low value 15:0
steps_low is_read 16:16
steps_high value 15:0
steps_high is_read 16:16
id_0 value 15:0
id_0 is_read 16:16
id_1 value 15:0
id_1 is_read 16:16
id_2 value 15:0
id_2 is_read 16:16
serial_0 value 15:0
serial_0 is_read 16:16
serial_1 value 15:0
serial_1 is_read 16:16
serial_2 value 15:0
serial_2 is_read 16:16
commands value 15:0
commands is_read 16:16
tcal value 15:0
tcal is_read 16:16
infos_1 value 15:0
infos_1 is_read 16:16
infos_2 value 15:0
infos_2 is_read 16:16
clock_max_khz value 15:0
clock_max_khz is_read 16:16
recovery value 15:0
recovery is_read 16:16
delay value 15:0
delay is_read 16:16
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
fn a_t_format_channel_starts_with_its_own_numbers() {
    let config = mixed_config();
    let words = config_words(&config, Some(1));
    // 40 cycles in a bit, filter of 2, request 3; no mode command, no window, no recovery time.
    assert_eq!(words, [40 | 48 << 16, 2 << 24 | 3 << 28, 20 | 2 << 29]);
    assert_eq!(CARD.register("protocols").unwrap().start(&config, 0), 2);
    let features = CARD.register("capabilities").unwrap().start(&config, 0) >> 16;
    assert_eq!(features >> 14 & 1, 1);
    assert_eq!(features & 3, 3, "EnDat and its line delay");
    let mut alone = config.clone();
    alone.channels.retain(|c| c.t_format.is_some());
    let features = CARD.register("capabilities").unwrap().start(&alone, 0) >> 16;
    assert_eq!(features & 3, 0, "no EnDat");
    assert!(blocks(&config).any(|b| b.name == "t_format"));
    assert!(blocks(&test_config()).all(|b| b.name != "t_format"));
}
