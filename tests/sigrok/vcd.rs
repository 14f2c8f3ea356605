//! Wires as files, and what decoders say of them.

use crate::tools::{self, require};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Writes wires with their levels, each row from its nanosecond on.
pub fn write<const N: usize>(
    name: &str,
    wires: &[&str; N],
    rows: &[(u64, [bool; N])],
    end: u64,
) -> PathBuf {
    let mut text = String::from("$timescale 1 ns $end\n$scope module wires $end\n");
    let ids = ["!", "\""];
    for (wire, id) in wires.iter().zip(ids) {
        writeln!(text, "$var wire 1 {id} {wire} $end").unwrap();
    }
    text.push_str("$upscope $end\n$enddefinitions $end\n");
    let mut last = None;
    for (time, levels) in rows {
        writeln!(text, "#{time}").unwrap();
        for (n, level) in levels.iter().enumerate() {
            if last.is_none_or(|last: &[bool; N]| last[n] != *level) {
                writeln!(text, "{}{}", u8::from(*level), ids[n]).unwrap();
            }
        }
        last = Some(levels);
    }
    writeln!(text, "#{end}").unwrap();
    let file = tools::folder(&format!("sigrok_{name}")).join("wires.vcd");
    std::fs::write(&file, text).unwrap();
    file
}

/// Runs a decoder of `sigrok/` with its options over a file, a sample for each nanosecond or for so many; its annotations.
pub fn decoded(file: &Path, ns: u32, decoder: &str) -> Option<String> {
    if !require("sigrok-cli", "sigrok decoder") {
        return None;
    }
    let decoders = Path::new(env!("CARGO_MANIFEST_DIR")).join("sigrok");
    let (input, name) = (
        format!("vcd:downsample={ns}"),
        decoder.split(':').next().unwrap(),
    );
    let output = std::process::Command::new("sigrok-cli")
        .env("SIGROKDECODE_DIR", decoders)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .args(["-I", &input, "-i", file.to_str().unwrap()])
        .args(["-P", decoder, "-A", name])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success() && errors.is_empty(),
        "{told}{errors}"
    );
    Some(told)
}

/// The numbers after this word, each at the beginning of an annotation.
pub fn numbers(told: &str, word: &str) -> Vec<u64> {
    let begin = format!(": {word} ");
    let number = |line: &str| {
        let (_, rest) = line.split_once(&begin)?;
        rest.split([' ', ':']).next()?.parse().ok()
    };
    told.lines().filter_map(number).collect()
}

/// None of these texts is in the annotations.
pub fn assert_without(told: &str, texts: &[&str]) {
    for text in texts {
        assert!(!told.contains(text), "{text}: {told}");
    }
}
