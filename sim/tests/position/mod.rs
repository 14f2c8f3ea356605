//! The position path of one channel, elaborated as for emission, with the encoder and line model.
//!
//! `rig` builds benches; each of the other modules tests one property of the channel.

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
