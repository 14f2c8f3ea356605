//! Bundles of ports between the blocks of a channel.
//!
//! ```text
//! ChannelRegisters --PortSettings--> EncoderPort, Channel, with guards FrameSettings
//! ServiceChannel --ServiceOrders--> Channel
//! AddInfo --AdditionalData--> Channel, EncoderPort, ServiceChannel, WholeResult
//! Snapshot --FrameResult--> Channel, EncoderPort, WholeResult, ChannelRegisters
//! Channel --FrameEnd--> EncoderPort, ServiceChannel
//! ```

use rtl_design::ports;
use rust_hdl::prelude::*;

/// Settings of one channel, as the host has written them; constant while `busy` and in the cycle of a trigger.
#[ports]
pub struct PortSettings {
    /// EnDat clock period, in system clock cycles; if odd, the high phase is longer. T-format: a bit, 8 to 127.
    pub period_cycles: Bits<11>,
    /// Extension of the first low phase beyond half a period: 0, or at least 4 system clock cycles (tST).
    pub first_low_extra_cycles: Bits<11>,
    /// Mode command of a triggered frame.
    pub command: Bits<6>,
    /// Position width, 1..=48 bits.
    pub position_bits: Bits<6>,
    /// Pulses on the data line of at most this many system clock cycles are ignored.
    pub filter_cycles: Bits<4>,
    /// Half a system clock cycle more, if DATA is sampled on both edges.
    pub filter_half: Bit,
    /// Largest distance of the start edge from its expected place, in system clock cycles.
    pub start_window_cycles: Bits<6>,
    /// Longest wait for the start bit after the turnaround, in microseconds. T-format: longest pause before the reply, 1 to 63.
    pub start_timeout_us: Bits<12>,
    /// Data must fall within this many system clock cycles after the frame.
    pub recovery_limit_cycles: Bits<13>,
}

/// Requests of the service to its channel.
#[ports]
pub struct ServiceOrders {
    /// Mode command of a request.
    pub request_command: Bits<6>,
    /// Parameter of the request: MRS code, address or port in the upper 8 bits, data below.
    pub request_parameter: Bits<24>,
    /// Strobe: send the request, a position command with supplement or not, with the next trigger.
    pub request_ride: Bit,
    /// Strobe: send the request in a separate frame as soon as the line is free. Its result is not published.
    pub request_own: Bit,
    /// Strobe: cancel the request if it has not begun.
    pub request_cancel: Bit,
    /// No triggered frame may begin: triggers are lost, and counted as such.
    pub hold_off: Bit,
    /// Puts the EnDat clock LOW, for the pulse of the power-up sequence.
    pub clock_low: Bit,
    /// Errors forced into the received data, to test the error paths; bits as `service.force` in the register map.
    pub forced: Bits<5>,
    /// Longest time from the first falling edge to the end of the recovery time; 0 = not watched.
    pub watchdog_us: Bits<12>,
    /// Data must not fall before this after the frame; 0 = not checked.
    pub recovery_min_cycles: Bits<13>,
    /// With 000111: the clock continues after each position, and the next one follows without a command.
    pub continuous: Bit,
    /// The clock stops after an error, until the next trigger.
    pub stop_at_error: Bit,
}

/// Result of a trigger.
#[ports]
pub struct FrameResult {
    /// Strobe: a new result can be read from this cycle on.
    pub result_strobe: Bit,
    /// Last good position, bit 0 = LSB, zeros above its width. T-format: multi-turn in bits 47..24, single-turn in 23..0.
    pub position: Bits<48>,
    /// A good position is available.
    pub position_valid: Bit,
    /// The last result brought the position, or in T-format a part of it; low = held from an earlier frame.
    pub fresh: Bit,
    /// Number of results, wrapping.
    pub sequence: Bits<16>,
    /// Time of the first falling edge of the position's frame (CLOCK; T-format: start bit), in system clock cycles.
    pub first_fall_timestamp: Bits<32>,
    /// Age of the position in microseconds: 0 until its frame has ended, counted from there; stops at 65535.
    pub age_us: Bits<16>,
    /// Primary cause of the last result, a code of the channel's protocol.
    pub cause: Bits<5>,
    /// Raw flags of the last result.
    pub flags: Bits<20>,
    /// CRC received in the last whole frame.
    pub crc_received: Bits<5>,
    /// CRC computed for the last whole frame.
    pub crc_computed: Bits<5>,
    /// CRC received with the position. With the error bits of a good frame and the width, a host can check what it has read. 0 in T-format.
    pub position_crc: Bits<5>,
    /// Width of the position; 0 in T-format.
    pub position_width: Bits<6>,
    /// The position came with F2 (EnDat 2.2); its error bits are F1 = 0, F2 = 1.
    pub position_has_f2: Bit,
}

/// A frame, triggered or not, has ended.
#[ports]
pub struct FrameEnd {
    /// Strobe: a frame has ended; the other signals belong to it.
    pub over: Bit,
    /// The frame carried the request.
    pub over_request: Bit,
    /// Primary cause of the frame, as in a result.
    pub over_cause: Bits<5>,
    /// Raw flags of the frame.
    pub over_flags: Bits<20>,
    /// Answer of the last request with a separate frame, the first bit in bit 0.
    pub answer: Bits<48>,
    /// The CRC of that answer is right.
    pub reply_good: Bit,
}

/// Record of the additional data that follow each position.
#[ports]
pub struct AdditionalData {
    /// Additional data that the encoder sends after each EnDat 2.2 position: bit 0 additional data 1, bit 1 additional data 2.
    pub info_active: Bits<2>,
    /// Last additional data 1: WRN, RM, Busy, I4..I0, 16 bits.
    pub info_1: Bits<24>,
    /// Last additional data 2.
    pub info_2: Bits<24>,
    /// Additional data in the last frame: bit 0 additional data 1, bit 1 additional data 2.
    pub info_came: Bits<2>,
    /// The CRCs of these blocks are right.
    pub info_good: Bits<2>,
    /// Received CRCs, or 0: additional data 1 in bits 4..0, additional data 2 in bits 9..5.
    pub info_crcs: Bits<10>,
}

/// The line of one encoder.
#[ports]
pub struct Line {
    /// EnDat clock to the transceiver, from a register; it rests HIGH.
    pub endat_clk: Bit,
    /// Data line to the transceiver, from a register.
    pub data_o: Bit,
    /// Driver enable of the data line, from a register.
    pub data_oe: Bit,
    /// Data line from the transceiver, asynchronous.
    #[back]
    pub data_i: Bit,
}

/// The host's access to the words of a port.
#[ports]
pub struct HostWindow {
    /// Word of the service's RAM, or of the T-format port, that the host accesses; stable from one strobe to the next, at least 8 cycles.
    pub host_address: Bits<7>,
    /// The word belongs to the line monitor, not to the service.
    pub host_line: Bit,
    /// Strobe: read the word.
    pub host_read: Bit,
    /// The word read; 0 for words of other ports.
    #[back]
    pub host_word: Bits<32>,
    /// Strobe: write one half of the word.
    pub host_write: Bit,
    /// Half to write: 1 = high. If written last, the low half acts.
    pub host_half: Bit,
    /// Data to write.
    pub host_data: Bits<16>,
}
