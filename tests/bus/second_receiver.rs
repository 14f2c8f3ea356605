//! A second receiver on the same samples: it agrees where nothing is upset, and tells where something is.

use super::{at, frame, Master, WORD_BUSES};
use crate::three_way::{three_way, Stimulus};
use crate::tools::is_whole;
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
#[test]
fn two_receivers_agree_until_one_is_made_to_differ() {
    for bus in WORD_BUSES {
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
    // Nothing of it needs a service.
    let mut master = Master::new(HostBus::Apb, SECOND);
    frame(&mut master);
    assert_eq!(told(&mut master, 0), (cause::NONE, true));
}

fn counted(campaign: &dyn Campaign) -> Tally {
    run_shard(campaign, Shard::WHOLE, 0, |_| {})
}

/// Catches a difference that noise, a torn wire or a plug makes between the receivers: such a frame would be told as upset.
#[test]
fn no_fault_of_the_line_makes_the_receivers_differ() {
    let tally = counted(&Faults::new(&[Port::SecondReceiver], 23, 5).unwrap());
    let class = |name: &str| tally.count(|row| row.class == name);
    assert!(class("detected") > 3_000 && class("masked") > 500);
    let upset = format!("cause_{}", cause::UPSET);
    assert_eq!(class(&upset), 0);
}

/// Catches a comparison that does not look at all of an answer, or not to the end.
#[test]
fn upsets_of_either_receiver_are_told() {
    let of = |port, only: &str| {
        let moments = if is_whole() { 24 } else { 8 };
        let draw = Draw::Grid { moments };
        counted(&Upsets::new(&[port], draw, 3, only).unwrap())
    };
    let class = |tally: &Tally, name: &str| tally.count(|row| row.class == name);
    let rest = |tally: &Tally| {
        let wrong = tally.rows().filter(|(row, _)| row.class == "silent");
        wrong
            .map(|(row, n)| format!("{} {}: {n}", row.kind, row.place))
            .collect::<Vec<_>>()
    };
    let alone = of(Port::AllParts, "receiver.");
    let first = of(Port::SecondReceiver, "receiver.");
    let second = of(Port::SecondReceiver, "second_0.");
    let silent = [&alone, &first, &second].map(|tally| class(tally, "silent"));
    println!("{silent:?}: {:?}", rest(&first));
    assert_eq!(silent[2], 0, "{:?}", rest(&second));
    assert!(
        silent[0] > 0 && silent[1] == 0,
        "{silent:?}: {:?}",
        rest(&first)
    );
    assert!(class(&first, "silent_other") <= class(&alone, "silent_other"));
    let detected = [&first, &second].map(|tally| class(tally, "detected"));
    assert!(detected.iter().all(|n| *n > 300), "{detected:?}");
}

/// Catches a comparison that the emitted Verilog makes in another cycle.
#[test]
fn second_receivers_agree_in_three_ways() {
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
    let rows = 3_000;
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
    let seen = three_way("second_receiver", &mut kernel, &design, &stimulus).unwrap();
    assert!(seen.output("differs").contains(&1));
}
