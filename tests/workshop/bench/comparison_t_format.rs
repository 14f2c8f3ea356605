//! The T-format receiver's table of `docs/comparison.md`.

use super::comparison_table::{Basis, Table};
use super::fault;
use super::measured::area;
use endat_console::error::CommandError;
use endat_draw::decimal;
use endat_hdl::protocols::t_format::protocol::{Request, BIT_HZ, FAST_BIT_HZ};

/// Logic cells that a test compares with place and route.
const LOGIC_CELLS: &str = include_str!("../../data/logic_cells.toml");

/// Beside those who have published a receiver of the same protocol.
pub(super) fn asynchronous() -> Result<Table, CommandError> {
    let [(all, all_ff), (receiver, receiver_ff)] =
        ["async_dsp", "t_format"].map(|n| area(n, "ice40"));
    let cells: toml::Table = LOGIC_CELLS.parse().unwrap_or_default();
    let packed = |what: &str| {
        let found = cells.get("async_dsp").and_then(|c| c.get(what));
        let found = found.and_then(|c| c.as_integer());
        found.ok_or_else(|| fault(&"no logic cells of async_dsp"))
    };
    let (cells, rams) = (packed("cells")?, packed("rams")?);
    let requests = Request::ALL.map(|r| format!("{:X}", r.id()));
    let rates = [BIT_HZ, FAST_BIT_HZ].map(|hz| format!("{} Mbit/s", decimal(hz as f64 / 1e6, 1)));
    let mut table = Table::new("Asynchronous receiver: `async_dsp`", "Kang et al. 2004");
    table.row(
        Basis::Synthesis,
        "receiver with the bus of a signal processor",
        "707 logic cells (FLEX10K, LUT4 and FF each)",
        format!(
            "{cells} logic cells (iCE40, the same): {all} LUT4, {all_ff} FF; and {rams} block RAMs of 4 kbit for the words"
        ),
    );
    table.row(
        Basis::Synthesis,
        "receiver alone",
        "236 to 248 LUT, 256 FF (Microchip's core for the same protocol)",
        format!("{receiver} LUT4, {receiver_ff} FF (iCE40): larger"),
    );
    table.row(
        Basis::Description,
        "rate",
        "2.5 Mbit/s",
        rates.join(" and "),
    );
    table.row(Basis::Words, "clock", "20 or 60 MHz by a pin", "the same");
    table.row(
        Basis::Description,
        "requests",
        "0, 1, 3",
        requests.join(", "),
    );
    table.row(
        Basis::Words,
        "bus",
        "data 4 clocks after the address, held for 5",
        "the same",
    );
    table.note("Tolerances and tested frames: [t-format.md](t-format.md#on-the-line).");
    Ok(table)
}
