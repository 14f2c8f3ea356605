//! The documentation as a site.
//!
//! ```text
//! docs/*.md, README ... --links--> pages --\
//! tables, blocks, program -----> pages ----+--> sources --mdBook--> HTML --check--> every link leads somewhere
//! ```

mod blocks;
mod check;
mod html;
mod links;
pub mod outline;
mod reference;

pub use check::dead_links;
pub use html::build;

use outline::{BLOCKS, HOMES, OUTLINE};
use std::fmt::Write;
use std::path::Path;

/// A file of the site's sources.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Page {
    /// Path below the sources, with its ending.
    pub path: String,
    /// Markdown.
    pub text: String,
}

impl Page {
    fn new(name: &str, text: String) -> Self {
        Self {
            path: format!("{name}.md"),
            text,
        }
    }

    /// The first heading.
    fn title(&self) -> &str {
        let heading = self.text.lines().find_map(|line| line.strip_prefix("# "));
        heading.unwrap_or(&self.path)
    }
}

/// What is wrong with the documentation, or could not be done.
pub type Complaints = Vec<String>;

/// All pages, and the table of contents that mdBook wants.
pub fn pages(repository: &Path) -> Result<Vec<Page>, Complaints> {
    let mut pages = made().map_err(|e| vec![e.to_string()])?;
    let mut complaints = vec![];
    for name in names() {
        let file = match HOMES.iter().find(|home| home.page == name) {
            Some(home) => home.file.to_owned(),
            None if pages.iter().any(|page| page.path == format!("{name}.md")) => continue,
            None => format!("docs/{name}.md"),
        };
        match std::fs::read_to_string(repository.join(&file)) {
            Ok(text) => {
                let text = links::settled(repository, &file, &text, &mut complaints);
                pages.push(Page::new(name, text));
            }
            Err(error) => complaints.push(format!(
                "{file}: {error}; the outline has it (site/outline.rs)"
            )),
        }
    }
    if !complaints.is_empty() {
        return Err(complaints);
    }
    pages.push(Page::new("SUMMARY", summary(&pages)));
    Ok(pages)
}

/// Names of all pages but those of the blocks.
fn names() -> impl Iterator<Item = &'static str> {
    OUTLINE.iter().flat_map(|part| part.pages.iter().copied())
}

/// Pages that no file of the repository is.
fn made() -> Result<Vec<Page>, endat_console::error::CommandError> {
    let mut pages = blocks::pages()?;
    pages.extend(reference::pages()?);
    Ok(pages)
}

fn summary(pages: &[Page]) -> String {
    let mut text = String::from("# Summary\n");
    for part in &OUTLINE {
        let _ = writeln!(text, "\n# {}\n", part.title);
        for name in part.pages {
            let is_it = |page: &&Page| page.path == format!("{name}.md");
            let Some(page) = pages.iter().find(is_it) else {
                continue;
            };
            let _ = writeln!(text, "- [{}]({})", page.title(), page.path);
            if *name == BLOCKS {
                let below = |page: &&Page| page.path.starts_with(&format!("{BLOCKS}/"));
                for page in pages.iter().filter(below) {
                    let _ = writeln!(text, "  - [{}]({})", page.title(), page.path);
                }
            }
        }
    }
    text
}

#[cfg(test)]
mod tests;
