//! Removes the parts of a design that its configuration never uses.
//!
//! ```text
//! start values, constants, ties --(until nothing changes)--> bits that never change --> branches never taken, registers that never move
//! outputs of the top, properties --(until nothing changes)--> nets, ports, instances, modules that matter
//! ```
//!
//! The ports of the design do the same in every cycle. The engines run the untrimmed design, so every comparison with emitted Verilog compares
//! the two. Bits are followed through all modules at once, beginning with registers at their start values; the knowledge of a module holds
//! in each of its instances. A register is known completely or not at all, so for any contents of the others the design continues
//! as before. Named constants keep their names, except flags, which only select logic.

mod fold;
mod known;
mod live;

use super::design::*;
use super::properties::words;
use known::{either, known, run, Known, Values};
use std::collections::BTreeSet;

impl Design {
    /// The design without what is never used.
    pub fn trimmed(&self) -> Self {
        let mut design = self.clone();
        loop {
            let facts = facts(&design);
            let folded = live::without_dead(&folded(&design, &facts), &facts);
            if folded == design {
                return design;
            }
            design = folded;
        }
    }
}

impl Module {
    /// The value of a net of which all is known.
    fn whole(&self, net: NetId, values: &Values) -> Option<u128> {
        values[net]?.whole(self.nets[net].width_bits)
    }

    /// Nets that the module's properties name.
    fn named_in_properties(&self) -> BTreeSet<NetId> {
        let words = words(&self.properties);
        let nets = self.nets.iter().enumerate();
        nets.filter(|(_, net)| words.contains(net.name.as_str()))
            .map(|(id, _)| id)
            .collect()
    }
}

/// Knowledge of every net of every module, valid in every cycle.
fn facts(design: &Design) -> Vec<Values> {
    let empty = |module: &Module| vec![None; module.nets.len()];
    let mut facts: Vec<Values> = design.modules.iter().map(empty).collect();
    for port in &design.top().ports {
        if port.direction == Direction::Input {
            facts[0][port.net] = Some(Known::UNKNOWN);
        }
    }
    for (module, values) in design.modules.iter().zip(&mut facts) {
        for register in &module.registers {
            let has_start = design.has_initial_values || register.reset.is_some();
            values[register.q] = Some(match has_start {
                true => Known::of(register.start),
                false => Known::UNKNOWN,
            });
        }
        for memory in &module.memories {
            values[memory.read_data] = Some(Known::UNKNOWN);
        }
    }
    loop {
        let before = facts.clone();
        for id in 0..design.modules.len() {
            step(design, id, &mut facts);
        }
        if facts == before {
            return facts;
        }
    }
}

/// Carries what is known in a module on: through its processes, into its registers, into and out of its children.
fn step(design: &Design, id: ModuleId, facts: &mut [Values]) {
    let module = &design.modules[id];
    let mut values = std::mem::take(&mut facts[id]);
    for process in &module.processes {
        let mut after = values.clone();
        let targets = targets(&process.statements);
        for net in &targets {
            after[*net] = Some(Known::UNKNOWN);
        }
        run(module, &process.statements, &mut after);
        for net in targets {
            values[net] = either(values[net], after[net]);
        }
    }
    for register in &module.registers {
        let q = register.q;
        let moved = either(values[q], values[register.next]);
        // One that moves may hold anything: an upset takes it where no logic does.
        let stays = moved.filter(|bits| bits.whole(module.nets[q].width_bits).is_some());
        values[q] = stays.or(Some(Known::UNKNOWN));
    }
    for instance in &module.instances {
        let child = &design.modules[instance.module];
        for (port, connection) in child.ports.iter().zip(&instance.connections) {
            let inside = &mut facts[instance.module][port.net];
            match (port.direction, &connection.value.kind) {
                (Direction::Input, _) => {
                    *inside = either(*inside, known(module, &connection.value, &values));
                }
                (Direction::Output, ExprKind::Net(net)) => {
                    values[*net] = either(values[*net], *inside);
                }
                (Direction::Output, _) => {}
            }
        }
    }
    facts[id] = values;
}

/// The design with what is known in its place.
fn folded(design: &Design, facts: &[Values]) -> Design {
    let mut design = design.clone();
    for (module, values) in design.modules.iter_mut().zip(facts) {
        let old = module.clone();
        for process in &mut module.processes {
            let mut own = values.clone();
            for net in targets(&process.statements) {
                own[net] = Some(Known::UNKNOWN);
            }
            process.statements = fold::fold(&old, &process.statements, &mut own);
        }
        for register in &mut module.registers {
            let is_off = |reset: &NetId| old.whole(*reset, values) == Some(0);
            register.reset = register.reset.filter(|reset| !is_off(reset));
        }
        for instance in &mut module.instances {
            for connection in &mut instance.connections {
                if connection.direction == Direction::Input {
                    connection.value = fold::shorter(&old, &connection.value, values);
                }
            }
        }
    }
    design
}
