//! Memories: a block RAM with one write port and one synchronous read port, and a read-only one.

use rust_hdl::prelude::*;

/// [`TimingInfo`] name by which elaboration recognises [`Memory`].
pub const MEMORY_TIMING: &str = "rtl_design_memory";
/// [`TimingInfo`] name by which elaboration recognises [`Rom`].
pub const ROM_TIMING: &str = "rtl_design_rom";

/// 2^`A` words of `D` bits. Reads return the word at `read_address` at the last clock edge; if that
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
    /// Data to write.
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

/// 2^`A` words of `D` bits that never change. Reads return the word at `read_address` at the last clock edge, 0 before
/// the first.
#[derive(Clone, Debug, LogicBlock)]
pub struct Rom<const D: usize, const A: usize> {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Word to read.
    pub read_address: Signal<In, Bits<A>>,
    /// The word read.
    pub read_data: Signal<Out, Bits<D>>,
    /// From word 0 on; those that are missing are 0.
    word: Vec<Constant<Bits<D>>>,
}

impl<const D: usize, const A: usize> Rom<D, A> {
    /// A memory that holds `words` from word 0 on, and 0 after them.
    ///
    /// # Panics
    /// If there are more words than it can hold, or one has more than `D` bits.
    pub fn new(words: &[u64]) -> Self {
        assert!(
            words.len() <= 1 << A,
            "{} words: a memory with {A} address bits has room for {}",
            words.len(),
            1u64 << A
        );
        let constant = |(index, word): (usize, &u64)| {
            assert!(
                D >= 64 || word >> D == 0,
                "word {index} = {word:#x}: does not fit into {D} bits"
            );
            Constant::new((*word).into())
        };
        Self {
            clock: Default::default(),
            read_address: Default::default(),
            read_data: Default::default(),
            word: words.iter().enumerate().map(constant).collect(),
        }
    }
}

impl<const D: usize, const A: usize> Logic for Rom<D, A> {
    fn update(&mut self) {
        if self.clock.pos_edge() {
            let word = self.word.get(self.read_address.val().index());
            self.read_data.next = word.map_or(Bits::default(), |word| word.val());
        }
    }
    fn connect(&mut self) {
        self.read_data.connect();
    }
    fn timing(&self) -> Vec<TimingInfo> {
        vec![TimingInfo {
            name: ROM_TIMING.into(),
            clock: "clock".into(),
            inputs: vec!["read_address".into()],
            outputs: vec!["read_data".into()],
        }]
    }
}
