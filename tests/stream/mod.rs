//! The stream of sample sets: sets, buffer, registers and push, alone and in a card.

mod buffer;
mod card;
mod infos;
mod line;
mod refusals;
pub mod rig;
mod runs;
mod sets;
mod three_ways;
