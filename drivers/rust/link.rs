//! Access to the words of a card.

use crate::error::Error;
use core::convert::Infallible;

/// Reads and writes words. Addresses count words; a byte-addressed bus needs four times that.
pub trait Link {
    /// Error of the bus.
    type Error;

    /// Reads a word.
    fn read(&mut self, word_address: u32) -> Result<u32, Error<Self::Error>>;

    /// Writes a word.
    fn write(&mut self, word_address: u32, value: u32) -> Result<(), Error<Self::Error>>;

    /// Reads consecutive words with one command of the bus, from one instant; returns `false` without an access if the bus has no
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

/// A memory-mapped card: over APB, Wishbone or AXI4-Lite.
#[derive(Debug)]
pub struct Mapped {
    base: *mut u32,
}

// SAFETY: the caller of `new` guarantees that the memory belongs to the card and nothing else writes it, on any processor.
#[allow(unsafe_code)]
unsafe impl Send for Mapped {}

impl Mapped {
    /// The card whose first word is at `base`.
    ///
    /// # Safety
    /// `base` is a multiple of 4; [`endat_regs::MAP_BYTES`] from there on belong to the card while this value lives, and nothing else
    /// writes them.
    #[allow(unsafe_code)] // Only the program that knows its memory map can guarantee the address.
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

    #[allow(unsafe_code)] // `at` stays within the memory guaranteed for `new`.
    fn read(&mut self, word_address: u32) -> Result<u32, Error<Infallible>> {
        Ok(unsafe { self.at(word_address)?.read_volatile() })
    }

    #[allow(unsafe_code)] // `at` stays within the memory guaranteed for `new`.
    fn write(&mut self, word_address: u32, value: u32) -> Result<(), Error<Infallible>> {
        unsafe { self.at(word_address)?.write_volatile(value) };
        Ok(())
    }
}
