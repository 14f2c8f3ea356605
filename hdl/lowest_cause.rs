//! Primary cause of a protocol whose codes are the raw flag numbers plus one: the lowest flag, because it explains the others.

use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Selects the lowest flag.
#[derive(LogicBlock, Block)]
pub struct LowestCause {
    /// Raw flags, bit n for code n + 1.
    pub flags: Signal<In, Bits<16>>,
    /// Number of the lowest plus one; 0 without flags.
    pub cause: Signal<Out, Bits<5>>,
}

#[kernel]
impl Logic for LowestCause {
    fn update(&mut self) {
        self.cause.next = 0.into();
        if self.flags.val().get_bit(15) {
            self.cause.next = 16.into();
        }
        if self.flags.val().get_bit(14) {
            self.cause.next = 15.into();
        }
        if self.flags.val().get_bit(13) {
            self.cause.next = 14.into();
        }
        if self.flags.val().get_bit(12) {
            self.cause.next = 13.into();
        }
        if self.flags.val().get_bit(11) {
            self.cause.next = 12.into();
        }
        if self.flags.val().get_bit(10) {
            self.cause.next = 11.into();
        }
        if self.flags.val().get_bit(9) {
            self.cause.next = 10.into();
        }
        if self.flags.val().get_bit(8) {
            self.cause.next = 9.into();
        }
        if self.flags.val().get_bit(7) {
            self.cause.next = 8.into();
        }
        if self.flags.val().get_bit(6) {
            self.cause.next = 7.into();
        }
        if self.flags.val().get_bit(5) {
            self.cause.next = 6.into();
        }
        if self.flags.val().get_bit(4) {
            self.cause.next = 5.into();
        }
        if self.flags.val().get_bit(3) {
            self.cause.next = 4.into();
        }
        if self.flags.val().get_bit(2) {
            self.cause.next = 3.into();
        }
        if self.flags.val().get_bit(1) {
            self.cause.next = 2.into();
        }
        if self.flags.val().get_bit(0) {
            self.cause.next = 1.into();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocols::t_format::cause;
    use crate::testing::settle;

    #[test]
    fn the_lowest_flag_is_the_cause() {
        let mut uut = LowestCause::default();
        uut.connect_all();
        let mut primary = |flags: u64| {
            uut.flags.next = flags.into();
            settle(&mut uut);
            uut.cause.val().to_u64()
        };
        assert_eq!(primary(0), cause::NONE);
        for code in 1..cause::COUNT {
            assert_eq!(primary(cause::flag(code)), code);
            assert_eq!(primary(0xffff & !(cause::flag(code) - 1)), code);
            assert_ne!(cause::name(code), "unknown");
        }
        assert_eq!(cause::name(cause::COUNT), "unknown");
    }
}
