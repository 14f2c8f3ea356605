//! Snapshot: one result per trigger, changed in one clock cycle, with the last good position held.
//!
//! ```text
//! publish    __/\__________________    position, time stamp and check bits are exchanged with the previous ones
//! confirm    ____________/\________    the frame has ended normally: the previous result is discarded
//! withdraw   ____________/\________    the frame has failed: the previous result returns
//! ```
//!
//! <!-- without restores -->
//! No position is valid after `withdraw`, until the next good one.
//!
//! <!-- end -->
//! <!-- with has_guards -->
//! The parity of the held values is stored after loading, and compared in every cycle from then on. A register that was upset makes
//! the position invalid, with a separate cause.
//!
//! <!-- end -->
//! Ref: Liu et al., "Angle encoder data acquisition system based on FPGA", 2024 (held data and error report).

use crate::endat::ports::ToldIn;
use crate::ports::FrameResultOut;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Result registers of one channel.
#[derive(LogicBlock, Block)]
#[properties("properties/snapshot.sv")]
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
    /// Strobe: the encoder has latched a position by itself, `delay_cycles` ago.
    pub latched: Signal<In, Bit>,
    /// Propagation delay, in system clock cycles.
    pub delay_cycles: Signal<In, Bits<11>>,
    /// Outcome of a frame.
    #[bundle]
    pub told: ToldIn,
    /// Position of the frame.
    pub position_in: Signal<In, Bits<48>>,
    /// Width of the position.
    pub width_in: Signal<In, Bits<6>>,
    /// The frame has F2.
    pub has_f2_in: Signal<In, Bit>,
    /// CRC as received.
    pub crc_received_in: Signal<In, Bits<5>>,
    /// CRC as computed.
    pub crc_computed_in: Signal<In, Bits<5>>,
    /// Result of a trigger.
    #[bundle]
    pub result: FrameResultOut,
    /// Strobe: the source of the position loads the held position in exchange.
    pub swap: Signal<Out, Bit>,
    /// High for one cycle when a new result can be read.
    strobe: Reg<Bit>,
    /// High in the first cycle after a good position was loaded: its parity is stored then.
    loaded: Reg<Bit>,
    /// Published position.
    held: Reg<Bits<48>>,
    /// CRC received with the published position.
    held_crc: Reg<Bits<5>>,
    /// Width of the published position.
    held_width: Reg<Bits<6>>,
    /// High if the published position came with F2.
    held_f2: Reg<Bit>,
    /// Position before the published one, until the new one is confirmed.
    earlier: Reg<Bits<48>>,
    /// CRC of the previous position.
    earlier_crc: Reg<Bits<5>>,
    /// Width of the previous position.
    earlier_width: Reg<Bits<6>>,
    /// High if the previous position came with F2.
    earlier_f2: Reg<Bit>,
    /// High if the previous position was valid.
    earlier_valid: Reg<Bit>,
    /// Parity of the previous position.
    earlier_parity: Reg<Bit>,
    /// High from a good result until its frame is confirmed or withdrawn.
    unconfirmed: Reg<Bit>,
    /// Parity of the published position, taken when it was loaded.
    parity: Reg<Bit>,
    /// High for one cycle after the pending time stamp was taken; its parity is stored then.
    timed: Reg<Bit>,
    /// Parity of the pending time stamp, stored when it was taken.
    pending_parity: Reg<Bit>,
    /// Parity of the pending time stamp in the cycle before.
    pending_sum: Reg<Bit>,
    /// High if the published position or its time stamp differed from its parity in the cycle before.
    is_upset: Reg<Bit>,
    /// High while a valid position is published.
    valid: Reg<Bit>,
    /// High if the last result brought a good position.
    is_fresh: Reg<Bit>,
    /// Number of results, wrapping.
    count: Reg<Bits<16>>,
    /// Time stamp of the frame under way; from a result to the end of the frame that of the previous position, if it can return.
    stamp_pending: Reg<Bits<32>>,
    /// Time stamp of the published position.
    stamp: Reg<Bits<32>>,
    /// Age of the position in microseconds, up to 65535.
    age: Reg<Bits<16>>,
    /// High when the age has reached 65535.
    age_full: Reg<Bit>,
    /// Primary cause of the last result, or of a fault after it.
    cause_held: Reg<Bits<5>>,
    /// Raw flags of the last result, or of a fault after it.
    flags_held: Reg<Bits<20>>,
    /// CRC received with the last result.
    received: Reg<Bits<5>>,
    /// CRC computed for the last result.
    computed: Reg<Bits<5>>,
    /// High for one cycle when a good position is published.
    take_good: Signal<Local, Bit>,
    /// High for one cycle when the published position is withdrawn.
    take_back: Signal<Local, Bit>,
    /// Parity of the published time stamp as stored.
    stamp_sum: Signal<Local, Bit>,
    /// Parity of the published position, with its CRC, width, F2 and time stamp, as stored.
    parity_now: Signal<Local, Bit>,
    /// High if an upset makes the published position invalid in this cycle.
    upset_now: Signal<Local, Bit>,
    /// High if the pending time stamp differs from its parity when a good position comes.
    pending_wrong: Signal<Local, Bit>,
    /// Cycles since the position was latched: the line delay if the encoder latched it by itself, else 0.
    ago: Signal<Local, Bits<11>>,
    /// Age at the output: 0 while the position is not confirmed and the previous one can return.
    age_now: Signal<Local, Bits<16>>,
    /// 1 if stored positions are checked against their parity.
    has_guards: Constant<Bit>,
    /// 1 if the previous position replaces a withdrawn one.
    restores: Constant<Bit>,
    /// 1 if the source of the position stores the previous one, in exchange.
    swaps: Constant<Bit>,
    /// 1 if this block stores the previous position.
    keeps: Constant<Bit>,
    /// 1 if positions are never withdrawn.
    never_withdraws: Constant<Bit>,
    /// 1 if each position can be withdrawn until the next result.
    never_confirms: Constant<Bit>,
    /// Cause of an upset in the stored position.
    upset_cause: Constant<Bits<5>>,
    /// Raw flag of an upset in the stored position.
    upset_flag: Constant<Bits<20>>,
}

/// Treatment of a published position that the encoder withdraws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Withdrawal {
    /// The previous position returns, with its time stamp; this block stores it meanwhile.
    Restores,
    /// The previous position returns; the receiver's word stores it in exchange.
    Swaps,
    /// No position is valid.
    Clears,
    /// No position is valid. The protocol has no confirmation: each position may be withdrawn until the next result.
    ClearsLate,
    /// Positions are never withdrawn: all faults are known when the result comes.
    Never,
}

impl Snapshot {
    /// A snapshot with this cause and flag for an upset of a stored bit; `guards` check for such upsets.
    pub fn new(withdrawal: Withdrawal, guards: bool, upset_cause: u64, upset_flag: u64) -> Self {
        Self::from_parts(SnapshotParts {
            has_guards: Constant::new(guards),
            restores: Constant::new(matches!(
                withdrawal,
                Withdrawal::Restores | Withdrawal::Swaps
            )),
            swaps: Constant::new(withdrawal == Withdrawal::Swaps),
            keeps: Constant::new(withdrawal == Withdrawal::Restores),
            never_withdraws: Constant::new(withdrawal == Withdrawal::Never),
            never_confirms: Constant::new(withdrawal == Withdrawal::ClearsLate),
            upset_cause: Constant::new(upset_cause.into()),
            upset_flag: Constant::new(upset_flag.into()),
        })
    }
}

#[kernel]
impl Logic for Snapshot {
    fn update(&mut self) {
        // The time stamp waits for its position during a whole frame, so a guard checks it, too.
        self.timed.d.next = self.first_fall.val() | self.latched.val();
        if self.timed.q.val() {
            self.pending_parity.d.next = self.stamp_pending.q.val().xor();
        }
        // Parity is registered one cycle early: a 32-bit XOR in the load path would miss timing.
        self.pending_sum.d.next = self.stamp_pending.q.val().xor();
        self.pending_wrong.next = self.has_guards.val()
            & self.told.good.val()
            & !self.timed.q.val()
            & (self.pending_sum.q.val() ^ self.pending_parity.q.val());
        self.take_good.next =
            self.told.publish.val() & self.told.good.val() & !self.pending_wrong.val();
        self.take_back.next =
            self.told.withdraw.val() & (self.unconfirmed.q.val() | self.never_confirms.val());
        self.ago.next = 0.into();
        if self.latched.val() {
            self.ago.next = self.delay_cycles.val();
        }
        // Between a result and the end of its frame `stamp_pending` stores the time stamp of the previous position.
        if self.restores.val() & self.take_good.val() {
            self.stamp_pending.d.next = self.stamp.q.val();
        }
        if self.first_fall.val() | self.latched.val() {
            self.stamp_pending.d.next = self.timestamp.val() - bit_cast::<32, 11>(self.ago.val());
        }
        // The age of a position that may return continues until the new one is confirmed, so that a series of withdrawn positions cannot make it look fresh.
        self.age_full.d.next = self.age.q.val().all();
        if self.tick_us.val() & !self.age_full.q.val() {
            self.age.d.next = self.age.q.val() + 1;
        }
        self.age_now.next = self.age.q.val();
        if self.restores.val() & self.unconfirmed.q.val() {
            self.age_now.next = 0.into();
        }
        if self.unconfirmed.q.val() & (self.told.confirm.val() | !self.restores.val()) {
            self.age.d.next = 0.into();
        }
        if !self.restores.val() & self.take_good.val() {
            self.age.d.next = 0.into();
        }
        self.strobe.d.next = self.told.publish.val();
        if self.told.publish.val() {
            self.is_fresh.d.next = self.told.good.val() & !self.pending_wrong.val();
            self.count.d.next = self.count.q.val() + 1;
            self.received.d.next = self.crc_received_in.val();
            self.computed.d.next = self.crc_computed_in.val();
        }
        self.loaded.d.next = self.take_good.val();
        if self.take_good.val() {
            self.held.d.next = self.position_in.val();
            self.held_crc.d.next = self.crc_received_in.val();
            self.held_width.d.next = self.width_in.val();
            self.held_f2.d.next = self.has_f2_in.val();
            self.stamp.d.next = self.stamp_pending.q.val();
            self.valid.d.next = true;
            if self.restores.val() {
                if self.keeps.val() {
                    self.earlier.d.next = self.held.q.val();
                    self.earlier_crc.d.next = self.held_crc.q.val();
                }
                self.earlier_width.d.next = self.held_width.q.val();
                self.earlier_f2.d.next = self.held_f2.q.val();
                self.earlier_valid.d.next = self.valid.q.val();
                if self.has_guards.val() {
                    self.earlier_parity.d.next = self.parity.q.val();
                }
            }
        }
        if self.told.confirm.val() | self.take_back.val() {
            self.unconfirmed.d.next = false;
        }
        if self.take_good.val() {
            self.unconfirmed.d.next = true;
        }

        // The guard. In the first cycle it checks the time stamp that was just loaded against the parity of the pending one; the CRC has
        // checked the position.
        self.stamp_sum.next = self.stamp.q.val().xor();
        self.parity_now.next = self.held.q.val().xor()
            ^ self.stamp_sum.val()
            ^ self.held_crc.q.val().xor()
            ^ self.held_width.q.val().xor()
            ^ self.held_f2.q.val();
        self.is_upset.d.next = self.has_guards.val()
            & (self.parity_now.val() ^ self.parity.q.val())
            & !self.loaded.q.val()
            & !self.take_good.val()
            & !self.take_back.val();
        if self.has_guards.val() & self.loaded.q.val() {
            self.parity.d.next = self.parity_now.val();
            self.is_upset.d.next = self.stamp_sum.val() ^ self.pending_parity.q.val();
        }
        if self.take_back.val() {
            if self.restores.val() {
                self.held.d.next = self.position_in.val();
                self.held_crc.d.next = self.crc_received_in.val();
                if self.keeps.val() {
                    self.held.d.next = self.earlier.q.val();
                    self.held_crc.d.next = self.earlier_crc.q.val();
                }
                self.held_width.d.next = self.earlier_width.q.val();
                self.held_f2.d.next = self.earlier_f2.q.val();
                self.stamp.d.next = self.stamp_pending.q.val();
                self.valid.d.next = self.earlier_valid.q.val();
                if self.has_guards.val() {
                    self.parity.d.next = self.earlier_parity.q.val();
                }
            } else {
                self.valid.d.next = false;
            }
            self.is_fresh.d.next = false;
        }
        if self.told.publish.val() | self.told.late_fault.val() {
            self.cause_held.d.next = self.told.cause_told.val();
            self.flags_held.d.next = self.told.flags_told.val();
        }
        self.upset_now.next = self.is_upset.q.val() & !self.take_good.val() & self.valid.q.val();
        if self.upset_now.val() {
            self.valid.d.next = false;
            self.is_fresh.d.next = false;
            self.cause_held.d.next = self.upset_cause.val();
            self.flags_held.d.next = self.flags_held.q.val() | self.upset_flag.val();
        }
        if self.told.publish.val() & self.pending_wrong.val() {
            self.cause_held.d.next = self.upset_cause.val();
            self.flags_held.d.next = self.told.flags_told.val() | self.upset_flag.val();
        }
        self.swap.next = self.swaps.val() & self.take_good.val();
        self.result.result_strobe.next = self.strobe.q.val();
        self.result.position.next = self.held.q.val();
        self.result.position_valid.next = self.valid.q.val();
        self.result.fresh.next = self.is_fresh.q.val();
        self.result.sequence.next = self.count.q.val();
        self.result.first_fall_timestamp.next = self.stamp.q.val();
        self.result.age_us.next = self.age_now.val();
        self.result.cause.next = self.cause_held.q.val();
        self.result.flags.next = self.flags_held.q.val();
        self.result.crc_received.next = self.received.q.val();
        self.result.crc_computed.next = self.computed.q.val();
        self.result.position_crc.next = self.held_crc.q.val();
        self.result.position_width.next = self.held_width.q.val();
        self.result.position_has_f2.next = self.held_f2.q.val();
    }
}
