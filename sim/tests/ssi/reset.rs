//! A reset in the middle of a frame: no wrong position afterwards, for any time of the next trigger.

use super::run::{engine_for, Run, Settings, SYSTEM_MHZ};
use endat_hdl::protocols::ssi::cause;
use endat_hdl::protocols::SsiSpec;
use endat_sim::rng::Rng;
use endat_sim::ssi::EncoderConfig;
use endat_sim::US;

const PERIOD: u64 = 20;
const WIDTH: u32 = 25;
/// Recovery time of the encoder, and the port's limit, in microseconds.
const TM_US: u64 = 19;
const RECOVERY_MAX_US: u64 = 20;
/// Alternating bits differ wherever a frame is cut.
const POSITION: u64 = 0x155_32D3;

fn start(twice: bool, repeats: bool) -> Run {
    let (settings, encoder) = asked(twice, repeats);
    Run::new(settings, encoder)
}

fn asked(twice: bool, repeats: bool) -> (Settings, EncoderConfig) {
    let encoder = EncoderConfig {
        position_bits: WIDTH,
        position: POSITION,
        repeats,
        tm: TM_US * US,
        ..EncoderConfig::default()
    };
    let settings = Settings {
        frame: if twice { 6 } else { 4 },
        period_cycles: PERIOD,
        recovery_limit_cycles: RECOVERY_MAX_US * SYSTEM_MHZ + 10,
    };
    (settings, encoder)
}

/// Resets the port at this many times of a frame, then triggers it repeatedly, the first time up to 10 us later.
fn no_position_is_wrong_after_a_reset(moments: u64) {
    let mut rng = Rng::new(47);
    let (mut count, mut good) = (0, 0);
    let mut wrong = vec![];
    for (twice, repeats) in [(false, false), (false, true), (true, true)] {
        let start = start(twice, repeats);
        assert!(start.clone().is_good());
        let clocks = u64::from(WIDTH + 1) * (1 + u64::from(twice));
        let frame = clocks * PERIOD + RECOVERY_MAX_US * SYSTEM_MHZ;
        for moment in 0..moments {
            let (from, to) = (moment * frame / moments, (moment + 1) * frame / moments);
            let cycle = rng.in_range(from, to.max(from + 1) - 1);
            let mut run = start.clone();
            run.trigger();
            run.cycles(cycle);
            run.reset();
            // Lost triggers have no effect.
            for _ in 0..4 {
                run.cycles(rng.in_range(0, 10 * SYSTEM_MHZ));
                let before = run.get("sequence");
                run.trigger();
                run.cycles(clocks * PERIOD + 2 * PERIOD);
                let shown = run.fresh();
                if shown.is_some_and(|position| position != POSITION) {
                    wrong.push(format!("{twice} {repeats} {cycle}: {shown:x?}"));
                }
                good += u64::from(run.get("sequence") != before && shown.is_some());
            }
            assert!(run.ends() && run.is_good(), "{twice} {repeats} {cycle}");
            count += 1;
        }
    }
    assert!(good > count, "{good} of {count} frames are triggered soon");
    assert!(wrong.is_empty(), "{} of {count}: {wrong:#?}", wrong.len());
}

#[test]
fn port_shows_no_wrong_position_after_a_reset_in_mid_frame() {
    no_position_is_wrong_after_a_reset(120);
}

#[test]
#[ignore = "slow: a reset at 10 000 moments of a frame"]
fn port_shows_no_wrong_position_after_a_reset_at_any_moment() {
    no_position_is_wrong_after_a_reset(3_400);
}

/// The wait is the longest recovery time and a period, not less and not much more.
#[test]
fn port_takes_no_trigger_after_a_reset_until_the_recovery_time_has_passed() {
    let mut run = start(false, true);
    run.reset();
    let waited = run.waits();
    let needed = RECOVERY_MAX_US * SYSTEM_MHZ + PERIOD;
    assert!((needed..needed + 30).contains(&waited), "{waited}");
    // A trigger during the wait is lost, and the next result reports it.
    run.reset();
    run.cycles(50);
    run.trigger();
    assert!(run.ends());
    assert_eq!(run.get("sequence"), 0, "a reset has no result");
    run.trigger();
    assert!(run.ends());
    assert_eq!(run.get("cause"), 7);
    assert_eq!(run.fresh(), Some(POSITION));
}

/// An encoder with more bits is in the middle of its frame when the port has finished; a HIGH of DATA there is one of its bits.
#[test]
fn port_waits_after_a_frame_whose_end_is_high() {
    let mut run = start(false, true);
    // The bit after the last requested one is HIGH.
    run.set("position_bits", 18);
    run.trigger();
    run.cycles(19 * PERIOD + 2 * PERIOD);
    assert_eq!(run.get("cause"), 3);
    let waited = run.waits();
    assert!(
        waited >= RECOVERY_MAX_US * SYSTEM_MHZ - 2 * PERIOD,
        "{waited}"
    );
    // The encoder has finished the previous frame.
    run.set("position_bits", WIDTH.into());
    assert!(run.is_good());
}

/// Power-up of the card may come in the middle of a frame, too: the encoder has a separate supply.
#[test]
fn port_takes_no_trigger_after_power_up_until_the_recovery_time_has_passed() {
    let (settings, encoder) = asked(false, true);
    let mut run = Run::powered(engine_for(&SsiSpec::default()), settings, encoder);
    let waited = run.waits();
    let needed = RECOVERY_MAX_US * SYSTEM_MHZ + PERIOD;
    assert!((needed..needed + 30).contains(&waited), "{waited}");
    assert!(run.is_good());
}

/// A frame ended by an upset leaves the encoder in the middle of its frame, where DATA is any bit.
#[test]
fn port_waits_after_an_upset_until_the_recovery_time_has_passed() {
    let start = start(false, true);
    let names: Vec<String> = start.engine.nets().map(String::from).collect();
    let state = (start.engine.registers()).find(|register| names[*register] == "state");
    let state = state.unwrap();
    let bits = 0..start.engine.width_bits(state);
    // Times with DATA HIGH at the end, and with DATA LOW that goes HIGH afterwards.
    let moments = (3 * PERIOD..20 * PERIOD).step_by(17);
    for (bit, cycle) in bits.flat_map(|bit| moments.clone().map(move |n| (bit, n))) {
        let mut run = start.clone();
        run.trigger();
        run.cycles(cycle);
        run.engine.flip(state, bit);
        let waited = run.waits();
        let what = format!("{bit} {cycle}: {waited}");
        assert!(waited >= RECOVERY_MAX_US * SYSTEM_MHZ, "{what}");
        let upset = u128::from(cause::flag(cause::UPSET));
        assert_eq!(run.get("flags") & upset, upset, "{what}");
        assert_eq!(run.fresh(), None, "{what}");
        assert!(run.is_good(), "{what}");
    }
}

/// DATA HIGH ends the wait; if DATA stays LOW, the longest recovery time does.
#[test]
fn port_takes_a_trigger_as_soon_as_data_is_high_again() {
    let start = start(false, false);
    for tm_us in [3, 11, 19] {
        let mut run = start.clone();
        run.encoder.config.tm = tm_us * US;
        run.trigger();
        run.cycles(u64::from(WIDTH + 1) * PERIOD);
        while !run.encoder.data() {
            assert_eq!(run.get("busy"), 1, "{tm_us}");
            run.cycles(1);
        }
        let waited = run.waits();
        assert!(waited <= 8, "{tm_us}: {waited}");
        assert!(run.is_good(), "{tm_us}");
    }
    let mut run = start.clone();
    run.trigger();
    run.cycles((u64::from(WIDTH) + 1) * PERIOD);
    run.broken = Some(false);
    let waited = run.waits();
    let most = RECOVERY_MAX_US * SYSTEM_MHZ + 2 * PERIOD + 30;
    assert!(waited <= most, "{waited}");
}
