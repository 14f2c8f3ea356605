//! Requests that wait for a trigger that does not come.

use super::rig::{quick, Rig};
use endat_hdl::endat::{
    service::map::{control, request_state, word},
    timing::REQUEST_WAIT_MS,
};
use endat_hdl::protocol::ModeCommand::*;
use endat_sim::{encoder::EncoderConfig, MS};

fn rig() -> Rig {
    let mut rig = Rig::new(false, quick(EncoderConfig::endat22(25)), 25);
    rig.good_position();
    rig.good_position();
    rig
}

/// Writes an attached request, without a trigger.
fn send(rig: &mut Rig, command: u8, address: u8) {
    rig.write(
        word::REQUEST,
        u32::from(command) << 24 | u32::from(address) << 16,
    );
    rig.wait_for(word::REQUEST_STATE, |s| s & 1 == 1);
}

/// The error of a request that ends by itself within this many milliseconds.
fn ended(rig: &mut Rig, ms: u64) -> u16 {
    let before = rig.read(word::REQUEST_STATE) >> 16;
    let end = rig.bench.now() + ms * MS;
    loop {
        let state = rig.read(word::REQUEST_STATE);
        if state >> 16 != before {
            assert_eq!(state & 1, 0);
            return state as u16 >> request_state::ERROR_SHIFT;
        }
        assert!(rig.bench.now() < end, "still pending after {ms} ms");
        rig.bench.run_cycles(2_000);
    }
}

/// The next request of either kind succeeds, and positions continue.
fn assert_free(rig: &mut Rig) {
    rig.good(SelectMemory, 0xA1, 0);
    rig.good(PositionSelectMemory, 0xA1, 0);
    rig.good_position();
    rig.assert_clean();
}

#[test]
fn a_request_without_a_trigger_ends_by_itself_and_sends_nothing() {
    let mut rig = rig();
    assert_eq!(rig.read(word::REQUEST_WAIT), u32::from(REQUEST_WAIT_MS));
    rig.write(word::REQUEST_WAIT, 20);
    let frames = rig.bench.frames(0).len();
    send(&mut rig, PositionSelectMemory.code(), 0xA1);
    rig.bench.run_for(15 * MS);
    assert_eq!(rig.read(word::REQUEST_STATE) & 1, 1, "not before its time");
    assert_eq!(ended(&mut rig, 10), request_state::NO_TRIGGER);
    assert_eq!(rig.bench.frames(0).len(), frames);
    // It is not sent after its end.
    rig.good_position();
    let last = rig.bench.frames(0).last().unwrap().command;
    assert_eq!(last, Some(SendPositionAddInfo.code()));
    assert_free(&mut rig);
}

/// The supplement has been sent, and no frame brings the additional data with its result.
#[test]
fn a_request_whose_answer_no_trigger_brings_ends_by_itself() {
    let mut rig = rig();
    rig.good(PositionSelectMemory, 0x45, 0);
    rig.write(word::REQUEST_WAIT, 20);
    send(&mut rig, PositionSendParameter.code(), 0x0D);
    rig.bench.trigger();
    rig.bench.run_for(5 * MS);
    assert_eq!(rig.read(word::REQUEST_STATE) & 1, 1);
    assert_eq!(ended(&mut rig, 20), request_state::NO_TRIGGER);
    rig.good(PositionSelectMemory, 0x4F, 0);
    assert_free(&mut rig);
}

#[test]
fn without_a_limit_a_request_waits_until_it_is_cancelled() {
    let mut rig = rig();
    rig.write(word::REQUEST_WAIT, 0);
    send(&mut rig, PositionErrorReset.code(), 0);
    rig.bench.run_for(100 * MS);
    assert_eq!(rig.read(word::REQUEST_STATE) & 1, 1);
    // Other actions in the control word wait for the end of the request, and are executed then.
    rig.write(word::CONTROL, u32::from(control::CANCEL | control::CLEAR));
    assert_eq!(ended(&mut rig, 1), request_state::CANCELLED);
    rig.bench.run_for(MS);
    assert_eq!(rig.read(word::COUNTERS), 0, "counters cleared");
    rig.good_position();
    let last = rig.bench.frames(0).last().unwrap().command;
    assert_eq!(last, Some(SendPositionAddInfo.code()));
    // It has no effect with no request under way.
    rig.write(word::CONTROL, u32::from(control::CANCEL));
    rig.bench.run_for(MS);
    assert_eq!(rig.read(word::REQUEST_STATE) & 1, 0);
    assert_free(&mut rig);
}

/// A frame that already carries the request is completed, and so is the request.
#[test]
fn a_cancelled_request_on_the_wire_is_finished() {
    let mut rig = rig();
    for wait_us in [2, 20, 40, 60] {
        send(&mut rig, PositionErrorReset.code(), 0);
        rig.bench.trigger();
        rig.bench.run_for(wait_us * MS / 1_000);
        let finished = rig.read(word::REQUEST_STATE) >> 16;
        rig.write(word::CONTROL, u32::from(control::CANCEL));
        let state = rig.wait_for(word::REQUEST_STATE, |s| s >> 16 != finished || s & 1 == 0);
        let error = state as u16 >> request_state::ERROR_SHIFT;
        assert!(
            error == request_state::OK || error == request_state::CANCELLED,
            "{error}"
        );
        rig.bench.run_for(MS);
        let last = rig.bench.frames(0).last().unwrap();
        assert!(last.supplement.is_some(), "{last:?}");
        rig.good_position();
    }
    assert_free(&mut rig);
}
