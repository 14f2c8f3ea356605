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
