//! That nothing unknown is left in a channel after a reset: with all registers and inputs unknown, a cycle of reset gives each register a level.

use super::netlist::{Kind, Netlist, Register, HIGH, LOW};
use super::report::{Row, Verdict};
use super::tools;
use crate::artifact::Artifact;
use crate::error::GenError;
use rtl_design::elaborate::Module;
use std::path::Path;

/// Its name in tables.
pub const NAME: &str = "known_after_reset";
const WORDS: &str = "After a cycle of reset no register has anything of what it held, or of what came in: nothing unknown is left.";
const RESET: &str = "reset";

/// The row of a part.
pub(super) fn row(folder: &Path, files: &[Artifact], module: &Module) -> Result<Row, GenError> {
    let names: Vec<&str> = files.iter().map(|f| f.path.as_str()).collect();
    let text = tools::gates_without_memories(folder, &names, &module.name)?;
    let netlist = Netlist::read(&text, &module.name).map_err(|what| tools::not_read(&what))?;
    let left = left(&netlist).map_err(|what| tools::not_read(&what))?;
    Ok(Row {
        module: module.name.clone(),
        name: NAME.into(),
        words: WORDS.into(),
        from_any_state: true,
        assertions: netlist.registers.len(),
        verdict: match left {
            0 => Verdict::Proved,
            _ => Verdict::Violated { after_cycles: 1 },
        },
        trace: None,
    })
}

/// How many bits of registers have no level after a cycle of reset.
fn left(netlist: &Netlist) -> Result<usize, String> {
    let mut levels: Vec<Option<bool>> = vec![None; netlist.net_count];
    (levels[LOW], levels[HIGH]) = (Some(false), Some(true));
    let reset = netlist.names.get(RESET).and_then(|nets| nets.first());
    levels[*reset.ok_or("no reset")?] = Some(true);
    for gate in &netlist.gates {
        let [a, b, c] = gate.inputs.map(|net| levels[net]);
        levels[gate.output] = match (gate.kind, a, b) {
            (Kind::Not, a, _) => a.map(|a| !a),
            (Kind::And, Some(false), _) | (Kind::And, _, Some(false)) => Some(false),
            (Kind::And, Some(true), Some(true)) => Some(true),
            (Kind::Or, Some(true), _) | (Kind::Or, _, Some(true)) => Some(true),
            (Kind::Or, Some(false), Some(false)) => Some(false),
            (Kind::Xor, Some(a), Some(b)) => Some(a != b),
            (Kind::Mux, a, b) => match c {
                Some(false) => a,
                Some(true) => b,
                None if a == b => a,
                None => None,
            },
            _ => None,
        };
    }
    let is_left = |r: &&Register| levels[r.input].is_none();
    Ok(netlist.registers.iter().filter(is_left).count())
}
