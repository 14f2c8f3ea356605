//! Blocks of a card, and the ports of the other protocols at their encoders.

mod ssi;
mod stream;
mod t_format;

// The tests of design/ are made of these, too.
#[path = "../../design/tests/ghdl.rs"]
mod ghdl;
#[path = "../../design/tests/three_way.rs"]
mod three_way;
#[allow(dead_code)] // other crates take the rest
#[path = "../../design/tests/tools.rs"]
mod tools;
