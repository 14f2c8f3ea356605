//! Draws the histogram of the edges of DATA that a card has measured, and the margin that it leaves.

use super::series::ticks;
use super::svg::{text_width, Anchor, Svg};
use std::fmt;

/// What a card's line monitor says.
#[derive(Clone, Debug, PartialEq)]
pub struct Edges {
    /// Edges in each bin, the earliest first; the first and the last one hold what is beyond them, too.
    pub bins: Vec<u32>,
    /// Width of a bin in places (a place is where DATA is looked at).
    pub places_per_bin: u32,
    /// From an edge's expected place to the sample, in places.
    pub half_bit_places: f64,
    /// A place in nanoseconds.
    pub place_ns: f64,
    /// Earliest and latest edge, in places from where it is expected; none if there were no edges.
    pub extremes: Option<(i8, i8)>,
    /// Frames that were counted.
    pub frames: u32,
    /// Those of them that had a cause.
    pub bad_frames: u32,
    /// Pulses that the input filter has removed.
    pub glitches: u32,
    /// How far the line delay has gone from its reference.
    pub drift_ns: f64,
    /// The line delay.
    pub delay_ns: f64,
}

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

impl Edges {
    /// Bin of offset 0.
    fn middle(&self) -> usize {
        self.bins.len() / 2
    }

    /// From the sample to the nearest edge; none if there were no edges.
    pub fn margin_ns(&self) -> Option<f64> {
        let (earliest, latest) = self.extremes?;
        // Offset n is from n to n + 1 places after the expected one.
        let worst = (-f64::from(earliest)).max(f64::from(latest) + 1.0);
        Some((self.half_bit_places - worst).max(0.0) * self.place_ns)
    }

    fn margin_part(&self) -> Option<f64> {
        let bit_ns = 2.0 * self.half_bit_places * self.place_ns;
        self.margin_ns().map(|margin| margin / bit_ns)
    }

    fn told(&self) -> String {
        match (self.extremes, self.margin_ns(), self.margin_part()) {
            (Some((earliest, latest)), Some(ns), Some(part)) => format!(
                "edges from {:.1} to {:.1} ns; margin {ns:.1} ns, {part:.2} of a bit",
                f64::from(earliest) * self.place_ns,
                (f64::from(latest) + 1.0) * self.place_ns
            ),
            _ => "no edges yet".into(),
        }
    }
}

impl fmt::Display for Edges {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} frames, {} of them bad; {} glitches removed",
            self.frames, self.bad_frames, self.glitches
        )?;
        writeln!(
            f,
            "line delay {:.1} ns, drift {:+.1} ns since its reference",
            self.delay_ns, self.drift_ns
        )?;
        writeln!(f, "{}", self.told())?;
        let most = self.bins.iter().copied().max().unwrap_or(0).max(1);
        let used = |i: &usize| self.bins[*i] > 0;
        let (Some(first), Some(last)) = (
            (0..self.bins.len()).find(used),
            (0..self.bins.len()).rev().find(used),
        ) else {
            return Ok(());
        };
        for bin in first..=last {
            let offset = (bin as f64 - self.middle() as f64)
                * f64::from(self.places_per_bin)
                * self.place_ns;
            let bar =
                "#".repeat((f64::from(self.bins[bin]) * 50.0 / f64::from(most)).ceil() as usize);
            writeln!(f, "{offset:>8.1} ns  {:>10}  {bar}", self.bins[bin])?;
        }
        Ok(())
    }
}

/// The histogram as SVG.
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
    // What lies beyond the samples belongs to another bit.
    let half = edges.half_bit_places;
    if x(half) <= right {
        svg.rect(LEFT, TOP, (x(-half) - LEFT).max(0.0), HEIGHT, "far");
        svg.rect(x(half), TOP, right - x(half), HEIGHT, "far");
    }
    // Some room above the highest.
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
        let places = (bin as f64 - edges.middle() as f64) * per_bin;
        let at = x(places);
        svg.line(&[(at, bottom), (at, bottom + 5.0)], "axis");
        let label = format!("{:.0}", places * edges.place_ns);
        svg.text(at, bottom + 18.0, Anchor::Middle, "tick", &label);
    }
    svg.line(&[(LEFT, bottom), (right, bottom)], "axis");
    let width = (right + 48.0)
        .max(head + 24.0)
        .max(text_width(&edges.told(), 11.5) + 60.0);
    svg.finish(width, bottom + 70.0, title, STYLE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edges(extremes: Option<(i8, i8)>) -> Edges {
        let mut bins = vec![0; 32];
        (bins[14], bins[15], bins[16], bins[17]) = (3, 100, 90, 5);
        Edges {
            bins,
            places_per_bin: 1,
            half_bit_places: 8.0,
            place_ns: 10.0,
            extremes,
            frames: 12,
            bad_frames: 1,
            glitches: 2,
            drift_ns: -1.25,
            delay_ns: 150.0,
        }
    }

    #[test]
    fn the_margin_is_from_the_worst_edge_to_the_sample() {
        assert_eq!(edges(Some((-2, 1))).margin_ns(), Some(60.0));
        assert_eq!(edges(Some((-3, 1))).margin_ns(), Some(50.0));
        assert_eq!(edges(Some((0, 4))).margin_ns(), Some(30.0));
        assert_eq!(edges(Some((0, 20))).margin_ns(), Some(0.0));
        assert_eq!(edges(None).margin_ns(), None);
    }

    #[test]
    fn drawing_and_table_show_every_bin_that_has_edges() {
        let edges = edges(Some((-2, 1)));
        let svg = edges_svg(&edges, "channel 0");
        assert_eq!(svg.matches("class=\"edges\"").count(), 4);
        assert!(svg.contains("margin 60.0 ns, 0.38 of a bit"));
        assert!(super::super::is_drawing(&svg));
        let text = edges.to_string();
        assert_eq!(text.lines().count(), 3 + 4);
        assert!(text.contains("   -10.0 ns         100  ####"));
    }
}
