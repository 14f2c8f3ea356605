//! Expressions of one segment as a graph: every node is computed once, whatever reads it.

use crate::elaborate::mask;
use std::collections::HashMap;

/// Index of a node in its [`Graph`].
pub type NodeId = usize;

/// Operation of a node. Operands have the width of the result unless stated otherwise; bits above the width are 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// A number.
    Constant(u128),
    /// A net that another segment, a register or the bench drives.
    Net(usize),
    /// Complement.
    Not(NodeId),
    /// Bitwise.
    And(NodeId, NodeId),
    /// Bitwise.
    Or(NodeId, NodeId),
    /// Bitwise.
    Xor(NodeId, NodeId),
    /// Sum, wrapping.
    Add(NodeId, NodeId),
    /// Difference, wrapping.
    Sub(NodeId, NodeId),
    /// Product, wrapping.
    Mul(NodeId, NodeId),
    /// Shift to the left; the amount has any width, and at the width of the result everything is shifted out.
    Shl(NodeId, NodeId),
    /// Shift to the right, likewise; the first operand may be wider than the result.
    Shr(NodeId, NodeId),
    /// 1 if two operands of one width are equal.
    Eq(NodeId, NodeId),
    /// 1 if less, unsigned; two operands of one width.
    Lt(NodeId, NodeId),
    /// Parity of an operand of any width.
    Parity(NodeId),
    /// `.1` if `.0`, of one bit, is 1; else `.2`.
    Mux(NodeId, NodeId, NodeId),
    /// Zero-extension of a narrower operand.
    Extend(NodeId),
}

impl Op {
    /// The nodes that it reads.
    pub fn operands(&self) -> impl Iterator<Item = NodeId> {
        let (a, b, c) = match *self {
            Op::Constant(_) | Op::Net(_) => (None, None, None),
            Op::Not(a) | Op::Parity(a) | Op::Extend(a) => (Some(a), None, None),
            Op::And(a, b)
            | Op::Or(a, b)
            | Op::Xor(a, b)
            | Op::Add(a, b)
            | Op::Sub(a, b)
            | Op::Mul(a, b)
            | Op::Shl(a, b)
            | Op::Shr(a, b)
            | Op::Eq(a, b)
            | Op::Lt(a, b) => (Some(a), Some(b), None),
            Op::Mux(a, b, c) => (Some(a), Some(b), Some(c)),
        };
        [a, b, c].into_iter().flatten()
    }

    /// The same on other nodes.
    pub fn moved(self, to: impl Fn(NodeId) -> NodeId) -> Self {
        match self {
            Op::Constant(_) | Op::Net(_) => self,
            Op::Not(a) => Op::Not(to(a)),
            Op::Parity(a) => Op::Parity(to(a)),
            Op::Extend(a) => Op::Extend(to(a)),
            Op::And(a, b) => Op::And(to(a), to(b)),
            Op::Or(a, b) => Op::Or(to(a), to(b)),
            Op::Xor(a, b) => Op::Xor(to(a), to(b)),
            Op::Add(a, b) => Op::Add(to(a), to(b)),
            Op::Sub(a, b) => Op::Sub(to(a), to(b)),
            Op::Mul(a, b) => Op::Mul(to(a), to(b)),
            Op::Shl(a, b) => Op::Shl(to(a), to(b)),
            Op::Shr(a, b) => Op::Shr(to(a), to(b)),
            Op::Eq(a, b) => Op::Eq(to(a), to(b)),
            Op::Lt(a, b) => Op::Lt(to(a), to(b)),
            Op::Mux(a, b, c) => Op::Mux(to(a), to(b), to(c)),
        }
    }
}

/// A node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Node {
    /// Operation.
    pub op: Op,
    /// Width of the result in bits.
    pub width_bits: usize,
}

/// Nodes in an order in which each reads only earlier ones.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// The nodes.
    pub nodes: Vec<Node>,
    found: HashMap<Node, NodeId>,
}

impl Graph {
    /// A number.
    pub fn constant(&mut self, value: u128, width_bits: usize) -> NodeId {
        self.insert(Op::Constant(value & mask(width_bits)), width_bits)
    }

    /// The number that a node is, if it is one.
    pub fn as_constant(&self, node: NodeId) -> Option<u128> {
        match self.nodes[node].op {
            Op::Constant(value) => Some(value),
            _ => None,
        }
    }

    /// Width of a node.
    pub fn width_bits(&self, node: NodeId) -> usize {
        self.nodes[node].width_bits
    }

    /// A node that computes `op`, or a simpler one that gives the same.
    pub fn add(&mut self, op: Op, width_bits: usize) -> NodeId {
        let constants: Vec<u128> = op.operands().map_while(|n| self.as_constant(n)).collect();
        let count = op.operands().count();
        if count > 0 && constants.len() == count {
            let value = evaluate(&op, &constants, |n| self.width_bits(n));
            return self.constant(value, width_bits);
        }
        match self.simpler(&op, width_bits) {
            Some(node) => node,
            None => self.insert(op, width_bits),
        }
    }

    fn insert(&mut self, op: Op, width_bits: usize) -> NodeId {
        let node = Node { op, width_bits };
        let next = self.nodes.len();
        let id = *self.found.entry(node).or_insert(next);
        if id == next {
            self.nodes.push(node);
        }
        id
    }

    /// Simplification that does not depend on the values.
    fn simpler(&mut self, op: &Op, width_bits: usize) -> Option<NodeId> {
        let ones = mask(width_bits);
        let same = |a: NodeId, b: NodeId| a == b;
        match *op {
            Op::Not(a) => match self.nodes[a].op {
                Op::Not(inner) => Some(inner),
                _ => None,
            },
            Op::And(a, b) | Op::Or(a, b) | Op::Xor(a, b) => {
                if let (Some(_), None) = (self.as_constant(a), self.as_constant(b)) {
                    // Numbers are the right operand.
                    return Some(self.add(commuted(op), width_bits));
                }
                let number = self.as_constant(b);
                match (op, number) {
                    (Op::And(..) | Op::Or(..), None) if same(a, b) => Some(a),
                    (Op::Xor(..), None) if same(a, b) => Some(self.constant(0, width_bits)),
                    (Op::And(..), Some(0)) => Some(b),
                    (Op::And(..), Some(n)) if n == ones => Some(a),
                    (Op::Or(..) | Op::Xor(..), Some(0)) => Some(a),
                    (Op::Or(..), Some(n)) if n == ones => Some(b),
                    (Op::Xor(..), Some(n)) if n == ones => Some(self.add(Op::Not(a), width_bits)),
                    _ => None,
                }
            }
            Op::Add(a, b) | Op::Sub(a, b) | Op::Shl(a, b) => {
                (self.as_constant(b) == Some(0)).then_some(a)
            }
            Op::Shr(a, b) => {
                (self.as_constant(b) == Some(0) && self.width_bits(a) == width_bits).then_some(a)
            }
            Op::Eq(a, b) => {
                if same(a, b) {
                    return Some(self.constant(1, 1));
                }
                match (self.width_bits(a), self.as_constant(a), self.as_constant(b)) {
                    (_, Some(_), None) => Some(self.add(Op::Eq(b, a), 1)),
                    (1, _, Some(1)) => Some(a),
                    (1, _, Some(_)) => Some(self.add(Op::Not(a), 1)),
                    _ => None,
                }
            }
            Op::Lt(a, b) if same(a, b) => Some(self.constant(0, 1)),
            Op::Mux(c, a, b) => {
                if let Op::Not(inner) = self.nodes[c].op {
                    return Some(self.add(Op::Mux(inner, b, a), width_bits));
                }
                let numbers = (self.as_constant(a), self.as_constant(b));
                match (self.as_constant(c), width_bits, numbers) {
                    (Some(0), ..) => Some(b),
                    (Some(_), ..) => Some(a),
                    _ if same(a, b) => Some(a),
                    (None, 1, (Some(1), _)) => Some(self.add(Op::Or(c, b), 1)),
                    (None, 1, (_, Some(0))) => Some(self.add(Op::And(c, a), 1)),
                    (None, 1, (Some(0), _)) => {
                        let not = self.add(Op::Not(c), 1);
                        Some(self.add(Op::And(not, b), 1))
                    }
                    (None, 1, (_, Some(1))) => {
                        let not = self.add(Op::Not(c), 1);
                        Some(self.add(Op::Or(not, a), 1))
                    }
                    _ => None,
                }
            }
            Op::Extend(a) => (self.width_bits(a) == width_bits).then_some(a),
            _ => None,
        }
    }
}

fn commuted(op: &Op) -> Op {
    match *op {
        Op::And(a, b) => Op::And(b, a),
        Op::Or(a, b) => Op::Or(b, a),
        Op::Xor(a, b) => Op::Xor(b, a),
        other => other,
    }
}

/// Result of an operator for numbers, before it is cut to its width; `width_of` returns the width of its operands.
pub fn evaluate(op: &Op, v: &[u128], width_of: impl Fn(NodeId) -> usize) -> u128 {
    let shift = |a: u128, by: u128, f: fn(u128, u32) -> Option<u128>| {
        let by = u32::try_from(by).ok();
        by.and_then(|n| f(a, n)).unwrap_or(0)
    };
    match *op {
        Op::Constant(value) => value,
        Op::Net(_) => unreachable!("a net is not computed"),
        Op::Not(a) => !v[0] & mask(width_of(a)),
        Op::And(..) => v[0] & v[1],
        Op::Or(..) => v[0] | v[1],
        Op::Xor(..) => v[0] ^ v[1],
        Op::Add(..) => v[0].wrapping_add(v[1]),
        Op::Sub(..) => v[0].wrapping_sub(v[1]),
        Op::Mul(..) => v[0].wrapping_mul(v[1]),
        Op::Shl(..) => shift(v[0], v[1], u128::checked_shl),
        Op::Shr(..) => shift(v[0], v[1], u128::checked_shr),
        Op::Eq(..) => (v[0] == v[1]).into(),
        Op::Lt(..) => (v[0] < v[1]).into(),
        Op::Parity(_) => (v[0].count_ones() & 1).into(),
        Op::Mux(..) => {
            if v[0] != 0 {
                v[1]
            } else {
                v[2]
            }
        }
        Op::Extend(_) => v[0],
    }
}
