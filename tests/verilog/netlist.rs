//! The card synthesised for every family: it can be, its synchronisers stay flip-flops, and the netlists do what the RTL does.

use super::{area::require, is_core, name_of, quick_files, write};
use crate::passed::Check;
use crate::tools;
use endat_gen::area::{self, Family, Synthesis, ECP5, GOWIN, ICE40, XC6S, XC7};
use endat_gen::bitstream::replay::{self, Pins};
use endat_gen::config::DEFAULT_PRESET;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::sync::OnceLock;

/// The card synthesised for a family.
fn synthesised(family: &Family) -> Synthesis {
    let files: Vec<_> = quick_files()
        .iter()
        .filter(|f| is_core(f))
        .cloned()
        .collect();
    // Runners with a process for each test synthesise it more than once, at the same time.
    let folder = tools::folder(&format!("netlist-{}-{}", family.name, std::process::id()));
    area::synthesise(&folder, &files, DEFAULT_PRESET, family).unwrap()
}

/// The same, made once for all tests.
fn xc6s() -> &'static Synthesis {
    static DONE: OnceLock<Synthesis> = OnceLock::new();
    DONE.get_or_init(|| synthesised(&XC6S))
}

/// What of a family is decided by the card and by who synthesises it and plays to it.
fn seen(family: &Family, what: &str) -> Check {
    let check = Check::new(format!("{what} for {}", family.name)).files(quick_files());
    check.sources(&[
        "gen/area",
        "gen/bitstream/replay.rs",
        "tests/verilog/netlist.rs",
    ])
}

fn has_flip_flops(synthesis: &Synthesis) {
    // Two channels with their results, configuration and counters.
    assert!(synthesis.usage.ff > 1000, "{:?}", synthesis.usage);
    let latches = synthesis
        .cells
        .keys()
        .filter(|c| c.contains("LATCH") || c.starts_with("LD"));
    assert_eq!(latches.count(), 0, "{:?}", synthesis.cells);
}

#[test]
fn card_synthesises_for_7_series_and_gowin() {
    if require("synthesis of the card") {
        let families = [XC7, GOWIN];
        let turn = quick_files().iter().map(|file| file.text.len()).sum();
        for family in tools::third(&families, turn) {
            seen(family, "synthesis").unless_passed(|| has_flip_flops(&synthesised(family)));
        }
    }
}

/// Names of the registers that the emitted text marks as synchroniser stages.
fn marked_registers() -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for file in quick_files().iter().filter(|f| is_core(f)) {
        let mut lines = file.text.lines();
        while let Some(line) = lines.next() {
            if line.contains("ASYNC_REG") {
                let declaration = lines.next().unwrap().split('=').next().unwrap();
                let name = declaration.split_whitespace().last().unwrap();
                found.insert(name.to_owned());
            }
        }
    }
    found
}

#[test]
fn synchronisers_of_the_card_stay_flip_flops() {
    if require("synchronisers in the netlist of the card") {
        seen(&XC6S, "synchronisers").unless_passed(synchronisers_stay);
    }
}

fn synchronisers_stay() {
    let text = fs::read_to_string(&xc6s().json).unwrap();
    let netlist: Value = serde_json::from_str(&text).unwrap();
    let module = &netlist["modules"][DEFAULT_PRESET];
    // The bit that every flip-flop drives.
    let cells = module["cells"].as_object().unwrap().values();
    let flip_flops: BTreeSet<u64> = cells
        .filter(|c| matches!(c["type"].as_str(), Some("FDRE" | "FDSE")))
        .map(|c| c["connections"]["Q"][0].as_u64().unwrap())
        .collect();
    let marked = marked_registers();
    assert!(marked.len() >= 3, "{marked:?}");
    let mut stages = 0;
    for (name, net) in module["netnames"].as_object().unwrap() {
        let last = name.rsplit('.').next().unwrap();
        if !marked.contains(last) {
            continue;
        }
        for bit in net["bits"].as_array().unwrap() {
            let bit = bit.as_u64().unwrap_or_else(|| panic!("{name} is constant"));
            assert!(
                flip_flops.contains(&bit),
                "{name} is not a flip-flop of its own"
            );
            stages += 1;
        }
    }
    // Three stages for each DATA input and the trigger, two for the UART.
    assert_eq!(stages, 3 + 3 + 3 + 2);
}

/// Cycles that are compared: reset, host commands, a frame that measures the delay, frames at the configured clock.
const CYCLES: usize = 60_000;

/// Pins of the card, inputs and outputs, without the clock.
fn pins() -> Pins {
    let mut inputs: Vec<String> = vec!["rst_i".into(), "trigger_i".into(), "uart_rx_i".into()];
    let mut outputs: Vec<String> = vec!["uart_tx_o".into(), "led_status_o".into()];
    for n in 0..2 {
        inputs.push(format!("endat_data{n}_i"));
        for end in ["clk{n}_o", "data{n}_o", "data{n}_oe"] {
            outputs.push(format!("endat_{}", end.replace("{n}", &n.to_string())));
        }
        outputs.push(format!("led_channel{n}_o"));
    }
    Pins { inputs, outputs }
}

/// Stimulus and outputs of the quick card, one line a cycle, recorded while it runs in its own test bench.
fn record() -> String {
    let (folder, mut files) = write("recorder", quick_files());
    let card = name_of(quick_files());
    files.push(format!("{card}_tb.v"));
    replay::record(&folder, card, &files, &pins(), &|_| false, CYCLES).unwrap()
}

/// The recording of the quick card.
fn recording() -> &'static str {
    static TEXT: OnceLock<String> = OnceLock::new();
    TEXT.get_or_init(record)
}

/// The frames are in a recording: all outputs move but those that stand still for so long.
fn assert_outputs_move(recording: &str, outputs: &[String], is_still: fn(&str) -> bool) {
    for (place, name) in outputs.iter().rev().enumerate() {
        let bits: BTreeSet<u8> = recording.lines().map(|l| l.as_bytes()[place]).collect();
        assert!(bits.len() == 2 || is_still(name), "{name} does not move");
    }
}

/// The folder of Debian's yosys' own files: where yosys itself looks for them, beside its program. Its cell models are the
/// ones that iverilog reads for every family.
fn share() -> PathBuf {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let programs = std::env::split_paths(&path).map(|folder| folder.join("yosys"));
    let program = programs
        .filter(|p| p.is_file())
        .find_map(|p| p.canonicalize().ok());
    let program = program.expect("yosys is in the PATH");
    program.parent().unwrap().join("../share/yosys")
}

/// What iverilog is told to read the models of a family's cells, by their folder.
fn cell_models(family: &str) -> [String; 3] {
    let folder = share().join(family);
    [
        "-DNO_ICE40_DEFAULT_ASSIGNMENTS".to_owned(),
        format!("-I{}", folder.display()),
        folder.join("cells_sim.v").display().to_string(),
    ]
}

/// Plays a recording of the quick card.
fn play_card(test: &str, recording: &str, card: &[(&str, &str)], options: &[String]) -> String {
    let folder = tools::folder(&format!("gate-{test}"));
    let mut files = Vec::new();
    for (file, text) in card {
        fs::write(folder.join(file), text).unwrap();
        files.push(*file);
    }
    files.extend(options.iter().map(String::as_str));
    let instance = format!("{DEFAULT_PRESET} dut (.clk_i(clk)");
    replay::play(&folder, recording, &instance, &pins(), &files).unwrap()
}

/// The recording played back to the RTL: equal as it stands, and one wrong bit in the last cycle is noticed.
#[test]
fn player_compares_every_cycle() {
    if !tools::require("iverilog", "recording of the card") {
        return;
    }
    let core = quick_files().iter().filter(|f| is_core(f));
    let card: Vec<_> = core.map(|f| (f.path.as_str(), f.text.as_str())).collect();
    assert_eq!(recording().lines().count(), CYCLES);
    assert_eq!(play_card("rtl", recording(), &card, &[]), replay::SAME);
    let (first, last) = recording().trim_end().rsplit_once('\n').unwrap();
    let flipped = if last.starts_with('0') { "1" } else { "0" };
    let spoilt = format!("{first}\n{flipped}{}\n", &last[1..]);
    let said = play_card("spoilt", &spoilt, &card, &[]);
    assert!(
        said.starts_with(&format!("cycle {}:", CYCLES - 1)),
        "{said}"
    );
    // Clocks, drivers and lights of both channels move.
    assert_outputs_move(recording(), &pins().outputs, |name| name == "led_status_o");
}

fn gate_level(family: &Family) {
    let check = format!("gate level on {}", family.name);
    if !(require(&check) && tools::require("iverilog", &check) && tools::require("yosys", &check)) {
        return;
    }
    seen(family, "gate level").unless_passed(|| netlist_equals(family));
}

fn netlist_equals(family: &Family) {
    let synthesis = match family.name {
        "xc6s" => xc6s().clone(),
        _ => synthesised(family),
    };
    has_flip_flops(&synthesis);
    let options = cell_models(match family.name {
        "xc6s" => "xilinx",
        name => name,
    });
    let netlist = fs::read_to_string(&synthesis.verilog).unwrap();
    let card = [("netlist.v", netlist.as_str())];
    let said = play_card(family.name, recording(), &card, &options);
    assert_eq!(said, replay::SAME);
}

#[test]
fn spartan_6_netlist_equals_the_rtl() {
    gate_level(&XC6S);
}

#[test]
#[ignore = "a minute and a half: --ignored netlist"]
fn ecp5_netlist_equals_the_rtl() {
    gate_level(&ECP5);
}

#[test]
fn ice40_netlist_equals_the_rtl() {
    gate_level(&ICE40);
}
