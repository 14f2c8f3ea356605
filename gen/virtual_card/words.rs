//! A controller at the pins of each bus: what it reads and writes, in words.

use endat_hdl::card::bus::HostBus;
use endat_hdl::card::uart_bridge::ADDRESS_BITS;
use endat_sim::bench::Bench;
use rtl_design::engine::Compiled;

/// Who moves words over the pins of a card.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Words {
    /// AMBA 3 APB.
    Apb,
    /// Wishbone B4 classic.
    Wishbone,
    /// AXI4-Lite.
    AxiLite,
    /// AHB-Lite.
    AhbLite,
    /// SPI, mode 0, with check sums.
    Spi,
    /// The window of the parallel bus.
    Parallel,
    /// The addresses of a T-format receiver, 16 bits each.
    Dsp,
}

/// Half a period of the serial clock, and the pause around a frame, in system clock cycles: the shortest that are allowed.
const SCK_HALF_CYCLES: u64 = 4;
/// From an address on the parallel bus, or on that of a signal processor, to its data; a strobe takes as long.
const STROBE_CYCLES: u64 = 4;
/// No access takes longer: what does not answer by then is a fault of the core, and reads as 0.
const ACCESS_CYCLES_MAX: u64 = 10_000;
/// SPI: how often a frame with a wrong check sum is tried.
const SPI_TRIES: usize = 3;
/// SPI: codes of a frame.
const SPI_WRITE: u8 = 2;
const SPI_READ: u8 = 3;
/// SPI: bytes of the head, and the one that the card needs to read.
const SPI_HEAD_BYTES: usize = 4;
/// Registers of the parallel bus: the window's address, and both halves of its word.
const WINDOW: u32 = 5;
const WINDOW_LOW: u32 = 6;
const WINDOW_HIGH: u32 = 7;
const WINDOW_WRITES: u32 = 1 << 14;
const WINDOW_BUSY: u32 = 1 << 15;
/// Check sum of SPI: CRC-16/IBM-3740.
const CHECK: crc::Crc<u16> = crc::Crc::<u16>::new(&crc::CRC_16_IBM_3740);

type Card = Bench<Compiled>;

fn set_all(card: &mut Card, pins: &[(&str, u32)]) {
    for (name, level) in pins {
        card.set(name, (*level).into());
    }
}

/// Runs to the cycle in which one of these is high; false if that never comes.
fn comes(card: &mut Card, names: &[&str]) -> bool {
    for _ in 0..ACCESS_CYCLES_MAX {
        if names.iter().any(|name| card.get(name) != 0) {
            return true;
        }
        card.tick();
    }
    false
}

impl Words {
    /// The controller of this bus; none for a UART, and where there are no registers.
    pub fn of(bus: HostBus) -> Option<Self> {
        Some(match bus {
            HostBus::Apb => Self::Apb,
            HostBus::Wishbone => Self::Wishbone,
            HostBus::AxiLite => Self::AxiLite,
            HostBus::AhbLite => Self::AhbLite,
            HostBus::Spi => Self::Spi,
            HostBus::Parallel => Self::Parallel,
            HostBus::Uart | HostBus::Bare => return None,
        })
    }

    /// How many words there are; what is beyond reads as 0.
    pub const fn addresses(self) -> u32 {
        match self {
            Self::Dsp => 1 << 3,
            _ => 1 << ADDRESS_BITS,
        }
    }

    /// Puts the pins to rest.
    pub fn rest(self, card: &mut Card) {
        match self {
            Self::Spi => set_all(card, &[("spi_cs_n_i", 1)]),
            Self::Parallel | Self::Dsp => set_all(
                card,
                &[("bus_cs_n_i", 1), ("bus_rd_n_i", 1), ("bus_wr_n_i", 1)],
            ),
            Self::AhbLite => set_all(card, &[("s_ahb_hready", 1), ("s_ahb_hsize", 2)]),
            Self::Apb | Self::Wishbone | Self::AxiLite => {}
        }
    }

    /// Reads `count` words, from addresses that rise or from one.
    pub fn read(self, card: &mut Card, address: u16, count: usize, rises: bool) -> Vec<u32> {
        if self == Self::Spi && rises {
            return spi_read(card, address, count);
        }
        let step = u16::from(rises);
        let addresses = (0..count as u16).map(|n| address.wrapping_add(step * n));
        addresses.map(|a| self.read_word(card, a)).collect()
    }

    fn read_word(self, card: &mut Card, address: u16) -> u32 {
        match self {
            Self::Apb => apb(card, address, None),
            Self::Wishbone => wishbone(card, address, None),
            Self::AxiLite => axi_read(card, address),
            Self::AhbLite => ahb(card, address, None),
            Self::Spi => spi_read(card, address, 1)[0],
            Self::Parallel => {
                put(card, WINDOW, address.into());
                wait_for_window(card);
                get(card, WINDOW_LOW) | get(card, WINDOW_HIGH) << 16
            }
            Self::Dsp => get(card, address.into()),
        }
    }

    /// Writes a word.
    pub fn write(self, card: &mut Card, address: u16, word: u32) {
        match self {
            Self::Apb => drop(apb(card, address, Some(word))),
            Self::Wishbone => drop(wishbone(card, address, Some(word))),
            Self::AxiLite => axi_write(card, address, word),
            Self::AhbLite => drop(ahb(card, address, Some(word))),
            Self::Spi => spi_write(card, address, word),
            Self::Parallel => {
                put(card, WINDOW, u32::from(address) | WINDOW_WRITES);
                put(card, WINDOW_LOW, word & 0xFFFF);
                put(card, WINDOW_HIGH, word >> 16);
                wait_for_window(card);
            }
            Self::Dsp => put(card, address.into(), word & 0xFFFF),
        }
    }
}

fn apb(card: &mut Card, address: u16, write: Option<u32>) -> u32 {
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
    let word = match comes(card, &["s_apb_pready"]) {
        true => card.get("s_apb_prdata") as u32,
        false => 0,
    };
    card.tick();
    set_all(card, &[("s_apb_psel", 0), ("s_apb_penable", 0)]);
    word
}

fn wishbone(card: &mut Card, address: u16, write: Option<u32>) -> u32 {
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
    let word = match comes(card, &["wb_ack_o", "wb_err_o"]) {
        true => card.get("wb_dat_o") as u32,
        false => 0,
    };
    card.tick();
    set_all(card, &[("wb_cyc_i", 0), ("wb_stb_i", 0)]);
    word
}

/// Offers something until it is taken.
fn offer(card: &mut Card, valid: &str, ready: &str) {
    card.set(valid, 1);
    comes(card, &[ready]);
    card.tick();
    card.set(valid, 0);
}

/// Takes an answer.
fn take(card: &mut Card, valid: &str, ready: &str) {
    comes(card, &[valid]);
    card.set(ready, 1);
    card.tick();
    card.set(ready, 0);
}

fn axi_read(card: &mut Card, address: u16) -> u32 {
    card.set("s_axi_araddr", u128::from(address) << 2);
    offer(card, "s_axi_arvalid", "s_axi_arready");
    comes(card, &["s_axi_rvalid"]);
    let word = card.get("s_axi_rdata") as u32;
    take(card, "s_axi_rvalid", "s_axi_rready");
    word
}

fn axi_write(card: &mut Card, address: u16, word: u32) {
    card.set("s_axi_awaddr", u128::from(address) << 2);
    offer(card, "s_axi_awvalid", "s_axi_awready");
    set_all(card, &[("s_axi_wdata", word), ("s_axi_wstrb", 0xF)]);
    offer(card, "s_axi_wvalid", "s_axi_wready");
    take(card, "s_axi_bvalid", "s_axi_bready");
}

/// Address phase and data phase, one after the other; nobody else is on the bus.
fn ahb(card: &mut Card, address: u16, write: Option<u32>) -> u32 {
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
    let word = match comes(card, &["s_ahb_hreadyout"]) {
        true => card.get("s_ahb_hrdata") as u32,
        false => 0,
    };
    card.set("s_ahb_hready", 1);
    card.tick();
    word
}

/// A frame of SPI; what came back.
fn spi_frame(card: &mut Card, bytes: &[u8]) -> Vec<u8> {
    card.set("spi_cs_n_i", 0);
    card.run_cycles(SCK_HALF_CYCLES);
    let mut came = Vec::with_capacity(bytes.len());
    for byte in bytes {
        let mut back = 0;
        for bit in (0..8).rev() {
            card.set("spi_mosi_i", u128::from(byte >> bit & 1));
            card.run_cycles(SCK_HALF_CYCLES);
            // Taken as the clock rises.
            back = back << 1 | card.get("spi_miso_o") as u8;
            card.set("spi_sck_i", 1);
            card.run_cycles(SCK_HALF_CYCLES);
            card.set("spi_sck_i", 0);
        }
        came.push(back);
    }
    card.run_cycles(SCK_HALF_CYCLES);
    card.set("spi_cs_n_i", 1);
    card.run_cycles(SCK_HALF_CYCLES);
    came
}

fn spi_read(card: &mut Card, address: u16, count: usize) -> Vec<u32> {
    let [high, low] = address.to_be_bytes();
    let request = [SPI_READ, high, low, count as u8];
    let mut frame = request.to_vec();
    frame.resize(SPI_HEAD_BYTES + 1 + 4 * count + 2, 0);
    for _ in 0..SPI_TRIES {
        let came = spi_frame(card, &frame);
        let (data, check) = came[SPI_HEAD_BYTES + 1..].split_at(4 * count);
        if CHECK.checksum(&[&request, data].concat()).to_be_bytes() == check {
            let word = |b: &[u8]| u32::from_be_bytes([b[0], b[1], b[2], b[3]]);
            return data.chunks_exact(4).map(word).collect();
        }
    }
    vec![0; count]
}

fn spi_write(card: &mut Card, address: u16, word: u32) {
    let [high, low] = address.to_be_bytes();
    let mut frame = vec![SPI_WRITE, high, low, 1];
    frame.extend(word.to_be_bytes());
    frame.extend(CHECK.checksum(&frame).to_be_bytes());
    spi_frame(card, &frame);
}

/// Reads a register of a bus with strobes.
fn get(card: &mut Card, register: u32) -> u32 {
    let strobes = |level| [("bus_cs_n_i", level), ("bus_rd_n_i", level)];
    card.set("bus_address_i", register.into());
    set_all(card, &strobes(0));
    card.run_cycles(STROBE_CYCLES);
    let data = card.get("bus_data_o") as u32;
    set_all(card, &strobes(1));
    card.run_cycles(STROBE_CYCLES);
    data
}

/// Writes one.
fn put(card: &mut Card, register: u32, data: u32) {
    let strobes = |level| [("bus_cs_n_i", level), ("bus_wr_n_i", level)];
    set_all(card, &[("bus_address_i", register), ("bus_data_i", data)]);
    set_all(card, &strobes(0));
    card.run_cycles(STROBE_CYCLES);
    set_all(card, &strobes(1));
    card.run_cycles(STROBE_CYCLES);
}

fn wait_for_window(card: &mut Card) {
    let end = card.cycle() + ACCESS_CYCLES_MAX;
    while get(card, WINDOW) & WINDOW_BUSY != 0 && card.cycle() < end {}
}
