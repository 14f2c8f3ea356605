//! A card on a UART, in the byte format of UARTBone.

use crate::error::Error;
use crate::link::Link;

const WRITE: u8 = 1;
const READ: u8 = 2;

/// Bytes of a UART: 8N1.
pub trait Serial {
    /// Error, also for missing bytes.
    type Error;

    /// Sends all bytes.
    fn send(&mut self, bytes: &[u8]) -> Result<(), Self::Error>;

    /// Receives all bytes, or times out.
    fn receive(&mut self, bytes: &mut [u8]) -> Result<(), Self::Error>;
}

/// A card on a UART. The format has no check sum; the stream is read, not pushed. After an error of the link wait 100 ms, until the card
/// has dropped the command.
#[derive(Debug)]
pub struct Uart<S> {
    serial: S,
}

impl<S: Serial> Uart<S> {
    /// The card at this UART.
    pub const fn new(serial: S) -> Self {
        Self { serial }
    }

    /// Returns the UART.
    pub fn release(self) -> S {
        self.serial
    }
}

impl<S: Serial> Link for Uart<S> {
    type Error = S::Error;

    fn read(&mut self, word_address: u32) -> Result<u32, Error<S::Error>> {
        let mut word = [0];
        self.read_burst(word_address, &mut word)?;
        Ok(word[0])
    }

    fn write(&mut self, word_address: u32, value: u32) -> Result<(), Error<S::Error>> {
        let [a, b, c, d] = word_address.to_be_bytes();
        let [e, f, g, h] = value.to_be_bytes();
        let bytes = [WRITE, 1, a, b, c, d, e, f, g, h];
        self.serial.send(&bytes).map_err(Error::Link)
    }

    fn read_burst(
        &mut self,
        word_address: u32,
        words: &mut [u32],
    ) -> Result<bool, Error<S::Error>> {
        let count = u8::try_from(words.len()).ok().filter(|count| *count > 0);
        let count = count.ok_or(Error::Argument)?;
        let [a, b, c, d] = word_address.to_be_bytes();
        let command = [READ, count, a, b, c, d];
        self.serial.send(&command).map_err(Error::Link)?;
        for word in words {
            let mut bytes = [0; 4];
            self.serial.receive(&mut bytes).map_err(Error::Link)?;
            *word = u32::from_be_bytes(bytes);
        }
        Ok(true)
    }
}
