//! The end of a frame: counters, threshold, additional data and their echo of a request, next selection.

use super::requests::{self, mailbox, ANSWERED};
use super::{high, keep_bits, low, minus, own, set, set_bits, ServiceTimes};
use crate::endat::sequencer::assembler::Assembler;
use crate::endat::service::map::{
    info_status, input, input::status, output, output::acknowledge, output::control as level,
    output::go, request_state, state, word, COUNTER_BAD_INFOS,
};
use crate::endat::transaction::cause;
use crate::protocol::ModeCommand;

pub(super) fn event(a: &mut Assembler, times: &ServiceTimes) {
    a.place("event").link().st(own::FROM_EVENT);
    a.inp(input::STATUS).st(own::STATUS);
    a.inp(input::CAUSE).st(own::INDEX).st(own::NUMBER);
    a.ldi(acknowledge::EVENT).out(output::ACKNOWLEDGE);
    let not_missed = a.label();
    a.ld(own::STATUS).andi(status::MISSED).jz(not_missed);
    a.ld(high(word::LOST)).addi(1).st(high(word::LOST));
    a.place(not_missed);
    let uncounted = a.label();
    if times.error_test_ms > 0 {
        let counted = a.label();
        a.ld(own::TESTING).jz(counted);
        a.ld(own::STATUS).andi(status::IS_REQUEST).jnz(uncounted);
        a.place(counted);
        set(a, own::BEHIND, 1);
    }
    a.call("count");
    threshold(a);
    a.place(uncounted);

    // Store additional data in the slots of their codes.
    a.ldi(0).st(own::MATCHED);
    take(
        a,
        [status::INFO_2_CAME, status::INFO_2],
        [input::INFO_2, input::INFO_2_STATUS],
        high(word::INFO_STATUS),
    );
    take(
        a,
        [status::INFO_1_CAME, status::INFO_1],
        [input::INFO_1, input::INFO_1_STATUS],
        low(word::INFO_STATUS),
    );

    let (sent, fulfilled) = (a.label(), a.label());
    a.ld(own::MAILBOX).jz("turn");
    a.xori(mailbox::SENT).jz(sent);
    a.ld(own::MAILBOX).xori(mailbox::RIDING).jnz("event_done");
    let (is_out, mine) = (a.label(), a.label());
    a.ld(own::STATUS).andi(status::IS_REQUEST).jnz(mine);
    // A frame that was under way, or measured the delay, carries no request. After more of them the channel has lost the request.
    a.ld(own::PATIENCE).addi(minus(1)).st(own::PATIENCE);
    a.jnz("event_done");
    set(a, own::PATIENCE, requests::PATIENCE);
    a.inp(input::STATUS)
        .andi(status::REQUEST_RUNS)
        .jnz("event_done");
    a.ldi(go::RIDE).out(output::GO);
    a.jmp("event_done");
    a.place(mine);
    // A forced CRC fault does not affect the supplement; other faults may.
    for sent in ANSWERED.into_iter().chain([cause::CRC]) {
        a.ld(own::NUMBER).xori(sent as u16).jz(is_out);
    }
    a.ldi(request_state::FRAME).call("finish");
    a.jmp("event_done");
    a.place(is_out);
    set(a, own::MAILBOX, mailbox::SENT);
    a.ld(own::STATUS).andi(status::INFO_1_ACTIVE).jz(fulfilled);
    a.jmp("event_done");

    // Additional data 1 shows when the encoder has finished, and with which echo.
    a.place(sent);
    let in_time = a.label();
    a.inp(input::TIME_MS).sub(own::BEGAN_MS);
    a.addi(minus(times.busy_ms)).jnc(in_time);
    a.ldi(request_state::BUSY_TIMEOUT).call("finish");
    a.jmp("event_done");
    a.place(in_time);
    a.ld(own::STATUS).andi(status::INFO_1_ACTIVE).jz(fulfilled);
    a.ld(own::STATUS).andi(status::INFO_1).jz("event_done");
    a.ld(low(word::INFO_STATUS)).andi(1 << 5).jnz("event_done");
    a.ld(low(word::INFO_STATUS)).st(high(word::ANSWER));
    a.ld(own::CONTENT).st(low(word::ANSWER));
    answer_echo(a, fulfilled);
    a.place(fulfilled);
    a.ldi(request_state::OK).call("finish");
    a.place("event_done");
    a.ld(own::FROM_EVENT).jmpa();
    turn(a);
    count(a);
}

/// Stores the content of a block of additional data, or counts its wrong CRC.
fn take(a: &mut Assembler, [came, good]: [u16; 2], [content, byte]: [u8; 2], kept: u8) {
    let (right, done) = (a.label(), a.label());
    a.ld(own::STATUS).andi(good).jnz(right);
    a.ld(own::STATUS).andi(came).jz(done);
    set_bits(a, kept, info_status::BAD_CRC);
    set(a, own::INDEX, COUNTER_BAD_INFOS.into());
    a.call("count").jmp(done);
    a.place(right);
    a.inp(content).st(own::CONTENT);
    a.inp(byte).st(kept);
    a.call("store");
    a.place(done);
}

/// 0x47 repeats the MRS code, 0x45 and 0x46 repeat the address, in the upper byte.
fn answer_echo(a: &mut Assembler, fulfilled: crate::endat::sequencer::assembler::Handle) {
    let (parameter, compare) = (a.label(), a.label());
    a.ld(own::CODE).xori(7).jnz(parameter);
    a.ld(own::MODE);
    a.xori(ModeCommand::PositionSelectMemory.code().into())
        .jnz(fulfilled);
    // The encoder does not echo the selection of additional data.
    a.ld(own::ADDRESS).andi(0xE0).xori(0x40).jz(fulfilled);
    a.jmp(compare);
    a.place(parameter);
    a.ld(own::CODE).addi(minus(5)).jnc(fulfilled);
    a.addi(minus(2)).jc(fulfilled);
    a.ld(own::MODE);
    a.xori(ModeCommand::PositionSendParameter.code().into())
        .jz(compare);
    a.ld(own::MODE);
    a.xori(ModeCommand::PositionReceiveParameter.code().into())
        .jnz(fulfilled);
    a.place(compare);
    a.ld(own::CONTENT).swap().andi(0xFF).sub(own::ADDRESS);
    a.jz(fulfilled);
    a.ldi(request_state::ADDRESS_ECHO).call("finish");
    a.jmp("event_done");
}

/// Counts cause INDEX, in 32 bits.
fn count(a: &mut Assembler) {
    a.place("count");
    a.ld(own::INDEX).add(own::INDEX).tax();
    a.ld_x(low(word::COUNTERS))
        .addi(1)
        .st_x(low(word::COUNTERS));
    a.ld_x(high(word::COUNTERS)).adc(own::ZERO);
    a.st_x(high(word::COUNTERS)).ret();
}

/// Threshold: n of the last m frames.
fn threshold(a: &mut Assembler) {
    let (stays, good, done) = (a.label(), a.label(), a.label());
    a.ld(own::WINDOW).jz(done);
    // The oldest frame was bad if the history is at least 2^(m-1).
    a.ld(own::HISTORY).sub(own::LEAVING).jc(stays);
    a.st(own::HISTORY);
    a.ld(own::BAD).addi(minus(1)).st(own::BAD);
    a.place(stays);
    a.ld(own::HISTORY).add(own::HISTORY).st(own::HISTORY);
    a.ld(own::INDEX).jz(good);
    a.ld(own::HISTORY).addi(1).st(own::HISTORY);
    a.ld(own::BAD).addi(1).st(own::BAD);
    a.place(good);
    a.ld(low(word::THRESHOLD)).jz(done);
    a.ld(own::BAD).sub(low(word::THRESHOLD)).jc(done);
    a.call("alarm");
    set_bits(a, low(word::STATE), state::ALARM);
    a.place(done);
}

/// Prepares the selection of the next code of the list.
fn turn(a: &mut Assembler) {
    let (go_on, select) = (a.label(), a.label());
    a.place("turn");
    a.ld(low(word::LIST_LENGTH)).jz("event_done");
    // Only if triggers send 111000.
    a.inp(input::CONFIGURED).andi(1 << 6).jz("event_done");
    // A list with one code is selected once.
    a.ld(low(word::LIST_LENGTH)).xori(1).jnz(select);
    a.ld(own::MATCHED).jnz("event_done");
    a.place(select);
    // The frame that ended may have measured the delay, so the last selection may still be under way.
    a.call("let_go").jnz("event_done");
    a.ld(own::TURN).addi(1).st(own::TURN);
    a.sub(low(word::LIST_LENGTH)).jc(go_on);
    set(a, own::TURN, 0);
    a.place(go_on);
    a.ldi(ModeCommand::PositionSelectMemory.code().into());
    a.out(output::COMMAND);
    a.ld(own::TURN).add(own::TURN).tax();
    a.ld_x(low(word::LIST)).out(output::ADDRESS);
    a.ldi(0).out(output::DATA);
    a.ldi(go::RIDE).out(output::GO);
    a.jmp("event_done");

    a.place("alarm");
    keep_bits(a, own::LEVELS, level::ALARM);
    a.out(output::CONTROL).ret();
}

/// Stores CONTENT of the block whose status byte is in A in the slots of its code.
pub(super) fn store(a: &mut Assembler) {
    let (next, other, done) = (a.label(), a.label(), a.label());
    a.place("store").andi(0x1F).st(own::CODE);
    a.link().st(own::FROM_STORE);
    a.ldi(0).st(own::INDEX);
    a.place(next);
    a.ld(own::INDEX).sub(low(word::LIST_LENGTH)).jnc(done);
    a.ld(own::INDEX).addi(minus(word::LIST_MAX.into())).jc(done);
    a.ld(own::INDEX).add(own::INDEX).tax();
    a.ld_x(low(word::LIST)).andi(0x1F).sub(own::CODE).jnz(other);
    a.ld(own::CONTENT).st_x(low(word::SLOTS));
    a.inp(input::SEQUENCE).st_x(high(word::SLOTS));
    set(a, own::MATCHED, 1);
    a.place(other);
    a.ld(own::INDEX).addi(1).st(own::INDEX).jmp(next);
    a.place(done);
    a.call("position_2");
    a.ld(own::FROM_STORE).jmpa();
}
