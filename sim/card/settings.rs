//! What a virtual card is made of.

pub use endat_emit::encoders::CABLE_M;

/// An open plug, as `--encoder` calls it.
pub const NO_DEVICE: &str = "none";

/// What a virtual card is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct VirtualConfig {
    /// Device at each port, `none` for an open plug; one for all, or one for each. Empty: what the configuration names.
    pub encoders: Vec<String>,
    /// Cable to each encoder in metres.
    pub cable_m: f64,
    /// DATA edges come up to so much earlier or later, in nanoseconds.
    pub jitter_ns: u64,
    /// How fast shafts turn, in turns per second (linear encoders: hundredths of a metre per second).
    pub speed: f64,
    /// Seed of everything random.
    pub seed: u64,
    /// Sets of the stream are made by arithmetic instead of the core: one for each trigger of the timer, as fast as the host takes them,
    /// or in real time behind a port.
    pub makes_sets: bool,
}

impl Default for VirtualConfig {
    fn default() -> Self {
        Self {
            encoders: Vec::new(),
            cable_m: CABLE_M,
            jitter_ns: 0,
            speed: 0.25,
            seed: 1,
            makes_sets: false,
        }
    }
}
