//! Every fault has its cause, within its limit. The last good position remains, and the next frame is good again.

use super::rig::*;
use endat_hdl::endat::channel::Features;
use endat_hdl::endat::transaction::cause;
use endat_hdl::protocol::LEAD_PULSES;
use endat_sim::{
    bench::ChannelResult,
    encoder::{Defect, FrameEnd, Violation},
    Time, MS, NS, US,
};

/// Raw flags that are not causes.
const PARALLEL_CRC: u64 = 1 << 8;
const TAIL_NOT_HIGH: u64 = 1 << 9;

/// The raw flag of a cause.
const fn flag(cause: u64) -> u64 {
    1 << (cause - 1)
}

/// A good frame, a faulty one, and a good one again.
struct Story {
    rig: Rig,
    faulty: ChannelResult,
    /// Time from the trigger of the faulty frame to its result.
    took: Time,
}

fn assert_held(before: &ChannelResult, after: &ChannelResult) {
    assert!(!after.fresh && after.position_valid, "{after:?}");
    assert_eq!(after.position, before.position, "{after:?}");
    assert_eq!(
        after.first_fall_timestamp, before.first_fall_timestamp,
        "{after:?}"
    );
    assert_eq!(after.sequence, before.sequence + 1, "{after:?}");
    assert!(after.age_us > 0, "{after:?}");
}

/// The faulty frame is the encoder's frame 1.
fn story(setup: &Setup) -> Story {
    let mut rig = setup.ready();
    let good = good_frame(&mut rig);
    settle(&mut rig);
    let triggered = rig.now();
    let faulty = any_frame(&mut rig);
    assert_held(&good, &faulty);
    let took = faulty.time - triggered;
    let next = good_frame(&mut rig);
    assert_eq!(next.sequence, faulty.sequence + 1);
    settle(&mut rig);
    assert_eq!(rig.conflicts(0), []);
    Story { rig, faulty, took }
}

fn of_defect(defect: Defect) -> Story {
    story(&Setup::card().defect(1, defect))
}

/// Time from the trigger to the end of the turnaround, where the channel starts to wait for the start bit.
fn turnaround(setup: &Setup) -> Time {
    let s = &setup.settings;
    let cycles =
        s.period_cycles / 2 + s.first_low_extra_cycles + u64::from(LEAD_PULSES) * s.period_cycles;
    cycles * 1_000_000 * US / setup.system_hz
        + setup.line.round_trip()
        + setup.encoder.clock_to_data
}

#[test]
fn data_high_before_a_frame_is_data_not_low_at_once_and_without_a_clock_edge() {
    let setup = Setup::card().defect(0, Defect::HighWhenIdle(100 * US));
    let mut rig = setup.ready();
    let good = good_frame(&mut rig);
    settle(&mut rig);
    rig.run_for(5 * US);
    assert_eq!(rig.get("data_i"), 1);
    let triggered = rig.now();
    let faulty = any_frame(&mut rig);
    assert_held(&good, &faulty);
    assert_eq!(
        (faulty.cause, faulty.flags),
        (cause::DATA_NOT_LOW, flag(cause::DATA_NOT_LOW))
    );
    assert!(
        faulty.time - triggered <= 60 * NS,
        "{} ps",
        faulty.time - triggered
    );
    assert_eq!(rig.frames(0).len(), 1, "no clock edge reached the encoder");
    // A quiet time, then DATA low for tR.
    settle(&mut rig);
    let quiet = rig.now() - faulty.time;
    // The first microsecond is incomplete, and counts.
    assert!(quiet >= (ABORT_US - 2) * US, "{quiet} ps");
    rig.run_until_done(MS, |b| b.get("data_i") == 0);
    rig.run_for(US);
    good_frame(&mut rig);
    settle(&mut rig);
    assert_eq!((rig.violations(0), rig.conflicts(0)), (&[][..], vec![]));
}

#[test]
fn a_trigger_before_data_has_been_low_for_long_enough_is_an_overrun_not_a_frame() {
    let setup = Setup::card();
    let mut rig = setup.ready();
    good_frame(&mut rig);
    rig.run_until_done(FRAME_LIMIT, |b| b.frames(0)[0].data_fall.is_some());
    rig.run_for(200 * NS); // of the 500 ns of tR
    rig.trigger();
    rig.run_for(50 * US);
    assert_eq!((rig.frames(0).len(), rig.results().len()), (1, 1));
    let next = any_frame(&mut rig);
    assert_eq!((next.cause, next.fresh), (cause::TRIGGER_OVERRUN, true));
    good_frame(&mut rig);
    assert_eq!(rig.violations(0), []);
}

#[test]
fn a_silent_encoder_is_no_start_bit_when_the_limit_is_over() {
    for defect in [Defect::NoStartBit, Defect::LateStart(MS)] {
        let setup = Setup::card().defect(1, defect);
        let s = story(&setup);
        assert_eq!(
            (s.faulty.cause, s.faulty.flags),
            (cause::NO_START_BIT, flag(cause::NO_START_BIT))
        );
        let limit = setup.settings.start_timeout_us * US;
        let waited = s.took - turnaround(&setup);
        assert!((limit - US..=limit + US).contains(&waited), "{waited} ps");
        // The clock stops; the encoder may note this.
        let frame = &s.rig.frames(0)[1];
        assert_eq!(frame.end, FrameEnd::Stopped);
        let stops = |v: &Violation| matches!(v, Violation::StoppedBeforeAnswer { .. });
        assert!(
            s.rig.violations(0).iter().all(|v| stops(&v.1)),
            "{:?}",
            s.rig.violations(0)
        );
    }
}

#[test]
fn an_encoder_as_slow_as_the_limit_is_still_heard() {
    let mut setup = Setup::card();
    let limit = setup.settings.start_timeout_us * US;
    // Minus the half period in which a start bit is sampled, and a microsecond tick.
    setup.encoder.tcal = turnaround(&setup) + limit - 2 * US;
    let mut rig = setup.ready();
    good_frame(&mut rig);
    settle(&mut rig);
    assert_sound(&setup, &rig);
}

#[test]
fn a_line_that_nobody_drives_is_a_start_without_its_edge() {
    let s = of_defect(Defect::Open);
    assert_eq!(
        (s.faulty.cause, s.faulty.flags),
        (cause::START_WINDOW, flag(cause::START_WINDOW))
    );
}

#[test]
fn a_start_edge_outside_its_window_is_refused_and_the_delay_is_measured_again() {
    let setup = Setup::card();
    let period_ps = setup.settings.period_cycles * 10 * NS;
    let window_ps = setup.settings.start_window_cycles * 10 * NS;
    let measured = setup.measured();
    for more in (10..period_ps / NS).step_by(10) {
        let mut moved = setup.clone();
        moved.encoder.clock_to_data += more * NS;
        let mut rig = moved.on(measured.clone());
        let result = any_frame(&mut rig);
        let distance = (more * NS).min(period_ps - more * NS);
        if distance + 20 * NS <= window_ps && more * NS < period_ps / 2 {
            assert_eq!(
                (result.cause, result.fresh),
                (cause::NONE, true),
                "{more} ns {result:?}"
            );
        } else if distance >= window_ps + 20 * NS {
            assert_eq!(result.cause, cause::START_WINDOW, "{more} ns {result:?}");
            assert_eq!(result.flags, flag(cause::START_WINDOW));
            assert!(!result.fresh);
            // Reported when the start bit is sampled, at most a period after its edge.
            let frame = &rig.frames(0)[0];
            let edge = frame.start_time + moved.encoder.clock_to_data + moved.line.round_trip();
            assert!(result.time < edge + period_ps + 100 * NS);
        }
        let before = rig.get("delay_cycles");
        good_frame(&mut rig);
        if result.cause == cause::START_WINDOW {
            let delay = rig.get("delay_cycles") as i128;
            assert!(
                (delay - before as i128 - i128::from(more) / 10).abs() <= 1,
                "{before} {delay}"
            );
        }
    }
}

#[test]
fn a_wrong_crc_is_a_crc_error_whatever_its_bits() {
    for xor in 1..32u8 {
        let s = of_defect(Defect::CrcXor(xor));
        assert_eq!(s.faulty.cause, cause::CRC);
        assert_eq!(s.faulty.flags, flag(cause::CRC) | PARALLEL_CRC);
        assert_eq!(
            s.faulty.crc_received ^ s.faulty.crc_computed,
            u64::from(xor)
        );
        assert_eq!(s.faulty.crc_received, crc_sent(&s.rig.frames(0)[1]));
        assert_eq!(s.rig.violations(0), [], "the frame is complete");
    }
}

#[test]
fn alarms_of_the_encoder_are_f1_and_f2_with_a_right_crc() {
    let bits = |f1, f2| Defect::ErrorBits { f1, f2 };
    let (one, two) = (flag(cause::F1), flag(cause::F2));
    for (defect, cause, flags) in [
        (bits(true, true), cause::F1, one),
        (bits(false, false), cause::F2, two),
        (bits(true, false), cause::F1, one | two),
    ] {
        let s = of_defect(defect);
        assert_eq!((s.faulty.cause, s.faulty.flags), (cause, flags));
        assert_eq!(s.faulty.crc_received, s.faulty.crc_computed);
        assert_eq!(s.rig.violations(0), [], "the frame is complete");
    }
}

#[test]
fn data_that_does_not_fall_withdraws_the_position_and_brings_back_the_one_before() {
    let setup = Setup::card().defect(1, Defect::LateFall(MS));
    let mut rig = setup.ready();
    let before = good_frame(&mut rig);
    let result = good_frame(&mut rig);
    assert_ne!(result.position, before.position);
    let tail = rig.samples(0).len();
    assert!(rig.run_until_done(MS, |b| b.get("cause") != 0));
    assert!(tail > 0);
    let told = rig.now();
    let frame = rig.frames(0)[1].clone();
    let edge = frame.last_rise + setup.encoder.clock_to_data + setup.line.round_trip() / 2;
    let limit = setup.settings.recovery_limit_cycles * 10 * NS;
    assert!(
        (limit..limit + 200 * NS).contains(&(told - edge)),
        "{} ps",
        told - edge
    );
    assert_eq!(rig.results()[1].late_cause, Some(cause::DATA_NOT_FALLING));
    assert_eq!(rig.get("flags") as u64, flag(cause::DATA_NOT_FALLING));
    assert_eq!(
        [
            "position",
            "first_fall_timestamp",
            "position_valid",
            "fresh"
        ]
        .map(|name| rig.get(name) as u64),
        [before.position, before.first_fall_timestamp, 1, 0]
    );
    // Its age continues.
    rig.run_cycles(2);
    let age = (rig.now() - before.time) / US;
    assert!((age.saturating_sub(40)..=age).contains(&(rig.get("age_us") as u64)));
    assert_eq!(rig.results().len(), 2, "no separate result");
    rig.run_for(MS);
    settle(&mut rig);
    good_frame(&mut rig);
    assert_eq!((rig.violations(0), rig.conflicts(0)), (&[][..], vec![]));
}

/// A port that restores the previous position.
const RESTORING: Features = Features {
    restore: true,
    ..Features::NONE
};
/// A port with a separate copy of that position.
const WITH_COPY: Features = Features {
    second_receiver: true,
    ..RESTORING
};

/// Without `restore` no position is valid after a withdrawn one; with a separate copy the previous position returns, too.
#[test]
fn a_withdrawn_position_gives_way_as_its_port_says() {
    for (features, valid) in [(Features::NONE, 0), (WITH_COPY, 1), (Features::GUARDED, 1)] {
        let setup = Setup::card().defect(1, Defect::LateFall(MS)).with(features);
        let mut rig = setup.ready();
        let before = good_frame(&mut rig);
        good_frame(&mut rig);
        assert!(rig.run_until_done(MS, |b| b.get("cause") != 0));
        let shown = ["position_valid", "fresh"].map(|name| rig.get(name));
        assert_eq!(shown, [valid, 0], "{features:?}");
        if valid == 1 {
            let shown = ["position", "first_fall_timestamp"].map(|name| rig.get(name) as u64);
            assert_eq!(shown, [before.position, before.first_fall_timestamp]);
        }
    }
}

/// A port that restores has no previous position yet.
#[test]
fn withdrawal_of_the_first_position_leaves_no_valid_one() {
    for features in [RESTORING, WITH_COPY, Features::GUARDED] {
        // Frame 0 measures the delay and brings no position.
        let setup = Setup::card().defect(1, Defect::LateFall(MS)).with(features);
        let mut rig = setup.fresh();
        good_frame(&mut rig);
        assert_eq!(rig.get("position_valid"), 1);
        assert!(rig.run_until_done(MS, |b| b.get("cause") != 0));
        let shown = ["position_valid", "fresh"].map(|name| rig.get(name));
        assert_eq!(shown, [0, 0], "{features:?}");
    }
}

#[test]
fn the_longest_allowed_recovery_is_no_fault() {
    let mut setup = Setup::card();
    let limit = setup.settings.recovery_limit_cycles * 10 * NS;
    for (tm, fault) in [(limit - 50 * NS, false), (limit + 200 * NS, true)] {
        setup.encoder.tm = tm..=tm;
        let mut rig = setup.ready_with_other_recovery();
        good_frame(&mut rig);
        settle(&mut rig);
        assert_eq!(rig.results()[0].late_cause.is_some(), fault, "tm {tm} ps");
    }
}

#[test]
fn a_trigger_within_a_frame_is_an_overrun_and_the_position_is_good() {
    let setup = Setup::card();
    let mut rig = setup.ready();
    good_frame(&mut rig);
    settle(&mut rig);
    let mut at_result = 0;
    for (after, own) in [
        (30 * NS, true),
        (3 * US, true),
        (12 * US, true),
        (17_500 * NS, false),
    ] {
        let before = rig.results().len();
        rig.trigger();
        rig.run_for(after);
        rig.trigger();
        settle(&mut rig);
        assert_eq!(rig.results().len(), before + 1, "one result, {after} ps");
        let first = rig.results()[before].clone();
        let second = any_frame(&mut rig);
        settle(&mut rig);
        let (told, other) = if own {
            (&first, &second)
        } else {
            (&second, &first)
        };
        assert_eq!(
            (told.cause, told.flags, told.fresh),
            (cause::TRIGGER_OVERRUN, flag(cause::TRIGGER_OVERRUN), true),
            "{after} ps"
        );
        assert_eq!(
            (other.cause, other.fresh),
            (cause::NONE, true),
            "{after} ps"
        );
        at_result += 1;
    }
    assert_eq!(at_result, 4);
    assert_eq!((rig.violations(0), rig.conflicts(0)), (&[][..], vec![]));
    for (frame, result) in rig.frames(0).iter().zip(rig.results()) {
        assert_eq!(frame.position, result.position);
    }
}

/// A CRC5 passes 1 of 32 wrong words. The cell after the frame detects those of them that leave it LOW.
fn other_widths(seeds: u64) {
    let setup = Setup::card();
    let measured = setup.measured();
    let (mut count, mut by_tail, mut unlucky) = (0, 0, 0);
    for wider in (-16..=16).filter(|n| *n != 0) {
        for seed in 0..seeds {
            // The position fills all 48 bits, so that a wider answer has some.
            let mut other = setup.clone();
            other.encoder.position_bits = 48;
            other = other.defect(0, Defect::WiderBy(29 - 48 + wider));
            other.encoder.seed = (seed * 64_u64).wrapping_add_signed(i64::from(wider));
            let mut rig = other.on(measured.clone());
            let result = any_frame(&mut rig);
            rig.run_for(20 * US);
            settle(&mut rig);
            let levels: Vec<bool> = rig.samples(0).iter().map(|s| s.level).collect();
            let tail = levels.last().copied().unwrap_or(false);
            assert_eq!(result.fresh, setup.believes(&levels), "{wider} {result:?}");
            count += 1;
            if result.crc_received == result.crc_computed && !tail {
                by_tail += 1;
                assert_eq!(result.cause, cause::DATA_NOT_FALLING);
                assert_ne!(result.flags & TAIL_NOT_HIGH, 0, "{wider} {result:?}");
                // The previous state remains.
                assert_eq!((rig.get("position_valid"), rig.get("fresh")), (1, 0));
            }
            unlucky += usize::from(result.fresh && tail);
        }
    }
    assert!(
        by_tail > 0 && unlucky * 40 < count,
        "{unlucky} of {count}, {by_tail} by the tail"
    );
}

#[test]
fn a_position_of_another_width_passes_only_with_a_right_crc_and_a_high_tail() {
    other_widths(10);
}

#[test]
#[ignore = "slow: four times as many encoders"]
fn no_position_of_another_width_passes_without_a_right_crc_and_a_high_tail() {
    other_widths(40);
}

/// x^15 = 1: an answer that is 15 bits short and followed by LOW has a right CRC.
#[test]
fn fifteen_bits_too_few_and_a_low_line_pass_the_crc_and_fail_at_the_tail() {
    let mut setup = Setup::card();
    let measured = setup.measured();
    let short = setup.answer_bits() - 15;
    setup = setup.defect(0, Defect::WiderBy(-15)).defect(
        0,
        Defect::StuckFrom {
            bit: short,
            level: false,
        },
    );
    let mut passed = 0;
    for seed in 0..64 {
        setup.encoder.seed = seed;
        let mut rig = setup.on(measured.clone());
        let result = any_frame(&mut rig);
        settle(&mut rig);
        assert_ne!(rig.results()[0].last_cause(), cause::NONE, "{result:?}");
        if result.crc_received == result.crc_computed {
            passed += 1;
            assert_eq!(result.flags, TAIL_NOT_HIGH);
            assert_eq!((rig.get("position_valid"), rig.get("fresh")), (1, 0));
        }
        rig.run_for(20 * US);
        settle(&mut rig);
        let again = any_frame(&mut rig);
        assert_eq!((again.cause, again.fresh), (cause::NONE, true));
    }
    assert!(
        passed > 0,
        "no answer passed the CRC: the tail check was not tested"
    );
}

/// Catches a frame whose LOW tail hides other faults.
#[test]
fn a_low_tail_tells_a_wrong_crc_and_f1_of_the_frame_too() {
    let setup = Setup::card();
    let after_frame = setup.answer_bits();
    for is_wrong in [false, true] {
        for has_alarm in [false, true] {
            let mut setup = setup.clone().defect(
                1,
                Defect::StuckFrom {
                    bit: after_frame,
                    level: false,
                },
            );
            let mut flags = TAIL_NOT_HIGH;
            if is_wrong {
                setup = setup.defect(1, Defect::CrcXor(5));
                flags |= flag(cause::CRC) | PARALLEL_CRC;
            }
            if has_alarm {
                setup = setup.defect(1, Defect::ErrorBits { f1: true, f2: true });
                flags |= flag(cause::F1);
            }
            let s = story(&setup);
            assert_eq!(
                (s.faulty.cause, s.faulty.flags),
                (cause::DATA_NOT_FALLING, flags)
            );
        }
    }
}

#[test]
fn an_answer_without_f2_is_refused() {
    for seed in 0..16 {
        let mut setup = Setup::card().defect(1, Defect::WithoutF2);
        setup.encoder.seed = seed;
        let mut rig = setup.ready();
        let good = good_frame(&mut rig);
        settle(&mut rig);
        let faulty = any_frame(&mut rig);
        assert_held(&good, &faulty);
        rig.run_for(20 * US);
        settle(&mut rig);
        good_frame(&mut rig);
    }
}

#[test]
fn no_encoder_at_all_is_data_not_low_with_the_clock_at_rest() {
    let mut setup = Setup::card();
    setup.encoder.unplugged.push(0..Time::MAX);
    let mut rig = setup.fresh();
    rig.watch("endat_clk");
    rig.watch("data_oe");
    for _ in 0..3 {
        rig.run_for(100 * US);
        let result = any_frame(&mut rig);
        assert_eq!(
            (result.cause, result.position_valid),
            (cause::DATA_NOT_LOW, false)
        );
    }
    for w in rig.watched() {
        assert_eq!(w.changes().len(), 1, "{} moved", w.name());
    }
}
