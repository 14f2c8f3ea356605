//! Requests of the host, and separate frames.

use super::{high, keep, keep_bits, low, minus, own, set, ServiceTimes};
use crate::endat::sequencer::assembler::Assembler;
use crate::endat::service::map::{
    input, input::status, output, output::acknowledge, output::control as level, output::go,
    request_state, word,
};
use crate::endat::transaction::cause;
use crate::protocol::ModeCommand;

/// Use of the request.
pub(super) mod mailbox {
    /// Only the list uses it.
    pub const IDLE: u16 = 0;
    /// The host's request waits for the next triggered frame.
    pub const RIDING: u16 = 1;
    /// Its frame is over; additional data 1 will bring the result.
    pub const SENT: u16 = 2;
    /// It has a separate frame.
    pub const OWN: u16 = 3;
}

/// Result of a request that never began; not a cause of a frame.
pub(super) const NEVER_BEGAN: u16 = cause::COUNT as u16;

/// Frames without the request before it is sent again.
pub(super) const PATIENCE: u16 = 4;

/// Causes with a valid answer: alarms, lost triggers, a short recovery time.
pub(super) const ANSWERED: [u64; 5] = [
    cause::NONE,
    cause::F1,
    cause::F2,
    cause::TRIGGER_OVERRUN,
    cause::RECOVERY_TOO_SHORT,
];

/// Commands with a separate frame and an answer without parameter.
const BARE: [ModeCommand; 2] = [ModeCommand::SendPosition, ModeCommand::SendTestValues];

/// Code of a command, as a number of the program.
pub(super) fn code(command: ModeCommand) -> u16 {
    command.code().into()
}

/// Called from the main loop, and returns to it.
pub(super) fn mailbox_request(a: &mut Assembler, times: &ServiceTimes) {
    let (is_own, ride) = (a.label(), a.label());
    a.place("mailbox");
    a.call("let_go").jnz("main");
    a.ldi(acknowledge::MAILBOX).out(output::ACKNOWLEDGE);
    a.inp(input::TIME_US).st(own::BEGAN_US);
    a.inp(input::TIME_MS).st(own::BEGAN_MS);
    a.ld(high(word::REQUEST)).swap().andi(0x3F).st(own::MODE);
    a.out(output::COMMAND);
    a.ld(high(word::REQUEST)).andi(0xFF).st(own::ADDRESS);
    a.out(output::ADDRESS);
    a.ld(low(word::REQUEST)).st(own::DATA).out(output::DATA);
    a.ldi(request_state::BUSY).st(low(word::REQUEST_STATE));
    // Commands with F2 wait for a trigger: 111000, and those with two equal triplets except 010 010.
    a.ld(own::MODE);
    a.xori(code(ModeCommand::SendPositionAddInfo)).jz(ride);
    a.ld(own::MODE).andi(7).st(own::COUNT);
    a.ld(own::MODE).shr().shr().shr().sub(own::COUNT);
    a.jnz(is_own);
    a.ld(own::COUNT).jz(is_own);
    a.xori(7).jz(is_own);
    a.ld(own::COUNT).xori(2).jz(is_own);
    a.place(ride);
    a.ldi(mailbox::RIDING).st(own::MAILBOX);
    set(a, own::PATIENCE, PATIENCE);
    a.ldi(go::RIDE).out(output::GO);
    a.jmp("main");

    a.place(is_own);
    a.ldi(mailbox::OWN).st(own::MAILBOX);
    // Triggers must not disturb the encoder's start, not even one directly after the frame of the reset.
    let lasts = a.label();
    a.ld(own::MODE);
    a.xori(code(ModeCommand::ReceiveReset)).jnz(lasts);
    keep_bits(a, own::LEVELS, level::HOLD_OFF);
    a.out(output::CONTROL);
    a.place(lasts);
    a.ldi(go::OWN).st(own::GO);
    a.call("own_frame");
    let (bare, kept) = (a.label(), a.label());
    for command in BARE {
        a.ld(own::MODE).xori(code(command)).jz(bare);
    }
    a.ldi(0).st(low(word::ANSWER_MORE));
    a.inp(input::PARAMETER[0]).st(low(word::ANSWER));
    a.inp(input::PARAMETER[1]).st(high(word::ANSWER));
    a.jmp(kept);
    a.place(bare);
    a.inp(input::REPLY[0]).st(low(word::ANSWER));
    a.inp(input::REPLY[1]).st(high(word::ANSWER));
    a.inp(input::REPLY[2]).st(low(word::ANSWER_MORE));
    a.place(kept).call("judge");
    a.st(own::ERROR);
    a.call("pause");
    a.call("let_triggers");
    a.ld(own::ERROR).call("finish");
    a.jmp("main");

    // Cancel a selection of the list that has not begun. If it has begun (A is not 0), finish it first and handle its end: the
    // channel sends it from the registers that the next request needs.
    a.place("let_go");
    a.ldi(go::CANCEL).out(output::GO);
    a.inp(input::STATUS)
        .andi(status::REQUEST_RUNS | status::EVENT)
        .ret();

    // The wait after a separate command.
    let (reset, write) = (a.label(), a.label());
    a.place("pause");
    a.ld(own::MODE);
    a.xori(code(ModeCommand::ReceiveReset)).jz(reset);
    a.ld(own::MODE);
    a.xori(code(ModeCommand::ReceiveParameter)).jz(write);
    a.ld(own::MODE);
    a.xori(code(ModeCommand::SelectMemory)).jz(write);
    a.ldi(times.gap_ms).jmp("wait");
    a.place(write).ldi(times.write_ms).jmp("wait");
    a.place(reset).ldi(times.reset_ms).jmp("wait");

    a.place("let_triggers");
    a.ld(own::LEVELS).andi(!level::HOLD_OFF);
    keep(a, own::LEVELS);
    a.out(output::CONTROL).ret();

    // Ends the waiting request with error A, unless its frame has just begun.
    let begun = a.label();
    a.place("give_up").st(own::ERROR);
    a.ldi(go::CANCEL).out(output::GO);
    a.inp(input::STATUS)
        .andi(status::REQUEST_RUNS | status::EVENT)
        .jnz(begun);
    a.ld(own::ERROR).jmp("finish");
    a.place(begun).ret();

    // Ends the request with error A.
    a.place("finish");
    (0..request_state::ERROR_SHIFT).for_each(|_| {
        a.st(own::ERROR).add(own::ERROR);
    });
    a.st(low(word::REQUEST_STATE));
    a.ld(high(word::REQUEST_STATE)).addi(1);
    a.st(high(word::REQUEST_STATE));
    a.inp(input::TIME_US).sub(own::BEGAN_US);
    a.st(low(word::DURATION));
    a.inp(input::TIME_MS).sub(own::BEGAN_MS);
    a.st(high(word::DURATION));
    a.ldi(mailbox::IDLE).st(own::MAILBOX).ret();
}

/// Sends the request at the ports in a separate frame; RESULT gets its cause and flags.
pub(super) fn own_frame(a: &mut Assembler, times: &ServiceTimes) {
    let (again, none, mine, done) = (a.label(), a.label(), a.label(), a.label());
    a.place("own_frame").link().st(own::FROM_OWN);
    a.inp(input::TIME_MS).st(own::OWN_FROM);
    a.ld(own::GO).out(output::GO);
    a.place(again);
    a.out(output::ALIVE);
    a.inp(input::STATUS).andi(status::EVENT).jz(none);
    a.inp(input::STATUS).andi(status::IS_REQUEST).jnz(mine);
    a.call("event");
    a.place(none);
    a.call("line");
    a.inp(input::TIME_MS).sub(own::OWN_FROM);
    a.addi(minus(times.request_ms)).jnc(again);
    a.ldi(go::CANCEL).out(output::GO);
    a.ldi(NEVER_BEGAN).st(own::RESULT).jmp(done);
    a.place(mine);
    a.inp(input::CAUSE).st(own::RESULT);
    a.call("event");
    a.place(done);
    a.ld(own::FROM_OWN).jmpa();
}

/// A = error code of the request, from RESULT and reply.
pub(super) fn judge(a: &mut Assembler) {
    let (answered, silent, crc, unknown) = (a.label(), a.label(), a.label(), a.label());
    let (ok, address, data) = (a.label(), a.label(), a.label());
    a.place("judge");
    let is = |a: &mut Assembler, what: u64, target| {
        a.ld(own::RESULT).xori(what as u16).jz(target);
    };
    for good in ANSWERED {
        is(a, good, answered);
    }
    is(a, cause::NO_START_BIT, silent);
    is(a, cause::CRC, crc);
    is(a, cause::UNKNOWN_COMMAND, unknown);
    a.ldi(request_state::FRAME).ret();
    a.place(silent).ldi(request_state::SILENT).ret();
    a.place(crc).ldi(request_state::CRC).ret();
    a.place(unknown).ldi(request_state::UNKNOWN).ret();

    a.place(answered);
    for command in BARE {
        a.ld(own::MODE).xori(code(command)).jz(ok);
    }
    a.inp(input::PARAMETER[1]).sub(own::ADDRESS);
    a.jnz(address);
    a.ld(own::MODE);
    a.xori(code(ModeCommand::SendParameter)).jz(ok);
    a.inp(input::PARAMETER[0]).sub(own::DATA).jnz(data);
    a.place(ok).ldi(request_state::OK).ret();
    a.place(address).ldi(request_state::ADDRESS_ECHO).ret();
    a.place(data).ldi(request_state::DATA_ECHO).ret();
}
