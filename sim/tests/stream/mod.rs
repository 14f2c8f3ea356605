//! The stream of sample sets: sets, buffer, registers and push, as blocks and in a card.

mod buffer;
mod card;
mod line;
mod rig;
mod sets;
mod three_ways;
