//! The engines on the core, beyond the reach of rust-hdl's kernels: lanes, upsets, saved states, forced nets, coverage.

use crate::stimulus::stimulus;
use crate::three_way::{agree, record, Recording, Stimulus};
use crate::tools;
use crate::verilog::area::subject;
use endat_sim::rng::Rng;
use endat_workshop::bench;
use rtl_design::elaborate::Design;
use rtl_design::engine::{Compiled, Engine, Instruments, Interpreter, Keep, LaneWords, Lanes};
use std::sync::LazyLock;

/// The channel without an encoder: busy enough for upsets and states.
fn channel() -> &'static Design {
    &subject("channel").design
}

/// Its engine as it starts; compiled once for all tests.
fn compiled() -> Compiled {
    static CHANNEL: LazyLock<Compiled> = LazyLock::new(|| Compiled::new(channel()).unwrap());
    CHANNEL.clone()
}

fn channel_stimulus(design: &Design, cycles: usize) -> Stimulus {
    let mut stimulus = stimulus(design, cycles, 5);
    let set = |stimulus: &mut Stimulus, name: &str, value: &dyn Fn(usize) -> u128| {
        let at = stimulus.inputs.iter().position(|n| n == name).unwrap();
        for (cycle, row) in stimulus.cycles.iter_mut().enumerate() {
            row[at] = value(cycle);
        }
    };
    // A reset is followed by a long quiet time.
    set(&mut stimulus, "reset", &|_| 0);
    set(&mut stimulus, "period_cycles", &|_| 12);
    set(&mut stimulus, "first_low_extra_cycles", &|_| 4);
    set(&mut stimulus, "command", &|_| 0b111000);
    set(&mut stimulus, "position_bits", &|_| 7);
    set(&mut stimulus, "filter_cycles", &|_| 1);
    set(&mut stimulus, "start_timeout_us", &|_| 20);
    set(&mut stimulus, "trigger", &|cycle| {
        (cycle % 500 == 20).into()
    });
    set(&mut stimulus, "data_i", &|cycle| {
        // LOW long enough for a frame to begin.
        (cycle % 2_000 > 600 && cycle / 45 % 3 == 1).into()
    });
    set(&mut stimulus, "tick_us", &|cycle| (cycle % 4 == 0).into());
    stimulus
}

/// Plays a part of the stimulus.
fn play(engine: &mut dyn Engine, stimulus: &Stimulus, cycles: std::ops::Range<usize>) -> Recording {
    let part = Stimulus {
        inputs: stimulus.inputs.clone(),
        cycles: stimulus.cycles[cycles].to_vec(),
        middle: vec![],
    };
    record(engine, &part)
}

#[test]
fn a_restored_state_goes_on_as_the_saved_one() {
    let design = channel();
    let stimulus = channel_stimulus(design, 3000);
    let mut engine = compiled();
    play(&mut engine, &stimulus, 0..1234);
    let saved = engine.save();
    let first = play(&mut engine, &stimulus, 1234..3000);
    assert_ne!(engine.save(), saved);
    engine.restore(&saved);
    let again = play(&mut engine, &stimulus, 1234..3000);
    agree("restored", &first, &again).unwrap();
}

/// An upset does the same in the compiled engine, in its portable form, and in a lane.
#[test]
fn upsets_agree_in_every_engine_and_lane() {
    let design = channel();
    let stimulus = channel_stimulus(design, 1500);
    let mut native = Compiled::keeping(design, Keep::Registers).unwrap();
    let registers: Vec<usize> = native.registers().collect();
    let mut rng = Rng::new(11);
    let mut lanes = Lanes::new(design, Keep::Registers, LaneWords::Two).unwrap();
    let ports: Vec<_> = stimulus.inputs.iter().map(|n| lanes.port(n)).collect();
    // Lane n has an upset of its own; lane 0 none.
    let upsets: Vec<(usize, usize, usize)> = (0..lanes.lanes())
        .map(|_| {
            let register = registers[rng.in_range(0, registers.len() as u64 - 1) as usize];
            let width = native.width_bits(register) as u64;
            let bit = rng.in_range(0, width - 1) as usize;
            (rng.in_range(100, 1400) as usize, register, bit)
        })
        .collect();
    let outputs: Vec<String> = lanes
        .ports()
        .iter()
        .filter(|p| !p.is_input)
        .map(|p| p.name.clone())
        .collect();
    let ids: Vec<_> = outputs.iter().map(|n| lanes.port(n)).collect();
    let watched: Vec<usize> = (0..lanes.lanes()).step_by(5).collect();
    let mut seen: Vec<Vec<Vec<u128>>> = vec![vec![]; watched.len()];
    for (cycle, row) in stimulus.cycles.iter().enumerate() {
        for (lane, (at, register, bit)) in upsets.iter().enumerate() {
            if *at == cycle && lane != 0 {
                lanes.flip(*register, *bit, lane);
            }
        }
        ports
            .iter()
            .zip(row)
            .for_each(|(port, value)| lanes.set_all(*port, *value));
        for (lane, rows) in watched.iter().zip(&mut seen) {
            rows.push(ids.iter().map(|id| lanes.get(*id, *lane)).collect());
        }
        lanes.tick();
    }
    let fresh = native.save();
    let mut portable = Compiled::portable(design, Keep::Registers).unwrap();
    let mut differ = 0;
    for (lane, rows) in watched.iter().zip(&seen) {
        let (at, register, bit) = upsets[*lane];
        native.restore(&fresh);
        portable.restore(&fresh);
        for engine in [&mut native, &mut portable] {
            let mut got = vec![];
            for (cycle, row) in stimulus.cycles.iter().enumerate() {
                if cycle == at && *lane != 0 {
                    engine.flip(register, bit);
                }
                for (name, value) in stimulus.inputs.iter().zip(row) {
                    let id = engine.port(name);
                    engine.set(id, *value);
                }
                got.push(
                    outputs
                        .iter()
                        .map(|n| {
                            let id = engine.port(n);
                            engine.get(id)
                        })
                        .collect::<Vec<_>>(),
                );
                engine.tick();
            }
            assert!(
                got == *rows,
                "lane {lane}: bit {bit} of register {register} at {at}"
            );
        }
        differ += usize::from(*rows != seen[0]);
    }
    // Upsets are seen, or they would say nothing.
    assert!(differ > 2, "{differ}");
}

#[test]
fn a_forced_net_keeps_its_value_until_it_is_let_go() {
    let design = channel();
    let stimulus = channel_stimulus(design, 2000);
    let forced = vec!["endat_clk".to_owned(), "data_i".into()];
    let instruments = Instruments {
        forced,
        coverage: false,
    };
    let mut engine = Compiled::instrumented(design, Keep::Registers, &instruments).unwrap();
    let mut plain = compiled();
    let free = play(&mut engine, &stimulus, 0..700);
    agree(
        "nothing forced",
        &play(&mut plain, &stimulus, 0..700),
        &free,
    )
    .unwrap();
    let (clock, data) = (
        engine.net("endat_clk").unwrap(),
        engine.net("data_i").unwrap(),
    );
    engine.force(clock, 1, 0);
    engine.force(data, 1, 1);
    let held = play(&mut engine, &stimulus, 700..1400);
    assert!(held.output("endat_clk").iter().all(|level| *level == 0));
    engine.force(clock, 0, 0);
    engine.force(data, 0, 0);
    let after = play(&mut engine, &stimulus, 1400..2000);
    assert!(after.output("endat_clk").contains(&1));
    let unknown = Instruments {
        forced: vec!["no.such.net".into()],
        coverage: false,
    };
    let error = Compiled::instrumented(design, Keep::Outputs, &unknown)
        .err()
        .unwrap();
    assert!(
        error
            .to_string()
            .starts_with("net = no.such.net: is not in the design"),
        "{error}"
    );
}

/// Forcing DATA is the same as driving it.
#[test]
fn a_forced_input_is_a_driven_one() {
    let design = channel();
    let mut driven = channel_stimulus(design, 2500);
    let instruments = Instruments {
        forced: vec!["data_i".into()],
        coverage: false,
    };
    let mut engine = Compiled::instrumented(design, Keep::Outputs, &instruments).unwrap();
    let data = engine.net("data_i").unwrap();
    engine.force(data, 1, 1);
    let forced = record(&mut engine, &driven);
    let at = driven.inputs.iter().position(|n| n == "data_i").unwrap();
    driven.cycles.iter_mut().for_each(|row| row[at] = 1);
    let want = record(&mut compiled(), &driven);
    agree("forced", &want, &forced).unwrap();
}

#[test]
fn coverage_is_what_the_registers_did() {
    let design = channel();
    let stimulus = channel_stimulus(design, 2000);
    let instruments = Instruments {
        forced: vec![],
        coverage: true,
    };
    let mut covered = Compiled::instrumented(design, Keep::Registers, &instruments).unwrap();
    let mut plain = Interpreter::new(design).unwrap();
    let ports: Vec<_> = stimulus.inputs.iter().map(|n| plain.port(n)).collect();
    let names = plain.nets().to_vec();
    let coverage = covered.coverage();
    let nets: Vec<usize> = coverage
        .iter()
        .map(|c| names.iter().position(|n| *n == c.name).unwrap())
        .collect();
    let mut before: Vec<u128> = nets.iter().map(|net| plain.peek(*net)).collect();
    let mut seen = vec![(0u128, 0u128, 0u128); nets.len()];
    for row in &stimulus.cycles {
        ports
            .iter()
            .zip(row)
            .for_each(|(port, value)| plain.set(*port, *value));
        for ((net, before), (rose, fell, values)) in nets.iter().zip(&mut before).zip(&mut seen) {
            let now = plain.peek(*net);
            *rose |= now & !*before;
            *fell |= !now & *before;
            *values |= 1u128.checked_shl(now as u32).unwrap_or(0);
            *before = now;
        }
        plain.tick();
    }
    record(&mut covered, &stimulus);
    let mut states = 0;
    for (c, (rose, fell, values)) in covered.coverage().iter().zip(&seen) {
        assert_eq!((c.rose, c.fell), (*rose, *fell), "{}", c.name);
        for (index, (state, is_seen)) in c.states.iter().flatten().enumerate() {
            assert_eq!(*is_seen, values >> index & 1 == 1, "{} {state}", c.name);
            states += usize::from(*is_seen);
        }
    }
    assert!(states > 4, "{states}");
}

#[test]
fn a_stop_condition_stops() {
    let mut engine = compiled();
    let trigger = engine.port("trigger");
    let clock = engine.port("endat_clk");
    for (name, value) in [
        ("period_cycles", 12),
        ("data_i", 0),
        ("command", 7),
        ("position_bits", 5),
    ] {
        let id = engine.port(name);
        engine.set(id, value);
    }
    engine.set(trigger, 1);
    assert!(engine.run_until(5000, |e| e.get(clock) == 0));
    assert_eq!(engine.get(clock), 0);
    assert!(!engine.run_until(3, |_| false));
}

/// The card with models: every engine of this project, and lanes. In the slow test over 10^6 cycles, with iverilog and Verilator.
#[test]
fn the_card_agrees_in_every_engine() {
    let frames = card_agrees(30_000, false);
    // Lanes run a twentieth of the cycles: no whole frame.
    assert!(frames.iter().any(|frames| *frames > 0.0), "{frames:?}");
}

#[test]
#[ignore = "slow: a million cycles, with iverilog and Verilator"]
fn the_card_agrees_over_many_cycles() {
    let outside = tools::require("iverilog", "engines: iverilog")
        && tools::require("verilator", "engines: Verilator");
    let frames = card_agrees(1_000_000, outside);
    assert!(frames.iter().all(|frames| *frames > 0.0), "{frames:?}");
}

/// The rates of frames of the engines with models.
fn card_agrees(cycles: usize, outside: bool) -> Vec<f64> {
    let options = bench::Options {
        cycles,
        outside,
        instructions: false,
    };
    let report = bench::run(options, &|_| {}).unwrap();
    assert!(report.is_equal(), "{report}");
    let longest = report.rows.iter().map(|r| r.compared_cycles).max();
    assert_eq!(longest, Some(cycles as u64));
    assert_eq!(
        report.rows.iter().any(|r| r.name.starts_with("Verilator")),
        outside
    );
    let rows = report.rows.iter().filter(|r| r.has_models);
    rows.map(|r| r.frames_per_s.unwrap_or(0.0)).collect()
}

/// 4096 cards in lanes: far below a gigabyte.
#[test]
fn four_thousand_cards_fit() {
    let card = &subject("card").design;
    let lanes = Lanes::new(card, Keep::Registers, LaneWords::Two).unwrap();
    let each = lanes.state_bytes() / lanes.lanes();
    assert!(each * 4096 < 100_000_000, "{each} bytes");
}
