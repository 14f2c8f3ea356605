//! Encoder port: a channel, with its service if configured; or the port of another protocol.
//!
//! ```text
//! trigger, configuration --> ServiceChannel --> Channel --> EnDat     trigger, configuration --> TFormatPort --> T-format
//!                               ^   |             |                                                 ^  |
//! host --- Service, RAM <-- io -+---+             +--> results        host --- words ---------------+  +--> results
//! ```
//!
//! Outputs of other protocols read 0; the EnDat clock then rests HIGH.
//!
//! A design with a separate bus uses this block: everything for one encoder, without a host link.

use crate::endat::channel::Channel;
use crate::endat::features::{Features, FixedTimes};
use crate::endat::line_monitor::{LineMonitor, LineStart};
use crate::endat::service::program::ServiceTimes;
use crate::endat::service::{channel::ServiceChannel, Service};
use crate::endat::transaction::cause;
use crate::ports::*;
use crate::protocols::ssi::asked::SsiSpec;
use crate::protocols::ssi::port::SsiPort;
use crate::protocols::t_format::port::TFormatPort;
use crate::protocols::Spoken;
use crate::replicate::each;
use endat_regs::Protocol;
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
    /// One-cycle strobe: read a position.
    pub trigger: Signal<In, Bit>,
    /// Strobe: measure the propagation delay again with the next frame.
    pub calibrate: Signal<In, Bit>,
    /// Settings of one channel, as the host has written them.
    #[bundle]
    pub settings: PortSettingsIn,
    /// T-format: request ID of a trigger.
    pub request_id: Signal<In, Bits<4>>,
    /// T-format: longest pause between two fields, in microseconds.
    pub field_gap_us: Signal<In, Bits<3>>,
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
    /// A trigger would be lost.
    pub busy: Signal<Out, Bit>,
    /// The frame under way carries the request.
    pub request_runs: Signal<Out, Bit>,
    /// DATA is HIGH, and no frame is on the wire.
    pub line_high: Signal<Out, Bit>,
    /// Strobe: a trigger is lost.
    pub trigger_lost: Signal<Out, Bit>,
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
    /// Alarm of the service (too many bad frames, or positions 1 and 2 apart) or of the line (drift or edges beyond their limits).
    pub alarm: Signal<Out, Bit>,
    /// The host's access to the words of a port.
    #[bundle]
    pub window: HostWindowIn,
    /// Port number that the program reads or writes; only if the service is outside this port, as the next four.
    pub io_address: Vec<Signal<In, Bits<5>>>,
    /// Strobe: the program reads the port.
    pub io_read: Vec<Signal<In, Bit>>,
    /// In the next cycle the value of the port; otherwise 0.
    pub io_in: Vec<Signal<Out, Bits<16>>>,
    /// Value to write.
    pub io_out: Vec<Signal<In, Bits<16>>>,
    /// Strobe: the program writes the port.
    pub io_write: Vec<Signal<In, Bit>>,
    /// EnDat channel; none for another protocol.
    channel: Vec<Channel>,
    /// T-format port, if the encoder speaks T-format.
    t_format: Vec<TFormatPort>,
    /// SSI port, if the encoder speaks SSI.
    ssi: Vec<SsiPort>,
    /// Connection of the channel to a service.
    served: Vec<ServiceChannel>,
    /// The port's own service.
    service: Vec<Service>,
    /// Line monitor.
    monitor: Vec<LineMonitor>,
    /// Cause of a lost trigger; the position is good.
    trigger_overrun: Constant<Bits<5>>,
    /// Cause of missing additional data; the position is good.
    info_missing: Constant<Bits<5>>,
    /// Cause of a short recovery time; the position is good.
    recovery_too_short: Constant<Bits<5>>,
    _channels: usize,
    _t_formats: usize,
    _ssis: usize,
    _served: usize,
    _services: usize,
    _ios: usize,
    _idle_ios: usize,
    _monitors: usize,
}

/// The port of another protocol than EnDat.
#[derive(Default)]
struct Others {
    /// T-format port, if the encoder speaks T-format.
    t_format: Vec<TFormatPort>,
    /// SSI port, if the encoder speaks SSI.
    ssi: Vec<SsiPort>,
}

impl EncoderPort {
    /// A port with these fixed times, and with a service that initialises and takes requests if `service` is given.
    /// `wants_short`: the encoder is set to the short recovery time.
    pub fn new(times: FixedTimes, service: Option<&ServiceTimes>, wants_short: bool) -> Self {
        let start = LineStart::default();
        Self::with_line(times, service, wants_short, Features::NONE, start)
    }

    /// As [`Self::new`], with the line delay features of `line`, and their settings after reset.
    pub fn with_line(
        times: FixedTimes,
        service: Option<&ServiceTimes>,
        wants_short: bool,
        line: Features,
        start: LineStart,
    ) -> Self {
        let served = Self::served(times, service, wants_short, line, start);
        Self {
            // A service inside the port does not use them.
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

    /// As [`Self::with_line`], with a service outside this port, at the `io_` ports.
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
            Others::default(),
            served.into_iter().collect(),
            monitor.into_iter().collect(),
            service.is_some(),
        )
    }

    /// A port for an encoder with another protocol than EnDat. `has_io`: it is connected to a service but does not use it.
    ///
    /// # Panics
    /// For EnDat, whose ports have other parameters.
    pub fn speaking(protocol: Protocol, guards: bool, has_io: bool) -> Self {
        let mut others = Others::default();
        match protocol {
            Protocol::TFormat => others.t_format.push(TFormatPort::new(guards)),
            Protocol::Ssi => others.ssi.push(SsiPort::new(&SsiSpec::default(), guards)),
            Protocol::Endat => panic!("EncoderPort::served makes ports for EnDat"),
        }
        Self::of(vec![], others, vec![], vec![], has_io)
    }

    /// As [`Self::speaking`], with the parts of a channel's specification that are not settings.
    ///
    /// # Panics
    /// As [`Self::speaking`].
    pub fn asked(spoken: &Spoken, guards: bool, has_io: bool) -> Self {
        let Spoken::Ssi(asked) = spoken else {
            return Self::speaking(spoken.protocol(), guards, has_io);
        };
        let others = Others {
            ssi: vec![SsiPort::new(asked, guards)],
            ..Others::default()
        };
        Self::of(vec![], others, vec![], vec![], has_io)
    }

    fn of(
        channel: Vec<Channel>,
        others: Others,
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
            _t_formats: others.t_format.len(),
            _ssis: others.ssi.len(),
            _served: served.len(),
            _services: 0,
            _ios: ios.min(served.len()),
            _idle_ios: ios.saturating_sub(served.len()),
            _monitors: monitor.len(),
            channel,
            t_format: others.t_format,
            ssi: others.ssi,
            served,
            service: vec![],
            monitor,
            trigger_overrun: Constant::new(cause::TRIGGER_OVERRUN.into()),
            info_missing: Constant::new(cause::INFO_MISSING.into()),
            recovery_too_short: Constant::new(cause::RECOVERY_TOO_SHORT.into()),
        })
    }
}

#[kernel]
impl Logic for EncoderPort {
    fn update(&mut self) {
        for i in 0..self._channels {
            connect!(self.channel[i] <= self;
                clock, reset, tick_us, timestamp, trigger, calibrate
            );
            PortSettingsIn::link(&mut self.settings, &mut self.channel[i].settings_in);
            self.channel[i].phase_mode.next = 0.into();
            self.channel[i].fixed_delay.next = 0.into();
            self.channel[i].majority.next = false;
            self.channel[i].orders.request_command.next = 0.into();
            self.channel[i].orders.request_parameter.next = 0.into();
            self.channel[i].orders.request_ride.next = false;
            self.channel[i].orders.request_own.next = false;
            self.channel[i].orders.request_cancel.next = false;
            self.channel[i].orders.hold_off.next = false;
            self.channel[i].orders.clock_low.next = false;
            self.channel[i].orders.forced.next = 0.into();
            self.channel[i].orders.watchdog_us.next = 0.into();
            self.channel[i].orders.recovery_min_cycles.next = 0.into();
            self.channel[i].orders.continuous.next = false;
            self.channel[i].orders.stop_at_error.next = false;
            LineOut::link(&mut self.line, &mut self.channel[i].line);
            FrameResultOut::link(&mut self.result, &mut self.channel[i].result);
            FrameEndOut::link(&mut self.end, &mut self.channel[i].end);
            AdditionalDataOut::link(&mut self.record, &mut self.channel[i].record);
            connect!(self <= self.channel[i];
                recovery_cycles, delay_cycles, busy, request_runs, line_high,
                trigger_lost = displaced, reply,
                calibrated, sample_strobe
            );
        }
        self.alarm.next = false;
        self.window.host_word.next = 0.into();
        for i in 0..self._t_formats {
            connect!(self.t_format[i] <= self;
                clock, reset, tick_us, timestamp, trigger, request_id, field_gap_us
            );
            connect!(self.t_format[i] <= self.settings; filter_cycles);
            self.t_format[i].data_i.next = self.line.data_i.val();
            self.t_format[i].bit_cycles.next = self.settings.period_cycles.val().get_bits::<7>(0);
            self.t_format[i].reply_gap_us.next =
                self.settings.start_timeout_us.val().get_bits::<6>(0);
            self.t_format[i].host_address.next = self.window.host_address.val().get_bits::<3>(0);
            connect!(self.t_format[i] <= self.window; host_read, host_write, host_half, host_data);
            self.be_without_endat();
            FrameResultOut::link(&mut self.result, &mut self.t_format[i].result);
            connect!(self.line <= self.t_format[i]; data_o, data_oe);
            connect!(self.end <= self.t_format[i]; over, over_request);
            connect!(self <= self.t_format[i]; busy, trigger_lost);
            self.window.host_word.next = self.t_format[i].host_word.val();
        }
        for i in 0..self._ssis {
            connect!(self.ssi[i] <= self; clock, reset, tick_us, timestamp, trigger);
            connect!(self.ssi[i] <= self.settings;
                period_cycles, first_low_extra_cycles, frame = command, position_bits,
                filter_cycles, recovery_limit_cycles
            );
            self.ssi[i].data_i.next = self.line.data_i.val();
            self.be_without_endat();
            FrameResultOut::link(&mut self.result, &mut self.ssi[i].result);
            self.line.endat_clk.next = self.ssi[i].ssi_clk.val();
            self.line.data_o.next = true;
            self.line.data_oe.next = false;
            self.end.over.next = self.ssi[i].over.val();
            self.end.over_request.next = false;
            connect!(self <= self.ssi[i]; busy, trigger_lost);
        }
        for i in 0..self._served {
            connect!(self.served[i] <= self; clock, reset);
            FrameEndOut::join(&mut self.channel[i].end, &mut self.served[i].end);
            AdditionalDataOut::join(&mut self.channel[i].record, &mut self.served[i].record);
            ServiceOrdersOut::join(&mut self.served[i].orders, &mut self.channel[i].orders);
            connect!(self.served[i] <= self.channel[i];
                request_runs, line_high, displaced, delay_cycles
            );
            connect!(self.served[i] <= self.channel[i].result; sequence, position, fresh);
            connect!(self.served[i] <= self.settings; period_cycles, command, position_bits);
            self.served[i].host_address.next = self.window.host_address.val();
            self.served[i].host_write.next =
                self.window.host_write.val() & !self.window.host_line.val();
            self.served[i].host_half.next = self.window.host_half.val();
            connect!(self.channel[i].settings_in <= self.served[i];
                period_cycles = period_now_cycles, command = command_now,
                position_bits = position_bits_now
            );
            self.channel[i].calibrate.next = self.calibrate.val() | self.served[i].calibrate.val();
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
            self.service[i].host_address.next = self.window.host_address.val();
            self.service[i].host_second.next = false;
            self.service[i].host_read.next =
                self.window.host_read.val() & !self.window.host_line.val();
            self.service[i].host_clear.next = false;
            self.service[i].host_write.next =
                self.window.host_write.val() & !self.window.host_line.val();
            connect!(self.service[i] <= self.window; host_half, host_data);
            self.window.host_word.next = self.service[i].host_word.val();
        }
        for i in 0..self._monitors {
            connect!(self.monitor[i] <= self; clock, reset);
            connect!(self.monitor[i] <= self.channel[i]; busy, edge_measured, edge_offset);
            self.monitor[i].over.next = self.channel[i].end.over.val();
            // With these causes the position is good.
            self.monitor[i].over_bad.next = self.channel[i].end.over_cause.val().any()
                & (self.channel[i].end.over_cause.val() != self.trigger_overrun.val())
                & (self.channel[i].end.over_cause.val() != self.info_missing.val())
                & (self.channel[i].end.over_cause.val() != self.recovery_too_short.val());
            connect!(self.monitor[i] <= self.channel[i]; glitch, phase, calibrated);
            self.monitor[i].host_address.next = self.window.host_address.val().get_bits::<6>(0);
            self.monitor[i].host_read.next =
                self.window.host_read.val() & self.window.host_line.val();
            self.monitor[i].host_write.next =
                self.window.host_write.val() & self.window.host_line.val();
            connect!(self.monitor[i] <= self.window; host_half, host_data);
            connect!(self.channel[i] <= self.monitor[i]; phase_mode, fixed_delay, majority);
            if self.monitor[i].alarm.val() {
                self.alarm.next = true;
            }
            if self.window.host_line.val() {
                self.window.host_word.next = self.monitor[i].host_word.val();
            }
        }
    }

    /// Sets the EnDat outputs to their rest levels.
    fn be_without_endat(&mut self) {
        self.line.endat_clk.next = true;
        self.recovery_cycles.next = 0.into();
        self.delay_cycles.next = 0.into();
        self.request_runs.next = false;
        self.line_high.next = false;
        self.end.over_cause.next = 0.into();
        self.end.over_flags.next = 0.into();
        self.reply.next = 0.into();
        self.end.answer.next = 0.into();
        self.end.reply_good.next = false;
        self.record.info_active.next = 0.into();
        self.record.info_1.next = 0.into();
        self.record.info_2.next = 0.into();
        self.record.info_came.next = 0.into();
        self.record.info_good.next = 0.into();
        self.record.info_crcs.next = 0.into();
        self.calibrated.next = false;
        self.sample_strobe.next = false;
    }
}
