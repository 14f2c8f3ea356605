//! Parts that a card may have besides triggered positions.

use super::LIST;
use crate::endat::line_delay::mode;
use crate::endat::line_monitor::LineStart;
use crate::endat::timing::sixteenths;

/// What a channel does about its line delay besides following it by a cycle for each frame; what is not asked for takes no logic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LineParts {
    /// Phase from the mean over many edges, from each start bit or from a register, at the host's choice; majority of three samples.
    pub alignment: bool,
    /// Margin of the samples, drift and glitches are measured; takes alignment.
    pub margin: bool,
    /// DATA is looked at on both edges of the system clock; takes alignment.
    pub double_edge: bool,
    /// Source of the phase after reset; the host may change this and what follows.
    pub phase: PhaseSource,
    /// Delay with [`PhaseSource::Fixed`], synchroniser and filter included, in nanoseconds.
    pub fixed_delay_ns: u64,
    /// Drift of the tracked delay that gives alarm, in nanoseconds; 0 = none.
    pub drift_limit_ns: u64,
    /// Samples of each bit: 1, or 3 for their majority; 0 stands for 1.
    pub samples: u64,
}

/// Where the phase of the samples comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PhaseSource {
    /// The mean over many edges.
    #[default]
    Tracked,
    /// The start bit of each frame.
    Frame,
    /// A register.
    Fixed,
}

impl LineParts {
    /// What the line's settings are after reset.
    pub fn start(&self, system_hz: u64) -> LineStart {
        LineStart {
            phase_mode: match self.phase {
                PhaseSource::Tracked => mode::TRACKED,
                PhaseSource::Frame => mode::FRAME,
                PhaseSource::Fixed => mode::FIXED,
            },
            fixed_delay: sixteenths(self.fixed_delay_ns, system_hz),
            majority: self.samples == 3,
            drift_limit: sixteenths(self.drift_limit_ns, system_hz),
            offset_limit: 0,
            clears: false,
        }
    }
}

/// Outputs to logic and to a processor in the same device (`docs/bus.md`); what is not asked for takes no logic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OutputParts {
    /// Cropped position, its strobe, and an OR of selected causes, of each channel.
    pub position: bool,
    /// An interrupt with status and mask.
    pub interrupt: bool,
}

impl OutputParts {
    /// Whether there are any.
    pub const fn any(self) -> bool {
        self.position || self.interrupt
    }
}

/// Time between two forced errors, in milliseconds, if nothing else is said.
pub const ERROR_TEST_MS: u16 = 1_000;

/// What watches a channel beside it, for a safe control (`docs/safety.md`); what is not asked for takes no logic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SafetyParts {
    /// Recovery time measured a second time, by a counter that nothing sets back.
    pub recovery_counter: bool,
    /// Results for a second controller, over an SPI that can only be read.
    pub second_interface: bool,
    /// A second receiver on the same samples, compared with the first.
    pub second_receiver: bool,
    /// Stored bits are checked, so that an upset of a register shows.
    pub upset_guards: bool,
    /// A port without bus: a position that is withdrawn gives way to the one before it. With a bus it always does.
    pub restore: bool,
    /// One forced error each so many milliseconds, whose cause is awaited; 0 = no schedule, and no program for it.
    pub error_test_ms: u16,
}

/// The stream of sample sets (`docs/stream.md`); without a buffer there is none, and no logic for it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StreamParts {
    /// Bytes of the buffer, one of [`crate::card::stream::buffer::BUFFER_BYTES`]; 0 = no stream.
    pub fifo_bytes: u64,
    /// What it does after reset.
    pub start: StreamStart,
    /// Sets have the additional data, too.
    pub additional_data: bool,
}

/// What a stream does after reset; the host can change it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StreamStart {
    /// Nothing.
    #[default]
    Off,
    /// Triggers make sets, which wait in the buffer.
    Collect,
    /// Triggers make sets, which are pushed.
    Push,
}

impl StreamStart {
    /// Whether triggers make sets.
    pub const fn collects(self) -> bool {
        !matches!(self, Self::Off)
    }

    /// Whether frames go out over the UART.
    pub const fn pushes(self) -> bool {
        matches!(self, Self::Push)
    }
}

/// What a channel does besides triggered positions; what is not asked for takes no logic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ServiceParts {
    /// All mode commands, additional data, counters, alarm.
    pub requests: bool,
    /// Stuck lines, absent and late encoders told apart, watchdog, shortest recovery time; takes requests.
    pub diagnosis: bool,
    /// Continuous clock; takes requests.
    pub continuous: bool,
    /// Initialisation of the encoder after reset and after it has been plugged in; takes requests.
    pub initialise: bool,
    /// MRS codes of the additional data that are selected in turn from the start on, 0 = none; takes requests.
    pub infos: [u8; LIST],
}
