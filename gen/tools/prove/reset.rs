//! That nothing unknown is left in a channel after a reset: whatever its registers held, a cycle of it gives each a level, or what comes in.

use super::netlist::{Kind, Netlist, Register, HIGH, LOW};
use super::report::{Row, Verdict};
use super::tools;
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use rtl_design::elaborate::{Direction, Module};
use rtl_design::verilog::emitted_name;
use std::collections::BTreeSet;
use std::path::Path;

/// Its name in tables.
pub const NAME: &str = "known_after_reset";
const WORDS: &str =
    "After a cycle of reset no register has anything of what it held: nothing unknown is left.";
const RESET: &str = "reset";
/// A register that yosys has made.
const NAMELESS: &str = "a register without a name";

/// The row of a part.
pub(super) fn row(folder: &Path, files: &[Artifact], module: &Module) -> Result<Row, CommandError> {
    let names: Vec<&str> = files.iter().map(|f| f.path.as_str()).collect();
    let text = tools::gates_without_memories(folder, &names, &module.name)?;
    let netlist = Netlist::read(&text, &module.name).map_err(|what| tools::not_read(&what))?;
    let left = left(&netlist, module).map_err(|what| tools::not_read(&what))?;
    let words = match left.first() {
        None => WORDS.into(),
        Some(first) => format!("{WORDS} Of {first}, first of {}, something is.", left.len()),
    };
    Ok(Row {
        module: module.name.clone(),
        name: NAME.into(),
        words,
        from_any_state: true,
        assertions: 1,
        verdict: match left.is_empty() {
            true => Verdict::Proved,
            false => Verdict::Violated { after_cycles: 1 },
        },
        met: None,
        trace: None,
    })
}

/// What is known of a net.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level {
    Low,
    High,
    /// What comes in decides.
    In,
    /// What a register held, or a memory holds, may decide.
    Held,
}

impl Level {
    fn is_known(self) -> bool {
        matches!(self, Self::Low | Self::High)
    }

    /// Of a gate in which all of these decide.
    fn of(all: &[Self]) -> Self {
        match all.contains(&Self::Held) {
            true => Self::Held,
            false => Self::In,
        }
    }
}

fn level(kind: Kind, [a, b, c]: [Level; 3]) -> Level {
    use Level::{High, Low};
    match (kind, a, b) {
        (Kind::Not, Low, _) => High,
        (Kind::Not, High, _) => Low,
        (Kind::Not, ..) => a,
        (Kind::And, Low, _) | (Kind::And, _, Low) => Low,
        (Kind::And, High, other) | (Kind::And, other, High) => other,
        (Kind::Or, High, _) | (Kind::Or, _, High) => High,
        (Kind::Or, Low, other) | (Kind::Or, other, Low) => other,
        (Kind::Xor, Low, other) | (Kind::Xor, other, Low) => other,
        (Kind::Xor, High, High) => Low,
        (Kind::Mux, ..) => match c {
            Low => a,
            High => b,
            _ if a == b && a.is_known() => a,
            _ => Level::of(&[a, b, c]),
        },
        _ => Level::of(&[a, b]),
    }
}

/// The registers that have something of what was held after a cycle of reset, by name.
fn left<'a>(netlist: &'a Netlist, module: &Module) -> Result<Vec<&'a str>, String> {
    let mut levels = vec![Level::Held; netlist.net_count];
    (levels[LOW], levels[HIGH]) = (Level::Low, Level::High);
    let inputs = module.ports.iter();
    for port in inputs.filter(|port| port.direction != Direction::Output) {
        let name = emitted_name(&module.nets[port.net].name);
        let nets = netlist.names.get(&name);
        for net in nets.ok_or_else(|| format!("no {name}"))? {
            levels[*net] = match name.as_str() {
                RESET => Level::High,
                _ => Level::In,
            };
        }
    }
    for gate in &netlist.gates {
        levels[gate.output] = level(gate.kind, gate.inputs.map(|net| levels[net]));
    }
    let is_left = |r: &&Register| levels[r.input] == Level::Held;
    // Names with a `$` are yosys's own.
    let name = |register: &Register| {
        let mut names = netlist.names.iter().filter(|(name, _)| !name.contains('$'));
        let found = names.find(|(_, nets)| nets.contains(&register.output));
        found.map_or(NAMELESS, |(name, _)| name.as_str())
    };
    let left: BTreeSet<&str> = netlist.registers.iter().filter(is_left).map(name).collect();
    Ok(left.into_iter().collect())
}
