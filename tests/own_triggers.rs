//! Cards whose channels have triggers of their own: configuration, results, stream, files.

use crate::bus::Master;
use endat_config::parse;
use endat_hdl::regs::{CARD, CARD_CONFIG, RESULT};
use endat_host::stream::{Decoder, SampleSet};

/// A card on APB with a quick channel and a slow one, whose keys are given.
fn text(more: &str) -> String {
    format!(
        "name = \"own_triggers\"\n[clock]\nsystem_hz = 100_000_000\n[endat]\ncable_m = 20\n\
         [[channel]]\nposition_bits = 25\ncommand = \"111000\"\nclock_hz = 6_250_000\n\
         [[channel]]\nposition_bits = 29\ncommand = \"111000\"\nclock_hz = 500_000\n{more}\
         [trigger]\nsample_hz = 20_000\nsources = [\"timer\"]\n[host]\nbus = \"apb\"\n\
         [stream]\nfifo_bytes = 2048\nstart = \"collect\"\n"
    )
}

fn problems(more: &str) -> Vec<String> {
    let problems = parse("card.toml", &text(more)).unwrap_err();
    problems.iter().map(ToString::to_string).collect()
}

#[test]
fn the_slowest_encoder_does_not_set_the_rate_of_all() {
    let too_fast = problems("");
    assert!(too_fast[0].contains("a frame of channel 1"), "{too_fast:?}");
    let too_fast = problems("divider = 2\n");
    for part in [
        "a frame of channel 1",
        "so at most 15844 Hz;",
        ", or raise divider = 2",
    ] {
        assert!(too_fast[0].contains(part), "{too_fast:?}");
    }
    for own in [
        "divider = 4\n",
        "sources = [\"pin\"]\n",
        "enabled = false\n",
    ] {
        let project = parse("card.toml", &text(own)).unwrap();
        assert!(project.card.own_triggers(), "{own}");
    }
}

#[test]
fn wrong_keys_of_a_channel_are_told_with_the_remedy() {
    for (keys, expected) in [
        ("divider = 0\n", "card.toml:14: channel[1].divider = 0: outside 1..32; choose a value in that range"),
        ("divider = 33\n", "card.toml:14: channel[1].divider = 33: outside 1..32; choose a value in that range"),
        ("enabled = 1\n", "card.toml:14: channel[1].enabled = 1: is an integer, must be true or false, without quotes"),
        ("sources = [\"pn\"]\n", "card.toml:14: channel[1].sources = \"pn\": unknown trigger; use pin, timer, register"),
    ] {
        assert!(problems(keys).iter().any(|p| p == expected), "{:?}", problems(keys));
    }
}

/// What the stream has collected.
fn sets(master: &mut Master) -> Vec<SampleSet> {
    let at = |name: &str| CARD.address(CARD.register(name).unwrap(), 0);
    let mut decoder = Decoder::default();
    while master.read(at("stream_state")) & 0xffff != 0 {
        let bytes = master.read(at("stream_data")).to_be_bytes();
        bytes.iter().for_each(|byte| decoder.push(*byte));
    }
    decoder.take()
}

#[test]
fn a_divided_channel_has_its_share_of_results_and_sets() {
    let project = parse("card.toml", &text("divider = 4\n")).unwrap();
    let mut master = Master::with_widths(&project, &[25, 29]);
    // The calibration frames; the stream begins behind them.
    master.bench.run_cycles(60_000);
    sets(&mut master);
    let mut all = Vec::new();
    for _ in 0..20 {
        master.bench.run_cycles(20_000);
        all.extend(sets(&mut master));
    }
    assert!(all.len() > 70, "{} sets", all.len());
    let parts = |n: usize| all.iter().map(move |set| set.channels[n]);
    assert!(parts(0).all(|p| p.taken && p.fresh && !p.missing));
    let taken: Vec<usize> = (0..all.len())
        .filter(|n| all[*n].channels[1].taken)
        .collect();
    assert!(taken.windows(2).all(|w| w[1] - w[0] == 4), "{taken:?}");
    // Its frame is longer than the trigger's period: it comes too late for its own set, and has its place in a later one.
    assert!(parts(1).all(|p| p.missing || !p.taken));
    let late: Vec<u64> = parts(1)
        .filter(|p| p.is_late())
        .map(|p| p.position)
        .collect();
    assert!(parts(1)
        .filter(|p| p.is_late())
        .all(|p| p.fresh && p.cause == 0));
    assert!(
        late.len().abs_diff(taken.len()) <= 1,
        "{} of {}",
        late.len(),
        taken.len()
    );
    let frames: Vec<u64> = master.bench.frames(1).iter().map(|f| f.position).collect();
    let first = frames.iter().position(|p| *p == late[0]).expect("a frame");
    assert_eq!(late[..], frames[first..first + late.len()]);
    let result = |master: &mut Master, name: &str, n| {
        master.read(RESULT.address(RESULT.register(name).unwrap(), n))
    };
    for _ in 0..200 {
        master.bench.run_cycles(1_777);
        let words = [0, 1].map(|n| {
            let sequence = result(&mut master, "status", n) & 0xffff;
            (sequence, result(&mut master, "timestamp", n))
        });
        let [(quick, early), (slow, late)] = words;
        assert!((quick / 4).abs_diff(slow) <= 2, "{quick} {slow}");
        // Both started in the same cycle, or the quick one a number of periods later.
        let apart = early.wrapping_sub(late) % 5_000;
        assert_eq!(apart, 0, "{early} {late}");
    }
}

#[test]
fn an_open_plug_is_disabled_and_reports_no_more() {
    let project = parse("card.toml", &text("divider = 4\n")).unwrap();
    let mut master = Master::with_widths(&project, &[25]);
    master.bench.run_cycles(400_000);
    let status = RESULT.address(RESULT.register("status").unwrap(), 1);
    let before = master.read(status);
    assert_ne!(before & 0xffff, 0, "it reports");
    let sources = CARD_CONFIG.address(CARD_CONFIG.register("trigger_sources").unwrap(), 0);
    master.write(sources, 2 | 2 << 8);
    master.bench.run_cycles(20_000);
    let at_rest = master.read(status);
    sets(&mut master);
    master.bench.run_cycles(200_000);
    assert_eq!(master.read(status), at_rest);
    let all = sets(&mut master);
    assert!(
        all.len() > 30
            && all
                .iter()
                .all(|s| !s.channels[1].taken && s.channels[0].fresh)
    );
}

#[test]
fn a_card_without_own_triggers_has_no_logic_for_them() {
    let plain = crate::bus_card::text(endat_hdl::card::bus::HostBus::Apb, "");
    let project = parse("card.toml", &plain).unwrap();
    assert!(!project.card.own_triggers());
    let has_it = |project| {
        let files = endat_emit::emit(project).unwrap();
        crate::emitted::has_block(&files, "channel_trigger")
    };
    assert!(!has_it(&project));
    assert!(has_it(&parse("card.toml", &text("divider = 4\n")).unwrap()));
}
