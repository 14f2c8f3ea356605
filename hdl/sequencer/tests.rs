use super::assembler::Assembler;
use super::model::Model;
use super::*;
use crate::testing::{settle, tick};
use proptest::prelude::*;

/// The block beside its model, cycle by cycle, and a host that reads and writes.
struct Rig {
    uut: Sequencer,
    model: Model,
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
    outputs: Vec<(u8, u16)>,
}

/// What a port answers in a cycle.
fn port_value(port: u8, now: u64) -> u16 {
    (now as u16).wrapping_mul(0x9e37) ^ u16::from(port).wrapping_mul(0x1111)
}

impl Rig {
    fn new(program: &[u32]) -> Self {
        let mut uut = Sequencer::new(program);
        uut.connect_all();
        Self {
            uut,
            model: Model::new(program),
            cycle: 0,
            now: 0,
            m: 0,
            input: 0,
            writing: None,
            reading: None,
            outputs: vec![],
        }
    }

    fn host_word(&self, address: usize) -> u32 {
        u32::from(self.model.ram[2 * address]) | u32::from(self.model.ram[2 * address + 1]) << 16
    }

    fn read(&mut self, address: usize) {
        self.uut.host_address.next = (address as u64).into();
        self.uut.host_read.next = true;
        self.reading = Some((address, vec![self.host_word(address)]));
    }

    fn write(&mut self, address: usize, half: usize, data: u16) {
        self.uut.host_address.next = (address as u64).into();
        self.uut.host_half.next = half == 1;
        self.uut.host_data.next = u64::from(data).into();
        self.uut.host_write.next = true;
        self.writing = Some((address, half, data));
    }

    /// One cycle of block and model.
    fn step(&mut self) -> Result<(), String> {
        self.uut.clock.next = false.into();
        settle(&mut self.uut);
        let port = self.uut.port_address.val().to_u64() as u8;
        self.uut.port_in.next = u64::from(port_value(port, self.now)).into();
        settle(&mut self.uut);
        let written = (self.uut.port_write.val()).then(|| (port, self.a()));
        let (is_reset, is_restart) = (self.uut.reset.val(), self.uut.restart.val());
        // A write of the host waits for the strobe to be over, and for the machine's own write.
        let is_written = !self.uut.host_write.val() && self.cycle != 2;
        let mut expected = None;
        match self.cycle {
            0 => {}
            1 => {
                self.m = self.model.ram[self.model.address()];
                self.input = port_value(self.model.port(), self.now);
            }
            _ => expected = self.model.step(self.m, self.input),
        }
        if let Some((address, half, data)) = self.writing.filter(|_| is_written) {
            self.model.ram[2 * address + half] = data;
            self.writing = None;
        }
        self.cycle = (self.cycle + 1) % 3;
        if is_restart || is_reset {
            self.cycle = 0;
            self.model.counter = 0;
        }
        if is_reset {
            self.model.reset();
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
        self.uut.host_write.next = false;
        self.now += 1;
        self.outputs.extend(expected);
        let m = &self.model;
        let want = (m.a, m.x, m.carry, m.link, m.counter, expected);
        let got = (
            self.a(),
            self.uut.index.q.val().to_u64() as u8,
            self.uut.carry.q.val(),
            self.uut.link.q.val().to_u64() as u16,
            self.uut.counter.q.val().to_u64() as u16,
            written,
        );
        if got != want {
            return Err(format!(
                "cycle {}: A, X, C, link, counter, port = {got:x?}, not {want:x?}",
                self.now
            ));
        }
        Ok(())
    }

    /// What the host has read, three cycles after its strobe: one of the values that the word had from then on.
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
        if rig.outputs.len() == count {
            return rig.outputs;
        }
        rig.step().unwrap();
    }
    panic!("only {:x?}", rig.outputs);
}

/// What a program leaves in A.
fn result(make: impl Fn(&mut Assembler) -> &mut Assembler) -> u16 {
    let mut a = Assembler::new();
    make(&mut a);
    a.out(0);
    outputs(&a, 1)[0].1
}

/// What a program leaves in C.
fn carry(make: impl Fn(&mut Assembler) -> &mut Assembler) -> u16 {
    result(|a| {
        make(a);
        // C comes in alone.
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
                // The condition is on what stands in A right before.
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

/// 5, 6, 7 and the unknown ones of 15; then what no program filled.
#[test]
fn what_is_no_instruction_starts_again() {
    let special = (6..16).map(|n| 0xf0000 | n);
    for word in [0x5ffff, 0x60001, 0x70002].into_iter().chain(special) {
        let mut rig = Rig::new(&[0x80001, 0xc0000, word, 0xc0001]);
        rig.run(18);
        assert_eq!(rig.outputs, [(0, 1), (0, 2)], "{word:#x}");
    }
    let mut rig = Rig::new(&[0x80001, 0xc0000]);
    rig.run(18);
    assert_eq!(rig.outputs, [(0, 1), (0, 2)]);
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
    assert_eq!(rig.outputs, [(0, 2047), (0, 4094)]);
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
        assert_eq!(rig.outputs, [(1, 0), (1, 5)], "{at}");
        assert_eq!((rig.model.x, rig.model.carry, rig.model.link), (1, true, 5));
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
    assert_eq!((rig.a(), rig.model.x, rig.model.link), (0, 0, 0));
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

    /// Any word, but rarely one that starts again; often a RAM word that others use too.
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
fn check(seed: u64, cycles: u64) -> Result<(), String> {
    let mut random = Random(seed);
    let program: Vec<u32> = (0..PROGRAM_WORDS).map(|_| random.instruction()).collect();
    let mut rig = Rig::new(&program);
    let mut quiet = 0;
    for _ in 0..cycles {
        if quiet == 0 && random.below(3) == 0 {
            let all = if random.below(2) == 0 { 4 } else { 128 };
            let address = random.below(all) as usize;
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
    for address in 0..128 {
        for _ in 0..8 {
            rig.step()?;
        }
        rig.check_host_word()?;
        rig.read(address);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, max_shrink_iters: 0, ..ProptestConfig::default() })]

    #[test]
    fn random_programs_do_what_the_model_does(seed: u64) {
        check(seed, 3000).map_err(TestCaseError::fail)?;
    }
}
