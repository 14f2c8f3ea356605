//! A second receiver on the same samples: it agrees where nothing is upset, and tells where something is.

use super::{at, frame, Master, WORD_BUSES};
use crate::three_way::{three_way, Stimulus};
use endat_hdl::card::bus::HostBus;
use endat_hdl::endat::features::Features;
use endat_hdl::endat::second_receiver::SecondReceiver;
use endat_hdl::endat::service::map::force;
use endat_hdl::endat::transaction::cause;
use endat_hdl::regs::{RESULT, SERVICE};
use endat_sim::campaign::faults::Faults;
use endat_sim::campaign::port::Port;
use endat_sim::campaign::upsets::{Draw, Upsets};
use endat_sim::campaign::{run_shard, Campaign, Shard, Tally};
use endat_sim::rng::Rng;
use rtl_design::elaborate::elaborate;
use rtl_design::engine::{Compiled, Engine};
use rtl_design::kernel_engine;
use rust_hdl::prelude::Block as _;

const SECOND: &str = "[safety]\nparts = [\"second_receiver\"]\n";
const WITH_SERVICE: &str =
    "[service]\nparts = [\"requests\"]\n[safety]\nparts = [\"second_receiver\"]\n";

/// Cause of a channel's last result, and whether it brought a position.
fn told(master: &mut Master, channel: usize) -> (u64, bool) {
    let status = master.read(at(&RESULT, "status", channel));
    let field = |name| u64::from(RESULT.field("status", name).of(status));
    (field("cause"), field("fresh") == 1)
}

/// Catches a comparison that finds something where nothing is wrong, and one that finds nothing at all.
fn two_receivers_agree(buses: &[HostBus]) {
    for &bus in buses {
        let mut master = Master::new(bus, WITH_SERVICE);
        for _ in 0..4 {
            frame(&mut master);
            for channel in 0..2 {
                assert_eq!(told(&mut master, channel), (cause::NONE, true), "{bus:?}");
            }
        }
        // Of channel 1 only; a host that forces it for frames of requests leaves the positions alone.
        for (forced, want) in [
            (force::SECOND_RECEIVER, (cause::UPSET, false)),
            (
                force::SECOND_RECEIVER | force::OWN_FRAMES,
                (cause::NONE, true),
            ),
            (force::CRC | force::OWN_FRAMES, (cause::NONE, true)),
            (0, (cause::NONE, true)),
        ] {
            master.write(at(&SERVICE, "force", 1), forced.into());
            frame(&mut master);
            assert_eq!(
                told(&mut master, 0),
                (cause::NONE, true),
                "{bus:?} {forced}"
            );
            assert_eq!(told(&mut master, 1), want, "{bus:?} {forced}");
        }
    }
}

#[test]
fn two_receivers_agree_until_one_is_made_to_differ() {
    two_receivers_agree(&[HostBus::AhbLite]);
}

#[test]
#[ignore = "slow: the second receiver with each bus and without a service"]
fn two_receivers_agree_with_each_bus() {
    two_receivers_agree(&WORD_BUSES);
    // The second receiver needs no service.
    let mut master = Master::new(HostBus::Apb, SECOND);
    frame(&mut master);
    assert_eq!(told(&mut master, 0), (cause::NONE, true));
}

fn counted(campaign: &dyn Campaign, part: Shard) -> Tally {
    run_shard(campaign, part, 0, |_| {})
}

/// Catches a difference that noise, a torn wire or a plug makes between the receivers: such a frame would be reported as upset.
/// Faults begin or end at every 23rd quarter of a bit.
fn faults_leave_the_receivers_equal(part: Shard, [detected, masked]: [u64; 2]) {
    let faults = Faults::new(&[Port::SecondReceiver], 23, 5).unwrap();
    let tally = counted(&faults, part);
    let class = |name: &str| tally.count(|row| row.class == name);
    let counts = [class("detected"), class("masked")];
    println!("{counts:?}");
    assert!(counts[0] > detected && counts[1] > masked, "{counts:?}");
    let upset = format!("cause_{}", cause::UPSET);
    assert_eq!(class(&upset), 0);
}

#[test]
fn faults_of_the_line_leave_the_receivers_equal() {
    faults_leave_the_receivers_equal(Shard { index: 3, of: 18 }, [150, 25]);
}

#[test]
#[ignore = "slow: faults of the line at hundreds of moments"]
fn no_fault_of_the_line_makes_the_receivers_differ() {
    faults_leave_the_receivers_equal(Shard::WHOLE, [3_000, 500]);
}

/// Catches a comparison that does not cover all of an answer, or ends early. Each flip-flop is inverted at so many moments.
/// `with_alone` shows that upsets of a receiver without a second one stay silent.
fn upsets_are_reported(moments: u64, part: Shard, with_alone: bool, least: u64) {
    let of = |port, only: &str| {
        let draw = Draw::Grid { moments };
        counted(&Upsets::new(&[port], draw, 3, only).unwrap(), part)
    };
    let class = |tally: &Tally, name: &str, of: &str| {
        tally.count(|row| row.class == name && row.place.starts_with(of))
    };
    const RECEIVERS: [&str; 2] = ["receiver.", "second_0."];
    let both = of(Port::SecondReceiver, &RECEIVERS.join(","));
    let silent: Vec<String> = both
        .rows()
        .filter(|(row, _)| row.class == "silent")
        .map(|(row, n)| format!("{} {}: {n}", row.kind, row.place))
        .collect();
    assert!(silent.is_empty(), "{silent:?}");
    if with_alone {
        let alone = of(Port::AllParts, RECEIVERS[0]);
        let other = [&both, &alone].map(|tally| class(tally, "silent_other", RECEIVERS[0]));
        assert!(class(&alone, "silent", RECEIVERS[0]) > 0);
        assert!(other[0] <= other[1], "{other:?}");
    }
    let detected = RECEIVERS.map(|receiver| class(&both, "detected", receiver));
    assert!(detected.iter().all(|n| *n > least), "{detected:?}");
}

/// The second of the seven kinds of frames.
const POSITIONS: Shard = Shard { index: 2, of: 7 };

#[test]
fn upsets_of_either_receiver_are_reported() {
    upsets_are_reported(4, POSITIONS, false, 30);
}

#[test]
#[ignore = "slow: every flip-flop of two receivers at 24 moments"]
fn upsets_of_either_receiver_are_reported_at_any_moment() {
    upsets_are_reported(24, Shard::WHOLE, true, 300);
}

/// Catches a comparison that the emitted Verilog makes in another cycle; in so many cycles.
fn second_receivers_agree(rows: usize) {
    let features = Features::PROTOCOL;
    let mut block = SecondReceiver::new(features);
    block.connect_all();
    let design = elaborate(&block, "second_receiver").unwrap();
    let mut kernel = kernel_engine!(block; clock;
        in reset, rise, level, look, payload_bits, infos, command, payload, crc_received, forced, good, cause, flags;
        out differs, good_told, cause_told, flags_told;
        bundles control, cells, shape, progress, check);
    let mut rng = Rng::new(11);
    let engine = Compiled::new(&design).unwrap();
    let inputs = engine.ports().iter().filter(|p| p.is_input);
    let names: Vec<String> = inputs.map(|p| p.name.clone()).collect();
    let mut cycles = Vec::with_capacity(rows);
    for cycle in 0..rows {
        let value = |name: &String| match name.as_str() {
            "reset" => u128::from(cycle < 3),
            "payload" => u128::from(rng.next_u64() >> 16),
            "payload_bits" => 9,
            "command" => 0x38,
            "has_f1" | "has_f2" => 1,
            "infos" | "has_parameter" | "has_supplement" | "forced" | "going_on" => 0,
            "crc_received" => u128::from(rng.next_u64() & 31),
            "start" => u128::from(cycle % 150 == 10),
            "sample" | "pulse" => u128::from(cycle % 4 == 1),
            _ => u128::from(rng.next_u64() & 1),
        };
        cycles.push(names.iter().map(value).collect());
    }
    let stimulus = Stimulus {
        inputs: names,
        cycles,
        middle: vec![],
    };
    let seen = three_way(
        &format!("second_receiver_{rows}"),
        &mut kernel,
        &design,
        &stimulus,
    )
    .unwrap();
    assert!(seen.output("differs").contains(&1));
}

#[test]
fn second_receivers_agree_in_three_ways() {
    second_receivers_agree(1_000);
}

#[test]
#[ignore = "slow: kernels, engines and simulators on thousands of cycles of the second receiver"]
fn second_receivers_agree_in_three_ways_for_long() {
    second_receivers_agree(3_000);
}
