//! Formatting of numbers.

/// A number with at most `digits` decimals, without trailing zeros.
pub fn decimal(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    match text {
        "-0" => "0".into(),
        _ => text.into(),
    }
}

/// A frequency in MHz, without needless zeros.
pub fn mhz(hz: u64) -> String {
    decimal(hz as f64 / 1e6, 6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_lose_needless_zeros_only() {
        for (value, digits, text) in [
            (5.0, 4, "5"),
            (0.25, 4, "0.25"),
            (-0.0, 4, "0"),
            (150.0, 4, "150"),
            (9.143, 4, "9.143"),
            (100.0, 0, "100"),
            (1.50, 2, "1.5"),
            (-0.04, 2, "-0.04"),
        ] {
            assert_eq!(decimal(value, digits), text);
        }
    }
}
