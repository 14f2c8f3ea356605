//! Every key of a configuration, said once: `gen/config/form/key.rs` says who takes what from here. A new key is a row.

pub use super::forms::*;
use super::names::{NAME_MAX, NAME_PATTERN};
use super::words::*;
use crate::board;
pub use crate::form::key::CHANNELS;
use crate::form::key::{self, keys, Choice};
pub use crate::form::key::{Key, Kind, Usual};
use crate::protocols::ssi::keys as ssi;
use crate::protocols::t_format::keys as t_format;
use endat_hdl::card::stream::buffer::BUFFER_BYTES;
use endat_hdl::config::{ERROR_TEST_MS, LIST};
use endat_hdl::endat::timing::{RECOVERY_MAX_NS, RECOVERY_MIN_NS};
use endat_regs::{Protocol, MAP_BYTES};
pub use ssi::{BITS_AFTER, BITS_BEFORE, BIT_DELAY, CODE, END_LOW, PARITY, TWICE};
use std::ops::RangeInclusive;

/// The table that says for all channels what they do not say themselves.
pub const COMMON: &str = "endat";
const TOP: &[&str] = &[""];
const CHANNEL: &[&str] = &[CHANNELS];
/// Keys that `[endat]` gives for all channels and a `[[channel]]` may give for itself.
const EITHER: &[&str] = &[COMMON, CHANNELS];

/// Channels whose line has a clock.
const CLOCKED: u8 = ENDAT_FORM | form(Protocol::Ssi);

/// Longest name of an encoder, in characters: a column of a report.
const ENCODER_MAX: usize = 40;
/// The usual longest calculation time of EnDat 2.2 encoders, in ns.
const TCAL_MAX_NS: u64 = 5_000;
/// Longest cable when none is given, in metres.
const CABLE_M: u64 = 100;
/// How many samples of a bit there may be.
pub const SAMPLE_COUNTS: [u64; 2] = [1, 3];
/// MRS codes that select additional data.
pub static INFOS_RANGES: [RangeInclusive<u64>; 2] = [0x40..=0x4E, 0x50..=0x5E];

fn plain(numbers: impl IntoIterator<Item = u64>) -> Vec<Choice> {
    let choice = |n: u64| Choice::new(n, "");
    numbers.into_iter().map(choice).collect()
}

fn protocols() -> Vec<Choice> {
    let choice = |p: &Protocol| Choice::new(p.row().word, p.row().means);
    Protocol::ALL.iter().map(choice).collect()
}

fn sources() -> Vec<Choice> {
    SOURCES.map(|(word, means)| Choice::new(word, means)).into()
}

keys! {
    /// Those of cards that speak EnDat, in the order of the page.
    COMMON_KEYS;
    NAME = Key::text(TOP, "name", "folder, files and top module")
        .note("letters, digits and underscores, a letter first; no reserved word of Verilog, VHDL or C")
        .at_most(NAME_MAX).pattern(NAME_PATTERN).required("\"my_card\"");
    WITH = Key::texts(TOP, "with", "files besides those of the card, as `emit --with` takes them")
        .one_of(super::extras::choices).usual(Usual::Empty);

    SYSTEM_HZ = Key::number(&["clock"], "system_hz", "clock of the core")
        .note("as far as the board's clock manager makes it").of(CARD_FORM).required("100_000_000");

    CLOCK_HZ = Key::number(EITHER, "clock_hz", "clock on the line")
        .within(|_, _| endat_hdl::config::clock_limits())
        .note("below 100 kHz with SSI only; period 4 to 2047 system cycles (8 with continuous clock; also 2 with `double_edge` and without requests), within 5000 ppm; \
               may be left out in `[endat]` if each channel has its own")
        .of(CLOCKED).required("3_125_000");
    CALIBRATION_HZ = Key::number(EITHER, "calibration_hz", "EnDat clock of the frames that measure the line delay")
        .note("at most `clock_hz`; the period is at most 2047 system cycles; the delay of cable and filter must be less than four fifths of the period \
               (at most 655 kHz with 100 m and 20 ns)")
        .of(ENDAT_FORM).usual(Usual::Follows("200 kHz; 100 kHz with more than 380 m"));
    TST_NS = Key::number(EITHER, "tst_ns", "shortest first low phase tST")
        .note("0 = none").of(CLOCKED).usual(Usual::Follows("2000 from 1 MHz up, else 0; with SSI 0"));
    FILTER_NS = Key::number(EITHER, "filter_ns", "DATA must be stable this long before it counts")
        .note("up to half a period, at most 15 cycles (15.5, in steps of half a cycle, with `double_edge`); `explain` says how much is \
               recommended; 0 = no filter; a channel that speaks T-format has it, too: up to half a bit, default 50 ns")
        .of(CARD_FORM).usual(Usual::Number(0));
    START_WINDOW_NS = Key::number(EITHER, "start_window_ns", "the start edge must come within plus or minus this of its expected phase")
        .note("1 cycle to half a period, at most 63 cycles")
        .of(ENDAT_FORM).usual(Usual::Follows("a quarter of a period; half of one with alignment"));
    TCAL_MAX = Key::number(EITHER, "tcal_max_ns", "longest calculation time tcal of the encoder")
        .note("less with a long cable: the core waits at most 4095 us for the start bit. The limit also holds in the slow frame that measures the \
               delay. Some encoders answer at a fixed clock pulse, so they answer later in that frame: an answer at clock 15 needs 28000 if `calibration_hz` is 200 kHz")
        .of(ENDAT_FORM).usual(Usual::Number(TCAL_MAX_NS));
    RECOVERY_MIN = Key::number(EITHER, "recovery_min_ns", "shortest recovery time tm of the encoder")
        .note("from 10000; from 1250 with 111000 above 1 MHz; with SSI at least one and a half clock periods")
        .of(CLOCKED).usual(Usual::Number(RECOVERY_MIN_NS));
    RECOVERY_MAX = Key::number(EITHER, "recovery_max_ns", "longest recovery time tm of the encoder")
        .note("from `recovery_min_ns`; with the cable at most 8159 cycles; with SSI the monoflop time, for which a trigger has to wait")
        .of(CLOCKED).usual(Usual::Number(RECOVERY_MAX_NS));
    CABLE = Key::number(EITHER, "cable_m", "longest cable")
        .note("above 204 MHz to 380").of(CLOCKED).usual(Usual::Number(CABLE_M));

    ENCODER = Key::text(CHANNEL, "encoder", "the encoder's name, for reports").note("characters that can be seen").at_most(ENCODER_MAX);
    PROTOCOL = Key::text(CHANNEL, "protocol", "what the encoder speaks")
        .note("[other protocols](#other-protocols) have keys of their own, and none of `[endat]`")
        .one_of(protocols).usual(Usual::Word(Protocol::Endat.row().word));
    POSITION_BITS = Key::number(CHANNEL, "position_bits", "width of the position, from the encoder's data sheet")
        .of(CLOCKED).required("29");
    SINGLE_TURN_BITS = Key::number(CHANNEL, "single_turn_bits", "bits of the angle within a turn, from the encoder's data sheet: hosts count turns and differences with it")
        .note("those of `position_bits` that `multi_turn_bits` leaves, if only that is given; T-format: up to 24 of bits 23..0. The name plate of an EnDat encoder has it, too, \
               where the card reads it (`\"initialise\"`); it takes no logic")
        .of(CARD_FORM).usual(Usual::Follows("not known: no angles, no turns counted on"));
    MULTI_TURN_BITS = Key::number(CHANNEL, "multi_turn_bits", "bits that count turns, above those of the angle")
        .note("T-format: up to 24 of bits 47..24, and takes `single_turn_bits`").of(CARD_FORM).usual(Usual::Follows("0 with `single_turn_bits`, else not known"));
    LINEAR = Key::boolean(CHANNEL, "linear", "whether the position is a place on a scale, which does not wrap")
        .note("instead of `single_turn_bits`").of(CARD_FORM).usual(Usual::Boolean(false));
    COMMAND = Key::text(CHANNEL, "command", "mode command that a trigger sends").one_of(commands).of(ENDAT_FORM).required("\"111000\"");
    ENABLED = Key::boolean(CHANNEL, "enabled", "whether the channel takes triggers")
        .note("if any `[[channel]]` has `enabled`, `divider` or `sources`, every channel of the card gets its own trigger settings, which the host can change \
               ([host-link.md](host-link.md#triggers-of-each-channel)); without these keys the card has no logic for them")
        .of(CARD_FORM).usual(Usual::Boolean(true));
    DIVIDER = Key::number(CHANNEL, "divider", "the channel takes one of so many triggers").of(CARD_FORM).usual(Usual::Number(1));
    OWN_SOURCES = Key::texts(CHANNEL, "sources", "which triggers are for this channel")
        .note("as far as `trigger.sources` or the host enables them").one_of(sources).of(CARD_FORM).usual(Usual::All);

    SAMPLE_HZ = Key::number(&["trigger"], "sample_hz", "rate of the timer trigger")
        .note("at least `system_hz` / 2^24 (6 at 100 MHz); if the timer is a source, frame, cable and recovery time limit it (`explain` prints the limit), and `divider` multiplies that limit")
        .of(CARD_FORM).required("10_000");
    TRIGGER_SOURCES = Key::texts(&["trigger"], "sources", "triggers that are enabled after reset")
        .note("with `[]` the host enables one later").one_of(sources).of(CARD_FORM).usual(Usual::All);

    BAUD = Key::number(&["link"], "baud", "rate of the UART").note("to the board's limit, within 20000 ppm").of(CARD_FORM).required("2_000_000");
    READ_HZ = Key::number(&["link"], "read_hz", "how often the host reads all channels, in one burst")
        .note("as often as the link can carry the results").of(CARD_FORM).usual(Usual::Follows("`sample_hz`"));

    BUS = Key::text(&["host"], "bus", "bus between the registers and the host ([bus.md](bus.md))").one_of(buses).usual(Usual::Word("uart"));
    BASE_ADDRESS = Key::number(&["host"], "base_address", "byte address of the registers in the system, for a bus with system addresses")
        .note("as `0x4000_0000`; it goes into the SVD, SystemRDL, C header and `_csr.csv`, not into the logic")
        .step(MAP_BYTES as u64).of(CARD_FORM).usual(Usual::Number(0));
    SCK_HZ = Key::number(&["host"], "sck_hz", "the host's clock, with `\"spi\"`")
        .note("up to an eighth of `system_hz`; checked, changes nothing").of(CARD_FORM);

    SERVICE_PARTS = Key::texts(&["service"], "parts", "what each channel does besides triggered positions; what is left out takes no logic")
        .one_of(|| parts(&SERVICE)).first_leads().of(CARD_FORM);
    INFOS = Key::numbers(&["service"], "infos", "additional data that are selected in turn after reset, by MRS code")
        .note("as `[0x4C, 0x59]`; the host can change them ([programming.md](programming.md))")
        .items(&INFOS_RANGES).at_most(LIST).takes("requests").of(CARD_FORM);

    LINE_PARTS = Key::texts(&["line"], "parts", "options for the line delay, which every channel tracks anyway ([margin.md](margin.md))")
        .one_of(|| parts(&LINE)).first_leads().of(CARD_FORM);
    PHASE = Key::text(&["line"], "phase", "where the phase comes from after reset")
        .note("the host can change it, and also `fixed_delay_ns`, `drift_limit_ns` and `samples`").one_of(phases).takes("alignment").of(CARD_FORM).usual(Usual::Word("tracked"));
    FIXED_DELAY_NS = Key::number(&["line"], "fixed_delay_ns", "delay with `\"fixed\"`, synchroniser and filter included")
        .note("kept to a sixteenth of a cycle; up to 2047 cycles").takes("alignment").of(CARD_FORM).usual(Usual::Number(0));
    DRIFT_LIMIT_NS = Key::number(&["line"], "drift_limit_ns", "drift of the delay that gives alarm")
        .note("up to 255 cycles; 0 = none").takes("alignment").of(CARD_FORM).usual(Usual::Number(0));
    SAMPLES = Key::number(&["line"], "samples", "samples of each bit").note("3 for their majority")
        .one_of(|| plain(SAMPLE_COUNTS)).takes("alignment").of(CARD_FORM).usual(Usual::Number(1));

    OUTPUT_PARTS = Key::texts(&["outputs"], "parts", "outputs for logic in the same device")
        .note("with every bus but `\"uart\"` and `\"none\"`, the first one without a board: [bus.md](bus.md)")
        .one_of(|| vec![
            Choice::new("position", "cropped position, strobe and error of each channel"),
            Choice::new("interrupt", "interrupt to a processor"),
        ]).of(CARD_FORM);

    SAFETY_PARTS = Key::texts(&["safety"], "parts", "monitors of each channel ([safety.md](safety.md))")
        .note("all but `\"second_receiver\"` with every bus but `\"none\"`; `\"second_interface\"` has the pins `second_sck_i`, `second_cs_n_i` and \
               `second_miso_o`, on Papilio Pro B8, B9 and B10; `\"second_receiver\"` not with `double_edge`; `\"error_test\"` takes `\"requests\"`")
        .one_of(|| parts(&SAFETY)).of(CARD_FORM);
    ERROR_TEST_PERIOD = Key::number(&["safety"], "error_test_ms", "time between two forced errors of a channel")
        .note("the host can change it (0 = none)").takes("error_test").of(CARD_FORM).usual(Usual::Number(ERROR_TEST_MS as u64));
    UPSET_GUARDS = Key::boolean(&["safety"], "upset_guards", "whether stored bits are checked, so that an upset of a register shows ([safety.md](safety.md#guards-against-upsets))")
        .note("a port takes some 100 LUTs and 100 flip-flops more; without them a host's check of the CRC finds upsets of the EnDat position that is shown, and \
               4 per mille of all upsets show a wrong one as good (with guards 0.6)").usual(Usual::Boolean(false));
    RESTORE = Key::boolean(&["safety"], "restore", "whether a port without bus shows the previous position again when the encoder withdraws one")
        .note("with any other bus than `\"none\"` it always does; with `false` no position is valid then").of(CARD_FORM).usual(Usual::Boolean(false));

    FIFO_BYTES = Key::number(&["stream"], "fifo_bytes", "buffer of the stream ([stream.md](stream.md))")
        .note("0 = no stream, no logic; `sample_hz` times the frame must fit the line")
        .one_of(|| plain([0].into_iter().chain(BUFFER_BYTES))).of(CARD_FORM).usual(Usual::Number(0));
    STREAM_START = Key::text(&["stream"], "start", "what the stream does after reset")
        .note("the host can change it").one_of(starts).of(CARD_FORM).usual(Usual::Word("off"));
    ADDITIONAL_DATA = Key::boolean(&["stream"], "additional_data", "whether sets have the additional data of their frames")
        .note("8 bytes more for each channel; takes `\"requests\"` in `service.parts` ([stream.md](stream.md#sets-with-additional-data))")
        .of(CARD_FORM).usual(Usual::Boolean(false));

    INITIAL_VALUES = Key::boolean(&["device"], "initial_values", "whether the device gives registers and RAM start values ([bus.md](bus.md))")
        .note("with `false` a reset does").usual(Usual::Boolean(true));

    BOARD_NAME = Key::text(&["board"], "name", "a board that comes with the program ([boards.md](boards.md))")
        .note("required with `\"uart\"`, if there is no `file`")
        .one_of(|| board::names().into_iter().map(|name| Choice::new(name, "")).collect())
        .of(CARD_FORM).required("\"papilio_pro\"");
    BOARD_FILE = Key::text(&["board"], "file", "a board's file, from the folder of the configuration, instead of `name`").of(CARD_FORM);

    PINS = Key::text(&["pins"], "SIGNAL", "the pin of a signal, where it is not the board's usual one")
        .note("a pin (`\"P48\"`) or a connector position (`\"A0\"`), as the board calls them")
        .named(board::signals).of(CARD_FORM).usual(Usual::Follows("the board's usual place"));
}

/// What only another protocol has, in the order of the page.
const OTHER_KEYS: &[&[&Key]] = &[t_format::KEYS, ssi::KEYS];
const COUNT: usize = {
    let (mut count, mut at) = (COMMON_KEYS.len(), 0);
    while at < OTHER_KEYS.len() {
        count += OTHER_KEYS[at].len();
        at += 1;
    }
    count
};

/// All of them, in the order of the page: those that only another protocol has come last.
pub static KEYS: &[&Key] = &{
    let mut parts = [COMMON_KEYS; 1 + OTHER_KEYS.len()];
    let mut other = 0;
    while other < OTHER_KEYS.len() {
        parts[1 + other] = OTHER_KEYS[other];
        other += 1;
    }
    let mut all: [&Key; COUNT] = [&NAME; _];
    let (mut next, mut part) = (0, 0);
    while part < parts.len() {
        let mut at = 0;
        while at < parts[part].len() {
            all[next] = parts[part][at];
            next += 1;
            at += 1;
        }
        part += 1;
    }
    all
};

/// The tables, in the order of the page, and what each is about.
pub const TABLES: &[(&str, &str)] = &[
    ("clock", "clock of the core"),
    (COMMON, "what all channels have that do not say it themselves: every key of it may also stand in a `[[channel]]`"),
    (CHANNELS, "an encoder port; one table in double brackets for each, 1 to 8 of them"),
    ("trigger", "when positions are taken"),
    ("link", "the UART, on cards that have one"),
    ("host", "bus between the registers and the host"),
    ("service", "what each channel does besides triggered positions"),
    ("line", "what each channel does about its line delay"),
    ("outputs", "outputs to logic in the same device"),
    ("safety", "monitors of each channel, and checks of stored bits"),
    ("stream", "sets of all channels, one for each trigger, for a host that wants every position"),
    ("device", "what the device cannot do"),
    ("board", "the board: pins and clock manager"),
    ("pins", "signals on other pins of the board than the usual ones"),
];

/// Keys of a `[[channel]]` that a form has.
pub fn of_channels(forms: u8) -> impl Iterator<Item = &'static Key> {
    let of_channel = move |key: &&&Key| key.tables.contains(&CHANNELS) && key.forms & forms != 0;
    KEYS.iter().filter(of_channel).copied()
}

/// Keys that `[endat]` gives for all channels.
pub fn of_lines() -> impl Iterator<Item = &'static Key> {
    KEYS.iter().filter(|key| key.tables == EITHER).copied()
}

/// Tables in single brackets that a form has, in the order of the page.
pub fn tables(forms: u8) -> Vec<&'static str> {
    let keys = KEYS.iter().filter(|key| key.forms & forms != 0);
    let mut tables = Vec::new();
    for table in keys.filter_map(|key| key.tables.first()) {
        if !["", CHANNELS].contains(table) && !tables.contains(table) {
            tables.push(*table);
        }
    }
    tables
}

/// The tables of the page: keys of cards, and for each other protocol those that EnDat does not have.
pub fn page() -> Vec<String> {
    let of_endat: Vec<&Key> = KEYS
        .iter()
        .copied()
        .filter(|key| key.forms & ENDAT_FORM != 0)
        .collect();
    let others = OTHER_KEYS.iter().map(|keys| key::page(keys.to_vec()));
    [key::page(of_endat)].into_iter().chain(others).collect()
}
