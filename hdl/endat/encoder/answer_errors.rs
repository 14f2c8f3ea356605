//! Errors on command: makes something wrong with chosen frames of an encoder.
//!
//! ```text
//! arm      /\_____________________________________    loads skip_frames = 2, error_frames = 1
//! begins   ______/\________/\________/\________/\_
//! active   __________________________/~~~~~~~~~\__
//! ```
//!
//! Bits of an answer are counted from the start bit, which is number 0; the HIGH after the last bit of the CRC counts, too. The CRC fits
//! inverted error bits and another width. It does not fit a bit that `bit_error` changes.

use super::ports::EncoderErrorsIn;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Values of `bit_error`: what is wrong with the bit that `bit_number` selects.
pub mod bit_error {
    /// Nothing.
    pub const NONE: u64 = 0;
    /// The bit is inverted.
    pub const INVERT: u64 = 1;
    /// DATA is LOW from this bit to the end of the recovery time.
    pub const LOW: u64 = 2;
    /// DATA is HIGH from this bit to the end of the recovery time.
    pub const HIGH: u64 = 3;
    /// The driver is off from this bit to the end of the recovery time.
    pub const OFF: u64 = 4;
}

/// Chooses the frames with errors, and changes the levels of their answers.
#[derive(LogicBlock, Block)]
pub struct AnswerErrors {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset: no errors.
    pub reset: Signal<In, Bit>,
    /// Errors that the encoder makes.
    #[bundle]
    pub wanted: EncoderErrorsIn,
    /// Strobe: a frame begins.
    pub begins: Signal<In, Bit>,
    /// Strobe: a bit of the answer, or the HIGH after it, is launched.
    pub launches: Signal<In, Bit>,
    /// Level that a sound encoder launches.
    pub level: Signal<In, Bit>,
    /// With `begins`: this frame has the errors.
    pub applies: Signal<Out, Bit>,
    /// The frame under way has the errors.
    pub active: Signal<Out, Bit>,
    /// Level that is launched.
    pub wrong_level: Signal<Out, Bit>,
    /// Driver enable of this bit.
    pub drives: Signal<Out, Bit>,
    /// Frames before the first one with errors.
    skip: Reg<Bits<16>>,
    /// Frames with errors that are still to come.
    frames: Reg<Bits<16>>,
    /// High from the beginning of a frame with errors to the beginning of the next frame.
    is_active: Reg<Bit>,
    /// Number of the next bit.
    number: Reg<Bits<7>>,
    /// High from the bit on from which DATA keeps a level; cleared when a frame begins.
    holds: Reg<Bit>,
    /// High if a frame that begins has the errors.
    is_next: Signal<Local, Bit>,
    /// High for the bit that `bit_number` selects.
    is_chosen: Signal<Local, Bit>,
    /// High if DATA keeps a level.
    holds_now: Signal<Local, Bit>,
    invert: Constant<Bits<3>>,
    high: Constant<Bits<3>>,
    off: Constant<Bits<3>>,
}

impl Default for AnswerErrors {
    fn default() -> Self {
        Self::from_parts(AnswerErrorsParts {
            invert: Constant::new(bit_error::INVERT.into()),
            high: Constant::new(bit_error::HIGH.into()),
            off: Constant::new(bit_error::OFF.into()),
        })
    }
}

#[kernel]
impl Logic for AnswerErrors {
    fn update(&mut self) {
        self.is_next.next = !self.skip.q.val().any() & self.frames.q.val().any();
        if self.launches.val() {
            self.number.d.next = self.number.q.val() + 1;
        }
        self.is_chosen.next =
            self.is_active.q.val() & (self.number.q.val() == self.wanted.bit_number.val());
        self.holds_now.next = self.holds.q.val()
            | (self.is_chosen.val() & self.wanted.bit_error.val().get_bits::<2>(1).any());
        if self.launches.val() {
            self.holds.d.next = self.holds_now.val();
        }
        self.wrong_level.next = self.level.val()
            ^ (self.is_chosen.val() & (self.wanted.bit_error.val() == self.invert.val()));
        self.drives.next = true;
        if self.holds_now.val() {
            self.wrong_level.next = self.wanted.bit_error.val() == self.high.val();
            self.drives.next = self.wanted.bit_error.val() != self.off.val();
        }
        if self.begins.val() {
            self.is_active.d.next = self.is_next.val();
            self.number.d.next = 0.into();
            self.holds.d.next = false;
            if self.skip.q.val().any() {
                self.skip.d.next = self.skip.q.val() - 1;
            } else if self.frames.q.val().any() {
                self.frames.d.next = self.frames.q.val() - 1;
            }
        }
        if self.wanted.arm.val() {
            self.skip.d.next = self.wanted.skip_frames.val();
            self.frames.d.next = self.wanted.error_frames.val();
        }
        self.applies.next = self.is_next.val();
        self.active.next = self.is_active.q.val();
    }
}
