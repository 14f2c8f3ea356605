//! Reset, error reset, loss of supply, and the selection of the recovery time.

use super::*;

fn set_recovery(m: &mut Master, word: u16) {
    m.ask(SELECT, area::OPERATING_STATUS, 0);
    m.ask(WRITE, status_word::FUNCTION, word);
    m.wait(13 * MS);
}

/// Recovery time of one frame.
fn recovery(m: &mut Master, code: u8) -> Time {
    let address = match code {
        SELECT | SELECT_22 => area::OPERATING_STATUS,
        _ => status_word::PROTECTION,
    };
    m.exchange(code, Parameter { address, data: 0 });
    m.wait(13 * MS);
    m.last().data_fall.unwrap() - m.last().last_rise
}

#[test]
fn the_short_recovery_time_is_for_22_commands_only() {
    let short = 1_250 * NS..=3_750 * NS;
    let long = 10 * US..=30 * US;
    let mut m = Master::new(quick(), 2_000_000);
    assert!(long.contains(&recovery(&mut m, POSITION_22)));
    set_recovery(&mut m, SHORT_RECOVERY);
    for (code, command) in Command::ALL {
        let range = if command.is_endat22() { &short } else { &long };
        if command != Command::ReceiveReset {
            let tm = recovery(&mut m, code);
            assert!(range.contains(&tm), "{command:?} {tm}");
        }
    }
    m.ask(SELECT, area::OPERATING_STATUS, 0);
    set_recovery(&mut m, LONG_RECOVERY);
    assert!(long.contains(&recovery(&mut m, POSITION_22)));
    set_recovery(&mut m, 0b11);
    assert!(
        long.contains(&recovery(&mut m, POSITION_22)),
        "no valid choice"
    );
    set_recovery(&mut m, SHORT_RECOVERY);
    assert_eq!(m.violations(), []);
}

#[test]
fn the_short_recovery_time_needs_more_than_1_mhz() {
    let at = |hz| {
        let mut m = Master::new(quick(), hz);
        set_recovery(&mut m, SHORT_RECOVERY);
        recovery(&mut m, POSITION_21);
        assert_eq!(m.violations(), []);
        recovery(&mut m, POSITION_22);
        m.violations()
    };
    let period = US;
    let slow = Violation::ShortRecoveryTooSlow { period };
    assert_eq!(at(1_000_000), [slow]);
    assert_eq!(at(1_250_000), []);
}

#[test]
fn an_encoder_without_short_recovery_time_takes_the_long_one() {
    let mut config = quick();
    config.tm_short = None;
    let mut m = Master::new(config, 1_000_000);
    set_recovery(&mut m, SHORT_RECOVERY);
    assert!(recovery(&mut m, POSITION_22) >= 10 * US);
    assert_eq!(m.violations(), []);
}

#[test]
fn a_reset_drops_every_selection_and_keeps_the_memory() {
    let mut m = Master::new(quick(), 2_000_000);
    set_recovery(&mut m, SHORT_RECOVERY);
    m.ask(SELECT, area::OPERATING_PARAMETERS, 0);
    m.ask(WRITE, 7, 0x7777);
    m.wait(13 * MS);
    m.select(0x4C, 1);
    m.select(0x50, 2);
    assert_eq!(m.ask(RESET, 0x5A, 0x1234).unwrap().word(), 0x5A_1234);
    m.wait(51 * MS);
    m.infos = 0;
    assert_eq!(m.position22(POSITION_22, 0, 0), []);
    assert!(recovery(&mut m, POSITION_22) >= 10 * US);
    assert_eq!(m.ask(READ, 7, 0), None, "no area is selected");
    m.ask(SELECT, area::OPERATING_PARAMETERS, 0);
    assert_eq!(m.ask(READ, 7, 0).unwrap().data, 0x7777);
    m.ask(RESET, 0, 0);
    m.wait(51 * MS);
    m.select(0x47, 1);
    assert_eq!(
        m.position22(POSITION_22, 0, 0)[0].data,
        0,
        "no acknowledgement"
    );
}

#[test]
fn nobody_is_listening_for_50_ms_after_a_reset() {
    let after = |wait: Time| {
        let mut m = Master::new(quick(), 2_000_000);
        m.ask(RESET, 0, 0);
        let reset = m.last().last_rise;
        m.wait(reset + wait - m.now);
        assert_eq!(m.encoder.is_ready(m.now), wait >= 50 * MS);
        let seen = m.pulses(POSITION_22, 250 * NS, 32);
        m.wait(40 * US);
        let answered = seen.iter().any(|o| o.symbol == Symbol::Bit(0));
        (answered, m.violations())
    };
    let early = 49_999 * US;
    let violation = Violation::DuringReset { after: early };
    assert_eq!(after(early), (false, vec![violation]));
    assert_eq!(after(50 * MS), (true, vec![]));
    let mut m = Master::new(quick(), 2_000_000);
    m.ask(RESET, 0, 0);
    for _ in 0..2 {
        m.pulses(POSITION_22, 250 * NS, 32);
        m.wait(40 * US);
        assert!(!m.encoder.is_ready(m.now));
    }
    assert_eq!(
        m.violations().len(),
        2,
        "a frame does not shorten the reset"
    );
}

#[test]
fn a_reset_that_is_not_clocked_out_does_nothing() {
    let mut m = Master::new(quick(), 2_000_000);
    m.select(0x4C, 1);
    let bit = |rise| Master::parameter_bit(RESET, Parameter::default(), rise);
    m.pulses_with(bit, 250 * NS, 64);
    m.wait(40 * US);
    assert_eq!(m.position22(POSITION_22, 0, 0).len(), 1);
}

#[test]
fn an_error_reset_drops_the_area_and_perhaps_the_additional_data() {
    for stops in [false, true] {
        let mut config = quick();
        config.error_reset_stops_infos = stops;
        let mut m = Master::new(config, 2_000_000);
        m.position22(SELECT_22, 0xA1, 0);
        m.select(0x4C, 1);
        assert_eq!(m.position22(ERROR_RESET, 0, 0).len(), 1);
        m.infos = u32::from(!stops);
        let infos = m.position22(READ_22, 13, 0).len();
        assert_eq!(infos, usize::from(!stops));
        assert_eq!(m.last().refused, Some(ErrorSource::Address));
        assert_eq!(m.violations(), []);
    }
}

#[test]
fn a_brown_out_in_mid_frame_is_a_restart() {
    let brown_out = Defect::BrownOut {
        after: 10 * US,
        length: 200 * US,
    };
    let mut m = Master::new(quick().defect(2, brown_out), 2_000_000);
    set_recovery(&mut m, LONG_RECOVERY);
    let infos_before = m.encoder.frames().len();
    assert_eq!(infos_before, 2);
    m.pulses(POSITION_22, 250 * NS, 32);
    m.wait(40 * US);
    assert_eq!(m.last().end, FrameEnd::Lost);
    assert_eq!(m.encoder.output().symbol, Symbol::Absent);
    m.wait(200 * US);
    assert_eq!(m.encoder.output().symbol, Symbol::Idle);
    assert_eq!(m.ask(READ, 3, 0), None, "the selected area is lost");
}

#[test]
fn a_write_that_loses_its_supply_leaves_the_old_word() {
    for (after, word) in [(11_900 * US, 0), (12_100 * US, 0xCAFE)] {
        let mut m = Master::new(quick(), 2_000_000);
        m.ask(SELECT, 0xA7, 0);
        let lost = m.now + after + 20 * US; // the write begins 16 us after the first edge
        m.encoder.supply.push_back((lost, false));
        m.encoder.supply.push_back((lost + MS, true));
        m.ask(WRITE, 5, 0xCAFE);
        m.wait(15 * MS);
        assert_eq!(m.encoder.word(0xA7, 5), Some(word));
    }
}

#[test]
fn a_plugged_in_encoder_needs_its_start_up_time() {
    let mut config = quick();
    config.start_up = 300 * US;
    // The second pull comes during the start-up.
    config.unplugged = vec![100 * US..200 * US, 400 * US..500 * US];
    let m = |until: Time| {
        let mut m = Master::new(config.clone(), 2_000_000);
        m.wait(until - m.now);
        m
    };
    for (time, there) in [(99, true), (100, false), (499, false), (799, false)] {
        let absent = m(time * US).encoder.output().symbol == Symbol::Absent;
        assert_eq!(absent, !there, "{time} us");
    }
    let mut plugged = m(801 * US);
    let seen: Vec<Symbol> = plugged.outputs.iter().map(|o| o.1.symbol).collect();
    assert_eq!(seen, [Symbol::Idle, Symbol::Absent, Symbol::Idle]);
    plugged.position22(POSITION_22, 0, 0);
    assert_eq!(plugged.violations(), []);
    // Plugged in while the clock runs: ignores it until the clock has been HIGH for long.
    let mut m = m(794_900 * NS); // so that the clock is LOW at that moment
    let seen = m.pulses(POSITION_22, 250 * NS, 40);
    assert!(seen.iter().all(|o| o.symbol != Symbol::Bit(0)));
    assert_eq!(m.encoder.frames().len(), 0);
    m.wait(40 * US);
    m.position22(POSITION_22, 0, 0);
}

#[test]
fn an_encoder_may_be_without_supply_at_first() {
    let mut config = quick();
    config.start_up = MS;
    config.unplugged.push(0..2 * MS);
    let mut m = Master::new(config, 2_000_000);
    m.wait(0);
    m.pulses(POSITION_22, 250 * NS, 32);
    m.wait(2_999 * US - m.now);
    assert_eq!(m.encoder.output().drive, Drive::Released);
    assert_eq!(m.encoder.frames().len(), 0);
    m.wait(2 * US);
    assert_eq!(m.encoder.output().symbol, Symbol::Idle);
    m.position22(POSITION_22, 0, 0);
    assert_eq!(m.violations(), []);
}
