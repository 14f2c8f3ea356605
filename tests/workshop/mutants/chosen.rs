//! Wrong designs of a card in one program: its bench, with the number of a mutant, says whether it sees it.
//!
//! The design is changed before it is printed, so whoever reads the text gets the same wrong core.

use super::{once, Emission};
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use endat_emit::sources;
use endat_sim::rng::Rng;
use endat_tools::programs;
use endat_tools::prove::{refutes, Subject};
use endat_tools::readers::{is_core, passes, Reader, QUIET};
use endat_tools::scratch;
use rtl_design::elaborate::Design;
use rtl_design::mutate::{mutated, mutations, schema, Kind, Mutation};
use std::time::Duration;
use tempfile::TempDir;

/// A bench that has not ended by then has seen the mutant.
const LONGEST: Duration = Duration::from_secs(300);

/// Mutations of a design: its modules in turn, and in each module the kinds in turn, so that neither wide words nor large modules crowd out
/// the others. Returns fewer than `count` if the design has no more.
#[must_use]
pub fn drawn(design: &Design, count: usize, seed: u64) -> Vec<Mutation> {
    let mut rng = Rng::new(seed);
    let mut pools: Vec<Vec<Vec<Mutation>>> = (0..design.modules.len())
        .map(|id| {
            let all = mutations(design, id);
            let of = |kind| all.iter().filter(|m| m.kind == kind).cloned().collect();
            Kind::ALL.into_iter().map(of).collect()
        })
        .collect();
    let mut found = vec![];
    while found.len() < count && !pools.is_empty() {
        pools.retain_mut(|kinds| {
            kinds.retain(|pool| !pool.is_empty());
            if kinds.is_empty() || found.len() == count {
                return !kinds.is_empty();
            }
            kinds.rotate_left(1);
            let last = kinds.len() - 1;
            let pool = &mut kinds[last];
            let at = rng.in_range(0, pool.len() as u64 - 1) as usize;
            found.push(pool.swap_remove(at));
            true
        });
    }
    found
}

/// Whether a property of a part that holds the wrong module does not hold any more, from the start values on.
pub fn proof_sees(emission: &Emission, mutation: &Mutation) -> Result<bool, CommandError> {
    let right = &emission.subject;
    let design = mutated(&right.design, mutation);
    let files = sources::untitled(&design);
    let subject = Subject::of(&right.name, design, files);
    let name = &right.design.modules[mutation.module].name;
    let module = subject.design.modules.iter().position(|m| m.name == *name);
    // Without a use for the module the text does not have it: its properties are gone with it.
    let Some(module) = module else {
        return Ok(false);
    };
    Ok(refutes(&subject, module, None)?.unwrap_or(false))
}

/// A bench with one card, or with a card and its mutants.
pub struct Chosen {
    folder: TempDir,
    reader: Reader,
}

impl Chosen {
    /// All these mutants of a card. A card whose bench does not pass while none is chosen is refused.
    pub fn new(
        emission: &Emission,
        mutations: &[Mutation],
        reader: Reader,
    ) -> Result<Self, CommandError> {
        let (design, choice) = schema(&emission.subject.design, mutations);
        let name = emission.bench.path.trim_end_matches(".v");
        let head = format!("module {name};");
        let number = format!(
            "{head}\n    integer {choice};\n    initial if (!$value$plusargs(\"mutant=%d\", {choice})) {choice} = 0;"
        );
        let text = once(&emission.bench.text, &head, &number)?;
        let text = once(
            &text,
            " dut (",
            &format!(" dut (.{choice}({choice}[15:0]), "),
        )?;
        let bench = Artifact::new(emission.bench.path.clone(), text);
        let program = Self::built(&design, &bench, reader)?;
        let text = program.play(0)?;
        if passes(&text) {
            return Ok(program);
        }
        Err(emission.not_passing(&text))
    }

    /// One mutant of a card alone, printed like any other card: it is chosen by number 0.
    pub fn plain(
        emission: &Emission,
        mutation: &Mutation,
        reader: Reader,
    ) -> Result<Self, CommandError> {
        let design = mutated(&emission.subject.design, mutation);
        Self::built(&design, &emission.bench, reader)
    }

    /// Whether the bench sees a mutant: it does not end with PASS.
    pub fn sees(&self, number: usize) -> Result<bool, CommandError> {
        Ok(!passes(&self.play(number)?))
    }

    fn built(design: &Design, bench: &Artifact, reader: Reader) -> Result<Self, CommandError> {
        let folder = scratch::folder()?;
        let mut files = sources::untitled(design);
        files.retain(is_core);
        files.push(bench.clone());
        endat_console::artifact::write(folder.path(), &files, scratch::REMEDY)?;
        let top = bench.path.trim_end_matches(".v");
        let program = reader.program();
        let mut arguments = reader.builds(top);
        if reader == Reader::Verilator {
            arguments.extend(QUIET);
        }
        arguments.extend(files.iter().map(|file| file.path.as_str()));
        let ran = programs::run(program, folder.path(), &arguments)?;
        if ran.is_good {
            return Ok(Self { folder, reader });
        }
        Err(CommandError::fault(
            "campaign mutants",
            &format!("{program}: {}", programs::line_with(&ran.text(), "rror")),
        ))
    }

    fn play(&self, number: usize) -> Result<String, CommandError> {
        let chosen = format!("+mutant={number}");
        let (program, first) = self.reader.starts();
        let arguments = [first, &[&chosen, "+first"]].concat();
        let ran = programs::run_within(program, self.folder.path(), &arguments, LONGEST)?;
        Ok(ran.map_or_else(String::new, |ran| ran.text()))
    }
}
