//! Draws all frames of a link in order: sent command, answer, and time. Only the order is to scale.

use super::{groups::command_name, LEFT, RIGHT, STYLE};
use crate::{
    bench::Link,
    encoder::{AnswerKind, FrameEnd, FrameLog, Symbol},
    frame::Parameter,
    Time, MS, US,
};
use endat_draw::{text_width, Anchor, Svg};
use std::ops::Range;

/// Width of a frame with the pause before it.
const FRAME_WIDTH: f64 = 172.0;
const PAUSE_WIDTH: f64 = 72.0;
/// Width of a pause without an encoder.
const ABSENT_WIDTH: f64 = 118.0;
/// Frames in a line.
const FRAMES: usize = 6;
const LINE_HEIGHT: f64 = 132.0;
const CLOCK_HEIGHT: f64 = 18.0;
const DATA_HEIGHT: f64 = 24.0;
/// Part of a frame's width in which the receiver sends.
const SENT_PART: f64 = 0.57;
/// Distance of the strokes for clock pulses.
const STROKES: f64 = 4.0;

/// Every frame of a link as SVG; `None` without frames.
pub fn overview_svg(link: &Link, title: &str) -> Option<String> {
    let frames = link.encoder().frames();
    let absent = absent(link);
    let mut before = 0;
    let mut svg = Svg::new();
    let subtitle = "each frame: clock, DATA (blue: the receiver sends, yellow: the encoder answers, red: wrong), what it is, when it begins; between frames the pause";
    let mut right = svg.head(title, subtitle);
    for (line, frames) in frames.chunks(FRAMES).enumerate() {
        let y = 84.0 + LINE_HEIGHT * line as f64;
        for (text, y) in [
            ("CLOCK", y + CLOCK_HEIGHT / 2.0 + 4.0),
            ("DATA", y + 34.0 + DATA_HEIGHT / 2.0 + 4.0),
        ] {
            svg.text(24.0, y, Anchor::Start, "name", text);
        }
        let mut x = LEFT;
        for frame in frames {
            x = pauses(&mut svg, x, y, before..frame.first_fall, &absent);
            draw(&mut svg, x, y, frame);
            x += FRAME_WIDTH;
            before = frame.data_fall.unwrap_or(frame.last_rise);
        }
        right = right.max(x);
    }
    let lines = frames.len().div_ceil(FRAMES);
    let height = 84.0 + LINE_HEIGHT * lines as f64;
    (lines > 0).then(|| svg.finish(right + RIGHT, height, title, STYLE))
}

/// Times without an encoder: unplugged, or without supply.
fn absent(link: &Link) -> Vec<Range<Time>> {
    let outputs = link.trace().map_or(&[][..], |t| &t.encoder);
    let ends = outputs.iter().skip(1).map(|o| o.0).chain([Time::MAX]);
    let spans = outputs.iter().zip(ends);
    let absent = spans.filter(|(o, _)| o.1.symbol == Symbol::Absent);
    absent.map(|(o, end)| o.0..end).collect()
}

/// Draws the pause between two frames, with or without an encoder; returns its end.
fn pauses(svg: &mut Svg, mut x: f64, y: f64, span: Range<Time>, absent: &[Range<Time>]) -> f64 {
    let mut from = span.start.min(span.end);
    for gone in absent {
        let (start, end) = (gone.start.max(from), gone.end.min(span.end));
        if start >= end {
            continue;
        }
        if start > from {
            pause(svg, x, y, PAUSE_WIDTH, start - from);
            x += PAUSE_WIDTH;
        }
        pause(svg, x, y, ABSENT_WIDTH, end - start);
        nobody(svg, x, y + 34.0, ABSENT_WIDTH);
        x += ABSENT_WIDTH;
        from = end;
    }
    if from < span.end {
        pause(svg, x, y, PAUSE_WIDTH, span.end - from);
        x += PAUSE_WIDTH;
    }
    x
}

/// Draws an undriven DATA, without an encoder.
fn nobody(svg: &mut Svg, x: f64, y: f64, width: f64) {
    svg.rect(x, y, width, DATA_HEIGHT, "gap");
    svg.rect(x, y, width, DATA_HEIGHT, "f-nobody");
    let (middle, text) = (x + width / 2.0, "no encoder");
    let half = text_width(text, 11.0) / 2.0 + 3.0;
    let row = y + DATA_HEIGHT / 2.0;
    for (a, b) in [(x, middle - half), (middle + half, x + width)] {
        svg.line(&[(a, row), (b, row)], "nobody");
    }
    svg.text(middle, row + 4.0, Anchor::Middle, "field", text);
}

/// A time with at least three digits.
fn span(time: Time) -> String {
    match time {
        0..MS => format!("{:.0} us", time as f64 / US as f64),
        _ if time < 100 * MS => format!("{:.1} ms", time as f64 / MS as f64),
        _ => format!("{:.0} ms", time as f64 / MS as f64),
    }
}

/// CLOCK HIGH, DATA LOW.
fn pause(svg: &mut Svg, x: f64, y: f64, width: f64, time: Time) {
    let (data, end) = (y + 34.0, x + width);
    svg.line(&[(x, y), (end, y)], "clock");
    idle(svg, x, data, width);
    let (row, a, b) = (data + DATA_HEIGHT + 12.0, x + 3.0, end - 3.0);
    svg.line(&[(a, row), (b, row)], "dimline");
    for (x, side) in [(a, 4.0), (b, -4.0)] {
        svg.line(
            &[(x + side, row - 2.5), (x, row), (x + side, row + 2.5)],
            "dimline",
        );
    }
    svg.text(
        (a + b) / 2.0,
        row + 15.0,
        Anchor::Middle,
        "dim",
        &span(time),
    );
}

/// DATA is LOW.
fn idle(svg: &mut Svg, x: f64, y: f64, width: f64) {
    svg.rect(x, y, width, DATA_HEIGHT, "f-idle");
    let low = y + DATA_HEIGHT - 3.0;
    svg.line(&[(x, low), (x + width, low)], "encoder");
}

fn draw(svg: &mut Svg, x: f64, y: f64, frame: &FrameLog) {
    let (data, bottom, end) = (y + 34.0, y + CLOCK_HEIGHT, x + FRAME_WIDTH);
    let (name, sent, came) = texts(frame);
    // A single pulse, or many.
    let strokes = match frame.command {
        None => 2,
        Some(_) => ((FRAME_WIDTH - 12.0) / STROKES) as usize,
    };
    let mut points = vec![(x, y)];
    for i in 0..2 * (strokes / 2) {
        let x = x + 6.0 + STROKES * i as f64;
        let (from, to) = if i % 2 == 0 { (y, bottom) } else { (bottom, y) };
        points.extend([(x, from), (x, to)]);
    }
    points.push((end, y));
    svg.line(&points, "clock");
    let middle = x + FRAME_WIDTH * SENT_PART;
    let row = data + DATA_HEIGHT / 2.0 + 4.0;
    match frame.command {
        None => idle(svg, x, data, FRAME_WIDTH),
        Some(_) => {
            let answer = match frame.start_edge {
                Some(_) if fault(frame).is_some() => "f-both",
                Some(_) => "f-encoder",
                None => "f-nobody",
            };
            svg.rect(x, data, middle - x, DATA_HEIGHT, "f-receiver");
            svg.rect(middle, data, end - middle, DATA_HEIGHT, answer);
        }
    }
    svg.text((x + middle) / 2.0, row, Anchor::Middle, "field", &sent);
    svg.text((middle + end) / 2.0, row, Anchor::Middle, "field", &came);
    let centre = (x + end) / 2.0;
    svg.text(
        centre,
        data + DATA_HEIGHT + 17.0,
        Anchor::Middle,
        "name",
        &name,
    );
    let begin = frame.first_fall as f64 / MS as f64;
    let mhz = 1e6 / frame.period.max(1) as f64;
    let clock = match frame.command {
        None => String::new(),
        Some(_) => format!(", {mhz:.3} MHz"),
    };
    let when = format!("at {begin:.3} ms{clock}");
    svg.text(
        centre,
        data + DATA_HEIGHT + 34.0,
        Anchor::Middle,
        "tick",
        &when,
    );
}

/// Fault of an answer.
fn fault(f: &FrameLog) -> Option<&'static str> {
    match f.errors {
        _ if f.end == FrameEnd::Lost => Some("cut off"),
        _ if !f.all_crcs_fit() => Some("CRC wrong"),
        (true, Some(false)) => Some("F1 and F2"),
        (true, _) => Some("error F1"),
        (_, Some(false)) => Some("error F2"),
        _ => None,
    }
}

/// Frame, sent command and answer as text.
fn texts(f: &FrameLog) -> (String, String, String) {
    let word = |p: Parameter| format!("{:02X} {:04X}", p.address, p.data);
    let Some(code) = f.command else {
        return ("pulse".into(), String::new(), String::new());
    };
    let sent = match f.parameter {
        Some(p) => format!("{code:06b} {}", word(p)),
        None => format!("{code:06b}"),
    };
    let came = match (f.start_edge, f.kind, f.reply) {
        (None, ..) => "no start bit".into(),
        _ if fault(f).is_some() => fault(f).unwrap_or_default().into(),
        (_, AnswerKind::Parameter, Some(reply)) => word(reply),
        // Wider positions do not fit.
        (_, AnswerKind::Position, _) if f.position < 1 << 36 => format!("{:#X}", f.position),
        (_, AnswerKind::Position, _) => "position".into(),
        _ => String::new(),
    };
    (command_name(code).into(), sent, came)
}
