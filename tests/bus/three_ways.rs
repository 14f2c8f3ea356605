//! Kernels, engines and emitted Verilog of each front's card agree on a random stimulus, with the bus asked all the time.

use crate::bus_card::text;
use crate::made;
use crate::three_way::{agree, record, three_way, Recording, Stimulus};
use endat_config::{parse, Project};
use endat_hdl::card::bus::{
    ahb_lite::AhbLiteCard, apb::ApbCard, axi_lite::AxiLiteCard, parallel::ParallelCard,
    spi::SpiCard, wishbone::WishboneCard, HostBus,
};
use endat_sim::rng::Rng;
use rtl_design::engine::{Engine, KernelEngine};
use rtl_design::kernel_engine;

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

/// Additional parts of a bus's card: one of them has the outputs within the device and the second interface.
fn more(bus: HostBus) -> &'static str {
    match bus {
        HostBus::Apb => "[outputs]\nparts = [\"position\", \"interrupt\"]\n[safety]\nparts = [\"recovery_counter\", \"second_interface\"]\n",
        HostBus::Uart
        | HostBus::Wishbone
        | HostBus::AxiLite
        | HostBus::AhbLite
        | HostBus::Spi
        | HostBus::Parallel
        | HostBus::Bare => "",
    }
}

/// A bus's card as kernels.
fn kernels(project: &Project) -> Box<dyn Engine> {
    let (bus, card) = (project.bus, &project.card);
    fn connected<B: rust_hdl::prelude::Block>(mut block: B) -> B {
        block.connect_all();
        block
    }
    match bus {
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
        HostBus::AhbLite => {
            let engine: KernelEngine<AhbLiteCard> = kernel_engine!(connected(AhbLiteCard::new(card)); clk_i;
                in rst_i, trigger_i, s_ahb_hsel, s_ahb_htrans, s_ahb_hwrite, s_ahb_hsize, s_ahb_haddr, s_ahb_hwdata, s_ahb_hready;
                out s_ahb_hrdata, s_ahb_hreadyout, s_ahb_hresp, led_status_o, irq_o);
            Box::new(with_channels!(engine))
        }
        HostBus::AxiLite => {
            let engine: KernelEngine<AxiLiteCard> = kernel_engine!(connected(AxiLiteCard::new(card)); clk_i;
                in rst_i, trigger_i, s_axi_awaddr, s_axi_awvalid, s_axi_wdata, s_axi_wstrb, s_axi_wvalid, s_axi_bready,
                   s_axi_araddr, s_axi_arvalid, s_axi_rready;
                out s_axi_awready, s_axi_wready, s_axi_bresp, s_axi_bvalid, s_axi_arready, s_axi_rdata, s_axi_rresp,
                    s_axi_rvalid, led_status_o, irq_o);
            Box::new(with_channels!(engine))
        }
        HostBus::Uart | HostBus::Bare => panic!("{bus:?}: other tests compare its kernels"),
    }
}

/// New values of an input.
#[derive(Clone, Copy, Debug)]
enum Values {
    /// Any.
    Any,
    /// The other level.
    Toggled,
    /// HIGH in one of four.
    Rarely,
    /// HIGH in three of four: masters ask more often than not.
    Often,
    /// Mostly the first; otherwise anything.
    Mostly(u128),
    /// A word address, shifted by so many bits: mostly of a word that exists.
    Address(u32),
    /// One of the eight registers of the parallel bus.
    Register,
}

/// An input: its name, and its new values after so many cycles on average.
type Pin = (&'static str, u64, Values);

/// Inputs that every card has.
const PINS: [Pin; 4] = [
    ("rst_i", 400, Values::Mostly(0)),
    ("trigger_i", 400, Values::Often),
    ("endat_data0_i", 60, Values::Any),
    ("endat_data1_i", 60, Values::Any),
];

/// Inputs of a bus. Requests stay for some cycles.
fn pins(bus: HostBus) -> &'static [Pin] {
    use Values::{Address, Any, Mostly, Often, Rarely, Register, Toggled};
    match bus {
        HostBus::Apb => &[
            ("s_apb_psel", 30, Often),
            ("s_apb_penable", 30, Often),
            ("s_apb_pwrite", 30, Often),
            ("s_apb_paddr", 30, Address(2)),
            ("s_apb_pwdata", 30, Any),
            ("second_sck_i", 4, Toggled),
            ("second_cs_n_i", 500, Rarely),
        ],
        HostBus::Wishbone => &[
            ("wb_cyc_i", 30, Often),
            ("wb_stb_i", 30, Often),
            ("wb_we_i", 30, Often),
            ("wb_adr_i", 30, Address(0)),
            ("wb_dat_i", 30, Any),
            ("wb_sel_i", 30, Mostly(15)),
        ],
        HostBus::AxiLite => &[
            ("s_axi_awaddr", 30, Address(2)),
            ("s_axi_awvalid", 30, Often),
            ("s_axi_wdata", 30, Any),
            ("s_axi_wstrb", 30, Mostly(15)),
            ("s_axi_wvalid", 30, Often),
            ("s_axi_bready", 2, Often),
            ("s_axi_araddr", 30, Address(2)),
            ("s_axi_arvalid", 30, Often),
            ("s_axi_rready", 2, Often),
        ],
        // Address phases change within the data phase of the transfer before; words and NONSEQ, but not always.
        HostBus::AhbLite => &[
            ("s_ahb_hsel", 60, Often),
            ("s_ahb_htrans", 8, Mostly(2)),
            ("s_ahb_hwrite", 10, Any),
            ("s_ahb_hsize", 6, Mostly(2)),
            ("s_ahb_haddr", 10, Address(2)),
            ("s_ahb_hwdata", 10, Any),
            ("s_ahb_hready", 2, Often),
        ],
        HostBus::Spi => &[
            ("spi_sck_i", 4, Toggled),
            ("spi_cs_n_i", 500, Rarely),
            ("spi_mosi_i", 20, Often),
        ],
        // The window's addresses come over the data lines.
        HostBus::Parallel => &[
            ("bus_cs_n_i", 6, Often),
            ("bus_rd_n_i", 6, Often),
            ("bus_wr_n_i", 6, Often),
            ("bus_address_i", 6, Register),
            ("bus_data_i", 6, Address(0)),
        ],
        HostBus::Uart | HostBus::Bare => &[],
    }
}

impl Values {
    fn next(self, before: u128, width_bits: usize, rng: &mut Rng) -> u128 {
        const ADDRESSES: [u128; 18] = [
            0, 1, 5, 6, 0x010, 0x011, 0x012, 0x080, 0x081, 0x089, 0x100, 0x102, 0x108, 0x109,
            0x180, 0x181, 0x183, 0x7ff,
        ];
        let any = u128::from(rng.next_u64()) & ((1 << width_bits) - 1);
        match self {
            Self::Any => any,
            Self::Toggled => before ^ 1,
            Self::Rarely => (rng.in_range(0, 3) == 0).into(),
            Self::Often => (rng.in_range(0, 3) > 0).into(),
            Self::Mostly(value) if rng.in_range(0, 9) < 9 => value,
            Self::Mostly(_) => any,
            Self::Address(shift) => {
                ADDRESSES[rng.in_range(0, ADDRESSES.len() as u64 - 1) as usize] << shift
            }
            Self::Register => rng.in_range(0, 7).into(),
        }
    }
}

/// So many cycles, with a reset at the beginning and one in the midst.
fn stimulus(bus: HostBus, kernel: &dyn Engine, cycles: usize) -> Stimulus {
    let mut rng = Rng::new(3);
    let inputs = kernel.ports().iter().filter(|p| p.is_input);
    let pin = |name: &str| {
        let all = PINS.iter().chain(pins(bus));
        let found = all.copied().find(|pin| pin.0 == name);
        found.unwrap_or_else(|| panic!("{bus:?}: the stimulus does not have {name}"))
    };
    let inputs: Vec<(Pin, usize)> = inputs.map(|p| (pin(&p.name), p.width_bits)).collect();
    let mut row = vec![0u128; inputs.len()];
    let mut rows = vec![];
    for cycle in 0..cycles {
        for (value, ((name, stays, values), width_bits)) in row.iter_mut().zip(&inputs) {
            if *name == "rst_i" {
                *value = (cycle < 2 || cycle == cycles * 7 / 12).into();
            } else if rng.in_range(1, *stays) == 1 {
                *value = values.next(*value, *width_bits, &mut rng);
            }
        }
        rows.push(row.clone());
    }
    Stimulus {
        inputs: inputs.iter().map(|(pin, _)| pin.0.to_owned()).collect(),
        cycles: rows,
        middle: vec![],
    }
}

/// The output that changes with each answer of a bus, and an output that is HIGH after what the bus refuses, if it can refuse.
fn answers(bus: HostBus) -> (&'static str, Option<&'static str>) {
    match bus {
        HostBus::Apb => ("s_apb_pready", None),
        HostBus::Wishbone => ("wb_ack_o", None),
        HostBus::AxiLite => ("s_axi_rvalid", None),
        HostBus::AhbLite => ("s_ahb_hreadyout", Some("s_ahb_hresp")),
        HostBus::Spi => ("spi_miso_o", None),
        HostBus::Parallel => ("bus_data_o", None),
        HostBus::Uart | HostBus::Bare => panic!("{bus:?}: other tests compare its kernels"),
    }
}

/// The outputs have more than `least` changes of the bus's answer, and a refusal, if the bus has a signal for it.
fn check_answers(bus: HostBus, seen: &Recording, least: usize) {
    let (answer, refusal) = answers(bus);
    let changes = seen.output(answer);
    let changes = changes.windows(2).filter(|w| w[0] != w[1]).count();
    assert!(changes > least, "{bus:?}: {changes} changes of {answer}");
    if let Some(refusal) = refusal {
        assert!(seen.output(refusal).contains(&1), "{bus:?}: {refusal}");
    }
}

/// Kernels and native code agree on a bus's card in so many cycles.
fn native_code_agrees(bus: HostBus, cycles: usize, least: usize) {
    let project = parse("card.toml", &text(bus, more(bus))).unwrap();
    let mut kernel = kernels(&project);
    let stimulus = stimulus(bus, kernel.as_ref(), cycles);
    let expected = record(kernel.as_mut(), &stimulus);
    let seen = record(&mut made::card(&project), &stimulus);
    agree(bus.name(), &expected, &seen).unwrap();
    check_answers(bus, &expected, least);
}

/// All executions agree on a bus's card in so many cycles.
fn executions_agree(bus: HostBus, cycles: usize, least: usize) {
    let project = parse("card.toml", &text(bus, more(bus))).unwrap();
    let design = endat_emit::design(&project).unwrap();
    let mut kernel = kernels(&project);
    let stimulus = stimulus(bus, kernel.as_ref(), cycles);
    let name = format!("{}_card", bus.name());
    let seen = three_way(&name, kernel.as_mut(), &design, &stimulus).unwrap();
    check_answers(bus, &seen, least);
}

/// True if the card of a bus is compared here.
fn has_front(bus: &HostBus) -> bool {
    match bus {
        HostBus::Apb
        | HostBus::Wishbone
        | HostBus::AxiLite
        | HostBus::AhbLite
        | HostBus::Spi
        | HostBus::Parallel => true,
        // `elaborate::core` compares the card with a UART and the bare channel.
        HostBus::Uart | HostBus::Bare => false,
    }
}

/// Kernels are slow: a bus whose address and data phases overlap, and a serial one.
#[test]
fn native_code_of_two_fronts_agrees_with_their_kernels() {
    for bus in [HostBus::AhbLite, HostBus::Spi] {
        native_code_agrees(bus, 500, 3);
    }
}

#[test]
#[ignore = "slow: kernels, engines and simulators on the card of each bus"]
fn every_front_agrees() {
    for bus in HostBus::ALL.into_iter().filter(has_front) {
        executions_agree(bus, 1_200, 5);
    }
}
