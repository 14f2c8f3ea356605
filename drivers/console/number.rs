//! Numbers as people type them, with their limits in the message: of options, faults and calculated columns.

use crate::error::{shown, CommandError};
use std::ops::RangeInclusive;

/// A number as people write it: 3_125_000.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let groups = digits.as_bytes().rchunks(3).rev();
    let groups = groups.map(|group| String::from_utf8_lossy(group).into_owned());
    groups.collect::<Vec<_>>().join("_")
}

/// A number as people type it, within `range`.
pub fn number(flag: &str, text: &str, range: RangeInclusive<u64>) -> Result<u64, CommandError> {
    let (low, high) = (range.start(), range.end());
    let fail = |what: String| {
        let text = shown(text);
        Err(CommandError::input(format!("{flag} = {text}: {what}")))
    };
    let plain = text.replace('_', "").to_ascii_lowercase();
    let (digits, radix) = match (plain.strip_prefix("0x"), plain.strip_prefix("0b")) {
        (Some(digits), _) => (digits, 16),
        (_, Some(digits)) => (digits, 2),
        _ => (plain.strip_prefix('-').unwrap_or(&plain), 10),
    };
    if digits.is_empty() || !digits.chars().all(|c| c.is_digit(radix)) {
        return fail(format!(
            "is not a number from {low} to {high}; write 123, 0x7B or 0b1111011"
        ));
    }
    match u64::from_str_radix(digits, radix) {
        Ok(value) if range.contains(&value) && !plain.starts_with('-') => Ok(value),
        _ => fail(format!(
            "outside {low}..{high}; give a number in that range"
        )),
    }
}

/// The same, for the parser of the command line, which names the option itself.
pub fn parser(low: u32, high: u32) -> impl Fn(&str) -> Result<u32, String> + Clone {
    move |text| {
        let found = number("", text, low.into()..=high.into());
        found.map(|number| number as u32).map_err(|error| {
            let text = error.to_string();
            let what = text.split_once(": ").map(|(_, what)| what.to_owned());
            what.unwrap_or(text)
        })
    }
}

/// A number with a point, within `range`.
pub fn decimal(flag: &str, text: &str, range: RangeInclusive<f64>) -> Result<f64, CommandError> {
    let (low, high) = (range.start(), range.end());
    match text.replace('_', "").parse::<f64>() {
        Ok(value) if range.contains(&value) => Ok(value),
        Ok(_) => Err(CommandError::input(format!(
            "{flag} = {}: outside {low}..{high}; give a number in that range",
            shown(text)
        ))),
        Err(_) => Err(CommandError::input(format!(
            "{flag} = {}: is not a number from {low} to {high}; write 12 or 0.5",
            shown(text)
        ))),
    }
}

/// The same for an option that may be left out.
pub fn number_if(
    flag: &str,
    text: &Option<String>,
    range: RangeInclusive<u64>,
) -> Result<Option<u64>, CommandError> {
    text.as_deref()
        .map(|text| number(flag, text, range))
        .transpose()
}

/// The same for an option that may be left out.
pub fn decimal_if(
    flag: &str,
    text: &Option<String>,
    range: RangeInclusive<f64>,
) -> Result<Option<f64>, CommandError> {
    text.as_deref()
        .map(|text| decimal(flag, text, range))
        .transpose()
}
