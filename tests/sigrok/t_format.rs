//! The one of T-format.

use super::scenario;
use super::vcd::{assert_without, decoded, numbers, write};
use std::path::Path;

const DECODER: &str = "t_format:data=data";
/// Texts that no sound exchange has.
const COMPLAINTS: [&str; 8] = [
    "missing",
    "No ",
    "Delimiter",
    "another",
    "wrong",
    "Refused",
    "Skipped",
    "Capture",
];
/// A bit in nanoseconds.
const BIT: u64 = 400;
/// Request 0 and two replies of a TS5700N8401, its CRCs included, and their positions.
const REQUEST: [u8; 1] = [0x02];
const REPLIES: [[u8; 6]; 2] = [
    [0x02, 0x20, 0xB4, 0xBD, 0x1C, 0x37],
    [0x02, 0x20, 0x50, 0xA9, 0x78, 0xA3],
];
const POSITIONS: [u64; 2] = [1_883_572, 7_907_664];
/// When requests begin and replies do after that.
const BEGIN: u64 = 30_000;
const PERIOD: u64 = 100_000;
const REPLY: u64 = 7_000;

/// LOW from the first number to the second.
type Low = (u64, u64);

/// The fields of these bytes, one after the other from `begin` on.
fn fields(bytes: &[u8], begin: u64) -> impl Iterator<Item = Low> + '_ {
    bytes.iter().enumerate().flat_map(move |(n, byte)| {
        let cells = u16::from(*byte) << 1 | 0x200;
        let low = (0..10).filter(move |i| cells >> i & 1 == 0);
        low.map(move |i| {
            let at = begin + BIT * (10 * n as u64 + i);
            (at, at + BIT)
        })
    })
}

/// Two exchanges, and what else is LOW in each, from its request on (from the moment before it if negative).
fn decoded_with(name: &str, pulses: &[(i64, u64)]) -> Option<String> {
    let mut low: Vec<Low> = vec![];
    for (n, reply) in (0..).zip(&REPLIES) {
        let begin = BEGIN + n * PERIOD;
        low.extend(fields(&REQUEST, begin));
        low.extend(fields(reply, begin + REPLY));
        low.extend(pulses.iter().map(|(at, width)| {
            let at = begin.checked_add_signed(*at).unwrap();
            (at, at + width)
        }));
    }
    let mut times: Vec<u64> = low.iter().flat_map(|l| [l.0, l.1]).chain([0]).collect();
    times.sort_unstable();
    times.dedup();
    let level = |time| !low.iter().any(|l| (l.0..l.1).contains(&time));
    let rows: Vec<_> = times
        .into_iter()
        .map(|time| (time, [level(time)]))
        .collect();
    let end = BEGIN + 2 * PERIOD;
    decoded(&write(name, &["data"], &rows, end), 10, DECODER)
}

fn file(name: &str, ns: u32) -> Option<String> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/sigrok");
    decoded(&data.join(name), ns, DECODER)
}

/// Catches a decoder of T-format that takes another field or byte order, misses a wrong check sum, or a request of the host.
#[test]
fn sigrok_decodes_every_t_format_exchange() {
    let Some((report, told)) = scenario("t-format", DECODER) else {
        return;
    };
    let exchanges = report[0]["exchanges"].as_array().unwrap();
    assert!(exchanges.len() >= 7 && report[0]["complaints"] == serde_json::json!([]));
    // What the encoder heard and answered, as the decoder should tell it.
    let mut wanted = vec![];
    for exchange in exchanges {
        let bytes = |name: &str| -> Vec<u64> {
            let bytes = exchange[name].as_array().unwrap();
            bytes.iter().map(|b| b.as_u64().unwrap()).collect()
        };
        let (sent, reply) = (bytes("request"), bytes("reply"));
        let id = exchange["id"].as_u64().unwrap();
        let number = |b: &[u64]| b[0] | b[1] << 8 | b[2] << 16;
        wanted.push(format!("ID {id:X} "));
        if sent.len() > 1 {
            wanted.push(format!("ADF {:02X}", sent[1]));
        }
        wanted.push(format!("Reply {:02X}", reply[0]));
        let spoilt = exchange["cause"] == "reply_crc";
        match (id, spoilt) {
            (0, _) => wanted.push(format!("Single-turn {} ", number(&reply[2..]))),
            (1, _) => wanted.push(format!("Multi-turn {} ", number(&reply[2..]))),
            (2, _) => wanted.push(format!("ENID {:02X}", reply[2])),
            (3, false) => {
                wanted.push(format!("Single-turn {} ", number(&reply[2..])));
                wanted.push(format!("Multi-turn {} ", number(&reply[6..])));
            }
            (3, true) => wanted.extend(["Refused".into(), "Refused".into()]),
            (6 | 0xD, _) => wanted.push(format!("EDF {:02X}", reply[2])),
            _ => {}
        }
        let sum = reply.last().unwrap();
        wanted.push(match spoilt {
            true => format!("CRC {sum:02X}, should be"),
            false => format!("CRC {sum:02X}"),
        });
    }
    let mut rest = told.lines();
    for text in &wanted {
        let found = rest.any(|line| line.contains(text.as_str()));
        assert!(found, "{text}: {told}");
    }
    assert_eq!(told.matches("-1: CRC wrong").count(), 1, "{told}");
    assert_without(&told, &["missing", "No re", "Delimiter", "another"]);
}

/// Bytes as a microcontroller logged them, of a TS5700N8401.
#[test]
fn sigrok_decodes_the_t_format_replies_of_a_real_encoder() {
    let Some(told) = file("real.vcd", 10) else {
        return;
    };
    let positions = [
        1_883_572, 7_907_664, 7_267_713, 6_039_153, 3_755_428, 1_522_390, 229_187,
    ];
    assert_eq!(numbers(&told, "Single-turn"), positions, "{told}");
    let sums = ["37", "A3", "28", "29", "F2", "D9", "1D"];
    let told_sums: Vec<_> = (told.lines())
        .filter_map(|line| Some(line.split_once(": CRC ")?.1))
        .collect();
    assert_eq!(told_sums, sums, "{told}");
    assert_without(&told, &COMPLAINTS);
}

/// Catches a decoder that takes a falling edge for a start bit where the core waits for a header.
#[test]
fn sigrok_passes_over_low_pulses_before_a_t_format_header() {
    for (name, pulses) in [("glitch20.vcd", 2), ("glitch250.vcd", 2), ("burst.vcd", 6)] {
        let Some(told) = file(name, 10) else {
            return;
        };
        assert_eq!(numbers(&told, "Single-turn"), POSITIONS, "{name}: {told}");
        for sum in [": CRC 37", ": CRC A3"] {
            assert!(told.contains(sum), "{told}");
        }
        assert_eq!(told.matches(": LOW for ").count(), pulses, "{told}");
        assert_without(&told, &COMPLAINTS);
    }
    // While idle, just before a request, where its driver goes off, and just before the reply.
    for width in [20, 60, 250, 500, 590] {
        for at in [-20_000, -(width as i64) - 100, 4_030, 6_900 - width as i64] {
            let told = decoded_with("pulses", &[(at, width)]).unwrap();
            assert_eq!(
                numbers(&told, "Single-turn"),
                POSITIONS,
                "{width} at {at}: {told}"
            );
            assert_without(&told, &COMPLAINTS);
        }
    }
}

/// Catches a position of a reply that the core would refuse, and a decoder that loses what follows.
#[test]
fn sigrok_refuses_the_t_format_replies_that_the_core_refuses() {
    // In HIGH cells of the reply's data: shorter than half a bit, and a whole one.
    let sf_bit_5 = REPLY as i64 + 10 * BIT as i64 + 6 * BIT as i64;
    for (pulse, why) in [
        ((sf_bit_5 + 20, 60), "short pulse"),
        ((sf_bit_5, BIT), "CRC wrong"),
    ] {
        let Some(told) = decoded_with("refused", &[pulse]) else {
            return;
        };
        assert!(numbers(&told, "Single-turn").is_empty(), "{told}");
        assert_eq!(told.matches(": Refused ").count(), 2, "{told}");
        assert!(told.contains(why), "{told}");
    }
    // The delimiter of SF is LOW.
    let told = decoded_with("delimiter", &[(sf_bit_5 + 3 * BIT as i64, BIT)]).unwrap();
    assert!(numbers(&told, "Single-turn").is_empty(), "{told}");
    assert_eq!(told.matches(": Delimiter is LOW").count(), 2, "{told}");
    // What is too long for noise and no header ends the exchange; the next one is whole.
    let told = decoded_with("long", &[(-15_000, 1_500)]).unwrap();
    assert_eq!(numbers(&told, "Single-turn"), POSITIONS, "{told}");
    assert_eq!(told.matches(": No header").count(), 2, "{told}");
    let told = decoded_with("long_reply", &[(5_000, 1_500)]).unwrap();
    assert!(numbers(&told, "Single-turn").is_empty(), "{told}");
    assert_eq!(told.matches(": No reply").count(), 2, "{told}");
}
