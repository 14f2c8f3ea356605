//! All mutants of a card in one program: its bench, with the number of a mutant, says whether it sees it.

use super::list::{files, reading_bare, yosys_must, Mutation};
use super::stimulus::CYCLES;
use super::{alone, once, recorder, Emission};
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use endat_tools::programs;
use endat_tools::prove::Subject;
use endat_tools::readers;
use endat_tools::scratch;
use rtl_design::elaborate::Module;
use rtl_design::verilog::file_name;
use std::collections::BTreeMap;
use std::path::Path;
use tempfile::TempDir;

/// The control input of a module with mutants, and its bits.
const CONTROL: &str = "mutant";
const CONTROL_BITS: usize = 20;
/// A run may take so many times the cycles of the card as it is.
const LONGER: u64 = 2;
/// From so many runs on a program that takes longer to make, and runs faster, is worth it.
const MANY: usize = 100;

/// A module with mutants, and the number of the first of them.
pub struct Mutated<'a> {
    /// Its index in the design.
    pub module: usize,
    /// They.
    pub mutations: &'a [Mutation],
    /// Number of the first one, from 1 on: 0 is the card as it is.
    pub first: u64,
}

/// A card with its mutants, and its bench.
pub struct Program {
    folder: TempDir,
    /// The sum over the ports of each module alone, by its index.
    alone: BTreeMap<usize, Option<u64>>,
    /// What the card is as it was emitted: cycles of the run, and the sum over the ports of each module.
    whole: Run,
}

/// A run of a bench.
#[derive(Debug)]
pub struct Run {
    /// The bench has nothing to complain about.
    pub passes: bool,
    cycles: u64,
    sums: Vec<u64>,
}

impl Run {
    fn new(text: &str) -> Self {
        let after = |word: &'static str| text.lines().filter_map(move |l| l.strip_prefix(word));
        let sums = after("sum ").filter_map(|l| l.split_once(' ')?.1.parse().ok());
        Self {
            passes: readers::passes(text),
            cycles: after("cycles ").find_map(|l| l.parse().ok()).unwrap_or(0),
            sums: sums.collect(),
        }
    }
}

impl Program {
    /// Builds it, and sees that the bench passes while no mutant is chosen.
    pub fn new(emission: &Emission, mutated: &[Mutated]) -> Result<Self, CommandError> {
        let subject = &emission.subject;
        let folder = scratch::folder()?;
        endat_console::artifact::write(folder.path(), &subject.files, scratch::REMEDY)?;
        for one in mutated {
            let module = &subject.design.modules[one.module];
            let text = mutated_text(emission, module, one)?;
            let file = Artifact::new(file_name(&module.name), text);
            endat_console::artifact::write(folder.path(), &[file], scratch::REMEDY)?;
        }
        let runs = mutated.iter().map(|m| m.mutations.len()).sum::<usize>();
        let optimised = if runs < MANY { "-O0" } else { "-O1" };
        let modules: Vec<usize> = mutated.iter().map(|m| m.module).collect();
        build_bench(folder.path(), emission, optimised)?;
        build_alone(folder.path(), subject, &modules, CYCLES)?;
        let mut program = Self {
            folder,
            alone: BTreeMap::new(),
            whole: Run::new(""),
        };
        for module in modules {
            let sum = program.sum_alone(0, module)?;
            program.alone.insert(module, sum);
        }
        let (whole, text) = program.play(&[])?;
        if !whole.passes {
            return Err(emission.not_passing(&text));
        }
        program.whole = whole;
        Ok(program)
    }

    /// Runs a mutant of a module; whether the bench passes, and whether any port of that module, or directly below, was another one in any cycle.
    pub fn run(&self, mutant: u64, module: usize) -> Result<(bool, bool), CommandError> {
        let (mutant, watched) = (format!("+mutant={mutant}"), format!("+watched={module}"));
        let limit = format!("+cycles_max={}", LONGER * self.whole.cycles);
        let (run, _) = self.play(&[&mutant, &watched, &limit, "+first"])?;
        let differs = run.sums.get(module) != self.whole.sums.get(module);
        Ok((run.passes, differs))
    }

    /// Whether any port of a module, or directly below, is another one while the module is alone with random inputs.
    pub fn differs_alone(&self, mutant: u64, module: usize) -> Result<bool, CommandError> {
        let whole = self.alone.get(&module).copied().flatten();
        Ok(self.sum_alone(mutant, module)? != whole)
    }

    fn sum_alone(&self, mutant: u64, module: usize) -> Result<Option<u64>, CommandError> {
        let plusargs = [format!("+mutant={mutant}"), format!("+alone={module}")];
        let text = start(
            self.folder.path(),
            alone::TOP,
            &plusargs.each_ref().map(String::as_str),
        )?;
        Ok(Run::new(&text).sums.first().copied())
    }

    fn play(&self, plusargs: &[&str]) -> Result<(Run, String), CommandError> {
        let text = start(self.folder.path(), recorder::TOP, plusargs)?;
        Ok((Run::new(&text), text))
    }
}

/// Runs a program that [`build`] has made; what it printed.
fn start(folder: &Path, top: &str, plusargs: &[&str]) -> Result<String, CommandError> {
    let program = folder.join(program(top));
    Ok(programs::run(&program.display().to_string(), folder, plusargs)?.text())
}

fn program(top: &str) -> String {
    format!("{top}_program/sim")
}

/// What a card's ports did in its bench.
pub struct Recording {
    /// Its inputs, a line for each cycle, the first one lowest.
    pub inputs: String,
    /// The sum over the ports of each module, see [`recorder`].
    pub sums: Vec<u64>,
}

/// Sums over the ports of each module alone, with so many cycles of its random inputs.
pub fn sums_alone(subject: &Subject, cycles: usize) -> Result<Vec<u64>, CommandError> {
    let folder = scratch::folder()?;
    endat_console::artifact::write(folder.path(), &subject.files, scratch::REMEDY)?;
    let modules: Vec<usize> = (0..subject.design.modules.len()).collect();
    build_alone(folder.path(), subject, &modules, cycles)?;
    let sum = |module: usize| {
        let text = start(folder.path(), alone::TOP, &[&format!("+alone={module}")])?;
        Ok(Run::new(&text).sums.first().copied().unwrap_or(0))
    };
    modules.into_iter().map(sum).collect()
}

/// Runs the bench of a card as it is.
pub fn record(emission: &Emission) -> Result<Recording, CommandError> {
    let program = Program::new(emission, &[])?;
    // A recording of pins does not have the registers that the bench sets inside the card.
    let sums = program.play(&["+inputs", "+no_deposit"])?.0.sums;
    let inputs = scratch::read(&program.folder.path().join("inputs.txt"))?;
    Ok(Recording { inputs, sums })
}

/// A module with all its mutants, chosen by a plusarg.
fn mutated_text(
    emission: &Emission,
    module: &Module,
    one: &Mutated,
) -> Result<String, CommandError> {
    let subject = &emission.subject;
    let folder = scratch::folder()?;
    endat_console::artifact::write(folder.path(), &files(subject, module), scratch::REMEDY)?;
    let mut script = reading_bare(subject, module);
    for (number, mutation) in (one.first..).zip(one.mutations) {
        script += &format!(
            "mutate -ctrl {CONTROL} {CONTROL_BITS} {number} {}\n",
            mutation.options
        );
    }
    let out = "mutated.v";
    // The control is no port: other modules stay as they are.
    script += &format!(
        "delete -input {}/w:{CONTROL}\nselect {}\nwrite_verilog -noattr -selected {out}\n",
        module.name, module.name
    );
    yosys_must(folder.path(), &module.name, script)?;
    let text = scratch::read(&folder.path().join(out))?;
    let wire = format!("wire [{}:0] {CONTROL};", CONTROL_BITS - 1);
    let reg = format!(
        "reg [{}:0] {CONTROL}; initial if (!$value$plusargs(\"mutant=%d\", {CONTROL})) {CONTROL} = 0;",
        CONTROL_BITS - 1
    );
    Ok("`timescale 1ns / 1ps\n".to_owned() + &once(&text, &wire, &reg)?)
}

/// The program of the bench.
fn build_bench(folder: &Path, emission: &Emission, optimised: &str) -> Result<(), CommandError> {
    let bench = &emission.bench;
    let name = bench.path.trim_end_matches(".v");
    let mut files = vec![bench.clone()];
    files.push(Artifact::new(
        file_name(recorder::TOP),
        recorder::text(&emission.subject, name),
    ));
    endat_console::artifact::write(folder, &files, scratch::REMEDY)?;
    files.extend(emission.subject.files.iter().cloned());
    build(folder, recorder::TOP, &files, optimised)
}

/// The program of modules alone; the card's files are in the folder.
fn build_alone(
    folder: &Path,
    subject: &Subject,
    modules: &[usize],
    cycles: usize,
) -> Result<(), CommandError> {
    if modules.is_empty() {
        return Ok(());
    }
    let mut files = vec![Artifact::new(
        file_name(alone::TOP),
        alone::text(&subject.design, modules, cycles),
    )];
    // They are long, so no two are held at once.
    for &index in modules {
        let rows = alone::rows_text(&subject.design, index, cycles);
        let file = Artifact::new(alone::rows_file(&subject.design.modules[index]), rows);
        endat_console::artifact::write(folder, &[file], scratch::REMEDY)?;
    }
    endat_console::artifact::write(folder, &files, scratch::REMEDY)?;
    files.extend(subject.files.iter().cloned());
    build(folder, alone::TOP, &files, "-O1")
}

/// Verilator makes a program of files in a folder.
fn build(
    folder: &Path,
    top: &str,
    files: &[Artifact],
    optimised: &str,
) -> Result<(), CommandError> {
    let fast = format!("OPT_FAST={optimised}");
    let program = program(top);
    let (made, name) = program.split_once('/').unwrap_or(("obj_dir", "sim"));
    let mut arguments = vec!["--binary", "--timing", "-O3"];
    arguments.extend(readers::QUIET);
    arguments.extend(["-MAKEFLAGS", &fast, "--Mdir", made, "-o", name]);
    arguments.extend(["--top-module", top]);
    arguments.extend(files.iter().map(|f| f.path.as_str()));
    let ran = programs::run("verilator", folder, &arguments)?;
    if ran.is_good {
        return Ok(());
    }
    Err(CommandError::fault(
        "campaign mutants",
        &format!("verilator: {}", programs::line_with(&ran.text(), "%Error")),
    ))
}
