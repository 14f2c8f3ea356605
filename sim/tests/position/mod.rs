//! The position path of one channel, as it is elaborated for emission, against the encoder and line model.
//!
//! `rig` builds benches; the other modules each ask one question of the channel.

mod bit_errors;
mod crc;
mod doubt;
mod faults;
mod frame_timing;
mod interrupted;
mod logged;
mod pulses;
mod random;
mod result_fields;
pub mod rig;
mod sweep;
