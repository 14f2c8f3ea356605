//! Draws the histogram of the edges of DATA, and the eye below it.

use super::edges::Edges;
use super::opening;
use super::series::ticks;
use super::svg::{text_width, Anchor, Svg};

const STYLE: &str = "\
text{font-family:'DejaVu Sans',Verdana,Helvetica,sans-serif;fill:#1f2937}\
.title{font-size:19px;font-weight:bold}.sub{font-size:12.5px;fill:#4b5563}.name{font-size:13px;font-weight:bold}\
.tick{font-size:11px;fill:#374151}.count{font-size:10px;fill:#374151}.mark{font-size:11.5px;fill:#7c2d12}\
path{fill:none}.axis{stroke:#374151;stroke-width:1}.grid{stroke:#e5e7eb;stroke-width:0.8}\
.edges{fill:#2171b5}.beyond{fill:#d55e00}.far{fill:#f3f4f6}.sample{stroke:#d55e00;stroke-width:2}\
.expected{stroke:#111827;stroke-width:1;stroke-dasharray:4 3}.margin{stroke:#c2410c;stroke-width:1.2}";

const LEFT: f64 = 64.0;
const TOP: f64 = 120.0;
const HEIGHT: f64 = 240.0;
const BIN: f64 = 22.0;

/// The histogram and the eye as SVG.
pub fn edges_svg(edges: &Edges, title: &str) -> String {
    let mut svg = Svg::new();
    let bins = edges.bins.len();
    let (right, bottom) = (LEFT + BIN * bins as f64, TOP + HEIGHT);
    let subtitle = format!(
        "{} frames, {} bad, {} glitches removed; line delay {:.1} ns, drift {:+.1} ns",
        edges.frames, edges.bad_frames, edges.glitches, edges.delay_ns, edges.drift_ns
    );
    let head = svg.head(title, &subtitle);
    svg.text(24.0, 76.0, Anchor::Start, "mark", &edges.told());
    let per_bin = f64::from(edges.places_per_bin);
    let x = |places: f64| LEFT + BIN * (edges.middle() as f64 + places / per_bin);
    // Edges beyond the samples belong to other bits.
    let half = edges.half_bit_places;
    if x(half) <= right {
        svg.rect(LEFT, TOP, (x(-half) - LEFT).max(0.0), HEIGHT, "far");
        svg.rect(x(half), TOP, right - x(half), HEIGHT, "far");
    }
    // Some space above the maximum.
    let most = 1.08 * f64::from(edges.bins.iter().copied().max().unwrap_or(0).max(1));
    let (counts, _) = ticks(0.0, most);
    for count in counts {
        let y = bottom - HEIGHT * count / most;
        svg.line(&[(LEFT, y), (right, y)], "grid");
        let label = format!("{count:.0}");
        let before = LEFT - 8.0 - text_width(&label, 11.0);
        svg.text(before, y + 4.0, Anchor::Start, "tick", &label);
    }
    for (bin, count) in edges.bins.iter().enumerate().filter(|(_, c)| **c > 0) {
        let height = (f64::from(*count) / most * HEIGHT).max(1.5);
        let is_end = bin == 0 || bin + 1 == bins;
        let left = LEFT + BIN * bin as f64;
        let class = if is_end { "beyond" } else { "edges" };
        svg.rect(left + 1.5, bottom - height, BIN - 3.0, height, class);
    }
    svg.line(&[(x(0.0), TOP - 6.0), (x(0.0), bottom)], "expected");
    svg.text(
        x(0.0),
        bottom + 52.0,
        Anchor::Middle,
        "name",
        "offset from the expected place, ns",
    );
    svg.text(24.0, TOP - 8.0, Anchor::Start, "name", "edges");
    if x(half) <= right {
        for (side, name) in [(-half, "sample before"), (half, "sample")] {
            svg.line(&[(x(side), TOP - 6.0), (x(side), bottom)], "sample");
            svg.text(x(side), bottom + 34.0, Anchor::Middle, "mark", name);
        }
    }
    for bin in (0..=bins).step_by(4) {
        let places = edges.places_of(bin);
        let at = x(places);
        svg.line(&[(at, bottom), (at, bottom + 5.0)], "axis");
        let label = format!("{:.0}", places * edges.place_ns);
        svg.text(at, bottom + 18.0, Anchor::Middle, "tick", &label);
    }
    svg.line(&[(LEFT, bottom), (right, bottom)], "axis");
    let width = (right + 48.0)
        .max(head + 24.0)
        .max(text_width(&edges.told(), 11.5) + 60.0);
    let below = bottom + 60.0;
    opening::draw(&mut svg, edges, LEFT, right, below);
    let height = below + opening::ABOVE + opening::HEIGHT + 50.0;
    svg.finish(width, height, title, &[STYLE, opening::STYLE].concat())
}

#[cfg(test)]
mod tests {
    use super::super::edges::tests::edges as of;
    use super::super::svg::is_drawing;
    use super::*;

    #[test]
    fn the_drawing_shows_every_bin_that_has_edges_and_the_eye() {
        let edges = of(Some((-2, 1)));
        let svg = edges_svg(&edges, "channel 0");
        assert_eq!(svg.matches("class=\"edges\"").count(), 4);
        assert!(svg.contains("margin 60.0 ns, 0.38 of a bit"));
        assert!(svg.contains("eye: open for 120.0 of 160.0 ns"));
        // Four bins, at both ends of the bit, upwards and downwards.
        assert_eq!(svg.matches("class=\"slope").count(), 4 * 2 * 2);
        let none = edges_svg(&of(None), "channel 0");
        assert!(none.contains("no edges yet") && !none.contains("class=\"open\""));
        assert!(is_drawing(&svg));
    }
}
