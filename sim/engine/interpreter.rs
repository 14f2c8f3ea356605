//! The plain engine: executes a [`Design`] as it stands, cycle by cycle.
//!
//! The hierarchy is flattened once, processes are put into an order in which each reads only what is already
//! settled, and every statement becomes a few operations on numbered values.

use super::program::{Compiler, Program};
use super::{Engine, Port, PortId};
use endat_hdl::elaborate::{
    mask, Design, Direction, Expr, ExprKind, Module, NetId, Process, Statement,
};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Why a design cannot be interpreted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InterpreterError {
    /// Nets that depend on each other without a register between them.
    #[error("combinational loop: {}: put a register into it", .0.join(" -> "))]
    Loop(Vec<String>),
    /// A register has another clock than the first one.
    #[error("register {register}: clock = {clock}: the interpreter runs one clock; use one clock input for all registers")]
    SecondClock {
        /// Hierarchical name of the register.
        register: String,
        /// Its clock.
        clock: String,
    },
}

/// Runs a [`Design`]. A clone goes on from the same state, apart from the original.
#[derive(Clone)]
pub struct Interpreter {
    ports: Vec<Port>,
    /// Value index of each port.
    port_values: Vec<usize>,
    values: Vec<u128>,
    program: Arc<Program>,
    registers: Arc<[FlatRegister]>,
    /// New register contents, while a clock edge is computed.
    next: Vec<u128>,
    memories: Vec<FlatMemory>,
    names: Arc<[String]>,
    /// Processes to run again before anything is read.
    stale: Vec<bool>,
    is_settled: bool,
}

struct FlatRegister {
    q: usize,
    next: usize,
    reset: Option<usize>,
    start: u128,
}

#[derive(Clone)]
struct FlatMemory {
    read_address: usize,
    read_data: usize,
    write_enable: usize,
    write_address: usize,
    write_data: usize,
    words: Vec<u128>,
}

impl Interpreter {
    /// Prepares a design for execution; its registers hold their start values.
    ///
    /// # Errors
    /// If it has a combinational loop or a second clock.
    pub fn new(design: &Design) -> Result<Self, InterpreterError> {
        let mut flat = Flat {
            design,
            names: vec![],
            widths: vec![],
            processes: vec![],
            registers: vec![],
            clocks: vec![],
            memories: vec![],
        };
        let top = design.top();
        let nets: Vec<usize> = top
            .nets
            .iter()
            .map(|n| flat.value(&n.name, n.width_bits))
            .collect();
        flat.module(top, "", &nets);
        flat.check_clocks()?;
        let program = flat.compile()?;
        let ports = top.ports.iter().filter(|p| !p.is_clock);
        let mut values = vec![0; program.value_count];
        for (index, value) in &program.constants {
            values[*index] = *value;
        }
        for register in &flat.registers {
            values[register.q] = register.start;
        }
        Ok(Self {
            port_values: ports.clone().map(|p| nets[p.net]).collect(),
            ports: ports
                .map(|p| Port {
                    name: top.nets[p.net].name.clone(),
                    width_bits: top.nets[p.net].width_bits,
                    is_input: p.direction == Direction::Input,
                })
                .collect(),
            next: vec![0; flat.registers.len()],
            values,
            stale: program.all_stale(),
            program: program.into(),
            registers: flat.registers.into(),
            memories: flat.memories,
            names: flat.names.into(),
            is_settled: false,
        })
    }

    /// Hierarchical names of all nets, in the order of [`Interpreter::peek`].
    pub fn nets(&self) -> &[String] {
        &self.names
    }

    /// The settled value of any net, by its index in [`Interpreter::nets`].
    pub fn peek(&mut self, net: usize) -> u128 {
        self.settle();
        self.values[net]
    }

    fn settle(&mut self) {
        if !self.is_settled {
            self.program.run(&mut self.values, &mut self.stale);
            self.is_settled = true;
        }
    }
}

impl Engine for Interpreter {
    fn ports(&self) -> &[Port] {
        &self.ports
    }

    fn set(&mut self, port: PortId, value: u128) {
        let value = value & mask(self.ports[port.0].width_bits);
        let net = self.port_values[port.0];
        if self.values[net] != value {
            self.values[net] = value;
            self.program.changed(net, &mut self.stale);
            self.is_settled = false;
        }
    }

    fn get(&mut self, port: PortId) -> u128 {
        self.settle();
        self.values[self.port_values[port.0]]
    }

    fn tick(&mut self) {
        self.settle();
        let values = &mut self.values;
        for (next, register) in self.next.iter_mut().zip(&*self.registers) {
            let is_reset = register.reset.is_some_and(|reset| values[reset] != 0);
            *next = if is_reset {
                register.start
            } else {
                values[register.next]
            };
        }
        // A memory reads nothing but settled values, and its output is not read before all edges are done.
        let mut read = vec![];
        for memory in &mut self.memories {
            read.push((
                memory.read_data,
                memory.words[values[memory.read_address] as usize],
            ));
            if values[memory.write_enable] != 0 {
                memory.words[values[memory.write_address] as usize] = values[memory.write_data];
            }
        }
        for (next, register) in self.next.iter().zip(&*self.registers) {
            if values[register.q] != *next {
                values[register.q] = *next;
                self.program.changed(register.q, &mut self.stale);
            }
        }
        for (net, word) in read {
            if values[net] != word {
                values[net] = word;
                self.program.changed(net, &mut self.stale);
            }
        }
        self.is_settled = false;
    }
}

/// A process with the values that its nets became.
struct FlatProcess {
    statements: Vec<Statement>,
    parameters: Vec<u128>,
}

impl FlatProcess {
    fn targets(&self) -> BTreeSet<usize> {
        let mut set = BTreeSet::new();
        for statement in &self.statements {
            statement.for_each_target(&mut |net, _, _| {
                set.insert(net);
            });
        }
        set
    }

    fn reads(&self) -> BTreeSet<usize> {
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
struct Flat<'a> {
    design: &'a Design,
    names: Vec<String>,
    widths: Vec<usize>,
    processes: Vec<FlatProcess>,
    registers: Vec<FlatRegister>,
    /// Output and clock of each register and memory.
    clocks: Vec<(usize, usize)>,
    memories: Vec<FlatMemory>,
}

impl Flat<'_> {
    fn value(&mut self, name: &str, width_bits: usize) -> usize {
        self.names.push(name.into());
        self.widths.push(width_bits);
        self.names.len() - 1
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
            self.registers.push(FlatRegister {
                q: nets[register.q],
                next: nets[register.next],
                reset: register.reset.map(|net| nets[net]),
                start: register.start,
            });
        }
        for memory in &module.memories {
            self.clocks
                .push((nets[memory.read_data], nets[memory.clock]));
            self.memories.push(FlatMemory {
                read_address: nets[memory.read_address],
                read_data: nets[memory.read_data],
                write_enable: nets[memory.write_enable],
                write_address: nets[memory.write_address],
                write_data: nets[memory.write_data],
                words: vec![0; memory.words],
            });
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
                    None => self.value(&format!("{child_path}{}", n.name), n.width_bits),
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
        );
        let mut value = connection.clone();
        value.for_each_net_mut(&mut |net| *net = nets[*net]);
        self.processes.push(FlatProcess {
            statements: vec![Statement::Assign {
                net,
                low_bit: 0,
                value,
            }],
            parameters: parameters.to_vec(),
        });
        net
    }

    fn check_clocks(&self) -> Result<(), InterpreterError> {
        let Some((_, first)) = self.clocks.first() else {
            return Ok(());
        };
        match self.clocks.iter().find(|(_, clock)| clock != first) {
            Some((output, clock)) => Err(InterpreterError::SecondClock {
                register: self.names[*output].clone(),
                clock: self.names[*clock].clone(),
            }),
            None => Ok(()),
        }
    }

    fn compile(&self) -> Result<Program, InterpreterError> {
        let order = sorted(&self.processes).map_err(|nets| {
            InterpreterError::Loop(
                nets.into_iter()
                    .map(|net| self.names[net].clone())
                    .collect(),
            )
        })?;
        let mut compiler = Compiler::new(self.widths.clone());
        for index in order {
            let process = &self.processes[index];
            compiler.process(
                &process.statements,
                &process.parameters,
                &process.reads(),
                process.targets(),
            );
        }
        Ok(compiler.finish())
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
