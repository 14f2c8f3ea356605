//! The stream of sample sets: sets, buffer, registers and push, alone and in a card.

mod buffer;
mod rig;
mod sets;
