//! Shmoo maps: a channel with its encoder and line, run under every pair of conditions, and the fate of its frames.

mod axis;
mod judge;
mod published;
#[cfg(test)]
mod tests;

pub use axis::{Axis, Conditions, Phase, Quantity, ReceiverKind};
pub use judge::{Fate, Tally};
pub use published::{Published, PUBLISHED};

use crate::campaign::{self, CampaignError, Case, RunOptions};
use endat_draw::decimal;
use std::fmt::Write as _;

/// Plan of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Common conditions.
    pub conditions: Conditions,
    /// Channels in each cell, each with other random numbers.
    pub runs: usize,
    /// Frames of each channel after the one that measures the delay.
    pub frames: usize,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// A map.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Plan.
    pub plan: Plan,
    /// The cells, line by line from the first value of y on.
    pub cells: Vec<Tally>,
}

/// Decimals of the values of an axis.
pub const DECIMALS: usize = 4;
/// Start of a map's table, after the names of its axes.
const COLUMNS: &str = "fate,frames,good,margin_percent";

impl Plan {
    /// Number of channels in all cells.
    pub fn channels(&self) -> usize {
        self.x.values.len() * self.y.values.len() * self.runs
    }

    /// Conditions of the cells, in order.
    fn conditions(&self) -> impl Iterator<Item = Conditions> + '_ {
        self.y.values.iter().flat_map(move |y| {
            self.x.values.iter().map(move |x| {
                let mut conditions = self.conditions;
                conditions.set(self.x.quantity, *x);
                conditions.set(self.y.quantity, *y);
                conditions
            })
        })
    }

    /// Every channel of the map, cell by cell.
    fn cases(&self) -> Vec<Case> {
        let mut cases = Vec::new();
        for conditions in self.conditions() {
            for _ in 0..self.runs {
                let seed = self.seed.wrapping_mul(0x9E37_79B9) + cases.len() as u64;
                cases.push(conditions.case(self.frames, seed));
            }
        }
        cases
    }

    /// Runs the map on all processors; `progress` receives the number of finished channels.
    ///
    /// # Errors
    /// If the channel cannot be elaborated: a bug in this program.
    pub fn run(
        &self,
        threads: usize,
        progress: impl Fn(usize) + Sync,
    ) -> Result<Map, CampaignError> {
        let cases = self.cases();
        let options = RunOptions {
            threads,
            ..RunOptions::default()
        };
        let outcomes = campaign::run(&cases, options, judge::judge, progress)?;
        let cells = outcomes.chunks(self.runs).map(|runs| {
            let mut sum = Tally::default();
            runs.iter().for_each(|run| sum.add(&run.verdict));
            sum
        });
        Ok(Map {
            plan: self.clone(),
            cells: cells.collect(),
        })
    }
}

impl Map {
    /// The cell at these positions of the axes.
    pub fn cell(&self, x: usize, y: usize) -> &Tally {
        &self.cells[y * self.plan.x.values.len() + x]
    }

    /// Cells in which every frame was good.
    pub fn passed(&self) -> usize {
        self.count(Fate::Good)
    }

    /// Number of cells with this fate.
    pub fn count(&self, fate: Fate) -> usize {
        self.cells.iter().filter(|c| c.fate() == fate).count()
    }

    /// One line for each cell.
    pub fn csv(&self) -> String {
        let (x, y) = (&self.plan.x, &self.plan.y);
        let counted = Fate::ALL.iter().filter(|fate| **fate != Fate::Good);
        let names: Vec<_> = counted.clone().map(|fate| fate.column()).collect();
        let mut text = format!(
            "{},{},{COLUMNS},{}\n",
            x.quantity.name(),
            y.quantity.name(),
            names.join(",")
        );
        for (row, y) in y.values.iter().enumerate() {
            for (column, x) in x.values.iter().enumerate() {
                let cell = self.cell(column, row);
                let margin = cell.margin().map(|m| format!("{:.1}", 100.0 * m));
                let _ = write!(
                    text,
                    "{},{},{},{},{},{}",
                    decimal(*x, DECIMALS),
                    decimal(*y, DECIMALS),
                    cell.fate().column(),
                    cell.frames(),
                    cell.count(Fate::Good),
                    margin.unwrap_or_default()
                );
                for fate in counted.clone() {
                    let _ = write!(text, ",{}", cell.count(*fate));
                }
                text.push('\n');
            }
        }
        text
    }
}

/// True if a file with this start may be the table of a map.
pub fn is_table(head: &str) -> bool {
    let first = head.lines().next().unwrap_or_default();
    let rest = first.split_once(',').and_then(|(_, r)| r.split_once(','));
    rest.is_some_and(|(_, columns)| columns.starts_with(COLUMNS))
}
