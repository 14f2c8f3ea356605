//! Files: what an emission leaves behind, and places that are no files.

use crate::program::{bad, good, run, Dir};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

#[test]
fn check_finds_every_kind_of_staleness_and_never_writes() {
    let dir = Dir::new("check");
    let out = dir.path("o");
    let check = ["emit", "--check", "--out", &out];
    let nothing = bad(&check, 1);
    assert!(nothing.contains("README.md: is missing"), "{nothing}");
    assert_eq!(dir.files(), vec![]);
    good(&["emit", "--out", &out]);
    assert!(good(&check).ends_with("up to date\n"));
    let folder = dir.0.join("o/s6_two_channel");
    fs::write(folder.join("README.md"), "x").unwrap();
    fs::remove_file(folder.join("s6_two_channel.ucf")).unwrap();
    fs::write(folder.join("old.v"), "x").unwrap();
    let manifest = fs::read_to_string(folder.join("MANIFEST")).unwrap();
    fs::write(
        folder.join("MANIFEST"),
        format!("{manifest}0  old.v\n0  ../../o.v\n"),
    )
    .unwrap();
    let before = dir.files();
    let found = bad(&check, 1);
    for text in [
        "README.md: is not what",
        "s6_two_channel.ucf: is missing",
        "MANIFEST: is not what",
        "old.v: is no longer emitted, but has been changed; delete it",
    ] {
        assert!(found.contains(text), "{text}\n{found}");
    }
    assert!(!found.contains("../o.v"), "{found}");
    assert!(
        found.ends_with(&format!(
            "renew with: cargo run -- emit --out {out} --force"
        )),
        "{found}"
    );
    assert_eq!(dir.files(), before);
}

/// A card of its own in `o/card`: the preset with some texts replaced.
fn emit(dir: &Dir, changes: &[(&str, &str)]) -> (PathBuf, Vec<String>) {
    let text = good(&["presets", "--show", "s6_two_channel"]).replace("s6_two_channel", "card");
    let change = |text: String, (from, to): &(&str, &str)| text.replacen(from, to, 1);
    let text = changes.iter().fold(text, change);
    let file = dir.write("card.toml", text.as_bytes());
    let outcome = run(&["emit", "--config", &file, "--out", &dir.path("o")]);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    (dir.0.join("o/card"), outcome.messages)
}

/// Another card: it has blocks that the preset lacks, and lacks some that the preset has.
const OTHER: [(&str, &str); 2] = [
    ("parts = []", "parts = [\"requests\"]"),
    ("fifo_bytes = 2_048", "fifo_bytes = 0"),
];

/// A file of one emission that another has not.
fn block_of(folder: &Path, other: &[String]) -> String {
    let names = names(folder);
    let own = names.iter().find(|n| !other.contains(n));
    own.expect("configurations with different blocks").clone()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_file_that_is_no_longer_emitted_goes_unless_its_owner_changed_it() {
    let other = Dir::new("stale-other");
    let (fresh, _) = emit(&other, &OTHER);
    let expected = names(&fresh);
    let dir = Dir::new("stale");
    let (folder, _) = emit(&dir, &[]);
    let block = block_of(&folder, &expected);
    let config = dir.path("card.toml");
    let check = [
        "emit",
        "--check",
        "--config",
        &config,
        "--out",
        &dir.path("o"),
    ];
    fs::copy(other.0.join("card.toml"), &config).unwrap();
    let found = bad(&check, 1);
    assert!(
        found.contains(&format!("{block}: is no longer emitted; emit removes it")),
        "{found}"
    );
    fs::write(folder.join("mine.txt"), "x").unwrap();
    let (_, messages) = emit(&dir, &OTHER);
    assert_eq!(messages, [""; 0]);
    let mut left = names(&folder);
    left.retain(|n| n != "mine.txt");
    assert_eq!(left, expected);
    assert!(folder.join("mine.txt").exists(), "not ours");
    good(&check);

    // The way back, with a block that its owner has changed.
    let changed = block_of(&folder, &{
        let third = Dir::new("stale-third");
        names(&emit(&third, &[]).0)
    });
    fs::write(folder.join(&changed), "// mine").unwrap();
    let (_, messages) = emit(&dir, &[]);
    let text = format!("{changed}: is no longer emitted, but has been changed");
    assert!(
        messages.len() == 1 && messages[0].contains(&text),
        "{messages:?}"
    );
    // It stays, and is none of the card's files any more.
    assert!(folder.join(&changed).exists());
    let list = fs::read_to_string(folder.join("card.f")).unwrap();
    assert!(
        !list.contains(&changed) && list.contains("card_channel.v"),
        "{list}"
    );
}

/// What its owner has changed, or put there, is refused with the way out; nothing at all has been written then.
#[test]
fn emit_overwrites_only_what_it_has_written() {
    let dir = Dir::new("by-hand");
    let (folder, _) = emit(&dir, &[]);
    let config = dir.path("card.toml");
    let out = dir.path("o");
    let emit = ["emit", "--config", &config, "--out", &out];
    // A configuration that changes many files.
    let text = fs::read_to_string(&config).unwrap();
    fs::write(
        &config,
        text.replacen("sample_hz = 10_000", "sample_hz = 5_000", 1),
    )
    .unwrap();
    let top = folder.join("card.v");
    let mine = fs::read_to_string(&top).unwrap() + "// mine\n";
    fs::write(&top, &mine).unwrap();
    let before = dir.files();
    let told = bad(&emit, 2);
    assert!(
        told.contains("card.v: has been changed, or was not written by emit, and would be lost; move it away, give another folder with --out, or --force")
            && told.lines().count() == 1,
        "{told}"
    );
    assert_eq!(dir.files(), before);
    // A file of somebody else in the place of one that is new.
    let other = Dir::new("not-ours");
    let place = other.0.join("o/card");
    fs::create_dir_all(&place).unwrap();
    fs::write(place.join("README.md"), "mine").unwrap();
    fs::write(place.join("MANIFEST"), "mine, too\n").unwrap();
    let told = bad(&["emit", "--config", &config, "--out", &other.path("o")], 2);
    assert!(
        told.contains("README.md: has been") && told.contains("MANIFEST: has been"),
        "{told}"
    );
    assert_eq!(names(&place), ["MANIFEST", "README.md"]);
    good(&[&emit[..], &["--force"]].concat());
    assert_ne!(fs::read_to_string(&top).unwrap(), mine);
    assert!(good(&emit).ends_with("up to date\n"));
    // What emit wrote itself is renewed without a word.
    fs::write(&config, text).unwrap();
    good(&emit);
}

#[test]
fn the_manifest_is_what_sha256sum_reads() {
    let dir = Dir::new("sha256sum");
    let (folder, _) = emit(&dir, &[]);
    let manifest = fs::read_to_string(folder.join("MANIFEST")).unwrap();
    assert_eq!(manifest.lines().count() + 1, names(&folder).len());
    for line in manifest.lines() {
        let (digest, name) = line.split_once("  ").unwrap();
        assert!(digest.len() == 64 && folder.join(name).is_file(), "{line}");
    }
    let check = Command::new("sha256sum")
        .args(["-c", "--quiet", "MANIFEST"])
        .current_dir(&folder)
        .status();
    assert!(check.map_or(true, |status| status.success()));
}

#[test]
fn two_files_in_one_place_are_refused() {
    let dir = Dir::new("one-place");
    let (out, same) = (dir.path("x.out"), dir.path("../cli-one-place/x.out"));
    let rows = [
        ["--svg", &out, "--vcd", &out],
        ["--svg", &same, "--vcd", &out],
        ["--svg", &dir.path("x.gtkw"), "--vcd", &dir.path("x.vcd")],
    ];
    for files in rows {
        let message = bad(&[&["sim", "paper"], &files[..]].concat(), 2);
        assert!(
            message.contains("is the place of a file of --vcd; give another file"),
            "{message}"
        );
    }
    assert!(bad(&["sim", "paper", "--vcd", &dir.path("x.gtkw")], 2)
        .contains("give a name that ends in .vcd"));
    assert_eq!(dir.files(), vec![]);
}

#[cfg(unix)]
#[test]
fn what_is_no_regular_file_is_neither_read_nor_replaced() {
    use std::os::unix::fs::FileTypeExt;
    let dir = Dir::new("irregular");
    let pipe = dir.path("pipe");
    if !Command::new("mkfifo")
        .arg(&pipe)
        .status()
        .is_ok_and(|s| s.success())
    {
        return;
    }
    let rows: [&[&str]; 4] = [
        &["explain", "--config", &pipe],
        &["emit", "--config", &pipe],
        &["sim", "paper", "--svg", &pipe],
        &["sim", "paper", "--vcd", &pipe],
    ];
    for arguments in rows {
        let message = bad(arguments, 2);
        assert!(
            message.contains(": is not a regular file; give "),
            "{message}"
        );
    }
    assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
    let (folder, _) = emit(&dir, &[]);
    fs::remove_file(folder.join("README.md")).unwrap();
    fs::rename(&pipe, folder.join("README.md")).unwrap();
    let config = dir.path("card.toml");
    let out = dir.path("o");
    let found = bad(&["emit", "--check", "--config", &config, "--out", &out], 1);
    assert!(
        found.contains("README.md: is not a regular file; move it away first"),
        "{found}"
    );
    bad(&["emit", "--config", &config, "--out", &out], 2);
}

/// Nothing is recorded that could not be kept, and no port is opened for it.
#[cfg(unix)]
#[test]
fn places_of_a_recording_are_looked_at_before_the_port() {
    let dir = Dir::new("recording");
    let rows = dir.path("rows.csv");
    let (link, below) = (dir.path("link.svg"), dir.path("rows.csv/x.svg"));
    std::os::unix::fs::symlink(&rows, &link).unwrap();
    let folder = dir.0.display().to_string();
    let text = dir.write("notes.txt", b"mine");
    let (nowhere, in_text) = ("/proc/x.svg".to_owned(), format!("{text}/deep/x.svg"));
    let other = std::env::temp_dir().join("other.svg").display().to_string();
    for (out, svg, told) in [
        (&rows, &link, "--svg = "),
        (
            &rows,
            &rows,
            "is the place of a file of --out; give another file",
        ),
        (&rows, &below, "below the other; give another file"),
        (
            &folder,
            &other,
            "is a folder, not a file; give another file",
        ),
        (&rows, &nowhere, "no file can be made in /proc: "),
        (&rows, &in_text, "no file can be made in "),
        (&in_text, &other, "--out = "),
        (
            &rows,
            &text,
            "holds something else; only files of this program are replaced",
        ),
        // Nothing is wrong with them, so the port is next.
        (
            &dir.path("a/b/rows.csv"),
            &dir.path("c/x.svg"),
            "/none/port: ",
        ),
    ] {
        let log = ["log", "--port", "/none/port", "--out", out, "--svg", svg];
        let message = bad(&log, 2);
        assert!(message.contains(told), "{log:?}: {message}");
        assert_eq!(message.contains("/none/port"), told == "/none/port: ");
    }
}

#[cfg(unix)]
#[test]
fn a_link_to_a_file_stays_a_link() {
    let dir = Dir::new("link");
    let target = dir.write("target.svg", b"");
    let link = dir.0.join("link.svg");
    std::os::unix::fs::symlink(&target, &link).unwrap();
    let outcome = run(&["sim", "paper", "--svg", &link.display().to_string()]);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert!(fs::read_to_string(&target).unwrap().starts_with("<svg"));
}

#[test]
fn sim_names_a_remedy_that_it_has() {
    let dir = Dir::new("sim-remedy");
    let folder = dir.0.display().to_string();
    let message = bad(&["sim", "paper", "--svg", &folder], 2);
    assert!(
        message.ends_with(": is a folder, not a file; give another file"),
        "{message}"
    );
}

#[test]
fn pictures_replace_only_pictures() {
    let dir = Dir::new("foreign");
    let (svg, vcd) = (dir.path("a.svg"), dir.path("a.vcd"));
    let draw = ["sim", "lc416", "--svg", &svg, "--vcd", &vcd];
    assert_eq!(run(&draw).exit_code, 0);
    let drawn = dir.files();
    assert_eq!(drawn.len(), 3);
    // Files of its own, also those of another scenario, are replaced.
    let other = ["sim", "real-1", "--svg", &svg, "--vcd", &vcd];
    assert_eq!(run(&other).messages.len(), 3);
    assert_eq!(run(&draw).messages.len(), 3);
    assert!(dir.files() == drawn);
    let foreign = b"<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\"/>\n";
    let rows: [(&str, &str, &[u8]); 4] = [
        ("--svg", "a.svg", b"[clock]\n"),
        ("--svg", "a.svg", foreign),
        ("--vcd", "a.vcd", b"$date today $end\n"),
        (
            "--vcd",
            "a.gtkw",
            b"[*]\n[*] GTKWave Analyzer, saved by its user\n",
        ),
    ];
    for (option, name, bytes) in rows {
        let path = dir.write(name, bytes);
        let before = dir.files();
        let wanted = format!("{option} = {path}: holds something else; only files of this program are replaced; give another file, or delete this one");
        assert_eq!(bad(&other, 2), wanted);
        assert!(dir.files() == before, "{name}");
        std::fs::remove_file(path).unwrap();
        assert!(run(&draw).exit_code == 0 && dir.files() == drawn);
    }
}
