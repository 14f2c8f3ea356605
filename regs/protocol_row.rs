//! The description of a protocol.

use crate::causes::cause::Cause;
use crate::register::field;
use crate::{Field, Named, Part, Values, CHANNELS_MAX};

/// Facts about a protocol that card and host share.
#[derive(Debug)]
pub struct ProtocolRow {
    /// Name.
    pub name: &'static str,
    /// Name as an identifier, as used in configurations.
    pub word: &'static str,
    /// One-line description for users who choose a protocol.
    pub means: &'static str,
    /// Name of a channel with this protocol, with its article.
    pub channel: &'static str,
    /// True if the line has a clock.
    pub has_clock: bool,
    /// Causes.
    pub causes: &'static [Cause],
    /// Causes by their code in a result.
    pub coded: &'static [Named],
    /// Register blocks that only channels with this protocol have.
    pub blocks: &'static [&'static str],
    /// Fields with other values or limits than in EnDat, by their [`Field::by_protocol`](field@Field::by_protocol).
    pub fields: &'static [OwnField],
    /// Field of `card.protocols`, bit n for channel n; `None` for EnDat, the default.
    pub channels: Option<Field>,
    /// Part of a card with this protocol, if its channels have additional words.
    pub part: Option<Part>,
    /// Lowest turn bit of a position, if it does not follow from the width of the angle; the bits between the two are unused.
    pub turns_at: Option<u32>,
    /// Numbers of `config.timing.request_id` whose replies include turns; `None` if every position has turns.
    pub turns_with: Option<&'static [u8]>,
    /// True if `status.line` holds special bits of the frame instead of flags.
    pub has_special_bits: bool,
}

/// Values of a shared field in one protocol.
#[derive(Debug)]
pub struct OwnField {
    /// Its [`Field::by_protocol`](field@Field::by_protocol).
    pub field: &'static str,
    /// Named numbers or bits.
    pub values: Values,
    /// Allowed ranges, both ends included; empty if all numbers are allowed.
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
