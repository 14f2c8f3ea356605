//! What the Python package `endat` has of the Rust program: a card at the other end of a link, or simulated in this process.
//!
//! ```text
//! endat.Card (Python) -> NativeCard -> worker's thread, which owns the card -> endat_host
//! ```

mod columns;
mod fault;
mod native;
mod worker;

use pyo3::prelude::*;

/// The module; `python/endat/endat_native.pyi` has its types.
#[pymodule]
mod endat_native {
    #[pymodule_export]
    use super::native::{cause_names, connect, explain_cause, NativeCard};
}
