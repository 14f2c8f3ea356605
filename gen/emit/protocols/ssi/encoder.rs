//! An SSI encoder that fits a channel.

use crate::encoders::{CABLE_M, NS_PER_M, SECOND};
use endat_hdl::config::{ChannelConfig, PositionRange};
use endat_hdl::protocols::ssi::asked::Parity;
use endat_hdl::protocols::ssi::cause;
use endat_hdl::protocols::ssi::specials::{Special, Specials};
use endat_hdl::protocols::SsiSpec;
use endat_sim::ssi::{EncoderConfig, Extra, SsiLink, SsiMotion};
use endat_sim::{Time, NS};
use std::sync::Arc;

/// Steps of a turn, as usual encoders of 12 or 13 bits to the turn have them, unless the configuration has others.
const TURN_BITS: u64 = 13;
/// Of a scale: a tenth of it to and fro.
const STROKE: f64 = 0.1;

/// The causes that special bits may be, in the order of the bits of an alarm, and what they are called.
pub const ALARMS: [(u64, &str); 3] = [
    (cause::ALARM, "alarm"),
    (cause::POWER_FAIL, "power fails"),
    (cause::NOT_VALID, "position not valid"),
];

/// The special bits that an encoder with these alarms sends.
pub fn extras(specials: &Specials, alarms: u16) -> Vec<Extra> {
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

/// The encoder that a channel is configured for.
pub fn fitting(channel: &ChannelConfig, asked: &SsiSpec, seed: u64) -> EncoderConfig {
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
pub fn motion(config: &ChannelConfig, channel: usize, speed: f64) -> SsiMotion {
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

/// The way along a cable; the usual one is not longer than the channel takes.
pub fn delay(channel: &ChannelConfig, cable_m: f64) -> Time {
    let most_m = channel.spec.cable_m as f64;
    let cable_m = match cable_m == CABLE_M {
        true => cable_m.min(most_m),
        false => cable_m,
    };
    (cable_m * NS_PER_M * NS as f64) as Time
}

/// One without a fault at channel `n`, for a run that is recorded: 10 m away, or as far as the channel takes.
pub fn sound(channel: &ChannelConfig, asked: &SsiSpec, n: usize) -> SsiLink {
    let mut link = SsiLink::new(
        fitting(channel, asked, n as u64 + 1),
        delay(channel, CABLE_M),
    );
    link.set_motion(motion(channel, n, 1.0));
    link
}
