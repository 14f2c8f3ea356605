//! The campaign over mutants: one bit of one cell of one block of the emitted Verilog is another one, and bench, comparison with the design, or
//! proof must see it.
//!
//! ```text
//! emission -> list: yosys lists mutants of each block -> bench: all of a card in one program, run with the number of each
//!                                 not seen at the pins -> recorder: seen at a port of its block?
//!                                 not seen there       -> alone: seen with random inputs?
//!                                 not seen there       -> equal: does it change anything at all?
//!                                 it does              -> prove: does a property still hold?
//! ```

pub mod alone;
mod bench;
pub mod chosen;
mod equal;
mod known;
mod list;
mod page;
mod reasons;
pub mod recorder;
pub mod stimulus;

pub use bench::{record, sums_alone, Recording};
pub use page::{page, table};

use bench::{Mutated, Program};
use endat_config::{load_any_preset, parse_any, Configuration};
use endat_console::artifact::{sha256, Artifact};
use endat_console::error::{shorten, CommandError};
use endat_sim::campaign::{Campaign, Row, Shard, Tally};
use endat_tools::prove::{self, Subject};
use endat_tools::readers::is_bench;
use list::Mutation;
use std::ops::Range;

/// Begins the errors of the campaign.
const CONTEXT: &str = "campaign mutants";

/// The campaign's name.
pub const NAME: &str = "mutants";

/// Presets that together with [`CARDS`] have nearly all blocks. A block is tried in the first one that has it.
const PRESETS: [&str; 4] = [
    "s6_two_channel",
    "async_dsp",
    "mixed_protocols",
    "artinchip_endat_if",
];

/// Cards of the campaign's own, for blocks that no preset has: name and configuration.
const CARDS: [(&str, &str); 4] = [
    ("axi_lite", include_str!("cards/axi_lite.toml")),
    ("wishbone", include_str!("cards/wishbone.toml")),
    ("spi", include_str!("cards/spi.toml")),
    ("parallel", include_str!("cards/parallel.toml")),
];

/// A card as it is emitted, and its bench.
pub struct Emission {
    /// The card.
    pub subject: Subject,
    /// What simulates it.
    pub bench: Artifact,
}

impl Emission {
    /// Of a configuration.
    fn new(configuration: &Configuration) -> Result<Self, CommandError> {
        let (subject, files) = match configuration {
            Configuration::Card(card) => (Subject::new(card)?, endat_emit::emit(card)?),
            Configuration::Receiver(receiver) => (
                Subject::receiver(receiver)?,
                endat_emit::protocols::t_format::emit(receiver)?,
            ),
        };
        let bench = files.into_iter().find(is_bench).ok_or_else(|| {
            CommandError::input(format!("{}: has no bench, one is needed", subject.name))
        })?;
        Ok(Self { subject, bench })
    }

    /// Of one of [`subjects`], or of a preset.
    pub fn named(name: &str) -> Result<Self, CommandError> {
        let card = CARDS.iter().find(|card| card.0 == name);
        Self::new(&match card {
            Some((name, text)) => parse_any(&format!("{name}.toml"), text)?,
            None => load_any_preset(name)?,
        })
    }

    /// The error for a bench that complains, by its output, while no mutant is chosen.
    fn not_passing(&self, text: &str) -> CommandError {
        CommandError::input(format!(
            "{CONTEXT}: {}: the bench does not pass while no mutant is chosen: {}; mend that first",
            self.subject.name,
            shorten(text.trim())
        ))
    }
}

/// Replaces a text that occurs exactly once.
fn once(text: &str, from: &str, to: &str) -> Result<String, CommandError> {
    match text.matches(from).count() {
        1 => Ok(text.replace(from, to)),
        count => Err(CommandError::fault(
            CONTEXT,
            &format!("{from}: occurs {count} times"),
        )),
    }
}

/// Names of the cards.
pub fn subjects() -> impl Iterator<Item = &'static str> {
    PRESETS.into_iter().chain(CARDS.map(|card| card.0))
}

/// The mutants of one block.
struct Group {
    /// Index of its card.
    emission: usize,
    /// Index of its module there.
    module: usize,
    mutations: Vec<Mutation>,
}

/// Mutants of blocks.
pub struct Mutants {
    emissions: Vec<Emission>,
    groups: Vec<Group>,
    /// Of each card whose mutants are to be run.
    programs: Vec<Option<Program>>,
}

/// What saw a mutant, or why it is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fate {
    /// The emitted bench.
    Bench,
    /// A port of the block, or directly below it, is another one in a cycle of that bench.
    Ports,
    /// A port of the block, or directly below it, is another one while the block is alone with random inputs.
    Alone,
    /// A property does not hold.
    Proof,
    /// Nothing: it is proved that it changes nothing.
    Equivalent,
    /// Nothing, and it is not proved that it changes nothing.
    Survivor,
}

impl Fate {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Bench,
        Self::Ports,
        Self::Alone,
        Self::Proof,
        Self::Equivalent,
        Self::Survivor,
    ];

    /// The class in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bench => "bench",
            Self::Ports => "ports",
            Self::Alone => "alone",
            Self::Proof => "proof",
            Self::Equivalent => "equivalent",
            Self::Survivor => "survivor",
        }
    }

    /// Whether it is seen.
    pub const fn is_killed(self) -> bool {
        matches!(self, Self::Bench | Self::Ports | Self::Alone | Self::Proof)
    }
}

impl Mutants {
    /// So many mutants of each block whose name begins with `only`, at most, of one card, or of all. Blocks that two cards have are tried in the
    /// first one.
    pub fn new(
        emissions: Vec<Emission>,
        card: Option<&str>,
        per_block: u64,
        seed: u64,
        only: &str,
    ) -> Result<Self, CommandError> {
        let mut seen: Vec<String> = vec![];
        let mut groups = vec![];
        for (index, emission) in emissions.iter().enumerate() {
            for (place, module) in emission.subject.design.modules.iter().enumerate() {
                if seen.contains(&module.type_name) {
                    continue;
                }
                seen.push(module.type_name.clone());
                let is_of_card = card.is_none_or(|card| emission.subject.name == card);
                if !is_of_card || !module.type_name.starts_with(only) {
                    continue;
                }
                groups.push(Group {
                    emission: index,
                    module: place,
                    mutations: list::mutations(&emission.subject, module, per_block, seed)?,
                });
            }
        }
        Ok(Self {
            programs: emissions.iter().map(|_| None).collect(),
            emissions,
            groups,
        })
    }

    /// Makes the programs that a part of the campaign needs. A card whose bench does not pass as it is, is refused.
    pub fn prepare(&mut self, shard: Shard, progress: &dyn Fn(&str)) -> Result<(), CommandError> {
        let all: u64 = self.groups().iter().sum();
        let cases = shard.cases(all);
        for (index, emission) in self.emissions.iter().enumerate() {
            let mut first = 0;
            let mut mutated = vec![];
            for group in &self.groups {
                let end = first + group.mutations.len() as u64;
                let is_asked = first < cases.end && cases.start < end;
                if group.emission == index && is_asked && !group.mutations.is_empty() {
                    mutated.push(Mutated {
                        module: group.module,
                        mutations: &group.mutations,
                        first: first + 1,
                    });
                }
                first = end;
            }
            if !mutated.is_empty() {
                progress(&format!("{}: building", emission.subject.name));
                self.programs[index] = Some(Program::new(emission, &mutated)?);
            }
        }
        Ok(())
    }

    /// Runs one; what became of it, the block, and its place.
    pub fn case(&self, case: u64) -> Result<(Fate, &str, &str), CommandError> {
        let mut at = case;
        let mut groups = self.groups.iter();
        let group = groups.find(|g| match at.checked_sub(g.mutations.len() as u64) {
            Some(rest) => {
                at = rest;
                false
            }
            None => true,
        });
        let group = group.ok_or_else(|| CommandError::fault(NAME, &"no such case"))?;
        let mutation = &group.mutations[at as usize];
        let fate = self.fate(group, mutation, case + 1)?;
        let module = &self.emissions[group.emission].subject.design.modules[group.module];
        Ok((fate, &module.type_name, &mutation.place))
    }

    fn fate(&self, group: &Group, mutation: &Mutation, number: u64) -> Result<Fate, CommandError> {
        let subject = &self.emissions[group.emission].subject;
        let module = &subject.design.modules[group.module];
        let program = self.programs[group.emission].as_ref();
        let program = program.ok_or_else(|| CommandError::fault(NAME, &"no program"))?;
        let (passes, differs) = program.run(number, group.module)?;
        if !passes {
            return Ok(Fate::Bench);
        }
        if differs {
            return Ok(Fate::Ports);
        }
        if program.differs_alone(number, group.module)? {
            return Ok(Fate::Alone);
        }
        if equal::is_equal(subject, module, mutation)? {
            return Ok(Fate::Equivalent);
        }
        let mut first = list::reading(subject, module) + &format!("mutate {}\n", mutation.options);
        for below in list::children(subject, module) {
            first += &format!("delete ={below}\n");
        }
        Ok(match prove::refutes(subject, group.module, Some(&first))? {
            Some(true) => Fate::Proof,
            _ => Fate::Survivor,
        })
    }
}

impl Campaign for Mutants {
    fn digest(&self) -> u64 {
        let files = self.emissions.iter().flat_map(|e| &e.subject.files);
        let benches = self.emissions.iter().map(|e| &e.bench);
        let texts: String = files.chain(benches).map(|f| f.text.as_str()).collect();
        let digest = sha256(texts.as_bytes());
        u64::from_str_radix(&digest[..16], 16).unwrap_or(0)
    }

    fn groups(&self) -> Vec<u64> {
        self.groups
            .iter()
            .map(|g| g.mutations.len() as u64)
            .collect()
    }

    fn run(&self, group: usize, cases: Range<u64>) -> Tally {
        let mut tally = Tally::default();
        let before: u64 = self.groups().iter().take(group).sum();
        let group = &self.groups[group];
        let subject = &self.emissions[group.emission].subject;
        for at in cases {
            let case = before + at;
            // One that is wrong, or not seen, is told with its number, which runs it alone.
            let (class, place) = match self.case(case) {
                Ok((Fate::Survivor, _, place)) => {
                    (Fate::Survivor.name(), format!("case {case}, {place}"))
                }
                Ok((fate, ..)) => (fate.name(), "all".into()),
                Err(error) => ("not_run", format!("case {case}: {error}")),
            };
            let row = Row {
                subject: subject.name.clone(),
                kind: subject.design.modules[group.module].type_name.clone(),
                place,
                class: class.into(),
            };
            tally.add(row, 1);
        }
        tally
    }

    fn batch(&self, _group: usize) -> u64 {
        1
    }
}
