//! The service's program, step by step.
//!
//! ```text
//! start -> [power-up, initialisation] -> loop: end of a frame?   count it, keep its additional data, prepare the next selection
//!                                              request written?  send it, check its echo, wait as the command demands
//!                                              control written?  initialise, clear
//!                                              line HIGH for long, then LOW?  power-up, initialise
//! ```
//!
//! Subroutines that call others save their return address in a word of RAM. Conditions: after `sub`, C means less; after `addi(minus(k))`,
//! C means at least k.

mod error_test;
mod events;
mod guard;
mod initialise;
mod own;
mod position_2;
mod requests;

pub use error_test::forced_errors;
pub use initialise::{step_name, steps, Step};

use super::map::{
    control, input, input::status, output, output::acknowledge, output::control as level,
    request_state, state, word, COUNTER_BAD_INFOS,
};
use crate::config::LIST;
use crate::endat::sequencer::{assembler::Assembler, RAM_WORDS, SHARED_CYCLES};
use crate::endat::timing;
use guard::{guard, guarded, settings};

/// Times and automatic actions of a service.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ServiceTimes {
    /// Initialise the encoder after reset and after it is plugged in.
    pub initialise: bool,
    /// The channel has the watchdog and the check of the shortest recovery time.
    pub diagnosis: bool,
    /// The channel has the continuous clock.
    pub continuous: bool,
    /// MRS codes in the list of additional data after reset; 0 = none.
    pub infos: [u8; LIST],
    /// Initial period of the forced errors, in milliseconds; 0 leaves out their program.
    pub error_test_ms: u16,
    /// The channels have a second receiver.
    pub second_receiver: bool,
    /// Clock HIGH after power-up, before the pulse, in ms.
    pub power_up_ms: u16,
    /// Clock HIGH after the pulse, in ms.
    pub after_pulse_ms: u16,
    /// Wait after a reset, in ms.
    pub reset_ms: u16,
    /// Wait after writing a word or selecting an area, in ms.
    pub write_ms: u16,
    /// Wait after other commands with a parameter, in ms.
    pub gap_ms: u16,
    /// Longest Busy, in ms.
    pub busy_ms: u16,
    /// Timeout of a separate request frame, in ms.
    pub request_ms: u16,
    /// Initial timeout of a request that waits for a trigger, in ms.
    pub wait_ms: u16,
    /// Time that DATA must be HIGH to count as an open line, in ms.
    pub unplugged_ms: u16,
    /// Time without a write to the alive port after which a run restarts, in ms; at most 63.
    pub stuck_ms: u16,
    /// Upper limit of any wait, in ms, as a mask. It also limits a wait entered by a jump astray.
    pub wait_mask: u16,
    /// Clear RAM, which may hold any content after a reset.
    pub clears_ram: bool,
    /// System clock in kHz.
    pub system_khz: u32,
}

impl ServiceTimes {
    /// The protocol's times, for a system clock of `system_hz`.
    pub const fn at(system_hz: u64) -> Self {
        Self {
            initialise: true,
            diagnosis: true,
            continuous: true,
            infos: [0; LIST],
            error_test_ms: 0,
            second_receiver: false,
            power_up_ms: timing::POWER_UP_MS,
            after_pulse_ms: timing::AFTER_PULSE_MS,
            reset_ms: timing::RESET_MS,
            write_ms: timing::WRITE_MS,
            gap_ms: timing::PARAMETER_GAP_MS,
            busy_ms: timing::BUSY_MS,
            request_ms: 200,
            wait_ms: timing::REQUEST_WAIT_MS,
            unplugged_ms: 5,
            // Longest computation: a division of 2047 rounds, 48 cycles each, 13 ms at the slowest clock.
            stuck_ms: 32,
            wait_mask: WAIT_MASK,
            clears_ram: false,
            system_khz: (system_hz / 1_000) as u32,
        }
    }
}

/// 4 seconds.
const WAIT_MASK: u16 = 0x0FFF;
const _: () = assert!(timing::AFTER_PULSE_MS < WAIT_MASK && timing::POWER_UP_MS < WAIT_MASK);

/// Low half of a host word.
const fn low(word: u8) -> u8 {
    2 * word
}

/// High half of a host word.
const fn high(word: u8) -> u8 {
    2 * word + 1
}

/// Addend that subtracts `k`.
const fn minus(k: u16) -> u16 {
    0u16.wrapping_sub(k)
}

/// Sets a RAM word to a number.
fn set(a: &mut Assembler, address: u8, value: u16) {
    a.ldi(value).st(address);
}

/// Sets bits of a RAM word.
fn set_bits(a: &mut Assembler, address: u8, bits: u16) {
    a.ld(address).andi(!bits).addi(bits).st(address);
}

/// Stores A in one of [`own::KEPT`], with its complement. If an upset, or a jump astray, changes only one of the two, the main loop restarts the program.
fn keep(a: &mut Assembler, address: u8) {
    let inverse = own::KEPT.iter().find(|(kept, _)| *kept == address);
    let (_, inverse) = inverse.expect("a word that is kept");
    a.st(address).xori(u16::MAX).st(*inverse).xori(u16::MAX);
}

/// Sets bits of one of [`own::KEPT`].
fn keep_bits(a: &mut Assembler, address: u8, bits: u16) {
    a.ld(address).andi(!bits).addi(bits);
    keep(a, address);
}

/// The program.
///
/// # Panics
/// If the program exceeds the program memory: a bug in this file that every test detects.
pub fn program(times: &ServiceTimes) -> Vec<u32> {
    let mut a = Assembler::new();
    start(&mut a, times);
    main_loop(&mut a, times);
    subroutines(&mut a, times);
    events::event(&mut a, times);
    events::store(&mut a);
    position_2::position_2(&mut a);
    requests::mailbox_request(&mut a, times);
    requests::own_frame(&mut a, times);
    requests::judge(&mut a);
    if times.error_test_ms > 0 {
        error_test::error_test(&mut a, times);
    }
    if times.initialise {
        initialise::initialise(&mut a, times);
    }
    match a.finish() {
        Ok(words) => words,
        Err(fault) => panic!("the service's program: {fault}"),
    }
}

/// Cycles that clearing the RAM takes at most: seven instructions for each word.
pub const CLEAR_CYCLES: u64 = (7 * RAM_WORDS as u64 + 50) * SHARED_CYCLES;

/// Clears RAM, once after power-up.
fn clear_ram(a: &mut Assembler) {
    let (cold, more, half, warm) = (a.label(), a.label(), a.label(), a.label());
    let [(first, one), (second, other)] = own::CLEARED;
    // If the comparison is undecided, as in a simulator with unknown values, clear.
    a.ld(first).xori(one).jz(half);
    a.place(cold).ldi(u16::from(u8::MAX));
    // Word 0 is the counter, and is cleared last.
    a.place(more).st(0).tax().ldi(0).st_x(0);
    a.ld(0).addi(minus(1)).jnz(more).st(0);
    set(a, first, one);
    set(a, second, other);
    // Clear the count of starts: TIME_MS is 0 at power-up. A jump astray to this place clears it, too.
    a.inp(input::TIME_MS).st(high(word::STATE));
    a.jmp(warm);
    a.place(half).ld(second).xori(other).jnz(cold);
    a.place(warm);
}

fn start(a: &mut Assembler, times: &ServiceTimes) {
    if times.clears_ram {
        clear_ram(a);
    }
    a.place("start");
    // A separate zero for each: a jump astray into the middle corrupts only one of them.
    for word in [
        own::ZERO,
        own::MAILBOX,
        own::IS_HIGH,
        own::WINDOW,
        own::TURN,
        own::STAGE,
        low(word::STATE),
        low(word::REQUEST_STATE),
        low(word::PROGRESS),
        high(word::PROGRESS),
    ] {
        set(a, word, 0);
    }
    for (word, inverse) in guarded(times) {
        let value = match (word, inverse) {
            own::SET_ERROR_TEST => times.error_test_ms,
            _ => 0,
        };
        set(a, word, value);
        set(a, inverse, !value);
    }
    a.ldi(0).out(output::FOUND).out(output::PERIOD);
    let infos = times.infos.into_iter().filter(|code| *code != 0);
    let mut length = 0;
    for code in infos {
        set(a, low(word::LIST + length), code.into());
        length += 1;
    }
    if length > 0 {
        set(a, low(word::LIST_LENGTH), length.into());
    }
    set(a, low(word::REQUEST_WAIT), times.wait_ms);
    if times.error_test_ms > 0 {
        error_test::start(a);
    }
    a.ldi(acknowledge::EVENT | acknowledge::MAILBOX | acknowledge::CONTROL);
    a.out(output::ACKNOWLEDGE);
    a.call("modulus");
    if times.diagnosis {
        a.call("recovery_min");
        guard(a, own::SET_RECOVERY);
    }
    // At the end: a jump astray into the middle sets the start values, and the host must notice.
    a.ld(high(word::STATE)).addi(1).st(high(word::STATE));
    if times.initialise {
        a.call("power_up");
    } else {
        a.ldi(0).out(output::CONTROL);
    }
}

fn main_loop(a: &mut Assembler, times: &ServiceTimes) {
    a.place("main");
    let (free, acts, waits, levels) = (a.label(), a.label(), a.label(), a.label());
    let (nobody, idle) = (a.label(), a.label());
    let (no_clear, no_control) = (a.label(), a.label());
    a.out(output::ALIVE);
    a.call("look");
    // One request at a time: the next one waits in the mailbox, and so does the control word.
    a.ld(own::MAILBOX).jz(free);
    a.xori(requests::mailbox::OWN).jz(nobody);
    a.inp(input::STATUS)
        .andi(status::REQUEST_RUNS | status::EVENT)
        .jnz(levels);
    a.inp(input::STATUS).andi(status::CONTROL).jz(waits);
    a.ld(low(word::CONTROL)).andi(control::CANCEL).jz(waits);
    a.ldi(request_state::CANCELLED).call("give_up");
    a.ld(own::MAILBOX).jz(acts).jmp(levels);
    a.place(waits);
    a.ld(low(word::REQUEST_WAIT)).jz(levels);
    a.inp(input::TIME_MS).sub(own::BEGAN_MS);
    a.sub(low(word::REQUEST_WAIT)).jc(levels);
    a.ldi(request_state::NO_TRIGGER).call("give_up");
    a.jmp(levels);
    a.place(free);
    // A request under way that waits for no trigger is not handled here: an upset has led the program out of its handler.
    a.ld(low(word::REQUEST_STATE)).andi(request_state::BUSY);
    a.jz(idle);
    a.place(nobody);
    a.ldi(request_state::FRAME).call("finish");
    a.place(idle);
    a.inp(input::STATUS).andi(status::CONTROL).jz(no_control);
    // Before the next request, which a cancel does not concern.
    a.place(acts);
    a.ldi(acknowledge::CONTROL).out(output::ACKNOWLEDGE);
    a.ld(low(word::CONTROL)).andi(control::CLEAR).jz(no_clear);
    a.call("clear");
    a.place(no_clear);
    if times.initialise {
        a.ld(low(word::CONTROL)).andi(control::INITIALISE);
        a.jz(no_control);
        a.call("initialise");
    }
    a.place(no_control);
    a.inp(input::STATUS).andi(status::MAILBOX).jnz("mailbox");
    if times.error_test_ms > 0 {
        a.call("error_test");
    }
    a.place(levels);
    a.inp(input::DISPLACED).st(low(word::LOST));
    let same = a.label();
    a.inp(input::STATUS).andi(status::WRITTEN).jz(same);
    a.ldi(acknowledge::WRITTEN).out(output::ACKNOWLEDGE);
    settings(times).for_each(|setting| guard(a, setting));
    a.place(same);
    // A word plus its complement is -1. All are checked within the time of a frame of the continuous clock.
    a.ldi(guarded(times).count() as u16);
    for (word, inverse) in guarded(times) {
        a.add(word).add(inverse);
    }
    a.jnz("changed");
    // All other levels are cleared here.
    a.ld(own::LEVELS).andi(!level::ALARM).jnz("start");
    // Levels are rewritten continuously, so an upset of one is corrected.
    a.ld(low(word::FORCE)).out(output::FORCE);
    a.ld(own::LEVELS).out(output::CONTROL);
    a.ld(own::FOUND).out(output::FOUND);
    a.ld(own::PERIOD).out(output::PERIOD);
    if times.diagnosis {
        a.ld(low(word::LIMITS)).out(output::WATCHDOG);
        a.ld(high(word::LIMITS)).out(output::RECOVERY_MIN);
    }
    if times.continuous {
        a.ld(low(word::CONTINUOUS)).out(output::CONTINUOUS);
    }
    window(a);
    plug(a, times);
    a.jmp("main");

    // A guarded word has changed. WRITTEN set: the host wrote it. Otherwise an upset changed it: restart, and the count of starts makes the host write its settings again.
    a.place("changed");
    a.inp(input::STATUS).andi(status::WRITTEN).jz("start");
    a.jmp("main");
}

/// Another m: restart the history.
fn window(a: &mut Assembler) {
    let (same, more) = (a.label(), a.label());
    a.ld(high(word::THRESHOLD)).sub(own::WINDOW).jz(same);
    a.ld(high(word::THRESHOLD)).st(own::WINDOW).st(own::COUNT);
    a.ldi(0).st(own::HISTORY).st(own::BAD);
    set(a, own::LEAVING, 1);
    a.place(more);
    a.ld(own::COUNT).addi(minus(1)).st(own::COUNT).jz(same);
    a.ld(own::LEAVING).add(own::LEAVING).st(own::LEAVING);
    a.jnz(more);
    // Limit m to 16.
    set(a, own::LEAVING, 1 << 15);
    a.place(same);
}

/// An open line is HIGH; when it is LOW again, initialise the encoder.
fn plug(a: &mut Assembler, times: &ServiceTimes) {
    let done = a.label();
    a.inp(input::STATUS).andi(status::LINE_HIGH).jnz(done);
    a.ld(own::MAILBOX).jnz(done);
    a.ld(low(word::STATE)).andi(state::UNPLUGGED).jz(done);
    a.ld(low(word::STATE)).andi(!state::UNPLUGGED);
    a.st(low(word::STATE));
    if times.initialise {
        a.call("power_up");
    }
    a.place(done);
}

fn subroutines(a: &mut Assembler, times: &ServiceTimes) {
    // Handles the end of a frame, or detects an open line; for every loop. Call it only where nothing but `event` needs
    // the return address.
    let (is_high, again, seen) = (a.label(), a.label(), a.label());
    a.place("look");
    a.inp(input::STATUS).andi(status::EVENT).jnz("event");
    a.place("line");
    a.inp(input::STATUS).andi(status::LINE_HIGH).jnz(is_high);
    a.st(own::IS_HIGH).ret();
    a.place(is_high);
    a.ld(own::IS_HIGH).jnz(again);
    set(a, own::IS_HIGH, 1);
    a.inp(input::TIME_MS).st(own::HIGH_FROM);
    a.place(again);
    a.inp(input::TIME_MS).sub(own::HIGH_FROM);
    a.addi(minus(times.unplugged_ms)).jnc(seen);
    a.ld(low(word::STATE))
        .andi(!(state::UNPLUGGED | state::INITIALISED));
    a.addi(state::UNPLUGGED).st(low(word::STATE));
    a.place(seen).ret();

    if times.diagnosis {
        // Lower end of the selected recovery time range. The callers guard this; a jump astray into it is not guarded.
        let long = a.label();
        let cycles =
            |ns| timing::recovery_min_cycles(ns, u64::from(times.system_khz) * 1_000) as u16;
        a.place("recovery_min");
        a.inp(input::CONFIGURED).andi(1 << 7).jz(long);
        set(a, high(word::LIMITS), cycles(timing::SHORT_RECOVERY_MIN_NS));
        a.ret();
        a.place(long).place("recovery_long");
        set(a, high(word::LIMITS), cycles(timing::RECOVERY_MIN_NS));
        a.ret();
    }

    // Waits for at least A milliseconds; the mask limits every value of A.
    a.place("wait")
        .addi(1)
        .andi(times.wait_mask)
        .st(own::WAIT_MS);
    a.link().st(own::FROM_WAIT);
    a.inp(input::TIME_MS).st(own::WAIT_FROM);
    let (again, over) = (a.here(), a.label());
    a.out(output::ALIVE);
    a.call("look");
    a.inp(input::TIME_MS).sub(own::WAIT_FROM).sub(own::WAIT_MS);
    a.jnc(over);
    // The word may have been upset, too.
    a.inp(input::TIME_MS).sub(own::WAIT_FROM);
    a.addi(minus(times.wait_mask)).jnc(again);
    a.place(over).ld(own::FROM_WAIT).jmpa();

    // Clears counters and latched state.
    a.place("clear");
    // Unrolled: a jump astray into a loop would clear all of RAM.
    a.ldi(0);
    for counter in 0..=COUNTER_BAD_INFOS {
        let word = word::COUNTERS + counter;
        a.st(low(word)).st(high(word));
    }
    for word in [
        low(word::COMPARISONS),
        high(word::COMPARISONS),
        own::HISTORY,
        own::BAD,
        high(word::LOST),
    ] {
        a.st(word);
    }
    let mut latched = state::ALARM | state::POSITION_2;
    if times.error_test_ms > 0 {
        a.st(low(word::ERROR_TEST_STATE));
        a.st(high(word::ERROR_TEST_STATE));
        latched |= state::ERROR_TEST;
    }
    a.ld(low(word::STATE)).andi(!latched).st(low(word::STATE));
    a.ld(own::LEVELS).andi(!level::ALARM);
    keep(a, own::LEVELS);
    a.out(output::CONTROL).ret();

    // 2 to the power of the position's width.
    a.place("modulus");
    let (configured, more) = (a.label(), a.label());
    a.ld(own::FOUND).andi(63).jnz(configured);
    a.inp(input::CONFIGURED).andi(63);
    a.place(configured).st(own::COUNT);
    a.ldi(0);
    (1..4).for_each(|i| {
        a.st(own::MODULUS + i);
    });
    set(a, own::MODULUS, 1);
    a.place(more);
    a.ld(own::MODULUS).add(own::MODULUS).st(own::MODULUS);
    for i in 1..4 {
        a.ld(own::MODULUS + i).adc(own::MODULUS + i);
        a.st(own::MODULUS + i);
    }
    a.ld(own::COUNT).addi(minus(1)).st(own::COUNT).jnz(more);
    a.ret();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::endat::sequencer::PROGRAM_WORDS;

    #[test]
    fn the_program_fits_with_and_without_initialisation() {
        let mut times = ServiceTimes::at(100_000_000);
        let whole = program(&times).len();
        times.initialise = false;
        let part = program(&times).len();
        println!("{whole} words, {part} without initialisation");
        assert!(part < whole && whole <= PROGRAM_WORDS);
    }
}
