//! Requests of the host.

use super::rig::{quick, Rig, SYSTEM_HZ};
use endat_hdl::{
    protocol::ModeCommand::*,
    service::map::{request_state, word},
};
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
    let encoder = encoder().defect(1, echo).defect(2, data).defect(3, crc);
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
    assert_eq!(rig.bench.frames(0).len(), frames, "nothing went out");
    // An area that no encoder has.
    let (error, _) = rig.request(SelectMemory, 0x11, 0);
    assert_eq!(error, request_state::SILENT);
    let finished = rig.read(word::REQUEST_STATE) >> 16;
    assert_eq!(finished, 8);
    rig.good_position();
}

#[test]
fn words_are_read_and_written_while_sampling_at_10_khz_without_one_sample_late_or_wrong() {
    const PERIOD: u64 = SYSTEM_HZ / 10_000;
    let encoder = encoder().position(PositionSource::Random);
    let mut rig = Rig::new(false, encoder, 25);
    rig.good_position();
    // A busy host: select, choose what information 1 says, write, read low and high, on and on.
    let requests: [(_, u8, u16); 7] = [
        (PositionSelectMemory, area::OPERATING_PARAMETERS, 0),
        (PositionSelectMemory, 0x47, 0),
        (PositionReceiveParameter, 0x05, 0xA55A),
        (PositionSelectMemory, 0x45, 0),
        (PositionSendParameter, 0x05, 0),
        (PositionSelectMemory, 0x46, 0),
        (PositionErrorReset, 0, 0),
    ];
    let mut next = 0;
    let mut answers = vec![];
    let first = rig.bench.results().len();
    let mut triggers = vec![];
    for _ in 0..1_500 {
        triggers.push(rig.bench.cycle());
        rig.bench.trigger();
        let end = rig.bench.cycle() + PERIOD;
        let state = rig.read(word::REQUEST_STATE);
        if state & 1 == 0 && state >> 16 == next as u32 {
            if next > 0 {
                answers.push((state as u16 >> 4, rig.read(word::ANSWER) as u16));
            }
            let (command, address, data) = requests[next % requests.len()];
            let fields = u32::from(address) << 16 | u32::from(data);
            rig.write(word::REQUEST, u32::from(command.code()) << 24 | fields);
            next += 1;
        }
        rig.bench.run_cycles(end - rig.bench.cycle());
    }
    assert!(next > 100, "{next} requests");
    let results = &rig.bench.results()[first..];
    let frames = &rig.bench.frames(0)[first..];
    assert_eq!((results.len(), frames.len()), (1_500, 1_500));
    for ((result, frame), trigger) in results.iter().zip(frames).zip(triggers) {
        assert_eq!((result.cause, result.fresh), (0, true), "{frame:?}");
        assert_eq!(result.position, frame.position);
        let latch = result.first_fall_timestamp - trigger;
        assert!(latch < 4, "{latch} cycles after its trigger");
    }
    let jitter: std::collections::BTreeSet<u64> = results
        .windows(2)
        .map(|w| w[1].first_fall_timestamp - w[0].first_fall_timestamp)
        .collect();
    assert_eq!(
        jitter,
        [PERIOD].into(),
        "the time from trigger to latch never changes"
    );
    assert!(answers.iter().all(|a| a.0 == request_state::OK));
    let high_bytes = answers.iter().skip(5).step_by(requests.len());
    assert!(high_bytes.map(|a| a.1).all(|a| a == 0x05A5), "{answers:x?}");
    rig.assert_clean();
}
