//! Every port of every block of the emitted Verilog, in every cycle of its bench, against the design. This is what `endat-workshop mutants` counts as `ports`.

use crate::tools;
use endat_workshop::mutants::recorder::{self, Watched};
use endat_workshop::mutants::{alone, record, subjects, sums_alone, Emission, Recording};
use rtl_design::elaborate::Design;
use rtl_design::engine::{Compiled, Engine, Keep, PortId};
use std::collections::HashMap;

/// Cycles of a block of the shipped card alone, and of a block of each subject. The campaign gives each a million.
const QUICK_CYCLES: usize = 24_000;
const ALL_CYCLES: usize = 100_000;

/// A design that is given one row after the other, and the ports of each module that are watched.
struct Watch {
    engine: Compiled,
    inputs: Vec<PortId>,
    watched: Vec<Vec<(usize, usize)>>,
    sums: Vec<u64>,
}

impl Watch {
    fn new(design: &Design) -> Self {
        let engine = Compiled::keeping(design, Keep::Nets).unwrap();
        let nets: HashMap<&str, usize> = engine.nets().zip(0..).collect();
        let ports = |ports: &Vec<Watched>| {
            let port = |p: &Watched| (nets[p.net.as_str()], p.width_bits);
            ports.iter().map(port).collect()
        };
        let watched: Vec<_> = recorder::watched(design).iter().map(ports).collect();
        let inputs = alone::inputs(design.top());
        let inputs = inputs.iter().map(|i| engine.port(&i.name)).collect();
        Self {
            inputs,
            sums: vec![recorder::START; watched.len()],
            watched,
            engine,
        }
    }

    fn row(&mut self, row: impl IntoIterator<Item = u128>) {
        for (port, value) in self.inputs.iter().zip(row) {
            self.engine.set(*port, value);
        }
        self.engine.fall();
        for (sum, ports) in self.sums.iter_mut().zip(&self.watched) {
            for (net, width_bits) in ports {
                let value = self.engine.peek(*net).expect("every net is kept");
                *sum = recorder::step(*sum, value, *width_bits);
            }
        }
        self.engine.tick();
    }
}

/// The sums of the design over the inputs of the bench, a line for each cycle.
fn sums(design: &Design, inputs: &str) -> Vec<u64> {
    let mut watch = Watch::new(design);
    let widths = alone::inputs(design.top());
    for line in inputs.lines() {
        let mut to = line.len();
        watch.row(widths.iter().map(|input| {
            to -= input.width_bits;
            u128::from_str_radix(&line[to..to + input.width_bits], 2).unwrap()
        }));
    }
    watch.sums
}

/// The modules whose ports differ.
fn differing(emission: &Emission, recording: &Recording) -> Vec<String> {
    let design = &emission.subject.design;
    let sums = sums(design, &recording.inputs);
    assert_eq!(sums.len(), recording.sums.len());
    let both = sums.iter().zip(&recording.sums).zip(&design.modules);
    let differing = both.filter(|((one, other), _)| one != other);
    differing.map(|(_, module)| module.name.clone()).collect()
}

fn ports_agree(preset: &str) {
    if !tools::require("verilator", &format!("ports of {preset}")) {
        return;
    }
    let emission = Emission::named(preset).unwrap();
    let recording = record(&emission).unwrap();
    assert!(recording.inputs.lines().count() > 100_000);
    assert!(differing(&emission, &recording).is_empty());
}

/// Catches an operator that Verilog takes for another one than the design, anywhere in the shipped card, whether or not it reaches a pin.
#[test]
#[ignore = "slow: every port of the shipped card"]
fn every_port_of_the_shipped_card_does_what_the_design_does() {
    ports_agree("s6_two_channel");
}

/// Catches the same in what a bench never comes to.
#[test]
fn every_block_of_a_small_card_alone_does_with_random_inputs_what_the_design_does() {
    if tools::require("verilator", "blocks of a receiver alone") {
        blocks_agree("async_dsp", 4_000);
    }
}

#[test]
#[ignore = "slow: blocks of the shipped card alone"]
fn every_block_of_a_card_alone_does_with_random_inputs_what_the_design_does() {
    if tools::require("verilator", "blocks of the shipped card alone") {
        blocks_agree("s6_two_channel", QUICK_CYCLES);
    }
}

fn blocks_agree(preset: &str, cycles: usize) {
    let subject = Emission::named(preset).unwrap().subject;
    let found = sums_alone(&subject, cycles).unwrap();
    for (index, module) in subject.design.modules.iter().enumerate() {
        let mut watch = Watch::new(&alone::part(&subject.design, index));
        let rows = alone::rows(&subject.design, index).take(cycles);
        rows.for_each(|row| watch.row(row));
        assert_eq!(watch.sums[0], found[index], "{}", module.name);
    }
}

/// One block that is another one is named, with those that hold it.
#[test]
#[ignore = "slow: a recording of every port of a receiver"]
fn every_port_of_a_receiver_does_what_the_design_does_and_another_block_is_named() {
    let preset = "async_dsp";
    if !tools::require("verilator", "ports of a receiver") {
        return;
    }
    let emission = Emission::named(preset).unwrap();
    every_port_agrees_and_another_is_named(emission);
}

fn every_port_agrees_and_another_is_named(mut emission: Emission) {
    let recording = record(&emission).unwrap();
    assert_eq!(differing(&emission, &recording), Vec::<String>::new());
    // The data of a write, which nobody takes before its end, follow the pins while something is read, too.
    let mut files = emission.subject.files.iter_mut();
    let file = files.find(|f| f.path == "async_dsp_bus_strobes.v").unwrap();
    let broken = file
        .text
        .replace("if (!cs_n & !wr_n) begin", "if (!cs_n) begin");
    assert_ne!(file.text, broken);
    file.text = broken;
    let named = differing(&emission, &record(&emission).unwrap());
    assert_eq!(named, ["async_dsp", "async_dsp_bus_strobes"]);
}

/// Those whose benches set no register inside the card.
#[test]
#[ignore = "slow: every port of every subject"]
fn every_port_of_every_subject_does_what_the_design_does() {
    for preset in subjects() {
        blocks_agree(preset, ALL_CYCLES);
        let bench = Emission::named(preset).unwrap().bench.text;
        let sets = ["\n        end_quiet_time;", "turn_forward("];
        if !sets.iter().any(|task| bench.contains(task)) {
            ports_agree(preset);
        }
    }
}
