//! The configuration of a card: a user's values in hertz and nanoseconds, and their conversion to cycles for the blocks.
//!
//! ```text
//! CardSpec (Hz, ns, bits) --CardConfig::resolve--> CardConfig (cycles, checked) --> blocks, explain, files
//! ```
//!
//! Only this module converts. It reports every problem, not only the first; each message names the
//! key, its value, the limit and the remedy.

mod card;
mod channel;
mod limits;
mod parts;
mod range;
mod spoken;

pub(crate) use card::{frame_too_long, microseconds, TooLong};
pub use card::{needed_baud, read_bytes, stream_baud, BAUD_NOTE};
pub(crate) use channel::{check_clock, check_filter, check_tst, is_uneven};
pub(crate) use limits::recovery_most_ns;
pub use limits::{clock_limits, limits, narrowest, Limits};
pub use parts::{
    LineParts, OutputParts, PhaseSource, SafetyParts, ServiceParts, StreamParts, StreamStart,
    ERROR_TEST_MS,
};
pub use range::PositionRange;

use crate::endat::timing::{
    calibration_hz, RECOVERY_MAX_NS, RECOVERY_MIN_NS, TST_FROM_HZ, TST_USUAL_NS,
};
use crate::protocol::ModeCommand;
use crate::protocols::Spoken;
use endat_regs::{CARD_CONFIG, CHANNELS_MAX, CHANNEL_CONFIG, LINE};
use std::fmt;
use std::ops::RangeInclusive;

/// Channels a card may have.
pub const CHANNELS: RangeInclusive<usize> = 1..=CHANNELS_MAX;
/// Codes of additional data that a service selects in turn.
pub const LIST: usize = crate::endat::service::map::word::LIST_MAX as usize;
/// Bits of the EnDat period and of the first low phase, in the blocks.
pub const PERIOD_BITS: u32 = CHANNEL_CONFIG.field("frame", "period_cycles").width;
/// Bits of the drift limit for the alarm, in sixteenths of a cycle, in the blocks.
pub const DRIFT_LIMIT_BITS: u32 = LINE.field("limits", "drift").width;
/// Bits of the input filter length, in the blocks.
pub const FILTER_BITS: u32 = CHANNEL_CONFIG.field("timing", "filter_cycles").width;
/// Bits of the start window, in the blocks.
pub const START_WINDOW_BITS: u32 = CHANNEL_CONFIG.field("timing", "start_window_cycles").width;
/// Bits of the recovery limit, in the blocks.
pub const RECOVERY_LIMIT_BITS: u32 = CHANNEL_CONFIG
    .field("limits", "recovery_limit_cycles")
    .width;
/// Bits of the longest wait for the start bit, in the blocks.
pub const START_TIMEOUT_BITS: u32 = CHANNEL_CONFIG.field("limits", "start_timeout_us").width;
/// Bits of the number of bits that count turns, in the register map.
const MULTI_TURN_BITS: u32 = CHANNEL_CONFIG.field("timing", "multi_turn_bits").width;
/// Fewest cycles by which a first low phase may exceed half a period, in the blocks.
pub const FIRST_LOW_EXTRA_MIN: u64 = 4;
/// Bits of the ready time tR, in the blocks.
pub const READY_LOW_BITS: u32 = 8;
/// Bits of the period of the sampling timer, in the blocks.
pub const TIMER_BITS: u32 = CARD_CONFIG.field("trigger_period", "value").width;
/// Slowest system clock that can count microseconds, in hertz.
pub const SYSTEM_HZ_MIN: u64 = 1_000_000;
/// Fastest system clock for the time stamps and counters, in hertz.
pub const SYSTEM_HZ_MAX: u64 = 250_000_000;
/// Fewest system clock cycles in one bit of the host UART.
pub const UART_BIT_CYCLES_MIN: u64 = 8;
/// Largest deviation of the UART rate from the requested one, in parts per million: half of what 8N1 tolerates.
pub const UART_TOLERANCE_PPM: u64 = 20_000;
/// Bits on the line for one byte (8N1).
pub const UART_BITS_PER_BYTE: u64 = 10;
/// Bytes of a UARTBone read request (command, length, address).
pub const READ_REQUEST_BYTES: u64 = 6;
/// Longest cable whose delay can be measured, in metres: 8 us.
pub const CABLE_M_MAX: u64 = 780;
/// Bits of the propagation delay in whole cycles, in the blocks.
pub const DELAY_BITS: u32 = 11;
/// Constant part of the propagation delay, in ns (PWM 20: tD = 0.2 us + 0.01 us/m).
pub const DELAY_BASE_NS: u64 = 200;
/// Propagation delay of a metre of cable, there and back, worst case, in ns (PWM 20).
pub const DELAY_NS_PER_M: u64 = 10;
/// Cycles between a pin and the logic that evaluates it: synchroniser, longest filter, edge detection.
pub const INPUT_LATENCY_CYCLES: u64 = 32;

/// Request for one channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChannelSpec {
    /// EnDat clock, in hertz.
    pub clock_hz: u64,
    /// EnDat clock of the frames that measure the propagation delay, in hertz; `None` = the default for the cable.
    pub calibration_hz: Option<u64>,
    /// Shortest first low phase tST, in ns; 0 = an ordinary half period.
    pub tst_ns: u64,
    /// Mode command sent with every trigger.
    pub command: ModeCommand,
    /// Position bits of the encoder.
    pub position_bits: u64,
    /// DATA must be stable for this time to count, in ns; 0 = no filter.
    pub filter_ns: u64,
    /// The start edge must come within plus or minus this of its expected phase, in ns.
    pub start_window_ns: u64,
    /// Longest calculation time tcal of the encoder, in ns.
    pub tcal_max_ns: u64,
    /// Shortest recovery time tm of the encoder, in ns.
    pub recovery_min_ns: u64,
    /// Longest recovery time tm of the encoder, in ns.
    pub recovery_max_ns: u64,
    /// Longest cable, in metres.
    pub cable_m: u64,
    /// Protocol of the channel. Each protocol uses those of the other numbers that its encoders have; T-format uses only `filter_ns`.
    pub spoken: Spoken,
    /// Triggers that the channel takes. If no channel sets it, every channel takes all triggers, without selection logic.
    pub trigger: Option<OwnTrigger>,
    /// Range of the position, for the host; `None` = unknown, unless the name plate of an EnDat encoder has it.
    pub range: Option<PositionRange>,
}

/// Request for a card.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CardSpec {
    /// System clock of the core, in hertz.
    pub system_hz: u64,
    /// The encoder ports.
    pub channels: Vec<ChannelSpec>,
    /// Sampling rate of the timer trigger, in hertz.
    pub sample_hz: u64,
    /// Triggers enabled after reset.
    pub sources: TriggerSources,
    /// Rate of the host UART, in bit/s.
    pub baud: u64,
    /// Rate at which the host reads the results of all channels, in hertz.
    pub read_hz: u64,
    /// Features of each channel in addition to positions.
    pub service: ServiceParts,
    /// Line delay features of each channel.
    pub line: LineParts,
    /// The stream of sample sets.
    pub stream: StreamParts,
    /// Outputs to logic in the same device.
    pub outputs: OutputParts,
    /// Independent monitoring of each channel.
    pub safety: SafetyParts,
}

/// A request with missing values, which could not be read; values that depend on them are not checked.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CardDraft {
    /// System clock of the core, in hertz.
    pub system_hz: Option<u64>,
    /// The encoder ports.
    pub channels: Option<Vec<Option<ChannelSpec>>>,
    /// Sampling rate of the timer trigger, in hertz.
    pub sample_hz: Option<u64>,
    /// Triggers enabled after reset.
    pub sources: Option<TriggerSources>,
    /// Rate of the host UART, in bit/s.
    pub baud: Option<u64>,
    /// The fastest rate that the board passes on to the host, in bit/s.
    pub baud_max: Option<u64>,
    /// Rate at which the host reads the results of all channels, in hertz.
    pub read_hz: Option<u64>,
    /// Features of each channel in addition to positions.
    pub service: ServiceParts,
    /// Line delay features of each channel.
    pub line: LineParts,
    /// The stream of sample sets.
    pub stream: StreamParts,
    /// Outputs to logic in the same device.
    pub outputs: OutputParts,
    /// Independent monitoring of each channel.
    pub safety: SafetyParts,
    /// See [`CardConfig::initial_values`].
    pub initial_values: bool,
    /// The host uses another bus than a UART; the UART values are unused.
    pub without_uart: bool,
}

impl From<&CardSpec> for CardDraft {
    fn from(request: &CardSpec) -> Self {
        Self {
            system_hz: Some(request.system_hz),
            channels: Some(request.channels.iter().cloned().map(Some).collect()),
            sample_hz: Some(request.sample_hz),
            sources: Some(request.sources),
            baud: Some(request.baud),
            baud_max: None,
            read_hz: Some(request.read_hz),
            service: request.service,
            line: request.line,
            stream: request.stream,
            outputs: request.outputs,
            safety: request.safety,
            initial_values: true,
            without_uart: false,
        }
    }
}

/// Trigger sources enabled after reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TriggerSources {
    /// Rising edge of the trigger pin.
    pub pin: bool,
    /// Periodic timer.
    pub timer: bool,
    /// Strobe written by the host.
    pub register: bool,
}

/// Triggers that a channel takes after reset; the host can change it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OwnTrigger {
    /// The channel takes triggers.
    pub enabled: bool,
    /// The channel takes one of `divider` triggers, starting with the first one after a change of these settings.
    pub divider: u64,
    /// Sources that the channel accepts, among those enabled in the card.
    pub sources: TriggerSources,
}

impl Default for OwnTrigger {
    fn default() -> Self {
        Self {
            enabled: true,
            divider: 1,
            sources: TriggerSources {
                pin: true,
                timer: true,
                register: true,
            },
        }
    }
}

impl OwnTrigger {
    /// Sources that the channel ignores: bit 0 pin, bit 1 timer, bit 2 register.
    pub const fn ignored(&self) -> u64 {
        !self.sources.pin as u64
            | (!self.sources.timer as u64) << 1
            | (!self.sources.register as u64) << 2
    }

    /// Triggers to skip after each accepted one.
    pub const fn skip(&self) -> u64 {
        self.divider.saturating_sub(1)
    }

    /// Number of timer periods for each trigger of the channel; `None` if it ignores the timer.
    pub fn timer_divider(&self) -> Option<u64> {
        (self.enabled && self.sources.timer).then_some(self.divider)
    }
}

/// Part of the configuration with a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// `[clock]`
    Clock,
    /// The channel with this index; with the key `channel` the number of channels.
    Channel(usize),
    /// `[trigger]`
    Trigger,
    /// `[link]`
    Link,
    /// `[stream]`
    Stream,
    /// `[line]`
    Line,
}

/// One problem of a request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Section.
    pub section: Section,
    /// Key, with the name of the field in the request.
    pub key: &'static str,
    /// The given value.
    pub value: String,
    /// Problem, limit and remedy.
    pub text: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}: {}", self.key, self.value, self.text)
    }
}

/// One channel in the units of the blocks; each field fits its configuration input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChannelConfig {
    /// EnDat clock period; if odd, the high phase is longer.
    pub period_cycles: u64,
    /// First low phase minus half a period (tST).
    pub first_low_extra_cycles: u64,
    /// Mode command.
    pub command: ModeCommand,
    /// Position bits.
    pub position_bits: u32,
    /// Input filter; 0 = off.
    pub filter_cycles: u64,
    /// Half a cycle more; with `double_edge`.
    pub filter_half: bool,
    /// Half width of the start window.
    pub start_window_cycles: u64,
    /// Longest wait for the start bit from the end of the turnaround, also at the calibration clock, in microseconds.
    pub start_timeout_us: u64,
    /// DATA must have fallen by this time, counted from the last rising clock edge at the receiver.
    pub recovery_limit_cycles: u64,
    /// DATA must be low for this time before the next frame (tR).
    pub ready_low_cycles: u64,
    /// Quiet time after an aborted transfer, in microseconds.
    pub abort_us: u64,
    /// Protocol of the channel. In T-format `period_cycles` is a bit, `start_timeout_us` the longest pause before the reply, and of the
    /// other numbers only `filter_cycles` is used. SSI does not use `command`, `start_window_cycles` and the three times from `start_timeout_us` on, except
    /// the recovery time.
    pub spoken: Spoken,
    /// The request, for reports.
    pub spec: ChannelSpec,
}

/// A checked card in the units of the blocks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CardConfig {
    /// System clock, in hertz.
    pub system_hz: u64,
    /// The encoder ports.
    pub channels: Vec<ChannelConfig>,
    /// Period of the sampling timer.
    pub sample_period_cycles: u64,
    /// Requested sampling rate, in hertz.
    pub sample_hz: u64,
    /// Triggers enabled after reset.
    pub sources: TriggerSources,
    /// System clock cycles in a UART bit.
    pub uart_bit_cycles: u64,
    /// Requested UART rate, in bit/s.
    pub baud: u64,
    /// Rate at which the host reads, in hertz.
    pub read_hz: u64,
    /// Features of each channel in addition to positions.
    pub service: ServiceParts,
    /// Line delay features of each channel.
    pub line: LineParts,
    /// The stream of sample sets.
    pub stream: StreamParts,
    /// Outputs to logic in the same device.
    pub outputs: OutputParts,
    /// Independent monitoring of each channel.
    pub safety: SafetyParts,
    /// The device configuration sets registers and RAM to their start values. Otherwise a reset does, and RAM is cleared after it.
    pub initial_values: bool,
    /// First 48 bits of the SHA-256 of the canonical configuration (0 until a generator sets it).
    pub hash: u64,
}

/// Lengths of one position frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameTime {
    /// First low phase.
    pub first_low_cycles: u64,
    /// Complete pulses before the start bit (`N_pre`) with the longest tcal.
    pub lead_pulses: u64,
    /// Bits from the start bit to the last CRC bit (`L`).
    pub answer_bits: u64,
    /// Rising edges that the encoder sees (`P = N_pre + L + 1`).
    pub pulses: u64,
    /// First falling to last rising clock edge.
    pub frame_cycles: u64,
}

impl ChannelSpec {
    /// A channel with this protocol and default values.
    pub const fn speaking(spoken: Spoken) -> Self {
        Self {
            clock_hz: 0,
            calibration_hz: None,
            tst_ns: 0,
            command: ModeCommand::SendPosition,
            position_bits: 0,
            filter_ns: 0,
            start_window_ns: 0,
            tcal_max_ns: 0,
            recovery_min_ns: RECOVERY_MIN_NS,
            recovery_max_ns: RECOVERY_MAX_NS,
            cable_m: 0,
            spoken,
            trigger: None,
            range: None,
        }
    }

    /// Longest propagation delay tD of the line, in ns (PWM 20).
    pub const fn delay_max_ns(&self) -> u64 {
        delay_max_ns(self.cable_m)
    }

    /// EnDat clock of the frames that measure the propagation delay, in hertz.
    pub const fn calibration_hz(&self) -> u64 {
        match self.calibration_hz {
            Some(hz) => hz,
            None => calibration_hz(self.delay_max_ns()),
        }
    }

    /// The start time tST that receivers use at a clock rate: none below 1 MHz.
    pub const fn usual_tst_ns(clock_hz: u64) -> u64 {
        if clock_hz >= TST_FROM_HZ {
            TST_USUAL_NS
        } else {
            0
        }
    }
}

/// Longest propagation delay tD of a cable, in ns (PWM 20).
const fn delay_max_ns(cable_m: u64) -> u64 {
    DELAY_BASE_NS + DELAY_NS_PER_M * cable_m
}

/// Longest input filter with `places` samples of DATA in a cycle, in samples.
pub const fn filter_longest(places: u64) -> u64 {
    places * (max_of(FILTER_BITS) + 1) - 1
}

/// Largest number in `bits` bits.
pub(crate) const fn max_of(bits: u32) -> u64 {
    (1 << bits) - 1
}

/// Collects the problems of one section.
pub(crate) struct Check<'a> {
    section: Section,
    problems: &'a mut Vec<Problem>,
}

impl<'a> Check<'a> {
    pub(crate) fn new(section: Section, problems: &'a mut Vec<Problem>) -> Self {
        Self { section, problems }
    }

    pub(crate) fn fail(&mut self, key: &'static str, value: impl fmt::Display, text: String) {
        self.problems.push(Problem {
            section: self.section,
            key,
            value: value.to_string(),
            text,
        });
    }

    /// True if `value` is within `limits`; otherwise reports the problem.
    pub(crate) fn within(&mut self, key: &'static str, value: u64, limits: &Limits) -> bool {
        let inside = limits.contains(value);
        if !inside {
            self.fail(key, value, limits.to_string());
        }
        inside
    }
}

#[cfg(test)]
mod tests;
