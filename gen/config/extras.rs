//! Extra files of an emission: the key `with`, and `emit --with`.

use super::keys::WITH;
use super::parts::read_words;
use super::reader::Table;
use crate::form::key::Choice;
use endat_console::error::{shown, CommandError};

/// Files that are emitted only where they are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extra {
    /// Its word.
    pub word: &'static str,
    /// Its meaning.
    pub means: &'static str,
    /// Ends of the names of its files, after that of the card.
    pub ends: &'static [&'static str],
}

/// The word for all of them.
pub const ALL: &str = "all";
/// The driver in C, whose files have names without that of the card.
pub const DRIVER: &str = "driver";
/// Every extra, in the order of the pages.
pub const EXTRAS: [Extra; 12] = [
    extra("svd", "registers as CMSIS-SVD", &[".svd"]),
    extra("rdl", "registers as SystemRDL", &[".rdl"]),
    extra("csr", "registers as a list of LiteX", &["_csr.csv"]),
    extra(
        "sv",
        "registers as a SystemVerilog package",
        &["_registers.sv"],
    ),
    extra(
        "vhdl-package",
        "registers and component as VHDL packages, for a VHDL design around a card in Verilog",
        &["_registers.vhd", "_component.vhd", "_instance.vho"],
    ),
    extra("ipxact", "IP-XACT", &["_ipxact.xml"]),
    extra(
        "vivado",
        "script that packages an IP for Vivado, with a Zynq system where the bus is AXI4-Lite",
        &["_vivado.tcl", "_ip.xdc", "_zynq.tcl"],
    ),
    extra(
        "platform-designer",
        "component for Platform Designer (Quartus)",
        &["_hw.tcl", "_axi4lite.v", "_axi4lite.vhd"],
    ),
    extra("litex", "LiteX module", &["_litex.py"]),
    extra("amaranth", "Amaranth component", &["_amaranth.py"]),
    extra("spinal", "SpinalHDL black box", &["_spinal.scala"]),
    extra(
        DRIVER,
        "driver in C, and an example for the UART",
        &["_example.c"],
    ),
];

const fn extra(word: &'static str, means: &'static str, ends: &'static [&'static str]) -> Extra {
    Extra { word, means, ends }
}

/// The words of the key.
pub(crate) fn choices() -> Vec<Choice> {
    let all = EXTRAS
        .iter()
        .map(|extra| Choice::new(extra.word, extra.means));
    all.chain([Choice::new(ALL, "everything that the card can have")])
        .collect()
}

/// Reads the key, and complains about unknown words.
pub(crate) fn read(table: &Table<'_, '_>) -> Vec<String> {
    let words = table.strings(&WITH).unwrap_or_default();
    let places = read_words(table, &WITH, words, "extra").unwrap_or_default();
    let mut names = WITH.words();
    let named = places
        .into_iter()
        .map(|place| std::mem::take(&mut names[place]));
    named.collect()
}

/// Words of `--with`, checked.
pub fn named(words: &[String]) -> Result<Vec<String>, CommandError> {
    let known = WITH.words();
    match words.iter().find(|word| !known.contains(word)) {
        None => Ok(words.to_vec()),
        Some(word) => Err(CommandError::input(format!(
            "--with = {}: unknown extra; use {}",
            shown(word),
            known.join(", ")
        ))),
    }
}
