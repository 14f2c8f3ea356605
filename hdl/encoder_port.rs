//! Encoder port: a channel, and its service where the configuration has one; or a T-format port in their place.
//!
//! ```text
//! trigger, configuration --> ServiceChannel --> Channel --> EnDat     trigger, configuration --> TFormatPort --> T-format
//!                               ^   |             |                                                 ^  |
//! host --- Service, RAM <-- io -+---+             +--> results        host --- words ---------------+  +--> results
//! ```
//!
//! What only the other protocol has reads 0; EnDat's clock rests HIGH.
//!
//! For a design with a bus of its own this is the block to take: everything of one encoder, without a host link.

use crate::channel::Channel;
use crate::features::{Features, FixedTimes};
use crate::line_monitor::{LineMonitor, LineStart};
use crate::service::program::ServiceTimes;
use crate::service::{channel::ServiceChannel, Service};
use crate::several::each;
use crate::t_format::port::TFormatPort;
use crate::transaction::cause;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// One encoder.
#[derive(LogicBlock, Block)]
pub struct EncoderPort {
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
    /// Data line from the transceiver, asynchronous.
    pub data_i: Signal<In, Bit>,
    /// EnDat clock period, in system clock cycles; an odd one has the longer high phase. T-format: a bit, 8 to 127.
    pub period_cycles: Signal<In, Bits<11>>,
    /// How much longer than half a period the first low phase is: 0, or at least 4 system clock cycles (tST).
    pub first_low_extra_cycles: Signal<In, Bits<11>>,
    /// Mode command of a triggered frame.
    pub command: Signal<In, Bits<6>>,
    /// Position width, 1..=48 bits.
    pub position_bits: Signal<In, Bits<6>>,
    /// Pulses on the data line of at most this many system clock cycles are ignored.
    pub filter_cycles: Signal<In, Bits<4>>,
    /// And half a system clock cycle more, where DATA is looked at on both edges.
    pub filter_half: Signal<In, Bit>,
    /// Largest distance of the start edge from its expected place, in system clock cycles.
    pub start_window_cycles: Signal<In, Bits<6>>,
    /// Longest wait for the start bit after the turnaround, in microseconds. T-format: longest pause before the reply, 1 to 63.
    pub start_timeout_us: Signal<In, Bits<12>>,
    /// Data must fall within this many system clock cycles after the frame.
    pub recovery_limit_cycles: Signal<In, Bits<13>>,
    /// T-format: request ID of a trigger.
    pub request_id: Signal<In, Bits<4>>,
    /// T-format: longest pause between two fields, in microseconds.
    pub field_gap_us: Signal<In, Bits<3>>,
    /// EnDat clock to the transceiver, from a register.
    pub endat_clk: Signal<Out, Bit>,
    /// Data line to the transceiver, from a register.
    pub data_o: Signal<Out, Bit>,
    /// Driver enable of the data line, from a register.
    pub data_oe: Signal<Out, Bit>,
    /// Strobe: a new result can be read from this cycle on.
    pub result_strobe: Signal<Out, Bit>,
    /// Last good position, bit 0 = LSB, zeros above its width. T-format: multi-turn in bits 47..24, single-turn in 23..0.
    pub position: Signal<Out, Bits<48>>,
    /// There is a good position.
    pub position_valid: Signal<Out, Bit>,
    /// The last result brought the position; low = held from an earlier frame.
    pub fresh: Signal<Out, Bit>,
    /// Number of results, wrapping.
    pub sequence: Signal<Out, Bits<16>>,
    /// Time of the first falling clock edge of the frame that brought the position, in system clock cycles.
    pub first_fall_timestamp: Signal<Out, Bits<32>>,
    /// Age of the position in microseconds; stops at 65535.
    pub age_us: Signal<Out, Bits<16>>,
    /// Primary cause of the last result, see [`crate::transaction::cause`]; its flags mean something else in T-format.
    pub cause: Signal<Out, Bits<5>>,
    /// Raw flags of the last result.
    pub flags: Signal<Out, Bits<20>>,
    /// CRC received in the last whole frame.
    pub crc_received: Signal<Out, Bits<5>>,
    /// CRC computed for the last whole frame.
    pub crc_computed: Signal<Out, Bits<5>>,
    /// CRC that came with the position; 0 on a T-format channel.
    pub position_crc: Signal<Out, Bits<5>>,
    /// Width of the position; 0 on a T-format channel.
    pub position_width: Signal<Out, Bits<6>>,
    /// The position came with F2.
    pub position_has_f2: Signal<Out, Bit>,
    /// Recovery time tm of the last frame, in system clock cycles.
    pub recovery_cycles: Signal<Out, Bits<13>>,
    /// Tracked propagation delay tD, synchroniser and filter included, in system clock cycles.
    pub delay_cycles: Signal<Out, Bits<11>>,
    /// A trigger would not be taken.
    pub busy: Signal<Out, Bit>,
    /// The frame under way has the request.
    pub request_runs: Signal<Out, Bit>,
    /// DATA is HIGH, and no frame is on the wire.
    pub line_high: Signal<Out, Bit>,
    /// Strobe: a trigger has been lost.
    pub displaced: Signal<Out, Bit>,
    /// Strobe: a frame, triggered or not, has ended; `over_cause` to `reply_good` are of it.
    pub over: Signal<Out, Bit>,
    /// The frame had the request.
    pub over_request: Signal<Out, Bit>,
    /// Primary cause of the frame, as `cause`.
    pub over_cause: Signal<Out, Bits<5>>,
    /// Raw flags of the frame, as `flags`.
    pub over_flags: Signal<Out, Bits<20>>,
    /// Answer of the last request with a frame of its own: 8 and 16 bits, or a position or test values from bit 0 on.
    pub reply: Signal<Out, Bits<48>>,
    /// Its CRC is right.
    pub reply_good: Signal<Out, Bit>,
    /// The encoder sends after each EnDat 2.2 position: bit 0 additional data 1, bit 1 additional data 2.
    pub info_active: Signal<Out, Bits<2>>,
    /// Additional data 1 as it came last: WRN, RM, Busy, I4..I0, 16 bits.
    pub info_1: Signal<Out, Bits<24>>,
    /// Additional data 2 as it came last.
    pub info_2: Signal<Out, Bits<24>>,
    /// Additional data in the last frame: bit 0 additional data 1, bit 1 additional data 2.
    pub info_came: Signal<Out, Bits<2>>,
    /// Their CRCs are right.
    pub info_good: Signal<Out, Bits<2>>,
    /// The CRCs with which they came: additional data 1 in bits 4..0, additional data 2 in bits 9..5.
    pub info_crcs: Signal<Out, Bits<10>>,
    /// The propagation delay is known: frames run at the full clock, requests may ride.
    pub calibrated: Signal<Out, Bit>,
    /// Strobe: the data line is sampled for a bit of the answer.
    pub sample_strobe: Signal<Out, Bit>,
    /// The service's alarm: too many bad frames, or positions 1 and 2 apart; or that of the line: drift or edges beyond their limits.
    pub alarm: Signal<Out, Bit>,
    /// Word of the service's RAM, or of the T-format port, that the host accesses; stays put from one strobe to the next, 8 cycles at least.
    pub host_address: Signal<In, Bits<7>>,
    /// The word is one of the line monitor, not of the service.
    pub host_line: Signal<In, Bit>,
    /// Strobe: read it.
    pub host_read: Signal<In, Bit>,
    /// The word read; 0 without service, or where it stands elsewhere.
    pub host_word: Signal<Out, Bits<32>>,
    /// Strobe: write one half of it.
    pub host_write: Signal<In, Bit>,
    /// The half: 1 = high. Write the low one last: it acts.
    pub host_half: Signal<In, Bit>,
    /// What to write.
    pub host_data: Signal<In, Bits<16>>,
    /// Port of the service that the program reads or writes; only where the service stands elsewhere, as the next four.
    pub io_address: Vec<Signal<In, Bits<5>>>,
    /// Strobe: it is read.
    pub io_read: Vec<Signal<In, Bit>>,
    /// In the next cycle what the port had to say, otherwise 0.
    pub io_in: Vec<Signal<Out, Bits<16>>>,
    /// What is written.
    pub io_out: Vec<Signal<In, Bits<16>>>,
    /// Strobe: it is written to the port.
    pub io_write: Vec<Signal<In, Bit>>,
    channel: Vec<Channel>,
    t_format: Vec<TFormatPort>,
    served: Vec<ServiceChannel>,
    service: Vec<Service>,
    monitor: Vec<LineMonitor>,
    trigger_overrun: Constant<Bits<5>>,
    info_missing: Constant<Bits<5>>,
    recovery_too_short: Constant<Bits<5>>,
    _channels: usize,
    _t_formats: usize,
    _served: usize,
    _services: usize,
    _ios: usize,
    _idle_ios: usize,
    _monitors: usize,
}

impl EncoderPort {
    /// A port with these fixed times; with a service that initialises and takes requests if `service` is given.
    /// `wants_short`: the encoder is set to the short recovery time.
    pub fn new(times: FixedTimes, service: Option<&ServiceTimes>, wants_short: bool) -> Self {
        let start = LineStart::default();
        Self::with_line(times, service, wants_short, Features::NONE, start)
    }

    /// The same with the features of `line` that have to do with the line delay, and their settings after reset.
    pub fn with_line(
        times: FixedTimes,
        service: Option<&ServiceTimes>,
        wants_short: bool,
        line: Features,
        start: LineStart,
    ) -> Self {
        let served = Self::served(times, service, wants_short, line, start);
        Self {
            // Its own service has no use for them.
            io_address: vec![],
            io_read: vec![],
            io_in: vec![],
            io_out: vec![],
            io_write: vec![],
            service: (service.into_iter().map(|s| Service::new(s, 1))).collect(),
            _services: service.iter().count(),
            _ios: 0,
            ..served
        }
    }

    /// The same for a service that stands elsewhere, at the `io_` ports.
    pub fn served(
        times: FixedTimes,
        service: Option<&ServiceTimes>,
        wants_short: bool,
        line: Features,
        start: LineStart,
    ) -> Self {
        let features = Features {
            requests: service.is_some(),
            diagnosis: service.is_some_and(|s| s.diagnosis),
            continuous: service.is_some_and(|s| s.continuous),
            ..line
        };
        let served = service.map(|s| ServiceChannel::new(wants_short, s.initialise));
        let monitor = (line.alignment).then(|| LineMonitor::new(line, start));
        Self::of(
            vec![Channel::with(times, features)],
            vec![],
            served.into_iter().collect(),
            monitor.into_iter().collect(),
            service.is_some(),
        )
    }

    /// A port for a T-format encoder. `has_io`: beside it is a service, of which it has nothing.
    pub fn t_format(has_io: bool) -> Self {
        Self::of(vec![], vec![TFormatPort::default()], vec![], vec![], has_io)
    }

    fn of(
        channel: Vec<Channel>,
        t_format: Vec<TFormatPort>,
        served: Vec<ServiceChannel>,
        monitor: Vec<LineMonitor>,
        has_io: bool,
    ) -> Self {
        let ios = usize::from(has_io);
        Self::from_parts(EncoderPortParts {
            io_address: each(ios),
            io_read: each(ios),
            io_in: each(ios),
            io_out: each(ios),
            io_write: each(ios),
            _channels: channel.len(),
            _t_formats: t_format.len(),
            _served: served.len(),
            _services: 0,
            _ios: ios.min(served.len()),
            _idle_ios: ios.saturating_sub(served.len()),
            _monitors: monitor.len(),
            channel,
            t_format,
            served,
            service: vec![],
            monitor,
            trigger_overrun: Constant::new(cause::TRIGGER_OVERRUN.into()),
            info_missing: Constant::new(cause::INFO_MISSING.into()),
            recovery_too_short: Constant::new(cause::RECOVERY_TOO_SHORT.into()),
        })
    }
}

impl Logic for EncoderPort {
    #[kernel]
    fn update(&mut self) {
        for i in 0..self._channels {
            connect!(self.channel[i] <= self;
                clock, reset, tick_us, timestamp, trigger, calibrate, data_i, period_cycles,
                first_low_extra_cycles, command, position_bits, filter_cycles, filter_half,
                start_window_cycles, start_timeout_us, recovery_limit_cycles
            );
            self.channel[i].phase_mode.next = 0.into();
            self.channel[i].fixed_delay.next = 0.into();
            self.channel[i].majority.next = false;
            self.channel[i].request_command.next = 0.into();
            self.channel[i].request_parameter.next = 0.into();
            self.channel[i].request_ride.next = false;
            self.channel[i].request_own.next = false;
            self.channel[i].request_cancel.next = false;
            self.channel[i].hold_off.next = false;
            self.channel[i].clock_low.next = false;
            self.channel[i].forced.next = 0.into();
            self.channel[i].watchdog_us.next = 0.into();
            self.channel[i].recovery_min_cycles.next = 0.into();
            self.channel[i].continuous.next = false;
            self.channel[i].stop_at_error.next = false;
            connect!(self <= self.channel[i];
                endat_clk, data_o, data_oe, result_strobe, position, position_valid, fresh,
                sequence, first_fall_timestamp, age_us, cause, flags, crc_received, crc_computed,
                position_crc, position_width, position_has_f2, recovery_cycles, delay_cycles, busy,
                request_runs, line_high, displaced, over, over_request, over_cause, over_flags,
                reply, reply_good, info_active, info_1, info_2, info_came, info_good, info_crcs,
                calibrated, sample_strobe
            );
        }
        self.alarm.next = false;
        self.host_word.next = 0.into();
        for i in 0..self._t_formats {
            connect!(self.t_format[i] <= self;
                clock, reset, tick_us, timestamp, trigger, data_i, request_id
            );
            self.t_format[i].bit_cycles.next = self.period_cycles.val().get_bits::<7>(0);
            self.t_format[i].reply_gap_us.next = self.start_timeout_us.val().get_bits::<6>(0);
            connect!(self.t_format[i] <= self; field_gap_us, filter_cycles);
            self.t_format[i].host_address.next = self.host_address.val().get_bits::<3>(0);
            connect!(self.t_format[i] <= self; host_read, host_write, host_half, host_data);
            self.endat_clk.next = true;
            self.crc_received.next = 0.into();
            self.crc_computed.next = 0.into();
            self.position_crc.next = 0.into();
            self.position_width.next = 0.into();
            self.position_has_f2.next = false;
            self.recovery_cycles.next = 0.into();
            self.delay_cycles.next = 0.into();
            self.request_runs.next = false;
            self.line_high.next = false;
            self.displaced.next = false;
            self.over_cause.next = 0.into();
            self.over_flags.next = 0.into();
            self.reply.next = 0.into();
            self.reply_good.next = false;
            self.info_active.next = 0.into();
            self.info_1.next = 0.into();
            self.info_2.next = 0.into();
            self.info_came.next = 0.into();
            self.info_good.next = 0.into();
            self.info_crcs.next = 0.into();
            self.calibrated.next = false;
            self.sample_strobe.next = false;
            connect!(self <= self.t_format[i];
                data_o, data_oe, result_strobe, position, position_valid, fresh, sequence,
                first_fall_timestamp, age_us, cause, flags, busy, over, over_request, host_word
            );
        }
        for i in 0..self._served {
            connect!(self.served[i] <= self; clock, reset);
            connect!(self.served[i] <= self.channel[i];
                over, over_request, over_cause, reply = answer, reply_good, info_active, info_1,
                info_2, info_came, info_good, request_runs, line_high, displaced, sequence,
                position, fresh, delay_cycles
            );
            connect!(self.served[i] <= self; period_cycles, command, position_bits, host_address);
            self.served[i].host_write.next = self.host_write.val() & !self.host_line.val();
            self.served[i].host_half.next = self.host_half.val();
            connect!(self.channel[i] <= self.served[i];
                period_cycles = period_now_cycles, command = command_now,
                position_bits = position_bits_now
            );
            self.channel[i].calibrate.next = self.calibrate.val() | self.served[i].calibrate.val();
            connect!(self.channel[i] <= self.served[i];
                request_command, request_parameter, request_ride, request_own, request_cancel,
                hold_off, clock_low, forced, watchdog_us, recovery_min_cycles, continuous,
                stop_at_error
            );
            self.alarm.next = self.served[i].alarm.val();
        }
        for i in 0..self._ios {
            self.served[i].io_address.next = self.io_address[i].val();
            self.served[i].io_out.next = self.io_out[i].val();
            self.served[i].io_write.next = self.io_write[i].val();
            self.served[i].io_read.next = self.io_read[i].val();
            self.io_in[i].next = self.served[i].io_in.val();
        }
        for i in 0..self._idle_ios {
            self.io_in[i].next = 0.into();
        }
        for i in 0..self._services {
            connect!(self.service[i] <= self; clock, reset, tick_us);
            self.service[i].io_in[0].next = self.served[i].io_in.val();
            connect!(self.served[i] <= self.service[i]; io_address, io_out);
            self.served[i].io_read.next = self.service[i].io_read[0].val();
            self.served[i].io_write.next = self.service[i].io_write[0].val();
            self.service[i].host_address.next = self.host_address.val();
            self.service[i].host_second.next = false;
            self.service[i].host_read.next = self.host_read.val() & !self.host_line.val();
            self.service[i].host_clear.next = false;
            self.service[i].host_write.next = self.host_write.val() & !self.host_line.val();
            connect!(self.service[i] <= self; host_half, host_data);
            self.host_word.next = self.service[i].host_word.val();
        }
        for i in 0..self._monitors {
            connect!(self.monitor[i] <= self; clock, reset);
            connect!(self.monitor[i] <= self.channel[i]; busy, edge_measured, edge_offset, over);
            // These come with a good position.
            self.monitor[i].over_bad.next = self.channel[i].over_cause.val().any()
                & (self.channel[i].over_cause.val() != self.trigger_overrun.val())
                & (self.channel[i].over_cause.val() != self.info_missing.val())
                & (self.channel[i].over_cause.val() != self.recovery_too_short.val());
            connect!(self.monitor[i] <= self.channel[i]; glitch, phase, calibrated);
            self.monitor[i].host_address.next = self.host_address.val().get_bits::<6>(0);
            self.monitor[i].host_read.next = self.host_read.val() & self.host_line.val();
            self.monitor[i].host_write.next = self.host_write.val() & self.host_line.val();
            connect!(self.monitor[i] <= self; host_half, host_data);
            connect!(self.channel[i] <= self.monitor[i]; phase_mode, fixed_delay, majority);
            if self.monitor[i].alarm.val() {
                self.alarm.next = true;
            }
            if self.host_line.val() {
                self.host_word.next = self.monitor[i].host_word.val();
            }
        }
    }
}
