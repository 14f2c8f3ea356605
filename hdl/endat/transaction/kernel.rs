//! Kernel of the transaction.

use super::*;
use rtl_design::kernel;

mod states;

#[kernel(parts = states::states)]
impl Logic for Transaction {
    fn update(&mut self) {
        clock!(self, clock, health, verdict);
        self.phase.reset.next = false;
        self.extra.d.next = self.limits.first_low_extra_cycles.val().any();
        self.health.reset.next = self.reset.val();
        self.verdict.reset.next = self.reset.val();
        self.ask();
        self.explain_line();
        self.go_on();
        self.end_frame();
        self.run_timer();
        self.find_last_edge();
        self.judge();
        self.know_delay();
        self.owe();
        self.begin_frame();
        self.run_on();
        self.measure_again();
        self.hold_clock();
        self.tell();
        self.watch_health();
    }

    /// Frame requests, and defaults of a cycle.
    fn ask(&mut self) {
        self.own.next = self.next_frame.is_own.val() & self.has_all.val();
        self.triggered.next =
            self.next_frame.trigger.val() & !(self.next_frame.hold_off.val() & self.has_all.val());
        // The position that follows a measuring frame.
        self.owed.next = self.once_more.q.val()
            & self.owing.q.val()
            & !(self.next_frame.hold_off.val() & self.has_all.val());
        self.wanted.next = self.triggered.val()
            | self.owed.val()
            | (self.next_frame.begin_own.val() & self.has_all.val());
        self.proof.next = false;
        self.plugged.d.next = false;
        self.refuse.next = false;
        self.normal_end.next = false;
        self.supplement_starts.d.next = false;
        self.limit.next = bit_cast::<16, 12>(self.limits.start_timeout_us.val());
        if self.has_all.val() & self.shape.has_parameter.val() {
            self.limit.next = self.parameter_timeout_us.val();
        }
        self.in_us.next = false;
        self.timer_clear.next = false;
        self.accept.next = false;
        self.give_up.next = false;
        self.idle.next = false;
        self.answer_taken.next = false;
        self.announce.next = false;
        self.probed.next = false;
        // The timer of a wait longer than a frame still counts for one cycle after it.
        self.endless.next = (self.timer.q.val() & self.frame_us.val()).any()
            & !(self.cleared.q.val() & self.has_all.val());
        self.watched.next = false;
        self.found_late.next = false;
        self.found.next = 0.into();
    }

    /// Flags for a line that is HIGH at rest, and for a missing start bit.
    fn explain_line(&mut self) {
        self.not_low.next = self.data_not_low.val();
        self.no_start.next = self.no_start_bit.val();
        if self.has_diagnosis.val() & self.health.is_open.val() {
            self.not_low.next = self.data_not_low.val() | self.no_encoder.val();
        }
        if self.has_diagnosis.val() & self.health.is_stuck.val() {
            self.not_low.next = self.data_not_low.val() | self.stuck_high.val();
        }
        if self.has_diagnosis.val() & self.health.never_high.val() {
            self.no_start.next = self.no_start_bit.val() | self.stuck_low.val();
        }
    }

    /// Sequence of a frame.
    fn go_on(&mut self) {
        self.running.next = false;
        // A frame without an end: a register was upset.
        self.vanished.next = self.has_guards.val()
            & ((self.owing.q.val() & !self.once_more.q.val()) | self.under_way.q.val());

        match self.phase.q.val() {
            Phase::NotReady => self.await_low(),
            Phase::Ready => self.await_trigger(),
            Phase::FirstLow => self.hold_first_low(),
            Phase::Frame => self.run_frame(),
            Phase::Park => self.park(),
            Phase::Tail => self.end_clock(),
            Phase::Recovery => self.await_fall(),
            Phase::Abort => self.stay_quiet(),
            _ => {
                self.found.next = self.upset.val();
                self.give_up.next = true;
            }
        }
    }

    /// Ends a frame, early or normally.
    fn end_frame(&mut self) {
        if self.has_diagnosis.val() & self.health.expired.val() & self.watched.val() {
            self.found.next = self.found.val() | self.too_long.val();
            self.give_up.next = true;
        }
        // An aborted frame has the abort as its only result; the verdict uses this for `proof`.
        if self.give_up.val() | self.verdict.gave_up.val() {
            self.announce.next = false;
        }
        // Continuous clock ends with the clock HIGH for longer than tm, in any state of the encoder.
        self.leave.next = self.going.val()
            & self.progress.gap_good.val()
            & (!self.next_frame.continuous.val()
                | self.next_frame.line_wanted.val()
                | !self.known.val()
                | (self.next_frame.stop_at_error.val() & self.verdict.is_bad.val()));
        // Delayed, because the answer of this cycle is published first.
        self.left.d.next = self.leave.val();
        if self.left.q.val() {
            self.normal_end.next = true;
        }
        if self.proof.val() & self.verdict.is_pending.val() & !self.going.val() {
            self.answered.d.next = true;
        }
        if self.announce.val() {
            self.answered.d.next = true;
            self.late.d.next = true;
        }
        if self.normal_end.val() {
            self.answered.d.next = false;
            self.under_way.d.next = self.going.val() & !self.leave.val();
        }
        // The abort takes effect one cycle later, which keeps the decision out of the longest paths.
        if self.verdict.gave_up.val() {
            self.phase.d.next = Phase::Abort;
            self.timer_clear.next = true;
            self.accept.next = false;
            self.refuse.next = false;
            // A trigger directly after the refused one counts as lost.
            self.idle.next = false;
            // DATA LOW after a frame of another length does not end the frame again.
            self.normal_end.next = false;
            self.answered.d.next = false;
            self.is_calibrated.d.next = false;
            self.late.d.next = false;
            self.under_way.d.next = false;
        }
    }

    /// Time-outs, each counted from the start of its span.
    fn run_timer(&mut self) {
        self.was_hunting.d.next = self.progress.hunting.val();
        self.was_center.d.next = self.center.val();
        self.timer_step.d.next = !self.in_us.val() | self.tick_us.val();
        if self.timer_step.q.val() {
            self.timer.d.next = self.timer.q.val() + 1;
        }
        self.timer_limit.d.next = self.limit.val();
        // Greater or equal: a timer upset past its limit ends, too. While `cleared` is HIGH the timer still has the value of the previous span.
        self.timer_hit.d.next =
            (self.timer.q.val() >= self.timer_limit.q.val()) & !self.cleared.q.val();
        self.cleared.d.next = self.timer_clear.val() | self.rise_back.val();
        if self.timer_clear.val() {
            self.timer_hit.d.next = false;
        }
        // The timer starts one cycle after the strobe that begins a span, with the cycles that have passed by then. Spans that start at 0
        // and count cycles have a limit that is one less.
        self.is_back.d.next = self.rise_back.val() & !self.verdict.gave_up.val();
        if self.cleared.q.val() {
            self.timer.d.next = 0.into();
        }
        if self.is_back.q.val() {
            self.timer.d.next = bit_cast::<16, 3>(self.last_edge.ago_cycles.val())
                + bit_cast::<16, 2>((bit_cast::<2, 1>(self.timer_step.q.val().into())) | 2);
        }
        if self.starting.q.val() {
            self.timer.d.next = 3.into();
        }
    }

    /// Finds the start of the recovery time.
    fn find_last_edge(&mut self) {
        self.in_tail.next = self.phase.q.val() == Phase::Tail;
        self.in_recovery.next = self.phase.q.val() == Phase::Recovery;
        self.cell_control.last_cell.next = self.in_tail.val() & self.was_center.q.val();
        connect!(self.last_edge <= self;
            clock, reset, in_tail, in_recovery, will_rise, going, running
        );
        connect!(self.last_edge <= self.progress;
            last_bit, no_pulse_left = all_sent, one_pulse_left = one_to_send, last_sent, none_under_way,
            started
        );
        self.last_edge.start.next = self.starting.q.val();
        self.rise_back.next = self.last_edge.comes.val();
        self.last_edge.was_center.next = self.was_center.q.val();
        self.last_edge.tail_sampled.next = self.tail_sampled.q.val();
        self.last_edge.in_supplement.next = self.in_supplement.q.val();
    }

    /// Inputs of the verdict.
    fn judge(&mut self) {
        connect!(self.verdict <= self; found, answer_taken, prove = proof);
        self.verdict.is_measuring.next = self.measuring.q.val();
        self.verdict.settings_upset.next = self.settings_upset.val() | self.delay_upset.val();
        self.verdict.give_up.next = self.give_up.val();
        // A measuring frame has published nothing.
        self.verdict.is_late.next =
            (self.answered.q.val() & !self.verdict.once_more.val()) | self.found_late.val();
        connect!(self.verdict <= self; refuse, announce, normal_end, is_own = own);
        // While a run stops, no recovery time is measured.
        self.verdict.is_going.next =
            self.going.val() | (self.leaving.q.val() & self.has_continuous.val());
        AnswerCheckIn::link(&mut self.check, &mut self.verdict.check);
        self.verdict.recovery_cycles.next = self.recovery.q.val();
        self.verdict.recovery_min_cycles.next = self.limits.recovery_min_cycles.val();
    }

    /// Tracks whether the propagation delay is known.
    fn know_delay(&mut self) {
        // With alignment, the mean over several frames; the last of them makes the delay known.
        if self.verdict.is_received.val()
            & self.measuring.q.val()
            & !(self.has_alignment.val() & self.is_fixed.val())
        {
            self.is_calibrated.d.next = true;
            if self.has_alignment.val() & self.is_slow.q.val() {
                self.passes.d.next = self.passes.q.val() + 1;
                self.is_calibrated.d.next = self.passes.q.val().all();
            }
        }
        // A delay that is wrong by whole periods is not detected at the start edge. A continuous clock finds each start bit anew, and ends as configured.
        if self.verdict.is_doubtful.val() & !self.going.val() {
            self.is_calibrated.d.next = false;
        }
    }

    /// Lost triggers, and the owed result.
    fn owe(&mut self) {
        self.lost.next = self.next_frame.trigger.val()
            & !self.going.val()
            & ((!self.accept.val() & !self.idle.val())
                | (self.accept.val() & self.own.val())
                | self.owing.q.val());
        self.verdict.lost.next = self.lost.val();
        self.known.next =
            self.is_calibrated.q.val() | (self.has_alignment.val() & self.is_fixed.val());
        if self.verdict.publishes.val() | self.refuse.val() {
            self.owing.d.next = false;
        }
        // Any other outcome of that frame is the trigger's result, not a late fault.
        if self.verdict.once_more.val() {
            self.once_more.d.next = true;
            self.answered.d.next = false;
        }
        if (self.accept.val() & !self.own.val())
            | self.refuse.val()
            | self.verdict.gave_up.val()
            | !self.owing.q.val()
        {
            self.once_more.d.next = false;
        }
        if self.accept.val() & !self.own.val() {
            self.owing.d.next = true;
        }
    }

    /// Start values of a frame.
    fn begin_frame(&mut self) {
        if self.accept.val() {
            self.is_slow.d.next = !self.known.val();
            self.late.d.next = false;
        }
        // One cycle later is early enough: the first clock edge has not come yet.
        if self.starting.q.val() {
            self.measuring.d.next = self.is_slow.q.val();
            self.under_way.d.next = true;
            self.answered.d.next = false;
            self.in_supplement.d.next = false;
            self.acquiring.d.next =
                self.is_slow.q.val() & !(self.has_alignment.val() & self.passes.q.val().any());
            self.tail_sampled.d.next = false;
        }
    }

    /// A clock that continues after the answer, and its end.
    fn run_on(&mut self) {
        self.going.next = false;
        for i in 0..self._runs {
            connect!(self.runs[i] <= self; clock, reset);
            self.runs[i].raise.next = self.accept.val()
                & self.next_frame.continuous.val()
                & self.known.val()
                & !self.own.val();
            self.runs[i].clear.next =
                self.leave.val() | self.verdict.gave_up.val() | self.accept.val();
            self.going.next = self.runs[i].is_set.val();
        }
        if self.leave.val() {
            self.phase.d.next = Phase::Abort;
            self.timer_clear.next = true;
            self.leaving.d.next = true;
        }
        if self.verdict.gave_up.val() {
            self.leaving.d.next = false;
            self.probing.d.next = false;
            self.settling.d.next = false;
        }
    }

    /// Conditions for a new measurement of the delay.
    fn measure_again(&mut self) {
        self.high_at_tick.d.next = self.high_at_tick.q.val() & self.level.val();
        if self.tick_us.val() {
            self.high_at_tick.d.next = self.level.val();
        }
        // A fixed delay is not measured: tracking must measure first.
        self.afresh.next =
            self.next_frame.calibrate.val() | self.plugged.q.val() | self.delay_upset.val();
        if self.afresh.val() | (self.has_alignment.val() & self.is_fixed.val()) {
            self.is_calibrated.d.next = false;
        }
        if self.afresh.val() | self.verdict.gave_up.val() | self.verdict.is_doubtful.val() {
            self.passes.d.next = 0.into();
        }
    }

    /// The clock: runs, is held LOW, ends.
    fn hold_clock(&mut self) {
        self.was_running.d.next = self.running.val();
        self.cell_control.run.next = self.was_running.q.val();
        self.starting.d.next = self.accept.val();
        self.control.start.next = self.starting.q.val();
        self.control.aborts.next = self.verdict.gave_up.val();
        // Receiving the start bit ends its cell; `started` is set by the time of the comparison.
        self.sent.next =
            self.last_edge.all_sent.val() & self.progress.started.val() & !self.going.val();
        self.parking.next = false;
        if self.has_all.val() & self.shape.has_supplement.val() & !self.in_supplement.q.val() {
            self.parking.next = (self.sent.val() & (self.phase.q.val() == Phase::Frame))
                | (self.phase.q.val() == Phase::Park);
            self.sent.next = false;
        }
        self.hold.d.next = (self.phase.q.val() == Phase::FirstLow)
            | self.last_edge.holds.val()
            | self.parking.val();
        self.hold_low.next = self.hold.q.val();
        self.cell_control.drain.next = self.last_edge.stalled.val();
        if self.has_all.val() {
            self.cell_control.drain.next =
                self.last_edge.stalled.val() | (self.phase.q.val() == Phase::Park);
        }
        self.stopping.d.next = !self.running.val() | self.verdict.gave_up.val() | self.leave.val();
        // The high phase of the last pulse may be only two cycles long.
        self.stop.next = self.stopping.q.val() | self.sent.val();
    }

    /// Outputs.
    fn tell(&mut self) {
        self.control.acquire.next = self.acquiring.q.val();
        self.cell_control.slow.next = self.is_slow.q.val();
        self.busy.next = !self.idle.val()
            | self.once_more.q.val()
            | (self.next_frame.begin_own.val() & self.has_all.val());
        ToldOut::link(&mut self.told, &mut self.verdict.told);
        self.control.start_supplement.next = self.supplement_starts.q.val();
        self.over.next = self.verdict.over.val();
        self.begun.next = self.accept.val() | self.refuse.val();
        // A reset may have come in the middle of a frame. After power-up no frame has begun.
        if self.reset.val() {
            self.phase.d.next = Phase::Abort;
        }
        self.is_at_rest.next = ((self.phase.q.val() == Phase::NotReady)
            | (self.phase.q.val() == Phase::Ready))
            & !self.verdict.is_telling.val();
        self.displaced.next = self.verdict.displaced.val();
        self.calibrated.next = self.known.val();
        self.recovery_cycles.next = self.recovery.q.val();
        self.probe.next =
            self.probing.q.val() & (self.phase.q.val() == Phase::Abort) & self.has_diagnosis.val();
        if self.phase.q.val() != Phase::Abort {
            self.probing.d.next = false;
            self.settling.d.next = false;
        }
        self.is_probed.next =
            (self.probing.q.val() | self.settling.q.val()) & self.has_diagnosis.val();
        self.control.going_on.next = self.going.val();
    }

    /// Health of the line.
    fn watch_health(&mut self) {
        connect!(self.health <= self; tick_us, level);
        self.health.start.next = self.starting.q.val();
        self.health.under_way.next = self.watched.val() & self.is_watched.val() & !self.going.val();
        self.health.watchdog_us.next = self.limits.watchdog_us.val();
        self.health.probed.next = self.probed.val();
        self.health.is_ready.next = self.phase.q.val() == Phase::Ready;
    }
}
