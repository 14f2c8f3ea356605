//! Kernel of the sequencer.

use super::*;
use rtl_design::kernel;

#[kernel]
impl Logic for Sequencer {
    fn update(&mut self) {
        clock!(self, clock, program, low, high);
        self.is_execute.next = self.cycle.q.val() == Cycle::Execute;
        self.cycle.reset.next = self.reset.val() | self.restart.val();
        self.goes_astray.next = self.is_astray.q.val() & self.is_execute.val();
        self.counter.reset.next = self.reset.val()
            | self.restart.val()
            | (self.goes_astray.val() & !self.is_shared.val());
        self.other_counter.reset.next =
            self.reset.val() | self.restart.val() | self.goes_astray.val();
        self.word.reset.next = self.reset.val() | self.host_clear.val();
        self.fetch();
        self.decode();
        self.choose_way();
        self.prepare();
        self.execute();
        self.read_memory();
        self.write_memory();
    }

    /// First cycle: the instruction.
    fn fetch(&mut self) {
        self.cycle.d.next = Cycle::Fetch;
        if (self.cycle.q.val() == Cycle::Fetch) | (self.is_execute.val() & self.is_shared.val()) {
            self.cycle.d.next = Cycle::Operand;
        }
        if self.cycle.q.val() == Cycle::Operand {
            self.cycle.d.next = Cycle::Execute;
        }
        // The counter moves only at the end of the third cycle, so the word is stable throughout the second and third.
        self.program.read_address.next = self.counter.q.val();
        if self.is_execute.val() & self.is_shared.val() {
            self.program.read_address.next = self.other_counter.q.val();
        }
        self.op.next = self.program.read_data.val().get_bits::<4>(16);
        self.choice.next = self.program.read_data.val().get_bits::<2>(16);
        self.special.next = self.program.read_data.val().get_bits::<4>(0);
        self.immediate.next = self.program.read_data.val().get_bits::<16>(0);
        self.port_address.next = self.program.read_data.val().get_bits::<5>(0);
        self.port_second.next = self.is_second.q.val();
    }

    /// Second cycle: computes the inputs of the third.
    fn decode(&mut self) {
        self.offset.next = 0.into();
        if self.immediate.val().get_bit(8) {
            self.offset.next = self.index.q.val();
        }
        self.operand_address.next =
            self.program.read_data.val().get_bits::<8>(0) + self.offset.val();
        self.address.d.next = self.operand_address.val();
        // Two bits distinguish these four among the instructions that use `value`.
        match self.choice.val().index() {
            1 => self.logic.next = self.accumulator.q.val() & self.immediate.val(),
            2 => self.logic.next = self.accumulator.q.val() ^ self.immediate.val(),
            3 => self.logic.next = bit_cast::<16, 11>(self.link.q.val()),
            _ => self.logic.next = self.immediate.val(),
        }
        self.value.d.next = self.logic.val();
        self.takes_memory.d.next = false;
        self.adds.next = false;
        self.inverts.d.next = false;
        self.carry_in.d.next = false;
        self.shifted_out.d.next = false;
        self.loads.next = false;
        self.takes_port.next = false;
        self.loads_carry.d.next = false;
        self.stores.d.next = false;
        self.writes_port.d.next = false;
        self.takes_carry.next = self.immediate.val().get_bit(9) & self.carry.q.val();
        match self.op.val().index() {
            0 => self.loads.next = true,
            1 => {
                self.loads.next = true;
                self.takes_memory.d.next = true;
            }
            2 => self.stores.d.next = true,
            3 => {
                self.loads.next = true;
                self.loads_carry.d.next = true;
                self.takes_memory.d.next = true;
                self.adds.next = true;
                self.carry_in.d.next = self.takes_carry.val();
            }
            4 => {
                self.loads.next = true;
                self.loads_carry.d.next = true;
                self.takes_memory.d.next = true;
                self.adds.next = true;
                self.inverts.d.next = true;
                self.carry_in.d.next = !self.takes_carry.val();
            }
            8 => {
                self.loads.next = true;
                self.loads_carry.d.next = true;
                self.adds.next = true;
            }
            9 => self.loads.next = true,
            10 => self.loads.next = true,
            11 => {
                self.loads.next = true;
                self.takes_port.next = true;
            }
            12 => self.writes_port.d.next = true,
            15 => {
                if self.special.val() == 2 {
                    self.loads.next = true;
                }
                if self.special.val() == 4 {
                    self.loads.next = true;
                    self.loads_carry.d.next = true;
                    self.shifted_out.d.next = self.accumulator.q.val().get_bit(0);
                }
                if self.special.val() == 5 {
                    self.loads.next = true;
                }
                if self.special.val().get_bit(2) {
                    self.value.d.next = self.accumulator.q.val() >> 1;
                    if self.special.val().get_bit(0) {
                        self.value.d.next = (self.accumulator.q.val() << 8)
                            | bit_cast::<16, 8>(self.accumulator.q.val().get_bits::<8>(8));
                    }
                }
            }
            _ => {}
        }
    }

    /// Selects the next address.
    fn choose_way(&mut self) {
        match self.program.read_data.val().get_bits::<3>(13).index() {
            0 => self.is_taken.next = true,
            1 => self.is_taken.next = self.is_zero.q.val(),
            2 => self.is_taken.next = !self.is_zero.q.val(),
            3 => self.is_taken.next = self.carry.q.val(),
            4 => self.is_taken.next = !self.carry.q.val(),
            5 => self.is_taken.next = self.accumulator.q.val().get_bit(15),
            _ => self.is_taken.next = false,
        }
        // 0 to the next word, 1 to the target, 2 to the link, 3 to A.
        self.way.d.next = 0.into();
        self.is_astray.d.next = false;
        match self.op.val().index() {
            5 => self.is_astray.d.next = true,
            6 => self.is_astray.d.next = true,
            7 => self.is_astray.d.next = true,
            13 => self.way.d.next = bit_cast::<2, 1>(self.is_taken.val().into()),
            14 => self.way.d.next = 1.into(),
            15 => match self.special.val().index() {
                0 => self.way.d.next = 2.into(),
                1 => {}
                2 => {}
                3 => self.way.d.next = 3.into(),
                4 => {}
                5 => {}
                _ => self.is_astray.d.next = true,
            },
            _ => {}
        }
        self.is_zero.d.next = !self.accumulator.q.val().any();
        if self.is_execute.val() & self.is_shared.val() {
            self.is_zero.d.next = !self.other_accumulator.q.val().any();
        }
    }

    /// Selects the operands of the sum.
    fn prepare(&mut self) {
        // An instruction that does not load A adds 0 to it. The reset input of the flip-flops makes this 0 without look-up tables.
        self.base.d.next = self.accumulator.q.val();
        self.base.reset.next = self.reset.val() | (self.loads.val() & !self.adds.val());
        self.value.reset.next = self.reset.val() | !self.loads.val() | self.takes_port.val();
        self.port_read.next = self.takes_port.val() & (self.cycle.q.val() == Cycle::Operand);
    }

    /// Third cycle: the sum, with an extra place for the carry below its lowest bit.
    fn execute(&mut self) {
        self.operand.next = self.value.q.val();
        if self.takes_memory.q.val() {
            self.operand.next = self.low.read_data.val();
            if self.address.q.val().get_bit(0) {
                self.operand.next = self.high.read_data.val();
            }
        }
        if self.inverts.q.val() {
            self.operand.next = !self.operand.val();
        }
        self.sum.next = ((bit_cast::<18, 16>(self.operand.val() | self.port_in.val()) << 1)
            | bit_cast::<18, 1>(self.carry_in.q.val().into()))
            + ((bit_cast::<18, 16>(self.base.q.val()) << 1) | 1);
        self.following.next = self.counter.q.val() + 1;
        self.next_carry.next = self.carry.q.val();
        if self.loads_carry.q.val() {
            self.next_carry.next =
                (self.sum.val().get_bit(17) ^ self.inverts.q.val()) | self.shifted_out.q.val();
        }
        match self.way.q.val().index() {
            1 => self.next_counter.next = self.program.read_data.val().get_bits::<11>(0),
            2 => self.next_counter.next = self.link.q.val(),
            3 => self.next_counter.next = self.accumulator.q.val().get_bits::<11>(0),
            _ => self.next_counter.next = self.following.val(),
        }
        self.next_link.next = self.link.q.val();
        if self.op.val() == 14 {
            self.next_link.next = self.following.val();
        }
        self.next_index.next = self.index.q.val();
        if (self.op.val() == 15) & (self.special.val() == 1) {
            self.next_index.next = self.accumulator.q.val().get_bits::<8>(0);
        }
        if self.is_execute.val() {
            self.other_counter.d.next = self.next_counter.val();
            self.other_link.d.next = self.next_link.val();
            self.other_accumulator.d.next = self.sum.val().get_bits::<16>(1);
            self.other_carry.d.next = self.next_carry.val();
            self.other_index.d.next = self.next_index.val();
            if self.is_shared.val() {
                self.is_second.d.next = !self.is_second.q.val();
                self.counter.d.next = self.other_counter.q.val();
                self.link.d.next = self.other_link.q.val();
                self.accumulator.d.next = self.other_accumulator.q.val();
                self.carry.d.next = self.other_carry.q.val();
                self.index.d.next = self.other_index.q.val();
            } else {
                self.counter.d.next = self.next_counter.val();
                self.link.d.next = self.next_link.val();
                self.accumulator.d.next = self.sum.val().get_bits::<16>(1);
                self.carry.d.next = self.next_carry.val();
                self.index.d.next = self.next_index.val();
            }
        }
        self.port_out.next = self.accumulator.q.val();
        self.port_write.next = self.is_execute.val() & self.writes_port.q.val();
    }

    /// Reads the RAM for the machine in its second cycle, otherwise for the host.
    fn read_memory(&mut self) {
        self.host_place.next = bit_cast::<8, 7>(self.host_address.val())
            | (bit_cast::<8, 1>(self.host_second.val().into()) << 7);
        self.read_word.next = self.host_place.val();
        self.is_for_host.d.next = true;
        if self.cycle.q.val() == Cycle::Operand {
            self.read_word.next = bit_cast::<8, 7>(self.operand_address.val().get_bits::<7>(1))
                | (bit_cast::<8, 1>(self.is_second.q.val().into()) << 7);
            self.is_for_host.d.next = false;
        }
        self.low.read_address.next = self.read_word.val();
        self.high.read_address.next = self.read_word.val();
        if self.read_pending.q.val() & self.is_for_host.q.val() {
            self.read_pending.d.next = false;
            self.word.d.next = (bit_cast::<32, 16>(self.high.read_data.val()) << 16)
                | bit_cast::<32, 16>(self.low.read_data.val());
        }
        if self.host_read.val() {
            self.read_pending.d.next = true;
        }
        self.host_word.next = self.word.q.val();
    }

    /// Writes the RAM for the machine in its third cycle, otherwise for the host.
    fn write_memory(&mut self) {
        self.write_word.next = self.host_place.val();
        self.write_half.next = self.host_half.val();
        self.written.next = self.host_data.val();
        self.is_written.next = self.write_pending.q.val();
        if self.is_execute.val() {
            self.write_word.next = bit_cast::<8, 7>(self.address.q.val().get_bits::<7>(1))
                | (bit_cast::<8, 1>(self.is_second.q.val().into()) << 7);
            self.write_half.next = self.address.q.val().get_bit(0);
            self.written.next = self.accumulator.q.val();
            self.is_written.next = self.stores.q.val();
        } else {
            self.write_pending.d.next = false;
        }
        if self.host_write.val() {
            self.write_pending.d.next = true;
        }
        self.low.write_address.next = self.write_word.val();
        self.high.write_address.next = self.write_word.val();
        self.low.write_data.next = self.written.val();
        self.high.write_data.next = self.written.val();
        self.low.write_enable.next = self.is_written.val() & !self.write_half.val();
        self.high.write_enable.next = self.is_written.val() & self.write_half.val();
    }
}
