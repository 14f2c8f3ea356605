//! The fast engine: a design as native code.

pub(in crate::engine) mod layout;
pub(in crate::engine) mod native;
mod portable;
mod words;

use super::form::{Form, Keep, Place};
use super::{Engine, EngineError, Port, PortId};
use endat_hdl::elaborate::{mask, Design};
use layout::Layout;
use native::Native;
use portable::Portable;
use std::sync::Arc;

/// What executes the form.
#[derive(Clone)]
enum Code {
    Native(Native),
    Portable(Arc<Portable>),
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
}

/// Everything that a running design remembers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Saved {
    state: Vec<u64>,
    memories: Vec<Vec<u128>>,
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
        let form = Form::new(design, keep)?;
        let layout = words::layout(&form);
        let native = Native::compile(&form, &layout, &words::Words(&form));
        Ok(Self::on(form, layout, native))
    }

    /// The same without native code, as on a platform that the code generator does not know.
    ///
    /// # Errors
    /// If it has a combinational loop or a second clock.
    pub fn portable(design: &Design, keep: Keep) -> Result<Self, EngineError> {
        let form = Form::new(design, keep)?;
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
            Err(why) => (Code::Portable(Portable.into()), Some(why.into())),
        };
        Self {
            memories: form.memories.iter().map(|m| vec![0; m.words]).collect(),
            form: form.into(),
            layout: layout.into(),
            code,
            fallback,
            state,
            is_settled: false,
        }
    }

    /// Why this runs in an interpreter instead of native code, if it does.
    pub fn fallback(&self) -> Option<&str> {
        self.fallback.as_deref()
    }

    /// debug
    pub fn stats(&self) -> String {
        format!(
            "segments {} nodes {} commits {} regs {} words {}",
            self.form.segments.len(),
            self.form
                .segments
                .iter()
                .map(|s| s.nodes.len())
                .sum::<usize>(),
            self.form.commits.len(),
            self.form.registers.len(),
            self.layout.words
        )
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

    fn settle(&mut self) {
        if self.is_settled {
            return;
        }
        match &self.code {
            Code::Native(native) => native.settle(&mut self.state),
            Code::Portable(portable) => portable.settle(&self.form, &self.layout, &mut self.state),
        }
        self.is_settled = true;
    }

    /// Reads and writes the memories whose inputs have changed. Their inputs stay as they are until everything is loaded.
    fn serve_memories(&mut self) {
        for (index, word, bit) in self.layout.take_memories(&mut self.state) {
            let nets = &self.form.memories[index];
            let (layout, form) = (&self.layout, &self.form);
            let value = |net, state: &[u64]| portable::value(layout, form, state, net);
            let words = &mut self.memories[index];
            let read = words[value(nets.read_address, &self.state) as usize];
            if value(nets.write_enable, &self.state) != 0 {
                let address = value(nets.write_address, &self.state) as usize;
                words[address] = value(nets.write_data, &self.state);
                // The next cycle may read what was written.
                self.state[word] |= 1 << bit;
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

    fn tick(&mut self) {
        self.settle();
        self.serve_memories();
        match &self.code {
            Code::Native(native) => native.commit(&mut self.state),
            Code::Portable(portable) => portable.commit(&self.form, &self.layout, &mut self.state),
        }
        self.is_settled = false;
    }
}
