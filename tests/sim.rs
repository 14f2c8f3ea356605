//! The bench from the command line: the elaborated channel in every scenario.

use crate::program::{bad, good, run, Dir};
use endat_hdl::endat::channel::{Channel, FixedTimes};
use endat_hdl::endat::service::program::{steps, Step};
use endat_sim::encoder::Defect;
use endat_sim::scenario::{self, RunOptions};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::Compiled;
use rust_hdl::prelude::Block;
use std::fs;
use std::sync::OnceLock;

/// The scenario that lasts two seconds.
const LONG: &str = "initialise";

/// The scenarios on the channel as it is elaborated for emission; the test of its steps runs the long one.
#[test]
fn the_core_is_sound_in_every_scenario() {
    is_sound_in(|name| name != LONG);
}

#[test]
#[ignore = "slow: the core in the scenario of two seconds"]
fn the_core_is_sound_while_it_initialises() {
    is_sound_in(|name| name == LONG);
}

fn is_sound_in(chosen: impl Fn(&str) -> bool) {
    let list: serde_json::Value =
        serde_json::from_str(&good(&["sim", "--list", "--json"])).unwrap();
    let names: Vec<&str> = list
        .as_array()
        .unwrap()
        .iter()
        .map(|s| s["name"].as_str().unwrap())
        .collect();
    assert!(
        names.contains(&"paper") && names.contains(&"real-1"),
        "{names:?}"
    );
    for name in names.into_iter().filter(|name| chosen(name)) {
        let report: serde_json::Value =
            serde_json::from_str(&good(&["sim", name, "--json"])).unwrap();
        for channel in report.as_array().unwrap() {
            assert_eq!(channel["complaints"], serde_json::json!([]), "{name}");
            let positions = match channel["exchanges"].as_array() {
                Some(exchanges) => exchanges
                    .iter()
                    .filter(|e| e["position"].is_number())
                    .count(),
                None => channel["channels"][0]["frames"]
                    .as_array()
                    .unwrap()
                    .iter()
                    .filter(|f| f["result"]["position"].is_number())
                    .count(),
            };
            assert!(positions > 0, "{name} brought no position");
        }
    }
}

#[test]
fn the_real_frame_has_its_66_rising_edges_and_can_be_looked_at() {
    let dir = Dir::new("sim");
    let (vcd, svg) = (dir.path("real.vcd"), dir.path("real.svg"));
    let outcome = run(&["sim", "real-1", "--json", "--vcd", &vcd, "--svg", &svg]);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    assert_eq!(outcome.messages.len(), 3, "{:?}", outcome.messages);
    let report: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
    let frames = report[0]["channels"][0]["frames"]
        .as_array()
        .unwrap()
        .clone();
    let last = &frames[frames.len() - 1];
    assert_eq!(last["encoder"]["rising_edges"], 66);
    assert_eq!(last["result"]["crc_received"], 0x19);
    assert!(fs::read_to_string(&vcd)
        .unwrap()
        .contains("$enddefinitions"));
    assert!(fs::read_to_string(&svg).unwrap().starts_with("<svg"));
    assert!(dir.0.join("real.gtkw").exists());
    assert!(
        bad(&["sim", "real-1", "--svg", &dir.0.display().to_string()], 2)
            .contains("is a folder, not a file")
    );
    assert!(bad(&["sim", "real-1", "--vcd", "/"], 2).contains("is not the name of a file"));
}

/// Catches a story of a T-format encoder without its line, and one that takes options which mean nothing there.
#[test]
fn the_line_of_a_t_format_encoder_can_be_written_and_is_not_drawn() {
    let dir = Dir::new("sim_t_format");
    let (vcd, wires) = (dir.path("all.vcd"), dir.path("line.vcd"));
    let outcome = run(&["sim", "t-format", "--vcd", &vcd, "--wires", &wires]);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    for part in ["1A 00 56 34 12 17", "reply_crc", "all as it should be"] {
        assert!(outcome.stdout.contains(part), "{part}: {outcome:?}");
    }
    let all = fs::read_to_string(&vcd).unwrap();
    assert!(all.contains("module t_format0") && all.contains("result_strobe"));
    // The last of the line is in the file, though nothing changes there.
    let line = fs::read_to_string(&wires).unwrap();
    let last = line.lines().rfind(|l| l.starts_with('#')).unwrap();
    assert!(last[1..].parse::<u64>().unwrap() > 1_450_000, "{last}");
    assert!(line.matches('\n').count() > 200);
    let refused = bad(&["sim", "t-format", "--svg", &dir.path("no.svg")], 2);
    assert!(refused.contains("only EnDat frames are drawn"), "{refused}");
    let refused = bad(&["sim", "t-format", "--channel", "1"], 2);
    assert!(refused.contains("has one channel"), "{refused}");
}

/// Frames of channel 0 in the report of a scenario.
fn frames_of(scenario: &str) -> Vec<serde_json::Value> {
    let report: serde_json::Value =
        serde_json::from_str(&good(&["sim", scenario, "--json"])).unwrap();
    let rows = report[0]["channels"][0]["frames"].as_array();
    rows.unwrap().clone()
}

/// Answers to requests with separate frames.
#[test]
fn requests_are_in_the_report() {
    let parameter = frames_of("parameter");
    let answers: Vec<_> = parameter
        .iter()
        .filter(|r| !r["answer"].is_null())
        .collect();
    assert_eq!(answers.len(), 2);
    assert_eq!(answers[0]["encoder"]["command"], 0b001_110);
    assert_eq!(answers[0]["answer"]["word"], 0xA1_0000);
    assert_eq!(answers[0]["trigger_us"], 2_620.0);
    assert_eq!(answers[1]["encoder"]["command"], 0b100_011);
    assert_eq!(answers[1]["answer"]["word"], 0x0D_801D);
    assert_eq!(answers[1]["answer"]["crc_good"], true);
}

#[test]
#[ignore = "slow: the steps of the initialisation, a scenario of two seconds"]
fn steps_of_the_initialisation_are_in_the_report() {
    let initialise = frames_of("initialise");
    let commands: Vec<_> = initialise
        .iter()
        .map(|r| r["encoder"]["command"].as_u64())
        .collect();
    let before = initialise.iter().take_while(|r| r["trigger_us"].is_null());
    let frames = |s: &Step| {
        let without = matches!(s, Step::TakeWidth | Step::OnlyEndat22 | Step::ChooseClock);
        usize::from(!without && *s != Step::SetRecovery)
    };
    let steps: usize = steps().iter().map(frames).sum();
    assert_eq!(before.count(), 1 + steps);
    assert_eq!(commands[..3], [None, Some(0b101_010), Some(0b001_110)]);
}

/// The report would say so if a request went wrong.
#[test]
fn a_request_that_fails_is_complained_about() {
    let compiled = OnceLock::new();
    let complaints = |defect: Option<Defect>| {
        let mut s = scenario::named("parameter").unwrap();
        let encoder = s.channels[0].encoder.clone();
        if let Some(defect) = defect {
            s.channels[0].encoder = encoder.defect(3, defect);
        }
        let engine = compiled.get_or_init(|| {
            let times = FixedTimes::at(s.system_hz);
            let mut block = Channel::with(times, s.features());
            block.connect_all();
            Compiled::new(&elaborate(&block, "channel").unwrap()).unwrap()
        });
        let report = s.run_channel(0, engine.clone(), RunOptions::default()).1;
        report.complaints()
    };
    assert_eq!(complaints(None), [""; 0]);
    let spoilt = complaints(Some(Defect::CrcXor(1)));
    assert!(spoilt[0].contains("frame 3: CRC"), "{spoilt:?}");
    let silent = complaints(Some(Defect::NoStartBit));
    assert!(
        silent.iter().any(|c| c.contains("frame 3: no start bit")),
        "{silent:?}"
    );
}
