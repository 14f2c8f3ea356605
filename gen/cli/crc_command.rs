//! `crc`: computes and explains the CRC of a frame.

use super::{to_json, Outcome};
use crate::crc::{self, CoveredBit};
use crate::error::GenError;
use clap::Args;
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
        conflicts_with = "raw"
    )]
    position: Option<String>,
    /// Position bits, 1 to 48
    #[arg(long, value_name = "COUNT", requires = "position")]
    bits: Option<String>,
    /// Error bit F1, 1 = error
    #[arg(long, value_name = "BIT", requires = "position")]
    f1: Option<String>,
    /// Error bit F2 of EnDat 2.2, 0 = error; leave out for EnDat 2.1
    #[arg(long, value_name = "BIT", requires = "position")]
    f2: Option<String>,
    /// Covered bits in the order of transmission, instead of the fields
    #[arg(long, value_name = "BITS")]
    raw: Option<String>,
    /// CRC that was received, decimal, 0x... or 0b...; exit code 1 when it is wrong
    #[arg(long, value_name = "NUMBER")]
    received: Option<String>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// A number as people type it.
fn number(flag: &str, text: &str, max: u64) -> Result<u64, GenError> {
    let plain = text.replace('_', "").to_ascii_lowercase();
    let parsed = match (plain.strip_prefix("0x"), plain.strip_prefix("0b")) {
        (Some(digits), _) => u64::from_str_radix(digits, 16),
        (_, Some(digits)) => u64::from_str_radix(digits, 2),
        _ => plain.parse(),
    };
    match parsed {
        Ok(value) if value <= max => Ok(value),
        Ok(value) => Err(GenError::input(format!(
            "{flag} = {text}: {value} is more than {max}; give a smaller number"
        ))),
        Err(_) => Err(GenError::input(format!(
            "{flag} = {text:?}: is not a number from 0 to {max}; write 123, 0x7B or 0b1111011"
        ))),
    }
}

fn fields(arguments: &CrcArgs) -> Result<Vec<CoveredBit>, GenError> {
    let text =
        |value: &Option<String>, default: &str| value.clone().unwrap_or_else(|| default.into());
    let bits = text(&arguments.bits, "0");
    let (low, high) = (*POSITION_BITS.start(), *POSITION_BITS.end());
    let width = number("--bits", &bits, u64::from(high))? as u32;
    if width < low {
        return Err(GenError::input(format!(
            "--bits = {bits}: outside {low}..{high}; give the encoder's position bits"
        )));
    }
    let position_text = text(&arguments.position, "0");
    let position = number("--position", &position_text, u64::MAX)?;
    if position >> width != 0 {
        return Err(GenError::input(format!(
            "--position = {position_text}: needs {} bits, --bits is {width}; give a position below {}",
            u64::BITS - position.leading_zeros(),
            1u64 << width
        )));
    }
    let f1 = number("--f1", &text(&arguments.f1, "0"), 1)? as u8;
    let f2 = arguments
        .f2
        .as_ref()
        .map(|f2| number("--f2", f2, 1))
        .transpose()?;
    Ok(crc::position_bits(
        f1,
        f2.map(|f2| f2 as u8),
        position,
        width,
    ))
}

fn raw(text: &str) -> Result<Vec<CoveredBit>, GenError> {
    let digits: Vec<char> = text.chars().filter(|c| !matches!(c, '_' | ' ')).collect();
    if let Some(bad) = digits.iter().find(|c| !matches!(c, '0' | '1')) {
        return Err(GenError::input(format!("--raw = {text:?}: has the character {bad:?}; write only 0 and 1, first transmitted bit first")));
    }
    if digits.is_empty() || digits.len() > crc::BITS_MAX {
        return Err(GenError::input(format!(
            "--raw: has {} bits, outside 1..{}; give the covered bits of one block",
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
pub fn run(arguments: &CrcArgs) -> Result<Outcome, GenError> {
    let bits = match &arguments.raw {
        Some(text) => raw(text)?,
        None => fields(arguments)?,
    };
    let received = arguments
        .received
        .as_ref()
        .map(|r| number("--received", r, 31))
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
