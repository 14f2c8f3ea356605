//! What holds behind every bus.

use super::{Master, WORD_BUSES};
use endat_hdl::card::bus::HostBus;
use endat_hdl::regs::{Access, CARD, CARD_CONFIG, RESULT};
use std::collections::BTreeMap;

/// Word address of a register.
fn at(block: &endat_hdl::regs::Block, name: &str, channel: usize) -> u16 {
    block.address(block.register(name).unwrap(), channel)
}

/// Every word of a card: access and start value.
fn words(master: &Master) -> BTreeMap<u16, (Access, u32)> {
    let config = &master.config;
    let words = endat_hdl::regs::words(config).into_iter();
    let told = |w: endat_hdl::regs::Word| (w.address, (w.register.access, w.start));
    words.map(told).collect()
}

#[test]
fn every_register_reads_as_the_table_says_after_reset() {
    for bus in WORD_BUSES {
        let mut master = Master::new(bus, "");
        let words = words(&master);
        for address in (0..0x180).chain(0x1f8..0x208).chain([0x3ff, 0x400, 0x7ff]) {
            let expected = words.get(&address).map_or(0, |word| word.1);
            assert_eq!(master.read(address), expected, "{bus:?}, {address:#x}");
        }
    }
}

#[test]
fn random_reads_and_writes_are_those_of_a_memory() {
    for bus in WORD_BUSES {
        let mut master = Master::new(bus, "");
        let mut model = words(&master);
        // Strobes measure and trigger; a held result is another test.
        model.retain(|address, _| {
            !(0x180..0x200).contains(address) && !(6..0x100).contains(address)
        });
        let addresses: Vec<u16> = model
            .keys()
            .copied()
            .chain([0x103, 0x105, 0x17f, 0x208])
            .collect();
        for _ in 0..600 {
            let address = addresses[master.rng.in_range(0, addresses.len() as u64 - 1) as usize];
            let value = master.rng.next_u64() as u32;
            if master.rng.in_range(0, 1) == 1 {
                master.write(address, value);
                if let Some((Access::ReadWrite, word)) = model.get_mut(&address) {
                    *word = value;
                }
            } else {
                let expected = model.get(&address).map_or(0, |word| word.1);
                assert_eq!(master.read(address), expected, "{bus:?}, {address:#x}");
            }
            for _ in 0..master.rng.in_range(0, 2) {
                master.tick();
            }
        }
    }
}

#[test]
fn a_trigger_over_the_bus_brings_the_positions_of_both_encoders() {
    for bus in WORD_BUSES {
        let mut master = Master::new(bus, "");
        for round in 1..=3u32 {
            master.bench.run_cycles(5_000);
            master.write(at(&CARD, "trigger_now", 0), 1);
            master.bench.run_cycles(60_000);
            for channel in 0..2 {
                let status = master.read(at(&RESULT, "status", channel));
                let low = master.read(at(&RESULT, "position_low", channel));
                let frame = master.bench.frames(channel).last().expect("a frame");
                assert_eq!(u64::from(low), frame.position, "{bus:?}");
                assert_eq!(status & 0xffff, round, "{bus:?}: sequence");
                assert_eq!(status >> 16 & 0xff, 0xc0, "{bus:?}: fresh, valid, no cause");
            }
            assert_eq!(master.read(at(&CARD, "trigger_count", 0)), round);
        }
    }
}

/// Words that are read upwards belong together while results come in all the time.
#[test]
fn words_read_upwards_are_of_one_moment() {
    for bus in WORD_BUSES {
        let mut master = Master::new(bus, "");
        master.write(at(&CARD_CONFIG, "trigger_sources", 0), 2);
        master.write(at(&CARD_CONFIG, "trigger_period", 0), 5_200);
        master.bench.run_cycles(60_000);
        let mut seen = BTreeMap::new();
        let mut stamps = 0;
        for _ in 0..1_500 {
            let sequence = master.read(at(&RESULT, "status", 0)) & 0xffff;
            let pause = master.rng.in_range(0, 300);
            master.bench.run_cycles(pause);
            let low = master.read(at(&RESULT, "position_low", 0));
            let stamp = master.read(at(&RESULT, "timestamp", 0));
            let other = master.read(at(&RESULT, "timestamp", 1));
            assert_eq!(stamp, other, "{bus:?}: both channels of one trigger");
            let first = *seen.entry(sequence).or_insert((low, stamp));
            assert_eq!(first, (low, stamp), "{bus:?}: of one moment");
            stamps = stamps.max(seen.len());
        }
        assert!(stamps > 50, "{stamps} results");
    }
}

#[test]
fn a_moment_ends_by_itself_and_with_a_lower_address() {
    let mut master = Master::new(HostBus::Apb, "");
    let (status, stamp) = (at(&RESULT, "status", 0), at(&RESULT, "timestamp", 0));
    let trigger = |master: &mut Master| {
        master.write(at(&CARD, "trigger_now", 0), 1);
        // Sooner or later the result comes: it does not follow while `reading`.
        master.bench.run_cycles(60_000);
    };
    trigger(&mut master);
    let first = master.read(status) & 0xffff;
    let old = master.read(stamp);
    // The next result comes long after the moment has ended, with no read in between.
    trigger(&mut master);
    assert_ne!(master.read(stamp), old, "the moment has ended by itself");
    assert_eq!(master.read(status) & 0xffff, first + 1);
    // A result that comes within the moment: it is seen with a lower address only. Of 150 delays of the read some hit it.
    let mut both = [0; 2];
    for delay in 0..150 {
        master.bench.run_cycles(5_000);
        master.write(at(&CARD, "trigger_now", 0), 1);
        master.bench.run_cycles(1_400 + 10 * delay);
        let before = master.read(status) & 0xffff;
        master.bench.run_cycles(500);
        let count = master.read(status + 1); // goes on
        let after = master.read(status) & 0xffff;
        assert!(after == before || after == before + 1);
        both[usize::from(after != before)] += 1;
        assert!(count > 0);
    }
    assert!(both[0] > 10 && both[1] > 10, "{both:?}");
}

/// Each read of the same address begins a new snapshot, however fast the reads follow each other.
#[test]
fn a_master_that_polls_one_address_sees_the_next_result() {
    for bus in WORD_BUSES {
        let mut master = Master::new(bus, "");
        for name in ["status", "timestamp"] {
            master.bench.run_cycles(60_000); // the channel takes a trigger
            let address = at(&RESULT, name, 0);
            let before = master.read(address);
            master.write(at(&CARD, "trigger_now", 0), 1);
            let end = master.bench.cycle() + 60_000;
            while master.read(address) == before {
                assert!(master.bench.cycle() < end, "{bus:?}: {name} stays");
            }
        }
    }
}

#[test]
fn an_access_takes_the_cycles_that_the_page_says() {
    let status = at(&RESULT, "status", 0);
    // The master of AXI4-Lite makes pauses.
    for bus in WORD_BUSES.into_iter().filter(|b| *b != HostBus::AxiLite) {
        let mut master = Master::new(bus, "");
        // Request and answer of the bus take 2 cycles and one more.
        for (address, write, cycles) in [
            (0, None, 20),
            (status, None, 23),
            (status + 1, None, 20),
            (status + 1, None, 23),
            (7, Some(0), 8),
            (0x100, None, 12 * 3 + 7),
            (0x100, Some(1), 12 * 3 + 7),
        ] {
            let answer = master.access(address, write);
            assert_eq!(answer.cycles, cycles, "{bus:?}: {address:#x}, {write:?}");
        }
    }
}
