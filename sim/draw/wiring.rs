//! Draws the wiring between the ports of a device and encoders: transceivers, resistors, lines.

use super::svg::{text_width, Anchor, Svg};

/// A port of the device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WiredPort {
    /// Name.
    pub signal: String,
    /// Connector and pin.
    pub place: String,
    /// Purpose.
    pub meaning: String,
}

/// The ports of one channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WiredChannel {
    /// Number.
    pub number: usize,
    /// CLOCK; `None` for an encoder without a clock line.
    pub clock: Option<WiredPort>,
    /// DATA to the encoder.
    pub data: WiredPort,
    /// Driver enable.
    pub enable: WiredPort,
    /// DATA from the encoder.
    pub answer: WiredPort,
}

const STYLE: &str = "\
text{font-family:'DejaVu Sans',Verdana,Helvetica,sans-serif;fill:#1f2937}\
.title{font-size:19px;font-weight:bold}.sub{font-size:12.5px;fill:#4b5563}.name{font-size:12px;font-weight:bold}\
.signal{font-size:11.5px}.place{font-size:11.5px;fill:#1d4ed8}.small{font-size:10.5px;fill:#4b5563}path{fill:none}\
.wire{stroke:#1f2937;stroke-width:1.3}.pair{stroke:#b45309;stroke-width:1.5}\
.part{fill:#f8fafc;stroke:#334155;stroke-width:1.3}.resistor{fill:white;stroke:#b45309;stroke-width:1.3}";

/// Width of the drawing, and positions of its columns.
const WIDTH: f64 = 960.0;
const PLACE: f64 = 24.0;
const DEVICE: (f64, f64) = (132.0, 270.0);
const DRIVER: (f64, f64) = (400.0, 520.0);
const ENCODER: (f64, f64) = (740.0, 860.0);
/// Positions of the resistors.
const PULL_DOWN: f64 = 335.0;
const TERMINATION: f64 = 640.0;
/// Distance of two ports, and space around a part.
const ROW: f64 = 34.0;
const ROOM: f64 = 22.0;

/// A box with its name above it.
fn part(svg: &mut Svg, (left, right): (f64, f64), top: f64, bottom: f64, name: &str) {
    svg.rect(left, top, right - left, bottom - top, "part");
    svg.text(
        (left + right) / 2.0,
        top - 6.0,
        Anchor::Middle,
        "name",
        name,
    );
}

/// A port at the right edge of the device, with its place before it, and a wire to a pin of a transceiver.
fn port(svg: &mut Svg, port: &WiredPort, y: f64, pin: &str) {
    svg.text(PLACE, y + 4.0, Anchor::Start, "place", &port.place);
    let name = DEVICE.1 - 8.0 - text_width(&port.signal, 11.5);
    svg.text(name, y + 4.0, Anchor::Start, "signal", &port.signal);
    svg.line(&[(DEVICE.1, y), (DRIVER.0, y)], "wire");
    svg.text(DRIVER.0 + 7.0, y + 4.0, Anchor::Start, "signal", pin);
}

/// A line of a pair, from a pin of a transceiver to one of the encoder.
fn line(svg: &mut Svg, y: f64, pin: &str, name: &str) {
    let at = DRIVER.1 - 7.0 - text_width(pin, 11.5);
    svg.text(at, y + 4.0, Anchor::Start, "signal", pin);
    svg.line(&[(DRIVER.1, y), (ENCODER.0, y)], "pair");
    svg.text(ENCODER.0 + 7.0, y + 4.0, Anchor::Start, "signal", name);
}

/// A vertical resistor on a wire, with its value next to it.
fn resistor(svg: &mut Svg, x: f64, from: f64, to: f64, value: &str) {
    let (middle, half) = ((from + to) / 2.0, 9.0);
    svg.line(&[(x, from), (x, middle - half)], "wire");
    svg.line(&[(x, middle + half), (x, to)], "wire");
    svg.rect(x - 5.0, middle - half, 10.0, 2.0 * half, "resistor");
    svg.text(x + 10.0, middle + 4.0, Anchor::Start, "small", value);
}

fn ground(svg: &mut Svg, x: f64, y: f64) {
    svg.line(&[(x - 7.0, y), (x + 7.0, y)], "wire");
    svg.line(&[(x - 4.0, y + 4.0), (x + 4.0, y + 4.0)], "wire");
}

/// Draws one channel below `top`; returns its end.
fn channel(svg: &mut Svg, channel: &WiredChannel, top: f64) -> f64 {
    let first = top + ROOM;
    let data = first
        + if channel.clock.is_some() {
            2.0 * ROW + 16.0
        } else {
            0.0
        };
    let last = data + 3.5 * ROW;
    let name = format!("device, channel {}", channel.number);
    part(svg, DEVICE, top, last + 6.0, &name);
    part(svg, ENCODER, top, last + 6.0, "encoder");
    if let Some(clock) = &channel.clock {
        part(svg, DRIVER, top, first + ROW + 8.0, "MAX3490");
        port(svg, clock, first, "DI");
        line(svg, first, "Y", "CLOCK+");
        line(svg, first + ROW, "Z", "CLOCK-");
    }
    let [plus, minus] = match &channel.clock {
        Some(_) => ["DATA+", "DATA-"],
        None => ["SD+", "SD-"],
    };
    part(svg, DRIVER, data - ROOM, last + 6.0, "MAX3485");
    port(svg, &channel.data, data, "DI");
    port(svg, &channel.enable, data + ROW, "DE");
    port(svg, &channel.answer, data + 2.5 * ROW, "RO");
    // The pull-down keeps the enable low while the device is not configured; the receiver is always on.
    resistor(svg, PULL_DOWN, data + ROW, data + 1.85 * ROW, "10 k");
    ground(svg, PULL_DOWN, data + 1.85 * ROW);
    svg.text(DRIVER.0 + 7.0, last - 4.0, Anchor::Start, "signal", "/RE");
    svg.line(
        &[
            (DRIVER.0, last - 8.0),
            (PULL_DOWN + 20.0, last - 8.0),
            (PULL_DOWN + 20.0, last),
        ],
        "wire",
    );
    ground(svg, PULL_DOWN + 20.0, last);
    line(svg, data, "A", plus);
    line(svg, data + 1.5 * ROW, "B", minus);
    resistor(svg, TERMINATION, data, data + 1.5 * ROW, "120");
    last + 6.0
}

/// The channels, then the other pins.
pub fn wiring_svg(
    channels: &[WiredChannel],
    others: &[WiredPort],
    title: &str,
    subtitle: &str,
) -> String {
    let mut svg = Svg::new();
    let head = svg.head(title, subtitle);
    let mut y = 92.0;
    for one in channels {
        y = channel(&mut svg, one, y) + 46.0;
    }
    for other in others {
        svg.text(PLACE, y, Anchor::Start, "place", &other.place);
        svg.text(DEVICE.0, y, Anchor::Start, "signal", &other.signal);
        svg.text(DEVICE.1, y, Anchor::Start, "small", &other.meaning);
        y += 19.0;
    }
    let notes = [
        "3.3 V and 100 nF at each transceiver; the grounds of encoder and card are one. Resistors in ohms.",
        "Above about 5 MHz of EnDat clock take faster transceivers: 20 Mbit/s for 8 MHz, 50 Mbit/s for 16 MHz.",
    ];
    y += 10.0;
    for note in notes {
        svg.text(PLACE, y, Anchor::Start, "small", note);
        y += 16.0;
    }
    svg.finish(WIDTH.max(head + PLACE), y + 8.0, title, STYLE)
}
