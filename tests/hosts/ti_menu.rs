//! Each line of the menu of TI's diagnostic example, on the preset with its three channels, by the host library. The virtual
//! card has a UART in the place of the preset's bus.

use super::changed;
use super::desk::Desk;
use endat_card::VirtualConfig;
use endat_config::{load_preset, Project};
use std::ops::RangeInclusive;

struct Menu(Desk);

impl Menu {
    /// Commands that the encoder has understood from the frame `first` on.
    fn commands(&mut self, channel: usize, first: usize) -> Vec<u8> {
        let bench = self.0.card.bridge().transport().bench();
        let frames = bench.frames(channel)[first..].iter();
        frames.filter_map(|f| f.command).collect()
    }

    fn frames(&mut self, channel: usize) -> usize {
        let bench = self.0.card.bridge().transport().bench();
        bench.frames(channel).len()
    }

    fn last_period_ns(&mut self, channel: usize) -> u64 {
        let bench = self.0.card.bridge().transport().bench();
        bench.frames(channel).last().unwrap().period / endat_sim::NS
    }
}

/// Catches a line of the table in docs/host.md that does something else than it says on this preset, with clocks of an eighth.
#[test]
fn every_function_works_on_the_three_channel_preset() {
    let slower = [
        ("system_hz = 128_000_000", "system_hz = 16_000_000"),
        ("clock_hz = 16_000_000", "clock_hz = 2_000_000"),
        ("clock_hz = 8_000_000", "clock_hz = 2_000_000"),
        ("sample_hz = 8_000", "sample_hz = 4_000"),
    ];
    let times = Times {
        system_mhz: 16,
        periods_ns: [500, 500],
        longer: (16, 1_000),
        delays: 4..=20,
    };
    every_function_works(&changed("ti_three_channel", &slower), times);
}

#[test]
#[ignore = "slow: TI's menu at the preset's own clocks"]
fn every_function_works_at_the_clocks_of_the_three_channel_preset() {
    let times = Times {
        system_mhz: 128,
        periods_ns: [62, 125],
        longer: (32, 250),
        delays: 13..=60,
    };
    every_function_works(&load_preset("ti_three_channel").unwrap(), times);
}

/// Times of a card.
struct Times {
    system_mhz: u64,
    /// Clock periods of channels 0 and 1.
    periods_ns: [u64; 2],
    /// A longer period for channel 1, in system clock cycles and in nanoseconds.
    longer: (u32, u64),
    /// Delays that 10 m of cable may have, in system clock cycles.
    delays: RangeInclusive<u32>,
}

fn every_function_works(project: &Project, times: Times) {
    let mut menu = Menu(Desk::new(project, &VirtualConfig::default()));

    // Initialise, identify.
    for (channel, bits, endat22) in [(0, 25, true), (1, 37, true), (2, 24, false)] {
        let plate = menu.0.card.name_plate(channel).unwrap();
        assert!(plate.initialised && plate.failed.is_none(), "{plate:?}");
        assert_eq!((plate.position_bits, plate.endat22), (Some(bits), endat22));
    }

    // Send position, 2.2 and 2.1.
    menu.0.run_ms(2);
    menu.0.assert_positions(20);
    assert_eq!(menu.commands(0, 0).last(), Some(&0b111000));
    assert_eq!(menu.commands(2, 0).last(), Some(&0b000111));

    // Additional data: two codes in turn.
    for channel in [0, 1] {
        menu.0.set(&format!("service{channel}.list_0.mrs"), 0x4C);
        menu.0.set(&format!("service{channel}.list_1.mrs"), 0x4D);
        menu.0
            .set(&format!("service{channel}.list_length.length"), 2);
    }
    menu.0.run_ms(4);
    for slot in ["service0.slot_0", "service0.slot_1", "service1.slot_0"] {
        assert!(menu.0.reg(slot) & 0xFFFF > 0, "{slot}");
    }

    // Memory: parameters in frames of their own.
    let width = menu.0.card.read_parameter(1, 0xA1, 0x0D).unwrap();
    assert_eq!(width.data & 0x3F, 37);
    menu.0.card.write_parameter(1, 0xA9, 0x05, 0x1234).unwrap();
    assert_eq!(
        menu.0.card.read_parameter(1, 0xA9, 0x05).unwrap().data,
        0x1234
    );
    assert_eq!(menu.0.send(2, 0b001110, 0xA1, 0), (0xA1, 0));
    assert_eq!(menu.0.send(2, 0b100011, 0x0D, 0), (0x0D, 0x8018));

    // The same with a position: the supplement takes the parameter along, additional data bring the answer.
    let first = menu.frames(0);
    menu.0.send(0, 0b001001, 0xA9, 0);
    menu.0.send(0, 0b011011, 0x06, 0x0BAD);
    menu.0.send(0, 0b001001, 0xA9, 0);
    menu.0.send(0, 0b100100, 0x06, 0);
    let commands = menu.commands(0, first);
    for command in [0b001001, 0b011011, 0b100100] {
        assert!(commands.contains(&command), "{command:06b}");
    }
    assert_eq!(
        menu.0.card.read_parameter(0, 0xA9, 0x06).unwrap().data,
        0x0BAD
    );

    // Reset and error reset, test values, test and communication command.
    let first = menu.frames(0);
    menu.0.send(0, 0b101010, 0, 0);
    menu.0.send(0, 0b101101, 0, 0);
    menu.0.send(0, 0b010101, 0, 0);
    menu.0.send(0, 0b110001, 0, 0);
    menu.0.send(0, 0b010010, 0, 0);
    let commands = menu.commands(0, first);
    for command in [0b101010, 0b101101, 0b010101, 0b110001, 0b010010] {
        assert!(commands.contains(&command), "{command:06b}");
    }

    // Position 2, put together from three blocks of additional data and compared.
    for (place, code) in [(0, 0x42), (1, 0x43), (2, 0x44)] {
        menu.0.set(&format!("service1.list_{place}.mrs"), code);
    }
    menu.0.set("service1.list_length.length", 3);
    menu.0.set("service1.tolerance", 1);
    menu.0.set("service1.control.clear", 1);
    menu.0.run_ms(20);
    let comparisons = menu.0.reg("service1.comparisons");
    assert!(comparisons & 0xFFFF > 10, "{comparisons:#x}");
    assert_eq!(comparisons >> 16, 0, "none fails");

    // Clock and first low phase of one channel, the others stay.
    assert_eq!(menu.last_period_ns(1), times.periods_ns[1]);
    menu.0.set("config1.frame.period_cycles", times.longer.0);
    menu.0.set("config1.timing.first_low_extra_cycles", 64);
    menu.0.run_ms(2);
    let periods_ns = (menu.last_period_ns(1), menu.last_period_ns(0));
    assert_eq!(periods_ns, (times.longer.1, times.periods_ns[0]));
    menu.0.assert_positions(20);

    // Propagation delay and recovery time. 10 m of cable are 100 ns there and back; three cycles of synchroniser, driver and margin.
    menu.0.set("card.calibrate", 7);
    menu.0.run_ms(3);
    menu.0.assert_positions(20);
    for (channel, recovery_ns) in [
        (0, 1_250..=30_000),
        (1, 1_250..=30_000),
        (2, 10_000..=30_000),
    ] {
        let delay = menu
            .0
            .reg(&format!("result{channel}.evidence.delay_cycles"));
        assert!(times.delays.contains(&delay), "{channel}: {delay}");
        let recovery = menu
            .0
            .reg(&format!("result{channel}.age_recovery.recovery_cycles"));
        let recovery_ns_now = u64::from(recovery) * 1_000 / times.system_mhz;
        assert!(
            recovery_ns.contains(&recovery_ns_now),
            "{channel}: {recovery_ns_now}"
        );
    }

    // Continuous clock on the channel that sends 000111, the others go on with their triggers.
    let good = menu.0.reg("service2.frames_good");
    menu.0.set("service2.continuous.go_on", 1);
    menu.0.run_ms(4);
    let now = menu.0.reg("service2.frames_good");
    assert!(now - good > 70, "{good} {now}: more than a trigger each");
    menu.0.assert_positions(20);
    menu.0.set("service2.continuous.go_on", 0);
    menu.0.run_ms(2);
    menu.0.assert_positions(20);
}
