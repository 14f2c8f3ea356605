//! The table of strangers (`table.toml`): whom the suite runs, in which version, to do what, and which test shows it.
//! `docs/works-with.md` is written from it.

use super::configurations::texts;
use crate::tools;
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::Command;
use std::sync::LazyLock;

const PAGE: &str = "docs/works-with.md";

/// A row of the table.
struct Stranger {
    name: &'static str,
    /// Its package in Python's index, if it is one.
    pip: Option<&'static str>,
    version: &'static str,
    asks: Vec<&'static str>,
    does: &'static str,
    /// `file::function`.
    tests: Vec<&'static str>,
}

static TABLE: LazyLock<toml::Table> = LazyLock::new(|| include_str!("table.toml").parse().unwrap());
static STRANGERS: LazyLock<Vec<Stranger>> = LazyLock::new(|| {
    let rows = TABLE["stranger"].as_array().unwrap();
    rows.iter()
        .map(|row| stranger(row.as_table().unwrap()))
        .collect()
});

fn words(row: &'static toml::Table, key: &str) -> Vec<&'static str> {
    let list = row.get(key).and_then(toml::Value::as_array);
    let words = list.into_iter().flatten();
    words.map(|word| word.as_str().unwrap()).collect()
}

fn stranger(row: &'static toml::Table) -> Stranger {
    let known = [
        "name", "pip", "version", "install", "asks", "programs", "modules", "does", "tests",
    ];
    for key in row.keys() {
        assert!(known.contains(&key.as_str()), "{key}: unknown");
    }
    let text = |key: &str| row.get(key).and_then(toml::Value::as_str);
    let name = text("name").unwrap();
    let pip = text("pip");
    let version = match (pip, text("version")) {
        (Some(package), None) => installed_by_ci(package),
        (None, Some(version)) => version,
        _ => panic!("{name}: write pip or version, not both"),
    };
    Stranger {
        name,
        pip,
        version,
        asks: words(row, "asks"),
        does: text("does").unwrap(),
        tests: words(row, "tests"),
    }
}

/// The version of a package that CI installs: exactly one.
fn installed_by_ci(package: &str) -> &'static str {
    let script = include_str!("../../.ci/install");
    let words = script.split_whitespace();
    let mut versions = words.filter_map(|w| w.strip_prefix(package)?.strip_prefix("=="));
    let version = versions.next();
    assert!(
        versions.next().is_none(),
        "{package}: .ci/install has two versions"
    );
    version.unwrap_or_else(|| panic!("{package}: .ci/install does not install it with =="))
}

/// The page.
fn page() -> String {
    let mut text = "# Works with\n\nPrograms of others, and what they make of what is emitted or served here. None is patched, and none has \
        a setting made for this project. The suite runs each of them (`.ci/run` installs them all and refuses to go on without one); \
        a row is there because its tests pass.\n\n| program | version | what it does | shown by |\n|---|---|---|---|\n"
        .to_owned();
    for stranger in STRANGERS.iter() {
        let shown = stranger.tests.iter().map(|test| {
            let (file, function) = test.split_once("::").unwrap();
            format!("[`{function}`](../{file})")
        });
        let shown: Vec<String> = shown.collect();
        let Stranger {
            name,
            version,
            does,
            ..
        } = stranger;
        let _ = writeln!(
            text,
            "| {name} | {version} | {does} | {} |",
            shown.join("<br>")
        );
    }
    let names: Vec<String> = texts()
        .iter()
        .map(|(name, _)| format!("`{name}`"))
        .collect();
    let _ = write!(
        text,
        "\nVersions are those that ran last; others may do as well. Every emission is one of {} configurations: the presets, and cards that \
         have each bus, part and extreme that no preset has: {}.\n\nThis page is written from `tests/strangers/table.toml`: \
         `UPDATE_EXPECT=1 cargo test --test emission strangers::table`. The benches of all emissions, and of cards with every bus and every \
         usual clock, are slow tests: `cargo test --test emission strangers -- --ignored`.\n",
        names.len(),
        names.join(", ")
    );
    text
}

/// What a stranger answers when it is asked for its version; `None` if it is not there.
fn told(stranger: &Stranger) -> Option<String> {
    let output = match stranger.pip {
        Some(package) => {
            let script = format!("import importlib.metadata as m; print(m.version('{package}'))");
            Command::new("python3").args(["-c", &script]).output()
        }
        None => Command::new(stranger.asks[0])
            .args(&stranger.asks[1..])
            .output(),
    };
    let output = output.ok().filter(|o| o.status.success())?;
    let text = [output.stdout, output.stderr].concat();
    Some(String::from_utf8_lossy(&text).into_owned())
}

/// Whether a text has this version as a word.
fn has_version(text: &str, version: &str) -> bool {
    let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '.'));
    let is_it = |word: &str| {
        let rest = word.trim_start_matches('v').strip_prefix(version);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    words.into_iter().any(is_it)
}

#[test]
fn the_page_is_the_table_s() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(PAGE);
    tools::assert_committed(&path, &page());
}

/// A row whose test is gone says nothing.
#[test]
fn every_row_has_a_test_that_is_there() {
    for stranger in STRANGERS.iter() {
        assert!(
            !stranger.tests.is_empty(),
            "{}: no test shows it",
            stranger.name
        );
        for test in &stranger.tests {
            let (file, function) = test.split_once("::").unwrap();
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
            let source = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{test}: {e}"));
            let lines: Vec<&str> = source.lines().map(str::trim).collect();
            let start = format!("fn {function}(");
            let at = lines.iter().position(|line| line.starts_with(&start));
            let at = at.unwrap_or_else(|| panic!("{test}: there is no such function"));
            let before = lines[..at].iter().rev();
            let mut attributes = before.take_while(|l| l.starts_with("#[") || l.starts_with("///"));
            assert!(attributes.any(|l| *l == "#[test]"), "{test}: is no test");
        }
    }
}

/// What CI installs is what the page says; another version of anything else is told in a line.
#[test]
fn every_stranger_tells_its_version() {
    for stranger in STRANGERS.iter() {
        let Stranger {
            name, version, pip, ..
        } = stranger;
        let Some(told) = told(stranger) else {
            let in_ci = std::env::var_os("CI").is_some();
            assert!(
                !in_ci,
                "{name}: does not tell its version, and CI requires it"
            );
            tools::cannot("it is not installed", &format!("version of {name}"));
            continue;
        };
        let is_same = has_version(&told, version);
        assert!(
            is_same || pip.is_none(),
            "{name}: is {told}, and .ci/install installs {version}"
        );
        if !is_same {
            let first = told.lines().next().unwrap_or("");
            let line = format!("{name} is {first:?} here, and {version} in {PAGE}");
            let _ = writeln!(std::io::stderr(), "NOTE {line}");
        }
    }
}
