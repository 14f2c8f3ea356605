//! What makes a bitstream of a family's devices: open tools, or the vendor's.

use super::keys;
use crate::form::key::Key;
use crate::form::reader::Table;

/// How open tools make a bitstream. Arguments are templates that know `name`, `constraints`, `device` and `board`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Build {
    /// The yosys command; the top module is added.
    pub synthesis: String,
    /// nextpnr and its arguments; netlist, frequency, seed and report are added.
    pub place: Vec<String>,
    /// What makes the bitstream of its result.
    pub pack: Vec<String>,
    /// Name of the bitstream.
    pub bitstream: String,
    /// Command that installs the tools.
    pub install: String,
    /// Attributes, `name=value`, that make nextpnr put a register into the output cell; none if it cannot.
    pub output_registers: Vec<String>,
    /// How its result is read back, if it can be.
    pub read_back: Option<ReadBack>,
}

/// How what open tools have made of a card becomes Verilog again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadBack {
    /// The bitstream, with IceStorm.
    Icestorm,
    /// The placed and routed netlist that nextpnr writes (`--write {{ name }}_placed.json`), with models of this device's cells.
    Netlist(Placed),
}

/// Devices whose cells have models.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placed {
    /// Lattice ECP5.
    Ecp5,
    /// Gowin GW1N.
    Gowin,
}

impl ReadBack {
    /// Each with its name in a family's file.
    const NAMES: [(Self, &'static str); 3] = [
        (Self::Icestorm, "icestorm"),
        (Self::Netlist(Placed::Ecp5), "ecp5_netlist"),
        (Self::Netlist(Placed::Gowin), "gowin_netlist"),
    ];
}

/// How the vendor's tool makes a bitstream. Words are templates as those of [`Build`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Vendor {
    /// Name for people.
    pub tool: String,
    /// The tool's shell and its arguments; it runs the script in the folder of the sources.
    pub run: Vec<String>,
    /// Name of the bitstream.
    pub bitstream: String,
}

/// Shells of vendors' tools: a family's file names one of them, and no other program.
const SHELLS: [&str; 6] = [
    "vivado",
    "xtclsh",
    "quartus_sh",
    "diamondc",
    "radiantc",
    "gw_sh",
];

/// A file from elsewhere may name the tools of this trade, and no other program.
fn command(
    table: &Table<'_, '_>,
    key: &'static Key,
    is_tool: &dyn Fn(&str) -> bool,
) -> Option<Vec<String>> {
    let words = table.strings(key);
    table.require(key)?;
    let example = key.example();
    let words = words?;
    let tool = words.first();
    let plain = |tool: &str| {
        tool.bytes()
            .all(|b| b.is_ascii_alphanumeric() || b"-_".contains(&b))
    };
    if !tool.is_some_and(|tool| plain(&tool.value) && is_tool(&tool.value)) {
        let line = tool.map_or(table.line, |at| at.line);
        let value = tool.map_or(String::new(), |at| format!("{:?}", at.value));
        let text = format!("does not begin with a tool for it; write, for example, {example}");
        table.complain(line, key.name, &value, &text);
        return None;
    }
    Some(words.into_iter().map(|at| at.value).collect())
}

/// What may be left out; none if it is there and wrong.
pub(super) fn left_out_or_good<T>(table: Option<Option<T>>) -> Option<Option<T>> {
    match table {
        None => Some(None),
        Some(table) => table.map(Some),
    }
}

pub(super) fn read_vendor(table: &Table<'_, '_>) -> Option<Vendor> {
    let tool = table.required_string(&keys::VENDOR_TOOL);
    let bitstream = table.required_string(&keys::VENDOR_BITSTREAM);
    let run = command(table, &keys::RUN, &|tool| SHELLS.contains(&tool));
    table.finish();
    Some(Vendor {
        tool: tool?.value,
        run: run?,
        bitstream: bitstream?.value,
    })
}

pub(super) fn read_build(table: &Table<'_, '_>) -> Option<Build> {
    let synthesis = table.required_string(&keys::SYNTHESIS);
    let bitstream = table.required_string(&keys::BITSTREAM);
    let install = table.required_string(&keys::INSTALL);
    let place = command(table, &keys::PLACE, &|tool| tool.starts_with("nextpnr-"));
    let pack = command(table, &keys::PACK, &|tool| tool.ends_with("pack"));
    let output_registers = table.strings(&keys::OUTPUT_REGISTERS).unwrap_or_default();
    let word = |text: &str| {
        let is_plain = |b: u8| b.is_ascii_alphanumeric() || b == b'_';
        !text.is_empty() && text.bytes().all(is_plain)
    };
    let is_attribute = |text: &str| {
        text.split_once('=')
            .is_some_and(|(name, value)| word(name) && word(value))
    };
    for at in output_registers
        .iter()
        .filter(|at| !is_attribute(&at.value))
    {
        let value = format!("{:?}", at.value);
        let text = "is no attribute, NAME=VALUE of letters, digits and _; write, for example, ioff_dir=output";
        table.complain(at.line, keys::OUTPUT_REGISTERS.name, &value, text);
    }
    let read_back = table.string(&keys::READ_BACK).map(|at| {
        let known = ReadBack::NAMES.iter().find(|(_, name)| *name == at.value);
        if known.is_none() {
            let names = ReadBack::NAMES.map(|(_, name)| name).join(", ");
            let text = format!("is no way to read a result back; known ways: {names}");
            table.complain(
                at.line,
                keys::READ_BACK.name,
                &format!("{:?}", at.value),
                &text,
            );
        }
        known.map(|(way, _)| *way)
    });
    table.finish();
    let synthesis = synthesis?;
    let plain = |c: char| c.is_ascii_alphanumeric() || " _-".contains(c);
    if !synthesis.value.starts_with("synth_") || !synthesis.value.chars().all(plain) {
        let text =
            "is no synthesis command of yosys with its options; write, for example, synth_ecp5";
        table.complain(
            synthesis.line,
            "synthesis",
            &format!("{:?}", synthesis.value),
            text,
        );
    }
    Some(Build {
        output_registers: output_registers.into_iter().map(|at| at.value).collect(),
        synthesis: synthesis.value,
        place: place?,
        pack: pack?,
        bitstream: bitstream?.value,
        install: install?.value,
        read_back: left_out_or_good(read_back)?,
    })
}
