//! docs/ssi.md: each of its statements has a test, and its tables are what the sources have.

use crate::program::{bad, good};
use endat_config::parse;
use endat_hdl::protocols::ssi::cause;
use endat_hdl::protocols::ssi::specials::Special;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

const PAGE: &str = include_str!("../../docs/ssi.md");
const PROMISES: &str = include_str!("../data/ssi_promises.txt");
const ROOT: &str = env!("CARGO_MANIFEST_DIR");
/// Folders with tests.
const FOLDERS: [&str; 6] = ["tests", "sim", "hdl", "gen", "host", "drivers"];

/// Sentences, and rows of tables; code and headings are not among them.
fn statements() -> Vec<&'static str> {
    let lines: Vec<&str> = PAGE.lines().collect();
    let (mut found, mut is_code) = (vec![], false);
    for (n, line) in lines.iter().enumerate() {
        is_code ^= line.starts_with("```");
        let is_rule = |line: Option<&&str>| line.is_some_and(|l| l.starts_with("|---"));
        match line.chars().next() {
            None | Some('#') => {}
            Some('`') if line.starts_with("```") => {}
            _ if is_code || is_rule(Some(line)) || is_rule(lines.get(n + 1)) => {}
            Some('|') => found.push(*line),
            _ => found.extend(line.split(". ")),
        }
    }
    found
}

/// Adds the tests of Rust files; true if it runs in `cargo test`.
fn add_tests(path: &Path, found: &mut BTreeMap<String, bool>) {
    if path.is_dir() {
        let entries = fs::read_dir(path).unwrap();
        entries.for_each(|entry| add_tests(&entry.unwrap().path(), found));
    } else if path.extension().is_some_and(|e| e == "rs") {
        let text = fs::read_to_string(path).unwrap();
        for test in text.split("#[test]\n").skip(1) {
            let (head, name) = test.split_once("fn ").unwrap();
            let name = name.split('(').next().unwrap();
            found.insert(name.to_owned(), !head.contains("#[ignore"));
        }
    }
}

/// Catches a sentence without a test, a test that is gone, and words that are not in the page any more.
#[test]
fn each_statement_of_the_page_on_ssi_has_a_test() {
    let mut tests = BTreeMap::new();
    for folder in FOLDERS {
        add_tests(&Path::new(ROOT).join(folder), &mut tests);
    }
    let statements = statements();
    assert!(statements.len() > 90, "{}", statements.len());
    let mut wrong = vec![];
    let rows = PROMISES.lines().filter(|line| !line.starts_with('#'));
    let rows: Vec<(&str, &str)> = rows.map(|r| r.split_once(" => ").expect(r)).collect();
    for (words, names) in &rows {
        let is_there = statements.iter().filter(|s| s.contains(words)).count();
        if is_there != 1 {
            wrong.push(format!("{words}: in {is_there} statements"));
        }
        if *names == "-" {
            continue;
        }
        let names = names.split(' ').map(|name| (name, tests.get(name)));
        let names: Vec<_> = names.collect();
        let absent = names.iter().filter(|(_, is_quick)| is_quick.is_none());
        wrong.extend(absent.map(|(name, _)| format!("{words}: {name} is no test")));
        if !names.iter().any(|(_, is_quick)| *is_quick == Some(&true)) {
            wrong.push(format!("{words}: no test of `cargo test`"));
        }
    }
    let has_test = |s: &&&str| !rows.iter().any(|(words, _)| s.contains(words));
    let open = statements.iter().filter(has_test);
    wrong.extend(open.map(|s| format!("{s}: has no line in ssi_promises.txt")));
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// The cells of the rows between a heading of a table and its end.
fn table(heading: &str) -> Vec<Vec<&'static str>> {
    let (_, rows) = PAGE.split_once(heading).expect(heading);
    let rows = rows.lines().skip(2).take_while(|l| l.starts_with('|'));
    let cells = |row: &'static str| row.trim_matches('|').split('|').map(str::trim).collect();
    rows.map(cells).collect()
}

#[test]
fn tables_of_the_page_on_ssi_are_those_of_the_sources() {
    let words = table("| word | the bit |");
    let words: Vec<&str> = words.iter().flat_map(|row| row[0].split(", ")).collect();
    let known = Special::ALL.map(|(_, word, _)| format!("`{word}`"));
    assert_eq!(words, known);
    let causes = table("| cause | name | meaning |");
    let known = cause::ALL[1..].iter();
    let known: Vec<_> = known.map(|c| (c.code.to_string(), c.name)).collect();
    assert_eq!(causes.len(), known.len());
    for (row, (code, name)) in causes.iter().zip(known) {
        assert_eq!(row[..2], [code, format!("`{name}`")]);
        let told = good(&["explain", name]);
        assert!(told.contains(name), "{told}");
    }
    let range = |name: &str| {
        let fields = endat_regs::protocols::ssi::PROTOCOL.fields;
        fields.iter().find(|f| f.field == name).unwrap().takes
    };
    assert_eq!(range("period_cycles"), [(4, 2047)]);
    assert!(PAGE.contains("`frame.period_cycles` (4 to 2047)"));
}

/// The configurations that other tests run.
#[test]
fn devices_of_the_page_on_ssi_have_the_keys_that_are_tried() {
    let rows = table("| encoder, or device that reads it | keys |");
    let names = ["el5001", "epos4", "as5045", "mt6701"];
    assert_eq!(rows.len(), names.len());
    for (row, name) in rows.iter().zip(names) {
        let file = format!("{ROOT}/tests/data/ssi_status_bits/{name}.toml");
        let project = parse(name, &fs::read_to_string(file).unwrap()).unwrap();
        let channel = &project.card.channels[0];
        let asked = channel.spoken.ssi().unwrap();
        let mut keys = format!("`position_bits = {}`", channel.position_bits);
        if !asked.before.is_empty() {
            assert_eq!(asked.before.bits(), 8);
            assert!(asked
                .before
                .iter()
                .all(|special| special == Special::Ignored));
            keys += ", `bits_before` with eight times `\"ignored\"`";
        }
        if !asked.after.is_empty() {
            keys += &format!(", `bits_after = {}`", asked.after);
        }
        assert_eq!(row[1], keys, "{name}");
    }
}

/// Each key of the example may be left out where it says `(default)`, and has the default that it names.
#[test]
fn keys_of_the_page_on_ssi_have_the_defaults_that_it_names() {
    let (_, example) = PAGE.split_once("```toml\n").unwrap();
    let (example, _) = example.split_once("```").unwrap();
    let channel = |lines: &[String]| {
        let text = format!(
            "name = \"page\"\n[clock]\nsystem_hz = 100_000_000\n{}\n[trigger]\nsample_hz = 500\n[host]\nbus = \"apb\"\n",
            lines.join("\n")
        );
        let project = parse("page.toml", &text).unwrap_or_else(|e| panic!("{text}{e:?}"));
        format!("{:?}", project.card.channels[0])
    };
    let lines: Vec<String> = example.lines().map(str::to_owned).collect();
    let whole = channel(&lines);
    let mut defaults = 0;
    for (n, line) in lines.iter().enumerate() {
        let Some((_, rest)) = line.split_once("(default") else {
            continue;
        };
        let mut without = lines.clone();
        without.remove(n);
        let (key, _) = line.split_once(" = ").unwrap();
        let named = rest.split_once(')').unwrap().0.trim_start_matches(": ");
        match named {
            "not known" => continue,
            "" => assert_eq!(channel(&without), whole, "{line}"),
            value => {
                let mut with = lines.clone();
                with[n] = format!("{} = {value}", key.trim());
                assert_eq!(channel(&with), channel(&without), "{line}");
            }
        }
        defaults += 1;
    }
    assert_eq!(defaults, 12, "of the keys in the example");
}

/// Catches a report that is silent of a position that nothing checks, or that finds fault with one that is checked.
#[test]
fn explain_says_what_checks_an_ssi_position() {
    let warns = |keys: &str| {
        let text = format!(
            "name = \"one\"\n[clock]\nsystem_hz = 100_000_000\n[[channel]]\nprotocol = \"ssi\"\nposition_bits = 12\nclock_hz = 500_000\n{keys}\n\
             [trigger]\nsample_hz = 500\n[host]\nbus = \"apb\"\n"
        );
        let project = parse("one.toml", &text).unwrap();
        let told = endat_config::explain::report(&project).to_string();
        told.contains("nothing to check it by: see twice and parity")
    };
    let others = [
        "",
        "code = \"gray\"",
        "bits_after = [\"alarm\", \"shown\"]",
        "end_low = false",
    ];
    assert_eq!(others.map(warns), [true; 4]);
    let checks = [
        "twice = true",
        "parity = \"odd\"",
        "bits_after = [\"parity_even\"]",
        "bits_after = [\"crc6\"]",
    ];
    assert_eq!(checks.map(warns), [false; 4]);
}

#[test]
fn parts_of_other_channels_and_commands_are_refused_to_ssi() {
    let port = ["--port", "virtual:ssi_two_channel"];
    for command in [&["margin"][..], &["param", "read", "0xB9", "0"]] {
        bad(&[command, &port].concat(), 2);
    }
    for table in [
        "[service]\nparts = [\"requests\"]\n",
        "[line]\nparts = [\"margin\", \"alignment\"]\n",
    ] {
        let text = format!(
            "name = \"one\"\n[clock]\nsystem_hz = 100_000_000\n[[channel]]\nprotocol = \"ssi\"\nposition_bits = 12\nclock_hz = 500_000\n\
             [trigger]\nsample_hz = 500\n[host]\nbus = \"apb\"\n{table}"
        );
        let wrong = parse("one.toml", &text).unwrap_err();
        let told: Vec<String> = wrong.iter().map(ToString::to_string).collect();
        assert!(
            told[0].contains("takes a channel that speaks EnDat"),
            "{told:?}"
        );
    }
}
