//! Each fault has its cause, affects no position and hangs nothing.

use super::rig::{Map, Rig};
use endat_hdl::protocols::t_format::{cause, protocol::Request};
use endat_sim::t_format::{Defect, EncoderConfig};

fn config(defect: Defect) -> EncoderConfig {
    EncoderConfig {
        single_turn: 0x11_1111,
        multi_turn: 0x22_2222,
        status: 0,
        defect,
        ..EncoderConfig::default()
    }
}

/// A good exchange, one with the defect while the position changes, and a good one again.
fn around(mhz: u64, id: u8, defect: Defect) -> Map {
    let mut rig = Rig::new(mhz, config(Defect::None));
    assert!(rig.exchange(3).fresh);
    rig.encoder.config.single_turn = 0x33_3333;
    rig.encoder.config.multi_turn = 0x44_4444;
    rig.encoder.config.defect = defect;
    let bad = rig.exchange(id);
    rig.encoder.config.defect = Defect::None;
    // A line that was stuck must be idle first.
    rig.wait_us(20);
    let good = rig.exchange(3);
    assert_eq!(
        (good.cause, good.single_turn),
        (cause::NONE, 0x33_3333),
        "{defect:?}"
    );
    assert!(good.fresh && good.repeats && good.communication == 0);
    assert_eq!(rig.encoder.violations(), []);
    bad
}

const US: u64 = 1_000_000;

#[test]
fn every_cause_is_told_and_the_position_held() {
    let rows = [
        (Defect::Silent, cause::NO_ANSWER, 1 << 0),
        (Defect::StuckLow, cause::LINE_NOT_IDLE, 0),
        // Bits of the sync code, so no header.
        (Defect::Flip { field: 0, bit: 0 }, cause::HEADER, 1 << 1),
        (Defect::Flip { field: 0, bit: 1 }, cause::HEADER, 1 << 1),
        (Defect::Flip { field: 0, bit: 2 }, cause::HEADER, 1 << 1),
        (
            Defect::Flip { field: 0, bit: 7 },
            cause::CONTROL_PARITY,
            1 << 4 | 1 << 6,
        ),
        (
            Defect::Flip { field: 0, bit: 4 },
            cause::CONTROL_PARITY,
            1 << 4 | 1 << 5 | 1 << 6,
        ),
        // Same length as the right one.
        (Defect::OtherId(12), cause::ECHO, 1 << 5),
        (Defect::Delimiter { field: 0 }, cause::DELIMITER, 1 << 3),
        (Defect::Delimiter { field: 5 }, cause::DELIMITER, 1 << 3),
        (Defect::Short { fields: 1 }, cause::FIELD_TIMEOUT, 1 << 2),
        (Defect::Short { fields: 5 }, cause::FIELD_TIMEOUT, 1 << 2),
        (
            Defect::Pause {
                field: 3,
                length: 6 * US,
            },
            cause::FIELD_TIMEOUT,
            1 << 2,
        ),
        (Defect::Flip { field: 2, bit: 0 }, cause::CRC, 1 << 6),
        (Defect::Flip { field: 5, bit: 7 }, cause::CRC, 1 << 6),
        (Defect::Status(0x40), cause::REQUEST_PARITY, 1 << 7),
        (Defect::Status(0x80), cause::REQUEST_DELIMITER, 1 << 7),
    ];
    for mhz in [20, 60] {
        for (defect, expected, communication) in rows {
            let bad = around(mhz, 0, defect);
            let what = format!("{mhz} MHz, {defect:?}: {bad:?}");
            assert_eq!(cause::name(bad.cause), cause::name(expected), "{what}");
            assert_eq!(bad.communication, communication, "{what}");
            assert_eq!(bad.alarmed, communication != 0, "{what}");
            assert!(!bad.fresh, "{what}");
            assert_eq!(
                (bad.single_turn, bad.multi_turn),
                (0x11_1111, 0x22_2222),
                "{what}"
            );
            assert!(bad.single_valid && bad.multi_valid, "{what}");
        }
    }
}

#[test]
fn alarms_of_the_encoder_come_with_its_position() {
    for (status, expected) in [
        (0x10, cause::COUNTING_ERROR),
        (0x20, cause::MULTI_TURN_ALARM),
        (0x30, cause::COUNTING_ERROR),
    ] {
        let map = around(20, 0, Defect::Status(status));
        assert_eq!((map.cause, map.status), (expected, status));
        assert!(map.fresh && !map.alarmed);
        assert_eq!(map.single_turn, 0x33_3333);
    }
}

#[test]
fn any_single_wrong_bit_of_any_reply_is_seen() {
    for request in Request::ALL {
        let config = EncoderConfig {
            write_time: 50 * US,
            ..config(Defect::None)
        };
        let mut rig = Rig::new(20, config);
        rig.memory(request.id(), 5, 0x5A);
        for field in 0..request.reply().len() {
            for bit in 0..8 {
                rig.wait_us(100);
                rig.encoder.config.defect = Defect::Flip { field, bit };
                let bad = rig.memory(request.id(), 5, 0x5A);
                assert!(!bad.fresh, "{request:?} {field} {bit} {bad:?}");
            }
        }
        rig.encoder.config.defect = Defect::None;
        rig.wait_us(100);
        assert!(rig.memory(request.id(), 5, 0x5A).fresh, "{request:?}");
    }
}

#[test]
fn a_short_pulse_before_the_reply_is_passed_over() {
    for mhz in [20, 60] {
        for width in [60_000, 250_000, 400_000, 500_000] {
            let ahead = 2 * US;
            let map = around(mhz, 0, Defect::Pulse { ahead, width });
            assert!(map.fresh, "{mhz} MHz, {width} ps: {map:?}");
        }
        let (ahead, width) = (2 * US, 1_200_000);
        let map = around(mhz, 0, Defect::Pulse { ahead, width });
        assert_eq!(map.cause, cause::HEADER);
    }
}

#[test]
fn a_reply_is_taken_up_to_the_gap_that_is_set_and_refused_after_its_grace() {
    for mhz in [20, 60] {
        for set in [1, 2, 3, 4, 7, 13, 20, 40, 63] {
            let mut rig = Rig::new(mhz, config(Defect::None));
            rig.set_gap(set);
            for gap in [
                US * 3 / 10,
                US,
                28 * US / 10,
                38 * US / 10,
                set * US,
                set * US + 3 * US,
            ] {
                rig.encoder.config.reply_gap = gap;
                let map = rig.exchange(3);
                let what = format!("{mhz} MHz, set {set} us, reply after {gap} ps");
                if gap <= set * US {
                    assert!(map.fresh, "{what}: {map:?}");
                } else if gap >= (set + 3) * US {
                    assert_eq!(map.cause, cause::NO_ANSWER, "{what}");
                }
                // A late reply comes now; no request is sent during it.
                rig.wait_us(gap / US + 100);
            }
            assert_eq!(rig.encoder.violations(), []);
        }
    }
}

#[test]
fn fields_may_be_apart_by_the_gap_that_is_set() {
    for (length, good) in [
        (0, true),
        (US, true),
        (2 * US, true),
        (5 * US + US / 2, false),
    ] {
        let map = around(20, 3, Defect::Pause { field: 4, length });
        assert_eq!(map.fresh, good, "{length} {map:?}");
    }
}

#[test]
fn unknown_requests_are_refused_and_nothing_goes_out() {
    let mut rig = Rig::new(20, config(Defect::None));
    for id in [4, 5, 9, 0xA, 0xB, 0xE, 0xF] {
        let map = rig.exchange(id);
        assert_eq!(map.cause, cause::UNKNOWN_REQUEST);
        assert!(!map.fresh && !map.repeats);
    }
    assert_eq!(rig.encoder.requests().len(), 0);
    assert!(rig.exchange(0).fresh);
}

#[test]
fn a_trigger_in_an_exchange_is_told_and_its_position_taken() {
    let mut rig = Rig::new(20, config(Defect::None));
    rig.write(0, 3);
    rig.wait_us(10);
    rig.pins.trigger = true;
    rig.wait_us(1);
    rig.pins.trigger = false;
    let map = rig.finish();
    assert_eq!(map.cause, cause::NONE);
    assert!(map.overrun && map.fresh && map.single_turn == 0x11_1111);
    // The pin sends the last request again.
    rig.wait_us(20);
    rig.pins.trigger = true;
    rig.wait_us(1);
    rig.pins.trigger = false;
    let map = rig.finish();
    assert!(!map.overrun && map.cause == cause::NONE);
    assert_eq!(rig.encoder.replies().len(), 2);
    assert_eq!(rig.encoder.violations(), []);
}

#[test]
fn the_trigger_pin_and_a_second_write_of_address_0_write_no_byte_again() {
    let mut rig = Rig::new(20, config(Defect::None));
    assert!(rig.memory(6, 5, 0x5A).fresh);
    rig.wait_us(6_000);
    rig.pins.trigger = true;
    rig.wait_us(1);
    rig.pins.trigger = false;
    let map = rig.finish();
    assert_eq!((map.cause, map.fresh), (cause::UNKNOWN_REQUEST, false));
    assert_eq!(rig.exchange(6).cause, cause::UNKNOWN_REQUEST);
    assert_eq!(rig.encoder.requests().len(), 1);
    assert!(rig.memory(6, 5, 0xA5).fresh);
    assert_eq!(rig.encoder.eeprom(0, 5), 0xA5);
    assert_eq!(rig.encoder.violations(), []);
}

#[test]
fn nobody_on_the_line_gives_a_result_for_every_request() {
    let mut rig = Rig::new(60, config(Defect::None));
    rig.unplugged = true;
    for _ in 0..5 {
        assert_eq!(rig.exchange(3).cause, cause::NO_ANSWER);
    }
    rig.unplugged = false;
    rig.wait_us(100);
    assert!(rig.exchange(3).fresh);
}

#[test]
fn after_a_fault_the_next_request_waits_for_an_idle_line() {
    // Another, longer reply is still on the line when the fault is detected.
    let mut rig = Rig::new(20, config(Defect::Delimiter { field: 1 }));
    rig.write(0, 3);
    let map = rig.finish();
    assert_eq!(map.cause, cause::DELIMITER);
    rig.write(0, 3);
    assert_eq!(rig.finish().cause, cause::LINE_NOT_IDLE);
    rig.encoder.config.defect = Defect::None;
    rig.wait_us(70);
    assert!(rig.exchange(3).fresh);
    assert_eq!(rig.encoder.violations(), []);
}
