//! Waveforms and drawings of a bench, as files.

use endat_console::error::CommandError;
use endat_draw::is_drawing;
use endat_sim::bench::Bench;
use endat_sim::diagram::{frame_svg, overview_svg};
use endat_sim::wave::{is_layout, is_vcd, write_line, write_wires, Wave};
use endat_terminal::files::{file_name, write_all, File};
use rtl_design::engine::Compiled;
use std::path::Path;

/// The frame that is drawn: the first at the full clock.
const DRAWN_FRAME: usize = 1;

/// Files that are asked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pictures<'a> {
    /// Waveforms, with a GTKWave layout beside them.
    pub vcd: Option<&'a Path>,
    /// The wires of the first link, for logic analysers' programs.
    pub wires: Option<&'a Path>,
    /// A frame as a timing diagram.
    pub svg: Option<&'a Path>,
    /// What of it.
    pub frame: Drawn,
}

/// What is drawn.
#[derive(Clone, Copy, Debug, Default)]
pub enum Drawn {
    /// The first frame at the full clock.
    #[default]
    First,
    /// This frame, 0 = the one that measures the delay.
    Frame(usize),
    /// All frames, in an overview.
    All,
}

/// Writes waveforms and drawing; returns one message for each file.
pub fn draw(
    wanted: &Pictures<'_>,
    bench: &Bench<Compiled>,
    title: &str,
) -> Result<Vec<String>, CommandError> {
    let mut files: Vec<File> = Vec::new();
    if let Some(path) = wanted.vcd {
        let name = file_name("--vcd", path)?;
        let wave = Wave::of(bench);
        let mut bytes = Vec::new();
        wave.write_vcd(&mut bytes)
            .map_err(|e| CommandError::io("write", path, &e, "give another file"))?;
        let text = String::from_utf8_lossy(&bytes).into_owned();
        files.push(File {
            option: "--vcd",
            path: path.to_owned(),
            text,
            is_ours: is_vcd,
        });
        files.push(File {
            option: "--vcd",
            path: path.with_extension("gtkw"),
            text: wave.gtkw(&name),
            is_ours: is_layout,
        });
    }
    if let Some(path) = wanted.wires {
        let mut bytes = Vec::new();
        wires(bench, &mut bytes)
            .map_err(|e| CommandError::io("write", path, &e, "give another file"))?;
        files.push(File {
            option: "--wires",
            path: path.to_owned(),
            text: String::from_utf8_lossy(&bytes).into_owned(),
            is_ours: is_vcd,
        });
    }
    if let Some(path) = wanted.svg {
        if bench.link_count() == 0 {
            return Err(CommandError::input(format!(
                "--svg = {}: only EnDat frames are drawn; leave it out, or take --vcd or --wires",
                path.display()
            )));
        }
        let link = bench.link(0);
        let nothing = || {
            CommandError::input(format!(
                "--svg = {}: there is no frame to draw; leave it out",
                path.display()
            ))
        };
        let drawing = match wanted.frame {
            Drawn::All => overview_svg(link, title).ok_or_else(nothing)?,
            Drawn::Frame(frame) => frame_svg(link, frame, title).ok_or_else(|| {
                let count = link.encoder().frames().len();
                CommandError::input(format!(
                    "--frame = {frame}: the encoder saw {count} frames; choose one of 0..{}",
                    count.saturating_sub(1)
                ))
            })?,
            Drawn::First => frame_svg(link, DRAWN_FRAME, title)
                .or_else(|| frame_svg(link, 0, title))
                .ok_or_else(nothing)?,
        };
        files.push(File {
            option: "--svg",
            path: path.to_owned(),
            text: drawing,
            is_ours: is_drawing,
        });
    }
    write_all(&files)
}

/// The wires of the first link, of whichever protocol.
fn wires(bench: &Bench<Compiled>, out: &mut Vec<u8>) -> std::io::Result<()> {
    let other = bench.others().next();
    match other.filter(|_| bench.link_count() == 0) {
        Some(other) => write_line(other, bench.now(), out),
        None => write_wires(bench.link(0), out),
    }
}
