//! Which nets a module reads and mentions, and how to renumber them.

use super::design::*;
use super::plan::for_each_read;
use std::collections::{BTreeMap, BTreeSet};

impl Module {
    /// The bits of each net that something reads: a statement, a register, a memory, an instance.
    pub fn read_bits(&self) -> BTreeMap<NetId, u128> {
        let mut read: BTreeMap<NetId, u128> = BTreeMap::new();
        let mut note = |net: NetId, bits: u128| *read.entry(net).or_default() |= bits;
        for statement in self.processes.iter().flat_map(|p| &p.statements) {
            statement.for_each_expr(&mut |expr| for_each_read(expr, &mut note));
        }
        for register in &self.registers {
            for net in register
                .reset
                .iter()
                .chain([&register.clock, &register.next])
            {
                note(*net, u128::MAX);
            }
        }
        for memory in &self.memories {
            memory.inputs().for_each(|net| note(net, u128::MAX));
        }
        for instance in &self.instances {
            let inputs = instance
                .connections
                .iter()
                .filter(|c| c.direction == Direction::Input);
            inputs.for_each(|c| for_each_read(&c.value, &mut note));
        }
        read
    }

    pub(super) fn mentioned_nets(&self) -> BTreeSet<NetId> {
        let mut nets: BTreeSet<NetId> = self.read_bits().into_keys().collect();
        nets.extend(self.ports.iter().map(|p| p.net));
        nets.extend(self.registers.iter().map(|r| r.q));
        nets.extend(self.memories.iter().map(|m| m.read_data));
        for connection in self.instances.iter().flat_map(|i| &i.connections) {
            connection.value.for_each_net(&mut |net| {
                nets.insert(net);
            });
        }
        for statement in self.processes.iter().flat_map(|p| &p.statements) {
            statement.for_each_target(&mut |net, _, _| {
                nets.insert(net);
            });
        }
        nets
    }

    /// Removes all other nets; nothing may mention them.
    pub(super) fn keep_nets(&mut self, used: &BTreeSet<NetId>) {
        let numbers = used.iter().enumerate();
        let map: BTreeMap<NetId, NetId> = numbers.map(|(new, old)| (*old, new)).collect();
        let nets = std::mem::take(&mut self.nets).into_iter().enumerate();
        let kept = nets.filter(|(net, _)| used.contains(net));
        self.nets = kept.map(|(_, net)| net).collect();
        self.renumber(&|net| map[&net]);
    }

    fn renumber(&mut self, map: &dyn Fn(NetId) -> NetId) {
        for statement in self.processes.iter_mut().flat_map(|p| &mut p.statements) {
            statement.for_each_net_mut(&mut |net| *net = map(*net));
        }
        for port in &mut self.ports {
            port.net = map(port.net);
        }
        for register in &mut self.registers {
            register.q = map(register.q);
            register.next = map(register.next);
            register.clock = map(register.clock);
            register.reset = register.reset.map(map);
        }
        for memory in &mut self.memories {
            memory.read_data = map(memory.read_data);
            memory.inputs_mut().for_each(|net| *net = map(*net));
        }
        for instance in &mut self.instances {
            for connection in &mut instance.connections {
                connection
                    .value
                    .for_each_net_mut(&mut |net| *net = map(*net));
            }
        }
    }
}
