//! Any state of an SSI port, reachable or not: the next triggers work, and with two copies no wrong position is reported.

use super::run::{engine_for, Run, Settings};
use endat_hdl::protocols::ssi::specials::Special::*;
use endat_hdl::protocols::ssi::specials::Specials;
use endat_hdl::protocols::SsiSpec;
use endat_sim::rng::Rng;
use endat_sim::ssi::{EncoderConfig, Extra};
use endat_sim::US;

/// Registers up to this width get every value, wider ones have each of their bits inverted.
const ALL_VALUES_BITS: usize = 6;
/// Times of the frame at which each of them is upset in the slow test.
const MOMENTS: u64 = 16;
/// Triggers that may be lost or bad after an upset.
const TRIGGERS: usize = 2;
const WIDTH: u32 = 12;
/// A frame of two copies and its recovery time, in cycles.
const FRAME_CYCLES: u64 = 2 * (WIDTH as u64 + 1) * PERIOD + 400;
const PERIOD: u64 = 24;
const POSITION: u64 = 0xA6C;

/// Special bits before and after the position, with those of an encoder without alarm.
fn special(twice: bool) -> (SsiSpec, [Vec<Extra>; 2]) {
    let list = |specials: &[_]| Specials::new(specials).unwrap();
    let asked = SsiSpec {
        twice,
        before: list(&[Ignored, NotAlarm, Shown]),
        after: list(&[Valid, PowerFail, ParityEven, Ignored]),
        ..SsiSpec::default()
    };
    let [low, high] = [false, true].map(Extra::Level);
    let after = vec![high, low, Extra::Parity(false), low];
    (asked, [vec![high, high, low], after])
}

/// A port with this request, and an encoder that sends these bits around its position.
fn start(asked: &SsiSpec, [before, after]: [Vec<Extra>; 2]) -> Run {
    let encoder = EncoderConfig {
        position_bits: WIDTH,
        position: POSITION,
        repeats: asked.twice,
        before,
        after,
        tm: 15 * US,
        pulse_min: 0,
        ..EncoderConfig::default()
    };
    let settings = Settings {
        frame: asked.frame().into(),
        period_cycles: PERIOD,
        recovery_limit_cycles: 380,
    };
    Run::of(engine_for(asked), settings, encoder)
}

/// Two copies of a position alone.
fn plain() -> Run {
    let asked = SsiSpec {
        twice: true,
        ..SsiSpec::default()
    };
    start(&asked, Default::default())
}

/// Upsets every register at all times, or each value of it at one time that varies.
fn the_next_triggers_work(start: Run, all_moments: bool, count_min: usize) {
    let frame_cycles =
        FRAME_CYCLES + 14 * PERIOD * u64::from(!start.encoder.config.after.is_empty());
    assert!(start.clone().is_good());
    let names: Vec<String> = start.engine.nets().map(String::from).collect();
    let registers: Vec<usize> = start.engine.registers().collect();
    let mut rng = Rng::new(5);
    let (mut count, mut lost, mut wrong) = (0, vec![], vec![]);
    for register in registers {
        let width = start.engine.width_bits(register);
        let masks: Vec<u128> = match width {
            0..=ALL_VALUES_BITS => (1..1 << width).collect(),
            _ => (0..width).map(|bit| 1 << bit).collect(),
        };
        let places = masks.iter().flat_map(|m| (0..MOMENTS).map(move |n| (m, n)));
        let step = if all_moments { 1 } else { MOMENTS as usize + 1 };
        for (mask, moment) in places.step_by(step) {
            let span = frame_cycles / MOMENTS;
            let cycle = moment * span + rng.in_range(0, span - 1);
            let mut run = start.clone();
            run.trigger();
            run.cycles(cycle);
            for bit in (0..width).filter(|bit| mask >> bit & 1 == 1) {
                run.engine.flip(register, bit);
            }
            let ends = run.ends();
            let what = format!("{} ^ {mask:#b} in cycle {cycle}", names[register]);
            run.cycles(600);
            let shown = run.get("position");
            let is_valid = run.get("position_valid") == 1 && run.get("fresh") == 1;
            if is_valid && shown != POSITION.into() {
                wrong.push(format!("{what}: {shown:#x}"));
            }
            let tries = (0..TRIGGERS).take_while(|_| !run.is_good()).count();
            count += 1;
            if !ends || !run.is_good() {
                lost.push(format!("{what}: ends {ends}, {tries} bad"));
            }
        }
    }
    assert!(count > count_min, "{count}");
    assert!(lost.is_empty(), "{} of {count}: {lost:#?}", lost.len());
    assert!(wrong.is_empty(), "{} of {count}: {wrong:#?}", wrong.len());
}

#[test]
fn a_port_works_after_an_upset_of_any_register() {
    the_next_triggers_work(plain(), false, 5_000 / 17);
}

#[test]
fn a_port_with_special_bits_works_after_an_upset_of_any_register() {
    let (asked, extras) = special(true);
    the_next_triggers_work(start(&asked, extras), false, 5_000 / 17);
}

/// One copy: inverts every bit of every register at some times of the frame; returns the number of upsets, and those with a wrong position.
fn silent_upsets(moments: u64) -> (usize, Vec<String>) {
    let (asked, extras) = special(false);
    let start = start(&asked, extras);
    assert!(start.clone().is_good());
    let cycles = (u64::from(WIDTH) + 8) * PERIOD + 300;
    let names: Vec<String> = start.engine.nets().map(String::from).collect();
    let registers: Vec<usize> = start.engine.registers().collect();
    let mut rng = Rng::new(11);
    let (mut count, mut wrong) = (0, vec![]);
    for register in registers {
        for bit in 0..start.engine.width_bits(register) {
            for moment in 0..moments {
                let span = cycles / moments;
                let cycle = moment * span + rng.in_range(0, span - 1);
                let mut run = start.clone();
                run.trigger();
                run.cycles(cycle);
                run.engine.flip(register, bit);
                run.ends();
                count += 1;
                if run.fresh().is_some_and(|shown| shown != POSITION) {
                    wrong.push(format!("{}[{bit}] in cycle {cycle}", names[register]));
                }
            }
        }
    }
    (count, wrong)
}

/// At most 0.5 % of all upsets; the bits that select the position are counted twice.
#[test]
fn few_upsets_of_a_port_with_special_bits_show_a_wrong_position() {
    let (count, wrong) = silent_upsets(2);
    assert!(count > 700, "{count}");
    assert!(
        wrong.len() * 200 <= count,
        "{} of {count}: {wrong:#?}",
        wrong.len()
    );
}

#[test]
#[ignore = "slow: forty moments of a frame with special bits"]
fn few_upsets_at_any_moment_show_a_wrong_position() {
    let (count, wrong) = silent_upsets(40);
    assert!(
        wrong.len() * 200 <= count,
        "{} of {count}: {wrong:#?}",
        wrong.len()
    );
}

#[test]
#[ignore = "slow: every value of every register at 16 moments"]
fn whatever_state_a_port_is_brought_into_the_next_triggers_work() {
    the_next_triggers_work(plain(), true, 5_000);
    let (asked, extras) = special(true);
    the_next_triggers_work(start(&asked, extras), true, 5_000);
}
