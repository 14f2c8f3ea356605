//! Reference model of the machine in plain Rust, instruction by instruction; tests compare the block with it.

use super::{PROGRAM_WORDS, RAM_WORDS};

/// State visible to a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Model {
    pub program: Vec<u32>,
    pub ram: [u16; RAM_WORDS],
    pub counter: u16,
    pub link: u16,
    pub a: u16,
    pub x: u8,
    pub carry: bool,
}

impl Model {
    pub fn new(program: &[u32]) -> Self {
        let mut program = program.to_vec();
        program.resize(PROGRAM_WORDS, 0xd0000);
        Self {
            program,
            ram: [0; RAM_WORDS],
            counter: 0,
            link: 0,
            a: 0,
            x: 0,
            carry: false,
        }
    }

    pub fn reset(&mut self) {
        *self = Self {
            ram: self.ram,
            ..Self::new(&self.program)
        };
    }

    pub fn instruction(&self) -> u32 {
        self.program[usize::from(self.counter)]
    }

    fn imm(&self) -> u16 {
        self.instruction() as u16
    }

    fn flag(&self, bit: u32) -> bool {
        self.instruction() >> bit & 1 == 1
    }

    /// RAM word of the instruction, if it has one.
    pub fn address(&self) -> usize {
        let x = if self.flag(8) { self.x } else { 0 };
        usize::from((self.imm() as u8).wrapping_add(x))
    }

    pub fn port(&self) -> u8 {
        self.imm() as u8 % 32
    }

    /// Executes one instruction, with the word `m` from RAM and `input` at the port. Returns the written port and its value.
    pub fn step(&mut self, m: u16, input: u16) -> Option<(u8, u16)> {
        let next = (self.counter + 1) % PROGRAM_WORDS as u16;
        let target = self.imm() % PROGRAM_WORDS as u16;
        let (imm, port, address) = (self.imm(), self.port(), self.address());
        let carry = u16::from(self.flag(9) && self.carry);
        let mut to = next;
        match self.instruction() >> 16 {
            0 => self.a = imm,
            1 => self.a = m,
            2 => self.ram[address] = self.a,
            3 => {
                let sum = u32::from(self.a) + u32::from(m) + u32::from(carry);
                (self.a, self.carry) = (sum as u16, sum > 0xffff);
            }
            4 => {
                let difference = i32::from(self.a) - i32::from(m) - i32::from(carry);
                (self.a, self.carry) = (difference as u16, difference < 0);
            }
            8 => (self.a, self.carry) = self.a.overflowing_add(imm),
            9 => self.a &= imm,
            10 => self.a ^= imm,
            11 => self.a = input,
            12 => {
                self.counter = next;
                return Some((port, self.a));
            }
            13 => {
                let is_taken = match imm >> 13 {
                    0 => true,
                    1 => self.a == 0,
                    2 => self.a != 0,
                    3 => self.carry,
                    4 => !self.carry,
                    5 => self.a >= 0x8000,
                    _ => false,
                };
                if is_taken {
                    to = target;
                }
            }
            14 => (self.link, to) = (next, target),
            15 => match imm % 16 {
                0 => to = self.link,
                1 => self.x = self.a as u8,
                2 => self.a = self.link,
                3 => to = self.a % PROGRAM_WORDS as u16,
                4 => (self.a, self.carry) = (self.a / 2, self.a % 2 == 1),
                5 => self.a = self.a.swap_bytes(),
                _ => to = 0,
            },
            _ => to = 0,
        }
        self.counter = to;
        None
    }
}
