//! Blocks of a card, and the ports of the other protocols with their encoders.

mod ssi;
mod stream;
mod t_format;

// Shared with the tests of design/.
#[path = "../../design/tests/ghdl.rs"]
mod ghdl;
#[path = "../../design/tests/three_way.rs"]
mod three_way;
#[allow(dead_code)] // other crates use the rest
#[path = "../../design/tests/tools.rs"]
mod tools;
