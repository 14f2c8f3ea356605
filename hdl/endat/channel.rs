//! Channel: one encoder port, from the trigger to the snapshot.
//!
//! ```text
//! trigger -> Transaction -> ClockGen -> endat_clk
//!                |    \---> CommandSender -> data_o, data_oe
//!                |              data_i -> InputFilter
//!                |                             |
//!                +------ LineDelay -> Receiver -> Snapshot -> position, cause, ...
//! ```
//!
//! With requests the channel sends all mode commands: a request is attached to the next triggered position frame (EnDat 2.2), or
//! has a separate frame. The block AddInfo records the additional data that follow each position.
//!
//! The first frame after reset, after an aborted frame and after `calibrate` runs at the calibration clock and
//! measures the propagation delay; all others run at the configured clock. Settings are frozen while `busy` and in the cycle of a trigger.
//! With guards a frame keeps a copy of them, and a setting that changes during the frame makes its position invalid.

mod kernel;

use crate::endat::add_info::AddInfo;
use crate::endat::clock_gen::ClockGen;
use crate::endat::command_sender::CommandSender;
use crate::endat::command_shape::CommandShape;
pub use crate::endat::features::{Features, FixedTimes};
use crate::endat::frame_settings::FrameSettings;
use crate::endat::line_delay::{self, LineDelay};
use crate::endat::ports::*;
use crate::endat::receiver::Receiver;
use crate::endat::second_receiver::SecondReceiver;
use crate::endat::transaction::{cause, Transaction};
use crate::input_filter::InputFilter;
use crate::ports::*;
use crate::protected_bit::ProtectedBit;
use crate::protocol::{PARAMETER_BITS, TEST_VALUE_BITS};
use crate::replicate::numbered;
use crate::snapshot::{Snapshot, Withdrawal};
use rtl_design::reg::Reg;
use rtl_design::Block;
use rust_hdl::prelude::*;

/// From the cycle with the trigger strobe to the first cycle with the EnDat clock low, at every width and rate.
pub const TRIGGER_TO_FIRST_FALL_CYCLES: u64 = 3;
/// From the cycle in which the bit after the last CRC bit is sampled to the one with the result strobe, at every width and rate; one more
/// if additional data follow.
pub const TAIL_SAMPLE_TO_RESULT_CYCLES: u64 = 3;
/// From the time in `first_fall_timestamp` to the first cycle with the EnDat clock low.
pub const TIMESTAMP_TO_FIRST_FALL_CYCLES: u64 = 2;
/// Delay that the registers at both pins and the synchroniser add to `delay_cycles`; the filter adds its length.
pub const DELAY_OFFSET_CYCLES: u64 = 4;

/// Frames that measure the delay, of a channel with alignment.
pub const CALIBRATION_FRAMES: usize = 4;

/// One EnDat port.
#[derive(LogicBlock, Block)]
#[properties("../properties/channel.sv")]
pub struct Channel {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// Free-running time in system clock cycles.
    pub timestamp: Signal<In, Bits<32>>,
    /// One-cycle strobe: read a position.
    pub trigger: Signal<In, Bit>,
    /// Strobe: measure the propagation delay again with the next frame.
    pub calibrate: Signal<In, Bit>,
    /// Settings of one channel, as the host has written them.
    #[bundle]
    pub settings_in: PortSettingsIn,
    /// Requests of the service to its channel.
    #[bundle]
    pub orders: ServiceOrdersIn,
    /// Source of the phase: 0 mean over many edges, 1 fixed delay, 2 start bit of each frame.
    pub phase_mode: Signal<In, Bits<2>>,
    /// Delay in mode `fixed`, in sixteenths of a system clock cycle.
    pub fixed_delay: Signal<In, Bits<15>>,
    /// Each sample is the majority of itself and its two neighbours.
    pub majority: Signal<In, Bit>,
    /// The line of one encoder.
    #[bundle]
    pub line: LineOut,
    /// Result of a trigger.
    #[bundle]
    pub result: FrameResultOut,
    /// Recovery time tm of the last frame, in system clock cycles.
    pub recovery_cycles: Signal<Out, Bits<13>>,
    /// Tracked propagation delay tD, including synchroniser and filter, in system clock cycles.
    pub delay_cycles: Signal<Out, Bits<11>>,
    /// The delay as the mean of many edges, in sixteenths of a system clock cycle.
    pub phase: Signal<Out, Bits<15>>,
    /// Strobe: an edge of the answer has been measured.
    pub edge_measured: Signal<Out, Bit>,
    /// Places (cycles, or half ones with the double edge) from the tracked one to this edge, less one, in two's complement.
    pub edge_offset: Signal<Out, Bits<8>>,
    /// Strobe: the filter has removed a pulse.
    pub glitch: Signal<Out, Bit>,
    /// A trigger would be lost.
    pub busy: Signal<Out, Bit>,
    /// The frame under way carries the request.
    pub request_runs: Signal<Out, Bit>,
    /// DATA is HIGH, and no frame is on the wire.
    pub line_high: Signal<Out, Bit>,
    /// Strobe: a trigger is lost.
    pub displaced: Signal<Out, Bit>,
    /// A frame, triggered or not, has ended.
    #[bundle]
    pub end: FrameEndOut,
    /// Answer of the last request with a separate frame: 8 and 16 bits, or a position or test values from bit 0 on.
    pub reply: Signal<Out, Bits<48>>,
    /// Record of the additional data that follow each position.
    #[bundle]
    pub record: AdditionalDataOut,
    /// The propagation delay is known: frames run at the full clock, and requests may be attached to triggered frames.
    pub calibrated: Signal<Out, Bit>,
    /// Strobe: the data line is sampled for a bit of the answer.
    pub sample_strobe: Signal<Out, Bit>,
    /// With that, and double edge: sampled at the clock edge, not half a cycle before it.
    pub sample_second: Signal<Out, Bit>,
    filter: InputFilter,
    clock_gen: ClockGen,
    sender: CommandSender,
    delay: LineDelay,
    receiver: Receiver,
    transaction: Transaction,
    snapshot: Snapshot,
    shape: CommandShape,
    wanted_shape: CommandShape,
    add_info: AddInfo,
    settings: Vec<FrameSettings>,
    /// EnDat clock, for the pin.
    #[start(true)]
    clk_pin: Reg<Bit>,
    /// Level for the data line, for the pin.
    data_pin: Reg<Bit>,
    /// Driver enable, for the pin.
    oe_pin: Reg<Bit>,
    second: Vec<SecondReceiver>,
    /// High from a request with a separate frame until that frame begins or the request is cancelled.
    own_asked: Vec<ProtectedBit>,
    /// High from a request for a triggered frame until that frame begins or the request is cancelled.
    ride_asked: Vec<ProtectedBit>,
    /// High if a request waits for a separate frame.
    own_wanted: Signal<Local, Bit>,
    /// High if a request waits for the next triggered frame.
    ride_wanted: Signal<Local, Bit>,
    /// Mode command for triggered frames.
    command_set: Signal<Local, Bits<6>>,
    /// Position width of the frame.
    width_set: Signal<Local, Bits<6>>,
    /// Length of the input filter in the frame, in system clock cycles.
    filter_set: Signal<Local, Bits<4>>,
    /// The input filter is half a cycle longer in the frame.
    filter_half_set: Signal<Local, Bit>,
    /// Start window of the frame, in system clock cycles.
    window_set: Signal<Local, Bits<6>>,
    _guards: usize,
    _requests: usize,
    _seconds: usize,
    /// Mode command of the frame; follows settings and request between two frames.
    frame_command: Reg<Bits<6>>,
    /// Position width of the frame; follows the settings between two frames.
    frame_width: Reg<Bits<6>>,
    /// EnDat clock period of the frame, in system clock cycles; follows the settings between two frames.
    frame_period: Reg<Bits<11>>,
    /// High if the frame is a separate frame of a request; chosen between two frames.
    frame_own: Reg<Bit>,
    /// High if a request is attached to the frame; chosen between two frames.
    frame_ride: Reg<Bit>,
    /// High for one cycle after a block of additional data is complete.
    info_taken: Reg<Bit>,
    /// High for one cycle after the answer to a request with a separate frame is complete.
    reply_taken: Reg<Bit>,
    /// Payload of the last answer to a request with a separate frame.
    reply_word: Reg<Bits<48>>,
    /// High if the CRC of that answer is right; cleared when a frame begins.
    reply_right: Reg<Bit>,
    /// High if that answer is a parameter, which arrived MSB first.
    reply_has_parameter: Reg<Bit>,
    has_guards: Constant<Bit>,
    has_requests: Constant<Bit>,
    has_double: Constant<Bit>,
    /// 1 if a clock period must have at least four system clock cycles.
    needs_four: Constant<Bit>,
    /// Value of `phase_mode` for a fixed delay.
    fixed_mode: Constant<Bits<2>>,
    /// Bits of a parameter.
    parameter_bits: Constant<Bits<6>>,
    /// Bits of the test values.
    test_value_bits: Constant<Bits<6>>,
    /// Mode command of the frame.
    command_now: Signal<Local, Bits<6>>,
    /// Bits of the payload of the answer.
    payload_bits: Signal<Local, Bits<6>>,
    /// Payload of an answer that arrived MSB first.
    word: Signal<Local, Bits<24>>,
    /// Last answer to a request, if it arrived MSB first.
    turned: Signal<Local, Bits<24>>,
    /// High if the CRC matches the bits as received and as stored.
    crc_ok: Signal<Local, Bit>,
    /// Faults forced by a test in this frame: F1, F2, CRC, second receiver.
    forced_now: Signal<Local, Bits<4>>,
    /// EnDat clock period of the frame, in system clock cycles.
    period: Signal<Local, Bits<11>>,
    /// EnDat clock period of a frame that measures the delay, in system clock cycles.
    calibration_period_cycles: Constant<Bits<11>>,
}

impl Channel {
    /// A channel with these fixed times, for triggered positions without additional data.
    pub fn new(times: FixedTimes) -> Self {
        Self::with(times, Features::default())
    }

    /// A channel with these fixed times and features.
    pub fn with(times: FixedTimes, features: Features) -> Self {
        let requests = usize::from(features.requests);
        let seconds = usize::from(features.second_receiver);
        let guards = features.upset_guards;
        Self::from_parts(ChannelParts {
            filter: InputFilter::new(features),
            clock_gen: ClockGen::new(features),
            sender: CommandSender::new(features.requests),
            delay: LineDelay::new(features),
            receiver: Receiver::new(features),
            snapshot: Snapshot::new(
                match features.restore {
                    true if features.swaps() => Withdrawal::Swaps,
                    true => Withdrawal::Restores,
                    false => Withdrawal::Clears,
                },
                guards,
                cause::UPSET,
                cause::flag(cause::UPSET),
            ),
            settings: numbered(usize::from(guards), |_| FrameSettings::default()),
            _guards: guards.into(),
            transaction: Transaction::new(times, features),
            shape: CommandShape::new(features.requests),
            wanted_shape: CommandShape::new(features.requests),
            add_info: AddInfo::new(times.separator_cycles),
            second: numbered(seconds, |_| SecondReceiver::new(features)),
            own_asked: numbered(requests, |_| ProtectedBit::new(guards)),
            ride_asked: numbered(requests, |_| ProtectedBit::new(guards)),
            _requests: requests,
            _seconds: seconds,
            has_guards: Constant::new(guards),
            has_requests: Constant::new(features.requests),
            has_double: Constant::new(features.double_edge),
            needs_four: Constant::new(
                features.double_edge && (features.requests || features.continuous),
            ),
            fixed_mode: Constant::new(line_delay::mode::FIXED.into()),
            parameter_bits: Constant::new(u64::from(PARAMETER_BITS).into()),
            test_value_bits: Constant::new(u64::from(TEST_VALUE_BITS).into()),
            calibration_period_cycles: Constant::new(times.calibration_period_cycles.into()),
        })
    }
}
