//! What a configuration may say, what the program asks and answers about it, and that each remedy is one.

#[path = "keys/bases.rs"]
mod bases;
#[allow(dead_code)] // other topics take the rest
mod bus_card;
mod config;
mod explain;
mod keys;
mod new;
#[allow(dead_code)] // other topics take the rest
mod program;
mod remedies;
#[allow(dead_code, unused_imports)]
mod tools;

mod bus {
    mod configuration;
}
mod ssi {
    mod config;
}
#[allow(dead_code)] // other topics take the rest
mod strangers {
    pub mod configurations;
}
mod t_format {
    mod config;
}
