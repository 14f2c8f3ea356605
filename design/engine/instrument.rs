//! Nets that can be forced, and coverage: built into the design before it is compiled, so that every engine has them.

use super::flat::{Flat, FlatNet, FlatProcess, FlatRegister};
use super::EngineError;
use crate::elaborate::{BinaryOp, Design, Expr, ExprKind, Statement, UnaryOp};
use std::collections::btree_map::{BTreeMap, Entry};

/// Optional instruments of an engine.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Instruments {
    /// Hierarchical names of nets that can be forced.
    pub forced: Vec<String>,
    /// Note which bits of registers and ports have risen and fallen, and which states have been reached.
    pub coverage: bool,
}

/// Nets of a forced net: bits to force, and their values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Force {
    pub mask: usize,
    pub value: usize,
}

/// Nets that note what happened to a net.
#[derive(Clone, Debug)]
pub(super) struct Covered {
    pub net: usize,
    pub rose: usize,
    pub fell: usize,
    /// One bit for each state, and the names of the states.
    pub states: Option<(usize, Vec<String>)>,
}

/// The instruments in place.
#[derive(Clone, Debug, Default)]
pub(super) struct Fitted {
    /// By forced net.
    pub forces: BTreeMap<usize, Force>,
    pub covered: Vec<Covered>,
}

impl Fitted {
    /// Nets that must be kept, and are driven from outside.
    pub fn inputs(&self) -> impl Iterator<Item = usize> + '_ {
        self.forces.values().flat_map(|f| [f.mask, f.value])
    }

    /// Nets that must be kept.
    pub fn observed(&self) -> impl Iterator<Item = usize> + '_ {
        let covered = self.covered.iter();
        covered
            .flat_map(|c| [Some(c.rose), Some(c.fell), c.states.as_ref().map(|s| s.0)])
            .flatten()
    }
}

/// Builds the instruments into a flat design.
///
/// # Errors
/// If there is no net of a name.
pub(super) fn fit(
    flat: &mut Flat,
    design: &Design,
    instruments: &Instruments,
) -> Result<Fitted, EngineError> {
    let mut fitted = Fitted::default();
    for name in &instruments.forced {
        let net = flat.nets.iter().position(|n| n.name == *name);
        let net = net.ok_or_else(|| EngineError::UnknownNet(name.clone()))?;
        // A second force would be inserted between the first one and the readers.
        if let Entry::Vacant(place) = fitted.forces.entry(net) {
            place.insert(force(flat, net));
        }
    }
    if instruments.coverage {
        let mut nets: Vec<usize> = flat.registers.iter().map(|r| r.q).collect();
        nets.extend(&flat.port_nets);
        nets.sort_unstable();
        nets.dedup();
        fitted.covered = nets
            .into_iter()
            .map(|net| cover(flat, design, net))
            .collect();
    }
    Ok(fitted)
}

fn add(flat: &mut Flat, net: usize, what: &str, width_bits: usize) -> usize {
    flat.nets.push(FlatNet {
        name: format!("{} {what}", flat.nets[net].name),
        width_bits,
        enum_id: None,
    });
    flat.nets.len() - 1
}

fn read(flat: &Flat, net: usize) -> Expr {
    Expr {
        width_bits: flat.nets[net].width_bits,
        kind: ExprKind::Net(net),
    }
}

fn binary(op: BinaryOp, a: Expr, b: Expr) -> Expr {
    Expr {
        width_bits: a.width_bits,
        kind: ExprKind::Binary(op, Box::new(a), Box::new(b)),
    }
}

fn not(a: Expr) -> Expr {
    Expr {
        width_bits: a.width_bits,
        kind: ExprKind::Unary(UnaryOp::Not, Box::new(a)),
    }
}

fn assign(net: usize, value: Expr) -> FlatProcess {
    FlatProcess {
        statements: vec![Statement::Assign {
            docs: vec![],
            net,
            low_bit: 0,
            value,
        }],
        parameters: vec![],
    }
}

/// Puts `net = driven & !mask | value & mask` between a net and what drives it.
fn force(flat: &mut Flat, net: usize) -> Force {
    let width = flat.nets[net].width_bits;
    let driven = add(flat, net, "driven", width);
    let (mask, value) = (
        add(flat, net, "forced bits", width),
        add(flat, net, "forced value", width),
    );
    for register in flat.registers.iter_mut().filter(|r| r.q == net) {
        register.q = driven;
    }
    for memory in flat.memories.iter_mut().filter(|m| m.read_data == net) {
        memory.read_data = driven;
    }
    let ports = flat.ports.iter().zip(&mut flat.port_nets);
    ports
        .filter(|(port, port_net)| port.is_input && **port_net == net)
        .for_each(|(_, port_net)| *port_net = driven);
    let keep = binary(BinaryOp::And, read(flat, driven), not(read(flat, mask)));
    let replace = binary(BinaryOp::And, read(flat, value), read(flat, mask));
    let forced = assign(net, binary(BinaryOp::Or, keep, replace));
    let driver = flat
        .processes
        .iter()
        .position(|p| p.targets().contains(&net));
    match driver {
        None => flat.processes.insert(0, forced),
        Some(index) => {
            let process = flat.processes.remove(index);
            let mut rest = process.targets();
            rest.remove(&net);
            // The same once more, for nothing but the net; what else it drives there is read nowhere.
            let mut renamed = BTreeMap::from([(net, driven)]);
            for target in &rest {
                let width = flat.nets[*target].width_bits;
                renamed.insert(*target, add(flat, *target, "unforced", width));
            }
            let mut before = process.statements.clone();
            for statement in &mut before {
                statement.for_each_net_mut(&mut |net| *net = *renamed.get(net).unwrap_or(net));
            }
            let after = process.statements.iter();
            let after = after.filter_map(|s| s.restricted_to(&rest)).collect();
            let parameters = process.parameters;
            let part = |statements| FlatProcess {
                statements,
                parameters: parameters.clone(),
            };
            let parts = [part(before), forced, part(after)];
            flat.processes.splice(index..index, parts);
        }
    }
    Force { mask, value }
}

/// Adds registers that remember what a net did.
fn cover(flat: &mut Flat, design: &Design, net: usize) -> Covered {
    let width = flat.nets[net].width_bits;
    let start = flat
        .registers
        .iter()
        .find(|r| r.q == net)
        .map_or(0, |r| r.start);
    let before = add(flat, net, "before", width);
    let remember = |flat: &mut Flat, q: usize, start: u128, next: Expr| {
        let d = add(flat, q, "next", next.width_bits);
        flat.processes.push(assign(d, next));
        flat.registers.push(FlatRegister {
            q,
            next: d,
            reset: None,
            start,
        });
    };
    let now = read(flat, net);
    remember(flat, before, start, now.clone());
    let was = read(flat, before);
    let noted = |flat: &mut Flat, what: &str, event: Expr| {
        let q = add(flat, net, what, event.width_bits);
        let next = binary(BinaryOp::Or, read(flat, q), event);
        remember(flat, q, 0, next);
        q
    };
    let rose = noted(
        flat,
        "rose",
        binary(BinaryOp::And, now.clone(), not(was.clone())),
    );
    let fell = noted(flat, "fell", binary(BinaryOp::And, not(now.clone()), was));
    let states = flat.nets[net].enum_id.map(|id| {
        let names = design.enums[id].variants.clone();
        // The value of a state is its index.
        let one = Expr::constant(1, names.len());
        let event = binary(BinaryOp::Shl, one, now);
        (noted(flat, "states", event), names)
    });
    Covered {
        net,
        rose,
        fell,
        states,
    }
}
