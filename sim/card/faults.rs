//! Faults that are made while a virtual card runs: what a cable, a plug or an encoder can do, by name.

use super::deed::Deed;
use super::VirtualCard;
use endat_console::did_you_mean;
use endat_console::error::{shown, CommandError};
use endat_console::number::{decimal, number};
use endat_sim::encoder::{Cause, Defect};
use endat_sim::line::{FaultKind, GlitchRate, Jitter, LineFault, Wire};
use endat_sim::{Time, MS, NS, US};

/// What can be made, what it takes, and what it is.
pub const FAULTS: [(&str, &str, &str); 13] = [
    ("unplug", "CHANNEL", "the plug is off: the encoder has no supply, nobody drives DATA"),
    ("plug", "CHANNEL", "it is in again; the encoder begins anew"),
    ("crc", "CHANNEL [N]", "a wrong CRC in the next N frames [1]"),
    ("f1", "CHANNEL [N]", "error bit F1 in the next N frames [1]"),
    ("f2", "CHANNEL [N]", "error bit F2 in the next N frames [1]"),
    ("silent", "CHANNEL [N]", "no start bit in the next N frames [1]"),
    ("slow", "CHANNEL TIME", "the encoder calculates so much longer, as in 30us, until heal"),
    ("alarm", "CHANNEL [BITS]", "alarms, bit 0 light source to 6 battery [1], until they are cleared; of SSI bit 0 alarm, 1 power failure, 2 not valid, until heal"),
    ("warning", "CHANNEL [BITS]", "the same with warnings"),
    ("noise", "CHANNEL RATE", "short pulses on DATA, so many per microsecond, as in 1e-3, until heal"),
    ("jitter", "CHANNEL TIME", "edges come up to so much earlier or later, as in 20ns, until heal"),
    ("line", "CHANNEL KIND", "a fault of the pair, until heal: stuck_low, stuck_high, open, short, swapped, data_to_clock, noise, glitches"),
    ("heal", "CHANNEL", "all of these are gone, the plug is in"),
];

/// A fault that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    channel: usize,
    deed: Deed,
}

/// Most frames, and longest times, that make sense.
const FRAMES_MAX: u64 = 1_000_000_000;
const SLOW_MAX: Time = 10 * MS;
const JITTER_MAX: Time = US;
/// Pulses of noise.
const PULSE: (Time, Time) = (40 * NS, 200 * NS);
/// The rarest noise that is any.
const NOISE_MIN: f64 = 1e-9;
/// Bits of alarms and warnings.
const STATUS_MAX: u64 = 0xFFFF;

fn wrong(what: &str, text: &str, why: &str) -> String {
    format!("{what} = {}: {why}", shown(text))
}

/// What a parser of numbers says, as a text.
fn text_of<T>(result: Result<T, CommandError>) -> Result<T, String> {
    result.map_err(|error| error.to_string())
}

/// A time with its unit.
fn time(what: &str, text: &str, most: Time) -> Result<Time, String> {
    let units = [("ns", NS), ("us", US), ("ms", MS)];
    let found = units
        .iter()
        .find_map(|(name, unit)| Some((name, text.strip_suffix(name)?, *unit)));
    let found = found.filter(|(_, digits, _)| !digits.is_empty());
    let Some((name, digits, unit)) = found else {
        let limit = format!("is no time from 0 to {}us; write 20ns or 0.5us", most / US);
        return Err(wrong(what, text, &limit));
    };
    let what = format!("{what}, in {name}");
    let number = text_of(decimal(&what, digits, 0.0..=most as f64 / unit as f64))?;
    Ok((number * unit as f64) as Time)
}

/// What stands for each word of what a fault takes, in an example.
const EXAMPLES: [(&str, &str); 6] = [
    ("CHANNEL", "0"),
    ("[N]", "3"),
    ("[BITS]", "3"),
    ("TIME", "0.5us"),
    ("RATE", "1e-3"),
    ("KIND", "stuck_low"),
];

/// How a fault is written.
fn example(name: &str, takes: &str) -> String {
    let known = |word: &str| EXAMPLES.iter().find(|e| e.0 == word).map_or("", |e| e.1);
    let words: Vec<&str> = takes.split(' ').map(known).collect();
    format!(
        "inject {name}: takes {takes}; write for example {name} {}",
        words.join(" ")
    )
}

/// The name that may have been meant.
fn guess<'a>(text: &str, known: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.collect();
    did_you_mean::guess(text, known.iter().copied())
        .unwrap_or_else(|| format!("there are {}", known.join(", ")))
}

impl Fault {
    /// What these words ask for.
    pub fn parse(words: &[&str]) -> Result<Self, String> {
        let names = FAULTS.iter().map(|f| f.0);
        let Some((name, rest)) = words.split_first() else {
            return Err(format!(
                "there is no fault; there are {}",
                names.collect::<Vec<_>>().join(", ")
            ));
        };
        let Some((name, takes, _)) = FAULTS.iter().find(|f| f.0 == *name) else {
            let why = format!("there is no such fault; {}", guess(name, names));
            return Err(wrong("inject", name, &why));
        };
        let (channel, value) = match rest {
            [channel] => (channel, None),
            [channel, value] if *takes != "CHANNEL" => (channel, Some(*value)),
            _ => return Err(example(name, takes)),
        };
        // Which ones there are, the card says.
        let channel = number("channel", channel, 0..=u64::MAX).map_err(|_| {
            wrong(
                "channel",
                channel,
                "is no channel; give its number, 0 for the first",
            )
        })?;
        let channel = usize::try_from(channel).unwrap_or(usize::MAX);
        let count = || {
            value.map_or(Ok(1), |text| {
                text_of(number("frames", text, 1..=FRAMES_MAX))
            })
        };
        let bits = || {
            value
                .map_or(Ok(1), |text| text_of(number("bits", text, 1..=STATUS_MAX)))
                .map(|b| b as u16)
        };
        let needed = || value.ok_or_else(|| example(name, takes));
        let deed = match *name {
            "unplug" => Deed::Supply(false),
            "plug" => Deed::Supply(true),
            "crc" => Deed::Spoil(count()?, Defect::CrcXor(1)),
            // With the other bit as it is when all is well.
            "f1" => Deed::Spoil(count()?, Defect::ErrorBits { f1: true, f2: true }),
            "f2" => Deed::Spoil(
                count()?,
                Defect::ErrorBits {
                    f1: false,
                    f2: false,
                },
            ),
            "silent" => Deed::Spoil(count()?, Defect::NoStartBit),
            "slow" => Deed::Slow(time("slow", needed()?, SLOW_MAX)?),
            "alarm" => Deed::Status {
                alarms: bits()?,
                warnings: 0,
            },
            "warning" => Deed::Status {
                alarms: 0,
                warnings: bits()?,
            },
            "noise" => {
                let what = "noise, in pulses per microsecond";
                Deed::Noise(text_of(decimal(what, needed()?, NOISE_MIN..=1.0))?)
            }
            "jitter" => Deed::Jitter(time("jitter", needed()?, JITTER_MAX)?),
            "line" => {
                let text = needed()?;
                let kinds = || FaultKind::ALL.iter().filter(|k| !k.is_plug());
                let kind = kinds().find(|k| k.name() == text).ok_or_else(|| {
                    let why = format!(
                        "there is no such fault of a line; {}",
                        guess(text, kinds().map(|k| k.name()))
                    );
                    wrong("line", text, &why)
                })?;
                Deed::Line(*kind)
            }
            _ => Deed::Heal,
        };
        Ok(Self { channel, deed })
    }
}

impl VirtualCard {
    /// Makes a fault now; what was done, or why not.
    pub fn inject(&mut self, words: &str) -> Result<String, String> {
        let words: Vec<&str> = words.split_whitespace().collect();
        let fault = Fault::parse(&words)?;
        let now = self.bench.now();
        let seed = self.bench.cycle();
        let Some(port) = self.ports.get(fault.channel).copied() else {
            let there = match self.ports.len() {
                1 => "channel 0 alone".to_owned(),
                count => format!("channels 0 to {}", count - 1),
            };
            return Err(format!(
                "channel = {}: this card has {there}; give one of these",
                words[1]
            ));
        };
        match port {
            PortOf::Other(index) => {
                let (faults, encoder) = (&mut self.others[index], self.bench.other_mut(index));
                let name = encoder.protocol().name();
                faults.make(encoder, fault.deed).ok_or_else(|| {
                    format!(
                        "channel = {}: speaks {name}, which knows {} only",
                        fault.channel,
                        faults.known().join(", ")
                    )
                })?;
                self.is_spoilt = true;
            }
            PortOf::Endat(index) => self.disturb(index, fault.deed, now, seed),
        }
        let seconds = now as f64 / super::SECOND;
        Ok(format!(
            "{} at {seconds:.6} s of the card's time",
            words.join(" ")
        ))
    }

    /// Ends what was to spoil some replies only.
    pub(super) fn mend(&mut self) {
        let bench = &mut self.bench;
        self.is_spoilt = false;
        for (index, faults) in self.others.iter_mut().enumerate() {
            self.is_spoilt |= faults.mend(bench.other_mut(index));
        }
    }

    fn disturb(&mut self, index: usize, deed: Deed, now: Time, seed: u64) {
        let link = self.bench.link_mut(index);
        match deed {
            Deed::Supply(on) => {
                // A plug that is in stays in: the encoder does not begin anew.
                if link.encoder().is_on() != on {
                    link.encoder_mut().switch_supply(now, on);
                }
            }
            Deed::Spoil(frames, defect) => link.encoder_mut().spoil(frames, defect),
            Deed::Slow(by) => link.encoder_mut().spoil(u64::MAX, Defect::LateStart(by)),
            Deed::Status { alarms, warnings } => link.encoder_mut().add_cause(Cause {
                during: now..now + 1,
                alarms,
                warnings,
            }),
            Deed::Noise(rate) => link.disturb(|line| {
                let rate = GlitchRate {
                    wire: Wire::Data,
                    mean_gap: (US as f64 / rate) as Time,
                    shortest: PULSE.0,
                    longest: PULSE.1,
                };
                line.set_random_glitches(now, Some(rate));
            }),
            Deed::Jitter(most) => link.disturb(|line| line.set_jitter(Jitter::Uniform(most), seed)),
            Deed::Line(kind) => link.disturb(|line| {
                line.set_fault(LineFault::new(kind, now, Time::MAX, seed));
            }),
            Deed::Heal => {
                let jitter = self.jitter;
                link.disturb(|line| {
                    line.heal(now);
                    line.set_jitter(jitter, seed);
                });
                let encoder = link.encoder_mut();
                encoder.heal(now);
                if !encoder.is_on() {
                    encoder.switch_supply(now, true);
                }
            }
        }
    }
}

/// Which link of the bench a channel has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PortOf {
    /// EnDat.
    Endat(usize),
    /// Another protocol.
    Other(usize),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_misspelt_or_beyond_its_limit_is_told() {
        let parse = |text: &str| Fault::parse(&text.split_whitespace().collect::<Vec<_>>());
        for (text, told) in [
            (
                "unplgu 0",
                "inject = unplgu: there is no such fault; did you mean unplug?",
            ),
            ("", "there is no fault; there are unplug, plug, crc"),
            (
                "unplug",
                "inject unplug: takes CHANNEL; write for example unplug 0",
            ),
            ("unplug 0 1", "takes CHANNEL"),
            ("unplug x", "channel = x: is no channel; give its number"),
            ("crc 0 0", "frames = 0: outside 1..1000000000"),
            ("slow 0 30", "slow = 30: is no time from 0 to 10000us"),
            ("unplug -1", "channel = -1: is no channel; give its number"),
            ("slow 0 -1us", "slow, in us = -1: outside 0..10000"),
            (
                "slow 0",
                "inject slow: takes CHANNEL TIME; write for example slow 0 0.5us",
            ),
            ("jitter 0 ns", "jitter = ns: is no time from 0 to 1us"),
            (
                "jitter 0 -20ns",
                "jitter, in ns = -20: outside 0..1000; give a number",
            ),
            ("jitter 0 infms", "jitter, in ms = inf: outside"),
            (
                "noise 0 2",
                "noise, in pulses per microsecond = 2: outside 0.000000001..1",
            ),
            ("noise 0 nan", "microsecond = nan: outside"),
            ("line 0 stuck", "there is no such fault of a line"),
            ("alarm 0 0x10000", "bits = 0x10000: outside 1..65535"),
        ] {
            let error = parse(text).unwrap_err();
            assert!(error.contains(told), "{text}: {error}");
        }
        for (name, takes, _) in FAULTS {
            let told = example(name, takes);
            let (_, text) = told.split_once("example ").unwrap();
            let words: Vec<&str> = text.split(' ').collect();
            assert_eq!(words.len(), 1 + takes.split(' ').count(), "{text}");
            assert_eq!(parse(text).map(|f| f.channel), Ok(0), "{text}");
        }
    }
}
