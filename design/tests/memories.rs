//! Memories in ordinary blocks, three ways.

use crate::rng::Rng;
use crate::zoo::check;
use rtl_design::elaborate::elaborate;
use rtl_design::kernel_engine;
use rtl_design::memory::{Memory, Rom};
use rust_hdl::prelude::*;

/// Two independent memories.
#[derive(LogicBlock, Default)]
pub struct Store {
    pub clock: Signal<In, Clock>,
    pub enable: Signal<In, Bit>,
    pub to: Signal<In, Bits<3>>,
    pub from: Signal<In, Bits<3>>,
    pub data: Signal<In, Bits<40>>,
    pub out: Signal<Out, Bits<40>>,
    pub low: Signal<Out, Bits<4>>,
    words: Memory<40, 3>,
    nibbles: Memory<4, 3>,
}

impl Logic for Store {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, words, nibbles);
        self.words.read_address.next = self.from.val();
        self.words.write_address.next = self.to.val();
        self.words.write_enable.next = self.enable.val();
        self.words.write_data.next = self.data.val();
        self.nibbles.read_address.next = self.from.val() + 1;
        self.nibbles.write_address.next = self.to.val();
        self.nibbles.write_enable.next = true;
        self.nibbles.write_data.next = self.data.val().get_bits::<4>(30);
        self.out.next = self.words.read_data.val();
        self.low.next = self.nibbles.read_data.val() ^ 5;
    }
}

#[test]
fn memories_agree() {
    let mut block = Store::default();
    block.connect_all();
    let design = elaborate(&block, "store").unwrap();
    assert_eq!(design.top().memories.len(), 2);
    let engine = kernel_engine!(block; clock; in enable, to, from, data; out out, low);
    check("store", &design, engine, 1000);
}

/// Read-only memories: one filled from end to end, one with words missing, one without any.
#[derive(LogicBlock)]
pub struct Tables {
    pub clock: Signal<In, Clock>,
    pub from: Signal<In, Bits<6>>,
    pub full_out: Signal<Out, Bits<20>>,
    pub part_out: Signal<Out, Bits<64>>,
    pub chained_out: Signal<Out, Bits<3>>,
    full: Rom<20, 6>,
    part: Rom<64, 4>,
    chained: Rom<3, 4>,
    empty: Rom<2, 2>,
}

impl Default for Tables {
    fn default() -> Self {
        let mut rng = Rng::new(3);
        let mut words = |count: usize, bits: usize| -> Vec<u64> {
            (0..count).map(|_| rng.next_u64() >> (64 - bits)).collect()
        };
        Self {
            clock: Default::default(),
            from: Default::default(),
            full_out: Default::default(),
            part_out: Default::default(),
            chained_out: Default::default(),
            full: Rom::new(&words(64, 20)),
            part: Rom::new(&words(11, 64)),
            chained: Rom::new(&words(16, 3)),
            empty: Rom::new(&[]),
        }
    }
}

impl Logic for Tables {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, full, part, chained, empty);
        self.full.read_address.next = self.from.val();
        self.part.read_address.next = self.from.val().get_bits::<4>(0);
        // The output of one memory is the input of the next.
        self.chained.read_address.next = self.full.read_data.val().get_bits::<4>(9);
        self.empty.read_address.next = self.chained.read_data.val().get_bits::<2>(0);
        self.full_out.next = self.full.read_data.val();
        self.part_out.next = self.part.read_data.val();
        self.chained_out.next =
            self.chained.read_data.val() ^ bit_cast::<3, 2>(self.empty.read_data.val());
    }
}

#[test]
fn read_only_memories_agree() {
    let mut block = Tables::default();
    block.connect_all();
    let design = elaborate(&block, "tables").unwrap();
    let memories = &design.top().memories;
    assert!(memories.iter().all(|m| m.write.is_none()));
    let given: Vec<(usize, usize)> = memories.iter().map(|m| (m.start.len(), m.words)).collect();
    assert_eq!(given, [(64, 64), (11, 16), (16, 16), (0, 4)]);
    let engine = kernel_engine!(block; clock; in from; out full_out, part_out, chained_out);
    check("tables", &design, engine, 1000);
}
