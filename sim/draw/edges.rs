//! The histogram of DATA edges measured by a card, and the timing margin.

use std::fmt;

/// Data of a card's line monitor.
#[derive(Clone, Debug, PartialEq)]
pub struct Edges {
    /// Edges in each bin, the earliest first; the first and the last bin include all edges beyond.
    pub bins: Vec<u32>,
    /// Width of a bin in places (a place is one sampling time of DATA).
    pub places_per_bin: u32,
    /// From an edge's expected place to the sample, in places.
    pub half_bit_places: f64,
    /// Duration of a place in nanoseconds.
    pub place_ns: f64,
    /// Earliest and latest edge, in places from the expected place; `None` without edges.
    pub extremes: Option<(i8, i8)>,
    /// Frames that were counted.
    pub frames: u32,
    /// Frames among them with a cause.
    pub bad_frames: u32,
    /// Pulses that the input filter has removed.
    pub glitches: u32,
    /// Drift of the line delay from its reference.
    pub drift_ns: f64,
    /// The line delay.
    pub delay_ns: f64,
}

impl Edges {
    /// Bin of offset 0.
    pub(super) fn middle(&self) -> usize {
        self.bins.len() / 2
    }

    /// Start of a bin, in places from the expected place of an edge.
    pub(super) fn places_of(&self, bin: usize) -> f64 {
        (bin as f64 - self.middle() as f64) * f64::from(self.places_per_bin)
    }

    /// Time from the sample to the nearest edge; `None` without edges.
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

    pub(super) fn told(&self) -> String {
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
            let offset = self.places_of(bin) * self.place_ns;
            let bar =
                "#".repeat((f64::from(self.bins[bin]) * 50.0 / f64::from(most)).ceil() as usize);
            writeln!(f, "{offset:>8.1} ns  {:>10}  {bar}", self.bins[bin])?;
        }
        Ok(())
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub fn edges(extremes: Option<(i8, i8)>) -> Edges {
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
    fn the_table_shows_every_bin_that_has_edges() {
        let text = edges(Some((-2, 1))).to_string();
        assert_eq!(text.lines().count(), 3 + 4);
        assert!(text.contains("   -10.0 ns         100  ####"));
    }
}
