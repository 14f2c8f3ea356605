//! AXI4-Lite.

use crate::front::{
    comes, design_of, set_all, BenchHost, BusInterface, Controller, Front, LitexBus, Pins, Unused,
};
use endat_hdl::card::bus::axi_lite::AxiLiteCard;

/// A controller.
struct AxiLite;

const PORTS: &[(&str, &str)] = &[
    ("s_axi_awaddr", "awaddr"),
    ("s_axi_awvalid", "awvalid"),
    ("s_axi_awready", "awready"),
    ("s_axi_wdata", "wdata"),
    ("s_axi_wstrb", "wstrb"),
    ("s_axi_wvalid", "wvalid"),
    ("s_axi_wready", "wready"),
    ("s_axi_bresp", "bresp"),
    ("s_axi_bvalid", "bvalid"),
    ("s_axi_bready", "bready"),
    ("s_axi_araddr", "araddr"),
    ("s_axi_arvalid", "arvalid"),
    ("s_axi_arready", "arready"),
    ("s_axi_rdata", "rdata"),
    ("s_axi_rresp", "rresp"),
    ("s_axi_rvalid", "rvalid"),
    ("s_axi_rready", "rready"),
];

/// What kind of access it is, which the card does not look at.
const PROTECTION: &[Unused] = &[
    Unused {
        name: "s_axi_awprot",
        logical: "awprot",
        width: 3,
    },
    Unused {
        name: "s_axi_arprot",
        logical: "arprot",
        width: 3,
    },
];

/// What there is to know of it.
pub(super) const FRONT: Front = Front {
    design: |card, name, times, _| design_of(AxiLiteCard::with_times(card, times), name),
    bench_host: Some(BenchHost {
        text: include_str!("../templates/bench_host/axi_lite.v"),
        vhdl: include_str!("../templates/vhdl/bench/host/axi_lite.vhd"),
        moves_words: true,
        connections: PORTS,
    }),
    controller: Some(&AxiLite),
    interface: Some(BusInterface {
        name: "s_axi",
        vivado: "xilinx.com:interface:aximm",
        ipxact: Some(["amba.com", "AMBA4", "AXI4-Lite", "r0p0_0"]),
        platform_designer: "axi4lite",
        unused: PROTECTION,
        logical: &[],
        address: Some(("awaddr", 1)),
        litex: Some(LitexBus {
            module: "axi",
            // LiteX joins interfaces of the system's width only.
            class: "axi.AXILiteInterface(data_width=32, address_width=32)",
            field,
        }),
    }),
};

impl Controller for AxiLite {
    fn read_word(&self, card: &mut Pins, address: u16) -> Option<u32> {
        card.set("s_axi_araddr", u128::from(address) << 2);
        offer(card, "s_axi_arvalid", "s_axi_arready");
        let answers = comes(card, &["s_axi_rvalid"]);
        let word = card.get("s_axi_rdata") as u32;
        take(card, "s_axi_rvalid", "s_axi_rready");
        answers.then_some(word)
    }

    fn write(&self, card: &mut Pins, address: u16, word: u32) {
        card.set("s_axi_awaddr", u128::from(address) << 2);
        offer(card, "s_axi_awvalid", "s_axi_awready");
        set_all(card, &[("s_axi_wdata", word), ("s_axi_wstrb", 0xF)]);
        offer(card, "s_axi_wvalid", "s_axi_wready");
        take(card, "s_axi_bvalid", "s_axi_bready");
    }
}

/// Offers something until it is taken.
fn offer(card: &mut Pins, valid: &str, ready: &str) {
    card.set(valid, 1);
    comes(card, &[ready]);
    card.tick();
    card.set(valid, 0);
}

/// Takes an answer.
fn take(card: &mut Pins, valid: &str, ready: &str) {
    comes(card, &[valid]);
    card.set(ready, 1);
    card.tick();
    card.set(ready, 0);
}

/// `awaddr` is `addr` of the channel `aw`, as many bits as the port has.
fn field(rest: &str, width: usize) -> String {
    let channels = ["aw", "ar", "w", "r", "b"];
    let split = channels.iter().find_map(|channel| {
        let field = rest.strip_prefix(channel)?;
        Some(match field {
            "addr" => format!("{channel}.{field}[:{width}]"),
            _ => format!("{channel}.{field}"),
        })
    });
    split.unwrap_or_default()
}
