//! The simple engine: executes a [`Design`] without transformation, cycle by cycle.
//!
//! The hierarchy is flattened once, processes are put into an order in which each reads only what is already
//! settled, and every statement becomes a few operations on numbered values.

use super::flat::{Falling, Flat, FlatMemory, FlatRegister};
use super::program::{Compiler, Program};
use super::{Engine, EngineError, Port, PortId};
use crate::elaborate::{mask, Design};
use std::sync::Arc;

/// Runs a [`Design`]. A clone goes on from the same state, apart from the original.
#[derive(Clone)]
pub struct Interpreter {
    ports: Vec<Port>,
    /// Value index of each port.
    port_values: Vec<usize>,
    values: Vec<u128>,
    program: Arc<Program>,
    registers: Arc<[FlatRegister]>,
    falling: Arc<[Falling]>,
    has_fallen: bool,
    /// New register contents, while a clock edge is computed.
    next: Vec<u128>,
    memories: Vec<Memory>,
    names: Arc<[String]>,
    /// Processes to run again before anything is read.
    stale: Vec<bool>,
    is_settled: bool,
}

#[derive(Clone)]
struct Memory {
    nets: FlatMemory,
    words: Vec<u128>,
}

impl Interpreter {
    /// Prepares a design for execution; its registers hold their start values.
    ///
    /// # Errors
    /// If it has a combinational loop or a second clock.
    pub fn new(design: &Design) -> Result<Self, EngineError> {
        let flat = Flat::new(design)?;
        let mut compiler = Compiler::new(flat.nets.iter().map(|n| n.width_bits).collect());
        for process in &flat.processes {
            compiler.process(
                &process.statements,
                &process.parameters,
                &process.reads(),
                process.targets(),
            );
        }
        let program = compiler.finish();
        let mut values = vec![0; program.value_count];
        for (index, value) in &program.constants {
            values[*index] = *value;
        }
        for register in &flat.registers {
            values[register.q] = register.start;
        }
        let memory = |nets: FlatMemory| Memory {
            words: nets.start.clone(),
            nets,
        };
        Ok(Self {
            ports: flat.ports,
            port_values: flat.port_nets,
            next: vec![0; flat.registers.len()],
            values,
            stale: program.all_stale(),
            program: program.into(),
            registers: flat.registers.into(),
            falling: flat.falling.into(),
            has_fallen: false,
            memories: flat.memories.into_iter().map(memory).collect(),
            names: flat.nets.into_iter().map(|n| n.name).collect(),
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

    fn fall(&mut self) {
        self.has_fallen = true;
        self.settle();
        for Falling { q, next } in self.falling.clone().iter() {
            if self.values[*q] != self.values[*next] {
                self.values[*q] = self.values[*next];
                self.program.changed(*q, &mut self.stale);
                self.is_settled = false;
            }
        }
    }

    fn tick(&mut self) {
        if !std::mem::take(&mut self.has_fallen) && !self.falling.is_empty() {
            self.fall();
            self.has_fallen = false;
        }
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
        for Memory { nets, words } in &mut self.memories {
            read.push((nets.read_data, words[values[nets.read_address] as usize]));
            if let Some(write) = nets.write.filter(|write| values[write.enable] != 0) {
                words[values[write.address] as usize] = values[write.data];
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
