//! The bench's host: how it sits at the card's bus, and the tasks `host_idle`, `write_word`, `read_words` with the function `word`.

use super::{clock_ns, real};
use crate::error::GenError;
use crate::template;
use endat_hdl::card::bus::HostBus;
use endat_hdl::card::config_ring::RING_BYTES;
use endat_hdl::config::CardConfig;
use minijinja::context;
use serde::Serialize;

/// A port of the card and what it is connected to.
#[derive(Serialize)]
pub struct Connection {
    port: &'static str,
    net: &'static str,
}

/// The host at one kind of bus.
pub struct Host {
    /// Declarations and tasks.
    pub text: String,
    /// The bus at the card.
    pub connections: Vec<Connection>,
    /// A written word acts after this, in ns.
    pub settle_ns: f64,
}

/// Bit times of a UART that a written word is waited for.
const UART_SETTLE_BITS: f64 = 20.0;
/// Half an SPI clock period, in system clock cycles: a quarter more than the shortest one, and no multiple of a cycle.
pub(super) const SCK_HALF_CYCLES: f64 = 5.1;

/// What an access takes at most besides a turn of the configuration ring, in system clock cycles.
const ACCESS_CYCLES: usize = 100;

/// Longest access of a bus, in system clock cycles.
fn access_cycles_max(card: &CardConfig) -> usize {
    RING_BYTES * (card.channels.len() + 1) + ACCESS_CYCLES
}

const UART: &[(&str, &str)] = &[
    ("uart_rx_i", "uart_to_card"),
    ("uart_tx_o", "uart_from_card"),
];
const APB: &[(&str, &str)] = &[
    ("s_apb_psel", "psel"),
    ("s_apb_penable", "penable"),
    ("s_apb_pwrite", "pwrite"),
    ("s_apb_paddr", "paddr"),
    ("s_apb_pwdata", "pwdata"),
    ("s_apb_prdata", "prdata"),
    ("s_apb_pready", "pready"),
    ("s_apb_pslverr", "pslverr"),
];
const WISHBONE: &[(&str, &str)] = &[
    ("wb_cyc_i", "wb_cyc"),
    ("wb_stb_i", "wb_cyc"),
    ("wb_we_i", "wb_we"),
    ("wb_adr_i", "wb_adr"),
    ("wb_dat_i", "wb_dat_to_card"),
    ("wb_sel_i", "4'b1111"),
    ("wb_dat_o", "wb_dat_from_card"),
    ("wb_ack_o", "wb_ack"),
    ("wb_err_o", "wb_err"),
];
const AXI_LITE: &[(&str, &str)] = &[
    ("s_axi_awaddr", "awaddr"),
    ("s_axi_awvalid", "awvalid"),
    ("s_axi_awready", "awready"),
    ("s_axi_wdata", "wdata"),
    ("s_axi_wstrb", "4'b1111"),
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
const AHB_LITE: &[(&str, &str)] = &[
    ("s_ahb_hsel", "hsel"),
    ("s_ahb_htrans", "{hsel, 1'b0}"),
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
const SPI: &[(&str, &str)] = &[
    ("spi_sck_i", "spi_sck"),
    ("spi_cs_n_i", "spi_cs_n"),
    ("spi_mosi_i", "spi_mosi"),
    ("spi_miso_o", "spi_miso"),
    ("spi_miso_oe", "spi_miso_oe"),
];
const PARALLEL: &[(&str, &str)] = &[
    ("bus_cs_n_i", "bus_cs_n"),
    ("bus_rd_n_i", "bus_rd_n"),
    ("bus_wr_n_i", "bus_wr_n"),
    ("bus_address_i", "bus_address"),
    ("bus_data_i", "bus_data_to_card"),
    ("bus_data_o", "bus_data_from_card"),
    ("bus_data_oe", "bus_data_oe"),
];
/// Tasks of every host, for what the bus of each does in `bus_write` and `bus_read`.
const ACCESS: &str = include_str!("../templates/bench_host/access.v");
/// What both are for hosts that move one word at a time.
const WORDS: &str = include_str!("../templates/bench_host/words.v");

/// Whether frames of the stream go out over the UART from the start.
pub fn pushes(bus: HostBus, card: &CardConfig) -> bool {
    bus == HostBus::Uart && card.stream.start.pushes()
}

/// The host of a card with this bus; none for a port without a bus.
pub fn host(bus: HostBus, card: &CardConfig) -> Result<Option<Host>, GenError> {
    let (own, words, connections) = match bus {
        HostBus::Uart => (include_str!("../templates/bench_host/uart.v"), "", UART),
        HostBus::Apb => (include_str!("../templates/bench_host/apb.v"), WORDS, APB),
        HostBus::Wishbone => {
            let own = include_str!("../templates/bench_host/wishbone.v");
            (own, WORDS, WISHBONE)
        }
        HostBus::AxiLite => {
            let own = include_str!("../templates/bench_host/axi_lite.v");
            (own, WORDS, AXI_LITE)
        }
        HostBus::AhbLite => {
            let own = include_str!("../templates/bench_host/ahb_lite.v");
            (own, WORDS, AHB_LITE)
        }
        HostBus::Spi => (include_str!("../templates/bench_host/spi.v"), "", SPI),
        HostBus::Parallel => {
            let own = include_str!("../templates/bench_host/parallel.v");
            (own, WORDS, PARALLEL)
        }
        HostBus::Bare => return Ok(None),
    };
    let clk_ns = clock_ns(card.system_hz);
    let settle_ns = match bus {
        HostBus::Uart => UART_SETTLE_BITS * 1e9 / card.baud as f64,
        _ => access_cycles_max(card) as f64 * clk_ns,
    };
    let context = context! {
        uart_bit_ns => real(1e9 / card.baud as f64),
        pushes => pushes(bus, card),
        // Twice the longest frame of a stream.
        frame_bits => real((2 * 10 * endat_hdl::card::stream::buffer::frame_bytes(card.channels.len(), card.stream.additional_data)) as f64),
        sck_half_ns => real(SCK_HALF_CYCLES * clk_ns),
        access_cycles_max => access_cycles_max(card),
    };
    // Names stand before they are used.
    let text = format!("{ACCESS}{words}{own}");
    Ok(Some(Host {
        text: template::render("bench_host", &text, &context)?,
        connections: (connections.iter())
            .map(|(port, net)| Connection { port, net })
            .collect(),
        settle_ns,
    }))
}
