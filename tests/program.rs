//! Running the program: in this process, or as a process of its own.

use endat_terminal::outcome::Outcome;
use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, PoisonError};

/// A folder of its own for one test, emptied before use.
pub struct Dir(pub PathBuf);

impl Dir {
    pub fn new(test: &str) -> Self {
        Self(crate::tools::folder(&format!("cli-{test}")))
    }

    pub fn path(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }

    pub fn write(&self, name: &str, bytes: &[u8]) -> String {
        fs::write(self.0.join(name), bytes).unwrap();
        self.path(name)
    }

    /// Every file below the folder, with its bytes.
    pub fn files(&self) -> Vec<(String, Vec<u8>)> {
        let mut all = Vec::new();
        let mut folders = vec![self.0.clone()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(&folder).unwrap() {
                let path = entry.unwrap().path();
                match path.is_dir() {
                    true => folders.push(path),
                    false => all.push((path.display().to_string(), fs::read(&path).unwrap())),
                }
            }
        }
        all.sort();
        all
    }
}

/// The program that has a command: the generator, unless only another one has it.
pub fn program_of(command: &str) -> &'static str {
    let others = [
        ("endat", endat::command_line()),
        ("endat-workshop", endat_workshop::cli::command_line()),
    ];
    let has = |line: &clap::Command| line.find_subcommand(command).is_some();
    let other = others.iter().find(|(_, line)| has(line));
    match other {
        Some((name, _)) if !has(&endat_gen::cli::command_line()) => name,
        _ => "endat-gen",
    }
}

/// Runs the program that has the command in this process.
pub fn run(arguments: &[&str]) -> Outcome {
    let program = program_of(arguments.first().unwrap_or(&""));
    let words = std::iter::once(program).chain(arguments.iter().copied());
    match program {
        "endat" => endat::run(words),
        "endat-workshop" => endat_workshop::cli::run(words),
        _ => endat_gen::cli::run(words),
    }
}

pub fn good(arguments: &[&str]) -> String {
    let outcome = run(arguments);
    assert_eq!(
        (outcome.exit_code, &outcome.messages),
        (0, &vec![]),
        "{arguments:?}"
    );
    outcome.stdout
}

/// The messages of a run that must end with this exit code.
pub fn bad(arguments: &[&str], exit_code: u8) -> String {
    let outcome = run(arguments);
    assert_eq!(outcome.exit_code, exit_code, "{arguments:?}: {outcome:?}");
    assert!(!outcome.messages.is_empty(), "{arguments:?}");
    outcome.messages.join("\n")
}

pub fn program() -> Command {
    Command::new(GENERATOR)
}

/// The generator as a process.
pub const GENERATOR: &str = env!("CARGO_BIN_EXE_endat-gen");

/// Path of the program of another package, next to the generator; cargo builds it if it is not there or old.
fn built(package: &'static str) -> PathBuf {
    static BUILT: Mutex<BTreeSet<&str>> = Mutex::new(BTreeSet::new());
    let mut built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
    if built.insert(package) {
        let cargo = Command::new(env!("CARGO"))
            .args(["build", "--quiet", "--package", package])
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .status();
        assert!(cargo.unwrap().success(), "cargo build --package {package}");
    }
    PathBuf::from(GENERATOR).with_file_name(format!("{package}{}", std::env::consts::EXE_SUFFIX))
}

/// Path of the program `endat`.
pub fn endat_path() -> PathBuf {
    built("endat")
}

/// The program `endat` as a process.
pub fn endat() -> Command {
    Command::new(endat_path())
}

/// Sends a signal by its name to a process. The shell's own command is on every machine, a program of that name is not.
#[cfg(unix)]
pub fn signal(process: &Child, name: &str) {
    let command = format!("kill -{name} {}", process.id());
    let sent = Command::new("sh").args(["-c", &command]).status();
    assert!(sent.unwrap().success(), "{command}");
}

/// The program, left running, and the line that it begins with.
pub fn begun(command: &mut Command) -> (Child, String) {
    let quiet = command.stdout(Stdio::piped()).stderr(Stdio::null());
    let mut program = quiet.spawn().unwrap();
    let mut line = String::new();
    let mut told = BufReader::new(program.stdout.take().unwrap());
    told.read_line(&mut line).unwrap();
    (program, line)
}
