//! Keys that only SSI has.

use crate::config::forms::form;
use crate::form::key::{keys, Choice, Key, Usual, CHANNELS};
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

keys! {
    /// All of them, in the order of the page.
    KEYS;
    CODE = Key::text(CHANNEL, "code", "code of the position, from the encoder's data sheet")
        .one_of(codes).of(SPEAKS_IT).usual(Usual::Word(BINARY));
    TWICE = Key::boolean(CHANNEL, "twice", "whether each position is asked for twice, and the two are compared: SSI has no check sum")
        .note("for an encoder that repeats while the clock goes on (multiple transmission); a frame is twice as long")
        .of(SPEAKS_IT).usual(Usual::Boolean(false));
}
