//! What `--resume` goes on behind: the last file that is there must be of the same recording.

use super::files::{highest, numbered, Target};
use super::layout::Layout;
use super::read;
use endat_console::error::CommandError;

/// Refuses files that rows of this layout cannot go on behind; what is to be told of the last one.
pub fn check(
    target: &Target,
    layout: &Layout,
    says_when: bool,
) -> Result<Vec<String>, CommandError> {
    let Target::Numbered { path, resume: true } = target else {
        return Ok(Vec::new());
    };
    let last = match highest(path) {
        0 if path.is_file() => {
            return Err(CommandError::input(format!(
                "--resume: {} has no number, so nothing goes on behind it; rename it to {}, or give another --out",
                path.display(),
                numbered(path, 1).display()
            )))
        }
        0 => return Ok(Vec::new()),
        number => numbered(path, number),
    };
    let head = match read::first(&last) {
        Ok(Some(head)) => head,
        Ok(None) => return Ok(Vec::new()),
        // Its rows are lost or not, whatever comes behind it.
        Err(error) => {
            return Ok(vec![format!(
                "--resume: {error}; what comes goes into another file behind it"
            )])
        }
    };
    let units = layout.scales.iter().map(|scale| scale.convert(0).unit);
    let mut before: Vec<&str> = head.derived.iter().map(|one| one.name.as_str()).collect();
    let now: Vec<String> = layout.derived.iter().map(|one| one.column()).collect();
    let mut now: Vec<&str> = now.iter().map(String::as_str).collect();
    // Objects of JSON have their names in any order.
    before.sort_unstable();
    now.sort_unstable();
    if before == now && units.eq(head.units.iter().map(String::as_str)) {
        let told = format!(
            "--resume: {} and what comes do not both say when they were begun: `stats` and `plot` put them right behind each other; --about lets text say so",
            last.display()
        );
        let is_known = says_when && head.start().is_some();
        return Ok(Vec::from_iter((!is_known).then_some(told)));
    }
    let columns = |channels: usize, derived: &[&str]| match derived {
        [] => format!("{channels} channels"),
        names => format!("{channels} channels and {}", names.join(", ")),
    };
    Err(CommandError::input(format!(
        "--resume: {} has other columns: {}, where this log has {}; give the same --derive at the same card, or another --out",
        last.display(),
        columns(head.units.len(), &before),
        columns(layout.scales.len(), &now)
    )))
}
