//! A small seeded random generator: the bench must give the same run for the same seed on every machine.

/// SplitMix64: one 64-bit counter and a mixing function. Good enough for jitter, not for cryptography.
#[derive(Clone, Debug)]
pub struct Rng(u64);

impl Rng {
    /// A generator with this seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 random bits.
    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number in `low..=high`, with (nearly) uniform probability; `low` if the range is empty.
    pub fn in_range(&mut self, low: u64, high: u64) -> u64 {
        let span = high.saturating_sub(low) as u128 + 1;
        low + ((self.next_u64() as u128 * span) >> 64) as u64
    }

    /// A number in `-peak..=peak`.
    pub fn around_zero(&mut self, peak: u64) -> i64 {
        self.in_range(0, 2 * peak) as i64 - peak as i64
    }

    /// An approximately normal number with standard deviation `rms` (sum of twelve uniform ones), cut off at `peak`.
    pub fn normal(&mut self, rms: u64, peak: u64) -> i64 {
        let sum: u64 = (0..12).map(|_| self.next_u64() >> 32).sum();
        let sigmas = sum as f64 / 2f64.powi(32) - 6.0;
        ((sigmas * rms as f64).round() as i64).clamp(-(peak as i64), peak as i64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_include_both_ends_and_nothing_else() {
        let mut rng = Rng::new(1);
        let seen: std::collections::BTreeSet<u64> = (0..1000).map(|_| rng.in_range(3, 7)).collect();
        assert_eq!(seen.into_iter().collect::<Vec<_>>(), [3, 4, 5, 6, 7]);
        assert_eq!(rng.in_range(5, 5), 5);
    }

    #[test]
    fn normal_numbers_have_their_deviation_and_stay_under_the_peak() {
        let mut rng = Rng::new(2);
        let n: Vec<i64> = (0..4000).map(|_| rng.normal(1000, 2500)).collect();
        let rms = (n.iter().map(|x| (x * x) as f64).sum::<f64>() / n.len() as f64).sqrt();
        assert!((900.0..1050.0).contains(&rms), "{rms}");
        assert!(n.iter().all(|x| x.abs() <= 2500));
    }
}
