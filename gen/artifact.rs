//! Emitted files: text first, then all of them onto the disk or none.

use crate::error::GenError;
use sha2::{Digest, Sha256};
use std::fs;
use std::path::{Path, PathBuf};

/// Name of the list of all other files.
pub const MANIFEST: &str = "MANIFEST";

/// One file to be emitted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Artifact {
    /// File name, without folders.
    pub path: String,
    /// Contents.
    pub text: String,
}

impl Artifact {
    /// A file.
    pub fn new(path: impl Into<String>, text: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            text: text.into(),
        }
    }
}

/// SHA-256 in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes)
        .iter()
        .map(|b| format!("{b:02x}"))
        .collect()
}

/// The list of files with size and SHA-256, one a line.
pub fn manifest(artifacts: &[Artifact]) -> Artifact {
    let lines = artifacts.iter().map(|a| {
        format!(
            "{}  {:>8}  {}\n",
            sha256(a.text.as_bytes()),
            a.text.len(),
            a.path
        )
    });
    Artifact::new(MANIFEST, lines.collect::<String>())
}

/// File names in the text of a MANIFEST.
fn listed(manifest: &str) -> impl Iterator<Item = &str> {
    manifest
        .lines()
        .filter_map(|line| line.split_whitespace().nth(2))
}

/// What differs between `folder` and the artefacts; empty when nothing does. Never writes.
pub fn differences(folder: &Path, artifacts: &[Artifact]) -> Vec<String> {
    let mut found = Vec::new();
    for artifact in artifacts {
        let path = folder.join(&artifact.path);
        match fs::read(&path) {
            Ok(bytes) if bytes == artifact.text.as_bytes() => {}
            Ok(_) => found.push(format!(
                "{}: is not what the configuration gives",
                path.display()
            )),
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
                found.push(format!("{}: is missing", path.display()))
            }
            Err(e) => found.push(format!("{}: cannot read: {e}", path.display())),
        }
    }
    found.extend(leftovers(folder, artifacts));
    found
}

/// Files of an earlier emission that are no longer emitted.
pub fn leftovers(folder: &Path, artifacts: &[Artifact]) -> Vec<String> {
    let earlier = fs::read_to_string(folder.join(MANIFEST)).unwrap_or_default();
    listed(&earlier)
        .filter(|name| !artifacts.iter().any(|a| a.path == *name) && !name.contains(['/', '\\']))
        .map(|name| folder.join(name))
        .filter(|path| path.exists())
        .map(|path| format!("{}: is no longer emitted; delete it", path.display()))
        .collect()
}

/// A file waiting under a temporary name beside its place.
struct Staged {
    from: PathBuf,
    to: PathBuf,
}

/// Writes the artefacts that differ and returns their paths; after an error no file has changed.
pub fn write(folder: &Path, artifacts: &[Artifact]) -> Result<Vec<PathBuf>, GenError> {
    let remedy = "give another folder with --out";
    fs::create_dir_all(folder).map_err(|e| GenError::io("make the folder", folder, &e, remedy))?;
    let mut staged: Vec<Staged> = Vec::new();
    for artifact in artifacts {
        let to = folder.join(&artifact.path);
        if fs::read(&to).is_ok_and(|bytes| bytes == artifact.text.as_bytes()) {
            continue;
        }
        let from = folder.join(format!(".{}.part{}", artifact.path, std::process::id()));
        let written = if to.is_dir() {
            Err(std::io::Error::other("a folder is in its place"))
        } else {
            fs::write(&from, &artifact.text)
        };
        staged.push(Staged { from, to });
        if let Err(e) = written {
            discard(&staged);
            let last = &staged[staged.len() - 1];
            return Err(GenError::io("write", &last.to, &e, remedy));
        }
    }
    for index in 0..staged.len() {
        let Staged { from, to } = &staged[index];
        if let Err(e) = fs::rename(from, to) {
            discard(&staged[index..]);
            return Err(GenError::io("write", to, &e, remedy));
        }
    }
    Ok(staged.into_iter().map(|s| s.to).collect())
}

fn discard(staged: &[Staged]) {
    for Staged { from, .. } in staged {
        // It may never have been made; nothing better can be done about one that stays.
        let _ = fs::remove_file(from);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manifest_lists_size_and_digest() {
        let text = manifest(&[Artifact::new("a.v", "abc")]).text;
        let digest = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(text, format!("{digest}         3  a.v\n"));
        assert_eq!(listed(&text).collect::<Vec<_>>(), ["a.v"]);
    }
}
