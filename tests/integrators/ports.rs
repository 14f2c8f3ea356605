//! Ports: every file around a core names those of the module that is emitted, in both languages.

use super::{sources, written};
use crate::tools::{require, run};
use endat_config::{load_any_preset, parse, Configuration};
use endat_console::artifact::Artifact;
use endat_emit::language::Language;
use endat_emit::{emit_in, protocols};
use std::collections::BTreeSet;

/// The channel of a port without registers, for each protocol; `sequence` is one of its ports, and a word of SystemVerilog.
const BARE: [(&str, &str); 3] = [
    (
        "e_none",
        "position_bits = 25\ncommand = \"111000\"\nclock_hz = 2_000_000",
    ),
    (
        "s_none",
        "protocol = \"ssi\"\nposition_bits = 13\nclock_hz = 500_000",
    ),
    ("t_none", "protocol = \"t_format\"\nbit_hz = 2_500_000"),
];

fn bare(name: &str, channel: &str, language: Language) -> Vec<Artifact> {
    let text = format!(
        "name = \"{name}\"\n[clock]\nsystem_hz = 100_000_000\n[host]\nbus = \"none\"\n[trigger]\nsample_hz = 1_000\n[[channel]]\n{channel}\n"
    );
    emit_in(&parse("bare.toml", &text).unwrap(), language).unwrap()
}

fn of_preset(name: &str, language: Language) -> Vec<Artifact> {
    match load_any_preset(name).unwrap() {
        Configuration::Card(card) => emit_in(&card, language).unwrap(),
        Configuration::Receiver(receiver) => {
            protocols::t_format::emit_in(&receiver, language).unwrap()
        }
    }
}

/// The part of a text between two marks.
fn between<'t>(text: &'t str, from: &str, to: &str) -> &'t str {
    let (_, rest) = text
        .split_once(from)
        .unwrap_or_else(|| panic!("no {from}: {text}"));
    rest.split_once(to).map_or(rest, |(part, _)| part)
}

/// The first word of a line of VHDL that declares or connects a port.
fn of_vhdl<'l>(line: &'l str, mark: &str) -> Option<&'l str> {
    let (name, _) = line.split_once(mark)?;
    Some(name.trim().trim_matches('\\'))
}

/// The ports of the top module, from its own text.
fn declared(name: &str, text: &str, language: Language) -> BTreeSet<String> {
    let names: Vec<&str> = match language {
        Language::Verilog => {
            let lines = between(text, &format!("\nmodule {name} ("), "\n);").lines();
            let lines = lines.map(str::trim);
            let ports = lines.filter(|l| ["input ", "output "].iter().any(|d| l.starts_with(d)));
            ports
                .filter_map(|l| l.trim_end_matches(',').split(' ').next_back())
                .collect()
        }
        Language::Vhdl => {
            let lines = between(text, &format!("\nentity {name} is"), "end entity").lines();
            lines
                .filter(|l| !l.trim().starts_with("--"))
                .filter_map(|l| of_vhdl(l, " : "))
                .collect()
        }
    };
    names.into_iter().map(str::to_owned).collect()
}

/// A file around a core: the end of its name, and the port that a line of it names.
type Around = (&'static str, fn(&str) -> Option<&str>);

const AROUND: [Around; 7] = [
    ("_instance.vh", |line| {
        line.strip_prefix('.')?.split('(').next()
    }),
    ("_instance.vho", |line| of_vhdl(line, "=>")),
    ("_component.vhd", |line| match line.starts_with("--") {
        true => None,
        false => of_vhdl(line, " : "),
    }),
    ("_ipxact.xml", |line| {
        line.strip_prefix("<ipxact:name>")?
            .strip_suffix("</ipxact:name>")
    }),
    ("_litex.py", of_python),
    ("_amaranth.py", of_python),
    ("_spinal.scala", |line| {
        let (name, kind) = line.strip_prefix("val ")?.split_once(" = ")?;
        ["in ", "out "]
            .iter()
            .any(|d| kind.starts_with(d))
            .then_some(name)
    }),
];

fn of_python(line: &str) -> Option<&str> {
    let rest = ["i_", "o_"].iter().find_map(|d| line.strip_prefix(d))?;
    Some(rest.split_once('=')?.0)
}

/// Ports that a file of a core names and its module lacks, and the other way round.
fn wrong(name: &str, files: &[Artifact], language: Language) -> Vec<String> {
    let text = |end: &str| {
        let path = format!("{name}{end}");
        files
            .iter()
            .find(|f| f.path == path)
            .map(|f| f.text.as_str())
    };
    let ports = declared(name, text(language.extension()).unwrap(), language);
    assert!(ports.len() > 8, "{name}: {ports:?}");
    let named = |(end, port): Around| {
        let whole = text(end).filter(|_| language == Language::Verilog || end != "_instance.vh")?;
        let part = match end {
            "_ipxact.xml" => between(whole, "<ipxact:ports>", "</ipxact:ports>"),
            _ => whole,
        };
        let names = part.lines().map(str::trim).filter_map(port);
        let names: BTreeSet<String> = names.map(str::to_owned).collect();
        let other: Vec<_> = names.symmetric_difference(&ports).collect();
        (!other.is_empty()).then(|| format!("{name}{end}, {language:?}: {other:?}"))
    };
    AROUND.into_iter().filter_map(named).collect()
}

#[test]
fn every_file_around_a_core_names_the_ports_of_its_module() {
    let mut said = vec![];
    for language in [Language::Verilog, Language::Vhdl] {
        for (name, channel) in BARE {
            said.extend(wrong(name, &bare(name, channel, language), language));
        }
    }
    for name in ["async_dsp", "clb_2mhz"] {
        let language = Language::Verilog;
        said.extend(wrong(name, &of_preset(name, language), language));
    }
    assert!(said.is_empty(), "{}", said.join("\n"));
}

#[test]
#[ignore = "slow: ports of every preset in both languages"]
fn every_file_around_every_preset_names_the_ports_of_its_module() {
    use endat_config::{PRESETS, RECEIVER_PRESETS};
    let mut said = vec![];
    for (name, _) in PRESETS.iter().chain(RECEIVER_PRESETS) {
        for language in [Language::Verilog, Language::Vhdl] {
            said.extend(wrong(name, &of_preset(name, language), language));
        }
    }
    assert!(said.is_empty(), "{}", said.join("\n"));
}

#[test]
fn the_instantiation_template_of_a_port_without_registers_compiles() {
    if !require("iverilog", "instantiation template of a bare port") {
        return;
    }
    for (name, channel) in BARE {
        let folder = written(
            &bare(name, channel, Language::Verilog),
            &format!("bare-{name}"),
        );
        let template = std::fs::read_to_string(folder.join(format!("{name}_instance.vh"))).unwrap();
        let holder = format!("module holder;\n{template}\nendmodule\n");
        std::fs::write(folder.join("holder.v"), holder).unwrap();
        let mut arguments = vec!["-g2005", "-tnull", "-s", "holder", "holder.v"];
        let sources = sources(&folder);
        arguments.extend(sources.iter().map(String::as_str));
        let (is_good, said) = run("iverilog", &folder, &arguments);
        assert!(is_good, "{name}: {said}");
    }
}
