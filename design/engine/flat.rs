//! A design without hierarchy: every net of every instance has a separate number.

use super::{EngineError, Port};
use crate::elaborate::{
    targets, Design, Direction, EnumId, Expr, ExprKind, Module, NetId, Process, Statement,
    WritePort,
};
use std::collections::{BTreeMap, BTreeSet};

/// A register; see [`crate::elaborate::Register`].
#[derive(Clone, Copy, Debug)]
pub(super) struct FlatRegister {
    pub q: usize,
    pub next: usize,
    pub reset: Option<usize>,
    pub start: u128,
}

/// A register on the falling edge, without reset: to all others it is an input that changes in the middle of the cycle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Falling {
    pub q: usize,
    pub next: usize,
}

/// A memory; see [`crate::elaborate::Memory`].
#[derive(Clone, Debug)]
pub(super) struct FlatMemory {
    pub read_address: usize,
    pub read_data: usize,
    pub write: Option<WritePort>,
    /// Every word at power-up.
    pub start: Vec<u128>,
}

impl FlatMemory {
    /// The nets that it reads.
    pub fn inputs(&self) -> impl Iterator<Item = usize> {
        let write = self.write.map(WritePort::nets);
        std::iter::once(self.read_address).chain(write.into_iter().flatten())
    }

    /// The nets that it reads, to be changed.
    pub fn inputs_mut(&mut self) -> impl Iterator<Item = &mut usize> {
        let write = self.write.as_mut().map(WritePort::nets_mut);
        std::iter::once(&mut self.read_address).chain(write.into_iter().flatten())
    }
}

/// A net.
#[derive(Clone, Debug)]
pub(super) struct FlatNet {
    /// Hierarchical name, with dots.
    pub name: String,
    pub width_bits: usize,
    pub enum_id: Option<EnumId>,
}

/// A process on the numbers of its nets.
pub(super) struct FlatProcess {
    pub statements: Vec<Statement>,
    pub parameters: Vec<u128>,
}

impl FlatProcess {
    pub fn targets(&self) -> BTreeSet<usize> {
        targets(&self.statements)
    }

    pub fn reads(&self) -> BTreeSet<usize> {
        let mut set = BTreeSet::new();
        for statement in &self.statements {
            statement.for_each_expr(&mut |expr| {
                expr.for_each_net(&mut |net| {
                    set.insert(net);
                });
            });
        }
        set
    }
}

/// The design without hierarchy.
pub(super) struct Flat {
    pub nets: Vec<FlatNet>,
    /// In an order in which each reads only what earlier ones drive.
    pub processes: Vec<FlatProcess>,
    pub registers: Vec<FlatRegister>,
    /// Registers on the falling edge.
    pub falling: Vec<Falling>,
    pub memories: Vec<FlatMemory>,
    /// All ports but the clocks.
    pub ports: Vec<Port>,
    /// The net of each of them.
    pub port_nets: Vec<usize>,
}

impl Flat {
    /// Flattens a design.
    ///
    /// # Errors
    /// If it has a combinational loop or a second clock.
    pub fn new(design: &Design) -> Result<Self, EngineError> {
        let mut builder = Builder {
            design,
            nets: vec![],
            processes: vec![],
            registers: vec![],
            falling: vec![],
            clocks: vec![],
            memories: vec![],
        };
        let top = design.top();
        let nets: Vec<usize> = top
            .nets
            .iter()
            .map(|n| builder.value(&n.name, n.width_bits, n.enum_id))
            .collect();
        builder.module(top, "", &nets);
        builder.check_clocks()?;
        let processes = builder.sorted()?;
        let ports = top.ports.iter().filter(|p| !p.is_clock);
        Ok(Self {
            port_nets: ports.clone().map(|p| nets[p.net]).collect(),
            ports: ports
                .map(|p| Port {
                    name: top.nets[p.net].name.clone(),
                    width_bits: top.nets[p.net].width_bits,
                    is_input: p.direction == Direction::Input,
                })
                .collect(),
            nets: builder.nets,
            processes,
            registers: builder.registers,
            falling: builder.falling,
            memories: builder.memories,
        })
    }
}

/// A flat design in the making.
struct Builder<'a> {
    design: &'a Design,
    nets: Vec<FlatNet>,
    processes: Vec<FlatProcess>,
    registers: Vec<FlatRegister>,
    falling: Vec<Falling>,
    /// Output and clock of each register and memory.
    clocks: Vec<(usize, usize)>,
    memories: Vec<FlatMemory>,
}

impl Builder<'_> {
    fn value(&mut self, name: &str, width_bits: usize, enum_id: Option<EnumId>) -> usize {
        self.nets.push(FlatNet {
            name: name.into(),
            width_bits,
            enum_id,
        });
        self.nets.len() - 1
    }

    /// Adds a module whose nets are the values `nets`.
    fn module(&mut self, module: &Module, path: &str, nets: &[usize]) {
        let parameters: Vec<u128> = module.parameters.iter().map(|p| p.value).collect();
        for Process { statements } in &module.processes {
            let mut statements = statements.clone();
            statements
                .iter_mut()
                .for_each(|s| s.for_each_net_mut(&mut |net| *net = nets[*net]));
            self.processes.push(FlatProcess {
                statements,
                parameters: parameters.clone(),
            });
        }
        for register in &module.registers {
            self.clocks.push((nets[register.q], nets[register.clock]));
            let (q, next) = (nets[register.q], nets[register.next]);
            if register.on_fall {
                self.falling.push(Falling { q, next });
                continue;
            }
            self.registers.push(FlatRegister {
                q,
                next,
                reset: register.reset.map(|net| nets[net]),
                start: register.start,
            });
        }
        for memory in &module.memories {
            self.clocks
                .push((nets[memory.read_data], nets[memory.clock]));
            let mut flat = FlatMemory {
                read_address: memory.read_address,
                read_data: nets[memory.read_data],
                write: memory.write,
                start: memory.start_words(),
            };
            flat.inputs_mut().for_each(|net| *net = nets[*net]);
            self.memories.push(flat);
        }
        for instance in &module.instances {
            let child = &self.design.modules[instance.module];
            let child_path = format!("{path}{}.", instance.name);
            let mut connected: BTreeMap<NetId, usize> = BTreeMap::new();
            for (port, connection) in child.ports.iter().zip(&instance.connections) {
                let connection = &connection.value;
                let value = match connection.kind {
                    ExprKind::Net(net) => nets[net],
                    _ => {
                        self.connection(connection, nets, &parameters, &child_path, child, port.net)
                    }
                };
                connected.insert(port.net, value);
            }
            let child_nets: Vec<usize> = child
                .nets
                .iter()
                .enumerate()
                .map(|(net, n)| match connected.get(&net) {
                    Some(value) => *value,
                    None => self.value(&format!("{child_path}{}", n.name), n.width_bits, n.enum_id),
                })
                .collect();
            self.module(child, &child_path, &child_nets);
        }
    }

    /// A value for an input that is connected to a constant or a part of a net.
    fn connection(
        &mut self,
        connection: &Expr,
        nets: &[usize],
        parameters: &[u128],
        path: &str,
        child: &Module,
        port: NetId,
    ) -> usize {
        let net = self.value(
            &format!("{path}{}", child.nets[port].name),
            connection.width_bits,
            child.nets[port].enum_id,
        );
        let mut value = connection.clone();
        value.for_each_net_mut(&mut |net| *net = nets[*net]);
        self.processes.push(FlatProcess {
            statements: vec![Statement::Assign {
                docs: vec![],
                net,
                low_bit: 0,
                value,
            }],
            parameters: parameters.to_vec(),
        });
        net
    }

    fn check_clocks(&self) -> Result<(), EngineError> {
        let Some((_, first)) = self.clocks.first() else {
            return Ok(());
        };
        match self.clocks.iter().find(|(_, clock)| clock != first) {
            Some((output, clock)) => Err(EngineError::SecondClock {
                register: self.nets[*output].name.clone(),
                clock: self.nets[*clock].name.clone(),
            }),
            None => Ok(()),
        }
    }

    /// Takes the processes, in an order in which each reads only what earlier ones drive.
    fn sorted(&mut self) -> Result<Vec<FlatProcess>, EngineError> {
        let order = sorted(&self.processes).map_err(|nets| {
            let names = nets.into_iter().map(|net| self.nets[net].name.clone());
            EngineError::Loop(names.collect())
        })?;
        let mut processes: Vec<Option<FlatProcess>> = std::mem::take(&mut self.processes)
            .into_iter()
            .map(Some)
            .collect();
        Ok(order
            .into_iter()
            .filter_map(|index| processes[index].take())
            .collect())
    }
}

/// An order in which every process comes after those it reads, or the nets of a loop.
fn sorted(processes: &[FlatProcess]) -> Result<Vec<usize>, Vec<usize>> {
    let mut drivers: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for (index, process) in processes.iter().enumerate() {
        for net in process.targets() {
            drivers.entry(net).or_default().insert(index);
        }
    }
    let sources: Vec<BTreeSet<usize>> = processes
        .iter()
        .enumerate()
        .map(|(index, process)| {
            let own = process.targets();
            let read = process.reads().into_iter().filter(|net| !own.contains(net));
            let mut sources: BTreeSet<usize> = read
                .filter_map(|net| drivers.get(&net))
                .flatten()
                .copied()
                .collect();
            sources.remove(&index);
            sources
        })
        .collect();
    let mut state = vec![0u8; processes.len()]; // 0 new, 1 open, 2 done
    let mut order = vec![];
    for start in 0..processes.len() {
        let mut stack = vec![(start, sources[start].iter())];
        if state[start] != 0 {
            continue;
        }
        state[start] = 1;
        while let Some((index, rest)) = stack.last_mut() {
            match rest.next() {
                Some(&source) if state[source] == 0 => {
                    state[source] = 1;
                    stack.push((source, sources[source].iter()));
                }
                Some(&source) if state[source] == 1 => {
                    let from = stack.iter().position(|(i, _)| *i == source).unwrap_or(0);
                    let open = stack[from..].iter().map(|(i, _)| *i);
                    return Err(open
                        .filter_map(|i| processes[i].targets().into_iter().next())
                        .collect());
                }
                Some(_) => {}
                None => {
                    state[*index] = 2;
                    order.push(*index);
                    stack.pop();
                }
            }
        }
    }
    Ok(order)
}
