//! Sequencer: a small 16-bit accumulator machine that runs a program from block RAM, once or twice, and shares its data with a host.
//!
//! ```text
//!            +------ counter <- next, target, link, A           port_in ---------------\
//!            v                                                  imm, A, link --> value --\
//!         program --- imm + X --> low, high (RAM) ----------------------------------> (+) -> A -> port_out
//!                                  ^         |                                        ^   |
//!  host_address, host_data --------+         +--> host_word                           A   +-> C
//!
//! cycle       |  Fetch  | Operand | Execute |  Fetch  | ...
//! program      counter-> word held
//! RAM, read      host     operand    host      host
//! RAM, write     host      host    ST only     host
//!
//! shared      |  Fetch  | Operand | Execute | Operand | Execute | Operand | ...
//! runs           first     first     first    second    second     first
//! program       first-> word held   second-> word held   first-> word held
//! ```
//!
//! **Each instruction takes three cycles.** The first reads the program memory, the second reads the operand, and all effects are complete at the
//! end of the third. The second cycle already computes everything that needs no operand from RAM (`value`). So the third is one
//! addition: A or 0 (`base`), plus the word from RAM or `value`.
//!
//! **Shared**, the program runs twice, with separate A, X, C, link, counter and RAM. The two runs alternate instruction by instruction, and the Execute of one
//! is the Fetch of the other: four cycles for an instruction. The active run is in the first set of registers, the waiting one in those named `other_`. At the
//! end of Execute they are exchanged, so no multiplexer is needed.
//!
//! **The host** reads and writes in cycles in which the machine does not use that side of the RAM, so neither waits for the other. RAM
//! is 128 words of 32 bits for the host, 256 of 16 bits for the machine: word 2n is the low half, word 2n + 1 the high half of word n.
//!
//! **Instructions** are `op` (bits 19..16) and `imm` (bits 15..0). An operand `m` is the RAM word at `imm[7:0]`, plus X if
//! `imm[8]` (wrapping); with `imm[9]` the carry C is included.
//!
//! | op | name | effect |
//! |---|---|---|
//! | 0 | LDI | A = imm |
//! | 1 | LD m | A = m |
//! | 2 | ST m | m = A |
//! | 3 | ADD m | A = A + m (+ C), C = carry |
//! | 4 | SUB m | A = A - m (- C), C = borrow |
//! | 8 | ADDI | A = A + imm, C = carry |
//! | 9 | ANDI | A = A and imm |
//! | 10 | XORI | A = A xor imm |
//! | 11 | IN | A = port `imm[4:0]` |
//! | 12 | OUT | port `imm[4:0]` = A |
//! | 13 | J | to `imm[9:0]` if `imm[15:13]` is 0 or: 1 and A = 0, 2 and A != 0, 3 and C, 4 and not C, 5 and `A[15]` |
//! | 14 | CALL | link = address of the next instruction, to `imm[9:0]` |
//! | 15 | `imm[3:0]` | 0 RET: to link; 1 TAX: X = `A[7:0]`; 2 LINK: A = link; 3 JMPA: to `A[9:0]`; 4 SHR: A = A / 2, C = `A[0]`; 5 SWAP: exchange the bytes of A |
//!
//! All other codes jump to 0 and do nothing else, so a program that runs astray restarts. Address 0 follows `0x7ff`.

pub mod assembler;
mod kernel;
#[cfg(test)]
mod model;
#[cfg(test)]
mod tests;

use rtl_design::memory::{Memory, Rom};
use rtl_design::reg::Reg;
use rtl_design::{Block, States};
use rust_hdl::prelude::*;

/// Words of a program.
pub const PROGRAM_WORDS: usize = 2048;
/// Words of RAM, as the machine counts them: 16 bits each.
pub const RAM_WORDS: usize = 256;
/// Ports in each direction.
pub const PORTS: usize = 32;
/// Cycles of an instruction.
pub const INSTRUCTION_CYCLES: u64 = 3;
/// Cycles from one instruction of a run to its next if two runs share the machine.
pub const SHARED_CYCLES: u64 = 4;

/// Cycle of an instruction.
#[derive(Copy, Clone, PartialEq, Debug, LogicState, States)]
pub enum Cycle {
    /// The program memory is read.
    Fetch,
    /// The instruction is available; its operand is read.
    Operand,
    /// Its effects are stored.
    Execute,
}

/// 16-bit accumulator machine with its program, and 128 words of 32 bits that it shares with a host.
#[derive(LogicBlock, Block)]
pub struct Sequencer {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset: clears A, X, C and link, and the programs begin at 0. RAM is not cleared.
    pub reset: Signal<In, Bit>,
    /// Strobe: both programs continue at 0 in the next cycle. An instruction in its third cycle is completed, an earlier one is
    /// dropped. A, X, C and link do not change.
    pub restart: Signal<In, Bit>,
    /// Port of an IN or OUT, throughout its second and third cycle.
    pub port_address: Signal<Out, Bits<5>>,
    /// High for one cycle, the second of an IN: the port at `port_address` is read.
    pub port_read: Signal<Out, Bit>,
    /// In the cycle after `port_read`: the value of the port; otherwise 0.
    pub port_in: Signal<In, Bits<16>>,
    /// The port belongs to the second program, in the same cycles as `port_address`; low if there is only one.
    pub port_second: Signal<Out, Bit>,
    /// A, the value that an OUT writes.
    pub port_out: Signal<Out, Bits<16>>,
    /// High for one cycle: `port_out` is for the port at `port_address`.
    pub port_write: Signal<Out, Bit>,
    /// 32-bit word that the host reads or writes; stable from one strobe to the next, at least 8 cycles.
    pub host_address: Signal<In, Bits<7>>,
    /// The word belongs to the second program. Stable like `host_address`.
    pub host_second: Signal<In, Bit>,
    /// Strobe: read the word into `host_word`.
    pub host_read: Signal<In, Bit>,
    /// Strobe: clear `host_word`; with `host_read`, until the word is available.
    pub host_clear: Signal<In, Bit>,
    /// A consistent copy of the word, taken after `host_read`; valid from the third cycle after that strobe at the latest, until
    /// the next strobe.
    pub host_word: Signal<Out, Bits<32>>,
    /// Strobe: write one half of the word.
    pub host_write: Signal<In, Bit>,
    /// Half to write: 1 = high. Stable like `host_address`.
    pub host_half: Signal<In, Bit>,
    /// Data to write. Stable like `host_address`.
    pub host_data: Signal<In, Bits<16>>,
    /// The program.
    program: Rom<20, 11>,
    /// Even words of RAM; the second program has the upper half.
    #[start]
    low: Memory<16, 8>,
    /// Odd words of RAM.
    #[start]
    high: Memory<16, 8>,
    /// Cycle of the instruction.
    #[start(Cycle::Fetch)]
    cycle: Reg<Cycle>,
    /// Address of the instruction.
    counter: Reg<Bits<11>>,
    /// Address for RET; set by CALL.
    link: Reg<Bits<11>>,
    /// A.
    accumulator: Reg<Bits<16>>,
    /// High if A is 0; one cycle late.
    is_zero: Reg<Bit>,
    /// C.
    carry: Reg<Bit>,
    /// X.
    index: Reg<Bits<8>>,
    /// The second program runs.
    is_second: Reg<Bit>,
    /// Address of the next instruction of the program that waits (shared only).
    other_counter: Reg<Bits<11>>,
    /// Link of the program that waits (shared only).
    other_link: Reg<Bits<11>>,
    /// A of the program that waits (shared only).
    other_accumulator: Reg<Bits<16>>,
    /// C of the program that waits (shared only).
    other_carry: Reg<Bit>,
    /// X of the program that waits (shared only).
    other_index: Reg<Bits<8>>,
    /// RAM word of the operand.
    address: Reg<Bits<8>>,
    /// Operand of the sum if it is not a word of RAM.
    value: Reg<Bits<16>>,
    /// Other operand of the sum: A or 0.
    base: Reg<Bits<16>>,
    /// High in the third cycle if the operand is the word of RAM.
    takes_memory: Reg<Bit>,
    /// High in the third cycle if the operand is inverted, for SUB.
    inverts: Reg<Bit>,
    /// Carry into the sum of the third cycle.
    carry_in: Reg<Bit>,
    /// Bit that SHR moves into C.
    shifted_out: Reg<Bit>,
    /// High in the third cycle if C changes.
    loads_carry: Reg<Bit>,
    /// High in the third cycle if A goes into RAM.
    stores: Reg<Bit>,
    /// High in the third cycle if A goes to a port.
    writes_port: Reg<Bit>,
    /// Next address: 0 the following one, 1 the target, 2 the link, 3 A.
    way: Reg<Bits<2>>,
    /// High in the third cycle if the word is not an instruction: the program jumps to 0.
    is_astray: Reg<Bit>,
    /// Set when the host reads; cleared when its word has been read.
    read_pending: Reg<Bit>,
    /// Set when the host writes; cleared when its half has been written.
    write_pending: Reg<Bit>,
    /// The RAM was read for the host in the last cycle.
    is_for_host: Reg<Bit>,
    /// Word read by the host.
    word: Reg<Bits<32>>,
    /// Operation of the instruction.
    op: Signal<Local, Bits<4>>,
    /// Lower two bits of the operation: selects `logic`.
    choice: Signal<Local, Bits<2>>,
    /// Lower four bits of the instruction: the kind of operation 15.
    special: Signal<Local, Bits<4>>,
    /// Lower 16 bits of the instruction.
    immediate: Signal<Local, Bits<16>>,
    /// High in the third cycle.
    is_execute: Signal<Local, Bit>,
    /// X if the operand is indexed, otherwise 0.
    offset: Signal<Local, Bits<8>>,
    /// RAM word of the operand.
    operand_address: Signal<Local, Bits<8>>,
    /// RAM word that the host accesses.
    host_place: Signal<Local, Bits<8>>,
    /// RAM word that is read.
    read_word: Signal<Local, Bits<8>>,
    /// RAM word that is written.
    write_word: Signal<Local, Bits<8>>,
    /// High if the upper half is written.
    write_half: Signal<Local, Bit>,
    /// High if a half is written.
    is_written: Signal<Local, Bit>,
    /// Value that is written.
    written: Signal<Local, Bits<16>>,
    /// Result of the instructions that read no word of RAM.
    logic: Signal<Local, Bits<16>>,
    /// High if the instruction uses C, and C is set.
    takes_carry: Signal<Local, Bit>,
    /// High if A changes.
    loads: Signal<Local, Bit>,
    /// High if A is loaded from a port.
    takes_port: Signal<Local, Bit>,
    /// High if the operand is added to A.
    adds: Signal<Local, Bit>,
    /// Operand of the sum.
    operand: Signal<Local, Bits<16>>,
    /// Sum of the third cycle; below its lowest bit is a place for the carry.
    sum: Signal<Local, Bits<18>>,
    /// Address of the following instruction.
    following: Signal<Local, Bits<11>>,
    /// High if the condition of a jump is true.
    is_taken: Signal<Local, Bit>,
    /// High at the end of a word that is not an instruction.
    goes_astray: Signal<Local, Bit>,
    /// Address of the next instruction of this program.
    next_counter: Signal<Local, Bits<11>>,
    /// Link after this instruction.
    next_link: Signal<Local, Bits<11>>,
    /// C after this instruction.
    next_carry: Signal<Local, Bit>,
    /// X after this instruction.
    next_index: Signal<Local, Bits<8>>,
    /// 1 if the program runs twice.
    is_shared: Constant<Bit>,
}

/// J 0: fills the memory after the end of a program.
const START_AGAIN: u64 = 13 << 16;

impl Sequencer {
    /// A machine that runs `program` from its first word, once, or twice if shared; see [`assembler`].
    ///
    /// # Panics
    /// If it has more than [`PROGRAM_WORDS`] words, or one has more than 20 bits.
    pub fn new(program: &[u32], is_shared: bool) -> Self {
        let mut words: Vec<u64> = program.iter().copied().map(u64::from).collect();
        words.resize(words.len().max(PROGRAM_WORDS), START_AGAIN);
        Self::from_parts(SequencerParts {
            program: Rom::new(&words),
            is_shared: Constant::new(is_shared),
        })
    }
}
