//! UART in the UARTBone format.

use crate::error::GenError;
use crate::front::{design_of, BenchHost, BusInterface, Front};
use endat_hdl::card::Card;
use endat_hdl::config::CardConfig;
use endat_hdl::endat::service::program::ServiceTimes;
use rtl_design::elaborate::Design;

/// See the module.
pub(super) struct Uart;

const UART: &[(&str, &str)] = &[
    ("uart_rx_i", "uart_to_card"),
    ("uart_tx_o", "uart_from_card"),
];

const INTERFACE: BusInterface = BusInterface {
    name: "uart",
    vivado: "xilinx.com:interface:uart",
    ipxact: None,
    platform_designer: "",
    unused: &[],
    logical: &[("rx_i", "RxD"), ("tx_o", "TxD")],
    address: None,
    litex: None,
};

impl Front for Uart {
    fn design(
        &self,
        card: &CardConfig,
        name: &str,
        times: &ServiceTimes,
        link_timeout_us: u64,
    ) -> Result<Design, GenError> {
        design_of(Card::with_times(card, link_timeout_us, times), name)
    }

    fn bench_host(&self) -> Option<BenchHost> {
        Some(BenchHost {
            text: include_str!("../templates/bench_host/uart.v"),
            moves_words: false,
            connections: UART,
        })
    }

    fn interface(&self) -> Option<&'static BusInterface> {
        Some(&INTERFACE)
    }
}
