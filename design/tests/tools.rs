//! Outside tools. A tool that is missing is a skipped check with a line that says so; in CI (variable `CI` set) it is a failure.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Whether a tool can be started.
pub fn has(tool: &str) -> bool {
    let version = if tool == "iverilog" {
        "-V"
    } else {
        "--version"
    };
    Command::new(tool)
        .arg(version)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok()
}

/// Whether a check that needs `tool` can run. If not, says which check is skipped, or fails in CI.
pub fn require(tool: &str, check: &str) -> bool {
    has(tool) || skip(tool, check)
}

/// Says that a check is skipped because something is missing.
///
/// # Panics
/// In CI.
pub fn skip(what: &str, check: &str) -> bool {
    assert!(
        std::env::var_os("CI").is_none(),
        "{check}: {what} is not installed, and CI requires it"
    );
    cannot(&format!("{what} is not installed"), check);
    false
}

/// Says that a check is skipped, for a reason that no installation cures.
pub fn cannot(why: &str, check: &str) {
    // not eprintln!, which the test harness would swallow
    let _ = writeln!(std::io::stderr(), "SKIPPED {check}: {why}");
}

/// An empty folder for the files of one test.
pub fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

/// Runs a tool in a folder; its two outputs, and whether it was content.
pub fn run(tool: &str, folder: &Path, arguments: &[&str]) -> (bool, String) {
    let (good, text) = run_once(tool, folder, arguments);
    if good || !text.contains(ABC_ABORTED) {
        return (good, text);
    }
    let _ = writeln!(std::io::stderr(), "{tool}: its ABC aborted; once more");
    run_once(tool, folder, arguments)
}

/// Debian's ABC has aborted now and then on input that it takes the next time.
const ABC_ABORTED: &str = "failed: return code 134";

fn run_once(tool: &str, folder: &Path, arguments: &[&str]) -> (bool, String) {
    let output = Command::new(tool)
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap();
    let mut text = String::from_utf8_lossy(&output.stdout).into_owned();
    text.push_str(&String::from_utf8_lossy(&output.stderr));
    (output.status.success(), text)
}

pub fn is_whole() -> bool {
    false
}

pub fn third<T>(all: &[T], turn: usize) -> impl Iterator<Item = &T> {
    let of = 3;
    let first = turn % of.min(all.len().max(1));
    all.iter().skip(first).step_by(of)
}
