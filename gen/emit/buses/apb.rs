//! AMBA 3 APB.

use crate::front::{comes, design_of, set_all, BenchHost, BusInterface, Controller, Front, Pins};
use endat_hdl::card::bus::apb::ApbCard;

/// A controller.
struct Apb;

const PORTS: &[(&str, &str)] = &[
    ("s_apb_psel", "psel"),
    ("s_apb_penable", "penable"),
    ("s_apb_pwrite", "pwrite"),
    ("s_apb_paddr", "paddr"),
    ("s_apb_pwdata", "pwdata"),
    ("s_apb_prdata", "prdata"),
    ("s_apb_pready", "pready"),
    ("s_apb_pslverr", "pslverr"),
];

/// What there is to know of it.
pub(super) const FRONT: Front = Front {
    design: |card, name, times, _| design_of(ApbCard::with_times(card, times), name),
    bench_host: Some(BenchHost {
        text: include_str!("../templates/bench_host/apb.v"),
        vhdl: include_str!("../templates/vhdl/bench/host/apb.vhd"),
        moves_words: true,
        connections: PORTS,
    }),
    controller: Some(&Apb),
    interface: Some(BusInterface {
        name: "s_apb",
        vivado: "xilinx.com:interface:apb",
        ipxact: Some(["amba.com", "AMBA3", "APB", "r1p0_0"]),
        platform_designer: "apb",
        unused: &[],
        logical: &[],
        address: Some(("paddr", 1)),
        litex: None,
    }),
};

impl Controller for Apb {
    fn read_word(&self, card: &mut Pins, address: u16) -> Option<u32> {
        access(card, address, None)
    }

    fn write(&self, card: &mut Pins, address: u16, word: u32) {
        access(card, address, Some(word));
    }
}

fn access(card: &mut Pins, address: u16, write: Option<u32>) -> Option<u32> {
    set_all(
        card,
        &[
            ("s_apb_psel", 1),
            ("s_apb_penable", 0),
            ("s_apb_paddr", u32::from(address) << 2),
            ("s_apb_pwrite", write.is_some().into()),
            ("s_apb_pwdata", write.unwrap_or(0)),
        ],
    );
    card.tick();
    card.set("s_apb_penable", 1);
    let answers = comes(card, &["s_apb_pready"]);
    let word = card.get("s_apb_prdata") as u32;
    card.tick();
    set_all(card, &[("s_apb_psel", 0), ("s_apb_penable", 0)]);
    answers.then_some(word)
}
