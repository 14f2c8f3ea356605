//! What can go wrong on a T-format channel has its cause in the card's result, and leaves the other channel alone.

use super::*;
use endat_hdl::protocols::t_format::cause;
use endat_hdl::regs::Protocol;
use endat_sim::t_format::{Defect, Violation};

#[test]
fn every_cause_of_an_encoder_is_told_by_its_code() {
    let rows = [
        (Defect::Silent, cause::NO_ANSWER),
        (Defect::StuckLow, cause::LINE_NOT_IDLE),
        (Defect::Flip { field: 0, bit: 1 }, cause::HEADER),
        (Defect::Flip { field: 0, bit: 7 }, cause::CONTROL_PARITY),
        (Defect::OtherId(12), cause::ECHO),
        (Defect::Delimiter { field: 5 }, cause::DELIMITER),
        (Defect::Short { fields: 5 }, cause::FIELD_TIMEOUT),
        (Defect::Flip { field: 2, bit: 0 }, cause::CRC),
        (Defect::Status(0x40), cause::REQUEST_PARITY),
        (Defect::Status(0x80), cause::REQUEST_DELIMITER),
        (Defect::Status(0x10), cause::COUNTING_ERROR),
        (Defect::Status(0x20), cause::MULTI_TURN_ALARM),
    ];
    let mut rig = Rig::new(false, "\"register\"");
    rig.trigger();
    rig.us(400);
    for (defect, code) in rows {
        let encoder = rig.master.bench.t_format_mut(0).encoder_mut();
        encoder.config.defect = defect;
        let before = rig.result(1);
        // The receiver sees a line that is stuck before it sends.
        rig.us(5);
        rig.trigger();
        rig.us(400);
        let bad = rig.result(1);
        let is_harmless = cause::flag(code) & cause::HARMLESS != 0;
        assert_eq!(bad.sequence, before.sequence + 1, "{defect:?}");
        assert_eq!(bad.cause, code, "{defect:?}");
        assert_eq!(bad.fresh, is_harmless, "{defect:?}");
        assert_eq!(bad.position == before.position, !is_harmless, "{defect:?}");
        let name = endat_host::causes::name(endat_host::causes::of_code(
            bad.cause as u8,
            Protocol::TFormat,
        ));
        assert_eq!(name, cause::ALL[code as usize].name);
        assert!(endat_host::causes::advice(name).is_some());
        let encoder = rig.master.bench.t_format_mut(0).encoder_mut();
        encoder.config.defect = Defect::None;
        rig.us(100);
        rig.trigger();
        rig.us(200);
        let good = rig.result(1);
        assert!(good.cause == 0 && good.fresh, "{defect:?}: {good:?}");
        assert_eq!(Some(good.position), rig.replied());
        let endat = rig.result(0);
        assert!(endat.cause == 0 && endat.fresh, "{defect:?}: {endat:?}");
    }
    rig.check_encoders();
}

/// A controller that asks again and again after a reset in the middle of an exchange.
#[test]
fn card_shows_no_wrong_t_format_position_after_a_reset() {
    for moment in 0..20 {
        let mut rig = Rig::new(false, "\"register\"");
        rig.trigger();
        rig.us(4 * moment);
        rig.master.bench.reset();
        for _ in 0..12 {
            rig.us(5 + moment % 3);
            rig.trigger();
            let seen = rig.result(1);
            assert!(
                !seen.fresh || Some(seen.position) == rig.replied(),
                "{moment}: {seen:?}"
            );
        }
        let violations = rig.master.bench.t_format(0).encoder().violations();
        assert!(
            !violations.iter().any(Violation::is_collision),
            "{violations:?}"
        );
        rig.us(200);
        rig.trigger();
        rig.us(200);
        let good = rig.result(1);
        assert!(good.fresh && Some(good.position) == rig.replied());
    }
}

#[test]
fn refused_requests_and_lost_triggers_have_codes_of_t_format() {
    let mut rig = Rig::new(false, "\"register\"");
    rig.trigger();
    rig.us(400);
    for id in [4, 6, 13] {
        rig.configure("timing", "request_id", id);
        let sent = rig.master.bench.t_format(0).encoder().requests().len();
        rig.trigger();
        rig.us(100);
        assert_eq!(rig.result(1).cause, cause::UNKNOWN_REQUEST, "{id}");
        assert_eq!(
            rig.master.bench.t_format(0).encoder().requests().len(),
            sent
        );
    }
    rig.configure("timing", "request_id", 3);
    rig.trigger();
    // Behind the EnDat frame with its recovery time, within the exchange.
    rig.us(35);
    rig.trigger();
    rig.us(200);
    let seen = rig.result(1);
    assert_eq!((seen.cause, seen.fresh), (cause::TRIGGER_OVERRUN, true));
    assert_eq!(rig.result(0).sequence, seen.sequence + 1, "EnDat took both");
    assert_eq!(rig.result(0).cause, 0);
}

/// A host that writes settings at any moment of an exchange: that one is as it was, the next one has them.
#[test]
fn settings_written_in_an_exchange_are_taken_behind_it() {
    for moment_us in (0..60).step_by(3) {
        let mut rig = Rig::new(false, "\"register\"");
        rig.trigger();
        rig.us(400);
        rig.trigger();
        rig.us(moment_us);
        rig.configure("frame", "period_cycles", 20);
        rig.configure("timing", "request_id", 0);
        rig.configure("timing", "filter_cycles", 2);
        rig.configure("limits", "start_timeout_us", 5);
        rig.configure("limits", "field_gap_us", 0);
        rig.us(200);
        let seen = rig.result(1);
        assert!(seen.cause == 0 && seen.fresh, "{moment_us}: {seen:?}");
        assert_eq!(Some(seen.position), rig.replied(), "{moment_us}");
        let encoder = rig.master.bench.t_format_mut(0).encoder_mut();
        encoder.config.bit_hz = 5_000_000;
        rig.trigger();
        rig.us(200);
        let next = rig.result(1);
        assert!(next.cause == 0 && next.fresh, "{moment_us}: {next:?}");
        let replies = rig.master.bench.t_format(0).encoder().replies();
        assert_eq!(replies.last().unwrap().len(), 6, "the other request");
        rig.check_encoders();
    }
}
