//! The board top and its constraints: a strict reader of UCF, and real tools over the Verilog.

use endat_config::board::Board;
use endat_config::{load_preset, parse, Project};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn text_of(project: &Project, end: &str) -> String {
    let files = endat_emit::emit(project).unwrap();
    files
        .into_iter()
        .find(|a| a.path.ends_with(end))
        .unwrap_or_else(|| panic!("no {end}"))
        .text
}

/// What one UCF says about one net.
#[derive(Debug, Default, PartialEq)]
struct Net {
    attributes: BTreeMap<String, String>,
    flags: BTreeSet<String>,
}

/// A strict reader of the UCF statements that are emitted; anything else is an error.
fn read_ucf(text: &str) -> Result<BTreeMap<String, Net>, String> {
    let mut nets: BTreeMap<String, Net> = BTreeMap::new();
    let code: String = text
        .lines()
        .map(|l| format!("{}\n", l.split('#').next().unwrap_or("")))
        .collect();
    let mut statements: Vec<&str> = code.split(';').map(str::trim).collect();
    if statements.pop() != Some("") {
        return Err("the last statement is not terminated".into());
    }
    for statement in statements {
        if statement.contains('\n') {
            return Err(format!(
                "a statement runs over the end of its line: {statement:?}"
            ));
        }
        let (kind, rest) = statement
            .split_once(' ')
            .ok_or(format!("empty statement: {statement:?}"))?;
        match kind {
            "CONFIG" if rest.starts_with("PART = ") => {}
            "TIMESPEC" => {
                let words: Vec<&str> = rest.split_whitespace().collect();
                if let [name, "=", "FROM", group, "TO", "\"FFS\"", ns, "ns", "DATAPATHONLY"] =
                    words[..]
                {
                    let group = group.trim_matches('"');
                    if name != format!("\"TS_{group}\"") {
                        return Err(format!("TIMESPEC {name} of {group}"));
                    }
                    let is_in =
                        |net: &&mut Net| net.attributes.get("TNM").is_some_and(|g| g == group);
                    let mut inputs = nets.values_mut().filter(is_in).peekable();
                    inputs.peek().ok_or(format!("nothing is in {group}"))?;
                    for net in inputs {
                        if net.attributes.insert("BOUND".into(), ns.into()).is_some() {
                            return Err("two bounds".into());
                        }
                    }
                    continue;
                }
                let ["\"TS_osc_i\"", "=", "PERIOD", "\"osc_i\"", ns, "ns", "HIGH", "50", "%"] =
                    words[..]
                else {
                    return Err(format!("TIMESPEC {rest}"));
                };
                let net = nets.entry("osc_i".into()).or_default();
                if net.attributes.insert("PERIOD".into(), ns.into()).is_some() {
                    return Err("two periods".into());
                }
            }
            "NET" => {
                let (name, rest) = rest
                    .strip_prefix('"')
                    .and_then(|r| r.split_once('"'))
                    .ok_or(format!("NET {rest}"))?;
                let net = nets.entry(name.to_owned()).or_default();
                for part in rest.split('|').map(str::trim) {
                    let fresh = match part.split_once(" = ") {
                        Some((
                            key @ ("LOC" | "IOSTANDARD" | "SLEW" | "DRIVE" | "IOB" | "TNM"
                            | "TNM_NET"),
                            value,
                        )) => net
                            .attributes
                            .insert(key.into(), value.trim_matches('"').into())
                            .is_none(),
                        None if matches!(part, "PULLUP" | "PULLDOWN") => {
                            net.flags.insert(part.into())
                        }
                        _ => return Err(format!("NET {name}: unknown constraint {part:?}")),
                    };
                    if !fresh {
                        return Err(format!("NET {name}: {part} twice"));
                    }
                }
            }
            _ => return Err(format!("unknown statement {statement:?}")),
        }
    }
    Ok(nets)
}

/// Ports of the board top: name and whether it is an input.
fn ports(verilog: &str) -> Vec<(String, bool)> {
    let head = verilog.split_once(");").unwrap().0;
    let lines = head.lines().filter(|l| {
        ["put wire ", "put  wire ", "inout  wire "]
            .iter()
            .any(|d| l.contains(d))
    });
    lines
        .map(|l| {
            (
                l.trim_end_matches(',')
                    .rsplit(' ')
                    .next()
                    .unwrap()
                    .to_owned(),
                l.contains("input "),
            )
        })
        .collect()
}

/// Every port of the top has one usable pin, its standard, and a reason if nobody times it.
pub fn judge(project: &Project) {
    let nets = read_ucf(&text_of(project, ".ucf")).unwrap();
    let ports = ports(&text_of(project, "_top.v"));
    assert_eq!(ports.len(), project.pins.len());
    assert_eq!(
        nets.keys().collect::<BTreeSet<_>>(),
        ports.iter().map(|(p, _)| p).collect(),
        "ports and nets"
    );
    let board = Board::named("papilio_pro").unwrap();
    let usable: BTreeSet<&String> = board
        .connectors
        .values()
        .flatten()
        .chain(board.fixed.values())
        .chain([&board.oscillator_pin])
        .collect();
    let mut pins = BTreeSet::new();
    for (port, is_input) in &ports {
        let net = &nets[port];
        let pin = &net.attributes["LOC"];
        assert!(
            usable.contains(pin),
            "{port}: {pin} is not usable on the board"
        );
        assert!(pins.insert(pin), "{pin} twice");
        assert_eq!(net.attributes["IOSTANDARD"], "LVCMOS33", "{port}");
        let transceiver = port.starts_with("endat_") && !is_input;
        assert_eq!(
            net.attributes.get("IOB").map(String::as_str),
            transceiver.then_some("TRUE"),
            "{port}"
        );
        assert_eq!(net.attributes.contains_key("SLEW"), !is_input, "{port}");
        // No clock times them: a way to the first register of a system clock at most.
        let is_asynchronous = (*is_input || port.ends_with("_io")) && port != "osc_i";
        let bound = net
            .attributes
            .get("BOUND")
            .map(|ns| ns.parse::<f64>().unwrap());
        let samples =
            1 + u32::from(project.card.line.double_edge && port.starts_with("endat_data"));
        let period = 1e9 / project.card.system_hz as f64 / f64::from(samples);
        assert_eq!(bound.is_some(), is_asynchronous, "{port}");
        assert!(
            bound.is_none_or(|ns| (ns - period).abs() < 1e-4),
            "{port}: {bound:?}"
        );
        assert!(
            net.flags.contains("PULLUP")
                || net.flags.contains("PULLDOWN")
                || !is_input
                || port == "osc_i",
            "{port} may float"
        );
    }
    assert_eq!(nets["osc_i"].attributes["PERIOD"], "31.25");
}

#[test]
fn every_port_of_the_preset_has_one_usable_pin_and_its_standard() {
    judge(&load_preset("s6_two_channel").unwrap());
}

#[test]
fn moved_pins_and_other_channel_counts_hold_too() {
    let preset = include_str!("../gen/config/presets/s6_two_channel.toml");
    let moved = preset.replacen(
        "[pins]",
        "[pins]\ntrigger_i = \"A0\"\nendat_data0_i = \"P47\"",
        1,
    );
    let project = parse("card.toml", &moved).unwrap();
    judge(&project);
    assert_eq!(
        read_ucf(&text_of(&project, ".ucf")).unwrap()["trigger_i"].attributes["LOC"],
        "P48"
    );
    let second = preset
        .find("[[channel]]                     # channel 1")
        .unwrap();
    let single = format!(
        "{}{}",
        &preset[..second],
        &preset[preset.find("[trigger]").unwrap()..]
    );
    let project = parse("card.toml", &single).unwrap();
    assert_eq!(project.card.channels.len(), 1);
    judge(&project);
}

#[test]
fn the_wiring_page_names_the_pins_of_the_preset() {
    let page = include_str!("../docs/wiring.md");
    for pin in load_preset("s6_two_channel").unwrap().pins {
        // Rows of the channels are written once, with N for the number.
        let n = pin.signal.find(|c: char| c.is_ascii_digit());
        let name = n.map_or(pin.signal.clone(), |at| {
            format!("{}N{}", &pin.signal[..at], &pin.signal[at + 1..])
        });
        let place = pin.place();
        let row = page
            .lines()
            .find(|l| l.starts_with('|') && l.contains(&name) && l.contains(&place));
        assert!(row.is_some(), "{} on {place}", pin.signal);
    }
}

/// Catches two samplers of one line of which one may see it a sample later than the other.
#[test]
fn a_line_with_two_samplers_has_half_the_way_to_them() {
    let of = |board: &str| {
        let request =
            crate::program::good(&["presets", "--show", "s6_two_channel", "--board", board]);
        let (before, line) = request.split_once("[line]").unwrap();
        let line = line.replacen("parts = []", "parts = [\"alignment\", \"double_edge\"]", 1);
        let request = format!("{before}[line]{line}");
        parse("card.toml", &request).unwrap()
    };
    let card = of("papilio_pro");
    assert!(card.card.line.double_edge);
    let nets = read_ucf(&text_of(&card, ".ucf")).unwrap();
    let bound = |signal: &str| nets[signal].attributes["BOUND"].clone();
    assert_eq!(bound("endat_data1_i"), "5");
    assert_eq!(bound("trigger_i"), "10");
    for (board, end, word) in [
        ("arty_a7_35", "channel.xdc", " -datapath_only"),
        ("de10_nano", "_top.sdc", ""),
    ] {
        let text = text_of(&of(board), end);
        for (signal, ns) in [("endat_data1_i", 5), ("trigger_i", 10)] {
            let line = format!("set_max_delay{word} -from [get_ports {signal}] {ns}\n");
            assert!(text.contains(&line), "{line}{text}");
        }
    }
    let gowin = text_of(&of("tang_nano_9k"), "_top.sdc");
    assert!(
        gowin.contains("set_max_delay -from [get_ports {endat_data1_i}] 5.0505\n"),
        "{gowin}"
    );
    assert!(
        gowin.contains("set_false_path -from [get_ports {trigger_i}]\n"),
        "{gowin}"
    );
    // That of the core alone, for a top of somebody's own.
    let core = text_of(&of("arty_a7_35"), "channel.sdc");
    assert!(core.contains("}] 5\nset_min_delay -from "), "{core}");
    let one = text_of(&load_preset("s6_two_channel").unwrap(), "channel.sdc");
    assert!(
        one.contains("set_false_path -from ") && !one.contains("set_max_delay"),
        "{one}"
    );
}

#[test]
fn the_ucf_reader_is_strict() {
    let good = text_of(&load_preset("s6_two_channel").unwrap(), ".ucf");
    assert!(read_ucf(&good).is_ok());
    let last = good.trim_end().trim_end_matches(';');
    for bad in [
        last.to_owned(),
        good.replacen(';', "", 2),
        good.replace("IOSTANDARD", "IOSTANDART"),
        good.replace(
            "NET \"trigger_i\" TNM =",
            "NET \"trigger_i\" TNM = \"others\";\nNET \"trigger_i\" TNM =",
        ),
        good.replace("NET \"trigger_i\" TNM", "NET trigger_i TNM"),
        good.replace("FROM \"asynchronous_inputs\"", "FROM \"asynchronous\""),
        good.replace(" DATAPATHONLY", ""),
        good.replace("PERIOD \"osc_i\"", "PERIOD osc_i"),
        good.replace("CONFIG", "KONFIG"),
    ] {
        assert!(read_ucf(&bad).is_err());
    }
}

/// The primitives of the board top, as far as a simulator needs them; the real ones come with the vendor's tools.
const PRIMITIVES: &str = r#"
`timescale 1ns / 1ps
`default_nettype none
module IBUFG (input wire I, output wire O);
    assign O = I;
endmodule
module BUFG (input wire I, output wire O);
    assign O = I;
endmodule
module PLL_BASE #(
    parameter BANDWIDTH = "OPTIMIZED",
    parameter COMPENSATION = "SYSTEM_SYNCHRONOUS",
    parameter real CLKIN_PERIOD = 0.0,
    parameter integer DIVCLK_DIVIDE = 1,
    parameter integer CLKFBOUT_MULT = 1,
    parameter integer CLKOUT0_DIVIDE = 1
) (
    input wire CLKIN, input wire RST, input wire CLKFBIN,
    output wire CLKFBOUT, output wire CLKOUT0, output wire CLKOUT1, output wire CLKOUT2, output wire CLKOUT3,
    output wire CLKOUT4, output wire CLKOUT5, output wire LOCKED
);
`ifdef VERILATOR
    // Lint only: the real delays would be warned about.
    assign CLKOUT0 = CLKIN;
    assign LOCKED = ~RST;
    wire unused_factors = &{1'b0, CLKIN_PERIOD > 0.0, DIVCLK_DIVIDE > CLKFBOUT_MULT, CLKOUT0_DIVIDE > 0};
`else
    reg oscillator = 1'b0;
    reg locked = 1'b0;
    initial #1000 locked = 1'b1;
    always #(CLKIN_PERIOD * DIVCLK_DIVIDE * CLKOUT0_DIVIDE / CLKFBOUT_MULT / 2.0) oscillator = ~oscillator;
    assign CLKOUT0 = oscillator;
    assign LOCKED = locked;
`endif
    assign CLKFBOUT = CLKIN;
    assign {CLKOUT1, CLKOUT2, CLKOUT3, CLKOUT4, CLKOUT5} = 5'b0;
    wire unused = &{1'b0, RST, CLKFBIN, BANDWIDTH == "OPTIMIZED", COMPENSATION == "INTERNAL"};
endmodule
`default_nettype wire
"#;

/// Counts clock cycles and reset cycles of the card for 10 us.
const BENCH: &str = r#"
`timescale 1ns / 1ps
module bench;
    reg osc = 0;
    always #15.625 osc = ~osc;
    NAME_top top (.osc_i(osc), .trigger_i(1'b0), .uart_rx_i(1'b1), .endat_data0_i(1'b0), .endat_data1_i(1'b0),
        .uart_tx_o(), .endat_clk0_o(), .endat_data0_o(), .endat_data0_oe(), .endat_clk1_o(), .endat_data1_o(),
        .endat_data1_oe(), .led_status_o(), .led_channel0_o(), .led_channel1_o());
    integer cycles = 0;
    integer after_lock = 0;
    integer last_reset = 0;
    always @(posedge top.card.clk_i) begin
        cycles = cycles + 1;
        if (top.pll_locked) after_lock = after_lock + 1;
        if (top.card.rst_i) last_reset = after_lock;
    end
    initial #11001 begin
        $display("cycles %0d reset until %0d reset now %b", cycles, last_reset, top.card.rst_i);
        $finish;
    end
endmodule
"#;

/// Runs a tool; `None` with a line when it is missing and the environment does not insist.
pub fn tool(name: &str, folder: &Path, arguments: &[&str]) -> Option<(bool, String)> {
    crate::tools::assert_listed(name);
    match Command::new(name)
        .args(arguments)
        .current_dir(folder)
        .output()
    {
        Ok(output) => {
            let text = [output.stdout, output.stderr].concat();
            Some((
                output.status.success(),
                String::from_utf8_lossy(&text).into_owned(),
            ))
        }
        Err(_) => {
            assert!(std::env::var_os("CI").is_none(), "{name} is required in CI");
            eprintln!("skipped: {name} is not installed");
            None
        }
    }
}

/// A card with the ports of the real one and nothing inside, for as long as the design is not part of the emission.
fn empty_card(project: &Project) -> String {
    let mut ports = vec!["input wire clk_i".to_owned(), "input wire rst_i".to_owned()];
    let mut body = String::new();
    let mut inputs = vec!["clk_i", "rst_i"];
    for pin in project.pins.iter().filter(|p| p.signal != "osc_i") {
        if pin.kind.is_input() {
            ports.push(format!("input wire {}", pin.signal));
            inputs.push(&pin.signal);
        } else {
            ports.push(format!("output wire {}", pin.signal));
            body.push_str(&format!("assign {} = 1'b0;\n", pin.signal));
        }
    }
    let name = &project.name;
    format!("`timescale 1ns / 1ps\nmodule {name} ({});\n{body}wire unused = &{{1'b0, {}}};\nendmodule\n", ports.join(", "), inputs.join(", "))
}

/// What a bench, module `bench`, says at the top of a card's board; none without iverilog.
pub fn play(project: &Project, name: &str, bench: &str) -> Option<String> {
    let (folder, files) = lay_out(project, name);
    fs::write(folder.join("bench.v"), bench).unwrap();
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let head = ["-g2005", "-o", "x.vvp", "-s", "bench", "bench.v"];
    let (good, said) = tool("iverilog", &folder, &[&head[..], &files].concat())?;
    assert!(good, "{said}");
    let (_, said) = tool("vvp", &folder, &["-n", "x.vvp"]).expect("vvp comes with iverilog");
    Some(said)
}

/// All Verilog of a project and the primitives, in a folder of its own.
pub fn lay_out(project: &Project, test: &str) -> (PathBuf, Vec<String>) {
    let folder = crate::tools::folder(&format!("constraints-{test}"));
    let primitives = format!("{PRIMITIVES}{}", include_str!("data/primitives.v"));
    let mut files = vec![("primitives.v".to_owned(), primitives)];
    let emitted = endat_emit::emit(project).unwrap();
    files.extend(
        emitted
            .into_iter()
            .filter(|a| a.path.ends_with(".v"))
            .map(|a| (a.path, a.text)),
    );
    let card = format!("{}.v", project.name);
    if !files.iter().any(|(path, _)| *path == card) {
        files.push((card, empty_card(project)));
    }
    for (path, text) in &files {
        fs::write(folder.join(path), text).unwrap();
    }
    (folder, files.into_iter().map(|(path, _)| path).collect())
}

#[test]
fn the_board_top_elaborates_without_a_warning() {
    lint_top(&load_preset("s6_two_channel").unwrap(), "elaborate");
}

/// Neither compiler nor linter has anything to say about the top.
pub fn lint_top(project: &Project, test: &str) {
    let (folder, files) = lay_out(project, test);
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let top = format!("{}_top", project.name);
    let icarus = [&["-g2005", "-Wall", "-o", "x.vvp", "-s", &top][..], &files].concat();
    if let Some((good, text)) = tool("iverilog", &folder, &icarus) {
        assert!(good && text.is_empty(), "{text}");
    }
    let lint = [
        &[
            "--lint-only",
            "-Wall",
            "--top-module",
            &top,
            "-v",
            "primitives.v",
        ][..],
        &files[1..],
    ]
    .concat();
    if let Some((good, text)) = tool("verilator", &folder, &lint) {
        // What the linter says about the blocks is judged where the blocks are tested.
        let about_top = |l: &&str| {
            l.starts_with('%')
                && (l.contains("_top.v:") || l.starts_with("%Error") && !l.contains("Exiting"))
        };
        let found: Vec<&str> = text.lines().filter(about_top).collect();
        assert!(found.is_empty(), "{text}");
        assert!(good || text.contains("%Warning"), "{text}");
    }
}

#[test]
fn the_clock_manager_makes_the_system_clock_and_reset_ends_in_step_with_it() {
    let project = load_preset("s6_two_channel").unwrap();
    let (folder, files) = lay_out(&project, "clock");
    fs::write(folder.join("bench.v"), BENCH.replace("NAME", &project.name)).unwrap();
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let compile = [
        &["-g2005", "-o", "x.vvp", "-s", "bench", "bench.v"][..],
        &files,
    ]
    .concat();
    let Some((good, text)) = tool("iverilog", &folder, &compile) else {
        return;
    };
    assert!(good, "{text}");
    let (_, text) = tool("vvp", &folder, &["-n", "x.vvp"]).expect("vvp comes with iverilog");
    // 11 us at 100 MHz; locked from 1 us on; four stages of reset.
    assert_eq!(text.trim(), "cycles 1100 reset until 4 reset now 0");
}
