//! Links of a page that is read in the repository become those of the same page in the site.

use crate::outline::HOMES;
use crate::Complaints;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

/// The site's address of a file of the repository, seen from any page that is not a block's; none if the site does not have it.
fn in_site(file: &str) -> Option<String> {
    if let Some(home) = HOMES.iter().find(|home| home.file == file) {
        return Some(format!("{}.md", home.page));
    }
    file.strip_prefix("docs/").map(str::to_owned)
}

/// Without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(plain.pop()),
            Component::CurDir => {}
            part => plain.push(part),
        }
    }
    plain
}

/// An inline link, or a picture, in a text.
#[derive(Debug, PartialEq, Eq)]
struct Found {
    /// Where its bracket is.
    begin: usize,
    /// Where its target is.
    target: Range<usize>,
}

/// All of a text; what is code has none.
fn links(text: &str) -> Vec<Found> {
    let mut found = vec![];
    let mut brackets = vec![];
    let mut is_fenced = false;
    // Length of the run of backticks that a span of code began with.
    let mut code = 0;
    let mut at = 0;
    while at < text.len() {
        let rest = &text[at..];
        let run = rest.len() - rest.trim_start_matches('`').len();
        let is_line = at == 0 || text.as_bytes()[at - 1] == b'\n';
        if run >= 3 && is_line {
            is_fenced = !is_fenced;
        } else if run > 0 && !is_fenced {
            code = match code {
                0 if rest[run..].contains(&"`".repeat(run)) => run,
                open if open == run => 0,
                open => open,
            };
        } else if code == 0 && !is_fenced {
            match rest.as_bytes()[0] {
                b'[' => brackets.push(at),
                b']' => {
                    let begin = brackets.pop();
                    let end = rest.find(')');
                    if let (Some(begin), Some(end), true) = (begin, end, rest[1..].starts_with('('))
                    {
                        let target = at + 2..at + end;
                        found.push(Found { begin, target });
                    }
                }
                _ => {}
            }
        }
        let first = rest.chars().next().map_or(1, char::len_utf8);
        at += run.max(first);
    }
    found
}

/// What becomes of a link.
enum Link {
    /// It leads to this.
    To(String),
    /// The site does not have what it leads to: only its words stay.
    Words,
}

/// The text with each link as it is in the site. What does not lead to a file of the repository is complained of.
pub fn settled(repository: &Path, file: &str, text: &str, complaints: &mut Complaints) -> String {
    let folder = Path::new(file).parent().unwrap_or(Path::new(""));
    let mut link = |target: &str| {
        let (path, anchor) = match target.split_once('#') {
            Some((path, anchor)) => (path, format!("#{anchor}")),
            None => (target, String::new()),
        };
        if path.is_empty() || path.contains("://") || path.starts_with("mailto:") {
            return Link::To(target.to_owned());
        }
        let file_of = plain(&folder.join(path));
        if !repository.join(&file_of).exists() {
            complaints.push(format!(
                "{file}: link = {target:?}: no such file; mend the link, or the name"
            ));
            return Link::Words;
        }
        let name = file_of.to_string_lossy().replace('\\', "/");
        match in_site(&name) {
            Some(page) => Link::To(format!("{page}{anchor}")),
            None => Link::Words,
        }
    };
    let mut edits: Vec<(Range<usize>, String)> = vec![];
    for found in links(text) {
        match link(&text[found.target.clone()]) {
            Link::To(target) => edits.push((found.target, target)),
            Link::Words => {
                edits.push((found.begin..found.begin + 1, String::new()));
                edits.push((found.target.start - 2..found.target.end + 1, String::new()));
            }
        }
    }
    edits.sort_by_key(|(at, _)| at.start);
    let mut settled = String::with_capacity(text.len());
    let mut copied = 0;
    for (at, new) in edits {
        settled.push_str(&text[copied..at.start]);
        settled.push_str(&new);
        copied = at.end;
    }
    settled.push_str(&text[copied..]);
    settled
}
