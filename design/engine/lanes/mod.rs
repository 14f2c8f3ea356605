//! Many copies of a design in one pass: each machine word holds one bit of each copy, a "lane".

mod bits;
mod lower;
mod portable;

use super::compiled::layout::Layout;
use super::compiled::native::Native;
use super::flat::Falling;
use super::form::{Form, Keep, Place};
use super::{EngineError, Instruments, Port, PortId};
use crate::elaborate::Design;
use bits::BitSegment;
use cranelift_codegen::ir::types::{I64, I64X2};
use std::sync::Arc;

/// Words that hold one bit of all lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaneWords {
    /// 64 lanes: a machine word.
    One,
    /// 128 lanes: a vector of two.
    Two,
}

impl LaneWords {
    /// How many words.
    pub fn count(self) -> usize {
        match self {
            LaneWords::One => 1,
            LaneWords::Two => 2,
        }
    }
}

#[derive(Clone)]
enum Code {
    Native(Native),
    Portable(Arc<portable::Portable>),
}

/// Runs many copies of a [`Design`] side by side. A clone goes on from the same state, apart from the original.
#[derive(Clone)]
pub struct Lanes {
    form: Arc<Form>,
    layout: Arc<Layout>,
    code: Code,
    fallback: Option<Arc<str>>,
    words: usize,
    state: Vec<u64>,
    /// For each memory its words, lane by lane; once for all lanes if it is read-only.
    memories: Vec<Vec<u128>>,
    is_settled: bool,
    has_fallen: bool,
}

/// Bit j of word i becomes bit i of word j. Plain loops: closures and adapters are not inlined in a build for tests.
fn transpose(words: &mut [u64; 64]) {
    let (mut step, mut mask) = (32, 0x0000_0000_FFFF_FFFF_u64);
    while step > 0 {
        let mut first = 0;
        while first < 64 {
            let moved = (words[first] >> step ^ words[first + step]) & mask;
            words[first] ^= moved << step;
            words[first + step] ^= moved;
            // The next one without the bit of the step.
            first = (first + step + 1) & !step;
        }
        step /= 2;
        mask ^= mask << step;
    }
}

impl Lanes {
    /// Compiles a design; `keep` says what can be seen. All lanes start alike, at power-up.
    ///
    /// # Errors
    /// If it has a combinational loop or a second clock.
    pub fn new(design: &Design, keep: Keep, words: LaneWords) -> Result<Self, EngineError> {
        let form = Form::new(design, keep, &Instruments::default())?;
        let kind = match words {
            LaneWords::One => I64,
            LaneWords::Two => I64X2,
        };
        let layout = lower::layout(&form, kind);
        let segments: Vec<BitSegment> = form.segments.iter().map(BitSegment::new).collect();
        let lower = lower::Bits {
            form: &form,
            segments: &segments,
            kind,
        };
        let native = Native::compile(&form, &layout, &lower);
        Ok(Self::on(form, layout, segments, words, native))
    }

    /// The same without native code, as on a platform that the code generator does not know.
    ///
    /// # Errors
    /// If it has a combinational loop or a second clock.
    pub fn portable(design: &Design, keep: Keep, words: LaneWords) -> Result<Self, EngineError> {
        let form = Form::new(design, keep, &Instruments::default())?;
        let layout = Layout::new(&form, |width_bits| width_bits * words.count());
        let segments: Vec<BitSegment> = form.segments.iter().map(BitSegment::new).collect();
        Ok(Self::on(
            form,
            layout,
            segments,
            words,
            Err("asked for".into()),
        ))
    }

    fn on(
        form: Form,
        layout: Layout,
        segments: Vec<BitSegment>,
        words: LaneWords,
        native: Result<Native, String>,
    ) -> Self {
        let words = words.count();
        let mut state = vec![0; layout.words];
        for register in &form.registers {
            let place = layout.place(register.q);
            for bit in 0..form.nets[register.q].width_bits {
                if register.start >> bit & 1 == 1 {
                    state[place + bit * words..][..words].fill(u64::MAX);
                }
            }
        }
        layout.mark_all(&mut state);
        let (code, fallback) = match native {
            Ok(native) => (Code::Native(native), None),
            Err(why) => (
                Code::Portable(portable::Portable::new(segments, words).into()),
                Some(why.into()),
            ),
        };
        let lanes = words * 64;
        Self {
            memories: form
                .memories
                .iter()
                .map(|m| m.start.repeat(if m.write.is_some() { lanes } else { 1 }))
                .collect(),
            form: form.into(),
            layout: layout.into(),
            code,
            fallback,
            words,
            state,
            is_settled: false,
            has_fallen: false,
        }
    }

    /// Why this runs in an interpreter instead of native code, if it does.
    pub fn fallback(&self) -> Option<&str> {
        self.fallback.as_deref()
    }

    /// Number of lanes.
    pub fn lanes(&self) -> usize {
        self.words * 64
    }

    /// Bytes of state that the lanes take together.
    pub fn state_bytes(&self) -> usize {
        let memories: usize = self.memories.iter().map(|m| m.len() * 16).sum();
        self.state.len() * 8 + memories
    }

    /// Every port but the clock, in declaration order.
    pub fn ports(&self) -> &[Port] {
        &self.form.ports
    }

    /// The port called `name`.
    ///
    /// # Panics
    /// If there is none: the name is written in a bench, not typed by a user.
    pub fn port(&self, name: &str) -> PortId {
        let found = self.form.ports.iter().position(|p| p.name == name);
        PortId(found.unwrap_or_else(|| panic!("the design has no port {name}")))
    }

    /// Drives an input of one lane.
    pub fn set(&mut self, port: PortId, lane: usize, value: u128) {
        let net = self.form.port_nets[port.0];
        if self.layout.slot(net).is_some() {
            self.store(net, lane, value);
            self.is_settled = false;
        }
    }

    /// Drives an input of all lanes.
    pub fn set_all(&mut self, port: PortId, value: u128) {
        for bit in 0..self.form.ports[port.0].width_bits {
            let word = if value >> bit & 1 == 1 { u64::MAX } else { 0 };
            for part in 0..self.words {
                self.set_word(port, bit, part, word);
            }
        }
    }

    /// Drives one bit of an input of the lanes `64 * part` to `64 * part + 63`.
    pub fn set_word(&mut self, port: PortId, bit: usize, part: usize, lanes: u64) {
        let net = self.form.port_nets[port.0];
        let Some(place) = self.layout.slot(net) else {
            return;
        };
        let word = &mut self.state[place + bit * self.words + part];
        if *word != lanes {
            *word = lanes;
            self.layout.mark(&mut self.state, net);
            self.is_settled = false;
        }
    }

    /// The settled value of a port in one lane.
    pub fn get(&mut self, port: PortId, lane: usize) -> u128 {
        self.peek(self.form.port_nets[port.0], lane).unwrap_or(0)
    }

    /// One bit of a port of the lanes `64 * part` to `64 * part + 63`.
    pub fn word(&mut self, port: PortId, bit: usize, part: usize) -> u64 {
        match self.form.place(self.form.port_nets[port.0]) {
            Place::Constant(value) if value >> bit & 1 == 1 => u64::MAX,
            Place::Constant(_) | Place::Dropped => 0,
            Place::Net(net) => {
                self.settle();
                self.state[self.layout.place(net) + bit * self.words + part]
            }
        }
    }

    /// Hierarchical names of all nets, dropped ones included.
    pub fn nets(&self) -> impl ExactSizeIterator<Item = &str> {
        self.form.nets.iter().map(|n| n.name.as_str())
    }

    /// The registers that were not dropped, as indices of their outputs in [`Lanes::nets`]; those on the falling edge last.
    pub fn registers(&self) -> impl Iterator<Item = usize> + '_ {
        let rising = self.form.registers.iter().map(|r| r.q);
        rising.chain(self.form.falling.iter().map(|f| f.q))
    }

    /// Width of a net, by its index in [`Lanes::nets`].
    pub fn width_bits(&self, net: usize) -> usize {
        self.form.nets[net].width_bits
    }

    /// The settled value of a net in one lane, by its index in [`Lanes::nets`]; `None` if it was dropped.
    pub fn peek(&mut self, net: usize, lane: usize) -> Option<u128> {
        match self.form.place(net) {
            Place::Constant(value) => Some(value),
            Place::Dropped => None,
            Place::Net(net) => {
                self.settle();
                Some(self.load(net, lane))
            }
        }
    }

    /// Flips a bit of a register in one lane, as an upset would; by the index of its output in [`Lanes::nets`].
    ///
    /// # Panics
    /// If it is no register that was kept, or has no such bit.
    pub fn flip(&mut self, register: usize, bit: usize, lane: usize) {
        let rising = self.form.registers.iter().find(|r| r.q == register);
        let is_falling = self.form.falling.iter().any(|f| f.q == register);
        assert!(
            (rising.is_some() || is_falling) && bit < self.form.nets[register].width_bits,
            "net {register} has no register bit {bit}"
        );
        let next = rising.map(|r| r.next);
        self.settle();
        let value = self.load(register, lane);
        self.store(register, lane, value ^ 1 << bit);
        // It is loaded again even if its input stays as it was; at the falling edge everything is.
        if let Some(next) = next {
            self.layout.mark_commits(&mut self.state, next);
        }
        self.is_settled = false;
    }

    fn load(&self, net: usize, lane: usize) -> u128 {
        let place = self.layout.place(net) + lane / 64;
        (0..self.form.nets[net].width_bits)
            .map(|bit| u128::from(self.state[place + bit * self.words] >> (lane % 64) & 1) << bit)
            .sum()
    }

    fn store(&mut self, net: usize, lane: usize, value: u128) {
        let place = self.layout.place(net) + lane / 64;
        let mut is_changed = false;
        for bit in 0..self.form.nets[net].width_bits {
            let word = &mut self.state[place + bit * self.words];
            let new = *word & !(1 << (lane % 64)) | ((value >> bit & 1) as u64) << (lane % 64);
            is_changed |= *word != new;
            *word = new;
        }
        if is_changed {
            self.layout.mark(&mut self.state, net);
        }
    }

    fn settle(&mut self) {
        if self.is_settled {
            return;
        }
        match &self.code {
            Code::Native(native) => native.settle(&mut self.state),
            Code::Portable(portable) => portable.settle(&self.layout, &mut self.state),
        }
        self.is_settled = true;
    }

    /// 64 bits of a net, from `first_bit` on, in the lanes `64 * part` to `64 * part + 63`.
    fn gather(&self, net: usize, part: usize, first_bit: usize) -> [u64; 64] {
        let place = self.layout.place(net) + part;
        let mut values = [0; 64];
        let last = self.form.nets[net].width_bits.min(first_bit + 64);
        if last <= first_bit {
            return values;
        }
        for bit in first_bit..last {
            values[bit - first_bit] = self.state[place + bit * self.words];
        }
        transpose(&mut values);
        values
    }

    /// Stores them.
    fn scatter(&mut self, net: usize, part: usize, first_bit: usize, values: &[u64; 64]) {
        let place = self.layout.place(net) + part;
        let mut is_changed = false;
        let mut rows = *values;
        transpose(&mut rows);
        let last = self.form.nets[net].width_bits.min(first_bit + 64);
        for bit in first_bit..last {
            let (word, new) = (
                &mut self.state[place + bit * self.words],
                rows[bit - first_bit],
            );
            is_changed |= *word != new;
            *word = new;
        }
        if is_changed {
            self.layout.mark(&mut self.state, net);
        }
    }

    /// Reads and writes the memories whose inputs have changed. Their inputs stay as they are until everything is loaded.
    fn serve_memories(&mut self) {
        let mut next = 0;
        while let Some(index) = self.layout.take_memory(&mut self.state, next) {
            next = index + 1;
            for part in 0..self.words {
                self.serve_memory(index, part);
            }
        }
    }

    fn serve_memory(&mut self, index: usize, part: usize) {
        let form = self.form.clone();
        let nets = &form.memories[index];
        let size = nets.start.len();
        // Where the words of a lane begin.
        let first = |lane: usize| match nets.write {
            Some(_) => (64 * part + lane) * size,
            None => 0,
        };
        let read_at = self.gather(nets.read_address, part, 0);
        let mut words = [0; 64];
        for (lane, word) in words.iter_mut().enumerate() {
            *word = self.memories[index][first(lane) + read_at[lane] as usize];
        }
        if let Some(write) = nets.write {
            let enable = self.state[self.layout.place(write.enable) + part];
            if enable != 0 {
                let write_at = self.gather(write.address, part, 0);
                let data = [0, 64].map(|first_bit| self.gather(write.data, part, first_bit));
                for lane in 0..64 {
                    if enable >> lane & 1 == 0 {
                        continue;
                    }
                    let word = u128::from(data[0][lane]) | u128::from(data[1][lane]) << 64;
                    self.memories[index][first(lane) + write_at[lane] as usize] = word;
                }
                // The next cycle may read what was written.
                self.layout.mark_memory(&mut self.state, index);
            }
        }
        let width_bits = form.nets[nets.read_data].width_bits;
        for first_bit in [0, 64].into_iter().filter(|bit| *bit < width_bits) {
            let mut values = [0; 64];
            for (lane, value) in values.iter_mut().enumerate() {
                *value = (words[lane] >> first_bit) as u64;
            }
            self.scatter(nets.read_data, part, first_bit, &values);
        }
    }

    /// One falling edge of the clock, in all lanes; see [`Engine::fall`](super::Engine::fall).
    pub fn fall(&mut self) {
        self.has_fallen = true;
        let form = self.form.clone();
        for Falling { q, next } in &form.falling {
            self.settle();
            for bit in 0..form.nets[*q].width_bits {
                for part in 0..self.words {
                    let new = match form.place(*next) {
                        Place::Constant(value) if value >> bit & 1 == 1 => u64::MAX,
                        Place::Constant(_) | Place::Dropped => 0,
                        Place::Net(net) => {
                            self.state[self.layout.place(net) + bit * self.words + part]
                        }
                    };
                    let word = &mut self.state[self.layout.place(*q) + bit * self.words + part];
                    if std::mem::replace(word, new) != new {
                        self.layout.mark(&mut self.state, *q);
                        self.is_settled = false;
                    }
                }
            }
        }
    }

    /// One rising edge of the clock, in all lanes.
    pub fn tick(&mut self) {
        if !std::mem::take(&mut self.has_fallen) && !self.form.falling.is_empty() {
            self.fall();
            self.has_fallen = false;
        }
        self.settle();
        self.serve_memories();
        match &self.code {
            Code::Native(native) => native.commit(&mut self.state),
            Code::Portable(portable) => portable.commit(&self.form, &self.layout, &mut self.state),
        }
        self.is_settled = false;
    }
}
