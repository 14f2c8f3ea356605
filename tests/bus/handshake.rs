//! What each bus has of its own: back to back, left in the middle, refused.

use super::Master;
use endat_hdl::card::bus::HostBus;
use endat_hdl::regs::ID;

/// A scratch word.
const SCRATCH: u32 = 0x108 << 2;

#[test]
fn apb_transfers_follow_each_other_without_a_pause() {
    let mut master = Master::new(HostBus::Apb, "");
    let mut ready = 0;
    master.set("s_apb_psel", 1);
    master.set("s_apb_paddr", 0);
    for _ in 0..200 {
        master.set("s_apb_penable", 0);
        master.tick();
        master.set("s_apb_penable", 1);
        master.wait_for(&["s_apb_pready"]);
        assert_eq!(master.bench.get("s_apb_prdata") as u32, ID);
        master.tick();
        assert!(!master.high("s_apb_pready"));
        ready += 1;
    }
    assert_eq!(ready, 200);
}

#[test]
fn apb_refuses_an_address_between_words_and_does_nothing() {
    let mut master = Master::new(HostBus::Apb, "");
    let before = master.transfer(SCRATCH, None, 15).word;
    for low in 1..4 {
        let answer = master.transfer(SCRATCH | low, Some(!before), 15);
        assert!(answer.refused && answer.cycles == 2);
    }
    assert_eq!(master.transfer(SCRATCH, None, 15).word, before);
}

/// Whatever cycle a master leaves in, the next transfer is its own.
#[test]
fn a_transfer_that_is_left_answers_nobody() {
    for bus in [HostBus::Apb, HostBus::Wishbone] {
        let mut master = Master::new(bus, "");
        let word = master.transfer(SCRATCH, None, 15).word;
        let (select, answers): (&[&str], &[&str]) = match bus {
            HostBus::Apb => (&["s_apb_psel", "s_apb_penable"], &["s_apb_pready"]),
            _ => (&["wb_cyc_i", "wb_stb_i"], &["wb_ack_o", "wb_err_o"]),
        };
        for cycles in 1..60 {
            for (address, byte) in [("s_apb_paddr", 0), ("wb_adr_i", 0)] {
                if master.bench.has_port(address) {
                    master.set(address, byte);
                }
            }
            master.set(
                if bus == HostBus::Apb {
                    "s_apb_pwrite"
                } else {
                    "wb_we_i"
                },
                0,
            );
            for name in select {
                master.set(name, 1);
            }
            let mut answered = false;
            for _ in 0..cycles {
                answered |= answers.iter().any(|name| master.high(name));
                master.tick();
                if answered {
                    break;
                }
            }
            for name in select {
                master.set(name, 0);
            }
            if answered {
                continue;
            }
            let pause = master.rng.in_range(1, 3);
            for _ in 0..pause {
                master.tick();
                assert!(!answers.iter().any(|name| master.high(name)), "{bus:?}");
            }
            let answer = master.transfer(SCRATCH, None, 15);
            assert_eq!(answer.word, word, "{bus:?}: left after {cycles} cycles");
        }
    }
}

/// A master that stays in SETUP and then changes its mind has asked for what it enables, and for nothing else.
#[test]
fn apb_takes_what_is_enabled_however_long_the_setup() {
    const OTHER: u32 = 0x109 << 2;
    let mut master = Master::new(HostBus::Apb, "");
    for held in 1..12 {
        let before = master.transfer(SCRATCH, None, 15).word;
        let value = 0x1234_0000 | held;
        master.set("s_apb_psel", 1);
        master.set("s_apb_penable", 0);
        master.set("s_apb_pwrite", 1);
        master.set("s_apb_paddr", SCRATCH);
        master.set("s_apb_pwdata", !before);
        master.bench.run_cycles(u64::from(held));
        let answer = master.transfer(OTHER, Some(value), 15);
        assert!(!answer.refused);
        assert_eq!(master.transfer(SCRATCH, None, 15).word, before, "{held}");
        assert_eq!(master.transfer(OTHER, None, 15).word, value, "{held}");
    }
}

/// A write that is left in its first cycle writes nothing: its word may be gone already.
#[test]
fn a_write_that_is_left_at_once_does_nothing() {
    let mut master = Master::new(HostBus::Wishbone, "");
    let before = master.transfer(SCRATCH, None, 15).word;
    master.set("wb_we_i", 1);
    master.set("wb_dat_i", !before);
    master.set("wb_sel_i", 15);
    master.set("wb_cyc_i", 1);
    master.set("wb_stb_i", 1);
    master.tick();
    master.set("wb_stb_i", 0);
    master.set("wb_dat_i", 0);
    master.bench.run_cycles(100);
    assert_eq!(master.transfer(SCRATCH, None, 15).word, before);
}

#[test]
fn a_part_of_a_word_is_refused() {
    for bus in [HostBus::Wishbone, HostBus::AxiLite] {
        let mut master = Master::new(bus, "");
        let before = master.transfer(SCRATCH, None, 15).word;
        for selects in 1..15 {
            assert!(
                master.transfer(SCRATCH, Some(!before), selects).refused,
                "{bus:?}"
            );
            assert_eq!(master.transfer(SCRATCH, None, 15).word, before, "{bus:?}");
        }
        let nothing = master.transfer(SCRATCH, Some(!before), 0);
        assert_eq!(nothing.refused, bus == HostBus::Wishbone);
        assert_eq!(master.transfer(SCRATCH, None, 15).word, before);
        assert!(!master.transfer(SCRATCH, Some(!before), 15).refused);
        assert_eq!(master.transfer(SCRATCH, None, 15).word, !before);
    }
}

/// Neither direction waits for an answer of the other one that nobody takes.
#[test]
fn axi_directions_do_not_wait_for_each_other() {
    let mut master = Master::new(HostBus::AxiLite, "");
    // A read whose answer is not taken.
    master.set("s_axi_araddr", 0);
    master.set("s_axi_arvalid", 1);
    master.tick();
    master.set("s_axi_arvalid", 0);
    master.wait_for(&["s_axi_rvalid"]);
    for value in 1..20 {
        assert!(!master.transfer(SCRATCH, Some(value), 15).refused);
        assert!(master.high("s_axi_rvalid"));
        assert_eq!(master.bench.get("s_axi_rdata") as u32, ID);
    }
    master.set("s_axi_rready", 1);
    master.tick();
    master.set("s_axi_rready", 0);
    // A write whose answer is not taken.
    master.set("s_axi_awaddr", SCRATCH);
    master.set("s_axi_wdata", 77);
    master.set("s_axi_wstrb", 15);
    master.set("s_axi_awvalid", 1);
    master.set("s_axi_wvalid", 1);
    master.tick();
    master.set("s_axi_awvalid", 0);
    master.set("s_axi_wvalid", 0);
    master.wait_for(&["s_axi_bvalid"]);
    for _ in 0..20 {
        assert_eq!(master.transfer(SCRATCH, None, 15).word, 77);
        assert!(master.high("s_axi_bvalid"));
    }
}

/// READY does not depend on VALID within a cycle.
#[test]
fn axi_ready_comes_from_registers() {
    let mut master = Master::new(HostBus::AxiLite, "");
    for _ in 0..400 {
        for channel in ["aw", "w", "ar"] {
            let (valid, ready) = (
                format!("s_axi_{channel}valid"),
                format!("s_axi_{channel}ready"),
            );
            master.set(&valid, 0);
            let without = master.high(&ready);
            master.set(&valid, 1);
            assert_eq!(master.high(&ready), without, "{channel}");
            let keep = master.rng.in_range(0, 1);
            master.set(&valid, keep as u32);
        }
        let (b, r) = (master.rng.in_range(0, 1), master.rng.in_range(0, 1));
        master.set("s_axi_bready", b as u32);
        master.set("s_axi_rready", r as u32);
        master.tick();
    }
}

/// The next address stands beside the data, whether the bus says in the waits that it is ready or not; words of one moment come in any order.
#[test]
fn ahb_transfers_stand_beside_each_other() {
    for is_alone in [false, true] {
        let mut master = Master::new(HostBus::AhbLite, "");
        let before: Vec<u32> = [0, 1, 2]
            .map(|n| master.transfer(SCRATCH + 4 * n, None, 15).word)
            .into();
        // Read, write, read, write, ... of three words: each write turns what the read before it has shown.
        let mut shown = vec![];
        let order = (0..12).map(|n| (SCRATCH + 4 * (n / 2 % 3), n % 2 == 1));
        let order: Vec<(u32, bool)> = order.collect();
        for at in 0..=order.len() {
            match order.get(at) {
                Some((address, writes)) => {
                    master.set("s_ahb_hsel", 1);
                    master.set("s_ahb_htrans", 2);
                    master.set("s_ahb_haddr", *address);
                    master.set("s_ahb_hwrite", (*writes).into());
                    master.set("s_ahb_hsize", 2);
                }
                None => master.set("s_ahb_htrans", 0),
            }
            // The data phase of the one before.
            for _ in 0..300 {
                if master.high("s_ahb_hreadyout") {
                    break;
                }
                master.set("s_ahb_hready", is_alone.into());
                master.tick();
            }
            assert!(master.high("s_ahb_hreadyout") && !master.high("s_ahb_hresp"));
            if at > 0 && !order[at - 1].1 {
                shown.push(master.bench.get("s_ahb_hrdata") as u32);
            }
            master.set("s_ahb_hready", 1);
            master.tick();
            let word = shown.last().map_or(0, |word| !word);
            master.set("s_ahb_hwdata", word);
        }
        let twice: Vec<u32> = before
            .iter()
            .copied()
            .chain(before.iter().map(|w| !w))
            .collect();
        assert_eq!(shown, twice, "{is_alone}");
    }
}

#[test]
fn ahb_refuses_what_is_no_word_in_two_cycles_and_does_nothing() {
    let mut master = Master::new(HostBus::AhbLite, "");
    let before = master.transfer(SCRATCH, None, 15).word;
    for (low, selects) in [(1, 15), (2, 15), (0, 1)] {
        let answer = master.transfer(SCRATCH | low, Some(!before), selects);
        assert!(answer.refused && answer.cycles == 3, "{answer:?}");
    }
    assert_eq!(master.transfer(SCRATCH, None, 15).word, before);
    // Another one's transfer, and none at all.
    for (select, trans) in [(0, 2), (1, 0), (1, 1)] {
        master.set("s_ahb_hsel", select);
        master.set("s_ahb_htrans", trans);
        master.set("s_ahb_hwrite", 1);
        master.set("s_ahb_haddr", SCRATCH);
        master.set("s_ahb_hwdata", !before);
        for _ in 0..60 {
            master.tick();
            assert!(master.high("s_ahb_hreadyout"));
        }
    }
    assert_eq!(master.transfer(SCRATCH, None, 15).word, before);
}
