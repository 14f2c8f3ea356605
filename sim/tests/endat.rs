//! The EnDat port with its encoder: positions, sampling phase, requests and the service.

mod alignment;
mod encoder;
mod position;
mod requests;
mod service;

// Shared with the tests of design/.
#[path = "../../design/tests/ghdl.rs"]
mod ghdl;
#[path = "../../design/tests/three_way.rs"]
mod three_way;
#[allow(dead_code)] // other crates use the rest
#[path = "../../design/tests/tools.rs"]
mod tools;
