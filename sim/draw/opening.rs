//! The eye of DATA over two bits, from the histogram of its edges: the part of a bit without edges.

use super::edges::Edges;
use super::svg::{Anchor, Svg};

/// Style classes of this drawing.
pub const STYLE: &str = "\
.rail{stroke:#2171b5;stroke-width:2.4}.slope0{fill:#2171b5;fill-opacity:.06}.slope1{fill:#2171b5;fill-opacity:.13}\
.slope2{fill:#2171b5;fill-opacity:.24}.slope3{fill:#2171b5;fill-opacity:.42}.open{fill:#ecfdf5}";

/// Shades of slopes, from few edges to many.
const SHADES: f64 = 4.0;
/// Width of drawn slopes, as a part of a bit: only their start is measured.
const SLOPE: f64 = 0.05;
/// Height of the eye, and the space above it.
pub const HEIGHT: f64 = 130.0;
pub const ABOVE: f64 = 44.0;

/// Draws it from `left` to `right` below `top`; uses `HEIGHT + ABOVE` and 40 for the axis.
pub fn draw(svg: &mut Svg, edges: &Edges, left: f64, right: f64, top: f64) {
    let bit = 2.0 * edges.half_bit_places;
    let (high, low) = (top + ABOVE, top + ABOVE + HEIGHT);
    // From one bit before the sample to one after it.
    let x = |places: f64| left + (right - left) * (places / bit + 0.5) / 2.0;
    let within = |at: f64| at.clamp(left, right);
    svg.text(
        24.0,
        top + ABOVE - 14.0,
        Anchor::Start,
        "name",
        &told(edges),
    );
    if let Some((earliest, latest)) = edges.extremes {
        let (from, to) = (f64::from(latest) + 1.0, bit + f64::from(earliest));
        if to > from {
            svg.rect(x(from), high, x(to) - x(from), HEIGHT, "open");
        }
    }
    let most = f64::from(edges.bins.iter().copied().max().unwrap_or(0).max(1));
    let slope = SLOPE * bit / 2.0;
    for (bin, count) in edges.bins.iter().enumerate().filter(|(_, c)| **c > 0) {
        // Logarithmic shades, so that few edges are visible, too.
        let part = (1.0 + f64::from(*count)).ln() / (1.0 + most).ln();
        let class = format!("slope{}", (part * (SHADES - 0.01)).floor());
        let from = edges.places_of(bin);
        let to = from + f64::from(edges.places_per_bin);
        for shift in [-bit, 0.0, bit, 2.0 * bit] {
            let [a, b, c, d] = [
                from + shift - slope,
                to + shift - slope,
                to + shift + slope,
                from + shift + slope,
            ]
            .map(|places| within(x(places)));
            if d <= left || a >= right {
                continue;
            }
            for (begin, end) in [(low, high), (high, low)] {
                svg.line(&[(a, begin), (b, begin), (c, end), (d, end)], &class);
            }
        }
    }
    for y in [high, low] {
        svg.line(&[(left, y), (right, y)], "rail");
    }
    svg.text(24.0, high + 4.0, Anchor::Start, "tick", "HIGH");
    svg.text(24.0, low + 4.0, Anchor::Start, "tick", "LOW");
    for (places, name) in [(edges.half_bit_places, "sample"), (0.0, ""), (bit, "")] {
        let class = if name.is_empty() {
            "expected"
        } else {
            "sample"
        };
        svg.line(&[(x(places), high - 6.0), (x(places), low + 6.0)], class);
        svg.text(x(places), low + 36.0, Anchor::Middle, "mark", name);
    }
    svg.text(right + 16.0, low + 22.0, Anchor::Start, "tick", "ns");
    for quarter in -2..=6 {
        let places = f64::from(quarter) * bit / 4.0;
        let at = x(places);
        svg.line(&[(at, low + 6.0), (at, low + 11.0)], "axis");
        let label = format!("{:.0}", places * edges.place_ns);
        svg.text(at, low + 22.0, Anchor::Middle, "tick", &label);
    }
}

fn told(edges: &Edges) -> String {
    let bit_ns = 2.0 * edges.half_bit_places * edges.place_ns;
    match edges.extremes {
        Some((earliest, latest)) => {
            let shut = f64::from(latest) + 1.0 - f64::from(earliest);
            let open_ns = (bit_ns - shut * edges.place_ns).max(0.0);
            format!("eye: open for {open_ns:.1} of {bit_ns:.1} ns; where edges are is measured, how steep they are is not")
        }
        None => "eye: no edges yet".into(),
    }
}
