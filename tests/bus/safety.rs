//! What watches a channel beside it: the recovery time measured a second time.

use super::{at, frame, sound, text, Master, WORD_BUSES};
use crate::three_way::{three_way, Stimulus};
use endat_config::parse;
use endat_hdl::card::bus::HostBus;
use endat_hdl::card::recovery_counter::RecoveryCounter;
use endat_hdl::regs::{COUNTER_SPACING, RECOVERY, RESULT};
use endat_sim::encoder::{Defect, EncoderConfig};
use endat_sim::rng::Rng;
use endat_sim::{NS, US};
use rtl_design::elaborate::elaborate;
use rtl_design::kernel_engine;
use rust_hdl::prelude::Block as _;

const SAFETY: &str = "[safety]\nparts = [\"recovery_counter\"]\n";

fn card(bus: HostBus, first: EncoderConfig) -> Master {
    let project = parse("card.toml", &text(bus, SAFETY)).unwrap();
    Master::with_encoders(&project, vec![(0, first), (1, sound(1, 25))])
}

/// From rise to fall, in cycles, and whether fall belongs to it.
fn measured(master: &mut Master, channel: usize) -> (u16, bool) {
    let edges = master.read(at(&RECOVERY, "edges", channel));
    let counter = master.read(at(&RECOVERY, "counter", channel));
    let difference = ((edges >> 16) as u16).wrapping_sub(edges as u16);
    (difference, counter >> 16 & 1 != 0)
}

/// What the channel itself has measured: recovery time and line delay.
fn told(master: &mut Master, channel: usize) -> u16 {
    let recovery = RESULT.field("age_recovery", "recovery_cycles");
    let delay = RESULT.field("evidence", "delay_cycles");
    let recovery = recovery.of(master.read(at(&RESULT, "age_recovery", channel)));
    let delay = delay.of(master.read(at(&RESULT, "evidence", channel)));
    (recovery + delay) as u16
}

/// Catches a counter that is kept at another edge, a word torn between two moments, and a second measurement that follows the first.
fn both_measurements_agree(buses: &[HostBus]) {
    for &bus in buses {
        let mut first = sound(0, 29);
        first.tm = 10 * US..=30 * US;
        let mut master = card(bus, first);
        let mut seen = vec![];
        for round in 0..12 {
            frame(&mut master);
            for channel in 0..2 {
                let (difference, fallen) = measured(&mut master, channel);
                let own = told(&mut master, channel);
                // The channel counts one cycle from its pins to the edge and one to the level more.
                let apart = difference.wrapping_sub(own) as i16;
                assert!(
                    fallen && (-3..=1).contains(&apart),
                    "{bus:?} {round} {channel}: {difference}, the channel {own}"
                );
                if channel == 0 {
                    seen.push(difference);
                }
            }
        }
        seen.sort_unstable();
        seen.dedup();
        assert!(seen.len() > 6, "each frame has its own: {seen:?}");
    }
}

#[test]
fn the_recovery_time_is_measured_twice_and_both_agree() {
    both_measurements_agree(&[HostBus::Wishbone]);
}

#[test]
#[ignore = "slow: the second measurement of the recovery time with each bus"]
fn the_recovery_time_is_measured_twice_with_each_bus() {
    both_measurements_agree(&WORD_BUSES);
}

/// Catches a counter that is set back, stands still, or runs with another's.
#[test]
fn the_counters_run_and_never_meet() {
    let mut master = card(HostBus::Wishbone, sound(0, 29));
    let counter = |master: &mut Master, channel| {
        let before = master.bench.now();
        let word = master.read(at(&RECOVERY, "counter", channel)) as u16;
        (word, before)
    };
    let cycle = 10 * NS;
    let mut last = [None::<(u16, i64)>; 2];
    for round in 0..20 {
        if round % 4 == 0 {
            frame(&mut master);
        }
        master.bench.run_cycles(997);
        let now = [counter(&mut master, 0), counter(&mut master, 1)];
        for (channel, (value, time)) in now.into_iter().enumerate() {
            let time = time as i64;
            if let Some((earlier, then)) = last[channel] {
                let cycles = (time - then) / cycle as i64;
                let apart = value.wrapping_sub(earlier).wrapping_sub(cycles as u16) as i16;
                assert!((-2..=2).contains(&apart), "{channel}: {apart}");
            }
            last[channel] = Some((value, time));
        }
        let cycles = (now[1].1 as i64 - now[0].1 as i64) / cycle as i64;
        let apart = now[1].0.wrapping_sub(now[0].0).wrapping_sub(cycles as u16);
        assert!(apart.abs_diff(COUNTER_SPACING) <= 2, "{apart}");
    }
}

/// Catches an old edge that passes for a new one.
#[test]
fn data_that_does_not_fall_is_told() {
    let stuck = sound(0, 29).defect(3, Defect::LateFall(20_000 * US));
    let mut master = card(HostBus::Apb, stuck);
    frame(&mut master);
    frame(&mut master);
    assert!(measured(&mut master, 0).1);
    frame(&mut master);
    assert!(measured(&mut master, 1).1, "the other channel");
    assert!(!measured(&mut master, 0).1);
}

/// Catches bits of the answer that come in behind the last edge of CLOCK and pass for the end of the recovery time.
#[test]
fn data_that_does_not_fall_is_told_on_a_long_cable() {
    let text = text(HostBus::Wishbone, SAFETY)
        .replace(
            "clock_hz = 3_125_000",
            "clock_hz = 8_000_000\ncable_m = 150",
        )
        .replace("100_000_000", "96_000_000");
    let project = parse("card.toml", &text).unwrap();
    let stuck = |seed, bits| {
        (3..12).fold(sound(seed, bits), |e, frame| {
            e.defect(frame, Defect::LateFall(20_000 * US))
        })
    };
    for seed in 0..8 {
        let mut master = Master::with_cable(
            &project,
            vec![(0, stuck(seed, 29)), (1, sound(1, 25))],
            150.0,
        );
        frame(&mut master);
        frame(&mut master);
        assert!(measured(&mut master, 0).1, "{seed}");
        frame(&mut master);
        assert!(measured(&mut master, 1).1, "{seed}");
        assert!(!measured(&mut master, 0).1, "{seed}");
    }
}

/// Catches a part that no host finds: its bit stands in a word of its own.
#[test]
fn a_host_finds_the_part() {
    let file = crate::tools::folder("safety-host").join("card.toml");
    std::fs::write(&file, text(HostBus::AxiLite, SAFETY)).unwrap();
    let port = format!("virtual:{}", file.display());
    for name in ["recovery0.edges", "recovery1.counter"] {
        let outcome = crate::program::run(&["reg", "read", name, "--port", &port]);
        assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    }
    let write = ["reg", "write", "recovery0.edges", "1", "--port", &port];
    let outcome = crate::program::run(&write);
    assert!(outcome.messages[0].contains("is read only"), "{outcome:?}");
}

#[test]
fn the_block_agrees_in_three_ways() {
    let mut block = RecoveryCounter::new(5);
    block.connect_all();
    let design = elaborate(&block, "recovery_counter").unwrap();
    let mut kernel = kernel_engine!(block; clock;
        in reset, endat_clk, data_oe, data_i, word_address, in_range, lane;
        out read_byte);
    let names = [
        "reset",
        "endat_clk",
        "data_oe",
        "data_i",
        "word_address",
        "in_range",
        "lane",
    ];
    let mut rng = Rng::new(3);
    let first = RECOVERY.base + 5 * RECOVERY.stride;
    let row = |cycle: usize| -> Vec<u128> {
        vec![
            u128::from(cycle < 2 || cycle == 3_000),
            (rng.in_range(0, 3) != 0).into(),
            (rng.in_range(0, 3) == 0).into(),
            rng.in_range(0, 1).into(),
            u128::from(first) + u128::from(rng.in_range(0, 2)),
            (rng.in_range(0, 9) != 0).into(),
            (cycle % 4) as u128,
        ]
    };
    let stimulus = Stimulus {
        inputs: names.map(str::to_owned).to_vec(),
        cycles: (0..6_000).map(row).collect(),
        middle: vec![],
    };
    let seen = three_way("recovery_counter", &mut kernel, &design, &stimulus).unwrap();
    assert!(seen.output("read_byte").iter().filter(|v| **v != 0).count() > 1_000);
}

#[test]
fn the_part_is_refused_where_nobody_could_read_it() {
    let bare = text(HostBus::Bare, SAFETY).replacen(
        "[[channel]]\nposition_bits = 25\ncommand = \"000111\"\n",
        "",
        1,
    );
    let t_format = text(HostBus::Apb, SAFETY)
        .replace(
            "position_bits = 29\ncommand = \"111000\"",
            "protocol = \"t_format\"",
        )
        .replace(
            "position_bits = 25\ncommand = \"000111\"",
            "protocol = \"t_format\"",
        )
        .replace("[endat]\nclock_hz = 3_125_000\n", "");
    for (text, told) in [
        (bare, "host.bus = \"none\" has no registers"),
        (t_format, "no channel speaks EnDat"),
        (
            text(HostBus::Apb, "[safety]\nparts = [\"airbag\"]\n"),
            "unknown part; use recovery_counter",
        ),
    ] {
        let all = parse("card.toml", &text).unwrap_err();
        assert_eq!(all.len(), 1, "{all:?}");
        assert!(all[0].to_string().contains(told), "{all:?}");
    }
}

/// Catches a part that is taken where it cannot work, and a message that names only the first of two.
#[test]
fn parts_are_refused_each_with_its_reason() {
    let safety = |more: &str| text(HostBus::Apb, more);
    let double = "[line]\nparts = [\"alignment\", \"double_edge\"]\n";
    for (text, told) in [
        (
            safety(&format!("{double}[safety]\nparts = [\"second_receiver\", \"error_test\"]\n")),
            vec![
                "safety.parts = \"second_receiver\": bits of line.parts",
                "safety.parts = \"error_test\": frames of its own take the service",
            ],
        ),
        (
            safety("[safety]\nparts = []\nerror_test_ms = 100\n"),
            vec!["safety.error_test_ms = 100: takes the part error_test"],
        ),
        (
            safety("[service]\nparts = [\"requests\"]\n[safety]\nparts = [\"error_test\"]\nerror_test_ms = 9\n"),
            vec!["safety.error_test_ms = 9: outside 10..32000"],
        ),
        (
            text(HostBus::Bare, "[safety]\nparts = [\"error_test\", \"second_receiver\"]\n").replacen(
                "[[channel]]\nposition_bits = 25\ncommand = \"000111\"\n",
                "",
                1,
            ),
            vec!["safety.parts = \"error_test\": host.bus = \"none\" has no registers"],
        ),
    ] {
        let all = parse("card.toml", &text).unwrap_err();
        let all: Vec<String> = all.iter().map(ToString::to_string).collect();
        assert_eq!(all.len(), told.len(), "{all:?}");
        for (said, part) in all.iter().zip(told) {
            assert!(said.contains(part), "{said}: {part}");
        }
    }
}
