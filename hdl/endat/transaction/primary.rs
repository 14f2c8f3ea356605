//! Primary cause: selects one of the flags of a frame.

use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Selects the cause that explains the others; a later assignment wins.
#[derive(LogicBlock, Block)]
pub struct PrimaryCause {
    /// Raw flags, one bit for each fault; bits as in the register map.
    pub flags: Signal<In, Bits<20>>,
    /// Primary cause; numbers as in the register map.
    pub cause: Signal<Out, Bits<5>>,
}

#[kernel]
impl Logic for PrimaryCause {
    fn update(&mut self) {
        self.cause.next = 0.into();
        if self.flags.val().get_bit(7) {
            self.cause.next = 8.into();
        }
        if self.flags.val().get_bit(18) {
            self.cause.next = 17.into();
        }
        // CRC before F1 before F2: error bits of a corrupted frame are invalid.
        if self.flags.val().get_bit(5) {
            self.cause.next = 6.into();
        }
        if self.flags.val().get_bit(4) {
            self.cause.next = 5.into();
        }
        if self.flags.val().get_bit(3) {
            self.cause.next = 4.into();
        }
        if self.flags.val().get_bit(11) {
            self.cause.next = 10.into();
        }
        if self.flags.val().get_bit(6) | self.flags.val().get_bit(9) {
            self.cause.next = 7.into();
        }
        if self.flags.val().get_bit(17) {
            self.cause.next = 16.into();
        }
        if self.flags.val().get_bit(2) {
            self.cause.next = 3.into();
        }
        if self.flags.val().get_bit(1) {
            self.cause.next = 2.into();
        }
        if self.flags.val().get_bit(15) {
            self.cause.next = 14.into();
        }
        if self.flags.val().get_bit(14) {
            self.cause.next = 13.into();
        }
        if self.flags.val().get_bit(16) {
            self.cause.next = 15.into();
        }
        if self.flags.val().get_bit(0) {
            self.cause.next = 1.into();
        }
        if self.flags.val().get_bit(12) {
            self.cause.next = 11.into();
        }
        if self.flags.val().get_bit(13) {
            self.cause.next = 12.into();
        }
        if self.flags.val().get_bit(10) {
            self.cause.next = 9.into();
        }
        if self.flags.val().get_bit(19) {
            self.cause.next = 31.into();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::cause;
    use super::*;

    fn primary(flags: u64) -> u64 {
        let mut block = PrimaryCause::default();
        block.connect_all();
        block.flags.next = flags.into();
        block.update_all();
        block.update_all();
        block.cause.val().into()
    }

    #[test]
    fn the_cause_that_explains_the_others_wins() {
        use cause::*;
        let order = [
            TRIGGER_OVERRUN,
            RECOVERY_TOO_SHORT,
            F2,
            F1,
            CRC,
            INFO_MISSING,
            DATA_NOT_FALLING,
            OWN_ECHO,
            START_WINDOW,
            NO_START_BIT,
            LATE_START,
            STUCK_LOW,
            WATCHDOG,
            DATA_NOT_LOW,
            NO_ENCODER,
            STUCK_HIGH,
            UNKNOWN_COMMAND,
            UPSET,
        ];
        assert_eq!(order.len() as u64, cause::COUNT);
        assert_eq!(primary(0), NONE);
        for (rank, high) in order.into_iter().enumerate() {
            let mut below = flag(high);
            assert_eq!(primary(below), high);
            for low in &order[..rank] {
                assert_eq!(primary(flag(high) | flag(*low)), high);
                below |= flag(*low);
            }
            assert_eq!(primary(below), high);
        }
        assert_eq!(primary(flag::TAIL_LOW), DATA_NOT_FALLING);
        assert_eq!(primary(flag::PARALLEL_CRC), NONE);
    }
}
