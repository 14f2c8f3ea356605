//! All mode commands and additional data of the channel, with the encoder and line model.

mod continuous;
mod diagnosis;
mod every_command;
mod faults;
mod infos;
pub mod lanes;
mod record;
mod rig;
mod unasked;
mod upsets;
