//! Names that mean something to one of the tools: every emitted file stands them.

use super::written;
use crate::tools::{folder, require_python, run};
use endat_config::{load_preset, parse, preset};

/// Words of Python, YAML, SystemRDL, Tcl and LiteX that are no reserved words of Verilog, VHDL or C.
const NAMES: [&str; 12] = [
    "none",
    "yes",
    "off",
    "clock_signal",
    "reset_signal",
    "instance_x",
    "SOURCES",
    "migen",
    "os",
    "self",
    "addrmap",
    "endat_card",
];

/// In each folder: imports the modules and makes the instances; reads the FuseSoC core and the register map.
const SCRIPT: &str = "
import importlib, os, sys, yaml
from amaranth.back import rtlil
from migen.fhdl.verilog import convert
from systemrdl import RDLCompiler
for argument in sys.argv[1:]:
    folder, name, title = argument.split(':')
    sys.path[0] = folder
    os.chdir(folder)
    module = importlib.import_module(name + '_litex')
    core = getattr(module, title)()
    text = str(convert(core, {core.trigger_i}, name='soc'))
    assert name + ' ' in text, text
    component = importlib.import_module(name + '_amaranth')
    assert name in rtlil.convert(getattr(component, title)()), name
    described = yaml.safe_load(open(name + '.core').read().split('\\n', 1)[1])
    assert described['targets']['default']['toplevel'] == name, described
    compiler = RDLCompiler()
    compiler.compile_file(name + '.rdl')
    assert compiler.elaborate().top.inst_name == name, name
    print('good', name)
";

#[test]
fn names_that_are_words_elsewhere_are_names_here() {
    let check = "names of cards";
    let has_all = ["amaranth", "migen", "yaml", "systemrdl"]
        .iter()
        .all(|m| require_python(m, check));
    if !has_all {
        return;
    }
    assert!(load_preset("s6_two_channel").is_ok());
    let mut places = vec![];
    for name in NAMES {
        let text = preset("s6_two_channel")
            .unwrap()
            .replace("\"s6_two_channel\"", &format!("{name:?}"));
        let files = endat_emit::emit(&parse("card.toml", &text).unwrap()).unwrap();
        let place = written(&files, &format!("name-{name}"));
        let module = files
            .iter()
            .find(|f| f.path.ends_with("_litex.py"))
            .unwrap();
        let class = module
            .text
            .lines()
            .find_map(|l| l.strip_prefix("class "))
            .unwrap();
        let class = class.split('(').next().unwrap();
        places.push(format!("{}:{name}:{class}", place.display()));
    }
    // One process: its imports take longer than all that it does with a name.
    let mut arguments = vec!["-c", SCRIPT];
    arguments.extend(places.iter().map(String::as_str));
    let (is_good, told) = run("python3", &folder("names"), &arguments);
    assert!(is_good, "{told}");
    for name in NAMES {
        assert!(
            told.lines().any(|line| line == format!("good {name}")),
            "{name}: {told}"
        );
    }
}
