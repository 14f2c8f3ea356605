//! Supplement of the receiver after an EnDat 2.2 position: CLOCK parked LOW, LOW bits, a start bit, 8 and 16 bits, two more pulses.

use super::{memory::area, Command, Drive, Encoder, Phase, Supplement, Symbol, Violation};
use crate::{frame::Parameter, Time};

/// Rising edges of a supplement, without its LOW bits and the bits of a block address: one before the first bit, start bit, 24 bits,
/// two to the end.
const EDGES: u32 = 28;
const FIELD_BITS: u32 = 24;
const BLOCK_BITS: u32 = 8;

/// Progress of a supplement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Progress {
    zeros: u32,
    started: bool,
    bits: u32,
    /// Total number of bits.
    length: u32,
    /// Rising edges since the last bit.
    after: u32,
}

impl Encoder {
    /// Prepares for a supplement after the answer, with the fewest LOW bits.
    pub(super) fn expect_supplement(&mut self) {
        let edges = self.config.supplement_zeros + EDGES;
        self.log().supplement_edges = edges - 1;
    }

    /// CLOCK falls after answer bit `next - 1`.
    pub(super) fn park(&mut self, time: Time, next: u32) {
        let supplement = self.work.command.is_some_and(Command::has_supplement);
        if supplement && next == self.log().answer.len {
            let release = time + self.config.park_release;
            self.work.phase = Phase::Park { release };
            self.emit(release, Drive::Released, Symbol::Listening);
        }
    }

    /// CLOCK rises after having been parked for `pause`.
    pub(super) fn begin_supplement(&mut self, time: Time, pause: Time, release: Time) {
        if time < release {
            self.violate(time, Violation::EarlySupplement { pause });
            self.emit(time, Drive::Released, Symbol::Listening);
        }
        self.work.phase = Phase::Supplement;
    }

    /// True before the start bit of the supplement.
    pub(super) fn awaits_supplement(&self) -> bool {
        self.work.phase == Phase::Supplement && !self.work.supplement.started
    }

    pub(super) fn rise_in_supplement(&mut self, time: Time, edge: u32, data: Drive) {
        let progress = self.work.supplement;
        if !progress.started {
            self.look_for_start_bit(time, edge, data);
        } else if progress.bits < progress.length {
            self.take_supplement_bit(time, edge, data);
        } else {
            self.work.supplement.after += 1;
            match self.work.supplement.after {
                1 => self.launch(time, Drive::High, Symbol::Tail),
                _ => self.end_supplement(time),
            }
        }
    }

    fn look_for_start_bit(&mut self, time: Time, edge: u32, data: Drive) {
        self.work.shift = 0;
        self.shift_in(time, edge, data);
        if self.work.shift == 0 {
            self.work.supplement.zeros += 1;
            return;
        }
        self.work.shift = 0;
        self.work.supplement.started = true;
        self.work.supplement.length = FIELD_BITS;
        let zeros = self.work.supplement.zeros;
        if zeros < self.config.supplement_zeros {
            self.violate(time, Violation::SupplementZeros { seen: zeros });
        }
        self.log().supplement_edges = zeros + EDGES - 1;
    }

    fn take_supplement_bit(&mut self, time: Time, edge: u32, data: Drive) {
        self.shift_in(time, edge, data);
        let progress = &mut self.work.supplement;
        progress.bits += 1;
        let (shift, zeros) = (self.work.shift, progress.zeros);
        // The MRS code decides whether a block address follows (TI).
        let selects = self.work.command == Some(Command::PositionSelectMemory);
        if progress.bits == 8 && selects && shift as u8 == area::SECTION_2 {
            progress.length += BLOCK_BITS;
            self.log().supplement_edges += BLOCK_BITS;
            return;
        }
        if progress.bits < progress.length {
            return;
        }
        let block = progress.length - FIELD_BITS;
        self.log().supplement = Some(Supplement {
            zeros,
            fields: Parameter::from_word((shift >> block) as u32),
            block: (block > 0).then_some(shift as u8),
        });
    }

    /// The receiver releases DATA at this edge, and the encoder drives it.
    pub(super) fn fall_in_supplement(&mut self, time: Time) {
        let progress = self.work.supplement;
        let all = progress.started && progress.bits == progress.length;
        if all && progress.after == 0 {
            self.launch(time, Drive::Low, Symbol::Lead);
        }
    }

    fn end_supplement(&mut self, time: Time) {
        let supplement = self.log().supplement.unwrap_or_default();
        if let Some(command) = self.work.command {
            let block = supplement.block.unwrap_or(0);
            self.take_supplement(time, command, supplement.fields, block);
        }
        self.complete(time);
    }
}
