//! Numbers that were written with a unit: a key's name has its unit, and its value is a whole number.

use endat_console::number::grouped;

/// Units that a value may be written with, by the ending of the key: what one of each is in the key's own.
const UNITS: [(&str, &[(&str, f64)]); 6] = [
    (
        "_hz",
        &[("hz", 1.0), ("khz", 1e3), ("mhz", 1e6), ("ghz", 1e9)],
    ),
    (
        "baud",
        &[
            ("baud", 1.0),
            ("bit/s", 1.0),
            ("kbit/s", 1e3),
            ("mbit/s", 1e6),
            ("mbaud", 1e6),
        ],
    ),
    (
        "_ns",
        &[
            ("ns", 1.0),
            ("us", 1e3),
            ("µs", 1e3),
            ("ms", 1e6),
            ("s", 1e9),
        ],
    ),
    ("_us", &[("us", 1.0), ("µs", 1.0), ("ms", 1e3), ("s", 1e6)]),
    ("_m", &[("m", 1.0), ("km", 1e3)]),
    ("_mv", &[("mv", 1.0), ("v", 1e3)]),
];

/// How `key` would have to be written for a value such as `80 MHz`; none if the value is no number with a unit of the key.
pub fn remedy(key: &str, value: &str) -> Option<String> {
    let value = value.trim().trim_matches('"').trim();
    let unit_at = value.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '_')))?;
    let (number, unit) = value.split_at(unit_at);
    let number: f64 = number.replace('_', "").parse().ok()?;
    let (_, units) = UNITS.iter().find(|(ending, _)| key.ends_with(ending))?;
    let unit = unit.trim().to_lowercase();
    let (_, by) = units.iter().find(|(name, _)| *name == unit)?;
    let own = number * by;
    let is_whole = own.fract() == 0.0 && own < 1e15;
    is_whole.then(|| format!("write {key} = {}", grouped(own as u64)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_with_a_unit_becomes_one_in_the_unit_of_its_key() {
        for (key, value, told) in [
            ("system_hz", "80 MHz", "write system_hz = 80_000_000"),
            ("clock_hz", "\"2.5MHz\"", "write clock_hz = 2_500_000"),
            (
                "recovery_min_ns",
                "\"15 µs\"",
                "write recovery_min_ns = 15_000",
            ),
            ("baud", "3 Mbit/s", "write baud = 3_000_000"),
            ("cable_m", "\"100 m\"", "write cable_m = 100"),
        ] {
            assert_eq!(remedy(key, value).as_deref(), Some(told), "{value}");
        }
        for (key, value) in [
            ("system_hz", "fast"),
            ("system_hz", "80 m"),
            ("system_hz", "80"),
            ("recovery_min_ns", "0.5 ns"),
            ("name", "80 MHz"),
        ] {
            assert_eq!(remedy(key, value), None, "{value}");
        }
    }
}
