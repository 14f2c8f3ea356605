//! Command shape: the parts of a frame, derived from the two triplets of its mode command.
//!
//! ```text
//! left   right        frame
//! 000    111          position with F1
//! 111    000          position with F1, F2, additional data
//! 010    101          F1 and 40 bits of test values
//! 010    010          24 bits sent, 24 bits received
//! other  complement   24 bits sent, 24 bits received
//! other  the same     position with F1, F2, additional data; supplement
//! ```
//!
//! Ref: HEIDENHAIN Technical Information 383942 (mode commands).

use crate::endat::ports::AnswerShapeOut;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Decoder of a mode command.
#[derive(LogicBlock, Block)]
pub struct CommandShape {
    /// Mode command.
    pub command: Signal<In, Bits<6>>,
    /// The command is a mode command that this design sends.
    pub is_known: Signal<Out, Bit>,
    /// The command is 000111 or 111000.
    pub is_position: Signal<Out, Bit>,
    /// Parts of an answer.
    #[bundle]
    pub answer: AnswerShapeOut,
    /// The answer is 40 bits of test values.
    pub has_test_values: Signal<Out, Bit>,
    /// The watchdog applies to the frame: not for 101010, 100011 and 011100, as in ArtInChip's ENDAT-IF.
    pub is_watched: Signal<Out, Bit>,
    has_all: Constant<Bit>,
    /// Upper three bits of the command.
    left: Signal<Local, Bits<3>>,
    /// Lower three bits of the command.
    right: Signal<Local, Bits<3>>,
    /// Both halves of the command are equal.
    is_same: Signal<Local, Bit>,
    /// The lower half is the complement of the upper one.
    is_complement: Signal<Local, Bit>,
    /// The upper half is 010.
    is_two: Signal<Local, Bit>,
}

impl CommandShape {
    /// A decoder of all commands, or of 000111 and 111000 only.
    pub fn new(has_all: bool) -> Self {
        Self::from_parts(CommandShapeParts {
            has_all: Constant::new(has_all),
        })
    }
}

#[kernel]
impl Logic for CommandShape {
    fn update(&mut self) {
        self.left.next = self.command.val().get_bits::<3>(3);
        self.right.next = self.command.val().get_bits::<3>(0);
        self.is_same.next = self.left.val() == self.right.val();
        self.is_complement.next = (self.left.val() ^ self.right.val()).all();
        self.is_position.next =
            self.is_complement.val() & (self.left.val().all() | !self.left.val().any());
        self.is_two.next = self.left.val() == 2;

        self.is_known.next = self.is_position.val();
        self.answer.has_f1.next = true;
        self.answer.has_f2.next = self.command.val().get_bit(5);
        self.answer.has_parameter.next = false;
        self.has_test_values.next = false;
        self.is_watched.next = true;
        self.answer.has_supplement.next = false;
        if self.has_all.val() {
            self.is_known.next = self.is_complement.val()
                | (self.is_same.val() & self.left.val().any() & !self.left.val().all());
            self.has_test_values.next = self.is_complement.val() & self.is_two.val();
            self.is_watched.next = !(self.is_complement.val()
                & ((self.left.val() == 3) | (self.left.val() == 4) | (self.left.val() == 5)));
            self.answer.has_supplement.next = self.is_same.val() & !self.is_two.val();
            self.answer.has_parameter.next =
                (self.is_complement.val() & !self.is_position.val() & !self.is_two.val())
                    | (self.is_same.val() & self.is_two.val());
            self.answer.has_f2.next = (self.is_position.val() & self.left.val().any())
                | (self.is_same.val() & !self.is_two.val());
            self.answer.has_f1.next =
                !((self.is_complement.val() & !self.is_position.val() & !self.is_two.val())
                    | (self.is_same.val() & self.is_two.val()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::ModeCommand;

    /// Ref: ArtInChip ENDAT-IF, watchdog.
    const UNWATCHED: [ModeCommand; 3] = [
        ModeCommand::ReceiveReset,
        ModeCommand::SendParameter,
        ModeCommand::ReceiveParameter,
    ];

    fn shape(code: u8, has_all: bool) -> CommandShape {
        let mut block = CommandShape::new(has_all);
        block.connect_all();
        block.command.next = u64::from(code).into();
        block.update_all();
        block.update_all();
        block
    }

    #[test]
    fn every_code_has_the_shape_of_its_command() {
        for code in 0..64 {
            let s = shape(code, true);
            let command = ModeCommand::from_code(code);
            assert_eq!(s.is_known.val(), command.is_some(), "{code:06b}");
            if let Some(c) = command {
                assert_eq!(s.answer.has_f1.val(), c.error_bits() > 0, "{c:?}");
                assert_eq!(s.answer.has_f2.val(), c.has_f2(), "{c:?}");
                assert_eq!(s.answer.has_parameter.val(), c.has_parameter(), "{c:?}");
                assert_eq!(s.answer.has_supplement.val(), c.has_supplement(), "{c:?}");
                let watched = !UNWATCHED.contains(&c);
                assert_eq!(s.is_watched.val(), watched, "{c:?}");
                let values = c == ModeCommand::SendTestValues;
                assert_eq!(s.has_test_values.val(), values, "{c:?}");
            }
        }
    }

    #[test]
    fn without_the_others_only_positions_are_known() {
        for code in 0..64 {
            let s = shape(code, false);
            let command = ModeCommand::from_code(code);
            let position = command.filter(|c| ModeCommand::POSITION.contains(c));
            assert_eq!(s.is_known.val(), position.is_some(), "{code:06b}");
            if let Some(c) = position {
                assert_eq!(s.answer.has_f2.val(), c.has_f2());
            }
        }
    }
}
