//! Channels of one card, each at its own rate, width, delay and mode: none notices the others.

use endat_config::load_preset;
use endat_hdl::{
    card::{service_times, uart_bridge::TIMEOUT_US},
    config::{CardConfig, ChannelConfig, LineParts},
    protocol::ModeCommand,
};
use endat_sim::{
    bench::{Bench, Link, PinNames},
    encoder::EncoderConfig,
    line::LineConfig,
    US,
};
use rtl_design::engine::{Compiled, Engine};

/// Clock in hertz, position bits, command, cable in metres.
const CHANNELS: [(u64, u64, ModeCommand, u64); 8] = [
    (16_000_000, 25, ModeCommand::SendPositionAddInfo, 20),
    (8_000_000, 29, ModeCommand::SendPositionAddInfo, 100),
    (4_000_000, 36, ModeCommand::SendPositionAddInfo, 150),
    (2_000_000, 13, ModeCommand::SendPosition, 5),
    (12_800_000, 48, ModeCommand::SendPositionAddInfo, 60),
    (1_000_000, 17, ModeCommand::SendPosition, 50),
    (6_400_000, 1, ModeCommand::SendPositionAddInfo, 300),
    (3_200_000, 32, ModeCommand::SendPositionAddInfo, 1),
];

fn config() -> CardConfig {
    let mut card = load_preset("s6_two_channel").unwrap().card;
    card.system_hz = 128_000_000;
    card.sample_period_cycles = 12_800;
    card.line = LineParts {
        alignment: true,
        margin: true,
        double_edge: false,
        ..LineParts::default()
    };
    let request = card.channels[0].spec.clone();
    let channel = |(index, (clock_hz, position_bits, command, cable_m))| {
        let mut request = request.clone();
        (request.clock_hz, request.position_bits) = (clock_hz, position_bits);
        (request.command, request.cable_m) = (command, cable_m);
        request.start_window_ns = 16;
        ChannelConfig::resolve(&request, card.system_hz, false, index).unwrap()
    };
    card.channels = CHANNELS.into_iter().enumerate().map(channel).collect();
    card
}

fn link(channel: usize) -> Link {
    let (_, bits, _, cable_m) = CHANNELS[channel];
    let mut encoder = EncoderConfig::endat22(bits as u32).seed(channel as u64);
    encoder.tm = 10 * US..=12 * US;
    Link::new(LineConfig::cable(cable_m as f64), encoder)
}

/// The levels at the pins of each channel in so many cycles, with encoders on these channels only.
fn pins(engine: &Compiled, cycles: u64, with: &[usize]) -> Vec<Vec<u8>> {
    let links = with
        .iter()
        .map(|n| (PinNames::card(*n), link(*n)))
        .collect();
    let mut bench = Bench::new(engine.clone(), config().system_hz, links);
    bench.set("uart_rx_i", 1);
    bench.power_up();
    let mut all = vec![vec![]; CHANNELS.len()];
    let names = |n: usize| {
        [
            format!("endat_clk{n}_o"),
            format!("endat_data{n}_o"),
            format!("endat_data{n}_oe"),
            format!("led_channel{n}_o"),
        ]
    };
    let ids: Vec<_> = (0..CHANNELS.len())
        .map(|n| names(n).map(|name| bench.engine().port(&name)))
        .collect();
    for _ in 0..cycles {
        bench.tick();
        for (rows, ids) in all.iter_mut().zip(&ids) {
            let bit = |id| bench.engine().get(id) as u8;
            rows.push(
                ids.map(bit)
                    .into_iter()
                    .fold(0, |byte, bit| byte << 1 | bit),
            );
        }
    }
    all
}

fn channels_do_the_same_alone(channels: impl IntoIterator<Item = usize>, cycles: u64) {
    let config = config();
    let engine = crate::made::uart_card(&config, &service_times(&config), TIMEOUT_US);
    let together = pins(&engine, cycles, &[0, 1, 2, 3, 4, 5, 6, 7]);
    for channel in channels {
        let together = &together[channel];
        let alone = &pins(&engine, cycles, &[channel])[channel];
        let first = alone.iter().zip(together).position(|(a, b)| a != b);
        assert_eq!(first, None, "channel {channel}");
        // It worked: the channel's light is on, and the clock ran.
        assert_eq!(together[together.len() - 1] & 1, 1, "channel {channel}");
        let edges = together.windows(2).filter(|w| (w[0] ^ w[1]) & 8 != 0);
        assert!(edges.count() > 100, "channel {channel}");
    }
}

/// The fastest clock, and the narrowest position at the end of the longest cable.
#[test]
fn a_channel_does_the_same_alone_and_among_seven_others() {
    channels_do_the_same_alone([0, 6], 150_000);
}

#[test]
#[ignore = "slow: each of eight channels alone"]
fn each_channel_does_the_same_alone_and_among_seven_others() {
    channels_do_the_same_alone(0..CHANNELS.len(), 300_000);
}
