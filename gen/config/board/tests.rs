//! Boards and families that come with the program, and what is wrong with others.

use super::*;

#[test]
fn every_board_is_good_and_its_usual_places_are_free_pins() {
    for name in names() {
        let board = Board::named(name).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(board.places().count() >= 12, "{name}");
        for place in board.wing.values() {
            assert!(board.pin(place).is_ok(), "{name}: {place}");
        }
    }
}

#[test]
fn pins_are_found_by_number_and_by_position() {
    let board = Board::named("papilio_pro").unwrap();
    assert_eq!(board.pin("c8"), Ok("P123".into()));
    assert_eq!(board.pin("P48"), Ok("P48".into()));
    assert_eq!(board.position("P123"), "C8");
    for (word, text) in [
        ("P145", "P1..P144"),
        ("P0", "P1..P144"),
        ("P9", "not on a connector"),
        ("C16", "neither a pin"),
        ("", "neither a pin"),
        ("Pä", "neither a pin"),
    ] {
        assert!(board.pin(word).unwrap_err().contains(text), "{word}");
    }
    // The package has letters of its own, and a place of a connector is none of its pins.
    let board = Board::named("ulx3s").unwrap();
    let told = |word| board.pin(word).unwrap_err();
    assert!(told("gp77").starts_with("is not on a connector of ulx3s; "));
    assert!(
        told("gz77").contains("no such pin, the package of LFE5U-85F-6BG381C has A1..Y20; use ")
    );
}

#[test]
fn the_clock_manager_makes_the_system_clocks_of_the_presets() {
    let board = Board::named("papilio_pro").unwrap();
    for hz in [100_000_000, 128_000_000, 50_000_000] {
        let pll = board.pll(hz).unwrap();
        assert_eq!(32_000_000 / pll.divide * pll.multiply, pll.vco_hz);
        assert_eq!(pll.vco_hz / pll.output_divide, hz);
        assert!(board.family.clock_manager.vco_hz.contains(&pll.vco_hz));
    }
    let told = |hz| board.pll(hz).unwrap_err();
    assert!(told(99_999_999).contains("use 99200000 or 100000000 Hz"));
    // The next one up, 256 MHz, is more than the core is made for.
    assert!(told(249_000_000).ends_with("use 248000000 Hz"));
}
