//! Statements as a list of operations on numbered values.

use crate::elaborate::{binary, mask, BinaryOp, Expr, ExprKind, Statement, UnaryOp};
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

/// One operation. `to`, `a`, `b` are indices of values.
#[derive(Clone, Copy, Debug)]
enum Operation {
    Copy {
        to: usize,
        a: usize,
    },
    /// Replaces the bits of `to` that are set in `mask` (already shifted).
    Insert {
        to: usize,
        a: usize,
        low_bit: usize,
        mask: u128,
    },
    Extract {
        to: usize,
        a: usize,
        low_bit: usize,
        mask: u128,
    },
    Select {
        to: usize,
        a: usize,
        b: usize,
        mask: u128,
    },
    Unary {
        op: UnaryOp,
        to: usize,
        a: usize,
        mask: u128,
    },
    Binary {
        op: BinaryOp,
        to: usize,
        a: usize,
        b: usize,
        mask: u128,
    },
    /// Goes on at `target` if the value is 0.
    UnlessGo {
        a: usize,
        target: usize,
    },
    /// Goes on at `target` if the values differ.
    DifferGo {
        a: usize,
        b: usize,
        target: usize,
    },
    Go {
        target: usize,
    },
}

/// The operations of one process.
struct Segment {
    operations: Range<usize>,
    targets: Vec<usize>,
}

/// Compiled processes, in an order in which each reads only what is settled before.
pub(super) struct Program {
    operations: Vec<Operation>,
    segments: Vec<Segment>,
    /// For each net the segments that read it.
    readers: Vec<Vec<usize>>,
    pub value_count: usize,
    /// Values that never change.
    pub constants: Vec<(usize, u128)>,
}

impl Program {
    /// The segments of a state in which nothing is settled.
    pub fn all_stale(&self) -> Vec<bool> {
        vec![true; self.segments.len()]
    }

    /// Notes that a net has changed.
    pub fn changed(&self, net: usize, stale: &mut [bool]) {
        for reader in &self.readers[net] {
            stale[*reader] = true;
        }
    }

    /// Settles: runs the stale segments and those that read what they change.
    pub fn run(&self, v: &mut [u128], stale: &mut [bool]) {
        let mut before = vec![];
        for (index, segment) in self.segments.iter().enumerate() {
            if !stale[index] {
                continue;
            }
            before.clear();
            before.extend(segment.targets.iter().map(|target| v[*target]));
            self.run_segment(&segment.operations, v);
            for (target, before) in segment.targets.iter().zip(&before) {
                if v[*target] != *before {
                    self.changed(*target, stale);
                }
            }
            // The process's own outputs do not make it stale.
            stale[index] = false;
        }
    }

    fn run_segment(&self, range: &Range<usize>, v: &mut [u128]) {
        let mut at = range.start;
        while at < range.end {
            let operation = &self.operations[at];
            at += 1;
            match *operation {
                Operation::Copy { to, a } => v[to] = v[a],
                Operation::Insert {
                    to,
                    a,
                    low_bit,
                    mask,
                } => v[to] = (v[to] & !mask) | (v[a] << low_bit),
                Operation::Extract {
                    to,
                    a,
                    low_bit,
                    mask,
                } => v[to] = (v[a] >> low_bit) & mask,
                Operation::Select { to, a, b, mask } => {
                    v[to] = binary(BinaryOp::Shr, v[a], v[b]) & mask
                }
                Operation::Unary { op, to, a, mask } => {
                    v[to] = match op {
                        UnaryOp::Not => !v[a] & mask,
                        UnaryOp::All => (v[a] == mask).into(),
                        UnaryOp::Any => (v[a] != 0).into(),
                        UnaryOp::Xor => (v[a].count_ones() & 1).into(),
                    }
                }
                Operation::Binary { op, to, a, b, mask } => v[to] = binary(op, v[a], v[b]) & mask,
                Operation::UnlessGo { a, target } => {
                    if v[a] == 0 {
                        at = target;
                    }
                }
                Operation::DifferGo { a, b, target } => {
                    if v[a] != v[b] {
                        at = target;
                    }
                }
                Operation::Go { target } => at = target,
            }
        }
    }
}

/// Turns statements into operations.
pub(super) struct Compiler {
    net_widths: Vec<usize>,
    operations: Vec<Operation>,
    segments: Vec<Segment>,
    readers: Vec<Vec<usize>>,
    value_count: usize,
    constants: HashMap<u128, usize>,
}

impl Compiler {
    /// Nets are the first values.
    pub fn new(net_widths: Vec<usize>) -> Self {
        Self {
            value_count: net_widths.len(),
            readers: vec![vec![]; net_widths.len()],
            net_widths,
            operations: vec![],
            segments: vec![],
            constants: HashMap::new(),
        }
    }

    pub fn finish(self) -> Program {
        Program {
            operations: self.operations,
            segments: self.segments,
            readers: self.readers,
            value_count: self.value_count,
            constants: self
                .constants
                .into_iter()
                .map(|(value, index)| (index, value))
                .collect(),
        }
    }

    /// Adds a process with all nets that it reads and writes; those that it reads must come from earlier ones.
    pub fn process(
        &mut self,
        statements: &[Statement],
        parameters: &[u128],
        reads: &BTreeSet<usize>,
        targets: BTreeSet<usize>,
    ) {
        let start = self.operations.len();
        self.statements(statements, parameters);
        for net in reads {
            self.readers[*net].push(self.segments.len());
        }
        self.segments.push(Segment {
            operations: start..self.operations.len(),
            targets: targets.into_iter().collect(),
        });
    }

    fn statements(&mut self, statements: &[Statement], parameters: &[u128]) {
        for statement in statements {
            self.statement(statement, parameters);
        }
    }

    fn statement(&mut self, statement: &Statement, parameters: &[u128]) {
        match statement {
            Statement::Assign {
                net,
                low_bit,
                value,
                ..
            } => {
                let bits = mask(value.width_bits) << low_bit;
                let (to, low_bit) = (*net, *low_bit);
                if value.width_bits == self.net_widths[to] {
                    self.value_into(value, parameters, Some(to));
                } else {
                    let a = self.value_into(value, parameters, None);
                    self.operations.push(Operation::Insert {
                        to,
                        a,
                        low_bit,
                        mask: bits,
                    });
                }
            }
            Statement::If {
                condition,
                then,
                otherwise,
                ..
            } => {
                let a = self.value_into(condition, parameters, None);
                let skip = self.hole();
                self.statements(then, parameters);
                if otherwise.is_empty() {
                    self.operations[skip] = Operation::UnlessGo {
                        a,
                        target: self.operations.len(),
                    };
                } else {
                    let end = self.hole();
                    self.operations[skip] = Operation::UnlessGo {
                        a,
                        target: self.operations.len(),
                    };
                    self.statements(otherwise, parameters);
                    self.operations[end] = Operation::Go {
                        target: self.operations.len(),
                    };
                }
            }
            Statement::Case {
                subject,
                arms,
                default,
                ..
            } => {
                let a = self.value_into(subject, parameters, None);
                let mut ends = vec![];
                for (value, block) in arms {
                    let b = self.value_into(value, parameters, None);
                    let skip = self.hole();
                    self.statements(block, parameters);
                    ends.push(self.hole());
                    self.operations[skip] = Operation::DifferGo {
                        a,
                        b,
                        target: self.operations.len(),
                    };
                }
                self.statements(default, parameters);
                for end in ends {
                    self.operations[end] = Operation::Go {
                        target: self.operations.len(),
                    };
                }
            }
        }
    }

    /// A place for a jump whose target is not known yet.
    fn hole(&mut self) -> usize {
        self.operations.push(Operation::Go { target: 0 });
        self.operations.len() - 1
    }

    fn constant(&mut self, value: u128) -> usize {
        let next = &mut self.value_count;
        *self.constants.entry(value).or_insert_with(|| {
            *next += 1;
            *next - 1
        })
    }

    /// Computes an expression, into the value `to` if given; says where the result is.
    fn value_into(&mut self, expr: &Expr, parameters: &[u128], to: Option<usize>) -> usize {
        let width_mask = mask(expr.width_bits);
        let place = match &expr.kind {
            ExprKind::Constant(value) => Err(self.constant(*value)),
            ExprKind::Variant(_, index) => Err(self.constant(*index as u128)),
            ExprKind::Parameter(index) => Err(self.constant(parameters[*index])),
            ExprKind::Net(net) => Err(*net),
            // values have no width
            ExprKind::Extend(inner) => return self.value_into(inner, parameters, to),
            ExprKind::Slice(inner, low_bit) => {
                let (a, low_bit) = (self.value_into(inner, parameters, None), *low_bit);
                Ok(Operation::Extract {
                    to: 0,
                    a,
                    low_bit,
                    mask: width_mask,
                })
            }
            ExprKind::Select(inner, index) => {
                let a = self.value_into(inner, parameters, None);
                let b = self.value_into(index, parameters, None);
                Ok(Operation::Select {
                    to: 0,
                    a,
                    b,
                    mask: width_mask,
                })
            }
            ExprKind::Unary(op, inner) => {
                let a = self.value_into(inner, parameters, None);
                let mask = mask(inner.width_bits);
                Ok(Operation::Unary {
                    op: *op,
                    to: 0,
                    a,
                    mask,
                })
            }
            ExprKind::Binary(op, left, right) => {
                let a = self.value_into(left, parameters, None);
                let b = self.value_into(right, parameters, None);
                Ok(Operation::Binary {
                    op: *op,
                    to: 0,
                    a,
                    b,
                    mask: width_mask,
                })
            }
        };
        match (place, to) {
            (Err(a), None) => a,
            (Err(a), Some(to)) => {
                self.operations.push(Operation::Copy { to, a });
                to
            }
            (Ok(operation), to) => {
                let to = to.unwrap_or_else(|| {
                    self.value_count += 1;
                    self.value_count - 1
                });
                self.operations.push(operation.with_target(to));
                to
            }
        }
    }
}

impl Operation {
    fn with_target(mut self, target: usize) -> Self {
        match &mut self {
            Operation::Copy { to, .. }
            | Operation::Insert { to, .. }
            | Operation::Extract { to, .. }
            | Operation::Select { to, .. }
            | Operation::Unary { to, .. }
            | Operation::Binary { to, .. } => *to = target,
            Operation::UnlessGo { .. } | Operation::DifferGo { .. } | Operation::Go { .. } => {}
        }
        self
    }
}
