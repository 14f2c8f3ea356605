//! The frames of `docs/proofs.md`: widths, commands, cycles in a bit and cables.

use super::{prove, FrameReport, Line, Undriven};
use crate::prove::Subject;
use endat_config::parse;
use endat_console::error::CommandError;

/// A channel without bus, and its cable.
#[derive(Clone, Copy, Debug)]
pub struct FrameCase {
    /// Width of the position.
    pub position_bits: u32,
    /// Mode command.
    pub command: &'static str,
    /// System clock.
    pub system_mhz: u64,
    /// System clock cycles in a bit.
    pub period_cycles: u64,
    /// Delay, one way.
    pub delay_cycles: u32,
    /// What the settings allow for.
    pub cable_m: u32,
    /// DATA while nobody drives it.
    pub undriven: Undriven,
    /// More lines of `[endat]`.
    pub endat: &'static str,
    /// Tables with the parts that it has.
    pub parts: &'static str,
    /// Most phases of the microsecond.
    pub phases: u64,
}

/// EnDat 2.2 with 13 bits at 8 MHz, a bit of four cycles and one cycle of delay.
pub const PLAIN: FrameCase = FrameCase {
    position_bits: 13,
    command: "111000",
    system_mhz: 8,
    period_cycles: 4,
    delay_cycles: 1,
    cable_m: 7,
    undriven: Undriven::Anything,
    endat: "",
    parts: "",
    phases: 16,
};

const fn frames(
    position_bits: u32,
    command: &'static str,
    period: u64,
    delay: u32,
    cable_m: u32,
) -> FrameCase {
    FrameCase {
        position_bits,
        command,
        period_cycles: period,
        delay_cycles: delay,
        cable_m,
        ..PLAIN
    }
}

const fn with(parts: &'static str, case: FrameCase) -> FrameCase {
    FrameCase { parts, ..case }
}

const fn low(case: FrameCase) -> FrameCase {
    FrameCase {
        undriven: Undriven::Low,
        ..case
    }
}

const FIXED: &str = "[line]\nparts = [\"alignment\"]\nphase = \"fixed\"\nfixed_delay_ns = 1500\n";
const FRAME: &str = "[line]\nparts = [\"alignment\"]\nphase = \"frame\"\n";
const DOUBLE: &str = "[line]\nparts = [\"alignment\", \"double_edge\"]\nphase = \"frame\"\n";
const TRACKED: &str = "[line]\nparts = [\"alignment\"]\nphase = \"tracked\"\n";
const TRACKED_DOUBLE: &str =
    "[line]\nparts = [\"alignment\", \"double_edge\"]\nphase = \"tracked\"\n";
const INFO: &str = "[service]\nparts = [\"requests\"]\ninfos = [0x4C]\n";
const BOTH: &str = "[service]\nparts = [\"requests\"]\ninfos = [0x4C, 0x59]\n";

const CASES: [FrameCase; 21] = [
    PLAIN,
    frames(1, "000111", 4, 0, 7),
    frames(1, "111000", 8, 3, 70),
    frames(12, "000111", 32, 4, 90),
    low(frames(13, "111000", 4, 31, 780)),
    FrameCase {
        system_mhz: 16,
        ..low(frames(13, "111000", 4, 40, 500))
    },
    frames(25, "000111", 5, 2, 40),
    frames(25, "111000", 16, 5, 120),
    frames(37, "111000", 8, 16, 400),
    frames(48, "111000", 4, 3, 70),
    low(frames(48, "000111", 6, 20, 500)),
    FrameCase {
        endat: "filter_ns = 250\n",
        ..low(frames(25, "111000", 8, 4, 90))
    },
    with(INFO, frames(25, "111000", 8, 3, 70)),
    with(BOTH, frames(37, "111000", 4, 3, 70)),
    with(FIXED, frames(25, "111000", 8, 4, 90)),
    with(FRAME, frames(37, "111000", 8, 4, 90)),
    with(DOUBLE, frames(25, "111000", 8, 4, 90)),
    with(TRACKED, frames(13, "111000", 8, 4, 90)),
    with(TRACKED, frames(37, "111000", 5, 3, 70)),
    with(TRACKED, frames(48, "000111", 4, 2, 40)),
    with(TRACKED_DOUBLE, frames(25, "111000", 4, 2, 40)),
];

/// Proves the frames of a case.
pub fn prove_case(
    case: &FrameCase,
    change: impl FnOnce(&mut Subject),
    progress: &dyn Fn(&str),
) -> Result<FrameReport, CommandError> {
    let system_hz = 1_000_000 * case.system_mhz;
    let text = format!(
        "name = \"frame\"\n[clock]\nsystem_hz = {system_hz}\n[endat]\nclock_hz = {}\ncable_m = {}\n{}[[channel]]\n\
         position_bits = {}\ncommand = \"{}\"\n[trigger]\nsample_hz = 1_000\nsources = [\"pin\"]\n{}[host]\nbus = \"none\"\n",
        system_hz / case.period_cycles,
        case.cable_m,
        case.endat,
        case.position_bits,
        case.command,
        case.parts,
    );
    let project = parse("frame.toml", &text)?;
    let mut subject = Subject::new(&project)?;
    change(&mut subject);
    let line = Line::usual(case.delay_cycles, case.undriven, system_hz);
    prove(&subject, &project, line, case.phases, progress)
}

/// Proves all of them.
pub fn prove_cases(progress: &dyn Fn(&str)) -> Result<Vec<FrameReport>, CommandError> {
    let reports = CASES.iter().map(|case| prove_case(case, |_| (), progress));
    reports.collect()
}
