//! The edges at the pins, with cycle accuracy, and the two latencies.

use super::rig::*;
use endat_hdl::{
    endat::channel,
    protocol::{
        ModeCommand::{self, SendPosition, SendPositionAddInfo},
        DRIVER_OFF_FALL, DRIVER_ON_FALL, FIRST_COMMAND_FALL, MODE_COMMAND_BITS,
    },
};

/// Changes of a watched port as (cycle, value).
fn changes(rig: &Rig, name: &str) -> Vec<(u64, u128)> {
    let hz = u128::from(rig.system_hz());
    let cycle = |ps: u64| ((u128::from(ps) * hz + 500_000_000_000) / 1_000_000_000_000) as u64;
    let port = rig
        .watched()
        .iter()
        .find(|w| w.name() == name)
        .expect("watched");
    port.changes()
        .iter()
        .map(|(t, v)| (cycle(*t), *v))
        .collect()
}

const PINS: [&str; 4] = ["endat_clk", "data_o", "data_oe", "sample_strobe"];

fn watched(setup: &Setup) -> Rig {
    let mut rig = setup.ready();
    rig.run_cycles(200);
    PINS.iter().for_each(|p| rig.watch(p));
    rig
}

/// Cycles of the falling and of the rising edges of the clock.
fn clock_edges(rig: &Rig) -> (Vec<u64>, Vec<u64>) {
    let edges = changes(rig, "endat_clk");
    let of = |level| {
        edges
            .iter()
            .skip(1)
            .filter(move |e| e.1 == level)
            .map(|e| e.0)
            .collect()
    };
    assert_eq!(edges[0].1, 1, "the clock rests HIGH");
    (of(0), of(1))
}

#[test]
fn every_phase_is_half_a_period_and_the_first_low_one_has_its_extra() {
    for period in [8, 9, 10, 11, 12, 25, 32, 33, 999, 1000] {
        for extra in [0, 4, 5, 6, 150, 1000] {
            let mut setup = Setup::new(CARD, SendPosition, 3, 0.0);
            setup.settings.period_cycles = period;
            setup.settings.first_low_extra_cycles = extra;
            setup.settings.start_window_cycles = 2;
            // Without tST the fastest clock leaves a normal encoder too little time to release the line.
            setup.encoder.release = 1;
            let mut rig = watched(&setup);
            good_frame(&mut rig);
            settle(&mut rig);
            assert_sound(&setup, &rig);
            let (falls, rises) = clock_edges(&rig);
            let what = format!("period {period}, extra {extra}");
            assert!(falls.len() >= 20 && falls.len() == rises.len(), "{what}");
            for (i, (fall, rise)) in falls.iter().zip(&rises).enumerate() {
                let low = rise - fall;
                let more = if i == 0 { extra } else { 0 };
                assert_eq!(low, period / 2 + more, "LOW {i}, {what}");
                if let Some(next) = falls.get(i + 1) {
                    assert_eq!(next - rise, period - period / 2, "HIGH {i}, {what}");
                }
            }
        }
    }
}

#[test]
fn the_command_and_the_driver_change_with_their_falling_edges() {
    for command in ModeCommand::POSITION {
        for rates in RATES {
            let setup = Setup::new(rates, command, 13, 20.0);
            let mut rig = watched(&setup);
            good_frame(&mut rig);
            settle(&mut rig);
            let (falls, _) = clock_edges(&rig);
            let fall = |number: u32| falls[number as usize - 1];
            let drives = changes(&rig, "data_oe");
            let expected = [(fall(DRIVER_ON_FALL), 1), (fall(DRIVER_OFF_FALL), 0)];
            assert_eq!(drives[1..], expected, "{command:?} {rates:?}");
            // The level in each cell of the driver: the lead-in, then the six bits.
            let levels = changes(&rig, "data_o");
            let at = |cycle| levels.iter().rfind(|c| c.0 <= cycle).map(|c| c.1);
            for edge in DRIVER_ON_FALL..DRIVER_OFF_FALL {
                let bit = match edge.checked_sub(FIRST_COMMAND_FALL) {
                    Some(i) => command.code() >> (MODE_COMMAND_BITS - 1 - i) & 1,
                    None => 0,
                };
                assert_eq!(
                    at(fall(edge)),
                    Some(u128::from(bit)),
                    "F#{edge} {command:?}"
                );
                let next = fall(edge + 1);
                assert_eq!(at(next - 1), Some(u128::from(bit)), "F#{edge} {command:?}");
            }
            let on = fall(DRIVER_ON_FALL)..fall(DRIVER_OFF_FALL);
            for change in levels.iter().filter(|c| on.contains(&c.0)) {
                assert!(
                    falls.contains(&change.0),
                    "DATA between two falling edges: {change:?}"
                );
            }
        }
    }
}

#[test]
fn both_latencies_are_the_same_for_every_width_and_rate() {
    for rates in RATES {
        for (command, bits) in [
            (SendPosition, 1),
            (SendPosition, 18),
            (SendPositionAddInfo, 19),
            (SendPositionAddInfo, 33),
            (SendPositionAddInfo, 48),
        ] {
            let setup = Setup::new(rates, command, bits, 20.0);
            let mut rig = watched(&setup);
            for _ in 0..2 {
                settle(&mut rig);
                let quiet = clock_edges(&rig).0.len();
                let triggered = rig.cycle();
                let result = good_frame(&mut rig);
                let (falls, _) = clock_edges(&rig);
                assert_eq!(
                    falls[quiet] - triggered,
                    channel::TRIGGER_TO_FIRST_FALL_CYCLES,
                    "{rates:?} {command:?} {bits}"
                );
                let strobes = changes(&rig, "sample_strobe");
                let last = strobes.iter().rfind(|s| s.1 == 1).expect("samples").0;
                assert_eq!(
                    result.cycle - last,
                    channel::TAIL_SAMPLE_TO_RESULT_CYCLES,
                    "{rates:?} {command:?} {bits}"
                );
            }
        }
    }
}
