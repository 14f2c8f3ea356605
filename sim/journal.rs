//! Notes of an encoder about its receiver: all entries, or only the last ones for long runs.

use std::ops::Deref;

/// A list of events in order; dereferences to the slice of the kept entries.
#[derive(Clone, Debug)]
pub struct Journal<T> {
    kept: Vec<T>,
    forgotten: u64,
    most: usize,
}

impl<T> Default for Journal<T> {
    fn default() -> Self {
        Self {
            kept: Vec::new(),
            forgotten: 0,
            most: usize::MAX,
        }
    }
}

impl<T> Journal<T> {
    /// From now on keeps at least the last `most` entries, and at most twice as many.
    pub fn keep(&mut self, most: usize) {
        self.most = most;
        self.forget();
    }

    /// Adds an entry.
    pub fn push(&mut self, entry: T) {
        self.kept.push(entry);
        self.forget();
    }

    /// Number of all entries, including dropped ones.
    pub fn count(&self) -> u64 {
        self.forgotten + self.kept.len() as u64
    }

    /// The last entry.
    pub fn last_mut(&mut self) -> Option<&mut T> {
        self.kept.last_mut()
    }

    fn forget(&mut self) {
        if self.kept.len() > self.most.saturating_mul(2) {
            let old = self.kept.len() - self.most;
            self.kept.drain(..old);
            self.forgotten += old as u64;
        }
    }
}

impl<T> Deref for Journal<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.kept
    }
}

#[cfg(test)]
mod tests {
    use super::Journal;

    #[test]
    fn the_last_entries_are_kept_and_all_are_counted() {
        let mut journal = Journal::default();
        (0..10).for_each(|n| journal.push(n));
        assert_eq!((journal.len(), journal.count()), (10, 10));
        journal.keep(4);
        for n in 10..1_000 {
            journal.push(n);
            assert!((4..=8).contains(&journal.len()));
            assert_eq!(journal.count(), n + 1);
            assert!(journal.windows(2).all(|two| two[0] + 1 == two[1]));
            assert_eq!(journal.last(), Some(&n));
        }
    }
}
