//! Lists the boards and families that come with the program, so that a new one is a file and nothing else.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// What is in a folder, in the order of the names.
fn entries(folder: &Path) -> Vec<PathBuf> {
    println!("cargo:rerun-if-changed={}", folder.display());
    let found = fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut paths: Vec<PathBuf> = found.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

fn name(path: &Path) -> &str {
    path.file_name().unwrap().to_str().unwrap()
}

/// Name of a file, and the text that is included from it.
fn row(path: &Path) -> String {
    println!("cargo:rerun-if-changed={}", path.display());
    format!(
        "({:?}, include_str!({:?}))",
        name(path),
        path.display().to_string()
    )
}

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap());
    let boards: Vec<String> = entries(&root.join("boards"))
        .iter()
        .map(|path| row(path))
        .collect();
    let mut text = format!(
        "/// The boards that come with the program: name and text of the file.\nconst BOARDS: &[(&str, &str)] = &[{}];\n",
        boards.join(", ")
    );
    text.push_str("/// The families: name of the folder, and its files.\nconst FAMILIES: &[(&str, &[(&str, &str)])] = &[");
    for family in entries(&root.join("families")) {
        let files: Vec<String> = entries(&family).iter().map(|path| row(path)).collect();
        write!(text, "({:?}, &[{}]), ", name(&family), files.join(", ")).unwrap();
    }
    text.push_str("];\n");
    let out = PathBuf::from(env::var_os("OUT_DIR").unwrap()).join("boards.rs");
    fs::write(out, text).unwrap();
}
