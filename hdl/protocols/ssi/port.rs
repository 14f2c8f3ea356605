//! SSI port: one encoder as a channel of a card, with the result registers that EnDat channels have.
//!
//! ```text
//! state    REST| LOW |HIGH | LOW |HIGH |  ...  | LOW |   LAST   |  RECOVERY   |REST
//! clk   ~~~~~~~\_____/~~~~~\_____/~~~~~~  ...  \_____/~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~
//! data  ~~~~~~~~~~~~~~< msb      >< ...     >< lsb   >\_________________/~~~~~~~~~~
//!              HIGH? ^           ^ taken             ^ taken    ^ LOW? result   ^ HIGH? if not: withdrawn
//! ```
//!
//! A frame is good only if all of its bits have come. With `frame` bit 1 the clock goes on: a LOW bit, and the same position once more.
//!
//! `RECOVERY` ends when DATA is HIGH, since the encoder is ready then. After a reset, an upset, or a frame at whose end DATA was HIGH, it lasts
//! for the whole recovery time: the encoder may be in the middle of a frame, where DATA is any of its bits.
//! <!-- with has_guards -->
//!
//! Guards against upsets: the codes of the states differ in two bits, the clock is what the state says, bits and the edge that takes none are
//! counted twice.
//! <!-- end -->

use super::asked::SsiSpec;
use super::cause;
use super::special_bits::SpecialBits;
use crate::endat::features::Features;
use crate::input_filter::InputFilter;
use crate::lowest_cause::LowestCause;
use crate::ports::FrameResultOut;
use crate::snapshot::{Snapshot, Withdrawal};
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

pub use endat_regs::protocols::ssi::frame;

/// Port of one SSI encoder.
#[derive(LogicBlock, Block)]
#[properties("../../properties/ssi_port.sv")]
pub struct SsiPort {
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
    /// Line from the transceiver, asynchronous, HIGH at rest.
    pub data_i: Signal<In, Bit>,
    /// Clock period, in system clock cycles, 4 to 2047; fewer count as 4 more. Constant while `busy`, as all settings.
    pub period_cycles: Signal<In, Bits<11>>,
    /// How much longer than half a period the first low phase is.
    pub first_low_extra_cycles: Signal<In, Bits<11>>,
    /// Kind of frame: bit 0 Gray code, bit 1 each position twice, bit 2 a frame may go out, bit 3 parity.
    pub frame: Signal<In, Bits<6>>,
    /// Position width, 1 to 48 bits.
    pub position_bits: Signal<In, Bits<6>>,
    /// Pulses of at most this many system clock cycles are ignored.
    pub filter_cycles: Signal<In, Bits<4>>,
    /// DATA is HIGH again at the latest after so many system clock cycles (tm).
    pub recovery_limit_cycles: Signal<In, Bits<13>>,
    /// Clock to the transceiver, from a register, HIGH at rest.
    pub ssi_clk: Signal<Out, Bit>,
    /// A trigger would not be taken.
    pub busy: Signal<Out, Bit>,
    /// Strobe: a frame has ended.
    pub over: Signal<Out, Bit>,
    /// Strobe: a trigger has been lost.
    pub displaced: Signal<Out, Bit>,
    /// Result of a trigger.
    #[bundle]
    pub result: FrameResultOut,
    filter: InputFilter,
    #[start]
    primary: LowestCause,
    snapshot: Snapshot,
    special: Vec<SpecialBits>,
    // As after a frame of which nothing is known: a reset may have come in the middle of one.
    #[start(STATE_LAST.into())]
    state: Reg<Bits<4>>,
    #[start(true)]
    clk: Reg<Bit>,
    timer: Reg<Bits<13>>,
    left: Reg<Bits<6>>,
    left_too: Reg<Bits<6>>,
    torn: Reg<Bit>,
    // The next rising edge brings no bit: the first one of a copy. In `LAST`: wait for another period.
    #[start(true)]
    first: Reg<Bit>,
    #[start(true)]
    first_too: Reg<Bit>,
    second: Reg<Bit>,
    word: Reg<Bits<48>>,
    again: Reg<Bits<48>>,
    sum: Reg<Bit>,
    ones: Reg<Bit>,
    not_even: Reg<Bit>,
    #[start(true)]
    not_low: Reg<Bit>,
    lost: Reg<Bit>,
    // `displaced`.
    is_lost: Reg<Bit>,
    slow: Reg<Bit>,
    fallen: Reg<Bit>,
    // With `not_low`: a reset has come, no frame.
    #[start(true)]
    unknown: Reg<Bit>,
    not_high: Reg<Bit>,
    period: Signal<Local, Bits<11>>,
    low_cycles: Signal<Local, Bits<11>>,
    high_cycles: Signal<Local, Bits<11>>,
    is_due: Signal<Local, Bit>,
    is_last: Signal<Local, Bit>,
    takes_bit: Signal<Local, Bit>,
    bits: Signal<Local, Bits<6>>,
    is_position: Signal<Local, Bit>,
    special_found: Signal<Local, Bits<12>>,
    shown: Signal<Local, Bits<8>>,
    ends_copy: Signal<Local, Bit>,
    is_parity: Signal<Local, Bit>,
    bit_before: Signal<Local, Bit>,
    value: Signal<Local, Bit>,
    is_other: Signal<Local, Bit>,
    is_astray: Signal<Local, Bit>,
    is_torn: Signal<Local, Bit>,
    is_short: Signal<Local, Bit>,
    is_upset: Signal<Local, Bit>,
    publishes: Signal<Local, Bit>,
    ready: Signal<Local, Bit>,
    is_late: Signal<Local, Bit>,
    good: Signal<Local, Bit>,
    loses: Signal<Local, Bit>,
    found: Signal<Local, Bits<6>>,
    raised: Signal<Local, Bits<16>>,
    has_guards: Constant<Bit>,
    // Nothing can be said of DATA after the last bit: no check there, and the recovery time lasts as long as it may.
    holds_end: Constant<Bit>,
    at_rest: Constant<Bits<4>>,
    at_low: Constant<Bits<4>>,
    at_high: Constant<Bits<4>>,
    at_last: Constant<Bits<4>>,
    at_recovery: Constant<Bits<4>>,
    at_judge: Constant<Bits<4>>,
    _specials: usize,
}

/// Codes of the states. Each has an even number of ones, so that no upset of one bit makes another state.
const STATE_REST: u64 = 0;
const STATE_LOW: u64 = 3;
const STATE_HIGH: u64 = 5;
const STATE_LAST: u64 = 6;
const STATE_RECOVERY: u64 = 9;
const STATE_JUDGE: u64 = 10;

impl SsiPort {
    /// For what is asked, as far as no setting says it: special bits, and how a frame ends; `guards` look for upsets of stored bits.
    pub fn new(asked: &SsiSpec, guards: bool) -> Self {
        let special: Vec<SpecialBits> = match asked.has_specials() {
            true => vec![SpecialBits::new(&asked.before, &asked.after, guards)],
            false => vec![],
        };
        Self::from_parts(SsiPortParts {
            _specials: special.len(),
            special,
            has_guards: Constant::new(guards),
            holds_end: Constant::new(asked.holds_end),
            filter: InputFilter::new(Features::NONE),
            snapshot: Snapshot::new(
                Withdrawal::ClearsLate,
                guards,
                cause::UPSET,
                cause::flag(cause::UPSET),
            ),
            at_rest: Constant::new(STATE_REST.into()),
            at_low: Constant::new(STATE_LOW.into()),
            at_high: Constant::new(STATE_HIGH.into()),
            at_last: Constant::new(STATE_LAST.into()),
            at_recovery: Constant::new(STATE_RECOVERY.into()),
            at_judge: Constant::new(STATE_JUDGE.into()),
        })
    }
}

#[kernel]
impl Logic for SsiPort {
    fn update(&mut self) {
        clock!(self, clock, filter, snapshot);
        self.filter.reset.next = self.reset.val();
        self.snapshot.reset.next = self.reset.val();
        connect!(self.filter <= self; pin = data_i, filter_cycles);
        self.filter.filter_half.next = false;
        self.filter.majority.next = false;
        self.filter.both_edges.next = false;
        self.time_clock();
        self.clock_frame();
        self.take_bits();
        self.look_at_special_bits();
        self.recover();
        self.judge();
        self.show_result();
    }

    /// Lengths of both halves of a period, and the end of the one under way.
    fn time_clock(&mut self) {
        // A shorter one has no halves.
        self.period.next = self.period_cycles.val();
        if !self.period_cycles.val().get_bits::<9>(2).any() {
            self.period.next = self.period_cycles.val() | 4;
        }
        self.low_cycles.next = self.period.val() >> 1;
        self.high_cycles.next = self.period.val() - self.low_cycles.val();
        self.is_due.next = !self.timer.q.val().any();
        if self.timer.q.val().any() {
            self.timer.d.next = self.timer.q.val() - 1;
        }
    }

    /// The clock, and whose turn it is.
    fn clock_frame(&mut self) {
        self.bits.next = self.position_bits.val();
        if self.frame.val().get_bit(3) {
            self.bits.next = self.position_bits.val() + 1;
        }
        for i in 0..self._specials {
            self.bits.next = self.special[i].all_bits.val();
        }
        self.ends_copy.next = !self.left.q.val().get_bits::<5>(1).any();
        // This rising edge takes the last bit of the frame.
        self.is_last.next = !self.first.q.val()
            & self.ends_copy.val()
            & (self.second.q.val() | !self.frame.val().get_bit(1));
        // No upset keeps the clock LOW.
        self.clk.d.next = self.state.q.val() != self.at_low.val();
        self.is_astray.next = self.has_guards.val()
            & (self.state.q.val().xor()
                | (self.clk.q.val() == (self.state.q.val() == self.at_low.val())));
        if self.state.q.val() == self.at_rest.val() {
            if self.trigger.val() {
                self.unknown.d.next = !self.frame.val().get_bit(2);
                self.not_high.d.next = !self.filter.level.val();
                self.not_low.d.next = false;
                self.first.d.next = true;
                self.first_too.d.next = true;
                self.second.d.next = false;
                self.sum.d.next = false;
                self.ones.d.next = false;
                self.not_even.d.next = false;
                self.left.d.next = self.bits.val();
                self.left_too.d.next = self.bits.val();
                self.state.d.next = self.at_judge.val();
                if self.frame.val().get_bit(2) & self.filter.level.val() {
                    self.clk.d.next = false;
                    self.state.d.next = self.at_low.val();
                    self.timer.d.next = bit_cast::<13, 11>(self.low_cycles.val())
                        + bit_cast::<13, 11>(self.first_low_extra_cycles.val())
                        - 1;
                }
            }
        } else if self.state.q.val() == self.at_judge.val() {
            self.state.d.next = self.at_recovery.val();
        } else if self.is_due.val() {
            if self.state.q.val() == self.at_low.val() {
                self.clk.d.next = true;
                self.state.d.next = self.at_high.val();
                self.timer.d.next = bit_cast::<13, 11>(self.high_cycles.val()) - 1;
                if self.is_last.val() {
                    self.state.d.next = self.at_last.val();
                    self.timer.d.next = bit_cast::<13, 11>(self.period.val()) - 1;
                }
            } else if self.state.q.val() == self.at_high.val() {
                self.clk.d.next = false;
                self.state.d.next = self.at_low.val();
                self.timer.d.next = bit_cast::<13, 11>(self.low_cycles.val()) - 1;
            } else if self.state.q.val() == self.at_last.val() {
                self.first.d.next = false;
                self.first_too.d.next = false;
                self.timer.d.next = bit_cast::<13, 11>(self.period.val()) - 1;
                if !self.first.q.val() {
                    self.state.d.next = self.at_judge.val();
                    self.timer.d.next = self.recovery_limit_cycles.val();
                    self.not_low.d.next =
                        self.not_low.q.val() | (self.filter.level.val() & !self.holds_end.val());
                }
            } else {
                // Whatever the line does: a trigger looks at it again.
                self.state.d.next = self.at_rest.val();
            }
        }
        if self.ready.val() {
            self.state.d.next = self.at_rest.val();
        }
        // An upset ends the frame.
        if self.is_astray.val() {
            self.clk.d.next = true;
            self.state.d.next = self.at_last.val();
        }
    }

    /// What the line says at each rising edge of the clock but the first of a copy, most significant bit first.
    fn take_bits(&mut self) {
        self.takes_bit.next =
            (self.state.q.val() == self.at_low.val()) & self.is_due.val() & !self.first.q.val();
        self.bit_before.next = self.word.q.val().get_bit(0);
        if self.second.q.val() {
            self.bit_before.next = self.again.q.val().get_bit(0);
        }
        self.value.next =
            self.filter.level.val() ^ (self.bit_before.val() & self.frame.val().get_bit(0));
        if (self.state.q.val() == self.at_low.val()) & self.is_due.val() {
            self.first.d.next = false;
            self.first_too.d.next = false;
            // HIGH before the first bit, LOW between two copies.
            if self.first.q.val() {
                if self.second.q.val() {
                    self.not_low.d.next = self.not_low.q.val() | self.filter.level.val();
                } else {
                    self.not_high.d.next = !self.filter.level.val();
                }
            }
        }
        self.is_parity.next = self.frame.val().get_bit(3) & self.ends_copy.val();
        for i in 0..self._specials {
            self.is_parity.next = self.frame.val().get_bit(3) & self.special[i].ends_position.val();
        }
        if self.takes_bit.val() {
            self.left.d.next = self.left.q.val() - 1;
            self.left_too.d.next = self.left_too.q.val() - 1;
            if self.is_position.val() {
                // Of the bits as they are sent.
                self.ones.d.next = self.ones.q.val() ^ self.filter.level.val();
                if self.is_parity.val() {
                    self.not_even.d.next = self.not_even.q.val()
                        | (self.ones.q.val()
                            ^ self.filter.level.val()
                            ^ self.frame.val().get_bit(4));
                } else {
                    if self.second.q.val() {
                        self.again.d.next =
                            (self.again.q.val() << 1) | bit_cast::<48, 1>(self.value.val().into());
                    } else {
                        self.word.d.next =
                            (self.word.q.val() << 1) | bit_cast::<48, 1>(self.value.val().into());
                        self.sum.d.next = self.sum.q.val() ^ self.value.val();
                    }
                }
            }
            // The second copy begins as the first one.
            if self.ends_copy.val() & !self.second.q.val() & self.frame.val().get_bit(1) {
                self.second.d.next = true;
                self.first.d.next = true;
                self.first_too.d.next = true;
                self.ones.d.next = false;
                self.left.d.next = self.bits.val();
                self.left_too.d.next = self.bits.val();
            }
        }
        if (self.state.q.val() == self.at_rest.val()) & self.trigger.val() {
            self.word.d.next = 0.into();
            self.again.d.next = 0.into();
        }
    }

    /// The bits that are not position, if there are any.
    fn look_at_special_bits(&mut self) {
        self.is_position.next = true;
        self.special_found.next = 0.into();
        self.shown.next = 0.into();
        for i in 0..self._specials {
            connect!(self.special[i] <= self; clock, reset, position_bits);
            self.special[i].has_parity.next = self.frame.val().get_bit(3);
            self.special[i].begins.next =
                (self.state.q.val() == self.at_rest.val()) & self.trigger.val();
            self.special[i].repeats.next = (self.state.q.val() == self.at_low.val())
                & self.is_due.val()
                & self.first.q.val()
                & self.second.q.val();
            self.special[i].takes.next = self.takes_bit.val();
            self.special[i].level.next = self.filter.level.val();
            self.special[i].left.next = self.left.q.val();
            self.special[i].heard.next = !self.unknown.q.val() & !self.not_high.q.val();
            self.is_position.next = self.special[i].is_position.val();
            self.special_found.next = self.special[i].found.val();
            self.shown.next = self.special[i].shown.val();
        }
    }

    /// How the recovery time ends.
    fn recover(&mut self) {
        // The encoder is ready again, if DATA was LOW before.
        self.ready.next = (self.state.q.val() == self.at_recovery.val())
            & self.filter.level.val()
            & !self.not_low.q.val()
            & !self.torn.q.val()
            & !self.holds_end.val();
        // DATA is LOW for another reason than the end of a frame: the position may be wrong.
        self.is_late.next = (self.state.q.val() == self.at_recovery.val())
            & self.is_due.val()
            & !self.filter.level.val()
            & self.good.val();
    }

    /// What the frame is worth: a bit for each cause, in the order of their codes.
    fn judge(&mut self) {
        self.busy.next = self.state.q.val() != self.at_rest.val();
        self.publishes.next = (self.state.q.val() == self.at_judge.val())
            & !(self.unknown.q.val() & self.not_low.q.val());
        // A trigger that was not taken is told by the result of the frame under way, or of the next one.
        if self.publishes.val() {
            self.lost.d.next = false;
            self.slow.d.next = false;
        }
        self.loses.next = self.trigger.val() & (self.state.q.val() != self.at_rest.val());
        self.is_lost.d.next = self.loses.val();
        self.displaced.next = self.is_lost.q.val();
        if self.loses.val() {
            self.lost.d.next = true;
        }
        if self.is_late.val() {
            self.slow.d.next = true;
        }
        self.is_other.next =
            self.frame.val().get_bit(1) & (self.word.q.val() != self.again.q.val());
        // The bits are counted twice: a copy that is short by one fits the next one that begins a bit too soon.
        self.is_torn.next = self.has_guards.val()
            & (self.torn.q.val()
                | self.is_astray.val()
                | (self.left.q.val() != self.left_too.q.val())
                | (self.first.q.val() != self.first_too.q.val()));
        self.torn.d.next = self.is_torn.val()
            & (self.is_astray.val() | (self.state.q.val() != self.at_rest.val()));
        // All bits have come, in as many copies as were asked for.
        self.is_short.next = (self.left.q.val().any()
            | (self.second.q.val() ^ self.frame.val().get_bit(1)))
            & !self.unknown.q.val()
            & !self.not_high.q.val();
        // What is stored is what came.
        self.is_upset.next = self.is_short.val()
            | (self.has_guards.val()
                & (self.is_torn.val() | (self.word.q.val().xor() ^ self.sum.q.val())));
        self.found.next = bit_cast::<6, 1>(self.unknown.q.val().into())
            | (bit_cast::<6, 1>(self.not_high.q.val().into()) << 1)
            | (bit_cast::<6, 1>(self.not_low.q.val().into()) << 2)
            | (bit_cast::<6, 1>(self.not_even.q.val().into()) << 3)
            | (bit_cast::<6, 1>(self.is_other.val().into()) << 4)
            | (bit_cast::<6, 1>(self.is_upset.val().into()) << 5);
        self.good.next = !self.found.val().any() & !self.special_found.val().any();
        // A lost trigger is for the next result, not for what has become of this one.
        self.raised.next = bit_cast::<16, 6>(self.found.val())
            | (bit_cast::<16, 1>((self.lost.q.val() & !self.is_late.val()).into()) << 6)
            | (bit_cast::<16, 1>((self.slow.q.val() | self.is_late.val()).into()) << 7)
            | bit_cast::<16, 12>(self.special_found.val());
        self.primary.flags.next = self.raised.val();
        for i in 0..self._specials {
            // With a lost trigger, or a late end of the frame before, the position would have been taken.
            if self.special[i].found.val().any() {
                self.primary.flags.next = self.raised.val() & 0xFF3F;
            }
        }
    }

    /// The last good position, and why there is no newer one.
    fn show_result(&mut self) {
        connect!(self.snapshot <= self; tick_us, timestamp);
        self.fallen.d.next =
            (self.fallen.q.val() | !self.clk.q.val()) & (self.state.q.val() != self.at_rest.val());
        self.snapshot.first_fall.next =
            !self.clk.q.val() & !self.fallen.q.val() & self.first.q.val();
        self.snapshot.latched.next = false;
        self.snapshot.delay_cycles.next = 0.into();
        self.snapshot.told.publish.next = self.publishes.val();
        self.snapshot.told.good.next = self.publishes.val() & self.good.val();
        self.snapshot.told.late_fault.next = self.is_late.val();
        self.snapshot.told.withdraw.next = self.is_late.val();
        // The age counts from the result on.
        self.snapshot.told.confirm.next = true;
        self.snapshot.width_in.next = 0.into();
        self.snapshot.has_f2_in.next = false;
        self.snapshot.position_in.next = self.word.q.val();
        self.snapshot.crc_received_in.next = 0.into();
        self.snapshot.crc_computed_in.next = 0.into();
        self.snapshot.told.cause_told.next = self.primary.cause.val();
        self.snapshot.told.flags_told.next =
            bit_cast::<20, 16>(self.raised.val()) | (bit_cast::<20, 8>(self.shown.val()) << 12);
        self.over.next = self.publishes.val();
        self.ssi_clk.next = self.clk.q.val();
        FrameResultOut::link(&mut self.result, &mut self.snapshot.result);
    }
}

#[cfg(test)]
mod tests;
