//! Memory content of real devices, as read by a receiver.

use super::*;

/// Reads a word at 200 kHz.
fn read(m: &mut Master, word: u8) -> u16 {
    let (mrs, address) = match word {
        0..16 => (0xA1, word),
        16..32 => (0xA3, word - 16),
        _ => (0xA5, word - 32),
    };
    m.wait(MS);
    m.ask(SELECT, mrs, 0).unwrap();
    m.wait(MS);
    m.ask(READ, address, 0).unwrap().data
}

#[test]
fn every_device_can_be_told_from_its_words() {
    for device in DEVICES {
        let mut m = Master::new(device.encoder(), 200_000);
        let w = |m: &mut Master, word| u32::from(read(m, word));
        assert_eq!(
            w(&mut m, 13) & 0x3F,
            device.position_bits,
            "{}",
            device.name
        );
        assert_eq!(w(&mut m, 14) >> 15 == 1, device.rotary);
        assert_eq!(w(&mut m, 17), u32::from(device.revolutions));
        let steps = w(&mut m, 21) << 16 | w(&mut m, 20);
        assert_eq!(steps, device.measuring_steps);
        if device.rotary {
            let turns = device.encoder().plate.multiturn_bits();
            let width = steps.ilog2() + turns;
            assert_eq!(width, device.position_bits, "{}", device.name);
        }
        assert_eq!(w(&mut m, 16) << 16 | w(&mut m, 15), device.signal_periods);
        assert_eq!(w(&mut m, 37) & 0b11 == 0b01, device.endat22);
        assert_eq!(w(&mut m, 37) >> 2 & 0b11 == 0b01, device.safety);
        assert_eq!(m.violations(), [], "{}", device.name);
        m.wait(MS);
        let area = m.ask(SELECT, area::MANUFACTURER_22, 0);
        assert_eq!(area.is_some(), device.endat22);
        if device.endat22 {
            let max = m.ask(READ, 25, 0).unwrap().data;
            assert_eq!(u64::from(max) * 1000, device.max_clock_hz);
        }
    }
}

#[test]
fn identity_words_are_laid_out_as_described() {
    let mut config = EncoderConfig::endat22(25);
    config.plate.id_letters = *b"ID";
    config.plate.id_number = 0x1234_5678;
    config.plate.serial_letters = *b"AZ";
    config.plate.serial_number = 0x9ABC_DEF0;
    config.plate.alarms = 0x0055;
    config.plate.warnings = 0x0011;
    config.plate.infos_1 = 0x0102;
    config.plate.infos_2 = 0x0304;
    config.tcal = 4_550 * NS;
    let mut m = Master::new(config, 1_000_000);
    let words: Vec<u16> = (24..30).map(|word| read(&mut m, word)).collect();
    // Word 27 ends and word 29 begins with a letter; the number is between them, high byte first.
    assert_eq!(words, [0x4944, 0x5678, 0x1234, 0x9A41, 0xBCDE, 0x5AF0]);
    assert_eq!([read(&mut m, 35), read(&mut m, 36)], [0x0055, 0x0011]);
    assert_eq!([read(&mut m, 8), read(&mut m, 39)], [2, 5]);
    let words = [0, 1].map(|address| m.encoder.word(area::MANUFACTURER_22, address));
    assert_eq!(words, [Some(0x0102), Some(0x0304)], "infos 1 and 2");
    let sources = m.encoder.word(area::MANUFACTURER_22, 35);
    assert_eq!(sources, Some(0x17C7), "error sources 1 to 3, 7 to 11, 13");
}

#[test]
fn an_lc_encoder_does_not_wait_long_with_its_clock_low() {
    let low_for = |device: Device, span| {
        let mut m = Master::new(device.encoder(), 1_000_000);
        m.pulses(POSITION_22, 500 * NS, 15);
        m.edge(false, Drive::Released);
        m.wait(span);
        m.violations()
    };
    assert_eq!(low_for(LC_416, 30 * US - 1), []);
    assert_eq!(low_for(LC_416, 30 * US), [Violation::ClockLowTooLong]);
    assert_eq!(low_for(RCN_8510, 49 * MS), []);
}

#[test]
fn the_ecn_113_knows_no_22_commands() {
    for (code, command) in Command::ALL {
        let mut m = Master::new(ECN_113.encoder(), 1_000_000);
        m.pulses(code, 500 * NS, 12);
        let unknown = m.violations().contains(&Violation::UnknownCommand(code));
        assert_eq!(unknown, command.is_endat22(), "{code:06b}");
    }
}
