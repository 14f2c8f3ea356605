//! Statements become graphs: each target of a process gets one expression, branches become multiplexers.

use super::graph::{Graph, NodeId, Op};
use crate::elaborate::{mask, BinaryOp, Expr, ExprKind, Statement, UnaryOp};
use crate::engine::flat::{Flat, FlatProcess};
use std::collections::BTreeMap;

/// Kind of a net.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Known {
    /// Something that changes.
    Net(usize),
    /// Always the same number.
    Constant(u128),
}

/// The graph of a process, and the node of each net that it drives.
pub(super) type Built = (Graph, BTreeMap<usize, NodeId>);

/// Builds the graph of one process; `known` says what the nets of earlier ones are.
pub(super) fn process(flat: &Flat, process: &FlatProcess, known: &[Known]) -> Built {
    let mut builder = Builder {
        flat,
        known,
        parameters: &process.parameters,
        graph: Graph::default(),
        values: BTreeMap::new(),
    };
    for net in process.targets() {
        let zero = builder.graph.constant(0, flat.nets[net].width_bits);
        builder.values.insert(net, zero);
    }
    builder.block(&process.statements);
    (builder.graph, builder.values)
}

struct Builder<'a> {
    flat: &'a Flat,
    known: &'a [Known],
    parameters: &'a [u128],
    graph: Graph,
    values: BTreeMap<usize, NodeId>,
}

impl Builder<'_> {
    fn block(&mut self, statements: &[Statement]) {
        for statement in statements {
            self.statement(statement);
        }
    }

    /// Values of the nets after a block, without changing anything else.
    fn branch(&mut self, statements: &[Statement]) -> BTreeMap<usize, NodeId> {
        let before = self.values.clone();
        self.block(statements);
        std::mem::replace(&mut self.values, before)
    }

    fn statement(&mut self, statement: &Statement) {
        match statement {
            Statement::Assign {
                net,
                low_bit,
                value,
                ..
            } => {
                let (net, width) = (*net, self.flat.nets[*net].width_bits);
                let node = self.expr(value);
                let node = if value.width_bits == width {
                    node
                } else {
                    self.inserted(self.values[&net], node, *low_bit, width)
                };
                self.values.insert(net, node);
            }
            Statement::If {
                condition,
                then,
                otherwise,
                ..
            } => {
                let condition = self.expr(condition);
                let then = self.branch(then);
                self.block(otherwise);
                self.merge(condition, &then);
            }
            Statement::Case {
                subject,
                arms,
                default,
                ..
            } => {
                let subject = self.expr(subject);
                let arms: Vec<_> = arms
                    .iter()
                    .map(|(value, block)| {
                        let value = self.expr(value);
                        (
                            self.graph.add(Op::Eq(subject, value), 1),
                            self.branch(block),
                        )
                    })
                    .collect();
                self.block(default);
                // The first arm that fits is the last to decide.
                for (condition, values) in arms.iter().rev() {
                    self.merge(*condition, values);
                }
            }
        }
    }

    /// The nets take the values of a branch where its condition holds.
    fn merge(&mut self, condition: NodeId, branch: &BTreeMap<usize, NodeId>) {
        for (net, value) in &mut self.values {
            let then = branch[net];
            if then != *value {
                let width = self.flat.nets[*net].width_bits;
                *value = self.graph.add(Op::Mux(condition, then, *value), width);
            }
        }
    }

    /// `base` with the bits from `low_bit` on replaced.
    fn inserted(&mut self, base: NodeId, part: NodeId, low_bit: usize, width: usize) -> NodeId {
        let bits = mask(self.graph.width_bits(part)) << low_bit;
        let keep = self.graph.constant(!bits, width);
        let rest = self.graph.add(Op::And(base, keep), width);
        let part = self.graph.add(Op::Extend(part), width);
        let by = self.graph.constant(low_bit as u128, 8);
        let part = self.graph.add(Op::Shl(part, by), width);
        self.graph.add(Op::Or(rest, part), width)
    }

    fn expr(&mut self, expr: &Expr) -> NodeId {
        let width = expr.width_bits;
        match &expr.kind {
            ExprKind::Constant(value) => self.graph.constant(*value, width),
            ExprKind::Variant(_, index) => self.graph.constant(*index as u128, width),
            ExprKind::Parameter(index) => self.graph.constant(self.parameters[*index], width),
            ExprKind::Net(net) => match (self.values.get(net), self.known[*net]) {
                (Some(value), _) => *value,
                (None, Known::Constant(value)) => self.graph.constant(value, width),
                (None, Known::Net(net)) => self.graph.add(Op::Net(net), width),
            },
            ExprKind::Extend(inner) => {
                let inner = self.expr(inner);
                self.graph.add(Op::Extend(inner), width)
            }
            ExprKind::Slice(inner, low_bit) => {
                let inner = self.expr(inner);
                let by = self.graph.constant(*low_bit as u128, 8);
                self.graph.add(Op::Shr(inner, by), width)
            }
            ExprKind::Select(inner, index) => {
                let (mut inner, index) = (self.expr(inner), self.expr(index));
                if self.graph.width_bits(inner) < width {
                    inner = self.graph.add(Op::Extend(inner), width);
                }
                self.graph.add(Op::Shr(inner, index), width)
            }
            ExprKind::Unary(op, inner) => {
                let a = self.expr(inner);
                let inner = inner.width_bits;
                match op {
                    UnaryOp::Not => self.graph.add(Op::Not(a), width),
                    UnaryOp::Xor => self.graph.add(Op::Parity(a), 1),
                    UnaryOp::All => {
                        let ones = self.graph.constant(mask(inner), inner);
                        self.graph.add(Op::Eq(a, ones), 1)
                    }
                    UnaryOp::Any => {
                        let zero = self.graph.constant(0, inner);
                        let none = self.graph.add(Op::Eq(a, zero), 1);
                        self.graph.add(Op::Not(none), 1)
                    }
                }
            }
            ExprKind::Binary(op, left, right) => {
                let (a, b) = (self.expr(left), self.expr(right));
                self.binary(*op, a, b, width)
            }
        }
    }

    fn binary(&mut self, op: BinaryOp, a: NodeId, b: NodeId, width: usize) -> NodeId {
        let (op, is_negated) = match op {
            BinaryOp::Add => (Op::Add(a, b), false),
            BinaryOp::Sub => (Op::Sub(a, b), false),
            BinaryOp::Mul => (Op::Mul(a, b), false),
            BinaryOp::And => (Op::And(a, b), false),
            BinaryOp::Or => (Op::Or(a, b), false),
            BinaryOp::Xor => (Op::Xor(a, b), false),
            BinaryOp::Shl => (Op::Shl(a, b), false),
            BinaryOp::Shr => (Op::Shr(a, b), false),
            BinaryOp::Eq => (Op::Eq(a, b), false),
            BinaryOp::Ne => (Op::Eq(a, b), true),
            BinaryOp::Lt => (Op::Lt(a, b), false),
            BinaryOp::Ge => (Op::Lt(a, b), true),
            BinaryOp::Gt => (Op::Lt(b, a), false),
            BinaryOp::Le => (Op::Lt(b, a), true),
        };
        let node = self.graph.add(op, width);
        if is_negated {
            self.graph.add(Op::Not(node), 1)
        } else {
            node
        }
    }
}
