//! Verdict: registers the faults of a frame, then reports them with the primary cause.
//!
//! ```text
//! answer_taken, give_up ...  ____/~~\_______________
//! taken, gave_up             _______/~~\____________    the flags are combined
//! prove                      ___________/~~\________    the bit after the answer is right, too
//! decides                    ______________/~~\_____    a cycle later: keeps the present sample out of this path
//! publish, late_fault, over  _________________/~~\__    cause and flags stay until the next one
//! ```
//!
//! An answer is published after the bit that follows it: one verdict for everything seen in the frame. A later fault (DATA does
//! not fall, additional data of another length) withdraws it.

use super::cause::{self, flag};
use super::primary::PrimaryCause;
use crate::endat::features::{Features, FixedTimes};
use crate::endat::ports::{AnswerCheckIn, ToldOut};
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Result, cause and flags of one channel's frames.
#[derive(LogicBlock, Block)]
#[properties("../../properties/verdict.sv")]
pub struct Verdict {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Flags for `give_up`, `refuse` or `announce`; bits as the raw flags in the register map.
    pub found: Signal<In, Bits<20>>,
    /// Strobe: the answer has been received; CRC and error bits decide.
    pub answer_taken: Signal<In, Bit>,
    /// Strobe, with `taken` or later: the answer has the right length; publish it.
    pub prove: Signal<In, Bit>,
    /// The frame measures the delay: a good answer to a trigger is not published, and its position is requested again.
    pub is_measuring: Signal<In, Bit>,
    /// Settings of the frame have changed during the frame.
    pub settings_upset: Signal<In, Bit>,
    /// Strobe: the frame is aborted.
    pub give_up: Signal<In, Bit>,
    /// With `give_up`: the result of the frame has been published.
    pub is_late: Signal<In, Bit>,
    /// Strobe: no frame is begun for this trigger.
    pub refuse: Signal<In, Bit>,
    /// Strobe: the result is reported, and the frame continues.
    pub announce: Signal<In, Bit>,
    /// Strobe: the frame has ended normally.
    pub normal_end: Signal<In, Bit>,
    /// The clock continues after this frame.
    pub is_going: Signal<In, Bit>,
    /// The frame belongs to a request, not to a trigger.
    pub is_own: Signal<In, Bit>,
    /// Strobe: a trigger is lost.
    pub lost: Signal<In, Bit>,
    /// Checks of an answer.
    #[bundle]
    pub check: AnswerCheckIn,
    /// Recovery time tm of the frame that has ended.
    pub recovery_cycles: Signal<In, Bits<13>>,
    /// Data must not fall before this.
    pub recovery_min_cycles: Signal<In, Bits<13>>,
    /// Strobe: `answer_taken`, a cycle later.
    pub taken: Signal<Out, Bit>,
    /// An answer has been received, and is not published yet.
    pub is_pending: Signal<Out, Bit>,
    /// With `taken`: the CRC is right.
    pub is_received: Signal<Out, Bit>,
    /// With `taken`: the CRC is wrong, as in the previous frame.
    pub is_doubtful: Signal<Out, Bit>,
    /// From `taken` on: the answer has a wrong CRC, or an alarm.
    pub is_bad: Signal<Out, Bit>,
    /// Strobe: `give_up`, a cycle later.
    pub gave_up: Signal<Out, Bit>,
    /// High while a result is waiting to be published.
    pub is_telling: Signal<Out, Bit>,
    /// Outcome of a frame.
    #[bundle]
    pub told: ToldOut,
    /// Strobe one cycle before `publish`.
    pub publishes: Signal<Out, Bit>,
    /// Strobe, instead of `publishes`: the delay is measured, and the position follows.
    pub once_more: Signal<Out, Bit>,
    /// Strobe: a frame has ended, normally or not.
    pub over: Signal<Out, Bit>,
    /// Strobe: a trigger is lost.
    pub displaced: Signal<Out, Bit>,
    #[start]
    chooser: PrimaryCause,
    has_guards: Constant<Bit>,
    has_diagnosis: Constant<Bit>,
    /// Shortest recovery time tm after a request's frame, in system clock cycles.
    own_recovery_min_cycles: Constant<Bits<13>>,
    /// Flags that this configuration can set.
    possible: Constant<Bits<20>>,
    crc_wrong: Constant<Bits<20>>,
    parallel_wrong: Constant<Bits<20>>,
    own_echo: Constant<Bits<20>>,
    f1_set: Constant<Bits<20>>,
    f2_clear: Constant<Bits<20>>,
    trigger_overrun: Constant<Bits<20>>,
    too_short: Constant<Bits<20>>,
    stored_upset: Constant<Bits<20>>,
    /// Flags found in the cycle before.
    seen: Reg<Bits<20>>,
    /// High for one cycle after `prove` if an answer was pending and the frame was not aborted.
    prove_seen: Reg<Bit>,
    /// `answer_taken`, one cycle later, unless the frame was aborted.
    was_taken: Reg<Bit>,
    /// `give_up`, one cycle later; never in two cycles in a row.
    was_given_up: Reg<Bit>,
    /// High with `gave_up` if the result of the frame is already published.
    gave_up_late: Reg<Bit>,
    /// `refuse`, one cycle later.
    refused: Reg<Bit>,
    /// `announce`, one cycle later.
    announced: Reg<Bit>,
    /// `normal_end`, one cycle later.
    ended: Reg<Bit>,
    /// Set when a trigger is lost; cleared when a result has reported it.
    overrun: Reg<Bit>,
    /// High if the last answer had a wrong CRC.
    was_bad: Reg<Bit>,
    /// High for one cycle: the result of a trigger is published.
    publishing: Reg<Bit>,
    /// High for one cycle: the answer is good and has the right length.
    is_good: Reg<Bit>,
    /// Set when a measuring frame has no result, so its short tm is not reported; cleared by the next answer.
    is_silent: Reg<Bit>,
    /// Set when an answer is received; cleared when its length is proven or the frame is aborted.
    pending: Reg<Bit>,
    /// High for one cycle: the published position is withdrawn.
    withdrawing: Reg<Bit>,
    /// High for one cycle: the published position is final.
    confirming: Reg<Bit>,
    /// High for one cycle: a fault that was found after the result is reported.
    reports_late: Reg<Bit>,
    /// High for one cycle: a frame has ended, normally or not.
    frame_over: Reg<Bit>,
    /// High from the end of a frame until its cause and flags are valid.
    telling: Reg<Bit>,
    /// `lost`, one cycle later.
    was_lost: Reg<Bit>,
    /// Flags of the last result or later fault; the primary cause is chosen from them.
    flags_held: Reg<Bits<20>>,
    /// Flags to report: from the strobe, the answer, lost triggers and upsets.
    found_all: Signal<Local, Bits<20>>,
    /// High if the received CRC does not match the bits as received, or as stored.
    crc_bad: Signal<Local, Bit>,
    /// High if the answer has a wrong CRC or an alarm bit.
    answer_bad: Signal<Local, Bit>,
    /// High for one cycle: the answer has the right length.
    proven: Signal<Local, Bit>,
    /// High for one cycle: the result is published in the next cycle.
    publishes_now: Signal<Local, Bit>,
    /// High with `proven` if a good answer came while settings of the frame changed.
    upset: Signal<Local, Bit>,
    /// High with `proven` if the answer has measured the delay: the position itself comes with another frame.
    measured: Signal<Local, Bit>,
    /// Shortest recovery time of this frame, in system clock cycles.
    recovery_min: Signal<Local, Bits<13>>,
    /// High if a frame without a fault has ended before the shortest recovery time.
    early: Signal<Local, Bit>,
}

/// Flags that the transaction can find with these features.
fn possible(features: Features) -> u64 {
    let mut causes = vec![
        cause::DATA_NOT_LOW,
        cause::NO_START_BIT,
        cause::START_WINDOW,
        cause::DATA_NOT_FALLING,
        cause::UNKNOWN_COMMAND,
        cause::UPSET,
    ];
    if features.requests {
        causes.push(cause::INFO_MISSING);
    }
    if features.diagnosis {
        causes.extend([cause::NO_ENCODER, cause::STUCK_HIGH, cause::STUCK_LOW]);
        causes.extend([cause::LATE_START, cause::WATCHDOG]);
    }
    causes.into_iter().map(flag).sum::<u64>() | flag::TAIL_LOW
}

impl Verdict {
    /// A verdict with these fixed times and features.
    pub fn new(times: FixedTimes, features: Features) -> Self {
        Self::from_parts(VerdictParts {
            has_guards: Constant::new(features.upset_guards),
            has_diagnosis: Constant::new(features.diagnosis),
            own_recovery_min_cycles: Constant::new(times.own_recovery_min_cycles.into()),
            possible: Constant::new(possible(features).into()),
            crc_wrong: Constant::new(flag(cause::CRC).into()),
            parallel_wrong: Constant::new(flag::PARALLEL_CRC.into()),
            own_echo: Constant::new(flag(cause::OWN_ECHO).into()),
            f1_set: Constant::new(flag(cause::F1).into()),
            f2_clear: Constant::new(flag(cause::F2).into()),
            trigger_overrun: Constant::new(flag(cause::TRIGGER_OVERRUN).into()),
            too_short: Constant::new(flag(cause::RECOVERY_TOO_SHORT).into()),
            stored_upset: Constant::new(flag(cause::UPSET).into()),
        })
    }
}

#[kernel]
impl Logic for Verdict {
    fn update(&mut self) {
        // Mask flags that are never set, so that synthesis can remove them.
        self.seen.d.next = self.found.val() & self.possible.val();
        // An answer that is complete in the cycle of an abort is not left pending for the next frame.
        self.was_taken.d.next = self.answer_taken.val() & !self.was_given_up.q.val();
        self.was_given_up.d.next = self.give_up.val() & !self.was_given_up.q.val();
        // A measuring frame has published nothing.
        self.gave_up_late.d.next = self.give_up.val()
            & !self.was_given_up.q.val()
            & self.is_late.val()
            & !self.measured.val();
        self.refused.d.next = self.refuse.val();
        self.announced.d.next = self.announce.val() & self.has_diagnosis.val();
        self.ended.d.next = self.normal_end.val();

        // From the registered flags: this keeps the selection out of the path of new faults.
        self.chooser.flags.next = self.flags_held.q.val();
        self.crc_bad.next = !(self.check.crc_ok.val() & self.check.stored_ok.val());
        self.answer_bad.next = self.crc_bad.val() | self.check.f1.val() | !self.check.f2.val();
        self.is_bad.next = self.answer_bad.val();
        self.is_pending.next = self.pending.q.val() | self.was_taken.q.val();
        // An aborted frame has the abort as its only result.
        self.prove_seen.d.next =
            self.prove.val() & self.is_pending.val() & !self.was_given_up.q.val();
        self.proven.next =
            self.prove_seen.q.val() & self.pending.q.val() & !self.was_given_up.q.val();
        self.found_all.next = self.seen.q.val();
        if self.proven.val() | (self.is_pending.val() & self.was_given_up.q.val()) {
            if self.crc_bad.val() {
                self.found_all.next = self.found_all.val() | self.crc_wrong.val();
                if self.has_diagnosis.val() & self.check.is_echo.val() {
                    self.found_all.next =
                        self.found_all.val() | self.crc_wrong.val() | self.own_echo.val();
                }
            }
            if self.check.f1.val() {
                self.found_all.next = self.found_all.val() | self.f1_set.val();
            }
            if !self.check.f2.val() {
                self.found_all.next = self.found_all.val() | self.f2_clear.val();
            }
            if !self.check.stored_ok.val() {
                self.found_all.next = self.found_all.val() | self.parallel_wrong.val();
            }
        }
        if self.was_taken.q.val() {
            self.was_bad.d.next = self.crc_bad.val();
        }
        self.upset.next = self.proven.val() & !self.answer_bad.val() & self.settings_upset.val();
        self.measured.next = self.proven.val()
            & self.is_measuring.val()
            & !self.answer_bad.val()
            & !self.upset.val()
            & !self.is_own.val();
        // An abort without a flag means that a register was upset.
        if self.upset.val()
            | (self.has_guards.val() & self.was_given_up.q.val() & !self.seen.q.val().any())
        {
            self.found_all.next = self.found_all.val() | self.stored_upset.val();
        }
        // The result reports this.
        if self.overrun.q.val() & !self.measured.val() {
            self.found_all.next = self.found_all.val() | self.trigger_overrun.val();
        }
        self.recovery_min.next = self.recovery_min_cycles.val();
        if self.is_own.val() {
            self.recovery_min.next = self.own_recovery_min_cycles.val();
        }
        self.early.next = self.has_diagnosis.val()
            & self.ended.q.val()
            & !self.is_going.val()
            & !self.proven.val()
            & !self.chooser.cause.val().any()
            & (self.recovery_cycles.val() < self.recovery_min.val());
        if self.early.val() {
            self.found_all.next = self.found_all.val() | self.too_short.val();
        }
        if self.proven.val()
            | self.was_given_up.q.val()
            | self.refused.q.val()
            | self.announced.q.val()
            | self.early.val()
        {
            self.flags_held.d.next = self.found_all.val();
            // The end of a measuring frame is not reported.
            if !self.is_own.val()
                & !self.measured.val()
                & !(self.early.val() & self.is_silent.q.val())
            {
                self.overrun.d.next = false;
            }
        }
        self.was_lost.d.next = self.lost.val();
        if self.was_lost.q.val() {
            self.overrun.d.next = true;
        }
        if self.measured.val() {
            self.is_silent.d.next = true;
        }
        if self.answer_taken.val() {
            self.is_silent.d.next = false;
        }
        self.publishes_now.next = ((self.proven.val() & !self.measured.val())
            | self.refused.q.val()
            | self.announced.q.val()
            | (self.was_given_up.q.val() & !self.gave_up_late.q.val()))
            & !self.is_own.val();
        self.publishing.d.next = self.publishes_now.val();
        self.publishes.next = self.publishes_now.val();
        if self.was_taken.q.val() {
            self.pending.d.next = true;
        }
        if self.proven.val() | self.was_given_up.q.val() {
            self.pending.d.next = false;
        }
        self.reports_late.d.next = (self.gave_up_late.q.val()
            | (self.early.val() & !self.is_silent.q.val()))
            & !self.is_own.val();
        self.withdrawing.d.next = self.gave_up_late.q.val() & !self.is_own.val();
        self.confirming.d.next = self.ended.q.val() & !self.is_own.val();
        self.is_received.next = self.was_taken.q.val() & !self.crc_bad.val();
        self.is_doubtful.next = self.was_taken.q.val() & self.crc_bad.val() & self.was_bad.q.val();
        self.is_good.d.next = self.proven.val() & !self.answer_bad.val() & !self.upset.val();
        // `over` comes with cause and flags of the fault that ended the frame.
        self.frame_over.d.next =
            self.ended.q.val() | self.was_given_up.q.val() | self.refused.q.val();
        self.telling.d.next = self.normal_end.val()
            | self.give_up.val()
            | self.refuse.val()
            | self.ended.q.val()
            | self.was_given_up.q.val()
            | self.refused.q.val();

        self.taken.next = self.was_taken.q.val();
        self.gave_up.next = self.was_given_up.q.val();
        self.is_telling.next = self.telling.q.val();
        self.told.publish.next = self.publishing.q.val();
        self.told.good.next = self.is_good.q.val();
        self.once_more.next = self.measured.val();
        self.told.late_fault.next = self.reports_late.q.val();
        self.told.withdraw.next = self.withdrawing.q.val();
        self.told.confirm.next = self.confirming.q.val();
        self.over.next = self.frame_over.q.val();
        self.displaced.next = self.was_lost.q.val();
        self.told.cause_told.next = self.chooser.cause.val();
        self.told.flags_told.next = self.flags_held.q.val();
    }
}
