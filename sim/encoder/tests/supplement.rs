//! EnDat 2.2 commands with a supplement.

use super::*;

/// Pulses of a 13-bit frame before its last bit is launched: 10 to the start bit, 21 bits.
const TO_LAST_BIT: u32 = 31;

fn with_supplement(change: impl Fn(&mut Master)) -> (Master, Vec<Output>) {
    let mut m = Master::new(quick(), 1_000_000);
    change(&mut m);
    m.pulses(SELECT_22, 500 * NS, TO_LAST_BIT);
    let seen = m.supplement(Parameter::from_word(0xB9_8001), None);
    (m, seen)
}

#[test]
fn a_supplement_follows_the_drawing() {
    for (code, _) in Command::ALL.iter().filter(|c| c.1.has_supplement()) {
        let mut m = Master::new(quick(), 1_000_000);
        m.pulses(*code, 500 * NS, TO_LAST_BIT);
        assert_eq!(m.encoder.output().symbol, Symbol::Bit(20));
        let park = m.now;
        let fields = Parameter::from_word(0xB9_8001);
        let seen = m.supplement(fields, None);
        let last_rise = m.now - m.half;
        m.wait(40 * US);
        assert_eq!(m.violations(), [], "{code:06b}");
        assert_eq!(seen.len(), 35);
        assert!(seen[..33].iter().all(|o| o.drive == Drive::Released));
        assert_eq!((seen[33].drive, seen[34].drive), (Drive::High, Drive::High));
        let released = m.drives(Symbol::Listening);
        assert_eq!(released - park, 500 * NS, "the last bit remains until then");
        // F'33 is two periods before the last rising edge, minus half a period.
        let low = m.drives(Symbol::Lead);
        assert_eq!(last_rise - low, 1_500 * NS - 50 * NS);
        let high = m.drives(Symbol::Tail);
        assert_eq!(last_rise - high, 1_000 * NS - 50 * NS, "HIGH from R'34");
        let fall = m.drives(Symbol::Idle);
        assert!((10 * US..=30 * US).contains(&(fall - last_rise)));
        let log = m.last();
        let supplement = Supplement {
            zeros: 7,
            fields,
            block: None,
        };
        assert_eq!(log.supplement, Some(supplement));
        assert_eq!(log.rising_edges, TO_LAST_BIT + 35);
        assert_eq!(log.expected_rising_edges(), Some(TO_LAST_BIT + 35));
        assert_eq!(log.end, FrameEnd::Complete);
    }
}

#[test]
fn pulses_and_start_bit_of_a_supplement_must_be_exact() {
    let stopped_after = |pulses: usize| {
        let mut m = Master::new(quick(), 1_000_000);
        m.pulses(TEST_22, 500 * NS, TO_LAST_BIT);
        m.pulse(Drive::Released, 2 * US);
        for k in 1..pulses {
            let data = match k {
                1..=7 | 9..=32 => Drive::Low,
                8 => Drive::High,
                _ => Drive::Released,
            };
            m.pulse(data, 500 * NS);
        }
        m.wait(40 * US);
        let accepted = m.encoder.job.is_some() || m.encoder.registers.test.address != 0;
        (m.violations(), m.last().end, accepted)
    };
    let (seen, expected) = (TO_LAST_BIT + 34, TO_LAST_BIT + 35);
    let few = Violation::TooFewPulses { seen, expected };
    assert_eq!(stopped_after(34), (vec![few], FrameEnd::Stopped, false));
    assert_eq!(stopped_after(35), (vec![], FrameEnd::Complete, true));
    let many = Violation::TooManyPulses { expected };
    assert_eq!(stopped_after(36), (vec![many], FrameEnd::Overrun, true));
    let seen = TO_LAST_BIT + 1;
    let none = Violation::NoSupplement { seen };
    assert_eq!(stopped_after(1), (vec![none], FrameEnd::Stopped, false));
}

#[test]
fn a_stop_high_after_the_last_bit_is_no_end() {
    let mut m = Master::new(quick(), 1_000_000);
    m.pulses(SELECT_22, 500 * NS, TO_LAST_BIT);
    m.wait(40 * US);
    let (seen, expected) = (TO_LAST_BIT, TO_LAST_BIT + 35);
    assert_eq!(m.violations(), [Violation::TooFewPulses { seen, expected }]);
}

#[test]
fn the_pause_before_a_supplement_lets_the_encoder_release() {
    let (m, _) = with_supplement(|m| {
        m.half = 200 * NS;
        m.pause = 300 * NS;
    });
    let early = Violation::EarlySupplement { pause: 300 * NS };
    assert_eq!(m.violations(), [early]);
    let late = 35 * 400 * NS; // the supplement, from R'1 to the end of its last HIGH
    assert_eq!(m.drives(Symbol::Listening), m.now + 200 * NS - late);
    let (m, seen) = with_supplement(|m| {
        m.half = 200 * NS;
        m.pause = 500 * NS;
    });
    assert_eq!(m.violations(), []);
    assert_eq!(seen[0].drive, Drive::Released);
    let (m, _) = with_supplement(|m| m.pause = 51 * MS);
    assert_eq!(m.violations()[0], Violation::ClockLowTooLong);
}

#[test]
fn the_start_bit_is_looked_for_behind_enough_zeros() {
    for (zeros, violations) in [
        (6, vec![Violation::SupplementZeros { seen: 6 }]),
        (7, vec![]),
        (9, vec![]),
    ] {
        let (m, _) = with_supplement(|m| m.zeros = zeros);
        assert_eq!(m.violations(), violations);
        assert_eq!(m.last().supplement.unwrap().zeros, zeros);
        assert_eq!(m.last().supplement.unwrap().fields.word(), 0xB9_8001);
        assert_eq!(m.last().end, FrameEnd::Complete);
        assert_eq!(m.last().rising_edges, TO_LAST_BIT + 28 + zeros);
    }
}

#[test]
fn a_block_address_makes_the_supplement_longer() {
    let select = |m: &mut Master, block| {
        m.pulses(SELECT_22, 500 * NS, TO_LAST_BIT);
        m.supplement(Parameter::from_word(0xBF_0000), block);
        m.wait(40 * US);
    };
    let mut m = Master::new(quick(), 1_000_000);
    select(&mut m, Some(2));
    assert_eq!(m.violations(), []);
    assert_eq!(m.last().rising_edges, TO_LAST_BIT + 43);
    assert_eq!(m.last().supplement.unwrap().block, Some(2));
    m.select(0x47, 1);
    assert_eq!(m.position22(POSITION_22, 0, 0)[0].data, 0xBF02);
    m.position22(WRITE_22, 0xFE, 0x1357);
    m.wait(13 * MS);
    assert_eq!(m.ask(READ, 0xFE, 0).unwrap().data, 0x1357);
    m.ask(SELECT, area::SECTION_2, 1);
    assert_eq!(m.ask(READ, 0xFE, 0).unwrap().data, 0, "another block");
    m.infos = 1;
    m.position22(TEST_22, area::SECTION_2, 0); // no block after other commands
    assert_eq!(m.last().rising_edges, TO_LAST_BIT + 30 + 35);
    assert_eq!(m.violations(), []);
    let mut m = Master::new(quick(), 1_000_000);
    select(&mut m, Some(4));
    assert_eq!(m.last().refused, Some(ErrorSource::Block));
    let mut m = Master::new(quick(), 1_000_000);
    select(&mut m, None);
    let (seen, expected) = (TO_LAST_BIT + 35, TO_LAST_BIT + 43);
    let last = Violation::TooFewPulses { seen, expected };
    assert_eq!(m.violations().last(), Some(&last));
}
