//! Positions of a file counted on: as it says what they are, as its user says, or as far as its columns tell.

use super::super::about::scale_of;
use super::{Cell, Head, Wrong};
use endat_host::motion::Unwrap;
use endat_host::range::Ranges;
use endat_host::units::Scale;
use endat_regs::Protocol;

/// Counts turns on where a file does not say how many measuring steps a turn has.
#[derive(Clone, Debug, Default)]
struct TextTurns {
    is_multiturn: bool,
    /// Last value within the turn, and turns until then.
    last: Option<(f64, f64)>,
}

impl TextTurns {
    fn step(&mut self, value: f64, told: u64, unit: &str) -> f64 {
        if unit != "deg" {
            return value;
        }
        self.is_multiturn |= told > 0;
        let (last, turns) = self.last.unwrap_or((value, 0.0));
        let turns = match self.is_multiturn {
            true => told as f64,
            false => turns - ((value - last) / 360.0).round(),
        };
        self.last = Some((value, turns));
        value + turns * 360.0
    }
}

/// A channel of a file.
#[derive(Clone, Debug, Default)]
pub struct Channel {
    /// Its scale, if it is known.
    scale: Option<Scale>,
    /// Its scale if turns have a fixed bit, as in T-format: text without a description may have either.
    apart: Option<Scale>,
    /// The user has said so: positions must fit.
    is_said: bool,
    turns: Unwrap,
    text: TextTurns,
}

/// Channels of a file that begins so, with what is said about some of them.
pub fn channels(head: &Head, said: &Ranges) -> Result<Vec<Channel>, Wrong> {
    said.check(head.units.len())
        .map_err(|why| Wrong::at(0, why.to_string()))?;
    let each = 0..head.units.len();
    each.map(|n| Channel::new(head, n, said)).collect()
}

impl Channel {
    fn new(head: &Head, n: usize, said: &Ranges) -> Result<Self, Wrong> {
        let about = &head.about["channels"][n];
        let spoken = Protocol::ALL.iter().find(|p| about["protocol"] == p.name());
        let said_of = |protocol: Protocol| {
            let scale = said.scale(n, protocol, None);
            scale.map_err(|why| Wrong::at(0, why.to_string()))
        };
        let mine = said_of(spoken.copied().unwrap_or(Protocol::Endat))?;
        let mut others = Protocol::ALL
            .iter()
            .filter(|p| p.row().turns_at.is_some() && spoken.is_none());
        let apart = match others.next() {
            // It may have more bits than these positions.
            Some(other) => said_of(*other).unwrap_or_default(),
            None => None,
        };
        let known = scale_of(about);
        let scale = match (mine, known) {
            // The same, and more of it.
            (Some(Scale::Counted), Some(known @ Scale::Linear { .. })) => Some(known),
            (said, known) => said.or(known),
        };
        Ok(Self {
            scale,
            apart: apart.filter(|_| mine.is_some()),
            is_said: mine.is_some(),
            turns: Unwrap::new(scale.and_then(|scale| scale.range())),
            text: TextTurns::default(),
        })
    }

    /// Its scale, if it is known.
    pub fn scale(&self) -> Option<Scale> {
        self.scale
    }

    /// The position of a cell, counted on if its range is known.
    pub(super) fn position(&mut self, cell: &Cell, unit: &str) -> Result<Option<f64>, String> {
        let (Some(mut scale), Some(raw)) = (self.scale, cell.raw) else {
            let turns = cell.turns.unwrap_or(0);
            return Ok(cell.value.map(|value| self.text.step(value, turns, unit)));
        };
        if let Some(apart) = self.apart {
            let is_in_turn =
                |scale: &Scale| scale.fits(raw) && cell.turns == scale.convert(raw).turns;
            if !is_in_turn(&scale) && is_in_turn(&apart) {
                scale = apart;
            }
        }
        if self.is_said && !scale.fits(raw) {
            return Err(format!("= {raw}: has more bits than --range gives it, {scale}; give as many as the encoder has"));
        }
        Ok(Some(scale.value(self.turns.step(scale.steps(raw)))))
    }
}
