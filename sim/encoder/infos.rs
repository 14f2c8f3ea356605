//! The additional data: selection and content.

use super::{memory::area, Encoder, EncoderConfig, Registers};
use crate::{frame::Info, Time, US};

/// The selections, which 0x4F and 0x5F end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Selection {
    /// MRS code 0x40 to 0x4E.
    pub first: Option<u8>,
    /// MRS code 0x50 to 0x5E.
    pub second: Option<u8>,
}

/// MRS codes that select additional data.
pub(super) fn is_info_code(mrs: u8) -> bool {
    matches!(mrs, 0x40..=0x5F)
}

impl Selection {
    /// Applies a selection, unless the encoder lacks those additional data.
    pub fn select(&mut self, mrs: u8, config: &EncoderConfig) -> Result<(), ()> {
        let (group, supported) = match mrs & 0xF0 {
            0x40 => (&mut self.first, config.plate.infos_1),
            _ => (&mut self.second, config.plate.infos_2),
        };
        let number = mrs & 0xF;
        if number == 0xF {
            *group = None;
        } else if number == 0 || supported >> number & 1 != 0 {
            *group = Some(mrs);
        } else {
            return Err(());
        }
        Ok(())
    }
}

/// Positions sent in three parts: latched when the first part is sent, so that the parts are consistent. The latch time of real
/// encoders is not published.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Parts {
    position_2: u64,
    asynchronous: u64,
}

impl Encoder {
    /// The selected additional data in the order of transmission: 2 before 1.
    pub(super) fn infos(&mut self, time: Time, position: u64) -> Vec<Info> {
        let selected = [self.selection.second, self.selection.first];
        let status = Info {
            warning: self.status.warnings != 0,
            reference: self.config.values.reference_done,
            busy: self.job.is_some(),
            ..Info::default()
        };
        let infos = selected.into_iter().flatten().map(|code| Info {
            code,
            content: self.content(code, time, position),
            ..status
        });
        infos.collect()
    }

    fn content(&mut self, code: u8, time: Time, position: u64) -> u16 {
        let values = &self.config.values;
        let width = u64::MAX >> (64 - self.config.position_bits);
        let third = |word: u64, n: u8| (word >> (16 * n)) as u16;
        let Registers { mrs, memory, test } = self.registers;
        let bytes = |high: u8, low: u8| u16::from_be_bytes([high, low]);
        let high = |word: u16| (word >> 8) as u8;
        match code {
            0x41 if self.memory.word(area::OPERATING_PARAMETERS, 3) == 0 => 0,
            0x41 => {
                let turn = (self.frames.count()).checked_rem(values.diagnostics.len() as u64);
                turn.map_or(0, |turn| values.diagnostics[turn as usize])
            }
            0x42..=0x44 => {
                if code == 0x42 {
                    let second = position.wrapping_add_signed(values.position_2_offset);
                    self.parts.position_2 = second & width;
                }
                third(self.parts.position_2, code - 0x42)
            }
            0x45 => bytes(memory.address, memory.data as u8),
            0x46 => bytes(memory.address, high(memory.data)),
            0x47 => bytes(mrs.0, mrs.1),
            0x48 => bytes(test.address, test.data as u8),
            0x49..=0x4B => third(values.test_values, code - 0x49),
            0x4C | 0x4D => values.temperatures[usize::from(code - 0x4C)],
            0x4E => values.sensors,
            0x51 => values.commutation,
            0x52 => values.acceleration,
            0x53 => bytes(high(values.commutation), high(values.acceleration)),
            0x54 => values.limits,
            0x55 => bytes(values.limits as u8, high(values.acceleration)),
            0x56..=0x58 => {
                if code == 0x56 {
                    let other = position.wrapping_add_signed(values.asynchronous_offset);
                    self.parts.asynchronous = other & width;
                }
                third(self.parts.asynchronous, code - 0x56)
            }
            0x59 => self.status.sources,
            0x5B => (time / US) as u16,
            _ => 0,
        }
    }
}
