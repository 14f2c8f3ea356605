//! SPI, mode 0, with check sums.

use crate::front::{design_of, BenchHost, Controller, Front, Pins};
use endat_hdl::card::bus::spi::SpiCard;

/// A controller.
struct Spi;

/// Half a period of the serial clock, and the pause around a frame, in system clock cycles: the shortest that are allowed.
const SCK_HALF_CYCLES: u64 = 4;
/// How often a frame with a wrong check sum is tried.
const SPI_TRIES: usize = 3;
/// Codes of a frame.
const SPI_WRITE: u8 = 2;
const SPI_READ: u8 = 3;
/// Bytes of the head, and the one that the card needs to read.
const SPI_HEAD_BYTES: usize = 4;
/// Check sum of SPI: CRC-16/IBM-3740.
const CHECK: crc::Crc<u16> = crc::Crc::<u16>::new(&crc::CRC_16_IBM_3740);
const PORTS: &[(&str, &str)] = &[
    ("spi_sck_i", "spi_sck"),
    ("spi_cs_n_i", "spi_cs_n"),
    ("spi_mosi_i", "spi_mosi"),
    ("spi_miso_o", "spi_miso"),
    ("spi_miso_oe", "spi_miso_oe"),
];

/// What there is to know of it.
pub(super) const FRONT: Front = Front {
    design: |card, name, times, _| design_of(SpiCard::with_times(card, times), name),
    bench_host: Some(BenchHost {
        text: include_str!("../templates/bench_host/spi.v"),
        vhdl: include_str!("../templates/vhdl/bench/host/spi.vhd"),
        moves_words: false,
        connections: PORTS,
    }),
    controller: Some(&Spi),
    interface: None,
};

impl Controller for Spi {
    fn rest(&self, card: &mut Pins) {
        card.set("spi_cs_n_i", 1);
    }

    fn read_word(&self, card: &mut Pins, address: u16) -> Option<u32> {
        spi_read(card, address, 1).map(|words| words[0])
    }

    fn write(&self, card: &mut Pins, address: u16, word: u32) {
        let [high, low] = address.to_be_bytes();
        let mut frame = vec![SPI_WRITE, high, low, 1];
        frame.extend(word.to_be_bytes());
        frame.extend(CHECK.checksum(&frame).to_be_bytes());
        spi_frame(card, &frame);
    }

    /// In one frame, which is one moment.
    fn burst(&self, card: &mut Pins, address: u16, count: usize) -> Vec<u32> {
        spi_read(card, address, count).unwrap_or(vec![0; count])
    }
}

/// A frame of SPI; what came back.
fn spi_frame(card: &mut Pins, bytes: &[u8]) -> Vec<u8> {
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

/// Words, if their check sum is right.
fn spi_read(card: &mut Pins, address: u16, count: usize) -> Option<Vec<u32>> {
    let [high, low] = address.to_be_bytes();
    let request = [SPI_READ, high, low, count as u8];
    let mut frame = request.to_vec();
    frame.resize(SPI_HEAD_BYTES + 1 + 4 * count + 2, 0);
    for _ in 0..SPI_TRIES {
        let came = spi_frame(card, &frame);
        let (data, check) = came[SPI_HEAD_BYTES + 1..].split_at(4 * count);
        if CHECK.checksum(&[&request, data].concat()).to_be_bytes() == check {
            let word = |b: &[u8]| u32::from_be_bytes([b[0], b[1], b[2], b[3]]);
            return Some(data.chunks_exact(4).map(word).collect());
        }
    }
    None
}
