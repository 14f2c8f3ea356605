//! Frames corrupted in many ways: random answers, jitter, noise, glitches, settings that change in the frame. Also every word
//! of a narrow encoder, compared with an independent predicate.

use super::port::{Conditions, FrameKind, Mishap, Port, Ready};
use super::work::{digest, hash, Campaign};
use super::{CampaignError, Row, Tally};
use crate::{
    encoder::Defect,
    line::{FaultKind, Jitter},
    rng::Rng,
    Time, NS, US,
};
use rtl_design::engine::Lanes;
use std::ops::Range;
use std::sync::OnceLock;

/// Longer than the frame with its lead and recovery.
const LONG: Time = 60 * US;
/// Widest encoder for which every word is tried.
pub const WIDEST_BITS: u32 = 13;
/// Cycles of a frame in which a setting changes.
const SETTING_CYCLES: u64 = 500;

/// Kind of corruption.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Spoilt {
    /// Random bits after the start bit.
    Word,
    /// Two bits inverted.
    TwoBits,
    /// Uniform jitter of every edge, up to this many nanoseconds.
    Jitter(u64),
    /// A line fault from a random time on, for a random duration.
    Line(FaultKind),
    /// This input has a random value from a random time to the end of the frame.
    Setting(&'static str, u64),
}

/// All kinds of corruption.
const WAYS: [Spoilt; 15] = [
    Spoilt::Word,
    Spoilt::TwoBits,
    Spoilt::Jitter(50),
    Spoilt::Jitter(90),
    Spoilt::Jitter(120),
    Spoilt::Line(FaultKind::Noise),
    Spoilt::Line(FaultKind::Glitches),
    Spoilt::Line(FaultKind::StuckLow),
    Spoilt::Line(FaultKind::StuckHigh),
    Spoilt::Setting("position_bits", 48),
    Spoilt::Setting("command", 63),
    Spoilt::Setting("period_cycles", 2047),
    Spoilt::Setting("first_low_extra_cycles", 2047),
    Spoilt::Setting("start_window_cycles", 63),
    Spoilt::Setting("recovery_limit_cycles", 8191),
];

impl Spoilt {
    fn name(self) -> String {
        match self {
            Self::Word => "random word".into(),
            Self::TwoBits => "two bits".into(),
            Self::Jitter(ns) => format!("jitter {ns} ns"),
            Self::Line(kind) => kind.name().replace('_', " "),
            Self::Setting(name, _) => format!("setting {name}"),
        }
    }

    fn mishap(self, rng: &mut Rng) -> Mishap {
        let seed = rng.next_u64();
        match self {
            Self::Word => {
                let mask = u128::from(rng.next_u64()) << 64 | u128::from(rng.next_u64());
                Mishap::Answer(Defect::FlipBits(mask & !1), seed)
            }
            Self::TwoBits => {
                let mut bit = || 1u128 << rng.in_range(1, 31);
                Mishap::Answer(Defect::FlipBits(bit() | bit()), seed)
            }
            Self::Jitter(ns) => Mishap::Jitter(Jitter::Uniform(ns * NS), seed),
            Self::Line(kind) => {
                let from = rng.in_range(0, 20 * US);
                let until = match kind {
                    FaultKind::Noise | FaultKind::Glitches => rng.in_range(from + US / 4, LONG),
                    _ => LONG,
                };
                Mishap::Fault {
                    kind,
                    from,
                    until,
                    seed,
                }
            }
            Self::Setting(name, most) => Mishap::Setting {
                name,
                value: u128::from(rng.in_range(1, most)),
                cycle: rng.in_range(0, SETTING_CYCLES),
            },
        }
    }
}

struct Group {
    port: Port,
    kind: FrameKind,
    way: Spoilt,
    cases: u64,
    ready: usize,
}

/// A port that is about to begin a frame, created on first use.
struct Lazy {
    port: Port,
    kind: FrameKind,
    conditions: Conditions,
    engine: Lanes,
    ready: OnceLock<Ready>,
}

impl Lazy {
    fn get(&self) -> &Ready {
        self.ready
            .get_or_init(|| Ready::new(self.port, self.kind, self.conditions, self.engine.clone()))
    }
}

/// The campaign of corrupted frames.
pub struct Garbage {
    ready: Vec<Lazy>,
    groups: Vec<Group>,
    seed: u64,
    digest: u64,
}

impl Garbage {
    /// `cases` corrupted frames.
    ///
    /// # Errors
    /// If the design of a port cannot be elaborated.
    pub fn new(ports: &[Port], cases: u64, seed: u64) -> Result<Self, CampaignError> {
        let (mut ready, mut groups, mut digested) = (vec![], vec![], 0);
        for port in ports {
            digested ^= digest(&port.design()?);
            let engine = port.engine()?;
            for kind in [FrameKind::Position, FrameKind::Position21] {
                groups.extend(WAYS.map(|way| Group {
                    port: *port,
                    kind,
                    way,
                    cases: 0,
                    ready: ready.len(),
                }));
                ready.push(Lazy {
                    port: *port,
                    kind,
                    conditions: Conditions::default(),
                    engine: engine.clone(),
                    ready: OnceLock::new(),
                });
            }
        }
        let count = groups.len() as u64;
        for (index, group) in groups.iter_mut().enumerate() {
            group.cases = cases / count + u64::from((index as u64) < cases % count);
        }
        Ok(Self {
            ready,
            groups,
            seed,
            digest: digested,
        })
    }
}

impl Campaign for Garbage {
    fn digest(&self) -> u64 {
        self.digest
    }

    fn groups(&self) -> Vec<u64> {
        self.groups.iter().map(|g| g.cases).collect()
    }

    fn run(&self, group: usize, cases: Range<u64>) -> Tally {
        let group = &self.groups[group];
        let (subject, kind) = (
            format!("{} {}", group.port.name(), group.kind.name()),
            group.way.name(),
        );
        let drawn_by = format!("{} {}", group.port.name(), group.kind.drawn_by());
        let what = hash(&format!("{drawn_by} {kind}")) ^ self.seed;
        let mishap = |number| {
            group
                .way
                .mishap(&mut Rng::new(Rng::new(what).next_u64() ^ number))
        };
        let mishaps: Vec<Mishap> = cases.map(mishap).collect();
        let mut tally = Tally::default();
        for outcome in self.ready[group.ready].get().run(&mishaps) {
            let mut add = |class: &str| {
                let row = Row {
                    subject: subject.clone(),
                    kind: kind.clone(),
                    place: "frame".into(),
                    class: class.into(),
                };
                tally.add(row, 1);
            };
            add(outcome.class.name());
            outcome.marks().for_each(|mark| add(mark.name()));
            if outcome.cause != 0 {
                add(&format!("cause_{}", outcome.cause));
            }
        }
        tally
    }
}

/// The position that must be accepted from an answer, if any; arguments: its bits from F1 to the last one of the CRC, and whether it has an F2.
pub type Predicate = fn(&[bool], bool) -> Option<u64>;

/// Every word that an encoder of each width up to [`WIDEST_BITS`] can send, with every CRC and error bit.
pub struct AcceptSet {
    ready: Vec<(Lazy, bool)>,
    predicate: Predicate,
    digest: u64,
}

impl AcceptSet {
    /// The widths up to `widest_bits`.
    ///
    /// # Errors
    /// If the design of the port cannot be elaborated.
    pub fn new(widest_bits: u32, predicate: Predicate) -> Result<Self, CampaignError> {
        let port = Port::Position;
        let engine = port.engine()?;
        let mut ready = vec![];
        for position_bits in 1..=widest_bits {
            for (kind, f2) in [(FrameKind::Position, true), (FrameKind::Position21, false)] {
                let lazy = Lazy {
                    port,
                    kind,
                    conditions: Conditions {
                        position_bits,
                        ..Conditions::default()
                    },
                    engine: engine.clone(),
                    ready: OnceLock::new(),
                };
                ready.push((lazy, f2));
            }
        }
        Ok(Self {
            ready,
            predicate,
            digest: digest(&port.design()?),
        })
    }
}

impl Campaign for AcceptSet {
    fn digest(&self) -> u64 {
        self.digest
    }

    fn groups(&self) -> Vec<u64> {
        let words = |(lazy, f2): &(Lazy, bool)| {
            1u64 << (lazy.conditions.position_bits + 6 + u32::from(*f2))
        };
        self.ready.iter().map(words).collect()
    }

    fn run(&self, group: usize, cases: Range<u64>) -> Tally {
        let (lazy, f2) = &self.ready[group];
        // The start bit is unchanged.
        let mishap = |mask: u64| Mishap::Answer(Defect::FlipBits(u128::from(mask) << 1), 1);
        let mishaps: Vec<Mishap> = cases.map(mishap).collect();
        let mut tally = Tally::default();
        for told in lazy.get().answers(&mishaps) {
            let must = (self.predicate)(&told.answer[1..], *f2);
            let class = match (told.position, must) {
                (None, None) => "refused",
                (None, Some(_)) => "refused_wrongly",
                (told, must) if told == must => "taken",
                _ => "taken_wrongly",
            };
            let row = Row {
                subject: lazy.port.name().into(),
                kind: lazy.kind.name().into(),
                place: format!("{} bits", lazy.conditions.position_bits),
                class: class.into(),
            };
            tally.add(row, 1);
        }
        tally
    }
}
