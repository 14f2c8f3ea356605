//! Ports that travel together through an encoder.

use rtl_design::ports;
use rust_hdl::prelude::*;

/// Settings of an encoder; they are constant while it is `busy`.
#[ports]
pub struct EncoderSettings {
    /// Width of the position, 1..=48 bits.
    pub position_bits: Bits<6>,
    /// The encoder answers EnDat 2.2 commands, too.
    pub endat22: Bit,
    /// Calculation time tcal, in system clock cycles: from the first falling edge of CLOCK to the earliest start bit.
    pub tcal_cycles: Bits<16>,
    /// Recovery time tm after an EnDat 2.1 command, in system clock cycles.
    pub tm_cycles: Bits<13>,
    /// Recovery time tm after an EnDat 2.2 command, in system clock cycles.
    pub tm_22_cycles: Bits<13>,
}

/// The line, at the encoder's end.
#[ports]
pub struct EncoderLine {
    /// Level for the data line while `data_oe` is high, from a register.
    pub data_o: Bit,
    /// Driver enable of the data line, from a register.
    pub data_oe: Bit,
    /// EnDat clock from the transceiver, asynchronous.
    #[back]
    pub endat_clk: Bit,
    /// Data line from the transceiver, asynchronous.
    #[back]
    pub data_i: Bit,
}

/// Errors that an encoder makes; they are constant from `arm` to the end of the last frame that has them.
#[ports]
pub struct EncoderErrors {
    /// Strobe: takes the two numbers of frames. A reset clears them: no errors.
    pub arm: Bit,
    /// Frames before the first one with errors.
    pub skip_frames: Bits<16>,
    /// Frames with errors.
    pub error_frames: Bits<16>,
    /// What is wrong with one bit: 0 nothing, 1 inverted, 2 LOW, 3 HIGH, 4 not driven; 2 to 4 last to the end of the
    /// recovery time, or to a falling edge of CLOCK within it.
    pub bit_error: Bits<3>,
    /// That bit; 0 = start bit.
    pub bit_number: Bits<7>,
    /// Inverted bits of the CRC; bit 4 goes first.
    pub crc_xor: Bits<5>,
    /// F1 is inverted; the CRC fits.
    pub invert_f1: Bit,
    /// F2 is inverted; the CRC fits.
    pub invert_f2: Bit,
    /// Inverted bits of the width: the answer has another one, 1..=48.
    pub width_xor: Bits<6>,
    /// The start bit does not come.
    pub no_start: Bit,
    /// How many clocks before the earliest one the start bit may come: 0..=2. The encoder ignores 3: the receiver would
    /// still drive DATA.
    pub early_clocks: Bits<2>,
    /// Calculation time tcal of these frames, in system clock cycles.
    pub error_tcal_cycles: Bits<16>,
    /// Recovery time tm of these frames, in system clock cycles.
    pub error_tm_cycles: Bits<13>,
}
