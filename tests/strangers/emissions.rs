//! Every configuration of the list, in every language and simulator: lint, the emitted bench, and cocotb at the card's own bus.

use super::benches::{has_tools, on_both_cores};
use super::configurations::{emission, texts, Emission};
use crate::passed::Check;
use crate::tools::{self, run};
use crate::verilog::write;
use endat_gen::config::Configuration;
use endat_gen::readers::{is_bench, Reader, LINTERS};
use std::path::Path;

const PYTHON: &str = "cocotb at every emission";

/// The emissions, written; `of` gives what is wrong with one.
fn check(
    test: &str,
    texts: &[(String, String)],
    of: impl Fn(&Emission, &Path) -> Vec<String> + Sync,
) {
    let said = on_both_cores(texts, |_, (name, text)| {
        let emission = emission(name, text);
        let check = Check::new(format!("{test} of emission {name}")).files(&emission.files);
        let check = check
            .text(text)
            .source("gen/readers.rs")
            .source("tests/cocotb");
        check
            .source("tests/strangers/emissions.rs")
            .complaint_unless_passed(|| {
                let (folder, _) = write(&format!("{test}-{name}"), &emission.files);
                let wrong = of(&emission, &folder);
                let _ = std::fs::remove_dir_all(folder);
                let wrong = wrong.into_iter().map(|text| format!("{name}: {text}"));
                let wrong: Vec<String> = wrong.collect();
                (!wrong.is_empty()).then(|| wrong.join("\n"))
            })
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

/// Catches a word of one language that another one reserves, a width that only one reader minds, and a bench that does not fit its card.
#[test]
fn every_emission_is_clean_in_every_language() {
    if has_tools() {
        check("lint", &texts(), |emission, folder| {
            let lint = |reader: Reader| {
                let said = reader.lint(folder, emission.top(), &emission.files);
                Some(format!("{reader}: {}", said.unwrap()?))
            };
            LINTERS.into_iter().filter_map(lint).collect()
        });
    }
}

/// Catches an output without a start value, and a front that only masters of this project can read.
#[test]
fn cocotb_reads_the_identification_of_every_emission() {
    if has_tools() && has_cocotb() {
        let script = include_str!("../cocotb/run.py");
        let texts: Vec<_> = tools::third(&texts(), script.len()).cloned().collect();
        check("cocotb", &texts, |emission, folder| {
            cocotb(emission, folder, "-g2005").into_iter().collect()
        });
    }
}

/// The full product: every emission in every simulator and language; `cargo test every_emission_runs -- --ignored --nocapture` tells each that
/// has ended. Where it was stopped, `FIRST_CASE` goes on.
#[test]
#[ignore = "every emission in every simulator and language: simulations and builds of an hour and a half"]
fn every_emission_runs_in_every_language() {
    if !has_tools() || !has_cocotb() {
        return;
    }
    let texts = texts();
    let readers = LINTERS.map(Some).into_iter().chain([None]);
    let cases = texts
        .iter()
        .flat_map(|card| readers.clone().map(move |reader| (card, reader)));
    let cases: Vec<_> = cases.enumerate().collect();
    let first = std::env::var("FIRST_CASE").map_or(0, |n| n.parse().unwrap());
    let said = on_both_cores(&cases[first..], |_, (case, ((name, text), reader))| {
        let emission = emission(name, text);
        let (folder, _) = write(&format!("product-{case}"), &emission.files);
        let wrong = match reader {
            // A port without a bus has no bench.
            Some(_) if !emission.files.iter().any(is_bench) => None,
            Some(reader) => {
                let (passes, text) = reader.play(&folder, &emission.files).unwrap();
                (!passes).then(|| format!("{reader}: {text}"))
            }
            None => cocotb(&emission, &folder, "-g2012"),
        };
        let _ = std::fs::remove_dir_all(folder);
        let what = reader.map_or("cocotb".into(), |reader| reader.to_string());
        let became = wrong.as_deref().unwrap_or("passes");
        eprintln!("case {case} of {}: {name}, {what}: {became}", cases.len());
        wrong.map(|text| format!("{name}: {text}"))
    });
    assert!(said.is_empty(), "{}", said.join("\n"));
}
