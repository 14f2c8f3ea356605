//! Both ends of the Rust driver's bus: what its traits ask for goes to a rig.

use super::rig::Rig;
use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use endat_driver::{Error, Link, Registers, Serial};
use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

/// Both ends of the driver's bus, and what a test does with the encoders.
#[derive(Clone)]
pub struct World(pub Rc<RefCell<Rig>>);

impl World {
    pub fn new(rig: Rig) -> Self {
        Self(Rc::new(RefCell::new(rig)))
    }

    pub fn told(&self, line: &str) -> String {
        self.0.borrow_mut().answer(line)
    }

    pub fn ask(&self, line: &str) -> u64 {
        u64::from_str_radix(&self.told(line), 16).unwrap()
    }

    /// Leaves a cycle.
    pub fn pause_us(&self, us: u32) {
        self.told(&format!("delay {us:x}"));
    }

    pub fn is_content(&self) {
        assert_eq!(
            self.ask("violations"),
            0,
            "the encoders saw something wrong"
        );
    }
}

impl DelayNs for World {
    fn delay_ns(&mut self, ns: u32) {
        self.pause_us(ns.div_ceil(1_000));
    }
}

impl Link for World {
    type Error = Infallible;

    fn read(&mut self, word_address: u32) -> Result<u32, Error<Infallible>> {
        Ok(self.ask(&format!("r {word_address:x}")) as u32)
    }

    fn write(&mut self, word_address: u32, value: u32) -> Result<(), Error<Infallible>> {
        self.told(&format!("w {word_address:x} {value:x}"));
        Ok(())
    }
}

impl ErrorType for World {
    type Error = Infallible;
}

impl SpiDevice for World {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        let [Operation::TransferInPlace(bytes)] = operations else {
            panic!("chip select is low for one transfer");
        };
        let sent: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        take(&self.told(&format!("spi {sent}")), bytes);
        Ok(())
    }
}

impl Registers for World {
    type Error = Infallible;

    fn get(&mut self, register: u8) -> Result<u16, Infallible> {
        Ok(self.ask(&format!("get {register:x}")) as u16)
    }

    fn put(&mut self, register: u8, value: u16) -> Result<(), Infallible> {
        self.told(&format!("put {register:x} {value:x}"));
        Ok(())
    }
}

impl Serial for World {
    type Error = Infallible;

    fn send(&mut self, bytes: &[u8]) -> Result<(), Infallible> {
        let sent: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        self.told(&format!("send {sent}"));
        Ok(())
    }

    fn receive(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        take(&self.told(&format!("receive {:x}", bytes.len())), bytes);
        Ok(())
    }
}

fn take(told: &str, bytes: &mut [u8]) {
    for (n, byte) in bytes.iter_mut().enumerate() {
        *byte = u8::from_str_radix(&told[2 * n..2 * n + 2], 16).unwrap();
    }
}
