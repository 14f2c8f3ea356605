//! Wrong designs: small changes of a [`Design`], each a mistake that checks of the design should see.
//!
//! ```text
//! Design -> mutations: every change that keeps the design printable -> mutated: the design with one of them
//!                                                                   -> schema: one design with many of them, chosen by an input
//! ```
//!
//! Printers and engines take the changed design like any other one. Contents of memories and start values of registers stay.

mod assigned;
mod expr;
mod schema;
mod sites;

pub use schema::{schema, CHOICE_BITS};
pub use sites::mutations;

use crate::elaborate::{free_name, Design, Expr, Module, ModuleId, Net, NetId, Process, Statement};

/// Kind of a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A bit of an assigned value, or of an input of a child, is always 0 or always 1.
    Stuck,
    /// Such a bit, or a condition, is inverted.
    Inverted,
    /// An operator is another one, or a complement is missing.
    Operator,
    /// A constant, or the lowest bit of a slice, differs by one; a state is the next one.
    Constant,
    /// A condition is missing: a branch is always or never taken, an operand of `and` or `or` or an arm of a case is left out.
    Condition,
    /// An assignment is missing.
    Assignment,
    /// A register has no reset.
    Reset,
    /// A register that only delays another one, or an input, is a wire.
    Stage,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 8] = [
        Self::Stuck,
        Self::Inverted,
        Self::Operator,
        Self::Constant,
        Self::Condition,
        Self::Assignment,
        Self::Reset,
        Self::Stage,
    ];

    /// The name in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stuck => "stuck",
            Self::Inverted => "inverted",
            Self::Operator => "operator",
            Self::Constant => "constant",
            Self::Condition => "condition",
            Self::Assignment => "assignment",
            Self::Reset => "reset",
            Self::Stage => "stage",
        }
    }
}

/// One change of one module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mutation {
    /// The module.
    pub module: ModuleId,
    /// Kind of the change.
    pub kind: Kind,
    /// Name of the net, register or connected port that the change is about; empty for a condition.
    pub about: String,
    change: Change,
}

/// Place of a change, and its replacement.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Change {
    /// Statements in the place of one.
    Statement {
        process: usize,
        path: Path,
        with: Vec<Statement>,
    },
    /// Another value at an input of a child.
    Connection {
        instance: usize,
        port: usize,
        with: Expr,
    },
    /// A register without its reset.
    Reset { register: usize },
    /// A wire in the place of a register; `from` is what the register delays.
    Stage { register: usize, from: NetId },
}

/// A statement in a process: an index into each [`Statement::blocks`] on the way (0 for the process itself), and one into that block.
type Path = Vec<(usize, usize)>;

/// The design with one mutation.
#[must_use]
pub fn mutated(design: &Design, mutation: &Mutation) -> Design {
    let mut design = design.clone();
    let module = &mut design.modules[mutation.module];
    match &mutation.change {
        Change::Statement {
            process,
            path,
            with,
        } => {
            let statements = &mut module.processes[*process].statements;
            replace(statements, path, &mut |_| with.clone());
        }
        Change::Connection {
            instance,
            port,
            with,
        } => {
            let net = cut(module, *instance, *port);
            let statements = vec![assign(net, with.clone())];
            module.processes.push(Process { statements });
        }
        Change::Reset { register } => module.registers[*register].reset = None,
        Change::Stage { register, from } => {
            let removed = module.registers.remove(*register);
            let statements = vec![assign(removed.q, module.net_expr(*from))];
            module.processes.insert(0, Process { statements });
        }
    }
    design
}

/// Replaces the statement at a path by what `with` makes of it.
fn replace(
    block: &mut Vec<Statement>,
    path: &[(usize, usize)],
    with: &mut dyn FnMut(Statement) -> Vec<Statement>,
) {
    let [(_, index), rest @ ..] = path else {
        return;
    };
    let Some((inner, _)) = rest.first() else {
        let statement = block[*index].clone();
        block.splice(index..=index, with(statement));
        return;
    };
    let mut blocks = block[*index].blocks_mut();
    if let Some(inner) = blocks.get_mut(*inner) {
        replace(inner, rest, with);
    }
}

/// Puts a new net between an input of a child and what it is connected to.
fn cut(module: &mut Module, instance: usize, port: usize) -> NetId {
    let width_bits = module.instances[instance].connections[port]
        .value
        .width_bits;
    let name = format!("{}_input_{port}", module.instances[instance].name);
    let net = new_net(module, &name, width_bits);
    module.instances[instance].connections[port].value = module.net_expr(net);
    net
}

fn new_net(module: &mut Module, wanted: &str, width_bits: usize) -> NetId {
    let nets = module.nets.iter().map(|net| &net.name);
    let instances = module.instances.iter().map(|instance| &instance.name);
    let parameters = module.parameters.iter().map(|parameter| &parameter.name);
    let memories = module.memories.iter().map(|memory| &memory.name);
    let taken = nets.chain(instances).chain(parameters).chain(memories);
    let name = free_name([wanted.to_owned()], taken);
    module.nets.push(Net {
        name,
        width_bits,
        enum_id: None,
        docs: vec![],
    });
    module.nets.len() - 1
}

fn assign(net: NetId, value: Expr) -> Statement {
    Statement::Assign {
        docs: vec![],
        net,
        low_bit: 0,
        value,
    }
}
