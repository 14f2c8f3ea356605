//! Outside tools: those of `design/tests/tools.rs`, each in the table of strangers.

#[path = "../design/tests/tools.rs"]
mod plain;

use crate::strangers::table as strangers;
use plain::skip;
pub use plain::{cannot, folder, has, run};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// Whether all these tools are there, see [`require`].
pub fn require_all(tools: &[&str], check: &str) -> bool {
    tools.iter().all(|tool| require(tool, check))
}

/// Whether a check that needs `tool` can run. If not, says which check is skipped, or fails in CI.
pub fn require(tool: &str, check: &str) -> bool {
    strangers::assert_listed(tool);
    plain::require(tool, check)
}

/// The same for a module of Python.
pub fn require_python(module: &str, check: &str) -> bool {
    strangers::assert_listed(module);
    let import = Command::new("python3")
        .args(["-c", &format!("import {module}")])
        .stderr(Stdio::null())
        .status();
    import.is_ok_and(|s| s.success()) || skip(&format!("Python module {module}"), check)
}

/// A committed file, after `UPDATE_EXPECT=1` has made it what it should be now.
pub fn committed(path: &Path, now: &str) -> String {
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        fs::write(path, now).unwrap();
    }
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Whether all of what this project breaks on purpose, and of what it measures, is tried: with `SUITE_WHOLE=1`.
pub fn is_whole() -> bool {
    std::env::var_os("SUITE_WHOLE").is_some()
}

/// A third of these, or all of them if [`is_whole`]. `turn` says which third; the length of a text, so that a change of it tries others.
pub fn third<T>(all: &[T], turn: usize) -> impl Iterator<Item = &T> {
    let of = if is_whole() { 1 } else { 3 };
    // Of two, one.
    let first = turn % of.min(all.len().max(1));
    all.iter().skip(first).step_by(of)
}

/// Catches a short list of which nothing is tried, and a place that never is.
#[test]
fn a_third_is_never_nothing_and_each_has_its_turn() {
    for count in 1..8 {
        let all: Vec<usize> = (0..count).collect();
        let thirds = (0..6).map(|turn| third(&all, turn).copied().collect::<Vec<_>>());
        let thirds: Vec<_> = thirds.collect();
        assert!(thirds.iter().all(|third| !third.is_empty()), "{count}");
        assert!(all
            .iter()
            .all(|n| thirds.iter().any(|third| third.contains(n))));
    }
}
