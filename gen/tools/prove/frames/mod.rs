//! Proof of whole frames: what the encoder sent is what is published, for every position, from power-up on and for ever.
//!
//! ```text
//! power-up --> ready --first frame--> rest --frame--> rest     and a cycle without a trigger leads from each of the two to itself
//! ```
//!
//! *Ready* and *rest* are a level for each register that controls, and anything for each that holds data. They are found by running: a run
//! begins with unknown bits wherever there may be anything, and each bit of the channel is a function of these (`forms.rs`). Where two
//! runs come back differently, a register may be anything, until nothing changes any more. What is looked at is the Verilog as
//! emitted, with the settings of its configuration; encoder and cable are in `encoder.sv`.

mod cases;
mod forms;
mod induction;
mod text;
mod walk;

pub use cases::{prove_case, prove_cases, FrameCase, PLAIN};

use super::netlist::Netlist;
use super::{tools, Subject, Trace, CHANNEL};
use crate::scratch;
use clap::ValueEnum;
use endat_config::Project;
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use endat_hdl::config::{CardConfig, ChannelConfig, PhaseSource};
use endat_hdl::protocol::ModeCommand;
use induction::{Induction, Stop};
use rtl_design::elaborate::Module;
use serde::Serialize;
use std::fmt;
use std::path::Path;
use std::thread;
use std::time::Instant;
use walk::Break;

/// Phases of the microsecond that frames are proved in, unless somebody asks for more.
pub const PHASES: u64 = 16;

/// Inputs of the channel with their levels.
type Settings = Vec<(&'static str, u128)>;

/// DATA while nobody drives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum Undriven {
    /// Another level in every cycle, if it likes.
    Anything,
    /// LOW, as a line with a bias is.
    Low,
}

impl Undriven {
    /// The one that can be proved: an input filter counts DATA while nobody drives it, so anything there may come back as anything.
    pub fn usual(card: &CardConfig) -> Self {
        match card.endat_channels().next() {
            Some((_, c)) if c.filter_cycles > 0 || c.filter_half => Self::Low,
            _ => Self::Anything,
        }
    }
}

impl fmt::Display for Undriven {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Anything => "anything",
            Self::Low => "LOW",
        })
    }
}

/// Encoder and cable; times in system clock cycles.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Line {
    /// One way, from pin to pin.
    pub delay_cycles: u32,
    /// Calculation time tcal.
    pub tcal_cycles: u32,
    /// Recovery time tm.
    pub tm_cycles: u32,
    /// DATA while nobody drives it.
    pub undriven: Undriven,
}

impl Line {
    /// That of an encoder with tcal = 5 us and tm = 11 us, which is within what EnDat allows.
    pub fn usual(delay_cycles: u32, undriven: Undriven, system_hz: u64) -> Self {
        let cycles = |us: u64| (us * system_hz / 1_000_000) as u32;
        Self {
            delay_cycles,
            tcal_cycles: cycles(5),
            tm_cycles: cycles(11),
            undriven,
        }
    }
}

/// Frames to be proved.
#[derive(Clone, Debug)]
struct Case {
    name: String,
    system_hz: u64,
    command: ModeCommand,
    position_bits: u32,
    line: Line,
    /// Additional data that the encoder sends: bit 0 the first, bit 1 the second.
    infos: u32,
}

impl Case {
    /// Cycles in a microsecond.
    fn tick_cycles(&self) -> u64 {
        self.system_hz / 1_000_000
    }
}

/// What has been proved of the frames of a channel.
#[derive(Clone, Debug, Serialize)]
pub struct FrameReport {
    /// The card.
    pub name: String,
    /// Mode command, as bits.
    pub command: String,
    /// Width of the position.
    pub position_bits: u32,
    /// System clock cycles in a bit.
    pub period_cycles: u64,
    /// Where the phase of the samples comes from.
    pub phase: &'static str,
    /// Additional data in each answer.
    pub infos: u32,
    /// Encoder and cable.
    #[serde(flatten)]
    pub line: Line,
    /// From the first trigger to rest, and from each other one, at most.
    pub frame_cycles: [u64; 2],
    /// Bits of registers that have a level at rest, and bits that may be anything.
    pub rest_bits: [usize; 2],
    /// Phases of the microsecond that were proved, of how many.
    pub phases: [u64; 2],
    /// Time for all.
    pub seconds: f64,
    /// What does not hold, if anything.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub broken: Option<Broken>,
}

/// What does not hold.
#[derive(Clone, Debug, Serialize)]
pub struct Broken {
    /// In words.
    pub what: String,
    /// The run in which.
    pub run: &'static str,
    /// Its cycle.
    pub cycle: u64,
    /// There is a run that leads there, from the state that the run begins with; otherwise it was not proved that none does.
    pub is_reached: bool,
    /// Signals up to there.
    #[serde(skip)]
    pub trace: Option<Trace>,
    /// File with them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
}

impl Broken {
    fn new(found: Break, run: &'static str) -> Self {
        Self {
            what: found.what.into(),
            run,
            cycle: found.cycle,
            is_reached: found.trace.is_some(),
            trace: found.trace,
            file: None,
        }
    }

    /// Writes waveform and drawing, if there is a run, into a folder.
    pub fn keep(&mut self, folder: &Path, name: &str) -> Result<(), CommandError> {
        if let Some(trace) = &self.trace {
            trace.keep(
                folder,
                name,
                &format!("{name}: {}", self.what),
                &self.to_string(),
            )?;
            let path = folder.join(format!("{name}.vcd"));
            self.file = Some(path.display().to_string());
        }
        Ok(())
    }
}

impl fmt::Display for Broken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = match self.is_reached {
            true => "VIOLATED",
            false => "NOT PROVED",
        };
        write!(
            f,
            "{word} in cycle {} of {}: {}",
            self.cycle, self.run, self.what
        )
    }
}

impl fmt::Display for FrameReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [phases, of] = self.phases;
        let all =
            "every position arrives as it was sent, from power-up on, frame after frame: proved";
        let some = "every position arrives as it was sent, where frames begin in these phases of the microsecond: proved";
        let said = match (&self.broken, phases == of) {
            (Some(broken), _) if !broken.is_reached && self.line.undriven == Undriven::Anything => {
                format!("{broken}; --undriven low asks for less, a line with a bias")
            }
            (Some(broken), _) => broken.to_string(),
            (None, true) => all.into(),
            (None, false) => some.into(),
        };
        writeln!(
            f,
            "{}: {} bits, {}, {} additional data, {} cycles a bit, phase from {}, delay {}, tcal {}, tm {} cycles, undriven DATA {}, {phases} of {of} phases of the microsecond: {said} ({:.1} s)",
            self.name,
            self.position_bits,
            self.command,
            self.infos,
            self.period_cycles,
            self.phase,
            self.line.delay_cycles,
            self.line.tcal_cycles,
            self.line.tm_cycles,
            self.line.undriven,
            self.seconds,
        )
    }
}

/// Proves the frames of a card's first EnDat channel, in so many phases of the microsecond at most.
pub fn prove(
    subject: &Subject,
    project: &Project,
    line: Line,
    phases: u64,
    progress: &dyn Fn(&str),
) -> Result<FrameReport, CommandError> {
    let started = Instant::now();
    let card = &project.card;
    let is_endat = |c: &&ChannelConfig| c.is_endat();
    let top = (subject.design.modules.iter()).position(|m| m.type_name == CHANNEL);
    let (Some(channel), Some(top)) = (card.channels.iter().find(is_endat), top) else {
        return Err(CommandError::input(format!(
            "{}: has no EnDat channel; give a configuration with one",
            subject.name
        )));
    };
    if !card.system_hz.is_multiple_of(1_000_000) {
        return Err(CommandError::input(format!(
            "{}: frames are proved at whole megahertz; take another system_hz",
            subject.name
        )));
    }
    if !subject.design.has_initial_values {
        return Err(CommandError::input(format!(
            "{}: frames are proved from the start values on; take initial_values = false out, which changes nothing else",
            subject.name
        )));
    }
    let parts = card.line.start(card.system_hz);
    let settings: Settings = vec![
        ("period_cycles", channel.period_cycles.into()),
        (
            "first_low_extra_cycles",
            channel.first_low_extra_cycles.into(),
        ),
        ("command", channel.command.code().into()),
        ("position_bits", channel.position_bits.into()),
        ("filter_cycles", channel.filter_cycles.into()),
        ("start_window_cycles", channel.start_window_cycles.into()),
        ("start_timeout_us", channel.start_timeout_us.into()),
        (
            "recovery_limit_cycles",
            channel.recovery_limit_cycles.into(),
        ),
        ("phase_mode", parts.phase_mode.into()),
        ("fixed_delay", parts.fixed_delay.into()),
        ("majority", parts.majority.into()),
    ];
    let case = Case {
        name: subject.name.clone(),
        system_hz: card.system_hz,
        command: channel.command,
        position_bits: channel.position_bits,
        line,
        infos: match channel.command.has_f2() {
            true => infos(&card.service.infos),
            false => 0,
        },
    };
    let all = case.tick_cycles();
    let count = all.min(phases);
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let threads = threads.min(count as usize);
    let scope = match count == all {
        true => String::new(),
        false => format!("; --phases {all} proves all of them"),
    };
    progress(&format!(
        "{}: frames that begin in {count} of {all} phases of the microsecond, {threads} at a time{scope}",
        subject.name
    ));
    let netlist = gates(subject, &subject.design.modules[top], &case, &settings)?;
    let mut induction = Induction {
        netlist: &netlist,
        case: &case,
        phases: (0..count).map(|phase| phase * all / count).collect(),
        threads,
        progress,
        frame_cycles: [0, 0],
        rest_bits: [0, 0],
    };
    let broken = match induction.run() {
        Ok(()) => None,
        Err(Stop::Broken(broken)) => Some(broken),
        Err(Stop::Error(error)) => return Err(error),
    };
    Ok(FrameReport {
        command: format!("{:06b}", case.command.code()),
        position_bits: case.position_bits,
        period_cycles: channel.period_cycles,
        phase: match card.line.phase {
            _ if !card.line.alignment => "first frame",
            PhaseSource::Tracked => "edges",
            PhaseSource::Frame => "start bit",
            PhaseSource::Fixed => "setting",
        },
        infos: case.infos.count_ones(),
        line,
        frame_cycles: induction.frame_cycles,
        rest_bits: induction.rest_bits,
        phases: [count, all],
        seconds: started.elapsed().as_secs_f64(),
        broken,
        name: case.name,
    })
}

/// Which additional data these MRS codes select: bit 0 the first, bit 1 the second.
fn infos(codes: &[u8]) -> u32 {
    let of = |code: &u8| match code >> 4 {
        4 => 1,
        5 => 2,
        _ => 0,
    };
    codes.iter().fold(0, |infos, code| infos | of(code))
}

/// The channel of these files with encoder and cable, as gates.
fn gates(
    subject: &Subject,
    channel: &Module,
    case: &Case,
    settings: &Settings,
) -> Result<Netlist, CommandError> {
    let folder = scratch::folder()?;
    let mut files = subject.files.clone();
    let frames = text::frames(channel, case, settings);
    files.push(Artifact::new(format!("{}.sv", text::FRAMES), frames));
    endat_console::artifact::write(folder.path(), &files, scratch::REMEDY)?;
    let names: Vec<&str> = files.iter().map(|f| f.path.as_str()).collect();
    let text = tools::gates(folder.path(), &names, text::FRAMES, text::WHOLE)?;
    Netlist::read(&text, text::FRAMES).map_err(|what| unreadable(case, &what))
}

fn unreadable(case: &Case, what: &str) -> CommandError {
    CommandError::input(format!(
        "{}: cannot run the Verilog: {what}; correct the file, or prove it as `emit` writes it",
        case.name
    ))
}
