//! Command sender: puts the mode command on the data line and switches the driver.
//!
//! ```text
//! falling edge   F1   F2   F3   F4   F5   F6   F7   F8   F9
//! oe           ______/~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~\______
//! data                0   M2   M1   M0  (M2) (M1) (M0)
//! ```
//!
//! The encoder has one clock, from F1 to F2, to release the line before the driver is switched on.
//!
//! Ref: [`crate::protocol::DRIVER_ON_FALL`], [`crate::protocol::FIRST_COMMAND_FALL`], [`crate::protocol::DRIVER_OFF_FALL`].

use crate::reg::Reg;
use rust_hdl::prelude::*;

/// Sends the six bits of a mode command, MSB first, on falling clock edges.
#[derive(LogicBlock, Default)]
pub struct CommandSender {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe: the frame begins with the first falling edge.
    pub start: Signal<In, Bit>,
    /// Strobe of each later falling edge.
    pub fall: Signal<In, Bit>,
    /// Releases the line at once.
    pub abort: Signal<In, Bit>,
    /// The mode command.
    pub command: Signal<In, Bits<6>>,
    /// Level for the data line while `oe` is high.
    pub data: Signal<Out, Bit>,
    /// Driver enable.
    pub oe: Signal<Out, Bit>,
    cells_left: Reg<Bits<4>>,
    cells: Signal<Local, Bits<8>>,
    cell_now: Signal<Local, Bits<3>>,
}

impl Logic for CommandSender {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, cells_left);
        self.cells_left.reset.next = self.reset.val();
        // Cells in falling order: 7 = the lead-in 0 at F2, 6..1 = the command, 8 and 0 = driver off.
        self.cells.next = bit_cast::<8, 6>(self.command.val()) << 1;
        self.cell_now.next = self.cells_left.q.val().get_bits::<3>(0);
        if self.fall.val() & self.cells_left.q.val().any() {
            self.cells_left.d.next = self.cells_left.q.val() - 1;
        }
        if self.abort.val() {
            self.cells_left.d.next = 0.into();
        }
        if self.start.val() {
            self.cells_left.d.next = 8.into();
        }
        self.data.next = self.cells.val().get_bit(self.cell_now.val().index());
        self.oe.next = self.cell_now.val().any();
    }
}
