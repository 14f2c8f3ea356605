//! Pieces of text that every part of an entity uses.

use crate::printing::{is_count, is_quantity, SMALL_MASK_MAX};

/// Begins a comment.
pub(super) const MARK: &str = "--";
/// Largest number that VHDL surely counts with.
const INTEGER_MAX: u128 = (1 << 31) - 1;
/// A pattern of at most so many bits is said bit by bit.
const SHORT_BITS: usize = 4;
/// The same where hexadecimal digits do not fit.
const BINARY_BITS: usize = 12;

/// A line of a comment in ASCII: VHDL-93 is Latin-1, where other characters would be something else.
pub(super) fn plain(line: &str) -> String {
    let letters = line.chars().map(|c| if c.is_ascii() { c } else { '?' });
    letters.collect()
}

pub(super) fn comment(lines: &[String], pad: &str) -> String {
    let lines: Vec<String> = lines.iter().map(|line| plain(line)).collect();
    crate::printing::comment(MARK, &lines, pad)
}

/// The type of a signal.
pub(super) fn subtype(width_bits: usize) -> String {
    match width_bits {
        1 => "std_logic".into(),
        _ => format!("unsigned({} downto 0)", width_bits - 1),
    }
}

/// The number that an operator of `unsigned` takes as it is: times and counts.
pub(super) fn number(value: u128) -> Option<String> {
    (is_count(value) && value <= INTEGER_MAX).then(|| value.to_string())
}

/// Source of a literal's type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Context {
    /// The signal that is assigned.
    Target,
    /// The other operand.
    Operand,
    /// Nothing: it has to say so itself.
    Alone,
}

/// A literal: times and counts in decimal, others bit by bit or in hexadecimal.
pub(super) fn literal(value: u128, width_bits: usize, context: Context) -> String {
    match (width_bits, number(value)) {
        (1, _) => format!("'{value}'"),
        (_, Some(number)) if width_bits > SHORT_BITS => {
            format!("to_unsigned({number}, {width_bits})")
        }
        _ => typed(bits(value, width_bits), context),
    }
}

/// The value of something that has a name.
pub(super) fn named_literal(name: &str, value: u128, width_bits: usize) -> String {
    match width_bits {
        1 => format!("'{value}'"),
        _ if value == 0 => "(others => '0')".into(),
        _ if is_quantity(name, value) && value <= INTEGER_MAX => {
            format!("to_unsigned({value}, {width_bits})")
        }
        _ => bits(value, width_bits),
    }
}

/// A pattern of bits in an operation on bits.
pub(super) fn mask_literal(value: u128, width_bits: usize, context: Context) -> String {
    match width_bits {
        1 => format!("'{value}'"),
        _ if value <= SMALL_MASK_MAX => literal(value, width_bits, context),
        _ => typed(bits(value, width_bits), context),
    }
}

/// A pattern in which each bit has a separate meaning: a string, or concatenated strings.
pub(super) fn bits(value: u128, width_bits: usize) -> String {
    let above = width_bits % 4;
    match width_bits {
        1 => format!("'{value}'"),
        _ if above == 0 && width_bits > SHORT_BITS => {
            format!("x\"{value:0digits$x}\"", digits = width_bits / 4)
        }
        _ if width_bits <= BINARY_BITS => binary(value, width_bits),
        _ => {
            let low = width_bits - above;
            format!(
                "{} & x\"{:0digits$x}\"",
                binary(value >> low, above),
                value & crate::elaborate::mask(low),
                digits = low / 4
            )
        }
    }
}

/// A string of bits, also of one: what a case takes.
pub(super) fn binary(value: u128, width_bits: usize) -> String {
    format!("\"{value:0width_bits$b}\"")
}

/// Strings side by side, as one operand.
fn typed(text: String, context: Context) -> String {
    match (context, text.contains('&')) {
        (Context::Target, _) | (Context::Operand, false) => text,
        _ => format!("unsigned'({text})"),
    }
}

/// Items of a list in lines, as many in each as fit, separated by commas.
pub(super) fn wrapped(items: &[String], longest: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for (index, item) in items.iter().enumerate() {
        let end = if index + 1 < items.len() { "," } else { "" };
        let last = lines.len() - 1;
        if !lines[last].is_empty() && lines[last].len() + item.len() > longest {
            lines.push(format!("{item}{end}"));
            continue;
        }
        let space = if lines[last].is_empty() { "" } else { " " };
        lines[last].push_str(&format!("{space}{item}{end}"));
    }
    lines
}
