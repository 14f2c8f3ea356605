//! Waveforms and drawings of a bench, as files.

use crate::artifact::{self, Artifact};
use crate::error::{shown, GenError};
use endat_sim::bench::Bench;
use endat_sim::diagram::frame_svg;
use endat_sim::engine::Compiled;
use endat_sim::wave::Wave;
use std::path::{Path, PathBuf};

/// The frame that is drawn: the first at the full clock.
const DRAWN_FRAME: usize = 1;

/// Files that are asked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pictures<'a> {
    /// Waveforms, with a GTKWave layout beside them.
    pub vcd: Option<&'a Path>,
    /// A frame as a timing diagram.
    pub svg: Option<&'a Path>,
    /// Which frame, 0 = the one that measures the delay; otherwise the first at the full clock.
    pub frame: Option<usize>,
}

/// A file to be written: the option that asked for it, its place, its text.
type File = (&'static str, PathBuf, String);

/// Writes waveforms and drawing; returns one message for each file.
pub fn draw(
    wanted: &Pictures<'_>,
    bench: &Bench<Compiled>,
    title: &str,
) -> Result<Vec<String>, GenError> {
    let mut files: Vec<File> = Vec::new();
    if let Some(path) = wanted.vcd {
        let name = file_name("--vcd", path)?;
        let wave = Wave::of(bench);
        let mut bytes = Vec::new();
        wave.write_vcd(&mut bytes)
            .map_err(|e| GenError::io("write", path, &e, "give another file"))?;
        let text = String::from_utf8_lossy(&bytes).into_owned();
        files.push(("--vcd", path.to_owned(), text));
        let layout = path.with_extension("gtkw");
        files.push(("--vcd", layout, wave.gtkw(&name)));
    }
    if let Some(path) = wanted.svg {
        let link = bench.link(0);
        let drawing = match wanted.frame {
            Some(frame) => frame_svg(link, frame, title).ok_or_else(|| {
                let count = link.encoder().frames().len();
                GenError::input(format!(
                    "--frame = {frame}: the encoder saw {count} frames; choose one of 0..{}",
                    count.saturating_sub(1)
                ))
            })?,
            None => frame_svg(link, DRAWN_FRAME, title)
                .or_else(|| frame_svg(link, 0, title))
                .ok_or_else(|| {
                    GenError::input(format!(
                        "--svg = {}: there is no frame to draw; leave it out",
                        path.display()
                    ))
                })?,
        };
        files.push(("--svg", path.to_owned(), drawing));
    }
    check_places(&files)?;
    let mut written = Vec::new();
    for (option, path, text) in &files {
        written.extend(write(option, path, text)?);
    }
    Ok(written)
}

/// Refuses two files in one place: the layout of the waveforms, too, has one.
fn check_places(files: &[File]) -> Result<(), GenError> {
    for (index, (option, path, _)) in files.iter().enumerate() {
        for (other, taken, _) in &files[..index] {
            if place(path) == place(taken) {
                let text = if option == other {
                    "is the name of the layout beside it; give a name that ends in .vcd".into()
                } else {
                    format!("is the place of a file of {other}; give another file")
                };
                return Err(GenError::input(format!(
                    "{option} = {}: {text}",
                    path.display()
                )));
            }
        }
    }
    Ok(())
}

fn folder(path: &Path) -> &Path {
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty());
    parent.unwrap_or(Path::new("."))
}

/// One spelling for all the ways to name a file.
fn place(path: &Path) -> PathBuf {
    let whole = std::fs::canonicalize(path);
    whole.unwrap_or_else(|_| {
        let folder = folder(path);
        let folder = std::fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
        folder.join(path.file_name().unwrap_or_default())
    })
}

fn file_name(option: &str, path: &Path) -> Result<String, GenError> {
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned());
    name.ok_or_else(|| {
        GenError::input(format!(
            "{option} = {}: is not the name of a file; give one",
            shown(&path.display().to_string())
        ))
    })
}

fn write(option: &str, path: &Path, text: &str) -> Result<Vec<String>, GenError> {
    let artifact = Artifact::new(file_name(option, path)?, text);
    let files = artifact::write(folder(path), &[artifact], "give another file")?;
    Ok(files
        .iter()
        .map(|_| format!("wrote {}", path.display()))
        .collect())
}
