//! Proofs of the emitted Verilog, run by outside tools: what each block promises holds in every cycle, whatever comes in.
//!
//! ```text
//! properties of the blocks -> below `ifdef FORMAL in their modules -> harness: inputs are anything, in every cycle
//!                                                   -> yosys: one model -> induction, from the start values
//!                                                                       -> from any contents of the registers
//! ```
//!
//! The properties of a part of a card are proved together: each may lean on the others in the cycles before.

mod cover;
pub mod frames;
mod fronts;
mod harness;
mod netlist;
mod page;
mod report;
pub mod reset;
mod tools;
mod trace;

pub use fronts::claimed;
pub use page::page;
pub use report::{Met, ModuleRow, PartReport, Report, Row, Verdict};
pub use tools::YOSYS;
pub use trace::Trace;

use crate::readers::is_core;
use crate::scratch;
use endat_config::{Project, Receiver};
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use endat_draw::waves_svg;
use endat_emit::language::Language;
use rtl_design::elaborate::properties::{inputs, of_label, properties, Begins, Property};
use rtl_design::elaborate::{Design, Module};
use rtl_design::verilog::as_printed;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Instant;
use tools::Answer;

/// The type of an encoder port.
const ENCODER_PORT: &str = "EncoderPort";
/// The type of an EnDat channel.
const CHANNEL: &str = "Channel";

/// Types of blocks that are proved with everything below them, each with all its inputs free; what is in one of them is not proved again. So is
/// the port of another protocol, a block of an [`ENCODER_PORT`] that is called one.
const PARTS: [&str; 10] = [
    CHANNEL,
    "Exchange",
    "ChannelRegisters",
    "RegisterBank",
    "Stream",
    "UartBridge",
    "InputFilter",
    "WordAccess",
    "Interrupt",
    "ResultBanks",
];

/// Cycles before the one that an induction step is about.
const INDUCTION_CYCLES: usize = 4;

/// Cycles from any state: a property looks one back.
const ANYWHERE_CYCLES: usize = 3;

/// How far a counterexample is looked for where the induction finds none that begins at the start values.
const SEARCH_CYCLES: usize = 12;

/// The inputs that a proof allows, unless a claim allows less.
const ANYTHING: &str = "every input may be anything in every cycle";

/// What is proved.
#[derive(Clone)]
pub struct Subject {
    /// Name of the card.
    pub name: String,
    /// It.
    pub design: Design,
    /// Its Verilog, and nothing else.
    pub files: Vec<Artifact>,
    /// Which of its modules are proved, each with what is below it.
    pub parts: Vec<usize>,
}

impl Subject {
    /// A card as it is emitted.
    pub fn new(project: &Project) -> Result<Self, CommandError> {
        let design = endat_emit::design(project)?;
        let files = endat_emit::sources_of(project, &design, Language::Verilog);
        Ok(Self::of(&project.name, design, files))
    }

    /// A receiver as it is emitted.
    pub fn receiver(receiver: &Receiver) -> Result<Self, CommandError> {
        let design = endat_emit::protocols::t_format::design(receiver)?;
        let files = endat_emit::protocols::t_format::emit(receiver)?;
        Ok(Self::of(&receiver.name, design, files))
    }

    /// Leaves only those parts to prove that hold a module.
    pub fn narrow(&mut self, module: &str) {
        let design = &self.design;
        let holds = |part: usize| {
            let mut inside = below(design, part).into_iter();
            inside.any(|index| design.modules[index].name == module)
        };
        self.parts.retain(|part| holds(*part));
    }

    /// A design under the name of a card, with its Verilog and perhaps other files.
    pub fn of(name: &str, design: Design, mut files: Vec<Artifact>) -> Self {
        files.retain(is_core);
        let design = as_printed(&design);
        let parts = parts(&design);
        Self {
            name: name.into(),
            design,
            files,
            parts,
        }
    }
}

/// The modules that are proved, as [`PARTS`] says.
fn parts(design: &Design) -> Vec<usize> {
    let (mut parts, mut inside) = (vec![], vec![]);
    let types = design
        .modules
        .iter()
        .map(|module| module.type_name.as_str());
    let ports: BTreeSet<&str> = types
        .filter(|name| name.ends_with("Port") && *name != ENCODER_PORT)
        .collect();
    let claimed = fronts::CLAIMS.iter().map(|claim| claim.type_name);
    for part in ports.into_iter().chain(PARTS).chain(claimed) {
        for (index, module) in design.modules.iter().enumerate() {
            if module.type_name == part && !inside.contains(&index) {
                parts.push(index);
                inside.extend(below(design, index));
            }
        }
    }
    parts
}

/// Properties of a block.
struct Block<'a> {
    module: &'a Module,
    properties: Vec<Property>,
}

/// Proves all parts. Counterexamples go to `traces`, if given; `progress` is told what comes next.
pub fn prove(
    subject: &Subject,
    traces: Option<&Path>,
    progress: &dyn Fn(&str),
) -> Result<Report, CommandError> {
    let mut parts = vec![];
    for &part in &subject.parts {
        progress(&format!("{}: proving", subject.design.modules[part].name));
        parts.push(prove_part(subject, part, traces)?);
    }
    let provers = tools::versions()?;
    let modules = modules(subject, &parts);
    Ok(Report {
        name: subject.name.clone(),
        provers,
        parts,
        modules,
    })
}

/// Every module of a card, with the part that it is proved in and how many properties it has.
fn modules(subject: &Subject, reports: &[PartReport]) -> Vec<ModuleRow> {
    let design = &subject.design;
    let trees = subject.parts.iter().map(|part| below(design, *part));
    let trees: Vec<Vec<usize>> = trees.collect();
    let rows = || {
        let all = reports.iter().flat_map(|part| &part.rows);
        all.filter(|row| row.verdict != Verdict::NotClaimed)
    };
    let row = |(index, module): (usize, &Module)| ModuleRow {
        module: module.name.clone(),
        part: (trees.iter().find(|tree| tree.contains(&index)))
            .map(|tree| design.modules[tree[0]].name.clone()),
        properties: rows().filter(|r| r.module == module.name).count(),
    };
    design.modules.iter().enumerate().map(row).collect()
}

fn prove_part(
    subject: &Subject,
    top: usize,
    traces: Option<&Path>,
) -> Result<PartReport, CommandError> {
    let design = &subject.design;
    let module = &design.modules[top];
    let blocks: Vec<Block> = below(design, top)
        .into_iter()
        .map(|index| &design.modules[index])
        .filter(|m| !m.properties.is_empty())
        .map(|module| Block {
            module,
            properties: properties(&module.properties),
        })
        .collect();
    let folder = scratch::folder()?;
    let mut files = subject.files.clone();
    files.push(harness::artifact(module, design.has_initial_values));
    endat_console::artifact::write(folder.path(), &files, scratch::REMEDY)?;
    let claim = fronts::claim_of(module);
    let mut report = PartReport {
        module: module.name.clone(),
        inputs: match claim {
            Some(claim) if blocks.is_empty() => claim.inputs.into(),
            _ => inputs(&module.properties).unwrap_or(ANYTHING).into(),
        },
        start_seconds: 0.0,
        anywhere_seconds: 0.0,
        rows: vec![],
    };
    for begins in [Begins::AtStart, Begins::Anywhere] {
        let mut all = blocks.iter().flat_map(|b| &b.properties);
        if !all.any(|p| p.begins == begins) {
            continue;
        }
        let started = Instant::now();
        let proof = Proof {
            folder: folder.path(),
            files: &files,
            begins,
            has_initial_values: design.has_initial_values,
            first: "",
        };
        let answer = proof.run()?;
        let seconds = started.elapsed().as_secs_f64();
        match begins {
            Begins::AtStart => report.start_seconds = seconds,
            Begins::Anywhere => report.anywhere_seconds = seconds,
        }
        let mut rows = report::rows(&blocks, begins, &answer);
        if let (Some(traces), Some(trace)) = (traces, &answer.trace) {
            let mut paths = answer.failed.iter();
            let is_of = |path: &str, row: &Row| {
                property_of(&blocks, path).is_some_and(|(_, p)| p.name == row.name)
            };
            let failed = rows.iter().find(|r| r.verdict.is_failure());
            let path = failed.and_then(|row| paths.find(|path| is_of(path, row)));
            keep(
                traces,
                &module.name,
                trace,
                path.map_or("", String::as_str),
                &mut rows,
            )?;
        }
        report.rows.append(&mut rows);
    }
    // A part that does not hold is not asked what its conditions are worth.
    if !report.rows.iter().any(|row| row.verdict.is_failure()) {
        cover::look(subject, &blocks, &mut report.rows)?;
    }
    if let Some(claim) = claim {
        let started = Instant::now();
        let mut rows = claim.rows(design, &subject.files, top, folder.path())?;
        report.rows.append(&mut rows);
        report.start_seconds += started.elapsed().as_secs_f64();
    }
    // Elsewhere are words behind a valid bit, without a reset of their own, and bytes out of memories.
    if module.type_name != CHANNEL {
        return Ok(report);
    }
    let started = Instant::now();
    report
        .rows
        .push(reset::row(folder.path(), &subject.files, module)?);
    report.anywhere_seconds += started.elapsed().as_secs_f64();
    Ok(report)
}

/// One run over all properties that begin alike.
struct Proof<'a> {
    folder: &'a Path,
    files: &'a [Artifact],
    begins: Begins,
    has_initial_values: bool,
    /// What yosys does before it reads the files.
    first: &'a str,
}

impl Proof<'_> {
    fn run(&self) -> Result<Answer, CommandError> {
        let model = tools::model(self.folder, self.files, self.begins, self.first)?;
        // Without start values the first cycle is a reset, and what is before it is anything.
        let first = usize::from(!self.has_initial_values);
        let search = |cycles: usize| {
            let steps = format!("{first}:{}", first + cycles);
            tools::solve(self.folder, &model, &["--presat", "-t", &steps])
        };
        if self.begins == Begins::Anywhere {
            let steps = ANYWHERE_CYCLES.to_string();
            return tools::solve(self.folder, &model, &["-t", &steps]);
        }
        let base = search(INDUCTION_CYCLES)?;
        if !base.failed.is_empty() {
            return Ok(base);
        }
        let steps = INDUCTION_CYCLES.to_string();
        let step = tools::solve(self.folder, &model, &["-i", "-t", &steps])?;
        if step.failed.is_empty() {
            return Ok(step);
        }
        let longer = search(SEARCH_CYCLES)?;
        Ok(match longer.failed.is_empty() {
            true => Answer {
                is_reached: false,
                ..step
            },
            false => longer,
        })
    }
}

/// Whether a property that holds from the start values no longer does in the parts that hold a module. None where the module is in no part that
/// is proved. With `first` the module is the one that these commands read from the file of the emitted one and change.
pub fn refutes(
    subject: &Subject,
    module: usize,
    first: Option<&str>,
) -> Result<Option<bool>, CommandError> {
    let design = &subject.design;
    let own = rtl_design::verilog::file_name(&design.modules[module].name);
    let mut found = None;
    for &part in &subject.parts {
        let tree = below(design, part);
        if !tree.contains(&module) {
            continue;
        }
        let folder = scratch::folder()?;
        let harness = harness::artifact(&design.modules[part], design.has_initial_values);
        let mut files = subject.files.clone();
        files.push(harness.clone());
        endat_console::artifact::write(folder.path(), &files, scratch::REMEDY)?;
        files.retain(|file| first.is_none() || file.path != own);
        if tree
            .iter()
            .any(|index| !design.modules[*index].properties.is_empty())
        {
            let proof = Proof {
                folder: folder.path(),
                files: &files,
                begins: Begins::AtStart,
                has_initial_values: design.has_initial_values,
                first: first.unwrap_or_default(),
            };
            if !proof.run()?.failed.is_empty() {
                return Ok(Some(true));
            }
            found = Some(false);
        }
        if let Some(claim) = fronts::claim_of(&design.modules[part]) {
            files.retain(|file| file.path != harness.path);
            let flat = fronts::flat(
                design,
                &files,
                part,
                folder.path(),
                first.unwrap_or_default(),
            )?;
            let answer = claim.ask(&design.modules[part], folder.path(), &flat)?;
            if !answer.failed.is_empty() {
                return Ok(Some(true));
            }
            found = Some(false);
        }
    }
    Ok(found)
}

/// Modules in the tree of one, itself first, each once.
fn below(design: &Design, top: usize) -> Vec<usize> {
    let mut found = vec![top];
    let mut next = 0;
    while let Some(&index) = found.get(next) {
        for instance in &design.modules[index].instances {
            if !found.contains(&instance.module) {
                found.push(instance.module);
            }
        }
        next += 1;
    }
    found
}

/// Writes a counterexample, as waveform and drawing, beside others; the rows that it is of tell where.
fn keep(
    traces: &Path,
    module: &str,
    trace: &str,
    assertion: &str,
    rows: &mut [Row],
) -> Result<(), CommandError> {
    let Some(failed) = rows.iter().find(|r| r.verdict.is_failure()) else {
        return Ok(());
    };
    let name = format!("{module}_{}", failed.name);
    let path = PathBuf::from(format!("{name}.vcd"));
    let remedy = "give another folder with --out";
    let waves = trace::waves(trace, assertion);
    let waves = waves.map_err(|e| CommandError::io("read", &path, &e, remedy))?;
    let title = format!("{}: {} ({})", failed.module, failed.name, failed.verdict);
    let files = [
        Artifact::new(path.display().to_string(), trace),
        Artifact::new(
            format!("{name}.svg"),
            waves_svg(&waves, &title, &failed.words),
        ),
    ];
    endat_console::artifact::write(traces, &files, remedy)?;
    let shown = traces.join(&path).display().to_string();
    for row in rows.iter_mut().filter(|r| r.verdict.is_failure()) {
        row.trace = Some(shown.clone());
    }
    Ok(())
}

/// The property among those of a block that a failed assertion is of, by its path in the model: `u.u_sender.driver_window`.
fn property_of<'a>(blocks: &'a [Block<'a>], path: &str) -> Option<(&'a Block<'a>, &'a Property)> {
    let label = path.rsplit('.').next().unwrap_or(path);
    let in_block = |block: &'a Block<'a>| {
        let index = of_label(&block.properties, label)?;
        Some((block, &block.properties[index]))
    };
    blocks.iter().find_map(in_block)
}
