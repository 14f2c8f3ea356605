//! Nothing is sent without a request.

use super::rig::{fixed_times, Rig};
use endat_hdl::endat::{
    channel::{Channel, Features},
    transaction::cause,
};
use endat_hdl::protocol::ModeCommand;
use endat_sim::{
    bench::{Bench, ChannelSettings, Link, PinNames},
    encoder::{area, EncoderConfig},
    line::LineConfig,
    MS, US,
};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::{Compiled, Keep};
use rust_hdl::prelude::Block;

const SYSTEM_HZ: u64 = 32_000_000;
const ENDAT_HZ: u64 = 4_000_000;

/// A host may write any command to the configuration. Most of them have no position in the answer, and some change the encoder.
#[test]
fn a_trigger_sends_no_other_command_than_those_for_a_position() {
    let mut rig = Rig::new(SYSTEM_HZ, ENDAT_HZ, EncoderConfig::endat22(25), 20.0);
    rig.good_position();
    rig.good(ModeCommand::SelectMemory, area::OPERATING_PARAMETERS, 0);
    let frames = rig.bench.frames(0).len();
    let known = ModeCommand::POSITION.map(ModeCommand::code);
    for code in (0..64).filter(|code| !known.contains(code)) {
        rig.bench.set("command", code.into());
        rig.bench.run_cycles(4);
        let over = rig.position();
        assert_eq!(
            cause::name(over.cause),
            "unknown mode command",
            "{code:06b}"
        );
        rig.bench.run_cycles(4);
        assert_eq!(rig.bench.get("fresh"), 0, "{code:06b}");
    }
    assert_eq!(rig.bench.frames(0).len(), frames);
    rig.assert_clean();
    // Nor with a request on its frame: an answer without a position could pass for one.
    rig.bench
        .set("command", ModeCommand::SendPositionAddInfo.code().into());
    rig.bench.run_cycles(4);
    let others = |c: &ModeCommand| !c.has_f2() && !known.contains(&c.code());
    let others: Vec<_> = ModeCommand::ALL.into_iter().filter(others).collect();
    for &command in &others {
        let over = rig.ride(command, 0, 0);
        let told = (cause::name(over.cause), over.is_request);
        assert_eq!(told, ("unknown mode command", true), "{command:?}");
        // The request is dropped.
        rig.bench.run_cycles(4);
        rig.good_position();
    }
    assert_eq!(rig.bench.frames(0).len(), frames + others.len());
    // A separate request frame still works.
    rig.bench
        .set("command", ModeCommand::SendPositionAddInfo.code().into());
    rig.good(
        ModeCommand::PositionSelectMemory,
        area::OPERATING_PARAMETERS,
        0,
    );
    rig.good(ModeCommand::SendTestValues, 0, 0);
}

/// A single inverted flip-flop sends no request, repeats none, and starts no continuous clock.
#[test]
fn one_upset_begins_nothing() {
    let features = Features {
        upset_guards: true,
        ..Features::PROTOCOL
    };
    let mut block = Channel::with(fixed_times(SYSTEM_HZ), features);
    block.connect_all();
    let design = elaborate(&block, "channel").expect("the channel elaborates");
    let engine = Compiled::keeping(&design, Keep::Registers).expect("the channel has no loop");
    let command = ModeCommand::SendPosition;
    let settings = ChannelSettings {
        abort_us: endat_sim::campaign::ABORT_US,
        ..ChannelSettings::new(SYSTEM_HZ, ENDAT_HZ, command, 25)
    };
    let link = || Link::new(LineConfig::cable(20.0), EncoderConfig::endat22(25));
    let mut ready = Bench::channel(engine, SYSTEM_HZ, &settings, link());
    assert!(ready.run_until_done(MS, |b| b.get("busy") == 0));
    ready.trigger();
    assert!(ready.run_until_done(MS, |b| !b.results().is_empty()));
    assert!(ready.run_until_done(MS, |b| b.get("busy") == 0));
    ready.run_for(US);
    let flags: Vec<(usize, String)> = (ready.engine().nets().enumerate())
        .filter(|(_, name)| {
            ["own_asked", "ride_asked", "runs"]
                .iter()
                .any(|n| name.contains(n))
        })
        .map(|(net, name)| (net, name.to_owned()))
        .collect();
    let registers: Vec<usize> = ready.engine().registers().collect();
    let flags: Vec<_> = (flags.into_iter())
        .filter(|(net, _)| registers.contains(net))
        .collect();
    assert_eq!(flags.len(), 6, "{flags:?}");
    for (net, name) in flags {
        let pins = (PinNames::channel(), link());
        let mut bench = Bench::new(ready.engine().clone(), SYSTEM_HZ, vec![pins]);
        bench.configure(&settings);
        bench.run_for(US);
        bench.engine().flip(net, 0);
        bench.run_for(100 * US);
        assert_eq!(bench.frames(0).len(), 0, "{name}");
        bench.trigger();
        assert!(bench.run_until_done(MS, |b| b.get("over") == 1));
        assert!(bench.run_until_done(MS, |b| b.get("busy") == 0));
        bench.run_for(100 * US);
        let new = bench.frames(0);
        assert_eq!(
            (new.len(), new[0].command),
            (1, Some(command.code())),
            "{name}"
        );
        assert_eq!(bench.get("over_request"), 0, "{name}");
    }
}
