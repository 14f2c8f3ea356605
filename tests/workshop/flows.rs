//! A card's Verilog through every flow of synthesis that yosys has: what comes out, and what it complains about.

use endat_config::Configuration;
use endat_console::artifact::{self, Artifact};
use endat_console::error::CommandError;
use endat_tools::area::{cells_of, run_good, version, YOSYS};
use endat_tools::readers::is_core;
use endat_tools::scratch;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// A flow: its name, and the yosys command without the top module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flow {
    /// Short name.
    pub name: &'static str,
    /// The yosys command; the top module is added.
    pub synth: &'static str,
    /// Registers of its devices have start values.
    pub starts: bool,
}

const fn flow(name: &'static str, synth: &'static str) -> Flow {
    Flow {
        name,
        synth,
        starts: true,
    }
}

/// All flows of yosys 0.70 for FPGAs but one: mapping for PolarPro 3 (`synth_quicklogic -family pp3`) needs more stack than WebAssembly has.
pub const FLOWS: [Flow; 13] = [
    flow("xc6s", "synth_xilinx -family xc6s"),
    flow("xc7", "synth_xilinx -family xc7"),
    flow("ecp5", "synth_ecp5"),
    flow("ice40", "synth_ice40"),
    flow("gowin", "synth_gowin"),
    flow("nexus", "synth_nexus"),
    flow("machxo2", "synth_lattice -family xo2"),
    flow("cyclonev", "synth_intel_alm -family cyclonev"),
    flow("efinix", "synth_efinix"),
    flow("qlf", "synth_quicklogic -family qlf_k6n10f"),
    flow("gatemate", "synth_gatemate"),
    flow("anlogic", "synth_anlogic"),
    Flow {
        starts: false,
        ..flow("polarfire", "synth_microchip -family polarfire")
    },
];

/// What flows that ask for it are told, in ps.
const CLOCK_PS: u32 = 10_000;
/// Most kinds of cells that a row names.
const KINDS: usize = 4;

/// What came of a flow.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Flowed {
    /// Name of the flow.
    pub flow: &'static str,
    /// Its yosys command.
    pub synth: &'static str,
    /// Cells of each kind.
    pub cells: BTreeMap<String, u64>,
    /// What yosys complains about, but for its own files.
    pub warnings: Vec<String>,
    /// Kinds of cells that the flow has left as no device has them, and latches.
    pub wrong: Vec<String>,
}

impl Flowed {
    /// What is to be complained about, a line each.
    pub fn complaints(&self) -> Vec<String> {
        let wrong = self.wrong.iter().map(|kind| format!("{kind} is left"));
        let all = self.warnings.iter().cloned().chain(wrong);
        all.map(|what| format!("{}: {what}", self.flow)).collect()
    }

    /// The kinds that there are most of.
    fn most(&self) -> String {
        let mut cells: Vec<_> = self.cells.iter().collect();
        cells.sort_by_key(|(name, count)| (std::cmp::Reverse(**count), (*name).clone()));
        let cells = cells.iter().take(KINDS);
        let cells = cells.map(|(name, count)| format!("{name} {count}"));
        cells.collect::<Vec<_>>().join(", ")
    }
}

/// All flows of one card.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Flows {
    /// The tool, as it tells its version.
    pub tool: String,
    /// One by one.
    pub flows: Vec<Flowed>,
}

impl Flows {
    /// What is to be complained about, a line each.
    pub fn complaints(&self) -> Vec<String> {
        self.flows.iter().flat_map(Flowed::complaints).collect()
    }
}

impl fmt::Display for Flows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "| flow | command | most of its cells | warnings |")?;
        writeln!(f, "|---|---|---|---|")?;
        for flowed in &self.flows {
            writeln!(
                f,
                "| {} | `{}` | {} | {} |",
                flowed.flow,
                flowed.synth,
                flowed.most(),
                flowed.complaints().len()
            )?;
        }
        Ok(())
    }
}

/// A complaint of yosys about what it was given; none of a line that says something else, or complains about a file of its own.
fn warning(line: &str) -> Option<String> {
    let (before, text) = line.split_once("Warning: ")?;
    let is_own = before.starts_with("/share/") || before.contains("/share/yosys/");
    (!is_own).then(|| format!("{before}{}", text.trim()))
}

/// Cells of these names are none of a device, or are latches.
fn is_wrong(kind: &str) -> bool {
    // A flow for VPR ends with tables of this name.
    let is_unmapped = kind.starts_with('$') && kind != "$lut";
    is_unmapped || kind.to_ascii_uppercase().contains("LATCH") || kind.starts_with("LD")
}

/// Puts the module `top` of these files through a flow.
pub fn through(files: &[Artifact], top: &str, flow: Flow) -> Result<Flowed, CommandError> {
    let scratch = scratch::folder()?;
    let folder = scratch.path();
    artifact::write(folder, files, scratch::REMEDY)?;
    let mut names: Vec<&str> = files.iter().map(|f| f.path.as_str()).collect();
    names.sort_unstable();
    // One flow wants to be told a clock.
    let script = format!(
        "read_verilog {}; scratchpad -set abc9.D {CLOCK_PS}; {} -top {top}; tee -q -o stat.json stat -json",
        names.join(" "),
        flow.synth
    );
    let said = run_good(YOSYS, folder, &["-q", "-p", &script])?.text();
    let mut cells = cells_of(&scratch::read(&folder.join("stat.json"))?)?;
    // What yosys keeps for the names of scopes is no logic.
    cells.remove("$scopeinfo");
    Ok(Flowed {
        flow: flow.name,
        synth: flow.synth,
        warnings: said.lines().filter_map(warning).collect(),
        wrong: cells
            .keys()
            .filter(|kind| is_wrong(kind))
            .cloned()
            .collect(),
        cells,
    })
}

/// Flows of these names, all if there are none; an error for a name that is none.
pub fn named(names: &[String]) -> Result<Vec<Flow>, CommandError> {
    let one = |name: &String| {
        let found = FLOWS.iter().find(|flow| flow.name == name);
        found.copied().ok_or_else(|| {
            let known = FLOWS.map(|flow| flow.name).join(", ");
            CommandError::input(format!(
                "--only = {name:?}: no such flow; known flows: {known}"
            ))
        })
    };
    match names {
        [] => Ok(FLOWS.to_vec()),
        names => names.iter().map(one).collect(),
    }
}

/// Name and core of a configuration for a flow: without start values where its devices have none.
pub fn core(
    configuration: &Configuration,
    flow: Flow,
) -> Result<(String, Vec<Artifact>), CommandError> {
    let (name, files) = match configuration {
        Configuration::Card(card) => {
            let mut card = card.clone();
            card.card.initial_values &= flow.starts;
            (card.name.clone(), endat_emit::emit(&card)?)
        }
        Configuration::Receiver(receiver) => {
            let mut receiver = receiver.clone();
            receiver.initial_values &= flow.starts;
            (
                receiver.name.clone(),
                endat_emit::protocols::t_format::emit(&receiver)?,
            )
        }
    };
    Ok((name, files.into_iter().filter(is_core).collect()))
}

/// Puts a card through flows; `begin` is told each.
pub fn all(
    configuration: &Configuration,
    flows: &[Flow],
    begin: &dyn Fn(&str),
) -> Result<Flows, CommandError> {
    let one = |flow: &Flow| {
        let (name, files) = core(configuration, *flow)?;
        begin(&format!("{name}: {}", flow.name));
        through(&files, &name, *flow)
    };
    Ok(Flows {
        tool: version()?,
        flows: flows.iter().map(one).collect::<Result<_, _>>()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn complaints_about_what_was_given_count() {
        let own = "/share/xilinx/brams_xc3sda_map.v:221: Warning: Range select [3:2] out of bounds";
        assert_eq!(warning(own), None);
        assert_eq!(warning("Warnings: 2 unique messages, 2 total"), None);
        let given = "card.v:7: Warning: Range select [3:2] out of bounds";
        let told = "card.v:7: Range select [3:2] out of bounds".to_owned();
        assert_eq!(warning(given), Some(told));
        assert_eq!(
            warning("Warning: wire is undriven"),
            Some("wire is undriven".into())
        );
    }

    #[test]
    fn what_no_device_has_is_wrong() {
        for kind in ["$_DLATCH_P_", "$mem_v2", "LDCE", "TRELLIS_LATCH"] {
            assert!(is_wrong(kind), "{kind}");
        }
        for kind in ["LUT4", "$lut", "FDRE", "MISTRAL_FF"] {
            assert!(!is_wrong(kind), "{kind}");
        }
    }
}
