//! Word access: converts a 32-bit access of a bus into byte accesses of the register bank.
//!
//! ```text
//! request, word_address --> [result word: new snapshot?] --> lane 0 .. 3: access, done --> data --> finished
//!                                 |                        configuration: one turn, bytes as they pass
//!                                 +--> reading
//! ```
//!
//! **Snapshot.** Reads of result words at rising addresses belong to one snapshot, like one burst of the UART. The first of them
//! takes the snapshot, and `reading` holds it. A read of the same or of a lower address takes the next one. A snapshot ends automatically
//! 7 to 8 us after its last read, so that a host that stops in the middle does not freeze the results.
//!
//! From `request` to `finished`: 17 cycles for a word that is read, 3 more for the first of a snapshot, 26 for a word of a service or line
//! monitor; 5 for a strobe. A configuration word, read or written, takes a turn of the configuration ring (12 cycles for the card and each channel) plus 4.
//! So does a write to a service or line monitor.

use crate::card::ports::AccessOut;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Microseconds without a read after which a snapshot ends.
pub const QUIET_US: u64 = 8;

/// A word as four bytes.
#[derive(LogicBlock, Block)]
#[properties("../../properties/word_access.sv")]
pub struct WordAccess {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// Strobe: begin an access; only after the last one has finished.
    pub request: Signal<In, Bit>,
    /// Word address, constant from `request` to `finished`.
    pub address_in: Signal<In, Bits<11>>,
    /// Write; constant from `request` to `finished`.
    pub write_in: Signal<In, Bit>,
    /// Word to write, with `request`.
    pub data_in: Signal<In, Bits<32>>,
    /// The front is within a burst: the snapshot does not end automatically.
    pub keep_snapshot: Signal<In, Bit>,
    /// Strobe: the snapshot ends.
    pub end_snapshot: Signal<In, Bit>,
    /// Strobe: the access has ended.
    pub finished: Signal<Out, Bit>,
    /// Word that was read, from `finished` to the next `request`.
    pub read_data: Signal<Out, Bits<32>>,
    /// A front's access to the register bank.
    #[bundle]
    pub bank: AccessOut,
    /// Word: bytes to write leave at the top, bytes that were read enter at the bottom.
    data: Reg<Bits<32>>,
    /// Byte that is read, 0 = most significant.
    byte_lane: Reg<Bits<2>>,
    /// High for one cycle when an access of the register bank begins.
    access_strobe: Reg<Bit>,
    /// High for one cycle when the word is complete.
    end_strobe: Reg<Bit>,
    /// High if one access handles the whole word: a write, or a configuration word.
    whole: Reg<Bit>,
    /// Cycles until the first byte of a new snapshot is read; 0 = none.
    settle: Reg<Bits<2>>,
    /// High while results are held for a series of reads.
    holding: Reg<Bit>,
    /// Low address bits of the last result word read.
    last_read: Reg<Bits<7>>,
    /// Microseconds since the last read of a result word; 8 ends the snapshot.
    quiet_us: Reg<Bits<4>>,
    /// Page of the register map that the address is in.
    page: Signal<Local, Bits<4>>,
    /// High if a word of a result is read.
    is_result: Signal<Local, Bit>,
    /// High if the address is a configuration word.
    is_config: Signal<Local, Bit>,
    /// High if the word belongs to the held snapshot: its address is above the last one.
    goes_on: Signal<Local, Bit>,
}

#[kernel]
impl Logic for WordAccess {
    fn update(&mut self) {
        // 128 words each: page 2 has configurations, in the first four of each eight words; page 3 has results.
        self.page.next = self.address_in.val().get_bits::<4>(7);
        self.is_result.next = !self.write_in.val() & (self.page.val() == 3);
        self.is_config.next = (self.page.val() == 2) & !self.address_in.val().get_bit(2);
        self.goes_on.next = self.holding.q.val()
            & (self.address_in.val().get_bits::<7>(0) > self.last_read.q.val());

        // A new snapshot: `reading` falls for two cycles, in which the held words follow the results.
        self.access_strobe.d.next = false;
        self.end_strobe.d.next = false;
        if self.settle.q.val().any() {
            self.settle.d.next = self.settle.q.val() - 1;
        }
        if self.settle.q.val() == 2 {
            self.holding.d.next = true;
        }
        if self.settle.q.val() == 1 {
            self.access_strobe.d.next = true;
        }
        if self.tick_us.val() {
            self.quiet_us.d.next = self.quiet_us.q.val() + 1;
        }
        if self.keep_snapshot.val() {
            self.quiet_us.d.next = 0.into();
        }
        if self.quiet_us.q.val().get_bit(3) | self.end_snapshot.val() {
            self.holding.d.next = false;
            self.quiet_us.d.next = 0.into();
        }

        // A write accepts its word at once, and one access passes a configuration word. All other words are read byte by byte.
        if self.request.val() {
            // Absent words read 0.
            self.data.d.next = 0.into();
            if self.write_in.val() {
                self.data.d.next = self.data_in.val();
            }
            self.byte_lane.d.next = 0.into();
            self.whole.d.next = self.write_in.val() | self.is_config.val();
            self.access_strobe.d.next = true;
            if self.is_result.val() {
                self.quiet_us.d.next = 0.into();
                self.last_read.d.next = self.address_in.val().get_bits::<7>(0);
                self.holding.d.next = self.goes_on.val();
                if !self.goes_on.val() {
                    self.settle.d.next = 3.into();
                    self.access_strobe.d.next = false;
                }
            }
        }
        if self.bank.take_byte.val() {
            self.data.d.next =
                (self.data.q.val() << 8) | bit_cast::<32, 8>(self.bank.passing_byte.val());
        }
        if self.bank.done.val() {
            if self.whole.q.val() {
                self.end_strobe.d.next = true;
            } else {
                self.data.d.next =
                    (self.data.q.val() << 8) | bit_cast::<32, 8>(self.bank.read_byte.val());
                self.byte_lane.d.next = self.byte_lane.q.val() + 1;
                self.access_strobe.d.next = !self.byte_lane.q.val().all();
                self.end_strobe.d.next = self.byte_lane.q.val().all();
            }
        }

        self.finished.next = self.end_strobe.q.val();
        self.read_data.next = self.data.q.val();
        self.bank.word_address.next = self.address_in.val();
        self.bank.in_range.next = true;
        self.bank.write.next = self.write_in.val();
        self.bank.lane.next = self.byte_lane.q.val();
        self.bank.access.next = self.access_strobe.q.val();
        self.bank.write_data.next = self.data.q.val();
        self.bank.reading.next = self.holding.q.val();
    }
}
