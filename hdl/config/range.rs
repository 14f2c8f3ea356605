//! Kind of a position: turns and angle, or a place on a scale. The card stores it for the host; no block uses it.

use super::*;
use endat_regs::protocol::MAX_POSITION_BITS;
use endat_regs::range;

/// The range of a channel's position, if the configuration has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PositionRange {
    /// Turns and the angle within a turn.
    Rotary {
        /// Bits of the angle; `None` = the bits of the position that do not count turns.
        single_turn_bits: Option<u64>,
        /// Bits that count turns.
        multi_turn_bits: u64,
    },
    /// A place on a scale, which does not wrap.
    Linear,
}

impl PositionRange {
    /// The field `limits.range` of a channel with this range.
    pub fn kind(range: Option<Self>) -> u64 {
        let kind = match range {
            None => range::UNKNOWN,
            Some(Self::Rotary { .. }) => range::ROTARY,
            Some(Self::Linear) => range::LINEAR,
        };
        kind.into()
    }

    /// Bits of the angle, and bits that count turns, of a position with `position_bits` bits.
    pub fn bits(self, position_bits: u64) -> Option<[u64; 2]> {
        match self {
            Self::Rotary {
                single_turn_bits,
                multi_turn_bits: multi,
            } => Some([
                single_turn_bits.unwrap_or(position_bits.saturating_sub(multi)),
                multi,
            ]),
            Self::Linear => None,
        }
    }
}

impl ChannelConfig {
    /// Bits of the angle, and bits that count turns, if known.
    pub fn turn_bits(&self) -> Option<[u64; 2]> {
        self.spec.range?.bits(self.position_bits.into())
    }

    /// Bits that count turns; 0 if unknown.
    pub fn multi_turn_bits(&self) -> u64 {
        self.turn_bits().map_or(0, |[_, multi]| multi)
    }

    /// Width of the position for the host: angle and turns together, even if other bits are between the two.
    pub fn told_position_bits(&self) -> u64 {
        let apart = self
            .turn_bits()
            .filter(|_| self.protocol().row().turns_at.is_some());
        apart.map_or(self.position_bits.into(), |[single, multi]| single + multi)
    }
}

/// Rejects a range that does not match the position.
pub(super) fn check_range(check: &mut Check<'_>, config: &ChannelConfig) {
    let Some([single, multi]) = config.turn_bits() else {
        return;
    };
    // A rejected value must not cause a second message.
    if !limits("position_bits", None).contains(config.position_bits.into()) {
        return;
    }
    let (width, turns_at) = (
        u64::from(config.position_bits),
        config.protocol().row().turns_at.map(u64::from),
    );
    // Angle and turns have fixed places, or share the position.
    let (most_single, most_multi) = match turns_at {
        Some(at) => (at, u64::from(MAX_POSITION_BITS) - at),
        None => (width, width - 1),
    };
    let mut within = |key, value, most| {
        let limits = limits(key, None).at_most(most, "the position has no more bits");
        check.within(key, value, &limits)
    };
    let are_good = [
        // Without single_turn_bits the angle has all bits that are not turns.
        single == 0 || within("single_turn_bits", single, most_single),
        within("multi_turn_bits", multi, most_multi),
    ];
    if are_good != [true; 2] || turns_at.is_some() || single + multi == width {
        return;
    }
    let mut remedies = Vec::new();
    if multi < width {
        remedies.push(format!("set single_turn_bits to {}", width - multi));
    }
    if single > 0 && width - single <= max_of(MULTI_TURN_BITS) && width - single != multi {
        remedies.push(format!("set multi_turn_bits to {}", width - single));
    }
    let text = format!(
        "with multi_turn_bits = {multi} that is {} bits, and position_bits = {width}; {}",
        single + multi,
        remedies.join(", or ")
    );
    check.fail("single_turn_bits", single, text);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocols::t_format::protocol::Request;
    use crate::protocols::{SsiSpec, TFormatSpec};

    fn spec(spoken: Spoken, position_bits: u64, bits: [u64; 2]) -> ChannelSpec {
        let [single, multi_turn_bits] = bits;
        ChannelSpec {
            clock_hz: 1_000_000,
            position_bits,
            start_window_ns: 100,
            tcal_max_ns: 5_000,
            range: Some(PositionRange::Rotary {
                single_turn_bits: (single > 0).then_some(single),
                multi_turn_bits,
            }),
            ..ChannelSpec::speaking(spoken)
        }
    }

    fn resolved(spec: &ChannelSpec) -> Result<ChannelConfig, String> {
        let found = ChannelConfig::resolve(spec, 100_000_000, false, 0);
        found.map_err(|problems| problems[0].to_string())
    }

    #[test]
    fn turns_and_angle_are_all_of_the_position() {
        for spoken in [Spoken::Endat, Spoken::Ssi(SsiSpec::default())] {
            let good = resolved(&spec(spoken, 25, [12, 13])).unwrap();
            assert_eq!(
                (good.multi_turn_bits(), good.told_position_bits()),
                (13, 25)
            );
            let rest = resolved(&spec(spoken, 25, [0, 12])).unwrap();
            assert_eq!(rest.turn_bits(), Some([13, 12]));
            for (bits, told) in [
                ([13, 13], "single_turn_bits = 13: with multi_turn_bits = 13 that is 26 bits, and position_bits = 25; set single_turn_bits to 12, or set multi_turn_bits to 12"),
                ([25, 1], "set single_turn_bits to 24, or set multi_turn_bits to 0"),
                ([5, 24], "set single_turn_bits to 1, or set multi_turn_bits to 20"),
                ([26, 0], "single_turn_bits = 26: outside 1..25 (the position has no more bits)"),
                ([12, 32], "multi_turn_bits = 32: outside 0..24 (the position has no more bits)"),
                ([0, 25], "multi_turn_bits = 25: outside 0..24 (the position has no more bits)"),
            ] {
                let why = resolved(&spec(spoken, 25, bits)).unwrap_err();
                assert!(why.contains(told), "{why}");
            }
        }
    }

    #[test]
    fn t_format_has_angle_and_turns_at_places_of_their_own() {
        let asked = |request| {
            Spoken::TFormat(TFormatSpec {
                request,
                ..TFormatSpec::default()
            })
        };
        let everything = asked(Request::Everything);
        let good = resolved(&spec(everything, 0, [17, 16])).unwrap();
        assert_eq!((good.told_position_bits(), good.position_bits), (33, 48));
        for (spoken, bits, told) in [
            (everything, [25, 16], "single_turn_bits = 25: outside 1..24"),
            (everything, [17, 25], "multi_turn_bits = 25: outside 0..24"),
            (
                asked(Request::SingleTurn),
                [17, 16],
                "multi_turn_bits = 16: request = 0 brings no turns; remove it, or set request to 3",
            ),
            (
                asked(Request::MultiTurn),
                [17, 16],
                "single_turn_bits = 17: request = 1 brings no angle",
            ),
        ] {
            let why = resolved(&spec(spoken, 0, bits)).unwrap_err();
            assert!(why.contains(told), "{why}");
        }
        assert!(resolved(&spec(asked(Request::SingleTurn), 0, [17, 0])).is_ok());
        let scale = |request| ChannelSpec {
            range: Some(PositionRange::Linear),
            ..spec(asked(request), 0, [0, 0])
        };
        assert!(resolved(&scale(Request::SingleTurn)).is_ok());
        let told = "linear = true: request = 3 brings turns, and a scale has none; remove it, or set request to 0";
        let why = resolved(&scale(Request::Everything)).unwrap_err();
        assert!(why.contains(told), "{why}");
    }
}
