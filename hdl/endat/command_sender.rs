//! Command sender: puts mode command, parameter and supplement on the data line and switches the driver.
//!
//! ```text
//! falling edge   F1   F2   F3   F4   F5   F6   F7   F8   F9  ... F32  F33
//! oe           ______/~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~\_____________________   without parameter
//! oe           ______/~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~\____   with parameter
//! data                0   M2   M1   M0  (M2) (M1) (M0) | 24 bits ..... |
//!
//! falling edge   F'1  F'2  ...  F'7  F'8  F'9 .... F'32 F'33
//! oe           _/~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~\____                  supplement
//! data           0    0    ...  0    1   | 24 bits .... |
//! ```
//!
//! The encoder has one clock, from F1 to F2, to release the line before the driver is switched on.
//!
//! Ref: HEIDENHAIN PWM 20 user's manual (driver on at F2); TI motor-control SDK (first command bit at F3, 7 LOW bits before the
//! start bit of a supplement).

use crate::protocol::PARAMETER_BITS;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Sends mode command, parameter and supplement, MSB first, on falling clock edges.
#[derive(LogicBlock, Block)]
#[properties("../properties/command_sender.sv")]
pub struct CommandSender {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe: the frame begins with the first falling edge.
    pub start: Signal<In, Bit>,
    /// One-cycle strobe: the next falling edge is the first one of the supplement.
    pub start_supplement: Signal<In, Bit>,
    /// Strobe of each later falling edge.
    pub fall: Signal<In, Bit>,
    /// Releases the line at once.
    pub aborts: Signal<In, Bit>,
    /// The mode command.
    pub command: Signal<In, Bits<6>>,
    /// The parameter follows the mode command.
    pub has_parameter: Signal<In, Bit>,
    /// MRS code, address or port in the upper 8 bits, data below.
    pub parameter_word: Signal<In, Bits<24>>,
    /// Level for the data line while `oe` is high.
    pub data: Signal<Out, Bit>,
    /// Driver enable.
    pub oe: Signal<Out, Bit>,
    has_all: Constant<Bit>,
    /// Bits of a parameter.
    parameter_bits: Constant<Bits<5>>,
    /// Cells left of the mode command, or of the zeros and start bit of a supplement; counts down to 0.
    cells_left: Reg<Bits<4>>,
    /// Bits left of the parameter, including the one on the line; 0 if none is sent.
    bits_left: Reg<Bits<5>>,
    /// Set when a supplement begins; cleared when a frame begins.
    in_supplement: Reg<Bit>,
    /// Levels of these cells; `cell_now` selects the one on the line.
    cells: Signal<Local, Bits<8>>,
    /// `cells_left`, modulo 8.
    cell_now: Signal<Local, Bits<3>>,
    /// Levels of the parameter; `bits_left` selects the one on the line.
    bits: Signal<Local, Bits<32>>,
}

impl CommandSender {
    /// A sender for all commands and supplements, or for mode commands only.
    pub fn new(has_all: bool) -> Self {
        Self::from_parts(CommandSenderParts {
            has_all: Constant::new(has_all),
            parameter_bits: Constant::new(u64::from(PARAMETER_BITS).into()),
        })
    }
}

#[kernel]
impl Logic for CommandSender {
    fn update(&mut self) {
        // Cells in falling order: 7 = the lead-in 0 at F2, 6..1 = the command, 8 and 0 = driver off.
        self.cells.next = bit_cast::<8, 6>(self.command.val()) << 1;
        // 9 = driver off until F'1, 8..2 = zeros, 1 = the start bit.
        if self.in_supplement.q.val() {
            self.cells.next = 2.into();
        }
        self.bits.next = bit_cast::<32, 24>(self.parameter_word.val()) << 1;
        self.cell_now.next = self.cells_left.q.val().get_bits::<3>(0);
        if self.fall.val() & self.cells_left.q.val().any() {
            self.cells_left.d.next = self.cells_left.q.val() - 1;
        }
        self.data.next = self.cells.val().get_bit(self.cell_now.val().index());
        self.oe.next = self.cell_now.val().any();
        if self.has_all.val() {
            if self.fall.val() & self.bits_left.q.val().any() {
                self.bits_left.d.next = self.bits_left.q.val() - 1;
            }
            if self.fall.val()
                & (self.cells_left.q.val() == 1)
                & (self.has_parameter.val() | self.in_supplement.q.val())
            {
                self.bits_left.d.next = self.parameter_bits.val();
            }
            if self.in_supplement.q.val() {
                self.oe.next = self.cells_left.q.val().any() & (self.cells_left.q.val() != 9);
            }
            if self.bits_left.q.val().any() {
                self.data.next = self.bits.val().get_bit(self.bits_left.q.val().index());
                self.oe.next = true;
            }
            if self.start_supplement.val() {
                self.cells_left.d.next = 9.into();
                self.in_supplement.d.next = true;
            }
        }
        if self.aborts.val() {
            self.cells_left.d.next = 0.into();
            self.bits_left.d.next = 0.into();
        }
        if self.start.val() {
            self.cells_left.d.next = 8.into();
            self.bits_left.d.next = 0.into();
            self.in_supplement.d.next = false;
        }
    }
}
