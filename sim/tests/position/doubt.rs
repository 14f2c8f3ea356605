//! The core rejects doubtful positions: lines that change during a frame, settings that change, upset registers.

use super::rig::*;
use endat_hdl::endat::{
    channel::{Channel, Features, FixedTimes},
    transaction::cause,
};
use endat_hdl::protocol::ModeCommand::{SendPosition, SendPositionAddInfo};
use endat_sim::{encoder::Defect, rng::Rng, Time, MS, NS, US};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::{Compiled, Keep};
use rust_hdl::prelude::Block;

/// Period of a frame that measures the delay.
const SLOW: Time = 5 * US;

/// A plug is pulled in an answer, and the fail-safe bias sets DATA HIGH. The CRC of all ones is right in some cases; then DATA does not fall.
#[test]
fn a_plug_that_is_pulled_in_an_answer_never_leaves_a_wrong_position() {
    let mut withdrawn = 0;
    for command in [SendPosition, SendPositionAddInfo] {
        let setup = Setup::new((32_000_000, 4_000_000), command, 25, 20.0);
        let measured = setup.measured();
        for seed in 0..900 {
            let mut setup = setup.clone();
            // The answer begins about 6 us after the trigger, and takes 8 us.
            let pulled = 7 * US + seed * 7_900 * NS / 900;
            setup.encoder.unplugged.push(pulled..10 * MS);
            setup.encoder.seed = seed;
            let mut rig = setup.on(measured.clone());
            let held = ["position", "first_fall_timestamp"];
            let before = held.map(|name| rig.get(name));
            rig.run_for(US / 2);
            let result = any_frame(&mut rig);
            rig.run_until_done(MS, |b| b.get("cause") != 0);
            rig.run_cycles(2);
            let what = format!("{command:?} {seed} {result:?}");
            assert_ne!(rig.get("cause"), 0, "{what}");
            assert_eq!(
                (rig.get("fresh"), rig.get("position_valid")),
                (0, 1),
                "{what}"
            );
            assert_eq!(held.map(|name| rig.get(name)), before, "{what}");
            withdrawn += usize::from(result.fresh);
        }
    }
    assert!(withdrawn > 5, "{withdrawn}: the CRC let too few pass");
}

/// With guards a frame uses the settings of the cycle with its trigger; without them they must be stable while the channel is busy.
#[test]
fn settings_that_change_in_a_frame_count_for_the_next_one() {
    change_in_a_frame(Features::GUARDED, true);
}

/// A service determines width, command and rate of the encoder, and may set them during a frame of a trigger.
#[test]
fn width_command_and_rate_of_a_served_channel_count_for_the_next_frame() {
    let requests = Features {
        requests: true,
        ..Features::CARD
    };
    change_in_a_frame(requests, false);
}

fn change_in_a_frame(features: Features, all: bool) {
    let mut rng = Rng::new(3);
    for command in [SendPosition, SendPositionAddInfo] {
        let setup = Setup::new((32_000_000, 4_000_000), command, 25, 20.0).with(features);
        let measured = setup.measured();
        let frame = {
            let mut rig = setup.on(measured.clone());
            let begin = rig.cycle();
            good_frame(&mut rig);
            rig.cycle() - begin
        };
        for at in 4..frame {
            let mut rig = setup.on(measured.clone());
            rig.run_for(US);
            let results = rig.results().len();
            rig.trigger();
            rig.run_cycles(at);
            rig.set("position_bits", u128::from(rng.in_range(1, 48)));
            rig.set("command", [7, 56][rng.in_range(0, 1) as usize]);
            rig.set("period_cycles", u128::from(rng.in_range(4, 60)));
            if all {
                rig.set("filter_cycles", u128::from(rng.in_range(0, 2)));
                rig.set("start_window_cycles", 1);
                rig.set("recovery_limit_cycles", 3500);
            }
            assert!(rig.run_until_done(MS, |b| b.results().len() > results));
            let result = rig.results().last().unwrap().clone();
            let sent = rig.frames(0)[0].position;
            assert_eq!(
                (result.cause_name(), result.fresh, result.position),
                ("none", true, sent),
                "changed {at} cycles after the trigger"
            );
        }
    }
}

/// A channel with accessible registers.
fn open_engine() -> Compiled {
    let times = FixedTimes {
        abort_us: ABORT_US,
        ..FixedTimes::at(CARD.0)
    };
    let mut block = Channel::with(times, Features::GUARDED);
    block.connect_all();
    let design = elaborate(&block, "channel").unwrap();
    Compiled::keeping(&design, Keep::Registers).unwrap()
}

/// Bits of a register, by name.
pub fn register(engine: &Compiled, name: &str) -> (usize, usize) {
    let net = engine.nets().position(|n| n == name);
    let net = net.unwrap_or_else(|| panic!("no register {name}"));
    (net, engine.width_bits(net))
}

pub fn open_rig() -> Rig {
    let setup = Setup::card();
    let mut rig = setup.on(open_engine());
    good_frame(&mut rig);
    settle(&mut rig);
    good_frame(&mut rig);
    settle(&mut rig);
    rig
}

#[test]
fn a_held_position_or_time_stamp_that_is_upset_is_told_and_the_next_frame_is_good() {
    let mut rig = open_rig();
    let ready = rig.engine().clone();
    for name in [
        "held",
        "stamp",
        "held_crc",
        "held_width",
        "held_f2",
        "parity",
    ] {
        let (net, width) = register(&ready, &format!("snapshot.{name}"));
        for bit in 0..width {
            let mut rig = Setup::card().on(ready.clone());
            rig.run_for(US);
            rig.engine().flip(net, bit);
            rig.run_cycles(4);
            assert_eq!(
                [
                    rig.get("cause") as u64,
                    rig.get("position_valid") as u64,
                    rig.get("fresh") as u64
                ],
                [cause::UPSET, 0, 0],
                "{name} {bit}"
            );
            good_frame(&mut rig);
        }
    }
}

/// The time stamp waits for a frame from its edge to the result, including the cycles before the position is ready.
#[test]
fn a_time_stamp_that_is_upset_before_its_position_comes_is_told() {
    let mut rig = open_rig();
    let ready = rig.engine().clone();
    let (net, width) = register(&ready, "snapshot.stamp_pending");
    let mut rig = Setup::card().on(ready.clone());
    let begin = rig.cycle();
    let whole = good_frame(&mut rig);
    let frame = whole.cycle - begin;
    let true_stamp = whole.first_fall_timestamp;
    let mut told = 0;
    for bit in [0, 7, width - 1] {
        for back in (0..12).chain([100, 500, frame - 20]) {
            let mut rig = Setup::card().on(ready.clone());
            rig.trigger();
            rig.run_cycles(frame - back - 1);
            rig.engine().flip(net, bit);
            assert!(rig.run_until_done(MS, |b| !b.results().is_empty()));
            // The guard's first check of the stored value.
            rig.run_cycles(3);
            let ports = ["first_fall_timestamp", "fresh", "cause"];
            let [stamp, fresh, cause] = ports.map(|port| rig.get(port) as u64);
            let is_told = [fresh, cause] == [0, cause::UPSET];
            assert!(
                is_told || stamp == true_stamp,
                "bit {bit}, {back} cycles before: {stamp}, not {true_stamp}"
            );
            told += usize::from(is_told);
        }
    }
    assert!(told >= 3 * 12, "{told}");
}

/// From its last bit to its publication the position waits for the CRC and the bit after it.
#[test]
fn a_word_that_is_upset_before_it_is_published_is_refused() {
    let mut rig = open_rig();
    let ready = rig.engine().clone();
    let (net, width) = register(&ready, "receiver.word");
    let mut rig = Setup::card().on(ready.clone());
    let begin = rig.cycle();
    let result = good_frame(&mut rig);
    let frame = result.cycle - begin;
    let (mut refused, mut same) = (0, 0);
    for bit in 0..width {
        // Six bits of 32 cycles, and the shift to bit 0.
        for back in [3, 20, 60, 100, 150] {
            let mut rig = Setup::card().on(ready.clone());
            rig.trigger();
            rig.run_cycles(frame - back - 1);
            rig.engine().flip(net, bit);
            assert!(rig.run_until_done(MS, |b| !b.results().is_empty()));
            let result = rig.results()[0].clone();
            let sent = rig.frames(0)[0].position;
            assert!(
                !result.fresh || result.position == sent,
                "{bit} {back}: {result:?}"
            );
            refused += usize::from(!result.fresh);
            same += usize::from(result.fresh);
        }
    }
    assert!(refused > 29 * 4 && same < refused, "{refused} {same}");
}

#[test]
fn the_driver_is_on_while_a_command_is_sent_and_never_else() {
    let mut rig = open_rig();
    let ready = rig.engine().clone();
    let (net, width) = register(&ready, "sender.cells_left");
    for bit in 0..width {
        for after in [0, 11 * US, 15 * US] {
            let mut rig = Setup::card().on(ready.clone());
            if after != 0 {
                rig.trigger();
                rig.run_for(after);
            }
            let is_sending = rig.get("data_oe") == 1;
            rig.engine().flip(net, bit);
            rig.run_cycles(3);
            if !is_sending {
                assert_eq!(
                    rig.get("data_oe"),
                    0,
                    "bit {bit}, {after} ps after the trigger"
                );
            }
        }
    }
}

#[test]
fn a_trigger_has_its_result_even_if_the_frame_is_lost() {
    let mut rig = open_rig();
    let ready = rig.engine().clone();
    for name in [
        "transaction.phase",
        "transaction.tail_sampled",
        "transaction.was_running",
    ] {
        let (net, width) = register(&ready, name);
        for bit in 0..width {
            for after in (1..19).map(|us| us * US) {
                let mut rig = Setup::card().on(ready.clone());
                rig.trigger();
                rig.run_for(after);
                rig.engine().flip(net, bit);
                rig.run_cycles(10);
                assert!(
                    rig.run_until_done(5 * MS, |b| b.get("busy") == 0),
                    "{name} {bit} after {after} ps"
                );
                assert!(!rig.results().is_empty(), "{name} {bit} after {after} ps");
            }
        }
    }
}

/// The guard sees the register in the cycle of the trigger. A frame that begins in that cycle would end with a second result.
#[test]
fn trigger_in_the_cycle_of_an_abort_has_one_result() {
    let mut rig = open_rig();
    let ready = rig.engine().clone();
    for name in ["transaction.owing", "transaction.under_way"] {
        let (net, _) = register(&ready, name);
        let mut rig = Setup::card().on(ready.clone());
        rig.run_for(US);
        rig.engine().flip(net, 0);
        rig.trigger();
        rig.run_for(MS);
        let causes: Vec<u64> = rig.results().iter().map(|r| r.cause).collect();
        assert_eq!(causes, [cause::UPSET], "{name}");
        assert_eq!(rig.frames(0).len(), 0, "{name}");
        // An upset `owing` makes the trigger look lost, too: the next result may report this.
        assert!(any_frame(&mut rig).fresh, "{name}");
    }
}

/// `late` belongs to a frame announced without a start bit; the next frame begins without it.
#[test]
fn late_flag_of_an_earlier_frame_does_not_end_the_next_one() {
    let mut rig = open_rig();
    let ready = rig.engine().clone();
    let (net, _) = register(&ready, "transaction.late");
    // The phase in which the flag matters begins at once.
    let mut setup = Setup::card();
    setup.settings.first_low_extra_cycles = 0;
    let mut rig = setup.on(ready);
    rig.run_for(US);
    rig.engine().flip(net, 0);
    good_frame(&mut rig);
}

/// Another encoder, on a longer cable, is plugged in between two triggers: the delay is measured again, and not wrong by periods.
#[test]
fn data_that_was_high_between_frames_has_the_delay_measured_again() {
    let setup = Setup::card();
    let measured = setup.measured();
    for pulled_ns in [3_000, 50_000, 400_000] {
        let mut other = setup.clone();
        other.line.cable_m = 120.0;
        other
            .encoder
            .unplugged
            .push(2 * US..2 * US + pulled_ns * NS);
        let mut rig = other.on(measured.clone());
        rig.run_for(5 * US + pulled_ns * NS);
        let result = good_frame(&mut rig);
        settle(&mut rig);
        assert_eq!(rig.frames(0)[0].period, SLOW, "{pulled_ns} ns: {result:?}");
        good_frame(&mut rig);
        settle(&mut rig);
        assert_sound(&other, &rig);
    }
}

#[test]
fn a_reset_is_followed_by_the_quiet_time_of_an_aborted_frame() {
    let setup = Setup::card();
    let measured = setup.measured();
    for at in (0..20 * US).step_by(1_900_000) {
        let mut rig = setup.on(measured.clone());
        rig.run_for(US);
        rig.trigger();
        rig.run_for(at);
        rig.reset();
        let begin = rig.now();
        assert!(rig.run_until_done(MS, |b| b.get("busy") == 0));
        let quiet = (rig.now() - begin) / US;
        assert!((ABORT_US - 1..=ABORT_US + 2).contains(&quiet), "{quiet} us");
    }
}

/// A timer past its limit ends; with a comparison for equality it would wrap after 65 ms.
#[test]
fn a_timer_that_is_upset_does_not_make_the_quiet_time_longer() {
    let mut rig = open_rig();
    let ready = rig.engine().clone();
    let (net, width) = register(&ready, "transaction.timer");
    for bit in 0..width {
        let mut rig = Setup::card()
            .defect(0, Defect::NoStartBit)
            .on(ready.clone());
        assert!(!any_frame(&mut rig).fresh);
        rig.run_for(20 * US);
        rig.engine().flip(net, bit);
        let begin = rig.now();
        assert!(rig.run_until_done(70 * MS, |b| b.get("busy") == 0));
        let quiet = (rig.now() - begin) / US;
        assert!(quiet <= 2 * ABORT_US, "bit {bit}: {quiet} us");
    }
}

/// A timer setting of 0 ends at once, but the pause after it does not.
#[test]
fn a_limit_of_zero_does_not_shorten_the_quiet_time() {
    let mut setup = Setup::card();
    let measured = setup.measured();
    setup.settings.start_timeout_us = 0;
    setup.settings.recovery_limit_cycles = 0;
    let mut rig = setup.on(measured);
    let result = any_frame(&mut rig);
    assert_eq!(result.cause, cause::NO_START_BIT);
    let begin = rig.now();
    assert!(rig.run_until_done(MS, |b| b.get("busy") == 0));
    assert!((rig.now() - begin) / US >= ABORT_US - 1);
}

/// At a slow clock, an encoder of another width can end its frame between two pulses and look like a good one. The position
/// comes from the later frame at the full clock.
/// Runs every `step`th width from 8 to 48, with this many encoders of each.
fn other_widths(step: usize, seeds: u64) {
    let setup = Setup::card();
    let measured = setup.measured();
    let (mut slow, mut looked_good) = (0, 0);
    for bits in (8..=48)
        .step_by(step)
        .filter(|n| *n != setup.encoder.position_bits)
    {
        for seed in 0..seeds {
            let mut other = setup.clone();
            other.encoder.position_bits = bits;
            other.encoder.seed = seed * 64 + u64::from(bits);
            let mut rig = other.on(measured.clone());
            for _ in 0..8 {
                let before = rig.frames(0).len();
                let result = any_frame(&mut rig);
                settle(&mut rig);
                let frames = &rig.frames(0)[before..];
                let begun_slow = frames.first().is_some_and(|f| f.period == SLOW);
                if begun_slow {
                    slow += 1;
                    looked_good += usize::from(frames.len() == 2);
                    assert!(
                        !result.fresh || frames.len() == 2,
                        "{bits} {seed}: {result:?}"
                    );
                }
            }
        }
    }
    // At least one in four encoders is measured, and one in sixteen of these looks good.
    let encoders = 40 / step * seeds as usize;
    assert!(
        slow * 4 > encoders && looked_good * 16 > encoders,
        "{slow} {looked_good}"
    );
}

#[test]
fn an_encoder_of_another_width_gives_no_position_while_the_delay_is_measured() {
    other_widths(2, 1);
}

#[test]
#[ignore = "slow: every width, four encoders of each"]
fn no_encoder_of_another_width_gives_a_position_while_the_delay_is_measured() {
    other_widths(1, 4);
}
