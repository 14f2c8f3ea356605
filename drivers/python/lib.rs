//! The Rust part of the Python package `endat`: a card at a link, or simulated in this process.
//!
//! ```text
//! endat.Card (Python) -> NativeCard -> endat_host::owner, a thread that owns the card -> endat_host::Card
//! ```

mod columns;
mod fault;
mod native;

use pyo3::prelude::*;

/// The module; `python/endat/endat_native.pyi` has its types.
#[pymodule]
mod endat_native {
    #[pymodule_export]
    use super::native::{cause_names, connect, explain_cause, NativeCard};
}
