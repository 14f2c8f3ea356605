//! Every command with every combination of additional data, at every width, rate and cable.

use super::rig::Rig;
use endat_hdl::endat::transaction::cause;
use endat_hdl::protocol::ModeCommand::{self, *};
use endat_sim::{
    encoder::{area, EncoderConfig, FrameEnd},
    US,
};

/// An encoder with short times.
fn quick(position_bits: u32, endat_hz: u64) -> EncoderConfig {
    let mut config = EncoderConfig::endat22(position_bits);
    config.tac = 0..=0;
    config.write_time = 0..=0;
    config.reset_time = 0;
    config.tm = match endat_hz > 1_000_000 {
        true => 2 * US..=4 * US,
        false => 10 * US..=15 * US,
    };
    config
}

/// Address for a command that the encoder accepts.
fn address(command: ModeCommand) -> u8 {
    match command {
        SelectMemory | PositionSelectMemory => area::OPERATING_PARAMETERS,
        _ => 7,
    }
}

/// Cables and widths of the quick tests: the shortest and the longest frame.
const SOME: [(f64, u32); 2] = [(0.0, 1), (100.0, 48)];

fn all(system_hz: u64, endat_hz: u64) {
    for cable_m in [0.0, 100.0] {
        let cases: Vec<(f64, u32)> = (1..=48).map(|width| (cable_m, width)).collect();
        commands(system_hz, endat_hz, &cases);
    }
}

/// Every command on these cables, with positions of these widths.
fn commands(system_hz: u64, endat_hz: u64, cases: &[(f64, u32)]) {
    for &(cable_m, width) in cases {
        let mut rig = Rig::new(system_hz, endat_hz, quick(width, endat_hz), cable_m);
        rig.good_position(); // measures the delay
        rig.good(SelectMemory, area::OPERATING_PARAMETERS, 0);
        for infos in [&[][..], &[0x4C], &[0x5B], &[0x4C, 0x5B]] {
            for off in [0x4F, 0x5F] {
                rig.good(PositionSelectMemory, off, 0);
            }
            for code in infos {
                rig.good(PositionSelectMemory, *code, 0);
            }
            rig.good(PositionSelectMemory, area::OPERATING_PARAMETERS, 0);
            let frame = rig.good_position();
            assert_eq!(frame.infos.len(), infos.len());
            for command in ModeCommand::ALL {
                let frame = rig.good(command, address(command), 0x5AC3 + u16::from(width as u8));
                assert_eq!(frame.refused, None, "{command:?}");
                if command == ReceiveReset {
                    let frame = rig.good_position();
                    assert_eq!(frame.infos.len(), 0, "a reset ends them");
                    rig.good(SelectMemory, area::OPERATING_PARAMETERS, 0);
                    for code in infos {
                        rig.good(PositionSelectMemory, *code, 0);
                    }
                    rig.good(PositionSelectMemory, area::OPERATING_PARAMETERS, 0);
                }
            }
        }
        rig.assert_clean();
    }
}

#[test]
fn at_200_khz() {
    commands(8_000_000, 200_000, &SOME);
}

#[test]
fn at_2_mhz() {
    commands(16_000_000, 2_000_000, &SOME);
}

#[test]
fn at_8_mhz() {
    commands(64_000_000, 8_000_000, &SOME);
}

#[test]
fn at_16_mhz() {
    commands(128_000_000, 16_000_000, &SOME);
}

#[test]
#[ignore = "slow: every width"]
fn every_width_at_200_khz() {
    all(8_000_000, 200_000);
}

#[test]
#[ignore = "slow: every width"]
fn every_width_at_2_mhz() {
    all(16_000_000, 2_000_000);
}

#[test]
#[ignore = "slow: every width"]
fn every_width_at_8_mhz() {
    all(64_000_000, 8_000_000);
}

#[test]
#[ignore = "slow: every width"]
fn every_width_at_16_mhz() {
    all(128_000_000, 16_000_000);
}

/// After 0xBF the encoder waits for a block address, which only the separate frame has room for.
#[test]
fn section_2_is_selected_with_a_frame_of_its_own() {
    let mut rig = Rig::new(16_000_000, 2_000_000, quick(25, 2_000_000), 10.0);
    rig.good_position();
    for block in 0..4 {
        rig.good(SelectMemory, area::SECTION_2, block);
        rig.good(ReceiveParameter, 0x80, 0xA550 + block);
    }
    for block in 0..4 {
        rig.good(SelectMemory, area::SECTION_2, block);
        let reply = rig.good(SendParameter, 0x80, 0).reply.expect("a reply");
        assert_eq!(reply.data, 0xA550 + block);
    }
    let over = rig.own(SelectMemory, area::SECTION_2, 4);
    assert_eq!(over.cause, cause::NO_START_BIT, "there are four");
    rig.good_position();
    rig.good_position();
    // As a supplement it is too short: the encoder ignores it, without a report. The position is good.
    let over = rig.ride(PositionSelectMemory, area::SECTION_2, 0);
    assert_eq!(over.cause, cause::NONE);
    assert_eq!(rig.last_frame().end, FrameEnd::Stopped);
    assert!(rig.bench.results().last().expect("a result").fresh);
    rig.good_position();
}
