//! Verdict bytes: the checks of a reply as the processor's bytes.

use crate::lowest_cause::LowestCause;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Control data, communication alarm, and cause with valid positions.
#[derive(LogicBlock, Block)]
pub struct VerdictBytes {
    /// The reply is good.
    pub good: Signal<In, Bit>,
    /// Raw flags, one bit for each fault; bits as in the register map.
    pub flags: Signal<In, Bits<16>>,
    /// ID echoed in the reply.
    pub reply_id: Signal<In, Bits<4>>,
    /// A single-turn (bit 0) and a multi-turn position (bit 1) are available.
    pub valid: Signal<In, Bits<2>>,
    /// Low byte of address 1.
    pub control: Signal<Out, Bits<8>>,
    /// High byte of address 6.
    pub communication: Signal<Out, Bits<8>>,
    /// High byte of address 7, without busy.
    pub cause_byte: Signal<Out, Bits<8>>,
    /// Cause of the flags.
    #[start]
    primary: LowestCause,
    /// High if the encoder reports an error of the request.
    complains: Signal<Local, Bit>,
    /// High if the reply echoes the ID of the request.
    repeats: Signal<Local, Bit>,
    /// Communication alarm: the high byte of address 6.
    alarms: Signal<Local, Bits<8>>,
}

#[kernel]
impl Logic for VerdictBytes {
    fn update(&mut self) {
        self.primary.flags.next = self.flags.val();
        self.complains.next = self.flags.val().get_bits::<2>(9).any();
        self.alarms.next = bit_cast::<8, 2>(self.flags.val().get_bits::<2>(2))
            | (bit_cast::<8, 1>(self.flags.val().get_bits::<1>(7)) << 2)
            | (bit_cast::<8, 1>(self.flags.val().get_bits::<1>(6)) << 3)
            | (bit_cast::<8, 2>(self.flags.val().get_bits::<2>(4)) << 4)
            | (bit_cast::<8, 1>(self.flags.val().get_bits::<1>(8)) << 6)
            | (bit_cast::<8, 1>(self.complains.val().into()) << 7);
        self.communication.next = self.alarms.val();
        // Any flag up to the echo means that no ID, or another one, was received.
        self.repeats.next = !self.flags.val().get_bits::<6>(0).any();
        self.control.next = bit_cast::<8, 4>(self.reply_id.val())
            | (bit_cast::<8, 1>(self.repeats.val().into()) << 4)
            | (bit_cast::<8, 1>(self.alarms.val().any().into()) << 5)
            | (bit_cast::<8, 1>(self.good.val().into()) << 7);
        self.cause_byte.next = bit_cast::<8, 4>(self.primary.cause.val().get_bits::<4>(0))
            | (bit_cast::<8, 2>(self.valid.val()) << 4)
            | (bit_cast::<8, 1>(self.flags.val().get_bits::<1>(15)) << 6);
    }
}
