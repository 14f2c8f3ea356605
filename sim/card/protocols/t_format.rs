//! A T-format encoder at a virtual card: how it moves, and what can be wrong with it.

use super::{OtherEncoders, OtherFaults, Plugged, Spoilt};
use crate::deed::Deed;
use crate::settings::VirtualConfig;
use endat_config::protocols::t_format::asked;
use endat_emit::encoders::{NS_PER_M, SECOND};
use endat_hdl::config::ChannelConfig;
use endat_regs::Protocol;
use endat_sim::bench::{OtherEncoder, TFormatLink, TFormatMotion};
use endat_sim::encoder::Defect as Wanted;
use endat_sim::line::FaultKind;
use endat_sim::t_format::{Defect, EncoderConfig};
use endat_sim::{Time, MS, NS};
use std::sync::Arc;

/// The device that it is.
pub const DEVICES: &[&str] = &["TS5700N8401"];
/// Its bits of angle and of turns, unless the configuration has others.
const BITS: [u64; 2] = [17, 16];

/// What it and its line can do of the faults that there are.
const FAULTS: [&str; 9] = [
    "unplug",
    "plug",
    "crc",
    "silent",
    "slow",
    "alarm (bits to 255)",
    "jitter",
    "line stuck_low or open",
    "heal",
];

/// Bits of ALMC that a bit of the status field tells, too: counting error; multi-turn and battery.
const ALARMS: [(u16, u8); 2] = [(0x04, 1 << 4), (0xE0, 1 << 5)];

/// Single-turn and multi-turn position of one that turns evenly.
fn motion(channel: usize, speed: f64, [single_bits, multi_bits]: [u64; 2]) -> TFormatMotion {
    let speed = speed * (1.0 + 0.5 * channel as f64);
    let start = 100.1 * (channel + 1) as f64;
    Arc::new(move |time: Time| {
        let turns = start + speed * time as f64 / SECOND;
        let steps = (turns * f64::from(1u32 << single_bits)).max(0.0) as u64;
        let low = |bits: u64| (1u64 << bits) - 1;
        let turn = steps >> single_bits & low(multi_bits);
        ((steps & low(single_bits)) as u32, turn as u32)
    })
}

/// See the module.
pub struct TFormat;

impl OtherEncoders for TFormat {
    fn protocol(&self) -> Protocol {
        Protocol::TFormat
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
        plug(
            asked(channel).bit_hz,
            channel.turn_bits(),
            n,
            is_open,
            config,
        )
    }
}

/// One on its line, turning as others do.
pub fn plug(
    bit_hz: u64,
    bits: Option<[u64; 2]>,
    channel: usize,
    is_open: bool,
    config: &VirtualConfig,
) -> Plugged {
    let encoder = EncoderConfig {
        bit_hz,
        // A battery that is full: otherwise every result would have that alarm.
        status: 0,
        alarm: 0,
        jitter: config.jitter_ns as Time * NS,
        write_time: MS,
        seed: config.seed.wrapping_add(channel as u64),
        ..EncoderConfig::default()
    };
    let faults = Faults {
        sound: encoder.clone(),
        spoilt: Spoilt::default(),
    };
    let mut link = TFormatLink::new(encoder, (config.cable_m * NS_PER_M * NS as f64) as Time);
    let turns = motion(channel, config.speed, bits.unwrap_or(BITS));
    link.set_motion(turns.clone());
    if is_open {
        link.unplug();
    }
    Plugged {
        encoder: Box::new(link),
        motion: Arc::new(move |time| {
            let (single, multi) = turns(time);
            u64::from(multi) << 24 | u64::from(single)
        }),
        faults: Box::new(faults),
    }
}

/// What is wrong with one.
struct Faults {
    /// As it was.
    sound: EncoderConfig,
    spoilt: Spoilt,
}

fn link(encoder: &mut dyn OtherEncoder) -> &mut TFormatLink {
    let link = encoder.as_any_mut().downcast_mut();
    link.expect("the encoder that these faults were made for")
}

impl OtherFaults for Faults {
    fn known(&self) -> Vec<String> {
        FAULTS.map(str::to_owned).into()
    }

    fn make(&mut self, encoder: &mut dyn OtherEncoder, deed: Deed) -> Option<()> {
        let link = link(encoder);
        let until = |replies| Some(link.encoder().request_count() + replies);
        let (ends, defect) = match deed {
            // Of a position: only the CRC tells.
            Deed::Spoil(replies, Wanted::CrcXor(_)) => {
                (until(replies), Defect::Flip { field: 2, bit: 0 })
            }
            Deed::Spoil(replies, Wanted::NoStartBit) => (until(replies), Defect::Silent),
            Deed::Line(FaultKind::StuckLow) => (None, Defect::StuckLow),
            _ => return self.change(link, deed),
        };
        link.encoder_mut().config.defect = defect;
        self.spoilt = Spoilt::until(ends);
        Some(())
    }

    fn mend(&mut self, encoder: &mut dyn OtherEncoder) -> bool {
        let encoder = link(encoder).encoder_mut();
        if self.spoilt.ends_at(encoder.request_count()) {
            encoder.config.defect = Defect::None;
        }
        self.spoilt.goes_on()
    }
}

impl Faults {
    /// What lasts until something else is asked for.
    fn change(&mut self, link: &mut TFormatLink, deed: Deed) -> Option<()> {
        match deed {
            Deed::Supply(true) => link.plug(),
            Deed::Supply(false) | Deed::Line(FaultKind::Open) => link.unplug(),
            Deed::Slow(by) => link.encoder_mut().config.reply_gap = self.sound.reply_gap + by,
            Deed::Jitter(most) => link.encoder_mut().config.jitter = most,
            Deed::Status {
                alarms,
                warnings: 0,
            } if alarms <= 0xFF => {
                let config = &mut link.encoder_mut().config;
                config.alarm |= alarms as u8;
                // The status field sums them up.
                for (bits, status) in ALARMS {
                    config.status |= if alarms & bits == 0 { 0 } else { status };
                }
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
