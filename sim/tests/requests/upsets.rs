//! Any state of a channel with requests, reachable or not: a new trigger works, nothing hangs.

use super::lanes::*;
use endat_sim::{rng::Rng, US};
use rtl_design::engine::{Compiled, Keep};

/// Registers up to this width get every value, wider ones have each of their bits inverted.
const ALL_VALUES_BITS: usize = 6;
/// Times of the frame at which each of them is upset in the slow test.
const MOMENTS: u64 = 16;
/// The longest wait of an upset frame: half a period after a wrap, twice.
const LIMIT_US: u64 = 1_000;
/// Triggers until two in a row are good.
const TRIGGERS: usize = 2;

struct Upset {
    register: usize,
    mask: u128,
    cycle: u64,
    what: String,
}

/// A timer set past its limit reaches it again after 2^16 microseconds.
const TIMER_US: u64 = 66_000;

/// Every value of every register at every time; or each value at one time that varies.
fn upsets(all_moments: bool) -> Vec<Upset> {
    let engine = Compiled::keeping(&design(), Keep::Registers).unwrap();
    let names: Vec<&str> = engine.nets().collect();
    let mut rng = Rng::new(4);
    let mut upsets = vec![];
    for register in engine.registers() {
        let width = engine.width_bits(register);
        let masks: Vec<u128> = match width {
            0..=ALL_VALUES_BITS => (1..1 << width).collect(),
            _ => (0..width).map(|bit| 1 << bit).collect(),
        };
        for mask in masks {
            let turn = upsets.len() as u64 % MOMENTS;
            let moments = match all_moments {
                true => 0..MOMENTS,
                false => turn..turn + 1,
            };
            for moment in moments {
                let span = (FRAME_TIME + RECOVERY + US) * SYSTEM_HZ / (1_000_000 * US) / MOMENTS;
                let cycle = moment * span + rng.in_range(0, span - 1);
                let what = format!("{} ^ {mask:#b} in cycle {cycle}", names[register]);
                upsets.push(Upset {
                    register,
                    mask,
                    cycle,
                    what,
                });
            }
        }
    }
    upsets
}

/// Runs the frame with these upsets. Returns the idle rig, and descriptions of the failing lanes.
fn upset(upsets: &[Upset]) -> (Rig, Vec<String>) {
    let mut rig = Rig::new(&vec![(encoder(), line()); upsets.len()]);
    rig.trigger();
    let last = upsets.iter().map(|u| u.cycle).max().unwrap_or(0);
    for cycle in 0..=last {
        for (lane, upset) in upsets.iter().enumerate().filter(|(_, u)| u.cycle == cycle) {
            for bit in (0..128).filter(|bit| upset.mask >> bit & 1 == 1) {
                rig.bench.engine().flip(upset.register, bit, lane);
            }
        }
        rig.bench.tick();
    }
    let mut hung = rig.idle(LIMIT_US);
    if !hung.is_empty() {
        hung = rig.idle(TIMER_US);
    }
    hung.iter().for_each(|lane| rig.give_up(*lane));
    // The encoder may have to detect that the clock has stopped.
    rig.run_for(40 * US);
    rig.settle(LIMIT_US);
    (
        rig,
        hung.iter().map(|lane| upsets[*lane].what.clone()).collect(),
    )
}

fn the_next_triggers_work(upsets: &[Upset]) {
    let (mut hung, mut lost, mut worst) = (vec![], vec![], 0);
    for upsets in upsets.chunks(LANES) {
        let (mut rig, others) = upset(upsets);
        hung.extend(others);
        let (others, most) = rig.recovered(TRIGGERS, &|lane| upsets[lane].what.clone());
        lost.extend(others);
        worst = worst.max(most);
    }
    let (count, without_end) = (upsets.len(), hung.len());
    println!(
        "{count} upsets, {without_end} without end, at most {worst} triggers until all is well"
    );
    assert!(lost.is_empty(), "{lost:#?}");
    assert!(hung.is_empty(), "{hung:#?}");
}

#[test]
fn the_next_triggers_work_after_an_upset_of_any_register() {
    let upsets = upsets(false);
    assert!(upsets.len() > 15_000 / MOMENTS as usize);
    the_next_triggers_work(&upsets);
}

#[test]
#[ignore = "slow: every value of every register at 16 moments"]
fn whatever_state_a_channel_with_requests_is_brought_into_the_next_triggers_work() {
    let upsets = upsets(true);
    assert!(upsets.len() > 15_000);
    the_next_triggers_work(&upsets);
}
