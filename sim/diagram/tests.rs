use super::*;
use crate::{
    encoder::Defect,
    scenario::{self, RunOptions},
    test_receiver::TestReceiver,
};

fn drawing(name: &str, frame: usize) -> String {
    let s = scenario::named(name).unwrap();
    let options = RunOptions {
        record: true,
        ..RunOptions::default()
    };
    let (bench, _) = s.run_channel(0, TestReceiver::new(s.system_hz), options);
    frame_svg(bench.link(0), frame, s.summary).unwrap()
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
    assert_eq!(texts(&svg, "name"), ["CLOCK", "DATA"]);
}

#[test]
fn a_long_cable_shows_both_ends() {
    let svg = drawing("long-cable", 1);
    assert_eq!(texts(&svg, "name"), ["CLOCK", "CLOCK", "DATA", "DATA"]);
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
        let (bench, _) = s.run_channel(0, TestReceiver::new(s.system_hz), options);
        assert!(frame_svg(bench.link(0), 1, "a < b & c")
            .unwrap()
            .contains("a &lt; b &amp; c"));
        assert!(frame_svg(bench.link(0), 99, "").is_none());
    }
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
