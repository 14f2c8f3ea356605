//! Keys that only T-format has.

use crate::form::key::{keys, Choice, Key, Usual, CHANNELS};
use crate::forms::{form, RECEIVER_FORM};
use endat_hdl::protocols::t_format::dsp::TFormatStart;
use endat_hdl::protocols::t_format::protocol::{Request, BIT_HZ, FAST_BIT_HZ};
use endat_regs::Protocol;

const CHANNEL: &[&str] = &[CHANNELS];
/// A channel of a card, and a receiver.
const SPEAKS_IT: u8 = form(Protocol::TFormat) | RECEIVER_FORM;

fn rates() -> Vec<Choice> {
    [BIT_HZ, FAST_BIT_HZ].map(|hz| Choice::new(hz, "")).into()
}

fn requests() -> Vec<Choice> {
    let meaning = |request| match request {
        Request::SingleTurn => "single-turn position",
        Request::MultiTurn => "multi-turn position",
        Request::EncoderId => "kind of encoder",
        Request::Everything => "both positions, kind and alarms",
        Request::WriteEeprom => "writes a byte of the EEPROM",
        Request::ClearErrors => "clears errors; takes ten in a row",
        Request::ClearSingleTurn => "makes the present angle zero; takes ten in a row",
        Request::ClearMultiTurn => "clears turns and errors; takes ten in a row",
        Request::ReadEeprom => "reads a byte of the EEPROM",
    };
    Request::ALL.map(|r| Choice::new(r.id(), meaning(r))).into()
}

keys! {
    /// All of them, in the order of the page.
    KEYS;
    BIT_RATE = Key::number(CHANNEL, "bit_hz", "bit rate of T-format")
        .one_of(rates).of(SPEAKS_IT).usual(Usual::Number(BIT_HZ));
    REQUEST = Key::number(CHANNEL, "request", "what a trigger sends, of a receiver before the processor has written an ID")
        .note("6 and 13 with receivers only").one_of(requests).of(SPEAKS_IT).usual(Usual::Number(TFormatStart::DEFAULT.request_id as u64));
    REPLY_GAP_US = Key::number(CHANNEL, "reply_gap_us", "longest pause before the reply")
        .of(SPEAKS_IT).usual(Usual::Number(TFormatStart::DEFAULT.reply_gap_us));
    FIELD_GAP_US = Key::number(CHANNEL, "field_gap_us", "longest pause between two fields")
        .of(SPEAKS_IT).usual(Usual::Number(TFormatStart::DEFAULT.field_gap_us));
    FILTER_CYCLES = Key::number(CHANNEL, "filter_cycles", "pulses up to this length are ignored, by a receiver")
        .note("at 5 Mbit/s 0 or 1").of(RECEIVER_FORM).usual(Usual::Number(TFormatStart::DEFAULT.filter_cycles));
}
