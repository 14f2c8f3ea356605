//! Rules of the test suite: how long a binary is, what slow tests say, and that no verdict is kept.

use super::{walk, CRATES};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Longest test binary: the sum of its files. A longer one is slow to build, and has too many topics.
const BINARY_LINES: usize = 10_000;

/// Adds a file of a crate and the files of its modules. `folder` is the place of the modules that it declares.
fn add_modules(file: &Path, folder: &Path, found: &mut BTreeSet<PathBuf>) {
    let file = file
        .canonicalize()
        .unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let parsed = syn::parse_file(&fs::read_to_string(&file).unwrap()).unwrap();
    let place = file.parent().unwrap().to_owned();
    if found.insert(file) {
        add_declared(&parsed.items, &place, folder, found);
    }
}

/// Adds the modules that these items declare; `place` is the folder of their file, `folder` that of its modules.
fn add_declared(items: &[syn::Item], place: &Path, folder: &Path, found: &mut BTreeSet<PathBuf>) {
    for item in items {
        let syn::Item::Mod(module) = item else {
            continue;
        };
        let inside = folder.join(module.ident.to_string());
        let path = module.attrs.iter().find_map(|a| {
            let value = &a.meta.require_name_value().ok()?.value;
            let syn::Expr::Lit(literal) = value else {
                return None;
            };
            match &literal.lit {
                syn::Lit::Str(text) if a.path().is_ident("path") => Some(text.value()),
                _ => None,
            }
        });
        match (&module.content, path) {
            (Some((_, items)), _) => add_declared(items, &inside, &inside, found),
            (None, Some(path)) => {
                let file = place.join(path);
                add_modules(&file, file.parent().unwrap(), found);
            }
            (None, None) => {
                let single = inside.with_extension("rs");
                let file = match single.exists() {
                    true => single,
                    false => inside.join("mod.rs"),
                };
                add_modules(&file, &inside, found);
            }
        }
    }
}

#[test]
fn no_test_binary_is_above_10_000_lines() {
    let members = crate::packages::members();
    let packages = members["packages"].as_array().unwrap().iter();
    let targets = packages.flat_map(|p| p["targets"].as_array().unwrap());
    let mut lines = BTreeMap::new();
    for target in targets.filter(|t| t["kind"][0] == "test") {
        let file = Path::new(target["src_path"].as_str().unwrap());
        let mut files = BTreeSet::new();
        add_modules(file, file.parent().unwrap(), &mut files);
        let of = |file: &PathBuf| fs::read_to_string(file).unwrap().lines().count();
        lines.insert(
            target["name"].as_str().unwrap(),
            files.iter().map(of).sum::<usize>(),
        );
    }
    for name in [
        "configuration",
        "emission",
        "cards",
        "programs",
        "delivery",
        "endat",
        "blocks",
        "designs",
    ] {
        assert!(lines[name] > 1_000, "{lines:?}");
    }
    lines.retain(|_, lines| *lines > BINARY_LINES);
    assert!(lines.is_empty(), "above {BINARY_LINES} lines: {lines:?}");
}

/// Every file of the repository in folders that people write.
fn written_files() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = vec![];
    let folders = ["tests", "gen", "drivers", "campaigns", ".ci"];
    for folder in CRATES.iter().chain(&folders) {
        let folder = root.join(folder);
        if folder.exists() {
            walk(&folder, &mut files);
        }
    }
    files.sort();
    files.dedup();
    files
}

/// Verdicts of earlier runs are not kept: a test that is in the suite runs. One that is too slow is ignored, and its reason says what it
/// covers: CI runs these at night.
#[test]
fn slow_tests_say_what_they_cover_and_no_verdict_is_kept() {
    let files = written_files();
    assert!(files.len() > 500, "{} files", files.len());
    let mut slow = 0;
    for path in files {
        let name = path.file_name().unwrap().to_str().unwrap();
        let path_text = path.display();
        assert!(
            !["passed.toml", "passed.rs"].contains(&name),
            "{path_text}: keeps verdicts; delete it"
        );
        if !name.ends_with(".rs") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        for (number, line) in (1..).zip(text.lines()) {
            if line.trim_start().starts_with("#[ignore") {
                let reason = line.trim().strip_prefix("#[ignore = \"slow: ");
                assert!(
                    reason.is_some_and(|r| r.len() > "\"]".len()),
                    "{path_text}:{number}: give the reason: #[ignore = \"slow: WHAT IT COVERS\"]"
                );
                slow += 1;
            }
        }
    }
    assert!(slow > 0, "no slow test");
}
