use super::*;
use crate::{
    bench::{Bench, ChannelSettings},
    encoder::{area, Defect, EncoderConfig, PositionSource},
    line::LineConfig,
    scenario::{self, RunOptions},
    test_receiver::TestReceiver,
    MS,
};
use endat_hdl::protocol::ModeCommand::SendPosition;

fn drawing(name: &str, frame: usize) -> String {
    let s = scenario::named(name).unwrap();
    let options = RunOptions {
        record: true,
        ..RunOptions::default()
    };
    let (bench, _) = s.run_channel(0, TestReceiver::new(s.system_hz).measuring_apart(), options);
    frame_svg(bench.link(0), frame, s.summary).unwrap()
}

fn overview(name: &str) -> String {
    let s = scenario::named(name).unwrap();
    let options = RunOptions {
        record: true,
        ..RunOptions::default()
    };
    let (bench, _) = s.run_channel(0, TestReceiver::new(s.system_hz).measuring_apart(), options);
    overview_svg(bench.link(0), s.summary).unwrap()
}

/// The texts of a class, in the order of the file.
fn texts(svg: &str, class: &str) -> Vec<String> {
    let begin = format!("<text class=\"{class}\"");
    let lines = svg.lines().filter(|l| l.starts_with(&begin));
    lines
        .map(|l| {
            let text = l.split_once('>').unwrap().1;
            text.strip_suffix("</text>").unwrap().to_owned()
        })
        .collect()
}

#[test]
fn the_real_frame_has_its_bits_fields_and_counts() {
    let svg = drawing("real-1", 1);
    let command = (0..6).rev().map(|i| format!("M{i}"));
    let head = ["S", "F1", "F2"].map(String::from);
    let position = (0..37).map(|i| format!("D{i}"));
    let crc = (0..5).rev().map(|i| format!("C{i}"));
    let bits: Vec<String> = command.chain(head).chain(position).chain(crc).collect();
    assert_eq!(texts(&svg, "bit"), bits);
    assert_eq!(texts(&svg, "mark"), ["1", "21", "66"]);
    assert_eq!(texts(&svg, "count").len(), 66 - 3);
    assert_eq!(
        texts(&svg, "field"),
        [
            "idle",
            "nobody drives",
            "mode command 111000",
            "released",
            "LOW until tcal has passed",
            "S",
            "F1, F2",
            "position 0x7500684EF, 37 bits, LSB first",
            "CRC 0x19",
            "recovery time",
            "idle"
        ]
    );
    let times = texts(&svg, "dim");
    assert!(
        times.contains(&"first LOW 2.047 us".to_owned()),
        "{times:?}"
    );
    assert!(times.contains(&"tm 21.140 us".to_owned()), "{times:?}");
    // Two rows.
    assert_eq!(texts(&svg, "name"), ["CLOCK", "DATA", "CLOCK", "DATA"]);
}

#[test]
fn a_long_cable_shows_both_ends() {
    let svg = drawing("long-cable", 1);
    let rows = [["CLOCK", "CLOCK", "DATA", "DATA"]; 3].concat();
    assert_eq!(texts(&svg, "name"), rows);
    assert_eq!(texts(&svg, "mark").len(), 6);
}

#[test]
fn glitches_and_conflicts_are_seen_and_nothing_else_is() {
    assert!(drawing("glitches", 1).contains("class=\"glitch\""));
    let clean = drawing("paper", 1);
    assert!(!clean.contains("class=\"glitch\""));
    assert!(!clean.contains("class=\"both\"") && !clean.contains("class=\"f-both\""));
}

#[test]
fn bits_that_arrive_wrong_are_marked_and_so_is_the_crc() {
    let wrong = |svg: &str| svg.matches("<rect class=\"f-wrong\"").count();
    let legend = |svg: &str| usize::from(svg.contains("arrives wrong"));
    // One bit of the position, then one of the CRC; each with that of the legend.
    for frame in [3, 5] {
        let svg = drawing("crc-error", frame);
        assert_eq!((wrong(&svg), legend(&svg)), (2, 1));
        let crc = texts(&svg, "field").into_iter();
        let crc: Vec<_> = crc.filter(|t| t.starts_with("CRC")).collect();
        assert!(crc[0].ends_with(": wrong"), "{crc:?}");
    }
    let svg = drawing("crc-error", 4);
    assert_eq!((wrong(&svg), legend(&svg)), (0, 0));
}

#[test]
fn frames_that_end_early_can_be_drawn() {
    let mut s = scenario::named("alarm").unwrap();
    for defect in [
        Defect::NoStartBit,
        Defect::Open,
        Defect::LateFall(crate::MS),
    ] {
        s.channels[0].encoder.defects = vec![(1..=1, defect)];
        let options = RunOptions {
            record: true,
            ..RunOptions::default()
        };
        let (bench, _) =
            s.run_channel(0, TestReceiver::new(s.system_hz).measuring_apart(), options);
        assert!(frame_svg(bench.link(0), 1, "a < b & c")
            .unwrap()
            .contains("a &lt; b &amp; c"));
        assert!(frame_svg(bench.link(0), 99, "").is_none());
    }
}

/// The clock continues after the mark, and so does the count.
#[test]
fn a_long_wait_is_shortened_though_the_clock_goes_on() {
    let svg = drawing("no-answer", 3);
    let counts = texts(&svg, "mark").into_iter().chain(texts(&svg, "count"));
    let counts: Vec<u32> = counts.map(|n| n.parse().unwrap()).collect();
    let jump = counts.windows(2).position(|n| n[1] > n[0] + 1).unwrap();
    assert!((1..=jump as u32 + 1).eq(counts[..=jump].iter().copied()));
    let rest = counts.len() - jump - 1;
    assert!(jump < 20 && (4..10).contains(&rest), "{counts:?}");
    let last = counts.last().unwrap();
    assert!(svg.contains(&format!("no answer, {last} rising edges")));
    let fields = texts(&svg, "field");
    assert_eq!(fields.last().unwrap(), "LOW: no start bit comes");
}

/// Clock lines are vertical, wherever in a period the mark is.
#[test]
fn edges_beside_a_mark_are_upright() {
    let mut s = scenario::named("no-answer").unwrap();
    s.triggers = 2;
    for cable_m in [1.0, 10.0, 20.0, 30.0, 40.0] {
        s.channels[0].line = LineConfig::cable(cable_m);
        let options = RunOptions {
            record: true,
            ..RunOptions::default()
        };
        let (bench, _) =
            s.run_channel(0, TestReceiver::new(s.system_hz).measuring_apart(), options);
        let svg = frame_svg(bench.link(0), 3, "").unwrap();
        let clocks = svg.lines().filter(|l| l.contains("class=\"clock\""));
        let mut edges = 0;
        for clock in clocks {
            let path = clock.split('"').nth(3).unwrap().trim_start_matches('M');
            let points: Vec<_> = path.split(" L").map(|p| p.split_once(' ')).collect();
            for pair in points.windows(2) {
                let [Some(a), Some(b)] = pair else {
                    panic!("{path}")
                };
                assert!(a.0 == b.0 || a.1 == b.1, "{cable_m} m: {a:?} {b:?}");
                edges += usize::from(a.0 == b.0);
            }
        }
        assert!(edges > 40);
    }
}

#[test]
fn an_overview_has_every_frame_with_what_was_sent_and_what_came() {
    let s = scenario::named("no-answer").unwrap();
    let svg = overview("no-answer");
    let frames = texts(&svg, "name");
    assert_eq!(frames.iter().filter(|n| *n == "send position").count(), 7);
    let mut wanted = Vec::new();
    for came in [
        "0x1234567",
        "0x1235678",
        "0x1236789",
        "no start bit",
        "0x12389AB",
        "0x1239ABC",
        "0x123ABCD",
    ] {
        wanted.extend(["111000", came]);
    }
    assert_eq!(texts(&svg, "field"), wanted);
    assert_eq!(texts(&svg, "dim").len(), 7);
    assert_eq!(texts(&svg, "tick")[3], "at 12.620 ms, 3.125 MHz");

    let last = (0b100_011, 0x0D, 0, 0);
    let select = (0b001_110, area::MANUFACTURER_1, 0, 0);
    let bench = exchanged(1.0, &[select, last]);
    let svg = overview_svg(bench.link(0), "").unwrap();
    let wanted = ["001110 A1 0000", "A1 0000", "100011 0D 0000", "0D 800D"];
    assert_eq!(texts(&svg, "field")[2..], wanted);

    let svg = overview("unplugged");
    assert_eq!(
        texts(&svg, "field")[8..11],
        ["no encoder", "111000", "0x12389AB"]
    );
    let times = ["842 us", "2.0 ms", "120 us", "1 us", "697 us"];
    assert_eq!(texts(&svg, "dim")[4..], times);
    let came = ["0x1236789", "111000", "CRC wrong", "111000", "0x12389AB"];
    let svg = overview("crc-error");
    assert_eq!(texts(&svg, "field")[5..10], came);
    assert_eq!(svg.matches("class=\"f-both\"").count(), 2);
    let svg = overview("alarm");
    let came = texts(&svg, "field");
    let came: Vec<_> = came.iter().filter(|t| t.contains('F')).collect();
    assert_eq!(came, ["error F1", "error F2", "F1 and F2"]);

    let nothing = Bench::channel(
        TestReceiver::new(s.system_hz).measuring_apart(),
        s.system_hz,
        &s.channels[0].settings,
        s.link(0),
    );
    assert!(overview_svg(nothing.link(0), "").is_none());
}

#[test]
fn the_drawing_is_the_same_every_time_and_renders() {
    let svg = drawing("paper", 1);
    assert_eq!(svg, drawing("paper", 1));
    let renders = std::process::Command::new("rsvg-convert")
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::null())
        .spawn();
    let Ok(mut child) = renders else {
        assert!(
            std::env::var_os("CI").is_none(),
            "CI is set: rsvg-convert is required"
        );
        eprintln!("skipped: rsvg-convert is not installed");
        return;
    };
    let mut pipe = child.stdin.take().unwrap();
    std::io::Write::write_all(&mut pipe, svg.as_bytes()).unwrap();
    drop(pipe);
    assert!(child.wait().unwrap().success());
}

/// The last of these exchanges (command, 8 bits, 16 bits, expected additional data), after one that measures the delay.
fn exchange(cable_m: f64, exchanges: &[(u8, u8, u16, u8)]) -> String {
    let bench = exchanged(cable_m, exchanges);
    frame_svg(bench.link(0), exchanges.len(), "an exchange").unwrap()
}

/// The bench after these exchanges.
fn exchanged(cable_m: f64, exchanges: &[(u8, u8, u16, u8)]) -> Bench<TestReceiver> {
    const SYSTEM_HZ: u64 = 128_000_000;
    let mut encoder = EncoderConfig::endat22(13).position(PositionSource::Fixed(0x0BAD));
    encoder.tac = 0..=0;
    encoder.values.test_values = 0x12_3456_789A;
    let mut settings = ChannelSettings::new(SYSTEM_HZ, 4_000_000, SendPosition, 13);
    settings.start_timeout_us = 2_000;
    let link = Link::new(LineConfig::cable(cable_m), encoder);
    let mut bench = Bench::channel(TestReceiver::new(SYSTEM_HZ), SYSTEM_HZ, &settings, link);
    bench.record_links();
    let first = [(0b000_111, 0, 0, 0)];
    for (code, address, parameter, infos) in first.iter().chain(exchanges) {
        bench.set("command", (*code).into());
        bench.set("address", (*address).into());
        bench.set("parameter", (*parameter).into());
        bench.set("infos", (*infos).into());
        assert_eq!(bench.frame(5 * MS).expect("a result").cause, 0);
        assert!(bench.run_until_done(MS, |b| b.get("busy") == 0));
    }
    assert_eq!(bench.violations(0), []);
    bench
}

fn names(letter: char, most: u32) -> impl Iterator<Item = String> {
    (0..=most).rev().map(move |i| format!("{letter}{i}"))
}

/// The 8 and 16 bits from a receiver or an encoder.
fn fields() -> impl Iterator<Item = String> {
    names('A', 7).chain(names('P', 15))
}

fn words(text: &str) -> impl Iterator<Item = String> + '_ {
    text.split(' ').map(String::from)
}

#[test]
fn a_parameter_and_its_echo_have_names_and_values() {
    let select = (0b001_110, area::OPERATING_PARAMETERS, 0, 0);
    let svg = exchange(1.0, &[select, (0b011_100, 0x07, 0x5AC3, 0)]);
    let bits = names('M', 5).chain(fields()).chain(words("S"));
    let bits: Vec<String> = bits.chain(fields()).chain(names('C', 4)).collect();
    assert_eq!(texts(&svg, "bit"), bits);
    let crc = crate::frame::Parameter::from_word(0x07_5AC3).crc();
    let wanted = [
        "mode command 011100",
        "address 0x07",
        "parameter 0x5AC3",
        "off",
        "wait",
        "S",
        "address 0x07",
        "parameter 0x5AC3",
        &format!("CRC {crc:#04X}"),
    ];
    assert_eq!(texts(&svg, "field")[2..11], wanted);
    for class in ["f-sent-address", "f-sent-data", "f-address", "f-data"] {
        let count = svg.matches(&format!("<rect class=\"{class}\"")).count();
        assert_eq!(
            count,
            if class.ends_with("data") { 16 } else { 8 },
            "{class}"
        );
    }
    let select = exchange(1.0, &[select]);
    let fields = texts(&select, "field");
    assert!(fields.contains(&"MRS code 0xA7".to_owned()), "{fields:?}");
}

#[test]
fn test_values_are_called_so() {
    let svg = exchange(1.0, &[(0b010_101, 0, 0, 0)]);
    let fields = texts(&svg, "field");
    let wanted = "test values 0x123456789A, 40 bits, LSB first".to_owned();
    assert!(fields.contains(&wanted), "{fields:?}");
}

#[test]
fn additional_data_and_the_supplement_have_names_and_values() {
    let select = [(0b001_001, 0x4C, 0, 0), (0b001_001, 0x5B, 0, 1)];
    let last = (0b001_001, area::OPERATING_PARAMETERS, 0x5AC3, 3);
    for cable_m in [1.0, 100.0] {
        let svg = exchange(cable_m, &[select[0], select[1], last]);
        let ends = if cable_m > 1.0 { 2 } else { 1 };
        let info = || {
            let head = words("0 WRN RM BSY").chain(names('I', 4));
            head.chain(names('P', 15)).chain(names('C', 4))
        };
        let head = names('M', 5).chain(words("S F1 F2"));
        let head = head.chain((0..13).map(|i| format!("D{i}")));
        let answer = head.chain(names('C', 4)).chain(info()).chain(info());
        let bits = answer.chain(words("0 0 0 0 0 0 0 S")).chain(fields());
        let bits: Vec<String> = bits.collect();
        // With both ends a row of the page has bits of one end, then of the other.
        let (mut drawn, mut bits) = (texts(&svg, "bit"), vec![bits; ends].concat());
        if ends > 1 {
            drawn.sort();
            bits.sort();
        }
        assert_eq!(drawn, bits, "{cable_m} m");
        let wanted = [
            "position 0xBAD, 13 bits, LSB first",
            "CRC",
            "additional data 2, code 0x1B",
            "content 0x",
            "CRC",
            "additional data 1", // less room in a row that ends there
            "content 0x0B8A",
            "CRC",
            "pause",
            "7 zeros",
            "S",
            "MRS code 0xA7",
            "parameter 0x5AC3",
            "recovery time",
            "idle",
        ];
        let fields = texts(&svg, "field");
        let mut rest = fields.iter();
        for wanted in wanted {
            let found = rest.any(|text| text.contains(wanted));
            assert!(found, "{wanted}, {fields:?}");
        }
        for (class, count) in [("f-info", 18), ("f-sent-zero", 8), ("f-sent-start", 1)] {
            let rects = svg.matches(&format!("<rect class=\"{class}\"")).count();
            // At the end of a row, a cell at the other end may be in two parts.
            let most = count * ends + ends - 1;
            assert!((count * ends..=most).contains(&rects), "{class}: {rects}");
        }
    }
}
