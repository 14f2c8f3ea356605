//! Bitstreams with tools of vendors: their scripts run in a Tcl shell with stand-ins for the tools, which are not to be had here.

use super::boards;
use crate::program::{bad, good, program, Dir};
use crate::tools;
use serde_json::Value;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

/// The shells, and what ISE's starts.
const NAMES: [&str; 11] = [
    "vivado",
    "xtclsh",
    "xst",
    "ngdbuild",
    "map",
    "par",
    "trce",
    "bitgen",
    "quartus_sh",
    "gw_sh",
    "diamondc",
];

/// A folder of stand-ins, to come first in `PATH`.
fn stand_ins(dir: &Dir) -> String {
    let text = include_str!("../data/vendor.tcl");
    fs::create_dir_all(dir.0.join("bin")).unwrap();
    for name in NAMES {
        let file = dir.write(&format!("bin/{name}"), text.as_bytes());
        fs::set_permissions(file, fs::Permissions::from_mode(0o755)).unwrap();
    }
    let path = std::env::var("PATH").unwrap_or_default();
    format!("{}:{path}", dir.path("bin"))
}

/// Runs the program with stand-ins and a variable; exit code, output, complaints.
fn build(arguments: &[&str], path: &str, spoilt: Option<&str>) -> (Option<i32>, String, String) {
    let mut program = program();
    program.arg("build").args(arguments).env("PATH", path);
    if let Some(name) = spoilt {
        program.env(name, "1");
    }
    let output = program.output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        output.status.code(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

/// A board of each family that has a script, with the clock that its stand-in tells, and a cell.
const BOARDS: [(&str, &str, f64, &str, [u64; 2]); 5] = [
    ("arty_a7_35", "bit", 1e3 / 9.5, "Slice LUTs", [2907, 20_800]),
    (
        "papilio_pro",
        "bit",
        125.0,
        "Slice Registers",
        [3181, 11_440],
    ),
    ("de10_nano", "rbf", 118.61, "ALMs", [1702, 41_910]),
    ("tang_nano_9k", "fs", 110.25, "Register", [3172, 6693]),
    ("ulx3s", "bit", 104.866, "LUT4s", [3221, 83_640]),
];

#[test]
fn every_script_of_a_vendor_runs_to_its_end_and_its_report_is_read() {
    if !tools::require("tclsh", "vendors' scripts") {
        return;
    }
    let dir = Dir::new("vendor");
    let path = stand_ins(&dir);
    for (board, end, mhz, kind, cells) in BOARDS {
        let out = dir.path("o");
        let arguments = [
            "--board", board, "--vendor", "--out", &out, "--name", "card", "--json",
        ];
        let (code, told, progress) = build(&arguments, &path, None);
        assert_eq!(code, Some(0), "{board}: {progress}");
        let report: Value = serde_json::from_str(&told).unwrap();
        let clocks = report["best"]["clocks"].as_array().unwrap();
        let reached = |clock: &Value| (clock["fmax_mhz"].as_f64().unwrap() - mhz).abs() < 1e-3;
        assert!(clocks.iter().any(reached), "{board}: {report}");
        let told = &report["best"]["cells"][kind];
        assert_eq!(
            [&told["used"], &told["available"]],
            cells,
            "{board}: {report}"
        );
        assert_eq!(
            fs::read(dir.0.join(format!("o/card/card.{end}"))).unwrap(),
            b"bits\n"
        );

        let (code, _, told) = build(&arguments, &path, Some("SLOW"));
        assert_eq!(code, Some(1), "{board}: {told}");
        assert!(
            told.contains("timing is not met; take a slower clock.system_hz, or a faster device"),
            "{told}"
        );
        let (code, _, told) = build(&arguments, &path, Some("HOLD"));
        assert_eq!(code, Some(2), "{board}: {told}");
        assert!(told.contains("hold time"), "{board}: {told}");
    }
    // A bound that these two tell apart from their clocks.
    let out = dir.path("o");
    for (board, wanted) in [
        ("papilio_pro", "1 ways of asynchronous inputs"),
        (
            "arty_a7_35",
            "an input is too far from its first register, by -1.5 ns",
        ),
    ] {
        let arguments = ["--board", board, "--out", &out, "--name", "card"];
        let (code, _, told) = build(&arguments, &path, Some("FAR"));
        assert_eq!(code, Some(2), "{told}");
        assert!(told.contains(wanted), "{told}");
    }
    let scripts = boards().into_iter().filter(|b| b.family.vendor.is_some());
    let families: std::collections::BTreeSet<_> = scripts.map(|b| b.family.name).collect();
    assert_eq!(
        families.len(),
        BOARDS.len(),
        "a stand-in for each: {families:?}"
    );
}

/// Catches a script that leaves a file of the other language out, or gives it to the wrong reader.
#[test]
fn a_script_of_a_vendor_takes_vhdl() {
    takes_vhdl("vendor-vhdl", &["de10_nano"]);
}

#[test]
#[ignore = "slow: VHDL in the scripts of every vendor"]
fn every_script_of_a_vendor_takes_vhdl() {
    takes_vhdl("vendor-vhdl-all", &BOARDS.map(|(board, ..)| board));
}

fn takes_vhdl(test: &str, boards: &[&str]) {
    if !tools::require("tclsh", "vendors' scripts") {
        return;
    }
    let dir = Dir::new(test);
    let path = stand_ins(&dir);
    for board in boards {
        let out = dir.path(board);
        let arguments = ["--board", board, "--out", &out, "--name", "card"];
        let arguments = [&["--language", "vhdl"], &arguments[..]].concat();
        good(&[&["emit"], &arguments[..]].concat());
        let folder = Path::new(&out).join("card");
        let script = fs::read_to_string(folder.join("card_build.tcl")).unwrap();
        // The line that says how it is started.
        let started = script.lines().find(|l| l.starts_with("# Bitstream of"));
        let (_, command) = started.unwrap().rsplit_once(": ").unwrap();
        let ran = std::process::Command::new("sh")
            .args(["-c", command])
            .env("PATH", &path)
            .current_dir(&folder)
            .output()
            .unwrap();
        let told = String::from_utf8_lossy(&ran.stderr);
        assert!(ran.status.success(), "{board}: {told}");
        let read = [&arguments[..], &["--vendor", "--read"]].concat();
        let (code, _, told) = build(&read, &path, None);
        assert_eq!(code, Some(0), "{board}: {told}");
    }
    // And run by the program.
    let arguments = [
        "--board",
        "arty_a7_35",
        "--out",
        &dir.path("o"),
        "--name",
        "card",
    ];
    let arguments = [&["--language", "vhdl"], &arguments[..]].concat();
    let (code, _, told) = build(&arguments, &path, None);
    assert_eq!(code, Some(0), "{told}");
    let flash = [&["flash"], &arguments[..]].concat();
    assert!(good(&flash).contains("openFPGALoader --board arty_a7_35t"));
    assert!(bad(&[&["flash"], &arguments[2..]].concat(), 2).contains("version or --language ("));
    let none = [
        "flash",
        "--board",
        "ulx3s",
        "--language",
        "vhdl",
        "--out",
        &dir.path("none"),
    ];
    assert!(bad(&none, 2).contains("the same command with `build --vendor`"));
    let told = bad(&["build", "--board", "icebreaker", "--language", "vhdl"], 2);
    assert!(
        told.trim_end()
            .ends_with("open tools read Verilog; leave it out"),
        "{told}"
    );
    let told = bad(&["build", "--board", "ulx3s", "--language", "vhdl"], 2);
    assert!(
        told.contains("--language = vhdl: open tools read Verilog; leave it out"),
        "{told}"
    );
}

#[test]
fn a_report_that_was_made_elsewhere_is_read_beside_its_emission() {
    if !tools::require("tclsh", "vendors' scripts") {
        return;
    }
    let dir = Dir::new("vendor-read");
    let path = stand_ins(&dir);
    let out = dir.path("o");
    let arguments = ["--board", "arty_a7_35", "--out", &out, "--name", "card"];
    let read: Vec<&str> = arguments.into_iter().chain(["--read"]).collect();
    // Nothing is there yet.
    let (code, _, told) = build(&read, &path, None);
    assert!(
        code == Some(2) && told.contains("emit it, and run the script there"),
        "{told}"
    );
    // Without the tool, the emission is complete, and the remedy is what works.
    let (code, _, told) = build(&arguments, "", None);
    assert_eq!(code, Some(2));
    let command = "vivado -mode batch -nojournal -source card_build.tcl";
    assert!(told.contains(&format!("vivado: is not installed here; on a machine with Vivado, run `{command}` in {out}/card (it is complete), and then the same command with --read")), "{told}");
    let (code, _, told) = build(&read, &path, None);
    assert!(
        code == Some(2) && told.contains("card_report.json"),
        "{told}"
    );
    let mut words = command.split(' ');
    let ran = std::process::Command::new(Path::new(&dir.path("bin")).join(words.next().unwrap()))
        .args(words)
        .current_dir(dir.0.join("o/card"))
        .output()
        .unwrap();
    assert!(
        ran.status.success(),
        "{}",
        String::from_utf8_lossy(&ran.stderr)
    );
    let (code, told, _) = build(&read, "", None);
    assert!(code == Some(0) && told.contains("timing met"), "{told}");
    // The report of another card is none of this one.
    let mut other = read.clone();
    other[1] = "zybo_z7_10";
    let (code, _, told) = build(&other, "", None);
    assert!(
        code == Some(2)
            && told.contains("is of another configuration, board, version or --language"),
        "{told}"
    );
    // Nor the one of what was emitted here before, although its file is still there.
    let text = good(&[
        "presets",
        "--show",
        "s6_two_channel",
        "--board",
        "arty_a7_35",
    ]);
    let slower = text.replace("clock_hz = 3_125_000", "clock_hz = 2_500_000");
    assert_ne!(slower, text);
    let config = dir.write("slower.toml", slower.as_bytes());
    let again = ["--config", &config, "--out", &out, "--name", "card"];
    good(&[&["emit"], &again[..]].concat());
    let (code, _, told) = build(&[&again[..], &["--read"]].concat(), "", None);
    assert!(
        code == Some(2)
            && told.contains(
                "card_report.json: is of another configuration, board or version; build it again"
            ),
        "{told}"
    );
    let told = bad(&[&["flash"], &again[..]].concat(), 2);
    assert!(
        told.contains("card_report.json: is of another configuration, board or version"),
        "{told}"
    );
    good(&[&["emit"], &arguments[..]].concat());
    assert_eq!(build(&read, "", None).0, Some(0));
    // What is in it is not trusted, and a bitstream of nothing is none.
    dir.write("o/card/card.bit", b"");
    let (code, _, told) = build(&read, "", None);
    assert!(
        code == Some(2)
            && told.contains("is of another bitstream than card.bit, which has 0 bytes"),
        "{told}"
    );
    dir.write("o/card/card.bit", b"bits\n");
    let good_report = fs::read_to_string(dir.0.join("o/card/card_report.json")).unwrap();
    let oscillator_alone = good_report.replace("pll_clk", "osc_i");
    assert_ne!(oscillator_alone, good_report);
    for text in [
        "",
        "{}",
        "[1",
        &oscillator_alone,
        "{\"fmax\": {\"clk\": {\"achieved\": 1, \"constraint\": 1}}}",
    ] {
        dir.write("o/card/card_report.json", text.as_bytes());
        let (code, _, told) = build(&read, "", None);
        assert!(
            code == Some(2) && told.contains("card_report.json: "),
            "{text}: {told}"
        );
    }
}

#[test]
fn what_no_vendor_has_a_script_for_is_told() {
    let told = bad(&["build", "--board", "hx8k_b_evn", "--vendor"], 2);
    assert!(
        told.contains("board = hx8k_b_evn: iCE40 has no script for a vendor's tool; leave --vendor and --read out"),
        "{told}"
    );
}
