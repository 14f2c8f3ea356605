//! rust-hdl's own kernels as an engine: the reference that all other executions are compared with.

use super::{Engine, Port, PortId};
use rust_hdl::prelude::{
    Bit, Bits, Block, Clock, Direction, In, LiteralType, Local, Out, Signal, Synth, ToBits,
};

/// Passes of `update_all` before a kernel counts as unstable.
const MAX_PASSES: usize = 1000;

/// A port of a block, as numbers.
pub trait Pin {
    /// Its width.
    fn width_bits(&self) -> usize;
    /// Drives it, if it is an input.
    fn set(&mut self, value: u128);
    /// Its present value.
    fn get(&self) -> u128;
}

/// Types that a [`Pin`] can carry.
pub trait Number: Synth {
    /// From the lowest bits.
    fn from_u128(value: u128) -> Self;
    /// To the lowest bits.
    fn to_u128(self) -> u128;
}

impl Number for Bit {
    fn from_u128(value: u128) -> Self {
        value != 0
    }
    fn to_u128(self) -> u128 {
        self.into()
    }
}

impl<const N: usize> Number for Bits<N> {
    fn from_u128(value: u128) -> Self {
        if N <= 64 {
            (value as LiteralType).into()
        } else {
            value.to_bits()
        }
    }
    fn to_u128(self) -> u128 {
        Bits::to_u128(self)
    }
}

impl<D: Direction, T: Number> Pin for Signal<D, T>
where
    Self: Readable<T>,
{
    fn width_bits(&self) -> usize {
        T::BITS
    }
    fn set(&mut self, value: u128) {
        self.next = T::from_u128(value);
    }
    fn get(&self) -> u128 {
        self.read().to_u128()
    }
}

/// Signals of all directions have a `val`, but not one common trait for it.
pub trait Readable<T> {
    /// The present value.
    fn read(&self) -> T;
}

macro_rules! readable {
    ($($direction:ident)*) => {
        $(impl<T: Synth> Readable<T> for Signal<$direction, T> {
            fn read(&self) -> T {
                self.val()
            }
        })*
    };
}
readable!(In Out Local);

/// Finds a port in a block, or in a bundle.
pub type Access<B> = fn(&mut B) -> &mut dyn Pin;

/// The same, also where it is a port of a bundle.
type Found<B> = Box<dyn Fn(&mut B) -> &mut dyn Pin>;

/// Ports that travel together, see [`macro@crate::ports`].
pub trait Bundle: Sized + 'static {
    /// Name of each port, true if the block reads it, and its access function.
    const PINS: &'static [(&'static str, bool, Access<Self>)];
}

/// Runs a block with a simple settle loop: no threads, no events.
///
/// ```
/// # use rtl_design::engine::{Engine, KernelEngine};
/// # use rust_hdl::prelude::*;
/// # #[derive(LogicBlock, Default)]
/// # struct Inverter { clock: Signal<In, Clock>, a: Signal<In, Bit>, b: Signal<Out, Bit> }
/// # impl Logic for Inverter { #[hdl_gen] fn update(&mut self) { self.b.next = !self.a.val(); } }
/// let mut engine = KernelEngine::new(Inverter::default(), |b| &mut b.clock)
///     .input("a", |b| &mut b.a)
///     .output("b", |b| &mut b.b);
/// let (a, b) = (engine.port("a"), engine.port("b"));
/// engine.set(a, 1);
/// assert_eq!(engine.get(b), 0);
/// ```
pub struct KernelEngine<B: Block> {
    block: B,
    clock: fn(&mut B) -> &mut Signal<In, Clock>,
    ports: Vec<Port>,
    access: Vec<Found<B>>,
    is_settled: bool,
}

impl<B: Block + 'static> KernelEngine<B> {
    /// Takes a block and connects it.
    pub fn new(mut block: B, clock: fn(&mut B) -> &mut Signal<In, Clock>) -> Self {
        block.connect_all();
        Self {
            block,
            clock,
            ports: vec![],
            access: vec![],
            is_settled: false,
        }
    }

    /// Names an input.
    #[must_use]
    pub fn input(self, name: &str, access: Access<B>) -> Self {
        self.port_access(name, true, access)
    }

    /// Names an output.
    #[must_use]
    pub fn output(self, name: &str, access: Access<B>) -> Self {
        self.port_access(name, false, access)
    }

    /// Names all ports of a bundle, with `suffix` appended to their names.
    #[must_use]
    pub fn bundle<P: Bundle>(mut self, suffix: &str, bundle: fn(&mut B) -> &mut P) -> Self {
        for &(name, is_input, access) in P::PINS {
            let name = format!("{name}{suffix}");
            self = self.port_access(&name, is_input, move |block| access(bundle(block)));
        }
        self
    }

    fn port_access<A>(mut self, name: &str, is_input: bool, access: A) -> Self
    where
        A: 'static + Fn(&mut B) -> &mut dyn Pin,
    {
        self.ports.push(Port {
            name: name.into(),
            width_bits: access(&mut self.block).width_bits(),
            is_input,
        });
        self.access.push(Box::new(access));
        self
    }

    /// The block itself.
    pub fn block(&self) -> &B {
        &self.block
    }

    fn settle(&mut self) {
        if self.is_settled {
            return;
        }
        for _ in 0..MAX_PASSES {
            self.block.update_all();
            if !self.block.has_changed() {
                self.is_settled = true;
                return;
            }
        }
        panic!("the kernels do not settle: the block has a combinational loop");
    }

    fn set_clock(&mut self, level: bool) {
        (self.clock)(&mut self.block).next = level.into();
        self.is_settled = false;
        self.settle();
    }
}

impl<B: Block + 'static> Engine for KernelEngine<B> {
    fn ports(&self) -> &[Port] {
        &self.ports
    }

    fn set(&mut self, port: PortId, value: u128) {
        (self.access[port.0])(&mut self.block).set(value);
        self.is_settled = false;
    }

    fn get(&mut self, port: PortId) -> u128 {
        self.settle();
        (self.access[port.0])(&mut self.block).get()
    }

    fn fall(&mut self) {
        self.settle();
        self.set_clock(false);
    }

    fn tick(&mut self) {
        self.settle();
        if (self.clock)(&mut self.block).val().clk {
            self.set_clock(false);
        }
        self.set_clock(true);
    }
}

/// A [`KernelEngine`] of a block, from the names of its ports and bundles: `kernel_engine!(block; clock; in a, b; out c; bundles d)`.
#[macro_export]
macro_rules! kernel_engine {
    (
        $block:expr; $clock:ident; in $($input:ident),* $(,)?; out $($output:ident),* $(,)? $(; bundles $($bundle:ident),* $(,)?)?
    ) => {
        $crate::engine::KernelEngine::new($block, |b| &mut b.$clock)
            $(.input(stringify!($input), |b| &mut b.$input))*
            $(.output(stringify!($output), |b| &mut b.$output))*
            $($(.bundle("", |b| &mut b.$bundle))*)?
    };
}
