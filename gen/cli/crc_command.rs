//! `crc`: computes and explains the CRC of a frame.

use super::{to_json, Outcome};
use crate::crc::{self, CoveredBit};
use clap::Args;
use endat_console::error::{shown, CommandError};
use endat_console::number::number;
use endat_hdl::protocol::POSITION_BITS;

/// Arguments of `crc`.
///
/// The CRC covers F1, F2 (EnDat 2.2 only) and the position, LSB first; not the start bit.
#[derive(Args)]
pub struct CrcArgs {
    /// Position, decimal, 0x... or 0b...
    #[arg(
        long,
        value_name = "NUMBER",
        requires = "bits",
        required_unless_present = "raw",
        conflicts_with = "raw",
        allow_negative_numbers = true
    )]
    position: Option<String>,
    /// Position bits, 1 to 48
    #[arg(
        long,
        value_name = "COUNT",
        requires = "position",
        allow_negative_numbers = true
    )]
    bits: Option<String>,
    /// Error bit F1, 1 = error
    #[arg(
        long,
        value_name = "BIT",
        requires = "position",
        allow_negative_numbers = true
    )]
    f1: Option<String>,
    /// Error bit F2 of EnDat 2.2, 0 = error; leave out for EnDat 2.1
    #[arg(
        long,
        value_name = "BIT",
        requires = "position",
        allow_negative_numbers = true
    )]
    f2: Option<String>,
    /// Covered bits in the order of transmission, instead of the fields
    #[arg(long, value_name = "BITS", allow_negative_numbers = true)]
    raw: Option<String>,
    /// CRC that was received, decimal, 0x... or 0b...; exit code 1 when it is wrong
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true)]
    received: Option<String>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

fn fields(arguments: &CrcArgs) -> Result<Vec<CoveredBit>, CommandError> {
    let text =
        |value: &Option<String>, default: &str| value.clone().unwrap_or_else(|| default.into());
    let bits = text(&arguments.bits, "0");
    let (low, high) = (*POSITION_BITS.start(), *POSITION_BITS.end());
    let width = number("--bits", &bits, u64::from(low)..=u64::from(high))? as u32;
    let position = text(&arguments.position, "0");
    let position = number("--position", &position, 0..=(1 << width) - 1).map_err(|error| {
        let messages = error.messages().iter();
        let told = messages.map(|m| format!("{m}; --bits is {width}"));
        CommandError::Input(told.collect())
    })?;
    let f1 = number("--f1", &text(&arguments.f1, "0"), 0..=1)? as u8;
    let f2 = arguments
        .f2
        .as_ref()
        .map(|f2| number("--f2", f2, 0..=1))
        .transpose()?;
    Ok(crc::position_bits(
        f1,
        f2.map(|f2| f2 as u8),
        position,
        width,
    ))
}

fn raw(text: &str) -> Result<Vec<CoveredBit>, CommandError> {
    let digits: Vec<char> = text.chars().filter(|c| !matches!(c, '_' | ' ')).collect();
    if let Some(bad) = digits.iter().find(|c| !matches!(c, '0' | '1')) {
        return Err(CommandError::input(format!("--raw = {}: has the character {bad:?}; write only 0 and 1, first transmitted bit first", shown(text))));
    }
    if digits.is_empty() || digits.len() > crc::BITS_MAX {
        return Err(CommandError::input(format!(
            "--raw = {}: has {} bits, outside 1..{}; give the covered bits of one block",
            shown(text),
            digits.len(),
            crc::BITS_MAX
        )));
    }
    Ok(crc::raw_bits(
        &digits
            .iter()
            .map(|c| u8::from(*c == '1'))
            .collect::<Vec<_>>(),
    ))
}

/// Runs the command.
pub fn run(arguments: &CrcArgs) -> Result<Outcome, CommandError> {
    let bits = match &arguments.raw {
        Some(text) => raw(text)?,
        None => fields(arguments)?,
    };
    let received = arguments
        .received
        .as_ref()
        .map(|r| number("--received", r, 0..=31))
        .transpose()?;
    let explanation = crc::explain(bits, received.map(|r| r as u8));
    let stdout = if arguments.json {
        to_json(&explanation)?
    } else {
        explanation.to_string()
    };
    let mut outcome = Outcome::good(stdout);
    if !explanation.is_good() {
        outcome.exit_code = 1;
        outcome.messages.push(format!(
            "--received = 0x{:02X}: wrong, the CRC is 0x{:02X}",
            received.unwrap_or(0),
            explanation.crc
        ));
    }
    Ok(outcome)
}
