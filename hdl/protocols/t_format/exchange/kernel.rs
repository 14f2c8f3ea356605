//! Kernel of the exchange.

use super::*;
use rtl_design::kernel;

#[kernel]
impl Logic for Exchange {
    fn update(&mut self) {
        clock!(self, clock, grid, order);
        self.forget_last();
        self.wire();
        self.watch_line();
        self.run_timer();
        self.take_bit();
        self.go_on();
        self.guard_request();
        self.judge();
        self.report();
    }

    /// Clears the notes of an exchange after its result has been published.
    fn forget_last(&mut self) {
        self.forget.next = self.reset.val() | (self.phase.q.val() == Phase::Rest);
        self.grid.reset.next = self.reset.val();
        self.order.reset.next = self.reset.val();
        self.upset.reset.next = self.forget.val();
        // Between exchanges, and before the reply.
        self.check.reset.next =
            self.forget.val() | ((self.phase.q.val() == Phase::Wait) & self.order.is_control.val());
        self.echo.reset.next = self.forget.val();
        self.heard.reset.next = self.forget.val();
        self.missed.reset.next = self.forget.val();
        self.bad_parity.reset.next = self.forget.val();
        self.bad_echo.reset.next = self.forget.val();
        self.bad_delimiter.reset.next = self.forget.val();
        self.bad_crc.reset.next = self.forget.val();
        self.memory_busy.reset.next = self.forget.val();
    }

    /// Connects bits and field order.
    fn wire(&mut self) {
        self.grid.bit_cycles.next = self.bit_cycles.val();
        self.grid.restart.next = false;
        self.order.request_id.next = self.request_id.val();
        self.order.sending.next = self.phase.q.val() == Phase::Send;
        self.order.first.next = false;
        self.order.step.next = false;
        connect!(self.bits <= self; request_id, address, data);
        self.bits.crc_bit.next = self.check.q.val().get_bit(0);
        self.bits.index.next = self.index.q.val().get_bits::<3>(0);
        connect!(self.bits <= self.order; is_control, is_address, is_crc);
    }

    /// Detects edges, and measures the time since the last one.
    fn watch_line(&mut self) {
        self.previous.d.next = self.level.val();
        self.rising.next = !self.previous.q.val() & self.level.val();
        // Counts half a bit from each edge on.
        self.turns.next = self.previous.q.val() ^ self.level.val();
        self.half_bit.next = self.bit_cycles.val() >> 1;
        if self.run.q.val().any() {
            self.run.d.next = self.run.q.val() - 1;
        }
        if self.turns.val() {
            self.run.d.next = self.half_bit.val().get_bits::<6>(0);
        }
    }

    /// Counts below zero, to -3: so a wait is longer than its setting, wherever it began between two strobes.
    fn run_timer(&mut self) {
        self.expired.next = self.timer.q.val().get_bit(6) & !self.timer.q.val().get_bit(1);
        if self.tick_us.val() & !self.expired.val() {
            self.timer.d.next = self.timer.q.val() - 1;
        }
        // One field, or four.
        self.request_us.next = 3.into();
        if self.order.parts.is_memory.val() {
            self.request_us.next = 15.into();
        }
        self.rest_us.next = bit_cast::<7, 3>(self.field_gap_us.val()) | 8;
    }

    /// The start bit is 15, data bits are 0 to 7, the delimiter is 8.
    fn take_bit(&mut self) {
        self.is_start.next = self.index.q.val().get_bit(3) & self.index.q.val().get_bit(0);
        self.is_bit.next = !self.index.q.val().get_bit(3);
        self.in_sync.next = self.order.is_control.val()
            & self.is_bit.val()
            & !self.index.q.val().get_bit(2)
            & !(self.index.q.val().get_bit(1) & self.index.q.val().get_bit(0));
        // The edge into the second cell of the sync code times the following bits, even if the old grid has a strobe in this cycle.
        self.retimed.next = self.rising.val()
            & self.in_sync.val()
            & self.index.q.val().get_bit(0)
            & (self.phase.q.val() == Phase::Field);
        self.strobe.next = self.grid.strobe.val() & !self.retimed.val();
        self.sampled.next = self.strobe.val() & (self.phase.q.val() == Phase::Field);
        // The check sum processes sent bits like received bits.
        self.wire_bit.next = self.level.val();
        if self.phase.q.val() == Phase::Send {
            self.wire_bit.next = self.bits.bit_out.val();
        }
        self.summed.next =
            self.wire_bit.val() ^ (self.check.q.val().get_bit(0) & !self.order.is_crc.val());
        self.differs.next = self.level.val() ^ self.bits.bit_out.val();
        self.take.next = self.sampled.val() & self.is_bit.val();
        self.in_field.next =
            (self.phase.q.val() == Phase::Send) | (self.phase.q.val() == Phase::Field);
        if self.strobe.val() & self.is_bit.val() & self.in_field.val() {
            self.check.d.next = bit_cast::<8, 7>(self.check.q.val().get_bits::<7>(1))
                | (bit_cast::<8, 1>(self.summed.val().into()) << 7);
        }
        // Start and data bits are nine. An upset changes their number by an amount that three does not divide.
        if self.strobe.val() {
            self.index.d.next = self.index.q.val() + 1;
            self.bits_mod_3.d.next = self.bits_mod_3.q.val() + 1;
            if self.bits_mod_3.q.val().get_bit(1) {
                self.bits_mod_3.d.next = 0.into();
            }
            if !self.is_start.val() & !self.is_bit.val() {
                self.bits_mod_3.d.next = 0.into();
                if self.has_guards.val() & self.bits_mod_3.q.val().any() & self.in_field.val() {
                    self.upset.d.next = true;
                }
            }
        }
        if (self.phase.q.val() == Phase::Wait) | (self.phase.q.val() == Phase::Rest) {
            self.bits_mod_3.d.next = 0.into();
        }
    }

    /// Phases of an exchange.
    fn go_on(&mut self) {
        // An edge of the control field that is not a header.
        self.too_soon.next =
            self.order.is_control.val() & (self.is_start.val() | !self.index.q.val().any());
        self.publish.next = false;
        self.in_request.next =
            (self.phase.q.val() == Phase::Send) | (self.phase.q.val() == Phase::Release);
        match self.phase.q.val() {
            Phase::Rest => self.rest(),
            Phase::Send => self.send(),
            Phase::Release => self.release(),
            Phase::Wait => self.wait(),
            Phase::Field => self.receive(),
            _ => self.end(),
        }
    }

    /// The line is idle.
    fn rest(&mut self) {
        self.line.d.next = true;
        if self.expired.val() {
            self.unsettled.d.next = false;
        }
        // The wait after a reset is longer.
        if !self.level.val()
            & (self.timer.q.val().get_bit(6) | !self.timer.q.val().get_bits::<2>(4).any())
        {
            self.timer.d.next = self.rest_us.val();
        }
        self.order.first.next = true;
        self.index.d.next = 15.into();
        self.refused.d.next = false;
        if self.has_guards.val() & self.owed.q.val() {
            // The result of an unknown or blocked request would never come.
            self.phase.d.next = Phase::Judge;
        } else {
            if self.trigger.val() {
                if !self.order.is_known.val() | !self.level.val() | self.unsettled.q.val() {
                    self.refused.d.next = true;
                    self.phase.d.next = Phase::Judge;
                } else {
                    self.drives.d.next = true;
                    self.owed.d.next = true;
                    self.in_request.next = true;
                    self.timer.d.next = self.request_us.val();
                    // Until the verdict finds the reply complete.
                    self.unsettled.d.next = true;
                    self.grid.restart.next = true;
                    self.phase.d.next = Phase::Send;
                }
            }
        }
    }

    /// Sends the fields of a request.
    fn send(&mut self) {
        if self.strobe.val() {
            self.line.d.next = self.bits.bit_out.val();
            if self.is_start.val() {
                self.line.d.next = false;
            } else {
                if !self.is_bit.val() {
                    self.line.d.next = true;
                    self.index.d.next = 15.into();
                    self.order.step.next = true;
                    if self.order.is_last.val() {
                        self.order.first.next = true;
                        self.phase.d.next = Phase::Release;
                    }
                }
            }
        }
    }

    /// The last bit of the request is on the line.
    fn release(&mut self) {
        if self.strobe.val() {
            self.in_request.next = false;
            self.timer.d.next = bit_cast::<7, 6>(self.reply_gap_us.val());
            self.phase.d.next = Phase::Wait;
        }
    }

    /// Waits for a start bit.
    fn wait(&mut self) {
        self.index.d.next = 15.into();
        if self.expired.val() {
            self.missed.d.next = true;
            self.phase.d.next = Phase::Judge;
        } else {
            if self.previous.q.val() & !self.level.val() {
                self.heard.d.next = true;
                self.grid.restart.next = true;
                self.phase.d.next = Phase::Field;
            }
        }
    }

    /// Receives a field of the reply.
    fn receive(&mut self) {
        if self.sampled.val() {
            if self.is_start.val() {
                // HIGH at its middle: no start bit.
                if self.level.val() {
                    self.phase.d.next = Phase::Wait;
                }
            } else {
                if self.is_bit.val() {
                    if self.in_sync.val() {
                        if self.differs.val() {
                            self.phase.d.next = Phase::Wait;
                            // A pulse shorter than a bit and a half is noise; a longer one corrupts the header.
                            if self.index.q.val().any() {
                                self.missed.d.next = true;
                                self.phase.d.next = Phase::Judge;
                            }
                        }
                    } else {
                        if self.order.is_control.val() {
                            self.bad_parity.d.next = self.bad_parity.q.val() ^ self.level.val();
                            if !self.index.q.val().get_bits::<3>(0).all() {
                                self.echo.d.next =
                                    bit_cast::<4, 3>(self.echo.q.val().get_bits::<3>(1))
                                        | (bit_cast::<4, 1>(self.level.val().into()) << 3);
                                self.bad_echo.d.next = self.bad_echo.q.val() | self.differs.val();
                            }
                        }
                    }
                    if self.order.is_address.val() {
                        if self.index.q.val().get_bits::<3>(0).all() {
                            self.memory_busy.d.next = self.level.val();
                        } else {
                            self.bad_echo.d.next = self.bad_echo.q.val() | self.differs.val();
                        }
                    }
                    if self.order.is_crc.val() {
                        self.bad_crc.d.next = self.bad_crc.q.val() | self.differs.val();
                    }
                } else {
                    self.phase.d.next = Phase::Wait;
                    self.timer.d.next = bit_cast::<7, 3>(self.field_gap_us.val());
                    self.order.step.next = true;
                    if !self.level.val() | self.order.is_last.val() {
                        self.bad_delimiter.d.next = !self.level.val();
                        self.order.step.next = false;
                        self.phase.d.next = Phase::Judge;
                    }
                }
            }
        }
        self.grid.restart.next = self.retimed.val();
        if self.rising.val() & self.too_soon.val() {
            self.phase.d.next = Phase::Wait;
        }
        // A pulse that no encoder sends.
        if self.turns.val() & self.run.q.val().any() & !self.too_soon.val() {
            self.bad_crc.d.next = true;
        }
        if self.has_guards.val()
            & self.sampled.val()
            & self.is_bit.val()
            & self.order.is_foreign.val()
        {
            self.upset.d.next = true;
        }
    }

    /// The verdict.
    fn end(&mut self) {
        self.publish.next = self.phase.q.val() == Phase::Judge;
        self.phase.d.next = Phase::Rest;
        self.overrun.d.next = false;
        if self.phase.q.val() == Phase::Judge {
            // After a request the line must be at rest before the next one; a rejected request does not change the line.
            if !self.refused.q.val() {
                self.timer.d.next = self.rest_us.val();
            }
            self.owed.d.next = self.hold.val();
            if self.hold.val() {
                self.overrun.d.next = self.overrun.q.val();
                self.index.d.next = self.index.q.val();
                self.phase.d.next = Phase::Judge;
            }
        }
        // After a complete reply the line is free, whatever the reply contains.
        if self.is_whole.val() {
            self.unsettled.d.next = false;
        }
    }

    /// Cuts a request that lasts too long, or differs from the requested one.
    fn guard_request(&mut self) {
        if self.has_guards.val()
            & self.in_request.val()
            & (self.phase.q.val() != Phase::Rest)
            & (self.expired.val() | !self.request_fits.val() | self.upset.q.val())
        {
            self.in_request.next = false;
            self.upset.d.next = true;
            self.phase.d.next = Phase::Judge;
        }
        self.enabled.d.next = self.in_request.val();
        if !self.in_request.val() {
            self.drives.d.next = false;
        }
        if self.trigger.val() & (self.phase.q.val() != Phase::Rest) {
            self.overrun.d.next = true;
        }
    }

    /// The verdict's flags.
    fn judge(&mut self) {
        self.is_unknown.next = self.refused.q.val() & !self.order.is_known.val();
        self.is_not_idle.next = self.refused.q.val() & self.order.is_known.val();
        self.is_silent.next =
            self.missed.q.val() & self.order.is_control.val() & !self.heard.q.val();
        self.is_headless.next =
            self.missed.q.val() & self.order.is_control.val() & self.heard.q.val();
        self.is_short.next = self.missed.q.val() & !self.order.is_control.val();
        // A verdict in the middle of a reply without a fault, or the reply to a request that has changed since, is an upset.
        self.is_ended.next = self.refused.q.val()
            | self.missed.q.val()
            | self.bad_delimiter.q.val()
            | self.bad_echo.q.val()
            | (self.order.is_crc.val()
                & self.is_start.val()
                & !self.index.q.val().get_bit(1)
                & !self.index.q.val().get_bit(2)
                & (self.echo.q.val() == self.request_id.val()));
        self.is_astray.next = self.has_guards.val() & (self.upset.q.val() | !self.is_ended.val());
        // An alarm reported with an upset would hide the upset.
        self.alarms.next = self.status.val().get_bits::<2>(4);
        if self.is_astray.val() {
            self.alarms.next = 0.into();
        }
        self.raised.next = bit_cast::<16, 1>(self.is_unknown.val().into())
            | (bit_cast::<16, 1>(self.is_not_idle.val().into()) << 1)
            | (bit_cast::<16, 1>(self.is_silent.val().into()) << 2)
            | (bit_cast::<16, 1>(self.is_headless.val().into()) << 3)
            | (bit_cast::<16, 1>(self.bad_parity.q.val().into()) << 4)
            | (bit_cast::<16, 1>(self.bad_echo.q.val().into()) << 5)
            | (bit_cast::<16, 1>(self.bad_delimiter.q.val().into()) << 6)
            | (bit_cast::<16, 1>(self.is_short.val().into()) << 7)
            | (bit_cast::<16, 1>(self.bad_crc.q.val().into()) << 8)
            | (bit_cast::<16, 2>(self.status.val().get_bits::<2>(6)) << 9)
            | (bit_cast::<16, 1>(self.memory_busy.q.val().into()) << 11)
            | (bit_cast::<16, 2>(self.alarms.val()) << 12)
            | (bit_cast::<16, 1>(self.is_astray.val().into()) << 14)
            | (bit_cast::<16, 1>(self.overrun.q.val().into()) << 15);
        self.is_whole.next = !self.raised.val().get_bits::<9>(0).any() & !self.is_astray.val();
        self.is_good.next = self.is_whole.val() & !self.raised.val().get_bits::<3>(9).any();
    }

    /// Outputs of the verdict.
    fn report(&mut self) {
        self.flags.next = self.raised.val();
        self.good.next = self.is_good.val();
        self.reply_id.next = self.echo.q.val();
        self.crc.next = self.check.q.val();
        self.tx.next = self.line.q.val();
        self.driver.next = self.drives.q.val() & (self.enabled.q.val() | !self.has_guards.val());
        self.busy.next = self.phase.q.val() != Phase::Rest;
        connect!(self.field <= self.order; is_status, is_single, is_multi, is_alarm);
        self.field.is_byte.next = self.order.is_identity.val() | self.order.is_data.val();
        ReplyPartsOut::link(&mut self.parts, &mut self.order.parts);
    }
}
