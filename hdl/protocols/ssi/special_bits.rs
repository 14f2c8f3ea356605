//! Special bits: the bits of an SSI frame that are not position.
//!
//! ```text
//! left     all ... after + own + 1 | after + own ... after + 1 | after ... tail + 1 | tail ... 1
//! bit        before the position   |  position, is_position    |       after the position
//! stored     from the first one that is shown on               | up to the last one that is shown
//! ```
//!
//! `left` counts the bits of a copy down to 1; the port stores it twice. A parity bit directly after the position belongs to the position.
//! CRC and parity are computed from zero for each copy.
//! <!-- with has_guards -->
//!
//! A guard against upsets: the parity of the stored bits is formed while they arrive.
//! <!-- end -->

use super::cause;
use super::specials::{Places, Specials, CRC_POLYNOMIAL, SHOWN_MAX};
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Special bits of one SSI encoder.
#[derive(LogicBlock, Block)]
#[properties("../../properties/special_bits.sv")]
pub struct SpecialBits {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe: a trigger is accepted.
    pub begins: Signal<In, Bit>,
    /// Strobe: the second copy begins.
    pub repeats: Signal<In, Bit>,
    /// Strobe: a bit is sampled.
    pub takes: Signal<In, Bit>,
    /// DATA.
    pub level: Signal<In, Bit>,
    /// Bits of the copy that are left, including the one that is sampled.
    pub left: Signal<In, Bits<6>>,
    /// Bits of the position.
    pub position_bits: Signal<In, Bits<6>>,
    /// A parity bit follows the position, and belongs to it.
    pub has_parity: Signal<In, Bit>,
    /// Bits have been received.
    pub heard: Signal<In, Bit>,
    /// Bits of a copy.
    pub all_bits: Signal<Out, Bits<6>>,
    /// The sampled bit belongs to the position, or is its parity bit.
    pub is_position: Signal<Out, Bit>,
    /// The sampled bit is the last of these.
    pub ends_position: Signal<Out, Bit>,
    /// Raw flags from the special bits of the frame, bit n for code n + 1.
    pub found: Signal<Out, Bits<12>>,
    /// Special bits of the result, as last received; the last one in bit 0, and 0 for bits that are not shown.
    pub shown: Signal<Out, Bits<8>>,
    /// Special bits from the first to the last one that is shown, the last one in bit 0.
    status: Reg<Bits<14>>,
    /// Parity of the bits stored in `status`, formed while they arrived.
    sum: Reg<Bit>,
    /// Alarm, power failure, not valid, from the first copy.
    bad_before: Reg<Bits<3>>,
    /// Parity of all bits of the copy so far.
    ones: Reg<Bit>,
    /// High if the parity bit of a copy was wrong.
    is_odd: Reg<Bit>,
    /// CRC of the copy so far; 0 after its CRC bits if they are right.
    crc: Reg<Bits<6>>,
    /// High if the CRC of a copy was wrong.
    is_wrong: Reg<Bit>,
    /// Bits of the position and its parity bit.
    own_bits: Signal<Local, Bits<6>>,
    /// High if the bit comes before the position.
    is_before: Signal<Local, Bit>,
    /// High if the bit comes after the position.
    is_after: Signal<Local, Bit>,
    /// High for one cycle when the bit is stored.
    stores: Signal<Local, Bit>,
    /// High if a 1 leaves the shift register as the bit enters.
    falls_out: Signal<Local, Bit>,
    /// CRC including the sampled bit.
    crc_shifted: Signal<Local, Bits<6>>,
    /// Alarm, power failure, not valid, of both copies.
    bad: Signal<Local, Bits<3>>,
    /// High if the stored bits differ from their parity.
    is_upset: Signal<Local, Bit>,
    /// 1 if stored bits are checked against their parity.
    has_guards: Constant<Bit>,
    /// 1 if special bits come before the position.
    has_before: Constant<Bit>,
    /// 1 if special bits come after the position.
    has_after: Constant<Bit>,
    /// 1 if bits follow the last one that is shown.
    has_tail: Constant<Bit>,
    /// 1 if special bits are stored.
    has_stored: Constant<Bit>,
    /// 1 if a special bit is a parity bit.
    has_check: Constant<Bit>,
    /// 1 if special bits are a CRC.
    has_crc: Constant<Bit>,
    /// Number of special bits.
    count: Constant<Bits<6>>,
    /// Number of special bits after the position.
    after: Constant<Bits<6>>,
    /// Bits left of the copy at the last bit of the position.
    position_last: Constant<Bits<6>>,
    /// Number of bits that follow the last one that is shown.
    tail: Constant<Bits<6>>,
    /// Bits of `status` that are used.
    stored_mask: Constant<Bits<14>>,
    /// Highest bit of `status` that is used.
    first_mask: Constant<Bits<14>>,
    /// Bits of `status` that the result shows.
    shown_mask: Constant<Bits<8>>,
    /// Bits of `status` that are alarms.
    alarm_mask: Constant<Bits<14>>,
    /// Bits of `status` that are alarms at 0.
    alarm_low: Constant<Bits<14>>,
    /// Bits of `status` that are power failures.
    power_fail_mask: Constant<Bits<14>>,
    /// Bits of `status` that are power failures at 0.
    power_fail_low: Constant<Bits<14>>,
    /// Bits of `status` that mark the position not valid.
    not_valid_mask: Constant<Bits<14>>,
    /// Bits of `status` that mark it not valid at 0.
    not_valid_low: Constant<Bits<14>>,
    /// Bits left of the copy at the parity bit.
    parity_place: Constant<Bits<6>>,
    /// 1 if the parity is odd.
    parity_is_odd: Constant<Bit>,
    /// Bits left of the copy at the last bit of the CRC.
    crc_place: Constant<Bits<6>>,
    /// Generator of the CRC, without x^6.
    polynomial: Constant<Bits<6>>,
}

impl SpecialBits {
    /// A block for these special bits before and after the position.
    pub fn new(before: &Specials, after: &Specials, guards: bool) -> Self {
        let places = Places::new(before, after);
        let number = |number: usize| Constant::new((number as u64).into());
        let mask = |mask: u64| Constant::new(mask.into());
        let shown: u64 = places.shown.iter().map(|place| 1 << place).sum();
        let [alarm, alarm_low] = places.masks(cause::ALARM);
        let [power_fail, power_fail_low] = places.masks(cause::POWER_FAIL);
        let [not_valid, not_valid_low] = places.masks(cause::NOT_VALID);
        let (parity_place, parity_is_odd) = places.parity.unwrap_or_default();
        Self::from_parts(SpecialBitsParts {
            has_guards: Constant::new(guards),
            has_before: Constant::new(places.before > 0),
            has_after: Constant::new(places.after > 0),
            has_tail: Constant::new(places.tail > 0),
            has_stored: Constant::new(places.stored > 0),
            has_check: Constant::new(places.parity.is_some()),
            has_crc: Constant::new(places.crc.is_some()),
            count: number(places.before + places.after),
            after: number(places.after),
            position_last: number(places.after + 1),
            tail: number(places.tail),
            stored_mask: mask((1 << places.stored) - 1),
            first_mask: mask((1 << places.stored) >> 1),
            shown_mask: Constant::new((shown & ((1 << SHOWN_MAX) - 1)).into()),
            alarm_mask: mask(alarm),
            alarm_low: mask(alarm_low),
            power_fail_mask: mask(power_fail),
            power_fail_low: mask(power_fail_low),
            not_valid_mask: mask(not_valid),
            not_valid_low: mask(not_valid_low),
            parity_place: number(parity_place),
            parity_is_odd: Constant::new(parity_is_odd),
            crc_place: number(places.crc.unwrap_or(0)),
            polynomial: Constant::new(CRC_POLYNOMIAL.into()),
        })
    }
}

#[kernel]
impl Logic for SpecialBits {
    fn update(&mut self) {
        // Index of the bit in the copy.
        self.own_bits.next =
            self.position_bits.val() + bit_cast::<6, 1>(self.has_parity.val().into());
        self.all_bits.next = self.own_bits.val() + self.count.val();
        self.is_before.next =
            self.has_before.val() & (self.left.val() > (self.own_bits.val() + self.after.val()));
        self.is_after.next = self.has_after.val() & (self.left.val() <= self.after.val());
        self.is_position.next = !self.is_before.val() & !self.is_after.val();
        self.ends_position.next = self.left.val() == self.position_last.val();

        // Stores the shown bits and those between them.
        self.stores.next = self.has_stored.val()
            & self.takes.val()
            & !self.is_position.val()
            & (!self.has_tail.val() | (self.left.val() > self.tail.val()));
        self.falls_out.next = (self.status.q.val() & self.first_mask.val()).any();
        if self.stores.val() {
            self.status.d.next = ((self.status.q.val() << 1)
                | bit_cast::<14, 1>(self.level.val().into()))
                & self.stored_mask.val();
            self.sum.d.next = self.sum.q.val() ^ self.level.val() ^ self.falls_out.val();
        }
        self.is_upset.next = self.has_guards.val() & (self.status.q.val().xor() ^ self.sum.q.val());
        self.bad.next = self.bad_before.q.val()
            | bit_cast::<3, 1>(
                ((self.status.q.val() ^ self.alarm_low.val()) & self.alarm_mask.val())
                    .any()
                    .into(),
            )
            | (bit_cast::<3, 1>(
                ((self.status.q.val() ^ self.power_fail_low.val()) & self.power_fail_mask.val())
                    .any()
                    .into(),
            ) << 1)
            | (bit_cast::<3, 1>(
                ((self.status.q.val() ^ self.not_valid_low.val()) & self.not_valid_mask.val())
                    .any()
                    .into(),
            ) << 2);

        // Covers all bits as sent.
        self.crc_shifted.next = self.crc.q.val() << 1;
        if self.crc.q.val().get_bit(5) ^ self.level.val() {
            self.crc_shifted.next = (self.crc.q.val() << 1) ^ self.polynomial.val();
        }
        if self.takes.val() {
            self.ones.d.next = self.ones.q.val() ^ self.level.val();
            if self.has_check.val() & (self.left.val() == self.parity_place.val()) {
                self.is_odd.d.next = self.is_odd.q.val()
                    | (self.ones.q.val() ^ self.level.val() ^ self.parity_is_odd.val());
            }
            self.crc.d.next = self.crc_shifted.val();
            // Bits followed by their CRC give a CRC of 0.
            if self.has_crc.val() & (self.left.val() == self.crc_place.val()) {
                self.is_wrong.d.next = self.is_wrong.q.val() | self.crc_shifted.val().any();
            }
        }
        if self.repeats.val() {
            self.bad_before.d.next = self.bad.val();
        }
        if self.begins.val() | self.repeats.val() {
            self.ones.d.next = false;
            self.crc.d.next = 0.into();
        }
        if self.begins.val() {
            self.status.d.next = 0.into();
            self.sum.d.next = false;
            self.bad_before.d.next = 0.into();
            self.is_odd.d.next = false;
            self.is_wrong.d.next = false;
        }

        self.found.next = 0.into();
        if self.heard.val() {
            self.found.next = (bit_cast::<12, 1>(self.is_odd.q.val().into()) << 3)
                | (bit_cast::<12, 1>(self.is_upset.val().into()) << 5)
                | (bit_cast::<12, 3>(self.bad.val()) << 8)
                | (bit_cast::<12, 1>(self.is_wrong.q.val().into()) << 11);
        }
        self.shown.next = self.status.q.val().get_bits::<8>(0) & self.shown_mask.val();
    }
}

#[cfg(test)]
mod tests;
