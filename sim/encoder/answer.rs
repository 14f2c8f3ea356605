//! The encoder's answer, bit by bit.

use super::{AnswerKind, Command, Defect, Drive, Encoder, Phase, Symbol};
use crate::{
    frame::{AnswerBits, Parameter, PositionAnswer},
    Time,
};

/// Width of the test values.
const TEST_VALUE_BITS: u32 = 40;

impl Encoder {
    /// The rising edge that launches the start bit.
    pub(super) fn start(&mut self, time: Time, edge: u32) {
        let Some(command) = self.work.command else {
            return;
        };
        self.settle(time);
        let mut bits = match self.log().reply {
            Some(fields) => self.parameter_bits(fields),
            None if command == Command::SendTestValues => self.test_value_bits(),
            None => self.position_bits(time, command.has_f2()),
        };
        let sent = u128::MAX >> (128 - bits.len);
        bits.word ^= sent
            & self.sum_defects(|d| match d {
                Defect::FlipBits(mask) => *mask,
                _ => 0,
            });
        let log = self.log();
        log.answer = bits;
        log.start_edge = Some(edge);
        log.start_time = time;
        if command.has_supplement() {
            self.expect_supplement();
        }
        self.next_answer_bit(time, 0);
    }

    fn crc_with_defects(&self, crc: u8) -> u8 {
        let xor = self.sum_defects(|d| match d {
            Defect::CrcXor(x) => (*x).into(),
            _ => 0,
        });
        crc ^ xor as u8
    }

    fn parameter_bits(&mut self, fields: Parameter) -> AnswerBits {
        let xor = self.sum_defects(|d| match d {
            Defect::EchoXor(x) => (*x).into(),
            _ => 0,
        });
        let fields = Parameter::from_word(fields.word() ^ xor as u32);
        let crc = self.crc_with_defects(fields.crc());
        let log = self.log();
        log.kind = AnswerKind::Parameter;
        log.reply = Some(fields);
        log.crc = crc;
        fields.bits_with_crc(crc)
    }

    fn test_value_bits(&mut self) -> AnswerBits {
        let answer = PositionAnswer {
            f1: self.errors(false).0,
            f2: None,
            position: self.config.values.test_values,
            position_bits: TEST_VALUE_BITS,
        };
        self.head_bits(AnswerKind::TestValues, answer)
    }

    fn position_bits(&mut self, time: Time, mut f2: bool) -> AnswerBits {
        let mut position_bits = self.config.position_bits;
        let with_infos = f2;
        for defect in &self.work.defects {
            match defect {
                Defect::WiderBy(n) => position_bits = position_bits.saturating_add_signed(*n),
                Defect::WithoutF2 => f2 = false,
                _ => {}
            }
        }
        let position = self.log().position;
        let errors = self.errors(f2);
        let answer = PositionAnswer {
            f1: errors.0,
            f2: errors.1,
            position,
            position_bits,
        };
        let mut bits = self.head_bits(AnswerKind::Position, answer);
        let log = self.log();
        log.has_f2 = f2;
        log.position_bits = position_bits;
        if with_infos {
            self.append_infos(time, position, &mut bits);
        }
        bits
    }

    fn head_bits(&mut self, kind: AnswerKind, answer: PositionAnswer) -> AnswerBits {
        let crc = self.crc_with_defects(answer.crc());
        let log = self.log();
        log.kind = kind;
        log.errors = (answer.f1, answer.f2);
        log.crc = crc;
        answer.bits_with_crc(crc)
    }

    /// F1 and F2, which have opposite polarity.
    fn errors(&self, f2: bool) -> (bool, Option<bool>) {
        let alarm = self.status.alarms != 0;
        let mut errors = (alarm, f2.then_some(!alarm));
        for defect in &self.work.defects {
            if let Defect::ErrorBits { f1, f2: second } = defect {
                errors = (*f1, f2.then_some(*second));
            }
        }
        errors
    }

    fn append_infos(&mut self, time: Time, position: u64, bits: &mut AnswerBits) {
        for info in self.infos(time, position) {
            let number = if info.code < 0x50 { 1 } else { 2 };
            let xor = self.sum_defects(|d| match d {
                Defect::InfoCrcXor { info, xor } if *info == number => (*xor).into(),
                _ => 0,
            });
            let crc = info.crc() ^ xor as u8;
            bits.append(&info.bits_with_crc(crc));
            self.log().infos.push((info, crc));
        }
    }

    pub(super) fn next_answer_bit(&mut self, time: Time, bit: u32) {
        let answer = self.log().answer;
        if bit < answer.len {
            self.launch(time, Drive::level(answer.get(bit)), Symbol::Bit(bit as u8));
            self.work.phase = Phase::Answer(bit + 1);
        } else {
            self.launch(time, Drive::High, Symbol::Tail);
            self.complete(time);
        }
    }
}
