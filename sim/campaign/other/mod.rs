//! Ports of other protocols than EnDat in lanes: a frame with an inverted flip-flop, a disturbed line or a faulty encoder, and
//! the frames after it. Each lane triggers when it is idle and its time has come, as in [`super::port`].

mod run;
pub mod ssi;
pub mod t_format;

use super::port::Outcome;
use super::upsets::{Draw, Flops};
use super::work::{digest, hash, Campaign};
use super::{CampaignError, Row, Tally};
use crate::{rng::Rng, Time};
use rtl_design::elaborate::Design;
use rtl_design::engine::{Keep, LaneWords, Lanes};
use run::Ready;
use std::ops::Range;
use std::sync::Arc;

const LANES: usize = 128;
/// Time before the frame, for faults that exist when it begins.
const LEAD_US: u64 = 2;

/// Settings of a port, and duration of its frame.
#[derive(Clone)]
pub struct Plan {
    /// Name of the port in tables.
    pub subject: &'static str,
    /// Name of the frame in tables.
    pub kind: &'static str,
    system_mhz: u64,
    settings: &'static [(&'static str, u64)],
    /// Cycles from one trigger to the next: the frame, and the line at rest.
    span_cycles: u64,
    /// Part of it in which a disturbance begins or ends.
    disturbed_cycles: u64,
    /// End of a disturbance that began in the frame: after the longest recovery time.
    over_cycles: u64,
    /// More than any wait of a port after an upset.
    hang_cycles: u64,
    /// A quarter of a bit.
    quarter_cycles: u64,
    /// Settings that change in a frame, and their largest values.
    changes: &'static [(&'static str, u64)],
}

impl Plan {
    fn cycle_ps(&self) -> Time {
        1_000_000 / self.system_mhz
    }
}

/// An encoder in a lane.
pub trait Device: Clone + Send + Sync + 'static {
    /// Input pins, in the order of [`Self::hear`].
    const PINS: &'static [&'static str];
    /// Index of the pin with the receiver's driver, if any.
    const DRIVER: Option<usize>;
    /// Kinds of encoder faults.
    const WAYS: &'static [&'static str];

    /// The frames that are tried.
    fn plans() -> Vec<Plan>;
    /// The port.
    fn design() -> Result<Design, CampaignError>;
    /// An encoder for that frame.
    fn new(plan: &Plan) -> Self;
    /// The pins change.
    fn hear(&mut self, now: Time, pins: &[bool]);
    /// Processes due events.
    fn advance(&mut self, now: Time);
    /// Time of the next event.
    fn next_event(&self) -> Option<Time>;
    /// DATA, with the bias of the line.
    fn data(&self) -> bool;
    /// Sets the position of this round; returns it in the format of a result.
    fn turn(&mut self, round: u32) -> u64;
    /// Number of complaints.
    fn complaints(&self) -> usize;
    /// Applies a fault, one of [`Self::WAYS`].
    fn spoil(&mut self, way: usize, rng: &mut Rng);
    /// Removes the fault.
    fn mend(&mut self);
}

/// A disturbance of the line at the receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineFault {
    /// DATA is LOW.
    StuckLow,
    /// DATA is HIGH.
    StuckHigh,
    /// The plug is off: the encoder receives nothing, and DATA is HIGH.
    PlugHigh,
    /// The plug is off, with a LOW bias.
    PlugLow,
    /// Any level in any cycle.
    Noise,
    /// Occasional pulses of up to 16 cycles.
    Glitches,
}

impl LineFault {
    const ALL: [Self; 6] = [
        Self::StuckLow,
        Self::StuckHigh,
        Self::PlugHigh,
        Self::PlugLow,
        Self::Noise,
        Self::Glitches,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::StuckLow => "stuck_low",
            Self::StuckHigh => "stuck_high",
            Self::PlugHigh => "plug_off_bias_high",
            Self::PlugLow => "plug_off_bias_low",
            Self::Noise => "noise",
            Self::Glitches => "glitches",
        }
    }
}

/// A fault in a frame; cycles count from the trigger, those of the line from [`LEAD_US`] before it.
#[derive(Clone, Copy, Debug)]
enum Mishap {
    Flip {
        register: usize,
        bit: usize,
        cycle: u64,
    },
    Line {
        fault: LineFault,
        from: u64,
        until: u64,
        seed: u64,
    },
    Encoder {
        way: usize,
        seed: u64,
    },
    Setting {
        name: &'static str,
        value: u64,
        cycle: u64,
    },
}

fn engine<D: Device>() -> Result<(u64, Lanes), CampaignError> {
    let design = D::design()?;
    let engine = Lanes::new(&design, Keep::Registers, LaneWords::Two)?;
    Ok((digest(&design), engine))
}

fn tell(tally: &mut Tally, row: &Row, outcome: &Outcome, with_cause: bool) {
    let mut add = |class: &str| {
        let class = class.into();
        tally.add(
            Row {
                class,
                ..row.clone()
            },
            1,
        );
    };
    add(outcome.class.name());
    outcome.marks().for_each(|mark| add(mark.name()));
    if with_cause && outcome.cause != 0 {
        add(&format!("cause_{}", outcome.cause));
    }
}

/// Every flip-flop of a port inverted.
pub struct OtherUpsets<D: Device> {
    flops: Flops,
    draw: Draw,
    seed: u64,
    frames: Vec<Ready<D>>,
    digest: u64,
}

impl<D: Device> OtherUpsets<D> {
    /// Upsets of registers [selected by name](super::upsets::is_asked).
    ///
    /// # Errors
    /// If the design cannot be elaborated.
    pub fn new(draw: Draw, seed: u64, only: &str) -> Result<Self, CampaignError> {
        let (digest, engine) = engine::<D>()?;
        let plans = D::plans().into_iter();
        Ok(Self {
            flops: Flops::new(&engine, only),
            draw,
            seed,
            frames: plans.map(|p| Ready::new(p, engine.clone())).collect(),
            digest,
        })
    }

    /// Random cases, an equal share of each kind of frame.
    fn draw(&self, group: usize) -> Draw {
        let count = self.frames.len() as u64;
        match self.draw {
            Draw::Random { cases } => Draw::Random {
                cases: cases / count + u64::from((group as u64) < cases % count),
            },
            grid => grid,
        }
    }
}

impl<D: Device> Campaign for OtherUpsets<D> {
    fn digest(&self) -> u64 {
        self.digest
    }

    fn groups(&self) -> Vec<u64> {
        let frames = 0..self.frames.len();
        frames.map(|n| self.flops.cases(self.draw(n))).collect()
    }

    fn run(&self, group: usize, cases: Range<u64>) -> Tally {
        let ready = &self.frames[group];
        let plan = &ready.plan;
        let label = format!("{} {}", plan.subject, plan.kind);
        let (draw, span) = (self.draw(group), plan.span_cycles);
        let drawn = cases.map(|number| self.flops.case(draw, self.seed, &label, span, number));
        let drawn: Vec<(usize, u64)> = drawn.collect();
        let flip = |(index, cycle): &(usize, u64)| {
            let ((register, bit), cycle) = (self.flops.bits[*index], *cycle);
            Mishap::Flip {
                register,
                bit,
                cycle,
            }
        };
        let flips: Vec<Mishap> = drawn.iter().map(flip).collect();
        let mut tally = Tally::default();
        for ((index, _), outcome) in drawn.iter().zip(ready.run(&flips)) {
            let row = Row {
                subject: plan.subject.into(),
                kind: plan.kind.into(),
                place: self.flops.names[*index].clone(),
                class: String::new(),
            };
            tell(&mut tally, &row, &outcome, false);
        }
        tally
    }
}

/// The fault of a case of [`OtherFrames`], with its name.
type Draws = Arc<dyn Fn(&Plan, u64) -> (String, Mishap) + Send + Sync>;

/// Frames with a fault that depends on the number of the case.
pub struct OtherFrames<D: Device> {
    frames: Vec<Ready<D>>,
    cases: Vec<u64>,
    draws: Draws,
    digest: u64,
}

impl<D: Device> OtherFrames<D> {
    fn new(cases: impl Fn(&Plan) -> u64, draws: Draws) -> Result<Self, CampaignError> {
        let (digest, engine) = engine::<D>()?;
        let plans = D::plans();
        Ok(Self {
            cases: plans.iter().map(cases).collect(),
            frames: (plans.into_iter())
                .map(|p| Ready::new(p, engine.clone()))
                .collect(),
            draws,
            digest,
        })
    }

    /// Faults of the line that begin or end at every `step`-th quarter of a bit.
    ///
    /// # Errors
    /// If the design cannot be elaborated.
    pub fn faults(step: u64, seed: u64) -> Result<Self, CampaignError> {
        let moments = move |plan: &Plan| {
            let cycles = LEAD_US * plan.system_mhz + plan.disturbed_cycles;
            (cycles / plan.quarter_cycles).div_ceil(step)
        };
        let draws = move |plan: &Plan, number: u64| {
            let (moment, number) = (number % moments(plan), number / moments(plan));
            let fault = LineFault::ALL[(number / 2) as usize];
            let at = moment * step * plan.quarter_cycles;
            let last = LEAD_US * plan.system_mhz + plan.over_cycles;
            // On in the frame and off after it, or on before it and off in it.
            let (from, until, edge) = match number % 2 {
                0 => (at, last, "on"),
                _ => (0, at.max(1), "off"),
            };
            let what = hash(&format!("{} {} {number} {moment}", plan.subject, plan.kind));
            let seed = Rng::new(what ^ seed).next_u64();
            let mishap = Mishap::Line {
                fault,
                from,
                until,
                seed,
            };
            (format!("{} {edge}", fault.name()), mishap)
        };
        let count = move |plan: &Plan| 2 * LineFault::ALL.len() as u64 * moments(plan);
        Self::new(count, Arc::new(draws))
    }

    /// `cases` corrupted frames: by the encoder, the line, or a changing setting.
    ///
    /// # Errors
    /// If the design cannot be elaborated.
    pub fn garbage(cases: u64, seed: u64) -> Result<Self, CampaignError> {
        let draws = move |plan: &Plan, number: u64| {
            let what = hash(&format!("{} {}", plan.subject, plan.kind));
            let mut rng = Rng::new(Rng::new(what ^ seed).next_u64() ^ number);
            let ways = D::WAYS.len() + LineFault::ALL.len() + plan.changes.len();
            let way = number as usize % ways;
            if let Some(name) = D::WAYS.get(way) {
                let seed = rng.next_u64();
                return ((*name).to_owned(), Mishap::Encoder { way, seed });
            }
            let way = way - D::WAYS.len();
            if let Some(fault) = LineFault::ALL.get(way) {
                let last = LEAD_US * plan.system_mhz + plan.disturbed_cycles;
                let from = rng.in_range(0, last - 1);
                let mishap = Mishap::Line {
                    fault: *fault,
                    from,
                    until: rng.in_range(from + 1, last),
                    seed: rng.next_u64(),
                };
                return (fault.name().replace('_', " "), mishap);
            }
            let (name, most) = plan.changes[way - LineFault::ALL.len()];
            let mishap = Mishap::Setting {
                name,
                value: rng.in_range(0, most),
                cycle: rng.in_range(0, plan.disturbed_cycles),
            };
            (format!("setting {name}"), mishap)
        };
        let count = D::plans().len() as u64;
        Self::new(|_| cases / count, Arc::new(draws))
    }
}

impl<D: Device> Campaign for OtherFrames<D> {
    fn digest(&self) -> u64 {
        self.digest
    }

    fn groups(&self) -> Vec<u64> {
        self.cases.clone()
    }

    fn run(&self, group: usize, cases: Range<u64>) -> Tally {
        let ready = &self.frames[group];
        let plan = &ready.plan;
        let drawn: Vec<(String, Mishap)> = cases.map(|n| (self.draws)(plan, n)).collect();
        let mishaps: Vec<Mishap> = drawn.iter().map(|(_, mishap)| *mishap).collect();
        let mut tally = Tally::default();
        for ((kind, _), outcome) in drawn.into_iter().zip(ready.run(&mishaps)) {
            let row = Row {
                subject: format!("{} {}", plan.subject, plan.kind),
                // Distinguishes these rows from those of EnDat's ports.
                kind: format!("{}: {kind}", plan.subject),
                place: "line without delay".into(),
                class: String::new(),
            };
            tell(&mut tally, &row, &outcome, true);
        }
        tally
    }
}
