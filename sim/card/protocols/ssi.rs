//! An SSI encoder at a virtual card: how it moves, and what can be wrong with it.

use super::{OtherEncoders, OtherFaults, Plugged, Spoilt};
use crate::deed::Deed;
use crate::settings::VirtualConfig;
use endat_config::protocols::ssi::asked;
use endat_emit::protocols::ssi::encoder::{delay, extras, fitting, motion, ALARMS};
use endat_hdl::config::ChannelConfig;
use endat_hdl::protocols::SsiSpec;
use endat_regs::Protocol;
use endat_sim::bench::OtherEncoder;
use endat_sim::encoder::Defect as Wanted;
use endat_sim::line::FaultKind;
use endat_sim::ssi::{Defect, EncoderConfig, SsiLink};
use endat_sim::{Time, NS};

/// An encoder of whatever width and code a channel is configured for.
pub const DEVICES: &[&str] = &["SSI"];
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

/// The alarms that a channel's special bits can say.
fn known_alarms(asked: &SsiSpec) -> u16 {
    let has = |is: u64| {
        asked
            .specials()
            .any(|s| s.cause().is_some_and(|(c, _)| c == is))
    };
    (ALARMS.iter().enumerate()).fold(0, |known, (bit, is)| known | u16::from(has(is.0)) << bit)
}

/// See the module.
pub struct Ssi;

impl OtherEncoders for Ssi {
    fn protocol(&self) -> Protocol {
        Protocol::Ssi
    }

    fn devices(&self) -> &'static [&'static str] {
        DEVICES
    }

    fn plug(
        &self,
        channel: &ChannelConfig,
        n: usize,
        is_open: bool,
        config: &VirtualConfig,
    ) -> Plugged {
        plug(channel, asked(channel), n, is_open, config)
    }
}

/// One on its line, turning as others do.
pub fn plug(
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
    use endat_config::parse;
    use endat_emit::protocols::ssi::encoder::sound;

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
