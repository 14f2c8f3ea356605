//! Kernels, engines and emitted Verilog of each front's card agree on a random stimulus, with the bus asked all the time.

use crate::bus_card::text;
use crate::three_way::{three_way, Stimulus};
use crate::tools::third;
use endat_gen::config::parse;
use endat_hdl::card::bus::{
    apb::ApbCard, axi_lite::AxiLiteCard, parallel::ParallelCard, spi::SpiCard,
    wishbone::WishboneCard, HostBus,
};
use endat_sim::rng::Rng;
use rtl_design::elaborate::Design;
use rtl_design::engine::{Engine, KernelEngine};
use rtl_design::kernel_engine;

const CYCLES: usize = 1_200;
/// What a change of it tries other buses by.
const BANK: &str = include_str!("../../hdl/card/register_bank.rs");

/// The pins that every card has.
macro_rules! with_channels {
    ($engine:expr) => {
        $engine
            .input("endat_data0_i", |b| &mut b.endat_data_i[0])
            .input("endat_data1_i", |b| &mut b.endat_data_i[1])
            .output("endat_clk0_o", |b| &mut b.endat_clk_o[0])
            .output("endat_clk1_o", |b| &mut b.endat_clk_o[1])
            .output("endat_data0_o", |b| &mut b.endat_data_o[0])
            .output("endat_data1_o", |b| &mut b.endat_data_o[1])
            .output("endat_data0_oe", |b| &mut b.endat_data_oe[0])
            .output("endat_data1_oe", |b| &mut b.endat_data_oe[1])
            .output("led_channel0_o", |b| &mut b.led_channel_o[0])
            .output("led_channel1_o", |b| &mut b.led_channel_o[1])
    };
}

/// What a bus's card has besides: the outputs within the device and the second interface for one of them.
fn more(bus: HostBus) -> &'static str {
    match bus {
        HostBus::Apb => "[outputs]\nparts = [\"position\", \"interrupt\"]\n[safety]\nparts = [\"recovery_counter\", \"second_interface\"]\n",
        _ => "",
    }
}

/// The card of a bus as kernels.
fn kernels(bus: HostBus) -> (Box<dyn Engine>, Design) {
    let project = parse("card.toml", &text(bus, more(bus))).unwrap();
    let design = endat_gen::design(&project).unwrap();
    let card = &project.card;
    fn connected<B: rust_hdl::prelude::Block>(mut block: B) -> B {
        block.connect_all();
        block
    }
    let kernel: Box<dyn Engine> = match bus {
        HostBus::Apb => {
            let engine: KernelEngine<ApbCard> = kernel_engine!(connected(ApbCard::new(card)); clk_i;
                in rst_i, trigger_i, s_apb_psel, s_apb_penable, s_apb_pwrite, s_apb_paddr, s_apb_pwdata;
                out s_apb_prdata, s_apb_pready, s_apb_pslverr, led_status_o, irq_o);
            let engine = with_channels!(engine)
                .output("direct_position0_o", |b| &mut b.direct_position_o[0])
                .output("direct_position1_o", |b| &mut b.direct_position_o[1])
                .output("direct_valid0_o", |b| &mut b.direct_valid_o[0])
                .output("direct_valid1_o", |b| &mut b.direct_valid_o[1])
                .output("direct_fresh0_o", |b| &mut b.direct_fresh_o[0])
                .output("direct_fresh1_o", |b| &mut b.direct_fresh_o[1])
                .output("direct_error0_o", |b| &mut b.direct_error_o[0])
                .output("direct_error1_o", |b| &mut b.direct_error_o[1])
                .input("second_sck_i", |b| &mut b.second_sck_i[0])
                .input("second_cs_n_i", |b| &mut b.second_cs_n_i[0])
                .output("second_miso_o", |b| &mut b.second_miso_o[0])
                .output("second_miso_oe", |b| &mut b.second_miso_oe[0]);
            Box::new(engine)
        }
        HostBus::Wishbone => {
            let engine: KernelEngine<WishboneCard> = kernel_engine!(connected(WishboneCard::new(card)); clk_i;
                in rst_i, trigger_i, wb_cyc_i, wb_stb_i, wb_we_i, wb_adr_i, wb_dat_i, wb_sel_i;
                out wb_dat_o, wb_ack_o, wb_err_o, led_status_o, irq_o);
            Box::new(with_channels!(engine))
        }
        HostBus::Spi => {
            let engine: KernelEngine<SpiCard> = kernel_engine!(connected(SpiCard::new(card)); clk_i;
                in rst_i, trigger_i, spi_sck_i, spi_cs_n_i, spi_mosi_i; out spi_miso_o, spi_miso_oe, led_status_o, irq_o);
            Box::new(with_channels!(engine))
        }
        HostBus::Parallel => {
            let engine: KernelEngine<ParallelCard> = kernel_engine!(connected(ParallelCard::new(card)); clk_i;
                in rst_i, trigger_i, bus_cs_n_i, bus_rd_n_i, bus_wr_n_i, bus_address_i, bus_data_i;
                out bus_data_o, bus_data_oe, led_status_o, irq_o);
            Box::new(with_channels!(engine))
        }
        _ => {
            let engine: KernelEngine<AxiLiteCard> = kernel_engine!(connected(AxiLiteCard::new(card)); clk_i;
                in rst_i, trigger_i, s_axi_awaddr, s_axi_awvalid, s_axi_wdata, s_axi_wstrb, s_axi_wvalid, s_axi_bready,
                   s_axi_araddr, s_axi_arvalid, s_axi_rready;
                out s_axi_awready, s_axi_wready, s_axi_bresp, s_axi_bvalid, s_axi_arready, s_axi_rdata, s_axi_rresp,
                    s_axi_rvalid, led_status_o, irq_o);
            Box::new(with_channels!(engine))
        }
    };
    (kernel, design)
}

/// Requests stay for some cycles, addresses are mostly those of words that exist.
fn stimulus(kernel: &dyn Engine) -> Stimulus {
    let mut rng = Rng::new(3);
    let ports: Vec<_> = kernel
        .ports()
        .iter()
        .filter(|p| p.is_input)
        .cloned()
        .collect();
    let addresses = [
        0u64, 1, 5, 6, 0x010, 0x011, 0x012, 0x080, 0x081, 0x089, 0x100, 0x102, 0x108, 0x109, 0x180,
        0x181, 0x183, 0x7ff,
    ];
    let mut row = vec![0u128; ports.len()];
    let mut cycles = vec![];
    for cycle in 0..CYCLES {
        for (value, port) in row.iter_mut().zip(&ports) {
            let name = port.name.as_str();
            let stays = match name {
                "rst_i" | "trigger_i" => 400,
                _ if name.starts_with("bus_") => 6,
                "spi_cs_n_i" | "second_cs_n_i" => 500,
                "spi_sck_i" | "second_sck_i" => 4,
                "spi_mosi_i" => 20,
                _ if name.contains("ready") => 2,
                _ if name.contains("data0_i") || name.contains("data1_i") => 60,
                _ => 30,
            };
            if rng.in_range(1, stays) != 1 {
                continue;
            }
            let shift = if port.width_bits == 13 { 2 } else { 0 };
            *value = match name {
                "rst_i" => 0,
                "bus_address_i" => rng.in_range(0, 7).into(),
                _ if name.contains("adr") || name.contains("addr") => u128::from(
                    addresses[rng.in_range(0, addresses.len() as u64 - 1) as usize] << shift,
                ),
                "spi_sck_i" | "second_sck_i" => *value ^ 1,
                "spi_cs_n_i" | "second_cs_n_i" => (rng.in_range(0, 3) == 0).into(),
                // Addresses of the window; anything elsewhere.
                "bus_data_i" => {
                    u128::from(addresses[rng.in_range(0, addresses.len() as u64 - 1) as usize])
                }
                "wb_sel_i" | "s_axi_wstrb" => 15 - u128::from(rng.in_range(0, 9) / 9),
                // Asked more often than not.
                _ if port.width_bits == 1 && !name.starts_with("endat") => {
                    (rng.in_range(0, 3) > 0).into()
                }
                _ => u128::from(rng.next_u64()) & ((1 << port.width_bits) - 1),
            };
        }
        let reset = ports.iter().position(|p| p.name == "rst_i").unwrap();
        row[reset] = (cycle < 2 || cycle == 700).into();
        cycles.push(row.clone());
    }
    Stimulus {
        inputs: ports.into_iter().map(|p| p.name).collect(),
        cycles,
        middle: vec![],
    }
}

#[test]
fn every_front_agrees() {
    // The bare port is one of the blocks that have claims of their own.
    let has_front = |bus: &HostBus| ![HostBus::Uart, HostBus::Bare].contains(bus);
    let buses: Vec<HostBus> = HostBus::ALL.into_iter().filter(has_front).collect();
    for &bus in third(&buses, BANK.len()) {
        let (mut kernel, design) = kernels(bus);
        let stimulus = stimulus(kernel.as_ref());
        let seen = three_way(
            &format!("{}_card", bus.name()),
            kernel.as_mut(),
            &design,
            &stimulus,
        )
        .unwrap();
        let answers = match bus {
            HostBus::Apb => seen.output("s_apb_pready"),
            HostBus::Wishbone => seen.output("wb_ack_o"),
            HostBus::Spi => seen.output("spi_miso_o"),
            HostBus::Parallel => seen.output("bus_data_o"),
            _ => seen.output("s_axi_rvalid"),
        };
        let answers = answers.windows(2).filter(|w| w[0] != w[1]).count();
        assert!(answers > 5, "{bus:?}: {answers} answers");
    }
}
