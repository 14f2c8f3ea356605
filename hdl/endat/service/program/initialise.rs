//! Initialisation: a table of steps, each a request with a separate frame at the calibration clock.

use super::requests::{code, NEVER_BEGAN};
use super::{guard, high, keep, keep_bits, low, minus, own, set, set_bits, ServiceTimes};
use crate::config::PERIOD_BITS;
use crate::endat::sequencer::assembler::Assembler;
use crate::endat::service::map::{
    self, input, input::status, output, output::control as level, output::go, plate, state, word,
    NAME_PLATE,
};
use crate::endat::timing;
use crate::protocol::{ModeCommand, MAX_POSITION_BITS};

/// Number of tries of a step.
const TRIES: u16 = 3;
/// Number of tries of the whole table: an encoder with a loose plug loses its selection.
const ROUNDS: u16 = 2;

/// A step of the initialisation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Reset (101010), and the wait after it.
    Reset,
    /// Selects a memory area (001110).
    Select(u8),
    /// Reads a word (100011) into the name plate.
    Read {
        /// Address.
        address: u8,
        /// Host word to store it in.
        to: u8,
    },
    /// Writes a word (011100), and the wait after it.
    Write {
        /// Address.
        address: u8,
        /// Data.
        data: u16,
    },
    /// Uses the position width of the encoder; fails if it is invalid.
    TakeWidth,
    /// Continues only if the encoder supports EnDat 2.2; otherwise sets 2 MHz and 000111.
    OnlyEndat22,
    /// Chooses the clock.
    ChooseClock,
    /// Sets the recovery time if it differs.
    SetRecovery,
}

/// The steps of the initialisation, numbered from 1.
pub fn steps() -> Vec<Step> {
    let mut steps = vec![Step::Reset];
    let mut area = 0;
    for (index, entry) in NAME_PLATE.iter().enumerate() {
        if entry.mrs != area {
            area = entry.mrs;
            if area == map::AREA_ENDAT22 {
                steps.push(Step::OnlyEndat22);
            }
            steps.push(Step::Select(area));
        }
        steps.push(Step::Read {
            address: entry.address,
            to: word::NAME_PLATE + index as u8,
        });
        match entry.name {
            "warnings" => steps.extend([0, 1].map(|address| Step::Write { address, data: 0 })),
            "position_bits" => steps.push(Step::TakeWidth),
            "clock_max_khz" => steps.push(Step::ChooseClock),
            "recovery" => steps.push(Step::SetRecovery),
            _ => {}
        }
    }
    steps
}

/// Description of a step.
pub fn step_name(step: Step) -> String {
    match step {
        Step::Reset => "reset".into(),
        Step::Select(mrs) => format!("select memory area 0x{mrs:02X}"),
        Step::Read { to, .. } => {
            let entry = &NAME_PLATE[usize::from(to - word::NAME_PLATE)];
            format!("read {}", entry.name)
        }
        Step::Write { address, data } => format!("write {data} to word {address}"),
        Step::TakeWidth => "take over the position width".into(),
        Step::OnlyEndat22 => "find out whether it knows EnDat 2.2".into(),
        Step::ChooseClock => "choose the clock".into(),
        Step::SetRecovery => "set the recovery time".into(),
    }
}

/// Subroutines `power_up`, for an encoder after power-up, and `initialise`.
pub(super) fn initialise(a: &mut Assembler, times: &ServiceTimes) {
    a.place("power_up").link().st(own::FROM_INITIALISE);
    set_bits(a, low(word::STATE), state::INITIALISING);
    keep_bits(a, own::LEVELS, level::HOLD_OFF);
    a.out(output::CONTROL);
    a.ldi(times.power_up_ms).call("wait");
    a.ld(own::LEVELS).addi(level::CLOCK_LOW);
    a.out(output::CONTROL);
    // One or two microseconds; the specification asks for 125 ns.
    a.inp(input::TIME_US).st(own::WAIT_FROM);
    let pulse = a.here();
    a.inp(input::TIME_US).sub(own::WAIT_FROM).addi(minus(2));
    a.jnc(pulse);
    a.ld(own::LEVELS).out(output::CONTROL);
    a.ldi(times.after_pulse_ms).call("wait");
    a.jmp("begin");

    a.place("initialise").link().st(own::FROM_INITIALISE);
    keep_bits(a, own::LEVELS, level::HOLD_OFF);
    a.out(output::CONTROL);
    a.place("begin");
    if times.diagnosis {
        // The host's limit applies to positions; a selection may wait for the encoder's memory.
        a.ldi(0).out(output::WATCHDOG);
    }
    set(a, own::ROUNDS, ROUNDS);
    a.place("round");
    a.ldi(go::CANCEL).out(output::GO);
    let running = a.here();
    a.out(output::ALIVE);
    a.call("look");
    a.inp(input::STATUS).andi(status::REQUEST_RUNS).jnz(running);
    a.out(output::FOUND).out(output::PERIOD);
    keep(a, own::FOUND);
    keep(a, own::PERIOD);
    a.st(low(word::PROGRESS)).st(high(word::PROGRESS));
    a.ld(low(word::STATE))
        .andi(state::ALARM | state::POSITION_2)
        .addi(state::INITIALISING);
    a.st(low(word::STATE));
    // Clear everything read from another encoder.
    a.ldi(0);
    for word in word::NAME_PLATE..=map::PLATE_DELAY {
        a.st(low(word)).st(high(word));
    }
    a.ldi(go::OWN | go::CALIBRATE).st(own::GO);

    for step in steps() {
        match step {
            Step::Reset => a.call("step_reset"),
            Step::Select(mrs) => a.ldi(mrs.into()).call("step_select"),
            Step::Read { address, to } => a
                .ldi(u16::from(low(to)) << 8 | u16::from(address))
                .call("step_read"),
            Step::Write { address, data } => a
                .ldi(data)
                .st(own::DATA)
                .ldi(address.into())
                .call("step_write"),
            Step::TakeWidth => a.call("step_width"),
            Step::OnlyEndat22 => a.call("step_endat22"),
            Step::ChooseClock => a.call("step_clock"),
            Step::SetRecovery => a.call("step_recovery"),
        };
    }
    a.place("initialised");
    a.ld(own::FOUND).out(output::FOUND);
    a.inp(input::DELAY).st(low(map::PLATE_DELAY));
    a.ldi(1).st(high(map::PLATE_DELAY));
    set_bits(a, low(word::STATE), state::INITIALISED);
    a.place("initialise_end");
    a.ldi(0).st(low(word::PROGRESS));
    a.ld(low(word::STATE)).andi(!state::INITIALISING);
    a.st(low(word::STATE));
    a.call("let_triggers");
    a.call("modulus");
    a.ld(own::FROM_INITIALISE).jmpa();

    let answered = a.label();
    a.place("step_failed");
    a.ldi(0);
    keep(a, own::FOUND);
    keep(a, own::PERIOD);
    a.out(output::FOUND).out(output::PERIOD);
    a.ld(low(word::PROGRESS)).st(high(word::PROGRESS));
    // The line was never LOW: the next LOW means that an encoder was connected.
    a.ld(own::RESULT).xori(NEVER_BEGAN).jnz(answered);
    set_bits(a, low(word::STATE), state::UNPLUGGED);
    a.jmp("initialise_end");
    a.place(answered);
    a.ld(own::ROUNDS).addi(minus(1)).st(own::ROUNDS);
    a.jnz("round");
    a.jmp("initialise_end");

    exchange(a);
    findings(a, times);
}

/// Steps that are requests.
fn exchange(a: &mut Assembler) {
    a.place("step_reset").ldi(0).st(own::ADDRESS).st(own::DATA);
    a.ldi(code(ModeCommand::ReceiveReset)).jmp("exchange");
    a.place("step_select").st(own::ADDRESS);
    a.ldi(0).st(own::DATA);
    a.ldi(code(ModeCommand::SelectMemory)).jmp("exchange");
    a.place("step_read").st(own::STEP);
    a.andi(0xFF).st(own::ADDRESS);
    a.ldi(0).st(own::DATA);
    a.ldi(code(ModeCommand::SendParameter)).jmp("exchange");
    a.place("step_write").st(own::ADDRESS);
    a.ldi(code(ModeCommand::ReceiveParameter));

    a.place("exchange").st(own::MODE).out(output::COMMAND);
    a.link().st(own::STEP_RETURN);
    a.ld(own::ADDRESS).out(output::ADDRESS);
    a.ld(own::DATA).out(output::DATA);
    a.ld(low(word::PROGRESS)).addi(1).st(low(word::PROGRESS));
    a.ldi(TRIES).st(own::RETRIES);
    let (again, good, done) = (a.label(), a.label(), a.label());
    a.place(again);
    a.call("own_frame").call("judge").jz(good);
    a.call("pause");
    a.ld(own::RETRIES).addi(minus(1)).st(own::RETRIES);
    a.jnz(again);
    a.jmp("step_failed");
    a.place(good);
    a.ld(own::MODE);
    a.xori(code(ModeCommand::SendParameter)).jnz(done);
    a.ld(own::STEP).swap().tax();
    a.inp(input::PARAMETER[0]).st_x(0);
    a.ldi(1).st_x(1);
    a.place(done).call("pause");
    a.ld(own::STEP_RETURN).jmpa();
}

/// Restarts the program if no initialisation is under way: an upset has led here.
fn no_jump_astray(a: &mut Assembler) {
    a.ld(low(word::STATE)).andi(state::INITIALISING).jz("start");
}

/// Steps that evaluate words.
fn findings(a: &mut Assembler, times: &ServiceTimes) {
    let counted = |a: &mut Assembler| {
        a.ld(low(word::PROGRESS)).addi(1).st(low(word::PROGRESS));
    };
    let same = a.label();
    a.place("step_width");
    counted(a);
    a.ld(low(plate("position_bits"))).andi(63);
    keep(a, own::FOUND);
    a.jz("step_failed");
    a.addi(minus(MAX_POSITION_BITS as u16 + 1))
        .jc("step_failed");
    a.inp(input::CONFIGURED).andi(63).sub(own::FOUND).jz(same);
    a.jmp("other_width");
    a.place(same).ret();
    a.place("other_width");
    set_bits(a, low(word::STATE), state::OTHER_WIDTH);
    a.ret();

    let is_endat22 = a.label();
    a.place("step_endat22");
    counted(a);
    a.ld(low(plate("commands"))).andi(3).xori(1).jz(is_endat22);
    a.ld(own::FOUND).addi(1 << 6);
    keep(a, own::FOUND);
    if times.diagnosis {
        no_jump_astray(a);
        a.call("recovery_long");
        guard(a, own::SET_RECOVERY);
    }
    a.ldi(timing::ENDAT21_MAX_KHZ).st(own::DIVISOR);
    a.call("slowest");
    a.jmp("initialised");
    a.place(is_endat22);
    set_bits(a, low(word::STATE), state::ENDAT22);
    a.ret();

    // The period for DIVISOR kHz, rounded up, unless the configured period is longer.
    let (more, unknown) = (a.label(), a.label());
    a.place("step_clock");
    counted(a);
    a.ld(low(plate("clock_max_khz"))).st(own::DIVISOR);
    a.jz(unknown);
    a.place("slowest");
    let last = times.system_khz - 1;
    a.ldi(last as u16).st(own::REST);
    a.ldi((last >> 16) as u16).st(own::REST + 1);
    a.ldi(0).st(own::COUNT);
    a.place(more);
    a.ld(own::COUNT).addi(1).st(own::COUNT);
    a.addi(minus(1 << PERIOD_BITS)).jc("step_failed");
    a.ld(own::REST).sub(own::DIVISOR).st(own::REST);
    a.ld(own::REST + 1).sbc(own::ZERO).st(own::REST + 1);
    a.jnc(more);
    a.inp(input::PERIOD).sub(own::COUNT).jnc(unknown);
    a.ld(own::COUNT);
    keep(a, own::PERIOD);
    a.out(output::PERIOD);
    set_bits(a, low(word::STATE), state::SLOWER);
    a.place(unknown).ret();

    // Short only if selected, and if the clock runs as fast as configured.
    let (long, decided, range) = (a.label(), a.label(), a.label());
    a.place("step_recovery");
    counted(a);
    a.ldi(map::RECOVERY_LONG).st(own::DATA);
    if times.diagnosis {
        no_jump_astray(a);
        a.call("recovery_min");
        a.ld(low(word::STATE)).andi(state::SLOWER).jz(range);
        a.call("recovery_long");
        a.place(range);
        guard(a, own::SET_RECOVERY);
    }
    a.ld(low(word::STATE)).andi(state::SLOWER).jnz(long);
    a.inp(input::CONFIGURED).andi(1 << 7).jz(long);
    a.ldi(map::RECOVERY_SHORT).st(own::DATA);
    a.place(long).place(decided);
    a.ld(low(plate("recovery"))).andi(map::RECOVERY_MASK);
    a.sub(own::DATA).jz("initialised");
    // The word has other functions, too.
    a.ld(low(plate("recovery"))).andi(!map::RECOVERY_MASK);
    a.add(own::DATA).st(own::DATA);
    a.ldi(map::RECOVERY_ADDRESS.into());
    a.call("step_write");
    a.ld(own::DATA).st(low(plate("recovery")));
    a.jmp("initialised");
}
