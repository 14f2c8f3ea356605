//! What there is to say of a protocol.

use crate::causes::cause::Cause;
use crate::{Field, Named, Part, Values, CARD};

/// What card and host agree on of a protocol.
#[derive(Debug)]
pub struct ProtocolRow {
    /// Its name.
    pub name: &'static str,
    /// Its name as an identifier; so a configuration has it.
    pub word: &'static str,
    /// The same for who chooses among them.
    pub means: &'static str,
    /// Whether its line has a clock.
    pub has_clock: bool,
    /// Its causes.
    pub causes: &'static [Cause],
    /// The same under the codes of a result.
    pub coded: &'static [Named],
    /// Blocks of registers that only its channels have.
    pub blocks: &'static [&'static str],
    /// Fields that say or take something else than in EnDat, by their [`Field::by_protocol`].
    pub fields: &'static [OwnField],
    /// Bit n of it: channel n speaks the protocol. None of EnDat, which the others speak.
    pub channels: Option<&'static Field>,
    /// What a card has that speaks it; none of EnDat.
    pub part: Option<Part>,
}

/// What a field of all channels is in one protocol.
#[derive(Debug)]
pub struct OwnField {
    /// Its [`Field::by_protocol`].
    pub field: &'static str,
    /// What its numbers or bits stand for.
    pub values: Values,
    /// Numbers that it takes, each range from and to; none = all that fit.
    pub takes: &'static [(u32, u32)],
}

/// The field of that name in `card.protocols`.
pub(crate) const fn channels(word: &str) -> Option<&'static Field> {
    Some(CARD.field("protocols", word))
}
