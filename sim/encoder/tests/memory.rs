//! Memory areas, protection and access times.

use super::*;

fn master() -> Master {
    Master::new(quick(), 2_000_000)
}

/// Reads with EnDat 2.1 commands.
fn read(m: &mut Master, mrs: u8, address: u8) -> Option<u16> {
    m.ask(SELECT, mrs, 0)?;
    m.ask(READ, address, 0).map(|p| p.data)
}

fn write(m: &mut Master, mrs: u8, address: u8, data: u16) -> Option<u16> {
    m.ask(SELECT, mrs, 0)?;
    let echo = m.ask(WRITE, address, data);
    m.wait(13 * MS);
    echo.map(|p| p.data)
}

/// Reads with EnDat 2.2 commands, while positions continue.
fn read_22(m: &mut Master, mrs: u8, address: u8) -> u16 {
    let before = m.infos;
    m.position22(SELECT_22, mrs, 0);
    m.position22(READ_22, address, 0);
    m.select(0x45, 1);
    let low = m.position22(SELECT_22, 0x46, 0)[0].data;
    let high = m.position22(SELECT_22, 0x4F, 0)[0].data;
    m.infos = before;
    assert_eq!([low >> 8, high >> 8], [u16::from(address); 2]);
    high << 8 | low & 0xFF
}

#[test]
fn areas_have_their_addresses_and_no_others() {
    for (mrs, first, last) in [
        (0xA1, 0x04, 0x0F),
        (0xA3, 0x00, 0x0F),
        (0xA5, 0x00, 0x0F),
        (0xA7, 0x00, 0x0F),
        (0xB9, 0x00, 0x03),
        (0xBD, 0x00, 0x3F),
    ] {
        let mut m = master();
        for address in [first, last] {
            let word = read(&mut m, mrs, address);
            assert_eq!(word, m.encoder.word(mrs, address));
            assert!(word.is_some(), "{mrs:#X} {address}");
            assert_eq!(word, Some(read_22(&mut m, mrs, address)));
        }
        assert_eq!(m.violations(), []);
        for address in [first.wrapping_sub(1), last + 1] {
            let mut m = master();
            assert_eq!(read(&mut m, mrs, address), None, "{mrs:#X} {address}");
            assert_eq!(m.last().refused, Some(ErrorSource::Address));
            m.position22(READ_22, address, 0);
            assert_eq!(m.last().refused, Some(ErrorSource::Address));
        }
    }
}

#[test]
fn areas_must_exist_and_be_selected() {
    let refused = |config, mrs| {
        let mut m = Master::new(config, 2_000_000);
        assert_eq!(m.ask(SELECT, mrs, 0), None, "silence");
        m.last().refused
    };
    let old = || EncoderConfig::endat21(13);
    assert_eq!(refused(quick(), 0x12), Some(ErrorSource::MrsCode));
    assert_eq!(refused(quick(), 0xA2), Some(ErrorSource::MrsCode));
    assert_eq!(refused(quick(), 0xB1), Some(ErrorSource::MrsNotAllowed));
    assert_eq!(refused(old(), 0xBD), Some(ErrorSource::MrsNotAllowed));
    let mut m = master();
    assert_eq!(m.ask(READ, 13, 0), None, "no area yet");
    assert_eq!(m.last().refused, Some(ErrorSource::Address));
    m.position22(SELECT_22, 0x12, 0);
    assert_eq!(m.last().refused, Some(ErrorSource::MrsCode));
}

#[test]
fn words_are_written_and_kept_by_both_command_sets() {
    let mut m = master();
    assert_eq!(write(&mut m, 0xA7, 0x0F, 0xBEEF), Some(0xBEEF));
    assert_eq!(read(&mut m, 0xA7, 0x0F), Some(0xBEEF));
    m.position22(SELECT_22, 0xA7, 0);
    m.position22(WRITE_22, 0x0E, 0xCAFE);
    m.wait(13 * MS);
    assert_eq!(read_22(&mut m, 0xA7, 0x0E), 0xCAFE);
    assert_eq!(read_22(&mut m, 0xA7, 0x0F), 0xBEEF);
    assert_eq!(m.violations(), []);
}

#[test]
fn the_manufacturers_words_are_protected() {
    let mut m = master();
    for (mrs, address) in [(0xA1, 13), (0xA3, 1), (0xA5, 5), (0xBD, 25)] {
        let word = m.encoder.word(mrs, address).unwrap();
        let echo = write(&mut m, mrs, address, !word);
        assert_eq!(echo, Some(word), "the echo has the stored word");
        let frames = m.encoder.frames();
        let refused = frames.iter().rev().find_map(|f| f.refused);
        assert_eq!(refused, Some(ErrorSource::Protected));
        m.position22(WRITE_22, address, !word);
        assert_eq!(m.last().refused, Some(ErrorSource::Protected));
        m.wait(13 * MS);
        m.select(0x46, 1);
        let acknowledged = m.position22(POSITION_22, 0, 0)[0].data;
        assert_eq!(acknowledged, u16::from(address) << 8 | word >> 8);
        assert_eq!(m.encoder.word(mrs, address), Some(word));
        m.select(0x4F, 0);
    }
}

#[test]
fn write_protection_can_be_set_and_never_reset() {
    let mut m = master();
    write(&mut m, 0xA7, 5, 0x1111);
    assert_eq!(write(&mut m, 0xB9, 2, 0b001), Some(0b001));
    assert_eq!(write(&mut m, 0xA7, 5, 0x2222), Some(0x1111));
    assert_eq!(m.last().refused, Some(ErrorSource::Protected));
    assert_eq!(
        write(&mut m, 0xA9, 5, 0x2222),
        Some(0x2222),
        "another bit's"
    );
    assert_eq!(write(&mut m, 0xB9, 2, 0b010), Some(0b001));
    assert_eq!(m.last().refused, Some(ErrorSource::ClearProtection));
    assert_eq!(
        write(&mut m, 0xB9, 2, 0b011),
        Some(0b011),
        "more may be set"
    );
    assert_eq!(write(&mut m, 0xA9, 5, 0x3333), Some(0x2222));
    m.ask(RESET, 0, 0);
    m.wait(60 * MS);
    assert_eq!(m.encoder.word(0xB9, 2), Some(0b011));
    assert_eq!(m.encoder.word(0xA7, 5), Some(0x1111));
}

#[test]
fn a_write_is_busy_for_twelve_milliseconds() {
    let mut m = master();
    m.select(0x47, 1);
    m.position22(SELECT_22, 0xA7, 0);
    m.position22(WRITE_22, 0x0E, 0xCAFE);
    let written = m.last().last_rise;
    let busy = |m: &mut Master| m.position22(POSITION_22, 0, 0)[0].address & 0x20 != 0;
    assert!(busy(&mut m));
    assert_eq!(m.encoder.word(0xA7, 0x0E), Some(0));
    m.wait(written + 11_900 * US - m.now);
    assert!(busy(&mut m));
    m.wait(written + 12_000 * US - m.now);
    assert!(!busy(&mut m));
    assert_eq!(m.encoder.word(0xA7, 0x0E), Some(0xCAFE));
    assert_eq!(m.violations(), []);
}

#[test]
fn a_read_is_busy_for_its_access_time_and_keeps_the_old_result_until_then() {
    let mut config = quick();
    config.tac = 500 * US..=500 * US;
    let mut m = Master::new(config, 2_000_000);
    m.position22(SELECT_22, 0xA1, 0);
    m.wait(MS);
    m.select(0x45, 1);
    m.position22(READ_22, 13, 0);
    let busy = m.position22(POSITION_22, 0, 0)[0];
    assert_eq!((busy.address, busy.data), (0x25, 0));
    m.wait(MS);
    let done = m.position22(POSITION_22, 0, 0)[0];
    assert_eq!((done.address, done.data), (0x05, 0x0D0D));
}

#[test]
fn nothing_else_is_accessed_while_busy() {
    let mut m = master();
    m.position22(SELECT_22, 0xA7, 0);
    m.position22(POSITION_22, 0, 0);
    m.position22(WRITE_22, 0x0E, 0xCAFE);
    for (code, address) in [(SELECT_22, 0xA1), (READ_22, 0), (WRITE_22, 0), (TEST_22, 0)] {
        m.position22(code, address, 1);
        assert_eq!(m.last().refused, Some(ErrorSource::Address), "{code:06b}");
    }
    for code in [SELECT, READ, WRITE] {
        let mut m = master();
        write(&mut m, 0xA7, 1, 1);
        m.ask(WRITE, 0x0E, 0xCAFE);
        assert_eq!(m.ask(code, 0xA1, 0), None);
        let frames = m.encoder.frames();
        assert_eq!(frames.last().unwrap().refused, Some(ErrorSource::Address));
    }
    m.select(0x4C, 1); // additional data are not memory
    assert_eq!(m.last().refused, None);
    m.wait(13 * MS);
    assert_eq!(m.encoder.word(0xA7, 0x0E), Some(0), "not yet seen");
    m.position22(POSITION_22, 0, 0);
    assert_eq!(m.encoder.word(0xA7, 0x0E), Some(0xCAFE));
    assert_eq!(m.encoder.word(0xA7, 0), Some(0));
}

#[test]
fn alarms_are_latched_and_cleared_in_three_ways() {
    let clear: [fn(&mut Master); 3] = [
        |m| assert_eq!(write(m, 0xB9, 0, 0), Some(0)),
        |m| assert_eq!(m.position22_with_alarm(ERROR_RESET), [true, false]),
        |m| {
            m.ask(RESET, 0, 0);
            m.wait(60 * MS);
        },
    ];
    for clear in clear {
        let mut m = master();
        m.encoder.add_cause(Cause {
            during: MS..2 * MS,
            alarms: 0b1_0001,
            warnings: 1,
        });
        m.wait(3 * MS);
        assert_eq!(read(&mut m, 0xB9, 0), Some(0b1_0001));
        assert_eq!(read(&mut m, 0xB9, 1), Some(1));
        assert_eq!(
            write(&mut m, 0xB9, 0, 0b1),
            Some(0b1_0001),
            "not single bits"
        );
        assert_eq!(m.position22_with_alarm(POSITION_22), [true, false]);
        clear(&mut m);
        m.position22(POSITION_22, 0, 0); // checks F1 and F2
        assert_eq!(m.encoder.word(0xB9, 0), Some(0));
    }
}

#[test]
fn alarms_and_warnings_are_cleared_one_by_one() {
    let mut m = master();
    m.encoder.add_cause(Cause {
        during: MS..2 * MS,
        alarms: 1,
        warnings: 1,
    });
    m.wait(3 * MS);
    write(&mut m, 0xB9, 1, 0);
    assert_eq!(read(&mut m, 0xB9, 0), Some(1));
    assert_eq!(read(&mut m, 0xB9, 1), Some(0));
}

#[test]
fn an_alarm_after_the_clearing_write_stays() {
    let mut m = master();
    m.ask(SELECT, 0xB9, 0);
    m.ask(WRITE, 0, 0);
    let written = m.last().last_rise + 12 * MS;
    m.encoder.add_cause(Cause {
        during: written + MS..written + 2 * MS,
        alarms: 1,
        warnings: 0,
    });
    m.wait(20 * MS);
    assert_eq!(m.position22_with_alarm(POSITION_22), [true, false]);
}

#[test]
fn an_alarm_with_a_lasting_cause_comes_back() {
    let mut m = master();
    m.encoder.add_cause(Cause {
        during: 0..Time::MAX,
        alarms: 0b10,
        warnings: 0b1,
    });
    assert_eq!(m.position22_with_alarm(ERROR_RESET), [true, false]);
    assert_eq!(m.position22_with_alarm(POSITION_22), [true, false]);
    write(&mut m, 0xB9, 1, 0);
    assert_eq!(read(&mut m, 0xB9, 1), Some(1));
}

#[test]
fn error_sources_stay_until_they_are_reset() {
    let mut m = master();
    m.position22(SELECT_22, 0x12, 0);
    m.position22(SELECT_22, 0xB1, 0);
    m.select(0x59, 1);
    let sources = ErrorSource::MrsCode.bit() | ErrorSource::MrsNotAllowed.bit();
    assert_eq!(m.position22(POSITION_22, 0, 0)[0].data, sources);
    assert_eq!(m.position22(ERROR_RESET, 0, 0)[0].data, sources);
    assert_eq!(m.position22(POSITION_22, 0, 0)[0].data, 0);
}

#[test]
fn the_datum_shift_moves_the_position() {
    let mut config = EncoderConfig::endat22(25).position(PositionSource::Fixed(0x1234));
    config.tac = 0..=0;
    let mut m = Master::new(config, 2_000_000);
    write(&mut m, 0xA7, 0, 0xFFFE);
    m.position22(POSITION_22, 0, 0);
    assert_eq!(m.last().position, 0x1_1232, "word 0 is the low word");
    write(&mut m, 0xA7, 1, 0xFFFF);
    m.position22(POSITION_22, 0, 0);
    assert_eq!(m.last().position, 0x1232, "the shift is signed");
}
