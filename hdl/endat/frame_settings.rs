//! Settings of a frame, a guard: holds the inputs as they were when the frame began.
//!
//! ```text
//! trigger     _____/\__________________________
//! is_at_rest  ~~~~~~~\________________/~~~~~~~
//! inputs      A   B    C                        may change at any time
//! *_now       . A   B                  . C      the frame uses those of the cycle with the trigger
//! ```
//!
//! Command and width decide where a position is in the answer; their parity is stored when the frame begins.

use crate::endat::ports::FrameLimitsOut;
use crate::ports::PortSettingsIn;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Settings of one channel's frames.
#[derive(LogicBlock, Block)]
#[properties("../properties/frame_settings.sv")]
pub struct FrameSettings {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// No frame is under way or begins: the outputs follow the inputs.
    pub is_at_rest: Signal<In, Bit>,
    /// Strobe: a frame begins.
    pub start: Signal<In, Bit>,
    /// Mode command of the frame, from any source.
    pub frame_command: Signal<In, Bits<6>>,
    /// Settings of one channel, as the host has written them.
    #[bundle]
    pub wanted: PortSettingsIn,
    /// Shortest recovery time, in system clock cycles.
    pub recovery_min_cycles: Signal<In, Bits<13>>,
    /// Longest time of a frame, in microseconds; 0 = not watched.
    pub watchdog_us: Signal<In, Bits<12>>,
    /// EnDat clock period of the frame.
    pub period_cycles_now: Signal<Out, Bits<11>>,
    /// Mode command of a triggered frame when it began.
    pub command_now: Signal<Out, Bits<6>>,
    /// Position width of the frame.
    pub position_bits_now: Signal<Out, Bits<6>>,
    /// Input filter of the frame.
    pub filter_cycles_now: Signal<Out, Bits<4>>,
    /// Half a system clock cycle more.
    pub filter_half_now: Signal<Out, Bit>,
    /// Start window of the frame.
    pub start_window_cycles_now: Signal<Out, Bits<6>>,
    /// Time limits for the parts of a frame.
    #[bundle("_now")]
    pub limits: FrameLimitsOut,
    /// Command or width have changed since the frame began.
    pub is_upset: Signal<Out, Bit>,
    /// EnDat clock period; follows the input between two frames, as all settings below do.
    period_held: Reg<Bits<11>>,
    /// Extension of the first low phase, in system clock cycles.
    first_low_extra_held: Reg<Bits<11>>,
    /// Mode command of a triggered frame.
    command_held: Reg<Bits<6>>,
    /// Position width, in bits.
    position_held: Reg<Bits<6>>,
    /// Length of the input filter, in system clock cycles.
    filter_held: Reg<Bits<4>>,
    /// Start window, in system clock cycles.
    start_window_held: Reg<Bits<6>>,
    /// Longest wait for the start bit, in microseconds.
    start_timeout_held: Reg<Bits<12>>,
    /// Longest recovery time, in system clock cycles.
    recovery_limit_held: Reg<Bits<13>>,
    /// Shortest recovery time, in system clock cycles.
    recovery_min_held: Reg<Bits<13>>,
    /// Longest time of a frame, in microseconds; 0 = not watched.
    watchdog_held: Reg<Bits<12>>,
    /// The input filter is half a cycle longer.
    filter_half_held: Reg<Bit>,
    /// Parity of command and width when the frame began.
    parity: Reg<Bit>,
    /// Parity of command and width.
    parity_now: Signal<Local, Bit>,
}

#[kernel]
impl Logic for FrameSettings {
    fn update(&mut self) {
        if self.is_at_rest.val() {
            self.period_held.d.next = self.wanted.period_cycles.val();
            self.first_low_extra_held.d.next = self.wanted.first_low_extra_cycles.val();
            self.command_held.d.next = self.wanted.command.val();
            self.position_held.d.next = self.wanted.position_bits.val();
            self.filter_held.d.next = self.wanted.filter_cycles.val();
            self.start_window_held.d.next = self.wanted.start_window_cycles.val();
            self.start_timeout_held.d.next = self.wanted.start_timeout_us.val();
            self.recovery_limit_held.d.next = self.wanted.recovery_limit_cycles.val();
            self.recovery_min_held.d.next = self.recovery_min_cycles.val();
            self.watchdog_held.d.next = self.watchdog_us.val();
            self.filter_half_held.d.next = self.wanted.filter_half.val();
        }
        self.parity_now.next = self.frame_command.val().xor() ^ self.position_held.q.val().xor();
        if self.start.val() {
            self.parity.d.next = self.parity_now.val();
        }
        self.is_upset.next = self.parity_now.val() ^ self.parity.q.val();

        self.period_cycles_now.next = self.period_held.q.val();
        self.limits.first_low_extra_cycles.next = self.first_low_extra_held.q.val();
        self.command_now.next = self.command_held.q.val();
        self.position_bits_now.next = self.position_held.q.val();
        self.filter_cycles_now.next = self.filter_held.q.val();
        self.start_window_cycles_now.next = self.start_window_held.q.val();
        self.limits.start_timeout_us.next = self.start_timeout_held.q.val();
        self.limits.recovery_limit_cycles.next = self.recovery_limit_held.q.val();
        self.limits.recovery_min_cycles.next = self.recovery_min_held.q.val();
        self.limits.watchdog_us.next = self.watchdog_held.q.val();
        self.filter_half_now.next = self.filter_half_held.q.val();
    }
}
