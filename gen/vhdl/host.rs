//! A host at the bus of a simulated card, for the run that a bench plays again.

use endat_hdl::card::bus::HostBus;
use endat_hdl::config::CardConfig;
use endat_sim::bench::{Bench, Uart};
use rtl_design::engine::Compiled;

/// Longest access in system clock cycles: a turn of the configuration ring, and more.
const ACCESS_CYCLES_MAX: u64 = 2_000;
/// Half a period of an SPI clock, a strobe of a parallel bus, and the pause behind it, in system clock cycles.
const SCK_HALF_CYCLES: u64 = 6;
const STROBE_CYCLES: u64 = 7;
/// A UART's answer is waited for so many bytes longer than it is.
const SPARE_BYTES: u64 = 20;
const BITS_OF_BYTE: u64 = 10;

/// The host.
pub(super) struct Host {
    bus: HostBus,
    uart: Option<(Uart, u64)>,
}

impl Host {
    /// At the bus of this card; leaves it at rest.
    pub fn new(bus: HostBus, card: &CardConfig, bench: &mut Bench<Compiled>) -> Self {
        let rest: &[&str] = match bus {
            HostBus::Spi => &["spi_cs_n_i"],
            HostBus::Parallel => &["bus_cs_n_i", "bus_rd_n_i", "bus_wr_n_i"],
            _ => &[],
        };
        let rest = rest.iter().chain(&["second_cs_n_i"]);
        for name in rest.filter(|name| bench.has_port(name)).collect::<Vec<_>>() {
            bench.set(name, 1);
        }
        let is_uart = bus == HostBus::Uart;
        let uart = is_uart.then(|| (Uart::new(bench, card.uart_bit_cycles), card.uart_bit_cycles));
        Self { bus, uart }
    }

    /// Some cycles in which the host does nothing new.
    pub fn run(&mut self, bench: &mut Bench<Compiled>, cycles: u64) {
        match &mut self.uart {
            Some((uart, _)) => (0..cycles).for_each(|_| uart.tick(bench)),
            None => bench.run_cycles(cycles),
        }
    }

    /// Reads words from a word address on; none if no answer comes.
    pub fn read(&mut self, bench: &mut Bench<Compiled>, address: u64, words: u64) -> Vec<u32> {
        match self.bus {
            HostBus::Uart => self.read_uart(bench, address, words),
            HostBus::Spi => read_spi(bench, address, words),
            HostBus::Bare => vec![],
            _ => {
                let each = (0..words).map(|n| self.access(bench, address + n, None));
                each.collect::<Option<_>>().unwrap_or_default()
            }
        }
    }

    /// Writes a word. Over SPI nothing is written: that wants a check sum, and blocks behind the front are the same.
    pub fn write(&mut self, bench: &mut Bench<Compiled>, address: u64, value: u32) {
        match self.bus {
            HostBus::Uart => {
                let bytes = [command(1, address, 1), value.to_be_bytes().to_vec()].concat();
                self.exchange(bench, &bytes, 0);
            }
            HostBus::Spi | HostBus::Bare => {}
            _ => {
                self.access(bench, address, Some(value));
            }
        }
    }

    /// One word of a bus that moves one at a time.
    fn access(&self, bench: &mut Bench<Compiled>, address: u64, value: Option<u32>) -> Option<u32> {
        match self.bus {
            HostBus::Apb => access_apb(bench, address, value),
            HostBus::Wishbone => access_wishbone(bench, address, value),
            HostBus::AxiLite => access_axi_lite(bench, address, value),
            HostBus::AhbLite => access_ahb_lite(bench, address, value),
            _ => access_parallel(bench, address, value),
        }
    }

    fn read_uart(&mut self, bench: &mut Bench<Compiled>, address: u64, words: u64) -> Vec<u32> {
        let bytes = self.exchange(bench, &command(2, address, words), 4 * words);
        let words = bytes.chunks_exact(4);
        words
            .map(|b| u32::from_be_bytes([b[0], b[1], b[2], b[3]]))
            .collect()
    }

    /// Sends bytes and waits for so many.
    fn exchange(&mut self, bench: &mut Bench<Compiled>, bytes: &[u8], answer: u64) -> Vec<u8> {
        let Some((uart, bit_cycles)) = &mut self.uart else {
            return vec![];
        };
        let byte_cycles = BITS_OF_BYTE * *bit_cycles;
        uart.received().clear();
        uart.send(bytes);
        let longest = (bytes.len() as u64 + answer + SPARE_BYTES) * byte_cycles;
        for _ in 0..longest {
            if uart.unsent() == 0 && uart.received().len() as u64 >= answer {
                break;
            }
            uart.tick(bench);
        }
        let received = uart.received().drain(..).collect();
        self.run(bench, 2 * byte_cycles);
        received
    }
}

/// A command of the link.
fn command(code: u8, address: u64, words: u64) -> Vec<u8> {
    let mut bytes = vec![code, words as u8];
    bytes.extend((address as u32).to_be_bytes());
    bytes
}

/// Runs cycles until this output is high, and looks at others then.
fn until(bench: &mut Bench<Compiled>, port: &str) -> bool {
    for _ in 0..ACCESS_CYCLES_MAX {
        if bench.get(port) == 1 {
            return true;
        }
        bench.run_cycles(1);
    }
    false
}

fn set_all(bench: &mut Bench<Compiled>, values: &[(&str, u128)]) {
    for (name, value) in values {
        bench.set(name, *value);
    }
}

fn access_apb(bench: &mut Bench<Compiled>, address: u64, value: Option<u32>) -> Option<u32> {
    let data = value.unwrap_or_default();
    let request = [
        ("s_apb_psel", 1),
        ("s_apb_pwrite", value.is_some().into()),
        ("s_apb_paddr", u128::from(4 * address)),
        ("s_apb_pwdata", data.into()),
    ];
    set_all(bench, &request);
    bench.run_cycles(1);
    bench.set("s_apb_penable", 1);
    let answered = until(bench, "s_apb_pready");
    let word = bench.get("s_apb_prdata") as u32;
    bench.run_cycles(1);
    set_all(bench, &[("s_apb_psel", 0), ("s_apb_penable", 0)]);
    bench.run_cycles(1);
    answered.then_some(word)
}

fn access_wishbone(bench: &mut Bench<Compiled>, address: u64, value: Option<u32>) -> Option<u32> {
    let data = value.unwrap_or_default();
    let request = [
        ("wb_cyc_i", 1),
        ("wb_stb_i", 1),
        ("wb_sel_i", 15),
        ("wb_we_i", value.is_some().into()),
        ("wb_adr_i", address.into()),
        ("wb_dat_i", data.into()),
    ];
    set_all(bench, &request);
    let answered = until(bench, "wb_ack_o");
    let word = bench.get("wb_dat_o") as u32;
    bench.run_cycles(1);
    set_all(bench, &[("wb_cyc_i", 0), ("wb_stb_i", 0)]);
    bench.run_cycles(1);
    answered.then_some(word)
}

fn access_ahb_lite(bench: &mut Bench<Compiled>, address: u64, value: Option<u32>) -> Option<u32> {
    let request = [
        ("s_ahb_hsel", 1),
        ("s_ahb_htrans", 2),
        ("s_ahb_hsize", 2),
        ("s_ahb_hready", 1),
        ("s_ahb_hwrite", value.is_some().into()),
        ("s_ahb_haddr", u128::from(4 * address)),
    ];
    set_all(bench, &request);
    bench.run_cycles(1);
    let data = [
        ("s_ahb_hsel", 0),
        ("s_ahb_htrans", 0),
        ("s_ahb_hready", 0),
        ("s_ahb_hwdata", value.unwrap_or_default().into()),
    ];
    set_all(bench, &data);
    let answered = until(bench, "s_ahb_hreadyout");
    let word = bench.get("s_ahb_hrdata") as u32;
    bench.set("s_ahb_hready", 1);
    bench.run_cycles(2);
    answered.then_some(word)
}

fn access_axi_lite(bench: &mut Bench<Compiled>, address: u64, value: Option<u32>) -> Option<u32> {
    let at = u128::from(4 * address);
    let (asks, address_port, valid) = match value {
        Some(_) => (vec!["aw", "w"], "s_axi_awaddr", "s_axi_bvalid"),
        None => (vec!["ar"], "s_axi_araddr", "s_axi_rvalid"),
    };
    let data = value.unwrap_or_default();
    set_all(
        bench,
        &[
            (address_port, at),
            ("s_axi_wdata", data.into()),
            ("s_axi_wstrb", 15),
        ],
    );
    let port = |channel: &str, end: &str| format!("s_axi_{channel}{end}");
    for channel in &asks {
        bench.set(&port(channel, "valid"), 1);
    }
    let mut open = asks;
    let taker = if value.is_some() {
        "s_axi_bready"
    } else {
        "s_axi_rready"
    };
    bench.set(taker, 1);
    for _ in 0..ACCESS_CYCLES_MAX {
        let answered = bench.get(valid) == 1;
        let word = bench.get("s_axi_rdata") as u32;
        let taken: Vec<&str> = (open.iter().copied())
            .filter(|channel| bench.get(&port(channel, "ready")) == 1)
            .collect();
        bench.run_cycles(1);
        for channel in &taken {
            bench.set(&port(channel, "valid"), 0);
        }
        open.retain(|channel| !taken.contains(channel));
        if answered && open.is_empty() {
            bench.set(taker, 0);
            bench.run_cycles(1);
            return Some(word);
        }
    }
    None
}

/// A strobe of the parallel bus, and what stands on its data lines at the end of it.
pub(super) fn strobe(bench: &mut Bench<Compiled>, address: u64, value: Option<u16>) -> u16 {
    let strobe = if value.is_some() {
        "bus_wr_n_i"
    } else {
        "bus_rd_n_i"
    };
    let data = value.unwrap_or_default();
    let request = [
        ("bus_address_i", u128::from(address)),
        ("bus_data_i", data.into()),
        ("bus_cs_n_i", 0),
    ];
    set_all(bench, &request);
    bench.run_cycles(1);
    bench.set(strobe, 0);
    bench.run_cycles(STROBE_CYCLES);
    let read = bench.get("bus_data_o") as u16;
    bench.set(strobe, 1);
    bench.run_cycles(1);
    bench.set("bus_cs_n_i", 1);
    bench.run_cycles(STROBE_CYCLES);
    read
}

/// Register 5 is the window: busy in bit 15, write without reading first in bit 14. Registers 6 and 7 are the word.
fn access_parallel(bench: &mut Bench<Compiled>, address: u64, value: Option<u32>) -> Option<u32> {
    let window = address as u16 | u16::from(value.is_some()) << 14;
    strobe(bench, 5, Some(window));
    if let Some(value) = value {
        strobe(bench, 6, Some(value as u16));
        strobe(bench, 7, Some((value >> 16) as u16));
    }
    let is_free = (0..ACCESS_CYCLES_MAX / STROBE_CYCLES).any(|_| strobe(bench, 5, None) >> 15 == 0);
    let high = u32::from(strobe(bench, 7, None));
    let low = u32::from(strobe(bench, 6, None));
    is_free.then_some(high << 16 | low)
}

fn read_spi(bench: &mut Bench<Compiled>, address: u64, words: u64) -> Vec<u32> {
    fn exchange(bench: &mut Bench<Compiled>, byte: u8) -> u8 {
        let mut read = 0;
        for n in (0..8).rev() {
            bench.set("spi_mosi_i", u128::from(byte >> n & 1));
            bench.run_cycles(SCK_HALF_CYCLES);
            read = read << 1 | bench.get("spi_miso_o") as u8;
            bench.set("spi_sck_i", 1);
            bench.run_cycles(SCK_HALF_CYCLES);
            bench.set("spi_sck_i", 0);
        }
        read
    }
    bench.set("spi_cs_n_i", 0);
    bench.run_cycles(SCK_HALF_CYCLES);
    let [_, _, high, low] = (address as u32).to_be_bytes();
    for byte in [3, high, low, words as u8, 0] {
        exchange(bench, byte);
    }
    let word = |_| {
        let bytes = [0; 4].map(|byte| exchange(bench, byte));
        u32::from_be_bytes(bytes)
    };
    let read = (0..words).map(word).collect();
    bench.run_cycles(SCK_HALF_CYCLES);
    bench.set("spi_cs_n_i", 1);
    bench.run_cycles(SCK_HALF_CYCLES);
    read
}
