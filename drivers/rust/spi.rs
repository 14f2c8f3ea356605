//! A card on SPI, with the check sums of the frame.

use crate::error::Error;
use crate::frame::{crc16, CRC16_START};
use crate::link::Link;
use crate::map::word;
use crate::result::MOMENT_WORDS;
use embedded_hal::spi::SpiDevice;
use endat_regs::WORD_BYTES;

const WRITE: u8 = 2;
const READ: u8 = 3;
/// First byte of an answer: the last write was good, or was not.
const GOOD: u8 = 0xA0;
const BAD_WRITE: u8 = 0xA2;
/// Bytes of command, address and number.
const HEAD_BYTES: usize = 4;
/// Offset of the first word in an answer.
const ANSWER_AT: usize = 5;
const CRC_BYTES: usize = 2;
/// Inverts a check sum, so that it differs from the right one in more bits than a disturbance.
const ALL_WRONG: u16 = 0xFFFF;
const BYTES: usize = ANSWER_AT + WORD_BYTES as usize * MOMENT_WORDS + CRC_BYTES;

/// A card on SPI: mode 0, most significant bit first, at most an eighth of the system clock. Each frame has a check sum; a disturbed
/// frame is sent again.
#[derive(Debug)]
pub struct Spi<S> {
    device: S,
    /// Largest number of transmissions of a frame; 0 counts as 1.
    pub tries: u32,
    /// `false`: a write takes four frames and is confirmed; a disturbed one is sent again, so that a trigger may
    /// occur twice. `true`: a write is one frame without confirmation.
    pub unconfirmed: bool,
    /// Number of repeated frames, for diagnosis.
    pub disturbed: u32,
}

impl<S: SpiDevice> Spi<S> {
    /// The card on this device; a frame is sent up to three times.
    pub const fn new(device: S) -> Self {
        Self {
            device,
            tries: 3,
            unconfirmed: false,
            disturbed: 0,
        }
    }

    /// Returns the device.
    pub fn release(self) -> S {
        self.device
    }

    /// Reads words once; returns the first byte of the answer.
    fn read_once(&mut self, word_address: u32, words: &mut [u32]) -> Result<u8, Error<S::Error>> {
        let count = u8::try_from(words.len()).ok().filter(|count| *count > 0);
        let address = u16::try_from(word_address).ok();
        let (Some(count), Some(address)) = (count, address) else {
            return Err(Error::Argument);
        };
        let [upper, lower] = address.to_be_bytes();
        let head = [READ, upper, lower, count];
        let crc_at = ANSWER_AT + WORD_BYTES as usize * words.len();
        let mut bytes = [0; BYTES];
        let frame = bytes.get_mut(..crc_at + CRC_BYTES).ok_or(Error::Argument)?;
        frame[..HEAD_BYTES].copy_from_slice(&head);
        self.device.transfer_in_place(frame).map_err(Error::Link)?;
        let (answer, crc) = frame.split_at(crc_at);
        let sum = crc16(crc16(CRC16_START, &head), &answer[ANSWER_AT..]);
        if crc != sum.to_be_bytes() {
            // Without a card, or in a wrong mode, the head is invalid, too.
            return Err(match answer[0] {
                GOOD | BAD_WRITE => Error::CheckSum,
                _ => Error::NoCard,
            });
        }
        let own = answer[ANSWER_AT..].chunks_exact(WORD_BYTES as usize);
        for (word, bytes) in words.iter_mut().zip(own) {
            *word = bytes
                .iter()
                .fold(0, |word, byte| word << 8 | u32::from(*byte));
        }
        Ok(answer[0])
    }

    fn read_words(&mut self, word_address: u32, words: &mut [u32]) -> Result<u8, Error<S::Error>> {
        self.tried(|spi| spi.read_once(word_address, words))
    }

    /// Retries disturbed frames.
    fn tried<T>(
        &mut self,
        mut once: impl FnMut(&mut Self) -> Result<T, Error<S::Error>>,
    ) -> Result<T, Error<S::Error>> {
        let mut tries = self.tries.max(1);
        loop {
            let became = once(self);
            if !matches!(became, Err(Error::CheckSum | Error::NoCard)) {
                return became;
            }
            self.disturbed = self.disturbed.wrapping_add(1);
            tries -= 1;
            if tries == 0 {
                return became;
            }
        }
    }

    /// Result of the last write, from the head of a good read; read twice, because the head has no check sum.
    fn last_write(&mut self) -> Result<(), Error<S::Error>> {
        for _ in 0..=self.tries {
            let mut id = [0];
            let first = self.read_words(word!(CARD.id), &mut id)?;
            let second = self.read_words(word!(CARD.id), &mut id)?;
            match (first, second) {
                (GOOD, GOOD) => return Ok(()),
                (BAD_WRITE, BAD_WRITE) => return Err(Error::CheckSum),
                (first, second) if first == second => return Err(Error::NoCard),
                _ => {}
            }
        }
        Err(Error::NoCard)
    }

    /// One write of a word, with its check sum or with a wrong one; returns the result of the previous write.
    fn write_once(
        &mut self,
        word_address: u32,
        value: u32,
        wrong: u16,
    ) -> Result<u8, Error<S::Error>> {
        let [upper, lower] = u16::try_from(word_address)
            .map_err(|_| Error::Argument)?
            .to_be_bytes();
        let [a, b, c, d] = value.to_be_bytes();
        let mut frame = [WRITE, upper, lower, 1, a, b, c, d, 0, 0];
        let crc = crc16(CRC16_START, &frame[..8]) ^ wrong;
        frame[8..].copy_from_slice(&crc.to_be_bytes());
        self.device
            .transfer_in_place(&mut frame)
            .map_err(Error::Link)?;
        Ok(frame[0])
    }
}

impl<S: SpiDevice> Link for Spi<S> {
    type Error = S::Error;

    fn read(&mut self, word_address: u32) -> Result<u32, Error<S::Error>> {
        let mut word = [0];
        self.read_words(word_address, &mut word)?;
        Ok(word[0])
    }

    /// The card does not detect a write whose command byte was disturbed. So a frame with a wrong check sum goes first,
    /// which writes nothing: the card reports "bad" until the good write has arrived.
    fn write(&mut self, word_address: u32, value: u32) -> Result<(), Error<S::Error>> {
        if self.unconfirmed {
            return self.write_once(word_address, value, 0).map(drop);
        }
        self.tried(|spi| {
            spi.write_once(word_address, value, ALL_WRONG)?;
            let was_bad = spi.write_once(word_address, value, 0)? == BAD_WRITE;
            spi.last_write()?;
            match was_bad {
                true => Ok(()),
                false => Err(Error::CheckSum),
            }
        })
    }

    fn read_burst(
        &mut self,
        word_address: u32,
        words: &mut [u32],
    ) -> Result<bool, Error<S::Error>> {
        self.read_words(word_address, words).map(|_| true)
    }
}
