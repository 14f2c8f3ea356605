//! Completions and manual pages.

use crate::program::{bad, good, Dir};
use crate::tools;
use std::fs;
use std::path::Path;

/// Every command that the help lists.
fn commands() -> Vec<String> {
    let help = good(&["--help"]);
    let list = help
        .split_once("Commands:")
        .unwrap()
        .1
        .split_once("\n\n")
        .unwrap()
        .0;
    let lines = list
        .lines()
        .filter(|l| l.starts_with("  ") && !l.starts_with("   "));
    let names = lines.filter_map(|l| l.split_whitespace().next());
    names.filter(|n| *n != "help").map(str::to_owned).collect()
}

/// Bash itself completes the line: catches completions that it cannot read, and a command that is not among them.
#[test]
fn bash_completes_every_command() {
    if !tools::require("bash", "completions") {
        return;
    }
    let dir = Dir::new("completions");
    dir.write("endat", good(&["completions", "bash"]).as_bytes());
    let script = "source ./endat; COMP_WORDS=(endat-gen ''); COMP_CWORD=1; \
        $(complete -p endat-gen | sed 's/.*-F \\([^ ]*\\).*/\\1/') endat-gen '' endat-gen; echo \"${COMPREPLY[@]}\"";
    let (is_good, told) = tools::run("bash", &dir.0, &["-c", script]);
    let offered: Vec<&str> = told.split_whitespace().collect();
    for command in commands() {
        assert!(
            is_good && offered.contains(&command.as_str()),
            "{command}: {told}"
        );
    }
    assert!(bad(&["completions", "csh"], 2).contains("possible values: bash"));
}

#[test]
fn every_command_has_a_manual_page_that_is_the_same_again() {
    let dir = Dir::new("man");
    let pages = |folder: &str| {
        let out = dir.path(folder);
        let told = good(&["man", "--out", &out]);
        let read = |line: &str| {
            let path = Path::new(line);
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            (name, fs::read_to_string(path).unwrap())
        };
        told.lines().map(read).collect::<Vec<_>>()
    };
    let found = pages("one");
    assert_eq!(found, pages("other"));
    assert_eq!(found[0], ("endat-gen.1".to_owned(), good(&["man"])));
    let has = |name: &str| {
        found
            .iter()
            .any(|(n, text)| n == name && text.starts_with(".ie"))
    };
    for command in commands() {
        assert!(has(&format!("endat-gen-{command}.1")), "{command}");
    }
    let out = dir.path("endat");
    let man = ["endat", "man", "--out", &out];
    assert_eq!(endat::run(man).exit_code, 0);
    let page = fs::read_to_string(dir.0.join("endat/endat-reg-write.1")).unwrap();
    assert!(page.starts_with(".ie"), "{page}");
    let file = dir.write("file", b"");
    assert!(bad(&["man", "--out", &file], 2).contains("give another folder with --out"));
}
