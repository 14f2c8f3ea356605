//! Features of a channel, and its times that are fixed at generation.

use crate::endat::timing;

/// Times of a channel that do not depend on the encoder, fixed at generation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FixedTimes {
    /// Clock period of the frame that measures the propagation delay, in system clock cycles (1..=2047).
    pub calibration_period_cycles: u64,
    /// Data must have been low this long before a frame (tR), in system clock cycles (1..=65535).
    pub ready_low_cycles: u64,
    /// Quiet time after an aborted frame, in microseconds (1..=65535).
    pub abort_us: u64,
    /// From the edge after an answer to the look for additional data, in system clock cycles (1..=255).
    pub separator_cycles: u64,
    /// Clock LOW between an answer and its supplement, in system clock cycles (1..=65535).
    pub park_cycles: u64,
    /// Longest wait for the answer to a command with a parameter, in microseconds (1..=65535).
    pub parameter_timeout_us: u64,
    /// Longest wait within a frame, except for a start bit, in microseconds (a power of two, 1..=32768).
    pub frame_us: u64,
    /// Longest recovery time after a separate frame of a request, in system clock cycles (1..=65535).
    pub own_recovery_limit_cycles: u64,
    /// Shortest recovery time after such a frame, in system clock cycles (0..=8191).
    pub own_recovery_min_cycles: u64,
}

impl FixedTimes {
    /// The protocol's times at a system clock of `system_hz`.
    pub const fn at(system_hz: u64) -> Self {
        Self {
            calibration_period_cycles: timing::period_cycles(timing::CALIBRATION_HZ, system_hz),
            ready_low_cycles: timing::cycles_at_least(timing::READY_LOW_NS, system_hz),
            abort_us: timing::ABORT_US,
            separator_cycles: timing::cycles_at_most(timing::SEPARATOR_NS, system_hz),
            park_cycles: timing::cycles_at_least(timing::PARK_NS, system_hz),
            parameter_timeout_us: timing::PARAMETER_TIMEOUT_US,
            frame_us: timing::FRAME_US,
            own_recovery_limit_cycles: timing::cycles_at_least(
                timing::RECOVERY_MAX_NS + 1_000_000_000 / timing::CALIBRATION_HZ,
                system_hz,
            ),
            own_recovery_min_cycles: timing::recovery_min_cycles(
                timing::SHORT_RECOVERY_MIN_NS,
                system_hz,
            ),
        }
    }
}

/// Features of a channel in addition to triggered positions; a disabled one takes no logic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Features {
    /// All mode commands and additional data.
    pub requests: bool,
    /// Distinguishes stuck lines, absent and late encoders; watchdog, shortest recovery time.
    pub diagnosis: bool,
    /// Continuous clock (000111).
    pub continuous: bool,
    /// Phase from the mean of many edges, from each start bit or from a register; majority of three samples.
    pub alignment: bool,
    /// Measures the margin of the samples (in [`crate::encoder_port`], with alignment).
    pub margin: bool,
    /// Samples DATA on both edges of the system clock.
    pub double_edge: bool,
    /// A second receiver receives each answer, too, and is compared (not with `double_edge`).
    pub second_receiver: bool,
    /// Checks stored bits, so that an upset of a register is detected.
    pub upset_guards: bool,
    /// The previous position replaces one that is withdrawn; without this no position is valid then.
    pub restore: bool,
}

impl Features {
    /// True if the receiver's word keeps the previous position while the encoder may withdraw the new one. The word is free then, except for
    /// additional data, a running clock and a comparison.
    pub const fn swaps(self) -> bool {
        self.restore && !self.requests && !self.continuous && !self.second_receiver
    }

    /// Triggered positions only.
    pub const NONE: Self = Self {
        requests: false,
        diagnosis: false,
        continuous: false,
        alignment: false,
        margin: false,
        double_edge: false,
        second_receiver: false,
        upset_guards: false,
        restore: false,
    };

    /// As in a card: the previous position replaces one that is withdrawn.
    pub const CARD: Self = Self {
        restore: true,
        ..Self::NONE
    };

    /// As in a card with guards.
    pub const GUARDED: Self = Self {
        upset_guards: true,
        ..Self::CARD
    };

    /// All protocol features, as in a card.
    pub const PROTOCOL: Self = Self {
        requests: true,
        diagnosis: true,
        continuous: true,
        ..Self::CARD
    };
}
