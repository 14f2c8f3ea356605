//! Plugs pulled, supplies lost, resets and triggers at any time.

use super::rig::*;
use endat_hdl::endat::transaction::cause;
use endat_sim::{bench::ChannelResult, encoder::Defect, rng::Rng, Time, MS, NS, US};
use rtl_design::engine::Engine;

/// Runs a disturbed frame, then until the encoder is back and the channel idle. Returns the result and the levels sampled for it.
fn disturbed(rig: &mut Rig, back: Time) -> (ChannelResult, Vec<bool>) {
    let result = any_frame(rig);
    rig.run_until(back.max(rig.now()) + 30 * US);
    settle(rig);
    let levels = rig.samples(0).iter().map(|s| s.level).collect();
    (result, levels)
}

/// An encoder that is lost at every `step` picoseconds of a frame.
fn lost_every(step: Time) {
    let setup = Setup::card();
    let measured = setup.measured();
    let (mut good, mut bad, mut unlucky) = (0, 0, 0);
    // A frame takes 17 us, then the recovery time follows.
    for after in (0..21 * US).step_by(step as usize) {
        for length in [3 * US, 100 * US] {
            let setup = setup.clone().defect(0, Defect::BrownOut { after, length });
            let mut rig = setup.on(measured.clone());
            rig.run_for(2 * US);
            let back = rig.now() + after + length;
            let (result, levels) = disturbed(&mut rig, back);
            let sent = rig.frames(0)[0].position;
            let what = format!("lost after {after} ps for {length} ps: {result:?}");
            assert_eq!(result.fresh, setup.believes(&levels), "{what}");
            match (result.fresh, result.position == sent) {
                (true, true) => good += 1,
                (true, false) => unlucky += 1,
                _ => {
                    assert_ne!(result.cause, cause::NONE, "{what}");
                    bad += 1;
                }
            }
            // An encoder that returns within the mode command drives its idle level against the receiver.
            let drove = rig.conflicts(0).iter().filter(|c| c.both_on).count();
            assert!(drove == 0 || (length < 4 * US && after < 5 * US), "{what}");
            good_frame(&mut rig);
        }
    }
    // Good results only after the position is published.
    let share = (step / HALF_CELL) as usize;
    assert!(
        good * share > 20 && bad * share > 100,
        "{good} good, {bad} bad"
    );
    // A CRC5 lets 1 of 32 pass.
    assert!(unlucky * 32 <= bad, "{unlucky} of {bad}");
}

const HALF_CELL: Time = 160 * NS;

#[test]
fn an_encoder_lost_in_a_frame_gives_an_error_and_comes_back() {
    lost_every(5 * HALF_CELL);
}

#[test]
#[ignore = "slow: at every half cell of a frame"]
fn an_encoder_lost_at_any_moment_of_a_frame_gives_an_error_and_comes_back() {
    lost_every(HALF_CELL);
}

#[test]
fn a_plug_pulled_and_put_back_at_every_cell_never_leaves_a_wrong_position() {
    let setup = Setup::card();
    let measured = setup.measured();
    for cell in 0..60u64 {
        let mut setup = setup.clone();
        let pulled = 2 * US + cell * 320 * NS;
        setup.encoder.unplugged.push(pulled..pulled + 200 * US);
        let mut rig = setup.on(measured.clone());
        rig.run_for(2 * US);
        let (result, levels) = disturbed(&mut rig, pulled + 200 * US);
        assert_eq!(result.fresh, setup.believes(&levels), "{cell} {result:?}");
        if result.fresh {
            assert_eq!(
                result.position,
                rig.frames(0)[0].position,
                "{cell} {result:?}"
            );
        }
        // A trigger is refused while the encoder is away; afterwards it works again.
        good_frame(&mut rig);
    }
}

#[test]
fn a_reset_in_any_cycle_puts_the_pins_to_rest_within_two_cycles() {
    let setup = Setup::card();
    let mut rig = setup.ready();
    rig.run_for(US);
    rig.trigger();
    let pins = ["endat_clk", "data_oe"];
    let (mut busy, mut low, mut driving) = (0, 0, 0);
    while rig.results().is_empty() || rig.get("busy") != 0 {
        rig.tick();
        busy += 1;
        low += u32::from(rig.get("endat_clk") == 0);
        driving += u32::from(rig.get("data_oe") != 0);
        let mut engine = rig.engine().clone();
        let [reset, trigger] = ["reset", "trigger"].map(|n| engine.port(n));
        let ports = pins.map(|n| engine.port(n));
        engine.set(trigger, 0);
        engine.set(reset, 1);
        engine.tick();
        engine.set(reset, 0);
        for cycle in 1..40 {
            if cycle >= 2 {
                assert_eq!(
                    ports.map(|p| engine.get(p)),
                    [1, 0],
                    "cycle {busy}, {cycle} later"
                );
            }
            engine.tick();
        }
        let [valid, sequence] = ["position_valid", "sequence"].map(|n| engine.port(n));
        assert_eq!((engine.get(valid), engine.get(sequence)), (0, 0));
    }
    assert!(
        busy > 2000 && low > 500 && driving > 200,
        "{busy} {low} {driving}"
    );
}

#[test]
fn after_a_reset_within_a_frame_the_next_frame_is_good() {
    let setup = Setup::card();
    let measured = setup.measured();
    for at in (0..20 * US).step_by(700_000) {
        let mut rig = setup.on(measured.clone());
        rig.run_for(US);
        rig.trigger();
        rig.run_for(at);
        rig.reset();
        // The encoder needs some time to detect that the clock has stopped.
        settle(&mut rig);
        good_frame(&mut rig);
        assert_eq!(rig.conflicts(0), [], "reset after {at} ps");
    }
}

/// Triggers at random times, of random length, in every phase: each one during idle has one result, the others none.
fn storms(seeds: u64) {
    for seed in 0..seeds {
        let mut setup = Setup::card();
        setup = setup
            .defect(3, Defect::NoStartBit)
            .defect(7, Defect::HighWhenIdle(30 * US))
            .defect(8, Defect::CrcXor(3));
        setup.encoder.seed = seed;
        let mut rig = setup.ready();
        let mut rng = Rng::new(seed);
        let (mut accepted, mut lost, mut level, mut left) = (0, 0, false, 0u64);
        // Mostly quiet, then mostly active, then always on.
        while rig.now() < 3 * MS {
            if left == 0 {
                level = !level;
                left = match (seed % 3, level) {
                    (0, false) => rng.in_range(1, 6_000),
                    (_, false) => rng.in_range(1, 30),
                    (2, true) => rng.in_range(1, 20_000),
                    (_, true) => rng.in_range(1, 3),
                };
                rig.set("trigger", u128::from(level));
            }
            left -= 1;
            let busy = rig.get("busy") != 0;
            accepted += usize::from(level && !busy);
            lost += usize::from(level && busy);
            rig.tick();
        }
        rig.set("trigger", 0);
        rig.run_for(MS);
        settle(&mut rig);
        assert!(accepted > 20 && lost > 20, "{accepted} {lost}");
        assert_eq!(rig.results().len(), accepted, "seed {seed}");
        for (i, r) in rig.results().iter().enumerate() {
            assert_eq!(r.sequence, 1 + rig.results()[0].sequence - 1 + i as u64);
            if r.fresh {
                assert!(
                    rig.frames(0).iter().any(|f| f.position == r.position),
                    "{r:?}"
                );
            }
        }
        assert_eq!(rig.conflicts(0), []);
    }
}

#[test]
fn in_a_storm_of_triggers_every_accepted_one_has_one_result() {
    storms(3);
}

#[test]
#[ignore = "slow: twice as many storms"]
fn in_a_storm_of_triggers_every_accepted_one_has_exactly_one_result() {
    storms(6);
}
