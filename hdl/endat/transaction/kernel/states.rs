//! Actions of the transaction in each phase.

use rtl_design::kernel_parts;

#[kernel_parts(states)]
impl Transaction {
    /// Waits until DATA has been LOW for long enough.
    fn await_low(&mut self) {
        self.limit.next = self.ready_low_cycles.val() - 1;
        self.timer_clear.next = self.level.val();
        self.idle.next = self.level.val() & !(self.next_frame.hold_off.val() & self.has_all.val());
        if self.timer_hit.q.val() {
            self.phase.d.next = Phase::Ready;
        }
        if self.level.val() {
            self.phase.d.next = Phase::NotReady;
            // Longer than the ringing of an edge.
            self.plugged.d.next = self.high_at_tick.q.val() & self.tick_us.val();
            if self.triggered.val() | self.owed.val() {
                self.found.next = self.not_low.val();
                self.give_up.next = true;
            }
        }
        if self.vanished.val() {
            self.found.next = self.upset.val();
            self.give_up.next = true;
        }
    }

    /// Waits for a trigger.
    fn await_trigger(&mut self) {
        self.timer_clear.next = true;
        // Drop a trigger while the refusal of the previous one is being published; otherwise it would get that result.
        self.idle.next =
            !(self.next_frame.hold_off.val() & self.has_all.val()) & !self.verdict.is_telling.val();
        if self.level.val() {
            self.phase.d.next = Phase::NotReady;
            self.plugged.d.next = true;
            if (self.triggered.val() | self.owed.val()) & !self.verdict.is_telling.val() {
                self.found.next = self.not_low.val();
                self.give_up.next = true;
            }
        } else {
            if self.wanted.val() & !self.verdict.is_telling.val() {
                if self.next_frame.is_known.val() {
                    self.accept.next = true;
                    self.phase.d.next = Phase::Frame;
                    if self.extra.q.val() {
                        self.phase.d.next = Phase::FirstLow;
                    }
                } else {
                    self.found.next = self.unknown_command.val();
                    self.refuse.next = true;
                }
            }
            // The line is reserved for long; the trigger still gets a result: no fault, no position.
            if self.once_more.q.val()
                & self.next_frame.hold_off.val()
                & self.has_all.val()
                & !self.own.val()
            {
                self.refuse.next = true;
            }
        }
        if self.vanished.val() {
            self.found.next = self.upset.val();
            self.give_up.next = true;
            // A frame that began now would end with a second result.
            self.accept.next = false;
        }
    }

    /// The first low phase is longer than the others.
    fn hold_first_low(&mut self) {
        self.running.next = true;
        self.watched.next = true;
        self.limit.next = bit_cast::<16, 11>(self.limits.first_low_extra_cycles.val());
        if self.timer_hit.q.val() {
            self.phase.d.next = Phase::Frame;
            self.timer_clear.next = true;
        }
    }

    /// Command and answer.
    fn run_frame(&mut self) {
        self.running.next = true;
        self.watched.next = true;
        self.in_us.next = true;
        self.timer_clear.next =
            (self.progress.hunting.val() ^ self.was_hunting.q.val()) | self.progress.finished.val();
        // The receiver has lost its place. The timer of the hunt is still compared in the cycle after it.
        if self.endless.val()
            & !self.progress.hunting.val()
            & !(self.was_hunting.q.val() & self.has_all.val())
        {
            self.found.next = self.tail_low.val();
            self.give_up.next = true;
        }
        // In the first cycle of the hunt the timer still has the value of the previous wait.
        if self.timer_hit.q.val() & self.progress.hunting.val() & self.was_hunting.q.val() {
            self.found.next = self.no_start.val();
            self.give_up.next = true;
            // Report the result; the clock continues for the same time, to distinguish a late encoder from none.
            if self.has_diagnosis.val() & !self.shape.has_parameter.val() & !self.late.q.val() {
                self.give_up.next = false;
                self.announce.next = true;
                self.timer_clear.next = true;
            }
        }
        if self.late.q.val() & (self.progress.started.val() | self.progress.start_refused.val()) {
            self.found.next = self.no_start_bit.val() | self.late_start.val();
            self.give_up.next = true;
        }
        if self.progress.start_refused.val() & !self.late.q.val() {
            self.found.next = self.start_window.val();
            self.give_up.next = true;
        }
        if self.progress.done.val() {
            self.answer_taken.next = true;
        }
        if self.progress.separated.val() & self.has_all.val() {
            self.proof.next = true;
        }
        if self.has_continuous.val() & self.progress.gap_good.val() {
            self.proof.next = true;
        }
        if self.has_continuous.val() & self.progress.latched.val() {
            self.normal_end.next = true;
        }
        if self.progress.info_missing.val() & self.has_all.val() {
            self.found.next = self.info_not_there.val();
            self.give_up.next = true;
        }
        if self.has_continuous.val() & self.progress.gap_low.val() {
            self.found.next = self.tail_low.val();
            self.give_up.next = true;
        }
        if self.has_continuous.val() & self.progress.gap_high.val() {
            self.found.next = self.not_falling.val();
            self.give_up.next = true;
            self.found_late.next = true;
        }
        if self.progress.finished.val() & !self.going.val() {
            self.phase.d.next = Phase::Tail;
            if self.has_all.val() & self.shape.has_supplement.val() & !self.in_supplement.q.val() {
                self.phase.d.next = Phase::Park;
            }
        }
    }

    /// CLOCK is LOW before the supplement.
    fn park(&mut self) {
        self.running.next = true;
        self.watched.next = true;
        // No bit follows the answer here.
        self.proof.next = self.verdict.taken.val();
        self.limit.next = self.park_cycles.val() - 1;
        if self.timer_hit.q.val() {
            self.phase.d.next = Phase::Frame;
            self.timer_clear.next = true;
            self.in_supplement.d.next = true;
            self.supplement_starts.d.next = true;
            if !self.progress.all_ended.val() {
                self.found.next = self.upset.val();
                self.give_up.next = true;
            }
        }
        if !self.has_all.val() {
            self.found.next = self.upset.val();
            self.give_up.next = true;
        }
    }

    /// The last edges of the clock.
    fn end_clock(&mut self) {
        self.running.next = true;
        self.watched.next = true;
        self.in_us.next = true;
        if self.endless.val() {
            self.found.next = self.tail_low.val();
            self.give_up.next = true;
        }
        // One cycle late, because the middle may come before the last bit has been processed.
        if self.was_center.q.val() {
            self.phase.d.next = Phase::Recovery;
            // The times of the full clock apply from here on: a short tm ends before half a slow period does.
            self.acquiring.d.next = false;
            self.is_slow.d.next = false;
        }
    }

    /// DATA falls when the recovery time is over.
    fn await_fall(&mut self) {
        self.running.next = !self.tail_sampled.q.val();
        self.watched.next = true;
        self.limit.next = bit_cast::<16, 13>(self.limits.recovery_limit_cycles.val());
        // A request's command may have another range than the command of the triggers.
        if self.own.val() {
            self.limit.next = self.own_recovery_limit_cycles.val();
        }
        if self.cells.sample.val() {
            self.tail_sampled.d.next = true;
            self.proof.next = !self.tail_sampled.q.val() & self.level.val();
        }
        if self.tail_sampled.q.val() & !self.level.val() {
            self.recovery.d.next = self.timer.q.val().get_bits::<13>(0);
            self.timer_clear.next = true;
            self.phase.d.next = Phase::NotReady;
            self.normal_end.next = true;
        } else {
            if self.timer_hit.q.val() {
                self.found.next = self.not_falling.val();
                self.give_up.next = true;
            }
        }
        // Each cell had its pulse, unless a count was upset.
        if self.cells.sample.val() & !self.tail_sampled.q.val() & !self.progress.all_used.val() {
            self.found.next = self.upset.val();
            self.give_up.next = true;
        }
        // The encoder is still sending, or has stopped early: its frame has another length than configured.
        if self.cells.sample.val() & !self.tail_sampled.q.val() & !self.level.val() {
            self.found.next = self.tail_low.val();
            self.give_up.next = true;
        }
    }

    /// Keeps the line idle, then probes it if the diagnosis is present.
    fn stay_quiet(&mut self) {
        self.in_us.next = true;
        self.limit.next = self.abort_us.val();
        if self.has_continuous.val() & self.leaving.q.val() {
            self.limit.next = self.leave_us.val();
        }
        if self.has_diagnosis.val() & self.probing.q.val() {
            self.limit.next = self.probe_us.val();
        }
        if self.has_diagnosis.val() & self.settling.q.val() {
            self.limit.next = self.settle_us.val();
        }
        if self.timer_hit.q.val() {
            self.phase.d.next = Phase::NotReady;
            self.timer_clear.next = true;
            self.leaving.d.next = false;
            self.settling.d.next = false;
            if self.has_diagnosis.val() & self.level.val() & !self.settling.q.val() {
                self.phase.d.next = Phase::Abort;
                self.probing.d.next = true;
            }
            if self.probing.q.val() {
                self.phase.d.next = Phase::Abort;
                self.probed.next = true;
                self.probing.d.next = false;
                self.settling.d.next = true;
            }
        }
    }
}
