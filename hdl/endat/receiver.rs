//! Receiver: takes the bits of an answer from the start bit to the last CRC bit.
//!
//! ```text
//! field     Skip      Start     F1   F2   Payload  ............  Crc ........  Done
//! sample    /\ x10    /\        /\   /\   /\ /\ /\ ... /\        /\ /\ /\ /\ /\
//! align     __________________________________________/~~~~\____________________
//! ```
//!
//! <!-- with has_all -->
//! A block of additional data goes the same way behind the CRC: `Separator`, `Payload` of 24 bits, `Crc`. So does the answer to a
//! command with a parameter, without F1 and F2; what comes MSB first there is turned round where it is read. During a supplement
//! cells are only counted.
//!
//! <!-- end -->
//! The position arrives LSB first. It is shifted in at one of four places, and while the CRC bits arrive it is shifted down to bit 0
//! with at most 16 system clock cycles: no barrel shifter, and F1 and F2 drop off the end. The parallel CRC5 is taken of the word before
//! that: at all four places its last bit has the same distance from a multiple of 15.
//! `left` counts cells down to the end of the frame, `to_send` the clock pulses that they need: the difference is under way. The
//! clock generator stops when none is to be sent: so the encoder sees exactly the rising edges it needs, and never more than the
//! shortest answer while its start bit may still be on the cable.
//! <!-- with has_guards -->
//!
//! `under_way` counts the difference once more: at the end of the frame all three agree, unless one was upset. And a second parallel CRC5
//! looks at the word where it is stored, for as long as it stands there: what is published is what was checked.
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
    /// What a receiver is told of the frame.
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
    /// What an answer consists of.
    #[bundle]
    pub shape: AnswerShapeIn,
    /// Blocks of additional data that follow the position, 0..=2.
    pub infos: Signal<In, Bits<2>>,
    /// Strobe: what is HIGH now is a recovery time, which may be over in the middle of this cell.
    pub look: Signal<In, Bit>,
    /// Mode command that was sent.
    pub command: Signal<In, Bits<6>>,
    /// Strobe, between two frames: the word and the CRC take these.
    pub put: Signal<In, Bit>,
    /// For the word.
    pub put_word: Signal<In, Bits<48>>,
    /// For the CRC.
    pub put_crc: Signal<In, Bits<5>>,
    /// How far a receiver is.
    #[bundle]
    pub progress: ProgressOut,
    /// What an answer says of itself.
    #[bundle]
    pub verdict: AnswerCheckOut,
    /// Payload, bit 0 = the bit received first, zeros above its width.
    pub payload: Signal<Out, Bits<48>>,
    /// CRC as received; bit 4 came first.
    pub crc_received: Signal<Out, Bits<5>>,
    /// CRC computed from the bits as they came.
    pub crc_computed: Signal<Out, Bits<5>>,
    #[start]
    crc: Crc5Word,
    #[start]
    check: Crc5Check,
    #[start(Field::Done)]
    field: Reg<Field>,
    left: Reg<Bits<7>>,
    /// The cell that comes is the last one of the payload.
    payload_ends: Reg<Bit>,
    /// The cell that comes is the last one of the CRC.
    crc_ends: Reg<Bit>,
    to_send: Reg<Bits<7>>,
    under_way: Reg<Bits<3>>,
    word: Reg<Bits<50>>,
    covered: Reg<Bits<4>>,
    f1_bit: Reg<Bit>,
    #[start(true)]
    f2_bit: Reg<Bit>,
    crc_bits: Reg<Bits<5>>,
    crc_calc: Reg<Bits<5>>,
    take_crc: Reg<Bit>,
    align: Reg<Bit>,
    align_first: Reg<Bit>,
    last_taken: Reg<Bit>,
    waiting: Reg<Bit>,
    done_now: Reg<Bit>,
    used: Reg<Bit>,
    ended: Reg<Bit>,
    crc_equal: Reg<Bit>,
    stored_fits: Reg<Bit>,
    refused: Reg<Bit>,
    shift_now: Reg<Bit>,
    bit_now: Reg<Bit>,
    last_payload: Reg<Bit>,
    hunting_now: Reg<Bit>,
    started_now: Reg<Bit>,
    skip_rounds: Reg<Bits<2>>,
    infos_left: Reg<Bits<2>>,
    in_info: Reg<Bit>,
    missing: Reg<Bit>,
    supplement_over: Reg<Bit>,
    low_gap: Reg<Bit>,
    high_gap: Reg<Bit>,
    good_gap: Reg<Bit>,
    low_separator: Reg<Bit>,
    separator_then: Reg<Bit>,
    new_block: Reg<Bit>,
    heard: Reg<Bits<7>>,
    echo: Reg<Bit>,
    swaps: Constant<Bit>,
    has_guards: Constant<Bit>,
    has_all: Constant<Bit>,
    has_diagnosis: Constant<Bit>,
    has_continuous: Constant<Bit>,
    has_double: Constant<Bit>,
    skip_from: Constant<Bits<4>>,
    long_skip_from: Constant<Bits<4>>,
    fixed_cells: Constant<Bits<7>>,
    supplement_cells: Constant<Bits<7>>,
    info_bits: Constant<Bits<6>>,
    cells_from_start: Constant<Bits<7>>,
    not_aligned: Signal<Local, Bit>,
    is_taken: Signal<Local, Bit>,
    again: Signal<Local, Bit>,
    skip_step: Signal<Local, Bit>,
    covered_bit: Signal<Local, Bit>,
    crc_fits: Signal<Local, Bit>,
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
    separator: Signal<Local, Bit>,
    shifted: Signal<Local, Bits<50>>,
    one_more: Signal<Local, Bit>,
    one_less: Signal<Local, Bit>,
    counts: Signal<Local, Bit>,
    width: Signal<Local, Bits<6>>,
    cells_after: Signal<Local, Bits<7>>,
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
            // 34 cells are 4 and two more rounds of the counter.
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
