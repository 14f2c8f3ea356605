//! Proofs of bus fronts, for every master within the rules of its bus and for ever, and of the ring of configuration words, for every front.
//!
//! These proofs use registers of the blocks inside a module, so yosys flattens the module first. Each text begins with the promises;
//! from [`INSIDE`] on it has the invariants between front, word and bank that the induction needs.

use super::cover;
use super::report::{Met, Row, Verdict, RUN_CYCLES};
use super::tools::{self, Answer};
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use rtl_design::elaborate::properties::{of_label, properties, Begins, Property};
use rtl_design::elaborate::{Design, Module};
use rtl_design::verilog::emitted_name;
use std::path::Path;

/// From here on a text says what holds between the blocks inside.
const INSIDE: &str = "    // What holds between front, word and bank";
/// The property that all assertions inside are of.
const INSIDE_NAME: &str = "holds_inside";
/// Its words.
const INSIDE_WORDS: &str =
    "The registers of front, word access and bank are consistent in every cycle; the other proofs rely on it.";
/// Cycles that a step of the induction looks back over, and that its base has.
const DEPTH: usize = 5;
/// The same for waits: deeper than the longest one.
const WAIT_DEPTH: usize = 66;
/// How far a run that breaks a promise is looked for.
const SEARCH_CYCLES: usize = 16;

const BANK: &str = include_str!("bank.vh");
const BEFORE: &str = include_str!("before.vh");
const FOLLOWS: &str = include_str!("follows.vh");
const TRANSFER: &str = include_str!("transfer.vh");

/// Properties of a block, and where they hold.
pub(super) struct Claim {
    /// Type of the block.
    pub type_name: &'static str,
    /// The inputs that the proof allows, in words.
    pub inputs: &'static str,
    texts: &'static [&'static str],
    /// Properties whose induction takes as many cycles as the longest wait.
    waits: &'static [&'static str],
}

const MASTER: &str =
    "any master within the rules of the bus, any bank that answers each access within four cycles";

/// All of them.
pub(super) const CLAIMS: [Claim; 5] = [
    Claim {
        type_name: "ApbFront",
        inputs: MASTER,
        texts: &[BANK, BEFORE, include_str!("apb.vh"), FOLLOWS, TRANSFER],
        waits: &["answers_in_time"],
    },
    Claim {
        type_name: "WishboneFront",
        inputs: MASTER,
        texts: &[BANK, BEFORE, include_str!("wishbone.vh"), FOLLOWS, TRANSFER],
        waits: &["answers_in_time"],
    },
    Claim {
        type_name: "AhbLiteFront",
        inputs: MASTER,
        texts: &[BANK, include_str!("ahb_lite.vh"), TRANSFER],
        waits: &["answers_in_time"],
    },
    Claim {
        type_name: "AxiLiteFront",
        inputs: MASTER,
        texts: &[BANK, include_str!("axi_lite.vh")],
        waits: &["write_answers_in_time", "read_answers_in_time"],
    },
    Claim {
        type_name: "RegisterBank",
        inputs: "any front, in every cycle",
        texts: &[include_str!("ring.vh")],
        waits: &[],
    },
];

/// Types of blocks with a claim, and the properties of each.
pub fn claimed() -> Vec<(&'static str, Vec<Property>)> {
    let all = CLAIMS.iter();
    all.map(|claim| (claim.type_name, claim.properties()))
        .collect()
}

/// The claim about a module, if there is one.
pub(super) fn claim_of(module: &Module) -> Option<&'static Claim> {
    let mut all = CLAIMS.iter();
    all.find(|claim| claim.type_name == module.type_name)
}

impl Claim {
    /// The promises, and last the invariant inside.
    pub fn properties(&self) -> Vec<Property> {
        let text = self.texts.concat();
        let mut found = properties(&text);
        let promised: usize = found.iter().map(|p| p.assertions).sum();
        let all = text.matches(": assert (").count();
        found.push(Property {
            name: INSIDE_NAME.into(),
            words: INSIDE_WORDS.into(),
            begins: Begins::AtStart,
            assertions: all - promised,
            unless: vec![],
        });
        found
    }

    /// The text for a module of a design.
    fn text(&self, module: &Module) -> String {
        let mut parameters = module.parameters.iter();
        let last = parameters.find(|p| p.name.eq_ignore_ascii_case("last_block"));
        let blocks = last.map_or(String::new(), |last| {
            format!("    localparam [8:0] BLOCKS = {};\n", last.value + 1)
        });
        blocks + &self.texts.concat()
    }

    /// Proves it; what is said of each property.
    pub fn rows(
        &self,
        design: &Design,
        files: &[Artifact],
        top: usize,
        folder: &Path,
    ) -> Result<Vec<Row>, CommandError> {
        let module = &design.modules[top];
        let flat = flat(design, files, top, folder, "")?;
        let answer = self.ask(module, folder, &flat)?;
        let known = self.properties();
        let place = |path: &String| {
            let label = path.rsplit('.').next().unwrap_or(path);
            of_label(&known, label).unwrap_or(known.len() - 1)
        };
        let failed: Vec<usize> = answer.failed.iter().map(place).collect();
        let met = match failed.is_empty() {
            true => self.met(module, folder, &flat)?,
            false => vec![],
        };
        let is_met = |property: &Property| met.contains(&property.name);
        let rows = known.iter().enumerate().map(|(n, property)| Row {
            module: module.name.clone(),
            name: property.name.clone(),
            words: property.words.clone(),
            from_any_state: false,
            assertions: property.assertions,
            verdict: match Verdict::of(&answer, failed.contains(&n)) {
                Verdict::Proved if !is_met(property) && property.name != INSIDE_NAME => {
                    Verdict::Empty
                }
                verdict => verdict,
            },
            met: is_met(property).then_some(Met::Run),
            trace: None,
        });
        Ok(rows.collect())
    }

    /// Labels of the assertions whose condition a run of a master meets, in the flat module.
    fn met(&self, module: &Module, folder: &Path, flat: &str) -> Result<Vec<String>, CommandError> {
        let claims = cover::covers(&self.text(module));
        let model = tools::claims(folder, flat, &module.name, &claims)?;
        let paths = tools::reached(folder, &model, &format!("0:{RUN_CYCLES}"))?;
        let label = |path: &String| path.rsplit('.').next().map(str::to_owned);
        Ok(paths.iter().filter_map(label).collect())
    }

    /// Asks the solver about the flat module. A run that breaks a promise is looked for where the induction finds none that begins at the start values.
    pub fn ask(&self, module: &Module, folder: &Path, flat: &str) -> Result<Answer, CommandError> {
        let text = self.text(module);
        let (promises, _) = text.split_once(INSIDE).unwrap_or((&text, ""));
        let is_wait = |line: &str| {
            let mut all = self.waits.iter();
            all.any(|name| line.contains(&format!(" {name}: ")))
        };
        let without_waits = lines(&text, |line| (!is_wait(line)).then(|| line.into()));
        let others_granted = lines(&text, |line| match is_wait(line) {
            true => Some(line.into()),
            false => Some(line.replace(": assert (", ": assume (")),
        });
        let mut runs = vec![(without_waits, DEPTH)];
        if !self.waits.is_empty() {
            runs.push((others_granted, WAIT_DEPTH));
        }
        for (claims, depth) in runs {
            let model = tools::claims(folder, flat, &module.name, &claims)?;
            let depth = depth.to_string();
            let step = tools::solve(folder, &model, &["-i", "-t", &depth])?;
            let base = match step.failed.is_empty() {
                true => tools::solve(folder, &model, &["--presat", "-t", &depth])?,
                false => step,
            };
            if base.failed.is_empty() {
                continue;
            }
            let model = tools::claims(folder, flat, &module.name, promises)?;
            let depth = SEARCH_CYCLES.to_string();
            let found = tools::solve(folder, &model, &["-t", &depth])?;
            return Ok(match found.failed.is_empty() {
                true => Answer {
                    is_reached: false,
                    ..base
                },
                false => found,
            });
        }
        Ok(Answer::default())
    }
}

/// Flattens a module of these files into one text; yosys runs `first` before it reads them.
pub(super) fn flat(
    design: &Design,
    files: &[Artifact],
    top: usize,
    folder: &Path,
    first: &str,
) -> Result<String, CommandError> {
    let module = &design.modules[top];
    let files: Vec<_> = files.iter().map(|f| f.path.as_str()).collect();
    tools::flat(
        folder,
        &files,
        &module.name,
        first,
        &start_values(design, top),
    )
}

fn lines(text: &str, change: impl Fn(&str) -> Option<String>) -> String {
    let kept = text.lines().filter_map(change);
    kept.map(|line| line + "\n").collect()
}

/// Start values of the registers of a module and of those inside, for a card without start values in its text: it begins with a reset.
/// Path in the flat module, width and value.
fn start_values(design: &Design, top: usize) -> Vec<(String, usize, u128)> {
    if design.has_initial_values {
        return vec![];
    }
    let mut found = vec![];
    let mut open = vec![(String::new(), top)];
    while let Some((path, index)) = open.pop() {
        let module = &design.modules[index];
        for register in module.registers.iter().filter(|r| r.reset.is_some()) {
            let net = &module.nets[register.q];
            let name = emitted_name(&net.name);
            found.push((format!("{path}{name}"), net.width_bits, register.start));
        }
        for instance in &module.instances {
            open.push((format!("{path}{}.", instance.name), instance.module));
        }
    }
    found
}
