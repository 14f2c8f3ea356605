//! Worst path of a placed design: block, signal and line of the emitted text for each hop.
//!
//! nextpnr reports nets under names that synthesis has made longer, and one net has many names after flattening. The netlist of yosys
//! gives the names that the emitted text declares for the same bit.

use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use serde::Serialize;
use serde_json::Value;
use std::fmt;

/// Instance of the design in the harness.
const INSTANCE: &str = "dut.";
/// Block of the signals that belong to the harness.
const HARNESS: &str = "harness";
/// How the parts begin that synthesis and packing append to the name of a signal.
const APPENDED: [&str; 7] = [
    "_SB_", "_LUT4", "_TRELLIS", "_CCU2", "_PFUMX", "_L6MUX", "$",
];

/// A signal on the path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Hop {
    /// Delay from the clock edge to the output that drives the signal; for the last one to its register, with set-up time; in ns.
    pub at_ns: f64,
    /// Instance path; empty in the top module.
    pub block: String,
    /// Its name in the emitted text; for a net that only synthesis has, the signal that it was named after.
    pub signal: String,
    /// File and line of the emitted text, with its comments; none if the emitted text does not declare the signal.
    pub line: Option<String>,
    /// The text of that line.
    pub text: Option<String>,
}

/// The slowest path between two registers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CriticalPath {
    /// Seed of the placer.
    pub seed: u32,
    /// Delay of the whole path in ns.
    pub total_ns: f64,
    /// Its signals; the last one is the register at its end.
    pub hops: Vec<Hop>,
}

/// A name without what synthesis appended, as block and signal; none for a net without a name from the emitted text.
fn named(name: &str) -> Option<(&str, &str)> {
    let (path, last) = match name.rfind('.') {
        Some(dot) => name.split_at(dot + 1),
        None => ("", name),
    };
    let ends = APPENDED.iter().filter_map(|mark| last.find(mark));
    let end = ends.min().unwrap_or(last.len());
    let signal = last[..end].split('[').next().unwrap_or_default();
    if signal.is_empty() {
        return None;
    }
    let block = match path.strip_prefix(INSTANCE) {
        Some(path) => path.trim_end_matches('.'),
        None => HARNESS,
    };
    Some((block, signal))
}

/// Line number in the emitted text of a line of the text that yosys reads, without comment lines; both count from 1.
fn with_comments(text: &str, line: usize) -> Option<usize> {
    let is_logic = |(_, l): &(usize, &str)| !super::is_comment(l);
    let mut logic = text.lines().enumerate().filter(is_logic);
    Some(logic.nth(line.checked_sub(1)?)?.0 + 1)
}

/// Right side of an assignment to this signal or to one of its bits, and whether the assignment is clocked.
fn driven_by<'a>(line: &'a str, signal: &str) -> Option<(&'a str, bool)> {
    let line = line.trim_start();
    let line = line.strip_prefix("assign ").unwrap_or(line);
    let rest = line.strip_prefix(signal)?;
    let rest = match rest.strip_prefix('[') {
        Some(index) => index.split_once(']')?.1,
        None => rest,
    };
    let rest = rest.trim_start();
    let (value, is_clocked) = match rest.strip_prefix("<=") {
        Some(value) => (value, true),
        None => (rest.strip_prefix("= ")?, false),
    };
    Some((value.trim().trim_end_matches(';'), is_clocked))
}

/// Line of the emitted text that gives a signal its value: the first that is neither a reset value nor a copy of itself.
fn driver(text: &str, signal: &str) -> Option<usize> {
    let next = format!("{signal}_next");
    let mut first = None;
    for (index, line) in text.lines().enumerate() {
        let assignment = driven_by(line, signal).or_else(|| driven_by(line, &next));
        let Some((value, is_clocked)) = assignment else {
            continue;
        };
        let is_copy = value == signal || value == next;
        let is_reset = is_clocked && value.starts_with(|c: char| c.is_ascii_digit());
        if !is_copy && !is_reset {
            return Some(index + 1);
        }
        first = first.or(Some(index + 1));
    }
    first
}

/// What the tools have about a design: nets of the netlist, and the emitted files.
struct Design<'a> {
    nets: &'a serde_json::Map<String, Value>,
    files: &'a [Artifact],
}

/// A line of the emitted text.
struct Place<'a> {
    file: &'a str,
    line: usize,
    text: &'a str,
    rank: Rank,
}

/// How much a line says of a signal, the best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    /// It gives the signal its value, in a clocked assignment or by an operation.
    Value,
    /// It hands on the value of another name.
    Copy,
    /// It only declares the signal.
    Declaration,
}

impl Rank {
    /// Rank of the line of an assignment.
    fn of(line: &str) -> Self {
        let value = line.split_once('=').map_or("", |(_, value)| value);
        let value = value.trim().trim_end_matches(';');
        let is_name = value.chars().all(|c| c.is_alphanumeric() || c == '_');
        match is_name && !line.contains("<=") {
            true => Self::Copy,
            false => Self::Value,
        }
    }
}

impl<'a> Design<'a> {
    /// Where the signal of this net is driven, or else declared.
    fn place(&self, net: &str, signal: &str) -> Option<Place<'a>> {
        let source = self.nets.get(net)?["attributes"]["src"].as_str()?;
        let at = source.split('|').find_map(|part| {
            let (path, position) = part.split_once(':')?;
            let file = self.files.iter().find(|file| file.path == path)?;
            Some((file, position.split('.').next()?.parse().ok()?))
        });
        let (file, declared): (_, usize) = at?;
        let driver = driver(&file.text, signal);
        let line = driver.or_else(|| with_comments(&file.text, declared))?;
        let text = file.text.lines().nth(line - 1)?.trim();
        Some(Place {
            file: &file.path,
            line,
            text,
            rank: driver.map_or(Rank::Declaration, |_| Rank::of(text)),
        })
    }

    /// Names in the emitted text of the bit that a net of nextpnr is.
    fn declared_names(&self, net: &str) -> Vec<&'a str> {
        let indexed = net
            .strip_suffix(']')
            .and_then(|net| net.rsplit_once('['))
            .and_then(|(name, index)| Some((name, index.parse::<usize>().ok()?)));
        let name = indexed.map_or(net, |(name, _)| name);
        let bits = self.nets.get(name).and_then(|n| n["bits"].as_array());
        // Constant bits are text.
        let bit = bits.and_then(|bits| match indexed {
            Some((_, index)) => bits.get(index).filter(|bit| bit.is_u64()),
            None => bits.iter().find(|bit| bit.is_u64()),
        });
        let is_it = |value: &Value| {
            let bits = value["bits"].as_array();
            value["attributes"]["hdlname"].is_string()
                && bit.is_some_and(|bit| bits.is_some_and(|b| b.contains(bit)))
        };
        let nets = self.nets.iter().filter(|(_, value)| is_it(value));
        nets.map(|(name, _)| name.as_str()).collect()
    }

    /// Block, signal and line of a net, or of a register by the name of its cell.
    fn hop(&self, at_ns: f64, net: &str) -> Option<Hop> {
        let named_after = named(net);
        let mut names = self.declared_names(net);
        if let (true, Some((block, signal))) = (names.is_empty(), named_after) {
            names = self.declared_names(&flat(block, signal));
        }
        let mut places: Vec<_> = names
            .into_iter()
            .filter_map(|name| {
                let (block, signal) = named(name)?;
                Some((block, signal, self.place(name, signal)))
            })
            .collect();
        // The names of the same bit at the ports of other blocks have no driving line there, or only hand it on.
        places.sort_by_key(|(.., place)| place.as_ref().map_or(Rank::Declaration, |p| p.rank));
        let (block, signal, place) = match places.into_iter().next() {
            Some(found) => found,
            None => {
                let (block, signal) = named_after?;
                (block, signal, self.place(&flat(block, signal), signal))
            }
        };
        Some(Hop {
            at_ns,
            block: block.to_owned(),
            signal: signal.to_owned(),
            line: place.as_ref().map(|p| format!("{}:{}", p.file, p.line)),
            text: place.map(|p| p.text.to_owned()),
        })
    }
}

/// Name of a signal in the netlist.
fn flat(block: &str, signal: &str) -> String {
    match block {
        HARNESS => signal.to_owned(),
        "" => format!("{INSTANCE}{signal}"),
        block => format!("{INSTANCE}{block}.{signal}"),
    }
}

fn delay_ns(path: &Value) -> f64 {
    let steps = path["path"].as_array().into_iter().flatten();
    steps.filter_map(|step| step["delay"].as_f64()).sum()
}

/// The slowest path between registers in a report of nextpnr; paths from and to pins are not those of the core.
fn slowest(report: &Value) -> Option<&Value> {
    let is_inside = |path: &&Value| ["from", "to"].iter().all(|end| path[end] != "<async>");
    let paths = report["critical_paths"].as_array()?;
    paths
        .iter()
        .filter(is_inside)
        .max_by(|a, b| delay_ns(a).total_cmp(&delay_ns(b)))
}

/// The worst path of a report, with the lines of the emitted files.
pub(super) fn critical_path(
    seed: u32,
    report: &Value,
    netlist: &Value,
    files: &[Artifact],
) -> Result<CriticalPath, CommandError> {
    let fault = |what: &str| CommandError::fault("report of nextpnr", &what);
    let nets = netlist["modules"][HARNESS]["netnames"].as_object();
    let nets = nets.ok_or_else(|| fault("the netlist has no nets"))?;
    let design = Design { nets, files };
    let path = slowest(report).ok_or_else(|| fault("it has no path between registers"))?;
    let steps = path["path"].as_array().into_iter().flatten();
    let mut at_ns = 0.0;
    let mut hops: Vec<Hop> = vec![];
    let mut add = |hop: Option<Hop>| {
        let hop = hop.filter(|new| {
            let is_same = |last: &Hop| (&last.block, &last.signal) == (&new.block, &new.signal);
            !hops.last().is_some_and(is_same)
        });
        hops.extend(hop);
    };
    let mut end = "";
    for step in steps {
        if step["type"] == "routing" {
            add(design.hop(at_ns, step["net"].as_str().unwrap_or_default()));
        }
        at_ns += step["delay"].as_f64().unwrap_or(0.0);
        end = step["to"]["cell"].as_str().unwrap_or_default();
    }
    add(design.hop(at_ns, end));
    Ok(CriticalPath {
        seed,
        total_ns: at_ns,
        hops,
    })
}

impl fmt::Display for CriticalPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "  worst path with seed {}: {:.2} ns",
            self.seed, self.total_ns
        )?;
        let width = |of: fn(&Hop) -> usize| self.hops.iter().map(of).max().unwrap_or(0);
        let blocks = width(|hop| hop.block.len().max(1));
        let signals = width(|hop| hop.signal.len());
        let lines = width(|hop| hop.line.as_ref().map_or(1, String::len));
        for hop in &self.hops {
            let block = match hop.block.as_str() {
                "" => "-",
                block => block,
            };
            let row = format!(
                "  {:>7.2}  {block:<blocks$}  {:<signals$}  {:<lines$}  {}",
                hop.at_ns,
                hop.signal,
                hop.line.as_deref().unwrap_or("-"),
                hop.text.as_deref().unwrap_or_default(),
            );
            writeln!(f, "{}", row.trim_end())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
