//! Optional features of a card in addition to triggered positions.

use super::LIST;
use crate::endat::line_delay::mode;
use crate::endat::line_monitor::LineStart;
use crate::endat::timing::sixteenths;

/// Line delay features of a channel, in addition to following it by a cycle for each frame; disabled features take no logic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LineParts {
    /// Selectable sampling phase: mean of many edges, each start bit, or a register; majority of three samples.
    pub alignment: bool,
    /// Measures margin of the samples, drift and glitches; requires alignment.
    pub margin: bool,
    /// Samples DATA on both edges of the system clock; requires alignment.
    pub double_edge: bool,
    /// Source of the phase after reset; the host can change this and the settings below.
    pub phase: PhaseSource,
    /// Delay with [`PhaseSource::Fixed`], including synchroniser and filter, in nanoseconds.
    pub fixed_delay_ns: u64,
    /// Drift of the tracked delay that raises the alarm, in nanoseconds; 0 = none.
    pub drift_limit_ns: u64,
    /// Samples of each bit: 1, or 3 for their majority; 0 means 1.
    pub samples: u64,
}

/// Source of the sampling phase.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PhaseSource {
    /// The mean of many edges.
    #[default]
    Tracked,
    /// The start bit of each frame.
    Frame,
    /// A register.
    Fixed,
}

impl LineParts {
    /// The line's settings after reset.
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

/// Outputs to logic and to a processor in the same device (`docs/bus.md`); disabled features take no logic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OutputParts {
    /// Cropped position, its strobe, and an OR of selected causes, for each channel.
    pub position: bool,
    /// An interrupt with status and mask.
    pub interrupt: bool,
}

impl OutputParts {
    /// True if an output is enabled.
    pub const fn any(self) -> bool {
        self.position || self.interrupt
    }
}

/// Default time between two forced errors, in milliseconds.
pub const ERROR_TEST_MS: u16 = 1_000;

/// Independent monitoring of a channel, for a safe control (`docs/safety.md`); disabled features take no logic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SafetyParts {
    /// Recovery time measured independently, by a free-running counter.
    pub recovery_counter: bool,
    /// Results for a second controller, over a read-only SPI.
    pub second_interface: bool,
    /// A second receiver on the same samples, compared with the first.
    pub second_receiver: bool,
    /// Checks stored bits, so that an upset of a register is detected.
    pub upset_guards: bool,
    /// For a port without bus: the previous position replaces a withdrawn one. With a bus it always does.
    pub restore: bool,
    /// Period of the forced errors, whose cause is checked, in milliseconds; 0 leaves out schedule and program.
    pub error_test_ms: u16,
}

/// The stream of sample sets (`docs/stream.md`); without a buffer it takes no logic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StreamParts {
    /// Bytes of the buffer, one of [`crate::card::stream::buffer::BUFFER_BYTES`]; 0 = no stream.
    pub fifo_bytes: u64,
    /// State after reset.
    pub start: StreamStart,
    /// Sets include the additional data.
    pub additional_data: bool,
}

/// State of a stream after reset; the host can change it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StreamStart {
    /// Off.
    #[default]
    Off,
    /// Triggers produce sets in the buffer.
    Collect,
    /// Triggers produce sets, which are pushed.
    Push,
}

impl StreamStart {
    /// True if triggers produce sets.
    pub const fn collects(self) -> bool {
        !matches!(self, Self::Off)
    }

    /// True if the UART sends frames.
    pub const fn pushes(self) -> bool {
        matches!(self, Self::Push)
    }
}

/// Features of a channel in addition to triggered positions; disabled features take no logic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ServiceParts {
    /// All mode commands, additional data, counters, alarm.
    pub requests: bool,
    /// Distinguishes stuck lines, absent and late encoders; watchdog, shortest recovery time; requires requests.
    pub diagnosis: bool,
    /// Continuous clock; requires requests.
    pub continuous: bool,
    /// Initialisation of the encoder after reset and after it is plugged in; requires requests.
    pub initialise: bool,
    /// MRS codes of the additional data that are selected in turn after reset, 0 = none; requires requests.
    pub infos: [u8; LIST],
}
