//! Kernel of the encoder.

use super::*;
use rtl_design::kernel;

#[kernel]
impl Logic for Encoder {
    fn update(&mut self) {
        connect!(self.pins, self.crc <= self; clock, reset);
        self.pins.clock_pin.next = self.line.endat_clk.val();
        self.pins.data_pin.next = self.line.data_i.val();
        self.time_line();
        self.choose_settings();
        self.begin_frame();
        self.take_command();
        self.choose_bit();
        self.send_answer();
        self.recover();
        self.spoil_answer();
        self.lose_step();
        self.show();
    }

    /// Times tcal, tm, and how long CLOCK has kept its level.
    fn time_line(&mut self) {
        self.is_due.next = !self.timer.q.val().get_bits::<15>(1).any();
        if self.timer.q.val().any() {
            self.timer.d.next = self.timer.q.val() - 1;
        }
        if self.tick_us.val() {
            self.level_us.d.next = self.level_us.q.val() + 1;
        }
        if self.pins.rise.val() | self.pins.fall.val() | !self.plugged.val() {
            self.level_us.d.next = 0.into();
        }
        // An edge in the same cycle is stronger: it belongs to what CLOCK does next.
        self.is_high_long.next = self.pins.level_before.val()
            & !self.pins.fall.val()
            & (self.level_us.q.val() == self.high_limit_us.val());
        self.is_low_long.next = !self.pins.level_before.val()
            & !self.pins.rise.val()
            & (self.level_us.q.val() == self.low_limit_us.val());
    }

    /// Settings of the frame; with errors those of a wrong one.
    fn choose_settings(&mut self) {
        self.tcal.next = self.settings.tcal_cycles.val();
        self.tm.next = self.settings.tm_cycles.val();
        if self.has_f2.q.val() {
            self.tm.next = self.settings.tm_22_cycles.val();
        }
        self.bits.next = self.settings.position_bits.val();
        self.may_start.next = !self.left.q.val().any();
        self.inverts.next = 0.into();
        self.crc_wrong.next = 0.into();
        self.left_low.next = self.left.q.val().get_bits::<3>(0);
        for i in 0..self._errors {
            if self.errors[i].applies.val() {
                self.tcal.next = self.wanted.error_tcal_cycles.val();
            }
            if self.errors[i].active.val() {
                self.tm.next = self.wanted.error_tm_cycles.val();
                self.bits.next = self.settings.position_bits.val() ^ self.wanted.width_xor.val();
                self.inverts.next = (bit_cast::<2, 1>(self.wanted.invert_f2.val().into()) << 1)
                    | bit_cast::<2, 1>(self.wanted.invert_f1.val().into());
                self.crc_wrong.next = bit_cast::<8, 5>(self.wanted.crc_xor.val()) << 1;
                self.may_start.next = !self.wanted.no_start.val()
                    & (!self.left.q.val().any()
                        | (self.left.q.val() == bit_cast::<6, 2>(self.wanted.early_clocks.val())));
            }
        }
    }

    /// The first falling edge takes the position, and switches the driver off for the command.
    fn begin_frame(&mut self) {
        self.begins.next = (self.phase.q.val() == Phase::Idle) & self.pins.fall.val();
        self.is_last.next = self.pins.rise.val() & (self.left.q.val() == 1);
        if self.pins.rise.val() & self.left.q.val().any() {
            self.left.d.next = self.left.q.val() - 1;
        }
        if self.begins.val() {
            self.phase.d.next = Phase::Listen;
            self.word.d.next = self.position.val();
            self.timer.d.next = self.tcal.val();
            self.left.d.next = self.command_edges.val();
            self.has_f2.d.next = false;
            self.data_pin.d.next = false;
            self.oe_pin.d.next = false;
        }
    }

    /// The mode command: six bits up to its last rising edge.
    fn take_command(&mut self) {
        self.code_now.next = (bit_cast::<6, 5>(self.code.q.val()) << 1)
            | bit_cast::<6, 1>(self.pins.data.val().into());
        if self.pins.rise.val() {
            self.code.d.next = self.code_now.val().get_bits::<5>(0);
        }
        // With these the receiver drives DATA for longer, whether they have an answer or not.
        match self.code_now.val().index() {
            0b001110 => {
                self.is_parameter.next = true;
            }
            0b011100 => {
                self.is_parameter.next = true;
            }
            0b100011 => {
                self.is_parameter.next = true;
            }
            0b101010 => {
                self.is_parameter.next = true;
            }
            0b110001 => {
                self.is_parameter.next = true;
            }
            0b010010 => {
                self.is_parameter.next = true;
            }
            _ => {
                self.is_parameter.next = false;
            }
        }
        self.decodes.next = (self.phase.q.val() == Phase::Listen) & self.is_last.val();
        if self.decodes.val() {
            self.phase.d.next = Phase::Refuse;
            self.left.d.next = self.turnaround_edges.val();
            if self.is_parameter.val() {
                self.left.d.next = self.parameter_edges.val();
            }
            if self.code_now.val() == self.send_position.val() {
                self.phase.d.next = Phase::Wait;
            }
            if self.settings.endat22.val() & (self.code_now.val() == self.send_position_22.val()) {
                self.phase.d.next = Phase::Wait;
                self.has_f2.d.next = true;
            }
        }
        // One clock after the receiver has released DATA.
        if ((self.phase.q.val() == Phase::Wait) | (self.phase.q.val() == Phase::Refuse))
            & self.pins.fall.val()
            & (self.left.q.val() == 1)
        {
            self.oe_pin.d.next = true;
        }
    }

    /// The level that the next rising edge launches.
    fn choose_bit(&mut self) {
        self.is_covered.next = false;
        match self.phase.q.val() {
            Phase::F1 => {
                self.level.next = self.f1.q.val();
                self.is_covered.next = true;
            }
            Phase::F2 => {
                self.level.next = self.f2.q.val();
                self.is_covered.next = true;
            }
            Phase::Position => {
                self.level.next = self.word.q.val().get_bit(0);
                self.is_covered.next = true;
            }
            Phase::Crc => {
                self.level.next = self.crc.crc_bit.val()
                    ^ self.crc_wrong.val().get_bit(self.left_low.val().index());
            }
            _ => {
                // The start bit, and the end of the answer.
                self.level.next = true;
            }
        }
        self.starts.next = (self.phase.q.val() == Phase::Wait)
            & self.pins.rise.val()
            & self.may_start.val()
            & self.is_due.val();
        self.crc.clear.next = self.starts.val();
        self.crc.covers.next = self.pins.rise.val() & self.is_covered.val();
        self.crc.bit.next = self.level.val();
        self.crc.shift.next = self.pins.rise.val() & (self.phase.q.val() == Phase::Crc);
    }

    /// The answer, one bit with each rising edge.
    fn send_answer(&mut self) {
        self.ends.next = (self.phase.q.val() == Phase::Tail) & self.pins.rise.val();
        if self.starts.val() {
            self.phase.d.next = Phase::F1;
            self.f1.d.next = self.alarm_1.val() ^ self.inverts.val().get_bit(0);
            self.f2.d.next = !self.alarm_2.val() ^ self.inverts.val().get_bit(1);
            self.data_pin.d.next = self.level.val();
        }
        if self.pins.rise.val() {
            match self.phase.q.val() {
                Phase::F1 => {
                    self.data_pin.d.next = self.level.val();
                    self.left.d.next = self.bits.val();
                    self.phase.d.next = Phase::Position;
                    if self.has_f2.q.val() {
                        self.phase.d.next = Phase::F2;
                    }
                }
                Phase::F2 => {
                    self.data_pin.d.next = self.level.val();
                    self.left.d.next = self.bits.val();
                    self.phase.d.next = Phase::Position;
                }
                Phase::Position => {
                    self.data_pin.d.next = self.level.val();
                    self.word.d.next = self.word.q.val() >> 1;
                    if self.is_last.val() {
                        self.left.d.next = self.crc_bits.val();
                        self.phase.d.next = Phase::Crc;
                    }
                }
                Phase::Crc => {
                    self.data_pin.d.next = self.level.val();
                    if self.is_last.val() {
                        self.phase.d.next = Phase::Tail;
                    }
                }
                Phase::Tail => {
                    self.data_pin.d.next = self.level.val();
                    self.phase.d.next = Phase::Recovery;
                }
                _ => {}
            }
        }
    }

    /// The recovery time.
    fn recover(&mut self) {
        if self.ends.val() {
            self.timer.d.next = bit_cast::<16, 13>(self.tm.val());
        }
        if self.phase.q.val() == Phase::Recovery {
            if self.is_due.val() {
                self.phase.d.next = Phase::Idle;
                self.data_pin.d.next = false;
            }
            // A clock that goes on, or a frame that comes too early: the receiver may drive DATA.
            if self.pins.fall.val() {
                self.phase.d.next = Phase::Deaf;
                self.oe_pin.d.next = false;
            }
        }
    }

    /// Errors on command change what is launched.
    fn spoil_answer(&mut self) {
        self.launches.next = self.starts.val()
            | (self.pins.rise.val()
                & (self.is_covered.val()
                    | (self.phase.q.val() == Phase::Crc)
                    | (self.phase.q.val() == Phase::Tail)));
        for i in 0..self._errors {
            connect!(self.errors[i] <= self; clock, reset, begins, launches, level);
            EncoderErrorsIn::link(&mut self.wanted, &mut self.errors[i].wanted);
            if self.launches.val() {
                self.data_pin.d.next = self.errors[i].wrong_level.val();
                self.oe_pin.d.next = self.errors[i].drives.val();
            }
        }
        // The driver may have been off.
        if (self.phase.q.val() == Phase::Recovery)
            & self.is_due.val()
            & !self.pins.fall.val()
            & self.has_errors.val()
        {
            self.oe_pin.d.next = true;
        }
    }

    /// A frame that is not completed, and a plug that is pulled.
    fn lose_step(&mut self) {
        if self.is_high_long.val()
            & (self.phase.q.val() != Phase::Idle)
            & (self.phase.q.val() != Phase::Recovery)
        {
            self.phase.d.next = Phase::Idle;
            self.data_pin.d.next = false;
            self.oe_pin.d.next = true;
        }
        if self.is_low_long.val() | !self.plugged.val() {
            self.phase.d.next = Phase::Deaf;
            self.oe_pin.d.next = false;
        }
    }

    fn show(&mut self) {
        self.line.data_o.next = self.data_pin.q.val();
        self.line.data_oe.next = self.oe_pin.q.val();
        self.latch.next = self.begins.val();
        self.command_strobe.next = self.decodes.val();
        self.command.next = self.code_now.val();
        self.answered.next = self.ends.val();
        self.busy.next = self.phase.q.val() != Phase::Idle;
    }
}
