//! Continuous clock: consecutive positions without a command, and its ends.

use super::rig::Rig;
use endat_hdl::endat::{channel::TIMESTAMP_TO_FIRST_FALL_CYCLES, transaction::cause};
use endat_hdl::protocol::ModeCommand::*;
use endat_sim::{
    bench::ChannelSettings,
    encoder::{Defect, EncoderConfig, FrameEnd, LatchEdge, PositionSource},
    line::{Jitter, LineConfig},
    Time, MS, NS, US,
};

const SYSTEM_HZ: u64 = 100_000_000;
/// Frames of the encoder before that of the first result.
const MEASURING: usize = 1;
const EDGES: [LatchEdge; 2] = [LatchEdge::InHigh, LatchEdge::AfterLow];

fn encoder(position_bits: u32, edge: LatchEdge) -> EncoderConfig {
    EncoderConfig::endat22(position_bits)
        .continuous(edge)
        .position(PositionSource::Ramp {
            start: 0x1234,
            step: 0x0111_1357,
        })
}

/// After the frame that measures the delay, and the first position.
fn rig(endat_hz: u64, encoder: EncoderConfig, line: LineConfig) -> Rig {
    let settings = ChannelSettings::new(SYSTEM_HZ, endat_hz, SendPosition, encoder.position_bits);
    let mut rig = Rig::with(SYSTEM_HZ, settings, encoder, line);
    assert_eq!(rig.position().cause, cause::NONE);
    rig.bench.set("continuous", 1);
    rig
}

/// Triggers once, and runs until `frames` more results have arrived.
fn run(rig: &mut Rig, frames: usize) {
    let results = rig.bench.results().len() + frames;
    rig.bench.trigger();
    more(rig, results);
}

fn more(rig: &mut Rig, results: usize) {
    assert!(rig
        .bench
        .run_until_done(50 * MS, |b| b.results().len() >= results));
}

fn leave(rig: &mut Rig) {
    rig.bench.set("continuous", 0);
    assert!(rig.bench.run_until_done(5 * MS, |b| b.get("busy") == 0));
}

/// Every result has the position of its frame, and the time when the encoder latched it.
fn assert_right(rig: &Rig, endat_hz: u64) {
    let flight = rig.bench.link(0).line().config();
    let flight = flight.flight() + flight.clock.transceivers;
    let frames = &rig.bench.frames(0)[MEASURING..];
    for (result, frame) in rig.bench.results().iter().zip(frames) {
        assert_eq!(result.last_cause(), cause::NONE, "{result:?}");
        assert!(
            result.fresh && result.position == frame.position,
            "{result:?} {frame:?}"
        );
        assert_eq!(frame.end, FrameEnd::Complete);
        let stamp = result.first_fall_timestamp + TIMESTAMP_TO_FIRST_FALL_CYCLES;
        // The sources differ in the edge; the time stamp uses the later one.
        let early = match rig.bench.link(0).encoder().config().continuous {
            Some(LatchEdge::InHigh) if frame.continuous => 1_000_000_000_000 / endat_hz,
            _ => 0,
        };
        let taken = frame.first_fall + early - flight;
        let stamped = stamp * 10 * NS;
        assert!(
            taken.abs_diff(stamped) <= 60 * NS,
            "{taken} {stamped} {frame:?}"
        );
    }
}

fn positions_flow(widths: &[u32]) {
    for (endat_hz, cable_m) in [
        (200_000, 0.0),
        (1_000_000, 100.0),
        (2_000_000, 100.0),
        (12_500_000, 100.0),
    ] {
        for &bits in widths {
            for edge in EDGES {
                let mut rig = rig(endat_hz, encoder(bits, edge), LineConfig::cable(cable_m));
                run(&mut rig, 6);
                leave(&mut rig);
                assert_right(&rig, endat_hz);
                assert!(rig.bench.results().len() >= 7);
                assert!(rig.bench.frames(0)[MEASURING + 2..][..5]
                    .iter()
                    .all(|f| f.continuous));
                let over = rig.position();
                assert_eq!(over.cause, cause::NONE, "{endat_hz} {bits} {edge:?}");
                rig.assert_clean();
            }
        }
    }
}

#[test]
fn positions_flow_at_every_rate_and_length() {
    positions_flow(&[1, 48]);
}

#[test]
#[ignore = "slow: seven widths"]
fn positions_flow_at_every_width_rate_and_length() {
    positions_flow(&[1, 3, 13, 18, 29, 33, 48]);
}

#[test]
fn triggers_neither_disturb_a_run_nor_count_as_lost() {
    let mut rig = rig(
        2_000_000,
        encoder(29, LatchEdge::AfterLow),
        LineConfig::cable(10.0),
    );
    rig.bench.trigger();
    for _ in 0..200 {
        rig.bench.run_for(3_700 * NS);
        rig.bench.trigger();
        assert_eq!(rig.bench.get("displaced"), 0);
    }
    let results = rig.bench.results().len();
    assert!(results > 25, "{results}");
    leave(&mut rig);
    assert_right(&rig, 2_000_000);
    rig.assert_clean();
}

/// The run ends at any time; the next frame is good.
fn left_every(step_ns: usize) {
    for edge in EDGES {
        for wait in (0..40_000).step_by(step_ns) {
            let mut rig = rig(2_000_000, encoder(13, edge), LineConfig::cable(50.0));
            run(&mut rig, 2);
            rig.bench.run_for(wait * NS);
            leave(&mut rig);
            assert_eq!(rig.position().cause, cause::NONE);
            rig.assert_clean();
        }
    }
}

#[test]
fn a_run_is_left_at_moments_of_a_frame() {
    left_every(4_250);
}

#[test]
#[ignore = "slow: every half clock period of a frame"]
fn a_run_is_left_at_every_moment() {
    left_every(250);
}

/// A run ends without a recovery time; that of the frame before the run is not compared with the limit.
#[test]
fn run_that_is_left_reports_no_recovery_time_of_an_earlier_frame() {
    let mut rig = rig(
        2_000_000,
        encoder(29, LatchEdge::AfterLow),
        LineConfig::cable(10.0),
    );
    // Longer than any tm of this encoder.
    let earlier = rig.bench.get("recovery_cycles");
    rig.bench.set("recovery_min_cycles", 8_000);
    assert!((1..8_000).contains(&earlier), "{earlier}");
    run(&mut rig, 3);
    leave(&mut rig);
    let causes: Vec<u64> = rig.bench.results().iter().map(|r| r.last_cause()).collect();
    assert_eq!(causes, vec![cause::NONE; causes.len()]);
    // The limit applies to a frame with a recovery time.
    assert_eq!(rig.position().cause, cause::RECOVERY_TOO_SHORT);
}

#[test]
fn a_request_takes_the_line_and_the_next_trigger_goes_on() {
    let mut rig = rig(
        2_000_000,
        encoder(29, LatchEdge::AfterLow),
        LineConfig::cable(10.0),
    );
    run(&mut rig, 5);
    rig.bench.set("request_command", SelectMemory.code().into());
    rig.bench.set("request_parameter", 0xA1_0000);
    rig.strobe("request_own");
    let done =
        |b: &mut endat_sim::bench::Bench<_>| b.get("over") == 1 && b.get("over_request") == 1;
    assert!(rig.bench.run_until_done(20 * MS, done));
    assert_eq!(rig.bench.get("over_cause"), 0);
    assert_eq!(rig.last_frame().command, Some(SelectMemory.code()));
    assert!(rig.bench.run_until_done(MS, |b| b.get("busy") == 0));
    rig.bench.run_for(13 * MS);
    run(&mut rig, 5);
    assert!(rig.last_frame().continuous);
    leave(&mut rig);
    rig.assert_clean();
}

#[test]
fn after_an_error_it_goes_on_or_stops_as_configured() {
    for (defect, expected) in [
        (Defect::CrcXor(0b10), cause::CRC),
        (Defect::ErrorBits { f1: true, f2: true }, cause::F1),
    ] {
        for stop in [0, 1] {
            let encoder =
                encoder(29, LatchEdge::AfterLow).defect(MEASURING as u64 + 3, defect.clone());
            let mut rig = rig(2_000_000, encoder, LineConfig::cable(10.0));
            rig.bench.set("stop_at_error", stop);
            run(&mut rig, 3);
            let causes: Vec<u64> = rig.bench.results().iter().map(|r| r.last_cause()).collect();
            assert_eq!(causes, [0, 0, 0, expected]);
            rig.bench.run_for(MS);
            let results = rig.bench.results().len();
            assert_eq!(results == 4, stop == 1, "{results}");
            run(&mut rig, 2);
            let last = rig.bench.results().last().unwrap();
            assert_eq!((last.cause, last.fresh), (cause::NONE, true));
            leave(&mut rig);
            rig.assert_clean();
        }
    }
}

/// Any number of consecutive errors: only `stop_at_error` ends a run.
#[test]
fn errors_in_a_row_end_a_run_only_if_it_stops_at_errors() {
    for frames in [3..=4, 3..=5, 3..=12] {
        for stop in [0, 1] {
            let encoder = encoder(29, LatchEdge::AfterLow);
            let first = MEASURING as u64;
            let (from, to) = (first + frames.start(), first + frames.end());
            let encoder = encoder.defects(from..=to, Defect::CrcXor(0b10));
            let mut rig = rig(2_000_000, encoder, LineConfig::cable(10.0));
            rig.bench.set("stop_at_error", stop);
            rig.bench.trigger();
            rig.bench.run_for(MS);
            let causes: Vec<u64> = rig.bench.results().iter().map(|r| r.last_cause()).collect();
            assert_eq!(causes.len() == 4, stop == 1, "{frames:?} {causes:?}");
            for (n, found) in causes.iter().enumerate() {
                let wrong = frames.contains(&(n as u64));
                let expected = if wrong { cause::CRC } else { cause::NONE };
                assert_eq!(*found, expected, "{n} {causes:?}");
            }
            if stop == 0 {
                assert!(causes.len() > 30, "{frames:?} {causes:?}");
                assert!(rig.last_frame().continuous, "{:?}", rig.last_frame());
            }
            leave(&mut rig);
            rig.assert_clean();
        }
    }
}

#[test]
fn what_cannot_go_on_is_flagged_and_the_next_trigger_works() {
    for (defect, expected) in [
        (Defect::NoStartBit, cause::NO_START_BIT),
        (Defect::Open, cause::DATA_NOT_FALLING),
        // The cells between two answers show that the encoder has another width.
        (Defect::WiderBy(15), cause::DATA_NOT_FALLING),
    ] {
        let encoder = encoder(29, LatchEdge::AfterLow)
            .position(PositionSource::Fixed(0))
            .defect(MEASURING as u64 + 3, defect.clone());
        let mut rig = rig(2_000_000, encoder, LineConfig::cable(10.0));
        rig.bench.trigger();
        let bad =
            |b: &mut endat_sim::bench::Bench<_>| b.results().iter().any(|r| r.last_cause() != 0);
        assert!(rig.bench.run_until_done(5 * MS, bad), "{defect:?}");
        assert!(rig.bench.run_until_done(5 * MS, |b| b.get("busy") == 0));
        let last = rig.bench.results().last().unwrap().clone();
        let causes = [expected, cause::CRC];
        assert!(causes.contains(&last.last_cause()), "{defect:?} {last:?}");
        // The last good position remains.
        assert_eq!(
            [rig.bench.get("position_valid"), rig.bench.get("fresh")],
            [1, 0]
        );
        // The delay is measured again, and the run continues.
        run(&mut rig, 3);
        assert!(rig.last_frame().continuous, "{defect:?}");
        let last = rig.bench.results().last().unwrap();
        assert_eq!((last.cause, last.fresh), (cause::NONE, true), "{defect:?}");
        leave(&mut rig);
    }
}

/// An encoder without this mode stays HIGH for tm: the second cell shows it, and its position is good.
#[test]
fn an_encoder_without_the_mode_is_noticed() {
    let mut rig = rig(
        2_000_000,
        EncoderConfig::endat22(29),
        LineConfig::cable(10.0),
    );
    rig.position();
    let result = rig.bench.results().last().unwrap().clone();
    assert_eq!(result.late_cause, Some(cause::DATA_NOT_FALLING));
    assert!(result.fresh && result.position == rig.last_frame().position);
    assert_eq!(rig.bench.get("position_valid"), 1);
}

#[test]
fn the_sampling_point_follows_a_drifting_delay_through_a_run() {
    // One microsecond, two bits, in 400 frames.
    for drift in [100, -20] {
        let mut line = LineConfig::cable(100.0);
        line.data_in.jitter = Jitter::Uniform(40 * NS);
        line.data_in.drift = drift;
        let mut rig = rig(2_000_000, encoder(29, LatchEdge::AfterLow), line);
        run(&mut rig, 400);
        leave(&mut rig);
        let bad = rig.bench.results().iter().filter(|r| r.last_cause() != 0);
        assert_eq!(bad.count(), 0, "{drift}");
        rig.assert_clean();
    }
}

/// Without the command and the recovery time a position takes the answer, tcal, and two clocks.
#[test]
fn a_position_takes_its_answer_its_calculation_and_two_clocks() {
    let mut encoder = encoder(29, LatchEdge::AfterLow);
    encoder.tcal = 5 * US;
    let mut rig = rig(2_000_000, encoder, LineConfig::cable(10.0));
    run(&mut rig, 3);
    let times: Vec<Time> = rig.bench.results().iter().map(|r| r.time).collect();
    let period = times[3] - times[2];
    let answer = (1 + 1 + 29 + 5) * 500 * NS;
    let least = answer + 5 * US + 1_000 * NS;
    assert!((least..least + 2 * 500 * NS).contains(&period), "{period}");
}
