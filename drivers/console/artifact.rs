//! Emitted files: text first, then all of them onto the disk or none.

use crate::error::CommandError;
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Name of the list of all other files.
pub const MANIFEST: &str = "MANIFEST";
/// Name of the page that says what the files are.
pub const README: &str = "README.md";
/// Largest file of an earlier emission that is looked at.
const FILE_BYTES_MAX: u64 = 1 << 24;

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

/// The list of files, as `sha256sum -c` reads it.
pub fn manifest(artifacts: &[Artifact]) -> Artifact {
    let lines = artifacts
        .iter()
        .map(|a| format!("{}  {}\n", sha256(a.text.as_bytes()), a.path));
    Artifact::new(MANIFEST, lines.collect::<String>())
}

/// Digests and file names in the text of a MANIFEST; what is no plain file name is passed over.
fn listed(manifest: &str) -> impl Iterator<Item = (&str, &str)> {
    manifest.lines().filter_map(|line| {
        let (digest, name) = line.split_once(char::is_whitespace)?;
        let name = name.split_whitespace().last()?;
        (!name.contains(['/', '\\', ':']) && name != "." && name != "..").then_some((digest, name))
    })
}

/// The bytes of a regular file of at most `bytes_max` bytes; anything else is an error before it is opened.
pub fn read_regular(path: &Path, bytes_max: u64) -> io::Result<Vec<u8>> {
    let metadata = fs::metadata(path)?;
    if metadata.is_dir() {
        return Err(io::Error::other("is a folder, not a file"));
    }
    if !metadata.is_file() {
        return Err(io::Error::other("is not a regular file"));
    }
    if metadata.len() > bytes_max {
        let text = format!("has {} bytes, at most {bytes_max} are read", metadata.len());
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, text));
    }
    fs::read(path)
}

/// Whether the file at `path` holds `text`; one that is missing does not.
fn holds(path: &Path, text: &str) -> io::Result<bool> {
    match read_regular(path, text.len() as u64) {
        Ok(bytes) => Ok(bytes == text.as_bytes()),
        Err(e)
            if matches!(
                e.kind(),
                io::ErrorKind::FileTooLarge | io::ErrorKind::NotFound
            ) =>
        {
            Ok(false)
        }
        Err(e) => Err(e),
    }
}

/// Differences between `folder` and the artefacts; empty if there are none. Never writes.
pub fn differences(folder: &Path, artifacts: &[Artifact]) -> Vec<String> {
    let mut found = changed(folder, artifacts);
    found.extend(stale(folder, artifacts));
    found
}

/// Artefacts that the folder lacks or holds otherwise.
pub fn changed(folder: &Path, artifacts: &[Artifact]) -> Vec<String> {
    let mut found = Vec::new();
    for artifact in artifacts {
        let path = folder.join(&artifact.path);
        match holds(&path, &artifact.text) {
            Ok(true) => {}
            Ok(false) if path.exists() => found.push(format!(
                "{}: is not what the configuration gives",
                path.display()
            )),
            Ok(false) => found.push(format!("{}: is missing", path.display())),
            Err(e) => found.push(format!("{}: {e}; move it away first", path.display())),
        }
    }
    found
}

/// Files of an earlier emission that are no artefacts.
pub fn stale(folder: &Path, artifacts: &[Artifact]) -> Vec<String> {
    let left = leftovers(folder, artifacts);
    let removable = left.removable.iter();
    let mut found: Vec<String> = removable
        .map(|path| format!("{}: is no longer emitted; emit removes it", path.display()))
        .collect();
    found.extend(left.kept);
    found
}

/// Places of artefacts that hold what no emission has left there, with what is to be said about each: only their owner may replace it.
pub fn foreign(folder: &Path, artifacts: &[Artifact]) -> Vec<String> {
    let manifest = read_regular(&folder.join(MANIFEST), FILE_BYTES_MAX).unwrap_or_default();
    let manifest = String::from_utf8_lossy(&manifest);
    let is_digest =
        |digest: &str| digest.len() == 64 && digest.bytes().all(|b| b.is_ascii_hexdigit());
    let known: BTreeSet<(&str, &str)> = (listed(&manifest))
        .filter(|(digest, _)| is_digest(digest))
        .collect();
    let is_list = manifest.lines().count() == known.len();
    let is_foreign = |artifact: &&Artifact| {
        let path = folder.join(&artifact.path);
        // What is no regular file is told when it is to be written.
        let Ok(bytes) = read_regular(&path, FILE_BYTES_MAX) else {
            return path.is_file();
        };
        let is_known = match artifact.path.as_str() {
            MANIFEST => is_list,
            name => known.contains(&(sha256(&bytes).as_str(), name)),
        };
        bytes != artifact.text.as_bytes() && !is_known
    };
    let tell = |artifact: &Artifact| {
        format!(
            "{}: has been changed, or was not written by emit, and would be lost; move it away, give another folder with --out, or --force",
            folder.join(&artifact.path).display()
        )
    };
    artifacts.iter().filter(is_foreign).map(tell).collect()
}

/// Files in the folder of an emission that do not belong to it.
#[derive(Default)]
pub struct Leftovers {
    /// Files of an earlier emission, as it left them.
    pub removable: Vec<PathBuf>,
    /// What is to be said about those that only their owner may remove.
    pub kept: Vec<String>,
}

/// Compares the MANIFEST of an earlier emission with the artefacts.
pub fn leftovers(folder: &Path, artifacts: &[Artifact]) -> Leftovers {
    let mut left = Leftovers::default();
    // A file system may not tell capital letters from small ones.
    let emitted = |name: &str| artifacts.iter().any(|a| a.path.eq_ignore_ascii_case(name));
    let manifest = read_regular(&folder.join(MANIFEST), FILE_BYTES_MAX).unwrap_or_default();
    let manifest = String::from_utf8_lossy(&manifest);
    let mut known = BTreeSet::new();
    for (digest, name) in listed(&manifest).filter(|(_, name)| !emitted(name)) {
        let path = folder.join(name);
        if !known.insert(name) || !path.exists() {
            continue;
        }
        match read_regular(&path, FILE_BYTES_MAX) {
            Ok(bytes) if sha256(&bytes) == digest => left.removable.push(path),
            _ => left.kept.push(format!(
                "{}: is no longer emitted, but has been changed; delete it or move it away",
                path.display()
            )),
        }
    }
    left
}

/// A file waiting under a temporary name beside its place.
struct Staged {
    /// It is locked as long as it is open: no other emission takes it for a file that is left over.
    _held: File,
    from: PathBuf,
    to: PathBuf,
    /// Its place as the user named it.
    shown: PathBuf,
}

/// Between the name of a file and the process that writes it, in a temporary name.
const PART: &str = ".part";

/// A new file under a temporary name.
fn stage(from: &Path, text: &str) -> io::Result<File> {
    let mut file = File::create(from)?;
    // Where there are no locks, nothing is ever taken for left over.
    let _ = file.try_lock();
    file.write_all(text.as_bytes())?;
    Ok(file)
}

/// Removes what emissions of these artefacts have left that were killed: their temporary files which nobody holds.
fn sweep(folder: &Path, artifacts: &[Artifact]) {
    let names: BTreeSet<&str> = artifacts.iter().map(|a| a.path.as_str()).collect();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_str().and_then(|name| name.strip_prefix('.'));
        let Some((of, process)) = name.and_then(|name| name.rsplit_once(PART)) else {
            continue;
        };
        let is_process = !process.is_empty() && process.bytes().all(|b| b.is_ascii_digit());
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if !is_process || !is_file || !names.contains(of) {
            continue;
        }
        let path = entry.path();
        let file = File::options().write(true).open(&path);
        if file.is_ok_and(|file| file.try_lock().is_ok()) {
            // One that cannot be removed does no harm.
            let _ = fs::remove_file(&path);
        }
    }
}

/// Writes the artefacts that differ and returns their paths; after an error no file has changed. `remedy` ends a message.
pub fn write(
    folder: &Path,
    artifacts: &[Artifact],
    remedy: &str,
) -> Result<Vec<PathBuf>, CommandError> {
    write_unless(folder, artifacts, remedy, &|| false)
}

/// The same, given up as soon as `is_stopped` says so: then no file has changed, and none is left over.
pub fn write_unless(
    folder: &Path,
    artifacts: &[Artifact],
    remedy: &str,
    is_stopped: &dyn Fn() -> bool,
) -> Result<Vec<PathBuf>, CommandError> {
    fs::create_dir_all(folder)
        .map_err(|e| CommandError::io("make the folder", folder, &e, remedy))?;
    sweep(folder, artifacts);
    let mut staged: Vec<Staged> = Vec::new();
    for artifact in artifacts {
        let path = folder.join(&artifact.path);
        let written = holds(&path, &artifact.text).and_then(|same| {
            if same {
                return Ok(());
            }
            // A link stays, and what it leads to is renewed.
            let to = fs::canonicalize(&path).unwrap_or_else(|_| path.clone());
            let part = format!(".{}{PART}{}", artifact.path, std::process::id());
            let from = to.with_file_name(part);
            let written = stage(&from, &artifact.text);
            let held = written.inspect_err(|_| drop(fs::remove_file(&from)))?;
            staged.push(Staged {
                _held: held,
                from,
                to,
                shown: path.clone(),
            });
            Ok(())
        });
        if let Err(e) = written {
            discard(&staged);
            return Err(CommandError::io("write", &path, &e, remedy));
        }
        if is_stopped() {
            discard(&staged);
            return Err(CommandError::input(format!(
                "{}: interrupted, no file has changed; run the command again",
                folder.display()
            )));
        }
    }
    // From here on everything is written: a few renames, which nobody waits for.
    for index in 0..staged.len() {
        let Staged {
            from, to, shown, ..
        } = &staged[index];
        if let Err(e) = fs::rename(from, to) {
            discard(&staged[index..]);
            return Err(CommandError::io("write", shown, &e, remedy));
        }
    }
    Ok(staged.into_iter().map(|s| s.shown).collect())
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

    /// A Ctrl-C at any moment: everything or nothing, and nothing else.
    #[test]
    fn an_interrupted_emission_leaves_nothing_behind() {
        use std::cell::Cell;
        let folder = std::env::temp_dir().join(format!("endat-stop-{}", std::process::id()));
        let files = |text: &str| ["a.v", "b.v", "c.v"].map(|name| Artifact::new(name, text));
        write(&folder, &files("old"), "").unwrap();
        for moment in 1..=3 {
            let looks = Cell::new(0);
            let stop = || {
                looks.set(looks.get() + 1);
                looks.get() == moment
            };
            let error = write_unless(&folder, &files("new"), "", &stop).unwrap_err();
            assert!(error.messages()[0].contains("interrupted"), "{error}");
            assert_eq!(differences(&folder, &files("old")), [""; 0]);
            assert_eq!(fs::read_dir(&folder).unwrap().count(), 3);
        }
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn the_manifest_lists_digest_and_name() {
        let text = manifest(&[Artifact::new("a.v", "abc")]).text;
        let digest = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(text, format!("{digest}  a.v\n"));
        assert_eq!(listed(&text).collect::<Vec<_>>(), [(digest, "a.v")]);
    }
}
