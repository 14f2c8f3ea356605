//! Field order: the field under way, and the next one.
//!
//! ```text
//! sent    Control -> end                  6: -> Address -> Data -> Crc    D: -> Address -> Crc
//! reply   Control -> Status -> Single 0..2 -> Identity -> Multi 0..2 -> Alarm -> Crc      ID 3
//!                           \-> ...        \-> Crc                                        0, 7, 8, C
//!                           \-> Multi 0..2 -> Crc                                         1
//!                           \-> Identity -> Crc                                           2
//!         Control -> Address -> Data -> Crc                                               6, D
//! ```

use super::ports::ReplyPartsOut;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block, States};
use rust_hdl::prelude::*;

/// The field under way.
#[derive(Copy, Clone, PartialEq, Debug, LogicState, States)]
pub enum FieldKind {
    /// Control field.
    Control,
    /// Status field.
    Status,
    /// Single-turn position, bits 7..0.
    Single0,
    /// Single-turn position, bits 15..8.
    Single1,
    /// Single-turn position, bits 23..16.
    Single2,
    /// Kind of encoder.
    Identity,
    /// Multi-turn position, bits 7..0.
    Multi0,
    /// Multi-turn position, bits 15..8.
    Multi1,
    /// Multi-turn position, bits 23..16.
    Multi2,
    /// Alarms.
    Alarm,
    /// EEPROM address.
    Address,
    /// EEPROM data.
    Data,
    /// CRC.
    Crc,
}

/// Field under way.
#[derive(LogicBlock, Block)]
pub struct FieldOrder {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Request ID.
    pub request_id: Signal<In, Bits<4>>,
    /// The fields belong to the request.
    pub sending: Signal<In, Bit>,
    /// Strobe: begin with the control field.
    pub first: Signal<In, Bit>,
    /// Strobe: continue with the next field.
    pub step: Signal<In, Bit>,
    /// The request ID is known.
    pub is_known: Signal<Out, Bit>,
    /// The last field is under way.
    pub is_last: Signal<Out, Bit>,
    /// The field does not belong to a reply to the request.
    pub is_foreign: Signal<Out, Bit>,
    /// The field is the control field.
    pub is_control: Signal<Out, Bit>,
    /// The field is the status field.
    pub is_status: Signal<Out, Bit>,
    /// The field belongs to the single-turn position.
    pub is_single: Signal<Out, Bit>,
    /// The field is the kind of encoder.
    pub is_identity: Signal<Out, Bit>,
    /// The field belongs to the multi-turn position.
    pub is_multi: Signal<Out, Bit>,
    /// The field is the alarm field.
    pub is_alarm: Signal<Out, Bit>,
    /// The field is an EEPROM address.
    pub is_address: Signal<Out, Bit>,
    /// The field is EEPROM data.
    pub is_data: Signal<Out, Bit>,
    /// The field is the CRC.
    pub is_crc: Signal<Out, Bit>,
    /// Parts in the reply to a request.
    #[bundle]
    pub parts: ReplyPartsOut,
    /// Field under way.
    kind: Reg<FieldKind>,
    /// High if the request writes to the EEPROM.
    is_write: Signal<Local, Bit>,
    /// High if the reply has all fields of position, kind of encoder and alarms.
    is_everything: Signal<Local, Bit>,
    /// High if the reply has the multi-turn position only.
    is_turns: Signal<Local, Bit>,
    /// High if the reply has the kind of encoder only.
    is_kind: Signal<Local, Bit>,
    /// High if the request goes to the EEPROM.
    memory: Signal<Local, Bit>,
    /// High if another field of an EEPROM request follows this one.
    is_sent: Signal<Local, Bit>,
    /// High if the reply has a single-turn position.
    with_single: Signal<Local, Bit>,
    /// High if the field belongs to the single-turn position.
    is_single_now: Signal<Local, Bit>,
    /// High if the field belongs to the multi-turn position.
    is_multi_now: Signal<Local, Bit>,
}

#[kernel]
impl Logic for FieldOrder {
    fn update(&mut self) {
        self.is_known.next = true;
        self.is_write.next = false;
        self.memory.next = false;
        self.is_everything.next = false;
        self.is_turns.next = false;
        self.is_kind.next = false;
        self.with_single.next = true;
        match self.request_id.val().index() {
            0 => {}
            1 => {
                self.is_turns.next = true;
                self.with_single.next = false;
            }
            2 => {
                self.is_kind.next = true;
                self.with_single.next = false;
            }
            3 => {
                self.is_everything.next = true;
            }
            6 => {
                self.is_write.next = true;
                self.memory.next = true;
                self.with_single.next = false;
            }
            7 => {}
            8 => {}
            12 => {}
            13 => {
                self.memory.next = true;
                self.with_single.next = false;
            }
            _ => {
                self.is_known.next = false;
            }
        }
        self.parts.has_single.next = self.with_single.val();
        self.parts.is_memory.next = self.memory.val();
        self.parts.has_multi.next = self.is_turns.val() | self.is_everything.val();
        self.parts.has_identity.next = self.is_kind.val() | self.is_everything.val();
        self.parts.has_alarm.next = self.is_everything.val();

        self.is_control.next = self.kind.q.val() == FieldKind::Control;
        self.is_status.next = self.kind.q.val() == FieldKind::Status;
        self.is_single_now.next = (self.kind.q.val() == FieldKind::Single0)
            | (self.kind.q.val() == FieldKind::Single1)
            | (self.kind.q.val() == FieldKind::Single2);
        self.is_identity.next = self.kind.q.val() == FieldKind::Identity;
        self.is_multi_now.next = (self.kind.q.val() == FieldKind::Multi0)
            | (self.kind.q.val() == FieldKind::Multi1)
            | (self.kind.q.val() == FieldKind::Multi2);
        self.is_single.next = self.is_single_now.val();
        self.is_multi.next = self.is_multi_now.val();
        self.is_alarm.next = self.kind.q.val() == FieldKind::Alarm;
        self.is_address.next = self.kind.q.val() == FieldKind::Address;
        self.is_data.next = self.kind.q.val() == FieldKind::Data;
        self.is_crc.next = self.kind.q.val() == FieldKind::Crc;
        // Any other field ends a request.
        self.is_sent.next = self.memory.val()
            & ((self.kind.q.val() == FieldKind::Control)
                | (self.kind.q.val() == FieldKind::Address)
                | (self.kind.q.val() == FieldKind::Data));
        self.is_last.next =
            (self.kind.q.val() == FieldKind::Crc) | (self.sending.val() & !self.is_sent.val());
        // Without this check a field could pass for another one, with a good CRC.
        self.is_foreign.next = (self.is_single_now.val() & !self.with_single.val())
            | (self.is_multi_now.val() & !self.is_turns.val() & !self.is_everything.val())
            | ((self.kind.q.val() == FieldKind::Identity)
                & !self.is_kind.val()
                & !self.is_everything.val())
            | ((self.kind.q.val() == FieldKind::Alarm) & !self.is_everything.val())
            | (((self.kind.q.val() == FieldKind::Address)
                | (self.kind.q.val() == FieldKind::Data))
                & !self.memory.val());

        if self.step.val() {
            match self.kind.q.val() {
                FieldKind::Control => {
                    self.kind.d.next = FieldKind::Status;
                    if self.memory.val() {
                        self.kind.d.next = FieldKind::Address;
                    }
                }
                FieldKind::Status => {
                    self.kind.d.next = FieldKind::Single0;
                    if self.is_turns.val() {
                        self.kind.d.next = FieldKind::Multi0;
                    }
                    if self.is_kind.val() {
                        self.kind.d.next = FieldKind::Identity;
                    }
                }
                FieldKind::Single0 => {
                    self.kind.d.next = FieldKind::Single1;
                }
                FieldKind::Single1 => {
                    self.kind.d.next = FieldKind::Single2;
                }
                FieldKind::Single2 => {
                    self.kind.d.next = FieldKind::Crc;
                    if self.is_everything.val() {
                        self.kind.d.next = FieldKind::Identity;
                    }
                }
                FieldKind::Identity => {
                    self.kind.d.next = FieldKind::Crc;
                    if self.is_everything.val() {
                        self.kind.d.next = FieldKind::Multi0;
                    }
                }
                FieldKind::Multi0 => {
                    self.kind.d.next = FieldKind::Multi1;
                }
                FieldKind::Multi1 => {
                    self.kind.d.next = FieldKind::Multi2;
                }
                FieldKind::Multi2 => {
                    self.kind.d.next = FieldKind::Crc;
                    if self.is_everything.val() {
                        self.kind.d.next = FieldKind::Alarm;
                    }
                }
                FieldKind::Address => {
                    self.kind.d.next = FieldKind::Data;
                    if self.sending.val() & !self.is_write.val() {
                        self.kind.d.next = FieldKind::Crc;
                    }
                }
                // An invalid code ends the frame.
                _ => {
                    self.kind.d.next = FieldKind::Crc;
                }
            }
        }
        if self.first.val() {
            self.kind.d.next = FieldKind::Control;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::protocol::{Content, Request};
    use super::*;
    use crate::testing::{settle, tick};

    fn content(uut: &FieldOrder) -> Content {
        let is = [
            (uut.is_control.val(), Content::Control),
            (uut.is_status.val(), Content::Status),
            (uut.is_single.val(), Content::SingleTurn),
            (uut.is_identity.val(), Content::EncoderId),
            (uut.is_multi.val(), Content::MultiTurn),
            (uut.is_alarm.val(), Content::Alarm),
            (uut.is_address.val(), Content::Address),
            (uut.is_data.val(), Content::Data),
            (uut.is_crc.val(), Content::Crc),
        ];
        let found: Vec<_> = is.iter().filter(|(set, _)| *set).collect();
        assert_eq!(found.len(), 1);
        found[0].1
    }

    #[test]
    fn fields_come_in_the_order_of_the_protocol() {
        let mut uut = FieldOrder::default();
        uut.connect_all();
        let step = |uut: &mut FieldOrder| tick(uut, |u, level| u.clock.next = level.into());
        for id in 0..16u8 {
            let request = Request::from_id(id);
            uut.request_id.next = u64::from(id).into();
            settle(&mut uut);
            assert_eq!(uut.is_known.val(), request.is_some(), "{id}");
            let Some(request) = request else { continue };
            for sending in [true, false] {
                let fields = if sending {
                    request.sent()
                } else {
                    request.reply()
                };
                uut.sending.next = sending;
                uut.first.next = true;
                step(&mut uut);
                uut.first.next = false;
                uut.step.next = true;
                for (index, field) in fields.iter().enumerate() {
                    settle(&mut uut);
                    assert_eq!(content(&uut), *field, "{id} {index}");
                    assert_eq!(uut.is_last.val(), index + 1 == fields.len(), "{id} {index}");
                    step(&mut uut);
                }
                uut.step.next = false;
            }
        }
    }
}
