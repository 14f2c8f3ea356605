//! A segment as single bits: every operator becomes and, or, exclusive or, and choices between two bits.

use crate::engine::form::{Node, NodeId, Op, Segment};
use std::collections::HashMap;

/// Index of a bit in its [`BitSegment`].
pub(super) type Bit = usize;

/// How a bit is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Gate {
    /// A number.
    Constant(bool),
    /// Bit `.1` of a net.
    Net(usize, usize),
    Not(Bit),
    And(Bit, Bit),
    Or(Bit, Bit),
    Xor(Bit, Bit),
    /// `.1` if `.0` is 1, else `.2`.
    Mux(Bit, Bit, Bit),
}

/// Always the first two bits.
const ZERO: Bit = 0;
const ONE: Bit = 1;

/// A segment, bit by bit.
#[derive(Clone, Debug)]
pub(super) struct BitSegment {
    /// In an order in which each reads only earlier ones.
    pub gates: Vec<Gate>,
    /// Bits of the nets that are driven: net, number of the bit, and the gate.
    pub writes: Vec<(usize, usize, Bit)>,
    found: HashMap<Gate, Bit>,
}

impl BitSegment {
    /// Takes a segment apart.
    pub fn new(segment: &Segment) -> Self {
        let mut bits = Self {
            gates: vec![],
            writes: vec![],
            found: HashMap::new(),
        };
        bits.insert(Gate::Constant(false));
        bits.insert(Gate::Constant(true));
        let mut words: Vec<Vec<Bit>> = vec![];
        for node in &segment.nodes {
            let word = bits.node(&segment.nodes, &words, node);
            debug_assert_eq!(word.len(), node.width_bits);
            words.push(word);
        }
        for (net, node) in &segment.writes {
            let driven = words[*node].iter().enumerate();
            bits.writes
                .extend(driven.map(|(number, bit)| (*net, number, *bit)));
        }
        bits.drop_unused();
        bits
    }

    /// Removes gates that simplification has left without readers.
    fn drop_unused(&mut self) {
        let mut is_used = vec![false; self.gates.len()];
        for (_, _, bit) in &self.writes {
            is_used[*bit] = true;
        }
        for index in (0..self.gates.len()).rev() {
            if is_used[index] {
                for operand in operands(&self.gates[index]) {
                    is_used[operand] = true;
                }
            }
        }
        let mut place = vec![0; self.gates.len()];
        let mut gates = vec![];
        for (index, gate) in self.gates.iter().enumerate() {
            if is_used[index] {
                place[index] = gates.len();
                gates.push(match *gate {
                    Gate::Constant(_) | Gate::Net(..) => *gate,
                    Gate::Not(a) => Gate::Not(place[a]),
                    Gate::And(a, b) => Gate::And(place[a], place[b]),
                    Gate::Or(a, b) => Gate::Or(place[a], place[b]),
                    Gate::Xor(a, b) => Gate::Xor(place[a], place[b]),
                    Gate::Mux(c, a, b) => Gate::Mux(place[c], place[a], place[b]),
                });
            }
        }
        self.gates = gates;
        self.found.clear();
        for (_, _, bit) in &mut self.writes {
            *bit = place[*bit];
        }
    }

    fn insert(&mut self, gate: Gate) -> Bit {
        let next = self.gates.len();
        let bit = *self.found.entry(gate).or_insert(next);
        if bit == next {
            self.gates.push(gate);
        }
        bit
    }

    fn not(&mut self, a: Bit) -> Bit {
        match self.gates[a] {
            Gate::Constant(value) => Bit::from(!value),
            Gate::Not(inner) => inner,
            _ => self.insert(Gate::Not(a)),
        }
    }

    fn are_opposite(&self, a: Bit, b: Bit) -> bool {
        self.gates[a] == Gate::Not(b) || self.gates[b] == Gate::Not(a)
    }

    fn and(&mut self, a: Bit, b: Bit) -> Bit {
        match (a.min(b), a.max(b)) {
            (ZERO, _) => ZERO,
            (ONE, other) => other,
            (a, b) if a == b => a,
            (a, b) if self.are_opposite(a, b) => ZERO,
            (a, b) => self.insert(Gate::And(a, b)),
        }
    }

    fn or(&mut self, a: Bit, b: Bit) -> Bit {
        match (a.min(b), a.max(b)) {
            (ZERO, other) => other,
            (ONE, _) => ONE,
            (a, b) if a == b => a,
            (a, b) if self.are_opposite(a, b) => ONE,
            (a, b) => self.insert(Gate::Or(a, b)),
        }
    }

    fn xor(&mut self, a: Bit, b: Bit) -> Bit {
        match (a.min(b), a.max(b)) {
            (ZERO, other) => other,
            (ONE, other) => self.not(other),
            (a, b) if a == b => ZERO,
            (a, b) if self.are_opposite(a, b) => ONE,
            (a, b) => self.insert(Gate::Xor(a, b)),
        }
    }

    fn mux(&mut self, c: Bit, a: Bit, b: Bit) -> Bit {
        match (self.gates[c], a, b) {
            (Gate::Constant(true), ..) => a,
            (Gate::Constant(false), ..) => b,
            (Gate::Not(inner), ..) => self.mux(inner, b, a),
            _ if a == b => a,
            (_, ONE, _) => self.or(c, b),
            (_, _, ZERO) => self.and(c, a),
            (_, ZERO, _) => {
                let not = self.not(c);
                self.and(not, b)
            }
            (_, _, ONE) => {
                let not = self.not(c);
                self.or(not, a)
            }
            _ if self.are_opposite(a, b) => self.xor(c, b),
            _ => self.insert(Gate::Mux(c, a, b)),
        }
    }

    /// Sum of two words and a carry; the carry out comes last.
    fn sum(&mut self, a: &[Bit], b: &[Bit], mut carry: Bit) -> Vec<Bit> {
        let mut sum = vec![];
        for (a, b) in a.iter().zip(b) {
            let difference = self.xor(*a, *b);
            sum.push(self.xor(difference, carry));
            carry = self.mux(difference, carry, *a);
        }
        sum.push(carry);
        sum
    }

    fn complement(&mut self, a: &[Bit]) -> Vec<Bit> {
        a.iter().map(|bit| self.not(*bit)).collect()
    }

    /// AND of the bits, as a tree.
    fn all(&mut self, mut bits: Vec<Bit>) -> Bit {
        while bits.len() > 1 {
            bits = bits
                .chunks(2)
                .map(|pair| match pair {
                    [a, b] => self.and(*a, *b),
                    rest => rest[0],
                })
                .collect();
        }
        bits.first().copied().unwrap_or(ONE)
    }

    fn shifted(&self, a: &[Bit], by: usize, is_left: bool) -> Vec<Bit> {
        (0..a.len())
            .map(|i| {
                let from = if is_left {
                    i.checked_sub(by)
                } else {
                    i.checked_add(by)
                };
                from.and_then(|from| a.get(from).copied()).unwrap_or(ZERO)
            })
            .collect()
    }

    fn shift(&mut self, a: &[Bit], by: &[Bit], is_left: bool) -> Vec<Bit> {
        let mut word = a.to_vec();
        for (stage, bit) in by.iter().enumerate() {
            let distance = u32::try_from(stage)
                .ok()
                .and_then(|s| 1usize.checked_shl(s));
            let moved = match distance {
                Some(distance) if distance < a.len() => self.shifted(&word, distance, is_left),
                _ => vec![ZERO; a.len()],
            };
            word = self.choose(*bit, &moved, &word);
        }
        word
    }

    fn choose(&mut self, c: Bit, a: &[Bit], b: &[Bit]) -> Vec<Bit> {
        a.iter().zip(b).map(|(a, b)| self.mux(c, *a, *b)).collect()
    }

    fn each(&mut self, a: &[Bit], b: &[Bit], gate: fn(&mut Self, Bit, Bit) -> Bit) -> Vec<Bit> {
        a.iter().zip(b).map(|(a, b)| gate(self, *a, *b)).collect()
    }

    fn node(&mut self, nodes: &[Node], words: &[Vec<Bit>], node: &Node) -> Vec<Bit> {
        let width = node.width_bits;
        let word = |n: NodeId| &words[n][..];
        let mut result = match node.op {
            Op::Constant(value) => (0..width).map(|i| Bit::from(value >> i & 1 == 1)).collect(),
            Op::Net(net) => (0..width).map(|i| self.insert(Gate::Net(net, i))).collect(),
            Op::Not(a) => self.complement(word(a)),
            Op::And(a, b) => self.each(word(a), word(b), Self::and),
            Op::Or(a, b) => self.each(word(a), word(b), Self::or),
            Op::Xor(a, b) => self.each(word(a), word(b), Self::xor),
            Op::Add(a, b) => self.sum(word(a), word(b), ZERO),
            Op::Sub(a, b) => {
                let b = self.complement(word(b));
                self.sum(word(a), &b, ONE)
            }
            Op::Mul(a, b) => {
                let mut sum = vec![ZERO; width];
                for (place, bit) in word(b).iter().enumerate() {
                    let part = self.shifted(word(a), place, true);
                    let part: Vec<Bit> = part.iter().map(|p| self.and(*p, *bit)).collect();
                    sum = self.sum(&sum, &part, ZERO);
                    sum.truncate(width);
                }
                sum
            }
            Op::Shl(a, b) => self.shift(word(a), word(b), true),
            Op::Shr(a, b) => self.shift(word(a), word(b), false),
            Op::Eq(a, b) => {
                let differ = self.each(word(a), word(b), Self::xor);
                let equal = self.complement(&differ);
                vec![self.all(equal)]
            }
            Op::Lt(a, b) => {
                let b = self.complement(word(b));
                // a - b borrows if and only if a is less.
                let carry = self.sum(word(a), &b, ONE)[nodes[a].width_bits];
                vec![self.not(carry)]
            }
            Op::Parity(a) => {
                let mut odd = ZERO;
                for bit in word(a) {
                    odd = self.xor(odd, *bit);
                }
                vec![odd]
            }
            Op::Mux(c, a, b) => self.choose(words[c][0], word(a), word(b)),
            Op::Extend(a) => {
                let mut word = word(a).to_vec();
                word.resize(width, ZERO);
                word
            }
        };
        result.truncate(width);
        result
    }
}

/// The bits that a gate reads.
pub(super) fn operands(gate: &Gate) -> impl Iterator<Item = Bit> {
    let (a, b, c) = match *gate {
        Gate::Constant(_) | Gate::Net(..) => (None, None, None),
        Gate::Not(a) => (Some(a), None, None),
        Gate::And(a, b) | Gate::Or(a, b) | Gate::Xor(a, b) => (Some(a), Some(b), None),
        Gate::Mux(a, b, c) => (Some(a), Some(b), Some(c)),
    };
    [a, b, c].into_iter().flatten()
}
