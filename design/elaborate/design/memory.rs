//! Memories of a design, written or read-only.

use super::NetId;

/// A memory with one synchronous read port, and a write port unless it is read-only; a read in the cycle of a write sees
/// the old word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Verilog name.
    pub name: String,
    /// Bits of a word.
    pub width_bits: usize,
    /// Words; the address nets have just enough bits.
    pub words: usize,
    /// Clock.
    pub clock: NetId,
    /// Word to read.
    pub read_address: NetId,
    /// The word at `read_address` at the last clock edge; starts at 0.
    pub read_data: NetId,
    /// The write port; `None` if it is read-only.
    pub write: Option<WritePort>,
    /// Words at power-up, from word 0 on; those that are missing are 0.
    pub start: Vec<u128>,
    /// Rust documentation of the field, line by line.
    pub docs: Vec<String>,
}

/// The write port of a [`Memory`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WritePort {
    /// Writes at the next clock edge if high.
    pub enable: NetId,
    /// Word to write.
    pub address: NetId,
    /// Data to write.
    pub data: NetId,
}

impl WritePort {
    /// Its nets.
    pub fn nets(self) -> [NetId; 3] {
        [self.enable, self.address, self.data]
    }

    /// Its nets, to be changed.
    pub fn nets_mut(&mut self) -> [&mut NetId; 3] {
        [&mut self.enable, &mut self.address, &mut self.data]
    }
}

impl Memory {
    /// Every word at power-up.
    pub fn start_words(&self) -> Vec<u128> {
        let mut words = self.start.clone();
        words.resize(self.words, 0);
        words
    }

    /// The nets that it reads.
    pub fn inputs(&self) -> impl Iterator<Item = NetId> {
        let write = self.write.map(WritePort::nets);
        [self.clock, self.read_address]
            .into_iter()
            .chain(write.into_iter().flatten())
    }

    /// The nets that it reads, to be changed.
    pub fn inputs_mut(&mut self) -> impl Iterator<Item = &mut NetId> {
        let write = self.write.as_mut().map(WritePort::nets_mut);
        [&mut self.clock, &mut self.read_address]
            .into_iter()
            .chain(write.into_iter().flatten())
    }
}
