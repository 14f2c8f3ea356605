//! Receiver: takes the bits of a position frame from the start bit to the last CRC bit.
//!
//! ```text
//! field     Skip      Start     F1   F2   Position ............  Crc ........  Done
//! sample    /\ x10    /\        /\   /\   /\ /\ /\ ... /\        /\ /\ /\ /\ /\
//! align     __________________________________________/~~~~\____________________
//! ```
//!
//! The position arrives LSB first. It is shifted in at one of four places, 15 bits apart, so that the parallel CRC
//! sees it at the right distance from the end, and while the CRC bits arrive it is shifted down to bit 0 with at most 16
//! system clock cycles: no barrel shifter, and F1 and F2 drop off the end.
//!
//! `cells_left` counts down to the end of the frame. The clock generator stops when as many pulses are outstanding: so
//! the encoder sees exactly the rising edges it needs, and never more than the shortest answer while its start bit
//! may still be on the cable.

use crate::crc5::{Crc5Parallel, Crc5Serial, ORDER_OF_X};
use crate::protocol;
use crate::reg::Reg;
use rust_hdl::prelude::*;

/// What the next sample is.
#[derive(Copy, Clone, PartialEq, Debug, LogicState)]
pub enum Field {
    /// Cells before the earliest start bit: the line is undefined.
    Skip,
    /// Low, until the start bit.
    Start,
    /// Error bit 1.
    F1,
    /// Error bit 2 (EnDat 2.2 frames).
    F2,
    /// Position, LSB first.
    Position,
    /// CRC, MSB first.
    Crc,
    /// The frame is complete.
    Done,
}

/// Receiver of one channel.
#[derive(LogicBlock)]
pub struct Receiver {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe: a frame begins.
    pub start: Signal<In, Bit>,
    /// The frame measures the propagation delay: cells before the start bit are counted by clock edges.
    pub acquire: Signal<In, Bit>,
    /// Strobe of each rising clock edge.
    pub rise: Signal<In, Bit>,
    /// Strobe: sample `level`.
    pub sample: Signal<In, Bit>,
    /// The data line.
    pub level: Signal<In, Bit>,
    /// The start edge of this cell lies in its window.
    pub edge_in_window: Signal<In, Bit>,
    /// Position width, 1..=48 bits.
    pub position_bits: Signal<In, Bits<6>>,
    /// The frame carries F2.
    pub has_f2: Signal<In, Bit>,
    /// The line is undefined: samples are not looked at.
    pub skipping: Signal<Out, Bit>,
    /// The start bit may come now.
    pub hunting: Signal<Out, Bit>,
    /// Strobe with `sample`: this sample is a good start bit.
    pub start_found: Signal<Out, Bit>,
    /// Strobe one cycle after `sample`: it was high, but its edge is outside the window.
    pub start_refused: Signal<Out, Bit>,
    /// The start bit has been taken.
    pub started: Signal<Out, Bit>,
    /// Cells still to come, this one included.
    pub cells_left: Signal<Out, Bits<7>>,
    /// Strobe: position, error bits, CRC and verdict are valid.
    pub done: Signal<Out, Bit>,
    /// Position, bit 0 = LSB, zeros above its width.
    pub position: Signal<Out, Bits<48>>,
    /// Error bit 1, high = alarm.
    pub f1: Signal<Out, Bit>,
    /// Error bit 2, low = alarm; high in frames without it.
    pub f2: Signal<Out, Bit>,
    /// CRC as received; bit 4 came first.
    pub crc_received: Signal<Out, Bits<5>>,
    /// CRC computed in parallel from the stored word.
    pub crc_computed: Signal<Out, Bits<5>>,
    /// The serial register over the wire bits says the CRC is right.
    pub serial_ok: Signal<Out, Bit>,
    /// The CRC of the stored word equals the received one.
    pub parallel_ok: Signal<Out, Bit>,
    parallel: Crc5Parallel,
    serial: Crc5Serial,
    field: Reg<Field>,
    left: Reg<Bits<7>>,
    word: Reg<Bits<50>>,
    covered: Reg<Bits<4>>,
    f1_bit: Reg<Bit>,
    f2_bit: Reg<Bit>,
    crc_bits: Reg<Bits<5>>,
    crc_calc: Reg<Bits<5>>,
    take_crc: Reg<Bit>,
    align: Reg<Bit>,
    align_first: Reg<Bit>,
    last_taken: Reg<Bit>,
    done_now: Reg<Bit>,
    parallel_equal: Reg<Bit>,
    serial_good: Reg<Bit>,
    refused: Reg<Bit>,
    shift_now: Reg<Bit>,
    bit_now: Reg<Bit>,
    last_position: Reg<Bit>,
    hunting_now: Reg<Bit>,
    started_now: Reg<Bit>,
    skip_from: Constant<Bits<4>>,
    fixed_cells: Constant<Bits<7>>,
    skip_step: Signal<Local, Bit>,
    covered_bit: Signal<Local, Bit>,
    shift: Signal<Local, Bit>,
    bit_in: Signal<Local, Bit>,
    in50: Signal<Local, Bit>,
    in35: Signal<Local, Bit>,
    in20: Signal<Local, Bit>,
    in5: Signal<Local, Bit>,
    aligned_at: Signal<Local, Bits<4>>,
    covered_next: Signal<Local, Bits<4>>,
    crc_bit: Signal<Local, Bit>,
    start_sample: Signal<Local, Bit>,
    shifted: Signal<Local, Bits<50>>,
}

impl Default for Receiver {
    fn default() -> Self {
        Self {
            clock: Default::default(),
            reset: Default::default(),
            start: Default::default(),
            acquire: Default::default(),
            rise: Default::default(),
            sample: Default::default(),
            level: Default::default(),
            edge_in_window: Default::default(),
            position_bits: Default::default(),
            has_f2: Default::default(),
            skipping: Default::default(),
            hunting: Default::default(),
            start_found: Default::default(),
            start_refused: Default::default(),
            started: Default::default(),
            cells_left: Default::default(),
            done: Default::default(),
            position: Default::default(),
            f1: Default::default(),
            f2: Default::default(),
            crc_received: Default::default(),
            crc_computed: Default::default(),
            serial_ok: Default::default(),
            parallel_ok: Default::default(),
            parallel: Default::default(),
            serial: Default::default(),
            field: Reg::new(Field::Done),
            left: Default::default(),
            word: Default::default(),
            covered: Default::default(),
            f1_bit: Default::default(),
            f2_bit: Reg::new(true),
            crc_bits: Default::default(),
            crc_calc: Default::default(),
            take_crc: Default::default(),
            align: Default::default(),
            align_first: Default::default(),
            last_taken: Default::default(),
            done_now: Default::default(),
            parallel_equal: Default::default(),
            serial_good: Default::default(),
            refused: Default::default(),
            shift_now: Default::default(),
            bit_now: Default::default(),
            last_position: Default::default(),
            hunting_now: Default::default(),
            started_now: Default::default(),
            skip_from: Constant::new((ORDER_OF_X as u64 - u64::from(protocol::LEAD_PULSES)).into()),
            fixed_cells: Constant::new(
                u64::from(protocol::LEAD_PULSES + protocol::START_BITS + 1 + protocol::CRC_BITS)
                    .into(),
            ),
            skip_step: Default::default(),
            covered_bit: Default::default(),
            shift: Default::default(),
            bit_in: Default::default(),
            in50: Default::default(),
            in35: Default::default(),
            in20: Default::default(),
            in5: Default::default(),
            aligned_at: Default::default(),
            covered_next: Default::default(),
            crc_bit: Default::default(),
            start_sample: Default::default(),
            shifted: Default::default(),
        }
    }
}

impl Logic for Receiver {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, field, left, word, covered, f1_bit, f2_bit, crc_bits, crc_calc);
        dff_setup!(
            self,
            clock,
            take_crc,
            align,
            align_first,
            last_taken,
            done_now,
            parallel_equal,
            serial_good
        );
        clock!(self, clock, serial);
        self.field.reset.next = self.reset.val();
        self.left.reset.next = self.reset.val();
        self.word.reset.next = self.reset.val();
        self.covered.reset.next = self.reset.val();
        self.f1_bit.reset.next = self.reset.val();
        self.f2_bit.reset.next = self.reset.val();
        self.crc_bits.reset.next = self.reset.val();
        self.crc_calc.reset.next = self.reset.val();
        self.take_crc.reset.next = self.reset.val();
        self.align.reset.next = self.reset.val();
        self.align_first.reset.next = self.reset.val();
        self.last_taken.reset.next = self.reset.val();
        self.done_now.reset.next = self.reset.val();
        self.parallel_equal.reset.next = self.reset.val();
        self.serial_good.reset.next = self.reset.val();
        self.refused.reset.next = self.reset.val();
        self.hunting_now.reset.next = self.reset.val();
        self.started_now.reset.next = self.reset.val();
        self.shift_now.reset.next = self.reset.val();
        self.bit_now.reset.next = self.reset.val();
        self.last_position.reset.next = self.reset.val();
        clock!(
            self,
            clock,
            shift_now,
            bit_now,
            last_position,
            refused,
            hunting_now,
            started_now
        );
        self.serial.reset.next = self.reset.val();

        self.skip_step.next = self.sample.val();
        if self.acquire.val() {
            self.skip_step.next = self.rise.val();
        }
        self.start_sample.next =
            (self.field.q.val() == Field::Start) & self.sample.val() & self.level.val();
        self.covered_bit.next = false;
        self.crc_bit.next = false;
        self.last_position.d.next = false;
        self.take_crc.d.next = self.last_position.q.val();
        self.last_taken.d.next = false;

        if self.sample.val()
            & (self.field.q.val() != Field::Skip)
            & (self.field.q.val() != Field::Start)
        {
            self.left.d.next = self.left.q.val() - 1;
        }
        match self.field.q.val() {
            Field::Skip => {
                if self.skip_step.val() {
                    self.left.d.next = self.left.q.val() - 1;
                    if self.covered.q.val() == 14 {
                        self.field.d.next = Field::Start;
                    }
                }
            }
            Field::Start => {
                if self.start_sample.val() & self.edge_in_window.val() {
                    self.field.d.next = Field::F1;
                }
            }
            Field::F1 => {
                if self.sample.val() {
                    self.covered_bit.next = true;
                    self.f1_bit.d.next = self.level.val();
                    self.field.d.next = Field::Position;
                    if self.has_f2.val() {
                        self.field.d.next = Field::F2;
                    }
                }
            }
            Field::F2 => {
                if self.sample.val() {
                    self.covered_bit.next = true;
                    self.f2_bit.d.next = self.level.val();
                    self.field.d.next = Field::Position;
                }
            }
            Field::Position => {
                if self.sample.val() {
                    self.covered_bit.next = true;
                    // Seven cells left: this bit, five of the CRC and the edge that ends the frame.
                    if self.left.q.val() == 7 {
                        self.last_position.d.next = true;
                        self.field.d.next = Field::Crc;
                    }
                }
            }
            Field::Crc => {
                if self.sample.val() {
                    self.crc_bit.next = true;
                    if self.left.q.val() == 2 {
                        self.last_taken.d.next = true;
                        self.field.d.next = Field::Done;
                    }
                }
            }
            Field::Done => {}
            _ => {
                self.field.d.next = Field::Done;
            }
        }

        // Where a bit enters: the smallest of 5, 20, 35 and 50 bits that holds F1, F2 and the position.
        self.in5.next = self.position_bits.val() <= 3;
        self.in20.next = (self.position_bits.val() <= 18) & !self.in5.val();
        self.in35.next = (self.position_bits.val() <= 33) & !self.in5.val() & !self.in20.val();
        self.in50.next = !self.in5.val() & !self.in20.val() & !self.in35.val();
        self.bit_in.next = self.bit_now.q.val() & !self.align.q.val();
        // One cycle later than the sample: the whole word hangs on this enable.
        self.shift_now.d.next = self.covered_bit.val();
        self.bit_now.d.next = self.level.val();
        self.shift.next = self.shift_now.q.val() | self.align.q.val();
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
        if self.shift.val() | ((self.field.q.val() == Field::Skip) & self.skip_step.val()) {
            self.covered.d.next = self.covered_next.val();
        }
        // Aligned when 5 + 1 or 5 + 2 bits (modulo 15) have gone in; never after the first shift.
        self.align_first.d.next = self.take_crc.q.val();
        self.aligned_at.next = 5.into();
        if self.has_f2.val() {
            self.aligned_at.next = 6.into();
        }
        if self.take_crc.q.val() {
            self.crc_calc.d.next = self.parallel.crc.val();
            self.align.d.next = true;
        }
        if self.align.q.val()
            & !self.align_first.q.val()
            & (self.covered.q.val() == self.aligned_at.val())
        {
            self.align.d.next = false;
        }

        if self.crc_bit.val() {
            self.crc_bits.d.next = (self.crc_bits.q.val() << 1).replace_bit(0, self.level.val());
        }
        self.parallel.word.next = self.word.q.val();
        self.parallel.covered_mod_15.next = self.covered.q.val();
        self.serial.clear.next = self.start.val();
        self.serial.enable.next = self.covered_bit.val() | self.crc_bit.val();
        self.serial.bit.next = self.level.val();
        self.done_now.d.next = self.last_taken.q.val();
        self.parallel_equal.d.next = self.crc_bits.q.val() == self.crc_calc.q.val();
        self.serial_good.d.next = self.serial.residue_ok.val();

        if self.start.val() {
            self.field.d.next = Field::Skip;
            self.left.d.next = bit_cast::<7, 6>(self.position_bits.val()) + self.fixed_cells.val();
            if self.has_f2.val() {
                self.left.d.next =
                    bit_cast::<7, 6>(self.position_bits.val()) + self.fixed_cells.val() + 1;
            }
            self.word.d.next = 0.into();
            // Skipped cells take the counter to 0, where the covered bits start from.
            self.covered.d.next = self.skip_from.val();
            self.f2_bit.d.next = true;
            self.align.d.next = false;
        }

        self.skipping.next = self.field.q.val() == Field::Skip;
        self.hunting_now.d.next = self.field.q.val() == Field::Start;
        self.hunting.next = self.hunting_now.q.val();
        self.start_found.next = self.start_sample.val() & self.edge_in_window.val();
        self.refused.d.next = self.start_sample.val() & !self.edge_in_window.val();
        self.start_refused.next = self.refused.q.val();
        self.started_now.d.next =
            (self.field.q.val() != Field::Skip) & (self.field.q.val() != Field::Start);
        self.started.next = self.started_now.q.val();
        self.cells_left.next = self.left.q.val();
        self.done.next = self.done_now.q.val();
        self.position.next = self.word.q.val().get_bits::<48>(0);
        self.f1.next = self.f1_bit.q.val();
        self.f2.next = self.f2_bit.q.val();
        self.crc_received.next = self.crc_bits.q.val();
        self.crc_computed.next = self.crc_calc.q.val();
        self.serial_ok.next = self.serial_good.q.val();
        self.parallel_ok.next = self.parallel_equal.q.val();
    }
}
