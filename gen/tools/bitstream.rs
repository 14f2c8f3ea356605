//! From an emission to a bitstream with open tools: yosys, nextpnr with one seed after another, and what packs its result; or with the
//! vendor's tool and a script of the emission.

mod attempt;
mod output_cells;
mod read_back;
pub mod replay;
mod vendor;

use attempt::attempt;
pub use attempt::{Attempt, Clock, Inputs, Use};
pub use read_back::{way as way_back, Comparison, CYCLES};
pub use vendor::{read, run as run_vendor};

use crate::programs;
use crate::readers::is_bench;
use crate::scratch;
use endat_config::board::{Board, Build, ReadBack};
use endat_config::Project;
use endat_console::artifact::{self, Artifact};
use endat_console::error::CommandError;
use endat_draw::{decimal, mhz};
use endat_emit::making::{file_name, fill, input_hz, Maker};
use serde::Serialize;
use serde_json::{json, Value};
use std::fmt;
use std::io::ErrorKind;
use std::path::Path;
use std::process::Command;

/// Most that is shown of what a tool says when it fails.
const TAIL_BYTES: usize = 800;

/// What a build gave.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Name of the card.
    pub name: String,
    /// Board.
    pub board: String,
    /// Its device.
    pub part: String,
    /// System clock, in hertz.
    pub system_hz: u64,
    /// How many seeds were tried; 0 with a tool that takes none.
    pub seeds: u32,
    /// What the clock with the least margin reached with each of them, in MHz, in their order.
    pub reached_mhz: Vec<f64>,
    /// The best of them.
    pub best: Attempt,
    /// Name of the bitstream.
    pub bitstream: String,
    /// The command that loads it, where there is one.
    pub load: Option<String>,
    /// What was read back of it, where that was asked for.
    pub read_back: Option<Comparison>,
}

impl Report {
    fn new(
        project: &Project,
        board: &Board,
        reached_mhz: Vec<f64>,
        best: Attempt,
        bitstream: String,
    ) -> Self {
        Self {
            name: project.name.clone(),
            board: board.name.clone(),
            part: board.part.clone(),
            system_hz: project.card.system_hz,
            seeds: reached_mhz.len() as u32,
            reached_mhz,
            best,
            bitstream,
            load: None,
            read_back: None,
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} on {}, {}", self.name, self.board, self.part)?;
        for clock in &self.best.clocks {
            writeln!(
                f,
                "clock {:<24} {} MHz of {} MHz wanted, margin {} %",
                clock.net,
                decimal(clock.fmax_mhz, 1),
                decimal(clock.wanted_mhz, 3),
                decimal(clock.margin_percent, 1)
            )?;
        }
        if let Some(inputs) = &self.best.inputs {
            writeln!(
                f,
                "inputs without a clock         {} ns at most to their first register, {} ns allowed",
                decimal(inputs.slowest_ns, 1),
                decimal(inputs.allowed_ns, 1)
            )?;
        }
        for (kind, cells) in &self.best.cells {
            let percent = cells.used as f64 * 100.0 / cells.available.max(1) as f64;
            let percent = decimal(percent, 1);
            writeln!(
                f,
                "{kind:<30} {} of {}, {percent} %",
                cells.used, cells.available
            )?;
        }
        let met = if self.best.is_met { "met" } else { "NOT met" };
        let seeds = match self.seeds {
            0 => String::new(),
            tried => format!(" with seed {}, {tried} tried", self.best.seed),
        };
        writeln!(f, "timing {met}{seeds}; bitstream {}", self.bitstream)?;
        if let Some(comparison) = &self.read_back {
            write!(f, "{comparison}")?;
        }
        match &self.load {
            Some(command) => writeln!(f, "load it: {command}"),
            None => Ok(()),
        }
    }
}

/// The command that loads a bitstream, until power goes or for good; none if openFPGALoader has no name for the board.
pub fn loading(board: &Board, bitstream: &Path, for_good: bool) -> Option<String> {
    let loader = board.loader.as_ref()?;
    let flash = if for_good { " --write-flash" } else { "" };
    let path = bitstream.display().to_string();
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_./-".contains(c);
    let path = match path.chars().all(is_plain) {
        true => path,
        false => format!("'{}'", path.replace('\'', "'\\''")),
    };
    Some(format!("openFPGALoader --board {loader}{flash} {path}"))
}

/// How much is tried.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Seeds of the placer, at most.
    pub seeds: u32,
    /// No further seed when one meets timing.
    pub until_met: bool,
    /// How the best is read back, if it is.
    pub way_back: Option<ReadBack>,
}

/// Builds a card. Returns the report of the best seed and its bitstream's bytes.
pub fn build(
    project: &Project,
    board: &Board,
    build: &Build,
    artifacts: &[Artifact],
    effort: Effort,
    progress: &mut dyn FnMut(String),
) -> Result<(Report, Vec<u8>), CommandError> {
    let name = project.name.as_str();
    let scratch = scratch::folder()?;
    let folder = scratch.path();
    artifact::write(folder, artifacts, scratch::REMEDY)?;
    let fill = |words: &[String]| fill(project, board, words);
    let run = |words: &[String]| run(folder, words, &build.install);
    let tools = [&build.place, &build.pack].map(|words| words.first().map_or("", String::as_str));
    for tool in ["yosys"].into_iter().chain(tools) {
        if !is_there(tool) {
            return Err(not_there(tool, &build.install));
        }
    }
    progress(format!("{name}: synthesis for {}", board.family.title));
    // The test bench is not for a device.
    let sources = artifacts
        .iter()
        .filter(|a| a.path.ends_with(".v") && !is_bench(a));
    let mut sources: Vec<&str> = sources.map(|a| a.path.as_str()).collect();
    sources.sort_unstable();
    // nextpnr of some versions does not know $scopeinfo cells.
    let script = format!(
        "read_verilog {}; {} -top {name}_top; delete t:$scopeinfo; write_json {name}.json",
        sources.join(" "),
        build.synthesis
    );
    run(&["yosys", "-q", "-p", &script].map(str::to_owned))?;
    for signal in output_cells::mark_all(folder, project, &build.output_registers)? {
        progress(format!(
            "{name}: {signal} has no register of its own, and so none in its output cell"
        ));
    }
    let mhz = mhz(project.card.system_hz);
    let mut best: Option<Attempt> = None;
    let mut reached_mhz = vec![];
    let Effort {
        seeds, way_back, ..
    } = effort;
    for seed in 1..=seeds {
        progress(format!("{name}: place and route, seed {seed} of {seeds}"));
        let mut words = fill(&build.place)?;
        let (json, seed_word) = (format!("{name}.json"), seed.to_string());
        let more = ["-q", "--json", &json, "--freq", &mhz, "--seed", &seed_word];
        let more = more
            .into_iter()
            .chain(["--report", "report.json", "--timing-allow-fail"]);
        words.extend(more.map(str::to_owned));
        run(&words)?;
        let attempt = read_report(&folder.join("report.json"), seed, project)?;
        if let Some(clock) = attempt.tightest() {
            reached_mhz.push(clock.fmax_mhz);
            let (fmax, wanted) = (decimal(clock.fmax_mhz, 1), decimal(clock.wanted_mhz, 3));
            progress(format!(
                "{name}: seed {seed}: {fmax} MHz of {wanted} MHz wanted"
            ));
        }
        let is_met = attempt.is_met;
        if best
            .as_ref()
            .is_none_or(|best| attempt.margin() > best.margin())
        {
            // The bitstream is of the best seed.
            run(&fill(&build.pack)?)?;
            way_back.map_or(Ok(()), |way| read_back::keep(folder, name, way))?;
            best = Some(attempt);
        }
        if is_met && effort.until_met {
            break;
        }
    }
    let best = best
        .ok_or_else(|| CommandError::input("--seeds = 0: no seed, no bitstream; give 1 or more"))?;
    let bitstream = file_name(project, board, Maker::Open(build))?;
    let bytes = made(folder, &bitstream)?;
    let mut report = Report::new(project, board, reached_mhz, best, bitstream);
    if let Some(way) = way_back {
        progress(format!("{name}: read back, {CYCLES} cycles"));
        let what = (project, board, build, way);
        report.read_back = Some(read_back::compare(
            folder,
            what,
            artifacts,
            &report.bitstream,
        )?);
    }
    Ok((report, bytes))
}

/// The bitstream that a tool has made.
fn made(folder: &Path, bitstream: &str) -> Result<Vec<u8>, CommandError> {
    let path = folder.join(bitstream);
    std::fs::read(&path).map_err(|e| {
        let remedy = "correct what makes the bitstream in the family's files";
        CommandError::io("read", &path, &e, remedy)
    })
}

/// What may be done when a tool does not make a bitstream.
const TOO_LARGE: &str =
    "if the card does not fit, leave parts or channels out, or take a larger board";

/// Runs a tool that makes a bitstream.
fn run(folder: &Path, words: &[String], install: &str) -> Result<programs::Ran, CommandError> {
    run_or(folder, words, install, TOO_LARGE)
}

/// Runs a tool by its name or, rather, as YoWASP calls it; if it fails, `remedy` is what may be done.
fn run_or(
    folder: &Path,
    words: &[String],
    install: &str,
    remedy: &str,
) -> Result<programs::Ran, CommandError> {
    let (tool, arguments) = words
        .split_first()
        .ok_or_else(|| CommandError::input("build: no tool"))?;
    for name in [format!("yowasp-{tool}"), tool.clone()] {
        let mut command = Command::new(&name);
        let ran = match programs::start(command.current_dir(folder).args(arguments)) {
            Ok(ran) => ran,
            Err(e) if e.kind() == ErrorKind::NotFound => continue,
            Err(e) => {
                let text = format!("{name}: cannot be started: {e}; install it: `{install}`");
                return Err(CommandError::input(text));
            }
        };
        if ran.is_good {
            return Ok(ran);
        }
        return Err(failed(&name, &ran, remedy));
    }
    Err(not_there(tool, install))
}

/// Whether a tool is installed, under either of its names.
fn is_there(tool: &str) -> bool {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let names =
        ["yowasp-", ""].map(|start| format!("{start}{tool}{}", std::env::consts::EXE_SUFFIX));
    std::env::split_paths(&folders).any(|folder| names.iter().any(|n| folder.join(n).is_file()))
}

fn not_there(tool: &str, install: &str) -> CommandError {
    CommandError::input(format!(
        "{tool}: neither yowasp-{tool} nor {tool} is installed; install it: `{install}`"
    ))
}

/// What a tool says that did not do it.
fn failed(name: &str, ran: &programs::Ran, remedy: &str) -> CommandError {
    let said = ran.text();
    let start = said.len().saturating_sub(TAIL_BYTES);
    let start = (start..said.len()).find(|at| said.is_char_boundary(*at));
    let tail = start.and_then(|at| said.get(at..)).unwrap_or_default();
    CommandError::input(format!(
        "{name}: failed; {remedy}. It said: {}",
        tail.trim()
    ))
}

/// What nextpnr reports.
fn read_report(path: &Path, seed: u32, project: &Project) -> Result<Attempt, CommandError> {
    let text = scratch::read(path)?;
    let report: Value =
        serde_json::from_str(&text).map_err(|e| CommandError::fault("report of nextpnr", &e))?;
    attempt(&report, seed, project.card.system_hz, input_hz(project))
        .ok_or_else(|| CommandError::fault("report of nextpnr", &NO_SYSTEM_CLOCK))
}

/// What is wrong with such a report.
const NO_SYSTEM_CLOCK: &str = "it has no clock as fast as the system clock besides the oscillator";

/// Name of the report beside a bitstream.
fn report_name(project: &Project) -> String {
    format!("{}_report.json", project.name)
}

/// Name and text of that report: what the script of a vendor's tool writes, too.
pub fn report_file(project: &Project, report: &Report, bitstream: &[u8]) -> (String, String) {
    let clocks = report.best.clocks.iter();
    let clocks: serde_json::Map<_, _> = clocks
        .map(|c| {
            let clock = json!({"achieved": c.fmax_mhz, "constraint": c.wanted_mhz});
            (c.net.clone(), clock)
        })
        .collect();
    let text = json!({
        "configuration": project.hash,
        "part": report.part,
        "bitstream_bytes": bitstream.len(),
        "fmax": clocks,
        "utilization": report.best.cells,
    });
    (report_name(project), format!("{text:#}\n"))
}

/// The report in a folder; an error if it is of another configuration or device than the bitstream there should be, or of another bitstream.
pub fn report_of(
    project: &Project,
    board: &Board,
    folder: &Path,
    bitstream: &str,
) -> Result<Value, CommandError> {
    let path = folder.join(report_name(project));
    let wrong =
        |what: &str| CommandError::input(format!("{}: {what}; build it again", path.display()));
    let text = std::fs::read_to_string(&path).map_err(|e| {
        CommandError::input(format!(
            "{}: cannot read: {e}; `build` makes it, and so does the vendor's tool by {}_build.tcl in that folder",
            path.display(),
            project.name
        ))
    })?;
    let report: Value =
        serde_json::from_str(&text).map_err(|e| wrong(&format!("is no report: {e}")))?;
    if report["configuration"] != project.hash.as_str() || report["part"] != board.part.as_str() {
        return Err(wrong("is of another configuration, board or version"));
    }
    let bytes = std::fs::metadata(folder.join(bitstream)).map_or(0, |file| file.len());
    if bytes == 0 || report["bitstream_bytes"] != bytes {
        let text = format!("is of another bitstream than {bitstream}, which has {bytes} bytes");
        return Err(wrong(&text));
    }
    Ok(report)
}
