//! Selection, order and content of the additional data.

use super::*;

fn master() -> Master {
    Master::new(quick(), 2_000_000)
}

/// Codes and contents of the additional data of one position.
fn sent(m: &mut Master) -> Vec<(u8, u16)> {
    let infos = m.position22(POSITION_22, 0, 0);
    infos.iter().map(|i| (i.address & 0x1F, i.data)).collect()
}

#[test]
fn none_is_sent_until_one_is_selected() {
    let mut m = master();
    assert_eq!(sent(&mut m), []);
    assert_eq!(m.last().rising_edges, 11 + 21);
    // The frame with the selection has no additional data yet.
    assert_eq!(m.position22(SELECT_22, 0x40, 0), []);
    m.infos = 1;
    assert_eq!(sent(&mut m), [(0x00, 0)]);
    assert_eq!(sent(&mut m), [(0x00, 0)], "in every frame from now on");
    assert_eq!(m.last().rising_edges, 11 + 51);
    assert_eq!(m.violations(), []);
}

#[test]
fn additional_data_2_comes_before_additional_data_1() {
    let mut m = master();
    m.select(0x4D, 1);
    m.select(0x50, 2);
    assert_eq!(sent(&mut m), [(0x10, 0), (0x0D, 2982)]);
    let codes: Vec<u8> = m.last().infos.iter().map(|i| i.0.code).collect();
    assert_eq!(codes, [0x50, 0x4D]);
    assert_eq!(m.last().rising_edges, 11 + 81);
    let fields: Vec<String> = (20..52).map(|i| m.last().field(i).to_string()).collect();
    assert_eq!(fields[..6], ["C0", "0", "WRN", "RM", "BSY", "I4"]);
    assert_eq!(fields[30..], ["C0", "0"]);
    assert!(m.last().is_true_answer(13, true));
    assert_eq!(m.violations(), []);
}

#[test]
fn each_group_is_switched_off_by_itself() {
    let mut m = master();
    m.select(0x4D, 1);
    m.select(0x51, 2);
    m.select(0x4F, 1);
    assert_eq!(sent(&mut m), [(0x11, 0)]);
    m.select(0x4C, 2);
    m.select(0x5F, 1);
    assert_eq!(sent(&mut m), [(0x0C, 2954)]);
    m.select(0x4F, 0);
    assert_eq!(sent(&mut m), []);
    assert_eq!(m.violations(), []);
}

#[test]
fn a_selection_replaces_the_one_before_it_in_its_group() {
    let mut m = master();
    m.select(0x4C, 1);
    m.select(0x4D, 1);
    assert_eq!(sent(&mut m), [(0x0D, 2982)]);
}

#[test]
fn what_the_encoder_does_not_have_is_refused() {
    let mut config = quick();
    config.plate.infos_1 = 1 << 0xC;
    let mut m = Master::new(config, 2_000_000);
    m.select(0x4C, 1);
    m.select(0x4D, 1);
    assert_eq!(m.last().refused, Some(ErrorSource::InfoNotSupported));
    assert_eq!(sent(&mut m), [(0x0C, 2954)], "the old one remains");
    m.select(0x5A, 1); // not assigned
    assert_eq!(m.last().refused, Some(ErrorSource::InfoNotSupported));
    m.select(0x59, 2);
    let source = ErrorSource::InfoNotSupported.bit();
    assert_eq!(sent(&mut m), [(0x19, source), (0x0C, 2954)]);
    // The EnDat 2.1 command selects memory areas only.
    assert_eq!(m.ask(SELECT, 0x40, 0), None);
    assert_eq!(m.last().refused, Some(ErrorSource::MrsNotAllowed));
}

#[test]
fn every_plain_value_comes_under_its_code() {
    let mut config = quick();
    config.values = InfoValues {
        temperatures: [0x0B01, 0x0B02],
        sensors: 0x5E45,
        commutation: 0xC0DE,
        acceleration: 0xACCE,
        limits: 0x1122,
        test_values: 0x12_3456_789A,
        ..InfoValues::default()
    };
    let mut m = Master::new(config, 2_000_000);
    let mut get = |code| {
        m.select(code, 1);
        let infos = sent(&mut m);
        m.select(code | 0xF, 0);
        assert_eq!(infos.len(), 1);
        assert_eq!(infos[0].0, code & 0x1F);
        infos[0].1
    };
    assert_eq!([get(0x4C), get(0x4D), get(0x4E)], [0x0B01, 0x0B02, 0x5E45]);
    assert_eq!([get(0x49), get(0x4A), get(0x4B)], [0x789A, 0x3456, 0x0012]);
    assert_eq!([get(0x51), get(0x52), get(0x53)], [0xC0DE, 0xACCE, 0xC0AC]);
    assert_eq!([get(0x54), get(0x55)], [0x1122, 0x22AC]);
    assert_eq!(get(0x41), 0, "diagnostics are not configured");
}

#[test]
fn parts_of_a_position_belong_together() {
    for (first, offset) in [(0x42, 7i64), (0x56, -7)] {
        let mut config = EncoderConfig::endat22(37);
        config.position = PositionSource::Ramp {
            start: 0x1F_1234_FFF0,
            step: 0x1_0001,
        };
        config.values.position_2_offset = offset;
        config.values.asynchronous_offset = offset;
        let mut m = Master::new(config, 2_000_000);
        m.select(first, 1);
        // The frame that requests the second part is the last one with the first part.
        let low = m.position22(SELECT_22, first + 1, 0)[0].data;
        let taken = m.last().position;
        let middle = m.position22(SELECT_22, first + 2, 0)[0].data;
        let high = sent(&mut m)[0].1;
        let whole = [high, middle, low]
            .iter()
            .fold(0, |p, w| p << 16 | u64::from(*w));
        assert_eq!(whole, taken.wrapping_add_signed(offset));
    }
}

#[test]
fn other_positions_have_the_width_of_the_first() {
    let mut config = quick().position(PositionSource::Fixed(0));
    config.values.position_2_offset = -1;
    config.values.asynchronous_offset = -2;
    let mut m = Master::new(config, 2_000_000);
    m.select(0x42, 1);
    m.select(0x56, 2);
    assert_eq!(sent(&mut m), [(0x16, 0x1FFE), (0x02, 0x1FFF)]);
}

#[test]
fn a_21_position_has_no_additional_data() {
    let mut m = master();
    m.select(0x4C, 1);
    assert_eq!(
        m.exchange(POSITION_21, Parameter::default()).unwrap().len(),
        20
    );
    assert_eq!(
        (m.last().answer.len, m.last().end),
        (20, FrameEnd::Complete)
    );
}

#[test]
fn a_warning_is_told_by_all_additional_data_and_by_no_error_bit() {
    let warning = Cause {
        during: MS..2 * MS,
        alarms: 0,
        warnings: 2,
    };
    let mut m = Master::new(quick().cause(warning), 2_000_000);
    m.select(0x40, 1);
    m.select(0x50, 2);
    assert!(m.now < MS);
    assert!(m.last().infos.iter().all(|i| !i.0.warning));
    m.wait(5 * MS);
    let infos = m.position22(POSITION_22, 0, 0); // checks F1 and F2
    assert!(infos.iter().all(|i| i.address & 0x80 != 0));
    assert_eq!(m.last().errors, (false, Some(true)));
}

#[test]
fn an_alarm_sets_both_error_bits_in_opposite_senses() {
    let alarm = Cause {
        during: MS..2 * MS,
        alarms: 0b100,
        warnings: 0,
    };
    let mut m = Master::new(quick().cause(alarm.clone()), 2_000_000);
    m.wait(3 * MS);
    let bits = m.exchange(POSITION_22, Parameter::default()).unwrap();
    assert_eq!(bits[..3], [true, true, false]);
    assert_eq!(m.last().errors, (true, Some(false)));
    let bits = m.exchange(POSITION_21, Parameter::default()).unwrap();
    assert_eq!(bits[..2], [true, true]);
    let mut config = quick().cause(alarm);
    config.plate.alarms = 0b011;
    config.plate.warnings = 0b011;
    config.causes[0].warnings = 0b100;
    let mut m = Master::new(config, 2_000_000);
    m.wait(3 * MS);
    m.position22(POSITION_22, 0, 0); // an alarm that it cannot report
    assert_eq!(m.encoder.word(area::OPERATING_STATUS, 0), Some(0));
    assert_eq!(m.encoder.word(area::OPERATING_STATUS, 1), Some(0));
}

#[test]
fn an_alarm_during_the_calculation_is_told_in_the_same_frame() {
    // At 1 MHz the frame begins at 10 us and the start bit comes at 20.5 us.
    for (at, told) in [(20, true), (21, false)] {
        let alarm = Cause {
            during: at * US..at * US + 1,
            alarms: 1,
            warnings: 0,
        };
        let mut m = Master::new(quick().cause(alarm), 1_000_000);
        assert_eq!(m.position22_with_alarm(POSITION_22), [told, !told]);
        assert_eq!(m.position22_with_alarm(POSITION_22), [true, false]);
    }
}

#[test]
fn a_wrong_crc_stays_in_its_block() {
    let xor = 0b00100;
    let mut m = Master::new(
        quick().defect(2, Defect::InfoCrcXor { info: 1, xor }),
        2_000_000,
    );
    m.select(0x4C, 1);
    m.select(0x50, 2);
    m.exchange(POSITION_22, Parameter::default());
    let log = m.last();
    assert_eq!(log.infos[0].1, log.infos[0].0.crc());
    assert_eq!(log.infos[1].1, log.infos[1].0.crc() ^ xor);
    assert!(!log.is_true_answer(13, true));
    sent(&mut m); // all are right again
}

#[test]
fn a_test_command_is_acknowledged() {
    let mut m = master();
    m.select(0x48, 1);
    assert_eq!(sent(&mut m), [(8, 0)]);
    m.position22(TEST_22, 0x42, 0x1357);
    assert_eq!(sent(&mut m), [(8, 0x4257)]);
}
