//! Position 2, which arrives in three parts; compared with the position of the frame that brought the first part.

use super::{high, low, own, set, set_bits};
use crate::endat::sequencer::assembler::Assembler;
use crate::endat::service::map::{input, input::status, state, word, COUNTER_POSITION_2};

/// I4..I0 of the first part; the other parts follow.
const FIRST_PART: u16 = 2;

/// Stores CONTENT of additional data CODE.
pub(super) fn position_2(a: &mut Assembler) {
    let (second, third, none) = (a.label(), a.label(), a.label());
    a.place("position_2");
    a.ld(own::CODE).xori(FIRST_PART).jnz(second);
    a.st(own::STAGE);
    a.ld(own::STATUS).andi(status::FRESH).jz(none);
    a.ld(own::CONTENT).st(low(word::POSITION_2[0]));
    for (i, port) in input::POSITION.into_iter().enumerate() {
        a.inp(port).st(own::POSITION + i as u8);
    }
    set(a, own::STAGE, FIRST_PART + 1);
    a.place(none).ret();

    a.place(second);
    a.ld(own::CODE).sub(own::STAGE).jnz(none);
    a.ld(own::CODE).xori(FIRST_PART + 1).jnz(third);
    a.ld(own::CONTENT).st(high(word::POSITION_2[0]));
    set(a, own::STAGE, FIRST_PART + 2);
    a.ret();

    a.place(third);
    a.ld(own::CONTENT).st(low(word::POSITION_2[1]));
    set(a, own::STAGE, 0);
    difference(a);
    compare(a);
}

/// Position 2 - position - offset, modulo 2 to the power of the width.
fn difference(a: &mut Assembler) {
    let parts = |words: [u8; 2]| [low(words[0]), high(words[0]), low(words[1])];
    let (read, offset) = (parts(word::POSITION_2), parts(word::OFFSET));
    for (i, part) in read.into_iter().enumerate() {
        a.ld(part);
        match i {
            0 => a.sub(own::POSITION),
            _ => a.sbc(own::POSITION + i as u8),
        };
        a.st(own::DIFFERENCE + i as u8);
    }
    a.ldi(0).sbc(own::ZERO).st(own::DIFFERENCE + 3);
    for (i, offset) in offset.into_iter().enumerate() {
        a.ld(own::DIFFERENCE + i as u8);
        match i {
            0 => a.sub(offset),
            _ => a.sbc(offset),
        };
        a.st(own::DIFFERENCE + i as u8);
    }
    a.ld(own::DIFFERENCE + 3).sbc(own::ZERO);
    a.st(own::DIFFERENCE + 3);
    let (again, positive) = (a.label(), a.label());
    a.place(again);
    a.ld(own::DIFFERENCE + 3).andi(0x8000).jz(positive);
    for i in 0..4 {
        a.ld(own::DIFFERENCE + i);
        match i {
            0 => a.add(own::MODULUS),
            _ => a.adc(own::MODULUS + i),
        };
        a.st(own::DIFFERENCE + i);
    }
    a.jmp(again);
    a.place(positive);
    for (i, to) in parts(word::DIFFERENCE).into_iter().enumerate() {
        a.ld(own::DIFFERENCE + i as u8).st(to);
    }
}

/// Compares the difference, or the modulus minus the difference, with the tolerance.
fn compare(a: &mut Assembler) {
    let (compare, failed, within) = (a.label(), a.label(), a.label());
    a.ld(low(word::TOLERANCE)).jnz(compare);
    a.ld(high(word::TOLERANCE)).jnz(compare);
    a.ret();
    a.place(compare);
    a.ld(low(word::COMPARISONS)).addi(1);
    a.st(low(word::COMPARISONS));
    // Tolerance - difference.
    a.ld(low(word::TOLERANCE)).sub(own::DIFFERENCE);
    a.st(own::MARGIN);
    a.ld(high(word::TOLERANCE)).sbc(own::DIFFERENCE + 1);
    a.st(own::MARGIN + 1);
    for i in 2..4 {
        a.ldi(0).sbc(own::DIFFERENCE + i).st(own::MARGIN + i);
    }
    a.jnc(within);
    // Tolerance - (modulus - difference) = tolerance + difference - modulus.
    for i in 0..4 {
        a.ld(own::DIFFERENCE + i);
        match i {
            0 => a.add(low(word::TOLERANCE)),
            1 => a.adc(high(word::TOLERANCE)),
            _ => a.adc(own::ZERO),
        };
        a.st(own::MARGIN + i);
    }
    for i in 0..4 {
        a.ld(own::MARGIN + i);
        match i {
            0 => a.sub(own::MODULUS),
            _ => a.sbc(own::MODULUS + i),
        };
    }
    a.jnc(within);
    a.place(failed);
    a.ld(high(word::COMPARISONS)).addi(1);
    a.st(high(word::COMPARISONS));
    set(a, own::INDEX, COUNTER_POSITION_2.into());
    set_bits(a, low(word::STATE), state::POSITION_2);
    a.link().st(own::FROM_FAILED);
    a.call("count");
    a.call("alarm");
    a.ld(own::FROM_FAILED).jmpa();
    a.place(within).ret();
}
