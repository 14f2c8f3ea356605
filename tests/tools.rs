//! Outside tools: those of `design/tests/tools.rs`, each in the table of strangers.

#[path = "golden.rs"]
mod golden;
#[path = "../design/tests/tools.rs"]
mod plain;

pub use golden::{assert_committed, difference, renewing};
pub use plain::{cannot, folder, has, run, skip};
use std::collections::BTreeSet;
use std::process::{Command, Stdio};
use std::sync::LazyLock;

/// Programs and modules that `tests/strangers/table.toml` names.
static LISTED: LazyLock<BTreeSet<String>> = LazyLock::new(|| {
    let table: toml::Table = include_str!("strangers/table.toml").parse().unwrap();
    let rows = table["stranger"].as_array().unwrap().iter();
    let lists = rows.flat_map(|row| [row.get("programs"), row.get("modules")]);
    let names = lists
        .flatten()
        .flat_map(|list| list.as_array().unwrap().iter());
    names
        .map(|name| name.as_str().unwrap().to_owned())
        .collect()
});

/// Checks that the page on programs of others names this program or module.
///
/// # Panics
/// If it does not.
pub fn assert_listed(call: &str) {
    assert!(
        LISTED.contains(call),
        "{call}: a test runs it; add it to tests/strangers/table.toml"
    );
}

/// Whether all these tools are installed, see [`require`].
pub fn require_all(tools: &[&str], check: &str) -> bool {
    tools.iter().all(|tool| require(tool, check))
}

/// Whether a check that needs `tool` can run. If not, the check is listed as skipped, or fails in CI.
pub fn require(tool: &str, check: &str) -> bool {
    assert_listed(tool);
    plain::require(tool, check)
}

/// The same for a module of Python.
pub fn require_python(module: &str, check: &str) -> bool {
    assert_listed(module);
    let import = Command::new("python3")
        .args(["-c", &format!("import {module}")])
        .stderr(Stdio::null())
        .status();
    import.is_ok_and(|s| s.success()) || skip(&format!("Python module {module}"), check)
}

/// Says that a check is skipped for lack of something that the command in `why` brings.
///
/// # Panics
/// In CI.
pub fn lacks(why: &str, check: &str) {
    assert!(std::env::var_os("CI").is_none(), "{check}: {why}");
    cannot(why, check);
}
