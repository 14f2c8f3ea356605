//! A channel's side of the service: the ports of the program.
//!
//! ```text
//! ends of frames, additional data, answers --> io_in --> Service
//! requests, levels, width, clock <-- io_out, io_write <---'
//! ```

use super::map::input;
use crate::ports::{AdditionalDataIn, FrameEndIn, ServiceOrdersOut};
use crate::replicate::each;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// The service's part for a channel.
#[derive(LogicBlock, Block)]
pub struct ServiceChannel {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// A frame, triggered or not, has ended.
    #[bundle]
    pub end: FrameEndIn,
    /// Record of the additional data that follow each position.
    #[bundle]
    pub record: AdditionalDataIn,
    /// The frame under way carries the request.
    pub request_runs: Signal<In, Bit>,
    /// DATA is HIGH, and no frame is on the wire.
    pub line_high: Signal<In, Bit>,
    /// Strobe: a trigger is lost.
    pub displaced: Signal<In, Bit>,
    /// Number of results.
    pub sequence: Signal<In, Bits<16>>,
    /// Last good position.
    pub position: Signal<In, Bits<48>>,
    /// The last result brought the position.
    pub fresh: Signal<In, Bit>,
    /// Tracked line delay, in system clock cycles.
    pub delay_cycles: Signal<In, Bits<11>>,
    /// Configured EnDat clock period, in system clock cycles.
    pub period_cycles: Signal<In, Bits<11>>,
    /// Configured mode command.
    pub command: Signal<In, Bits<6>>,
    /// Configured position width.
    pub position_bits: Signal<In, Bits<6>>,
    /// EnDat clock period for the channel.
    pub period_now_cycles: Signal<Out, Bits<11>>,
    /// Mode command for the channel.
    pub command_now: Signal<Out, Bits<6>>,
    /// Position width for the channel.
    pub position_bits_now: Signal<Out, Bits<6>>,
    /// Requests of the service to its channel.
    #[bundle]
    pub orders: ServiceOrdersOut,
    /// Strobe: the next frame measures the line delay.
    pub calibrate: Signal<Out, Bit>,
    /// The channel's alarm.
    pub alarm: Signal<Out, Bit>,
    /// Port that the program reads or writes.
    pub io_address: Signal<In, Bits<5>>,
    /// Strobe: the program reads the port.
    pub io_read: Signal<In, Bit>,
    /// In the next cycle the value of the port; otherwise 0.
    pub io_in: Signal<Out, Bits<16>>,
    /// Value to write.
    pub io_out: Signal<In, Bits<16>>,
    /// Strobe: the program writes the port.
    pub io_write: Signal<In, Bit>,
    /// Word of RAM that the host writes; stable from one strobe to the next, at least 8 cycles.
    pub host_address: Signal<In, Bits<7>>,
    /// Strobe: the host writes one half of the word.
    pub host_write: Signal<In, Bit>,
    /// Half to write: 1 = high. If written last, the low half acts.
    pub host_half: Signal<In, Bit>,
    /// Set when a frame ends; cleared by the program.
    has_event: Reg<Bit>,
    /// Set when a frame ends before the program has read the previous one; cleared by the program.
    missed: Reg<Bit>,
    /// High if the last frame carried the request.
    event_request: Reg<Bit>,
    /// Primary cause of the last frame.
    event_cause: Reg<Bits<5>>,
    /// Set when the host writes a request; cleared by the program.
    request_written: Reg<Bit>,
    /// Set when the host writes the control word; cleared by the program.
    control_written: Reg<Bit>,
    /// Set when the host writes either half of a word; cleared by the program.
    written: Reg<Bit>,
    /// Lost triggers, modulo 65536.
    lost_count: Reg<Bits<16>>,
    /// Mode command of the request.
    out_command: Reg<Bits<6>>,
    /// MRS code, address or port of the request.
    out_address: Reg<Bits<8>>,
    /// Data of the request.
    out_data: Reg<Bits<16>>,
    /// Strobes: bit 0 sends the request with a trigger, 1 in a separate frame, 2 cancels it, 3 measures the delay.
    out_go: Reg<Bits<4>>,
    // Triggers must not interfere until the program has started.
    /// Bit 0 holds frames off, 1 keeps the clock low, 2 is the channel's alarm.
    #[given]
    out_control: Reg<Bits<3>>,
    /// Faults forced by a test.
    out_force: Reg<Bits<5>>,
    /// Position width found, 0 if none; bit 6: frames use mode command 000111.
    out_found: Reg<Bits<7>>,
    /// EnDat clock period in system clock cycles; 0 = as configured.
    out_period: Reg<Bits<11>>,
    /// Longest time of a frame, in microseconds; 0 = not watched.
    out_watchdog: Reg<Bits<12>>,
    /// Shortest recovery time, in system clock cycles; 0 = not checked.
    out_recovery: Reg<Bits<13>>,
    /// Bit 0: the clock continues after each position; bit 1: it stops after an error.
    out_continuous: Reg<Bits<2>>,
    /// Status of the channel for the program.
    status: Signal<Local, Bits<16>>,
    /// Answer to a request, if it arrived MSB first.
    turned: Signal<Local, Bits<24>>,
    /// One bit for each port: the program reads it.
    chosen: Signal<Local, Bits<32>>,
    /// Word of each port in the cycle after the program reads it, otherwise 0.
    seen: Vec<Reg<Bits<16>>>,
    _words: usize,
    /// 1 if the encoder is set to the short recovery time.
    wants_short: Constant<Bit>,
}

impl ServiceChannel {
    /// A channel part that sets the encoder to the short recovery time if `wants_short`, and initialises it after reset if
    /// `initialise`.
    pub fn new(wants_short: bool, initialise: bool) -> Self {
        Self::from_parts(ServiceChannelParts {
            out_control: Reg::new(u64::from(initialise).into()),
            seen: each(usize::from(input::WORDS)),
            _words: input::WORDS.into(),
            wants_short: Constant::new(wants_short),
        })
    }
}

#[kernel]
impl Logic for ServiceChannel {
    fn update(&mut self) {
        if self.displaced.val() {
            self.lost_count.d.next = self.lost_count.q.val() + 1;
        }

        // Ports read by the program.
        self.status.next = bit_cast::<16, 1>(self.has_event.q.val().into())
            | (bit_cast::<16, 1>(self.event_request.q.val().into()) << 1)
            | (bit_cast::<16, 1>(self.request_written.q.val().into()) << 2)
            | (bit_cast::<16, 1>(self.control_written.q.val().into()) << 3)
            | (bit_cast::<16, 1>(self.line_high.val().into()) << 4)
            | (bit_cast::<16, 1>(self.end.reply_good.val().into()) << 5)
            | (bit_cast::<16, 2>(self.record.info_good.val()) << 6)
            | (bit_cast::<16, 1>(self.record.info_active.val().get_bits::<1>(0)) << 8)
            | (bit_cast::<16, 1>(self.missed.q.val().into()) << 9)
            | (bit_cast::<16, 1>(self.fresh.val().into()) << 10)
            | (bit_cast::<16, 1>(self.request_runs.val().into()) << 11)
            | (bit_cast::<16, 2>(self.record.info_came.val()) << 12)
            | (bit_cast::<16, 1>(self.written.q.val().into()) << 14);
        // Words that arrive MSB first are reversed in the answer.
        self.turned.next = 0.into();
        for i in 0..24 {
            self.turned.next = self
                .turned
                .val()
                .replace_bit(23 - i, self.end.answer.val().get_bit(i));
        }
        self.seen[0].d.next = self.status.val();
        self.seen[1].d.next = bit_cast::<16, 5>(self.event_cause.q.val());
        self.seen[2].d.next = self.record.info_1.val().get_bits::<16>(0);
        self.seen[3].d.next = bit_cast::<16, 8>(self.record.info_1.val().get_bits::<8>(16));
        self.seen[4].d.next = self.record.info_2.val().get_bits::<16>(0);
        self.seen[5].d.next = bit_cast::<16, 8>(self.record.info_2.val().get_bits::<8>(16));
        self.seen[6].d.next = self.end.answer.val().get_bits::<16>(0);
        self.seen[7].d.next = self.end.answer.val().get_bits::<16>(16);
        self.seen[8].d.next = self.end.answer.val().get_bits::<16>(32);
        self.seen[9].d.next = self.turned.val().get_bits::<16>(0);
        self.seen[10].d.next = bit_cast::<16, 8>(self.turned.val().get_bits::<8>(16));
        self.seen[11].d.next = self.lost_count.q.val();
        self.seen[12].d.next = self.sequence.val();
        self.seen[13].d.next = self.position.val().get_bits::<16>(0);
        self.seen[14].d.next = self.position.val().get_bits::<16>(16);
        self.seen[15].d.next = self.position.val().get_bits::<16>(32);
        self.seen[16].d.next = bit_cast::<16, 6>(self.position_bits.val())
            | (bit_cast::<16, 1>(self.command.val().get_bits::<1>(5)) << 6)
            | (bit_cast::<16, 1>(self.wants_short.val().into()) << 7);
        self.seen[17].d.next = bit_cast::<16, 11>(self.period_cycles.val());
        self.seen[18].d.next = bit_cast::<16, 11>(self.delay_cycles.val());
        // Deselected registers are reset, which takes no logic, so an OR replaces a multiplexer.
        self.chosen.next = 0.into();
        if self.io_read.val() {
            self.chosen.next = bit_cast::<32, 1>(1.into()) << self.io_address.val();
        }
        for i in 0..self._words {
            self.seen[i].clock.next = self.clock.val();
            self.seen[i].reset.next = !self.chosen.val().get_bit(i);
        }
        self.io_in.next = self.seen[0].q.val()
            | self.seen[1].q.val()
            | self.seen[2].q.val()
            | self.seen[3].q.val()
            | self.seen[4].q.val()
            | self.seen[5].q.val()
            | self.seen[6].q.val()
            | self.seen[7].q.val()
            | self.seen[8].q.val()
            | self.seen[9].q.val()
            | self.seen[10].q.val()
            | self.seen[11].q.val()
            | self.seen[12].q.val()
            | self.seen[13].q.val()
            | self.seen[14].q.val()
            | self.seen[15].q.val()
            | self.seen[16].q.val()
            | self.seen[17].q.val()
            | self.seen[18].q.val();

        // Ports written by the program.
        self.out_go.d.next = 0.into();
        if self.io_write.val() {
            match self.io_address.val().index() {
                0 => {
                    if self.io_out.val().get_bit(0) {
                        self.has_event.d.next = false;
                        self.missed.d.next = false;
                    }
                    if self.io_out.val().get_bit(1) {
                        self.request_written.d.next = false;
                    }
                    if self.io_out.val().get_bit(2) {
                        self.control_written.d.next = false;
                    }
                    if self.io_out.val().get_bit(3) {
                        self.written.d.next = false;
                    }
                }
                1 => {
                    self.out_command.d.next = self.io_out.val().get_bits::<6>(0);
                }
                2 => {
                    self.out_address.d.next = self.io_out.val().get_bits::<8>(0);
                }
                3 => {
                    self.out_data.d.next = self.io_out.val();
                }
                4 => {
                    self.out_go.d.next = self.io_out.val().get_bits::<4>(0);
                }
                5 => {
                    self.out_control.d.next = self.io_out.val().get_bits::<3>(0);
                }
                6 => {
                    self.out_force.d.next = self.io_out.val().get_bits::<5>(0);
                }
                7 => {
                    self.out_found.d.next = self.io_out.val().get_bits::<7>(0);
                }
                8 => {
                    self.out_period.d.next = self.io_out.val().get_bits::<11>(0);
                }
                9 => {
                    self.out_watchdog.d.next = self.io_out.val().get_bits::<12>(0);
                }
                10 => {
                    self.out_recovery.d.next = self.io_out.val().get_bits::<13>(0);
                }
                11 => {
                    self.out_continuous.d.next = self.io_out.val().get_bits::<2>(0);
                }
                _ => {}
            }
        }
        if self.end.over.val() {
            self.has_event.d.next = true;
            self.missed.d.next = self.has_event.q.val();
            self.event_request.d.next = self.end.over_request.val();
            self.event_cause.d.next = self.end.over_cause.val();
        }
        if self.host_write.val() {
            self.written.d.next = true;
        }
        if self.host_write.val() & !self.host_half.val() {
            if self.host_address.val() == 0 {
                self.request_written.d.next = true;
            }
            if self.host_address.val() == 5 {
                self.control_written.d.next = true;
            }
        }

        self.orders.request_command.next = self.out_command.q.val();
        self.orders.request_parameter.next = bit_cast::<24, 16>(self.out_data.q.val())
            | (bit_cast::<24, 8>(self.out_address.q.val()) << 16);
        self.orders.request_ride.next = self.out_go.q.val().get_bit(0);
        self.orders.request_own.next = self.out_go.q.val().get_bit(1);
        self.orders.request_cancel.next = self.out_go.q.val().get_bit(2);
        self.calibrate.next = self.out_go.q.val().get_bit(3);
        self.orders.hold_off.next = self.out_control.q.val().get_bit(0);
        self.orders.clock_low.next = self.out_control.q.val().get_bit(1);
        self.alarm.next = self.out_control.q.val().get_bit(2);
        self.orders.forced.next = self.out_force.q.val();
        self.orders.watchdog_us.next = self.out_watchdog.q.val();
        self.orders.recovery_min_cycles.next = self.out_recovery.q.val();
        self.orders.continuous.next = self.out_continuous.q.val().get_bit(0);
        self.orders.stop_at_error.next = self.out_continuous.q.val().get_bit(1);
        self.period_now_cycles.next = self.period_cycles.val();
        if self.out_period.q.val().any() {
            self.period_now_cycles.next = self.out_period.q.val();
        }
        self.position_bits_now.next = self.position_bits.val();
        self.command_now.next = self.command.val();
        if self.out_found.q.val().get_bits::<6>(0).any() {
            self.position_bits_now.next = self.out_found.q.val().get_bits::<6>(0);
            if self.out_found.q.val().get_bit(6) {
                self.command_now.next = 7.into();
            }
        }
    }
}
