//! The block before it is connected.

use super::{Cycle, Sequencer, PROGRAM_WORDS};
use crate::memory::Rom;
use crate::reg::Reg;
use rust_hdl::prelude::Constant;

/// J 0: what stands behind the end of a program.
const START_AGAIN: u64 = 13 << 16;

impl Sequencer {
    /// A machine that runs `program`, from its first word on, once or, if it is shared, twice; see [`super::assembler`].
    ///
    /// # Panics
    /// If it has more than [`PROGRAM_WORDS`] words, or one has more than 20 bits.
    pub fn new(program: &[u32], is_shared: bool) -> Self {
        let mut words: Vec<u64> = program.iter().copied().map(u64::from).collect();
        words.resize(words.len().max(PROGRAM_WORDS), START_AGAIN);
        Self {
            clock: Default::default(),
            reset: Default::default(),
            restart: Default::default(),
            port_address: Default::default(),
            port_read: Default::default(),
            port_in: Default::default(),
            port_second: Default::default(),
            port_out: Default::default(),
            port_write: Default::default(),
            host_address: Default::default(),
            host_second: Default::default(),
            host_read: Default::default(),
            host_clear: Default::default(),
            host_word: Default::default(),
            host_write: Default::default(),
            host_half: Default::default(),
            host_data: Default::default(),
            program: Rom::new(&words),
            low: Default::default(),
            high: Default::default(),
            cycle: Reg::new(Cycle::Fetch),
            counter: Default::default(),
            link: Default::default(),
            accumulator: Default::default(),
            is_zero: Default::default(),
            carry: Default::default(),
            index: Default::default(),
            is_second: Default::default(),
            other_counter: Default::default(),
            other_link: Default::default(),
            other_accumulator: Default::default(),
            other_carry: Default::default(),
            other_index: Default::default(),
            address: Default::default(),
            value: Default::default(),
            takes_memory: Default::default(),
            loads: Default::default(),
            takes_port: Default::default(),
            adds: Default::default(),
            inverts: Default::default(),
            carry_in: Default::default(),
            shifted_out: Default::default(),
            loads_carry: Default::default(),
            stores: Default::default(),
            writes_port: Default::default(),
            way: Default::default(),
            is_astray: Default::default(),
            read_pending: Default::default(),
            write_pending: Default::default(),
            is_for_host: Default::default(),
            word: Default::default(),
            op: Default::default(),
            choice: Default::default(),
            special: Default::default(),
            immediate: Default::default(),
            is_execute: Default::default(),
            offset: Default::default(),
            operand_address: Default::default(),
            host_place: Default::default(),
            read_word: Default::default(),
            write_word: Default::default(),
            write_half: Default::default(),
            is_written: Default::default(),
            written: Default::default(),
            logic: Default::default(),
            takes_carry: Default::default(),
            base: Default::default(),
            operand: Default::default(),
            sum: Default::default(),
            following: Default::default(),
            is_taken: Default::default(),
            goes_astray: Default::default(),
            next_counter: Default::default(),
            next_link: Default::default(),
            next_carry: Default::default(),
            next_index: Default::default(),
            is_shared: Constant::new(is_shared),
        }
    }
}
