//! Files and boards that are made of configurations, the pages, the packages, the decoders for sigrok, turns that are counted on, and the rules of the house.

mod boards;
mod bus_card;
mod comparison;
mod constraints;
mod cycle_time;
mod documents;
#[allow(dead_code)] // other topics take the rest
mod emitted;
mod files;
mod house;
mod latency;
mod maps;
mod packages;
mod pages;
#[allow(dead_code)] // other topics take the rest
mod program;
mod shmoo;
mod sigrok;
#[allow(dead_code, unused_imports)]
mod tools;
mod turns;

#[allow(dead_code)] // the tests of hosts/ take the rest
#[path = "hosts/desk.rs"]
mod desk;

mod bus {
    mod board;
    mod cocotb;
}
mod ssi {
    mod page;
    mod virtual_card;
}
mod stream {
    mod refusals;
}
mod t_format {
    mod card {
        mod program;
        mod refusals;
    }
}
