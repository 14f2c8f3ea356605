//! Every state that an SSI port can be brought into, reached or not: the next triggers work, and with two copies no wrong position goes out.

use super::run::{Run, Settings};
use endat_sim::rng::Rng;
use endat_sim::ssi::EncoderConfig;
use endat_sim::US;

/// Registers up to this width get every value, wider ones have each of their bits inverted.
const ALL_VALUES_BITS: usize = 6;
/// Moments of the frame at which each of them is upset in the slow test.
const MOMENTS: u64 = 16;
/// Triggers that may be lost or bad after one that was upset.
const TRIGGERS: usize = 2;
const WIDTH: u32 = 12;
/// A frame of two copies and its recovery time, in cycles.
const FRAME_CYCLES: u64 = 2 * (WIDTH as u64 + 1) * PERIOD + 400;
const PERIOD: u64 = 24;
const POSITION: u64 = 0xA6C;

/// A port at an encoder that repeats its position.
fn start() -> Run {
    let encoder = EncoderConfig {
        position_bits: WIDTH,
        position: POSITION,
        tm: 15 * US,
        pulse_min: 0,
        ..EncoderConfig::default()
    };
    let settings = Settings {
        frame: 6,
        period_cycles: PERIOD,
        recovery_limit_cycles: 380,
    };
    Run::new(settings, encoder)
}

/// Upsets every register at all moments, or each value of it at one, another one for each.
fn the_next_triggers_work(all_moments: bool, count_min: usize) {
    let start = start();
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
            let span = FRAME_CYCLES / MOMENTS;
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
    the_next_triggers_work(false, 5_000 / 17);
}

#[test]
#[ignore = "slow: every value of every register at 16 moments"]
fn whatever_state_a_port_is_brought_into_the_next_triggers_work() {
    the_next_triggers_work(true, 5_000);
}
