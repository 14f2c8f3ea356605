//! Snapshot: one result per trigger, changed in one clock cycle, with the last good position held.
//!
//! Ref: Liu et al., "Angle encoder data acquisition system based on FPGA", 2024 (held data and error report).

use crate::reg::Reg;
use rust_hdl::prelude::*;

/// Result registers of one channel.
#[derive(LogicBlock, Default)]
pub struct Snapshot {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// Free-running time in system clock cycles.
    pub timestamp: Signal<In, Bits<32>>,
    /// Strobe: the first falling edge of a frame, which latches the position in the encoder.
    pub first_fall: Signal<In, Bit>,
    /// Strobe: the encoder has taken a position by itself, `delay_cycles` ago.
    pub latched: Signal<In, Bit>,
    /// Propagation delay, in system clock cycles.
    pub delay_cycles: Signal<In, Bits<11>>,
    /// Strobe: take the result of a trigger.
    pub publish: Signal<In, Bit>,
    /// With `publish`: the position is good.
    pub good: Signal<In, Bit>,
    /// Strobe: replace cause and flags of the present result; with flag 9 its position is not good any more.
    pub late_fault: Signal<In, Bit>,
    /// Position of the frame.
    pub position_in: Signal<In, Bits<48>>,
    /// CRC as received.
    pub crc_received_in: Signal<In, Bits<5>>,
    /// CRC as computed.
    pub crc_computed_in: Signal<In, Bits<5>>,
    /// Primary cause.
    pub cause_in: Signal<In, Bits<5>>,
    /// Raw flags.
    pub flags_in: Signal<In, Bits<19>>,
    /// Strobe: a new result can be read from this cycle on.
    pub result_strobe: Signal<Out, Bit>,
    /// Last good position, zeros above its width.
    pub position: Signal<Out, Bits<48>>,
    /// There is a good position.
    pub position_valid: Signal<Out, Bit>,
    /// The last result brought the position; low = held from an earlier frame.
    pub fresh: Signal<Out, Bit>,
    /// Number of results, wrapping.
    pub sequence: Signal<Out, Bits<16>>,
    /// Time of the first falling edge of the frame that brought the position.
    pub first_fall_timestamp: Signal<Out, Bits<32>>,
    /// Age of the position in microseconds since its publication; stops at 65535.
    pub age_us: Signal<Out, Bits<16>>,
    /// Primary cause of the last result.
    pub cause: Signal<Out, Bits<5>>,
    /// Raw flags of the last result.
    pub flags: Signal<Out, Bits<19>>,
    /// CRC received in the last whole frame.
    pub crc_received: Signal<Out, Bits<5>>,
    /// CRC computed for the last whole frame.
    pub crc_computed: Signal<Out, Bits<5>>,
    strobe: Reg<Bit>,
    held: Reg<Bits<48>>,
    valid: Reg<Bit>,
    is_fresh: Reg<Bit>,
    count: Reg<Bits<16>>,
    moment: Reg<Bits<32>>,
    stamp: Reg<Bits<32>>,
    age: Reg<Bits<16>>,
    age_full: Reg<Bit>,
    cause_held: Reg<Bits<5>>,
    flags_held: Reg<Bits<19>>,
    received: Reg<Bits<5>>,
    computed: Reg<Bits<5>>,
    take_good: Signal<Local, Bit>,
    ago: Signal<Local, Bits<11>>,
}

impl Logic for Snapshot {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, strobe, held, valid, is_fresh, count, moment, stamp, age);
        dff_setup!(self, clock, age_full, cause_held, flags_held, received, computed);
        self.strobe.reset.next = self.reset.val();
        self.held.reset.next = self.reset.val();
        self.valid.reset.next = self.reset.val();
        self.is_fresh.reset.next = self.reset.val();
        self.count.reset.next = self.reset.val();
        self.moment.reset.next = self.reset.val();
        self.stamp.reset.next = self.reset.val();
        self.age_full.reset.next = self.reset.val();
        self.age.reset.next = self.reset.val();
        self.cause_held.reset.next = self.reset.val();
        self.flags_held.reset.next = self.reset.val();
        self.received.reset.next = self.reset.val();
        self.computed.reset.next = self.reset.val();

        self.take_good.next = self.publish.val() & self.good.val();
        self.ago.next = 0.into();
        if self.latched.val() {
            self.ago.next = self.delay_cycles.val();
        }
        if self.first_fall.val() | self.latched.val() {
            self.moment.d.next = self.timestamp.val() - bit_cast::<32, 11>(self.ago.val());
        }
        self.age_full.d.next = self.age.q.val().all();
        if self.tick_us.val() & !self.age_full.q.val() {
            self.age.d.next = self.age.q.val() + 1;
        }
        self.strobe.d.next = self.publish.val();
        if self.publish.val() {
            self.is_fresh.d.next = self.good.val();
            self.count.d.next = self.count.q.val() + 1;
            self.received.d.next = self.crc_received_in.val();
            self.computed.d.next = self.crc_computed_in.val();
        }
        if self.take_good.val() {
            self.held.d.next = self.position_in.val();
            self.stamp.d.next = self.moment.q.val();
            self.valid.d.next = true;
            self.age.d.next = 0.into();
        }
        // A frame of another length: its position may be anything.
        if self.late_fault.val() & self.flags_in.val().get_bit(9) {
            self.valid.d.next = false;
            self.is_fresh.d.next = false;
        }
        if self.publish.val() | self.late_fault.val() {
            self.cause_held.d.next = self.cause_in.val();
            self.flags_held.d.next = self.flags_in.val();
        }
        self.result_strobe.next = self.strobe.q.val();
        self.position.next = self.held.q.val();
        self.position_valid.next = self.valid.q.val();
        self.fresh.next = self.is_fresh.q.val();
        self.sequence.next = self.count.q.val();
        self.first_fall_timestamp.next = self.stamp.q.val();
        self.age_us.next = self.age.q.val();
        self.cause.next = self.cause_held.q.val();
        self.flags.next = self.flags_held.q.val();
        self.crc_received.next = self.received.q.val();
        self.crc_computed.next = self.computed.q.val();
    }
}
