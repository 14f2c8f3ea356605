//! A card with few system clocks to a bit: positions from two on, informations, requests and initialisation from four on.

use endat_gen::config::{parse, Project};
use endat_gen::virtual_card::{VirtualCard, VirtualConfig};
use endat_host::mailbox::Request;
use endat_host::{Bridge, Card};

/// All of the service but the continuous clock.
const SERVICE: &str = "\"requests\", \"diagnosis\", \"initialise\"";

/// Two channels of 37 and 25 bits.
fn text(system_hz: u64, clock_hz: u64, line_parts: &str, service_parts: &str) -> String {
    format!(
        "name = \"few\"\n[clock]\nsystem_hz = {system_hz}\n[endat]\nclock_hz = {clock_hz}\ncable_m = 20\n\
         [[channel]]\nposition_bits = 37\ncommand = \"111000\"\n[[channel]]\nposition_bits = 25\ncommand = \"111000\"\n\
         [trigger]\nsample_hz = 3_000\n[line]\nparts = [{line_parts}]\n\
         [service]\nparts = [{service_parts}]\n[link]\nbaud = 2_000_000\n[board]\nname = \"papilio_pro\"\n"
    )
}

const DOUBLE_EDGE: &str = "\"alignment\", \"margin\", \"double_edge\"";

struct Few {
    card: Card<VirtualCard>,
    ms_cycles: u64,
}

impl Few {
    fn new(project: &Project, cable_m: f64) -> Self {
        let config = VirtualConfig {
            cable_m,
            ..VirtualConfig::default()
        };
        let card = VirtualCard::new(project, &config).unwrap();
        let mut card = Card::find(Bridge::new(card)).unwrap();
        if project.card.service.initialise {
            card.wait_for_initialisation(0).unwrap();
            card.wait_for_initialisation(1).unwrap();
        }
        Self {
            card,
            ms_cycles: project.card.system_hz / 1_000,
        }
    }

    fn reg(&mut self, name: &str) -> u32 {
        let place = self.card.place(name).unwrap();
        self.card.read(&place).unwrap()
    }

    fn set(&mut self, name: &str, value: u32) {
        let place = self.card.place(name).unwrap();
        self.card.write(&place, value).unwrap();
    }

    fn run_ms(&mut self, ms: u64) {
        let cycles = ms * self.ms_cycles;
        self.card.bridge().transport().run(cycles);
    }

    fn send(&mut self, channel: usize, command: u8, address: u8, data: u16) -> (u8, u16) {
        let request = Request {
            command,
            address,
            data,
        };
        let answer = self.card.request(channel, request).unwrap();
        (answer.address, answer.data)
    }

    /// Every frame that the card counts since it was cleared is a good one.
    fn check_all_good(&mut self, channel: usize, at_least: u32) {
        let good = self.reg(&format!("service{channel}.frames_good"));
        assert!(good >= at_least, "{channel}: {good}");
        let first = self.card.place(&format!("service{channel}.frames_good"));
        let last = self.card.place(&format!("service{channel}.bad_infos"));
        let (first, last) = (first.unwrap().address(), last.unwrap().address());
        let counts = self
            .card
            .bridge()
            .read(first, usize::from(last - first) + 1);
        assert_eq!(counts.unwrap()[1..].iter().sum::<u32>(), 0, "{channel}");
    }
}

/// Catches an information that begins before the position stands in its place, and a supplement that is one pulse off.
#[test]
fn everything_works_from_four_system_clocks_to_a_bit_on() {
    for (system_hz, clock_hz, cable_m) in [
        (64_000_000, 16_000_000, 0.5),
        (64_000_000, 16_000_000, 20.0),
        (80_000_000, 16_000_000, 13.0),
        (48_000_000, 8_000_000, 20.0),
        (56_000_000, 8_000_000, 7.0),
    ] {
        let project = parse("few.toml", &text(system_hz, clock_hz, DOUBLE_EDGE, SERVICE)).unwrap();
        eprintln!("{system_hz} {clock_hz} {cable_m}");
        let mut few = Few::new(&project, cable_m);
        for (channel, bits) in [(0, 37), (1, 25)] {
            let plate = few.card.name_plate(channel).unwrap();
            assert_eq!((plate.initialised, plate.position_bits), (true, Some(bits)));
            few.set(&format!("service{channel}.control.clear"), 1);
        }

        // One information, then both, each in turn with another.
        for codes in [&[0x4C][..], &[0x4C, 0x5B], &[0x4D, 0x5B, 0x4C]] {
            for channel in [0, 1] {
                for (place, code) in codes.iter().enumerate() {
                    few.set(&format!("service{channel}.list_{place}.mrs"), *code);
                }
                let length = codes.len() as u32;
                few.set(&format!("service{channel}.list_length.length"), length);
            }
            few.run_ms(10);
            for channel in [0, 1] {
                for place in 0..codes.len() {
                    let slot = few.reg(&format!("service{channel}.slot_{place}"));
                    let now = few.reg(&format!("result{channel}.status.sequence"));
                    let age = (now as u16).wrapping_sub((slot >> 16) as u16);
                    assert!(age <= 12, "{codes:x?} {channel} {place}: {slot:#x} {now}");
                }
            }
        }

        // Memory in frames of its own, and with a position.
        few.card.write_parameter(0, 0xA9, 0x05, 0x1234).unwrap();
        assert_eq!(few.card.read_parameter(0, 0xA9, 0x05).unwrap().data, 0x1234);
        few.send(1, 0b001001, 0xA9, 0);
        few.send(1, 0b011011, 0x06, 0x0BAD);
        few.send(1, 0b001001, 0xA9, 0);
        few.send(1, 0b100100, 0x06, 0);
        assert_eq!(few.send(1, 0b001110, 0xA9, 0), (0xA9, 0));
        assert_eq!(few.send(1, 0b100011, 0x06, 0), (0x06, 0x0BAD));

        few.run_ms(30);
        let results = few.card.results().unwrap().channels;
        for (channel, result) in results.iter().enumerate() {
            few.check_all_good(channel, 100);
            let bench = few.card.bridge().transport().bench();
            let sent = bench.frames(channel).iter().rev().take(20);
            let positions: Vec<u64> = sent.map(|f| f.position).collect();
            assert!(result.fresh && positions.contains(&result.position));
            // Only the pulse of the power-up sequence, which is no frame.
            assert_eq!(bench.violations(channel).len(), 1, "{system_hz} {clock_hz}");
        }
    }
}

#[test]
fn positions_are_right_with_two_system_clocks_to_a_bit() {
    for (system_hz, clock_hz, cable_m) in [
        (32_000_000, 16_000_000, 0.5),
        (32_000_000, 16_000_000, 20.0),
        (16_000_000, 8_000_000, 13.0),
    ] {
        let project = parse("few.toml", &text(system_hz, clock_hz, DOUBLE_EDGE, "")).unwrap();
        let mut few = Few::new(&project, cable_m);
        few.run_ms(5);
        for _ in 0..50 {
            few.run_ms(1);
            let results = few.card.results().unwrap().channels;
            for (channel, result) in results.iter().enumerate() {
                assert_eq!((result.cause, result.fresh), (0, true), "{result:?}");
                let bench = few.card.bridge().transport().bench();
                let sent = bench.frames(channel).iter().rev().take(3);
                let positions: Vec<u64> = sent.map(|f| f.position).collect();
                assert!(
                    positions.contains(&result.position),
                    "{result:?} {positions:?}"
                );
                assert_eq!(bench.violations(channel), [], "{system_hz} {clock_hz}");
            }
        }
    }
}

#[test]
fn fewer_clocks_are_refused_with_what_would_do() {
    let alone = "or line.parts = [\"alignment\", \"double_edge\"], which needs half of that";
    let least = "clock.system_hz is 32000000; use at most 8000000 Hz or a faster system clock";
    for (system_hz, line_parts, service_parts, told) in [
        (32, "", "", format!("needs a system clock of at least 64000000 Hz, {least}, {alone}")),
        (16, DOUBLE_EDGE, "", "needs a system clock of at least 32000000 Hz, clock.system_hz is 16000000; use at most 8000000 Hz or a faster system clock".into()),
        (32, DOUBLE_EDGE, SERVICE, "its period is 2 cycles of clock.system_hz = 32000000, additional informations take 4; use at most 8000000 Hz, or leave \"requests\" out of service.parts".into()),
(48, DOUBLE_EDGE, "", "its period of 3 cycles of clock.system_hz = 48000000 has pulses of 1 and 2 cycles, encoders allow 10 % of the period more or less than half of it; use a system clock of 32000000 or 64000000 Hz".into()),
    ] {
        let told = format!("endat.clock_hz = 16000000: {told}");
        let text = text(system_hz * 1_000_000, 16_000_000, line_parts, service_parts);
        let all = parse("few.toml", &text).unwrap_err();
        let found: Vec<String> = all.iter().map(ToString::to_string).collect();
        assert!(found.iter().any(|d| d.ends_with(&told)), "{told} {found:?}");
    }
}

/// A host may write a period that no configuration has: nothing is sent, so that no wrong position comes.
#[test]
fn a_period_that_is_too_short_for_informations_gives_no_wrong_position() {
    let text = text(64_000_000, 16_000_000, DOUBLE_EDGE, SERVICE);
    let project = parse("few.toml", &text).unwrap();
    let mut few = Few::new(&project, 5.0);
    for (place, code) in [(0, 0x4C), (1, 0x5B)] {
        few.set(&format!("service0.list_{place}.mrs"), code);
    }
    few.set("service0.list_length.length", 2);
    few.run_ms(3);
    for period_cycles in [3, 1] {
        few.set("config0.frame.period_cycles", period_cycles);
        few.run_ms(1);
        for _ in 0..20 {
            few.run_ms(1);
            let results = few.card.results().unwrap().channels;
            assert_eq!(results[0].cause_name(), "unknown_command");
            assert!(!results[0].fresh && results[1].fresh, "{results:?}");
        }
    }
    few.set("config0.frame.period_cycles", 4);
    few.run_ms(2);
    let results = few.card.results().unwrap().channels;
    assert!(results[0].fresh && results[0].cause == 0, "{results:?}");
}
