//! Many mutants in one design, which an input of the top chooses: made once by a simulator's compiler, run with each number.

use super::{assign, cut, new_net, replace, Change, Mutation, Path};
use crate::elaborate::{
    Connection, Design, Direction, Expr, Module, ModuleId, NetId, Port, Process, Statement,
};
use std::collections::BTreeMap;

/// Bits of the input that chooses.
pub const CHOICE_BITS: usize = 16;

/// The design with all these mutations. Mutation `k` of the list is active while the new input of the top is `k + 1`, none while it is 0.
/// Returns the name of that input, too.
#[must_use]
pub fn schema(design: &Design, mutations: &[Mutation]) -> (Design, String) {
    let mut design = design.clone();
    let mut choices: BTreeMap<ModuleId, NetId> = BTreeMap::new();
    // Modules come before those in them, so a walk from the end knows which children have the input.
    for id in (0..design.modules.len()).rev() {
        let below = design.modules[id].instances.iter();
        let has_below = below.clone().any(|i| choices.contains_key(&i.module));
        let is_mutated = mutations.iter().any(|m| m.module == id);
        if id != 0 && !has_below && !is_mutated {
            continue;
        }
        let module = &mut design.modules[id];
        let choice = new_net(module, "mutant", CHOICE_BITS);
        module.ports.push(Port {
            net: choice,
            direction: Direction::Input,
            is_clock: false,
        });
        let value = module.net_expr(choice);
        for instance in &mut module.instances {
            if choices.contains_key(&instance.module) {
                instance.connections.push(Connection {
                    direction: Direction::Input,
                    value: value.clone(),
                });
            }
        }
        let own = mutations.iter().zip(1..).filter(|(m, _)| m.module == id);
        change(module, choice, own.collect());
        choices.insert(id, choice);
    }
    let name = design.top().nets[choices[&0]].name.clone();
    (design, name)
}

/// Replacements at each place, each with the number that chooses it.
type Places<'a, Place, With> = BTreeMap<Place, Vec<(u128, &'a With)>>;

/// Puts the mutations of one module into it.
fn change(module: &mut Module, choice: NetId, mutations: Vec<(&Mutation, u128)>) {
    let mut statements: Places<(usize, &Path), Vec<Statement>> = BTreeMap::new();
    let mut connections: Places<(usize, usize), Expr> = BTreeMap::new();
    let mut resets = BTreeMap::new();
    let mut stages = BTreeMap::new();
    for (mutation, number) in mutations {
        match &mutation.change {
            Change::Statement {
                process,
                path,
                with,
            } => {
                let place = statements.entry((*process, path)).or_default();
                place.push((number, with));
            }
            Change::Connection {
                instance,
                port,
                with,
            } => {
                let place = connections.entry((*instance, *port)).or_default();
                place.push((number, with));
            }
            Change::Reset { register } => {
                resets.insert(*register, number);
            }
            Change::Stage { register, from } => {
                stages.insert(*register, (*from, number));
            }
        }
    }
    let subject = module.net_expr(choice);
    // From the last place to the first: what is inside another statement goes first, and no index moves before it is used.
    for ((process, path), arms) in statements.into_iter().rev() {
        let arm = |(number, with): &(u128, &Vec<Statement>)| (number_of(*number), (*with).clone());
        let arms: Vec<_> = arms.iter().map(arm).collect();
        replace(
            &mut module.processes[process].statements,
            path,
            &mut |statement| vec![case(&subject, arms.clone(), vec![statement])],
        );
    }
    for ((instance, port), arms) in connections {
        let right = module.instances[instance].connections[port].value.clone();
        let net = cut(module, instance, port);
        let arm = |(number, with): &(u128, &Expr)| {
            (number_of(*number), vec![assign(net, (*with).clone())])
        };
        let arms = arms.iter().map(arm).collect();
        let statements = vec![case(&subject, arms, vec![assign(net, right)])];
        module.processes.push(Process { statements });
    }
    for (register, number) in resets {
        let Some(reset) = module.registers[register].reset else {
            continue;
        };
        let name = format!("{}_reset", module.nets[module.registers[register].q].name);
        let net = new_net(module, &name, 1);
        let right = module.net_expr(reset);
        let arms = vec![(number_of(number), vec![assign(net, Expr::constant(0, 1))])];
        let statements = vec![case(&subject, arms, vec![assign(net, right)])];
        module.processes.push(Process { statements });
        module.registers[register].reset = Some(net);
    }
    stage(module, &subject, stages);
}

/// Wires that replace a register while their mutant is chosen, those that others delay first.
fn stage(module: &mut Module, subject: &Expr, mut stages: BTreeMap<usize, (NetId, u128)>) {
    let mut first = 0;
    while !stages.is_empty() {
        let delays: Vec<NetId> = stages.keys().map(|r| module.registers[*r].q).collect();
        let ready = stages.iter().find(|(_, (from, _))| !delays.contains(from));
        let Some((register, (from, number))) = ready.map(|(r, s)| (*r, *s)) else {
            return;
        };
        stages.remove(&register);
        let q = module.registers[register].q;
        let name = format!("{}_stage", module.nets[q].name);
        let held = new_net(module, &name, module.nets[q].width_bits);
        module.nets[held].enum_id = module.nets[q].enum_id;
        module.registers[register].q = held;
        let arms = vec![(number_of(number), vec![assign(q, module.net_expr(from))])];
        let statements = vec![case(subject, arms, vec![assign(q, module.net_expr(held))])];
        module.processes.insert(first, Process { statements });
        first += 1;
    }
}

fn number_of(number: u128) -> Expr {
    Expr::constant(number, CHOICE_BITS)
}

fn case(subject: &Expr, arms: Vec<(Expr, Vec<Statement>)>, right: Vec<Statement>) -> Statement {
    Statement::Case {
        docs: vec![],
        subject: subject.clone(),
        arms,
        default: right,
    }
}
