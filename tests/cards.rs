//! Cards at work: buses, outputs, streams, services and drivers, with encoders on their channels.

mod bus;
mod bus_card;
mod driver;
#[allow(dead_code)] // other topics take the rest
mod emitted;
mod host;
mod made;
mod own_triggers;
mod presets;
#[allow(dead_code)] // other topics take the rest
mod program;
#[allow(dead_code, unused_imports)]
mod tools;

mod alignment {
    mod independence;
    mod monitor;
}
mod service {
    mod card;
}
mod ssi {
    mod card;
}
mod stream {
    mod infos;
    mod runs;
}
mod t_format {
    mod card;
}

#[allow(dead_code)] // the tests of hosts/ take the rest
#[path = "hosts/desk.rs"]
mod desk;
#[allow(dead_code)] // part of it is for the tests of sim/
#[path = "../sim/tests/service/waits.rs"]
mod service_waits;
#[allow(dead_code)]
#[path = "../sim/tests/stream/rig.rs"]
mod stream_rig;

// The tests of design/ are made of these, too.
#[path = "../design/tests/ghdl.rs"]
mod ghdl;
#[path = "../design/tests/three_way.rs"]
mod three_way;
