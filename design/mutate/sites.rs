//! Every mutation of a module.

use super::assigned::Assigned;
use super::{expr, replace, Change, Kind, Mutation, Path};
use crate::elaborate::{
    targets, Design, Direction, Expr, ExprKind, Module, ModuleId, NetId, Register, Statement,
    UnaryOp,
};

/// Every mutation of one module, in a fixed order.
#[must_use]
pub fn mutations(design: &Design, id: ModuleId) -> Vec<Mutation> {
    let module = &design.modules[id];
    let mut found = vec![];
    let mut add = |kind, about: &str, change| {
        found.push(Mutation {
            module: id,
            kind,
            about: about.to_owned(),
            change,
        });
    };
    for (index, process) in module.processes.iter().enumerate() {
        let nets = targets(&process.statements);
        let before = Assigned::of(module, &nets, &process.statements);
        let mut paths = vec![];
        walk(&process.statements, 0, &mut vec![], &mut paths);
        for (path, statement) in paths {
            for (kind, with) in alternatives(design, module, statement) {
                let mut after = process.statements.clone();
                replace(&mut after, &path, &mut |_| with.clone());
                if !Assigned::of(module, &nets, &after).covers(&before) {
                    continue;
                }
                let about = match statement {
                    Statement::Assign { net, .. } => module.nets[*net].name.as_str(),
                    _ => "",
                };
                let path = path.clone();
                let process = index;
                add(
                    kind,
                    about,
                    Change::Statement {
                        process,
                        path,
                        with,
                    },
                );
            }
        }
    }
    for (index, instance) in module.instances.iter().enumerate() {
        let child = &design.modules[instance.module];
        for (port, connection) in instance.connections.iter().enumerate() {
            let is_clock = child.ports[port].is_clock;
            if connection.direction != Direction::Input || is_clock {
                continue;
            }
            let name = &child.nets[child.ports[port].net].name;
            for (kind, with) in expr::bits(&connection.value) {
                let change = Change::Connection {
                    instance: index,
                    port,
                    with,
                };
                add(kind, &format!("{}.{name}", instance.name), change);
            }
        }
    }
    for (index, register) in module.registers.iter().enumerate() {
        let name = &module.nets[register.q].name;
        if register.reset.is_some() {
            add(Kind::Reset, name, Change::Reset { register: index });
        }
        if let Some(from) = stage(module, index) {
            let change = Change::Stage {
                register: index,
                from,
            };
            add(Kind::Stage, name, change);
        }
    }
    found
}

/// The net that a register delays; none if registers delay each other in a ring, which would be a loop of wires.
fn stage(module: &Module, index: usize) -> Option<NetId> {
    let first = delayed(module, &module.registers[index])?;
    let mut at = first;
    for _ in &module.registers {
        let Some(next) = module.registers.iter().find(|r| r.q == at) else {
            return Some(first);
        };
        match delayed(module, next) {
            Some(from) => at = from,
            None => return Some(first),
        }
    }
    None
}

/// The net that a register delays, if its only assignment is that net: another register or an input.
fn delayed(module: &Module, register: &Register) -> Option<NetId> {
    let mut found = vec![];
    for process in &module.processes {
        for statement in &process.statements {
            statement.for_each_target(&mut |net, _, _| {
                if net == register.next {
                    found.push(statement);
                }
            });
        }
    }
    let [Statement::Assign { value, .. }] = &found[..] else {
        return None;
    };
    let ExprKind::Net(from) = value.kind else {
        return None;
    };
    let is_register = module.registers.iter().any(|r| r.q == from);
    let is_input = module
        .ports
        .iter()
        .any(|port| port.net == from && port.direction == Direction::Input && !port.is_clock);
    let is_whole = value.width_bits == module.nets[register.q].width_bits;
    (is_whole && from != register.q && (is_register || is_input)).then_some(from)
}

/// Every statement with its path, those inside after the one that holds them.
fn walk<'a>(
    block: &'a [Statement],
    number: usize,
    path: &mut Path,
    found: &mut Vec<(Path, &'a Statement)>,
) {
    for (index, statement) in block.iter().enumerate() {
        path.push((number, index));
        found.push((path.clone(), statement));
        for (number, inner) in statement.blocks().into_iter().enumerate() {
            walk(inner, number, path, found);
        }
        path.pop();
    }
}

/// Replacements of one statement.
fn alternatives(
    design: &Design,
    module: &Module,
    statement: &Statement,
) -> Vec<(Kind, Vec<Statement>)> {
    let mut found = vec![];
    match statement {
        Statement::Assign {
            docs,
            net,
            low_bit,
            value,
        } => {
            let with = |value: Expr| {
                vec![Statement::Assign {
                    docs: docs.clone(),
                    net: *net,
                    low_bit: *low_bit,
                    value,
                }]
            };
            let mut values = expr::changes(design, module, value);
            // A state has no bits: its values are those of its type.
            if module.nets[*net].enum_id.is_none() {
                values.extend(expr::bits(value));
            }
            found.extend(values.into_iter().map(|(kind, value)| (kind, with(value))));
            found.push((Kind::Assignment, vec![]));
        }
        Statement::If {
            docs,
            condition,
            then,
            otherwise,
        } => {
            let not = Expr {
                width_bits: 1,
                kind: ExprKind::Unary(UnaryOp::Not, Box::new(condition.clone())),
            };
            let mut conditions = expr::changes(design, module, condition);
            conditions.push((Kind::Inverted, not));
            for (kind, condition) in conditions {
                let statement = Statement::If {
                    docs: docs.clone(),
                    condition,
                    then: then.clone(),
                    otherwise: otherwise.clone(),
                };
                found.push((kind, vec![statement]));
            }
            found.push((Kind::Condition, then.clone()));
            found.push((Kind::Condition, otherwise.clone()));
        }
        Statement::Case {
            docs,
            subject,
            arms,
            default,
        } => {
            let with = |subject: Expr, arms: Vec<(Expr, Vec<Statement>)>| {
                vec![Statement::Case {
                    docs: docs.clone(),
                    subject,
                    arms,
                    default: default.clone(),
                }]
            };
            for (kind, subject) in expr::changes(design, module, subject) {
                found.push((kind, with(subject, arms.clone())));
            }
            // Without a default the last state that no arm names would assign nothing.
            if !default.is_empty() && arms.len() > 1 {
                for index in 0..arms.len() {
                    let mut arms = arms.clone();
                    arms.remove(index);
                    found.push((Kind::Condition, with(subject.clone(), arms)));
                }
            }
        }
    }
    found.retain(|(_, with)| with[..] != [statement.clone()]);
    found
}
