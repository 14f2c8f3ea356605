//! The encoder's log: one record for each frame.

use super::ErrorSource;
use crate::{
    frame::{
        crc5, info_field, parameter_field, position_field, AnswerBits, Field, Info, Parameter,
        PositionAnswer, CRC_BITS,
    },
    Time, US,
};

/// End of a frame, seen from the encoder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrameEnd {
    /// The frame is still running.
    #[default]
    Running,
    /// All bits were clocked out and the recovery time was respected.
    Complete,
    /// The clock stopped HIGH before the answer was complete.
    Stopped,
    /// The clock continued after the answer, or returned within the recovery time.
    Overrun,
    /// The encoder lost its supply or its plug.
    Lost,
}

/// Content of an answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AnswerKind {
    /// No answer (yet).
    #[default]
    None,
    /// F1, perhaps F2, position, perhaps additional data.
    Position,
    /// 8 and 16 bits.
    Parameter,
    /// F1 and 40 bits.
    TestValues,
}

/// Supplement of the receiver after an answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Supplement {
    /// LOW bits before the start bit.
    pub zeros: u32,
    /// MRS code, address or port, and its data.
    pub fields: Parameter,
    /// Block address, after the MRS code 0xBF only.
    pub block: Option<u8>,
}

/// One frame as the encoder saw it. Edges are counted and timed at the encoder.
#[derive(Clone, Debug, Default)]
pub struct FrameLog {
    /// Number of the frame, 0 = first.
    pub index: u64,
    /// Time of the first falling clock edge, and so of the position.
    pub first_fall: Time,
    /// First rising clock edge.
    pub first_rise: Time,
    /// Last rising clock edge so far.
    pub last_rise: Time,
    /// Rising clock edges so far.
    pub rising_edges: u32,
    /// Mean clock period over the mode command.
    pub period: Time,
    /// The mode command.
    pub command: Option<u8>,
    /// The latched position.
    pub position: u64,
    /// Number of the rising edge that launched the start bit (`s`).
    pub start_edge: Option<u32>,
    /// Time when the start bit was launched.
    pub start_time: Time,
    /// The answer, with its defects.
    pub answer: AnswerBits,
    /// True if the answer has an F2.
    pub has_f2: bool,
    /// Width of the position in the answer.
    pub position_bits: u32,
    /// Latched in continuous clock mode: without a mode command; edges count from `first_fall`.
    pub continuous: bool,
    /// Parameter that the receiver sent with an EnDat 2.1 command.
    pub parameter: Option<Parameter>,
    /// Content of the answer.
    pub kind: AnswerKind,
    /// The error bits that were sent.
    pub errors: (bool, Option<bool>),
    /// MRS code, address or port and data that were answered.
    pub reply: Option<Parameter>,
    /// CRC of position, test values or parameter, as sent.
    pub crc: u8,
    /// Additional data in the order sent (2 before 1), each with its CRC as sent.
    pub infos: Vec<(Info, u8)>,
    /// Supplement of the receiver after the answer.
    pub supplement: Option<Supplement>,
    /// Rising edges of the supplement, minus the one that would end a frame without it.
    pub supplement_edges: u32,
    /// Reason of a refusal.
    pub refused: Option<ErrorSource>,
    /// DATA fell at the end of the recovery time.
    pub data_fall: Option<Time>,
    /// End of the frame.
    pub end: FrameEnd,
}

/// Clock period that measures the delay: 200 kHz, with some tolerance.
const SLOW: Time = 49 * US / 10;

impl FrameLog {
    pub(super) fn new(index: u64, time: Time, position: u64, position_bits: u32) -> Self {
        Self {
            index,
            first_fall: time,
            first_rise: time,
            last_rise: time,
            position,
            position_bits,
            ..Self::default()
        }
    }

    /// Rising edges that this frame must have: `s` + answer bits + supplement; `None` if the answer never began.
    pub fn expected_rising_edges(&self) -> Option<u32> {
        self.start_edge
            .map(|s| s + self.answer.len + self.supplement_edges)
    }

    /// True if it has exactly its pulses.
    pub fn is_whole(&self) -> bool {
        self.end == FrameEnd::Complete && self.expected_rising_edges() == Some(self.rising_edges)
    }

    /// True if it measured the delay for `position`, a later frame of the same trigger: at a slower clock, unless that frame is slow itself.
    pub fn measures_for(&self, position: &Self) -> bool {
        let is_slower = self.period > position.period || position.period >= SLOW;
        self.index < position.index && is_slower
    }

    /// Length of the first part of the answer, without additional data.
    pub fn head_len(&self) -> u32 {
        self.answer.len - Info::BITS * self.infos.len() as u32
    }

    /// Field of answer bit `index`.
    pub fn field(&self, index: u32) -> Field {
        let head = self.head_len();
        match self.kind {
            AnswerKind::None => Field::None,
            AnswerKind::Parameter => parameter_field(index),
            AnswerKind::TestValues => position_field(index, false, head - 2 - CRC_BITS),
            AnswerKind::Position if index < head || index >= self.answer.len => {
                position_field(index.min(head), self.has_f2, self.position_bits)
            }
            AnswerKind::Position => info_field((index - head) % Info::BITS),
        }
    }

    /// True if the answer equals, bit by bit, that of a good encoder with this position and these additional data.
    pub fn is_true_answer(&self, position_bits: u32, f2: bool) -> bool {
        self.answer == self.true_position((false, f2.then_some(true)), position_bits)
    }

    fn true_position(&self, (f1, f2): (bool, Option<bool>), position_bits: u32) -> AnswerBits {
        let head = PositionAnswer {
            f1,
            f2,
            position: self.position,
            position_bits,
        };
        let mut bits = head.bits();
        for (info, _) in &self.infos {
            bits.append(&info.bits_with_crc(info.crc()));
        }
        bits
    }

    /// True if answer bit `index` differs from its position, error bits, parameter or additional data. The
    /// correct test values are not recorded.
    pub fn is_wrong_bit(&self, index: u32) -> bool {
        let good = match (self.kind, self.reply) {
            (AnswerKind::Position, _) => self.true_position(self.errors, self.position_bits),
            (AnswerKind::Parameter, Some(reply)) => reply.bits_with_crc(reply.crc()),
            _ => return false,
        };
        index < self.answer.len && good.get(index) != self.answer.get(index)
    }

    /// The expected CRC of the part of the answer with bit `index`, and the received one.
    pub fn crcs(&self, index: u32) -> (u8, u8) {
        let head = self.head_len();
        let (first, len) = match index.checked_sub(head) {
            None => (0, head),
            Some(beyond) => (head + beyond / Info::BITS * Info::BITS, Info::BITS),
        };
        let covered = (first + 1..first + len - CRC_BITS).map(|i| self.answer.get(i));
        let came = (first + len - CRC_BITS..first + len).map(|i| self.answer.get(i));
        let came = came.fold(0, |crc, bit| crc << 1 | u8::from(bit));
        (crc5(covered), came)
    }

    /// True if every CRC of the answer matches its bits.
    pub fn all_crcs_fit(&self) -> bool {
        let parts = (0..=self.infos.len() as u32).map(|n| match n {
            0 => 0,
            n => self.head_len() + (n - 1) * Info::BITS,
        });
        self.kind == AnswerKind::None
            || parts
                .map(|first| self.crcs(first))
                .all(|(fits, came)| fits == came)
    }
}
