//! Kernel of the receiver.

use super::*;
use rtl_design::kernel;

#[kernel]
impl Logic for Receiver {
    fn update(&mut self) {
        clock!(self, clock, check);
        self.check.reset.next = self.reset.val();
        self.choose_width();
        self.begin_cycle();
        self.count_cells();
        self.go_on();
        self.shift();
        self.align();
        self.check_crc();
        self.end_answer();
        self.begin_block();
        self.begin_frame();
        self.tell_progress();
        self.tell();
    }

    /// Width of this part of the answer, and the cells after its CRC.
    fn choose_width(&mut self) {
        // Cells after this CRC: the edge that ends the frame, 30 for each block of additional data.
        self.cells_after.next = 1.into();
        self.width.next = self.payload_bits.val();
        if self.has_all.val() {
            if self.infos_left.q.val() == 1 {
                self.cells_after.next = 31.into();
            }
            if self.infos_left.q.val() == 2 {
                self.cells_after.next = 61.into();
            }
            // The clock parks before that edge.
            if self.shape.has_supplement.val() {
                self.cells_after.next = 0.into();
                if self.infos_left.q.val() == 1 {
                    self.cells_after.next = 30.into();
                }
                if self.infos_left.q.val() == 2 {
                    self.cells_after.next = 60.into();
                }
            }
            if self.in_info.q.val() {
                self.width.next = self.info_bits.val();
            }
        }
    }

    /// Defaults of a cycle.
    fn begin_cycle(&mut self) {
        self.skip_step.next = self.cells.sample.val();
        if self.control.acquire.val() {
            self.skip_step.next = self.rise.val();
        }
        // Samples are at least two cycles apart: the state has been registered by then.
        self.start_sample.next =
            self.is_hunting.q.val() & self.cells.sample.val() & self.level.val();
        self.covered_bit.next = false;
        self.crc_bit.next = false;
        self.last_payload.d.next = false;
        self.take_crc.d.next = self.last_payload.q.val();
        self.last_taken.d.next = false;
        self.separator.next = false;
        self.missing.d.next = false;
        self.supplement_over.d.next = false;
        self.low_gap.d.next = false;
        self.high_gap.d.next = false;
        self.good_gap.d.next = false;
        self.again.next = false;
    }

    /// Counts cells and pulses.
    fn count_cells(&mut self) {
        // With few system clock cycles in a bit, cells continue until the end has been detected.
        self.counts.next = self.cells.sample.val()
            & ((self.field.q.val() != Field::Done) | self.left.q.val().get_bits::<6>(1).any());
        if self.counts.val()
            & (self.field.q.val() != Field::Skip)
            & (self.field.q.val() != Field::Start)
        {
            self.left.d.next = self.left.q.val() - 1;
        }
        // Each cell has its pulse. The number of cells before the start bit is unknown: each of them adds a pulse.
        self.one_more.next = self.cells.sample.val() & (self.field.q.val() == Field::Start);
        self.one_less.next = self.cells.pulse.val()
            | (self.control.acquire.val() & self.rise.val() & (self.field.q.val() == Field::Skip));
        if self.one_more.val() & !self.one_less.val() {
            self.to_send.d.next = self.to_send.q.val() + 1;
        }
        if self.one_less.val() & !self.one_more.val() {
            self.to_send.d.next = self.to_send.q.val() - 1;
        }
        // A third count, modulo 8, of the pulses that are on the cable.
        if self.has_guards.val() & self.cells.pulse.val() & !self.counts.val() {
            self.under_way.d.next = self.under_way.q.val() + 1;
        }
        if self.has_guards.val() & self.counts.val() & !self.cells.pulse.val() {
            self.under_way.d.next = self.under_way.q.val() - 1;
        }
    }

    /// Steps through the parts of an answer.
    fn go_on(&mut self) {
        // Compared in the previous cycle: a count is stable for at least two cycles.
        self.payload_ends.d.next = self.left.q.val() == (self.cells_after.val() + 6);
        self.crc_ends.d.next = self.left.q.val() == (self.cells_after.val() + 1);
        match self.field.q.val() {
            Field::Skip => {
                if self.skip_step.val() {
                    self.left.d.next = self.left.q.val() - 1;
                    if self.covered.q.val() == 14 {
                        self.skip_rounds.d.next = self.skip_rounds.q.val() - 1;
                        if !self.skip_rounds.q.val().any() | !self.has_all.val() {
                            self.field.d.next = Field::Start;
                        }
                    }
                }
            }
            Field::Start => {}
            Field::F1 => {
                if self.cells.sample.val() {
                    self.covered_bit.next = true;
                    self.f1_bit.d.next = self.level.val();
                    self.field.d.next = Field::Payload;
                    if self.shape.has_f2.val() {
                        self.field.d.next = Field::F2;
                    }
                }
            }
            Field::F2 => {
                if self.cells.sample.val() {
                    self.covered_bit.next = true;
                    self.f2_bit.d.next = self.level.val();
                    self.field.d.next = Field::Payload;
                }
            }
            Field::Payload => {
                if self.cells.sample.val() {
                    self.covered_bit.next = true;
                    // This bit, five of the CRC, and the cells after it.
                    if self.payload_ends.q.val() {
                        self.last_payload.d.next = true;
                        self.field.d.next = Field::Crc;
                    }
                }
            }
            Field::Crc => {
                if self.cells.sample.val() {
                    self.crc_bit.next = true;
                    if self.crc_ends.q.val() {
                        self.last_taken.d.next = true;
                        self.field.d.next = Field::Done;
                        if self.infos_left.q.val().any() & self.has_all.val() {
                            self.field.d.next = Field::Separator;
                        }
                        if self.control.going_on.val() & self.has_continuous.val() {
                            self.field.d.next = Field::GapHigh;
                        }
                    }
                }
            }
            Field::Separator => {
                if self.look.val() & self.level.val() & self.has_all.val() {
                    self.missing.d.next = true;
                    self.field.d.next = Field::Done;
                }
                if self.cells.sample.val() {
                    self.separator.next = true;
                    self.infos_left.d.next = self.infos_left.q.val() - 1;
                    self.field.d.next = Field::Payload;
                    if self.level.val() | !self.has_all.val() {
                        self.missing.d.next = true;
                        self.field.d.next = Field::Done;
                    }
                }
            }
            Field::GapHigh => {
                if self.cells.sample.val() {
                    self.low_gap.d.next = !self.level.val();
                    self.good_gap.d.next = self.level.val();
                    self.field.d.next = Field::GapLow;
                }
                if !self.has_continuous.val() {
                    self.field.d.next = Field::Done;
                }
            }
            Field::GapLow => {
                if self.cells.sample.val() {
                    self.high_gap.d.next = self.level.val();
                    self.again.next = true;
                    self.field.d.next = Field::Start;
                }
                if !self.has_continuous.val() {
                    self.field.d.next = Field::Done;
                }
            }
            Field::Done => {}
            Field::Supplement => {
                if self.cells.sample.val() & (self.left.q.val() == 2) {
                    self.supplement_over.d.next = true;
                    self.field.d.next = Field::Done;
                }
                if !self.has_all.val() {
                    self.field.d.next = Field::Done;
                }
            }
            _ => {
                self.field.d.next = Field::Done;
            }
        }
        // Outside the match arm: the edge of the start bit arrives last in the cycle.
        if self.start_sample.val() & self.cells.edge_in_window.val() {
            self.field.d.next = Field::F1;
            if !self.shape.has_f1.val() & self.has_all.val() {
                self.field.d.next = Field::Payload;
            }
        }
    }

    /// Entry of a bit: the smallest of 5, 20, 35 and 50 bits that holds F1, F2 and the position.
    fn shift(&mut self) {
        self.in5.next = self.width.val() <= 3;
        self.in20.next = (self.width.val() <= 18) & !self.in5.val();
        self.in35.next = (self.width.val() <= 33) & !self.in5.val() & !self.in20.val();
        self.in50.next = !self.in5.val() & !self.in20.val() & !self.in35.val();
        self.bit_in.next = self.bit_held.q.val() & !self.align.q.val();
        // One cycle after the sample: this enable drives the whole word.
        self.shifting.d.next = self.covered_bit.val();
        self.bit_held.d.next = self.level.val();
        self.shift.next = self.shifting.q.val() | self.align.q.val();
        self.shifted.next = self.word.q.val() >> 1;
        if self.in50.val() {
            self.shifted.next = (self.word.q.val() >> 1).replace_bit(49, self.bit_in.val());
        }
        if self.in35.val() {
            self.shifted.next = (self.word.q.val() >> 1).replace_bit(34, self.bit_in.val());
        }
        if self.in20.val() {
            self.shifted.next = (self.word.q.val() >> 1).replace_bit(19, self.bit_in.val());
        }
        if self.in5.val() {
            self.shifted.next = (self.word.q.val() >> 1).replace_bit(4, self.bit_in.val());
        }
        self.covered_next.next = self.covered.q.val() + 1;
        if self.covered.q.val() == 14 {
            self.covered_next.next = 0.into();
        }
        if self.shift.val() {
            self.word.d.next = self.shifted.val();
        }
        // The published word is no longer needed here.
        if self.swaps.val() & self.put.val() {
            self.word.d.next = bit_cast::<50, 48>(self.put_word.val());
        }
        if self.shift.val() | ((self.field.q.val() == Field::Skip) & self.skip_step.val()) {
            self.covered.d.next = self.covered_next.val();
        }
    }

    /// The word is aligned when 5, 5 + 1 or 5 + 2 bits (modulo 15) have entered; never after the first shift.
    fn align(&mut self) {
        self.align_first.d.next = self.take_crc.q.val();
        self.aligned_at.next = 5.into();
        if self.shape.has_f2.val() {
            self.aligned_at.next = 6.into();
        }
        if self.has_all.val() & (!self.shape.has_f1.val() | self.in_info.q.val()) {
            self.aligned_at.next = 4.into();
        }
        self.crc.word.next = self.word.q.val();
        self.crc.covered.next = self.covered.q.val();
        if self.take_crc.q.val() {
            self.crc_calc.d.next = self.crc.crc.val();
            self.align.d.next = true;
        }
        if self.align.q.val()
            & !self.align_first.q.val()
            & (self.covered.q.val() == self.aligned_at.val())
        {
            self.align.d.next = false;
        }
    }

    /// The received CRC, and the guard's check of the stored word.
    fn check_crc(&mut self) {
        if self.crc_bit.val() {
            self.crc_bits.d.next = (self.crc_bits.q.val() << 1).replace_bit(0, self.level.val());
        }
        if self.swaps.val() & self.put.val() {
            self.crc_bits.d.next = self.put_crc.val();
        }
        self.check.clear.next = self.control.start.val()
            | (self.new_block.q.val() & self.has_all.val())
            | (self.again.val() & self.has_continuous.val());
        self.check.word_bit.next = self.cells.sample.val() & (self.field.q.val() == Field::Payload);
        connect!(self.check <= self; crc_bit, bit = level);
        self.check.has_f2.next = self.shape.has_f2.val();
        self.check.word.next = self.word.q.val().get_bits::<48>(0);
        self.check.has_f1.next =
            !self.has_all.val() | (self.shape.has_f1.val() & !self.in_info.q.val());
        self.check.f1.next = self.f1_bit.q.val();
        self.check.f2.next = self.f2_bit.q.val();
    }

    /// The end of an answer or a block.
    fn end_answer(&mut self) {
        // With two or three system clock cycles in a bit the word is not aligned yet.
        self.not_aligned.next = self.align.q.val() & self.has_double.val();
        self.is_taken.next = self.last_taken.q.val() | self.waiting.q.val();
        self.waiting.d.next = self.is_taken.val() & self.not_aligned.val();
        self.is_complete.d.next = self.is_taken.val() & !self.not_aligned.val();
        self.crc_fits.next = self.crc_bits.q.val() == self.crc_calc.q.val();
        self.crc_equal.d.next = self.crc_fits.val();
        self.stored_fits.d.next = self.check.is_ok.val() & self.has_guards.val();
    }

    /// Begins a block with no bits. The position stays until it is published; the block's first bit comes a cycle later.
    fn begin_block(&mut self) {
        self.low_separator.d.next = self.separator.val() & !self.level.val() & self.has_all.val();
        self.separator_then.d.next = self.low_separator.q.val();
        self.new_block.d.next = self.separator_then.q.val();
        if self.has_all.val() & self.new_block.q.val() {
            self.word.d.next = 0.into();
            self.covered.d.next = 0.into();
            self.align.d.next = false;
            self.in_info.d.next = true;
        }
    }

    /// Start values for a frame, the next answer of a running clock, and a supplement.
    fn begin_frame(&mut self) {
        // Cells of the frame, excluding payload and additional data.
        self.cells_around.next = self.fixed_cells.val();
        if self.shape.has_f2.val() {
            self.cells_around.next = self.fixed_cells.val() + 1;
        }
        if self.has_all.val() {
            if self.shape.has_supplement.val() {
                self.cells_around.next = self.fixed_cells.val();
            }
            if self.infos.val() == 1 {
                self.cells_around.next = self.fixed_cells.val() + 31;
                if self.shape.has_supplement.val() {
                    self.cells_around.next = self.fixed_cells.val() + 30;
                }
            }
            if self.infos.val() == 2 {
                self.cells_around.next = self.fixed_cells.val() + 61;
                if self.shape.has_supplement.val() {
                    self.cells_around.next = self.fixed_cells.val() + 60;
                }
            }
            if self.shape.has_parameter.val() {
                self.cells_around.next = self.fixed_cells.val() + 23;
            }
        }
        if self.control.start.val() {
            self.field.d.next = Field::Skip;
            self.left.d.next = bit_cast::<7, 6>(self.payload_bits.val()) + self.cells_around.val();
            self.to_send.d.next =
                bit_cast::<7, 6>(self.payload_bits.val()) + self.cells_around.val();
            self.word.d.next = 0.into();
            self.under_way.d.next = 0.into();
            // Skipped cells bring the counter to 0, the start value for the covered bits.
            self.covered.d.next = self.skip_from.val();
            self.skip_rounds.d.next = 0.into();
            self.f2_bit.d.next = true;
            self.align.d.next = false;
            self.in_info.d.next = false;
            self.infos_left.d.next = self.infos.val();
            if self.has_all.val() {
                self.f1_bit.d.next = false;
                if self.shape.has_parameter.val() {
                    self.covered.d.next = self.long_skip_from.val();
                    self.skip_rounds.d.next = 2.into();
                }
            }
        }
        // The next answer, without a command before it; clearing `in_info` here ends an upset of it.
        if self.again.val() & self.has_continuous.val() {
            self.left.d.next =
                bit_cast::<7, 6>(self.payload_bits.val()) + self.cells_from_start.val();
            self.word.d.next = 0.into();
            self.covered.d.next = 0.into();
            self.in_info.d.next = false;
        }
        // The first bits from the first HIGH on, until that HIGH has passed all places.
        if self.cells.sample.val()
            & (self.field.q.val() != Field::Skip)
            & !self.heard.q.val().get_bit(6)
        {
            self.heard.d.next = (self.heard.q.val() << 1).replace_bit(0, self.level.val());
        }
        // The line is LOW again after an echo; an open line stays HIGH.
        if self.heard.q.val() == (bit_cast::<7, 6>(self.command.val()) << 1) {
            self.echo.d.next = true;
        }
        if self.control.start.val() | self.again.val() {
            self.heard.d.next = 0.into();
            self.echo.d.next = false;
        }
        if self.control.aborts.val() {
            self.field.d.next = Field::Done;
        }
        if self.control.start_supplement.val() & self.has_all.val() {
            self.field.d.next = Field::Supplement;
            self.left.d.next = self.supplement_cells.val();
            self.to_send.d.next = self.supplement_cells.val();
            self.under_way.d.next = 0.into();
        }
    }

    /// Reports the progress of the answer.
    fn tell_progress(&mut self) {
        self.progress.skipping.next =
            (self.field.q.val() == Field::Skip) | (self.field.q.val() == Field::Supplement);
        self.is_hunting.d.next = self.field.q.val() == Field::Start;
        self.progress.hunting.next = self.is_hunting.q.val();
        self.progress.start_found.next = self.start_sample.val() & self.cells.edge_in_window.val();
        self.refused.d.next = self.start_sample.val() & !self.cells.edge_in_window.val();
        self.progress.start_refused.next = self.refused.q.val();
        self.has_started.d.next =
            (self.field.q.val() != Field::Skip) & (self.field.q.val() != Field::Start);
        self.progress.started.next = self.has_started.q.val();
        self.progress.all_sent.next = !self.to_send.q.val().any();
        self.progress.one_to_send.next = self.to_send.q.val() == 1;
        self.progress.last_sent.next =
            (self.to_send.q.val() == 1) & self.one_less.val() & !self.one_more.val();
        self.progress.none_under_way.next = self.to_send.q.val() == self.left.q.val();
        // Evaluated at least a cycle after the last count: this keeps three comparisons out of the path of the cause.
        self.used.d.next = self.progress.all_sent.val()
            & (self.left.q.val() == 1)
            & ((self.under_way.q.val() == 1) | !self.has_guards.val());
        self.progress.all_used.next = self.used.q.val();
        self.ended.d.next = self.progress.all_sent.val()
            & self.progress.none_under_way.val()
            & !self.under_way.q.val().any();
        self.progress.all_ended.next = self.ended.q.val();
        self.progress.done.next = self.is_complete.q.val();
        self.progress.info_done.next = false;
        self.progress.separated.next = false;
        self.progress.info_missing.next = false;
        self.progress.last_bit.next = self.last_taken.q.val();
        self.progress.finished.next = self.is_complete.q.val();
        if self.has_all.val() {
            self.progress.done.next = self.is_complete.q.val() & !self.in_info.q.val();
            self.progress.info_done.next = self.is_complete.q.val() & self.in_info.q.val();
            self.progress.separated.next = self.low_separator.q.val();
            self.progress.info_missing.next = self.missing.q.val();
            self.progress.finished.next = (self.is_complete.q.val()
                & !self.infos_left.q.val().any())
                | self.supplement_over.q.val();
        }
        self.progress.gap_good.next = self.good_gap.q.val() & self.has_continuous.val();
        self.progress.gap_low.next = self.low_gap.q.val() & self.has_continuous.val();
        self.progress.gap_high.next = self.high_gap.q.val() & self.has_continuous.val();
        // No answer has been received from an encoder that is still sending the previous one.
        self.progress.latched.next =
            self.again.val() & !self.level.val() & self.has_continuous.val();
    }

    /// Outputs the received answer.
    fn tell(&mut self) {
        self.verdict.is_echo.next = self.echo.q.val() & self.has_diagnosis.val();
        self.payload.next = self.word.q.val().get_bits::<48>(0);
        self.verdict.f1.next = self.f1_bit.q.val();
        self.verdict.f2.next = self.f2_bit.q.val();
        self.crc_received.next = self.crc_bits.q.val();
        self.crc_computed.next = self.crc_calc.q.val();
        self.verdict.crc_ok.next = self.crc_equal.q.val();
        self.verdict.stored_ok.next = self.crc_equal.q.val();
        if self.has_guards.val() {
            self.verdict.stored_ok.next = self.stored_fits.q.val();
        }
    }
}
