//! Encoders that fit the channels of a card.

use endat_hdl::config::{ChannelConfig, PositionRange};
use endat_hdl::protocol::ModeCommand;
use endat_sim::encoder::{EncoderConfig, PositionSource, TypePlate};
use endat_sim::MS;

/// Cable between card and encoders where nothing else is asked for, in metres.
pub const CABLE_M: f64 = 10.0;
/// Delay of a metre of cable, in nanoseconds.
pub const NS_PER_M: f64 = 5.0;
/// A second of simulated time.
pub const SECOND: f64 = 1_000.0 * MS as f64;
/// Measuring step of a scale, in nanometres.
const SCALE_NM: u32 = 10;

/// Of the width that a channel is configured for, and of the generation that knows its command.
pub fn fitting(channel: &ChannelConfig) -> EncoderConfig {
    let bits = channel.position_bits;
    let encoder = match channel.command {
        ModeCommand::SendPosition => EncoderConfig::endat21(bits),
        _ => EncoderConfig::endat22(bits),
    };
    // One that says the same of itself.
    match (channel.turn_bits(), channel.spec.range) {
        (Some([single @ 1..32, multi @ 0..16]), _) => EncoderConfig {
            plate: TypePlate::of_turns(single as u32, multi as u32),
            ..encoder
        },
        (_, Some(PositionRange::Linear)) => EncoderConfig {
            plate: TypePlate::linear(SCALE_NM),
            ..encoder
        },
        _ => encoder,
    }
}

/// The same on channel `n`, with another position in every frame.
pub fn turning(channel: &ChannelConfig, n: usize) -> EncoderConfig {
    let (start, step) = (0x1234_5678 >> n, 0x10_0001);
    let encoder = fitting(channel).position(PositionSource::Ramp { start, step });
    encoder.seed(n as u64 + 1)
}
