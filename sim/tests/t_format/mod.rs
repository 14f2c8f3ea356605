//! The asynchronous receiver and its encoder.

mod budget;
mod dsp;
mod faults;
mod glitches;
mod header;
mod lanes;
mod reset;
mod rig;
mod three_ways;
mod upsets;
mod vectors;
