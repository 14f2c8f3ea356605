//! The typed design: modules, nets, registers, memories and expressions, each with its width.

mod memory;
mod statement;

pub use memory::{Memory, WritePort};
pub use statement::Statement;
pub(crate) use statement::{hand_on, restricted, targets};

/// Index of a module in [`Design::modules`].
pub type ModuleId = usize;
/// Index of a net in [`Module::nets`].
pub type NetId = usize;
/// Index of an enum type in [`Design::enums`].
pub type EnumId = usize;

/// Widest net that a design may have.
pub const MAX_WIDTH_BITS: usize = 128;

/// The value with the lowest `width_bits` bits set.
pub fn mask(width_bits: usize) -> u128 {
    if width_bits >= 128 {
        u128::MAX
    } else {
        (1 << width_bits) - 1
    }
}

/// A complete elaborated design. Modules precede the modules that they instantiate: the top comes first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Design {
    /// One module per distinct block type and parameters; the first is the top.
    pub modules: Vec<Module>,
    /// Every enum type that a net has.
    pub enums: Vec<EnumType>,
    /// Registers and RAM hold their start values before the first reset. Otherwise that is not asked of the device: a register has its
    /// start value after a reset, RAM holds anything.
    pub has_initial_values: bool,
}

impl Design {
    /// The top module.
    pub fn top(&self) -> &Module {
        &self.modules[0]
    }
}

/// An enum type and its states, in the order of their values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EnumType {
    /// Rust name of the type.
    pub name: String,
    /// Rust names of the variants; the value of a variant is its index.
    pub variants: Vec<String>,
    /// Bits of a value.
    pub width_bits: usize,
    /// Rust documentation of the type, line by line.
    pub docs: Vec<String>,
    /// Rust documentation of each variant, line by line.
    pub variant_docs: Vec<Vec<String>>,
}

/// One block type with its parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Module {
    /// Verilog name.
    pub name: String,
    /// Rust name of the block type; the instance name where the type is not in the sources.
    pub type_name: String,
    /// Rust documentation of the block type, line by line.
    pub docs: Vec<String>,
    /// Properties to prove: SystemVerilog over the names of its nets, see [`properties`](super::properties).
    pub properties: String,
    /// Every net, ports included.
    pub nets: Vec<Net>,
    /// Ports, in declaration order.
    pub ports: Vec<Port>,
    /// Named constants.
    pub parameters: Vec<Parameter>,
    /// Registers.
    pub registers: Vec<Register>,
    /// Memories.
    pub memories: Vec<Memory>,
    /// Child modules.
    pub instances: Vec<Instance>,
    /// Combinational processes; each net has at most one driver. A process follows the processes that it reads.
    pub processes: Vec<Process>,
}

/// A named bundle of wires.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Net {
    /// Verilog name, unique within the module even without regard to case.
    pub name: String,
    /// Width in bits, 1..=[`MAX_WIDTH_BITS`].
    pub width_bits: usize,
    /// The enum type, if it holds a state.
    pub enum_id: Option<EnumId>,
    /// Rust documentation of the field, line by line.
    pub docs: Vec<String>,
}

/// Direction of a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// Driven from outside.
    Input,
    /// Driven by the module.
    Output,
}

/// A port of a module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// The net of the same name.
    pub net: NetId,
    /// Direction.
    pub direction: Direction,
    /// Whether it is a clock.
    pub is_clock: bool,
}

/// A named constant of a module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Verilog name.
    pub name: String,
    /// Width in bits.
    pub width_bits: usize,
    /// Its value.
    pub value: u128,
    /// Rust documentation of the field, line by line.
    pub docs: Vec<String>,
}

/// A register: on each rising (or falling) edge of `clock`, `q` takes `start` if `reset` is high, else `next`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Register {
    /// Present value.
    pub q: NetId,
    /// Next value.
    pub next: NetId,
    /// Clock.
    pub clock: NetId,
    /// Synchronous reset, active high; `None` if it is tied low.
    pub reset: Option<NetId>,
    /// Value at power-up and after reset.
    pub start: u128,
    /// True for a synchroniser stage, which must stay a separate flip-flop.
    pub is_synchroniser: bool,
    /// Whether it works on the falling edge.
    pub on_fall: bool,
}

/// A child module in its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Instance {
    /// Verilog name.
    pub name: String,
    /// The child.
    pub module: ModuleId,
    /// Connections of the child's ports, in port order.
    pub connections: Vec<Connection>,
}

/// Connection of a port of an [`Instance`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Connection {
    /// Direction of the port, seen from the child.
    pub direction: Direction,
    /// A net, or for an input also a constant or a part of a net.
    pub value: Expr,
}

/// Statements that drive a set of nets, in order; later assignments replace earlier ones.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Process {
    /// Statements.
    pub statements: Vec<Statement>,
}

/// An expression and its width. Operands have the width of the result, except where a kind says otherwise.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Expr {
    /// Width in bits.
    pub width_bits: usize,
    /// Operation.
    pub kind: ExprKind,
}

/// Operation of an expression.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ExprKind {
    /// A literal.
    Constant(u128),
    /// A named state.
    Variant(EnumId, usize),
    /// A named constant, by index in [`Module::parameters`].
    Parameter(usize),
    /// A whole net.
    Net(NetId),
    /// Zero-extension of a narrower operand.
    Extend(Box<Expr>),
    /// The bits from `.1` upwards of a wider operand; they lie within it.
    Slice(Box<Expr>, usize),
    /// The bits of `.0` from `.1` (any width) upwards; bits above its end are zero.
    Select(Box<Expr>, Box<Expr>),
    /// An operator with one operand.
    Unary(UnaryOp, Box<Expr>),
    /// An operator with two operands.
    Binary(BinaryOp, Box<Expr>, Box<Expr>),
}

/// Operators with one operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UnaryOp {
    /// Complement.
    Not,
    /// 1 if all bits of an operand of any width are 1.
    All,
    /// 1 if any bit of an operand of any width is 1.
    Any,
    /// Parity of an operand of any width.
    Xor,
}

/// Operators with two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BinaryOp {
    /// Sum, wrapping.
    Add,
    /// Difference, wrapping.
    Sub,
    /// Product, wrapping.
    Mul,
    /// Bitwise and.
    And,
    /// Bitwise or.
    Or,
    /// Bitwise exclusive or.
    Xor,
    /// Shift to the left by the second operand, of any width; zero once everything is shifted out.
    Shl,
    /// Shift to the right by the second operand, of any width.
    Shr,
    /// 1 if equal; both operands have the same width.
    Eq,
    /// 1 if not equal; both operands have the same width.
    Ne,
    /// 1 if less, unsigned; both operands have the same width.
    Lt,
    /// 1 if less or equal, unsigned; both operands have the same width.
    Le,
    /// 1 if greater, unsigned; both operands have the same width.
    Gt,
    /// 1 if greater or equal, unsigned; both operands have the same width.
    Ge,
}

impl Expr {
    /// A literal.
    pub fn constant(value: u128, width_bits: usize) -> Self {
        Self {
            width_bits,
            kind: ExprKind::Constant(value & mask(width_bits)),
        }
    }

    /// The operands of the expression.
    pub fn operands(&self) -> Vec<&Expr> {
        match &self.kind {
            ExprKind::Constant(_)
            | ExprKind::Variant(..)
            | ExprKind::Parameter(_)
            | ExprKind::Net(_) => {
                vec![]
            }
            ExprKind::Extend(a) | ExprKind::Slice(a, _) | ExprKind::Unary(_, a) => vec![a],
            ExprKind::Select(a, b) | ExprKind::Binary(_, a, b) => vec![a, b],
        }
    }

    /// The operands, to change them.
    pub fn operands_mut(&mut self) -> Vec<&mut Expr> {
        match &mut self.kind {
            ExprKind::Constant(_)
            | ExprKind::Variant(..)
            | ExprKind::Parameter(_)
            | ExprKind::Net(_) => vec![],
            ExprKind::Extend(a) | ExprKind::Slice(a, _) | ExprKind::Unary(_, a) => vec![a],
            ExprKind::Select(a, b) | ExprKind::Binary(_, a, b) => vec![a, b],
        }
    }

    /// Calls `visit` for every net that the expression reads.
    pub fn for_each_net(&self, visit: &mut dyn FnMut(NetId)) {
        if let ExprKind::Net(net) = self.kind {
            visit(net);
        }
        for operand in self.operands() {
            operand.for_each_net(visit);
        }
    }

    /// Calls `change` for every net that the expression reads.
    pub fn for_each_net_mut(&mut self, change: &mut dyn FnMut(&mut NetId)) {
        if let ExprKind::Net(net) = &mut self.kind {
            change(net);
        }
        for operand in self.operands_mut() {
            operand.for_each_net_mut(change);
        }
    }
}

impl Module {
    /// A reference to a whole net.
    pub fn net_expr(&self, net: NetId) -> Expr {
        Expr {
            width_bits: self.nets[net].width_bits,
            kind: ExprKind::Net(net),
        }
    }
}
