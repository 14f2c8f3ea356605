//! A histogram whose range grows with what comes, in constant memory.

/// Bins, half of them below 0.
pub const BINS: usize = 32;

/// Counts around 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// Width of a bin; none before the first number that is not 0.
    width: Option<f64>,
    bins: [u64; BINS],
}

impl Default for Histogram {
    fn default() -> Self {
        Self {
            width: None,
            bins: [0; BINS],
        }
    }
}

impl Histogram {
    /// Bins of this width, as long as the numbers fit.
    pub fn of_width(width: f64) -> Self {
        Self {
            width: Some(width).filter(|w| *w > 0.0),
            ..Self::default()
        }
    }

    /// Takes a number.
    pub fn push(&mut self, x: f64) {
        if !x.is_finite() {
            return;
        }
        let half = BINS as f64 / 2.0;
        let width = match self.width {
            Some(width) => width,
            None if x == 0.0 => {
                self.bins[BINS / 2] += 1;
                return;
            }
            None => x.abs() / 8.0,
        };
        self.width = Some(width);
        let place = loop {
            // The middle bin is around 0.
            let place = (x / self.width.unwrap_or(width)).round() + half;
            if (0.0..BINS as f64).contains(&place) {
                break place as usize;
            }
            self.double();
        };
        self.bins[place] += 1;
    }

    /// Two bins become one; what was around 0 stays there.
    fn double(&mut self) {
        let mut bins = [0; BINS];
        let half = BINS as i64 / 2;
        for (n, count) in self.bins.iter().enumerate() {
            // What lies between two new bins is shared; the odd one goes towards 0.
            let place = n as i64 - half;
            let (near, far) = (place / 2, place / 2 + place % 2);
            let at = |place: i64| (place + half).clamp(0, BINS as i64 - 1) as usize;
            bins[at(near)] += count - count / 2;
            bins[at(far)] += count / 2;
        }
        self.bins = bins;
        self.width = self.width.map(|w| 2.0 * w);
    }

    /// Middle and count of the bins, from the first to the last that has something.
    pub fn bins(&self) -> Vec<(f64, u64)> {
        let width = self.width.unwrap_or(0.0);
        let has = |n: &usize| self.bins[*n] > 0;
        let (first, last) = ((0..BINS).find(has), (0..BINS).rev().find(has));
        let all = first.zip(last).map(|(first, last)| first..=last);
        let middle = |n: usize| (n as f64 - BINS as f64 / 2.0) * width;
        all.into_iter()
            .flatten()
            .map(|n| (middle(n), self.bins[n]))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_comes_is_counted_and_in_its_place() {
        let mut all = Histogram::default();
        for x in [0.0, 0.001, -0.001, 1_000.0, -1_000.0, f64::NAN] {
            all.push(x);
        }
        let bins = all.bins();
        assert_eq!(bins.iter().map(|b| b.1).sum::<u64>(), 5);
        let (first, last) = (bins[0], bins[bins.len() - 1]);
        let width = bins[1].0 - bins[0].0;
        assert!((first.0 + 1_000.0).abs() <= width && (last.0 - 1_000.0).abs() <= width);
        let middle = bins.iter().find(|b| b.0 == 0.0).unwrap();
        assert_eq!(middle.1, 3);
        assert_eq!(Histogram::default().bins(), []);
    }
}
