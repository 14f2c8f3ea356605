//! Statements of a process: what they assign and read, and parts of them.

use super::{Expr, NetId};
use std::collections::BTreeSet;

/// A statement of a [`Process`](super::Process).
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Statement {
    /// Assigns `value` to the bits of `net` from `low_bit` upwards.
    Assign {
        /// Comments of this statement.
        docs: Vec<String>,
        /// Target.
        net: NetId,
        /// Lowest bit assigned.
        low_bit: usize,
        /// Its width is that of the part assigned.
        value: Expr,
    },
    /// Executes one of two branches.
    If {
        /// About it.
        docs: Vec<String>,
        /// One bit.
        condition: Expr,
        /// If it is 1.
        then: Vec<Statement>,
        /// If it is 0.
        otherwise: Vec<Statement>,
    },
    /// Executes the arm whose value equals the subject.
    Case {
        /// About it.
        docs: Vec<String>,
        /// Compared expression.
        subject: Expr,
        /// Constants of the subject's width, and what to execute.
        arms: Vec<(Expr, Vec<Statement>)>,
        /// For all other values.
        default: Vec<Statement>,
    },
}
/// The part of statements that assigns nets of `set`.
pub fn restricted(statements: &[Statement], set: &BTreeSet<NetId>) -> Vec<Statement> {
    let parts = statements.iter().filter_map(|s| s.restricted_to(set));
    parts.collect()
}

/// Moves the comments of a statement to the first of the statements that replace it.
pub fn hand_on(docs: &[String], to: &mut [Statement]) {
    if let Some(first) = to.first_mut() {
        first.docs_mut().splice(0..0, docs.iter().cloned());
    }
}

/// The nets that statements assign.
pub fn targets(statements: &[Statement]) -> BTreeSet<NetId> {
    let mut nets = BTreeSet::new();
    for statement in statements {
        statement.for_each_target(&mut |net, _, _| {
            nets.insert(net);
        });
    }
    nets
}

impl Statement {
    /// Comments of this statement.
    pub fn docs(&self) -> &[String] {
        match self {
            Statement::Assign { docs, .. }
            | Statement::If { docs, .. }
            | Statement::Case { docs, .. } => docs,
        }
    }

    /// The same, to change it.
    pub fn docs_mut(&mut self) -> &mut Vec<String> {
        match self {
            Statement::Assign { docs, .. }
            | Statement::If { docs, .. }
            | Statement::Case { docs, .. } => docs,
        }
    }

    /// Calls `visit` for every net that the statement assigns, with the lowest bit and the width.
    pub fn for_each_target(&self, visit: &mut dyn FnMut(NetId, usize, usize)) {
        if let Statement::Assign {
            net,
            low_bit,
            value,
            ..
        } = self
        {
            visit(*net, *low_bit, value.width_bits);
        }
        for block in self.blocks() {
            for statement in block {
                statement.for_each_target(visit);
            }
        }
    }

    /// Calls `change` for every net that the statement assigns.
    pub fn for_each_target_mut(&mut self, change: &mut dyn FnMut(&mut NetId)) {
        if let Statement::Assign { net, .. } = self {
            change(net);
        }
        self.for_each_inner_mut(&mut |statement| {
            if let Statement::Assign { net, .. } = statement {
                change(net);
            }
        });
    }

    /// Calls `visit` for every expression of the statement itself, but not for those of the statements inside.
    pub fn for_each_own_expr(&self, visit: &mut dyn FnMut(&Expr)) {
        match self {
            Statement::Assign { value, .. } => visit(value),
            Statement::If { condition, .. } => visit(condition),
            Statement::Case { subject, arms, .. } => {
                visit(subject);
                arms.iter().for_each(|(value, _)| visit(value));
            }
        }
    }

    /// Calls `visit` for every expression in the statement.
    pub fn for_each_expr(&self, visit: &mut dyn FnMut(&Expr)) {
        self.for_each_own_expr(visit);
        for block in self.blocks() {
            for statement in block {
                statement.for_each_expr(visit);
            }
        }
    }

    /// Calls `change` for every net that the statement assigns or reads.
    pub fn for_each_net_mut(&mut self, change: &mut dyn FnMut(&mut NetId)) {
        self.for_each_target_mut(change);
        self.for_each_expr_mut(&mut |expr| expr.for_each_net_mut(change));
    }

    /// Calls `change` for every expression in the statement.
    pub fn for_each_expr_mut(&mut self, change: &mut dyn FnMut(&mut Expr)) {
        fn own(statement: &mut Statement, change: &mut dyn FnMut(&mut Expr)) {
            match statement {
                Statement::Assign { value, .. } => change(value),
                Statement::If { condition, .. } => change(condition),
                Statement::Case { subject, arms, .. } => {
                    change(subject);
                    arms.iter_mut().for_each(|(value, _)| change(value));
                }
            }
        }
        own(self, change);
        self.for_each_inner_mut(&mut |statement| own(statement, change));
    }

    /// Calls `change` for every statement inside, at any depth.
    fn for_each_inner_mut(&mut self, change: &mut dyn FnMut(&mut Statement)) {
        for statement in self.blocks_mut().into_iter().flatten() {
            change(statement);
            statement.for_each_inner_mut(change);
        }
    }

    /// The part of the statement that assigns nets of `set`.
    pub fn restricted_to(&self, set: &BTreeSet<NetId>) -> Option<Statement> {
        let block = |statements: &[Statement]| restricted(statements, set);
        match self {
            Statement::Assign { net, .. } => set.contains(net).then(|| self.clone()),
            Statement::If {
                docs,
                condition,
                then,
                otherwise,
            } => {
                let (then, otherwise) = (block(then), block(otherwise));
                (!then.is_empty() || !otherwise.is_empty()).then(|| Statement::If {
                    docs: docs.clone(),
                    condition: condition.clone(),
                    then,
                    otherwise,
                })
            }
            Statement::Case {
                docs,
                subject,
                arms,
                default,
            } => {
                let arms: Vec<_> = arms.iter().map(|(v, b)| (v.clone(), block(b))).collect();
                let default = block(default);
                let is_used = !default.is_empty() || arms.iter().any(|(_, b)| !b.is_empty());
                is_used.then(|| Statement::Case {
                    docs: docs.clone(),
                    subject: subject.clone(),
                    arms,
                    default,
                })
            }
        }
    }

    /// The blocks of statements inside it.
    pub fn blocks(&self) -> Vec<&[Statement]> {
        match self {
            Statement::Assign { .. } => vec![],
            Statement::If {
                then, otherwise, ..
            } => vec![then, otherwise],
            Statement::Case { arms, default, .. } => arms
                .iter()
                .map(|(_, block)| &block[..])
                .chain([&default[..]])
                .collect(),
        }
    }

    /// The same blocks, to change them.
    pub fn blocks_mut(&mut self) -> Vec<&mut Vec<Statement>> {
        match self {
            Statement::Assign { .. } => vec![],
            Statement::If {
                then, otherwise, ..
            } => vec![then, otherwise],
            Statement::Case { arms, default, .. } => arms
                .iter_mut()
                .map(|(_, block)| block)
                .chain([default])
                .collect(),
        }
    }
}
