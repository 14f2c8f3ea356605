//! Positions in units: degrees and turns of a rotary encoder, millimetres of a linear one.

use endat_driver::Range;
use std::f64::consts::TAU;
use std::fmt;

/// The scale of a position: its measuring step, the bits of its turns, and its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// Turns and the angle within a turn.
    Rotary {
        /// Measuring steps per revolution.
        steps_per_turn: u64,
        /// Number of turns that the encoder counts, 1 if it counts none; the position wraps to 0 after the last.
        turns: u64,
        /// Lowest turn bit, if unused bits are below it; else turns are counted in whole `steps_per_turn`.
        turns_at: Option<u32>,
    },
    /// A place on a scale, with the measuring step in nanometres.
    Linear {
        /// Measuring step in nanometres.
        step_nm: f64,
    },
    /// A place on a scale with an unknown measuring step.
    Counted,
    /// Counts with an unknown range: they are not unwrapped, and have no differences.
    Counts {
        /// Lowest turn bit, if known.
        turns_at: Option<u32>,
    },
}

/// A position in units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InUnits {
    /// Degrees within the turn, millimetres, or counts within the turn.
    pub value: f64,
    /// `deg`, `mm` or `counts`.
    pub unit: &'static str,
    /// Whole turns, if the length of a turn is known.
    pub turns: Option<u64>,
}

/// Mask of the bits below `bit`.
const fn below(bit: u32) -> u64 {
    match bit {
        64.. => u64::MAX,
        bit => (1 << bit) - 1,
    }
}

impl Scale {
    /// A singleturn encoder with `bits` bits.
    pub const fn singleturn(bits: u32) -> Self {
        Self::of_bits(bits, 0, None)
    }

    /// An encoder with these bits of angle and of turns; the turns begin at `turns_at`, or right above the angle.
    pub const fn of_bits(single: u32, multi: u32, turns_at: Option<u32>) -> Self {
        Self::Rotary {
            steps_per_turn: below(single) + 1,
            turns: below(multi) + 1,
            turns_at,
        }
    }

    /// The scale of a range, if it is known.
    pub const fn of_range(range: Range) -> Option<Self> {
        match range {
            Range::Unknown => None,
            Range::Linear => Some(Self::Counted),
            Range::Rotary(turns) => {
                let is_apart = turns.turns_at != turns.single_turn_bits;
                let at = if is_apart { Some(turns.turns_at) } else { None };
                Some(Self::of_bits(
                    turns.single_turn_bits,
                    turns.multi_turn_bits,
                    at,
                ))
            }
        }
    }

    /// True if the range is known, so that positions can be unwrapped and compared.
    pub const fn is_known(&self) -> bool {
        !matches!(self, Self::Counts { .. })
    }

    /// Measuring steps after which positions wrap: those of all turns. `None` for a linear scale and for an unknown range.
    pub const fn range(&self) -> Option<u64> {
        match *self {
            Self::Rotary {
                steps_per_turn,
                turns,
                ..
            } => steps_per_turn.checked_mul(turns),
            Self::Linear { .. } | Self::Counted | Self::Counts { .. } => None,
        }
    }

    /// A position in consecutive measuring steps, without unused bits; for counts with an unknown range the bits below the turns.
    pub const fn steps(&self, position: u64) -> u64 {
        match *self {
            Self::Rotary {
                steps_per_turn: steps,
                turns,
                turns_at: Some(at),
            } => {
                let turn = match position.checked_shr(at) {
                    Some(turn) => turn % if turns == 0 { 1 } else { turns },
                    None => 0,
                };
                let within = position & below(at);
                turn * steps + within % if steps == 0 { 1 } else { steps }
            }
            Self::Counts { turns_at: Some(at) } => position & below(at),
            _ => position,
        }
    }

    /// True if a position has no bit outside those of the angle and of the turns; otherwise the encoder uses more bits than the scale has.
    pub const fn fits(&self, position: u64) -> bool {
        match *self {
            Self::Rotary {
                steps_per_turn,
                turns,
                turns_at: Some(at),
            } => {
                let turn = match position.checked_shr(at) {
                    Some(turn) => turn,
                    None => 0,
                };
                position & below(at) < steps_per_turn && turn < turns
            }
            _ => match self.range() {
                Some(range) => position < range,
                None => true,
            },
        }
    }

    /// A position in units.
    pub fn convert(&self, position: u64) -> InUnits {
        let counted = self.steps(position);
        match *self {
            Self::Rotary { steps_per_turn, .. } => {
                let steps = steps_per_turn.max(1);
                InUnits {
                    value: (counted % steps) as f64 * 360.0 / steps as f64,
                    unit: "deg",
                    turns: Some(counted / steps),
                }
            }
            Self::Linear { step_nm } => InUnits {
                value: position as f64 * step_nm * 1e-6,
                unit: "mm",
                turns: None,
            },
            Self::Counted => InUnits {
                value: position as f64,
                unit: "counts",
                turns: None,
            },
            Self::Counts { turns_at } => InUnits {
                value: counted as f64,
                unit: "counts",
                turns: turns_at.and_then(|at| position.checked_shr(at)),
            },
        }
    }

    /// Measuring steps, of any size and sign, in the unit of [`Scale::convert`].
    pub fn value(&self, steps: i128) -> f64 {
        match *self {
            Self::Rotary { steps_per_turn, .. } => {
                let turn = steps_per_turn.max(1);
                // Rounds towards 0: a step back from 0 keeps all its digits.
                let (turns, within) = match (i64::try_from(steps), i64::try_from(turn)) {
                    // A 128-bit division costs more than the rest of a row.
                    (Ok(steps), Ok(turn)) => ((steps / turn) as f64, (steps % turn) as f64),
                    _ => {
                        let turn = i128::from(turn);
                        ((steps / turn) as f64, (steps % turn) as f64)
                    }
                };
                turns * 360.0 + within * 360.0 / turn as f64
            }
            Self::Linear { step_nm } => steps as f64 * step_nm * 1e-6,
            Self::Counted | Self::Counts { .. } => steps as f64,
        }
    }

    /// One measuring step in that unit.
    pub fn step(&self) -> f64 {
        match *self {
            Self::Rotary { steps_per_turn, .. } => 360.0 / steps_per_turn.max(1) as f64,
            Self::Linear { step_nm } => step_nm * 1e-6,
            Self::Counted | Self::Counts { .. } => 1.0,
        }
    }

    /// A position in radians, metres, or counts.
    pub fn si(&self, position: u64) -> f64 {
        let units = self.convert(position);
        match self {
            Self::Rotary { .. } => units.value / 360.0 * TAU,
            Self::Linear { .. } => units.value * 1e-3,
            Self::Counted | Self::Counts { .. } => units.value,
        }
    }

    /// The value in units at which a turn wraps; `None` for a linear scale and for an unknown range.
    pub fn wraps_at(&self) -> Option<f64> {
        matches!(self, Self::Rotary { .. }).then_some(360.0)
    }

    /// True if two scales agree in everything that both define.
    pub fn agrees(&self, other: &Self) -> bool {
        let is_scale = |one: &Self| matches!(one, Self::Linear { .. } | Self::Counted);
        self == other || is_scale(self) && is_scale(other)
    }

    /// Number of turns that the encoder counts; `None` for a linear scale and for an unknown range.
    pub const fn turns(&self) -> Option<u64> {
        match *self {
            Self::Rotary { turns, .. } => Some(turns),
            Self::Linear { .. } | Self::Counted | Self::Counts { .. } => None,
        }
    }

    /// Decimal places for one measuring step.
    pub fn digits(&self) -> usize {
        (-self.step().log10()).ceil().clamp(0.0, 12.0) as usize
    }
}

impl fmt::Display for Scale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rotary {
                steps_per_turn,
                turns,
                ..
            } => write!(f, "{steps_per_turn} steps a turn and {turns} turns"),
            Self::Linear { step_nm } => write!(f, "a scale of {step_nm} nm"),
            Self::Counted => f.write_str("a scale"),
            Self::Counts { .. } => f.write_str("nothing"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_turns_and_millimetres() {
        let multiturn = Scale::of_bits(25, 12, None);
        let quarter = multiturn.convert((7 << 25) | (1 << 23));
        assert_eq!(
            (quarter.value, quarter.turns, quarter.unit),
            (90.0, Some(7), "deg")
        );
        assert_eq!(multiturn.digits(), 5);
        assert_eq!(multiturn.range(), Some(1 << 37));
        assert_eq!(Scale::singleturn(29).digits(), 7);
        let linear = Scale::Linear { step_nm: 10.0 };
        assert!((linear.convert(123_456).value - 1.23456).abs() < 1e-12);
        assert_eq!(linear.convert(123_456).turns, None);
        assert_eq!((linear.digits(), linear.range()), (5, None));
        assert!((multiturn.si(1 << 24) - std::f64::consts::PI).abs() < 1e-12);
    }

    #[test]
    fn steps_beyond_64_bits_are_turns_too() {
        let scale = Scale::singleturn(20);
        for (turns, within) in [
            (5i128, 1i128 << 18),
            (1 << 60, 1 << 18),
            (-(1 << 60), -1 << 18),
        ] {
            let value = scale.value((turns << 20) + within);
            assert_eq!(
                value,
                turns as f64 * 360.0 + within as f64 / 1048576.0 * 360.0
            );
        }
    }

    #[test]
    fn counts_are_taken_apart_and_not_turned_into_an_angle() {
        let counts = Scale::Counts { turns_at: Some(24) };
        let units = counts.convert(7 << 24 | 0x01_FFFF);
        assert_eq!(
            (units.value, units.turns, units.unit),
            (131_071.0, Some(7), "counts")
        );
        assert_eq!((counts.digits(), counts.is_known()), (0, false));
        assert_eq!(counts.si(5), 5.0);
        let unknown = Scale::Counts { turns_at: None };
        assert_eq!(unknown.convert(1 << 30).turns, None);
    }

    /// Seven of the 24 bits of angle are unused: the position continues from bit 16 to bit 24.
    #[test]
    fn unused_bits_between_angle_and_turns_count_for_nothing() {
        let scale = Scale::of_bits(17, 16, Some(24));
        let (last, first) = (100 << 24 | 130_285, 101 << 24);
        assert_eq!(scale.steps(first) - scale.steps(last), 787);
        let half = scale.convert(7 << 24 | 1 << 16);
        assert_eq!((half.value, half.turns), (180.0, Some(7)));
        assert_eq!(scale.range(), Some(1 << 33));
        // An encoder that counts more turns than the scale has.
        assert_eq!(scale.steps(1 << 40 | 5), 5);
        assert!(scale.fits(last) && !scale.fits(last | 1 << 17));
        assert!(!scale.fits(1 << 40));
        assert!(!Scale::singleturn(20).fits(1 << 20));
    }

    #[test]
    fn an_encoder_without_steps_divides_by_nothing() {
        for turns_at in [None, Some(24)] {
            let odd = Scale::Rotary {
                steps_per_turn: 0,
                turns: 0,
                turns_at,
            };
            assert_eq!(odd.convert(5).value, 0.0);
            assert_eq!(
                odd.convert(5).turns,
                Some(5).filter(|_| turns_at.is_none()).or(Some(0))
            );
        }
    }
}
