//! Checked frames in lanes: the campaign runner with its full check of every frame.

use super::fault;
use endat_console::error::CommandError;
use endat_hdl::protocol::ModeCommand;
use endat_sim::campaign::{self, Case, RunOptions};
use endat_sim::NS;
use serde::Serialize;
use std::time::Instant;

/// How fast frames are made and checked.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Frames {
    /// Frames.
    pub frames: u64,
    /// Cases side by side.
    pub cases: u64,
    /// System clock cycles of all cases together.
    pub cycles: u64,
    /// Wall time.
    pub seconds: f64,
}

/// 29 position bits at 16 MHz from 128 MHz, cables up to 100 m, recovery time 1.25 us: results, pulses, CRC and times of every
/// frame are checked.
pub fn measure(frames: usize) -> Result<Frames, CommandError> {
    let case = |n: usize| {
        let metres = (n % 100) as f64;
        let mut case = Case::new(
            (128_000_000, 16_000_000),
            ModeCommand::SendPositionAddInfo,
            29,
            metres,
        );
        case.encoder.seed = n as u64;
        case.encoder.tcal = 600 * NS;
        case.encoder.tm = 1_250 * NS..=1_250 * NS;
        case.frames = frames;
        case
    };
    let cases: Vec<Case> = (0..256).map(case).collect();
    let options = RunOptions {
        samples: false,
        ..RunOptions::default()
    };
    let start = Instant::now();
    let outcomes = campaign::run(&cases, options, Case::check, |_| {}).map_err(|e| fault(&e))?;
    let seconds = start.elapsed().as_secs_f64();
    if let Some(failure) = outcomes.iter().find_map(|o| o.verdict.as_ref().err()) {
        return Err(fault(failure));
    }
    Ok(Frames {
        frames: outcomes.iter().map(|o| o.frames as u64).sum(),
        cases: cases.len() as u64,
        cycles: outcomes.iter().map(|o| o.cycles).sum(),
        seconds,
    })
}
