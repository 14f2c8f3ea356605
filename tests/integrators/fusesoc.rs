//! FuseSoC: several cores in one design, what a target's exit code is worth, and what the targets hand to the tools.

use super::{preset, written};
use crate::bus_card::text;
use crate::tools::{folder, require, require_all, run};
use endat_config::parse;
use endat_console::artifact::Artifact;
use endat_emit::emit;
use endat_hdl::card::bus::HostBus;
use std::fs;
use std::path::Path;

/// The name by which FuseSoC knows a core, without its version.
fn vlnv(name: &str) -> String {
    format!("endat-gen:motion:{name}")
}

/// Runs a target of a core that lies below `place`.
fn target(place: &Path, target: &str, more: &[&str], core: &str) -> (bool, String) {
    let target = format!("--target={target}");
    let arguments = [&["--cores-root", ".", "run", &target], more, &[core]].concat();
    run("fusesoc", place, &arguments)
}

/// A card behind a bus.
fn card(bus: HostBus, more: &str) -> Vec<Artifact> {
    emit(&parse("card.toml", &text(bus, more)).unwrap()).unwrap()
}

fn receiver() -> Vec<Artifact> {
    preset("async_dsp")
}

/// The word that tells a card's configuration, as its header has it.
fn hash_word(files: &[Artifact]) -> String {
    let header = files.iter().find(|f| f.path.ends_with(".h")).unwrap();
    let end = "_CARD_CONFIGURATION_HASH_RESET 0x";
    let line = header.text.lines().find(|l| l.contains(end)).unwrap();
    let (_, number) = line.split_once(end).unwrap();
    number.trim_end_matches('u').into()
}

/// Reads each card's own word over its own bus, and sees the receiver send a request.
const BENCH: &str = "
`timescale 1ns / 1ps
module soc_tb;
    reg clk = 1'b0;
    always #5 clk = !clk;
    reg wb = 1'b0, sel = 1'b0, enable = 1'b0, write_n = 1'b1, cs_n = 1'b1;
    wire ack, ready, driver;
    wire [31:0] word_a, word_b;
    integer sent = 0;
    wishbone_card first (
        .clk_i(clk), .rst_i(1'b0), .trigger_i(1'b0), .wb_cyc_i(wb), .wb_stb_i(wb), .wb_we_i(1'b0), .wb_adr_i(11'd4),
        .wb_dat_i(32'd0), .wb_sel_i(4'hf), .wb_dat_o(word_a), .wb_ack_o(ack), .endat_data0_i(1'b1), .endat_data1_i(1'b1));
    apb_card second (
        .clk_i(clk), .rst_i(1'b0), .trigger_i(1'b0), .s_apb_psel(sel), .s_apb_penable(enable), .s_apb_pwrite(1'b0),
        .s_apb_paddr(13'd16), .s_apb_pwdata(32'd0), .s_apb_prdata(word_b), .s_apb_pready(ready), .endat_data0_i(1'b1),
        .endat_data1_i(1'b1));
    async_dsp receiver (
        .clk_i(clk), .rst_i(1'b0), .clk_select_i(1'b1), .trigger_i(1'b0), .bus_cs_n_i(cs_n), .bus_rd_n_i(1'b1),
        .bus_wr_n_i(write_n), .bus_address_i(3'd0), .bus_data_i(16'd3), .encoder_data_oe(driver), .encoder_data_i(1'b1));
    always @(posedge clk) if (driver) sent = sent + 1;
    initial begin
        repeat (200) @(negedge clk);
        wb = 1'b1;
        while (!ack) @(negedge clk);
        $display(\"first %h\", word_a);
        wb = 1'b0;
        sel = 1'b1;
        @(negedge clk) enable = 1'b1;
        while (!ready) @(negedge clk);
        $display(\"second %h\", word_b);
        sel = 1'b0;
        enable = 1'b0;
        cs_n = 1'b0;
        write_n = 1'b0;
        repeat (6000) @(negedge clk); // the receiver waits after power-up
        repeat (10) @(negedge clk);
        write_n = 1'b1;
        repeat (1000) @(negedge clk);
        $display(\"receiver %0d\", sent);
        $finish;
    end
endmodule
";

/// Catches a module that two cores have with different contents: Verilator takes one of them for both. In `cargo test`,
/// `modules_of_one_name_in_several_emissions_are_the_same` compares them.
#[test]
#[ignore = "slow: FuseSoC's lint and simulation of three cores in one design"]
fn two_cards_and_a_receiver_share_a_design() {
    if !require_all(&["fusesoc", "verilator", "iverilog"], "cores in one design") {
        return;
    }
    let place = folder("fusesoc-soc");
    // The second one differs in what its blocks hold, too.
    let cores = [
        card(HostBus::Wishbone, ""),
        card(HostBus::Apb, "[service]\nparts = [\"requests\"]\n"),
        receiver(),
    ];
    for (index, files) in cores.iter().enumerate() {
        let folder = place.join(format!("core{index}"));
        fs::create_dir(&folder).unwrap();
        for file in files {
            fs::write(folder.join(&file.path), &file.text).unwrap();
        }
    }
    let depends = ["wishbone_card", "apb_card", "async_dsp"]
        .map(vlnv)
        .join("\", \"");
    let core = format!(
        "CAPI=2:\nname: \"::soc:0\"\nfilesets:\n  all:\n    depend: [\"{depends}\"]\n    files: [soc_tb.v]\n    file_type: verilogSource-2005\n\
         targets:\n  default: &default\n    filesets: [all]\n    toplevel: soc_tb\n\
         \x20 sim:\n    <<: *default\n    flow: sim\n    flow_options: {{tool: icarus, iverilog_options: [-g2005]}}\n\
         \x20 lint:\n    <<: *default\n    flow: lint\n    flow_options: {{tool: verilator, verilator_options: [--timing, -Wno-PINMISSING]}}\n"
    );
    fs::write(place.join("soc.core"), core).unwrap();
    fs::write(place.join("soc_tb.v"), BENCH).unwrap();
    let (is_good, told) = target(&place, "lint", &[], "soc");
    assert!(is_good, "{told}");
    let (is_good, told) = target(&place, "sim", &[], "soc");
    assert!(is_good, "{told}");
    for (name, files) in ["first", "second"].iter().zip(&cores) {
        let wanted = format!("{name} {}", hash_word(files).to_lowercase());
        assert!(told.contains(&wanted), "{wanted}: {told}");
    }
    // A request of 10 bits, at 2.5 Mbit/s from a clock that is taken for 60 MHz: 24 clocks each.
    let sent = told.lines().find_map(|l| l.strip_prefix("receiver "));
    let sent: u32 = sent.unwrap().trim().parse().unwrap();
    assert!((240..300).contains(&sent), "{sent}");
}

/// Catches a bench, or a flow, that fails in words only.
#[test]
fn a_failing_bench_fails_its_target() {
    let check = "exit code of FuseSoC for a receiver";
    if !require("fusesoc", check) || !require("iverilog", check) {
        return;
    }
    let mut files = receiver();
    let bench = files.iter_mut().find(|f| f.path.ends_with("_tb.v"));
    let bench = &mut bench.unwrap().text;
    let right = "if (got !== want)";
    assert_eq!(bench.matches(right).count(), 1);
    *bench = bench.replace(right, "if (got === want)");
    // The first complaint is enough, and FuseSoC hands no plusarg on.
    *bench = bench.replace("if ($test$plusargs(\"first\"))", "if (1'b1)");
    let place = written(&files, "fusesoc-failing-receiver");
    let (is_good, told) = target(&place, "sim", &[], &vlnv("async_dsp"));
    assert!(!is_good && told.contains("FAIL "), "{told}");
}

#[test]
#[ignore = "slow: FuseSoC's exit code for a failing bench of a card"]
fn a_failing_bench_of_a_card_fails_its_target() {
    let check = "exit code of FuseSoC";
    if !require("fusesoc", check) || !require("iverilog", check) {
        return;
    }
    let mut files = card(HostBus::Apb, "");
    let bench = files.iter_mut().find(|f| f.path.ends_with("_tb.v"));
    let bench = &mut bench.unwrap().text;
    let right = "32'h456E4474);";
    assert_eq!(bench.matches(right).count(), 1);
    *bench = bench.replace(right, "32'h456E4475);");
    let place = written(&files, "fusesoc-failing");
    let (is_good, told) = target(&place, "sim", &[], &vlnv("apb_card"));
    assert!(!is_good && told.contains("FAIL 1 complaints"), "{told}");
}

/// Every file that a target hands to its tool, in one text.
fn handed(place: &Path) -> String {
    let mut text = String::new();
    let mut folders = vec![place.join("build")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap_or_default().to_owned();
            match path.is_dir() {
                true if name != "src" => folders.push(path),
                true => {}
                false => text += &fs::read_to_string(path).unwrap_or_default(),
            }
        }
    }
    text
}

/// Catches a target without the clock that the card needs, and one that ends with a bitstream whose pins nobody has chosen.
#[test]
fn targets_know_the_clock_and_make_no_bitstream_without_pins() {
    targets_know_the_clock("async_dsp", &["ecp5", "vivado"]);
}

#[test]
#[ignore = "slow: every target of FuseSoC for cards and a receiver"]
fn every_target_knows_the_clock_and_makes_no_bitstream_without_pins() {
    for name in ["s6_two_channel", "apb_card", "async_dsp"] {
        targets_know_the_clock(name, &["ice40", "ecp5", "vivado", "quartus"]);
    }
}

fn targets_know_the_clock(core: &str, tools: &[&str]) {
    if !require("fusesoc", "FuseSoC targets") {
        return;
    }
    let cores = [
        ("s6_two_channel", preset("s6_two_channel"), "100"),
        ("apb_card", card(HostBus::Apb, ""), "100"),
        ("async_dsp", receiver(), "60"),
    ];
    for (name, files, mhz) in cores.iter().filter(|(name, ..)| *name == core) {
        let period_ns = if *mhz == "60" { "16.667" } else { "10" };
        let rows = [
            ("ice40", format!("--freq {mhz}"), "icepack"),
            ("ecp5", format!("--freq {mhz}"), "ecppack"),
            (
                "vivado",
                format!("read_xdc src/endat-gen_motion_{name}"),
                "default_target: bit",
            ),
            ("quartus", format!("{name}.sdc"), "\nall: asm"),
        ];
        let rows = rows.into_iter().filter(|(tool, ..)| tools.contains(tool));
        for (tool, wanted, unwanted) in rows {
            let place = written(files, &format!("fusesoc-{name}-{tool}"));
            let (is_good, told) = target(&place, tool, &["--setup"], &vlnv(name));
            assert!(is_good, "{name} {tool}: {told}");
            let text = handed(&place);
            let text = text.replace(['{', '}'], "");
            assert!(text.contains(&wanted), "{name} {tool}: {wanted}: {text}");
            assert!(!text.contains(unwanted), "{name} {tool}: {unwanted}");
            let sdc = fs::read_to_string(place.join(format!("{name}.sdc"))).unwrap();
            assert!(sdc.contains(&format!("-period {period_ns} ")), "{sdc}");
        }
        // Only a board has pins: there the bitstream is of the board top, with all its constraints.
        let place = written(files, &format!("fusesoc-{name}-ise"));
        let (is_good, told) = target(&place, "ise", &["--setup"], &vlnv(name));
        assert_eq!(is_good, *name == "s6_two_channel", "{told}");
        if is_good {
            let text = handed(&place);
            for wanted in [
                "xc6slx9",
                "tqg144",
                "s6_two_channel.ucf",
                "s6_two_channel_top",
            ] {
                assert!(text.contains(wanted), "{wanted}: {text}");
            }
        }
    }
}

/// The clock that the target asks for is the one that the verdict is about.
#[test]
#[ignore = "slow: FuseSoC's target for an iCE40, to its bitstream"]
fn a_slow_card_meets_its_clock_on_ice40() {
    if !require_all(
        &["fusesoc", "yosys", "nextpnr-ice40"],
        "FuseSoC target ice40",
    ) {
        return;
    }
    let second = "[[channel]]\nposition_bits = 25\ncommand = \"000111\"\n";
    let text = text(HostBus::Wishbone, "").replace(second, "");
    let text = text.replace("system_hz = 100_000_000", "system_hz = 25_000_000");
    let files = emit(&parse("card.toml", &text).unwrap()).unwrap();
    let place = written(&files, "fusesoc-ice40");
    let (is_good, told) = target(&place, "ice40", &[], &vlnv("wishbone_card"));
    assert!(is_good && told.contains("(PASS at 25.00 MHz)"), "{told}");
}
