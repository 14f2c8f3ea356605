//! Encoders that send bits which are not position, from their configuration to a host: the position is shown alone.

use crate::bus::Master;
use endat_gen::config::{parse, Project};
use endat_hdl::regs::RESULT;
use endat_sim::bench::PinNames;
use endat_sim::ssi::Extra::{Crc6, Level, Parity};
use endat_sim::ssi::{EncoderConfig, Extra, SsiLink};
use endat_sim::{NS, US};

const LOW: Extra = Level(false);
const HIGH: Extra = Level(true);

/// Configurations of `tests/data/ssi_status_bits`.
const CASES: [(&str, &str); 4] = [
    (
        "el5001",
        include_str!("../data/ssi_status_bits/el5001.toml"),
    ),
    ("epos4", include_str!("../data/ssi_status_bits/epos4.toml")),
    (
        "as5045",
        include_str!("../data/ssi_status_bits/as5045.toml"),
    ),
    (
        "mt6701",
        include_str!("../data/ssi_status_bits/mt6701.toml"),
    ),
];

fn project(name: &str) -> Project {
    let (_, text) = CASES.iter().find(|case| case.0 == name).unwrap();
    parse(name, text).unwrap()
}

/// A card at such an encoder: triggers bring these positions with this in `status.line`.
fn comes(name: &str, sound: EncoderConfig, positions: &[u64], line: u32) {
    let project = project(name);
    let mut master = Master::at_channels(&project, &[]);
    let sound = EncoderConfig {
        position_bits: project.card.channels[0].position_bits,
        gray: project.card.channels[0].spoken.ssi().unwrap().gray,
        repeats: false,
        tm: project.card.channels[0].spec.recovery_max_ns * NS,
        ..sound
    };
    let link = SsiLink::new(sound, 100 * NS);
    master.bench.add_other(&PinNames::card(0), Box::new(link));
    master.bench.run_for(100 * US);
    let at = |name: &str| RESULT.address(RESULT.register(name).unwrap(), 0);
    for position in positions {
        let link = master.bench.others_as_mut::<SsiLink>().next().unwrap();
        link.encoder_mut().config.position = *position;
        let trigger = endat_hdl::regs::CARD.register("trigger_now").unwrap();
        master.write(endat_hdl::regs::CARD.address(trigger, 0), 1);
        master.bench.run_for(400 * US);
        let [status, low, high] =
            ["status", "position_low", "position_high"].map(|name| master.read(at(name)));
        let shown = u64::from(low) | u64::from(high & 0xFFFF) << 32;
        assert_eq!((status >> 16 & 31, status >> 23 & 1), (0, 1), "{name}");
        assert_eq!((shown, status >> 24), (*position, line), "{name}");
    }
    assert_eq!(master.bench.others().next().unwrap().complaints(), [""; 0]);
}

/// Catches a special bit in the position, and one that turns the Gray code of the position over.
#[test]
fn cards_show_the_position_alone_and_the_bits_beside_it() {
    let with = |before: &[Extra], after: &[Extra]| EncoderConfig {
        before: before.into(),
        after: after.into(),
        ..EncoderConfig::default()
    };
    comes("el5001", with(&[], &[LOW]), &[0x12_3456, 1, 0xFF_FFFF], 0);
    let odd = [LOW, HIGH, LOW, LOW, LOW, LOW, LOW, LOW];
    comes("epos4", with(&odd, &[]), &[0x1_2345_6789, 0, 7], 0);
    let after = [HIGH, LOW, LOW, HIGH, LOW, Parity(false)];
    comes("as5045", with(&[], &after), &[0xA6C, 0, 0xFFF], 0b10010);
    let after = [LOW, LOW, HIGH, LOW, Crc6];
    comes("mt6701", with(&[], &after), &[0x1234, 0x3FFF], 0b0010);
}
