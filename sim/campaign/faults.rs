//! Every fault of the line begins or ends at every quarter bit of a frame, with every recovery time and cable.

use super::port::{Conditions, FrameKind, Mishap, Port, Ready, LEAD_PS};
use super::work::{digest, hash, Campaign};
use super::{CampaignError, Row, Tally};
use crate::{line::FaultKind, rng::Rng, Time, NS, US};
use rtl_design::engine::Lanes;
use std::ops::Range;
use std::sync::OnceLock;

/// A quarter of a bit.
const QUARTER: Time = 62_500;
/// From [`LEAD_PS`] before the trigger to after the longest answer.
const QUARTERS: u64 = 300;
/// Longer than the rest of a frame with its longest recovery time.
const LONG: Time = 60 * US;
/// Recovery times of the encoder.
const RECOVERIES: [Time; 6] = [1_250 * NS, 2 * US, 5 * US, 10 * US, 25 * US, 30 * US];
/// Shortest recovery time of 000111.
const LONG_RECOVERY: Time = 10 * US;
/// Cables in metres.
const CABLES_M: [f64; 3] = [1.0, 20.0, 100.0];

struct Group {
    port: Port,
    kind: FrameKind,
    conditions: Conditions,
    engine: Lanes,
    ready: OnceLock<Ready>,
}

impl Group {
    fn place(&self) -> String {
        let tm = self.conditions.tm.unwrap_or(0) as f64 / US as f64;
        format!("tm {tm:5.2} us; {:3} m", self.conditions.cable_m)
    }
}

/// The campaign.
pub struct Faults {
    groups: Vec<Group>,
    step: u64,
    seed: u64,
    digest: u64,
}

impl Faults {
    /// Faults at every `step`-th quarter of a bit.
    ///
    /// # Errors
    /// If the design of a port cannot be elaborated.
    pub fn new(ports: &[Port], step: u64, seed: u64) -> Result<Self, CampaignError> {
        let (mut groups, mut digested) = (vec![], 0);
        for port in ports {
            digested ^= digest(&port.design()?);
            let engine = port.engine()?;
            for kind in [FrameKind::Position, FrameKind::Position21] {
                let legal = RECOVERIES
                    .into_iter()
                    .filter(|tm| kind == FrameKind::Position || *tm >= LONG_RECOVERY);
                for (tm, cable_m) in legal.flat_map(|tm| CABLES_M.map(|cable_m| (tm, cable_m))) {
                    groups.push(Group {
                        port: *port,
                        kind,
                        conditions: Conditions {
                            tm: Some(tm),
                            cable_m,
                            ..Conditions::default()
                        },
                        engine: engine.clone(),
                        ready: OnceLock::new(),
                    });
                }
            }
        }
        Ok(Self {
            groups,
            step,
            seed,
            digest: digested,
        })
    }

    fn moments(&self) -> u64 {
        QUARTERS.div_ceil(self.step)
    }
}

impl Campaign for Faults {
    fn digest(&self) -> u64 {
        self.digest
    }

    fn groups(&self) -> Vec<u64> {
        let each = 2 * FaultKind::ALL.len() as u64 * self.moments();
        vec![each; self.groups.len()]
    }

    fn run(&self, group: usize, cases: Range<u64>) -> Tally {
        let group = &self.groups[group];
        let ready = group.ready.get_or_init(|| {
            Ready::new(
                group.port,
                group.kind,
                group.conditions,
                group.engine.clone(),
            )
        });
        let place = group.place();
        let what = hash(&format!(
            "{} {} {place}",
            group.port.name(),
            group.kind.drawn_by()
        ));
        let fault = |number: u64| {
            let (moment, number) = (number % self.moments(), number / self.moments());
            let kind = FaultKind::ALL[(number / 2) as usize];
            let at = moment * self.step * QUARTER;
            // On in the frame and off after it, or on before it and off in it.
            let (from, until) = match number % 2 {
                0 => (at, LEAD_PS + LONG),
                _ => (0, at.max(QUARTER)),
            };
            let seed = Rng::new(what ^ self.seed ^ number << 32 ^ moment).next_u64();
            Mishap::Fault {
                kind,
                from,
                until,
                seed,
            }
        };
        let faults: Vec<Mishap> = cases.map(fault).collect();
        let mut tally = Tally::default();
        for (mishap, outcome) in faults.iter().zip(ready.run(&faults)) {
            let Mishap::Fault { kind, from, .. } = mishap else {
                continue;
            };
            let edge = match from {
                0 => "off",
                _ => "on",
            };
            let mut add = |class: &str| {
                let row = Row {
                    subject: format!("{} {}", group.port.name(), group.kind.name()),
                    kind: format!("{} {edge}", kind.name()),
                    place: place.clone(),
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
