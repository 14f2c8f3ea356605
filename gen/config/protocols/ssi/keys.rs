//! Keys that only SSI has.

use crate::form::key::{keys, Choice, Key, Usual, CHANNELS};
use crate::forms::form;
use endat_hdl::protocols::ssi::specials::{Special, SPECIALS_MAX};
use endat_hdl::protocols::ssi::{asked::Parity, protocol::BIT_DELAY_NS};
use endat_regs::Protocol;

const CHANNEL: &[&str] = &[CHANNELS];
const SPEAKS_IT: u8 = form(Protocol::Ssi);
/// The words of `code`.
pub const BINARY: &str = "binary";
/// See [`BINARY`].
pub const GRAY: &str = "gray";

fn codes() -> Vec<Choice> {
    vec![
        Choice::new(BINARY, "a number"),
        Choice::new(GRAY, "Gray code, turned into a number"),
    ]
}

/// The words of `parity`.
pub const PARITIES: [(&str, Parity, &str); 3] = [
    ("none", Parity::None, "there is none"),
    ("even", Parity::Even, "an even number of ones with it"),
    ("odd", Parity::Odd, "an odd number"),
];

fn parities() -> Vec<Choice> {
    let choice = |(word, _, means)| Choice::new(word, means);
    PARITIES.map(choice).into()
}

fn specials() -> Vec<Choice> {
    let choice = |(_, word, means)| Choice::new(word, means);
    Special::ALL.map(choice).into()
}

/// Those that do not check what comes before them.
fn specials_before() -> Vec<Choice> {
    let plain = Special::ALL.into_iter().filter(|row| !row.0.is_check());
    plain
        .map(|(_, word, means)| Choice::new(word, means))
        .collect()
}

keys! {
    /// All of them, in the order of the page.
    KEYS;
    CODE = Key::text(CHANNEL, "code", "code of the position, from the encoder's data sheet")
        .one_of(codes).of(SPEAKS_IT).usual(Usual::Word(BINARY));
    PARITY = Key::text(CHANNEL, "parity", "bit behind the position, over its bits as they are sent")
        .one_of(parities).of(SPEAKS_IT).usual(Usual::Word("none"));
    BIT_DELAY = Key::number(CHANNEL, "bit_delay_ns", "longest time from a clock edge to its bit, at the encoder, from its data sheet")
        .note("with the cable both ways and the input it must fit into a period; less lets the clock be faster; checked, changes nothing in the card")
        .of(SPEAKS_IT).usual(Usual::Number(BIT_DELAY_NS));
    TWICE = Key::boolean(CHANNEL, "twice", "whether each position is asked for twice, and the two are compared: SSI has no check sum")
        .note("for an encoder that repeats while the clock goes on (multiple transmission); a frame is twice as long")
        .of(SPEAKS_IT).usual(Usual::Boolean(false));
    BITS_BEFORE = Key::texts(CHANNEL, "bits_before", "special bits before the position, which are not part of it, in the order in which they come")
        .note("no more with those of `bits_after`, where a CRC counts as six ([ssi.md](ssi.md#special-bits))")
        .one_of(specials_before).repeating().at_most(SPECIALS_MAX).of(SPEAKS_IT);
    BITS_AFTER = Key::texts(CHANNEL, "bits_after", "special bits after the position, and after its parity bit")
        .one_of(specials).repeating().at_most(SPECIALS_MAX).of(SPEAKS_IT);
    END_LOW = Key::boolean(CHANNEL, "end_low", "whether DATA is LOW after the last bit until the recovery time is over")
        .note("`false` for an encoder that keeps its last bit on the line; not with `twice`")
        .of(SPEAKS_IT).usual(Usual::Boolean(true));
}
