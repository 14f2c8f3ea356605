//! Request bits: the bit of a field to send, or to expect in the reply.

use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// One data bit of the control, address, data or CRC field.
#[derive(LogicBlock, Block)]
pub struct RequestBits {
    /// Request ID.
    pub request_id: Signal<In, Bits<4>>,
    /// EEPROM address.
    pub address: Signal<In, Bits<7>>,
    /// EEPROM data.
    pub data: Signal<In, Bits<8>>,
    /// The next bit of the CRC.
    pub crc_bit: Signal<In, Bit>,
    /// Bit of the field, 0 = first on the line.
    pub index: Signal<In, Bits<3>>,
    /// The field is the control field.
    pub is_control: Signal<In, Bit>,
    /// The field is the EEPROM address.
    pub is_address: Signal<In, Bit>,
    /// The field is the CRC; otherwise it is the data.
    pub is_crc: Signal<In, Bit>,
    /// The bit.
    pub bit_out: Signal<Out, Bit>,
    /// Parity of the request ID.
    parity: Signal<Local, Bit>,
    /// Control field: sync code, ID and parity.
    control_byte: Signal<Local, Bits<8>>,
    /// Address field.
    address_byte: Signal<Local, Bits<8>>,
}

#[kernel]
impl Logic for RequestBits {
    fn update(&mut self) {
        self.parity.next = self.request_id.val().get_bit(0)
            ^ self.request_id.val().get_bit(1)
            ^ self.request_id.val().get_bit(2)
            ^ self.request_id.val().get_bit(3);
        self.control_byte.next = (bit_cast::<8, 4>(self.request_id.val()) << 3)
            | (bit_cast::<8, 1>(self.parity.val().into()) << 7)
            | 2;
        self.address_byte.next = bit_cast::<8, 7>(self.address.val());
        self.bit_out.next = self.data.val().get_bit(self.index.val().index());
        if self.is_control.val() {
            self.bit_out.next = self.control_byte.val().get_bit(self.index.val().index());
        }
        if self.is_address.val() {
            self.bit_out.next = self.address_byte.val().get_bit(self.index.val().index());
        }
        if self.is_crc.val() {
            self.bit_out.next = self.crc_bit.val();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::protocol::control;
    use super::*;
    use crate::testing::settle;

    #[test]
    fn control_bytes_are_those_of_the_protocol() {
        let mut uut = RequestBits::default();
        uut.connect_all();
        uut.is_control.next = true;
        for id in 0..16u8 {
            let mut byte = 0;
            for index in 0..8u64 {
                uut.request_id.next = u64::from(id).into();
                uut.index.next = index.into();
                settle(&mut uut);
                byte |= u8::from(uut.bit_out.val()) << index;
            }
            assert_eq!(byte, control(id));
        }
    }
}
