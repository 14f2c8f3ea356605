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
//! With [`Features::requests`] the channel sends all mode commands: a request rides on the next triggered position frame (EnDat 2.2), or
//! has a frame of its own. [`AddInfo`] keeps the record of the additional data that follow each position.
//!
//! The first frame after reset, after an aborted frame and after `calibrate` runs at the calibration clock and
//! measures the propagation delay; all others run at the configured clock. A frame takes its settings over with its first falling
//! edge; inputs that change later count for the next one.

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
use crate::protocol::{PARAMETER_BITS, TEST_VALUE_BITS};
use crate::several::{each, numbered};
use crate::snapshot::Snapshot;
use crate::sure_bit::SureBit;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// From the cycle with the trigger strobe to the first cycle with the EnDat clock low, at every width and rate.
pub const TRIGGER_TO_FIRST_FALL_CYCLES: u64 = 3;
/// From the cycle in which the bit behind the last CRC bit is sampled to the one with the result strobe, at every width and rate.
pub const TAIL_SAMPLE_TO_RESULT_CYCLES: u64 = 2;
/// From the time in `first_fall_timestamp` to the first cycle with the EnDat clock low.
pub const TIMESTAMP_TO_FIRST_FALL_CYCLES: u64 = 2;
/// What registers at both pins and the synchroniser add to `delay_cycles`; the filter adds its length.
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
    /// One-cycle strobe: take a position.
    pub trigger: Signal<In, Bit>,
    /// Strobe: measure the propagation delay again with the next frame.
    pub calibrate: Signal<In, Bit>,
    /// Settings of one channel, as the host has written them.
    #[bundle]
    pub settings_in: PortSettingsIn,
    /// What the service asks of its channel.
    #[bundle]
    pub orders: ServiceOrdersIn,
    /// Where the phase comes from, see [`crate::endat::line_delay::mode`].
    pub phase_mode: Signal<In, Bits<2>>,
    /// Delay in mode `fixed`, in sixteenths of a system clock cycle.
    pub fixed_delay: Signal<In, Bits<15>>,
    /// Each sample is the majority of itself and its neighbours.
    pub majority: Signal<In, Bit>,
    /// The line of one encoder.
    #[bundle]
    pub line: LineOut,
    /// Result of a trigger.
    #[bundle]
    pub result: FrameResultOut,
    /// Recovery time tm of the last frame, in system clock cycles.
    pub recovery_cycles: Signal<Out, Bits<13>>,
    /// Tracked propagation delay tD, synchroniser and filter included, in system clock cycles.
    pub delay_cycles: Signal<Out, Bits<11>>,
    /// The delay as the mean of many edges, in sixteenths of a system clock cycle.
    pub phase: Signal<Out, Bits<15>>,
    /// Strobe: an edge of the answer has been measured.
    pub edge_measured: Signal<Out, Bit>,
    /// Places (cycles, or half ones with the double edge) from the tracked one to this edge, less one, in two's complement.
    pub edge_offset: Signal<Out, Bits<8>>,
    /// Strobe: the filter has removed a pulse.
    pub glitch: Signal<Out, Bit>,
    /// A trigger would not be taken.
    pub busy: Signal<Out, Bit>,
    /// The frame under way has the request.
    pub request_runs: Signal<Out, Bit>,
    /// DATA is HIGH, and no frame is on the wire.
    pub line_high: Signal<Out, Bit>,
    /// Strobe: a trigger has been lost.
    pub displaced: Signal<Out, Bit>,
    /// A frame, triggered or not, has ended.
    #[bundle]
    pub end: FrameEndOut,
    /// Answer of the last request with a frame of its own: 8 and 16 bits, or a position or test values from bit 0 on.
    pub reply: Signal<Out, Bits<48>>,
    /// Record of the additional data that follow each position.
    #[bundle]
    pub record: AdditionalDataOut,
    /// The propagation delay is known: frames run at the full clock, requests may ride.
    pub calibrated: Signal<Out, Bit>,
    /// Strobe: the data line is sampled for a bit of the answer.
    pub sample_strobe: Signal<Out, Bit>,
    /// With that, and double edge: at the clock edge, not half a cycle before it.
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
    #[start]
    settings: FrameSettings,
    #[start(true)]
    clk_pin: Reg<Bit>,
    data_pin: Reg<Bit>,
    oe_pin: Reg<Bit>,
    second: Vec<SecondReceiver>,
    own_asked: Vec<SureBit>,
    ride_asked: Vec<SureBit>,
    own_wanted: Signal<Local, Bit>,
    ride_wanted: Signal<Local, Bit>,
    _requests: usize,
    _seconds: usize,
    frame_command: Reg<Bits<6>>,
    frame_own: Reg<Bit>,
    frame_ride: Reg<Bit>,
    info_taken: Reg<Bit>,
    reply_taken: Reg<Bit>,
    reply_word: Reg<Bits<48>>,
    reply_right: Reg<Bit>,
    reply_has_parameter: Reg<Bit>,
    has_requests: Constant<Bit>,
    has_double: Constant<Bit>,
    needs_four: Constant<Bit>,
    fixed_mode: Constant<Bits<2>>,
    parameter_bits: Constant<Bits<6>>,
    test_value_bits: Constant<Bits<6>>,
    command_now: Signal<Local, Bits<6>>,
    payload_bits: Signal<Local, Bits<6>>,
    word: Signal<Local, Bits<24>>,
    turned: Signal<Local, Bits<24>>,
    crc_ok: Signal<Local, Bit>,
    forced_now: Signal<Local, Bits<4>>,
    period: Signal<Local, Bits<11>>,
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
        Self::from_parts(ChannelParts {
            filter: InputFilter::new(features),
            clock_gen: ClockGen::new(features),
            sender: CommandSender::new(features.requests),
            delay: LineDelay::new(features),
            receiver: Receiver::new(features),
            snapshot: Snapshot::new(cause::UPSET, cause::flag(cause::UPSET)),
            transaction: Transaction::new(times, features),
            shape: CommandShape::new(features.requests),
            wanted_shape: CommandShape::new(features.requests),
            add_info: AddInfo::new(times.separator_cycles),
            second: numbered(seconds, |_| SecondReceiver::new(features)),
            own_asked: each(requests),
            ride_asked: each(requests),
            _requests: requests,
            _seconds: seconds,
            has_requests: Constant::new(features.requests),
            has_double: Constant::new(features.double_edge),
            needs_four: Constant::new(features.double_edge && features.requests),
            fixed_mode: Constant::new(line_delay::mode::FIXED.into()),
            parameter_bits: Constant::new(u64::from(PARAMETER_BITS).into()),
            test_value_bits: Constant::new(u64::from(TEST_VALUE_BITS).into()),
            calibration_period_cycles: Constant::new(times.calibration_period_cycles.into()),
        })
    }
}

impl Logic for Channel {
    #[kernel]
    fn update(&mut self) {
        connect!(
            self.filter, self.clock_gen, self.sender, self.delay, self.receiver, self.transaction,
            self.snapshot, self.add_info, self.settings <= self; clock, reset
        );

        self.settings.is_at_rest.next = self.transaction.is_at_rest.val();
        self.settings.start.next = self.transaction.control.start.val();
        PortSettingsIn::link(&mut self.settings_in, &mut self.settings.wanted);
        self.settings.frame_command.next = self.command_now.val();
        connect!(self.settings <= self.orders; recovery_min_cycles, watchdog_us);

        self.period.next = self.settings.period_cycles_now.val();
        if self.transaction.cell_control.slow.val() {
            self.period.next = self.calibration_period_cycles.val();
        }

        // Which command the next frame has is settled before it begins, and stays until all has been told of it.
        connect!(self <= self.settings; command_now, payload_bits = position_bits_now);
        if self.has_requests.val() {
            self.command_now.next = self.frame_command.q.val();
            if self.shape.answer.has_parameter.val() {
                self.payload_bits.next = self.parameter_bits.val();
            }
            if self.shape.has_test_values.val() {
                self.payload_bits.next = self.test_value_bits.val();
            }
        }
        self.own_wanted.next = false;
        self.ride_wanted.next = false;
        for i in 0..self._requests {
            connect!(self.own_asked[i] <= self; clock, reset);
            self.own_asked[i].raise.next =
                self.orders.request_own.val() & !self.orders.request_cancel.val();
            self.own_asked[i].clear.next = self.orders.request_cancel.val()
                | (self.transaction.begun.val() & self.frame_own.q.val());
            self.own_wanted.next = self.own_asked[i].is_set.val();
            connect!(self.ride_asked[i] <= self; clock, reset);
            self.ride_asked[i].raise.next =
                self.orders.request_ride.val() & !self.orders.request_cancel.val();
            self.ride_asked[i].clear.next = self.orders.request_cancel.val()
                | (self.transaction.begun.val() & self.frame_ride.q.val());
            self.ride_wanted.next = self.ride_asked[i].is_set.val();
        }
        if !self.transaction.begun.val()
            & self.transaction.is_at_rest.val()
            & self.has_requests.val()
        {
            self.frame_command.d.next = self.settings_in.command.val();
            self.frame_own.d.next = self.own_wanted.val();
            self.frame_ride.d.next =
                self.ride_wanted.val() & self.transaction.calibrated.val() & !self.own_wanted.val();
            if self.own_wanted.val() | (self.ride_wanted.val() & self.transaction.calibrated.val())
            {
                self.frame_command.d.next = self.orders.request_command.val();
            }
        }
        self.shape.command.next = self.command_now.val();

        self.filter.pin.next = self.line.data_i.val();
        connect!(self.filter <= self.settings;
            filter_cycles = filter_cycles_now, filter_half = filter_half_now
        );
        self.filter.majority.next = self.majority.val();
        self.filter.both_edges.next = self.receiver.progress.started.val();

        connect!(self.clock_gen <= self.transaction; hold_low, stop);
        self.clock_gen.start.next = self.transaction.control.start.val();
        self.clock_gen.period_cycles.next = self.period.val();

        self.sender.fall.next = self.clock_gen.fall.val();
        // Outside of a command nothing is left to send, whatever a register says.
        self.sender.aborts.next = self.transaction.control.aborts.val()
            | (!self.receiver.progress.skipping.val()
                & !self.transaction.control.start_supplement.val());
        connect!(self.sender <= self.transaction.control; start, start_supplement);
        self.sender.command.next = self.command_now.val();
        self.sender.parameter_word.next = self.orders.request_parameter.val();
        self.sender.has_parameter.next = self.shape.answer.has_parameter.val();

        CellControlOut::join(&mut self.transaction.cell_control, &mut self.delay.control);
        connect!(self.delay <= self.transaction.control; acquire, going_on);
        connect!(self.delay <= self.clock_gen; will_rise, rise);
        connect!(self.delay <= self.filter; data_edge = edge_strobe, edge_second);
        self.delay.in_answer.next =
            self.receiver.progress.started.val() & !self.receiver.progress.skipping.val();
        connect!(self.delay <= self; mode = phase_mode, fixed_delay, period_cycles = period);
        connect!(self.delay <= self.receiver.progress;
            hunting, follow = start_found, none_under_way
        );
        self.delay.start_window_cycles.next = self.settings.start_window_cycles_now.val();

        ControlOut::join(&mut self.transaction.control, &mut self.receiver.control);
        self.receiver.rise.next = self.clock_gen.rise.val();
        CellsOut::join(&mut self.delay.cells, &mut self.receiver.cells);
        self.receiver.level.next = self.filter.level.val();
        if self.has_double.val() & !self.delay.sample_second.val() {
            self.receiver.level.next = self.filter.level_first.val();
        }
        connect!(self.receiver <= self; payload_bits, command = command_now);
        AnswerShapeOut::join(&mut self.shape.answer, &mut self.receiver.shape);
        connect!(self.receiver <= self.add_info; infos, look);

        self.transaction.tick_us.next = self.tick_us.val();
        connect!(self.transaction.next_frame <= self; trigger, calibrate);
        connect!(self.transaction.next_frame <= self.orders; hold_off, stop_at_error);
        self.transaction.level.next = self.filter.level.val();
        self.transaction.is_fixed.next = self.phase_mode.val() == self.fixed_mode.val();
        CellsOut::join(&mut self.delay.cells, &mut self.transaction.cells);
        connect!(self.transaction <= self.delay; center, delay_upset = is_upset);
        ProgressOut::join(&mut self.receiver.progress, &mut self.transaction.progress);
        // In fewer than four cycles additional data would begin before the position is taken.
        self.wanted_shape.command.next = self.settings_in.command.val();
        if self.has_requests.val() {
            self.wanted_shape.command.next = self.frame_command.q.val();
        }
        // A trigger takes positions only, with a request or without: another command's answer is none, and may change the encoder.
        self.transaction.next_frame.is_known.next = (self.wanted_shape.is_position.val()
            | (self.wanted_shape.is_known.val()
                & (self.frame_own.q.val()
                    | (self.frame_ride.q.val() & self.wanted_shape.answer.has_f2.val()))))
            & (!self.needs_four.val()
                | self.settings_in.period_cycles.val().get_bits::<9>(2).any());
        AnswerShapeOut::join(&mut self.shape.answer, &mut self.transaction.shape);
        self.transaction.next_frame.begin_own.next = self.frame_own.q.val() & self.own_wanted.val();
        self.transaction.next_frame.is_own.next = self.frame_own.q.val();
        self.transaction.next_frame.continuous.next = self.orders.continuous.val()
            & self.shape.answer.has_f1.val()
            & !self.shape.answer.has_f2.val()
            & !self.shape.has_test_values.val();
        self.transaction.next_frame.line_wanted.next =
            self.own_wanted.val() | self.orders.hold_off.val();
        AnswerCheckOut::join(&mut self.receiver.verdict, &mut self.transaction.check);
        self.forced_now.next = self.orders.forced.val().get_bits::<4>(0);
        if self.orders.forced.val().get_bit(4) & !self.frame_own.q.val() {
            self.forced_now.next = 0.into();
        }
        if self.has_requests.val() {
            self.transaction.check.f1.next =
                self.receiver.verdict.f1.val() ^ self.forced_now.val().get_bit(0);
            self.transaction.check.f2.next =
                self.receiver.verdict.f2.val() ^ self.forced_now.val().get_bit(1);
            self.transaction.check.serial_ok.next =
                self.receiver.verdict.serial_ok.val() & !self.forced_now.val().get_bit(2);
        }
        self.transaction.will_rise.next = self.clock_gen.will_rise.val();
        FrameLimitsOut::join(&mut self.settings.limits, &mut self.transaction.limits);
        self.transaction.settings_upset.next = self.settings.is_upset.val();

        connect!(self.snapshot <= self; tick_us, timestamp, width_in = payload_bits);
        self.snapshot.delay_cycles.next = self.delay.delay_cycles.val();
        self.snapshot.first_fall.next = self.transaction.control.start.val();
        ToldOut::join(&mut self.transaction.told, &mut self.snapshot.told);
        self.snapshot.has_f2_in.next = self.shape.answer.has_f2.val();
        connect!(self.snapshot <= self.receiver;
            position_in = payload, crc_received_in = crc_received, crc_computed_in = crc_computed
        );
        self.snapshot.latched.next = self.receiver.progress.latched.val();

        // What comes MSB first stands the other way round in the payload.
        self.word.next = 0.into();
        for i in 0..24 {
            self.word.next = self
                .word
                .val()
                .replace_bit(23 - i, self.receiver.payload.val().get_bit(i));
        }
        self.crc_ok.next =
            self.receiver.verdict.serial_ok.val() & self.receiver.verdict.parallel_ok.val();
        self.info_taken.d.next = self.receiver.progress.info_done.val();
        self.reply_taken.d.next = self.receiver.progress.done.val() & self.frame_own.q.val();
        if self.reply_taken.q.val() {
            self.reply_word.d.next = self.receiver.payload.val();
            self.reply_has_parameter.d.next = self.shape.answer.has_parameter.val();
            self.reply_right.d.next = self.crc_ok.val();
        }
        if self.transaction.control.start.val() {
            self.reply_right.d.next = false;
        }

        self.add_info.start.next = self.transaction.control.start.val();
        self.add_info.sample.next = self.delay.cells.sample.val();
        self.add_info.center.next = self.delay.center.val();
        self.add_info.answer_done.next = self.receiver.progress.done.val();
        connect!(self.add_info <= self.shape.answer; has_f2, has_supplement);
        self.add_info.command.next = self.command_now.val();
        self.add_info.mrs.next = self.orders.request_parameter.val().get_bits::<8>(16);
        self.add_info.info_done.next = self.info_taken.q.val() & self.has_requests.val();
        connect!(self.add_info <= self; crc_ok, word);
        self.add_info.crc.next = self.receiver.crc_received.val();
        self.add_info.over.next = self.transaction.over.val() & self.has_requests.val();
        self.add_info.flags.next = self.transaction.told.flags_told.val().get_bits::<12>(0);
        self.clk_pin.d.next = self.clock_gen.endat_clk.val();
        self.data_pin.d.next = self.sender.data.val();
        self.oe_pin.d.next = self.sender.oe.val();
        if self.transaction.probe.val() {
            self.data_pin.d.next = false;
            self.oe_pin.d.next = true;
        }
        if self.orders.clock_low.val() & self.has_requests.val() {
            self.clk_pin.d.next = false;
        }
        self.line.endat_clk.next = self.clk_pin.q.val();
        self.line.data_o.next = self.data_pin.q.val();
        self.line.data_oe.next = self.oe_pin.q.val();

        FrameResultOut::link(&mut self.result, &mut self.snapshot.result);
        connect!(self <= self.delay;
            delay_cycles, phase, edge_measured = measured, edge_offset = offset, sample_second
        );
        self.glitch.next = self.filter.glitch.val();
        self.request_runs.next =
            (self.frame_own.q.val() | self.frame_ride.q.val()) & !self.transaction.is_at_rest.val();
        self.line_high.next = (self.filter.level.val() | self.transaction.is_probed.val())
            & !self.transaction.cell_control.run.val();
        self.end.over_request.next = self.frame_own.q.val() | self.frame_ride.q.val();
        connect!(self <= self.transaction; recovery_cycles, busy, displaced, calibrated);
        self.end.over.next = self.transaction.over.val();
        connect!(self.end <= self.transaction.told; over_cause = cause_told, over_flags = flags_told);
        self.end.answer.next = self.reply_word.q.val();
        self.reply.next = self.reply_word.q.val();
        self.turned.next = 0.into();
        for i in 0..24 {
            self.turned.next = self
                .turned
                .val()
                .replace_bit(23 - i, self.reply_word.q.val().get_bit(i));
        }
        if self.reply_has_parameter.q.val() {
            self.reply.next = bit_cast::<48, 24>(self.turned.val());
        }
        self.end.reply_good.next = self.reply_right.q.val();
        AdditionalDataOut::link(&mut self.record, &mut self.add_info.record);
        for i in 0..self._seconds {
            ControlOut::join(&mut self.transaction.control, &mut self.second[i].control);
            CellsOut::join(&mut self.delay.cells, &mut self.second[i].cells);
            AnswerShapeOut::join(&mut self.shape.answer, &mut self.second[i].shape);
            ProgressOut::join(&mut self.receiver.progress, &mut self.second[i].progress);
            AnswerCheckOut::join(&mut self.receiver.verdict, &mut self.second[i].check);
            connect!(self.second[i] <= self.receiver; payload, crc_received);
            connect!(self.second[i] <= self.transaction.told;
                good, cause = cause_told, flags = flags_told
            );
            connect!(self.snapshot.told <= self.second[i];
                good = good_told, cause_told, flags_told
            );
            self.second[i].rise.next = self.clock_gen.rise.val();
            connect!(self.second[i] <= self.filter; level);
            connect!(self.second[i] <= self.add_info; infos, look);
            connect!(self.second[i] <= self; clock, reset, payload_bits, command = command_now);
            self.second[i].forced.next = self.forced_now.val().get_bit(3) & self.has_requests.val();
            if self.second[i].differs.val() {
                self.transaction.settings_upset.next = true;
                self.record.info_good.next = 0.into();
                self.end.reply_good.next = false;
            }
        }
        self.sample_strobe.next =
            self.delay.cells.sample.val() & !self.receiver.progress.skipping.val();
    }
}
