//! Figures that tests have measured.

/// The budgets that a test compares with synthesis.
const AREA: &str = include_str!("../../data/area.toml");

/// LUTs and flip-flops of a subject in a family; 0 if there are none.
pub(super) fn area(name: &str, family: &str) -> (u64, u64) {
    let table: toml::Table = AREA.parse().unwrap_or_default();
    let figure = |what: &str| table.get(name)?.get(family)?.get(what)?.as_integer();
    let figure = |what| figure(what).unwrap_or_default() as u64;
    (figure("lut"), figure("ff"))
}
