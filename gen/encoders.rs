//! Encoders that fit the channels of a card.

use endat_hdl::config::ChannelConfig;
use endat_hdl::protocol::ModeCommand;
use endat_sim::encoder::{EncoderConfig, PositionSource};

/// Of the width that a channel is configured for, and of the generation that knows its command.
pub fn fitting(channel: &ChannelConfig) -> EncoderConfig {
    let bits = channel.position_bits;
    match channel.command {
        ModeCommand::SendPosition => EncoderConfig::endat21(bits),
        _ => EncoderConfig::endat22(bits),
    }
}

/// The same on channel `n`, with another position in every frame.
pub fn turning(channel: &ChannelConfig, n: usize) -> EncoderConfig {
    let (start, step) = (0x1234_5678 >> n, 0x10_0001);
    let encoder = fitting(channel).position(PositionSource::Ramp { start, step });
    encoder.seed(n as u64 + 1)
}
