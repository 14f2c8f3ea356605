//! Whole result: result and additional data of one frame, for the registers of a channel with requests.
//!
//! ```text
//! frame       command  position  info 2  info 1 ~~~tm~~~\_________ next one
//! result_in   _______________/\___________________________________
//! is_open     _______________/~~~~~~~~~~~~~~~~~~~~~~~~~~~~\_______
//! over        ____________________________________________/\______    additional data are captured here, once
//! outputs     the previous result and its additional data | those of this frame
//! ```
//!
//! The outputs follow the result, except from its publication until its frame is over; then they and the additional data change in one cycle. So
//! a reader never mixes two frames, and never waits for missing data: each frame has an end. Frames that measure the delay and frames
//! of requests end without a separate result, and change nothing.
//!
//! The stream does not wait that long for the position. It takes the result from the channel, and from here the additional data, or the information
//! that they are still due.
//!
//! Without the additional data (T-format) the block is wires only.

use crate::ports::{AdditionalDataIn, FrameResultIn, FrameResultOut};
use crate::regs::{BLOCK_STRIDE, INFO_FIRST, RESULT_BASE};
use crate::replicate::each;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Result and additional data of one channel.
#[derive(LogicBlock, Block)]
pub struct WholeResult {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// Strobe: the channel takes a trigger.
    pub taken: Signal<In, Bit>,
    /// Result of a trigger.
    #[bundle("_in")]
    pub result_in: FrameResultIn,
    /// Recovery time, in system clock cycles.
    pub recovery_cycles_in: Signal<In, Bits<13>>,
    /// Tracked line delay, in system clock cycles.
    pub delay_cycles_in: Signal<In, Bits<11>>,
    /// Strobe: a frame has ended.
    pub over: Signal<In, Bit>,
    /// Record of the additional data that follow each position.
    #[bundle]
    pub record: AdditionalDataIn,
    /// The frame of the newest result is not over: additional data may still come.
    pub is_open: Signal<Out, Bit>,
    /// Additional data 1 of the newest result's frame: 24 bits, came, good, due.
    pub word_1: Signal<Out, Bits<27>>,
    /// Additional data 2 of the newest result's frame.
    pub word_2: Signal<Out, Bits<27>>,
    /// Result of a trigger.
    #[bundle]
    pub result: FrameResultOut,
    /// Recovery time, in system clock cycles.
    pub recovery_cycles: Signal<Out, Bits<13>>,
    /// Tracked line delay, in system clock cycles.
    pub delay_cycles: Signal<Out, Bits<11>>,
    /// Current words of the additional data, for the second interface; none without one.
    pub live: Vec<Signal<Out, Bits<32>>>,
    /// The held words follow the outputs.
    pub load: Signal<In, Bit>,
    /// Word address of the access.
    pub word_address: Signal<In, Bits<11>>,
    /// The address is inside the register map.
    pub in_range: Signal<In, Bit>,
    /// Byte of the word, 0 = most significant.
    pub lane: Signal<In, Bits<2>>,
    /// Byte of the held additional data, 1 cycle later; 0 for other words.
    pub read_byte: Signal<Out, Bits<8>>,
    /// High from a result until its frame has ended: additional data may still come.
    open: Reg<Bit>,
    /// High in the cycle after a frame has ended.
    past: Reg<Bit>,
    /// High for one cycle when a new result is shown, with its additional data.
    whole: Reg<Bit>,
    /// Additional data 1 of the shown result: data, came, good and CRC.
    first: Reg<Bits<31>>,
    /// Additional data 2 of the shown result.
    second: Reg<Bits<31>>,
    /// Age of the shown position in microseconds, up to 65535.
    age: Reg<Bits<16>>,
    /// Position that is shown.
    position_kept: Reg<Bits<48>>,
    /// High if the shown position is valid.
    position_valid_kept: Reg<Bit>,
    /// High if the shown result brought its position.
    fresh_kept: Reg<Bit>,
    /// Number of the shown result.
    sequence_kept: Reg<Bits<16>>,
    /// Time stamp of the shown position.
    first_fall_timestamp_kept: Reg<Bits<32>>,
    /// Primary cause of the shown result.
    cause_kept: Reg<Bits<5>>,
    /// Raw flags of the shown result.
    flags_kept: Reg<Bits<20>>,
    /// CRC received with the shown result.
    crc_received_kept: Reg<Bits<5>>,
    /// CRC computed for the shown result.
    crc_computed_kept: Reg<Bits<5>>,
    /// CRC that came with the shown position.
    position_crc_kept: Reg<Bits<5>>,
    /// Width of the shown position.
    position_width_kept: Reg<Bits<6>>,
    /// High if the shown position came with F2.
    position_has_f2_kept: Reg<Bit>,
    /// Recovery time of the shown result's frame.
    recovery_cycles_kept: Reg<Bits<13>>,
    /// Line delay at the shown result.
    delay_cycles_kept: Reg<Bits<11>>,
    /// Additional data 1 that the host reads.
    held_first: Reg<Bits<31>>,
    /// Additional data 2 that the host reads.
    held_second: Reg<Bits<31>>,
    /// Byte for the host; 0 for other words.
    byte_read: Reg<Bits<8>>,
    /// High for one cycle when a result comes whose frame can bring additional data.
    opens: Signal<Local, Bit>,
    /// `open`, with the result of this cycle.
    open_now: Signal<Local, Bit>,
    /// High for one cycle when the frame of the result has ended, or the next trigger is taken.
    closes: Signal<Local, Bit>,
    /// High in each cycle in which the shown result follows the channel's.
    follows: Signal<Local, Bit>,
    /// Additional data 1 as received: data if the CRC is right.
    filled_1: Signal<Local, Bits<31>>,
    /// Additional data 2 as received: data if the CRC is right.
    filled_2: Signal<Local, Bits<31>>,
    /// High if the address is one of these words.
    selected: Signal<Local, Bit>,
    /// Word that the address selects.
    word: Signal<Local, Bits<32>>,
    /// Address of the two words, divided by 2.
    pair: Constant<Bits<10>>,
    /// 1 if the channel has additional data.
    has_infos: Constant<Bit>,
    _live_pairs: usize,
}

impl WholeResult {
    /// The results of channel `channel`, with additional data if `has_infos`, and with a second interface if `is_shown`.
    pub fn new(channel: usize, has_infos: bool, is_shown: bool) -> Self {
        let first = RESULT_BASE + BLOCK_STRIDE * channel as u16 + u16::from(INFO_FIRST);
        Self::from_parts(WholeResultParts {
            pair: Constant::new(u64::from(first / 2).into()),
            has_infos: Constant::new(has_infos),
            live: each(2 * usize::from(is_shown)),
            _live_pairs: is_shown.into(),
        })
    }
}

#[kernel]
impl Logic for WholeResult {
    fn update(&mut self) {
        // A frame aborted before its position ends one cycle before its result is valid. A frame that withdraws its position changes the
        // result one cycle after its end.
        self.past.d.next = self.over.val();
        self.opens.next = self.result_in.result_strobe.val()
            & !self.past.q.val()
            & self.record.info_active.val().any()
            & (self.result_in.position_has_f2.val() | !self.result_in.fresh.val());
        self.open_now.next = self.open.q.val() | self.opens.val();
        // The next frame has begun: that of the result must have ended.
        self.closes.next = self.open.q.val() & (self.past.q.val() | self.taken.val());
        self.open.d.next = self.open_now.val() & !self.closes.val();
        self.is_open.next = self.open_now.val();

        // The content is valid if its CRC is right; the CRC is shown as received.
        self.filled_1.next = (bit_cast::<31, 5>(self.record.info_crcs.val().get_bits::<5>(0))
            << 26)
            | (bit_cast::<31, 1>(self.record.info_came.val().get_bits::<1>(0)) << 24);
        if self.record.info_came.val().get_bit(0) & self.record.info_good.val().get_bit(0) {
            self.filled_1.next = self.filled_1.val()
                | bit_cast::<31, 24>(self.record.info_1.val())
                | (bit_cast::<31, 1>(1.into()) << 25);
        }
        self.filled_2.next = (bit_cast::<31, 5>(self.record.info_crcs.val().get_bits::<5>(5))
            << 26)
            | (bit_cast::<31, 1>(self.record.info_came.val().get_bits::<1>(1)) << 24);
        if self.record.info_came.val().get_bit(1) & self.record.info_good.val().get_bit(1) {
            self.filled_2.next = self.filled_2.val()
                | bit_cast::<31, 24>(self.record.info_2.val())
                | (bit_cast::<31, 1>(1.into()) << 25);
        }

        // While no frame is open the result may still change: its cause when the frame ends, an upset at any time.
        self.follows.next = !self.open_now.val() | self.closes.val();
        self.whole.d.next =
            (self.result_in.result_strobe.val() & !self.opens.val()) | self.closes.val();
        self.age.d.next = self.age.q.val();
        if self.tick_us.val() & !self.age.q.val().all() {
            self.age.d.next = self.age.q.val() + 1;
        }
        if self.follows.val() {
            self.age.d.next = self.result_in.age_us.val();
            self.position_kept.d.next = self.result_in.position.val();
            self.position_valid_kept.d.next = self.result_in.position_valid.val();
            self.fresh_kept.d.next = self.result_in.fresh.val();
            self.sequence_kept.d.next = self.result_in.sequence.val();
            self.first_fall_timestamp_kept.d.next = self.result_in.first_fall_timestamp.val();
            self.cause_kept.d.next = self.result_in.cause.val();
            self.flags_kept.d.next = self.result_in.flags.val();
            self.crc_received_kept.d.next = self.result_in.crc_received.val();
            self.crc_computed_kept.d.next = self.result_in.crc_computed.val();
            self.position_crc_kept.d.next = self.result_in.position_crc.val();
            self.position_width_kept.d.next = self.result_in.position_width.val();
            self.position_has_f2_kept.d.next = self.result_in.position_has_f2.val();
            self.recovery_cycles_kept.d.next = self.recovery_cycles_in.val();
            self.delay_cycles_kept.d.next = self.delay_cycles_in.val();
        }
        if self.result_in.result_strobe.val() & !self.opens.val() {
            self.first.d.next = 0.into();
            self.second.d.next = 0.into();
        }
        if self.closes.val() {
            self.first.d.next = self.filled_1.val();
            self.second.d.next = self.filled_2.val();
        }
        self.result.result_strobe.next = self.result_in.result_strobe.val();
        self.result.age_us.next = self.result_in.age_us.val();
        self.result.position.next = self.result_in.position.val();
        self.result.position_valid.next = self.result_in.position_valid.val();
        self.result.fresh.next = self.result_in.fresh.val();
        self.result.sequence.next = self.result_in.sequence.val();
        self.result.first_fall_timestamp.next = self.result_in.first_fall_timestamp.val();
        self.result.cause.next = self.result_in.cause.val();
        self.result.flags.next = self.result_in.flags.val();
        self.result.crc_received.next = self.result_in.crc_received.val();
        self.result.crc_computed.next = self.result_in.crc_computed.val();
        self.result.position_crc.next = self.result_in.position_crc.val();
        self.result.position_width.next = self.result_in.position_width.val();
        self.result.position_has_f2.next = self.result_in.position_has_f2.val();
        self.recovery_cycles.next = self.recovery_cycles_in.val();
        self.delay_cycles.next = self.delay_cycles_in.val();
        if self.has_infos.val() {
            self.result.result_strobe.next = self.whole.q.val();
            self.result.age_us.next = self.age.q.val();
            self.result.position.next = self.position_kept.q.val();
            self.result.position_valid.next = self.position_valid_kept.q.val();
            self.result.fresh.next = self.fresh_kept.q.val();
            self.result.sequence.next = self.sequence_kept.q.val();
            self.result.first_fall_timestamp.next = self.first_fall_timestamp_kept.q.val();
            self.result.cause.next = self.cause_kept.q.val();
            self.result.flags.next = self.flags_kept.q.val();
            self.result.crc_received.next = self.crc_received_kept.q.val();
            self.result.crc_computed.next = self.crc_computed_kept.q.val();
            self.result.position_crc.next = self.position_crc_kept.q.val();
            self.result.position_width.next = self.position_width_kept.q.val();
            self.result.position_has_f2.next = self.position_has_f2_kept.q.val();
            self.recovery_cycles.next = self.recovery_cycles_kept.q.val();
            self.delay_cycles.next = self.delay_cycles_kept.q.val();
        }

        // For the stream: the record may still hold the data of the previous result.
        self.word_1.next = 0.into();
        self.word_2.next = 0.into();
        if self.open_now.val() {
            self.word_1.next = bit_cast::<27, 1>(1.into()) << 26;
            self.word_2.next = bit_cast::<27, 1>(1.into()) << 26;
        } else {
            if !self.result_in.result_strobe.val() {
                self.word_1.next = bit_cast::<27, 26>(self.first.q.val().get_bits::<26>(0));
                self.word_2.next = bit_cast::<27, 26>(self.second.q.val().get_bits::<26>(0));
            }
        }

        for i in 0..self._live_pairs {
            self.live[2 * i].next = bit_cast::<32, 31>(self.first.q.val());
            self.live[2 * i + 1].next = bit_cast::<32, 31>(self.second.q.val());
        }

        // The host's words.
        if self.load.val() {
            self.held_first.d.next = self.first.q.val();
            self.held_second.d.next = self.second.q.val();
        }
        self.selected.next = self.has_infos.val()
            & self.in_range.val()
            & (self.word_address.val().get_bits::<10>(1) == self.pair.val());
        self.word.next = bit_cast::<32, 31>(self.held_first.q.val());
        if self.word_address.val().get_bit(0) {
            self.word.next = bit_cast::<32, 31>(self.held_second.q.val());
        }
        // A reset by deselection takes no logic.
        self.byte_read.reset.next = !self.selected.val();
        match self.lane.val().index() {
            0 => {
                self.byte_read.d.next = self.word.val().get_bits::<8>(24);
            }
            1 => {
                self.byte_read.d.next = self.word.val().get_bits::<8>(16);
            }
            2 => {
                self.byte_read.d.next = self.word.val().get_bits::<8>(8);
            }
            _ => {
                self.byte_read.d.next = self.word.val().get_bits::<8>(0);
            }
        }
        self.read_byte.next = self.byte_read.q.val();
    }
}
