//! What a block alone is given: every input goes on in some way for a while, then in another one.

use endat_sim::rng::Rng;
use rtl_design::elaborate::mask;
use std::ops::RangeInclusive;

/// Cycles of a block.
pub const CYCLES: usize = 1_000_000;
/// How long an input goes on in the same way, in cycles, as a power of two.
const WAY_LOG: RangeInclusive<u64> = 5..=14;
/// How long some inputs rest while others go on, or all go on, likewise.
const CALM_LOG: RangeInclusive<u64> = 6..=14;
/// In a calm one input of so many goes on.
const AWAKE_OF: u64 = 3;
/// Mean cycles between two resets behind the first one, likewise.
const RESET_LOG: RangeInclusive<u64> = 4..=17;
/// About so many follow each other in the same way.
const RESETS: u64 = 4;
/// Cycles of the first reset.
const RESET_CYCLES: usize = 3;
/// An input changes once in so many cycles.
const HOLD_CYCLES: [u64; 8] = [1, 2, 4, 8, 16, 50, 200, 100_000];
/// So often, and less often, a microsecond ends.
const TICK_CYCLES: [u64; 5] = [1, 1, 2, 8, 200];
/// Values that an input had before, of which one comes back.
const REMEMBERED: usize = 4;

/// An input, and its bits.
pub struct Input {
    /// Its name.
    pub name: String,
    /// Bits.
    pub width_bits: usize,
}

/// What a block compares something with: a field, and a value of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Compared {
    /// Lowest bit of the field.
    pub low_bit: usize,
    /// Bits.
    pub width_bits: usize,
    /// The value.
    pub value: u128,
}

/// What a block knows.
#[derive(Clone, Debug, Default)]
pub struct Known {
    /// What it compares something with.
    pub compared: Vec<Compared>,
    /// How long something may take it, in cycles.
    pub beats: Vec<u64>,
}

/// About so much: anything between two powers of two, each pair as likely as another.
fn about(rng: &mut Rng, log: &RangeInclusive<u64>) -> u64 {
    let least = 1 << rng.in_range(*log.start(), *log.end());
    rng.in_range(least, 2 * least)
}

fn one_in(rng: &mut Rng, of: u64) -> bool {
    rng.in_range(1, of) == 1
}

fn any<T: Copy>(rng: &mut Rng, of: &[T]) -> T {
    of[rng.in_range(0, of.len() as u64 - 1) as usize]
}

/// How an input goes on for a while.
struct Way {
    cycles: u64,
    /// It changes once in so many cycles.
    hold_cycles: u64,
    /// Always after so many.
    is_even: bool,
    /// Highest bit of what it takes.
    bits: usize,
    /// Back to 0 in the next cycle.
    is_strobe: bool,
    counts: bool,
}

impl Way {
    fn new(rng: &mut Rng, known: &Known, width_bits: usize) -> Self {
        let is_even = one_in(rng, 4);
        Self {
            cycles: about(rng, &WAY_LOG),
            hold_cycles: match is_even && !known.beats.is_empty() {
                true => any(rng, &known.beats),
                false => any(rng, &HOLD_CYCLES),
            },
            is_even,
            // Half of them are small: what is counted down ends.
            bits: match one_in(rng, 2) {
                true => width_bits,
                false => rng.in_range(1, width_bits as u64) as usize,
            },
            is_strobe: one_in(rng, 3),
            counts: one_in(rng, 6),
        }
    }

    fn of_reset(rng: &mut Rng) -> Self {
        let hold_cycles = about(rng, &RESET_LOG);
        Self {
            cycles: RESETS * hold_cycles,
            ..Self::strobe(hold_cycles)
        }
    }

    fn of_tick(rng: &mut Rng) -> Self {
        Self {
            cycles: about(rng, &WAY_LOG),
            ..Self::strobe(any(rng, &TICK_CYCLES))
        }
    }

    fn strobe(hold_cycles: u64) -> Self {
        Self {
            cycles: 1,
            hold_cycles,
            is_even: false,
            bits: 1,
            is_strobe: true,
            counts: false,
        }
    }
}

/// What an input is for, as far as it matters here.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Role {
    Reset,
    /// A microsecond, which is a few cycles long: what a block waits for comes.
    Tick,
    Other,
}

impl Role {
    fn of(name: &str) -> Self {
        match name {
            "reset" | "rst_i" => Self::Reset,
            "tick_us" => Self::Tick,
            _ => Self::Other,
        }
    }
}

/// An input while it is played.
struct Played {
    width_bits: usize,
    role: Role,
    way: Way,
    now: u128,
    before: [u128; REMEMBERED],
}

impl Played {
    fn new(rng: &mut Rng, known: &Known, input: &Input) -> Self {
        let role = Role::of(&input.name);
        Self {
            width_bits: input.width_bits,
            way: Self::way(rng, known, role, input.width_bits),
            role,
            now: 0,
            before: [0; REMEMBERED],
        }
    }

    fn way(rng: &mut Rng, known: &Known, role: Role, width_bits: usize) -> Way {
        match role {
            Role::Reset => Way::of_reset(rng),
            Role::Tick => Way::of_tick(rng),
            Role::Other => Way::new(rng, known, width_bits),
        }
    }

    fn step(&mut self, rng: &mut Rng, known: &Known) {
        self.way.cycles -= 1;
        if self.way.cycles == 0 {
            self.way = Self::way(rng, known, self.role, self.width_bits);
        }
        let changes = match self.way.is_even {
            true => self.way.cycles.is_multiple_of(self.way.hold_cycles),
            false => one_in(rng, self.way.hold_cycles),
        };
        let is_bit = self.width_bits == 1;
        self.now = match changes {
            false if is_bit && self.way.is_strobe => 0,
            false if self.way.counts => self.now.wrapping_add(1) & mask(self.width_bits),
            false => self.now,
            true if is_bit && self.way.is_strobe => 1,
            true if is_bit => u128::from(one_in(rng, 2)),
            true => {
                let value = self.value(rng, known);
                self.before[rng.in_range(0, REMEMBERED as u64 - 1) as usize] = value;
                value
            }
        };
    }

    /// A bit that is another one; everything; nothing; what is near; what was; what the block knows; anything.
    fn value(&self, rng: &mut Rng, known: &Known) -> u128 {
        let all = mask(self.width_bits);
        let random = u128::from(rng.next_u64()) << 64 | u128::from(rng.next_u64());
        match rng.in_range(0, 11) {
            0 => self.now ^ (1 << rng.in_range(0, self.width_bits as u64 - 1)),
            1 => all,
            2 => 0,
            3 => self.now.wrapping_add(1) & all,
            4 => self.now.wrapping_sub(1) & all,
            5 => any(rng, &self.before),
            6..=8 if !known.compared.is_empty() => {
                let field = any(rng, &known.compared);
                let bits = mask(field.width_bits) << field.low_bit;
                // Around the field something, or what was there.
                let around = any(rng, &[0, self.now, random]);
                (around & !bits | field.value << field.low_bit) & all
            }
            _ => random & mask(self.way.bits),
        }
    }
}

/// The rows of a block: what it is given in each cycle, an input for each column.
pub struct Rows {
    rng: Rng,
    known: Known,
    inputs: Vec<Played>,
    /// Cycles until others rest.
    calm_cycles: u64,
    /// Which do not.
    awake: Vec<bool>,
    cycle: usize,
}

impl Rows {
    /// Of a block with these inputs, and what it knows of their width; a seed always gives the same ones.
    pub fn new(inputs: &[Input], known: Known, seed: u64) -> Self {
        let mut rng = Rng::new(seed);
        let played = |input: &Input| Played::new(&mut rng, &known, input);
        Self {
            inputs: inputs.iter().map(played).collect(),
            rng,
            known,
            calm_cycles: 1,
            awake: vec![],
            cycle: 0,
        }
    }

    fn rest(&mut self) {
        self.calm_cycles -= 1;
        if self.calm_cycles > 0 {
            return;
        }
        let rng = &mut self.rng;
        self.calm_cycles = about(rng, &CALM_LOG);
        let is_calm = one_in(rng, 2);
        let awake = |i: &Played| i.role == Role::Tick || !is_calm || one_in(rng, AWAKE_OF);
        self.awake = self.inputs.iter().map(awake).collect();
    }
}

impl Iterator for Rows {
    type Item = Vec<u128>;

    fn next(&mut self) -> Option<Vec<u128>> {
        if self.cycle == CYCLES {
            return None;
        }
        self.rest();
        let is_start = self.cycle < RESET_CYCLES;
        self.cycle += 1;
        for (input, is_awake) in self.inputs.iter_mut().zip(&self.awake) {
            if *is_awake {
                input.step(&mut self.rng, &self.known);
            } else if input.way.is_strobe && input.width_bits == 1 {
                input.now = 0;
            }
        }
        let now = |i: &Played| {
            if is_start && i.role == Role::Reset {
                1
            } else {
                i.now
            }
        };
        Some(self.inputs.iter().map(now).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: Compared = Compared {
        low_bit: 4,
        width_bits: 28,
        value: 0x00AB_CDEF,
    };

    fn rows() -> Vec<Vec<u128>> {
        let input = |name: &str, width_bits| Input {
            name: name.into(),
            width_bits,
        };
        let inputs = [input("reset", 1), input("tick_us", 1), input("word", 32)];
        let known = Known {
            compared: vec![KNOWN],
            beats: vec![33],
        };
        Rows::new(&inputs, known, 1).take(100_000).collect()
    }

    #[test]
    fn a_seed_gives_the_same_rows_again() {
        assert!(rows() == rows());
    }

    /// By chance a field of 28 bits has a value once in many millions of rows.
    #[test]
    fn what_a_block_compares_with_comes_in_its_field() {
        let is_known = |row: &&Vec<u128>| row[2] >> KNOWN.low_bit == KNOWN.value;
        assert!(rows().iter().filter(is_known).count() > 100);
    }

    /// What a block does after a long time is seen only where time passes, and nothing begins anew.
    #[test]
    fn time_passes_between_two_resets() {
        let rows = rows();
        let stretches = rows.split(|row| row[0] == 1);
        let ticks = stretches.map(|rows| rows.iter().filter(|row| row[1] == 1).count());
        assert!(ticks.max() > Some(10_000));
        assert!(rows[..RESET_CYCLES].iter().all(|row| row[0] == 1));
    }
}
