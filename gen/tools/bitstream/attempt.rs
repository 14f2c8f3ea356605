//! What one run of place and route, or of a vendor's tool, gave: clocks, inputs, cells.

use endat_config::board::OSCILLATOR_PORT;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// What nextpnr calls the end of a way that belongs to no clock.
const NO_CLOCK: &str = "<async>";

/// One clock of the device.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Clock {
    /// Net.
    pub net: String,
    /// Fastest that it may be, in MHz.
    pub fmax_mhz: f64,
    /// What it is, in MHz.
    pub wanted_mhz: f64,
    /// How much faster it could be, in percent.
    pub margin_percent: f64,
}

/// The way of those inputs that belong to no clock: that of the slowest, and what there may be. A line that goes to two samplers reaches
/// both within that time, so it is the most that their samples may be apart besides the clock.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Inputs {
    /// From the pin to the first register, in nanoseconds.
    pub slowest_ns: f64,
    /// The most that is good.
    pub allowed_ns: f64,
}

/// How much of one kind of cell a card takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Use {
    /// Taken.
    pub used: u64,
    /// There are.
    pub available: u64,
}

/// What one seed gave.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Attempt {
    /// Seed of the placer; 0 with a tool that takes none.
    pub seed: u32,
    /// Whether every clock is fast enough, and every input near enough to its first register.
    pub is_met: bool,
    /// All clocks.
    pub clocks: Vec<Clock>,
    /// Inputs that belong to no clock, where the tool tells of them.
    pub inputs: Option<Inputs>,
    /// Cells by their kind; what there is none of is left out.
    pub cells: BTreeMap<String, Use>,
}

impl Attempt {
    /// The clock with the least margin.
    pub fn tightest(&self) -> Option<&Clock> {
        let by_margin = |a: &&Clock, b: &&Clock| a.margin_percent.total_cmp(&b.margin_percent);
        self.clocks.iter().min_by(by_margin)
    }

    /// Its margin, in percent.
    pub fn margin(&self) -> f64 {
        self.tightest()
            .map_or(f64::NEG_INFINITY, |c| c.margin_percent)
    }
}

/// The slowest of the inputs that belong to no clock; none if the report has no word of them.
fn inputs(report: &Value, input_hz: u64) -> Option<Inputs> {
    let paths = report["critical_paths"].as_array()?.iter();
    let to_registers = paths.filter(|path| {
        let is_clock = |end: &Value| end.as_str().is_some_and(|end| end.contains("edge "));
        path["from"] == NO_CLOCK && is_clock(&path["to"])
    });
    let delays = to_registers.filter_map(|path| {
        let steps = path["path"].as_array()?.iter();
        steps
            .map(|step| step["delay"].as_f64())
            .sum::<Option<f64>>()
    });
    Some(Inputs {
        slowest_ns: delays.max_by(f64::total_cmp)?,
        allowed_ns: 1e9 / input_hz as f64,
    })
}

/// The clocks and cells of a report; none if it does not have the system clock.
pub(super) fn attempt(report: &Value, seed: u32, system_hz: u64, input_hz: u64) -> Option<Attempt> {
    let clocks = report["fmax"].as_object()?.iter();
    let clocks = clocks.map(|(net, clock)| {
        let (fmax_mhz, wanted_mhz) = (clock["achieved"].as_f64()?, clock["constraint"].as_f64()?);
        Some(Clock {
            net: net.clone(),
            fmax_mhz,
            wanted_mhz,
            margin_percent: (fmax_mhz / wanted_mhz - 1.0) * 100.0,
        })
    });
    let clocks: Vec<Clock> = clocks.collect::<Option<_>>()?;
    let system_mhz = system_hz as f64 / 1e6;
    // Periods are kept in whole picoseconds.
    let is_system = |clock: &Clock| {
        clock.wanted_mhz > system_mhz * 0.999 && !clock.net.starts_with(OSCILLATOR_PORT)
    };
    if !clocks.iter().any(is_system) {
        return None;
    }
    let cells = report["utilization"].as_object().into_iter().flatten();
    let cells = cells.filter_map(|(kind, cells)| {
        let (used, available) = (cells["used"].as_u64()?, cells["available"].as_u64()?);
        (used > 0).then(|| (kind.clone(), Use { used, available }))
    });
    let inputs = inputs(report, input_hz);
    Some(Attempt {
        seed,
        is_met: clocks
            .iter()
            .all(|clock| clock.fmax_mhz >= clock.wanted_mhz)
            && inputs.as_ref().is_none_or(|i| i.slowest_ns <= i.allowed_ns),
        clocks,
        inputs,
        cells: cells.collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn timing_is_met_when_every_clock_is_and_the_system_clock_is_there() {
        let report = |fmax: Value| json!({"fmax": fmax, "utilization": {"LC": {"used": 5, "available": 10}, "RAM": {"used": 0, "available": 2}}});
        let fast = json!({"clk": {"achieved": 120.0, "constraint": 99.0}, "osc_i": {"achieved": 300.0, "constraint": 12.0}});
        let good = attempt(&report(fast), 7, 99_000_000, 198_000_000).unwrap();
        assert!(good.is_met);
        assert_eq!((good.seed, good.cells.len()), (7, 1));
        assert!((good.margin() - 21.2).abs() < 0.1, "{}", good.margin());
        let slow = json!({"clk": {"achieved": 98.9, "constraint": 99.0}});
        assert!(
            !attempt(&report(slow), 1, 99_000_000, 198_000_000)
                .unwrap()
                .is_met
        );
        // A clock that nobody has constrained as fast as it will be is no timing.
        let other = json!({"clk": {"achieved": 120.0, "constraint": 12.0}});
        assert_eq!(attempt(&report(other), 1, 99_000_000, 198_000_000), None);
        assert_eq!(attempt(&json!({}), 1, 99_000_000, 198_000_000), None);
    }

    /// Catches two samplers of a line of which one sees it more than a sample later than the other.
    #[test]
    fn timing_is_not_met_when_an_input_is_far_from_its_register() {
        let report = |delays: [f64; 2]| {
            let path = delays.map(|delay| json!({"delay": delay}));
            let way = |from: &str, to: &str| json!({"from": from, "to": to, "path": path});
            json!({
                "fmax": {"clk": {"achieved": 120.0, "constraint": 99.0}},
                "critical_paths": [
                    {"from": "posedge clk", "to": "posedge clk", "path": [{"delay": 9.0}]},
                    {"from": "posedge clk", "to": NO_CLOCK, "path": [{"delay": 9.0}]},
                    way(NO_CLOCK, "negedge clk"),
                ],
            })
        };
        let at = |delays, input_hz| attempt(&report(delays), 1, 99_000_000, input_hz).unwrap();
        let near = at([2.0, 3.0], 198_000_000);
        assert!(near.is_met);
        assert!((near.inputs.unwrap().slowest_ns - 5.0).abs() < 1e-9);
        assert!(!at([2.0, 3.1], 198_000_000).is_met);
        assert!(at([2.0, 3.1], 99_000_000).is_met);
    }
}
