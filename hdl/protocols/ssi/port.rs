//! SSI port: one encoder as a channel of a card, with the result registers that EnDat channels have.
//!
//! ```text
//! state    REST| LOW |HIGH | LOW |HIGH |  ...  | LOW |   LAST   |  RECOVERY   |REST
//! clk   ~~~~~~~\_____/~~~~~\_____/~~~~~~  ...  \_____/~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~
//! data  ~~~~~~~~~~~~~~< msb      >< ...     >< lsb   >\_________________/~~~~~~~~~~
//!              HIGH? ^           ^ taken             ^ taken    ^ LOW? result   ^ HIGH? if not: withdrawn
//! ```
//!
//! A frame is good only if all of its bits have been received. With `frame` bit 1 the clock continues: a LOW bit, and the same position again.
//!
//! `RECOVERY` ends when DATA is HIGH, because the encoder is ready then. After a reset, an upset, or a frame with DATA HIGH at its end, it lasts
//! for the whole recovery time: the encoder may be in the middle of a frame, where DATA is any of its bits.
//! <!-- with has_guards -->
//!
//! Guards against upsets: the codes of the states differ in two bits, the clock must match the state, bits and the edge without a bit are
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
use rtl_design::Block;
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
    /// One-cycle strobe: read a position.
    pub trigger: Signal<In, Bit>,
    /// Line from the transceiver, asynchronous, HIGH at rest.
    pub data_i: Signal<In, Bit>,
    /// Clock period, in system clock cycles, 4 to 2047; below 4, 4 is added. Constant while `busy`, as all settings.
    pub period_cycles: Signal<In, Bits<11>>,
    /// Extension of the first low phase beyond half a period.
    pub first_low_extra_cycles: Signal<In, Bits<11>>,
    /// Kind of frame: bit 0 Gray code, bit 1 each position twice, bit 2 enables frames, bit 3 parity.
    pub frame: Signal<In, Bits<6>>,
    /// Position width, 1 to 48 bits.
    pub position_bits: Signal<In, Bits<6>>,
    /// Pulses of at most this many system clock cycles are ignored.
    pub filter_cycles: Signal<In, Bits<4>>,
    /// DATA is HIGH again after at most this many system clock cycles (tm).
    pub recovery_limit_cycles: Signal<In, Bits<13>>,
    /// Clock to the transceiver, from a register, HIGH at rest.
    pub ssi_clk: Signal<Out, Bit>,
    /// A trigger would be lost.
    pub busy: Signal<Out, Bit>,
    /// Strobe: a frame has ended.
    pub over: Signal<Out, Bit>,
    /// Strobe: a trigger is lost.
    pub trigger_lost: Signal<Out, Bit>,
    /// Result of a trigger.
    #[bundle]
    pub result: FrameResultOut,
    /// Synchroniser and filter of DATA.
    filter: InputFilter,
    /// Cause of the result.
    #[start]
    primary: LowestCause,
    /// Result registers.
    snapshot: Snapshot,
    /// Bits of a frame that are not position, for encoders with such bits.
    special: Vec<SpecialBits>,
    /// State of the frame; starts in `LAST`, because a reset may come in the middle of a frame.
    #[start(STATE_LAST.into())]
    state: Reg<Bits<4>>,
    /// Clock to the transceiver; HIGH at rest.
    #[start(true)]
    clk: Reg<Bit>,
    /// System clock cycles until the state may end.
    timer: Reg<Bits<13>>,
    /// Bits of the copy still to be received.
    left: Reg<Bits<6>>,
    /// Second copy of `left`, compared with it as a guard.
    left_too: Reg<Bits<6>>,
    /// High after an upset of state, clock or bit counts, until the port is at rest.
    torn: Reg<Bit>,
    /// High until the first rising edge of a copy, which brings no bit. In `LAST`: wait for another period.
    #[start(true)]
    first: Reg<Bit>,
    /// Second copy of `first`, compared with it as a guard.
    #[start(true)]
    first_too: Reg<Bit>,
    /// High during the second copy of a position.
    second: Reg<Bit>,
    /// Position as received, most significant bit first.
    word: Reg<Bits<48>>,
    /// Position of the second copy.
    again: Reg<Bits<48>>,
    /// Parity of the bits stored in `word`, formed while they arrived.
    sum: Reg<Bit>,
    /// Parity of the bits of this copy as sent.
    ones: Reg<Bit>,
    /// High if the parity bit of a copy was wrong; cleared by a trigger.
    not_even: Reg<Bit>,
    /// High if DATA was HIGH between two copies or at the end of the frame; cleared by a trigger.
    #[start(true)]
    not_low: Reg<Bit>,
    /// High if a trigger was lost, until a result reports it.
    lost: Reg<Bit>,
    /// High in the cycle after a trigger was lost.
    is_lost: Reg<Bit>,
    /// High if DATA was still LOW after the longest recovery time, until a result reports it.
    slow: Reg<Bit>,
    /// High from the first falling edge of the clock until the port is at rest.
    fallen: Reg<Bit>,
    /// High if frames of this kind are disabled. With `not_low`: no frame yet since a reset.
    #[start(true)]
    unknown: Reg<Bit>,
    /// High if DATA was LOW before the first bit of the last frame.
    not_high: Reg<Bit>,
    /// Clock period; below 4 cycles, 4 is added.
    period: Signal<Local, Bits<11>>,
    /// Length of a LOW phase.
    low_cycles: Signal<Local, Bits<11>>,
    /// Length of a HIGH phase.
    high_cycles: Signal<Local, Bits<11>>,
    /// High if the timer has run out.
    is_due: Signal<Local, Bit>,
    /// High if the next rising edge samples the last bit of the frame.
    is_last: Signal<Local, Bit>,
    /// High for one cycle when a bit is sampled.
    takes_bit: Signal<Local, Bit>,
    /// Bits of a copy, all of them.
    bits: Signal<Local, Bits<6>>,
    /// High if the bit belongs to the position, or is its parity bit.
    is_position: Signal<Local, Bit>,
    /// Raw flags of the frame.
    special_found: Signal<Local, Bits<12>>,
    /// Special bits that the result shows.
    shown: Signal<Local, Bits<8>>,
    /// High if the bit is the last one of a copy.
    ends_copy: Signal<Local, Bit>,
    /// High if the bit is the parity bit of the position.
    is_parity: Signal<Local, Bit>,
    /// Previous bit, for Gray code.
    bit_before: Signal<Local, Bit>,
    /// Bit of the position, decoded.
    value: Signal<Local, Bit>,
    /// High if the two copies differ.
    is_other: Signal<Local, Bit>,
    /// High if the state is invalid, or the clock does not match it.
    is_astray: Signal<Local, Bit>,
    /// `torn`, with the upsets of this cycle.
    is_torn: Signal<Local, Bit>,
    /// High if bits or copies are missing.
    is_short: Signal<Local, Bit>,
    /// High if an upset has changed the frame, or bits are missing.
    is_upset: Signal<Local, Bit>,
    /// High for one cycle when the result of a frame is published.
    publishes: Signal<Local, Bit>,
    /// High if the encoder is ready for the next frame before the longest recovery time is over.
    ready: Signal<Local, Bit>,
    /// High for one cycle when DATA is still LOW after the longest recovery time.
    is_late: Signal<Local, Bit>,
    /// High if the frame has no fault.
    good: Signal<Local, Bit>,
    /// High for one cycle when a trigger is lost.
    loses: Signal<Local, Bit>,
    /// Raw flags of the frame itself.
    found: Signal<Local, Bits<6>>,
    /// Raw flags of the result.
    raised: Signal<Local, Bits<16>>,
    /// 1 if upsets of stored bits are detected.
    has_guards: Constant<Bit>,
    /// 1 if DATA keeps the last bit to the end of the recovery time: it is not checked then.
    holds_end: Constant<Bit>,
    /// State: no frame.
    at_rest: Constant<Bits<4>>,
    /// State: clock LOW.
    at_low: Constant<Bits<4>>,
    /// State: clock HIGH between two bits.
    at_high: Constant<Bits<4>>,
    /// State: clock HIGH after the last bit, for one period.
    at_last: Constant<Bits<4>>,
    /// State: recovery time.
    at_recovery: Constant<Bits<4>>,
    /// State: the result is published.
    at_judge: Constant<Bits<4>>,
    _specials: usize,
}

/// Codes of the states. Each has an even number of ones, so that a single upset does not give another state.
const STATE_REST: u64 = 0;
const STATE_LOW: u64 = 3;
const STATE_HIGH: u64 = 5;
const STATE_LAST: u64 = 6;
const STATE_RECOVERY: u64 = 9;
const STATE_JUDGE: u64 = 10;

impl SsiPort {
    /// A port with the parts of `asked` that are not settings: special bits, and the end of a frame; `guards` detect upsets of stored bits.
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

mod kernel;
#[cfg(test)]
mod tests;
