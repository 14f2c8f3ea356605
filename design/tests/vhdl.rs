//! VHDL only: reserved names, ports that are read, order of files for compilers.

use crate::zoo::check;
use rtl_design::elaborate::elaborate;
use rtl_design::kernel_engine;
use rtl_design::reg::Reg;
use rtl_design::vhdl::{package_name, print, print_files, Header};
use rust_hdl::prelude::*;

/// Reserved words of VHDL in every place, and names that differ only in case, which VHDL ignores.
#[derive(LogicBlock, Default)]
struct Words {
    pub clock: Signal<In, Clock>,
    pub signal: Signal<In, Bits<4>>,
    pub open: Signal<In, Bit>,
    pub range: Signal<Out, Bits<4>>,
    pub units: Signal<Out, Bit>,
    pub to_sl: Signal<Out, Bits<4>>,
    pub others__: Signal<Out, Bit>,
    variable: Signal<Local, Bits<4>>,
    process: Reg<Bits<4>>,
    body: Child,
}

/// Its outputs are read inside.
#[derive(LogicBlock, Default)]
struct Child {
    pub clock: Signal<In, Clock>,
    pub file: Signal<In, Bits<4>>,
    pub procedure: Signal<Out, Bits<4>>,
    pub label: Signal<Out, Bit>,
    alias: Reg<Bits<4>>,
}

impl Logic for Child {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, alias);
        self.alias.reset.next = false;
        self.procedure.next = self.file.val() + 1;
        self.alias.d.next = self.alias.q.val() ^ self.procedure.val();
        self.label.next = self.procedure.val() == self.alias.q.val();
    }
}

impl Logic for Words {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, process, body);
        self.process.reset.next = false;
        self.body.file.next = self.signal.val();
        self.variable.next = self.body.procedure.val() + 3;
        self.process.d.next = self.process.q.val();
        if self.open.val() {
            self.process.d.next = self.variable.val();
        }
        self.range.next = self.process.q.val();
        self.to_sl.next = self.range.val() + self.variable.val();
        self.units.next = self.body.label.val();
        self.others__.next = self.to_sl.val() == 3;
    }
}

fn words() -> Words {
    let mut block = Words::default();
    block.connect_all();
    block
}

#[test]
fn words_of_vhdl_and_read_outputs_agree() {
    let block = words();
    let design = elaborate(&block, "entity").unwrap();
    let text = print(&design, &Header::default());
    for line in [
        "entity entity_value is",
        "    signal range_value_sig ",
        "    range_value <= std_logic_vector(range_value_sig);",
        "        signal_value : in  std_logic_vector(3 downto 0);",
        "        file_value      : in  unsigned(3 downto 0);",
    ] {
        assert!(text.contains(line), "{line}");
    }
    let engine = kernel_engine!(block; clock; in signal, open; out range, units, to_sl, others__);
    check("words", &design, engine, 300);
}

/// The package is first, the top last; all of it is in the one file, too.
#[test]
fn files_stand_in_the_order_of_compilers() {
    let design = elaborate(&words(), "words").unwrap();
    let files = print_files(&design, &Header::default());
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["words_logic.vhd", "words_body.vhd", "words.vhd"]);
    assert_eq!(package_name(&design), "words_logic");
    let whole = print(&design, &Header::default());
    for (name, text) in &files {
        let at = text.find("library ieee;").unwrap();
        assert!(whole.contains(text[at..].trim_end()), "{name}");
    }
}
