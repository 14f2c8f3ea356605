//! The EnDat receiver core, described in rust-hdl.
//!
//! ```text
//! host <-> card: front, registers, triggers, stream <-> encoder_port <-+-> endat: Channel, Service, LineMonitor <-> line
//!                                                                      +-> protocols: a port of another one    <-> line
//! ```
//!
//! A protocol is a folder: [`endat`], and those that [`protocols`] lists. All protocols share [`ports`] (bundles of ports), [`input_filter`] and
//! [`snapshot`]. [`encoder_port`] is one encoder of any protocol, [`card`] all of them with their host, [`config`] the configuration in cycles.
//! [`rtl_design`] has the registers, and turns any block into a typed `Design`.

pub mod card;
pub mod config;
pub mod encoder_port;
pub mod endat;
pub mod half_period;
pub mod input_filter;
pub mod lowest_cause;
pub mod ports;
pub use endat_regs::protocol;
pub mod protected_bit;
pub mod protocols;
pub mod regs;
mod replicate;
pub mod snapshot;
#[cfg(test)]
mod testing;
