//! EnDat 2.1 commands with a parameter, and test values.

use super::*;

#[test]
fn a_parameter_command_follows_the_drawing() {
    for code in [SELECT, WRITE, READ, RESET, TEST, COMMUNICATION] {
        let mut m = Master::new(quick(), 1_000_000);
        m.ask(SELECT, area::OPERATING_PARAMETERS, 0);
        m.wait(MS);
        let fields = match code {
            SELECT => (area::OPERATING_STATUS, 0xA5C3),
            _ => (0x05, 0xA5C3),
        };
        let (address, data) = fields;
        let fields = Parameter { address, data };
        let bit = |rise| Master::parameter_bit(code, fields, rise);
        let begin = m.outputs.len();
        let seen = m.pulses_with(bit, 500 * NS, 65);
        let last_rise = m.now - m.half;
        m.wait(40 * US);
        assert_eq!(m.violations(), [], "{code:06b}");
        assert!(seen[..33].iter().all(|o| o.symbol == Symbol::Listening));
        assert!(seen[..33].iter().all(|o| o.drive == Drive::Released));
        assert_eq!(seen[33].symbol, Symbol::Lead, "LOW from F#34");
        assert_eq!(seen[33].drive, Drive::Low);
        let symbols: Vec<Symbol> = seen[34..64].iter().map(|o| o.symbol).collect();
        assert_eq!(symbols, (0..30).map(Symbol::Bit).collect::<Vec<_>>());
        assert_eq!(seen[64].symbol, Symbol::Tail);
        assert_eq!(seen[64].drive, Drive::High);
        let fall = m.drives(Symbol::Idle);
        assert!((10 * US..=30 * US).contains(&(fall - last_rise)));
        // Read replaces the 16 bits by the word, which is 0; every other command echoes them.
        let data = if code == READ { 0 } else { data };
        let want = Parameter { address, data };
        let bits: Vec<bool> = seen[34..64]
            .iter()
            .map(|o| o.drive == Drive::High)
            .collect();
        assert!(bits[0]);
        assert_eq!(Parameter::from_word(number(&bits[1..25])), want);
        assert_eq!(number(&bits[25..]), u32::from(want.crc()));
        let log = m.last();
        let fields_of_bits = [0, 1, 8, 9, 24, 25, 29].map(|i| log.field(i).to_string());
        assert_eq!(fields_of_bits, ["S", "A7", "A0", "P15", "P0", "C4", "C0"]);
        assert_eq!((log.parameter, log.reply), (Some(fields), Some(want)));
        assert_eq!((log.kind, log.crc), (AnswerKind::Parameter, want.crc()));
        assert_eq!((log.rising_edges, log.start_edge), (65, Some(35)));
        assert_eq!((log.end, log.refused), (FrameEnd::Complete, None));
        assert!(m.outputs[begin..]
            .iter()
            .all(|o| o.1.symbol != Symbol::Absent));
    }
}

#[test]
fn the_clock_runs_while_the_memory_is_accessed() {
    let mut config = quick();
    config.tac = 12 * MS..=12 * MS;
    let mut m = Master::new(config, 1_000_000);
    let begin = m.now;
    assert!(m.ask(SELECT, 0xA1, 0).is_some());
    // The last bit is sampled at R#32, 31.5 us after F#1; the answer begins at the first edge 12 ms later.
    assert_eq!(m.last().start_time - begin, 12 * MS + 31_500 * NS);
    assert_eq!(m.last().start_edge, Some(12_032));
    assert_eq!(m.last().rising_edges, 12_062);
    // Commands without memory access do not wait.
    m.ask(TEST, 1, 2);
    assert_eq!(m.last().start_edge, Some(35));
    assert_eq!(m.violations(), []);
}

#[test]
fn pulse_counts_of_a_parameter_command_must_be_exact() {
    let with = |pulses| {
        let mut m = Master::new(quick(), 1_000_000);
        let fields = Parameter::from_word(0xA1_0000);
        let bit = |rise| Master::parameter_bit(SELECT, fields, rise);
        m.pulses_with(bit, 500 * NS, pulses);
        m.wait(50 * US);
        let sources = m.encoder.status.sources;
        (
            m.violations(),
            m.last().end,
            sources & ErrorSource::NotCompleted.bit() != 0,
        )
    };
    let (seen, expected) = (64, 65);
    let few = Violation::TooFewPulses { seen, expected };
    assert_eq!(with(64), (vec![few], FrameEnd::Stopped, true));
    assert_eq!(with(65), (vec![], FrameEnd::Complete, false));
    let many = Violation::TooManyPulses { expected };
    assert_eq!(with(66), (vec![many], FrameEnd::Overrun, false));
    let none = Violation::StoppedBeforeAnswer { seen: 31 };
    assert_eq!(with(31), (vec![none], FrameEnd::Stopped, true));
}

#[test]
fn a_parameter_that_nobody_drives_is_noticed() {
    let mut m = Master::new(quick(), 1_000_000);
    let bit = |rise| match rise {
        20 => Drive::Released,
        _ => Master::parameter_bit(SELECT, Parameter::from_word(0xA1_0000), rise),
    };
    m.pulses_with(bit, 500 * NS, 65);
    assert_eq!(m.violations(), [Violation::CommandNotDriven { edge: 20 }]);
}

#[test]
fn old_encoders_need_a_pause_between_parameter_commands() {
    let early = |wait| {
        let mut config = EncoderConfig::endat21(13);
        config.tac = 0..=0;
        let mut m = Master::new(config, 1_000_000);
        m.ask(SELECT, 0xA1, 0);
        let end = m.last().last_rise;
        m.wait(50 * US);
        m.exchange(POSITION_21, Parameter::default()); // allowed at any time
        m.wait(end + wait - m.now);
        m.ask(READ, 13, 0);
        m.violations()
    };
    let after = 999 * US;
    assert_eq!(early(after), [Violation::ParameterGap { after }]);
    assert_eq!(early(MS), []);
}

#[test]
fn test_values_are_forty_bits_behind_f1() {
    let mut config = quick().cause(Cause {
        during: 200 * US..300 * US,
        alarms: 1,
        warnings: 0,
    });
    config.values.test_values = 0x12_3456_789A;
    let mut m = Master::new(config, 1_000_000);
    let seen = m.pulses(TEST_VALUES, 500 * NS, 58);
    m.wait(40 * US);
    assert_eq!(seen[10].symbol, Symbol::Bit(0), "waits only for tcal");
    let bits: Vec<bool> = seen[10..57]
        .iter()
        .map(|o| o.drive == Drive::High)
        .collect();
    assert_eq!(bits[..2], [true, false]);
    let value = bits[2..42]
        .iter()
        .rev()
        .fold(0u64, |n, b| n << 1 | u64::from(*b));
    assert_eq!(value, 0x12_3456_789A);
    assert_eq!(
        number(&bits[42..]),
        u32::from(crc5(bits[1..42].iter().copied()))
    );
    assert_eq!(m.last().end, FrameEnd::Complete);
    assert_eq!(m.last().kind, AnswerKind::TestValues);
    let fields_of_bits = [0, 1, 2, 41, 42, 46].map(|i| m.last().field(i).to_string());
    assert_eq!(fields_of_bits, ["S", "F1", "D0", "D39", "C4", "C0"]);
    m.wait(200 * US);
    let bits = m.exchange(TEST_VALUES, Parameter::default()).unwrap();
    assert!(bits[1], "F1 reports the alarm here, too");
    assert_eq!(m.violations(), []);
}

#[test]
fn a_wrong_echo_has_a_right_crc() {
    let mut m = Master::new(quick().defect(0, Defect::EchoXor(0x10_0001)), 1_000_000);
    let reply = m.ask(TEST, 0xA1, 0x8000);
    assert_eq!(reply, Some(Parameter::from_word(0xB1_8001)));
    assert_eq!(m.last().parameter, Some(Parameter::from_word(0xA1_8000)));
    assert_eq!(m.ask(TEST, 0xA1, 0x8000), m.last().parameter);
}
