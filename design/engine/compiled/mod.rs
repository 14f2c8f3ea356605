//! The fast engine: a design as native code.

pub(in crate::engine) mod layout;
pub(in crate::engine) mod native;
mod portable;
mod words;

use super::flat::Falling;
use super::form::{Form, Keep, Place};
use super::{Engine, EngineError, Instruments, Port, PortId};
use crate::elaborate::{mask, Design, WritePort};
use layout::Layout;
pub use native::has_native_code;
use native::Native;
use std::sync::Arc;

/// Executor of the form.
#[derive(Clone)]
enum Code {
    Native(Native),
    Portable,
}

/// Runs a [`Design`] as native code. A clone goes on from the same state, apart from the original.
#[derive(Clone)]
pub struct Compiled {
    form: Arc<Form>,
    layout: Arc<Layout>,
    code: Code,
    /// Why there is no native code, if there is none.
    fallback: Option<Arc<str>>,
    state: Vec<u64>,
    memories: Vec<Vec<u128>>,
    is_settled: bool,
    has_fallen: bool,
}

/// Everything that a running design remembers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Saved {
    state: Vec<u64>,
    memories: Vec<Vec<u128>>,
}

/// Activity of a register or port.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NetCoverage {
    /// Hierarchical name.
    pub name: String,
    /// Width.
    pub width_bits: usize,
    /// Bits that have risen.
    pub rose: u128,
    /// Bits that have fallen.
    pub fell: u128,
    /// For a register that holds a state: every state, and whether it was reached.
    pub states: Option<Vec<(String, bool)>>,
}

impl Compiled {
    /// Compiles a design of which only the outputs can be seen; its registers hold their start values.
    ///
    /// # Errors
    /// If it has a combinational loop or a second clock.
    pub fn new(design: &Design) -> Result<Self, EngineError> {
        Self::keeping(design, Keep::Outputs)
    }

    /// Compiles a design; `keep` says what can be seen.
    ///
    /// # Errors
    /// If it has a combinational loop or a second clock.
    pub fn keeping(design: &Design, keep: Keep) -> Result<Self, EngineError> {
        Self::instrumented(design, keep, &Instruments::default())
    }

    /// Compiles a design with instruments.
    ///
    /// # Errors
    /// If it has a combinational loop or a second clock, or a net for an instrument is not there.
    pub fn instrumented(
        design: &Design,
        keep: Keep,
        instruments: &Instruments,
    ) -> Result<Self, EngineError> {
        let form = Form::new(design, keep, instruments)?;
        let layout = words::layout(&form);
        let native = Native::compile(&form, &layout, &words::Words(&form));
        Ok(Self::on(form, layout, native))
    }

    /// The same without native code, as on a platform that the code generator does not know.
    ///
    /// # Errors
    /// If it has a combinational loop or a second clock.
    pub fn portable(design: &Design, keep: Keep) -> Result<Self, EngineError> {
        let form = Form::new(design, keep, &Instruments::default())?;
        let layout = words::layout(&form);
        Ok(Self::on(form, layout, Err("asked for".into())))
    }

    fn on(form: Form, layout: Layout, native: Result<Native, String>) -> Self {
        let mut state = vec![0; layout.words];
        for register in &form.registers {
            portable::store(&layout, &form, &mut state, register.q, register.start);
        }
        layout.mark_all(&mut state);
        let (code, fallback) = match native {
            Ok(native) => (Code::Native(native), None),
            Err(why) => (Code::Portable, Some(why.into())),
        };
        Self {
            memories: form.memories.iter().map(|m| m.start.clone()).collect(),
            form: form.into(),
            layout: layout.into(),
            code,
            fallback,
            state,
            is_settled: false,
            has_fallen: false,
        }
    }

    /// Why this runs in an interpreter instead of native code, if it does.
    pub fn fallback(&self) -> Option<&str> {
        self.fallback.as_deref()
    }

    /// Hierarchical names of all nets, dropped ones included.
    pub fn nets(&self) -> impl ExactSizeIterator<Item = &str> {
        self.form.nets.iter().map(|n| n.name.as_str())
    }

    /// The settled value of a net, by its index in [`Compiled::nets`]; `None` if it was dropped.
    pub fn peek(&mut self, net: usize) -> Option<u128> {
        match self.form.place(net) {
            Place::Constant(value) => Some(value),
            Place::Dropped => None,
            Place::Net(net) => {
                self.settle();
                Some(portable::value(&self.layout, &self.form, &self.state, net))
            }
        }
    }

    /// The registers that were not dropped, as indices of their outputs in [`Compiled::nets`].
    pub fn registers(&self) -> impl ExactSizeIterator<Item = usize> + '_ {
        self.form.registers.iter().map(|r| r.q)
    }

    /// Width of a net, by its index in [`Compiled::nets`].
    pub fn width_bits(&self, net: usize) -> usize {
        self.form.nets[net].width_bits
    }

    /// Flips a bit of a register, as an upset would; by the index of its output in [`Compiled::nets`].
    ///
    /// # Panics
    /// If it is no register that was kept, or has no such bit.
    pub fn flip(&mut self, register: usize, bit: usize) {
        assert!(
            bit < self.form.nets[register].width_bits
                && self.form.registers.iter().any(|r| r.q == register),
            "net {register} has no register bit {bit}"
        );
        self.settle();
        let value = portable::value(&self.layout, &self.form, &self.state, register);
        let flipped = value ^ (1 << bit);
        portable::store(&self.layout, &self.form, &mut self.state, register, flipped);
        // It is loaded again even if its input stays as it was.
        if let Some(found) = self.form.registers.iter().find(|r| r.q == register) {
            self.layout.mark_commits(&mut self.state, found.next);
        }
        self.is_settled = false;
    }

    /// Everything that the design remembers, inputs included.
    pub fn save(&self) -> Saved {
        Saved {
            state: self.state.clone(),
            memories: self.memories.clone(),
        }
    }

    /// Goes back to a saved state.
    ///
    /// # Panics
    /// If it was saved from another design.
    pub fn restore(&mut self, saved: &Saved) {
        assert_eq!(
            saved.state.len(),
            self.state.len(),
            "saved from another design"
        );
        self.state.copy_from_slice(&saved.state);
        self.memories.clone_from(&saved.memories);
        self.is_settled = false;
    }

    /// The net of a hierarchical name.
    pub fn net(&self, name: &str) -> Option<usize> {
        self.form.nets.iter().position(|n| n.name == name)
    }

    /// Forces the bits of a net that are set in `mask` to those of `value`; a mask of 0 lets go.
    ///
    /// # Panics
    /// If the net was not named in [`Instruments::forced`].
    pub fn force(&mut self, net: usize, mask: u128, value: u128) {
        let force = self.form.instruments.forces.get(&net);
        let force = *force.unwrap_or_else(|| panic!("net {net} cannot be forced"));
        let bits = mask & crate::elaborate::mask(self.form.nets[net].width_bits);
        for (net, value) in [(force.mask, bits), (force.value, value & bits)] {
            portable::store(&self.layout, &self.form, &mut self.state, net, value);
        }
        self.is_settled = false;
    }

    /// Activity of registers and ports so far, if [`Instruments::coverage`] is built in.
    pub fn coverage(&mut self) -> Vec<NetCoverage> {
        let form = self.form.clone();
        let covered = form.instruments.covered.iter();
        let read = |this: &mut Self, net| this.peek(net).unwrap_or(0);
        covered
            .map(|c| NetCoverage {
                name: form.nets[c.net].name.clone(),
                width_bits: form.nets[c.net].width_bits,
                rose: read(self, c.rose),
                fell: read(self, c.fell),
                states: c.states.as_ref().map(|(net, names)| {
                    let seen = read(self, *net);
                    let states = names.iter().enumerate();
                    states
                        .map(|(index, name)| (name.clone(), seen >> index & 1 == 1))
                        .collect()
                }),
            })
            .collect()
    }

    /// Runs until a condition on the engine holds after a cycle; false if it has not within `cycles`.
    pub fn run_until(&mut self, cycles: u64, mut stop: impl FnMut(&mut Self) -> bool) -> bool {
        for _ in 0..cycles {
            self.tick();
            if stop(self) {
                return true;
            }
        }
        false
    }

    fn settle(&mut self) {
        if self.is_settled {
            return;
        }
        match &self.code {
            Code::Native(native) => native.settle(&mut self.state),
            Code::Portable => portable::settle(&self.form, &self.layout, &mut self.state),
        }
        self.is_settled = true;
    }

    /// Reads and writes the memories whose inputs have changed. Their inputs stay as they are until everything is loaded.
    fn serve_memories(&mut self) {
        let mut next = 0;
        while let Some(index) = self.layout.take_memory(&mut self.state, next) {
            next = index + 1;
            let nets = &self.form.memories[index];
            let (layout, form) = (&self.layout, &self.form);
            let value = |net, state: &[u64]| portable::value(layout, form, state, net);
            let words = &mut self.memories[index];
            let read = words[value(nets.read_address, &self.state) as usize];
            let is_written = |write: &WritePort| value(write.enable, &self.state) != 0;
            if let Some(write) = nets.write.filter(is_written) {
                let address = value(write.address, &self.state) as usize;
                words[address] = value(write.data, &self.state);
                // The next cycle may read what was written.
                layout.mark_memory(&mut self.state, index);
            }
            portable::store(layout, form, &mut self.state, nets.read_data, read);
        }
    }
}

impl Engine for Compiled {
    fn ports(&self) -> &[Port] {
        &self.form.ports
    }

    fn set(&mut self, port: PortId, value: u128) {
        let net = self.form.port_nets[port.0];
        // An input that nothing reads has no place.
        if self.layout.slot(net).is_some() {
            let value = value & mask(self.form.nets[net].width_bits);
            portable::store(&self.layout, &self.form, &mut self.state, net, value);
            self.is_settled = false;
        }
    }

    fn get(&mut self, port: PortId) -> u128 {
        let net = self.form.port_nets[port.0];
        // Ports are kept.
        self.peek(net).unwrap_or(0)
    }

    fn fall(&mut self) {
        self.has_fallen = true;
        for Falling { q, next } in self.form.clone().falling.iter() {
            let value = self.peek(*next).unwrap_or(0);
            portable::store(&self.layout, &self.form, &mut self.state, *q, value);
            self.is_settled = false;
        }
    }

    fn tick(&mut self) {
        if !std::mem::take(&mut self.has_fallen) && !self.form.falling.is_empty() {
            self.fall();
            self.has_fallen = false;
        }
        self.settle();
        self.serve_memories();
        match &self.code {
            Code::Native(native) => native.commit(&mut self.state),
            Code::Portable => portable::commit(&self.form, &self.layout, &mut self.state),
        }
        self.is_settled = false;
    }
}
