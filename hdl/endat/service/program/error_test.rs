//! Forced errors on a schedule: each in turn in a separate frame, whose cause is checked. This proves that error reporting works.
//!
//! Positions of triggers are not affected; a trigger during such a frame is lost, as with any separate request frame.

use super::requests::{code, mailbox};
use super::{high, low, minus, own, set, set_bits, ServiceTimes};
use crate::endat::sequencer::assembler::Assembler;
use crate::endat::service::map::{
    force, input, output, output::go, state, word, ERROR_TEST_PATIENCE_MS,
};
use crate::endat::transaction::cause;
use crate::protocol::ModeCommand;

/// Forced errors, with the cause that must be reported.
const ERRORS: [(u16, u64); 4] = [
    (force::CRC, cause::CRC),
    (force::F1, cause::F1),
    (force::F2, cause::F2),
    (force::SECOND_RECEIVER, cause::UPSET),
];

/// Number of different errors that a card forces in turn.
pub const fn forced_errors(second_receiver: bool) -> usize {
    ERRORS.len() - !second_receiver as usize
}

/// Start values.
pub(super) fn start(a: &mut Assembler) {
    for word in [own::TESTING, own::BEHIND, own::TEST_NEXT] {
        set(a, word, 0);
    }
    a.inp(input::TIME_MS).st(own::TEST_FROM);
}

/// Called from the main loop while no request is in use.
pub(super) fn error_test(a: &mut Assembler, times: &ServiceTimes) {
    let (due, send, done) = (a.label(), a.label(), a.label());
    a.place("error_test").link().st(own::FROM_TEST);
    a.ld(low(word::ERROR_TEST)).jz(done);
    a.ld(low(word::STATE)).andi(state::UNPLUGGED).jnz(done);
    if times.continuous {
        // A forced error would end the continuous clock.
        a.ld(low(word::CONTINUOUS)).andi(1).jnz(done);
    }
    a.inp(input::TIME_MS).sub(own::TEST_FROM);
    a.sub(low(word::ERROR_TEST)).jc(done);
    a.ld(own::BEHIND).jnz(due);
    a.inp(input::TIME_MS).sub(own::TEST_FROM);
    a.sub(low(word::ERROR_TEST))
        .addi(minus(ERROR_TEST_PATIENCE_MS))
        .jnc(done);
    a.place(due);
    a.call("let_go").jnz(done);
    a.inp(input::TIME_MS).st(own::TEST_FROM);
    a.ldi(0).out(output::ADDRESS).out(output::DATA);
    set(a, own::TESTING, 1);
    set(a, own::GO, go::OWN);
    a.ldi(mailbox::OWN).st(own::MAILBOX);

    // Use the mode command of the triggers.
    let old = a.label();
    a.ldi(code(ModeCommand::SendPosition)).st(own::MODE);
    a.inp(input::CONFIGURED).andi(1 << 6).jz(old);
    a.ldi(code(ModeCommand::SendPositionAddInfo)).st(own::MODE);
    a.place(old).ld(own::MODE).out(output::COMMAND);

    let count = forced_errors(times.second_receiver);
    let first = a.label();
    for (n, error) in ERRORS.into_iter().enumerate().take(count).skip(1) {
        let other = a.label();
        a.ld(own::TEST_NEXT).xori(n as u16).jnz(other);
        set(a, own::TEST_NEXT, (n + 1) as u16 % count as u16);
        if error.0 == force::F2 {
            // Answers of EnDat 2.1 have no F2.
            a.inp(input::CONFIGURED).andi(1 << 6).jz(first);
        }
        force_error(a, error);
        a.jmp(send).place(other);
    }
    // The first error comes last: it is the default for any other value.
    set(a, own::TEST_NEXT, 1);
    a.place(first);
    force_error(a, ERRORS[0]);

    a.place(send).call("own_frame");
    a.ld(low(word::FORCE)).out(output::FORCE);
    a.ldi(mailbox::IDLE).st(own::MAILBOX);
    let told = a.label();
    a.ld(own::RESULT).sub(own::TEST_CAUSE).jz(told);
    // The frame had a real error, which is reported: the test is void.
    a.ld(own::RESULT).jnz(done);
    a.ld(high(word::ERROR_TEST_STATE)).addi(1);
    a.st(high(word::ERROR_TEST_STATE));
    set_bits(a, low(word::STATE), state::ERROR_TEST);
    a.call("alarm").jmp(done);
    a.place(told);
    a.ld(low(word::ERROR_TEST_STATE)).addi(1);
    a.st(low(word::ERROR_TEST_STATE));
    a.place(done).ldi(0).st(own::TESTING).st(own::BEHIND);
    a.ld(own::FROM_TEST).jmpa();
}

/// Forces this error in the next separate request frame.
fn force_error(a: &mut Assembler, (forced, cause): (u16, u64)) {
    a.ldi(forced | force::OWN_FRAMES).out(output::FORCE);
    set(a, own::TEST_CAUSE, cause as u16);
}
