//! What has been proved, as text and data.

use super::tools::Answer;
use super::{property_of, Block};
use rtl_design::elaborate::properties::Begins;
use serde::Serialize;
use std::fmt;

/// Whether a property holds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// In every cycle, without bound.
    Proved,
    /// A run leads to where it does not.
    Violated {
        /// Cycles that it takes.
        after_cycles: usize,
    },
    /// There is a state in which it does not hold, and no short run leads there.
    NotProved,
    /// Another property does not hold, and this one may lean on it.
    Undecided,
    /// It says nothing of this block: the words say why.
    NotClaimed,
    /// It holds, and its condition is never met: it says nothing.
    Empty,
}

impl Verdict {
    /// Whether this is the property that does not hold.
    pub fn is_failure(&self) -> bool {
        matches!(self, Self::Violated { .. } | Self::NotProved | Self::Empty)
    }
}

impl Verdict {
    /// Of a property, after an answer in which it failed or did not.
    pub(super) fn of(answer: &Answer, has_failed: bool) -> Self {
        match (answer.failed.is_empty(), has_failed) {
            (true, _) => Self::Proved,
            (false, false) => Self::Undecided,
            (false, true) if answer.is_reached => Self::Violated {
                after_cycles: answer.cycles,
            },
            (false, true) => Self::NotProved,
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Proved => f.pad("proved"),
            Self::Violated { after_cycles } => f.pad(&format!("VIOLATED in cycle {after_cycles}")),
            Self::NotProved => f.pad("NOT PROVED"),
            Self::Undecided => f.pad("undecided"),
            Self::NotClaimed => f.pad("no claim"),
            Self::Empty => f.pad("EMPTY"),
        }
    }
}

/// Cycles of a run from the start values that is to meet a condition.
pub(super) const RUN_CYCLES: usize = 40;

/// How the condition of a property is met.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Met {
    /// By a run from the start values.
    Run,
    /// In a state that the proofs allow; it takes longer runs.
    State,
    /// Never.
    Never,
}

/// A property of a block.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The module that it is in.
    pub module: String,
    /// Its name.
    pub name: String,
    /// What it says.
    pub words: String,
    /// It holds whatever the registers begin with.
    pub from_any_state: bool,
    /// Assertions that it takes, lemmas among them.
    pub assertions: usize,
    /// Whether it holds.
    pub verdict: Verdict,
    /// How its condition is met; none where nobody looked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub met: Option<Met>,
    /// File with the counterexample.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trace: Option<String>,
}

/// A part of a card, proved as a whole.
#[derive(Clone, Debug, Serialize)]
pub struct PartReport {
    /// Its module.
    pub module: String,
    /// The inputs that the proof allows.
    pub inputs: String,
    /// Time for the properties that begin with the start values.
    pub start_seconds: f64,
    /// Time for those of any state.
    pub anywhere_seconds: f64,
    /// Its properties.
    pub rows: Vec<Row>,
}

/// A module of a card.
#[derive(Clone, Debug, Serialize)]
pub struct ModuleRow {
    /// Its name.
    pub module: String,
    /// The part that it is proved in; none: it is simulated only.
    pub part: Option<String>,
    /// Properties that it has.
    pub properties: usize,
}

impl fmt::Display for ModuleRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = match self.properties {
            0 => "none".into(),
            count => count.to_string(),
        };
        let part = match &self.part {
            Some(part) if *part == self.module => "a part",
            Some(part) => part,
            None => "no part: simulated only",
        };
        write!(f, "{:<44} {count:>10}  {part}", self.module)
    }
}

/// A card.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Its name.
    pub name: String,
    /// The programs that proved.
    pub provers: String,
    /// Its parts; those that are alike once.
    pub parts: Vec<PartReport>,
    /// Every module of it.
    pub modules: Vec<ModuleRow>,
}

impl Report {
    /// Whether every property holds.
    pub fn is_good(&self) -> bool {
        let mut rows = self.parts.iter().flat_map(|p| &p.rows);
        rows.all(|row| matches!(row.verdict, Verdict::Proved | Verdict::NotClaimed))
    }
}

/// The rows of properties that begin alike.
pub(super) fn rows(blocks: &[Block], begins: Begins, answer: &Answer) -> Vec<Row> {
    let failed: Vec<(&str, &str)> = answer
        .failed
        .iter()
        .filter_map(|path| property_of(blocks, path))
        .map(|(block, property)| (block.module.name.as_str(), property.name.as_str()))
        .collect();
    let verdict = |module: &str, name: &str| Verdict::of(answer, failed.contains(&(module, name)));
    let mut rows = vec![];
    for block in blocks {
        for property in block.properties.iter().filter(|p| p.begins == begins) {
            let verdict = match property.not_claimed(block.module) {
                None => verdict(&block.module.name, &property.name),
                Some(_) => Verdict::NotClaimed,
            };
            rows.push(Row {
                module: block.module.name.clone(),
                name: property.name.clone(),
                words: property.whole_words(),
                from_any_state: begins == Begins::Anywhere,
                assertions: property.assertions,
                verdict,
                met: None,
                trace: None,
            });
        }
    }
    rows
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for part in &self.parts {
            writeln!(f, "{}: {}", part.module, part.inputs)?;
            for (any, from, seconds) in [
                (false, "the start values, without bound", part.start_seconds),
                (true, "any contents of the registers", part.anywhere_seconds),
            ] {
                let rows = part.rows.iter().filter(|r| r.from_any_state == any);
                let rows: Vec<&Row> = rows.collect();
                let noun = match rows.len() {
                    0 => continue,
                    1 => "property",
                    _ => "properties",
                };
                let count = rows.len();
                writeln!(f, "\n  From {from}: {count} {noun}, {seconds:.1} s")?;
                for row in rows {
                    writeln!(f, "    {:<22} {:<10}  {}", row.name, row.verdict, row.words)?;
                    if row.verdict == Verdict::Empty {
                        writeln!(f, "    {:<22} no run of {} cycles meets its condition, and no state that the proofs allow", "", RUN_CYCLES)?;
                    }
                    if let Some(trace) = &row.trace {
                        writeln!(f, "    {:<22} counterexample: {trace}", "")?;
                    }
                }
            }
            let met = |met: Met| part.rows.iter().filter(move |r| r.met == Some(met));
            let run = met(Met::Run).count();
            let states: Vec<&str> = met(Met::State).map(|r| r.name.as_str()).collect();
            if run + states.len() > 0 {
                writeln!(
                    f,
                    "\n  Conditions: {run} met by runs of {RUN_CYCLES} cycles"
                )?;
            }
            if !states.is_empty() {
                writeln!(
                    f,
                    "              met in a state that the proofs allow, which no run may reach: {}",
                    states.join(", ")
                )?;
            }
            writeln!(f)?;
        }
        writeln!(f, "{:<44} {:>10}  proved in", "module", "properties")?;
        for module in &self.modules {
            writeln!(f, "{module}")?;
        }
        writeln!(f, "\n{}", self.provers)
    }
}
