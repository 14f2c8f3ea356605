//! What integrators take: each file, used by the program that it is for.

mod designers;
mod fusesoc;
mod ipxact;
mod litex;
mod names;
mod zynq;

use crate::tools::{self, require, require_all, require_python, run};
use endat_gen::artifact::Artifact;
use endat_gen::config::{load_any_preset, Configuration, Project};
use endat_gen::{cli, emit};
use std::fs;
use std::path::{Path, PathBuf};

/// Writes all files of an emission into an empty folder.
fn written(artifacts: &[Artifact], name: &str) -> PathBuf {
    let folder = tools::folder(name);
    for artifact in artifacts {
        fs::write(folder.join(&artifact.path), &artifact.text).unwrap();
    }
    folder
}

#[cfg(unix)]
fn emitted(project: &Project, name: &str) -> PathBuf {
    written(&emit(project).unwrap(), name)
}

/// The Verilog files of a core itself.
fn sources(folder: &Path) -> Vec<String> {
    let files = fs::read_dir(folder).unwrap();
    let names = files.filter_map(|f| f.ok()?.file_name().into_string().ok());
    let others = ["_tb.v", "_top.v", "_axi4lite.v", "holder.v"];
    names
        .filter(|f| f.ends_with(".v") && !others.iter().any(|o| f.ends_with(o)))
        .collect()
}

fn preset(name: &str) -> Vec<Artifact> {
    match load_any_preset(name).unwrap() {
        Configuration::Card(card) => emit(&card).unwrap(),
        Configuration::Receiver(receiver) => {
            endat_gen::protocols::t_format::emit(&receiver).unwrap()
        }
    }
}

/// What is emitted for integrators, a card and a receiver: name, class in Python, ports, folder.
fn cores(test: &str) -> [(&'static str, &'static str, usize, PathBuf); 2] {
    let of = |name, class, ports| {
        let folder = written(&preset(name), &format!("{test}-{name}"));
        (name, class, ports, folder)
    };
    [
        of("s6_two_channel", "S6TwoChannel", 16),
        of("async_dsp", "AsyncDsp", 15),
    ]
}

/// Catches a file that the list leaves out, a target that FuseSoC refuses, and lint.
#[test]
fn fusesoc_lints_and_simulates_the_core() {
    fusesoc_runs("fusesoc", &[("async_dsp", &["lint", "sim"])]);
}

#[test]
#[ignore = "slow: FuseSoC's lint and simulation of a card"]
fn fusesoc_lints_and_simulates_the_card() {
    fusesoc_runs("fusesoc-card", &[("s6_two_channel", &["lint", "sim"])]);
}

fn fusesoc_runs(test: &str, rows: &[(&str, &[&str])]) {
    if !require_all(&["fusesoc", "verilator", "iverilog"], "FuseSoC core") {
        return;
    }
    for (name, targets) in rows {
        let folder = &written(&preset(name), &format!("{test}-{name}"));
        for target in *targets {
            let is_lint = *target == "lint";
            let target = format!("--target={target}");
            let arguments = ["--cores-root", ".", "run", &target, name];
            let (is_good, told) = run("fusesoc", folder, &arguments);
            assert!(is_good, "{name} {target}: {told}");
            assert!(is_lint || told.contains("PASS"), "{told}");
        }
    }
}

/// Catches a port that is missing in the template, or has another width.
#[test]
fn the_instantiation_template_is_complete() {
    if !require("iverilog", "instantiation template") {
        return;
    }
    for (name, _, ports, folder) in cores("instance") {
        let template = fs::read_to_string(folder.join(format!("{name}_instance.vh"))).unwrap();
        assert_eq!(template.matches("    .").count(), ports, "{template}");
        let module = format!("module holder;\n{template}\nendmodule\n");
        fs::write(folder.join("holder.v"), module).unwrap();
        let mut arguments = vec!["-g2005", "-tnull", "-s", "holder", "holder.v"];
        let sources = sources(&folder);
        arguments.extend(sources.iter().map(String::as_str));
        let (is_good, told) = run("iverilog", &folder, &arguments);
        assert!(is_good, "{told}");
    }
}

/// Vivado's commands as tclsh sees them: each called with words that it knows, files that exist, ports that the card has.
const VIVADO: &str = r#"
proc create_project args {}
proc add_files args {
    set file [lindex $args end]
    if {![file exists $file]} { error "no file $file" }
    if {[lrange $args 0 1] eq {-fileset constrs_1}} { source $file } else { incr ::files }
}
set bounds 0
proc get_ports names {
    foreach name $names { if {$name ni $::ports} { error "no port $name" } }
    return $names
}
proc set_max_delay {only from ports ns} {
    if {"$only $from" ne "-datapath_only -from" || $ports eq {}} { error "set_max_delay $only $from $ports" }
    set ::bounds $ns
}
proc current_fileset {} { return sources_1 }
proc set_property {name value object} {
    if {$object eq ""} { error "no object for $name" }
    if {$name eq "physical_name" && $value ni $::ports} { error "no port $value" }
    if {$name eq "range"} { set ::range $value }
}
set mapped {}
set linked {}
set range 0
proc update_compile_order args {}
namespace eval ipx {
    proc package_project args { if {"-root_dir" ni $args} { error "no root" } }
    proc current_core {} { return core }
    proc infer_bus_interface {port kind core} { if {$port ni $::ports} { error "no port $port" } ; lappend ::known $port }
    proc add_bus_interface {name core} { lappend ::known $name ; return $name }
    proc add_port_map {logical bus} { lappend ::mapped $logical ; return $logical }
    proc associate_bus_interfaces args { lappend ::linked [lindex $args 1] }
    proc add_memory_map {name core} { return $name }
    proc add_address_block {name map} { return $map.$name }
    proc get_bus_interfaces {name option core} { if {$name ni $::known} { error "no interface $name" } ; return $name }
    proc add_bus_parameter {name interface} { return $interface.$name }
    proc remove_all_bus_interface core {}
    proc remove_all_memory_map core {}
    proc create_xgui_files core {}
    proc update_checksums core {}
    proc save_core core { set ::saved 1 }
}
"#;

#[test]
fn the_vivado_script_packages_every_source() {
    if !require("tclsh", "Vivado script") {
        return;
    }
    for (name, _, _, folder) in cores("vivado") {
        let count = sources(&folder).len();
        let told = packaged(name, &folder);
        assert!(
            told.contains(&format!("files {count} saved 1")),
            "{name}: {told}"
        );
    }
}

/// What Vivado's commands have been told by a core's script.
fn packaged(name: &str, folder: &Path) -> String {
    let template = fs::read_to_string(folder.join(format!("{name}_instance.vh"))).unwrap();
    let ports = template
        .lines()
        .filter_map(|l| l.strip_prefix("    .")?.split('(').next());
    let script = format!(
        "set ports {{{}}}\n{VIVADO}source {name}_vivado.tcl\n\
         puts \"files $files saved $saved\"\nputs \"known $known mapped $mapped linked $linked range $range bounds $bounds\"\n",
        ports.collect::<Vec<_>>().join(" ")
    );
    fs::write(folder.join("stub.tcl"), script).unwrap();
    let (is_good, told) = run("tclsh", folder, &["stub.tcl"]);
    assert!(is_good, "{name}: {told}");
    told
}

/// Catches a bus that Vivado would show as loose pins, and an interrupt that nobody can connect.
#[test]
fn the_vivado_script_names_bus_clock_reset_and_interrupt() {
    use endat_hdl::card::bus::HostBus;
    if !require("tclsh", "Vivado interfaces") {
        return;
    }
    let rows = [
        (HostBus::AxiLite, "s_axi", "AWADDR AWVALID AWREADY WDATA WSTRB WVALID WREADY BRESP BVALID BREADY ARADDR ARVALID ARREADY RDATA RRESP RVALID RREADY"),
        (HostBus::Apb, "s_apb", "PSEL PENABLE PWRITE PADDR PWDATA PRDATA PREADY PSLVERR"),
    ];
    // Two samples in a period halve what there is between them.
    let lines = [
        ("", 10),
        ("[line]\nparts = [\"alignment\", \"double_edge\"]\n", 5),
    ];
    for ((bus, interface, signals), (line, bound)) in rows.into_iter().zip(lines) {
        let text =
            crate::bus_card::text(bus, &format!("[outputs]\nparts = [\"interrupt\"]\n{line}"));
        let project = endat_gen::config::parse("card.toml", &text).unwrap();
        let folder = written(&emit(&project).unwrap(), &format!("vivado-{interface}"));
        let told = packaged(&project.name, &folder);
        let wanted = format!(
            "known clk_i rst_i {interface} irq_o mapped {signals} linked {interface} range 8192 bounds {bound}"
        );
        assert!(told.contains(&wanted), "{told}");
    }
}

#[test]
fn litex_elaborates_the_module_and_its_verilog_fits_the_card() {
    let check = "LiteX module";
    if !require_python("migen", check) || !require("iverilog", check) {
        return;
    }
    for (name, class, ports, folder) in cores("litex") {
        // Clock and reset are those of the system.
        let signals = ports - 2;
        let script = format!(
            "
from migen.fhdl.verilog import convert
from {name}_litex import {class}
core = {class}()
ios = {{getattr(core, n) for n in vars(core) if n.endswith(('_i', '_o', '_oe'))}}
assert len(ios) == {signals}, len(ios)
convert(core, ios, name='soc').write('soc.v')
open('sources', 'w').write(' '.join(core.SOURCES))
"
        );
        let (is_good, told) = run("python3", &folder, &["-c", &script]);
        assert!(is_good, "{told}");
        let sources = fs::read_to_string(folder.join("sources")).unwrap();
        let mut arguments = vec!["-g2005", "-tnull", "-s", "soc", "soc.v"];
        arguments.extend(sources.split(' '));
        let (is_good, told) = run("iverilog", &folder, &arguments);
        assert!(is_good, "{told}");
    }
}

/// The C example reads a virtual card.
#[cfg(unix)]
#[test]
fn the_c_example_reads_positions() {
    use crate::hosts::{slow_card, Served};
    use endat_gen::virtual_card::Door;
    if !require("gcc", "C example") {
        return;
    }
    let project = slow_card();
    let folder = emitted(&project, "c_example");
    let flags = [
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-Wpedantic",
        "-Wconversion",
        "-Werror",
        "-o",
        "example",
    ];
    let (is_good, told) = run(
        "gcc",
        &folder,
        &[&flags[..], &["s6_two_channel_example.c"]].concat(),
    );
    assert!(is_good, "{told}");
    let card = Served::new(project, || Door::terminal().unwrap());
    let program = folder.join("example");
    // The first trigger measures the delays, and has a position of each channel when that is done.
    let read = || run(program.to_str().unwrap(), &folder, &[&card.name]);
    let first = |told: &str| {
        [0, 1]
            .iter()
            .any(|n| told.contains(&format!("sequence {n},")))
    };
    let mut again = (0..100).map(|_| read());
    let (is_good, told) = again.find(|(_, told)| !first(told)).expect("triggers");
    assert!(is_good && told.contains("channel 1: position "), "{told}");
    // Both are of one moment: the same trigger.
    let stamp = |line: &str| {
        line.split("time stamp ")
            .nth(1)?
            .split(',')
            .next()
            .map(str::to_owned)
    };
    let stamps: Vec<_> = told.lines().filter_map(stamp).collect();
    assert!(stamps.len() == 2 && stamps[0] == stamps[1], "{told}");
    let (is_good, told) = run(program.to_str().unwrap(), &folder, &["/nowhere"]);
    assert!(!is_good && told.contains("/nowhere"), "{told}");
}

/// Runs a decoder of sigrok, with its options, over the wires of a scenario; its annotations.
fn decoded(scenario: &str, decoder: &str) -> Option<(serde_json::Value, String)> {
    if !require("sigrok-cli", "sigrok decoder") {
        return None;
    }
    let folder = tools::folder(&format!("sigrok_{scenario}"));
    let wires = folder.join("wires.vcd");
    let file = wires.to_str().unwrap();
    let arguments = [
        "endat-gen",
        "sim",
        scenario,
        "--channel",
        "0",
        "--json",
        "--wires",
        file,
    ];
    let outcome = cli::run(arguments);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    let decoders = Path::new(env!("CARGO_MANIFEST_DIR")).join("sigrok");
    let output = std::process::Command::new("sigrok-cli")
        .env("SIGROKDECODE_DIR", decoders)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .args([
            "-I",
            "vcd",
            "-i",
            file,
            "-P",
            decoder,
            "-A",
            decoder.split(':').next().unwrap(),
        ])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success(),
        "{told}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    Some((serde_json::from_str(&outcome.stdout).unwrap(), told))
}

fn endat(bits: u32) -> String {
    format!("endat:clk=clk:data=data:bits={bits}")
}

/// Catches a decoder of T-format that takes another field or byte order, misses a wrong check sum, or a request of the host.
#[test]
fn sigrok_decodes_every_t_format_exchange() {
    let Some((report, told)) = decoded("t-format", "t_format:data=data") else {
        return;
    };
    let exchanges = report[0]["exchanges"].as_array().unwrap();
    assert!(exchanges.len() >= 7 && report[0]["complaints"] == serde_json::json!([]));
    let lines: Vec<_> = told
        .lines()
        .filter_map(|l| l.split_once(": ")?.1.into())
        .collect();
    // What the encoder heard and answered, as the decoder should tell it.
    let mut wanted = vec![];
    for exchange in exchanges {
        let bytes = |name: &str| -> Vec<u64> {
            let bytes = exchange[name].as_array().unwrap();
            bytes.iter().map(|b| b.as_u64().unwrap()).collect()
        };
        let (sent, reply) = (bytes("request"), bytes("reply"));
        let id = exchange["id"].as_u64().unwrap();
        let number = |b: &[u64]| b[0] | b[1] << 8 | b[2] << 16;
        wanted.push(format!("ID {id:X} "));
        if sent.len() > 1 {
            wanted.push(format!("ADF {:02X}", sent[1]));
        }
        wanted.push(format!("Reply {:02X}", reply[0]));
        let spoilt = exchange["cause"] == "reply_crc";
        match (id, spoilt) {
            (0, _) => wanted.push(format!("Single-turn {} ", number(&reply[2..]))),
            (1, _) => wanted.push(format!("Multi-turn {} ", number(&reply[2..]))),
            (2, _) => wanted.push(format!("ENID {:02X}", reply[2])),
            (3, false) => {
                wanted.push(format!("Single-turn {} ", number(&reply[2..])));
                wanted.push(format!("Multi-turn {} ", number(&reply[6..])));
            }
            (6 | 0xD, _) => wanted.push(format!("EDF {:02X}", reply[2])),
            _ => {}
        }
        let sum = reply.last().unwrap();
        wanted.push(match spoilt {
            true => format!("CRC {sum:02X}, should be"),
            false => format!("CRC {sum:02X}"),
        });
    }
    let mut rest = lines.iter();
    for text in &wanted {
        let found = rest.any(|line: &&str| line.contains(text.as_str()));
        assert!(found, "{text}: {told}");
    }
    assert_eq!(told.matches("CRC wrong").count(), 1, "{told}");
    for never in ["missing", "No re", "Delimiter", "another"] {
        assert!(!told.contains(never), "{never}: {told}");
    }
}

/// Catches a decoder that dies of a frame that the card gave up, or takes the next one for its end.
#[test]
fn sigrok_goes_on_after_frames_that_were_cut() {
    let Some((report, told)) = decoded("paper-flow", &endat(29)) else {
        return;
    };
    let frames = report[0]["channels"][0]["frames"].as_array().unwrap();
    let sent = frames[0]["encoder"]["position"].as_u64().unwrap();
    let positions = told.matches(&format!(": Position {sent} ")).count();
    // One had no start bit, one was given up at a wrong one; the others are whole, whatever is wrong with them.
    assert_eq!(positions, frames.len() - 2, "{told}");
    assert_eq!(told.matches(": Position ").count(), positions, "{told}");
    for once in [": No start bit", ": Frame too short", ": CRC wrong"] {
        assert_eq!(told.matches(once).count(), 1, "{once}: {told}");
    }
}

/// Catches a decoder that counts another edge, or turns bits round.
#[test]
fn sigrok_decodes_every_frame_to_the_encoders_position() {
    for (scenario, bits) in [
        ("paper", 29),
        ("real-1", 37),
        ("additional-data", 29),
        // DATA changes behind the falling edge there.
        ("sixteen-megahertz", 25),
    ] {
        // A short recovery time: the next frame begins less than the usual 6 us behind this one.
        let short = if scenario == "sixteen-megahertz" {
            ":idle_us=3"
        } else {
            ""
        };
        let Some((report, told)) = decoded(scenario, &(endat(bits) + short)) else {
            return;
        };
        let frames = report[0]["channels"][0]["frames"].as_array().unwrap();
        let sent: Vec<u64> = frames
            .iter()
            .filter_map(|f| f["encoder"]["position"].as_u64())
            .collect();
        let read: Vec<u64> = told
            .lines()
            .filter_map(|l| l.split_once("Position ")?.1.split(' ').next()?.parse().ok())
            .collect();
        assert!(!sent.is_empty());
        assert_eq!(read, sent, "{scenario}: {told}");
        assert!(told.contains("111000 send position with additional data") || scenario != "paper");
        assert!(!told.contains("wrong") && !told.contains("short"), "{told}");
        if scenario == "additional-data" {
            // The temperature, and the supplement that selected it.
            assert_eq!(told.matches("0C 0B8A").count(), 3, "{told}");
            assert!(told.contains("0x4C 0x0000"), "{told}");
        }
    }
}
