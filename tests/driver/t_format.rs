//! The drivers' calls for T-format encoders, at a virtual card that has one at its second channel.

use super::rig::Rig;
use super::world::World;
use endat_config::{parse, preset, Project};
use endat_driver::regs::causes;
use endat_driver::regs::protocols::t_format::causes as cause;
use endat_driver::regs::protocols::t_format::request;
use endat_driver::regs::Protocol;
use endat_driver::{Card, Error, TFormatSettings, Uart};

/// Channels of the card.
const ENDAT: usize = 0;
const T_FORMAT: usize = 1;
const LIMIT_MS: u32 = 50;

/// The preset at a slower clock, which is simulated sooner; its timer triggers.
fn project() -> Project {
    let mut text = preset("mixed_protocols").unwrap().to_owned();
    for (from, to) in [
        ("system_hz = 100_000_000", "system_hz = 40_000_000"),
        ("clock_hz = 3_125_000", "clock_hz = 2_000_000"),
        ("baud = 3_000_000", "baud = 2_000_000"),
        ("sample_hz = 10_000", "sample_hz = 5_000"),
        ("name = \"papilio_pro\"", "name = \"arty_a7_35\""),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    parse("mixed.toml", &text).unwrap()
}

/// Catches a reset that triggers interrupt, an EEPROM that is read while it writes, and settings of the other protocol.
#[test]
fn the_c_driver_has_the_t_format_encoder() {
    Rig::of_virtual_card(&project()).run("t_format");
}

/// The same in Rust.
#[test]
fn the_rust_driver_has_the_t_format_encoder() {
    let world = World::new(Rig::of_virtual_card(&project()));
    let mut card = Card::open(Uart::new(world.clone()), world.clone(), None).unwrap();
    let turns = |card: &mut Card<_, _>| {
        world.told("delay 3e8");
        let result = card.read_moment().unwrap().results()[T_FORMAT];
        assert!(result.fresh, "{result:?}");
        result.position >> 24
    };
    assert_eq!(turns(&mut card), 200);

    let reply = card.exchange(T_FORMAT, request::EVERYTHING, 0, 0, LIMIT_MS);
    let reply = reply.unwrap();
    assert_eq!((reply.id, reply.alarm), (request::EVERYTHING, 0));
    let fields = card.read_fields(T_FORMAT).unwrap();
    assert_eq!((fields.encoder_id, fields.alarm), (0x17, 0));
    assert!(
        fields.has_single_turn && fields.has_multi_turn,
        "{fields:?}"
    );
    let unknown = causes::number(cause::UNKNOWN_REQUEST as u8, Protocol::TFormat);
    let refused = card.exchange(T_FORMAT, 4, 0, 0, LIMIT_MS);
    assert_eq!(refused, Err(Error::Exchange { cause: unknown }));
    let told = refused.unwrap_err().to_string();
    assert!(told.contains("(unknown_command): Write 7"), "{told}");
    let refused = card.exchange(T_FORMAT, 16, 0, 0, LIMIT_MS);
    assert_eq!(refused, Err(Error::Argument));
    let refused = card.exchange(ENDAT, request::EVERYTHING, 0, 0, LIMIT_MS);
    assert_eq!(refused, Err(Error::Protocol));

    for (address, data) in [(1, 0x11), (2, 0x22), (3, 0x33)] {
        card.write_eeprom(T_FORMAT, address, data, LIMIT_MS)
            .unwrap();
        assert_eq!(card.read_eeprom(T_FORMAT, address, LIMIT_MS), Ok(data));
    }
    // It is written and not yet read back: the EEPROM takes its time.
    assert_eq!(card.write_eeprom(T_FORMAT, 1, 0xA5, 0), Err(Error::Busy));
    assert_eq!(card.read_eeprom(T_FORMAT, 1, LIMIT_MS), Ok(0xA5));
    assert_eq!(
        card.read_eeprom(T_FORMAT, 128, LIMIT_MS),
        Err(Error::Argument)
    );

    // A request that is lost on the way is not told as done.
    for lost in 1..4 {
        card.write_eeprom(T_FORMAT, 10, 0x22, LIMIT_MS).unwrap();
        world.told(&format!("lose {lost:x}"));
        assert_eq!(card.read_eeprom(T_FORMAT, 2, LIMIT_MS), Ok(0x22));
        world.told(&format!("lose {lost:x}"));
        card.write_eeprom(T_FORMAT, 9, 0x40 + lost, LIMIT_MS)
            .unwrap();
        world.told("lose 0");
        assert_eq!(card.read_eeprom(T_FORMAT, 9, LIMIT_MS), Ok(0x40 + lost));
    }

    let before = card.read_t_format_settings(T_FORMAT).unwrap();
    assert_eq!(before.bit_cycles, card.period_cycles(2_500_000));
    let wrong = [
        TFormatSettings {
            bit_cycles: 7,
            ..before
        },
        TFormatSettings {
            request_id: request::READ_EEPROM.into(),
            ..before
        },
        TFormatSettings {
            request_id: request::CLEAR_ERRORS.into(),
            ..before
        },
        TFormatSettings {
            filter_cycles: before.bit_cycles / 2,
            ..before
        },
        TFormatSettings {
            reply_gap_us: 64,
            ..before
        },
        TFormatSettings {
            field_gap_us: 8,
            ..before
        },
    ];
    for wrong in wrong {
        assert_eq!(
            card.write_t_format_settings(T_FORMAT, &wrong),
            Err(Error::Argument)
        );
    }
    let other = TFormatSettings {
        reply_gap_us: 63,
        filter_cycles: 1,
        ..before
    };
    card.write_t_format_settings(T_FORMAT, &other).unwrap();
    assert_eq!(card.read_t_format_settings(T_FORMAT), Ok(other));
    assert_eq!(card.read_settings(T_FORMAT), Err(Error::Protocol));
    assert_eq!(card.read_t_format_settings(ENDAT), Err(Error::Protocol));

    let refused = card.reset_encoder(T_FORMAT, request::EVERYTHING, LIMIT_MS);
    assert_eq!(refused, Err(Error::Argument));
    card.reset_encoder(T_FORMAT, request::CLEAR_MULTI_TURN, LIMIT_MS)
        .unwrap();
    assert_eq!(turns(&mut card), 0);
}
