//! The encoder of hdl at the receiver of hdl: widths, rates, cables.

use super::{BLOCK, WRONG_BLOCK};
use crate::position::rig::{engine, ABORT_US};
use endat_hdl::endat::channel::Features;
use endat_hdl::endat::encoder::bit_error;
use endat_hdl::protocol::ModeCommand::{self, SendPosition, SendPositionAddInfo};
use endat_sim::bench::{ChannelSettings, Pair};
use endat_sim::line::LineConfig;
use endat_sim::rng::Rng;
use endat_sim::{MS, US};

struct Setup {
    /// System clock of the receiver, and CLOCK.
    rates: (u64, u64),
    /// System clock of the encoder; if it is that of the receiver, both have one clock.
    encoder_hz: u64,
    command: ModeCommand,
    position_bits: u32,
    cable_m: f64,
    frames: usize,
}

impl Setup {
    /// Every frame brings its position.
    fn run(&self) {
        let (system_hz, endat_hz) = self.rates;
        let (command, position_bits) = (self.command, self.position_bits);
        let context = format!(
            "{:?}, {command:?}, {position_bits} bits, {} m",
            self.rates, self.cable_m
        );
        let mut settings = ChannelSettings::new(system_hz, endat_hz, command, position_bits);
        settings.abort_us = ABORT_US;
        let us = self.encoder_hz / 1_000_000;
        let receiver = (engine(system_hz, Features::NONE), system_hz);
        let mut rng = Rng::new(endat_hz ^ u64::from(position_bits) << 32);
        let line = LineConfig::cable(self.cable_m);
        let after = match self.encoder_hz == system_hz {
            true => 0,
            false => rng.in_range(0, 15_624),
        };
        let mut pair = Pair::new(receiver, (BLOCK.clone(), self.encoder_hz), after, line);
        for (name, value) in settings.ports() {
            pair.set_receiver(name, value);
        }
        for (name, value) in [
            ("position_bits", position_bits.into()),
            ("endat22", 1),
            ("plugged", 1),
        ] {
            pair.set_encoder(name, value);
        }
        pair.run_for(20 * US);
        for frame in 0..self.frames {
            let position = rng.next_u64() & (u64::MAX >> (64 - position_bits));
            pair.set_encoder("position", position.into());
            pair.set_encoder("tcal_cycles", rng.in_range(0, 10 * us).into());
            pair.set_encoder("tm_cycles", rng.in_range(10 * us, 29 * us).into());
            // The short recovery time needs more than 1 MHz; the first result has a slow frame that measures the delay.
            let tm_22 = match endat_hz > 1_000_000 && frame > 0 {
                true => rng.in_range(5 * us / 4 + 1, 15 * us / 4),
                false => rng.in_range(10 * us, 29 * us),
            };
            pair.set_encoder("tm_22_cycles", tm_22.into());
            pair.trigger();
            assert!(
                pair.run_until_done(5 * MS, |p| p.results().len() > frame),
                "{context}"
            );
            assert!(
                pair.run_until_done(MS, |p| p.receiver("busy") == 0),
                "{context}"
            );
            let result = &pair.results()[frame];
            assert_eq!(
                (result.cause_name(), result.fresh),
                ("none", true),
                "{context}, frame {frame}: {result:?}"
            );
            assert_eq!(result.position, position, "{context}, frame {frame}");
        }
        let conflicts = pair.conflicts();
        assert!(
            conflicts.iter().all(|c| !c.both_on),
            "{context}: {conflicts:?}"
        );
    }
}

/// Widths at rates that each need another number of system clock cycles, with cables that the rates allow.
fn sweep(widths: &[u32], frames: usize) {
    for (rates, encoder_hz, cables) in [
        ((100_000_000, 100_000), 64_000_000, [0.0, 10.0, 150.0]),
        ((100_000_000, 1_000_000), 64_000_000, [0.0, 10.0, 100.0]),
        ((100_000_000, 3_125_000), 48_000_000, [0.0, 10.0, 100.0]),
        ((128_000_000, 8_000_000), 64_000_000, [0.0, 10.0, 100.0]),
        ((128_000_000, 16_000_000), 64_000_000, [0.0, 2.0, 20.0]),
        ((64_000_000, 16_000_000), 64_000_000, [0.0, 2.0, 20.0]),
        ((24_000_000, 3_000_000), 24_000_000, [0.0, 2.0, 100.0]),
    ] {
        for (&position_bits, cable_m) in widths.iter().zip(cables.into_iter().cycle()) {
            for command in [SendPosition, SendPositionAddInfo] {
                Setup {
                    rates,
                    encoder_hz,
                    command,
                    position_bits,
                    cable_m,
                    frames,
                }
                .run();
            }
        }
    }
}

#[test]
fn receiver_takes_the_positions_of_the_encoder() {
    sweep(&[1, 13, 25, 37, 48], 3);
}

/// Errors on command, and the cause that the receiver reports for each.
const CAUSES: [(&[(&str, u128)], &str); 13] = [
    (&[], "none"),
    (&[("crc_xor", 0b10000)], "CRC"),
    (&[("crc_xor", 1)], "CRC"),
    (&[("invert_f1", 1)], "F1"),
    (&[("invert_f2", 1)], "F2"),
    (
        &[("bit_error", bit_error::INVERT as u128), ("bit_number", 10)],
        "CRC",
    ),
    (
        &[("bit_error", bit_error::LOW as u128), ("bit_number", 10)],
        "data not falling after the frame",
    ),
    (
        &[("bit_error", bit_error::HIGH as u128), ("bit_number", 10)],
        "CRC",
    ),
    (
        &[("bit_error", bit_error::OFF as u128), ("bit_number", 10)],
        "CRC",
    ),
    (&[("width_xor", 1)], "CRC"),
    (&[("no_start", 1)], "no start bit"),
    (&[("error_tcal_cycles", 70 * 64)], "no start bit"),
    (
        &[("error_tm_cycles", 60 * 64)],
        "data not falling after the frame",
    ),
];

#[test]
fn receiver_reports_each_error_on_command() {
    let (system_hz, endat_hz) = (100_000_000, 3_125_000);
    let mut settings = ChannelSettings::new(system_hz, endat_hz, SendPositionAddInfo, 25);
    settings.abort_us = ABORT_US;
    let receiver = (engine(system_hz, Features::NONE), system_hz);
    let line = LineConfig::cable(20.0);
    let mut pair = Pair::new(receiver, (WRONG_BLOCK.clone(), 64_000_000), 7_000, line);
    for (name, value) in settings.ports() {
        pair.set_receiver(name, value);
    }
    let times = [
        ("tcal_cycles", 320),
        ("tm_cycles", 1280),
        ("tm_22_cycles", 1280),
    ];
    let device = [
        ("position_bits", 25),
        ("endat22", 1),
        ("plugged", 1),
        ("position", 0x15A_5C3A),
    ];
    for (name, value) in times.into_iter().chain(device) {
        pair.set_encoder(name, value);
    }
    pair.run_for(20 * US);
    let frame = |pair: &mut Pair<_, _>, context: &str| {
        let before = pair.results().len();
        pair.trigger();
        assert!(
            pair.run_until_done(5 * MS, |p| p.results().len() > before),
            "{context}"
        );
        assert!(
            pair.run_until_done(5 * MS, |p| p.receiver("busy") == 0),
            "{context}"
        );
        pair.results()[before].cause_name()
    };
    let sound = [("error_tcal_cycles", 320), ("error_tm_cycles", 1280)];
    let names = [
        "crc_xor",
        "invert_f1",
        "invert_f2",
        "bit_error",
        "bit_number",
        "width_xor",
        "no_start",
    ];
    for (errors, cause) in CAUSES {
        let context = format!("{errors:?}");
        // The first result after an error has a frame that measures the delay, so the second one gets the error.
        assert_eq!(frame(&mut pair, &context), "none");
        let none = names.map(|name| (name, 0));
        for (name, value) in none.into_iter().chain(sound).chain(errors.iter().copied()) {
            pair.set_encoder(name, value);
        }
        pair.set_encoder("error_frames", 1);
        pair.set_encoder("arm", 1);
        pair.run_for(US);
        pair.set_encoder("arm", 0);
        assert_eq!(frame(&mut pair, &context), cause, "{context}");
    }
    assert_eq!(frame(&mut pair, "after all"), "none");
}
