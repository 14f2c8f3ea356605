//! Every synthesis flow of yosys: devices for which nobody here has a board.

use super::benches::on_both_cores;
use crate::passed::Check;
use crate::program::{bad, good, Dir};
use crate::verilog::area::require;
use endat_gen::area::flows::{self, Flow, FLOWS};
use endat_gen::config::{load_any_preset, PRESETS, RECEIVER_PRESETS};

/// Puts the card of a preset through flows; what is wrong.
fn complaints(preset: &str, flows: &[Flow]) -> Vec<String> {
    let configuration = load_any_preset(preset).unwrap();
    on_both_cores(flows, |_, flow| {
        let (name, files) = flows::core(&configuration, *flow).unwrap();
        let check = Check::new(format!("{preset} through {}", flow.name)).files(&files);
        let check = check.text(flow.synth).source("gen/area/flows.rs");
        check.complaint_unless_passed(|| {
            let found = flows::through(&files, &name, *flow).unwrap();
            let cells: u64 = found.cells.values().sum();
            assert!(cells > 500, "{preset}: {}: {cells} cells", flow.name);
            let wrong = found.complaints();
            (!wrong.is_empty()).then(|| format!("{preset}: {}", wrong.join("\n")))
        })
    })
}

/// Catches Verilog that a flow warns about, or of which it makes latches or what its device does not have.
#[test]
fn a_card_goes_through_every_flow_of_yosys() {
    if !require("every flow of yosys") {
        return;
    }
    let wrong = complaints("demo", &FLOWS);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The same of every preset.
#[test]
#[ignore = "two hours: --ignored through_every_flow"]
fn every_preset_goes_through_every_flow_of_yosys() {
    if !require("every flow of yosys") {
        return;
    }
    let wrong = PRESETS
        .iter()
        .chain(RECEIVER_PRESETS)
        .flat_map(|(preset, _)| complaints(preset, &FLOWS));
    let wrong: Vec<String> = wrong.collect();
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
    let configuration = load_any_preset("demo").unwrap();
    let [ice40] = flows::named(&["ice40".to_owned()]).unwrap()[..] else {
        panic!("one flow");
    };
    let (_, files) = flows::core(&configuration, ice40).unwrap();
    let check = Check::new("what a flow says of bad Verilog").files(&files);
    check
        .sources(&["gen/area", "gen/cli/flows.rs", "tests/strangers/flows.rs"])
        .unless_passed(|| bad_verilog_and_a_card_are_told(&ice40));
}

fn bad_verilog_and_a_card_are_told(ice40: &Flow) {
    let text = "module card (input wire a, input wire d, output reg q, output wire z);\n    always @(posedge a) q <= d;\n    assign z = d & q[3];\nendmodule\n";
    let files = [endat_gen::artifact::Artifact::new("card.v", text)];
    let found = flows::through(&files, "card", *ice40).unwrap();
    assert!(!found.warnings.is_empty(), "{found:?}");
    let dir = Dir::new("flows");
    let config = dir.write("card.toml", good(&["presets", "--show", "demo"]).as_bytes());
    let table = good(&["flows", "--config", &config, "--only", "ice40"]);
    assert!(
        table.contains("| ice40 | `synth_ice40` | SB_LUT4 "),
        "{table}"
    );
    assert!(table.ends_with("| 0 |\n"), "{table}");
}
