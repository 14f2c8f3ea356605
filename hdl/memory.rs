//! Memory: a block RAM with one write port and one synchronous read port.

use rust_hdl::prelude::*;

/// [`TimingInfo`] name by which elaboration recognises [`Memory`].
pub const MEMORY_TIMING: &str = "endat_memory";

/// 2^`A` words of `D` bits. What is read is the word at `read_address` at the last clock edge; if that
/// word was written at the same edge, the old one. It starts with all words 0.
#[derive(Clone, Debug, LogicBlock)]
pub struct Memory<const D: usize, const A: usize> {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Word to read.
    pub read_address: Signal<In, Bits<A>>,
    /// The word read.
    pub read_data: Signal<Out, Bits<D>>,
    /// Writes at the next clock edge.
    pub write_enable: Signal<In, Bit>,
    /// Word to write.
    pub write_address: Signal<In, Bits<A>>,
    /// What to write.
    pub write_data: Signal<In, Bits<D>>,
    _words: Vec<Bits<D>>,
}

impl<const D: usize, const A: usize> Default for Memory<D, A> {
    fn default() -> Self {
        Self {
            clock: Default::default(),
            read_address: Default::default(),
            read_data: Default::default(),
            write_enable: Default::default(),
            write_address: Default::default(),
            write_data: Default::default(),
            _words: vec![Bits::default(); 1 << A],
        }
    }
}

impl<const D: usize, const A: usize> Logic for Memory<D, A> {
    fn update(&mut self) {
        if self.clock.pos_edge() {
            self.read_data.next = self._words[self.read_address.val().index()];
            if self.write_enable.val() {
                self._words[self.write_address.val().index()] = self.write_data.val();
            }
        }
    }
    fn connect(&mut self) {
        self.read_data.connect();
    }
    fn timing(&self) -> Vec<TimingInfo> {
        vec![TimingInfo {
            name: MEMORY_TIMING.into(),
            clock: "clock".into(),
            inputs: [
                "read_address",
                "write_enable",
                "write_address",
                "write_data",
            ]
            .map(String::from)
            .into(),
            outputs: vec!["read_data".into()],
        }]
    }
}
