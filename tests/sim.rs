//! The bench from the command line: the elaborated channel in every scenario.

use crate::program::{bad, good, run, Dir};
use std::fs;

/// The scenarios on the channel as it is elaborated for emission.
#[test]
fn the_core_is_sound_in_every_scenario() {
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
    for name in names {
        let report: serde_json::Value =
            serde_json::from_str(&good(&["sim", name, "--json"])).unwrap();
        for channel in report.as_array().unwrap() {
            assert_eq!(channel["complaints"], serde_json::json!([]), "{name}");
            let frames = channel["channels"][0]["frames"].as_array().unwrap();
            let positions = frames
                .iter()
                .filter(|f| f["result"]["position"].is_number())
                .count();
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
