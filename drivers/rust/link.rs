//! How words of a card are reached.

use crate::error::Error;
use core::convert::Infallible;

/// Reads and writes words. Addresses count words; a bus that counts bytes takes four times that.
pub trait Link {
    /// What the bus says when an access fails.
    type Error;

    /// Reads a word.
    fn read(&mut self, word_address: u32) -> Result<u32, Error<Self::Error>>;

    /// Writes a word.
    fn write(&mut self, word_address: u32, value: u32) -> Result<(), Error<Self::Error>>;

    /// Reads words that follow each other as one command of the bus, which is one moment; `false` without doing so if the bus has no
    /// such command.
    fn read_burst(
        &mut self,
        word_address: u32,
        words: &mut [u32],
    ) -> Result<bool, Error<Self::Error>> {
        let _ = (word_address, words);
        Ok(false)
    }
}

impl<L: Link + ?Sized> Link for &mut L {
    type Error = L::Error;

    fn read(&mut self, word_address: u32) -> Result<u32, Error<L::Error>> {
        (**self).read(word_address)
    }

    fn write(&mut self, word_address: u32, value: u32) -> Result<(), Error<L::Error>> {
        (**self).write(word_address, value)
    }

    fn read_burst(
        &mut self,
        word_address: u32,
        words: &mut [u32],
    ) -> Result<bool, Error<L::Error>> {
        (**self).read_burst(word_address, words)
    }
}

/// A card in the memory of the processor: behind APB, Wishbone or AXI4-Lite.
#[derive(Debug)]
pub struct Mapped {
    base: *mut u32,
}

// SAFETY: whoever made it has said that the memory is the card's and nobody else writes it, on no processor.
#[allow(unsafe_code)]
unsafe impl Send for Mapped {}

impl Mapped {
    /// The card whose first word is at `base`.
    ///
    /// # Safety
    /// `base` is a multiple of 4; [`endat_regs::MAP_BYTES`] from there on are the card's, for as long as this lives, and nobody else
    /// writes them.
    #[allow(unsafe_code)] // Only the program that knows its memory map can vouch for the address.
    pub const unsafe fn new(base: *mut u32) -> Self {
        Self { base }
    }

    fn at(&self, word_address: u32) -> Result<*mut u32, Error<Infallible>> {
        match word_address < endat_regs::MAP_BYTES / endat_regs::WORD_BYTES {
            true => Ok(self.base.wrapping_add(word_address as usize)),
            false => Err(Error::Argument),
        }
    }
}

impl Link for Mapped {
    type Error = Infallible;

    #[allow(unsafe_code)] // `at` keeps to the memory that `new` was promised.
    fn read(&mut self, word_address: u32) -> Result<u32, Error<Infallible>> {
        Ok(unsafe { self.at(word_address)?.read_volatile() })
    }

    #[allow(unsafe_code)] // `at` keeps to the memory that `new` was promised.
    fn write(&mut self, word_address: u32, value: u32) -> Result<(), Error<Infallible>> {
        unsafe { self.at(word_address)?.write_volatile(value) };
        Ok(())
    }
}
