//! The card synthesised for every family: it can be, its synchronisers stay flip-flops, and the netlists do what the RTL does. A receiver stands
//! for it in the quick test.

use super::area::{require, subject};
use super::{is_core, name_of, quick_files, write};
use crate::stimulus::stimulus;
use crate::three_way;
use crate::tools;
use endat_config::DEFAULT_PRESET;
use endat_console::artifact::Artifact;
use endat_tools::area::{self, Family, Synthesis, ECP5, GOWIN, ICE40, XC6S, XC7};
use endat_tools::bitstream::replay::{self, Pins};
use rtl_design::engine::{Compiled, Engine};
use rtl_design::verilog::emitted_name;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fmt::Write as _;
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
    let folder = tools::folder(&format!("netlist-{}", family.name));
    area::synthesise(&folder, &files, DEFAULT_PRESET, family).unwrap()
}

/// The same, made once for all tests.
fn xc6s() -> &'static Synthesis {
    static DONE: OnceLock<Synthesis> = OnceLock::new();
    DONE.get_or_init(|| synthesised(&XC6S))
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
#[ignore = "slow: other families"]
fn card_synthesises_for_7_series_and_gowin() {
    if require("synthesis of the card") {
        for family in [XC7, GOWIN] {
            has_flip_flops(&synthesised(&family));
        }
    }
}

/// Names of the registers that the emitted text marks as synchroniser stages.
fn marked_registers(files: &[Artifact]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for file in files.iter().filter(|f| is_core(f)) {
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
#[ignore = "slow: synchronisers of the whole card"]
fn synchronisers_of_the_card_stay_flip_flops() {
    if require("synchronisers in the netlist of the card") {
        let is_flip_flop = |cell: &str| matches!(cell, "FDRE" | "FDSE");
        let stages = kept_stages(xc6s(), DEFAULT_PRESET, quick_files(), is_flip_flop);
        // Three stages for each DATA input and the trigger, two for the UART.
        assert_eq!(stages, 3 + 3 + 3 + 2);
    }
}

/// The synchroniser stages, each of which is a separate flip-flop.
fn kept_stages(
    synthesis: &Synthesis,
    top: &str,
    files: &[Artifact],
    is_flip_flop: impl Fn(&str) -> bool,
) -> usize {
    let text = fs::read_to_string(&synthesis.json).unwrap();
    let netlist: Value = serde_json::from_str(&text).unwrap();
    let module = &netlist["modules"][top];
    // The bit that every flip-flop drives.
    let cells = module["cells"].as_object().unwrap().values();
    let flip_flops: BTreeSet<u64> = cells
        .filter(|c| c["type"].as_str().is_some_and(&is_flip_flop))
        .map(|c| c["connections"]["Q"][0].as_u64().unwrap())
        .collect();
    let marked = marked_registers(files);
    assert!(marked.len() >= 3, "{marked:?}");
    let mut stages = 0;
    for (name, net) in module["netnames"].as_object().unwrap() {
        let last = name.rsplit('.').next().unwrap();
        if !marked.contains(last) {
            continue;
        }
        for bit in net["bits"].as_array().unwrap() {
            let bit = bit.as_u64().unwrap_or_else(|| panic!("{name} is constant"));
            assert!(flip_flops.contains(&bit), "{name} is no flip-flop");
            stages += 1;
        }
    }
    stages
}

/// A receiver alone: a recording of the design, played to its netlist, with random inputs. One wrong bit in the last cycle is noticed.
#[test]
fn a_receivers_netlist_equals_its_design_and_keeps_its_synchronisers() {
    let check = "gate level of a receiver";
    if !(require(check) && tools::require("iverilog", check) && tools::require("yosys", check)) {
        return;
    }
    let receiver = subject("t_format");
    let folder = tools::folder("netlist-receiver");
    let files = receiver.files();
    let synthesis = area::synthesise(&folder, &files, receiver.name, &ICE40).unwrap();
    let is_flip_flop = |cell: &str| cell.starts_with("SB_DFF");
    let stages = kept_stages(&synthesis, receiver.name, &files, is_flip_flop);
    assert_eq!(stages, 3);

    let mut engine = Compiled::new(&receiver.design).unwrap();
    let stimulus = stimulus(&receiver.design, 2_000, 3);
    let recorded = three_way::record(&mut engine, &stimulus);
    let width = |name: &str| {
        let port = engine.ports().iter().find(|p| p.name == *name);
        port.unwrap().width_bits
    };
    let inputs: Vec<_> = stimulus
        .inputs
        .iter()
        .map(|n| (n.as_str(), width(n)))
        .collect();
    let outputs = recorded
        .outputs
        .iter()
        .map(|p| (p.name.as_str(), p.width_bits));
    let outputs: Vec<_> = outputs.collect();
    // The first port has the lowest bits.
    let bits = |ports: &[(&str, usize)], row: &[u128]| {
        let values = ports.iter().zip(row).rev();
        let values = values.map(|((_, width), value)| format!("{value:0width$b}"));
        values.collect::<String>()
    };
    let rows = stimulus.cycles.iter().zip(&recorded.cycles);
    let lines = rows.map(|(i, o)| format!("{}{}\n", bits(&outputs, o), bits(&inputs, i)));
    let recording: String = lines.collect();
    let pins = Pins {
        inputs: scalars(&inputs),
        outputs: scalars(&outputs),
    };
    let netlist = fs::read_to_string(&synthesis.verilog).unwrap();
    let wrapper = wrapper(receiver.name, &inputs, &outputs);
    let play = |recording: &str| {
        let folder = tools::folder("gate-receiver");
        fs::write(folder.join("netlist.v"), format!("{netlist}\n{wrapper}")).unwrap();
        let models = cell_models("ice40");
        let options: Vec<&str> = ["netlist.v"]
            .into_iter()
            .chain(models.iter().map(String::as_str))
            .collect();
        replay::play(
            &folder,
            recording,
            "wrapper dut (.clk(clk)",
            &pins,
            &options,
        )
        .unwrap()
    };
    assert_eq!(play(&recording), replay::SAME);
    let said = play(&spoilt(&recording));
    assert!(said.starts_with("cycle 1999:"), "{said}");
}

/// A name for each bit of ports.
fn scalars(ports: &[(&str, usize)]) -> Vec<String> {
    let names = ports
        .iter()
        .flat_map(|(name, width)| (0..*width).map(move |bit| format!("{name}_{bit}")));
    names.collect()
}

/// A module with a port for each bit around one with vectors.
fn wrapper(name: &str, inputs: &[(&str, usize)], outputs: &[(&str, usize)]) -> String {
    let mut text = String::from("module wrapper(input clk");
    for (word, ports) in [("input", inputs), ("output", outputs)] {
        scalars(ports).iter().for_each(|pin| {
            let _ = write!(text, ", {word} {pin}");
        });
    }
    let _ = write!(text, ");\n    {name} inner (.clock(clk)");
    for port in inputs.iter().chain(outputs) {
        let mut bits = scalars(&[*port]);
        bits.reverse();
        let _ = write!(text, ", .{}({{{}}})", emitted_name(port.0), bits.join(", "));
    }
    text + ");\nendmodule\n"
}

/// With one wrong bit in the last line.
fn spoilt(recording: &str) -> String {
    let (first, last) = recording.trim_end().rsplit_once('\n').unwrap();
    let flipped = if last.starts_with('0') { "1" } else { "0" };
    format!("{first}\n{flipped}{}\n", &last[1..])
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
#[ignore = "slow: recording of the whole card"]
fn player_compares_every_cycle() {
    if !tools::require("iverilog", "recording of the card") {
        return;
    }
    let core = quick_files().iter().filter(|f| is_core(f));
    let card: Vec<_> = core.map(|f| (f.path.as_str(), f.text.as_str())).collect();
    assert_eq!(recording().lines().count(), CYCLES);
    assert_eq!(play_card("rtl", recording(), &card, &[]), replay::SAME);
    let said = play_card("spoilt", &spoilt(recording()), &card, &[]);
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
    netlist_equals(family);
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
#[ignore = "slow: gate level of the card on Spartan-6"]
fn spartan_6_netlist_equals_the_rtl() {
    gate_level(&XC6S);
}

#[test]
#[ignore = "slow: gate level of the card on ECP5"]
fn ecp5_netlist_equals_the_rtl() {
    gate_level(&ECP5);
}

#[test]
#[ignore = "slow: gate level of the card on iCE40"]
fn ice40_netlist_equals_the_rtl() {
    gate_level(&ICE40);
}
