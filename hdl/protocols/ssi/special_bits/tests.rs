use super::super::specials::Special::{self, *};
use super::*;
use crate::testing::tick;

fn list(specials: &[Special]) -> Specials {
    Specials::new(specials).unwrap()
}

/// The flags and the shown bits of a frame with these levels, in copies.
fn frame(block: &mut SpecialBits, position_bits: u64, copies: &[&[u8]]) -> [u64; 2] {
    let step = |block: &mut SpecialBits| tick(block, |u, level| u.clock.next = level.into());
    block.heard.next = true;
    block.position_bits.next = position_bits.into();
    block.begins.next = true;
    step(block);
    block.begins.next = false;
    for (n, copy) in copies.iter().enumerate() {
        block.repeats.next = n > 0;
        step(block);
        block.repeats.next = false;
        for (place, level) in copy.iter().enumerate() {
            block.left.next = ((copy.len() - place) as u64).into();
            block.level.next = *level == 1;
            block.takes.next = true;
            step(block);
            block.takes.next = false;
            step(block);
        }
    }
    [block.found.val().to_u64(), block.shown.val().to_u64()]
}

fn block(before: &[Special], after: &[Special]) -> SpecialBits {
    let mut block = SpecialBits::new(&list(before), &list(after), true);
    block.connect_all();
    block
}

/// Catches a bit that is swapped with its neighbour, before and after the position.
#[test]
fn each_special_bit_has_its_cause_and_its_place() {
    let before = [Ignored, Alarm, NotPowerFail];
    let after = [NotAlarm, Ignored, Valid, Shown, Ignored];
    let good = [1, 0, 1, 1, 0, 1, 0, 1, 1, 0, 1, 0, 1];
    let mut uut = block(&before, &after);
    assert_eq!(frame(&mut uut, 5, &[&good]), [0, 0b01_1010]);
    for (place, flags, shown) in [
        (0, 0, 0b01_1010),
        (1, 1 << 8, 0b11_1010),
        (2, 1 << 9, 0b00_1010),
        (3, 0, 0b01_1010),
        (7, 0, 0b01_1010),
        (8, 1 << 8, 0b01_0010),
        (9, 0, 0b01_1010),
        (10, 1 << 10, 0b01_1000),
        (11, 0, 0b01_1011),
        (12, 0, 0b01_1010),
    ] {
        let mut other = good;
        other[place] ^= 1;
        let is = frame(&mut uut, 5, &[&other]);
        assert_eq!(is, [flags, shown], "{place}: {:#b} {:#b}", is[0], is[1]);
        // An alarm of the first copy counts, the second one is shown.
        let is = frame(&mut uut, 5, &[&other, &good]);
        assert_eq!(is, [flags, 0b01_1010], "{place}");
        let is = frame(&mut uut, 5, &[&good, &other]);
        assert_eq!(is, [flags, shown], "{place}");
    }
}

/// Positions of an AS5045 with their parity, counted by hand.
#[test]
fn parity_is_of_all_bits_before_it() {
    let mut uut = block(&[], &[Valid, NotValid, Alarm, Shown, Shown, ParityEven]);
    let bits = |text: &str| text.bytes().map(|b| b - b'0').collect::<Vec<_>>();
    let bad = bits("101100101001100011");
    assert_eq!(frame(&mut uut, 12, &[&bad]), [1 << 3, 0b10001]);
    let good = bits("101100101001100010");
    assert_eq!(frame(&mut uut, 12, &[&good]), [0, 0b10001]);
    assert_eq!(frame(&mut uut, 12, &[&good, &good]), [0, 0b10001]);
    let mut odd = block(&[], &[ParityOdd]);
    assert_eq!(frame(&mut odd, 3, &[&bits("1010")]), [1 << 3, 0]);
    assert_eq!(frame(&mut odd, 3, &[&bits("1011")]), [0, 0]);
    // With an odd number of ones in the first copy the second one starts from zero, too.
    assert_eq!(frame(&mut odd, 3, &[&bits("1011"), &bits("1011")]), [0, 0]);
}

/// The CRC of 101 by long division, and a bit after it that it does not cover.
#[test]
fn crc_begins_anew_with_each_copy() {
    let bits = |text: &str| text.bytes().map(|b| b - b'0').collect::<Vec<_>>();
    let mut uut = block(&[], &[Crc6, Ignored]);
    let [good, bad] = ["1010011111", "1010011011"].map(bits);
    assert_eq!(frame(&mut uut, 3, &[&good]), [0, 0]);
    assert_eq!(frame(&mut uut, 3, &[&good, &good]), [0, 0]);
    for copies in [[&bad, &good], [&good, &bad]] {
        let copies = copies.map(|copy| &copy[..]);
        assert_eq!(frame(&mut uut, 3, &copies), [1 << 11, 0]);
    }
}
