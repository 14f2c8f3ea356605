//! The card behind SPI, with a host that knows nothing but the frames of the page.

use super::Master;
use endat_hdl::card::bus::HostBus;
use endat_hdl::regs::{words, CARD, CARD_CONFIG, ID, RESULT};
use std::collections::BTreeMap;

/// Half a period of the serial clock, in system clocks: the fastest that is allowed.
const HALF: u64 = 4;

/// CRC-16/CCITT-FALSE.
pub fn crc16(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xffff, |crc, byte| {
        (0..8).rev().fold(crc, |crc, bit| {
            let feed = (crc >> 15) ^ u16::from(byte >> bit & 1);
            (crc << 1) ^ if feed == 1 { 0x1021 } else { 0 }
        })
    })
}

/// A host.
pub struct Host(
    /// Its card.
    pub Master,
    /// Clocks of the halves of its periods, in turn.
    &'static [u64],
    /// Chance of a pulse of noise on the clock, in a thousandth of a half period.
    u64,
);

impl Host {
    fn new(more: &str) -> Self {
        Self::at(Master::new(HostBus::Spi, more))
    }

    /// At this card.
    pub fn at(master: Master) -> Self {
        let mut host = Self(master, &[HALF], 0);
        host.0.set("spi_cs_n_i", 1);
        host.0.bench.run_cycles(20);
        host
    }

    /// The first `bits` bits of a frame; what came back.
    fn bits(&mut self, bytes: &[u8], bits: usize) -> Vec<u8> {
        let master = &mut self.0;
        assert_eq!(master.bench.get("spi_miso_oe"), 0);
        let phase = master.rng.in_range(0, 3);
        master.bench.run_cycles(phase);
        let (halves, noise) = (self.1, self.2);
        master.set("spi_cs_n_i", 0);
        master.bench.run_cycles(halves[0]);
        let mut came = vec![0; bytes.len()];
        let half = |master: &mut Master, level: u32, index: usize| {
            let mut left = halves[index % halves.len()];
            if noise > 0 && master.rng.in_range(0, 999) < noise {
                master.set("spi_sck_i", 1 - level);
                master.bench.run_cycles(1);
                master.set("spi_sck_i", level);
                left -= 1;
            }
            master.bench.run_cycles(left);
        };
        for bit in 0..bits {
            master.set("spi_mosi_i", (bytes[bit / 8] >> (7 - bit % 8) & 1).into());
            half(master, 0, 2 * bit);
            // The host takes the bit as it raises the clock.
            assert_eq!(master.bench.get("spi_miso_oe"), 1);
            came[bit / 8] |= (master.bench.get("spi_miso_o") as u8) << (7 - bit % 8);
            master.set("spi_sck_i", 1);
            half(master, 1, 2 * bit + 1);
            master.set("spi_sck_i", 0);
        }
        master.bench.run_cycles(HALF);
        master.set("spi_cs_n_i", 1);
        master.bench.run_cycles(HALF);
        came
    }

    /// A frame; what came back.
    pub fn frame(&mut self, bytes: &[u8]) -> Vec<u8> {
        self.bits(bytes, 8 * bytes.len())
    }

    /// A burst whose check sum is right.
    fn read(&mut self, address: u16, words: u8) -> Vec<u32> {
        let (came, good) = self.burst(address, words);
        assert!(good, "check sum at {address:#x}");
        came
    }

    /// A burst, and whether its check sum is right.
    fn burst(&mut self, address: u16, words: u8) -> (Vec<u32>, bool) {
        let [high, low] = address.to_be_bytes();
        let mut request = vec![3, high, low, words];
        let answer = {
            let mut frame = request.clone();
            frame.resize(5 + 4 * usize::from(words) + 2, 0);
            self.frame(&frame)
        };
        assert!(self.2 > 0 || answer[0] & 0xfd == 0xa0);
        let (data, crc) = answer[5..].split_at(4 * usize::from(words));
        request.extend(data);
        let good = crc16(&request).to_be_bytes() == crc;
        let word = |b: &[u8]| u32::from_be_bytes(b.try_into().unwrap());
        (data.chunks(4).map(word).collect(), good)
    }

    fn written(address: u16, words: &[u32]) -> Vec<u8> {
        let [high, low] = address.to_be_bytes();
        let mut frame = vec![2, high, low, words.len() as u8];
        let mut begin = 0;
        for word in words {
            frame.extend(word.to_be_bytes());
            frame.extend(crc16(&frame[begin..]).to_be_bytes());
            begin = frame.len();
        }
        frame
    }

    fn write(&mut self, address: u16, words: &[u32]) {
        self.frame(&Self::written(address, words));
        // Who looks at the encoders at once sees the word in its place.
        self.0.bench.run_cycles(130);
    }
}

fn at(block: &endat_hdl::regs::Block, name: &str, channel: usize) -> u16 {
    block.address(block.register(name).unwrap(), channel)
}

#[test]
fn the_check_sum_is_the_one_of_the_catalogue() {
    assert_eq!(crc16(b"123456789"), 0x29b1);
}

#[test]
fn every_register_reads_as_the_table_says_after_reset() {
    let mut host = Host::new("");
    let config = host.0.config.clone();
    let words = words(&config).into_iter();
    let words: BTreeMap<u16, u32> = words.map(|w| (w.address, w.start)).collect();
    for (first, count) in [(0u16, 200u8), (0xff, 60), (0x7f0, 32)] {
        for (i, got) in host.read(first, count).into_iter().enumerate() {
            let address = first + i as u16;
            let expected = words.get(&address).copied().unwrap_or(0);
            assert_eq!(got, expected, "{address:#x}");
        }
    }
    assert_eq!(host.read(0x8000, 2), [0, 0], "beyond the map");
}

#[test]
fn random_reads_and_writes_are_those_of_a_memory() {
    let mut host = Host::new("");
    let mut model = host.read(0x108, 3);
    for _ in 0..150 {
        let first = host.0.rng.in_range(0, 2) as usize;
        let count = host.0.rng.in_range(1, 3 - first as u64) as usize;
        if host.0.rng.in_range(0, 1) == 1 {
            let words: Vec<u32> = (0..count).map(|_| host.0.rng.next_u64() as u32).collect();
            host.write(0x108 + first as u16, &words);
            model[first..first + count].copy_from_slice(&words);
        } else {
            let words = host.read(0x108 + first as u16, count as u8);
            assert_eq!(words, model[first..first + count]);
        }
    }
    assert_eq!(host.read(0, 1), [ID]);
}

/// Each bit of a write frame that is turned round keeps the word from being written, and any other word.
#[test]
fn a_write_with_a_wrong_bit_is_not_carried_out_and_told() {
    let mut host = Host::new("");
    let before = host.read(0x100, 19);
    let good = Host::written(0x109, &[!before[9]]);
    for bit in 0..8 * good.len() {
        let mut wrong = good.clone();
        wrong[bit / 8] ^= 0x80 >> (bit % 8);
        host.frame(&wrong);
        host.0.bench.run_cycles(130);
        assert_eq!(host.read(0x100, 19), before, "bit {bit}");
        // In the command and in the number of words it is no write, or one that does not end.
        if (8..24).contains(&bit) || bit >= 32 {
            assert_eq!(host.frame(&[0])[0], 0xa2, "bit {bit}");
            host.write(0x00f, &[0]);
            assert_eq!(host.frame(&[0])[0], 0xa0, "bit {bit}");
        }
    }
    // Of two words the first may be right.
    let mut frame = Host::written(0x108, &[1, 2]);
    *frame.last_mut().unwrap() ^= 1;
    host.frame(&frame);
    host.0.bench.run_cycles(130);
    assert_eq!(host.read(0x108, 2), [1, before[9]]);
    host.frame(&good);
    host.0.bench.run_cycles(130);
    assert_eq!(host.read(0x109, 1), [!before[9]]);
}

#[test]
fn a_frame_may_end_anywhere() {
    let mut host = Host::new("");
    let before = host.read(0x108, 1);
    let write = Host::written(0x108, &[!before[0]]);
    for bits in 0..8 * write.len() {
        host.bits(&write, bits);
        assert_eq!(host.read(0x108, 1), before, "write of {bits} bits");
    }
    let mut read = vec![3, 0, 0, 5];
    read.resize(20, 0);
    for bits in 0..8 * read.len() {
        host.bits(&read, bits);
        assert_eq!(host.read(0, 1), [ID], "read of {bits} bits");
    }
}

#[test]
fn a_burst_is_one_moment_and_has_the_positions_of_both_encoders() {
    let mut host = Host::new("");
    // The frame behind that which measures begins when that one ends: earlier on one channel than on the other.
    for _ in 0..2 {
        host.write(at(&CARD, "trigger_now", 0), &[1]);
        host.0.bench.run_cycles(60_000);
    }
    let words = host.read(0x180, 14);
    for channel in 0..2 {
        let frame = host.0.bench.frames(channel).last().expect("a frame");
        assert_eq!(u64::from(words[8 * channel + 1]), frame.position);
        assert_eq!(words[8 * channel] & 0xc0_ffff, 0xc0_0002);
    }
    host.write(at(&CARD_CONFIG, "trigger_sources", 0), &[2]);
    host.write(at(&CARD_CONFIG, "trigger_period", 0), &[5_200]);
    let stamp = usize::from(at(&RESULT, "timestamp", 0) - 0x180);
    let mut seen = BTreeMap::new();
    for _ in 0..120 {
        let words = host.read(0x180, 14);
        assert_eq!(words[stamp], words[stamp + 8], "one trigger");
        let of_one = (words[1], words[stamp]);
        assert_eq!(*seen.entry(words[0]).or_insert(of_one), of_one);
    }
    assert!(seen.len() > 60, "{} results", seen.len());
}

/// The longest ring at the fastest clock: the first word has to be there in time.
#[test]
fn eight_channels_are_read_in_time() {
    let channel = "[[channel]]\nposition_bits = 25\ncommand = \"111000\"\n".repeat(6);
    let mut host = Host::new(&channel);
    for round in 0..20 {
        host.write(0x140, &[round, round + 1, round + 2]);
        assert_eq!(host.read(0x140, 3), [round, round + 1, round + 2]);
        assert_eq!(host.read(0x142, 1), [round + 2]);
    }
}

/// A host too fast by a quarter, or noise on the clock of a legal one, after a configuration write: words with a right check sum
/// are right, and the ring stays what it was. `rounds` without noise write each of the ring's 24 words at least once.
fn reads_leave_the_ring_as_it_is(rounds: usize, noisy_rounds: usize) {
    const LEGAL: &[u64] = &[HALF];
    const TOO_FAST: [&[u64]; 2] = [&[3, 3, 3, 3, 3, 3, 3, 4], &[3]];
    let channel = "[[channel]]\nposition_bits = 25\ncommand = \"111000\"\n".repeat(6);
    for (halves, noise, rounds) in [
        (LEGAL, 0, rounds),
        (TOO_FAST[0], 0, rounds),
        (TOO_FAST[1], 0, rounds),
        (LEGAL, 40, noisy_rounds),
    ] {
        let mut host = Host::new(&channel);
        let mut model = host.read(0x100, 0x43);
        for round in 0..rounds {
            let at = 8 * (round % 8) + 8 + round / 8 % 3;
            model[at] = host.0.rng.next_u64() as u32;
            host.frame(&Host::written(0x100 + at as u16, &[model[at]]));
            (host.1, host.2) = (halves, noise);
            // The identification is far from the ring; another word of it is not.
            let first = host.0.rng.in_range(0, 0x42) as usize;
            let (address, wanted) = match round % 2 {
                0 => (0, ID),
                _ => (0x100 + first as u16, model[first]),
            };
            let (came, good) = host.burst(address, 1);
            (host.1, host.2) = (&[HALF], 0);
            assert!(
                good || noise > 0 || halves != LEGAL,
                "a legal clock waits for nothing"
            );
            assert!(
                !good || came[0] == wanted,
                "{halves:?}, noise {noise}: {address:#x} is {wanted:#x}, {:#x} came with a right check sum",
                came[0]
            );
            host.0.bench.run_cycles(130);
            // What has been turned stays so.
            if round % 10 == 9 {
                assert_eq!(host.read(0x100, 0x43), model, "{halves:?}, noise {noise}");
            }
        }
    }
}

#[test]
fn a_read_at_once_after_a_configuration_write_leaves_the_ring_as_it_is() {
    reads_leave_the_ring_as_it_is(30, 100);
}

#[test]
#[ignore = "slow: hundreds of reads after configuration writes"]
fn many_reads_after_configuration_writes_leave_the_ring_as_it_is() {
    reads_leave_the_ring_as_it_is(60, 400);
}
