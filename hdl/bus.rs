//! Fronts: the card behind a bus of a system on chip or of a processor instead of a UART.
//!
//! ```text
//! bus pins <-> front (ApbFront, ...) <-> WordAccess <-> CardCore <-> trigger_i, endat_*, led_*
//! ```
//!
//! A front knows its bus and nothing of registers; [`word_access`] turns one word of it into the bank's bytes and decides which
//! words belong to one moment. See `docs/bus.md`.

pub mod apb;
pub mod word_access;
