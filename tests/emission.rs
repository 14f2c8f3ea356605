//! What is emitted, in the hands of simulators, synthesis and provers.

#[allow(dead_code)] // other topics take the rest
mod bus_card;
mod elaborate;
#[allow(dead_code)] // other topics take the rest
mod emitted;
mod engines;
#[allow(dead_code)] // other topics take the rest
mod program;
mod prove;
mod strangers;
#[allow(dead_code, unused_imports)]
mod tools;
mod verilog;
mod vhdl;

#[allow(dead_code)] // the tests of hosts/ take the rest
#[path = "hosts/desk.rs"]
mod desk;

mod ssi {
    mod bench;
    mod channel;
}
mod t_format {
    mod area;
    mod bench;
}

// The tests of design/ are made of these, too.
#[path = "../design/tests/ghdl.rs"]
mod ghdl;
#[path = "../design/tests/stimulus.rs"]
mod stimulus;
#[path = "../design/tests/three_way.rs"]
mod three_way;
use endat_sim::rng;
