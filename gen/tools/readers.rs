//! Programs of others that read emitted Verilog: linters and simulators.

use crate::programs;
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use std::fmt;
use std::path::Path;

/// A program, and the language that it takes the Verilog for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reader {
    /// iverilog with this language.
    Icarus(&'static str),
    /// Verilator, which knows SystemVerilog.
    Verilator,
}

/// Arguments for Verilator where its warnings are of no interest.
pub const QUIET: [&str; 3] = ["-Wno-fatal", "-Wno-lint", "-Wno-style"];

/// Both languages, and both programs.
pub const LINTERS: [Reader; 3] = [
    Reader::Icarus("-g2005"),
    Reader::Icarus("-g2012"),
    Reader::Verilator,
];

impl fmt::Display for Reader {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Icarus(language) => write!(f, "iverilog {language}"),
            Self::Verilator => f.write_str("verilator"),
        }
    }
}

/// Runs a program; whether it ended well, and what it said.
fn run(program: &str, folder: &Path, arguments: &[&str]) -> Result<(bool, String), CommandError> {
    let ran = programs::run(program, folder, arguments)?;
    Ok((ran.is_good, ran.text()))
}

/// Whether a file belongs to the card itself: no board top, no test bench.
pub fn is_core(file: &Artifact) -> bool {
    file.path.ends_with(".v") && !file.path.ends_with("_top.v") && !is_bench(file)
}

/// Whether a file is a test bench.
pub fn is_bench(file: &Artifact) -> bool {
    file.path.ends_with("_tb.v")
}

/// Files of the card itself, and its bench.
fn sources(files: &[Artifact]) -> (Vec<&str>, Option<&str>) {
    let core = files.iter().filter(|f| is_core(f));
    let bench = files.iter().find(|f| is_bench(f));
    (
        core.map(|f| f.path.as_str()).collect(),
        bench.map(|f| f.path.as_str()),
    )
}

/// Whether a bench has passed, by what it printed.
pub fn passes(text: &str) -> bool {
    let says = |word| text.lines().any(|line| line.starts_with(word));
    says("PASS") && !says("FAIL")
}

impl Reader {
    /// The program that compiles or checks.
    pub const fn program(self) -> &'static str {
        match self {
            Self::Icarus(_) => "iverilog",
            Self::Verilator => "verilator",
        }
    }

    /// An error if it is not there.
    pub fn find(&self) -> Result<(), CommandError> {
        let version = match self {
            Self::Icarus(_) => "-V",
            Self::Verilator => "--version",
        };
        run(self.program(), Path::new("."), &[version]).map(drop)
    }

    /// What it says about the files of an emission in a folder, with all warnings on: nothing, if all is well. iverilog is given the bench, too.
    pub fn lint(
        self,
        folder: &Path,
        top: &str,
        files: &[Artifact],
    ) -> Result<Option<String>, CommandError> {
        let (core, bench) = sources(files);
        let top_of_all = bench.map_or(top, |bench| bench.trim_end_matches(".v"));
        let mut arguments = match self {
            Self::Icarus(language) => vec![language, "-Wall", "-tnull", "-s", top_of_all],
            Self::Verilator => vec!["--lint-only", "-Wall", "--top-module", top],
        };
        arguments.extend(&core);
        arguments.extend(bench.filter(|_| self != Self::Verilator));
        let (is_good, text) = run(self.program(), folder, &arguments)?;
        let is_silent = is_good && text.is_empty();
        Ok((!is_silent).then_some(text))
    }

    /// Arguments that build the program of a bench in a folder; its files follow them.
    pub fn builds(self, top: &str) -> Vec<&str> {
        match self {
            Self::Icarus(language) => vec![language, "-s", top, "-o", "sim.vvp"],
            // Optimised, tasks of a bench take minutes to compile, to save seconds of its run.
            Self::Verilator => {
                let fast = ["--binary", "--timing", "-MAKEFLAGS", "OPT_FAST=-O0"];
                [&fast[..], &["--top-module", top, "-o", "sim"]].concat()
            }
        }
    }

    /// The program that runs such a bench, and its first arguments; plusargs follow them.
    pub const fn starts(self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::Icarus(_) => ("vvp", &["-n", "sim.vvp"]),
            Self::Verilator => ("./obj_dir/sim", &[]),
        }
    }

    /// Builds and runs the bench of an emission in a folder, with plusargs; whether it has passed, with an exit code that says so, and what
    /// was said.
    pub fn play(
        self,
        folder: &Path,
        files: &[Artifact],
        plusargs: &[&str],
    ) -> Result<(bool, String), CommandError> {
        let (core, bench) = sources(files);
        let Some(bench) = bench else {
            return Ok((false, "there is no bench".into()));
        };
        let mut arguments = self.builds(bench.trim_end_matches(".v"));
        arguments.push(bench);
        arguments.extend(&core);
        let (is_good, text) = run(self.program(), folder, &arguments)?;
        if !is_good || text.contains("arning") {
            return Ok((false, text));
        }
        let (program, first) = self.starts();
        let (is_good, text) = run(program, folder, &[first, plusargs].concat())?;
        Ok((is_good && passes(&text), text))
    }
}
