//! The emitted text under the tools that read it: not one warning.

#[path = "../../design/tests/clean.rs"]
mod clean;

use super::core::random_program;
use clean::{elaborated, simulators_are_content, write, yosys_is_content};
use endat_config::load_preset;
use endat_console::artifact::Artifact;
use endat_hdl::card::bus::{
    ahb_lite::AhbLiteCard, apb::ApbCard, axi_lite::AxiLiteCard, parallel::ParallelCard,
    spi::SpiCard, wishbone::WishboneCard,
};
use endat_hdl::card::Card;
use endat_hdl::config::OutputParts;
use endat_hdl::endat::channel::{Channel, FixedTimes};
use endat_hdl::endat::sequencer::Sequencer;
use endat_hdl::protocols::t_format::dsp::{AsyncDsp, TFormatStart};
use endat_tools::area;
use rtl_design::elaborate::{elaborate, Design};
use rust_hdl::prelude::Block;
use std::fs;
use std::sync::LazyLock;

/// The blocks that have memories, both protocols and a card with outputs.
const QUICK: [&str; 4] = ["sequencer", "channel", "async_dsp", "apb_card"];

fn designs() -> Vec<Design> {
    elaborated(blocks())
}

fn quick() -> &'static [Design] {
    static QUICK_DESIGNS: LazyLock<Vec<Design>> = LazyLock::new(|| {
        let blocks = blocks().into_iter();
        elaborated(blocks.filter(|(_, name)| QUICK.contains(name)).collect())
    });
    assert_eq!(QUICK_DESIGNS.len(), QUICK.len());
    &QUICK_DESIGNS
}

fn blocks() -> Vec<(Box<dyn Block>, &'static str)> {
    let card = load_preset("s6_two_channel").unwrap().card;
    let mut with_outputs = card.clone();
    with_outputs.outputs = OutputParts {
        position: true,
        interrupt: true,
    };
    vec![
        (
            Box::new(Sequencer::new(&random_program(4), false)),
            "sequencer",
        ),
        (
            Box::new(Channel::new(FixedTimes::at(100_000_000))),
            "channel",
        ),
        (
            Box::new(AsyncDsp::new(&TFormatStart::default(), true)),
            "async_dsp",
        ),
        (Box::new(Card::new(&card)), "card"),
        (Box::new(ApbCard::new(&with_outputs)), "apb_card"),
        (Box::new(WishboneCard::new(&card)), "wishbone_card"),
        (Box::new(AxiLiteCard::new(&card)), "axi_lite_card"),
        (Box::new(AhbLiteCard::new(&card)), "ahb_lite_card"),
        (Box::new(SpiCard::new(&card)), "spi_card"),
        (Box::new(ParallelCard::new(&card)), "parallel_card"),
    ]
}

#[test]
fn verilator_and_iverilog_have_nothing_to_say() {
    quick().iter().for_each(simulators_are_content);
}

#[test]
fn yosys_finds_neither_problems_nor_latches() {
    quick().iter().for_each(yosys_is_content);
}

#[test]
#[ignore = "slow: cards with every bus"]
fn tools_have_nothing_to_say_about_cards_with_every_bus() {
    let designs = designs();
    designs.iter().for_each(simulators_are_content);
    designs.iter().for_each(yosys_is_content);
}

/// A family, the most LUTs, and the number of cells of a block RAM.
type Room = (area::Family, u64, &'static str, u64);
const ROOMS: [Room; 3] = [
    (area::ECP5, 400, "DP16KD", 5),
    (area::XC6S, 200, "RAMB", 7),
    (area::ICE40, 400, "SB_RAM40_4K", 12),
];

#[test]
fn a_sequencer_is_small_and_has_its_memories_in_block_ram() {
    sequencer_fits(&ROOMS[..1]);
}

#[test]
#[ignore = "slow: other families"]
fn a_sequencer_is_small_and_has_its_memories_in_block_ram_of_other_families() {
    sequencer_fits(&ROOMS[1..]);
}

/// The area of the machine, with a program that uses every instruction.
fn sequencer_fits(rooms: &[Room]) {
    if !crate::verilog::area::require("area of the sequencer") {
        return;
    }
    let mut block = Sequencer::new(&random_program(4), false);
    block.connect_all();
    let test = format!("sequencer-area-{}", rooms[0].0.name);
    let (folder, files) = write(&elaborate(&block, "sequencer").unwrap(), &test);
    let files: Vec<_> = files
        .into_iter()
        .map(|name| Artifact::new(name.clone(), fs::read_to_string(folder.join(name)).unwrap()))
        .collect();
    for (family, most_luts, ram, count) in rooms {
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
