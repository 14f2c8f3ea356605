//! Virtual cards whose encoders send bits that are not position, and what the program says of them.

use crate::desk::Desk;
use crate::program::good;
use endat_card::VirtualConfig;
use endat_config::{parse, Project};

/// A configuration of `tests/data/ssi_status_bits`.
fn file(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/ssi_status_bits");
    format!("{folder}/{name}.toml")
}

fn project(name: &str) -> Project {
    parse(name, &std::fs::read_to_string(file(name)).unwrap()).unwrap()
}

/// Catches a special bit in the position. A virtual card has the encoder of its configuration; each of its alarms is a cause by name, and so is
/// a spoilt CRC.
#[test]
fn virtual_encoders_show_the_position_alone_and_their_alarms() {
    for (name, special, alarms, faults) in [
        (
            "el5001",
            0,
            "alarm (2 power fails, or a sum)",
            &[("alarm 0 2", "power_fail")][..],
        ),
        ("epos4", 0, "heal", &[]),
        (
            "as5045",
            0b10011,
            "alarm (1 alarm, 4 position not valid, or a sum)",
            &[
                ("alarm 0", "encoder_alarm"),
                ("alarm 0 4", "position_not_valid"),
                ("alarm 0 5", "encoder_alarm"),
                ("crc 0", "position_parity"),
            ],
        ),
        (
            "mt6701",
            0b0111,
            "alarm (4 position not valid, or a sum)",
            &[
                ("alarm 0 4", "position_not_valid"),
                ("crc 0", "position_crc"),
            ],
        ),
    ] {
        let still = VirtualConfig {
            speed: 0.0,
            ..VirtualConfig::default()
        };
        let mut desk = Desk::new(&project(name), &still);
        desk.run_ms(1);
        let measure = |desk: &mut Desk| {
            desk.set("card.trigger_now", 1);
            desk.run_ms(1);
            desk.card.results().unwrap().channels[0]
        };
        let first = measure(&mut desk);
        assert!(first.fresh && first.cause == 0, "{name}: {first:?}");
        assert_eq!(first.special_bits, Some(special), "{name}");
        // A tenth of a turn, of 12 or 13 bits.
        let tenth = if name == "as5045" { 409 } else { 819 };
        assert_eq!(first.position, tenth, "{name}");
        for (fault, cause) in faults {
            desk.card.bridge().transport().inject(fault).unwrap();
            let reading = measure(&mut desk);
            assert_eq!((reading.cause_name(), reading.fresh), (*cause, false));
            desk.card.bridge().transport().inject("heal 0").unwrap();
            assert!(measure(&mut desk).fresh, "{name}: {fault}");
        }
        // An alarm that no bit can say.
        let absent = desk.card.bridge().transport().inject("alarm 0 8");
        let told = absent.unwrap_err();
        assert!(told.ends_with(&format!("{alarms} only")), "{told}");
    }
}

/// `explain` and `read` of a configuration, as a user calls them.
#[test]
fn the_program_shows_special_bits() {
    let text = good(&["explain", "--config", &file("as5045")]);
    assert!(
        text.contains("  bits after       valid not_valid alarm shown shown parity_even\n"),
        "{text}"
    );
    assert!(
        text.contains("  position         12 bits; 19 clocks"),
        "{text}"
    );
    let text = good(&["explain", "--config", &file("epos4")]);
    assert!(
        text.contains("  bits before      ignored ignored"),
        "{text}"
    );
    assert!(text
        .contains("33 bits in Gray code, nothing to check it by: see twice and parity; 42 clocks"));
    let text = good(&["explain", "position_crc"]);
    assert!(text.contains("bits_after"), "{text}");
    // The warning of the encoder of channel 1 is on.
    let port = ["--port", "virtual:ssi_two_channel"];
    let text = good(&[&["read"][..], &port].concat());
    assert!(text.contains("good, special bits 0x03"), "{text}");
    let text = good(&[&["read", "--json"][..], &port].concat());
    let read: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!([0, 1].map(|n| read[n]["special_bits"].clone()), [0, 3]);
    let port = ["--port", "virtual:s6_two_channel"];
    let text = good(&[&["read", "--json"][..], &port].concat());
    assert!(!text.contains("special_bits"), "{text}");
}
