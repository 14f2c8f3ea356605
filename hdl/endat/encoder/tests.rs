//! The encoder alone: a receiver that keeps to the rules clocks it, and takes DATA just before each falling edge.

use super::*;
use rtl_design::elaborate::elaborate;
use rtl_design::engine::{Compiled, Engine};
use std::sync::OnceLock;

/// Cycles of a microsecond: a system clock of 64 MHz.
const US: u64 = 64;

/// DATA as the encoder drives it; none: the driver is off.
type Drive = Option<bool>;

struct Rig {
    engine: Compiled,
    cycle: u64,
    half: u64,
    /// Changes of DATA, with the cycle at whose end they come.
    changes: Vec<(u64, Drive)>,
    latches: Vec<u64>,
    commands: Vec<u64>,
    answers: u64,
}

impl Rig {
    /// An encoder of 13 bits that is ready, at a clock of `hz`.
    fn new(hz: u64) -> Self {
        static MADE: OnceLock<Compiled> = OnceLock::new();
        Self::of(&MADE, false, hz)
    }

    /// The same with errors on command.
    fn with_errors() -> Self {
        static MADE: OnceLock<Compiled> = OnceLock::new();
        let mut rig = Self::of(&MADE, true, 1_000_000);
        rig.set("error_tm_cycles", 2 * US);
        rig
    }

    fn of(made: &OnceLock<Compiled>, errors: bool, hz: u64) -> Self {
        let make = || {
            let mut block = Encoder::new(EncoderMake {
                clock_low_max_us: 30,
                errors,
            });
            block.connect_all();
            Compiled::new(&elaborate(&block, "encoder").unwrap()).unwrap()
        };
        let mut rig = Self {
            engine: made.get_or_init(make).clone(),
            cycle: 0,
            half: 32_000_000 / hz,
            changes: vec![],
            latches: vec![],
            commands: vec![],
            answers: 0,
        };
        let settings = [("position_bits", 13), ("endat22", 1), ("tcal_cycles", 1)];
        let times = [("tm_cycles", 20 * US), ("tm_22_cycles", 2 * US)];
        let pins = [("endat_clk", 1), ("plugged", 1), ("position", 0x1234)];
        for (name, value) in settings.into_iter().chain(times).chain(pins) {
            rig.set(name, value);
        }
        rig.run(12 * US);
        rig
    }

    fn set(&mut self, name: &str, value: u64) {
        let port = self.engine.port(name);
        self.engine.set(port, value.into());
    }

    fn get(&mut self, name: &str) -> u64 {
        let port = self.engine.port(name);
        self.engine.get(port) as u64
    }

    fn drive(&mut self) -> Drive {
        (self.get("data_oe") == 1).then(|| self.get("data_o") == 1)
    }

    fn run(&mut self, cycles: u64) {
        for _ in 0..cycles {
            self.cycle += 1;
            self.set("tick_us", u64::from(self.cycle.is_multiple_of(US)));
            let before = self.drive();
            if self.get("latch") == 1 {
                self.latches.push(self.cycle);
            }
            if self.get("command_strobe") == 1 {
                let command = self.get("command");
                self.commands.push(command);
            }
            self.answers += self.get("answered");
            self.engine.tick();
            let drive = self.drive();
            if drive != before {
                self.changes.push((self.cycle, drive));
            }
        }
    }

    /// One pulse of CLOCK; gives DATA just before the next falling edge.
    fn pulse(&mut self, data: bool) -> Drive {
        self.set("endat_clk", 0);
        self.set("data_i", data.into());
        self.run(self.half);
        self.set("endat_clk", 1);
        self.run(self.half);
        self.drive()
    }

    /// So many pulses; the third one and those after it carry these bits, the first of them in bit `count - 1`.
    fn pulses(&mut self, bits: u64, count: u64, pulses: u64) -> Vec<Drive> {
        let bit = |n: u64| (3..3 + count).contains(&n) && bits >> (2 + count - n) & 1 == 1;
        (1..=pulses).map(|n| self.pulse(bit(n))).collect()
    }

    /// A mode command, and the levels of the answer with HIGH after it, where the start bit may come at once.
    fn answer(&mut self, command: u64, bits: usize) -> String {
        let seen = self.pulses(command, 6, 11 + bits as u64);
        assert_eq!(seen[..9], [None; 9], "the driver is off for the command");
        assert_eq!(seen[9], Some(false), "LOW before the start bit");
        let text = |d: &Drive| d.map_or('-', |level| if level { '1' } else { '0' });
        seen[10..].iter().map(text).collect()
    }

    fn is_at_rest(&mut self) -> bool {
        self.drive() == Some(false) && self.get("busy") == 0
    }
}

/// TI's capture of a real encoder: 37 bits, EnDat 2.2.
#[test]
fn encoder_sends_the_captured_frame() {
    let mut rig = Rig::new(2_000_000);
    rig.set("position_bits", 37);
    rig.set("position", 0x7_5006_84EF);
    let frame = "101111101110010000101100000000010101110011001";
    assert_eq!(rig.answer(0b111_000, frame.len()), format!("{frame}1"));
    rig.run(3 * US);
    assert!(rig.is_at_rest());
    assert_eq!((rig.answers, &rig.commands[..]), (1, &[0b111_000][..]));
}

/// Vectors POS21-2 and POS22-4 of the protocol's collection: CRC 00100, and 00101 with both alarms.
#[test]
fn encoder_answers_both_generations_with_their_error_bits() {
    let mut rig = Rig::new(1_000_000);
    assert_eq!(rig.answer(0b000_111, 20), "100010110001001001001");
    rig.run(21 * US);
    assert!(rig.is_at_rest());
    rig.set("position_bits", 29);
    rig.set("position", 0x1234_5678);
    rig.set("alarm_1", 1);
    rig.set("alarm_2", 1);
    let position: String = (0..29)
        .map(|i| char::from(b'0' + (0x1234_5678_u32 >> i & 1) as u8))
        .collect();
    assert_eq!(rig.answer(0b111_000, 37), format!("110{position}001011"));
    rig.run(3 * US);
    // Each alarm has its own bit.
    rig.set("alarm_1", 0);
    rig.set("alarm_2", 1);
    assert_eq!(rig.answer(0b111_000, 37)[..3], *"100");
    rig.run(3 * US);
    rig.set("alarm_1", 1);
    rig.set("alarm_2", 0);
    assert_eq!(rig.answer(0b111_000, 37)[..3], *"111");
}

/// The position changes in every cycle.
#[test]
fn encoder_takes_the_position_with_the_first_falling_edge() {
    let mut rig = Rig::new(1_000_000);
    rig.set("position_bits", 16);
    let begin = rig.cycle;
    let mut bits = vec![];
    for pulse in 1..=34 {
        for level in [0, 1] {
            rig.set("endat_clk", level);
            rig.set("data_i", u64::from((6..=8).contains(&pulse)));
            for _ in 0..rig.half {
                rig.set("position", rig.cycle);
                rig.run(1);
            }
        }
        bits.push(rig.drive());
    }
    // `endat_clk` falls at the end of cycle `begin`; two stages later `latch` is high, and the position is that of this cycle.
    let taken = begin + CLOCK_TO_DATA_CYCLES;
    assert_eq!(rig.latches, [taken + 1]);
    let position = bits[12..28]
        .iter()
        .rev()
        .fold(0, |p, b| p << 1 | u64::from(b.unwrap()));
    assert_eq!(position, taken & 0xFFFF);
}

/// From the edge at the pin that launches something to the change of DATA, with whole cycles between both.
#[test]
fn tcal_and_tm_are_exact() {
    let mut rig = Rig::new(1_000_000);
    for (tcal, edge) in [
        (0, 11),
        (10 * US + 32, 11),
        (10 * US + 33, 12),
        (60 * US, 61),
    ] {
        rig.changes.clear();
        rig.set("tcal_cycles", tcal);
        let begin = rig.cycle;
        rig.pulses(0b000_111, 6, edge + 20);
        let start = rig.changes.iter().find(|c| c.1 == Some(true)).unwrap().0;
        let rise = begin + (edge - 1) * US + 32;
        assert_eq!(start - rise, 1 + CLOCK_TO_DATA_CYCLES, "{tcal}");
        let last = rig.cycle - 32;
        rig.run(21 * US);
        let fall = *rig.changes.last().unwrap();
        assert_eq!(
            fall,
            (last + 1 + CLOCK_TO_DATA_CYCLES + 20 * US, Some(false))
        );
    }
    rig.set("tcal_cycles", 0);
    for tm in [80, 240, 8191] {
        rig.set("tm_22_cycles", tm);
        rig.pulses(0b111_000, 6, 32);
        let last = rig.cycle - 32;
        rig.run(8200);
        assert_eq!(
            rig.changes.last().unwrap().0 - last,
            1 + CLOCK_TO_DATA_CYCLES + tm
        );
    }
}

#[test]
fn unknown_commands_have_no_answer() {
    let mut rig = Rig::new(1_000_000);
    let parameter = [
        0b001_110, 0b011_100, 0b100_011, 0b101_010, 0b110_001, 0b010_010,
    ];
    for (command, endat22) in (0..64).flat_map(|c| [(c, 0), (c, 1)]) {
        rig.set("endat22", endat22);
        if command == 0b000_111 || (command, endat22) == (0b111_000, 1) {
            continue;
        }
        // A parameter of ones must not look like an answer.
        let (bits, count, low) = match parameter.contains(&command) {
            true => (command << 24 | 0xFF_FFFF, 30, 33),
            false => (command, 6, 9),
        };
        let seen = rig.pulses(bits, count, 80);
        let off = seen.iter().take_while(|d| d.is_none()).count();
        assert_eq!(off, low, "{command:06b}");
        assert!(
            seen[low..].iter().all(|d| *d == Some(false)),
            "{command:06b}"
        );
        assert_eq!(rig.get("busy"), 1);
        rig.run(11 * US);
        assert!(rig.is_at_rest());
        assert_eq!(rig.commands.pop(), Some(command));
    }
    assert_eq!(rig.answers, 0);
}

#[test]
fn stopped_clock_ends_a_frame() {
    // Cut in the command, before the answer, within it, and one pulse before its end.
    for pulses in [4, 9, 10, 11, 20, 31] {
        let mut rig = Rig::new(1_000_000);
        rig.pulses(0b111_000, 6, pulses);
        rig.run(9 * US);
        assert_eq!(rig.get("busy"), 1, "{pulses}");
        rig.run(2 * US);
        assert!(rig.is_at_rest(), "{pulses}");
        assert!(
            rig.answer(0b111_000, 21).ends_with('1'),
            "the next frame is whole"
        );
    }
}

#[test]
fn clock_low_for_too_long_needs_a_pause() {
    let mut rig = Rig::new(1_000_000);
    rig.pulses(0b111_000, 6, 15);
    rig.set("endat_clk", 0);
    rig.run(30 * US);
    assert!(rig.drive().is_some());
    rig.run(2 * US);
    assert_eq!(rig.drive(), None);
    let seen = rig.pulses(0b111_000, 6, 40);
    assert_eq!(seen, [None; 40], "deaf");
    rig.run(11 * US);
    assert!(rig.is_at_rest());
}

#[test]
fn early_frame_is_not_driven_into() {
    let mut rig = Rig::new(1_000_000);
    rig.pulses(0b000_111, 6, 31);
    rig.run(5 * US);
    assert_eq!(rig.drive(), Some(true), "tm");
    let seen = rig.pulses(0b000_111, 6, 31);
    assert_eq!(seen, [None; 31]);
    rig.run(11 * US);
    assert!(rig.is_at_rest());
}

#[test]
fn plug_and_reset_switch_the_driver_off() {
    for name in ["plugged", "reset"] {
        let mut rig = Rig::new(1_000_000);
        let wrong = u64::from(name == "reset");
        rig.pulses(0b111_000, 6, 20);
        rig.set(name, wrong);
        rig.run(1);
        assert_eq!(rig.drive(), None, "{name}");
        rig.run(200 * US);
        assert_eq!(rig.drive(), None, "{name}");
        rig.set(name, 1 - wrong);
        rig.run(9 * US);
        assert_eq!(rig.drive(), None, "{name}");
        rig.run(2 * US);
        assert!(rig.is_at_rest(), "{name}");
    }
}

/// The fastest clock: four system clock cycles in a period.
#[test]
fn sixteen_megahertz_have_four_cycles() {
    let mut rig = Rig::new(16_000_000);
    // DATA of a bit comes with the falling edge: 2 cycles after the rising one, and a cycle for the pin.
    let seen = rig.pulses(0b000_111, 6, 31);
    let bits: String = seen[11..]
        .iter()
        .map(|d| char::from(b'0' + u8::from(d.unwrap())))
        .collect();
    assert_eq!(bits, "10001011000100100100");
    rig.run(21 * US);
    assert!(rig.is_at_rest());
}

/// `arm` counts frames: two sound ones, three with errors, and sound ones again; a reset ends errors.
#[test]
fn errors_come_in_the_chosen_frames() {
    let mut rig = Rig::with_errors();
    let sound = rig.answer(0b111_000, 21);
    rig.run(3 * US);
    let mut wrong = sound.clone().into_bytes();
    wrong[7] ^= 1;
    let wrong = String::from_utf8(wrong).unwrap();
    let arm = |rig: &mut Rig| {
        rig.set("arm", 1);
        rig.run(1);
        rig.set("arm", 0);
    };
    rig.set("skip_frames", 2);
    rig.set("error_frames", 3);
    rig.set("bit_error", bit_error::INVERT);
    rig.set("bit_number", 7);
    arm(&mut rig);
    for expected in [&sound, &sound, &wrong, &wrong, &wrong, &sound, &sound] {
        assert_eq!(rig.answer(0b111_000, 21), *expected);
        rig.run(3 * US);
    }
    rig.set("skip_frames", 0);
    arm(&mut rig);
    assert_eq!(rig.answer(0b111_000, 21), wrong);
    rig.set("reset", 1);
    rig.run(1);
    rig.set("reset", 0);
    rig.run(12 * US);
    assert_eq!(rig.answer(0b111_000, 21), sound);
}

/// A wider answer than the model makes: the bits above the width come from the position.
#[test]
fn wider_answer_has_the_next_bits_of_the_position() {
    let mut rig = Rig::with_errors();
    rig.set("position", 0x1_1234);
    rig.set("error_frames", 1);
    rig.set("width_xor", 13 ^ 17);
    rig.set("arm", 1);
    rig.run(1);
    rig.set("arm", 0);
    let answer = rig.answer(0b000_111, 24);
    assert_eq!(answer[2..19], *"00101100010010001");
    assert!(answer.ends_with('1'));
}
