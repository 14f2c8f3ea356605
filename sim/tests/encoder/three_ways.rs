//! The encoder with a receiver at work: kernels, engines and emitted Verilog and VHDL agree in every cycle.

use super::{block, DESIGN, WRONG_DESIGN};
use crate::three_way::{three_way, Stimulus};
use endat_sim::rng::Rng;
use rtl_design::elaborate::Design;
use rtl_design::kernel_engine;

/// Names of the inputs, in the order of a row: those that change within a frame first.
const INPUTS: [&str; 26] = [
    "reset",
    "plugged",
    "endat_clk",
    "data_i",
    "arm",
    "tick_us",
    "position",
    "position_bits",
    "endat22",
    "tcal_cycles",
    "tm_cycles",
    "tm_22_cycles",
    "alarm_1",
    "alarm_2",
    "skip_frames",
    "error_frames",
    "bit_error",
    "bit_number",
    "crc_xor",
    "invert_f1",
    "invert_f2",
    "width_xor",
    "no_start",
    "early_clocks",
    "error_tcal_cycles",
    "error_tm_cycles",
];

/// Least and largest value of the settings of a frame, in the order of [`INPUTS`].
const SETTINGS: [(u64, u64); 19] = [
    (1, 20),
    (0, 1),
    (0, 100),
    (1, 60),
    (1, 60),
    (0, 1),
    (0, 1),
    (0, 2),
    (0, 2),
    (0, 4),
    (0, 26),
    (0, 31),
    (0, 1),
    (0, 1),
    (0, 7),
    (0, 1),
    (0, 3),
    (0, 100),
    (1, 60),
];

/// Frames with random commands, settings, clocks and ends; microseconds of 8 cycles.
fn frames(count: usize, seed: u64) -> Stimulus {
    let mut rng = Rng::new(seed);
    let mut cycles: Vec<Vec<u128>> = vec![];
    let mut settings = [0u128; 19];
    let mut run = |settings: &[u128; 19], rng: &mut Rng, pins: [u128; 5], count: u64| {
        for _ in 0..count {
            let tick = u128::from(cycles.len().is_multiple_of(8));
            let position = u128::from(rng.next_u64() >> 16);
            cycles.push([&pins[..], &[tick, position], settings].concat());
        }
    };
    run(&settings, &mut rng, [1, 1, 1, 1, 0], 2);
    run(&settings, &mut rng, [0, 1, 1, 1, 0], 100);
    for frame in 0..count {
        settings = SETTINGS.map(|(least, most)| rng.in_range(least, most).into());
        run(
            &settings,
            &mut rng,
            [0, 1, 1, 1, u128::from(frame.is_multiple_of(3))],
            1,
        );
        let half = rng.in_range(1, 3);
        let command = [0b000_111, 0b111_000, 0b111_000, 0b011_100][frame % 4];
        let pulses = rng.in_range(5, 110);
        for pulse in 1..=pulses {
            let bit = u128::from((3..9).contains(&pulse) && command >> (8 - pulse) & 1 == 1);
            run(&settings, &mut rng, [0, 1, 0, bit, 0], half);
            run(&settings, &mut rng, [0, 1, 1, bit, 0], half);
        }
        let pause = rng.in_range(1, 120);
        run(&settings, &mut rng, [0, 1, 1, 1, 0], pause);
        match frame % 8 {
            5 => run(&settings, &mut rng, [0, 1, 0, 1, 0], 8 * 32),
            6 => run(&settings, &mut rng, [0, 0, 1, 1, 0], 3),
            7 => run(&settings, &mut rng, [1, 1, 1, 0, 0], 3),
            _ => {}
        }
        run(&settings, &mut rng, [0, 1, 1, 1, 0], 100);
    }
    Stimulus {
        inputs: INPUTS.map(str::to_owned).to_vec(),
        cycles,
        middle: vec![],
    }
}

fn agree(name: &str, design: &Design, errors: bool, frames: &Stimulus) {
    let mut kernel = kernel_engine!(block(errors); clock;
        in reset, tick_us, plugged, position, alarm_1, alarm_2;
        out latch, command_strobe, command, answered, busy;
        bundles settings, wanted, line);
    let seen = three_way(name, &mut kernel, design, frames).unwrap();
    for (name, at_least) in [("latch", 20), ("answered", 5)] {
        let count = seen.output(name).iter().sum::<u128>();
        assert!(count >= at_least, "{name}: {count}");
    }
    assert!(seen.output("data_oe").contains(&0));
}

#[test]
fn kernels_engines_and_emitted_text_agree_on_an_encoder() {
    agree("encoder", &DESIGN, false, &frames(24, 3));
}

#[test]
fn kernels_engines_and_emitted_text_agree_on_errors_on_command() {
    agree("encoder_errors", &WRONG_DESIGN, true, &frames(40, 4));
}
