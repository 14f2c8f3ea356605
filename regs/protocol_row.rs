//! What there is to say of a protocol.

use crate::causes::cause::Cause;
use crate::register::field;
use crate::{Field, Named, Part, Values, CHANNELS_MAX};

/// What card and host agree on of a protocol.
#[derive(Debug)]
pub struct ProtocolRow {
    /// Its name.
    pub name: &'static str,
    /// Its name as an identifier; so a configuration has it.
    pub word: &'static str,
    /// The same for who chooses among them.
    pub means: &'static str,
    /// One that speaks it, with its article.
    pub channel: &'static str,
    /// Whether its line has a clock.
    pub has_clock: bool,
    /// Its causes.
    pub causes: &'static [Cause],
    /// The same under the codes of a result.
    pub coded: &'static [Named],
    /// Blocks of registers that only its channels have.
    pub blocks: &'static [&'static str],
    /// Fields that say or take something else than in EnDat, by their [`Field::by_protocol`](field@Field::by_protocol).
    pub fields: &'static [OwnField],
    /// Its field of `card.protocols`, bit n: channel n speaks it. None of EnDat, which the others speak.
    pub channels: Option<Field>,
    /// What a card has that speaks it, if its channels have words of their own.
    pub part: Option<Part>,
    /// Lowest bit of a position that counts turns, where that does not follow from the width of the angle: unused bits are between the two.
    pub turns_at: Option<u32>,
    /// Numbers of `config.timing.request_id` whose replies bring turns; none: every position has them.
    pub turns_with: Option<&'static [u8]>,
    /// `status.line` has bits of the frame that are not position, no flags.
    pub has_special_bits: bool,
}

/// What a field of all channels is in one protocol.
#[derive(Debug)]
pub struct OwnField {
    /// Its [`Field::by_protocol`](field@Field::by_protocol).
    pub field: &'static str,
    /// What its numbers or bits stand for.
    pub values: Values,
    /// Numbers that it takes, each range from and to; none = all that fit.
    pub takes: &'static [(u32, u32)],
}

/// A field of `card.protocols`: a bit for each channel.
pub(crate) const fn channels(word: &'static str, lsb: u32, meaning: &'static str) -> Option<Field> {
    Some(field(word, lsb, CHANNELS_MAX as u32, "", meaning))
}

/// A row of [`ProtocolRow::fields`].
pub(crate) const fn own(
    field: &'static str,
    values: Values,
    takes: &'static [(u32, u32)],
) -> OwnField {
    OwnField {
        field,
        values,
        takes,
    }
}
