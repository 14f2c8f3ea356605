//! An SSI encoder at a virtual card: how it moves, and what can be wrong with it.

use crate::other_protocol::{OtherFaults, Plugged, Spoilt};
use crate::virtual_card::deed::Deed;
use crate::virtual_card::settings::{VirtualConfig, CABLE_M, NS_PER_M, SECOND};
use endat_hdl::config::{ChannelConfig, PositionRange};
use endat_hdl::protocols::ssi::asked::Parity;
use endat_hdl::protocols::ssi::cause;
use endat_hdl::protocols::ssi::specials::{Special, Specials};
use endat_hdl::protocols::SsiSpec;
use endat_sim::bench::OtherEncoder;
use endat_sim::encoder::Defect as Wanted;
use endat_sim::line::FaultKind;
use endat_sim::ssi::{Defect, EncoderConfig, Extra, SsiLink, SsiMotion};
use endat_sim::{Time, NS};
use std::sync::Arc;

/// An encoder of whatever width and code a channel is configured for.
pub(crate) const DEVICES: &[&str] = &["SSI"];
/// Steps of a turn, as usual encoders of 12 or 13 bits to the turn have them, unless the configuration has others.
const TURN_BITS: u64 = 13;
/// Of a scale: a tenth of it to and fro.
const STROKE: f64 = 0.1;

/// What it and its line can do of the faults that there are.
const FAULTS: [&str; 8] = [
    "unplug",
    "plug",
    "crc (a bit of the second copy, or of the only one, which without parity bit and CRC nobody sees)",
    "silent",
    "slow",
    "jitter",
    "line stuck_low or open",
    "heal",
];

/// The causes that special bits may be, in the order of the bits of an alarm, and what they are called.
const ALARMS: [(u64, &str); 3] = [
    (cause::ALARM, "alarm"),
    (cause::POWER_FAIL, "power fails"),
    (cause::NOT_VALID, "position not valid"),
];

/// The special bits that an encoder with these alarms sends.
fn extras(specials: &Specials, alarms: u16) -> Vec<Extra> {
    let extra = |special: Special| match special {
        Special::ParityEven => Extra::Parity(false),
        Special::ParityOdd => Extra::Parity(true),
        Special::Crc6 => Extra::Crc6,
        Special::Ignored => Extra::Level(false),
        special => Extra::Level(special.cause().is_none_or(|(cause, level)| {
            let raised = ALARMS.iter().position(|is| is.0 == cause);
            level == raised.is_some_and(|bit| alarms >> bit & 1 == 1)
        })),
    };
    specials.iter().map(extra).collect()
}

/// The alarms that a channel's special bits can say.
fn known_alarms(asked: &SsiSpec) -> u16 {
    let has = |is: u64| {
        asked
            .specials()
            .any(|s| s.cause().is_some_and(|(c, _)| c == is))
    };
    (ALARMS.iter().enumerate()).fold(0, |known, (bit, is)| known | u16::from(has(is.0)) << bit)
}

/// The encoder that a channel is configured for.
fn fitting(channel: &ChannelConfig, asked: &SsiSpec, seed: u64) -> EncoderConfig {
    let tm = channel.spec.recovery_max_ns * NS;
    EncoderConfig {
        position_bits: channel.position_bits,
        gray: asked.gray,
        parity: asked.has_parity().then_some(asked.parity == Parity::Odd),
        before: extras(&asked.before, 0),
        after: extras(&asked.after, 0),
        keeps_last: asked.holds_end,
        repeats: asked.twice,
        // Well within what is allowed, and longer than any clock's pause.
        tm: tm * 3 / 4,
        bit_delay: asked.bit_delay_ns * NS,
        seed,
        ..EncoderConfig::default()
    }
}

/// One that turns evenly; a scale goes to and fro.
fn motion(config: &ChannelConfig, channel: usize, speed: f64) -> SsiMotion {
    let speed = speed * (1.0 + 0.5 * channel as f64);
    let start = 0.1 * (channel + 1) as f64;
    let position_bits = config.position_bits;
    let all = (1u64 << position_bits) as f64;
    let turn_bits = match (config.turn_bits(), config.spec.range) {
        (Some([single, _]), _) => single,
        (_, Some(PositionRange::Linear)) => {
            return Arc::new(move |time: Time| {
                let place = 0.5 + STROKE * (speed * time as f64 / SECOND).sin();
                (place * all) as u64
            })
        }
        _ => TURN_BITS.min(position_bits.into()),
    };
    let steps = (1u64 << turn_bits) as f64;
    Arc::new(move |time: Time| {
        let turns = start + speed * time as f64 / SECOND;
        (turns * steps).max(0.0) as u64 & ((1 << position_bits) - 1)
    })
}

/// One on its line, turning as others do.
pub(crate) fn plug(
    channel: &ChannelConfig,
    asked: &SsiSpec,
    n: usize,
    is_open: bool,
    config: &VirtualConfig,
) -> Plugged {
    let jitter = config.jitter_ns as Time * NS;
    let fitting = fitting(channel, asked, config.seed.wrapping_add(n as u64));
    let encoder = EncoderConfig {
        jitter,
        // With it a bit comes as late as it may, and sooner.
        bit_delay: fitting.bit_delay.saturating_sub(jitter),
        ..fitting
    };
    let faults = Faults {
        sound: encoder.clone(),
        spoilt: Spoilt::default(),
        asked: *asked,
    };
    let mut link = SsiLink::new(encoder, delay(channel, config.cable_m));
    let turns = motion(channel, n, config.speed);
    link.set_motion(turns.clone());
    if is_open {
        link.unplug();
    }
    Plugged {
        encoder: Box::new(link),
        motion: turns,
        faults: Box::new(faults),
    }
}

/// The way along a cable; the usual one is not longer than the channel takes.
fn delay(channel: &ChannelConfig, cable_m: f64) -> Time {
    let most_m = channel.spec.cable_m as f64;
    let cable_m = match cable_m == CABLE_M {
        true => cable_m.min(most_m),
        false => cable_m,
    };
    (cable_m * NS_PER_M * NS as f64) as Time
}

/// One without a fault at channel `n`, for a run that is recorded: 10 m away, or as far as the channel takes.
pub(crate) fn sound(channel: &ChannelConfig, asked: &SsiSpec, n: usize) -> SsiLink {
    let mut link = SsiLink::new(
        fitting(channel, asked, n as u64 + 1),
        delay(channel, CABLE_M),
    );
    link.set_motion(motion(channel, n, 1.0));
    link
}

/// What is wrong with one.
struct Faults {
    /// As it was.
    sound: EncoderConfig,
    spoilt: Spoilt,
    asked: SsiSpec,
}

fn link(encoder: &mut dyn OtherEncoder) -> &mut SsiLink {
    let link = encoder.as_any_mut().downcast_mut();
    link.expect("the encoder that these faults were made for")
}

impl OtherFaults for Faults {
    fn known(&self) -> Vec<String> {
        let known = known_alarms(&self.asked);
        let bits = ALARMS.iter().enumerate();
        let bits = bits.filter(|(bit, _)| known >> bit & 1 == 1);
        let bits: Vec<String> = bits
            .map(|(bit, (_, means))| format!("{} {means}", 1 << bit))
            .collect();
        let alarms = (!bits.is_empty()).then(|| format!("alarm ({}, or a sum)", bits.join(", ")));
        FAULTS
            .map(str::to_owned)
            .into_iter()
            .chain(alarms)
            .collect()
    }

    fn make(&mut self, encoder: &mut dyn OtherEncoder, deed: Deed) -> Option<()> {
        let link = link(encoder);
        let until = |frames| Some(link.encoder().frames() + frames);
        let copy = usize::from(self.sound.repeats);
        let (ends, defect) = match deed {
            Deed::Spoil(frames, Wanted::CrcXor(_)) => {
                (until(frames), Defect::Flip { copy, bit: 0 })
            }
            Deed::Spoil(frames, Wanted::NoStartBit) => (until(frames), Defect::Silent),
            Deed::Line(FaultKind::StuckLow) => (None, Defect::StuckLow),
            _ => return self.change(link, deed),
        };
        link.encoder_mut().config.defect = defect;
        self.spoilt = Spoilt::until(ends);
        Some(())
    }

    fn mend(&mut self, encoder: &mut dyn OtherEncoder) -> bool {
        let encoder = link(encoder).encoder_mut();
        if self.spoilt.ends_at(encoder.frames()) {
            encoder.config.defect = Defect::None;
        }
        self.spoilt.goes_on()
    }
}

impl Faults {
    /// What lasts until something else is asked for.
    fn change(&mut self, link: &mut SsiLink, deed: Deed) -> Option<()> {
        match deed {
            Deed::Supply(true) => link.plug(),
            Deed::Supply(false) | Deed::Line(FaultKind::Open) => link.unplug(),
            Deed::Slow(by) => link.encoder_mut().config.tm = self.sound.tm + by,
            Deed::Jitter(most) => link.encoder_mut().config.jitter = most,
            Deed::Status {
                alarms,
                warnings: 0,
            } if alarms & known_alarms(&self.asked) == alarms => {
                let config = &mut link.encoder_mut().config;
                config.before = extras(&self.asked.before, alarms);
                config.after = extras(&self.asked.after, alarms);
            }
            Deed::Heal => {
                link.plug();
                link.encoder_mut().config = self.sound.clone();
                self.spoilt = Spoilt::default();
            }
            _ => return None,
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::parse;

    /// Catches an encoder that ignores the configured delay, and a cable longer than the channel takes.
    #[test]
    fn virtual_encoder_answers_as_late_as_its_channel_is_configured() {
        for (delay_ns, cable_m, way_ns) in [(150, 3, 15), (400, 30, 50)] {
            let text = format!(
                "name = \"late\"\n[clock]\nsystem_hz = 100_000_000\n[[channel]]\nprotocol = \"ssi\"\nposition_bits = 25\n\
                 clock_hz = 1_000_000\ncable_m = {cable_m}\nbit_delay_ns = {delay_ns}\n[trigger]\nsample_hz = 100\n[host]\nbus = \"apb\"\n"
            );
            let card = parse("late.toml", &text).unwrap().card;
            let channel = &card.channels[0];
            let asked = channel.spoken.ssi().unwrap();
            let config = VirtualConfig::default();
            let plugged = plug(channel, asked, 0, false, &config).encoder;
            for mut encoder in [plugged, Box::new(sound(channel, asked, 0))] {
                encoder.set_clock(0, false);
                encoder.advance_to(500 * NS);
                encoder.set_clock(500 * NS, true);
                // The first bit of a position of less than half the range is LOW.
                let due = (500 + delay_ns + 2 * way_ns) * NS;
                assert!(encoder.advance_to(due - 1), "too soon");
                assert!(!encoder.advance_to(due), "too late");
            }
        }
    }
}
