//! Runs a block in a unit test: one clock edge at a time, with a settle loop instead of rust-hdl's threads.

use rust_hdl::prelude::*;

/// Settles the combinational logic.
///
/// # Panics
/// If it does not settle within 50 passes: a combinational loop.
pub fn settle<B: Block>(uut: &mut B) {
    for _ in 0..50 {
        uut.update_all();
        if !uut.has_changed() {
            return;
        }
    }
    panic!("combinational loop: no stable state after 50 passes");
}

/// One rising clock edge; `set_clock` drives the clock input.
pub fn tick<B: Block>(uut: &mut B, set_clock: impl Fn(&mut B, bool)) {
    set_clock(uut, false);
    settle(uut);
    set_clock(uut, true);
    settle(uut);
}
