//! The encoder of hdl at the plain receiver of the simulation: neither shares anything with the other.

use super::*;
use crate::bench::ChannelSettings;
use crate::test_receiver::TestReceiver;
use crate::{rng::Rng, MS, US};
use endat_hdl::endat::encoder::Encoder;
use endat_hdl::protocol::ModeCommand::{self, SendPosition, SendPositionAddInfo};
use rtl_design::{elaborate::elaborate, engine::Compiled};
use rust_hdl::prelude::Block;
use std::sync::OnceLock;

const RECEIVER_HZ: u64 = 128_000_000;
const ENCODER_HZ: u64 = 64_000_000;

fn encoder() -> Compiled {
    static MADE: OnceLock<Compiled> = OnceLock::new();
    let make = || {
        let mut block = Encoder::default();
        block.connect_all();
        Compiled::new(&elaborate(&block, "encoder").unwrap()).unwrap()
    };
    MADE.get_or_init(make).clone()
}

/// Whole frames with random positions and alarms.
fn frames(endat_hz: u64, command: ModeCommand, position_bits: u32, cable_m: f64) {
    let context = format!("{endat_hz} Hz, {command:?}, {position_bits} bits, {cable_m} m");
    let mut settings = ChannelSettings::new(RECEIVER_HZ, endat_hz, command, position_bits);
    settings.abort_us = 500;
    let receiver = (TestReceiver::new(RECEIVER_HZ), RECEIVER_HZ);
    let mut rng = Rng::new(endat_hz ^ u64::from(position_bits));
    let after = rng.in_range(0, 15_624);
    let line = LineConfig::cable(cable_m);
    let mut pair = Pair::new(receiver, (encoder(), ENCODER_HZ), after, line);
    for (name, value) in settings.ports() {
        pair.set_receiver(name, value);
    }
    let tm = [("tm_cycles", 1280), ("tm_22_cycles", 128)];
    let device = [("position_bits", position_bits.into()), ("endat22", 1)];
    for (name, value) in tm.into_iter().chain(device).chain([("plugged", 1)]) {
        pair.set_encoder(name, value);
    }
    pair.run_for(20 * US);
    // The first one measures the delay.
    for frame in 0..4 {
        let position = rng.next_u64() & (u64::MAX >> (64 - position_bits));
        let alarms = [rng.in_range(0, 3) == 0, rng.in_range(0, 3) == 0];
        pair.set_encoder("position", position.into());
        pair.set_encoder("tcal_cycles", rng.in_range(0, 640).into());
        pair.set_encoder("alarm_1", alarms[0].into());
        pair.set_encoder("alarm_2", alarms[1].into());
        pair.trigger();
        assert!(
            pair.run_until_done(5 * MS, |p| p.results().len() > frame),
            "{context}"
        );
        let result = pair.results()[frame].clone();
        let expected = match alarms {
            [true, _] => 5,
            [_, true] if command == SendPositionAddInfo => 6,
            _ => 0,
        };
        assert_eq!(result.cause, expected, "{context}: {result:?}");
        if expected == 0 {
            assert_eq!(result.position, position, "{context}: {result:?}");
        }
        assert!(
            pair.run_until_done(MS, |p| p.receiver("busy") == 0),
            "{context}"
        );
        assert_eq!(pair.results()[frame].late_cause, None, "{context}");
    }
    assert_eq!(pair.conflicts(), [], "{context}");
}

#[test]
fn plain_receiver_takes_the_positions_of_the_encoder() {
    for (endat_hz, cable_m) in [
        (100_000, 150.0),
        (1_000_000, 100.0),
        (8_000_000, 100.0),
        (16_000_000, 20.0),
    ] {
        for position_bits in [1, 25, 48] {
            frames(endat_hz, SendPosition, position_bits, cable_m);
            frames(endat_hz, SendPositionAddInfo, position_bits, cable_m);
        }
    }
}
