//! Positions in units: degrees and turns of a rotary encoder, millimetres of a linear one.

use std::f64::consts::TAU;

/// Bits of a position.
const POSITION_BITS: u32 = endat_regs::protocol::MAX_POSITION_BITS;

/// What a measuring step of an encoder is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// Measuring steps per revolution.
    Rotary {
        /// Measuring steps per revolution.
        steps_per_turn: u64,
    },
    /// Measuring step in nanometres.
    Linear {
        /// Measuring step in nanometres.
        step_nm: f64,
    },
    /// Counts of an encoder that does not tell how many of them are a turn: those within the turn in the low bits, turns above.
    Counts {
        /// Bits that counts within the turn have; all of a position where nothing says what a turn is.
        single_bits: u32,
    },
}

/// A position in units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InUnits {
    /// Degrees within the turn, millimetres, or counts within the turn.
    pub value: f64,
    /// `deg`, `mm` or `counts`.
    pub unit: &'static str,
    /// Whole turns, where it is known what a turn is.
    pub turns: Option<u64>,
}

impl Scale {
    /// A singleturn encoder of `bits` bits.
    pub fn singleturn(bits: u32) -> Self {
        Self::Rotary {
            steps_per_turn: 1 << bits.min(63),
        }
    }

    /// A position in units.
    pub fn convert(&self, position: u64) -> InUnits {
        match *self {
            Self::Rotary { steps_per_turn } => {
                let steps = steps_per_turn.max(1);
                InUnits {
                    value: (position % steps) as f64 * 360.0 / steps as f64,
                    unit: "deg",
                    turns: Some(position / steps),
                }
            }
            Self::Linear { step_nm } => InUnits {
                value: position as f64 * step_nm * 1e-6,
                unit: "mm",
                turns: None,
            },
            Self::Counts { single_bits } => InUnits {
                value: self.steps(position) as f64,
                unit: "counts",
                turns: (single_bits < POSITION_BITS).then(|| position >> single_bits),
            },
        }
    }

    /// The part of a position that is counted on: not the turns, where nobody tells how many counts they have.
    pub fn steps(&self, position: u64) -> u64 {
        match self {
            Self::Counts { single_bits } => position & ((1 << single_bits) - 1),
            Self::Rotary { .. } | Self::Linear { .. } => position,
        }
    }

    /// Measuring steps, however many and to which side, in the unit of [`Scale::convert`].
    pub fn value(&self, steps: i128) -> f64 {
        match *self {
            Self::Rotary { steps_per_turn } => {
                let turn = i128::from(steps_per_turn.max(1));
                // Towards 0: a step back from 0 keeps all its digits.
                let (turns, within) = (steps / turn, steps % turn);
                turns as f64 * 360.0 + within as f64 * 360.0 / turn as f64
            }
            Self::Linear { step_nm } => steps as f64 * step_nm * 1e-6,
            Self::Counts { .. } => steps as f64,
        }
    }

    /// One measuring step in that unit.
    pub fn step(&self) -> f64 {
        match *self {
            Self::Rotary { steps_per_turn } => 360.0 / steps_per_turn.max(1) as f64,
            Self::Linear { step_nm } => step_nm * 1e-6,
            Self::Counts { .. } => 1.0,
        }
    }

    /// The same in radians, metres, or counts.
    pub fn si(&self, position: u64) -> f64 {
        let units = self.convert(position);
        match self {
            Self::Rotary { .. } => units.value / 360.0 * TAU,
            Self::Linear { .. } => units.value * 1e-3,
            Self::Counts { .. } => units.value,
        }
    }

    /// The value in units that is 0 again; none where the encoder does not tell.
    pub fn wraps_at(&self) -> Option<f64> {
        matches!(self, Self::Rotary { .. }).then_some(360.0)
    }

    /// Digits behind the point that show one measuring step.
    pub fn digits(&self) -> usize {
        (-self.step().log10()).ceil().clamp(0.0, 12.0) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_turns_and_millimetres() {
        let multiturn = Scale::Rotary {
            steps_per_turn: 1 << 25,
        };
        let quarter = multiturn.convert((7 << 25) | (1 << 23));
        assert_eq!(
            (quarter.value, quarter.turns, quarter.unit),
            (90.0, Some(7), "deg")
        );
        assert_eq!(multiturn.digits(), 5);
        assert_eq!(Scale::singleturn(29).digits(), 7);
        let linear = Scale::Linear { step_nm: 10.0 };
        assert!((linear.convert(123_456).value - 1.23456).abs() < 1e-12);
        assert_eq!(linear.convert(123_456).turns, None);
        assert_eq!(linear.digits(), 5);
        assert!((multiturn.si(1 << 24) - std::f64::consts::PI).abs() < 1e-12);
    }

    #[test]
    fn counts_are_taken_apart_and_not_turned_into_an_angle() {
        let counts = Scale::Counts { single_bits: 24 };
        let units = counts.convert(7 << 24 | 0x01_FFFF);
        assert_eq!(
            (units.value, units.turns, units.unit),
            (131_071.0, Some(7), "counts")
        );
        assert_eq!(counts.digits(), 0);
        assert_eq!(counts.si(5), 5.0);
    }

    #[test]
    fn an_encoder_without_steps_divides_by_nothing() {
        let odd = Scale::Rotary { steps_per_turn: 0 };
        assert_eq!(odd.convert(5).value, 0.0);
        assert_eq!(odd.convert(5).turns, Some(5));
    }
}
