//! Sequence, age, time stamp, delay and recovery time of a position.

use super::rig::*;
use endat_hdl::endat::{channel, transaction::cause};
use endat_hdl::protocol::ModeCommand::SendPositionAddInfo;
use endat_sim::{encoder::Defect, Time, NS, US};
use rtl_design::engine::{Compiled, Engine};

/// Cycles of a span, to the nearest.
fn cycles(span: Time, system_hz: u64) -> u64 {
    ((u128::from(span) * u128::from(system_hz) + 500_000_000_000) / 1_000_000_000_000) as u64
}

#[test]
fn before_the_first_frame_there_is_no_position() {
    let mut rig = Setup::card().defect(0, Defect::CrcXor(1)).fresh();
    let fields = ["position_valid", "fresh", "sequence", "position", "cause"];
    assert_eq!(fields.map(|f| rig.get(f)), [0; 5]);
    let result = any_frame(&mut rig);
    assert_eq!(
        (result.cause, result.position_valid, result.fresh),
        (cause::CRC, false, false)
    );
    assert_eq!((result.sequence, result.position), (1, 0));
    let result = good_frame(&mut rig);
    assert_eq!((result.sequence, result.position_valid), (2, true));
}

#[test]
fn the_time_stamp_is_of_the_first_falling_edge_whatever_the_rate() {
    for rates in RATES {
        let setup = Setup::new(rates, SendPositionAddInfo, 5, 1.0);
        let mut rig = setup.ready();
        rig.watch("endat_clk");
        for wait in [0, 1, 17, 333] {
            settle(&mut rig);
            rig.run_cycles(wait);
            let quiet = rig.watched()[0].changes().len();
            let result = good_frame(&mut rig);
            let first_fall = rig.watched()[0].changes()[quiet];
            assert_eq!(first_fall.1, 0);
            assert_eq!(
                result.first_fall_timestamp + channel::TIMESTAMP_TO_FIRST_FALL_CYCLES,
                cycles(first_fall.0, rates.0)
            );
        }
    }
}

#[test]
fn the_age_counts_microseconds_through_bad_frames_and_stops_at_its_end() {
    let mut rig = Setup::card().defect(1, Defect::CrcXor(1)).ready();
    let good = good_frame(&mut rig);
    assert_eq!(good.age_us, 0);
    // Counted from the end of the frame, 0 until then.
    settle(&mut rig);
    let end = rig.now() / US - good.time / US;
    for us in [1, 10, 100].map(|us| us + end) {
        rig.run_until(good.time + us * US);
        let age = rig.get("age_us") as u64;
        assert!((us - end - 1..=us).contains(&age), "{age} after {us} us");
    }
    let bad = any_frame(&mut rig);
    assert_eq!(bad.cause, cause::CRC);
    let us = (bad.time - good.time) / US;
    assert!(
        (us - end - 1..=us).contains(&bad.age_us),
        "{} after {us} us",
        bad.age_us
    );
    assert_eq!(good_frame(&mut rig).age_us, 0);
    // A tick in every second cycle, for speed.
    let engine = rig.engine();
    let [tick_us, age] = ["tick_us", "age_us"].map(|n| engine.port(n));
    let run = |engine: &mut Compiled, ticks: u32| {
        for _ in 0..ticks {
            for level in [1, 0] {
                engine.set(tick_us, level);
                engine.tick();
            }
        }
    };
    run(engine, 65_534);
    assert!((65_534..=65_535).contains(&engine.get(age)));
    run(engine, 1000);
    assert_eq!(engine.get(age), 65_535);
}

#[test]
fn the_recovery_time_is_measured_to_two_cycles() {
    let fast = [(100_000_000, 12_500_000), (128_000_000, 16_000_000)];
    let usual = [CARD, fast[0], fast[1]].map(|rates| (rates, 29, 20.0));
    // All pulses are sent before the start bit returns: CLOCK waits LOW for the answer.
    let held = fast.map(|rates| (rates, 1, 150.0));
    for (rates, position_bits, cable_m) in usual.into_iter().chain(held) {
        for tm in [
            1_250 * NS,
            1_777 * NS,
            3_750 * NS,
            10 * US,
            21_140 * NS,
            30 * US,
        ] {
            let mut setup = Setup::new(rates, SendPositionAddInfo, position_bits, cable_m);
            setup.encoder.tm = tm..=tm;
            // Includes the calibrating frame, which has another clock.
            let mut rig = setup.fresh();
            for _ in 0..2 {
                good_frame(&mut rig);
                settle(&mut rig);
                // DATA rises slightly after the last clock edge, and falls at the end of tm.
                let want = cycles(tm - setup.encoder.clock_to_data, rates.0);
                let got = rig.get("recovery_cycles") as u64;
                assert!(
                    got.abs_diff(want) <= 2,
                    "{got}, not {want}: {tm} ps, {rates:?}, {cable_m} m"
                );
            }
            assert_sound(&setup, &rig);
        }
    }
}

#[test]
fn the_delay_is_that_of_transceivers_cable_and_encoder() {
    for system_hz in [100_000_000, 128_000_000] {
        for cable_m in [0.0, 0.3, 1.0, 7.7, 20.0, 51.0, 100.0, 150.0] {
            let setup = Setup::new((system_hz, 2_000_000), SendPositionAddInfo, 13, cable_m);
            let mut rig = setup.fresh();
            good_frame(&mut rig);
            let line = setup.line.round_trip() + setup.encoder.clock_to_data;
            let first = rig.get("delay_cycles") as u64;
            let want = cycles(line, system_hz) + channel::DELAY_OFFSET_CYCLES;
            assert!(
                first.abs_diff(want) <= 1,
                "{first}, not {want}: {cable_m} m"
            );
            for _ in 0..4 {
                good_frame(&mut rig);
                let now = rig.get("delay_cycles") as u64;
                assert!(now.abs_diff(want) <= 1, "{now}, not {want}: {cable_m} m");
            }
        }
    }
}

#[test]
fn the_delay_follows_a_cable_that_changes_by_one_cycle_in_each_frame() {
    let setup = Setup::new(CARD, SendPositionAddInfo, 29, 20.0);
    let measured = setup.measured();
    for cable_m in [16.0f64, 24.0] {
        let mut moved = setup.clone();
        moved.line.cable_m = cable_m;
        let mut rig = moved.on(measured.clone());
        let start = rig.get("delay_cycles") as i64;
        let want = start + ((cable_m - 20.0) * 2.0 * 6.0 / 10.0) as i64; // 4.8 cycles
        let mut last = start;
        for _ in 0..8 {
            good_frame(&mut rig);
            settle(&mut rig);
            let now = rig.get("delay_cycles") as i64;
            assert!((now - last).abs() <= 1, "{last} to {now}");
            last = now;
        }
        assert!((last - want).abs() <= 1, "{start} to {last}, not {want}");
        assert_sound(&moved, &rig);
    }
}

#[test]
fn calibrate_measures_the_delay_with_the_next_frame() {
    let setup = Setup::card();
    let mut rig = setup.ready();
    rig.run_for(US);
    rig.set("calibrate", 1);
    rig.tick();
    rig.set("calibrate", 0);
    good_frame(&mut rig);
    good_frame(&mut rig);
    settle(&mut rig);
    assert_sound(&setup, &rig);
    let periods: Vec<Time> = rig.frames(0).iter().map(|f| f.period).collect();
    assert_eq!(periods, [5 * US, 320 * NS, 320 * NS]);
}
