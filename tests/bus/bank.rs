//! The bank behind a front that keeps no promise: whatever comes, the ring of configuration words comes home.

use crate::bus_card::text;
use crate::stream_rig::Named;
use endat_config::parse;
use endat_hdl::card::bus::HostBus;
use endat_hdl::card::register_bank::{ring_bytes, RegisterBank};
use endat_sim::rng::Rng;

/// Everything that a front says changes at random in the middle of accesses, and accesses come while one is busy.
#[test]
fn no_front_can_leave_the_ring_between_two_words() {
    let mut rng = Rng::new(16);
    for channels in [1usize, 2, 8] {
        let more = "[[channel]]\nposition_bits = 25\ncommand = \"111000\"\n".repeat(6);
        let mut config = parse("card.toml", &text(HostBus::Apb, &more)).unwrap().card;
        config.channels.truncate(channels);
        let mut bank = Named::new(RegisterBank::new(&config), "bank");
        bank.set("reset", true);
        bank.tick();
        bank.set("reset", false);
        bank.set("in_range", true);
        let whole = ring_bytes(channels) as u64;
        let mut turned = 0;
        for round in 0..2_000 {
            // Now and then a front that changes nothing, so that turns are whole ones, too.
            let patience = rng.in_range(1, 12);
            for _ in 0..rng.in_range(1, 150) {
                if rng.in_range(0, patience) == 0 {
                    // Half of them configuration words.
                    let config_word = 0x100 + rng.in_range(0, 0x4f);
                    let address = match rng.in_range(0, 1) {
                        0 => config_word,
                        _ => rng.in_range(0, 0x7ff),
                    };
                    bank.set("word_address", address);
                    bank.set("write", rng.in_range(0, 1));
                    bank.set("lane", rng.in_range(0, 3));
                    bank.set("in_range", rng.in_range(0, 7) != 0);
                }
                bank.set("access", rng.in_range(0, 2 * patience) == 0);
                bank.tick();
                turned += bank.get("ring_turn");
            }
            bank.set("access", false);
            for _ in 0..whole + 20 {
                bank.tick();
                turned += bank.get("ring_turn");
            }
            assert_eq!(turned % whole, 0, "{channels} channels, round {round}");
        }
        assert!(turned > 100 * whole, "{turned} steps of the ring");
    }
}
