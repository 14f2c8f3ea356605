//! The levels that configure a channel, in system clock cycles.

use endat_hdl::endat::timing;
use endat_hdl::protocol::ModeCommand;

/// Configuration of a channel; the fields have the names of its ports.
///
/// Some of them may be fixed in a design, without a port (tR, the abort time). The bench then
/// ignores them, and the caller passes them to the design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChannelSettings {
    /// EnDat clock period; if odd, the HIGH phase is one cycle longer.
    pub period_cycles: u64,
    /// Extension of the first LOW phase beyond half a period.
    pub first_low_extra_cycles: u64,
    /// Mode command.
    pub command: u8,
    /// Width of the position.
    pub position_bits: u32,
    /// DATA must be stable for this long to count; 0 = no filter.
    pub filter_cycles: u64,
    /// Half a cycle more; with `double_edge`.
    pub filter_half: bool,
    /// Source of the phase, see [`endat_hdl::endat::line_delay::mode`].
    pub phase_mode: u64,
    /// The delay in mode `fixed`, in sixteenths of a cycle.
    pub fixed_delay: u64,
    /// Each sample is the majority of itself and its two neighbours.
    pub majority: bool,
    /// Tolerance of the start edge around its expected phase.
    pub start_window_cycles: u64,
    /// Longest wait for the start bit, from the end of the turnaround.
    pub start_timeout_us: u64,
    /// DATA must fall within this time after the frame.
    pub recovery_limit_cycles: u64,
    /// DATA must have been LOW for this time before a frame (tR).
    pub ready_low_cycles: u64,
    /// Quiet time after an aborted frame.
    pub abort_us: u64,
}

impl ChannelSettings {
    /// Settings for an encoder with the default recovery time and tcal up to 50 us.
    pub fn new(system_hz: u64, endat_hz: u64, command: ModeCommand, position_bits: u32) -> Self {
        let period_cycles = timing::period_cycles(endat_hz, system_hz);
        let half = period_cycles / 2;
        let start_time_ns = if endat_hz >= timing::TST_FROM_HZ {
            timing::TST_USUAL_NS
        } else {
            0
        };
        Self {
            period_cycles,
            first_low_extra_cycles: timing::cycles_at_least(start_time_ns, system_hz)
                .saturating_sub(half),
            command: command.code(),
            position_bits,
            filter_cycles: 0,
            filter_half: false,
            phase_mode: 0,
            fixed_delay: 0,
            majority: false,
            start_window_cycles: (period_cycles / 4).clamp(1, 63),
            start_timeout_us: 50,
            recovery_limit_cycles: timing::cycles_at_least(
                timing::RECOVERY_MAX_NS + RECOVERY_MARGIN_NS,
                system_hz,
            ),
            ready_low_cycles: timing::cycles_at_least(timing::READY_LOW_NS, system_hz),
            abort_us: timing::ABORT_US,
        }
    }

    /// Sets the first LOW phase (tST), rounded up to whole cycles.
    pub fn start_time_ns(mut self, ns: u64, system_hz: u64) -> Self {
        self.first_low_extra_cycles =
            timing::cycles_at_least(ns, system_hz).saturating_sub(self.period_cycles / 2);
        self
    }

    /// Every configuration port with its value.
    pub fn ports(&self) -> [(&'static str, u128); 14] {
        [
            ("period_cycles", self.period_cycles),
            ("first_low_extra_cycles", self.first_low_extra_cycles),
            ("command", u64::from(self.command)),
            ("position_bits", u64::from(self.position_bits)),
            ("filter_cycles", self.filter_cycles),
            ("filter_half", u64::from(self.filter_half)),
            ("phase_mode", self.phase_mode),
            ("fixed_delay", self.fixed_delay),
            ("majority", u64::from(self.majority)),
            ("start_window_cycles", self.start_window_cycles),
            ("start_timeout_us", self.start_timeout_us),
            ("recovery_limit_cycles", self.recovery_limit_cycles),
            ("ready_low_cycles", self.ready_low_cycles),
            ("abort_us", self.abort_us),
        ]
        .map(|(name, value)| (name, u128::from(value)))
    }
}

/// Added to the longest recovery time: for cable, transceivers and the encoder's tolerance.
const RECOVERY_MARGIN_NS: u64 = 5_000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_of_the_paper_are_whole_cycles() {
        let s = ChannelSettings::new(100_000_000, 3_125_000, ModeCommand::SendPositionAddInfo, 29);
        assert_eq!((s.period_cycles, s.first_low_extra_cycles), (32, 184));
        assert_eq!((s.ready_low_cycles, s.recovery_limit_cycles), (50, 3500));
        let slow = ChannelSettings::new(100_000_000, 200_000, ModeCommand::SendPosition, 13);
        assert_eq!((slow.period_cycles, slow.first_low_extra_cycles), (500, 0));
    }
}
