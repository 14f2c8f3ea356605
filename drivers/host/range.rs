//! Position ranges from the user: `0=17+16` means 17 bits of angle and 16 turn bits in channel 0,
//! `1=linear` a scale. They override the card and the name plates.

use crate::units::Scale;
use crate::HostError;
use endat_driver::Range;
use endat_regs::{Protocol, CHANNELS_MAX};

/// A range from the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Said {
    Linear,
    Rotary { single: u32, multi: u32 },
}

/// Ranges from the user.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ranges([Option<Said>; CHANNELS_MAX]);

/// Format of a range.
const FORM: &str = "is no range; give bits of the angle and bits that count turns, for example 0=17+16 for channel 0, or 0=linear";

/// Reason why positions of a channel are not unwrapped.
pub fn unknown(channel: usize) -> String {
    format!("the range of positions of channel {channel} is unknown")
}

/// That reason with the remedy for a command with `--range`.
pub fn refusal(channel: usize) -> String {
    let why = unknown(channel);
    format!("{why}; give --range {channel}=SINGLE+MULTI (bits of the angle and bits that count turns, as in {channel}=17+16) or --range {channel}=linear")
}

/// Message for positions of a channel with bits outside their range.
pub fn too_small(channel: usize, count: u64, scale: &Scale) -> String {
    let positions = match count {
        1 => "a position has".to_owned(),
        _ => format!("{count} positions have"),
    };
    format!("channel {channel}: {positions} bits outside {scale}: the encoder uses more; give --range {channel}=SINGLE+MULTI according to its data sheet")
}

impl Ranges {
    /// Parses the texts of `--range`.
    pub fn parse(texts: &[String]) -> Result<Self, HostError> {
        let mut all = Self::default();
        for text in texts {
            let wrong = |why: &str| HostError::Name(format!("--range = {text}: {why}"));
            let (channel, said) = text.split_once('=').ok_or_else(|| wrong(FORM))?;
            let channel: usize = channel.trim().parse().map_err(|_| wrong(FORM))?;
            let place = all.0.get_mut(channel).ok_or_else(|| {
                wrong(&format!(
                    "no card has a channel {channel}; there are 0 to {}",
                    CHANNELS_MAX - 1
                ))
            })?;
            let number = |text: &str| text.trim().parse::<u32>().map_err(|_| wrong(FORM));
            let said = match said.trim().split_once('+') {
                None if said.trim() == "linear" => Said::Linear,
                None => Said::Rotary {
                    single: number(said)?,
                    multi: 0,
                },
                Some((single, multi)) => Said::Rotary {
                    single: number(single)?,
                    multi: number(multi)?,
                },
            };
            // Any protocol.
            if said.range(Protocol::Endat).is_none() {
                return Err(wrong(
                    "the angle has at least 1 bit, and all together are at most 48; give bits that fit",
                ));
            }
            if place.replace(said).is_some() {
                return Err(wrong(&format!(
                    "channel {channel} has one already; give one range for each channel"
                )));
            }
        }
        Ok(all)
    }

    /// True if no range is given.
    pub fn is_empty(&self) -> bool {
        self.0.iter().all(Option::is_none)
    }

    /// Rejects ranges of absent channels.
    pub fn check(&self, channels: usize) -> Result<(), HostError> {
        match self.0.iter().skip(channels).position(Option::is_some) {
            None => Ok(()),
            Some(beyond) => Err(HostError::Name(format!(
                "--range = {}: the card has no such channel; the last one is {}",
                channels + beyond,
                channels.saturating_sub(1)
            ))),
        }
    }

    /// The scale of a channel with this protocol and position width; `None` if no range is given or the width is unknown.
    pub fn scale(
        &self,
        channel: usize,
        protocol: Protocol,
        position_bits: Option<u32>,
    ) -> Result<Option<Scale>, HostError> {
        let Some(said) = self.0.get(channel).copied().flatten() else {
            return Ok(None);
        };
        let wrong = |why: String| HostError::Name(format!("--range = {channel}={said}: {why}"));
        let range = said.range(protocol).ok_or_else(|| {
            let (name, at) = (protocol.name(), protocol.row().turns_at.unwrap_or(0));
            wrong(format!(
                "a position of {name} has {at} bits of angle and {} of turns; give no more of either",
                endat_regs::protocol::MAX_POSITION_BITS - at
            ))
        })?;
        if said == Said::Linear && protocol.row().turns_at.is_some() {
            return Err(wrong(format!(
                "positions of {} count turns; give bits of the angle and bits that count turns, as in {channel}=17+16",
                protocol.name()
            )));
        }
        if let (Said::Rotary { single, multi }, Some(bits)) = (said, position_bits) {
            if single + multi != bits && protocol.row().turns_at.is_none() {
                return Err(wrong(format!(
                    "is {} bits, and positions of the channel have {bits}; give as many, or linear",
                    single + multi
                )));
            }
        }
        Ok(Scale::of_range(range))
    }
}

impl Said {
    fn range(self, protocol: Protocol) -> Option<Range> {
        match self {
            Self::Linear => Some(Range::Linear),
            Self::Rotary { single, multi } => Range::rotary(single, multi, protocol),
        }
    }
}

impl std::fmt::Display for Said {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Linear => f.write_str("linear"),
            Self::Rotary { single, multi } => write!(f, "{single}+{multi}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(texts: &[&str]) -> Result<Ranges, String> {
        let texts: Vec<String> = texts.iter().map(|t| (*t).to_owned()).collect();
        Ranges::parse(&texts).map_err(|e| e.to_string())
    }

    #[test]
    fn a_range_that_is_said_fits_the_positions_of_its_channel() {
        let said = parsed(&["0=17+16", "1=linear", "3=29"]).unwrap();
        let scale = |channel, protocol, bits| said.scale(channel, protocol, bits);
        let t_format = scale(0, Protocol::TFormat, Some(48)).unwrap().unwrap();
        assert_eq!(t_format, Scale::of_bits(17, 16, Some(24)));
        assert_eq!(
            scale(1, Protocol::Ssi, Some(24)).unwrap(),
            Some(Scale::Counted)
        );
        assert_eq!(scale(2, Protocol::Ssi, Some(24)).unwrap(), None);
        let endat = scale(3, Protocol::Endat, Some(29)).unwrap().unwrap();
        assert_eq!(endat, Scale::singleturn(29));
        let why = scale(0, Protocol::Ssi, Some(25)).unwrap_err().to_string();
        assert!(
            why.contains("--range = 0=17+16: is 33 bits") && why.contains("have 25"),
            "{why}"
        );
        let why = scale(3, Protocol::TFormat, None).unwrap_err().to_string();
        assert!(
            why.contains("has 24 bits of angle and 24 of turns"),
            "{why}"
        );
        // A scale has no place for the turns of this protocol.
        let why = scale(1, Protocol::TFormat, Some(48)).unwrap_err();
        assert_eq!(
            why.to_string(),
            "--range = 1=linear: positions of T-format count turns; give bits of the angle and bits that count turns, as in 1=17+16"
        );
        assert!(said.check(4).is_ok());
        let why = said.check(2).unwrap_err().to_string();
        assert!(
            why.contains("--range = 3: the card has no such channel"),
            "{why}"
        );
    }

    #[test]
    fn what_is_no_range_is_refused_with_its_form() {
        for (text, told) in [
            ("17+16", "is no range; give bits"),
            ("0=", "is no range; give bits"),
            ("0=17+x", "is no range; give bits"),
            ("0=0+16", "the angle has at least 1 bit"),
            ("0=40+9", "at most 48"),
            ("0=4000000000+4000000000", "at most 48"),
            ("8=17", "no card has a channel 8"),
        ] {
            let why = parsed(&[text]).unwrap_err();
            assert!(
                why.contains(&format!("--range = {text}: ")) && why.contains(told),
                "{why}"
            );
        }
        let twice = parsed(&["0=17", "0=linear"]).unwrap_err();
        assert!(twice.contains("has one already"), "{twice}");
    }
}
