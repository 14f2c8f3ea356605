//! Frame buffer: takes a set byte by byte, adds the CRC, encodes it with COBS into a block RAM, and outputs
//! whole frames.
//!
//! ```text
//!                     +--------> CRC-16 -----+
//! block, byte_at --> set byte ---------------+--> byte --> COBS --> block RAM --> data, ready
//!                                                  start of frame ^  written ^        ^ read
//! RAM   .... frame frame | n  b  b  b  n  b ...                                  take-+
//! ^ read_at     ^ start_at    ^ code_at: reserved for the distance to the next zero
//! ```
//!
//! The place of the next code byte is reserved, and written at the next zero. The reader sees a frame only when its end has been written:
//! `start_at` then moves past the whole frame. A byte takes 16 cycles, eight of them for the bits of the CRC.
//!
//! Ref: S. Cheshire, M. Baker, "Consistent Overhead Byte Stuffing", IEEE/ACM Transactions on Networking 7 (2), 1999.

use crate::replicate::each;
use rtl_design::memory::Memory;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Supported sizes of a buffer, in bytes.
pub const BUFFER_BYTES: [u64; 4] = [1024, 2048, 4096, 8192];
/// System clock cycles for each byte that is written.
pub const BYTE_CYCLES: u64 = 16;
/// Generator of the CRC, without x^16.
pub const CRC16_POLYNOMIAL: u64 = 0x1021;
/// Start value of the CRC (CRC-16/IBM-3740).
const CRC16_PRESET: u64 = 0xFFFF;

/// Bytes of a set of `channels` channels, with `additional_data` or without, CRC included.
pub const fn set_bytes(channels: usize, additional_data: bool) -> u64 {
    8 + 8 * channels as u64 * (1 + additional_data as u64) + 2
}

/// Bytes of a frame: COBS adds one, the end another.
pub const fn frame_bytes(channels: usize, additional_data: bool) -> u64 {
    set_bytes(channels, additional_data) + 2
}

/// System clock cycles from the close of a set until the next one may close.
pub const fn frame_cycles(channels: usize, additional_data: bool) -> u64 {
    BYTE_CYCLES * (set_bytes(channels, additional_data) + 3) + 2
}

/// Optional content of sets, in addition to the positions of triggers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SetParts {
    /// Additional data.
    pub additional_data: bool,
    /// Positions of a running clock, each in a separate set.
    pub runs: bool,
}

/// Encoder and buffer.
#[derive(LogicBlock, Block)]
#[properties("../../properties/frame_buffer.sv")]
pub struct FrameBuffer {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe: write a frame; only while `idle` and `room`.
    pub start: Signal<In, Bit>,
    /// No frame is being written.
    pub idle: Signal<Out, Bit>,
    /// A whole frame fits.
    pub room: Signal<Out, Bit>,
    /// A single position fits, and another frame after it, so that the sets of triggers always fit.
    pub single_room: Vec<Signal<Out, Bit>>,
    /// Requested 8 bytes of the set: 0 = head, n + 1 = channel n.
    pub block: Signal<Out, Bits<4>>,
    /// Requested byte of these.
    pub byte_at: Signal<Out, Bits<3>>,
    /// The other 8 bytes of channel n: the additional data.
    pub second: Vec<Signal<Out, Bit>>,
    /// The set has only one channel and no additional data; this and the next input are stable while it is written.
    pub single: Vec<Signal<In, Bit>>,
    /// Place of that channel: 8 times its block.
    pub single_place: Vec<Signal<In, Bits<7>>>,
    /// Requested byte, at most 4 cycles later; 0 for an absent block.
    pub set_byte: Signal<In, Bits<8>>,
    /// Bytes in the buffer, counting complete frames only.
    pub waiting_bytes: Signal<Out, Bits<16>>,
    /// `data` is the next byte.
    pub ready: Signal<Out, Bit>,
    /// The next byte of the frames.
    pub data: Signal<Out, Bits<8>>,
    /// Strobe, with `ready` only: the byte is accepted.
    pub take: Signal<In, Bit>,
    /// Buffer of 1024 bytes.
    ram1k: Vec<Memory<8, 10>>,
    /// Buffer of 2048 bytes.
    ram2k: Vec<Memory<8, 11>>,
    /// Buffer of 4096 bytes.
    ram4k: Vec<Memory<8, 12>>,
    /// Buffer of 8192 bytes.
    ram8k: Vec<Memory<8, 13>>,
    /// High while a frame is written.
    writing: Reg<Bit>,
    /// Cycle of the byte, 0 to 15.
    cycle_at: Reg<Bits<4>>,
    /// Byte of the set that is written: block in bits 6 to 3, byte in bits 2 to 0.
    at: Reg<Bits<7>>,
    /// High while the bytes after the last block are written: CRC and end.
    in_tail: Reg<Bit>,
    /// High while the end of the frame is written.
    is_end: Reg<Bit>,
    /// High after the end of the frame, until the counters have settled.
    is_past: Reg<Bit>,
    /// Byte that is written.
    byte_held: Reg<Bits<8>>,
    /// High if that byte is 0, which COBS replaces.
    is_zero: Reg<Bit>,
    /// High in the last cycle of a byte.
    byte_end: Reg<Bit>,
    /// CRC of the bytes so far; the start value while no frame is written.
    #[start(CRC16_PRESET.into())]
    crc: Reg<Bits<16>>,
    /// Distance from the last code byte: bytes since then, plus one.
    #[start(1u64.into())]
    run: Reg<Bits<7>>,
    /// Address of the next byte.
    write_at: Reg<Bits<13>>,
    /// Address that is kept free for the next code byte.
    code_at: Reg<Bits<13>>,
    /// Address after the last whole frame: the reader stops there.
    start_at: Reg<Bits<13>>,
    /// Address of the next byte to read.
    read_at: Reg<Bits<13>>,
    /// Bytes waiting to be read.
    used: Reg<Bits<13>>,
    /// High if a whole frame fits.
    #[start(true)]
    fits: Reg<Bit>,
    /// High in the cycle after a byte was accepted: `used` is not up to date.
    took: Reg<Bit>,
    /// High while the additional data of a channel are written.
    in_second: Vec<Reg<Bit>>,
    /// High if a frame fits and leaves room for the longest one.
    single_fits: Vec<Reg<Bit>>,
    /// Bit 7 of `run`, for sets longer than 127 bytes.
    run_high: Vec<Reg<Bit>>,
    /// High in the last cycle of the last byte of a block.
    block_ends: Vec<Signal<Local, Bit>>,
    /// Bit of the byte that enters the CRC in this cycle.
    bit_index: Signal<Local, Bits<3>>,
    /// Bit that the CRC feeds back.
    feedback: Signal<Local, Bit>,
    /// High for one cycle when the write address advances.
    advance: Signal<Local, Bit>,
    /// High for one cycle when the buffer is written.
    write: Signal<Local, Bit>,
    /// Address that is written: of the byte, or of the code byte.
    write_address: Signal<Local, Bits<13>>,
    /// Byte that is written: data, distance to the next zero, or the end.
    write_byte: Signal<Local, Bits<8>>,
    /// Byte at the read address.
    read_byte: Signal<Local, Bits<8>>,
    /// Number of the block after the last channel's.
    tail_block: Constant<Bits<4>>,
    /// Highest address of the buffer.
    mask: Constant<Bits<13>>,
    /// Most waiting bytes with which a whole frame still fits.
    most_used: Constant<Bits<13>>,
    /// Generator of the CRC, without x^16.
    polynomial: Constant<Bits<16>>,
    /// 1 if frames may have more than one length.
    has_other_frames: Constant<Bit>,
    _ram1k: usize,
    _ram2k: usize,
    _ram4k: usize,
    _ram8k: usize,
    _seconds: usize,
    _singles: usize,
    _block_ends: usize,
}

impl FrameBuffer {
    /// A buffer of `bytes` bytes, one of [`BUFFER_BYTES`], for sets of `channels` channels; with additional data and single positions of a running
    /// clock if `parts` includes them.
    ///
    /// # Panics
    /// If no buffer has this size.
    pub fn new(bytes: u64, channels: usize, parts: SetParts) -> Self {
        let (seconds, singles) = (usize::from(parts.additional_data), usize::from(parts.runs));
        assert!(BUFFER_BYTES.contains(&bytes), "buffer of {bytes} bytes");
        let of = |size: usize| usize::from(BUFFER_BYTES[size] == bytes);
        Self::from_parts(FrameBufferParts {
            second: each(seconds),
            single: each(singles),
            single_room: each(singles),
            single_place: each(singles),
            ram1k: (0..of(0)).map(|_| Default::default()).collect(),
            ram2k: (0..of(1)).map(|_| Default::default()).collect(),
            ram4k: (0..of(2)).map(|_| Default::default()).collect(),
            ram8k: (0..of(3)).map(|_| Default::default()).collect(),
            in_second: each(seconds),
            single_fits: each(singles),
            run_high: each(seconds),
            block_ends: each(seconds.max(singles)),
            tail_block: Constant::new((channels as u64 + 1).into()),
            mask: Constant::new((bytes - 1).into()),
            // One place stays free, to distinguish full from empty.
            most_used: Constant::new(
                (bytes - 1 - frame_bytes(channels, parts.additional_data)).into(),
            ),
            polynomial: Constant::new(CRC16_POLYNOMIAL.into()),
            has_other_frames: Constant::new(seconds.max(singles) > 0),
            _ram1k: of(0),
            _ram2k: of(1),
            _ram4k: of(2),
            _ram8k: of(3),
            _seconds: seconds,
            _singles: singles,
            _block_ends: seconds.max(singles),
        })
    }
}

#[kernel]
impl Logic for FrameBuffer {
    fn update(&mut self) {
        // Each frame starts from the initial state.
        self.at.reset.next = !self.writing.q.val();
        self.crc.reset.next = !self.writing.q.val();
        self.run.reset.next =
            !self.writing.q.val() | (self.byte_end.q.val() & self.is_zero.q.val());

        // Byte, and its cycle 0 to 15.
        self.cycle_at.d.next = self.cycle_at.q.val() + 1;
        self.byte_end.d.next = self.writing.q.val() & (self.cycle_at.q.val() == 14);
        if self.byte_end.q.val() {
            self.at.d.next = self.at.q.val() + 1;
        }
        // The two blocks of a channel have one number; the tail follows a single one.
        for i in 0..self._block_ends {
            self.block_ends[i].next =
                self.byte_end.q.val() & self.at.q.val().get_bits::<3>(0).all();
        }
        for i in 0..self._seconds {
            self.in_second[i].clock.next = self.clock.val();
            self.in_second[i].reset.next = !self.writing.q.val();
            self.in_second[i].d.next = self.in_second[i].q.val();
            if self.block_ends[i].val() {
                self.in_second[i].d.next =
                    self.at.q.val().get_bits::<4>(3).any() & !self.in_second[i].q.val();
                if self.at.q.val().get_bits::<4>(3).any() & !self.in_second[i].q.val() {
                    self.at.d.next = self.at.q.val() & 0x78;
                }
            }
            self.second[i].next = self.in_second[i].q.val();
            self.run_high[i].clock.next = self.clock.val();
            self.run_high[i].reset.next =
                !self.writing.q.val() | (self.byte_end.q.val() & self.is_zero.q.val());
            self.run_high[i].d.next = self.run_high[i].q.val();
            if self.byte_end.q.val() & self.run.q.val().all() {
                self.run_high[i].d.next = true;
            }
        }
        for i in 0..self._singles {
            if self.block_ends[i].val() & self.single[i].val() {
                self.at.d.next = bit_cast::<7, 4>(self.tail_block.val()) << 3;
                if !self.at.q.val().get_bits::<4>(3).any() {
                    self.at.d.next = self.single_place[i].val();
                }
            }
        }
        if !self.writing.q.val() {
            self.cycle_at.d.next = 0.into();
        }
        self.block.next = self.at.q.val().get_bits::<4>(3);
        self.byte_at.next = self.at.q.val().get_bits::<3>(0);
        // The tail: 0, 1 = CRC, 2 = the zero that COBS puts at the end, 3 = the end of the frame, 4 = time for the counters.
        self.in_tail.d.next = self.at.q.val().get_bits::<4>(3) == self.tail_block.val();
        self.is_end.d.next = self.in_tail.q.val() & self.at.q.val().get_bits::<2>(0).all();
        self.is_past.d.next = self.in_tail.q.val() & self.at.q.val().get_bit(2);

        self.byte_held.d.next = self.set_byte.val();
        if self.in_tail.q.val() & !self.at.q.val().get_bits::<2>(1).any() {
            self.byte_held.d.next = self.crc.q.val().get_bits::<8>(0);
            if self.at.q.val().get_bit(0) {
                self.byte_held.d.next = self.crc.q.val().get_bits::<8>(8);
            }
        }
        self.is_zero.d.next = !self.byte_held.q.val().any();

        // Each of the second eight cycles processes a bit of the CRC.
        self.bit_index.next = !self.cycle_at.q.val().get_bits::<3>(0);
        self.feedback.next = self.crc.q.val().get_bit(15)
            ^ self.byte_held.q.val().get_bit(self.bit_index.val().index());
        if self.cycle_at.q.val().get_bit(3) & !self.in_tail.q.val() {
            self.crc.d.next = self.crc.q.val() << 1;
            if self.feedback.val() {
                self.crc.d.next = (self.crc.q.val() << 1) ^ self.polynomial.val();
            }
        }

        // COBS: a zero reserves the place of the next code byte, and its distance is written to the last one.
        self.advance.next = self.start.val()
            | (self.byte_end.q.val() & !self.is_end.q.val() & !self.is_past.q.val());
        if self.advance.val() {
            self.write_at.d.next = (self.write_at.q.val() + 1) & self.mask.val();
            if self.start.val() | self.is_zero.q.val() {
                self.code_at.d.next = self.write_at.q.val();
            }
        }
        if self.byte_end.q.val() {
            self.run.d.next = self.run.q.val() + 1;
        }
        self.write.next = self.byte_end.q.val() & !self.is_past.q.val();
        self.write_address.next = self.write_at.q.val();
        self.write_byte.next = self.byte_held.q.val();
        if self.is_zero.q.val() {
            self.write_address.next = self.code_at.q.val();
            self.write_byte.next = bit_cast::<8, 7>(self.run.q.val());
            for i in 0..self._seconds {
                if self.run_high[i].q.val() {
                    self.write_byte.next = bit_cast::<8, 7>(self.run.q.val()) | 0x80;
                }
            }
        }
        if self.is_end.q.val() {
            self.write_byte.next = 0.into();
        }
        if self.start.val() {
            self.writing.d.next = true;
        }
        if self.byte_end.q.val() & self.is_end.q.val() {
            self.start_at.d.next = self.write_at.q.val();
        }
        if self.byte_end.q.val() & self.is_past.q.val() {
            self.writing.d.next = false;
        }
        self.idle.next = !self.writing.q.val();

        // The read side. An accepted byte frees its place a cycle later, and the next byte comes in the cycle after that.
        self.took.d.next = self.take.val();
        if self.take.val() {
            self.read_at.d.next = (self.read_at.q.val() + 1) & self.mask.val();
        }
        self.used.d.next = (self.start_at.q.val() - self.read_at.q.val()) & self.mask.val();
        self.fits.d.next = self.used.q.val() <= self.most_used.val();
        self.room.next = self.fits.q.val();
        for i in 0..self._singles {
            connect!(self.single_fits[i] <= self; clock, reset);
            // More than the longest frame.
            self.single_fits[i].d.next = self.used.q.val() <= (self.most_used.val() - 144);
            self.single_room[i].next = self.single_fits[i].q.val();
        }
        self.waiting_bytes.next = bit_cast::<16, 13>(self.used.q.val());
        self.ready.next = self.used.q.val().any() & !self.took.q.val();

        self.read_byte.next = 0.into();
        for i in 0..self._ram1k {
            connect!(self.ram1k[i] <= self; clock, write_enable = write);
            self.ram1k[i].write_address.next = self.write_address.val().get_bits::<10>(0);
            self.ram1k[i].write_data.next = self.write_byte.val();
            self.ram1k[i].read_address.next = self.read_at.q.val().get_bits::<10>(0);
            self.read_byte.next = self.ram1k[i].read_data.val();
        }
        for i in 0..self._ram2k {
            connect!(self.ram2k[i] <= self; clock, write_enable = write);
            self.ram2k[i].write_address.next = self.write_address.val().get_bits::<11>(0);
            self.ram2k[i].write_data.next = self.write_byte.val();
            self.ram2k[i].read_address.next = self.read_at.q.val().get_bits::<11>(0);
            self.read_byte.next = self.ram2k[i].read_data.val();
        }
        for i in 0..self._ram4k {
            connect!(self.ram4k[i] <= self; clock, write_enable = write);
            self.ram4k[i].write_address.next = self.write_address.val().get_bits::<12>(0);
            self.ram4k[i].write_data.next = self.write_byte.val();
            self.ram4k[i].read_address.next = self.read_at.q.val().get_bits::<12>(0);
            self.read_byte.next = self.ram4k[i].read_data.val();
        }
        for i in 0..self._ram8k {
            connect!(self.ram8k[i] <= self;
                clock, write_enable = write, write_address, write_data = write_byte
            );
            self.ram8k[i].read_address.next = self.read_at.q.val();
            self.read_byte.next = self.ram8k[i].read_data.val();
        }
        self.data.next = self.read_byte.val();
    }
}
