//! Every configuration of the list, in every language and simulator: lint, the emitted bench, and cocotb at the card's own bus.

use super::benches::has_tools;
use super::configurations::{emission, texts, Emission};
use super::on_both_cores;
use crate::tools::{self, run};
use crate::verilog::write;
use endat_config::{Configuration, PRESETS, RECEIVER_PRESETS};
use endat_tools::readers::{is_bench, is_core, Reader, LINTERS};
use std::collections::BTreeMap;
use std::path::Path;

const PYTHON: &str = "cocotb at every emission";

/// Every protocol and several buses.
const QUICK: [&str; 5] = ["demo", "async_dsp", "wishbone", "ssi", "both_protocols"];

/// The emissions whose names are wanted.
fn wanted(is_wanted: impl Fn(&str) -> bool) -> Vec<(String, String)> {
    let texts = texts().into_iter();
    texts.filter(|(name, _)| is_wanted(name)).collect()
}

/// The emissions, written; `of` gives what is wrong with one.
fn check(
    test: &str,
    texts: &[(String, String)],
    of: impl Fn(&Emission, &Path) -> Vec<String> + Sync,
) {
    let said = on_both_cores(texts, |_, (name, text)| {
        let emission = emission(name, text);
        let (folder, _) = write(&format!("{test}-{name}"), &emission.files);
        let wrong = of(&emission, &folder);
        let _ = std::fs::remove_dir_all(folder);
        let wrong = wrong.into_iter().map(|text| format!("{name}: {text}"));
        let wrong: Vec<String> = wrong.collect();
        (!wrong.is_empty()).then(|| wrong.join("\n"))
    });
    assert!(said.is_empty(), "{}", said.join("\n"));
}

/// Names of the top module's ports of one direction.
fn ports<'e>(emission: &'e Emission, direction: &str) -> Vec<&'e str> {
    let file = format!("{}.v", emission.top());
    let top = emission.files.iter().find(|f| f.path == file).unwrap();
    let lines = top.text.lines().map(str::trim);
    let lines = lines.filter(|line| line.starts_with(&format!("{direction} ")));
    let names = lines.filter_map(|line| line.trim_end_matches(',').split(' ').next_back());
    names.collect()
}

/// Runs the cocotb test at the card's own bus.
fn cocotb(emission: &Emission, folder: &Path, language: &str) -> Option<String> {
    let (hash, mut settings) = match &emission.configuration {
        Configuration::Card(project) => {
            let card = &project.card;
            let settings = [
                format!("BUS={}", project.bus.name()),
                format!("SYSTEM_HZ={}", card.system_hz),
                format!("CHANNELS={}", card.channels.len()),
                format!("UART_BIT_CYCLES={}", card.uart_bit_cycles),
                format!("PUSHES={}", u8::from(card.stream.start.pushes())),
            ];
            (&project.hash, settings.to_vec())
        }
        Configuration::Receiver(receiver) => (&receiver.hash, vec!["BUS=dsp".to_owned()]),
    };
    settings.extend(["input", "output"].map(|direction| {
        let names = ports(emission, direction).join(",");
        format!("{}S={names}", direction.to_uppercase())
    }));
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cocotb/run.py");
    let script = script.to_str().unwrap();
    let mut arguments = vec![script, "emission", emission.top(), hash, language];
    arguments.extend(settings.iter().map(String::as_str));
    let (is_good, text) = run("python3", folder, &arguments);
    (!is_good).then(|| format!("cocotb, {language}: {text}"))
}

fn has_cocotb() -> bool {
    [
        "cocotb_tools.runner",
        "cocotbext.apb",
        "cocotbext.axi",
        "cocotbext.wishbone",
    ]
    .iter()
    .all(|module| tools::require_python(module, PYTHON))
}

/// Catches a module that two cores of one design have with different contents: a tool takes one of them for both. Needs no outside tool.
#[test]
fn modules_of_one_name_in_several_emissions_are_the_same() {
    let mut modules: BTreeMap<String, String> = BTreeMap::new();
    for (name, text) in wanted(|name| QUICK.contains(&name)) {
        let files = emission(&name, &text).files;
        for file in files.iter().filter(|f| is_core(f)) {
            let module = |line: &str| line.strip_prefix("module ").map(str::to_owned);
            let module = file.text.lines().find_map(module).expect(&file.path);
            let before = modules.entry(module.clone()).or_insert(file.text.clone());
            assert!(
                *before == file.text,
                "{module}: another text in {}",
                file.path
            );
        }
    }
    assert!(modules.len() > 40, "{}", modules.len());
}

/// Catches a word of one language that another one reserves, a width that only one reader minds, and a bench that does not fit its card.
#[test]
fn some_emissions_are_clean_in_every_language() {
    if has_tools() {
        let texts = wanted(|name| QUICK.contains(&name));
        assert_eq!(texts.len(), QUICK.len());
        check("lint", &texts, lints);
    }
}

#[test]
#[ignore = "slow: every emission"]
fn every_emission_is_clean_in_every_language() {
    if has_tools() {
        check("lint-all", &texts(), lints);
    }
}

fn lints(emission: &Emission, folder: &Path) -> Vec<String> {
    let lint = |reader: Reader| {
        let said = reader.lint(folder, emission.top(), &emission.files);
        Some(format!("{reader}: {}", said.unwrap()?))
    };
    LINTERS.into_iter().filter_map(lint).collect()
}

/// What iverilog says against the files of a card with the properties in them.
fn formal(emission: &Emission, folder: &Path) -> Vec<String> {
    let core = emission.files.iter().filter(|f| is_core(f));
    let core: Vec<&str> = core.map(|f| f.path.as_str()).collect();
    let compiled = |defines: &[&str]| {
        let head = ["-g2012", "-tnull", "-s", emission.top()];
        let arguments = [&head[..], defines, &core].concat();
        let (is_good, text) = run("iverilog", folder, &arguments);
        (!is_good).then(|| format!("{defines:?}: {text}"))
    };
    let both = [&["-DFORMAL"][..], &["-DFORMAL", "-DFORMAL_ANY_STATE"]];
    both.into_iter().filter_map(compiled).collect()
}

/// Catches a name in the properties that is a word of SystemVerilog, which a reader takes the file for because of its assertions.
#[test]
fn some_emissions_compile_with_their_properties() {
    if has_tools() {
        let texts = wanted(|name| QUICK.contains(&name));
        check("formal", &texts, formal);
    }
}

#[test]
#[ignore = "slow: properties of every emission"]
fn every_emission_compiles_with_its_properties() {
    if has_tools() {
        check("formal-all", &texts(), formal);
    }
}

/// Catches an output without a start value, and a front that only masters of this project can read.
#[test]
fn cocotb_reads_the_identification_of_some_emissions() {
    if has_tools() && has_cocotb() {
        let texts = wanted(|name| ["wishbone", "bare", "fast_receiver"].contains(&name));
        check("cocotb", &texts, |emission, folder| {
            cocotb(emission, folder, "-g2012").into_iter().collect()
        });
    }
}

#[test]
#[ignore = "slow: cocotb at every emission"]
fn cocotb_reads_the_identification_of_every_emission() {
    if has_tools() && has_cocotb() {
        check("cocotb-all", &texts(), |emission, folder| {
            cocotb(emission, folder, "-g2005").into_iter().collect()
        });
    }
}

/// Emissions with long benches, which Verilator runs several times as fast as Icarus Verilog.
const LONG: [&str; 8] = [
    "s6_two_channel",
    "s6_two_channel_service",
    "ti_three_channel",
    "artinchip_endat_if",
    "mixed_protocols",
    "widest",
    "initialise",
    "eight_channels",
];

/// The bench of every emission with one reader: long ones with Verilator, the others with a language of Icarus Verilog in turn. Not each with
/// each: the readers differ in the language that they take the bench for, and all benches have one text. Every reader lints every emission.
fn runs(texts: &[(String, String)], plusargs: &[&str]) {
    if !has_tools() {
        return;
    }
    let said = on_both_cores(texts, |index, (name, text)| {
        let emission = emission(name, text);
        // A port without a bus has no bench.
        if !emission.files.iter().any(is_bench) {
            return None;
        }
        let reader = match LONG.contains(&name.as_str()) {
            true => Reader::Verilator,
            false => LINTERS[index % 2],
        };
        let (folder, _) = write(&format!("product-{name}"), &emission.files);
        let (passes, text) = reader.play(&folder, &emission.files, plusargs).unwrap();
        let _ = std::fs::remove_dir_all(folder);
        (!passes).then(|| format!("{name}: {reader}: {text}"))
    });
    assert!(said.is_empty(), "{}", said.join("\n"));
}

#[test]
#[ignore = "slow: benches of emissions that Verilator runs"]
fn every_long_bench_runs_with_verilator() {
    let texts = wanted(|name| LONG.contains(&name));
    assert_eq!(texts.len(), LONG.len());
    runs(&texts, &[]);
}

#[test]
#[ignore = "slow: benches of presets, in both languages in turn"]
fn every_preset_runs_in_a_language() {
    runs(&presets(true), &[]);
}

#[test]
#[ignore = "slow: benches of every bus, in both languages in turn"]
fn every_bus_runs_in_a_language() {
    let [buses, parts] = others();
    assert!(buses.len() > 8 && parts.len() > 8);
    // What takes long has nothing to do with the bus.
    runs(&buses, &["+quick"]);
}

#[test]
#[ignore = "slow: benches of every part and protocol, in both languages in turn"]
fn every_part_runs_in_a_language() {
    runs(&others()[1], &[]);
}

/// The emissions that are no presets: buses first, then parts and protocols.
fn others() -> [Vec<(String, String)>; 2] {
    let mut buses = presets(false);
    let first = buses.iter().position(|(name, _)| name == "requests");
    let parts = buses.split_off(first.unwrap());
    [buses, parts]
}

/// The emissions without long benches: presets or others.
fn presets(is_preset: bool) -> Vec<(String, String)> {
    let presets = PRESETS.iter().chain(RECEIVER_PRESETS);
    wanted(|name| presets.clone().any(|p| p.0 == name) == is_preset && !LONG.contains(&name))
}
