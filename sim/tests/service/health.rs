//! Slots, position 2, counters, threshold, forced errors.

use super::rig::{hasty, quick, Make, Rig, ENDAT_HZ};
use endat_hdl::endat::{
    service::map::{control, info_status, state, word, COUNTER_BAD_INFOS, COUNTER_POSITION_2},
    transaction::cause,
};
use endat_hdl::protocol::ModeCommand::*;
use endat_sim::{
    encoder::{Defect, EncoderConfig, PositionSource},
    MS,
};

fn encoder() -> EncoderConfig {
    let mut encoder = quick(EncoderConfig::endat22(25));
    encoder.values.position_2_offset = 1_000;
    encoder.position(PositionSource::Ramp {
        start: 0x1FF_FC00,
        step: 100,
    })
}

/// Selects these codes in turn.
fn list(rig: &mut Rig, codes: &[u8]) {
    for (i, code) in codes.iter().enumerate() {
        rig.write(word::LIST + i as u8, u32::from(*code));
    }
    rig.write(word::LIST_LENGTH, codes.len() as u32);
}

#[test]
fn every_code_of_the_list_has_its_slot_and_age() {
    let mut rig = Rig::new(false, encoder(), 25);
    rig.good_position();
    list(&mut rig, &[0x4C, 0x4D, 0x5B]);
    rig.frames(12);
    let sequence = rig.bench.get("sequence") as u32;
    let slot = |rig: &mut Rig, i| rig.read(word::SLOTS + i);
    assert_eq!(slot(&mut rig, 0) & 0xFFFF, 2954);
    assert_eq!(slot(&mut rig, 1) & 0xFFFF, 2982);
    for i in 0..3 {
        let age = sequence - (slot(&mut rig, i) >> 16);
        assert!(age < 3, "slot {i} is {age} frames old");
    }
    let fresh = rig.bench.results().iter().all(|r| r.cause == 0 && r.fresh);
    assert!(fresh, "no position is affected");
    // Requests of the host come in between.
    rig.good(PositionSelectMemory, 0xA1, 0);
    rig.frames(8);
    assert!(rig.bench.get("sequence") as u32 - (slot(&mut rig, 2) >> 16) < 3);
    // A list of one: selected once, no supplement after that.
    list(&mut rig, &[0x4D]);
    rig.frames(6);
    let last = rig.bench.frames(0).last().unwrap().clone();
    assert_eq!(last.command, Some(SendPositionAddInfo.code()));
    assert_eq!(slot(&mut rig, 0) & 0xFFFF, 2982);
    rig.assert_clean();
}

#[test]
fn the_configured_additional_data_are_selected_from_the_start_on_and_after_a_plug() {
    let mut encoder = hasty(encoder());
    encoder.unplugged.push(50 * MS..60 * MS);
    let make = Make {
        infos: [0x4C, 0x5B, 0, 0, 0, 0, 0, 0],
        ..Make::hasty()
    };
    let mut rig = Rig::with(make, ENDAT_HZ, encoder, 25);
    assert_eq!(rig.initialised(), 0);
    assert_eq!(rig.read(word::LIST_LENGTH), 2);
    let selected = |rig: &mut Rig| {
        rig.frames(6);
        assert_eq!(rig.read(word::SLOTS) & 0xFFFF, 2954);
        rig.bench.frames(0).last().unwrap().infos.len()
    };
    assert_eq!(selected(&mut rig), 2);
    assert!(rig.bench.now() < 50 * MS);
    rig.bench.run_until(50 * MS);
    assert_eq!(rig.initialised(), 0);
    assert_eq!(selected(&mut rig), 2);
}

#[test]
fn position_2_is_compared_over_the_wrap() {
    let mut rig = Rig::new(false, encoder(), 25);
    rig.good_position();
    rig.write(word::OFFSET[0], 1_003);
    rig.write(word::TOLERANCE, 2);
    list(&mut rig, &[0x42, 0x43, 0x44]);
    rig.frames(40);
    let counts = rig.read(word::COMPARISONS);
    assert!(counts & 0xFFFF >= 10, "{counts:#x}");
    assert_eq!(counts >> 16, counts & 0xFFFF, "3 steps away from 2");
    let difference = u64::from(rig.read(word::DIFFERENCE[0]));
    assert_eq!(difference, (1 << 25) - 3, "modulo the width");
    assert!(rig.state() & state::POSITION_2 != 0);
    assert_eq!(rig.bench.get("alarm"), 1);
    assert_eq!(rig.read(word::COUNTERS + COUNTER_POSITION_2), counts >> 16);

    rig.write(word::TOLERANCE, 3);
    rig.write(word::CONTROL, control::CLEAR.into());
    rig.frames(40);
    let counts = rig.read(word::COMPARISONS);
    assert!(counts & 0xFFFF >= 10 && counts >> 16 == 0, "{counts:#x}");
    assert_eq!(rig.state() & state::POSITION_2, 0);
    assert_eq!(rig.bench.get("alarm"), 0);
    rig.write(word::OFFSET[0], 997);
    rig.frames(6);
    assert_eq!(rig.read(word::DIFFERENCE[0]), 3);
    assert_eq!(rig.read(word::COMPARISONS) >> 16, 0);
    rig.assert_clean();
}

#[test]
fn a_wrong_crc_of_additional_data_is_told_and_counted_and_nothing_of_them_is_taken() {
    for (info, half) in [(1u8, 0), (2, 16)] {
        let bad = [11, 12].into_iter();
        let defect = Defect::InfoCrcXor { info, xor: 0b10 };
        let encoder = bad.fold(encoder(), |e, n| e.defect(n, defect.clone()));
        let mut rig = Rig::new(false, encoder, 25);
        rig.good_position();
        list(&mut rig, &[0x4C, 0x5B]);
        rig.frames(6);
        let bit = u32::from(info_status::BAD_CRC) << half;
        let good = rig.read(word::INFO_STATUS);
        assert_eq!(good & 0x0100_0100, 0, "{good:#x}");
        assert_eq!(rig.read(word::COUNTERS + COUNTER_BAD_INFOS), 0);
        let mut told = 0;
        for _ in 0..6 {
            let other = word::SLOTS + u8::from(info == 1);
            let own = word::SLOTS + u8::from(info == 2);
            let before = (rig.read(own), rig.read(other));
            rig.frames(1);
            let status = rig.read(word::INFO_STATUS);
            let is_bad = status & bit != 0;
            assert_eq!(status & 0x0100_0100, if is_bad { bit } else { 0 });
            assert_eq!(status & !bit, good, "the earlier bits remain");
            told += u32::from(is_bad);
            assert_eq!(rig.read(word::COUNTERS + COUNTER_BAD_INFOS), told);
            assert_eq!(
                rig.read(own) == before.0,
                is_bad,
                "its slot is as old as before"
            );
            assert_ne!(rig.read(other), before.1, "the other one is updated");
            assert_eq!(rig.read(word::BAD_FRAMES), 0, "the position is good");
        }
        assert_eq!(told, 2);
        rig.write(word::CONTROL, control::CLEAR.into());
        rig.frames(2);
        assert_eq!(rig.read(word::COUNTERS + COUNTER_BAD_INFOS), 0);
        rig.assert_clean();
    }
}

#[test]
fn causes_are_counted_and_n_of_m_raises_the_alarm() {
    let bad = [4, 6, 7, 13, 14, 15].into_iter();
    let alarm = Defect::ErrorBits { f1: true, f2: true };
    let encoder = bad.fold(encoder(), |e, n| e.defect(n, alarm.clone()));
    let mut rig = Rig::new(false, encoder, 25);
    rig.good_position();
    rig.write(word::THRESHOLD, 4 << 16 | 3);
    rig.frames(5);
    assert_eq!(rig.read(word::BAD_FRAMES), 0b0101 << 16 | 2);
    rig.frames(1);
    assert_eq!(rig.read(word::BAD_FRAMES), 0b1011 << 16 | 3);
    assert!(rig.state() & state::ALARM != 0);
    assert_eq!(rig.bench.get("alarm"), 1);
    rig.write(word::CONTROL, control::CLEAR.into());
    rig.frames(7);
    assert_eq!(rig.state() & state::ALARM, 0, "two of four are too few");
    assert_eq!(rig.read(word::COUNTERS + cause::F1 as u8), 2);
    rig.frames(1);
    assert!(rig.state() & state::ALARM != 0);
    assert_eq!(rig.read(word::COUNTERS + cause::F1 as u8), 3);
    assert_eq!(rig.read(word::COUNTERS), 5);
    assert_eq!(rig.read(word::LOST), 0);
}

#[test]
fn forced_errors_go_the_way_of_true_ones() {
    let mut rig = Rig::new(false, encoder(), 25);
    rig.good_position();
    for (bit, cause) in [(0, cause::F1), (1, cause::F2), (2, cause::CRC)] {
        rig.write(word::FORCE, 1 << bit);
        rig.frames(2);
        let last = rig.bench.results().last().unwrap().clone();
        assert_eq!((last.cause, last.fresh), (cause, false));
        assert_eq!(rig.read(word::COUNTERS + cause as u8), 2);
        rig.write(word::FORCE, 0);
        rig.frames(1);
        rig.good_position();
    }
}
