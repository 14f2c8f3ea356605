//! The bus of the signal processor.

use super::rig::Rig;
use endat_hdl::protocols::t_format::dsp::TFormatStart;
use endat_sim::t_format::EncoderConfig;

fn asked() -> Rig {
    let config = EncoderConfig {
        single_turn: 0x0A_1B2C,
        multi_turn: 0x00_4D5E,
        encoder_id: 0x11,
        ..EncoderConfig::default()
    };
    let mut rig = Rig::new(20, config);
    rig.exchange(3);
    rig
}

#[test]
fn seven_addresses_say_what_the_map_says() {
    let mut rig = asked();
    let words: Vec<u16> = (0..7).map(|address| rig.read(address)).collect();
    // Request ID | control data, ABS | ABS, ABS | ENID, ABM | ABM | ALMC, SF | CRC, communication alarm.
    assert_eq!(
        words,
        [0x0003, 0x2C93, 0x0A1B, 0x5E11, 0x004D, 0x20C8, 0x00CD]
    );
}

#[test]
fn data_are_valid_four_clocks_after_the_address_and_held_for_five() {
    let mut rig = asked();
    let expected: Vec<u16> = (0..7).map(|address| rig.read(address)).collect();
    (rig.pins.cs_n, rig.pins.rd_n, rig.pins.address) = (false, false, 7);
    rig.steps(10);
    // Each address is held for five clocks; records the data before each clock.
    let mut seen = vec![];
    for address in 1..7 {
        rig.pins.address = address;
        for _ in 0..5 {
            seen.push(rig.bus().0);
            rig.step();
        }
    }
    for (index, word) in expected[1..6].iter().enumerate() {
        let from = 5 * index;
        assert_eq!(seen[from + 4..from + 9], [*word; 5], "{index}");
        assert_ne!(seen[from + 3], *word, "not sooner");
    }
}

#[test]
fn a_moment_is_taken_by_address_0_and_stays() {
    let mut rig = asked();
    let before = rig.map();
    rig.encoder.config.single_turn = 0x7F_FFFF;
    rig.write(0, 0);
    rig.wait_us(60);
    let words: Vec<u16> = (1..3).map(|address| rig.read(address)).collect();
    assert_eq!(
        u32::from(words[0] >> 8) | u32::from(words[1]) << 8,
        before.single_turn
    );
    assert_eq!(rig.map().single_turn, 0x7F_FFFF);
}

#[test]
fn the_fast_rate_is_a_setting() {
    for mhz in [20, 60] {
        let config = EncoderConfig {
            bit_hz: 5_000_000,
            single_turn: 0x12_3456,
            ..EncoderConfig::default()
        };
        let mut rig = Rig::new(mhz, config);
        assert!(!rig.exchange(3).fresh);
        rig.wait_us(100);
        let rig_violations = rig.encoder.violations().len();
        let fast = TFormatStart {
            fast: true,
            ..TFormatStart::default()
        };
        rig.write(6, fast.word() as u16);
        for rate_error_ppm in [-20_000, 0, 20_000] {
            rig.encoder.config.rate_error_ppm = rate_error_ppm;
            let map = rig.exchange(3);
            assert!(
                map.fresh && map.single_turn == 0x12_3456,
                "{mhz} MHz {map:?}"
            );
        }
        assert_eq!(rig.encoder.violations().len(), rig_violations);
    }
}

#[test]
fn settings_stand_still_in_an_exchange() {
    let mut rig = asked();
    rig.write(0, 3);
    rig.wait_us(5);
    rig.write(7, 0x1234);
    rig.write(6, 0);
    rig.write(0, 1);
    let map = rig.finish();
    assert!(map.fresh && map.overrun && map.request_id == 3);
    rig.wait_us(20);
    assert!(!rig.exchange(3).overrun);
}
