//! The files of one recording.

use super::super::files::{before, behind, in_order, is_numbered, next};
use super::super::parquet::GROUPS;
use super::{parquet, Head};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Adds to the given files those that a Parquet recording filled after its first one, and sorts all. `notes` name the files that it adds, and
/// those that it leaves out.
pub(super) fn all(files: &[PathBuf], notes: &mut Vec<String>) -> Vec<PathBuf> {
    let mut all = files.to_vec();
    for file in files {
        let mut others = behind(file);
        if !is_numbered(file) {
            notes.extend(full(others.last().unwrap_or(file)));
        }
        others.retain(|other| !files.contains(other));
        // A pipe can be opened only once, and has no others.
        if others.is_empty() {
            continue;
        }
        let Some(begun) = start(file) else {
            continue;
        };
        let (rest, others): (Vec<_>, Vec<_>) =
            (others.into_iter()).partition(|other| start(other) == Some(begun));
        for other in others {
            notes.push(format!(
                "{}: is cut off, or of another recording than {}: left out; give it by itself to see which",
                other.display(),
                file.display()
            ));
        }
        if let Some(last) = rest.last() {
            notes.push(format!(
                "{}: goes on in {} more, to {}: read, too",
                file.display(),
                rest.len(),
                last.display()
            ));
        }
        all.extend(rest);
    }
    let all = in_order(&all);
    notes.extend(all.first().and_then(|first| goes_on_behind(first)));
    all
}

/// Tells that the first file is behind another one of its recording, which is not given.
fn goes_on_behind(first: &Path) -> Option<String> {
    let mut earlier = before(first).into_iter().peekable();
    earlier.peek()?;
    let begun = start(first)?;
    let last = earlier.find(|one| start(one) == Some(begun))?;
    Some(format!(
        "{}: goes on behind {}, which is not read; give that one, too, for figures of the whole recording",
        first.display(),
        last.display()
    ))
}

/// Tells of a last file that has all its groups: what came then is not there, or nothing came.
fn full(file: &Path) -> Option<String> {
    let is_full = is_plain_file(file) && parquet::groups_of(file)? == GROUPS as usize;
    is_full.then(|| {
        format!(
            "{}: is full: a longer recording goes on in {}, which is not there; if there is one, copy it to this folder",
            file.display(),
            next(file).display()
        )
    })
}

/// True for what can be opened twice.
fn is_plain_file(path: &Path) -> bool {
    path.metadata().is_ok_and(|meta| meta.is_file())
}

/// The time at which the recording of a Parquet file was begun; none for other files.
fn start(file: &Path) -> Option<SystemTime> {
    let about = parquet::about_of(file)?;
    let head = Head {
        about,
        ..Head::default()
    };
    head.start()
}
