//! Second receiver: receives the same answer from the same samples, a cycle later, and reports any disagreement.
//!
//! ```text
//! receiver          sample /\____ bit ____/\_____ done /\_____________
//! second receiver   ________/\____ bit ____/\___________/\____________
//! differs           __________________________________________________   ~~~ until the next frame, after any difference
//! ```
//!
//! Each cycle the progress of both is compared, and from the end of an answer its bits, while they are stored. One cycle apart the receivers never
//! have equal registers. So synthesis cannot merge them, and a disturbance of both at once hits different states.
//!
//! Synchroniser, filter and sampling point are shared: two copies would see an edge in different cycles and disagree without a fault.

use crate::endat::features::Features;
use crate::endat::ports::{AnswerCheckIn, AnswerShapeIn, CellsIn, ControlIn, ProgressIn};
use crate::endat::receiver::Receiver;
use crate::endat::transaction::cause::{self, flag};
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
    /// Control of a receiver during a frame.
    #[bundle]
    pub control: ControlIn,
    /// Strobe of each rising clock edge.
    pub rise: Signal<In, Bit>,
    /// Places of the answer's cells.
    #[bundle]
    pub cells: CellsIn,
    /// The data line.
    pub level: Signal<In, Bit>,
    /// Strobe: the recovery time is HIGH now.
    pub look: Signal<In, Bit>,
    /// Bits between error bits and CRC, 1..=48; stable during a frame, as are the inputs below.
    pub payload_bits: Signal<In, Bits<6>>,
    /// Parts of an answer.
    #[bundle]
    pub shape: AnswerShapeIn,
    /// Blocks of additional data that follow the position, 0..=2.
    pub infos: Signal<In, Bits<2>>,
    /// Mode command that was sent.
    pub command: Signal<In, Bits<6>>,
    /// Progress of a receiver.
    #[bundle]
    pub progress: ProgressIn,
    /// Payload of the first receiver.
    pub payload: Signal<In, Bits<48>>,
    /// Checks of an answer.
    #[bundle]
    pub check: AnswerCheckIn,
    /// CRC received by the first receiver.
    pub crc_received: Signal<In, Bits<5>>,
    /// Forces a difference at the end of each answer, to test the comparison.
    pub forced: Signal<In, Bit>,
    /// The result to be reported is good.
    pub good: Signal<In, Bit>,
    /// Primary cause of the first receiver.
    pub cause: Signal<In, Bits<5>>,
    /// Raw flags of the first receiver.
    pub flags: Signal<In, Bits<20>>,
    /// The two have disagreed in this frame.
    pub differs: Signal<Out, Bit>,
    /// The result is good, and the two agree up to and including the cycle in which it is reported.
    pub good_told: Signal<Out, Bit>,
    /// Primary cause to report.
    pub cause_told: Signal<Out, Bits<5>>,
    /// Raw flags to report.
    pub flags_told: Signal<Out, Bits<20>>,
    receiver: Receiver,
    /// `inputs`, one cycle later.
    strobes: Reg<Bits<11>>,
    /// `signs` in the cycle before.
    signs_before: Reg<Bits<12>>,
    /// Set when an answer or block is complete; cleared when the next one, or a frame, begins. Its bits are compared.
    holds: Reg<Bit>,
    /// `separated`, one cycle later.
    separator: Reg<Bit>,
    /// `separated`, two cycles later: the first receiver drops its bits.
    leaves: Reg<Bit>,
    /// Set when the two receivers disagree; cleared when a frame begins.
    different: Reg<Bit>,
    /// Inputs of the first receiver that change within a frame.
    inputs: Signal<Local, Bits<11>>,
    /// Progress of the first receiver.
    signs: Signal<Local, Bits<12>>,
    /// High if the progress of the two receivers differs.
    apart: Signal<Local, Bit>,
    /// High if payload, error bits or CRC of the two receivers differ.
    bits_differ: Signal<Local, Bit>,
    /// High for one cycle: an answer or block is complete in the second receiver.
    ends: Signal<Local, Bit>,
    /// High if the two receivers disagree in this cycle.
    differs_now: Signal<Local, Bit>,
    upset_cause: Constant<Bits<5>>,
    upset_flag: Constant<Bits<20>>,
}

impl SecondReceiver {
    /// A second receiver for a channel with these features.
    pub fn new(features: Features) -> Self {
        Self::from_parts(SecondReceiverParts {
            receiver: Receiver::new(Features {
                second_receiver: true,
                ..features
            }),
            upset_cause: Constant::new(cause::UPSET.into()),
            upset_flag: Constant::new(flag(cause::UPSET).into()),
        })
    }
}

#[kernel]
impl Logic for SecondReceiver {
    fn update(&mut self) {
        connect!(self.receiver <= self;
            clock, reset, payload_bits, infos, command
        );
        self.receiver.put.next = false;
        self.receiver.put_word.next = 0.into();
        self.receiver.put_crc.next = 0.into();
        AnswerShapeIn::link(&mut self.shape, &mut self.receiver.shape);
        self.inputs.next = 0.into();
        self.inputs.next = self.inputs.val().replace_bit(0, self.control.start.val());
        self.inputs.next = self.inputs.val().replace_bit(1, self.control.aborts.val());
        self.inputs.next = self.inputs.val().replace_bit(2, self.control.acquire.val());
        self.inputs.next = self.inputs.val().replace_bit(3, self.rise.val());
        self.inputs.next = self.inputs.val().replace_bit(4, self.cells.pulse.val());
        self.inputs.next = self.inputs.val().replace_bit(5, self.cells.sample.val());
        self.inputs.next = self.inputs.val().replace_bit(6, self.level.val());
        self.inputs.next = self
            .inputs
            .val()
            .replace_bit(7, self.cells.edge_in_window.val());
        self.inputs.next = self.inputs.val().replace_bit(8, self.look.val());
        self.inputs.next = self
            .inputs
            .val()
            .replace_bit(9, self.control.start_supplement.val());
        self.inputs.next = self
            .inputs
            .val()
            .replace_bit(10, self.control.going_on.val());
        self.strobes.d.next = self.inputs.val();
        self.receiver.control.start.next = self.strobes.q.val().get_bit(0);
        self.receiver.control.aborts.next = self.strobes.q.val().get_bit(1);
        self.receiver.control.acquire.next = self.strobes.q.val().get_bit(2);
        self.receiver.rise.next = self.strobes.q.val().get_bit(3);
        self.receiver.cells.pulse.next = self.strobes.q.val().get_bit(4);
        self.receiver.cells.sample.next = self.strobes.q.val().get_bit(5);
        self.receiver.level.next = self.strobes.q.val().get_bit(6);
        self.receiver.cells.edge_in_window.next = self.strobes.q.val().get_bit(7);
        self.receiver.look.next = self.strobes.q.val().get_bit(8);
        self.receiver.control.start_supplement.next = self.strobes.q.val().get_bit(9);
        self.receiver.control.going_on.next = self.strobes.q.val().get_bit(10);

        self.signs.next = 0.into();
        self.signs.next = self
            .signs
            .val()
            .replace_bit(0, self.progress.skipping.val());
        self.signs.next = self.signs.val().replace_bit(1, self.progress.hunting.val());
        self.signs.next = self.signs.val().replace_bit(2, self.progress.started.val());
        self.signs.next = self
            .signs
            .val()
            .replace_bit(3, self.progress.all_sent.val());
        self.signs.next = self
            .signs
            .val()
            .replace_bit(4, self.progress.none_under_way.val());
        self.signs.next = self
            .signs
            .val()
            .replace_bit(5, self.progress.all_ended.val());
        self.signs.next = self.signs.val().replace_bit(6, self.progress.done.val());
        self.signs.next = self
            .signs
            .val()
            .replace_bit(7, self.progress.info_done.val());
        self.signs.next = self
            .signs
            .val()
            .replace_bit(8, self.progress.separated.val());
        self.signs.next = self
            .signs
            .val()
            .replace_bit(9, self.progress.finished.val());
        self.signs.next = self
            .signs
            .val()
            .replace_bit(10, self.progress.gap_good.val());
        self.signs.next = self
            .signs
            .val()
            .replace_bit(11, self.progress.latched.val());
        self.signs_before.d.next = self.signs.val();
        self.apart.next = (self.signs_before.q.val().get_bit(0)
            ^ self.receiver.progress.skipping.val())
            | (self.signs_before.q.val().get_bit(1) ^ self.receiver.progress.hunting.val())
            | (self.signs_before.q.val().get_bit(2) ^ self.receiver.progress.started.val())
            | (self.signs_before.q.val().get_bit(3) ^ self.receiver.progress.all_sent.val())
            | (self.signs_before.q.val().get_bit(4) ^ self.receiver.progress.none_under_way.val())
            | (self.signs_before.q.val().get_bit(5) ^ self.receiver.progress.all_ended.val())
            | (self.signs_before.q.val().get_bit(6) ^ self.receiver.progress.done.val())
            | (self.signs_before.q.val().get_bit(7) ^ self.receiver.progress.info_done.val())
            | (self.signs_before.q.val().get_bit(8) ^ self.receiver.progress.separated.val())
            | (self.signs_before.q.val().get_bit(9) ^ self.receiver.progress.finished.val())
            | (self.signs_before.q.val().get_bit(10) ^ self.receiver.progress.gap_good.val())
            | (self.signs_before.q.val().get_bit(11) ^ self.receiver.progress.latched.val());

        self.bits_differ.next = (self.payload.val() != self.receiver.payload.val())
            | (self.check.f1.val() != self.receiver.verdict.f1.val())
            | (self.check.f2.val() != self.receiver.verdict.f2.val())
            | (self.crc_received.val() != self.receiver.crc_received.val())
            | (self.check.crc_ok.val() != self.receiver.verdict.crc_ok.val())
            | (self.check.stored_ok.val() != self.receiver.verdict.stored_ok.val());
        // Received bits stay in place until a new block, or frame, begins.
        self.ends.next = self.receiver.progress.done.val() | self.receiver.progress.info_done.val();
        if self.ends.val() {
            self.holds.d.next = true;
        }
        self.separator.d.next = self.progress.separated.val();
        self.leaves.d.next = self.separator.q.val();
        if self.control.start.val() | self.leaves.q.val() | self.progress.latched.val() {
            self.holds.d.next = false;
        }
        if self.control.start.val() {
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
