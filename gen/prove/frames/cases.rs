//! The frames of `docs/proofs.md`: widths, commands, cycles in a bit and cables, on a channel at 8 MHz.

use super::{prove, FrameReport, Times};
use crate::config::parse;
use crate::error::GenError;
use crate::prove::Subject;

const SYSTEM_HZ: u64 = 8_000_000;

/// Width, command, cycles in a bit, delay in cycles, cable in metres that the settings allow for, phases of the microsecond.
const CASES: [(u32, &str, u64, u32, u32, u64); 9] = [
    (13, "111000", 4, 1, 7, 8),
    (1, "000111", 4, 0, 7, 1),
    (1, "111000", 8, 3, 70, 1),
    (8, "000111", 5, 2, 40, 1),
    (10, "111000", 16, 5, 120, 1),
    (12, "000111", 32, 4, 90, 1),
    (13, "111000", 4, 31, 780, 1),
    (13, "000111", 8, 16, 400, 1),
    (16, "111000", 4, 3, 70, 1),
];

/// Proves a frame of a channel without bus and parts.
pub fn prove_case(
    (bits, command, period_cycles, delay_cycles, cable_m, phases): (u32, &str, u64, u32, u32, u64),
    change: impl FnOnce(&mut Subject),
    progress: &dyn Fn(&str),
) -> Result<FrameReport, GenError> {
    let text = format!(
        "name = \"frame\"\n[clock]\nsystem_hz = {SYSTEM_HZ}\n[endat]\nclock_hz = {}\ncable_m = {cable_m}\n[[channel]]\n\
         position_bits = {bits}\ncommand = \"{command}\"\n[trigger]\nsample_hz = 1_000\nsources = [\"pin\"]\n[host]\nbus = \"none\"\n",
        SYSTEM_HZ / period_cycles
    );
    let project = parse("frame.toml", &text)?;
    let mut subject = Subject::new(&project)?;
    change(&mut subject);
    let times = Times {
        delay_cycles,
        tcal_cycles: 40,
        tm_cycles: 88,
    };
    prove(&subject, &project, times, phases, progress)
}

/// Proves all of them.
pub fn prove_cases(progress: &dyn Fn(&str)) -> Result<Vec<FrameReport>, GenError> {
    let reports = CASES.iter().map(|case| prove_case(*case, |_| (), progress));
    reports.collect()
}
