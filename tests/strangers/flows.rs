//! Every synthesis flow of yosys: devices for which nobody here has a board.

use super::on_both_cores;
use crate::program::{bad, good, Dir};
use crate::verilog::area::require;
use endat_config::{load_any_preset, PRESETS, RECEIVER_PRESETS};
use endat_workshop::flows::{self, Flow, FLOWS};

/// Puts the card of a preset through flows; what is wrong.
fn complaints(preset: &str, flows: &[Flow]) -> Vec<String> {
    let configuration = load_any_preset(preset).unwrap();
    on_both_cores(flows, |_, flow| {
        let (name, files) = flows::core(&configuration, *flow).unwrap();
        let found = flows::through(&files, &name, *flow).unwrap();
        let cells: u64 = found.cells.values().sum();
        assert!(cells > 500, "{preset}: {}: {cells} cells", flow.name);
        let wrong = found.complaints();
        (!wrong.is_empty()).then(|| format!("{preset}: {}", wrong.join("\n")))
    })
}

fn named(names: &[&str]) -> Vec<Flow> {
    let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
    flows::named(&names).unwrap()
}

/// Catches Verilog that a flow warns about, or of which it makes latches or what its device does not have.
#[test]
fn a_receiver_goes_through_quick_flows_of_yosys() {
    if !require("every flow of yosys") {
        return;
    }
    let wrong = complaints("async_dsp", &named(&["gowin", "efinix"]));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
#[ignore = "slow: a card through every flow"]
fn a_card_goes_through_every_flow_of_yosys() {
    if !require("every flow of yosys") {
        return;
    }
    let wrong = complaints("demo", &FLOWS);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Flows of families that `verilog::lint` does not map the presets to, the one without start values among them.
const OTHERS: [&str; 10] = [
    "xc7",
    "gowin",
    "polarfire",
    "efinix",
    "nexus",
    "anlogic",
    "machxo2",
    "gatemate",
    "cyclonev",
    "qlf",
];

/// Every preset through one flow, in turn. All flows read the Verilog with the same front end, and `demo` goes through each of them.
#[test]
#[ignore = "slow: every preset through a flow"]
fn every_preset_goes_through_a_flow_of_yosys() {
    if !require("every flow of yosys") {
        return;
    }
    let presets = PRESETS.iter().chain(RECEIVER_PRESETS);
    let wrong: Vec<String> = presets
        .zip(OTHERS.iter().cycle())
        .flat_map(|((preset, _), flow)| complaints(preset, &named(&[flow])))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn what_a_flow_says_of_bad_verilog_is_told() {
    let told = bad(&["flows", "--only", "xc6s,spartan7"], 2);
    assert!(
        told.contains("--only = \"spartan7\": no such flow; known flows: xc6s, xc7, ecp5"),
        "{told}"
    );
    if !require("a flow of yosys") {
        return;
    }
    let gowin = &named(&["gowin"])[0];
    let text = "module card (input wire a, input wire d, output reg q, output wire z);\n    always @(posedge a) q <= d;\n    assign z = d & q[3];\nendmodule\n";
    let files = [endat_console::artifact::Artifact::new("card.v", text)];
    let found = flows::through(&files, "card", *gowin).unwrap();
    assert!(!found.warnings.is_empty(), "{found:?}");
    let dir = Dir::new("flows");
    let config = dir.write(
        "card.toml",
        good(&["presets", "--show", "async_dsp"]).as_bytes(),
    );
    let table = good(&["flows", "--config", &config, "--only", "gowin"]);
    assert!(table.contains("| gowin | `synth_gowin` | "), "{table}");
    assert!(table.ends_with("| 0 |\n"), "{table}");
}
