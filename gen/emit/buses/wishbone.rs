//! Wishbone B4, classic.

use crate::front::{
    comes, design_of, set_all, BenchHost, BusInterface, Controller, Front, LitexBus, Pins,
};
use endat_hdl::card::bus::wishbone::WishboneCard;

/// A controller.
struct Wishbone;

const PORTS: &[(&str, &str)] = &[
    ("wb_cyc_i", "wb_cyc"),
    ("wb_stb_i", "wb_stb"),
    ("wb_we_i", "wb_we"),
    ("wb_adr_i", "wb_adr"),
    ("wb_dat_i", "wb_dat_to_card"),
    ("wb_sel_i", "wb_sel"),
    ("wb_dat_o", "wb_dat_from_card"),
    ("wb_ack_o", "wb_ack"),
    ("wb_err_o", "wb_err"),
];

/// What there is to know of it.
pub(super) const FRONT: Front = Front {
    design: |card, name, times, _| design_of(WishboneCard::with_times(card, times), name),
    bench_host: Some(BenchHost {
        text: include_str!("../templates/bench_host/wishbone.v"),
        vhdl: include_str!("../templates/vhdl/bench/host/wishbone.vhd"),
        moves_words: true,
        connections: PORTS,
    }),
    controller: Some(&Wishbone),
    interface: Some(BusInterface {
        name: "wb",
        vivado: "",
        ipxact: Some(["opencores.org", "interface", "wishbone", "B4"]),
        platform_designer: "",
        unused: &[],
        logical: &[],
        address: Some(("adr_i", 4)),
        litex: Some(LitexBus {
            module: "wishbone",
            class: "wishbone.Interface(data_width=32, adr_width=BITS, addressing=\"word\")",
            field,
        }),
    }),
};

impl Controller for Wishbone {
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
            ("wb_cyc_i", 1),
            ("wb_stb_i", 1),
            ("wb_adr_i", address.into()),
            ("wb_we_i", write.is_some().into()),
            ("wb_dat_i", write.unwrap_or(0)),
            ("wb_sel_i", 0xF),
        ],
    );
    let answers = comes(card, &["wb_ack_o", "wb_err_o"]);
    let word = card.get("wb_dat_o") as u32;
    card.tick();
    set_all(card, &[("wb_cyc_i", 0), ("wb_stb_i", 0)]);
    answers.then_some(word)
}

/// `dat_i` is what the master writes.
fn field(rest: &str, _: usize) -> String {
    match rest {
        "dat_i" => "dat_w".into(),
        "dat_o" => "dat_r".into(),
        rest => rest.trim_end_matches("_i").trim_end_matches("_o").into(),
    }
}
