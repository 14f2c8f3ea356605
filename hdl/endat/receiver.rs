//! Receiver: receives the bits of an answer from the start bit to the last CRC bit.
//!
//! ```text
//! field     Skip      Start     F1   F2   Payload  ............  Crc ........  Done
//! sample    /\ x10    /\        /\   /\   /\ /\ /\ ... /\        /\ /\ /\ /\ /\
//! align     __________________________________________/~~~~\____________________
//! ```
//!
//! <!-- with has_all -->
//! A block of additional data passes the same fields after the CRC: `Separator`, `Payload` of 24 bits, `Crc`. So does the answer to a
//! command with a parameter, without F1 and F2; words that arrive MSB first are reversed where they are read. During a supplement
//! the receiver only counts cells.
//!
//! <!-- end -->
//! The position arrives LSB first. It is shifted in at one of four places. While the CRC bits arrive it is shifted down to bit 0
//! in at most 16 system clock cycles. So no barrel shifter is needed, and F1 and F2 drop off the end. The parallel CRC5 covers the word before
//! that: at all four places its last bit has the same distance from a multiple of 15.
//! `left` counts cells down to the end of the frame, `to_send` the clock pulses that they need: the difference is under way. The
//! clock generator stops when no pulse is left to send. So the encoder receives exactly the rising edges it needs, and never more than the
//! shortest answer while its start bit may still be on the cable.
//! <!-- with has_guards -->
//!
//! `under_way` counts the difference once more: at the end of the frame all three agree, unless one was upset. A second parallel CRC5
//! checks the word in its register for as long as it is stored there, so the published bits are the checked bits.
//! <!-- end -->

pub mod field;
mod kernel;

use crate::endat::crc5::{Crc5Check, Crc5Word, ORDER_OF_X};
use crate::endat::features::Features;
use crate::endat::ports::{AnswerCheckOut, AnswerShapeIn, CellsIn, ControlIn, ProgressOut};
use crate::protocol;
use field::Field;
use rtl_design::reg::Reg;
use rtl_design::Block;
use rust_hdl::prelude::*;

/// Receiver of one channel.
#[derive(LogicBlock, Block)]
#[properties("../properties/receiver.sv")]
pub struct Receiver {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Control of a receiver during a frame.
    #[bundle]
    pub control: ControlIn,
    /// Strobe of each rising clock edge.
    pub rise: Signal<In, Bit>,
    /// Places of the answer's cells.
    #[bundle]
    pub cells: CellsIn,
    /// The data line.
    pub level: Signal<In, Bit>,
    /// Bits between error bits and CRC, 1..=48.
    pub payload_bits: Signal<In, Bits<6>>,
    /// Parts of an answer.
    #[bundle]
    pub shape: AnswerShapeIn,
    /// Blocks of additional data that follow the position, 0..=2.
    pub infos: Signal<In, Bits<2>>,
    /// Strobe: the recovery time is HIGH now, and may end in the middle of this cell.
    pub look: Signal<In, Bit>,
    /// Mode command that was sent.
    pub command: Signal<In, Bits<6>>,
    /// Strobe, between two frames: load the word and the CRC.
    pub put: Signal<In, Bit>,
    /// Word to load.
    pub put_word: Signal<In, Bits<48>>,
    /// CRC to load.
    pub put_crc: Signal<In, Bits<5>>,
    /// Progress of a receiver.
    #[bundle]
    pub progress: ProgressOut,
    /// Checks of an answer.
    #[bundle]
    pub verdict: AnswerCheckOut,
    /// Payload, bit 0 = the bit received first, zeros above its width.
    pub payload: Signal<Out, Bits<48>>,
    /// CRC as received; bit 4 came first.
    pub crc_received: Signal<Out, Bits<5>>,
    /// CRC computed from the bits as received.
    pub crc_computed: Signal<Out, Bits<5>>,
    #[start]
    crc: Crc5Word,
    #[start]
    check: Crc5Check,
    /// Part of the answer to which the next sample belongs.
    #[start(Field::Done)]
    field: Reg<Field>,
    /// Cells until the end of the frame; cells that wait for the start bit do not count.
    left: Reg<Bits<7>>,
    /// The current cell is the last one of the payload.
    payload_ends: Reg<Bit>,
    /// The current cell is the last one of the CRC.
    crc_ends: Reg<Bit>,
    /// Clock pulses that the frame still needs.
    to_send: Reg<Bits<7>>,
    /// Pulses on the cable, modulo 8: sent pulses whose cell has not ended (upset guards only).
    under_way: Reg<Bits<3>>,
    /// Bits of the answer as they arrive; the payload from bit 0 on when aligned.
    word: Reg<Bits<50>>,
    /// Cells that are skipped, then bits that are shifted in, modulo 15.
    covered: Reg<Bits<4>>,
    /// Error bit F1 of the answer.
    f1_bit: Reg<Bit>,
    /// Error bit F2 of the answer; high in frames without it.
    #[start(true)]
    f2_bit: Reg<Bit>,
    /// CRC as received; bit 4 came first.
    crc_bits: Reg<Bits<5>>,
    /// CRC of the bits as received; valid one cycle after `take_crc`.
    crc_calc: Reg<Bits<5>>,
    /// High for one cycle when the last bit of the payload is in the word: its CRC is stored.
    take_crc: Reg<Bit>,
    /// High while the word is shifted down to bit 0.
    align: Reg<Bit>,
    /// High in the first cycle of the alignment, which never ends it.
    align_first: Reg<Bit>,
    /// High for one cycle after the last bit of an answer or block has been sampled.
    last_taken: Reg<Bit>,
    /// High if the last bit has been sampled and the word is not aligned yet (double edge only).
    waiting: Reg<Bit>,
    /// High for one cycle: an answer or a block of additional data is complete.
    is_complete: Reg<Bit>,
    /// High if the counts of cells and pulses agree that this cell is the last one.
    used: Reg<Bit>,
    /// High if the counts of cells and pulses agree that no cell is left.
    ended: Reg<Bit>,
    /// High if the received CRC equals that of the bits as received.
    crc_equal: Reg<Bit>,
    /// High if the received CRC equals that of the stored word (upset guards only).
    stored_fits: Reg<Bit>,
    /// High for one cycle after a start bit whose edge is outside the window.
    refused: Reg<Bit>,
    /// High for one cycle after the sample of a covered bit: `bit_held` is shifted in.
    shifting: Reg<Bit>,
    /// `level` in the cycle before.
    bit_held: Reg<Bit>,
    /// High for one cycle after the last bit of the payload has been sampled.
    last_payload: Reg<Bit>,
    /// High while `field` is `Start`; one cycle late.
    is_hunting: Reg<Bit>,
    /// High while `field` is neither `Skip` nor `Start`; one cycle late.
    has_started: Reg<Bit>,
    /// Rounds of 15 cells that are skipped after the present one.
    skip_rounds: Reg<Bits<2>>,
    /// Blocks of additional data whose separator has not come yet.
    infos_left: Reg<Bits<2>>,
    /// Set when a block of additional data begins; cleared when a frame or the next answer begins.
    in_info: Reg<Bit>,
    /// High for one cycle: the line is HIGH where a block of additional data should begin.
    missing: Reg<Bit>,
    /// High for one cycle after the last cell of the supplement.
    supplement_over: Reg<Bit>,
    /// High for one cycle: the cell after the CRC is LOW while the clock continues.
    low_gap: Reg<Bit>,
    /// High for one cycle: the second cell after the CRC is HIGH while the clock continues.
    high_gap: Reg<Bit>,
    /// High for one cycle: the cell after the CRC is HIGH while the clock continues, as it should be.
    good_gap: Reg<Bit>,
    /// High for one cycle after a LOW separator: a block of additional data begins.
    low_separator: Reg<Bit>,
    /// `low_separator`, one cycle later.
    separator_then: Reg<Bit>,
    /// `low_separator`, two cycles later: the word is cleared for the block.
    new_block: Reg<Bit>,
    /// The first seven samples from the first HIGH on, or fewer at the start.
    heard: Reg<Bits<7>>,
    /// Set when `heard` is the mode command, then LOW; cleared when a frame or the next answer begins.
    echo: Reg<Bit>,
    /// The word keeps the previous position between two frames.
    swaps: Constant<Bit>,
    has_guards: Constant<Bit>,
    has_all: Constant<Bit>,
    has_diagnosis: Constant<Bit>,
    has_continuous: Constant<Bit>,
    has_double: Constant<Bit>,
    /// Start value of `covered`; it is 0 after the skipped cells.
    skip_from: Constant<Bits<4>>,
    /// Start value of `covered` if a parameter is sent.
    long_skip_from: Constant<Bits<4>>,
    /// Cells of a frame without F2, payload and additional data.
    fixed_cells: Constant<Bits<7>>,
    /// Cells of a supplement.
    supplement_cells: Constant<Bits<7>>,
    /// Payload of a block of additional data.
    info_bits: Constant<Bits<6>>,
    /// Cells of an answer that follows another one, without its payload.
    cells_from_start: Constant<Bits<7>>,
    /// High if the word is not aligned yet (double edge only).
    not_aligned: Signal<Local, Bit>,
    /// High if the last bit has been sampled.
    is_taken: Signal<Local, Bit>,
    /// High for one cycle: the next answer of a running clock begins.
    again: Signal<Local, Bit>,
    /// High when a cell is skipped: with each sample, or with each clock edge if the delay is measured.
    skip_step: Signal<Local, Bit>,
    /// High with the sample of a bit that the CRC covers.
    covered_bit: Signal<Local, Bit>,
    /// High if the received CRC equals that of the bits as received.
    crc_fits: Signal<Local, Bit>,
    /// High if the word is shifted by one bit.
    shift: Signal<Local, Bit>,
    /// Bit that enters the word: a sample, or 0 during the alignment.
    bit_in: Signal<Local, Bit>,
    /// High if a bit enters the word at bit 49.
    in50: Signal<Local, Bit>,
    /// High if a bit enters the word at bit 34.
    in35: Signal<Local, Bit>,
    /// High if a bit enters the word at bit 19.
    in20: Signal<Local, Bit>,
    /// High if a bit enters the word at bit 4.
    in5: Signal<Local, Bit>,
    /// Value of `covered` at which the word is aligned.
    aligned_at: Signal<Local, Bits<4>>,
    /// `covered` after one more cell or bit.
    covered_next: Signal<Local, Bits<4>>,
    /// High with the sample of a CRC bit.
    crc_bit: Signal<Local, Bit>,
    /// High with a HIGH sample where the start bit may come.
    start_sample: Signal<Local, Bit>,
    /// High with the sample in front of a block of additional data.
    separator: Signal<Local, Bit>,
    /// The word shifted by one bit.
    shifted: Signal<Local, Bits<50>>,
    /// High if a cell has passed without a start bit: the frame needs one more pulse.
    one_more: Signal<Local, Bit>,
    /// High if a pulse that the answer needs is sent.
    one_less: Signal<Local, Bit>,
    /// High with a sample that counts a cell.
    counts: Signal<Local, Bit>,
    /// Bits of the payload, or of the block under way.
    width: Signal<Local, Bits<6>>,
    /// Cells that follow the CRC of this answer or block.
    cells_after: Signal<Local, Bits<7>>,
    /// Cells of the frame, excluding its payload.
    cells_around: Signal<Local, Bits<7>>,
}

impl Receiver {
    /// A receiver with these features.
    pub fn new(features: Features) -> Self {
        let lead = u64::from(protocol::LEAD_PULSES);
        let order = ORDER_OF_X as u64;
        Self::from_parts(ReceiverParts {
            swaps: Constant::new(features.swaps()),
            has_guards: Constant::new(features.upset_guards),
            has_all: Constant::new(features.requests),
            has_diagnosis: Constant::new(features.diagnosis),
            has_continuous: Constant::new(features.continuous),
            has_double: Constant::new(features.double_edge),
            skip_from: Constant::new((order - lead).into()),
            // 34 cells are 4 plus two rounds of the counter.
            long_skip_from: Constant::new(
                (3 * order - lead - u64::from(protocol::PARAMETER_BITS)).into(),
            ),
            fixed_cells: Constant::new(
                (lead + u64::from(protocol::START_BITS + 1 + protocol::CRC_BITS)).into(),
            ),
            supplement_cells: Constant::new(u64::from(protocol::SUPPLEMENT_PULSES).into()),
            info_bits: Constant::new(u64::from(protocol::PARAMETER_BITS).into()),
            cells_from_start: Constant::new(
                u64::from(protocol::START_BITS + 1 + protocol::CRC_BITS).into(),
            ),
        })
    }
}
