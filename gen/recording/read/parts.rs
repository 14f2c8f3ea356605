//! The files of one recording.

use super::super::files::{behind, in_order};
use super::{parquet, Head};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Adds to the given files those that a Parquet recording filled after its first one, and sorts all. `notes` name the files that it adds, and
/// those that it leaves out.
pub(super) fn all(files: &[PathBuf], notes: &mut Vec<String>) -> Vec<PathBuf> {
    let mut all = files.to_vec();
    for file in files {
        let mut others = behind(file);
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
    in_order(&all)
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
