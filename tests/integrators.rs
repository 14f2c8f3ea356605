//! What integrators take: each file, used by the program that it is for.

mod designers;
mod fusesoc;
mod ipxact;
mod litex;
mod names;
mod ports;
mod zynq;

use crate::tools::{self, require, require_all, require_python, run};
use endat_config::{load_any_preset, Configuration, Project};
use endat_console::artifact::Artifact;
use endat_emit::emit;
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
            endat_emit::protocols::t_format::emit(&receiver).unwrap()
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
        let project = endat_config::parse("card.toml", &text).unwrap();
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
    use endat_card::Door;
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
