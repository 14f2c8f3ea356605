use super::assembler::Assembler;
use super::model::Model;
use super::*;
use crate::testing::{settle, tick};
use proptest::prelude::*;

/// The block and its models, one for each run of the program, compared cycle by cycle, with a host that reads and writes.
struct Rig {
    uut: Sequencer,
    models: Vec<Model>,
    /// Active run.
    running: usize,
    /// 0 fetch, 1 operand, 2 execute.
    cycle: u32,
    /// Cycles since the start.
    now: u64,
    /// RAM word of the operand.
    m: u16,
    input: u16,
    /// Host word being written: address, half, data.
    writing: Option<(usize, usize, u16)>,
    /// Host word being read, and its values in each cycle from the strobe on.
    reading: Option<(usize, Vec<u32>)>,
    /// Outputs of the first and the second run.
    outputs: [Vec<(u8, u16)>; 2],
}

/// Words of RAM for the host; those of the second run follow those of the first.
const HOST_WORDS: usize = RAM_WORDS / 2;
/// Op of IN.
const IN: u32 = 11;

/// Value of a port in a cycle.
fn port_value(port: u8, now: u64) -> u16 {
    (now as u16).wrapping_mul(0x9e37) ^ u16::from(port).wrapping_mul(0x1111)
}

impl Rig {
    fn new(program: &[u32]) -> Self {
        Self::with_runs(program, 1)
    }

    fn with_runs(program: &[u32], runs: usize) -> Self {
        let mut uut = Sequencer::new(program, runs > 1);
        uut.connect_all();
        Self {
            uut,
            models: vec![Model::new(program); runs],
            running: 0,
            cycle: 0,
            now: 0,
            m: 0,
            input: 0,
            writing: None,
            reading: None,
            outputs: [vec![], vec![]],
        }
    }

    fn ram(&mut self, address: usize) -> &mut [u16] {
        let (run, word) = (address / HOST_WORDS, address % HOST_WORDS);
        &mut self.models[run].ram[2 * word..2 * word + 2]
    }

    fn host_word(&mut self, address: usize) -> u32 {
        let halves = self.ram(address);
        u32::from(halves[0]) | u32::from(halves[1]) << 16
    }

    fn point(&mut self, address: usize) {
        self.uut.host_address.next = ((address % HOST_WORDS) as u64).into();
        self.uut.host_second.next = address >= HOST_WORDS;
    }

    fn read(&mut self, address: usize) {
        self.point(address);
        self.uut.host_read.next = true;
        self.reading = Some((address, vec![self.host_word(address)]));
    }

    fn write(&mut self, address: usize, half: usize, data: u16) {
        self.point(address);
        self.uut.host_half.next = half == 1;
        self.uut.host_data.next = u64::from(data).into();
        self.uut.host_write.next = true;
        self.writing = Some((address, half, data));
    }

    /// One cycle of block and models.
    fn step(&mut self) -> Result<(), String> {
        self.uut.clock.next = false.into();
        let is_in = self.models[self.running].instruction() >> 16 == IN;
        let given = if self.cycle == 2 && is_in {
            self.input
        } else {
            0
        };
        self.uut.port_in.next = u64::from(given).into();
        settle(&mut self.uut);
        let port = self.uut.port_address.val().to_u64() as u8;
        let written = (self.uut.port_write.val()).then(|| (port, self.a()));
        let strobes = (self.uut.port_read.val(), self.uut.port_second.val());
        let (is_reset, is_restart) = (self.uut.reset.val(), self.uut.restart.val());
        // A write of the host waits for the strobe to be over, and for the machine's own write.
        let is_written = !self.uut.host_write.val() && self.cycle != 2;
        let mut expected = None;
        let expected_strobes = (self.cycle == 1 && is_in, self.running == 1);
        let model = &mut self.models[self.running];
        match self.cycle {
            0 => {}
            1 => {
                self.m = model.ram[model.address()];
                self.input = port_value(model.port(), self.now);
            }
            _ => expected = model.step(self.m, self.input),
        }
        if let Some((address, half, data)) = self.writing.filter(|_| is_written) {
            self.ram(address)[half] = data;
            self.writing = None;
        }
        self.outputs[self.running].extend(expected);
        let is_shared = self.models.len() > 1;
        self.cycle = match self.cycle {
            2 if is_shared => {
                self.running = 1 - self.running;
                1
            }
            cycle => (cycle + 1) % 3,
        };
        if is_restart || is_reset {
            self.cycle = 0;
            self.models.iter_mut().for_each(|m| m.counter = 0);
        }
        if is_reset {
            self.models.iter_mut().for_each(Model::reset);
            self.running = 0;
            self.writing = None;
        }
        if let Some((address, mut values)) = self.reading.take() {
            values.push(self.host_word(address));
            self.reading = Some((address, values));
        }
        tick(&mut self.uut, |u, level| u.clock.next = level.into());
        self.uut.reset.next = false;
        self.uut.restart.next = false;
        self.uut.host_read.next = false;
        self.uut.host_clear.next = false;
        self.uut.host_write.next = false;
        self.now += 1;
        if (written, strobes) != (expected, expected_strobes) {
            return Err(format!(
                "cycle {}: written {written:x?}, read and second {strobes:?}, not {expected:x?}, {expected_strobes:?}",
                self.now
            ));
        }
        self.compare()
    }

    /// Compares the registers of the active run and of the waiting one.
    fn compare(&self) -> Result<(), String> {
        let u = &self.uut;
        let of = |m: &Model| (m.a, m.x, m.carry, m.link, m.counter);
        let running = (
            self.a(),
            u.index.q.val().to_u64() as u8,
            u.carry.q.val(),
            u.link.q.val().to_u64() as u16,
            u.counter.q.val().to_u64() as u16,
        );
        let other = (
            u.other_accumulator.q.val().to_u64() as u16,
            u.other_index.q.val().to_u64() as u8,
            u.other_carry.q.val(),
            u.other_link.q.val().to_u64() as u16,
            u.other_counter.q.val().to_u64() as u16,
        );
        let mut pairs = vec![(running, of(&self.models[self.running]))];
        if let [first, second] = &self.models[..] {
            pairs.push((other, of([second, first][self.running])));
        }
        for (got, want) in pairs {
            if got != want {
                return Err(format!(
                    "cycle {}: A, X, C, link, counter = {got:x?}, not {want:x?}",
                    self.now
                ));
            }
        }
        Ok(())
    }

    /// Checks the word that the host reads: three cycles after its strobe it is one of the values since then.
    fn check_host_word(&mut self) -> Result<(), String> {
        let got = self.uut.host_word.val().to_u64() as u32;
        match &self.reading {
            Some((address, values)) if !values[..3].contains(&got) => Err(format!(
                "cycle {}: host word {address:#x} = {got:#x}, not one of {values:x?}",
                self.now
            )),
            _ => Ok(()),
        }
    }

    fn a(&self) -> u16 {
        self.uut.port_out.val().to_u64() as u16
    }

    fn run(&mut self, cycles: u64) {
        for _ in 0..cycles {
            self.step().unwrap();
        }
    }

    /// Reads a word as the host does.
    fn fetch(&mut self, address: usize) -> u32 {
        self.read(address);
        self.run(8);
        self.check_host_word().unwrap();
        self.uut.host_word.val().to_u64() as u32
    }
}

/// Runs a program until it has written `count` words to ports.
fn outputs(assembler: &Assembler, count: usize) -> Vec<(u8, u16)> {
    let mut rig = Rig::new(&assembler.finish().unwrap());
    for _ in 0..10_000 {
        if rig.outputs[0].len() == count {
            return rig.outputs[0].clone();
        }
        rig.step().unwrap();
    }
    panic!("only {:x?}", rig.outputs[0]);
}

/// A at the end of a program.
fn result(make: impl Fn(&mut Assembler) -> &mut Assembler) -> u16 {
    let mut a = Assembler::new();
    make(&mut a);
    a.out(0);
    outputs(&a, 1)[0].1
}

/// C at the end of a program.
fn carry(make: impl Fn(&mut Assembler) -> &mut Assembler) -> u16 {
    result(|a| {
        make(a);
        // Loads C alone.
        a.ldi(0).st(250).adc(250)
    })
}

/// A = x, RAM word 9 = y, C = c.
fn operands(a: &mut Assembler, x: u16, y: u16, c: u16) -> &mut Assembler {
    a.ldi(y).st(9).ldi(c).shr().ldi(x)
}

#[test]
fn sums_and_differences_have_carry_and_borrow() {
    type Make = fn(&mut Assembler, u16) -> &mut Assembler;
    type Exact = fn(i32, i32, i32) -> i32;
    let ways: [(Make, Exact); 5] = [
        (|a, _| a.add(9), |x, y, _| x + y),
        (|a, _| a.adc(9), |x, y, c| x + y + c),
        (|a, _| a.sub(9), |x, y, _| x - y),
        (|a, _| a.sbc(9), |x, y, c| x - y - c),
        (|a, y| a.addi(y), |x, y, _| x + y),
    ];
    let pairs = [
        (1, 2),
        (0xffff, 1),
        (0x8000, 0x8000),
        (5, 5),
        (0, 0xffff),
        (0, 0),
        (0xffff, 0xffff),
    ];
    for (number, (make, of)) in ways.into_iter().enumerate() {
        for (x, y) in pairs {
            for c in [0, 1] {
                let exact = of(x.into(), y.into(), c.into());
                let is_out = u16::from(!(0..0x10000).contains(&exact));
                assert_eq!(
                    (
                        result(|a| make(operands(a, x, y, c), y)),
                        carry(|a| make(operands(a, x, y, c), y))
                    ),
                    (exact as u16, is_out),
                    "{number}: {x:#x} {y:#x} {c}"
                );
            }
        }
    }
}

#[test]
fn bits_are_combined_shifted_and_swapped() {
    assert_eq!(result(|a| a.ldi(0x1234).andi(0x0ff0)), 0x0230);
    assert_eq!(result(|a| a.ldi(0x1234).xori(0xffff)), 0xedcb);
    assert_eq!(result(|a| a.ldi(0x8003).shr()), 0x4001);
    assert_eq!(carry(|a| a.ldi(0x8003).shr()), 1);
    assert_eq!(carry(|a| a.ldi(3).shr().ldi(2).shr()), 0);
    assert_eq!(result(|a| a.ldi(0x1234).swap()), 0x3412);
    // A load leaves the carry alone.
    assert_eq!(carry(|a| a.ldi(1).shr().ld(3).ldi(7).andi(0)), 1);
}

#[test]
fn an_index_is_added_to_the_address_and_wraps() {
    let indexed = |x: u16, address: u8| {
        result(|a| {
            a.ldi(x).tax().ldi(0xabcd).st_x(address).ldi(0);
            a.ld(address.wrapping_add(x as u8)).ld_x(address)
        })
    };
    for (x, address) in [(0, 7), (1, 7), (0xff, 7), (0x380, 0x90)] {
        assert_eq!(indexed(x, address), 0xabcd, "{x:#x} {address:#x}");
    }
    let sums = result(|a| {
        a.ldi(2).tax().ldi(100).st(12).ldi(1).shr();
        a.adc_x(10).sub_x(10).add_x(10).sbc_x(10)
    });
    // 0 + 100 + 1 - 100 + 100 - 100
    assert_eq!(sums, 1);
}

#[test]
fn conditions_decide_jumps() {
    type Jump = fn(&mut Assembler, &str) -> usize;
    type IsTaken = fn(u16, bool) -> bool;
    let jumps: [(Jump, IsTaken); 6] = [
        (|a, to| a.jmp(to).len(), |_, _| true),
        (|a, to| a.jz(to).len(), |a, _| a == 0),
        (|a, to| a.jnz(to).len(), |a, _| a != 0),
        (|a, to| a.jc(to).len(), |_, c| c),
        (|a, to| a.jnc(to).len(), |_, c| !c),
        (|a, to| a.jneg(to).len(), |a, _| a >= 0x8000),
    ];
    for (number, (jump, is_taken)) in jumps.into_iter().enumerate() {
        for value in [0, 1, 0x100, 0x7fff, 0x8000] {
            for c in [0, 1] {
                let mut a = Assembler::new();
                // The condition tests A as loaded directly before.
                a.ldi(c).shr().ldi(1 ^ value & 1).ldi(value);
                jump(&mut a, "yes");
                a.out(1).place("yes").out(2);
                let port = if is_taken(value, c == 1) { 2 } else { 1 };
                assert_eq!(outputs(&a, 1), [(port, value)], "jump {number}, C = {c}");
            }
        }
    }
}

#[test]
fn a_call_comes_back_and_an_address_in_a_is_a_target() {
    let mut a = Assembler::new();
    let sub = a.label();
    a.ldi(1).call(sub).out(3).ldi_label("table").addi(1).jmpa();
    a.place(sub).addi(0x10).st(0).link().out(4).ld(0).ret();
    a.place("table").jmp("first").jmp("second");
    a.place("first").out(5).place("second").ldi(9).out(6);
    assert_eq!(outputs(&a, 3), [(4, 2), (3, 0x11), (6, 9)]);
}

#[test]
fn a_port_is_read_in_the_second_cycle() {
    let mut a = Assembler::new();
    a.inp(31).out(7).inp(4).out(30);
    assert_eq!(
        outputs(&a, 2),
        [(7, port_value(31, 1)), (30, port_value(4, 7))]
    );
}

/// 5, 6, 7, the unknown codes of 15, and the memory after the program.
#[test]
fn what_is_no_instruction_starts_again() {
    let special = (6..16).map(|n| 0xf0000 | n);
    for word in [0x5ffff, 0x60001, 0x70002].into_iter().chain(special) {
        let mut rig = Rig::new(&[0x80001, 0xc0000, word, 0xc0001]);
        rig.run(18);
        assert_eq!(rig.outputs[0], [(0, 1), (0, 2)], "{word:#x}");
    }
    let mut rig = Rig::new(&[0x80001, 0xc0000]);
    rig.run(18);
    assert_eq!(rig.outputs[0], [(0, 1), (0, 2)]);
    let full: Vec<u32> = (0..PROGRAM_WORDS)
        .map(|n| {
            if n == PROGRAM_WORDS - 1 {
                0xc0000
            } else {
                0x80001
            }
        })
        .collect();
    let mut rig = Rig::new(&full);
    rig.run(2 * PROGRAM_WORDS as u64 * 3);
    assert_eq!(rig.outputs[0], [(0, 2047), (0, 4094)]);
}

#[test]
fn restart_begins_at_zero_and_keeps_what_was_computed() {
    let mut a = Assembler::new();
    a.out(1).ldi(3).shr().tax().call("end");
    a.place("end").ldi(5).st(4).jmp("end");
    for at in 20..26 {
        let mut rig = Rig::new(&a.finish().unwrap());
        rig.run(at);
        rig.uut.restart.next = true;
        rig.step().unwrap();
        rig.run(3);
        assert_eq!(rig.outputs[0], [(1, 0), (1, 5)], "{at}");
        assert_eq!(
            (rig.models[0].x, rig.models[0].carry, rig.models[0].link),
            (1, true, 5)
        );
    }
}

#[test]
fn reset_clears_the_machine_but_not_the_ram() {
    let mut a = Assembler::new();
    a.ldi(3)
        .shr()
        .tax()
        .st(6)
        .call("end")
        .place("end")
        .jmp("end");
    let mut rig = Rig::new(&a.finish().unwrap());
    rig.run(30);
    rig.uut.reset.next = true;
    rig.step().unwrap();
    assert_eq!((rig.a(), rig.models[0].x, rig.models[0].link), (0, 0, 0));
    assert!(!rig.uut.carry.q.val());
    assert_eq!(rig.fetch(3), 1);
}

#[test]
fn the_host_writes_halves_and_reads_words() {
    let mut rig = Rig::new(&[]);
    for (address, half, data) in [(0, 0, 1), (0, 1, 2), (127, 1, 3), (127, 0, 4), (64, 1, 5)] {
        rig.write(address, half, data);
        rig.run(8);
    }
    assert_eq!(rig.fetch(0), 0x20001);
    assert_eq!(rig.fetch(127), 0x30004);
    assert_eq!(rig.fetch(64), 0x50000);
    // It stays until the next strobe.
    rig.uut.host_address.next = 0u64.into();
    rig.write(64, 1, 6);
    rig.run(20);
    assert_eq!(rig.uut.host_word.val().to_u64(), 0x50000);
    rig.uut.host_clear.next = true;
    rig.run(1);
    assert_eq!(rig.uut.host_word.val().to_u64(), 0);
    rig.uut.host_clear.next = true;
    assert_eq!(rig.fetch(64), 0x60000);
}

#[test]
fn two_runs_take_turns_and_share_nothing_but_the_program() {
    // Each run counts in its RAM, from the first value of its port.
    let mut a = Assembler::new();
    a.inp(5).st(9).place("again").ld(9).addi(1).st(9).out(2);
    a.jmp("again");
    let mut rig = Rig::with_runs(&a.finish().unwrap(), 2);
    rig.run(200);
    let from = |run: usize, cycle| {
        let outputs = &rig.outputs[run];
        assert!(outputs.len() > 8, "{outputs:x?}");
        for (i, output) in outputs.iter().enumerate() {
            assert_eq!(
                *output,
                (2, port_value(5, cycle).wrapping_add(1 + i as u16))
            );
        }
        outputs.len()
    };
    // The second one's first IN is two cycles after the first one's.
    let (first, second) = (from(0, 1), from(1, 3));
    assert!(first.abs_diff(second) <= 1, "{first} {second}");
    assert_ne!(rig.fetch(9 / 2), rig.fetch(HOST_WORDS + 9 / 2));
    for (address, half, data) in [(20, 0, 0x12), (HOST_WORDS + 20, 1, 0x34)] {
        rig.write(address, half, data);
        rig.run(8);
    }
    assert_eq!(rig.fetch(20), 0x12);
    assert_eq!(rig.fetch(HOST_WORDS + 20), 0x34_0000);
}

/// Checks the cycle counts in the documentation.
#[test]
fn an_instruction_takes_three_cycles_alone_and_four_shared() {
    for (runs, cycles) in [(1, INSTRUCTION_CYCLES), (2, SHARED_CYCLES)] {
        let mut a = Assembler::new();
        a.place("again").addi(1).out(0).jmp("again");
        let mut rig = Rig::with_runs(&a.finish().unwrap(), runs);
        rig.run(3 * cycles * 50 + 1);
        for outputs in &rig.outputs[..runs] {
            assert!((49..=50).contains(&outputs.len()), "{runs} {outputs:?}");
        }
    }
}

/// A source of random numbers (splitmix64).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % limit
    }

    /// Any word, but rarely one that restarts; often a RAM word that others use too.
    fn instruction(&mut self) -> u32 {
        let mut op = self.below(16) as u32;
        if (5..8).contains(&op) && self.below(8) != 0 {
            op = 2;
        }
        let mut imm = self.below(0x10000) as u32;
        if op == 15 && self.below(8) != 0 {
            imm = self.below(6) as u32;
        }
        if op < 5 && self.below(2) == 0 {
            imm &= !0xf8;
        }
        if (9..10).contains(&op) && self.below(2) == 0 {
            imm |= 0xff0f;
        }
        op << 16 | imm
    }
}

/// A random program with a host that reads and writes, and restarts, at random moments.
fn check(seed: u64, cycles: u64, runs: usize) -> Result<(), String> {
    let mut random = Random(seed);
    let program: Vec<u32> = (0..PROGRAM_WORDS).map(|_| random.instruction()).collect();
    let mut rig = Rig::with_runs(&program, runs);
    let mut quiet = 0;
    for _ in 0..cycles {
        if quiet == 0 && random.below(3) == 0 {
            let all = if random.below(2) == 0 {
                4
            } else {
                HOST_WORDS as u64
            };
            let run = random.below(runs as u64) as usize;
            let address = random.below(all) as usize + run * HOST_WORDS;
            rig.reading = None;
            if random.below(2) == 0 {
                rig.read(address);
            } else {
                rig.write(
                    address,
                    random.below(2) as usize,
                    random.below(0x10000) as u16,
                );
            }
            quiet = 8;
        }
        rig.uut.restart.next = random.below(60) == 0;
        rig.step()?;
        quiet = u64::saturating_sub(quiet, 1);
        if quiet < 6 {
            rig.check_host_word()?;
        }
    }
    for address in 0..runs * HOST_WORDS {
        for _ in 0..8 {
            rig.step()?;
        }
        rig.check_host_word()?;
        rig.read(address);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, failure_persistence: None, max_shrink_iters: 0, ..ProptestConfig::default() })]

    #[test]
    fn random_programs_do_what_the_model_does(seed: u64) {
        check(seed, 3000, 1).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn two_runs_of_random_programs_do_what_two_models_do(seed: u64) {
        check(seed, 3000, 2).map_err(TestCaseError::fail)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 120, failure_persistence: None, max_shrink_iters: 0, ..ProptestConfig::default() })]

    #[test]
    #[ignore = "slow: 120 random programs"]
    fn many_random_programs_do_what_the_model_does(seed: u64) {
        check(seed, 3000, 1).map_err(TestCaseError::fail)?;
    }

    #[test]
    #[ignore = "slow: two runs of 120 random programs"]
    fn two_runs_of_many_random_programs_do_what_two_models_do(seed: u64) {
        check(seed, 3000, 2).map_err(TestCaseError::fail)?;
    }
}
