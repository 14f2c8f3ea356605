//! The real core, three ways, under stimulus that wanders through as many states as it can without an encoder.

use crate::stimulus::random_stimulus;
use crate::three_way::{three_way, Stimulus};
use endat_config::load_preset;
use endat_hdl::card::Card;
use endat_hdl::endat::channel::{Channel, Features, FixedTimes};
use endat_hdl::endat::sequencer::{Sequencer, PROGRAM_WORDS};
use endat_hdl::protocol::ModeCommand;
use endat_sim::rng::Rng;
use rtl_design::elaborate::elaborate;
use rtl_design::kernel_engine;
use rust_hdl::prelude::Block;
use std::collections::BTreeSet;

/// Lines that keep their level for a while; each has its own average number of cycles between changes.
fn wandering(lines: &[(&str, u64)], cycles: usize, seed: u64) -> Stimulus {
    let mut rng = Rng::new(seed);
    let mut row = vec![0; lines.len()];
    let mut cycle = |_| {
        for (value, (_, hold_cycles)) in row.iter_mut().zip(lines) {
            if rng.in_range(1, *hold_cycles) == 1 {
                *value ^= 1;
            }
        }
        row.clone()
    };
    Stimulus {
        inputs: lines.iter().map(|(name, _)| name.to_string()).collect(),
        cycles: (0..cycles).map(&mut cycle).collect(),
        middle: vec![],
    }
}

/// 1024 words for a sequencer, few of which go back to 0.
pub fn random_program(seed: u64) -> Vec<u32> {
    let mut rng = Rng::new(seed);
    let mut word = || match (rng.next_u64() & 0xfffff) as u32 {
        word if (5..8).contains(&(word >> 16)) => word & 0x2ffff,
        word if word >> 16 == 15 => (word % 6) | 0xf0000,
        word => word,
    };
    (0..1024).map(|_| word()).collect()
}

/// Cycles that begin with one mode command and end with the other.
const QUICK_CYCLES: usize = 3_800;
const CYCLES: usize = 12_000;

#[test]
fn a_channel_agrees() {
    let [results, causes] = channel_agrees("channel", Features::default(), QUICK_CYCLES);
    assert!(results > 3 && causes > 2, "{results} {causes}");
}

#[test]
fn a_channel_with_all_features_agrees() {
    let [results, causes] = channel_agrees("channel_all", Features::PROTOCOL, QUICK_CYCLES);
    assert!(results >= 1 && causes > 1, "{results} {causes}");
}

#[test]
#[ignore = "slow: three times as many cycles"]
fn channels_agree_over_many_cycles() {
    for (name, features) in [
        ("channel_long", Features::default()),
        ("channel_all_long", Features::PROTOCOL),
    ] {
        let [results, causes] = channel_agrees(name, features, CYCLES);
        assert!(results > 10 && causes > 2, "{name}: {results} {causes}");
    }
}

/// The numbers of results and of different causes.
fn channel_agrees(name: &str, features: Features, cycles: usize) -> [usize; 2] {
    let times = FixedTimes {
        calibration_period_cycles: 24,
        ready_low_cycles: 9,
        abort_us: 5,
        park_cycles: 20,
        parameter_timeout_us: 30,
        ..FixedTimes::at(100_000_000)
    };
    let mut block = Channel::with(times, features);
    block.connect_all();
    let design = elaborate(&block, "channel").unwrap();
    let mut kernel = kernel_engine!(block; clock;
        in reset, tick_us, timestamp, trigger, calibrate, phase_mode, fixed_delay, majority;
        out recovery_cycles, delay_cycles, phase, edge_measured, edge_offset, glitch, busy, sample_strobe, sample_second, request_runs, line_high, displaced, reply, calibrated;
        bundles line, settings_in, orders, result, end, record);
    let lines = [
        ("tick_us", 2),
        ("trigger", 8),
        ("calibrate", 700),
        ("data_i", 40),
        ("reset", 3000),
        ("request_ride", 90),
        ("request_own", 200),
        ("request_cancel", 900),
        ("hold_off", 600),
        ("clock_low", 300),
    ];
    let mut stimulus = wandering(&lines, cycles, 3);
    let fixed = [
        ("period_cycles", 12),
        ("first_low_extra_cycles", 5),
        ("command", 0b111000),
        ("position_bits", 7),
        ("filter_cycles", 1),
        ("filter_half", 1),
        ("start_window_cycles", 6),
        ("start_timeout_us", 20),
        ("recovery_limit_cycles", 300),
        ("recovery_min_cycles", 40),
        ("watchdog_us", 100),
        ("continuous", 1),
        ("stop_at_error", 0),
        ("timestamp", 0),
        ("phase_mode", 0),
        ("fixed_delay", 0),
        ("majority", 0),
        ("request_command", 0),
        ("request_parameter", 0x5C_A3C5),
        ("forced", 0),
    ];
    for (name, value) in fixed {
        stimulus.inputs.push(name.into());
        for (cycle, row) in stimulus.cycles.iter_mut().enumerate() {
            row.push(match name {
                "timestamp" => cycle as u128,
                "request_command" => {
                    let commands = ModeCommand::ALL;
                    commands[cycle / 50 % commands.len()].code().into()
                }
                // Stretches with the one command, and with the other.
                "command" if cycle % 6_000 > 3_000 => 0b000111,
                "stop_at_error" => u128::from(cycle % 4_000 > 2_000),
                _ => value,
            });
        }
    }
    for row in stimulus.cycles.iter_mut() {
        row[4] &= row[1] & row[0]; // reset is rare and short
        row[8] &= row[1];
    }
    let recording = three_way(name, &mut kernel, &design, &stimulus).unwrap();
    // Frames end in different ways.
    let results: u128 = recording.output("result_strobe").iter().sum();
    let causes: BTreeSet<u128> = recording.output("cause").into_iter().collect();
    [results as usize, causes.len()]
}

/// The quick test of the card is `engines::the_card_agrees_in_every_engine`.
#[test]
#[ignore = "slow: the card with iverilog and its kernels"]
fn the_card_agrees() {
    let project = load_preset("s6_two_channel").unwrap();
    let mut block = Card::new(&project.card);
    block.connect_all();
    let design = elaborate(&block, &project.name).unwrap();
    let mut kernel = endat_workshop::bench::card_kernels(block);
    let lines = [
        ("trigger_i", 300),
        ("uart_rx_i", 100),
        ("endat_data0_i", 150),
        ("endat_data1_i", 60),
        ("rst_i", 1),
    ];
    let mut stimulus = wandering(&lines, 8_000, 5);
    for (cycle, row) in stimulus.cycles.iter_mut().enumerate() {
        // A reset would be followed by 30 ms of quiet.
        row[4] = u128::from(cycle == usize::MAX);
    }
    let recording = three_way("card", &mut kernel, &design, &stimulus).unwrap();
    let edges = recording
        .output("endat_clk0_o")
        .windows(2)
        .filter(|w| w[0] != w[1])
        .count();
    assert!(edges > 20, "{edges} clock edges");
}

/// A random program, one word in eight of which goes to another place, with a host that reads and writes.
#[test]
fn a_sequencer_agrees() {
    sequencer_agrees("sequencer", false, 3_000, [200, 50]);
}

#[test]
fn a_shared_sequencer_agrees() {
    sequencer_agrees("shared_sequencer", true, 3_000, [200, 50]);
}

#[test]
#[ignore = "slow: four times as many cycles"]
fn sequencers_agree_over_many_cycles() {
    sequencer_agrees("sequencer_long", false, 12_000, [200, 50]);
    sequencer_agrees("shared_sequencer_long", true, 12_000, [200, 50]);
}

/// `least` different words come out of the port, and of the host's side.
fn sequencer_agrees(name: &str, is_shared: bool, cycles: usize, least: [usize; 2]) {
    let mut block = Sequencer::new(&random_program(5), is_shared);
    block.connect_all();
    let design = elaborate(&block, "sequencer").unwrap();
    let memories = &design.top().memories;
    let given: Vec<usize> = memories.iter().map(|m| m.start.len()).collect();
    assert_eq!(given, [PROGRAM_WORDS, 0, 0]);
    let mut kernel = kernel_engine!(block; clock;
        in reset, restart, port_in, host_address, host_second, host_read, host_clear, host_write, host_half, host_data;
        out port_address, port_second, port_out, port_read, port_write, host_word);
    let mut stimulus = random_stimulus(&kernel, cycles, 12);
    for (name, period_cycles) in [
        ("reset", 1500),
        ("restart", 97),
        ("host_read", 10),
        ("host_clear", 40),
        ("host_write", 13),
    ] {
        let at = stimulus.inputs.iter().position(|n| n == name).unwrap();
        for (cycle, row) in stimulus.cycles.iter_mut().enumerate() {
            row[at] = (cycle % period_cycles == 0).into();
        }
    }
    let seen = three_way(name, &mut kernel, &design, &stimulus).unwrap();
    let distinct = |name: &str| seen.output(name).into_iter().collect::<BTreeSet<_>>().len();
    let found = ["port_out", "host_word"].map(distinct);
    assert!(found[0] > least[0] && found[1] > least[1], "{found:?}");
    assert_eq!(distinct("port_write"), 2);
    assert_eq!(distinct("port_second"), 1 + usize::from(is_shared));
}
