//! Proof of a whole frame: what the encoder sent is what is published, for every position.
//!
//! ```text
//! start values --first frame--> rest         run with the encoder model of the bench
//!                 rest --a frame--> rest     proved: any position, any data left over from before
//!                 rest --a cycle--> rest     proved: waiting
//! ```
//!
//! In all phases of the microsecond that is every frame after the first one, which measures the delay, for ever. *Rest* is a value for each register that
//! controls, and anything for each that holds data; `rest.rs` finds it by running the channel, the proofs show that it is one.
//! The channel is as emitted, with the settings of its configuration; encoder and cable are in `encoder.sv`.

mod cases;
mod rest;
mod text;

pub use cases::{prove_case, prove_cases};

use super::{below, tools, Subject, Verdict, PROVED};
use crate::artifact::Artifact;
use crate::config::Project;
use crate::error::GenError;
use crate::scratch;
use endat_hdl::elaborate::Design;
use endat_hdl::protocol::ModeCommand;
use rest::{Register, Rest};
use serde::Serialize;
use std::fmt;
use std::time::Instant;
use text::{Run, CHECKS, REST};

/// Longer than a frame takes here and with the encoder model, in cycles.
const SLACK_CYCLES: u64 = 40;
/// Most phases of the microsecond that are proved one by one.
pub const PHASES_MAX: u64 = 8;
/// How often a register that is the same by chance may turn out to hold data.
const REPAIRS_MAX: usize = 30;

/// Inputs of the channel with their levels.
type Settings = Vec<(&'static str, u128)>;

/// Times of encoder and cable, in system clock cycles.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Times {
    /// One way, from pin to pin.
    pub delay_cycles: u32,
    /// Calculation time tcal.
    pub tcal_cycles: u32,
    /// Recovery time tm.
    pub tm_cycles: u32,
}

/// A frame to be proved.
#[derive(Clone, Debug)]
struct Case {
    name: String,
    system_hz: u64,
    command: ModeCommand,
    position_bits: u32,
    times: Times,
    /// Where in the microsecond the run begins, in cycles.
    tick_phase: u64,
}

impl Case {
    /// Cycles in a microsecond.
    fn tick_cycles(&self) -> u64 {
        self.system_hz / 1_000_000
    }
}

/// What has been proved of a frame.
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
    /// Encoder and cable.
    #[serde(flatten)]
    pub times: Times,
    /// From a trigger to rest.
    pub frame_cycles: u64,
    /// Bits of registers that have a value at rest, and bits that hold anything.
    pub rest_bits: [usize; 2],
    /// Phases of the microsecond that were proved, of how many.
    pub phases: [u64; 2],
    /// Time for all.
    pub seconds: f64,
    /// The answer.
    pub verdict: Verdict,
    /// What does not hold, if anything.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub broken: Option<String>,
}

impl fmt::Display for FrameReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [phases, of] = self.phases;
        writeln!(
            f,
            "{}: {} bits, {}, {} cycles a bit, delay {}, tcal {}, tm {} cycles: {} ({:.1} s, {phases} of {of} phases of the microsecond)",
            self.name,
            self.position_bits,
            self.command,
            self.period_cycles,
            self.times.delay_cycles,
            self.times.tcal_cycles,
            self.times.tm_cycles,
            match &self.broken {
                Some(broken) => broken.clone(),
                None if phases == of => format!("every position arrives as it was sent, frame after frame, {}", self.verdict),
                None => format!("every position arrives as it was sent, in a frame that begins in these phases, {}", self.verdict),
            },
            self.seconds,
        )
    }
}

/// Proves the frames of a card's first EnDat channel, in so many phases of the microsecond at most.
pub fn prove(
    subject: &Subject,
    project: &Project,
    times: Times,
    phases: u64,
    progress: &dyn Fn(&str),
) -> Result<FrameReport, GenError> {
    let started = Instant::now();
    let card = &project.card;
    let is_endat = |c: &&endat_hdl::config::ChannelConfig| c.t_format.is_none();
    let top = (subject.design.modules.iter()).position(|m| m.type_name == PROVED);
    let (Some(channel), Some(top)) = (card.channels.iter().find(is_endat), top) else {
        return Err(GenError::input(format!(
            "{}: has no EnDat channel; give a configuration with one",
            subject.name
        )));
    };
    if card.line.double_edge || !card.system_hz.is_multiple_of(1_000_000) {
        return Err(GenError::input(format!(
            "{}: frames are proved for channels that look at DATA on one edge, at whole megahertz; take double_edge out, or another system_hz",
            subject.name
        )));
    }
    let line = card.line.start(card.system_hz);
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
        ("phase_mode", line.phase_mode.into()),
        ("fixed_delay", line.fixed_delay.into()),
        ("majority", line.majority.into()),
    ];
    let mut case = Case {
        name: subject.name.clone(),
        system_hz: card.system_hz,
        command: channel.command,
        position_bits: channel.position_bits,
        times,
        tick_phase: 0,
    };
    let design = cut(&subject.design, top);
    let rest = rest::find(&design, &case, &settings)?;
    let mut proof = Proof {
        subject,
        channel: &design,
        settings: &settings,
        registers: text::around(&case)
            .into_iter()
            .chain(rest.registers.clone())
            .collect(),
        rest: &rest,
    };
    let all = case.tick_cycles();
    let phases = all.min(phases);
    let of_phase = |phase| [Run::Wait, Run::Frame].map(|run| (phase * all / phases, run));
    let runs: Vec<(u64, Run)> = (0..phases).flat_map(of_phase).collect();
    let mut broken = None;
    let (mut next, mut repairs) = (0, 0);
    while let Some(&(phase, run)) = runs.get(next) {
        progress(&format!(
            "{}: {} of {}, a frame has {} cycles",
            case.name,
            next + 1,
            runs.len(),
            rest.frame_cycles
        ));
        next += 1;
        case.tick_phase = phase;
        let Some(output) = proof.violated(&case, run)? else {
            continue;
        };
        // A register that was the same by chance holds data. All that was shown with it has to be shown without it.
        let index = output
            .strip_prefix(REST)
            .and_then(|i| i.parse::<usize>().ok());
        match index {
            Some(index) if repairs < REPAIRS_MAX => {
                progress(&format!(
                    "{}: {} may hold anything",
                    case.name, proof.registers[index].name
                ));
                proof.registers[index].value = None;
                repairs += 1;
                next = 0;
            }
            _ => {
                broken = Some(words(&output).to_owned());
                break;
            }
        }
    }
    let bits = |has_value: bool| {
        let found = proof.registers.iter();
        let found = found.filter(|r| r.value.is_some() == has_value);
        found.map(|r| r.width_bits).sum()
    };
    Ok(FrameReport {
        name: case.name,
        command: format!("{:06b}", case.command.code()),
        position_bits: case.position_bits,
        period_cycles: channel.period_cycles,
        times,
        frame_cycles: rest.frame_cycles,
        rest_bits: [bits(true), bits(false)],
        phases: [phases, all],
        seconds: started.elapsed().as_secs_f64(),
        verdict: match broken {
            None => Verdict::Proved,
            Some(_) => Verdict::NotProved,
        },
        broken,
    })
}

/// The tree below a module as a design of its own. Modules stand before those that they instantiate.
fn cut(design: &Design, top: usize) -> Design {
    let wanted = below(design, top);
    let last = wanted.iter().max().map_or(top, |&m| m);
    let mut cut = design.clone();
    cut.modules.truncate(last + 1);
    cut.modules.drain(..top);
    for module in &mut cut.modules {
        for instance in &mut module.instances {
            instance.module -= top;
        }
    }
    cut
}

struct Proof<'a> {
    subject: &'a Subject,
    channel: &'a Design,
    settings: &'a Settings,
    registers: Vec<Register>,
    rest: &'a Rest,
}

impl Proof<'_> {
    /// An output that becomes HIGH in a run, if any does.
    fn violated(&self, case: &Case, run: Run) -> Result<Option<String>, GenError> {
        let folder = scratch::folder()?;
        let frames = text::frames(self.channel.top(), case, self.settings);
        let limit = match run {
            Run::Frame => self.rest.frame_cycles,
            Run::Wait => 0,
        } + SLACK_CYCLES;
        let look = text::look(case, run, &self.registers, limit);
        let mut files = self.subject.files.clone();
        files.push(Artifact::new(format!("{}.sv", text::FRAMES), frames));
        files.push(Artifact::new(format!("{}.sv", text::LOOK), look));
        crate::artifact::write(folder.path(), &files, scratch::REMEDY)?;
        let names: Vec<&str> = files.iter().map(|f| f.path.as_str()).collect();
        let (look, rest) = names.split_last().unwrap_or((&"", &[]));
        let with_value = self.registers.iter().filter(|r| r.value.is_some());
        let exposed: String = with_value
            .clone()
            .map(|r| format!("w:{} ", r.name))
            .collect();
        let inits: String = with_value
            .map(|r| {
                let (width, value) = (r.width_bits, r.value.unwrap_or(0));
                format!("setattr -set init {width}'b{value:0width$b} w:{}\n", r.name)
            })
            .chain([format!(
                "setattr -set init 8'd{} w:tick_count\n",
                case.tick_phase
            )])
            .collect();
        let script = format!(
            "read_verilog -formal -noassert -sv -DFORMAL {}\nhierarchy -top {frames}\nproc\nflatten\nasync2sync\nsetattr -unset init w:*\n{inits}\
             expose {exposed}w:u.u_snapshot.f_whole\n\
             read_verilog -formal -sv {look}\nhierarchy -top {top}\nproc\nflatten\nopt_clean\nsetundef -undriven -anyseq\n\
             prep -top {top} -nordff\nasync2sync\ndffunmap\nchformal -lower\nopt -full\ndffunmap\nopt_clean\nmemory_map\nopt -full\n\
             setundef -anyseq\ntechmap\nopt -fast\ndffunmap\nsetundef -zero\naigmap\nopt_clean\n",
            rest.join(" "),
            frames = text::FRAMES,
            top = text::LOOK,
        );
        tools::first_violated(folder.path(), &script, limit + 1)
    }
}

/// What it means that an output is HIGH.
fn words(output: &str) -> &str {
    let known = [
        "the encoder sees a wrong clock, command or driver",
        "both drive DATA",
        "what is published is not what was sent",
        "a second result",
        "no result, or no rest after it",
        "the stored position does not fit its parity",
    ];
    let found = CHECKS.iter().position(|c| *c == output);
    found.map_or("the channel does not come back to one rest", |i| known[i])
}
