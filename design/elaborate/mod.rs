//! Elaboration: any rust-hdl block becomes a typed [`Design`].
//!
//! ```text
//! block tree (Probe) -> names and statements of each block -> typed expressions -> processes -> modules -> Design
//!    tree                   scope, index                        expr              plan       build
//! ```
//!
//! Every width equals that of the Rust simulation. A construct without an exact meaning is an
//! [`ElaborateError`] with block, field and remedy.

mod build;
mod design;
mod direct;
pub mod docs;
mod draft;
mod execute;
mod finish;
mod index;
mod loops;
mod names;
mod pieces;
mod plan;
pub mod properties;
mod scope;
mod tree;
mod trim;
mod uses;
mod words;

pub use design::*;
pub use execute::{binary, evaluate, execute};
pub use finish::block_name;
pub(crate) use names::free_name;
pub(crate) use pieces::{row, Piece};
use rust_hdl::prelude::Block;
pub use words::emitted_name;

/// Why a block cannot be elaborated.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("block {block}, {field}: {problem}; {remedy}")]
pub struct ElaborateError {
    /// Instance path of the block.
    pub block: String,
    /// Field or statement in it.
    pub field: String,
    /// Problem.
    pub problem: String,
    /// Remedy.
    pub remedy: String,
}

/// Elaborates a block. `name` becomes the name of the top module; the other modules are named by [`block_name`], and by what
/// differs where a block type has several.
///
/// # Errors
/// For every construct that has no exact meaning as hardware.
pub fn elaborate(top: &dyn Block, name: &str) -> Result<Design, ElaborateError> {
    let tree = tree::read(top, name)?;
    let (mut design, top) = build::build(&tree)?;
    finish::finish(&mut design, top, name, &tree)?;
    loops::separate(&mut design, &tree)?;
    Ok(design)
}
