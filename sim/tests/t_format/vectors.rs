//! Published frames: the receiver outputs the content sent by a real encoder.

use super::rig::Rig;
use endat_hdl::protocols::t_format::cause;
use endat_hdl::protocols::t_format::protocol::{crc, Request};
use endat_sim::t_format::EncoderConfig;

/// Bytes and CRC of each published frame.
fn vectors() -> Vec<(Vec<u8>, u8)> {
    let text = include_str!("../../../tests/data/crc_vectors.json");
    let data: serde_json::Value = serde_json::from_str(text).unwrap();
    let hex = |text: &str| u8::from_str_radix(text.trim_start_matches("0x"), 16).unwrap();
    let vectors = data["tamagawa"]["vectors"].as_array().unwrap();
    (vectors.iter())
        .map(|v| {
            let bytes = v["bytes_uart_order"].as_str().unwrap();
            let bytes = bytes.split_whitespace().map(hex).collect();
            (bytes, hex(v["crc_hex"].as_str().unwrap()))
        })
        .collect()
}

#[test]
fn logged_frames_of_a_real_encoder_arrive() {
    let logged = vectors();
    let frames: Vec<_> = logged
        .iter()
        .filter(|(bytes, _)| bytes[0] == 0x1A)
        .collect();
    assert_eq!(frames.len(), 9);
    for (bytes, sum) in frames {
        assert_eq!(crc(bytes), *sum);
        for mhz in [20, 60] {
            let mut rig = Rig::new(
                mhz,
                EncoderConfig {
                    single_turn: u32::from_le_bytes([bytes[2], bytes[3], bytes[4], 0]),
                    multi_turn: u32::from_le_bytes([bytes[6], bytes[7], bytes[8], 0]),
                    ..EncoderConfig::default()
                },
            );
            let map = rig.exchange(3);
            let sent = [bytes.clone(), vec![*sum]].concat();
            assert_eq!(rig.encoder.replies(), [sent]);
            assert_eq!(rig.encoder.violations(), []);
            assert_eq!(map.single_turn.to_le_bytes()[..3], bytes[2..5]);
            assert_eq!(map.multi_turn.to_le_bytes()[..3], bytes[6..9]);
            let fields = [map.status, map.encoder_id, map.alarm, map.crc];
            assert_eq!(fields, [bytes[1], bytes[5], bytes[9], *sum]);
            assert!(map.fresh && map.repeats && !map.alarmed && !map.busy);
            // The logged encoder has an empty battery.
            assert_eq!(map.cause, cause::MULTI_TURN_ALARM);
        }
    }
}

/// The same encoder, with requests for its single-turn position only.
#[test]
fn logged_single_turn_replies_of_a_real_encoder_arrive() {
    let logged = vectors();
    let replies = logged.iter().filter(|(bytes, _)| bytes[0] == 0x02);
    let mut positions = vec![];
    for (bytes, sum) in replies {
        assert_eq!(crc(bytes), *sum);
        for mhz in [20, 60] {
            let config = EncoderConfig {
                single_turn: u32::from_le_bytes([bytes[2], bytes[3], bytes[4], 0]),
                ..EncoderConfig::default()
            };
            let mut rig = Rig::new(mhz, config);
            let map = rig.exchange(0);
            let sent = [bytes.clone(), vec![*sum]].concat();
            assert_eq!(rig.encoder.replies(), [sent]);
            assert_eq!(rig.encoder.violations(), []);
            assert!(map.fresh && map.single_valid && !map.multi_valid);
            assert_eq!((map.status, map.crc), (bytes[1], *sum));
            assert_eq!(map.cause, cause::MULTI_TURN_ALARM);
            positions.push(map.single_turn);
        }
    }
    let published = [
        1_883_572, 7_907_664, 7_267_713, 6_039_153, 3_755_428, 1_522_390, 229_187,
    ];
    assert_eq!(positions, published.map(|p| [p; 2]).concat());
}

#[test]
fn published_eeprom_requests_are_what_the_receiver_sends() {
    let logged = vectors();
    let requests: Vec<Vec<u8>> = (logged.iter())
        .filter(|(bytes, _)| [0x32, 0xEA].contains(&bytes[0]))
        .map(|(bytes, sum)| [bytes.clone(), vec![*sum]].concat())
        .collect();
    assert_eq!(requests.len(), 3);
    let mut rig = Rig::new(20, EncoderConfig::default());
    for request in &requests {
        let data = if request.len() == 4 { request[2] } else { 0xFF };
        let map = rig.memory(request[0] >> 3 & 15, request[1], data);
        assert_eq!(map.cause, cause::NONE);
        rig.wait_us(6_000);
        assert!(map.memory == data || request.len() == 3);
    }
    assert_eq!(rig.encoder.requests(), requests);
    assert_eq!(rig.encoder.violations(), []);
    assert_eq!((rig.map().memory, rig.encoder.eeprom(1, 1)), (0x5A, 0x5A));
}

#[test]
fn every_request_brings_its_fields_and_leaves_the_others() {
    for mhz in [20, 60] {
        let config = EncoderConfig {
            single_turn: 0x12_3456,
            multi_turn: 0x65_4321,
            status: 0x03,
            alarm: 0xA5,
            ..EncoderConfig::default()
        };
        let mut rig = Rig::new(mhz, config);
        assert!(!rig.map().single_valid && !rig.map().multi_valid);
        for request in Request::ALL {
            if request == Request::ReadEeprom {
                // Still busy from the write.
                let busy = rig.memory(0xD, 9, 0);
                assert_eq!((busy.cause, busy.fresh), (cause::EEPROM_BUSY, false));
                rig.wait_us(6_000);
            }
            let map = rig.memory(request.id(), 9, 0x77);
            assert_eq!(map.request_id, u16::from(request.id()));
            assert_eq!((map.reply_id, map.repeats), (request.id(), true));
            assert_eq!(
                (map.cause, map.communication),
                (cause::NONE, 0),
                "{request:?}"
            );
            assert!(map.fresh && map.single_valid);
            assert_eq!(map.single_turn, 0x12_3456);
            let after = |first: Request| request.id() >= first.id();
            let turns = if after(Request::MultiTurn) {
                0x65_4321
            } else {
                0
            };
            assert_eq!((map.multi_turn, map.multi_valid), (turns, turns != 0));
            let kind = if after(Request::EncoderId) { 0x17 } else { 0 };
            assert_eq!(map.encoder_id, kind);
            let alarm = if after(Request::Everything) { 0xA5 } else { 0 };
            assert_eq!(map.alarm, alarm);
            let data = if after(Request::WriteEeprom) { 0x77 } else { 0 };
            assert_eq!(map.memory, data);
            let memory = request.reply().len() == 4 && request != Request::EncoderId;
            assert_eq!(map.status, if memory { 0 } else { 3 });
        }
        assert_eq!(rig.encoder.violations(), []);
        // Ten in a row reset: nine have no effect.
        (0..8).for_each(|_| assert!(rig.exchange(8).fresh));
        assert_eq!(rig.exchange(8).single_turn, 0x12_3456);
        assert_eq!(rig.exchange(8).single_turn, 0);
    }
}
