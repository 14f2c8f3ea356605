//! Bundles of ports: one block's to another's, up and down the hierarchy, and in lists.

use crate::zoo::check;
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::reg::Reg;
use rtl_design::verilog::{print_files, Header};
use rtl_design::{kernel, kernel_engine, ports, Block};
use rust_hdl::prelude::*;

/// A value and what is asked back.
#[ports]
pub struct Offer {
    /// Offered value.
    pub value: Bits<7>,
    /// It is taken.
    #[back]
    pub ready: Bit,
}

/// Counts while its offer is taken.
#[derive(LogicBlock, Block)]
struct Counter {
    pub clock: Signal<In, Clock>,
    pub reset: Signal<In, Bit>,
    #[bundle]
    pub offer: OfferOut,
    count: Reg<Bits<7>>,
}

#[kernel]
impl Logic for Counter {
    fn update(&mut self) {
        if self.offer.ready.val() {
            self.count.d.next = self.count.q.val() + 1;
        }
        self.offer.value.next = self.count.q.val();
    }
}

/// Offers half of what it is offered.
#[derive(LogicBlock, Block)]
struct Halved {
    /// The offer as it comes.
    #[bundle("_in")]
    pub whole: OfferIn,
    #[bundle]
    pub half: OfferOut,
}

#[kernel]
impl Logic for Halved {
    fn update(&mut self) {
        self.half.value.next = self.whole.value.val() >> 1;
        self.whole.ready.next = self.half.ready.val();
    }
}

/// Counters, each with its halves, whose offers are those of this block; and one that nothing is asked of.
#[derive(LogicBlock, Block)]
pub struct Row {
    pub clock: Signal<In, Clock>,
    pub reset: Signal<In, Bit>,
    #[bundle]
    pub offers: Vec<OfferOut>,
    #[bundle("_too")]
    pub passed_in: OfferIn,
    #[bundle("_on")]
    pub passed_out: OfferOut,
    counters: Vec<Counter>,
    halves: Vec<Halved>,
    #[start]
    last: Halved,
    _n: usize,
}

impl Row {
    fn new(n: usize) -> Self {
        Self::from_parts(RowParts {
            offers: vec![OfferOut::default(); n],
            counters: (0..n).map(|_| Counter::default()).collect(),
            halves: (0..n).map(|_| Halved::default()).collect(),
            _n: n,
        })
    }
}

#[kernel]
impl Logic for Row {
    fn update(&mut self) {
        for i in 0..self._n {
            connect!(self.counters[i] <= self; clock, reset);
            OfferOut::join(&mut self.counters[i].offer, &mut self.halves[i].whole);
            OfferOut::link(&mut self.offers[i], &mut self.halves[i].half);
        }
        OfferIn::link(&mut self.passed_in, &mut self.last.whole);
        OfferOut::link(&mut self.passed_out, &mut self.last.half);
        // An assignment after a link replaces it.
        self.passed_out.value.next = self.last.half.value.val() ^ 1;
    }
}

fn design(n: usize) -> Design {
    let mut block = Row::new(n);
    block.connect_all();
    elaborate(&block, "row").unwrap()
}

#[test]
fn bundles_agree() {
    let mut block = Row::new(2);
    block.connect_all();
    let engine = kernel_engine!(block; clock; in reset; out)
        .input("ready_0", |b| &mut b.offers[0].ready)
        .input("ready_1", |b| &mut b.offers[1].ready)
        .bundle("_too", |b| &mut b.passed_in)
        .input("ready_on", |b| &mut b.passed_out.ready)
        .output("value_0", |b| &mut b.offers[0].value)
        .output("value_1", |b| &mut b.offers[1].value)
        .output("value_on", |b| &mut b.passed_out.value);
    check("bundles", &design(2), engine, 500);
}

#[test]
fn a_port_of_a_bundle_is_told_as_any_other() {
    let text: String = print_files(&design(1), &Header::default())
        .into_iter()
        .map(|(_, text)| text)
        .collect();
    for line in [
        "//   value_0    out   7  Offered value.",
        "//   ready_too  out   1  It is taken.",
        "//   value_on   out   7  Offered value.",
        ".value_in(counters_0_value),",
    ] {
        assert!(text.contains(line), "{line} is not in\n{text}");
    }
}

#[test]
fn the_ports_of_a_bundle_in_an_engine_have_their_own_names() {
    let mut counter = Counter::default();
    counter.connect_all();
    let design = elaborate(&counter, "counter").unwrap();
    let engine = kernel_engine!(counter; clock; in reset; out; bundles offer);
    check("bundle-counter", &design, engine, 100);
}
