//! A card with few system clocks to a bit: positions from two on, additional data, requests and initialisation from four on.

use super::desk::Desk;
use endat_card::VirtualConfig;
use endat_config::{parse, Project};
use endat_hdl::endat::transaction::cause;

/// All of the service but the continuous clock.
const SERVICE: &str = "\"requests\", \"diagnosis\", \"initialise\"";

/// Two channels of 37 and 25 bits.
fn text(system_hz: u64, clock_hz: u64, line_parts: &str, service_parts: &str) -> String {
    format!(
        "name = \"few\"\n[clock]\nsystem_hz = {system_hz}\n[endat]\nclock_hz = {clock_hz}\ncable_m = 20\n\
         [[channel]]\nposition_bits = 37\ncommand = \"111000\"\n[[channel]]\nposition_bits = 25\ncommand = \"111000\"\n\
         [trigger]\nsample_hz = 3_000\n[line]\nparts = [{line_parts}]\n\
         [service]\nparts = [{service_parts}]\n[link]\nbaud = 2_000_000\nread_hz = 2_500\n[board]\nname = \"papilio_pro\"\n"
    )
}

const DOUBLE_EDGE: &str = "\"alignment\", \"margin\", \"double_edge\"";

fn desk(project: &Project, cable_m: f64) -> Desk {
    let config = VirtualConfig {
        cable_m,
        ..VirtualConfig::default()
    };
    Desk::new(project, &config)
}

/// Every frame that the card counts since it was cleared is a good one; triggers that met a frame of a request are the only losses.
fn check_all_good(desk: &mut Desk, channel: usize, at_least: u32, request_frames: u32) {
    let good = desk.reg(&format!("service{channel}.frames_good"));
    assert!(good >= at_least, "{channel}: {good}");
    let first = desk.card.place(&format!("service{channel}.frames_good"));
    let last = desk.card.place(&format!("service{channel}.bad_infos"));
    let (first, last) = (first.unwrap().address(), last.unwrap().address());
    let words = usize::from(last - first) + 1;
    let mut counts = desk.card.bridge().read(first, words).unwrap();
    let overruns = std::mem::take(&mut counts[cause::TRIGGER_OVERRUN as usize]);
    assert!(overruns <= request_frames, "{channel}: {overruns}");
    assert_eq!(counts[1..].iter().sum::<u32>(), 0, "{channel}: {counts:?}");
}

/// System clock, EnDat clock, and cable in metres.
type Case = (u64, u64, f64);

/// Everything that a service does: initialisation, additional data, memory in separate frames and with a position. Each list of
/// additional data is read for so many milliseconds, at least `good` frames come, and a frame of a request meets at most `met` triggers.
fn everything_works(cases: &[Case], list_ms: u64, good: u32, met: u32) {
    for &(system_hz, clock_hz, cable_m) in cases {
        let project = parse("few.toml", &text(system_hz, clock_hz, DOUBLE_EDGE, SERVICE)).unwrap();
        let mut desk = desk(&project, cable_m);
        for (channel, bits) in [(0, 37), (1, 25)] {
            let plate = desk.card.name_plate(channel).unwrap();
            assert_eq!((plate.initialised, plate.position_bits), (true, Some(bits)));
            desk.set(&format!("service{channel}.control.clear"), 1);
        }

        // One block of additional data, then both, each in turn with another.
        for codes in [&[0x4C][..], &[0x4C, 0x5B], &[0x4D, 0x5B, 0x4C]] {
            for channel in [0, 1] {
                for (place, code) in codes.iter().enumerate() {
                    desk.set(&format!("service{channel}.list_{place}.mrs"), *code);
                }
                let length = codes.len() as u32;
                desk.set(&format!("service{channel}.list_length.length"), length);
            }
            desk.run_ms(list_ms);
            for channel in [0, 1] {
                for place in 0..codes.len() {
                    let slot = desk.reg(&format!("service{channel}.slot_{place}"));
                    let now = desk.reg(&format!("result{channel}.status.sequence"));
                    let age = (now as u16).wrapping_sub((slot >> 16) as u16);
                    assert!(age <= 12, "{codes:x?} {channel} {place}: {slot:#x} {now}");
                }
            }
        }

        // Memory in frames of its own, and with a position.
        desk.card.write_parameter(0, 0xA9, 0x05, 0x1234).unwrap();
        assert_eq!(
            desk.card.read_parameter(0, 0xA9, 0x05).unwrap().data,
            0x1234
        );
        desk.send(1, 0b001001, 0xA9, 0);
        desk.send(1, 0b011011, 0x06, 0x0BAD);
        desk.send(1, 0b001001, 0xA9, 0);
        desk.send(1, 0b100100, 0x06, 0);
        assert_eq!(desk.send(1, 0b001110, 0xA9, 0), (0xA9, 0));
        assert_eq!(desk.send(1, 0b100011, 0x06, 0), (0x06, 0x0BAD));

        desk.run_ms(3 * list_ms);
        desk.assert_positions(20);
        // Two memory words with their selection, and one.
        for (channel, request_frames) in [(0, 4), (1, 2)] {
            check_all_good(&mut desk, channel, good, request_frames * met);
            // Only the pulse of the power-up sequence, which is no frame.
            let bench = desk.card.bridge().transport().bench();
            assert_eq!(bench.violations(channel).len(), 1, "{system_hz} {clock_hz}");
        }
    }
}

/// Catches additional data that begin before the position is in its place, and a supplement that is one pulse off.
#[test]
fn everything_works_from_four_system_clocks_to_a_bit_on() {
    // A frame takes four times as long as at 16 MHz.
    everything_works(&[(16_000_000, 4_000_000, 20.0)], 4, 30, 4);
}

#[test]
#[ignore = "slow: four to seven system clocks to a bit, at 8 and 16 MHz"]
fn everything_works_from_four_system_clocks_to_a_bit_on_at_any_clock() {
    let cases = [
        (64_000_000, 16_000_000, 0.5),
        (64_000_000, 16_000_000, 20.0),
        (80_000_000, 16_000_000, 13.0),
        (48_000_000, 8_000_000, 20.0),
        (56_000_000, 8_000_000, 7.0),
    ];
    everything_works(&cases, 10, 100, 1);
}

fn positions_are_right(cases: &[Case], rounds: u32) {
    for &(system_hz, clock_hz, cable_m) in cases {
        let project = parse("few.toml", &text(system_hz, clock_hz, DOUBLE_EDGE, "")).unwrap();
        let mut desk = desk(&project, cable_m);
        desk.run_ms(5);
        for _ in 0..rounds {
            desk.run_ms(1);
            desk.assert_positions(3);
            for channel in [0, 1] {
                let bench = desk.card.bridge().transport().bench();
                assert_eq!(bench.violations(channel), [], "{system_hz} {clock_hz}");
            }
        }
    }
}

#[test]
fn positions_are_right_with_two_system_clocks_to_a_bit() {
    positions_are_right(&[(16_000_000, 8_000_000, 13.0)], 30);
}

#[test]
#[ignore = "slow: two system clocks to a bit, at 8 and 16 MHz"]
fn positions_are_right_with_two_system_clocks_to_a_bit_at_any_clock() {
    let cases = [
        (32_000_000, 16_000_000, 0.5),
        (32_000_000, 16_000_000, 20.0),
        (16_000_000, 8_000_000, 13.0),
    ];
    positions_are_right(&cases, 50);
}

#[test]
fn fewer_clocks_are_refused_with_what_would_do() {
    let alone = "or line.parts = [\"alignment\", \"double_edge\"], which needs half of that on a card without requests";
    let least = "clock.system_hz is 32000000; use at most 8000000 Hz or a faster system clock";
    for (system_hz, line_parts, service_parts, told) in [
        (32, "", "", format!("needs a system clock of at least 64000000 Hz, {least}, {alone}")),
        (16, DOUBLE_EDGE, "", "needs a system clock of at least 32000000 Hz, clock.system_hz is 16000000; use at most 8000000 Hz or a faster system clock".into()),
        (32, DOUBLE_EDGE, SERVICE, "its period is 2 cycles of clock.system_hz = 32000000, additional data need 4; use at most 8000000 Hz, or leave \"requests\" out of service.parts".into()),
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
fn a_period_that_is_too_short_for_additional_data_gives_no_wrong_position() {
    nothing_is_sent(16_000_000, 8);
}

#[test]
#[ignore = "slow: periods that are too short, at 16 MHz"]
fn a_period_that_is_too_short_at_16_mhz_gives_no_wrong_position() {
    nothing_is_sent(64_000_000, 20);
}

/// With four cycles of this system clock to a bit.
fn nothing_is_sent(system_hz: u64, rounds: u32) {
    let text = text(system_hz, system_hz / 4, DOUBLE_EDGE, SERVICE);
    let project = parse("few.toml", &text).unwrap();
    let mut desk = desk(&project, 5.0);
    for (place, code) in [(0, 0x4C), (1, 0x5B)] {
        desk.set(&format!("service0.list_{place}.mrs"), code);
    }
    desk.set("service0.list_length.length", 2);
    desk.run_ms(3);
    for period_cycles in [3, 1] {
        desk.set("config0.frame.period_cycles", period_cycles);
        desk.run_ms(1);
        for _ in 0..rounds {
            desk.run_ms(1);
            let results = desk.card.results().unwrap().channels;
            assert_eq!(results[0].cause_name(), "unknown_command");
            assert!(!results[0].fresh && results[1].fresh, "{results:?}");
        }
    }
    desk.set("config0.frame.period_cycles", 4);
    desk.run_ms(2);
    let results = desk.card.results().unwrap().channels;
    assert!(results[0].fresh && results[0].cause == 0, "{results:?}");
}
