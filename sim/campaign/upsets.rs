//! Every flip-flop inverted at every time of a frame: the effects for the reader and the encoder, and the number of triggers
//! until everything is good again. A case is one flip in one frame.

use super::port::{Conditions, Mishap, Port, Ready};
use super::work::{digest, hash, Campaign};
use super::{CampaignError, Row, Tally};
use crate::rng::Rng;
use rtl_design::engine::Lanes;
use std::ops::Range;

/// Selection of flips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Draw {
    /// Every flip-flop, at this many times of each kind of frame: one at random in each equal part of the frame.
    Grid {
        /// Number of times.
        moments: u64,
    },
    /// A number of random flips.
    Random {
        /// Number of cases.
        cases: u64,
    },
}

/// The flip-flops of a design.
pub struct Flops {
    /// Register and bit of each.
    pub bits: Vec<(usize, usize)>,
    /// Hierarchical name of its register.
    pub names: Vec<String>,
}

/// True if a hierarchical name begins with one of the comma-separated names in `only`; an empty list selects all.
pub fn is_asked(name: &str, only: &str) -> bool {
    let mut begins = only
        .split(',')
        .map(str::trim)
        .filter(|begin| !begin.is_empty());
    only.is_empty() || begins.any(|begin| name.starts_with(begin))
}

impl Flops {
    /// Flip-flops of registers [selected by name](is_asked).
    pub fn new(engine: &Lanes, only: &str) -> Self {
        Self::filtered(engine, |name| is_asked(name, only))
    }

    /// Flip-flops of registers selected by a predicate.
    pub fn filtered(engine: &Lanes, choose: impl Fn(&str) -> bool) -> Self {
        let all: Vec<&str> = engine.nets().collect();
        let (mut bits, mut names) = (vec![], vec![]);
        for register in engine.registers().filter(|r| choose(all[*r])) {
            for bit in 0..engine.width_bits(register) {
                bits.push((register, bit));
                names.push(all[register].to_owned());
            }
        }
        Self { bits, names }
    }

    /// Number of cases.
    pub fn cases(&self, draw: Draw) -> u64 {
        match draw {
            Draw::Grid { moments } => self.bits.len() as u64 * moments,
            Draw::Random { .. } if self.bits.is_empty() => 0,
            Draw::Random { cases } => cases,
        }
    }

    /// The case with this number: flip-flop (an index), and cycle within `span`. `label` distinguishes groups.
    pub fn case(&self, draw: Draw, seed: u64, label: &str, span: u64, number: u64) -> (usize, u64) {
        match draw {
            Draw::Grid { moments } => {
                let (index, moment) = ((number / moments) as usize, number % moments);
                // The time depends on the flip-flop only: it is the same in a campaign with few registers.
                let what = format!("{label} {} {}", self.names[index], self.bits[index].1);
                let mut rng = Rng::new(hash(&what) ^ seed ^ moment.rotate_left(32));
                let from = span * moment / moments;
                let to = span * (moment + 1) / moments;
                (index, rng.in_range(from, to.max(from + 1) - 1))
            }
            Draw::Random { .. } => {
                let mut rng = Rng::new(Rng::new(hash(label) ^ seed).next_u64() ^ number);
                let index = rng.in_range(0, self.bits.len() as u64 - 1) as usize;
                (index, rng.in_range(0, span - 1))
            }
        }
    }
}

/// Flip-flops of one port in one kind of frame.
struct Group {
    ready: Ready,
    flops: Flops,
    cases: u64,
}

/// The campaign.
pub struct Upsets {
    groups: Vec<Group>,
    draw: Draw,
    seed: u64,
    digest: u64,
}

impl Upsets {
    /// Upsets of these ports, in registers [selected by name](is_asked).
    ///
    /// # Errors
    /// If the design of a port cannot be elaborated.
    pub fn new(ports: &[Port], draw: Draw, seed: u64, only: &str) -> Result<Self, CampaignError> {
        let (mut groups, mut digested) = (vec![], 0);
        for port in ports {
            digested ^= digest(&port.design()?);
            let engine = port.engine()?;
            for kind in port.kinds() {
                groups.push(Group {
                    ready: Ready::new(*port, *kind, Conditions::default(), engine.clone()),
                    flops: Flops::new(&engine, only),
                    cases: 0,
                });
            }
        }
        let count = groups.len() as u64;
        for (index, group) in groups.iter_mut().enumerate() {
            // Random cases, an equal share of each kind of frame.
            group.cases = group.flops.cases(match draw {
                Draw::Random { cases } => Draw::Random {
                    cases: cases / count + u64::from((index as u64) < cases % count),
                },
                grid => grid,
            });
        }
        Ok(Self {
            groups,
            draw,
            seed,
            digest: digested,
        })
    }
}

impl Campaign for Upsets {
    fn digest(&self) -> u64 {
        self.digest
    }

    fn groups(&self) -> Vec<u64> {
        self.groups.iter().map(|g| g.cases).collect()
    }

    fn run(&self, group: usize, cases: Range<u64>) -> Tally {
        let group = &self.groups[group];
        let ready = &group.ready;
        let label = format!("{} {}", ready.port.name(), ready.kind.drawn_by());
        let draw = |number| {
            let (draw, seed) = (self.draw, self.seed);
            group
                .flops
                .case(draw, seed, &label, ready.span_cycles, number)
        };
        let drawn: Vec<(usize, u64)> = cases.map(draw).collect();
        let flip = |(index, cycle): &(usize, u64)| {
            let ((register, bit), cycle) = (group.flops.bits[*index], *cycle);
            Mishap::Flip {
                register,
                bit,
                cycle,
            }
        };
        let flips: Vec<Mishap> = drawn.iter().map(flip).collect();
        let mut tally = Tally::default();
        for ((index, _), outcome) in drawn.iter().zip(group.ready.run(&flips)) {
            let mut add = |class: &str| {
                let row = Row {
                    subject: group.ready.port.name().into(),
                    kind: group.ready.kind.name().into(),
                    place: group.flops.names[*index].clone(),
                    class: class.into(),
                };
                tally.add(row, 1);
            };
            add(outcome.class.name());
            outcome.marks().for_each(|mark| add(mark.name()));
        }
        tally
    }
}
