//! What PeakRDL makes of the SystemRDL file: its listing, its C header, its IP-XACT.

use super::{projects, text_of, Word};
use crate::tools::{self, require};
use endat_config::Project;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Every word with its byte address.
fn places(project: &Project) -> BTreeSet<String> {
    let words = Word::all(&project.card);
    let place = |w: &Word| format!("{} 0x{:04X}", w.name(), w.address() * 4);
    words.iter().map(place).collect()
}

/// A folder with the RDL file, and the file's name.
fn rdl(project: &Project, test: &str) -> (PathBuf, String) {
    let folder = tools::folder(&format!("peakrdl-{test}-{}", project.name));
    let file = format!("{}.rdl", project.name);
    fs::write(folder.join(&file), text_of(project, ".rdl")).unwrap();
    (folder, file)
}

fn peakrdl(folder: &Path, arguments: &[&str]) -> String {
    let (is_good, text) = tools::run("peakrdl", folder, arguments);
    assert!(is_good, "{arguments:?}: {text}");
    text
}

/// Catches a stride that only the reader of our own tests makes good.
#[test]
fn peakrdl_lists_every_word_at_its_place() {
    if !require("peakrdl", "listing of the RDL file") {
        return;
    }
    for project in projects() {
        let (folder, file) = rdl(&project, "dump");
        let listing = peakrdl(&folder, &["dump", "--unroll", &file]);
        let found: BTreeSet<String> = listing
            .lines()
            .filter_map(|line| {
                let (range, path) = line.split_once(": ")?;
                let (first, _) = range.trim().split_once('-')?;
                let first = u32::from_str_radix(first.trim_start_matches("0x"), 16).ok()?;
                let (_, name) = path.split_once('.')?;
                Some(format!("{name} 0x{first:04X}"))
            })
            .collect();
        assert_eq!(found, places(&project), "{}", project.name);
    }
}

/// Catches a name that C takes for a word of its own, and a hole of the wrong size between two blocks.
#[test]
fn the_c_header_of_peakrdl_has_every_word_at_its_place() {
    if !(require("peakrdl", "C header of the RDL file") && require("gcc", "the same")) {
        return;
    }
    for project in projects() {
        let (folder, file) = rdl(&project, "c");
        peakrdl(&folder, &["c-header", &file, "-o", "map.h"]);
        let header = fs::read_to_string(folder.join("map.h")).unwrap();
        // The last type is that of the whole map.
        let (_, map) = header.rsplit_once("} ").unwrap();
        let (map, _) = map.split_once(';').unwrap();
        let mut program = "#include <stddef.h>\n#include \"map.h\"\n".to_owned();
        for word in Word::all(&project.card) {
            let (name, address) = (word.name(), word.address() * 4);
            program +=
                &format!("_Static_assert(offsetof({map}, {name}) == {address}, \"{name}\");\n");
        }
        fs::write(folder.join("places.c"), program).unwrap();
        let (is_good, text) = tools::run("gcc", &folder, &["-std=c11", "-c", "places.c"]);
        assert!(is_good, "{text}");
    }
}

#[test]
fn the_ip_xact_of_peakrdl_has_every_word_at_its_place() {
    if !require("peakrdl", "IP-XACT of the RDL file") {
        return;
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/read_ipxact.py");
    for project in projects() {
        let (folder, file) = rdl(&project, "ipxact");
        peakrdl(&folder, &["ip-xact", &file, "-o", "map.xml"]);
        let script = script.display().to_string();
        let (is_good, text) = tools::run("python3", &folder, &[&script, "map.xml"]);
        assert!(is_good, "{text}");
        let found: BTreeSet<String> = text.lines().map(str::to_owned).collect();
        assert_eq!(found, places(&project), "{}", project.name);
    }
}
