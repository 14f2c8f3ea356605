//! Small random kernels. Each is kept as one typed tree, which gives both halves of a rust-hdl block: the syntax tree that `#[hdl_gen]`
//! would have made, and the update function, computed with rust-hdl's own `Bits`.

use rtl_design::reg::Reg;
use rust_hdl::ast::{
    VerilogBlockOrConditional, VerilogCase, VerilogConditional, VerilogExpression as Ast,
    VerilogMatch, VerilogOp, VerilogOpUnary, VerilogStatement,
};
use rust_hdl::prelude::*;
use std::sync::Arc;

/// An expression; operands have the width of the result unless said otherwise.
#[derive(Clone, Debug)]
pub enum E {
    /// Signal of a kind (`a`, `b` inputs, `l` local, `o` output, `r` register) and width.
    Signal(char, usize),
    /// `bits::<N>(value)`, or a bool.
    Literal(u64, usize),
    /// A bare literal; only as an operand next to a typed one.
    Raw(u64),
    Binary(Op, Box<E>, Box<E>),
    /// One bit from two operands of another width.
    Compare(Op, Box<E>, Box<E>),
    /// The amount has 6 or 8 bits.
    Shift(Op, Box<E>, Box<E>),
    Not(Box<E>),
    /// `any`, `all` or `xor` of a wider operand.
    Reduce(Op, Box<E>),
    Cast(usize, Box<E>),
    /// `get_bits` (or `get_bit`, for one bit) from a position below the operand's width.
    Slice(usize, Box<E>, Box<E>),
    ReplaceBit(Box<E>, Box<E>, Box<E>),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Op {
    Add,
    Sub,
    And,
    Or,
    Xor,
    Shl,
    Shr,
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
    Any,
    All,
    Parity,
}

/// A statement; a target is a kind of signal (`d` for the input of a register) and its width.
#[derive(Clone, Debug)]
pub enum S {
    Assign((char, usize), E),
    If(E, Vec<S>, Vec<S>),
    /// On `.index()` of a narrow value.
    Match(E, Vec<(u64, Vec<S>)>, Vec<S>),
}

macro_rules! with_widths {
    ($macro:ident) => {
        $macro! {
            W6 6 a6 b6 l6 o6 r6, W8 8 a8 b8 l8 o8 r8, W13 13 a13 b13 l13 o13 r13, W16 16 a16 b16 l16 o16 r16,
            W32 32 a32 b32 l32 o32 r32, W33 33 a33 b33 l33 o33 r33, W48 48 a48 b48 l48 o48 r48, W64 64 a64 b64 l64 o64 r64
        }
    };
}

macro_rules! define {
    ($($v:ident $w:literal $a:ident $b:ident $l:ident $o:ident $r:ident),*) => {
        /// All widths in use; 1 is a bool.
        pub const WIDTHS: &[usize] = &[1, $($w),*];

        /// A value as rust-hdl has it.
        #[derive(Clone, Copy, Debug, PartialEq)]
        enum V { W1(bool), $($v(Bits<$w>)),* }

        impl V {
            fn literal(value: u64, width: usize) -> Self {
                match width { 1 => V::W1(value != 0), $($w => V::$v(value.into()),)* _ => unreachable!() }
            }
            fn cast<const N: usize>(x: Bits<N>, width: usize) -> Self {
                match width { 1 => V::W1(bit_cast::<1, N>(x).into()), $($w => V::$v(bit_cast::<$w, N>(x)),)* _ => unreachable!() }
            }
            fn cast_to(self, width: usize) -> Self {
                match self { V::W1(x) => V::cast(Bits::<1>::from(x), width), $(V::$v(x) => V::cast(x, width)),* }
            }
            fn slice<const N: usize>(x: Bits<N>, low: usize, width: usize) -> Self {
                match width { 1 => V::W1(x.get_bit(low)), $($w => V::$v(x.get_bits::<$w>(low)),)* _ => unreachable!() }
            }
            fn slice_to(self, low: usize, width: usize) -> Self {
                match self { V::W1(_) => unreachable!(), $(V::$v(x) => V::slice(x, low, width)),* }
            }
            fn index(self) -> usize {
                match self { V::W1(_) => unreachable!(), $(V::$v(x) => x.index()),* }
            }
            fn not(self) -> Self {
                match self { V::W1(x) => V::W1(!x), $(V::$v(x) => V::$v(!x)),* }
            }
            fn reduce(self, op: Op) -> Self {
                V::W1(match (self, op) {
                    $((V::$v(x), Op::Any) => x.any(), (V::$v(x), Op::All) => x.all(), (V::$v(x), Op::Parity) => x.xor(),)*
                    _ => unreachable!(),
                })
            }
            fn replace_bit(self, index: usize, bit: V) -> Self {
                match self { V::W1(_) => unreachable!(), $(V::$v(x) => V::$v(x.replace_bit(index, bit == V::W1(true)))),* }
            }
            fn binary(self, op: Op, other: V) -> Self {
                match (self, other) {
                    (V::W1(x), V::W1(y)) => V::W1(match op { Op::And => x & y, Op::Or => x | y, Op::Xor => x ^ y, _ => unreachable!() }),
                    $((V::$v(x), V::$v(y)) => V::$v(arithmetic(op, x, y)),)*
                    _ => unreachable!(),
                }
            }
            fn binary_raw(self, op: Op, other: u64) -> Self {
                match self { V::W1(_) => unreachable!(), $(V::$v(x) => V::$v(arithmetic_raw(op, x, other))),* }
            }
            fn compare(self, op: Op, other: V) -> bool {
                match (self, other) {
                    (V::W1(x), V::W1(y)) => compare(op, x, y),
                    $((V::$v(x), V::$v(y)) => compare(op, x, y),)*
                    _ => unreachable!(),
                }
            }
            fn compare_raw(self, op: Op, other: u64) -> bool {
                match self { V::W1(_) => unreachable!(), $(V::$v(x) => compare_raw(op, x, other)),* }
            }
            fn shift(self, op: Op, amount: V) -> Self {
                match (self, op, amount) {
                    $((V::$v(x), Op::Shl, V::W6(n)) => V::$v(x << n), (V::$v(x), Op::Shl, V::W8(n)) => V::$v(x << n),
                      (V::$v(x), _, V::W6(n)) => V::$v(x >> n), (V::$v(x), _, V::W8(n)) => V::$v(x >> n),)*
                    _ => unreachable!(),
                }
            }
            fn shift_raw(self, op: Op, amount: u64) -> Self {
                match (self, op) {
                    $((V::$v(x), Op::Shl) => V::$v(x << amount), (V::$v(x), _) => V::$v(x >> amount),)*
                    _ => unreachable!(),
                }
            }
        }

        /// A block with signals of all widths and a random kernel.
        #[derive(LogicBlock, Default)]
        pub struct RandomKernel {
            pub clock: Signal<In, Clock>,
            pub reset: Signal<In, Bit>,
            pub a1: Signal<In, Bit>, pub b1: Signal<In, Bit>, l1: Signal<Local, Bit>, pub o1: Signal<Out, Bit>, r1: Reg<Bit>,
            $(pub $a: Signal<In, Bits<$w>>, pub $b: Signal<In, Bits<$w>>, $l: Signal<Local, Bits<$w>>, pub $o: Signal<Out, Bits<$w>>, $r: Reg<Bits<$w>>,)*
            pub _program: Arc<Vec<S>>,
        }

        impl RandomKernel {
            fn read(&self, kind: char, width: usize) -> V {
                match (kind, width) {
                    ('a', 1) => V::W1(self.a1.val()), ('b', 1) => V::W1(self.b1.val()), ('l', 1) => V::W1(self.l1.val()),
                    ('o', 1) => V::W1(self.o1.val()), (_, 1) => V::W1(self.r1.q.val()),
                    $(('a', $w) => V::$v(self.$a.val()), ('b', $w) => V::$v(self.$b.val()), ('l', $w) => V::$v(self.$l.val()),
                      ('o', $w) => V::$v(self.$o.val()), (_, $w) => V::$v(self.$r.q.val()),)*
                    _ => unreachable!(),
                }
            }
            fn write(&mut self, target: (char, usize), value: V) {
                match (target.0, value) {
                    ('l', V::W1(x)) => self.l1.next = x, ('o', V::W1(x)) => self.o1.next = x, (_, V::W1(x)) => self.r1.d.next = x,
                    $(('l', V::$v(x)) => self.$l.next = x, ('o', V::$v(x)) => self.$o.next = x, (_, V::$v(x)) => self.$r.d.next = x,)*
                }
            }
            fn clock_registers(&mut self) {
                let (clock, reset) = (self.clock.val(), self.reset.val());
                self.r1.clock.next = clock;
                self.r1.reset.next = reset;
                $(self.$r.clock.next = clock; self.$r.reset.next = reset;)*
            }
            /// As an engine.
            pub fn engine(self) -> rtl_design::engine::KernelEngine<Self> {
                rtl_design::kernel_engine!(self; clock; in reset, a1, b1, $($a, $b),*; out o1, $($o),*)
            }
        }
    };
}
with_widths!(define);

fn arithmetic<const N: usize>(op: Op, x: Bits<N>, y: Bits<N>) -> Bits<N> {
    match op {
        Op::Add => x + y,
        Op::Sub => x - y,
        Op::And => x & y,
        Op::Or => x | y,
        _ => x ^ y,
    }
}

fn arithmetic_raw<const N: usize>(op: Op, x: Bits<N>, y: LiteralType) -> Bits<N> {
    match op {
        Op::Add => x + y,
        Op::Sub => x - y,
        Op::And => x & y,
        Op::Or => x | y,
        _ => x ^ y,
    }
}

fn compare<T: PartialOrd>(op: Op, x: T, y: T) -> bool {
    match op {
        Op::Eq => x == y,
        Op::Ne => x != y,
        Op::Lt => x < y,
        Op::Le => x <= y,
        Op::Gt => x > y,
        _ => x >= y,
    }
}

fn compare_raw<const N: usize>(op: Op, x: Bits<N>, y: LiteralType) -> bool {
    match op {
        Op::Eq => x == y,
        Op::Ne => x != y,
        Op::Lt => x < y,
        Op::Le => x <= y,
        Op::Gt => x > y,
        _ => x >= y,
    }
}

impl RandomKernel {
    /// A block that runs this kernel.
    pub fn new(program: Vec<S>) -> Self {
        Self {
            _program: Arc::new(program),
            ..Self::default()
        }
    }

    fn evaluate(&self, e: &E) -> V {
        match e {
            E::Signal(kind, width) => self.read(*kind, *width),
            E::Literal(value, width) => V::literal(*value, *width),
            E::Raw(_) => unreachable!(),
            E::Binary(op, x, y) => match **y {
                E::Raw(y) => self.evaluate(x).binary_raw(*op, y),
                _ => self.evaluate(x).binary(*op, self.evaluate(y)),
            },
            E::Compare(op, x, y) => V::W1(match **y {
                E::Raw(y) => self.evaluate(x).compare_raw(*op, y),
                _ => self.evaluate(x).compare(*op, self.evaluate(y)),
            }),
            E::Shift(op, x, y) => match **y {
                E::Raw(y) => self.evaluate(x).shift_raw(*op, y),
                _ => self.evaluate(x).shift(*op, self.evaluate(y)),
            },
            E::Not(x) => self.evaluate(x).not(),
            E::Reduce(op, x) => self.evaluate(x).reduce(*op),
            E::Cast(width, x) => self.evaluate(x).cast_to(*width),
            E::Slice(width, x, low) => self.evaluate(x).slice_to(self.position(low), *width),
            E::ReplaceBit(x, at, bit) => self
                .evaluate(x)
                .replace_bit(self.position(at), self.evaluate(bit)),
        }
    }

    fn position(&self, e: &E) -> usize {
        match e {
            E::Raw(at) => *at as usize,
            _ => self.evaluate(e).index(),
        }
    }

    fn execute(&mut self, statements: &[S]) {
        for statement in statements {
            match statement {
                S::Assign(target, value) => self.write(*target, self.evaluate(value)),
                S::If(condition, then, otherwise) => match self.evaluate(condition) {
                    V::W1(true) => self.execute(then),
                    _ => self.execute(otherwise),
                },
                S::Match(subject, arms, default) => {
                    let subject = self.evaluate(subject).index() as u64;
                    let arm = arms.iter().find(|(value, _)| *value == subject);
                    self.execute(arm.map_or(default, |(_, block)| block));
                }
            }
        }
    }
}

impl Logic for RandomKernel {
    fn update(&mut self) {
        self.clock_registers();
        let program = self._program.clone();
        self.execute(&program);
    }

    fn hdl(&self) -> Verilog {
        let mut block: Vec<VerilogStatement> = vec![];
        for width in WIDTHS {
            for input in ["clock", "reset"] {
                let target = Ast::Signal(format!("r{width}${input}$next"));
                block.push(VerilogStatement::Assignment(
                    target,
                    Ast::Signal(input.into()),
                ));
            }
        }
        block.extend(self._program.iter().map(statement));
        Verilog::Combinatorial(block)
    }
}

/// The syntax tree that `#[hdl_gen]` makes of the statement.
fn statement(s: &S) -> VerilogStatement {
    let block = |b: &[S]| b.iter().map(statement).collect();
    match s {
        S::Assign((kind, width), value) => {
            let target = if *kind == 'd' {
                format!("r{width}$d$next")
            } else {
                format!("{kind}{width}$next")
            };
            VerilogStatement::Assignment(Ast::Signal(target), ast(value))
        }
        S::If(condition, then, otherwise) => VerilogStatement::If(VerilogConditional {
            test: ast(condition),
            then: block(then),
            otherwise: match otherwise.is_empty() {
                true => VerilogBlockOrConditional::None,
                false => VerilogBlockOrConditional::Block(block(otherwise)),
            },
        }),
        S::Match(subject, arms, default) => {
            let case = |condition: String, b: &[S]| VerilogCase {
                condition,
                block: block(b),
            };
            let mut cases: Vec<_> = arms
                .iter()
                .map(|(value, b)| case(value.to_string(), b))
                .collect();
            cases.push(case("default".into(), default));
            VerilogStatement::Match(VerilogMatch {
                test: ast(subject),
                cases,
            })
        }
    }
}

/// The syntax tree that `#[hdl_gen]` makes of the expression, every operand in parentheses.
fn ast(e: &E) -> Ast {
    let operand = |e: &E| Box::new(Ast::Paren(Box::new(ast(e))));
    match e {
        E::Signal('r', width) => Ast::Signal(format!("r{width}$q")),
        E::Signal(kind, width) => Ast::Signal(format!("{kind}{width}")),
        E::Literal(value, 1) => Ast::Literal((*value != 0).into()),
        E::Literal(value, width) => Ast::Cast(Box::new(Ast::Literal((*value).into())), *width),
        E::Raw(value) => Ast::Literal((*value).into()),
        E::Binary(op, x, y) | E::Compare(op, x, y) | E::Shift(op, x, y) => {
            let op = match op {
                Op::Add => VerilogOp::Add,
                Op::Sub => VerilogOp::Sub,
                Op::And => VerilogOp::BitAnd,
                Op::Or => VerilogOp::BitOr,
                Op::Xor => VerilogOp::BitXor,
                Op::Shl => VerilogOp::Shl,
                Op::Shr => VerilogOp::Shr,
                Op::Eq => VerilogOp::Eq,
                Op::Ne => VerilogOp::Ne,
                Op::Lt => VerilogOp::Lt,
                Op::Le => VerilogOp::Le,
                Op::Gt => VerilogOp::Gt,
                _ => VerilogOp::Ge,
            };
            Ast::Binary(operand(x), op, operand(y))
        }
        E::Not(x) => Ast::Unary(VerilogOpUnary::Not, operand(x)),
        E::Reduce(op, x) => {
            let op = match op {
                Op::Any => VerilogOpUnary::Any,
                Op::All => VerilogOpUnary::All,
                _ => VerilogOpUnary::Xor,
            };
            Ast::Unary(op, operand(x))
        }
        E::Cast(width, x) => Ast::Cast(operand(x), *width),
        E::Slice(1, x, low) => Ast::Index(operand(x), operand(low)),
        E::Slice(width, x, low) => Ast::Slice(operand(x), *width, operand(low)),
        E::ReplaceBit(x, at, bit) => Ast::IndexReplace(operand(x), operand(at), operand(bit)),
    }
}
