//! The IP-XACT component, read back.

use super::written;
use crate::bus_card::text;
use crate::tools::{require, run};
use endat_config::parse;
use endat_emit::emit;
use endat_hdl::card::bus::HostBus;

/// Interfaces with the ports behind them, which the component must have; address block and files.
const SCRIPT: &str = "
import os, sys, xml.etree.ElementTree as xml
space = {'x': 'http://www.accellera.org/XMLSchema/IPXACT/1685-2014'}
component = xml.parse(sys.argv[1]).getroot()
every = lambda path, root=component: [e.text for e in root.findall(path, space)]
ports = every('x:model/x:ports/x:port/x:name')
for interface in component.findall('x:busInterfaces/x:busInterface', space):
    maps = 'x:abstractionTypes/x:abstractionType/x:portMaps/x:portMap/x:'
    assert set(every(maps + 'physicalPort/x:name', interface)) <= set(ports)
    kind = interface.find('x:busType', space).get('name')
    print(*every('x:name', interface), kind, *every(maps + 'logicalPort/x:name', interface))
    for reference in interface.findall('x:slave/x:memoryMapRef', space):
        assert reference.get('memoryMapRef') in every('x:memoryMaps/x:memoryMap/x:name')
block = component.find('x:memoryMaps/x:memoryMap/x:addressBlock', space)
names = every('x:vendor') + every('x:library') + every('x:name')
print('block', *every('x:baseAddress', block), *every('x:range', block), 'of', *names)
files = every('x:fileSets/x:fileSet/x:file/x:name')
assert all(os.path.exists(file) for file in files) and len(files) > 20, files
print('ports', len(ports))
";

/// Catches a port that is in no interface or in a wrong one, and an address that is not the configuration's.
#[test]
fn the_component_names_bus_clock_reset_and_interrupt() {
    if !require("python3", "IP-XACT component") {
        return;
    }
    let rows = [
        (
            HostBus::Apb,
            "s_apb APB PSEL PENABLE PWRITE PADDR PWDATA PRDATA PREADY PSLVERR",
        ),
        (
            HostBus::Wishbone,
            "wb wishbone CYC_I STB_I WE_I ADR_I DAT_I SEL_I DAT_O ACK_O ERR_O",
        ),
        (
            HostBus::AxiLite,
            "s_axi AXI4-Lite AWADDR AWVALID AWREADY WDATA WSTRB WVALID WREADY BRESP BVALID BREADY",
        ),
    ];
    for (bus, interface) in rows {
        let more = "base_address = 0x8000_4000\n[outputs]\nparts = [\"interrupt\"]\n";
        let project = parse("card.toml", &text(bus, more)).unwrap();
        let name = &project.name;
        let files = emit(&project).unwrap();
        let place = written(&files, &format!("ipxact-{name}"));
        let file = format!("{name}_ipxact.xml");
        let (is_good, told) = run("python3", &place, &["-c", SCRIPT, &file]);
        assert!(is_good, "{told}");
        let template = files
            .iter()
            .find(|f| f.path.ends_with("_instance.vh"))
            .unwrap();
        let ports = template.text.matches("    .").count();
        for wanted in [
            interface,
            "clk_i clock CLK",
            "rst_i reset RST",
            "irq_o interrupt INTERRUPT",
            &format!("block 0x80004000 8192 of endat-gen motion {name}"),
            &format!("ports {ports}"),
        ] {
            assert!(told.contains(wanted), "{wanted}: {told}");
        }
    }
}
