//! Second receiver: takes the same answer from the same samples, a cycle later, and tells where the two disagree.
//!
//! ```text
//! receiver          sample /\____ bit ____/\_____ done /\_____________
//! second receiver   ________/\____ bit ____/\___________/\____________
//! differs           __________________________________________________   ~~~ until the next frame, if anything was not the same
//! ```
//!
//! Each cycle the signs of both are compared, and from the end of an answer on its bits, as long as they stay. A cycle apart they are never equal in all
//! registers, so synthesis cannot make one of them, and what disturbs both at once meets them in different states.
//!
//! Shared are synchroniser, filter and sampling point: two of those would see an edge in different cycles, and disagree about nothing.

use crate::features::Features;
use crate::receiver::Receiver;
use crate::transaction::cause::{self, flag};
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// The second receiver of a channel, and the comparison.
#[derive(LogicBlock, Block)]
pub struct SecondReceiver {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe: a frame begins.
    pub start: Signal<In, Bit>,
    /// The frame is given up.
    pub aborts: Signal<In, Bit>,
    /// The frame measures the propagation delay.
    pub acquire: Signal<In, Bit>,
    /// Strobe of each rising clock edge.
    pub rise: Signal<In, Bit>,
    /// Strobe: a clock pulse is sent that the answer needs.
    pub pulse: Signal<In, Bit>,
    /// Strobe: sample `level`.
    pub sample: Signal<In, Bit>,
    /// The data line.
    pub level: Signal<In, Bit>,
    /// The start edge of this cell lies in its window.
    pub edge_in_window: Signal<In, Bit>,
    /// Strobe: what is HIGH now is a recovery time.
    pub look: Signal<In, Bit>,
    /// One-cycle strobe: the supplement begins.
    pub start_supplement: Signal<In, Bit>,
    /// The clock goes on after this answer.
    pub going_on: Signal<In, Bit>,
    /// Bits between error bits and CRC, 1..=48; this and what follows stays for a frame.
    pub payload_bits: Signal<In, Bits<6>>,
    /// The answer begins with F1.
    pub has_f1: Signal<In, Bit>,
    /// The frame carries F2.
    pub has_f2: Signal<In, Bit>,
    /// 24 bits are sent before the answer, and the answer is 24 bits.
    pub has_parameter: Signal<In, Bit>,
    /// The clock is parked LOW after the answer.
    pub has_supplement: Signal<In, Bit>,
    /// Additional data that follows the position, 0..=2.
    pub infos: Signal<In, Bits<2>>,
    /// Mode command that was sent.
    pub command: Signal<In, Bits<6>>,
    /// The first receiver looks at no samples.
    pub skipping: Signal<In, Bit>,
    /// It waits for the start bit.
    pub hunting: Signal<In, Bit>,
    /// It has taken the start bit.
    pub started: Signal<In, Bit>,
    /// It needs no more pulses.
    pub all_sent: Signal<In, Bit>,
    /// The cell of each pulse that was sent has ended, it says.
    pub none_under_way: Signal<In, Bit>,
    /// Its counts agree that no cell is left.
    pub all_ended: Signal<In, Bit>,
    /// Strobe: its answer is valid.
    pub done: Signal<In, Bit>,
    /// Strobe: its additional data is valid.
    pub info_done: Signal<In, Bit>,
    /// Strobe: it has seen the LOW in front of additional data.
    pub separated: Signal<In, Bit>,
    /// Strobe: it has all of the frame.
    pub finished: Signal<In, Bit>,
    /// Strobe: it has seen HIGH where the clock goes on.
    pub gap_good: Signal<In, Bit>,
    /// Strobe: it expects the next position.
    pub latched: Signal<In, Bit>,
    /// Payload of the first receiver.
    pub payload: Signal<In, Bits<48>>,
    /// Its error bit 1.
    pub f1: Signal<In, Bit>,
    /// Its error bit 2.
    pub f2: Signal<In, Bit>,
    /// The CRC that it has received.
    pub crc_received: Signal<In, Bits<5>>,
    /// Its serial verdict.
    pub serial_ok: Signal<In, Bit>,
    /// Its parallel verdict.
    pub parallel_ok: Signal<In, Bit>,
    /// The comparison is to find a difference at the end of each answer, to show that it lives.
    pub forced: Signal<In, Bit>,
    /// The result that is about to be told is good.
    pub good: Signal<In, Bit>,
    /// Its primary cause.
    pub cause: Signal<In, Bits<5>>,
    /// Its raw flags.
    pub flags: Signal<In, Bits<20>>,
    /// The two have disagreed in this frame.
    pub differs: Signal<Out, Bit>,
    /// The result is good, and the two agree to the very cycle in which it is told.
    pub good_told: Signal<Out, Bit>,
    /// Its primary cause.
    pub cause_told: Signal<Out, Bits<5>>,
    /// Its raw flags.
    pub flags_told: Signal<Out, Bits<20>>,
    receiver: Receiver,
    strobes: Reg<Bits<11>>,
    signs_before: Reg<Bits<12>>,
    holds: Reg<Bit>,
    separator: Reg<Bit>,
    leaves: Reg<Bit>,
    different: Reg<Bit>,
    inputs: Signal<Local, Bits<11>>,
    signs: Signal<Local, Bits<12>>,
    apart: Signal<Local, Bit>,
    bits_differ: Signal<Local, Bit>,
    ends: Signal<Local, Bit>,
    differs_now: Signal<Local, Bit>,
    upset_cause: Constant<Bits<5>>,
    upset_flag: Constant<Bits<20>>,
}

impl SecondReceiver {
    /// One for a channel with these features.
    pub fn new(features: Features) -> Self {
        Self::from_parts(SecondReceiverParts {
            receiver: Receiver::new(features),
            upset_cause: Constant::new(cause::UPSET.into()),
            upset_flag: Constant::new(flag(cause::UPSET).into()),
        })
    }
}

impl Logic for SecondReceiver {
    #[kernel]
    fn update(&mut self) {
        connect!(self.receiver <= self;
            clock, reset, payload_bits, has_f1, has_f2, has_parameter, has_supplement, infos, command
        );
        self.inputs.next = 0.into();
        self.inputs.next = self.inputs.val().replace_bit(0, self.start.val());
        self.inputs.next = self.inputs.val().replace_bit(1, self.aborts.val());
        self.inputs.next = self.inputs.val().replace_bit(2, self.acquire.val());
        self.inputs.next = self.inputs.val().replace_bit(3, self.rise.val());
        self.inputs.next = self.inputs.val().replace_bit(4, self.pulse.val());
        self.inputs.next = self.inputs.val().replace_bit(5, self.sample.val());
        self.inputs.next = self.inputs.val().replace_bit(6, self.level.val());
        self.inputs.next = self.inputs.val().replace_bit(7, self.edge_in_window.val());
        self.inputs.next = self.inputs.val().replace_bit(8, self.look.val());
        self.inputs.next = self
            .inputs
            .val()
            .replace_bit(9, self.start_supplement.val());
        self.inputs.next = self.inputs.val().replace_bit(10, self.going_on.val());
        self.strobes.d.next = self.inputs.val();
        self.receiver.start.next = self.strobes.q.val().get_bit(0);
        self.receiver.aborts.next = self.strobes.q.val().get_bit(1);
        self.receiver.acquire.next = self.strobes.q.val().get_bit(2);
        self.receiver.rise.next = self.strobes.q.val().get_bit(3);
        self.receiver.pulse.next = self.strobes.q.val().get_bit(4);
        self.receiver.sample.next = self.strobes.q.val().get_bit(5);
        self.receiver.level.next = self.strobes.q.val().get_bit(6);
        self.receiver.edge_in_window.next = self.strobes.q.val().get_bit(7);
        self.receiver.look.next = self.strobes.q.val().get_bit(8);
        self.receiver.start_supplement.next = self.strobes.q.val().get_bit(9);
        self.receiver.going_on.next = self.strobes.q.val().get_bit(10);

        self.signs.next = 0.into();
        self.signs.next = self.signs.val().replace_bit(0, self.skipping.val());
        self.signs.next = self.signs.val().replace_bit(1, self.hunting.val());
        self.signs.next = self.signs.val().replace_bit(2, self.started.val());
        self.signs.next = self.signs.val().replace_bit(3, self.all_sent.val());
        self.signs.next = self.signs.val().replace_bit(4, self.none_under_way.val());
        self.signs.next = self.signs.val().replace_bit(5, self.all_ended.val());
        self.signs.next = self.signs.val().replace_bit(6, self.done.val());
        self.signs.next = self.signs.val().replace_bit(7, self.info_done.val());
        self.signs.next = self.signs.val().replace_bit(8, self.separated.val());
        self.signs.next = self.signs.val().replace_bit(9, self.finished.val());
        self.signs.next = self.signs.val().replace_bit(10, self.gap_good.val());
        self.signs.next = self.signs.val().replace_bit(11, self.latched.val());
        self.signs_before.d.next = self.signs.val();
        self.apart.next = (self.signs_before.q.val().get_bit(0) ^ self.receiver.skipping.val())
            | (self.signs_before.q.val().get_bit(1) ^ self.receiver.hunting.val())
            | (self.signs_before.q.val().get_bit(2) ^ self.receiver.started.val())
            | (self.signs_before.q.val().get_bit(3) ^ self.receiver.all_sent.val())
            | (self.signs_before.q.val().get_bit(4) ^ self.receiver.none_under_way.val())
            | (self.signs_before.q.val().get_bit(5) ^ self.receiver.all_ended.val())
            | (self.signs_before.q.val().get_bit(6) ^ self.receiver.done.val())
            | (self.signs_before.q.val().get_bit(7) ^ self.receiver.info_done.val())
            | (self.signs_before.q.val().get_bit(8) ^ self.receiver.separated.val())
            | (self.signs_before.q.val().get_bit(9) ^ self.receiver.finished.val())
            | (self.signs_before.q.val().get_bit(10) ^ self.receiver.gap_good.val())
            | (self.signs_before.q.val().get_bit(11) ^ self.receiver.latched.val());

        self.bits_differ.next = (self.payload.val() != self.receiver.payload.val())
            | (self.f1.val() != self.receiver.f1.val())
            | (self.f2.val() != self.receiver.f2.val())
            | (self.crc_received.val() != self.receiver.crc_received.val())
            // That of the next block begins as soon as its separator has come.
            | ((self.serial_ok.val() != self.receiver.serial_ok.val())
                & !self.separator.q.val()
                & !self.leaves.q.val())
            | (self.parallel_ok.val() != self.receiver.parallel_ok.val());
        // What has come stays where it is until a new block, or frame, begins.
        self.ends.next = self.receiver.done.val() | self.receiver.info_done.val();
        if self.ends.val() {
            self.holds.d.next = true;
        }
        self.separator.d.next = self.separated.val();
        self.leaves.d.next = self.separator.q.val();
        if self.start.val() | self.leaves.q.val() | self.latched.val() {
            self.holds.d.next = false;
        }
        if self.start.val() {
            self.different.d.next = false;
        }
        self.differs_now.next = self.apart.val()
            | (self.holds.q.val() & self.bits_differ.val())
            | (self.ends.val() & self.forced.val());
        if self.differs_now.val() {
            self.different.d.next = true;
        }
        self.differs.next = self.different.q.val();

        connect!(self <= self; good_told = good, cause_told = cause, flags_told = flags);
        if self.good.val() & (self.different.q.val() | self.differs_now.val()) {
            self.good_told.next = false;
            self.cause_told.next = self.upset_cause.val();
            self.flags_told.next = self.upset_flag.val();
        }
    }
}
