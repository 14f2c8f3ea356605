//! AMBA 3 AHB-Lite.

use crate::front::{comes, design_of, set_all, BenchHost, BusInterface, Controller, Front, Pins};
use endat_hdl::card::bus::ahb_lite::AhbLiteCard;

/// A controller.
struct AhbLite;

const PORTS: &[(&str, &str)] = &[
    ("s_ahb_hsel", "hsel"),
    ("s_ahb_htrans", "htrans"),
    ("s_ahb_hwrite", "hwrite"),
    ("s_ahb_hsize", "3'd2"),
    ("s_ahb_haddr", "haddr"),
    ("s_ahb_hwdata", "hwdata"),
    // There is nobody else on the bus.
    ("s_ahb_hready", "hreadyout"),
    ("s_ahb_hrdata", "hrdata"),
    ("s_ahb_hreadyout", "hreadyout"),
    ("s_ahb_hresp", "hresp"),
];

/// What there is to know of it.
pub(super) const FRONT: Front = Front {
    design: |card, name, times, _| design_of(AhbLiteCard::with_times(card, times), name),
    bench_host: Some(BenchHost {
        text: include_str!("../templates/bench_host/ahb_lite.v"),
        vhdl: include_str!("../templates/vhdl/bench/host/ahb_lite.vhd"),
        moves_words: true,
        connections: PORTS,
    }),
    controller: Some(&AhbLite),
    interface: Some(BusInterface {
        name: "s_ahb",
        vivado: "xilinx.com:interface:ahblite",
        ipxact: Some(["amba.com", "AMBA3", "AHBLite", "r2p0_0"]),
        platform_designer: "",
        unused: &[],
        logical: &[],
        address: Some(("haddr", 1)),
        litex: None,
    }),
};

impl Controller for AhbLite {
    fn rest(&self, card: &mut Pins) {
        set_all(card, &[("s_ahb_hready", 1), ("s_ahb_hsize", 2)]);
    }

    fn read_word(&self, card: &mut Pins, address: u16) -> Option<u32> {
        access(card, address, None)
    }

    fn write(&self, card: &mut Pins, address: u16, word: u32) {
        access(card, address, Some(word));
    }
}

/// Address phase and data phase, one after the other; nobody else is on the bus.
fn access(card: &mut Pins, address: u16, write: Option<u32>) -> Option<u32> {
    set_all(
        card,
        &[
            ("s_ahb_hsel", 1),
            ("s_ahb_htrans", 2),
            ("s_ahb_haddr", u32::from(address) << 2),
            ("s_ahb_hwrite", write.is_some().into()),
        ],
    );
    card.tick();
    set_all(
        card,
        &[
            ("s_ahb_hsel", 0),
            ("s_ahb_htrans", 0),
            ("s_ahb_hready", 0),
            ("s_ahb_hwdata", write.unwrap_or(0)),
        ],
    );
    let answers = comes(card, &["s_ahb_hreadyout"]);
    let word = card.get("s_ahb_hrdata") as u32;
    card.set("s_ahb_hready", 1);
    card.tick();
    answers.then_some(word)
}
