//! Vectors of ports and blocks whose number depends on the configuration.

/// `n` default parts.
pub(crate) fn each<T: Default>(n: usize) -> Vec<T> {
    (0..n).map(|_| T::default()).collect()
}

/// `n` parts, each made from its number.
pub(crate) fn numbered<T>(n: usize, of: impl Fn(usize) -> T) -> Vec<T> {
    (0..n).map(of).collect()
}
