//! Running the program: in this process, or as a process of its own.

use endat_gen::cli::{self, Outcome};
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};

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

pub fn run(arguments: &[&str]) -> Outcome {
    cli::run(std::iter::once("endat-gen").chain(arguments.iter().copied()))
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
    Command::new(env!("CARGO_BIN_EXE_endat-gen"))
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
