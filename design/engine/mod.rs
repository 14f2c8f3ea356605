//! Engines that run a design, one clock cycle at a time, with a common trait.

mod compiled;
mod flat;
mod form;
mod instrument;
mod interpreter;
mod kernel;
mod lanes;
mod program;

pub use compiled::{has_native_code, Compiled, NetCoverage, Saved};
pub use form::Keep;
pub use instrument::Instruments;
pub use interpreter::Interpreter;
pub use kernel::{Access, Bundle, KernelEngine, Number, Pin};
pub use lanes::{LaneWords, Lanes};

/// Why a design cannot be executed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EngineError {
    /// Nets that depend on each other without a register between them.
    #[error("combinational loop: {}: put a register into it", .0.join(" -> "))]
    Loop(Vec<String>),
    /// An instrument is asked for on a net that is not there.
    #[error("net = {0}: is not in the design; give the hierarchical name of a net, with dots")]
    UnknownNet(String),
    /// A register has another clock than the first one.
    #[error("register {register}: clock = {clock}: engines run one clock; use one clock input for all registers")]
    SecondClock {
        /// Hierarchical name of the register.
        register: String,
        /// Its clock.
        clock: String,
    },
}

/// Index of a port in [`Engine::ports`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PortId(pub usize);

/// A port of the design that an engine runs. Clock ports are not listed: [`Engine::tick`] drives the clock.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// Name as in the emitted Verilog.
    pub name: String,
    /// Width in bits, 1..=128.
    pub width_bits: usize,
    /// Whether the bench drives it.
    pub is_input: bool,
}

/// Something that executes a design cycle by cycle: rust-hdl's kernels, or one of the engines for a `Design`.
///
/// A cycle is: set inputs, (optionally) read outputs, [`Engine::tick`]; or, for a design that looks at a pin twice in a cycle, set
/// inputs, [`Engine::fall`], set inputs again, [`Engine::tick`]. Registers start at their power-up values.
pub trait Engine {
    /// Every port but the clock, in declaration order.
    fn ports(&self) -> &[Port];
    /// Drives an input; bits above its width must be zero.
    fn set(&mut self, port: PortId, value: u128);
    /// The settled value of a port, with the present inputs and register contents.
    fn get(&mut self, port: PortId) -> u128;
    /// One falling edge of the clock, in the middle of a cycle: registers for this edge sample their inputs.
    ///
    /// Without a call, [`Engine::tick`] does it first: then inputs change with the rising edge only.
    fn fall(&mut self);
    /// One rising edge of the clock.
    fn tick(&mut self);

    /// The port called `name`.
    ///
    /// # Panics
    /// If there is none: the name is written in a bench, not typed by a user.
    fn port(&self, name: &str) -> PortId {
        PortId(
            self.ports()
                .iter()
                .position(|p| p.name == name)
                .unwrap_or_else(|| panic!("the design has no port {name}")),
        )
    }
}
