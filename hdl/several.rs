//! Ports and blocks of which there are as many as a configuration has.

/// `n` of them.
pub(crate) fn each<T: Default>(n: usize) -> Vec<T> {
    (0..n).map(|_| T::default()).collect()
}

/// As many parts, each of its number.
pub(crate) fn numbered<T>(n: usize, of: impl Fn(usize) -> T) -> Vec<T> {
    (0..n).map(of).collect()
}
