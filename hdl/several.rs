//! Ports and blocks of which there are as many as a configuration has.

/// `n` of them.
pub(crate) fn each<T: Default>(n: usize) -> Vec<T> {
    (0..n).map(|_| T::default()).collect()
}
