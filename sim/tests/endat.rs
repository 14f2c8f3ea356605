//! The EnDat port at its encoder: positions, the phase of the samples, requests and the service.

mod alignment;
mod encoder;
mod position;
mod requests;
mod service;

// The tests of design/ are made of these, too.
#[path = "../../design/tests/ghdl.rs"]
mod ghdl;
#[path = "../../design/tests/three_way.rs"]
mod three_way;
#[allow(dead_code)] // other crates take the rest
#[path = "../../design/tests/tools.rs"]
mod tools;
