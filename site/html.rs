//! Sources of the site on disk, and its HTML.

use crate::{pages, Complaints, Page};
use endat_tools::programs;
use std::fs;
use std::path::{Path, PathBuf};

/// What beside Markdown belongs to pages.
const PICTURES: [&str; 3] = ["svg", "png", "json"];

/// Makes HTML of Markdown.
const MDBOOK: &str = "mdbook";

/// How mdBook is to read and write it.
const SETTINGS: &str = include_str!("book.toml");

fn told(path: &Path) -> impl Fn(std::io::Error) -> Complaints + '_ {
    move |error| {
        vec![format!(
            "{}: {error}; give another folder with --out",
            path.display()
        )]
    }
}

/// Builds the site below `out`, and returns where its first page is.
pub fn build(repository: &Path, out: &Path) -> Result<PathBuf, Complaints> {
    check_folder(out)?;
    build_of(&pages(repository)?, repository, out)
}

/// Refuses a folder that has files of others.
fn check_folder(out: &Path) -> Result<(), Complaints> {
    let mark = SETTINGS.lines().next().unwrap_or_default();
    let settings = fs::read_to_string(out.join("book.toml"));
    let is_ours = settings.is_ok_and(|text| text.starts_with(mark));
    let is_empty = !out.exists() || fs::read_dir(out).is_ok_and(|mut all| all.next().is_none());
    match is_ours || is_empty {
        true => Ok(()),
        false => Err(vec![format!(
            "--out = {}: has files that are not the site's; give an empty folder, or one that is not there yet",
            out.display()
        )]),
    }
}

/// Builds a site of these pages, with the pictures of the repository.
pub(crate) fn build_of(
    pages: &[Page],
    repository: &Path,
    out: &Path,
) -> Result<PathBuf, Complaints> {
    let settings = out.join("book.toml");
    let sources = out.join("sources");
    // A page that is no more must not stay.
    if sources.exists() {
        fs::remove_dir_all(&sources).map_err(told(&sources))?;
    }
    fs::create_dir_all(out).map_err(told(out))?;
    fs::write(&settings, SETTINGS).map_err(told(&settings))?;
    for page in pages {
        let path = sources.join(&page.path);
        let folder = path.parent().unwrap_or(out);
        fs::create_dir_all(folder).map_err(told(folder))?;
        fs::write(&path, &page.text).map_err(told(&path))?;
    }
    copy_pictures(&repository.join("docs"), &sources)?;
    let ran = programs::run(MDBOOK, out, &["build"]).map_err(|e| e.messages().to_vec())?;
    match ran.is_good {
        true => Ok(out.join("html/index.html")),
        false => Err(vec![format!("{}: {}", MDBOOK, ran.text())]),
    }
}

/// Copies the pictures of a folder and of those in it.
fn copy_pictures(from: &Path, to: &Path) -> Result<(), Complaints> {
    for entry in fs::read_dir(from).map_err(told(from))? {
        let file = entry.map_err(told(from))?.path();
        let ending = file.extension().and_then(|e| e.to_str());
        let is_picture = ending.is_some_and(|e| PICTURES.contains(&e));
        let Some(name) = file.file_name() else {
            continue;
        };
        if file.is_dir() {
            let to = to.join(name);
            fs::create_dir_all(&to).map_err(told(&to))?;
            copy_pictures(&file, &to)?;
        } else if is_picture {
            fs::copy(&file, to.join(name)).map_err(told(&file))?;
        }
    }
    Ok(())
}
