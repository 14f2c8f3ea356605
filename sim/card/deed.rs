//! What a fault that is made does.

use endat_sim::encoder::Defect;
use endat_sim::line::FaultKind;
use endat_sim::Time;

/// What is to be done to a channel.
#[derive(Clone, Debug, PartialEq)]
pub enum Deed {
    Supply(bool),
    Spoil(u64, Defect),
    Slow(Time),
    Status { alarms: u16, warnings: u16 },
    Noise(f64),
    Jitter(Time),
    Line(FaultKind),
    Heal,
}
