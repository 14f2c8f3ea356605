//! Requests of the host.

use super::rig::{quick, Rig};
use endat_hdl::endat::service::map::{request_state, word};
use endat_hdl::protocol::ModeCommand::*;
use endat_sim::encoder::{area, Defect, EncoderConfig, PositionSource};

fn encoder() -> EncoderConfig {
    quick(EncoderConfig::endat22(25))
}

#[test]
fn a_word_is_read_with_frames_of_its_own() {
    let mut rig = Rig::new(false, encoder(), 25);
    rig.good(SelectMemory, area::MANUFACTURER_1, 0);
    let answer = rig.good(SendParameter, 0x0D, 0);
    assert_eq!(answer, 0x0D_8019, "word 13: 25 bits");
    rig.good_position();
    rig.assert_clean();
}

#[test]
fn a_word_is_read_while_positions_go_on() {
    let encoder = encoder().position(PositionSource::Ramp { start: 0, step: 77 });
    let mut rig = Rig::new(false, encoder, 25);
    rig.good_position();
    rig.good(PositionSelectMemory, area::MANUFACTURER_1, 0);
    assert_eq!(rig.good(PositionSelectMemory, 0x47, 0) & 0xFFFF, 0xA100);
    rig.good(PositionSelectMemory, 0x45, 0);
    assert_eq!(rig.good(PositionSendParameter, 0x0D, 0) & 0xFFFF, 0x0D19);
    assert_eq!(rig.good(PositionSelectMemory, 0x46, 0) & 0xFFFF, 0x0D80);
    let results = rig.bench.results();
    assert!(results.len() > 5);
    assert!(
        results.iter().all(|r| r.cause == 0 && r.fresh),
        "no position is lost"
    );
    rig.assert_clean();
}

#[test]
fn every_error_has_its_code() {
    let echo = Defect::EchoXor(0x01_0000);
    let data = Defect::EchoXor(0x00_0100);
    let crc = Defect::CrcXor(4);
    let encoder = encoder().defect(2, echo).defect(3, data).defect(4, crc);
    let mut rig = Rig::new(false, encoder, 25);
    rig.good_position();
    let select = area::OPERATING_PARAMETERS;
    let (error, _) = rig.request(SelectMemory, select, 0);
    assert_eq!(error, request_state::ADDRESS_ECHO);
    let (error, _) = rig.request(SelectMemory, select, 0);
    assert_eq!(error, request_state::DATA_ECHO);
    let (error, _) = rig.request(SelectMemory, select, 0);
    assert_eq!(error, request_state::CRC);
    let frames = rig.bench.frames(0).len();
    for code in [0, 0b000_001, 0b111_111, 0b001_011] {
        let (error, _) = rig.request_code(code, 0, 0);
        assert_eq!(error, request_state::UNKNOWN);
    }
    assert_eq!(rig.bench.frames(0).len(), frames, "nothing was sent");
    // An unknown area.
    let (error, _) = rig.request(SelectMemory, 0x11, 0);
    assert_eq!(error, request_state::SILENT);
    let finished = rig.read(word::REQUEST_STATE) >> 16;
    assert_eq!(finished, 8);
    rig.good_position();
}

/// Triggers at any time around the reset's frame and the encoder's start: none reaches the encoder before it is ready.
/// Catches triggers that are accepted between the end of the frame and the wait.
#[test]
fn no_trigger_disturbs_the_start_of_an_encoder_that_is_reset() {
    let encoder = encoder().position(PositionSource::Ramp { start: 0, step: 77 });
    let mut rig = Rig::new(false, encoder, 25);
    rig.good_position();
    let reset = u32::from(ReceiveReset.code()) << 24;
    // Slightly more than a frame apart, so that every request meets them at another place.
    let apart = rig.bench.system_hz() / 9_001;
    for _ in 0..12 {
        let before = rig.read(word::REQUEST_STATE) >> 16;
        rig.write(word::REQUEST, reset);
        while rig.read(word::REQUEST_STATE) >> 16 == before {
            rig.bench.trigger();
            rig.bench.run_cycles(apart);
        }
        assert_eq!(rig.read(word::REQUEST_STATE) as u16, 0, "fulfilled");
        rig.assert_clean();
        // The first position after the request's frame reports the triggers that were lost during it.
        rig.frames(2);
        rig.good_position();
    }
}
