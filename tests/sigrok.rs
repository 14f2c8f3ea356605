//! The decoders for sigrok, in `sigrok/`.

mod t_format;
mod vcd;
mod wires;

use crate::tools;
use endat_sim::encoder::{Defect, EncoderConfig, PositionSource};
use endat_sim::rng::Rng;
use endat_sim::{Time, NS, US};
use vcd::{assert_without, decoded, numbers};
use wires::{Frame, Wires, POSITION_21, POSITION_22};

/// Texts that no sound frame has.
const COMPLAINTS: [&str; 7] = [
    "Refused", "short", "wrong", "skipped", "Unknown", "DATA", "No start",
];

/// Runs a scenario of the bench: its report, and what a decoder with its options says of the wires.
fn scenario(name: &str, decoder: &str) -> Option<(serde_json::Value, String)> {
    let wires = tools::folder(&format!("sigrok_{name}")).join("wires.vcd");
    let file = wires.to_str().unwrap();
    let command = ["endat-gen", "sim", name, "--channel", "0", "--json"];
    let outcome = endat_gen::cli::run([&command[..], &["--wires", file]].concat());
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    let told = decoded(&wires, 1, decoder)?;
    Some((serde_json::from_str(&outcome.stdout).unwrap(), told))
}

fn endat(bits: u32) -> String {
    format!("endat:clk=clk:data=data:bits={bits}")
}

/// An encoder of 29 bits with a random position in every frame and this recovery time.
fn encoder(tm: Time) -> EncoderConfig {
    EncoderConfig {
        tm: tm..=tm,
        tac: 0..=0,
        ..EncoderConfig::endat22(29)
    }
}

/// Every position that was read was sent, in this order.
fn assert_sent(read: &[u64], sent: &[u64], told: &str) {
    let mut rest = sent.iter();
    for position in read {
        assert!(rest.any(|s| s == position), "{position}: {told}");
    }
}

/// Catches a decoder that dies of a frame that the card gave up, takes the next one for its end, or shows a position that is not good.
#[test]
fn sigrok_goes_on_after_frames_that_were_cut() {
    let Some((report, told)) = scenario("paper-flow", &endat(29)) else {
        return;
    };
    let frames = report[0]["channels"][0]["frames"].as_array().unwrap();
    let sent = frames[0]["encoder"]["position"].as_u64().unwrap();
    let good = numbers(&told, "Position");
    // One had no start bit, one was given up at a wrong one, one had error bits, one a wrong CRC.
    assert_eq!(good, vec![sent; frames.len() - 4], "{told}");
    assert_eq!(numbers(&told, "Refused"), [sent; 2], "{told}");
    for once in [
        ": No start bit",
        ": Frame too short",
        "-1: CRC wrong",
        "): CRC wrong",
        "): F1, F2",
    ] {
        assert_eq!(told.matches(once).count(), 1, "{once}: {told}");
    }
}

/// Catches a decoder that counts another edge, or turns bits round.
#[test]
fn sigrok_decodes_every_frame_to_the_encoders_position() {
    for (name, bits) in [
        ("paper", 29),
        ("real-1", 37),
        ("additional-data", 29),
        // DATA changes after the falling edge there, and the next frame begins soon.
        ("sixteen-megahertz", 25),
    ] {
        let Some((report, told)) = scenario(name, &endat(bits)) else {
            return;
        };
        let frames = report[0]["channels"][0]["frames"].as_array().unwrap();
        let sent: Vec<u64> = frames
            .iter()
            .filter_map(|f| f["encoder"]["position"].as_u64())
            .collect();
        assert!(!sent.is_empty());
        assert_eq!(numbers(&told, "Position"), sent, "{name}: {told}");
        assert!(told.contains("111000 send position with additional data") || name != "paper");
        assert_without(&told, &COMPLAINTS);
        if name == "additional-data" {
            // The temperature, and the supplement that selected it.
            assert_eq!(told.matches("0C 0B8A").count(), 3, "{told}");
            assert!(told.contains("0x4C 0x0000"), "{told}");
        }
    }
}

/// Catches a decoder that does not see a frame's end where CLOCK rests for a short time, or takes a slow HIGH for one.
#[test]
fn sigrok_decodes_endat_frames_at_every_rate_and_gap() {
    let mut wires = Wires::of(encoder(10 * US));
    let mut infos = 0;
    for khz in [100, 200, 500, 1_000, 2_000, 4_000, 8_000, 16_000] {
        let hz = khz * 1_000;
        let tm = if khz > 1_000 { 1_250 * NS } else { 10 * US };
        wires.plug(encoder(tm).seed(hz));
        let plain = Frame::new(hz, POSITION_22);
        let mut frames = vec![plain, Frame::new(hz, POSITION_21)];
        frames.extend([
            Frame::select(hz, 0x4C),
            plain,
            Frame::select(hz, 0x5B),
            plain,
        ]);
        if khz > 1_000 {
            let gap = |gap| Frame {
                gap: Some(gap),
                ..plain
            };
            frames.extend([2_800, 2_800, 5_900, 5_900].map(|ns| gap(ns * NS)));
        }
        frames.iter().for_each(|frame| wires.frame(frame));
        assert_eq!(wires.encoder.violations(), [], "{hz}");
        infos += wires
            .encoder
            .frames()
            .iter()
            .map(|f| f.infos.len())
            .sum::<usize>();
    }
    let Some(told) = decoded(&wires.write("rates", 0, 0), 1, &endat(29)) else {
        return;
    };
    assert_eq!(numbers(&told, "Position"), wires.sent, "{told}");
    assert_without(&told, &COMPLAINTS);
    assert_eq!(told.matches(": 0x4C 0x0000").count(), 8, "{told}");
    let checks = told.matches(": CRC ").count();
    assert_eq!(checks, wires.sent.len() + infos, "{told}");
}

/// Catches a decoder that takes DATA that is periods late for that of the clock pulse before it.
#[test]
fn sigrok_reports_endat_data_later_than_a_period_and_takes_its_delay() {
    const HZ: u64 = 4_000_000;
    const PLAIN: usize = 12;
    let mut wires = Wires::of(encoder(10 * US));
    wires.encoder = endat_sim::encoder::Encoder::new(encoder(10 * US).seed(7));
    for n in 0..PLAIN {
        wires.frame(&Frame::new(HZ, POSITION_22));
        if n % 4 == 3 {
            wires.frame(&Frame::select(HZ, 0x4C));
        }
    }
    assert_eq!(wires.encoder.violations(), []);
    for (flight, is_late) in [(50, false), (140, true), (300, true), (625, true)] {
        let file = wires.write(&format!("late_{flight}"), flight * NS, 0);
        let Some(told) = decoded(&file, 10, &endat(29)) else {
            return;
        };
        assert_sent(&numbers(&told, "Position"), &wires.sent, &told);
        let delays: Vec<u64> = (told.lines())
            .filter_map(|line| line.split_once("delay_ns=")?.1.parse().ok())
            .collect();
        if !is_late {
            assert_eq!(
                (numbers(&told, "Position"), delays),
                (wires.sent.clone(), vec![])
            );
            continue;
        }
        assert!(
            delays.len() >= PLAIN && told.contains("later than a period"),
            "{told}"
        );
        let true_ns = 2 * flight + 50;
        assert!(
            delays.iter().all(|ns| ns.abs_diff(true_ns) <= 20),
            "{true_ns}: {told}"
        );
        let told = decoded(&file, 10, &format!("{}:delay_ns={}", endat(29), delays[0])).unwrap();
        assert_eq!(numbers(&told, "Position"), wires.sent, "{told}");
        assert_without(&told, &COMPLAINTS);
    }
}

/// Catches a decoder that shows a number as a position although it may be none.
#[test]
fn sigrok_shows_no_wrong_endat_position() {
    const HZ: u64 = 8_000_000;
    let mut rng = Rng::new(3);
    let mut wires = Wires::of(encoder(1_250 * NS));
    (0..200).for_each(|_| wires.frame(&Frame::new(HZ, POSITION_22)));
    let file = wires.write("other_bits", 0, 0);
    for bits in [18, 23, 28, 30, 33] {
        let Some(told) = decoded(&file, 1, &endat(bits)) else {
            return;
        };
        // Read as fewer bits, a position is another one.
        assert!(numbers(&told, "Position").is_empty(), "{told}");
        assert!(
            bits < 29 || told.contains("CRC fits with bits=29"),
            "{told}"
        );
    }
    let whole = decoded(&file, 1, &endat(29)).unwrap();
    assert_eq!(numbers(&whole, "Position"), wires.sent);

    // Frames that were cut, or have pauses.
    let mut cut = Wires::of(encoder(1_250 * NS).seed(5));
    for n in 0..150 {
        cut.frame(&Frame {
            most: match n % 3 {
                0 => rng.in_range(1, 80) as u32,
                _ => u32::MAX,
            },
            pause: (8, if n % 10 == 7 { 3 * US } else { 0 }),
            ..Frame::new(HZ, POSITION_22)
        });
    }
    let told = decoded(&cut.write("cut", 0, 0), 1, &endat(29)).unwrap();
    let read = numbers(&told, "Position");
    assert_sent(&read, &cut.sent, &told);
    assert!(
        read.len() >= 60 && told.contains(": Frame too short"),
        "{told}"
    );
}

/// Catches clock pulses that are passed over without a word.
#[test]
fn sigrok_counts_endat_clock_pulses_that_it_skips() {
    const HZ: u64 = 2_000_000;
    let mut wires = Wires::of(encoder(1_250 * NS));
    let plain = Frame::new(HZ, POSITION_22);
    let surplus = |surplus| Frame { surplus, ..plain };
    let unknown = Frame::new(HZ, 0b010011);
    let unknown = Frame {
        most: 20,
        gap: Some(40 * US),
        ..unknown
    };
    wires.frame(&surplus(3));
    wires.frame(&surplus(1));
    let begin = wires.now();
    wires.frame(&unknown);
    wires.frame(&plain);
    let Some(told) = decoded(&wires.write("surplus", 0, 0), 1, &endat(29)) else {
        return;
    };
    assert_eq!(numbers(&told, "Position"), wires.sent, "{told}");
    for text in [
        ": 3 clock pulses skipped",
        ": 1 clock pulse skipped",
        ": Unknown mode command 010011",
        ": 12 clock pulses skipped",
    ] {
        assert_eq!(told.matches(text).count(), 1, "{text}: {told}");
    }
    // A capture that begins after four pulses.
    let inside = begin + 2 * US + 3 * 500 * NS + 100 * NS;
    let told = decoded(&wires.write("inside", 0, inside), 1, &endat(29)).unwrap();
    let text = ": Capture begins within a frame: 16 clock pulses skipped";
    assert_eq!(told.matches(text).count(), 1, "{told}");
    assert_eq!(numbers(&told, "Position"), wires.sent[2..], "{told}");
}

/// A frame of an EQI 1331, read off an oscilloscope, whose CRC would be 0x19.
#[test]
fn sigrok_and_crc_command_refuse_a_frame_of_an_eqi_1331_with_a_wrong_crc() {
    const POSITION: u64 = 0x4B83_9658;
    const COVERED: &str = "10001101001101001110000011101001";
    let config = EncoderConfig {
        tm: 10 * US..=10 * US,
        ..EncoderConfig::endat21(31)
    };
    let config = (config.position(PositionSource::Fixed(POSITION)))
        .defect(0, Defect::ErrorBits { f1: true, f2: true })
        .defect(0, Defect::CrcXor(0x19 ^ 0x04));
    let mut wires = Wires::of(config);
    (0..2).for_each(|_| wires.frame(&Frame::new(200_000, POSITION_21)));
    let command = ["endat-gen", "crc", "--raw", COVERED, "--received", "0x04"];
    let outcome = endat_gen::cli::run(command);
    assert_eq!(outcome.exit_code, 1, "{outcome:?}");
    assert!(
        outcome.messages[0].contains("the CRC is 0x19"),
        "{outcome:?}"
    );
    let Some(told) = decoded(&wires.write("eqi", 0, 0), 10, &endat(31)) else {
        return;
    };
    assert!(told.contains(": CRC 04, should be 19"), "{told}");
    assert_eq!(numbers(&told, "Refused"), [POSITION], "{told}");
    // The next frame of this encoder is good.
    assert_eq!(numbers(&told, "Position"), [POSITION], "{told}");
}
