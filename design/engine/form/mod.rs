//! Executable form: segments of pure expressions and groups of registers, with their readers.
//!
//! A cycle is: settle (run every segment one of whose nets has changed, in order), then commit (load every register of each
//! group whose inputs have changed). Unchanged parts are not computed again, and the result is the same: a segment gives
//! the same values for the same nets, and a register that was loaded holds its input.
//!
//! On the way here the hierarchy is gone, numbers are folded, nets that only rename others are replaced, and logic that
//! nothing observable depends on is dropped.

mod build;
mod graph;

pub use graph::{evaluate, Node, NodeId, Op};

use super::flat::{Falling, Flat, FlatMemory, FlatNet, FlatRegister};
use super::instrument::{fit, Fitted, Instruments};
use super::{EngineError, Port};
use crate::elaborate::Design;
use build::Known;
use std::collections::BTreeMap;

/// Nets that must stay observable in addition to the outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Keep {
    /// Only the outputs: the fastest.
    #[default]
    Outputs,
    /// Every register as well.
    Registers,
    /// Every net as well.
    Nets,
}

/// Expressions that are computed together.
#[derive(Clone, Debug)]
pub(super) struct Segment {
    pub nodes: Vec<Node>,
    /// Nets that it drives, each with its node.
    pub writes: Vec<(usize, NodeId)>,
}

impl Segment {
    /// The nets that it reads.
    pub fn reads(&self) -> impl Iterator<Item = usize> + '_ {
        self.nodes.iter().filter_map(|node| match node.op {
            Op::Net(net) => Some(net),
            _ => None,
        })
    }
}

/// Registers that are loaded together, or a memory.
#[derive(Clone, Debug)]
pub(super) enum Commit {
    /// Registers; none of their inputs is the output of a register.
    Registers(Vec<FlatRegister>),
    /// Index in [`Form::memories`].
    Memory(usize),
}

/// A design, ready to be run.
#[derive(Clone, Debug)]
pub(super) struct Form {
    pub nets: Vec<FlatNet>,
    /// Each reads only what earlier ones drive.
    pub segments: Vec<Segment>,
    pub commits: Vec<Commit>,
    /// No input of a memory is the output of a register or memory.
    pub memories: Vec<FlatMemory>,
    /// All registers that were not dropped.
    pub registers: Vec<FlatRegister>,
    pub falling: Vec<Falling>,
    /// Stored nets.
    pub is_stored: Vec<bool>,
    /// Value of each net that is not stored: another net, or a number.
    known: Vec<Known>,
    /// For each net the segments and the commits to run when it changes.
    pub readers: Vec<Vec<usize>>,
    pub commit_readers: Vec<Vec<usize>>,
    pub ports: Vec<Port>,
    pub port_nets: Vec<usize>,
    pub instruments: Fitted,
}

/// Where the value of a net is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// With this net.
    Net(usize),
    /// It is always this number.
    Constant(u128),
    /// Nowhere: it was dropped.
    Dropped,
}

impl Form {
    /// Brings a design into this form.
    ///
    /// # Errors
    /// If it has a combinational loop or a second clock, or a net for an instrument is not there.
    pub fn new(
        design: &Design,
        keep: Keep,
        instruments: &Instruments,
    ) -> Result<Self, EngineError> {
        let mut flat = Flat::new(design)?;
        let fitted = fit(&mut flat, design, instruments)?;
        let copies = separate_inputs(&mut flat);
        let is_input = inputs_of_state(&flat);
        let mut known: Vec<Known> = (0..flat.nets.len()).map(Known::Net).collect();
        for net in undriven(&flat, &copies, &fitted) {
            known[net] = Known::Constant(0);
        }
        let mut segments = vec![];
        for process in &flat.processes {
            let (graph, values) = build::process(&flat, process, &known);
            let mut writes = vec![];
            for (net, node) in values {
                match graph.nodes[node].op {
                    Op::Constant(value) if !is_input[net] => known[net] = Known::Constant(value),
                    Op::Net(source) if !is_input[net] && keep != Keep::Nets => {
                        known[net] = Known::Net(source)
                    }
                    _ => writes.push((net, node)),
                }
            }
            segments.push(Segment {
                nodes: graph.nodes,
                writes,
            });
        }
        for (from, to) in copies {
            let width_bits = flat.nets[to].width_bits;
            let op = Op::Net(from);
            segments.push(Segment {
                nodes: vec![Node { op, width_bits }],
                writes: vec![(to, 0)],
            });
        }
        for register in &mut flat.registers {
            register.reset = register
                .reset
                .filter(|reset| known[*reset] != Known::Constant(0));
        }
        let mut form = Self {
            readers: vec![vec![]; flat.nets.len()],
            commit_readers: vec![vec![]; flat.nets.len()],
            is_stored: vec![false; flat.nets.len()],
            nets: flat.nets,
            segments,
            commits: vec![],
            memories: flat.memories,
            registers: flat.registers,
            falling: flat.falling,
            known,
            ports: flat.ports,
            port_nets: flat.port_nets,
            instruments: fitted,
        };
        form.drop_dead(keep);
        form.group();
        form.connect();
        Ok(form)
    }

    /// Where the value of a net is found.
    pub fn place(&self, net: usize) -> Place {
        match self.known[net] {
            Known::Constant(value) => Place::Constant(value),
            Known::Net(net) if self.is_stored[net] => Place::Net(net),
            Known::Net(_) => Place::Dropped,
        }
    }

    fn roots(&self, keep: Keep) -> Vec<usize> {
        let mut roots = self.port_nets.clone();
        roots.extend(self.falling.iter().flat_map(|f| [f.q, f.next]));
        roots.extend(self.instruments.inputs());
        roots.extend(self.instruments.observed());
        if keep != Keep::Outputs {
            roots.extend(self.registers.iter().map(|r| r.q));
            roots.extend(self.memories.iter().map(|m| m.read_data));
        }
        if keep == Keep::Nets {
            roots.extend(0..self.nets.len());
        }
        roots
            .into_iter()
            .filter_map(|net| match self.known[net] {
                Known::Net(net) => Some(net),
                Known::Constant(_) => None,
            })
            .collect()
    }

    /// Drops nodes, registers and memories on which nothing kept depends.
    fn drop_dead(&mut self, keep: Keep) {
        let mut driver: BTreeMap<usize, (usize, NodeId)> = BTreeMap::new();
        for (index, segment) in self.segments.iter().enumerate() {
            for (net, node) in &segment.writes {
                driver.insert(*net, (index, *node));
            }
        }
        let register_of: BTreeMap<usize, FlatRegister> =
            self.registers.iter().map(|r| (r.q, *r)).collect();
        let memory_of: BTreeMap<usize, usize> = (self
            .memories
            .iter()
            .enumerate()
            .map(|(i, m)| (m.read_data, i)))
        .collect();
        let mut is_used: Vec<Vec<bool>> = self
            .segments
            .iter()
            .map(|s| vec![false; s.nodes.len()])
            .collect();
        let mut open = self.roots(keep);
        while let Some(net) = open.pop() {
            if std::mem::replace(&mut self.is_stored[net], true) {
                continue;
            }
            if let Some(register) = register_of.get(&net) {
                open.push(register.next);
                open.extend(register.reset);
            }
            if let Some(memory) = memory_of.get(&net) {
                open.extend(self.memories[*memory].inputs());
            }
            if let Some((segment, node)) = driver.get(&net) {
                let nodes = &self.segments[*segment].nodes;
                let mut pending = vec![*node];
                while let Some(node) = pending.pop() {
                    if !std::mem::replace(&mut is_used[*segment][node], true) {
                        pending.extend(nodes[node].op.operands());
                        if let Op::Net(source) = nodes[node].op {
                            open.push(source);
                        }
                    }
                }
            }
        }
        for (segment, is_used) in self.segments.iter_mut().zip(&is_used) {
            segment.retain(is_used, &self.is_stored);
        }
        self.segments.retain(|s| !s.writes.is_empty());
        let is_stored = &self.is_stored;
        self.registers.retain(|r| is_stored[r.q]);
        self.memories.retain(|m| is_stored[m.read_data]);
    }

    /// Registers whose inputs come from one segment, and that have one reset, are loaded together.
    fn group(&mut self) {
        let mut segment_of = BTreeMap::new();
        for (index, segment) in self.segments.iter().enumerate() {
            segment_of.extend(segment.writes.iter().map(|(net, _)| (*net, index)));
        }
        let mut groups: BTreeMap<_, Vec<FlatRegister>> = BTreeMap::new();
        for register in &self.registers {
            let key = (segment_of.get(&register.next), register.reset);
            groups.entry(key).or_default().push(*register);
        }
        self.commits = groups.into_values().map(Commit::Registers).collect();
        self.commits
            .extend((0..self.memories.len()).map(Commit::Memory));
    }

    fn connect(&mut self) {
        for (index, segment) in self.segments.iter().enumerate() {
            segment
                .reads()
                .for_each(|net| self.readers[net].push(index));
        }
        for (index, commit) in self.commits.iter().enumerate() {
            let nets: Vec<usize> = match commit {
                Commit::Registers(registers) => registers
                    .iter()
                    .flat_map(|r| [Some(r.next), r.reset])
                    .flatten()
                    .collect(),
                Commit::Memory(memory) => self.memories[*memory].inputs().collect(),
            };
            nets.into_iter()
                .for_each(|net| self.commit_readers[net].push(index));
        }
        for list in self.readers.iter_mut().chain(&mut self.commit_readers) {
            list.sort_unstable();
            list.dedup();
        }
    }
}

impl Segment {
    /// Keeps the nodes in use, and the writes of stored nets.
    fn retain(&mut self, is_used: &[bool], is_stored: &[bool]) {
        let mut place = vec![0; self.nodes.len()];
        let mut nodes = vec![];
        for (index, node) in self.nodes.iter().enumerate() {
            if is_used[index] {
                place[index] = nodes.len();
                nodes.push(Node {
                    op: node.op.moved(|n| place[n]),
                    ..*node
                });
            }
        }
        self.nodes = nodes;
        self.writes.retain(|(net, _)| is_stored[*net]);
        self.writes
            .iter_mut()
            .for_each(|(_, node)| *node = place[*node]);
    }
}

/// Which nets a register or memory takes over at a clock edge, or is controlled by.
fn inputs_of_state(flat: &Flat) -> Vec<bool> {
    let mut is_input = vec![false; flat.nets.len()];
    let registers = flat.registers.iter().flat_map(|r| [Some(r.next), r.reset]);
    for net in registers.flatten() {
        is_input[net] = true;
    }
    for net in flat.memories.iter().flat_map(FlatMemory::inputs) {
        is_input[net] = true;
    }
    is_input
}

/// Gives separate nets to inputs of registers and memories that are outputs of others, so that the loading order
/// does not matter. Returns pairs of a net and its copy.
fn separate_inputs(flat: &mut Flat) -> Vec<(usize, usize)> {
    let mut is_state = vec![false; flat.nets.len()];
    flat.registers.iter().for_each(|r| is_state[r.q] = true);
    flat.memories
        .iter()
        .for_each(|m| is_state[m.read_data] = true);
    let mut copies: BTreeMap<usize, usize> = BTreeMap::new();
    let nets = &mut flat.nets;
    let mut separate = |net: &mut usize| {
        if is_state[*net] {
            let copy = *copies.entry(*net).or_insert_with(|| {
                nets.push(nets[*net].clone());
                nets.len() - 1
            });
            *net = copy;
        }
    };
    for register in &mut flat.registers {
        separate(&mut register.next);
        register.reset.iter_mut().for_each(&mut separate);
    }
    let memories = flat.memories.iter_mut();
    memories.flat_map(FlatMemory::inputs_mut).for_each(separate);
    copies.into_iter().collect()
}

/// Nets that nothing drives: they are 0.
fn undriven(flat: &Flat, copies: &[(usize, usize)], fitted: &Fitted) -> Vec<usize> {
    let mut is_driven = vec![false; flat.nets.len()];
    let mut drive = |net: usize| is_driven[net] = true;
    flat.registers.iter().for_each(|r| drive(r.q));
    flat.memories.iter().for_each(|m| drive(m.read_data));
    flat.falling.iter().for_each(|f| drive(f.q));
    copies.iter().for_each(|(_, to)| drive(*to));
    fitted.inputs().for_each(&mut drive);
    let inputs = flat.ports.iter().zip(&flat.port_nets);
    inputs
        .filter(|(port, _)| port.is_input)
        .for_each(|(_, net)| drive(*net));
    for process in &flat.processes {
        process.targets().into_iter().for_each(&mut drive);
    }
    (0..flat.nets.len())
        .filter(|net| !is_driven[*net])
        .collect()
}
