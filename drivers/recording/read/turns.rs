//! Positions of a file counted on: as it says what they are, as its user says, or as far as its columns tell.

use super::super::about::scale_of;
use super::super::layout::of_channel;
use super::{Cell, Head, Wrong};
use endat_host::motion::Unwrap;
use endat_host::range::{self, Ranges};
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
    /// A value counted on. Refuses turns that are not those of the short way from the row before: the encoder may have begun to count anew,
    /// and nobody says after how many turns it does.
    fn step(&mut self, n: usize, value: f64, told: u64, unit: &str) -> Result<f64, String> {
        if unit != "deg" {
            return Ok(value);
        }
        let (last, turns) = self.last.unwrap_or((value, told as f64));
        let turns = turns - ((value - last) / 360.0).round();
        self.is_multiturn |= told > 0;
        if self.is_multiturn && turns != told as f64 {
            return Err(format!(
                "{} = {told}: by the short way from the row before it is turn {turns}; {}",
                of_channel(n, "turns"),
                range::refusal(n)
            ));
        }
        self.last = Some((value, turns));
        Ok(value + turns * 360.0)
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

    /// The position of a cell of channel `n`, counted on if its range is known.
    pub(super) fn position(
        &mut self,
        n: usize,
        cell: &Cell,
        unit: &str,
    ) -> Result<Option<f64>, String> {
        let (Some(mut scale), Some(raw)) = (self.scale, cell.raw) else {
            let turns = cell.turns.unwrap_or(0);
            let counted = |value| self.text.step(n, value, turns, unit);
            return cell.value.map(counted).transpose();
        };
        if let Some(apart) = self.apart {
            let is_in_turn =
                |scale: &Scale| scale.fits(raw) && cell.turns == scale.convert(raw).turns;
            if !is_in_turn(&scale) && is_in_turn(&apart) {
                scale = apart;
            }
        }
        if self.is_said && !scale.fits(raw) {
            return Err(format!(
                "{} = {raw}: has more bits than --range gives it, {scale}; give as many as the encoder has",
                of_channel(n, "raw")
            ));
        }
        Ok(Some(scale.value(self.turns.step(scale.steps(raw)))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Positions of text in degrees that does not say what it is of: angle and turns of each row.
    fn counted(rows: &[(f64, u64)]) -> Result<Vec<f64>, String> {
        let mut channel = Channel::default();
        let each = rows.iter().map(|&(value, turns)| {
            let cell = Cell {
                raw: Some(0),
                value: Some(value),
                turns: Some(turns),
                ..Cell::default()
            };
            Ok(channel.position(1, &cell, "deg")?.unwrap_or_default())
        });
        each.collect()
    }

    /// Catches a drift of a thousand turns a second where the count of turns begins anew.
    #[test]
    fn turns_of_text_are_counted_on_as_long_as_nobody_needs_to_know_where_they_end() {
        let multi_turn = counted(&[(350.0, 4), (10.0, 5), (350.0, 4)]).unwrap();
        assert_eq!(multi_turn, [1790.0, 1810.0, 1790.0]);
        let single_turn = counted(&[(350.0, 0), (10.0, 0), (170.0, 0)]).unwrap();
        assert_eq!(single_turn, [350.0, 370.0, 530.0]);
        for (rows, told, known) in [
            ([(350.0, 4095), (10.0, 0)], 0, 4096),
            ([(10.0, 0), (350.0, 4095)], 4095, -1),
            ([(350.0, 1), (10.0, 0)], 0, 2),
            ([(10.0, 3), (20.0, 7)], 7, 3),
        ] {
            let why = counted(&rows).unwrap_err();
            let begin = format!("ch1_turns = {told}: by the short way from the row before it is turn {known}; the range of positions of channel 1 is unknown");
            assert!(
                why.starts_with(&begin) && why.contains("--range 1=SINGLE+MULTI"),
                "{why}"
            );
        }
    }
}
