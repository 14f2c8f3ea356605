//! Faults of a line or an encoder are distinguished, within their limits and at every phase of a frame.

use super::rig::Rig;
use endat_hdl::endat::{
    timing::{recovery_min_cycles, PROBE_US, RECOVERY_MIN_NS, SETTLE_US},
    transaction::cause::{self, flag},
};
use endat_hdl::protocol::ModeCommand::*;
use endat_sim::{
    bench::{ChannelResult, ChannelSettings},
    campaign::ABORT_US,
    encoder::{Defect, EncoderConfig, FrameEnd},
    line::{FaultKind, LineConfig, LineFault, Stuck},
    Time, MS, NS, US,
};

const SYSTEM_HZ: u64 = 100_000_000;
const ENDAT_HZ: u64 = 2_000_000;
const HALF: Time = 250 * NS;
/// Start of the frame with the fault.
const FRAME: Time = 500 * US;
/// Duration of the fault after it.
const WRONG: Time = 900 * US;
/// More than a frame with its recovery time.
const FRAME_LENGTH: Time = 70 * US;

fn settings() -> ChannelSettings {
    let settings = ChannelSettings::new(SYSTEM_HZ, ENDAT_HZ, SendPositionAddInfo, 29);
    ChannelSettings {
        start_timeout_us: 20,
        ..settings
    }
}

fn rig(encoder: EncoderConfig, line: LineConfig) -> Rig {
    let mut rig = Rig::with(SYSTEM_HZ, settings(), encoder, line);
    rig.good_position();
    rig
}

fn encoder() -> EncoderConfig {
    EncoderConfig::endat22(29)
}

/// A frame that must not be good; returns its result.
fn bad(rig: &mut Rig) -> ChannelResult {
    let over = rig.position();
    let result = rig.bench.results().last().unwrap().clone();
    assert_eq!(over.cause, result.last_cause());
    assert!(!result.fresh);
    result
}

/// The first good position, after at most two bad frames.
fn recovers(rig: &mut Rig) {
    for _ in 0..2 {
        let over = rig.position();
        if over.cause == cause::NONE {
            break;
        }
    }
    rig.good_position();
}

fn late_start_bits(step: usize) {
    let limit = settings().start_timeout_us;
    for late in (limit + 4..3 * limit).step_by(step) {
        let mut rig = rig(
            encoder().defect(2, Defect::LateStart(late * US)),
            LineConfig::cable(10.0),
        );
        let begin = rig.bench.now();
        let result = bad(&mut rig);
        // The result comes at the limit, independent of the encoder.
        let took = result.time - begin;
        assert!((limit * US..(limit + 12) * US).contains(&took), "{took}");
        assert_eq!(result.cause, cause::NO_START_BIT);
        // tcal, 5 us, counts from the first falling edge; the limit from the end of the turnaround.
        match late {
            l if l < 2 * limit - 2 => {
                assert_eq!(result.late_cause, Some(cause::LATE_START), "{late}")
            }
            l if l > 2 * limit + 2 => assert_ne!(result.last_cause(), cause::LATE_START, "{late}"),
            _ => {}
        }
        assert!(rig.bench.now() - begin < (2 * limit + ABORT_US + 20) * US);
        rig.good_position();
        assert_eq!(rig.bench.conflicts(0), []);
    }
}

#[test]
fn late_start_bit_has_another_cause_than_silence() {
    late_start_bits(5);
}

#[test]
#[ignore = "slow: every microsecond up to three times the limit"]
fn late_start_bit_at_any_delay_has_another_cause_than_silence() {
    late_start_bits(1);
}

/// Step of the quick tests in half clock periods: odd, for both levels of CLOCK.
const SOME: usize = 41;

/// Every `step`th half clock period of a frame.
fn phases(step: usize) -> impl Iterator<Item = Time> {
    (0..FRAME_LENGTH).step_by(step * HALF as usize)
}

fn stuck_every(step: usize) {
    for level in [false, true] {
        for from in phases(step) {
            let until = FRAME + WRONG;
            let mut line = LineConfig::cable(10.0);
            line.stuck = Some(Stuck {
                from: FRAME + from,
                until,
                level,
            });
            let mut rig = rig(encoder(), line);
            rig.bench.run_until(FRAME);
            let over = rig.position();
            let result = rig.bench.results().last().unwrap().clone();
            let right = result.position == rig.last_frame().position;
            assert!(
                !result.fresh || right || over.cause != cause::NONE,
                "{from}: {over:?}"
            );
            // Detected from the next frame on.
            let expected = match level {
                false => cause::STUCK_LOW,
                true => cause::STUCK_HIGH,
            };
            rig.bench.run_until(FRAME + WRONG / 3);
            if level && over.cause == cause::NONE {
                assert_eq!(bad(&mut rig).cause, cause::DATA_NOT_LOW, "{from}");
            }
            for _ in 0..2 {
                assert_eq!(bad(&mut rig).cause, expected, "{from}");
            }
            rig.bench.run_until(until + 100 * US);
            recovers(&mut rig);
        }
    }
}

#[test]
fn a_stuck_line_has_its_cause_and_comes_back() {
    stuck_every(SOME);
}

#[test]
#[ignore = "slow: every half clock period of a frame"]
fn a_line_stuck_at_any_phase_has_its_cause_and_comes_back() {
    stuck_every(1);
}

fn unplugged_every(step: usize) {
    for from in phases(step) {
        let until = FRAME + WRONG;
        let mut encoder = encoder();
        encoder.unplugged.push(FRAME + from..until);
        encoder.start_up = 100 * US;
        let mut rig = rig(encoder, LineConfig::cable(10.0));
        rig.bench.run_until(FRAME);
        let over = rig.position();
        rig.bench.run_until(FRAME + WRONG / 3);
        if over.cause == cause::NONE {
            assert_eq!(bad(&mut rig).cause, cause::DATA_NOT_LOW, "{from}");
        }
        let begin = rig.bench.now();
        let result = bad(&mut rig);
        assert_eq!(result.cause, cause::NO_ENCODER, "{from}");
        assert_eq!(
            result.flags,
            flag(cause::NO_ENCODER) | flag(cause::DATA_NOT_LOW)
        );
        assert!(result.time - begin < US, "at once");
        // The pause of an aborted frame, and the line probe.
        let pause = rig.bench.now() - begin;
        let least = (ABORT_US + SETTLE_US) * US;
        assert!(
            (least..least + (PROBE_US + 3) * US).contains(&pause),
            "{pause}"
        );
        rig.bench.run_until(until + 200 * US);
        recovers(&mut rig);
        assert_eq!(rig.bench.conflicts(0), []);
    }
}

#[test]
fn an_unplugged_encoder_is_no_encoder_and_comes_back() {
    unplugged_every(SOME);
}

#[test]
#[ignore = "slow: every half clock period of a frame"]
fn an_encoder_unplugged_at_any_phase_is_no_encoder_and_comes_back() {
    unplugged_every(1);
}

fn watchdog(limits_us: impl Iterator<Item = u64>) {
    for limit in limits_us.map(u128::from) {
        let mut rig = rig(encoder(), LineConfig::cable(10.0));
        rig.bench.run_until(FRAME);
        rig.bench.set("watchdog_us", limit);
        rig.bench.trigger();
        let begin = rig.bench.now();
        let quiet = rig.bench.run_until_done(MS, |b| b.get("over") == 1);
        assert!(quiet);
        let took = rig.bench.now() - begin;
        let over_cause = rig.bench.get("over_cause") as u64;
        if over_cause == cause::NONE {
            assert!(took <= limit as Time * US, "{limit}: {took}");
            assert!(limit > 40, "a frame takes longer");
            continue;
        }
        assert_eq!(over_cause, cause::WATCHDOG);
        let limit_time = limit as Time * US;
        assert!(
            (limit_time - US..=limit_time + US).contains(&took),
            "{limit}: {took}"
        );
        rig.bench.run_cycles(4);
        assert_eq!(rig.bench.get("data_oe"), 0);
        // A low phase that has begun is completed.
        rig.bench.run_until(rig.bench.now() + HALF);
        assert_eq!(rig.bench.get("endat_clk"), 1);
        assert_eq!(rig.bench.violations(0), []);
        assert!(rig.bench.run_until_done(MS, |b| b.get("busy") == 0));
        rig.bench.set("watchdog_us", 0);
        recovers(&mut rig);
        assert_eq!(rig.bench.conflicts(0), []);
    }
}

#[test]
fn the_watchdog_ends_a_frame() {
    watchdog((1..80).step_by(6));
}

#[test]
#[ignore = "slow: every microsecond of a frame"]
fn the_watchdog_ends_a_frame_wherever_it_is() {
    watchdog(1..80);
}

/// Reset, and the two commands that read and write a parameter: as in ArtInChip's ENDAT-IF.
#[test]
fn the_watchdog_leaves_three_commands_alone() {
    for (command, address, data) in [
        (SendParameter, 3, 0),
        (ReceiveParameter, 3, 1),
        (ReceiveReset, 0, 0),
    ] {
        let mut encoder = encoder();
        encoder.tac = 5 * MS..=5 * MS;
        let mut rig = rig(encoder, LineConfig::cable(10.0));
        rig.good(SelectMemory, 0xB9, 0);
        rig.bench.run_for(13 * MS);
        rig.bench.set("watchdog_us", 30);
        rig.good(command, address, data);
        assert_eq!(rig.last_frame().end, FrameEnd::Complete, "{command:?}");
        rig.assert_clean();
    }
}

/// Between 4.1 and 8.2 ms the frame's limit would be reached in the cycle of the start bit.
#[test]
fn an_answer_with_a_parameter_is_taken_after_any_access_time() {
    for ms in [5, 8, 12] {
        let mut encoder = encoder();
        encoder.tac = ms * MS..=ms * MS;
        let mut rig = rig(encoder, LineConfig::cable(10.0));
        rig.good(SelectMemory, 0xA1, 0);
        rig.assert_clean();
    }
}

#[test]
fn the_watchdog_ends_every_other_command_with_a_parameter() {
    for command in [SelectMemory, ReceiveTestCommand, ReceiveCommunication] {
        let mut encoder = encoder();
        encoder.tac = 5 * MS..=5 * MS;
        let mut rig = rig(encoder, LineConfig::cable(10.0));
        rig.bench.set("watchdog_us", 30);
        let begin = rig.bench.now();
        let over = rig.request(command, 0xA1, 0);
        assert_eq!(over.cause, cause::WATCHDOG, "{command:?}");
        assert!(rig.bench.now() - begin < MS, "{command:?}");
        rig.bench.set("watchdog_us", 0);
        recovers(&mut rig);
    }
}

#[test]
fn a_recovery_time_outside_its_range_is_flagged_and_the_position_stays() {
    let least = recovery_min_cycles(RECOVERY_MIN_NS, SYSTEM_HZ);
    for tm_ns in [2_000, 5_000, 9_000, 9_300, 10_000, 10_100, 29_900] {
        let mut encoder = encoder();
        encoder.tm = tm_ns * NS..=tm_ns * NS;
        let mut rig = rig(encoder, LineConfig::cable(100.0));
        rig.bench.set("recovery_min_cycles", least.into());
        let over = rig.position();
        let result = rig.bench.results().last().unwrap();
        assert!(result.fresh && result.position == rig.last_frame().position);
        let measured = rig.bench.get("recovery_cycles") as u64 * 10;
        // Tolerance of seven cycles: the filter delays edges, and the tail is at the rounded delay.
        assert!(measured.abs_diff(tm_ns) <= 70, "{measured} ns for {tm_ns}");
        match tm_ns {
            ..9_340 => assert_eq!(over.cause, cause::RECOVERY_TOO_SHORT, "{tm_ns}"),
            _ => assert_eq!(over.cause, cause::NONE, "{tm_ns}"),
        }
    }
}

/// With the short range selected, EnDat 2.1 commands still have the long one.
#[test]
fn a_request_has_the_range_of_its_command() {
    let mut encoder = encoder();
    encoder.tm = 29 * US..=29 * US;
    encoder.tm_short = Some(2 * US..=2 * US);
    let mut settings = settings();
    settings.recovery_limit_cycles = 500;
    let mut rig = Rig::with(SYSTEM_HZ, settings, encoder, LineConfig::cable(10.0));
    let least = recovery_min_cycles(1_250, SYSTEM_HZ);
    rig.bench.set("recovery_min_cycles", least.into());
    rig.good(SelectMemory, 0xB9, 0);
    rig.bench.run_for(13 * MS);
    rig.good(ReceiveParameter, 3, 1);
    rig.bench.run_for(13 * MS);
    rig.good_position();
    rig.good(SendParameter, 3, 0);
    rig.good_position();
    rig.assert_clean();
}

#[test]
fn an_echo_of_the_own_command_is_no_answer() {
    // The first frame, at 200 kHz: the turnaround ends after ten periods.
    for command in [SendPositionAddInfo, SendPosition] {
        for delay in (45..75).map(|us| us * US + 700 * NS) {
            let mut line = LineConfig::cable(10.0);
            line.echo_after = Some(delay);
            let encoder = encoder().defect(0, Defect::NoStartBit);
            let mut settings = settings();
            settings.command = command.code();
            settings.start_timeout_us = 100;
            let mut rig = Rig::with(SYSTEM_HZ, settings, encoder, line);
            assert_eq!(bad(&mut rig).cause, cause::OWN_ECHO, "{command:?} {delay}");
        }
    }
}

/// docs/programming.md lists these causes for a card with wrong wiring or configured for another encoder.
fn wrong_wiring_and_widths(widths: impl Iterator<Item = u32>) {
    for (kind, expected) in [
        (FaultKind::Swapped, cause::NO_ENCODER),
        (FaultKind::ToClock, cause::STUCK_HIGH),
    ] {
        let mut rig = Rig::with(SYSTEM_HZ, settings(), encoder(), LineConfig::cable(10.0));
        let fault = LineFault::new(kind, 0, Time::MAX, 1);
        rig.bench.link_mut(0).disturb(|line| line.set_fault(fault));
        rig.bench.run_for(10 * US);
        assert_eq!(bad(&mut rig).last_cause(), cause::DATA_NOT_LOW, "{kind:?}");
        for _ in 0..4 {
            assert_eq!(bad(&mut rig).last_cause(), expected, "{kind:?}");
        }
    }
    for bits in widths.filter(|bits| *bits != 29) {
        let line = LineConfig::cable(10.0);
        let mut rig = Rig::with(SYSTEM_HZ, settings(), EncoderConfig::endat22(bits), line);
        let causes: Vec<u64> = (0..6).map(|_| bad(&mut rig).last_cause()).collect();
        let explained = [cause::CRC, cause::DATA_NOT_FALLING, cause::F2];
        assert!(
            causes.iter().all(|c| explained.contains(c)),
            "{bits}: {causes:?}"
        );
    }
}

#[test]
fn a_wrong_wiring_and_a_wrong_width_have_the_causes_of_the_table() {
    wrong_wiring_and_widths([13, 25, 28, 30, 37].into_iter());
}

#[test]
#[ignore = "slow: every width from 13 to 40"]
fn a_wrong_width_has_the_causes_of_the_table_whatever_it_is() {
    wrong_wiring_and_widths(13..=40);
}
