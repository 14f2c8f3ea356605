//! Instructions per cycle, where valgrind is there: unlike seconds they are the same on a busy machine.

use super::fault;
use endat_console::error::CommandError;
use serde::Serialize;
use std::process::Command;

/// Instructions of an engine for one cycle of one copy.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Instructions {
    /// Engine.
    pub name: &'static str,
    /// Instructions per cycle and copy.
    pub per_cycle: f64,
}

/// Engines as `--only` names them: what people call them, cycles of the longer run, copies.
const ENGINES: [(&str, &str, usize, usize); 4] = [
    ("plain", "plain engine", 4_000, 1),
    ("compiled", "compiled engine", 60_000, 1),
    ("models", "compiled engine with models", 60_000, 1),
    ("lanes", "lanes with models, 128 in a vector", 4_000, 128),
];

/// What callgrind counts for a run.
fn count(engine: &str, cycles: usize) -> Result<Option<f64>, CommandError> {
    let program = std::env::current_exe().map_err(|e| fault(&e))?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args([
            "bench",
            "engines",
            "--only",
            engine,
            "--cycles",
            &cycles.to_string(),
        ])
        .output();
    let Ok(output) = output else {
        return Ok(None);
    };
    let text = String::from_utf8_lossy(&output.stderr);
    let line = text
        .lines()
        .find_map(|line| line.split("Collected :").nth(1));
    Ok(line.and_then(|count| count.trim().parse().ok()))
}

/// The slope between a shorter and a longer run; nothing where valgrind is missing.
pub fn measure() -> Result<Vec<Instructions>, CommandError> {
    let mut found = vec![];
    for (engine, name, cycles, copies) in ENGINES {
        let (short, long) = (count(engine, cycles / 2)?, count(engine, cycles)?);
        if let (Some(short), Some(long)) = (short, long) {
            let per_cycle = (long - short) / (cycles - cycles / 2) as f64 / copies as f64;
            found.push(Instructions { name, per_cycle });
        }
    }
    Ok(found)
}
