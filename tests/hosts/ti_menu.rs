//! Each line of the menu of TI's diagnostic example, on the preset with its three channels, by the host library. The virtual
//! card has a UART in the place of the preset's bus.

use super::host;
use endat_gen::virtual_card::VirtualCard;
use endat_host::mailbox::Request;
use endat_host::Card;
use std::time::Duration;

/// A card whose encoders have been initialised.
struct Menu(Card<VirtualCard>);

impl Menu {
    fn new() -> Self {
        let mut card = host("ti_three_channel");
        for channel in 0..3 {
            card.wait_for_initialisation(channel).unwrap();
        }
        Self(card)
    }

    fn reg(&mut self, name: &str) -> u32 {
        let place = self.0.place(name).unwrap();
        self.0.read(&place).unwrap()
    }

    fn set(&mut self, name: &str, value: u32) {
        let place = self.0.place(name).unwrap();
        self.0.write(&place, value).unwrap();
    }

    fn run_ms(&mut self, ms: u64) {
        let card = self.0.bridge().transport();
        let cycles = ms * 128_000;
        card.run(cycles);
    }

    fn send(&mut self, channel: usize, command: u8, address: u8, data: u16) -> (u8, u16) {
        let request = Request {
            command,
            address,
            data,
        };
        let answer = self.0.request(channel, request).unwrap();
        assert!(answer.duration > Duration::ZERO);
        (answer.address, answer.data)
    }

    /// Commands that the encoder has understood from the frame `first` on.
    fn commands(&mut self, channel: usize, first: usize) -> Vec<u8> {
        let bench = self.0.bridge().transport().bench();
        let frames = bench.frames(channel)[first..].iter();
        frames.filter_map(|f| f.command).collect()
    }

    fn frames(&mut self, channel: usize) -> usize {
        let bench = self.0.bridge().transport().bench();
        bench.frames(channel).len()
    }

    fn last_period_ns(&mut self, channel: usize) -> u64 {
        let bench = self.0.bridge().transport().bench();
        bench.frames(channel).last().unwrap().period / endat_sim::NS
    }

    /// All channels give the position that their encoder has sent.
    fn assert_positions(&mut self) {
        let results = self.0.results().unwrap().channels;
        for (channel, result) in results.iter().enumerate() {
            assert!(result.fresh && result.cause == 0, "{channel}: {result:?}");
            let bench = self.0.bridge().transport().bench();
            let sent = bench.frames(channel).iter().rev().take(20);
            let positions: Vec<u64> = sent.map(|f| f.position).collect();
            assert!(positions.contains(&result.position), "{channel}");
        }
    }
}

/// Catches a line of the table in docs/host.md that does something else than it says on this preset.
#[test]
fn every_function_works_on_the_three_channel_preset() {
    let mut menu = Menu::new();

    // Initialise, identify.
    for (channel, bits, endat22) in [(0, 25, true), (1, 37, true), (2, 24, false)] {
        let plate = menu.0.name_plate(channel).unwrap();
        assert!(plate.initialised && plate.failed.is_none());
        assert_eq!((plate.position_bits, plate.endat22), (Some(bits), endat22));
    }

    // Send position, 2.2 and 2.1.
    menu.run_ms(2);
    menu.assert_positions();
    assert_eq!(menu.commands(0, 0).last(), Some(&0b111000));
    assert_eq!(menu.commands(2, 0).last(), Some(&0b000111));

    // Additional information: two codes in turn.
    for channel in [0, 1] {
        menu.set(&format!("service{channel}.list_0.mrs"), 0x4C);
        menu.set(&format!("service{channel}.list_1.mrs"), 0x4D);
        menu.set(&format!("service{channel}.list_length.length"), 2);
    }
    menu.run_ms(4);
    for slot in ["service0.slot_0", "service0.slot_1", "service1.slot_0"] {
        assert!(menu.reg(slot) & 0xFFFF > 0, "{slot}");
    }

    // Memory: parameters in frames of their own.
    let width = menu.0.read_parameter(1, 0xA1, 0x0D).unwrap();
    assert_eq!(width.data & 0x3F, 37);
    menu.0.write_parameter(1, 0xA9, 0x05, 0x1234).unwrap();
    assert_eq!(menu.0.read_parameter(1, 0xA9, 0x05).unwrap().data, 0x1234);
    assert_eq!(menu.send(2, 0b001110, 0xA1, 0), (0xA1, 0));
    assert_eq!(menu.send(2, 0b100011, 0x0D, 0), (0x0D, 0x8018));

    // The same with a position: the supplement takes the parameter along, additional information brings the answer.
    let first = menu.frames(0);
    menu.send(0, 0b001001, 0xA9, 0);
    menu.send(0, 0b011011, 0x06, 0x0BAD);
    menu.send(0, 0b001001, 0xA9, 0);
    menu.send(0, 0b100100, 0x06, 0);
    let commands = menu.commands(0, first);
    for command in [0b001001, 0b011011, 0b100100] {
        assert!(commands.contains(&command), "{command:06b}");
    }
    assert_eq!(menu.0.read_parameter(0, 0xA9, 0x06).unwrap().data, 0x0BAD);

    // Reset and error reset, test values, test and communication command.
    let first = menu.frames(0);
    menu.send(0, 0b101010, 0, 0);
    menu.send(0, 0b101101, 0, 0);
    menu.send(0, 0b010101, 0, 0);
    menu.send(0, 0b110001, 0, 0);
    menu.send(0, 0b010010, 0, 0);
    let commands = menu.commands(0, first);
    for command in [0b101010, 0b101101, 0b010101, 0b110001, 0b010010] {
        assert!(commands.contains(&command), "{command:06b}");
    }

    // Position 2, put together from three informations and compared.
    for (place, code) in [(0, 0x42), (1, 0x43), (2, 0x44)] {
        menu.set(&format!("service1.list_{place}.mrs"), code);
    }
    menu.set("service1.list_length.length", 3);
    menu.set("service1.tolerance", 1);
    menu.set("service1.control.clear", 1);
    menu.run_ms(20);
    let comparisons = menu.reg("service1.comparisons");
    assert!(comparisons & 0xFFFF > 10, "{comparisons:#x}");
    assert_eq!(comparisons >> 16, 0, "none fails");

    // Clock and first low phase of one channel, the others stay.
    assert_eq!(menu.last_period_ns(1), 125);
    menu.set("config1.frame.period_cycles", 32);
    menu.set("config1.timing.first_low_extra_cycles", 64);
    menu.run_ms(2);
    assert_eq!((menu.last_period_ns(1), menu.last_period_ns(0)), (250, 62));
    menu.assert_positions();

    // Propagation delay and recovery time. 10 m of cable are 100 ns there and back; three cycles of synchroniser, driver and margin.
    menu.set("card.calibrate", 7);
    menu.run_ms(3);
    menu.assert_positions();
    for (channel, recovery_ns) in [
        (0, 1_250..=30_000),
        (1, 1_250..=30_000),
        (2, 10_000..=30_000),
    ] {
        let delay = menu.reg(&format!("result{channel}.evidence.delay_cycles"));
        assert!((13..=60).contains(&delay), "{channel}: {delay}");
        let recovery = menu.reg(&format!("result{channel}.age_recovery.recovery_cycles"));
        let recovery_ns_now = u64::from(recovery) * 1_000 / 128;
        assert!(
            recovery_ns.contains(&recovery_ns_now),
            "{channel}: {recovery_ns_now}"
        );
    }

    // Continuous clock on the channel that sends 000111, the others go on with their triggers.
    let good = menu.reg("service2.frames_good");
    menu.set("service2.continuous.go_on", 1);
    menu.run_ms(4);
    let now = menu.reg("service2.frames_good");
    assert!(now - good > 70, "{good} {now}: more than a trigger each");
    menu.assert_positions();
    menu.set("service2.continuous.go_on", 0);
    menu.run_ms(2);
    menu.assert_positions();
}
