//! Whether every link of the finished site leads somewhere.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A page as it has been written.
struct Html {
    links: Vec<String>,
    ids: BTreeSet<String>,
}

/// Values of an attribute, as mdBook writes it.
fn values<'t>(text: &'t str, attribute: &str) -> impl Iterator<Item = String> + 't {
    let head = format!(" {attribute}=\"");
    let length = head.len();
    text.match_indices(&head)
        .map(|(at, _)| at)
        .collect::<Vec<_>>()
        .into_iter()
        .filter_map(move |at| text[at + length..].split('"').next())
        .map(|value| value.replace("&amp;", "&"))
}

fn read(folder: &Path, pages: &mut BTreeMap<PathBuf, Html>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            read(&path, pages)?;
        } else if path.extension().is_some_and(|e| e == "html") {
            let text = fs::read_to_string(&path)?;
            let links = values(&text, "href").chain(values(&text, "src")).collect();
            let ids = values(&text, "id").collect();
            pages.insert(path, Html { links, ids });
        }
    }
    Ok(())
}

/// Links of the pages below a folder that lead to no file, or to no place of a page there.
pub fn dead_links(site: &Path) -> io::Result<Vec<String>> {
    let mut pages = BTreeMap::new();
    read(site, &mut pages)?;
    let mut dead = vec![];
    for (page, html) in &pages {
        // It is shown at any address that is not there, so its links are from the root.
        if page.ends_with("404.html") {
            continue;
        }
        for link in &html.links {
            if link.contains("://") || link.starts_with("mailto:") || link.starts_with("data:") {
                continue;
            }
            let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
            let to = match path {
                "" => page.clone(),
                path => page.parent().unwrap_or(site).join(path),
            };
            let to = to.canonicalize().unwrap_or(to);
            let leads = match pages.get(&to) {
                _ if !to.exists() => false,
                Some(html) => anchor.is_empty() || html.ids.contains(anchor),
                None => true,
            };
            if !leads {
                let page = page.strip_prefix(site).unwrap_or(page);
                dead.push(format!("{}: {link}: leads nowhere", page.display()));
            }
        }
    }
    Ok(dead)
}
