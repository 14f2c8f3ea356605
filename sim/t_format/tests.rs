//! Correct and incorrect requests to the encoder.

use super::*;
use crate::{MS, US};

const BIT: Time = 400_000;

/// Levels of fields of these bytes.
fn levels(bytes: &[u8]) -> Vec<bool> {
    let field = |byte: &u8| {
        let byte = u16::from(*byte) << 1 | 1 << 9;
        (0..10).map(move |i| byte >> i & 1 == 1).collect::<Vec<_>>()
    };
    bytes.iter().flat_map(field).collect()
}

/// Drives these levels from `start` on, then releases.
fn drive(encoder: &mut Encoder, start: Time, levels: &[bool]) -> Time {
    for (index, level) in levels.iter().enumerate() {
        encoder.receiver(start + index as u64 * BIT, Drive::level(*level));
    }
    let end = start + levels.len() as u64 * BIT;
    encoder.receiver(end, Drive::Released);
    end
}

/// The bytes from the encoder after `from`, sampled in the middle of their bits.
fn listen(encoder: &mut Encoder, from: Time) -> Vec<u8> {
    let mut bytes = vec![];
    let mut time = from;
    let limit = from + 100 * US;
    while time < limit {
        encoder.advance(time);
        if encoder.output() != Drive::Low {
            time += BIT / 16;
            continue;
        }
        let byte = (0..8).fold(0, |byte, i| {
            encoder.advance(time + (i + 1) * BIT + BIT / 2);
            byte | u8::from(encoder.output() != Drive::Low) << i
        });
        bytes.push(byte);
        time += 9 * BIT + BIT / 2;
    }
    bytes
}

fn ask(encoder: &mut Encoder, start: Time, bytes: &[u8]) -> Vec<u8> {
    let end = drive(encoder, start, &levels(bytes));
    listen(encoder, end)
}

#[test]
fn requests_get_their_replies() {
    let config = EncoderConfig {
        single_turn: 0x3b_c029,
        multi_turn: 0x01_0203,
        ..EncoderConfig::default()
    };
    let mut encoder = Encoder::new(config);
    let rows: [(&[u8], &[u8]); 4] = [
        (&[0x02], &[0x02, 0x20, 0x29, 0xC0, 0x3B, 0xF0]),
        (&[0x8A], &[0x8A, 0x20, 0x03, 0x02, 0x01, 0xAA]),
        (&[0x92], &[0x92, 0x20, 0x17, 0xA5]),
        (
            &[0x1A],
            &[0x1A, 0x20, 0x29, 0xC0, 0x3B, 0x17, 3, 2, 1, 0xC8, 0x37],
        ),
    ];
    for (index, (request, reply)) in rows.into_iter().enumerate() {
        assert_eq!(ask(&mut encoder, (index as u64 + 1) * MS, request), reply);
    }
    assert_eq!(encoder.violations(), []);
    assert_eq!(encoder.replies().len(), 4);
}

#[test]
fn eeprom_has_pages_and_is_busy_after_a_write() {
    let mut encoder = Encoder::new(EncoderConfig::default());
    let rows: [(u64, &[u8], &[u8]); 5] = [
        (1, &[0x32, 0x7F, 0x01, 0x4C], &[0x32, 0x7F, 0x01, 0x4C]),
        (2, &[0x32, 0x01, 0x5A, 0x69], &[0x32, 0x01, 0x5A, 0x69]),
        (3, &[0xEA, 0x01, 0xEB], &[0xEA, 0x81, 0x00, 0x6B]),
        (10, &[0xEA, 0x01, 0xEB], &[0xEA, 0x01, 0x5A, 0xB1]),
        (11, &[0xEA, 0x7F, 0x95], &[0xEA, 0x7F, 0x01, 0x94]),
    ];
    for (at, request, reply) in rows {
        assert_eq!(ask(&mut encoder, at * MS, request), reply, "{at} ms");
    }
    assert_eq!((encoder.eeprom(1, 1), encoder.eeprom(0, 1)), (0x5A, 0));
    assert_eq!(encoder.violations(), []);
}

#[test]
fn a_reset_takes_ten_requests_in_a_row() {
    let config = EncoderConfig {
        single_turn: 5,
        multi_turn: 6,
        ..EncoderConfig::default()
    };
    let mut encoder = Encoder::new(config);
    let mut at = 0;
    let mut ask = |encoder: &mut Encoder, byte| {
        at += MS;
        ask(encoder, at, &[byte])
    };
    (0..9).for_each(|_| drop(ask(&mut encoder, 0xC2)));
    ask(&mut encoder, 0x02);
    (0..9).for_each(|_| drop(ask(&mut encoder, 0xC2)));
    assert_eq!(encoder.told().0, 5);
    ask(&mut encoder, 0xC2);
    assert_eq!(encoder.told(), (0, 6));
    (0..10).for_each(|_| drop(ask(&mut encoder, 0x62)));
    assert_eq!((encoder.told(), encoder.config.alarm), ((0, 0), 0));
    // The shaft moves.
    encoder.config.single_turn = 4;
    encoder.config.multi_turn = 7;
    assert_eq!(encoder.told(), (0xFF_FFFF, 1));
}

#[test]
fn it_complains_about_each_fault_of_the_receiver() {
    let new = || Encoder::new(EncoderConfig::default());
    let wrong = |change: &dyn Fn(&mut Vec<bool>), bytes: &[u8]| {
        let mut encoder = new();
        let mut levels = levels(bytes);
        change(&mut levels);
        let end = drive(&mut encoder, MS, &levels);
        let reply = listen(&mut encoder, end);
        (encoder.violations().to_vec(), reply.get(1).copied())
    };
    let flip = |bit: usize| move |levels: &mut Vec<bool>| levels[bit] = !levels[bit];
    let none = |_: &mut Vec<bool>| {};
    assert_eq!(
        wrong(&flip(8), &[0x02]),
        (vec![Violation::Parity], Some(0x60))
    );
    assert_eq!(
        wrong(&flip(9), &[0x02]),
        (vec![Violation::Delimiter], Some(0xA0))
    );
    assert_eq!(wrong(&flip(2), &[0x02]), (vec![Violation::Sync], None));
    assert_eq!(wrong(&none, &[0xA2]), (vec![Violation::UnknownId(4)], None));
    assert_eq!(
        wrong(&none, &[0xEA, 0x01, 0xEA]),
        (vec![Violation::Crc], None)
    );
    assert_eq!(
        wrong(&none, &[0xEA, 0x01]),
        (vec![Violation::Incomplete], None)
    );
    let cut = |levels: &mut Vec<bool>| levels.truncate(levels.len() - 1);
    assert_eq!(wrong(&cut, &[0x02]).0, [Violation::ReleasedEarly]);

    // The driver goes off within the delimiter, or stays on, or comes too soon.
    let mut encoder = new();
    let levels = levels(&[0x02]);
    for (index, level) in levels.iter().enumerate() {
        encoder.receiver(MS + index as u64 * BIT, Drive::level(*level));
    }
    encoder.receiver(MS + 9 * BIT + BIT * 3 / 4, Drive::Released);
    assert_eq!(encoder.violations(), [Violation::ReleasedEarly]);

    let mut encoder = new();
    for (index, level) in levels.iter().enumerate() {
        encoder.receiver(MS + index as u64 * BIT, Drive::level(*level));
    }
    encoder.advance(MS + 10 * US);
    assert_eq!(encoder.violations(), [Violation::Conflict]);

    let mut encoder = new();
    let end = drive(&mut encoder, MS, &levels);
    encoder.receiver(end + US, Drive::Low);
    assert_eq!(encoder.violations(), [Violation::Impatient]);

    let mut encoder = new();
    let end = drive(&mut encoder, MS, &levels) + 28 * US / 10 + 60 * BIT;
    encoder.receiver(end + US / 10, Drive::Low);
    assert_eq!(encoder.violations(), [Violation::TooEarly]);

    let mut encoder = new();
    encoder.receiver(MS, Drive::Low);
    encoder.receiver(MS + BIT * 5 / 2, Drive::High);
    assert_eq!(encoder.violations(), [Violation::BitWidth]);
}
