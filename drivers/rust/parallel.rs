//! A card on the parallel bus: words through its window.

use crate::error::Error;
use crate::link::Link;

/// Registers of the bus.
const WINDOW: u8 = 5;
const LOW_HALF: u8 = 6;
const HIGH_HALF: u8 = 7;
/// Bits of the window.
const BUSY: u16 = 0x8000;
const NO_READ: u16 = 0x4000;
const ADDRESS_BITS: u32 = 0x07FF;
/// Polls of the window until it must be free: the longest access takes some hundred system clocks, a poll several.
const LOOKS: u32 = 1_000;

/// The eight registers of 16 bits of the parallel bus.
pub trait Registers {
    /// Error of an access; `Infallible` if it cannot fail.
    type Error;

    /// Reads register 0 to 7.
    fn get(&mut self, register: u8) -> Result<u16, Self::Error>;

    /// Writes register 0 to 7.
    fn put(&mut self, register: u8, value: u16) -> Result<(), Self::Error>;
}

/// A card on the parallel bus.
#[derive(Debug)]
pub struct Parallel<R> {
    registers: R,
}

impl<R: Registers> Parallel<R> {
    /// The card at these registers.
    pub const fn new(registers: R) -> Self {
        Self { registers }
    }

    /// Returns the registers.
    pub fn release(self) -> R {
        self.registers
    }

    fn get(&mut self, register: u8) -> Result<u16, Error<R::Error>> {
        self.registers.get(register).map_err(Error::Link)
    }

    fn put(&mut self, register: u8, value: u16) -> Result<(), Error<R::Error>> {
        self.registers.put(register, value).map_err(Error::Link)
    }

    /// Waits for the previous access, and starts another one.
    fn select(&mut self, word_address: u32, more: u16) -> Result<(), Error<R::Error>> {
        if word_address > ADDRESS_BITS {
            return Err(Error::Argument);
        }
        self.wait_for_window()?;
        // Each write of the window also sets the channel of registers 0 to 4, which the driver does not use.
        self.put(WINDOW, word_address as u16 | more)
    }

    fn wait_for_window(&mut self) -> Result<(), Error<R::Error>> {
        for _ in 0..LOOKS {
            if self.get(WINDOW)? & BUSY == 0 {
                return Ok(());
            }
        }
        Err(Error::Timeout)
    }
}

impl<R: Registers> Link for Parallel<R> {
    type Error = R::Error;

    fn read(&mut self, word_address: u32) -> Result<u32, Error<R::Error>> {
        self.select(word_address, 0)?;
        self.wait_for_window()?;
        let low = self.get(LOW_HALF)?;
        Ok(u32::from(self.get(HIGH_HALF)?) << 16 | u32::from(low))
    }

    fn write(&mut self, word_address: u32, value: u32) -> Result<(), Error<R::Error>> {
        self.select(word_address, NO_READ)?;
        self.put(LOW_HALF, value as u16)?;
        self.put(HIGH_HALF, (value >> 16) as u16)?;
        self.wait_for_window()
    }
}
