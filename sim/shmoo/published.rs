//! Published limits of cable and clock.

/// A published limit.
#[derive(Clone, Copy, Debug)]
pub struct Published {
    /// Title with source.
    pub title: &'static str,
    /// Cable in metres and EnDat clock in MHz: corners of a guaranteed area, or measured points.
    pub points: &'static [(f64, f64)],
}

/// Longest cable of a receiver without compensation, in metres: tD = 0.2 us + 0.01 us/m must stay below half a period (HEIDENHAIN PWM 20
/// user's manual).
const fn uncompensated_mhz(cable_m: f64) -> f64 {
    1.0 / (2.0 * (0.2 + 0.01 * cable_m))
}

/// Points of the curve [`uncompensated_mhz`].
const UNCOMPENSATED: [(f64, f64); 32] = {
    let mut points = [(0.0, 0.0); 32];
    let mut i = 0;
    while i < points.len() {
        let cable_m = 5.0 * i as f64;
        points[i] = (cable_m, uncompensated_mhz(cable_m));
        i += 1;
    }
    points
};

/// The limits in a map of cable and clock.
pub const PUBLISHED: [Published; 3] = [
    Published {
        title: "TI AM243x receiver: 8 MHz to 100 m, 16 MHz to 20 m",
        points: &[
            (0.0, 16.0),
            (20.0, 16.0),
            (20.0, 8.0),
            (100.0, 8.0),
            (100.0, 0.0),
        ],
    },
    Published {
        title: "no compensation: tD = T/2 (PWM 20 manual)",
        points: &UNCOMPENSATED,
    },
    Published {
        title: "public VHDL receiver, measured on hardware",
        points: &[(3.5, 2.77), (20.0, 0.961), (30.0, 0.961), (50.0, 0.595)],
    },
];
