//! UART in the UARTBone format.

use crate::front::{design_of, BenchHost, BusInterface, Front};
use endat_hdl::card::Card;

const PORTS: &[(&str, &str)] = &[
    ("uart_rx_i", "uart_to_card"),
    ("uart_tx_o", "uart_from_card"),
];

/// What there is to know of it.
pub(super) const FRONT: Front = Front {
    design: |card, name, times, link_timeout_us| {
        design_of(Card::with_times(card, link_timeout_us, times), name)
    },
    bench_host: Some(BenchHost {
        text: include_str!("../templates/bench_host/uart.v"),
        vhdl: include_str!("../templates/vhdl/bench/host/uart.vhd"),
        moves_words: false,
        connections: PORTS,
    }),
    controller: None,
    interface: Some(BusInterface {
        name: "uart",
        vivado: "xilinx.com:interface:uart",
        ipxact: None,
        platform_designer: "",
        unused: &[],
        logical: &[("rx_i", "RxD"), ("tx_o", "TxD")],
        address: None,
        litex: None,
    }),
};
