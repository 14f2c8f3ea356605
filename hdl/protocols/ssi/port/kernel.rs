//! Kernel of the SSI port.

use super::*;
use rtl_design::kernel;

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
        self.check_special_bits();
        self.recover();
        self.judge();
        self.show_result();
    }

    /// Lengths of both halves of a period, and the end of the one under way.
    fn time_clock(&mut self) {
        // A shorter period has no halves.
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

    /// Runs the clock and the states.
    fn clock_frame(&mut self) {
        self.bits.next = self.position_bits.val();
        if self.frame.val().get_bit(3) {
            self.bits.next = self.position_bits.val() + 1;
        }
        for i in 0..self._specials {
            self.bits.next = self.special[i].all_bits.val();
        }
        self.ends_copy.next = !self.left.q.val().get_bits::<5>(1).any();
        // This rising edge samples the last bit of the frame.
        self.is_last.next = !self.first.q.val()
            & self.ends_copy.val()
            & (self.second.q.val() | !self.frame.val().get_bit(1));
        // An upset must not keep the clock LOW.
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
                // In any state of the line: the next trigger checks it again.
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

    /// Samples DATA at each rising edge of the clock except the first of a copy, most significant bit first.
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
                // Parity of the bits as sent.
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

    /// Special bits, for encoders with such bits.
    fn check_special_bits(&mut self) {
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

    /// End of the recovery time.
    fn recover(&mut self) {
        // The encoder is ready again if DATA was LOW before.
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

    /// Checks of the frame: a bit for each cause, in the order of their codes.
    fn judge(&mut self) {
        self.busy.next = self.state.q.val() != self.at_rest.val();
        self.publishes.next = (self.state.q.val() == self.at_judge.val())
            & !(self.unknown.q.val() & self.not_low.q.val());
        // The result of the frame under way, or of the next one, reports a lost trigger.
        if self.publishes.val() {
            self.lost.d.next = false;
            self.slow.d.next = false;
        }
        self.loses.next = self.trigger.val() & (self.state.q.val() != self.at_rest.val());
        self.is_lost.d.next = self.loses.val();
        self.trigger_lost.next = self.is_lost.q.val();
        if self.loses.val() {
            self.lost.d.next = true;
        }
        if self.is_late.val() {
            self.slow.d.next = true;
        }
        self.is_other.next =
            self.frame.val().get_bit(1) & (self.word.q.val() != self.again.q.val());
        // The bits are counted twice, because a copy that is short by one could match if the next one begins a bit early.
        self.is_torn.next = self.has_guards.val()
            & (self.torn.q.val()
                | self.is_astray.val()
                | (self.left.q.val() != self.left_too.q.val())
                | (self.first.q.val() != self.first_too.q.val()));
        self.torn.d.next = self.is_torn.val()
            & (self.is_astray.val() | (self.state.q.val() != self.at_rest.val()));
        // Checks that all bits of all copies have been received.
        self.is_short.next = (self.left.q.val().any()
            | (self.second.q.val() ^ self.frame.val().get_bit(1)))
            & !self.unknown.q.val()
            & !self.not_high.q.val();
        // Checks that the stored bits are the received bits.
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
        // The next result reports a lost trigger; it does not affect the outcome of this one.
        self.raised.next = bit_cast::<16, 6>(self.found.val())
            | (bit_cast::<16, 1>((self.lost.q.val() & !self.is_late.val()).into()) << 6)
            | (bit_cast::<16, 1>((self.slow.q.val() | self.is_late.val()).into()) << 7)
            | bit_cast::<16, 12>(self.special_found.val());
        self.primary.flags.next = self.raised.val();
        for i in 0..self._specials {
            // A lost trigger, or a late end of the previous frame, alone would accept the position.
            if self.special[i].found.val().any() {
                self.primary.flags.next = self.raised.val() & 0xFF3F;
            }
        }
    }

    /// Outputs the last good position, and the cause if there is no newer one.
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
