//! The encoder with a receiver at work: kernels, engines and emitted Verilog and VHDL agree in every cycle.

use super::{block, DESIGN};
use crate::three_way::{three_way, Stimulus};
use endat_sim::rng::Rng;
use rtl_design::kernel_engine;

/// Names of the inputs, in the order of a row.
const INPUTS: [&str; 13] = [
    "reset",
    "tick_us",
    "plugged",
    "position_bits",
    "endat22",
    "tcal_cycles",
    "tm_cycles",
    "tm_22_cycles",
    "position",
    "alarm_1",
    "alarm_2",
    "endat_clk",
    "data_i",
];

/// Frames with random commands, widths, clocks and ends; microseconds of 8 cycles.
fn frames(count: usize, seed: u64) -> Stimulus {
    let mut rng = Rng::new(seed);
    let mut cycles: Vec<Vec<u128>> = vec![];
    let mut settings = [0u128; 7];
    let mut run = |settings: &[u128; 7], rng: &mut Rng, pins: [u128; 4], count: u64| {
        let [reset, plugged, clock, data] = pins;
        let [bits, endat22, tcal, tm, tm_22, alarm_1, alarm_2] = *settings;
        for _ in 0..count {
            let tick = u128::from(cycles.len() % 8 == 0);
            let position = u128::from(rng.next_u64() >> 16);
            cycles.push(vec![
                reset, tick, plugged, bits, endat22, tcal, tm, tm_22, position, alarm_1, alarm_2,
                clock, data,
            ]);
        }
    };
    run(&settings, &mut rng, [1, 1, 1, 1], 2);
    run(&settings, &mut rng, [0, 1, 1, 1], 100);
    for frame in 0..count {
        let half = rng.in_range(1, 3);
        let bits = rng.in_range(1, 20);
        settings = [
            bits.into(),
            rng.in_range(0, 1).into(),
            rng.in_range(0, 60 * half).into(),
            rng.in_range(1, 60).into(),
            rng.in_range(1, 60).into(),
            rng.in_range(0, 1).into(),
            rng.in_range(0, 1).into(),
        ];
        let command = [0b000_111, 0b111_000, 0b011_100, 0b001_001][frame % 4];
        let pulses = rng.in_range(5, 60 + bits);
        for pulse in 1..=pulses {
            let bit = u128::from((3..9).contains(&pulse) && command >> (8 - pulse) & 1 == 1);
            run(&settings, &mut rng, [0, 1, 0, bit], half);
            run(&settings, &mut rng, [0, 1, 1, bit], half);
        }
        let pause = rng.in_range(1, 120);
        run(&settings, &mut rng, [0, 1, 1, 1], pause);
        match frame % 8 {
            5 => run(&settings, &mut rng, [0, 1, 0, 1], 8 * 32),
            6 => run(&settings, &mut rng, [0, 0, 1, 1], 3),
            7 => run(&settings, &mut rng, [1, 1, 1, 0], 3),
            _ => {}
        }
        run(&settings, &mut rng, [0, 1, 1, 1], 100);
    }
    Stimulus {
        inputs: INPUTS.map(str::to_owned).to_vec(),
        cycles,
        middle: vec![],
    }
}

#[test]
fn kernels_engines_and_emitted_text_agree_on_an_encoder() {
    let mut kernel = kernel_engine!(block(); clock;
        in reset, tick_us, plugged, position, alarm_1, alarm_2;
        out latch, command_strobe, command, answered, busy;
        bundles settings, line);
    let seen = three_way("encoder", &mut kernel, &DESIGN, &frames(24, 3)).unwrap();
    for (name, at_least) in [("latch", 20), ("answered", 5)] {
        let count = seen.output(name).iter().sum::<u128>();
        assert!(count >= at_least, "{name}: {count}");
    }
    assert!(seen.output("data_oe").contains(&0));
}
