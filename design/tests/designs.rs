//! Random designs of one module, without rust-hdl: all operators at widths up to 128 bits, memories, partial assignments.

use crate::ghdl;
use crate::rng::Rng;
use crate::stimulus::stimulus;
use crate::three_way::{agree, engines, lanes_agree, record, replay};
use crate::tools;
use proptest::prelude::*;
use rtl_design::elaborate::{
    BinaryOp, Design, Direction, Expr, ExprKind, Memory, Module, Net, NetId, Port, Process,
    Register, Statement, UnaryOp, WritePort,
};
use rtl_design::engine::Interpreter;

/// Widths around the borders of words.
const WIDTHS: [usize; 12] = [1, 2, 7, 8, 31, 33, 63, 64, 65, 100, 127, 128];

/// A random module: inputs, expressions over everything before, registers and memories fed by them.
struct Maker {
    rng: Rng,
    module: Module,
    /// Nets that an expression may read.
    readable: Vec<NetId>,
    /// True if products of more than 33 bits may occur.
    has_wide_products: bool,
}

impl Maker {
    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.rng.in_range(0, from.len() as u64 - 1) as usize]
    }

    fn net(&mut self, name: &str, width_bits: usize) -> NetId {
        self.module.nets.push(Net {
            name: name.into(),
            width_bits,
            enum_id: None,
            docs: vec![],
        });
        self.module.nets.len() - 1
    }

    fn port(
        &mut self,
        name: &str,
        width_bits: usize,
        direction: Direction,
        is_clock: bool,
    ) -> NetId {
        let net = self.net(name, width_bits);
        self.module.ports.push(Port {
            net,
            direction,
            is_clock,
        });
        net
    }

    fn number(&mut self) -> u128 {
        let any = u128::from(self.rng.next_u64()) << 64 | u128::from(self.rng.next_u64());
        match self.rng.in_range(0, 3) {
            0 => any,
            1 => any & 3,
            2 => u128::MAX,
            _ => 0,
        }
    }

    /// An expression of a width.
    fn expr(&mut self, width_bits: usize, depth: usize) -> Expr {
        let of = |kind| Expr { width_bits, kind };
        if depth == 0 || self.rng.in_range(0, 5) == 0 {
            let fitting: Vec<NetId> = (self.readable.iter().copied())
                .filter(|net| self.module.nets[*net].width_bits == width_bits)
                .collect();
            if fitting.is_empty() || self.rng.in_range(0, 3) == 0 {
                return Expr::constant(self.number(), width_bits);
            }
            return of(ExprKind::Net(self.pick(&fitting)));
        }
        let less = depth - 1;
        let boxed = Box::new;
        let any_width = self.pick(&WIDTHS);
        match self.rng.in_range(0, 9) {
            0 if width_bits > 1 => {
                let narrower = self.rng.in_range(1, width_bits as u64 - 1) as usize;
                of(ExprKind::Extend(boxed(self.expr(narrower, less))))
            }
            1 if width_bits < 128 => {
                let wider = self.rng.in_range(width_bits as u64 + 1, 128) as usize;
                let low = self.rng.in_range(0, (wider - width_bits) as u64) as usize;
                of(ExprKind::Slice(boxed(self.expr(wider, less)), low))
            }
            2 => {
                let (from, index) = (self.expr(any_width, less), self.expr(8, less));
                of(ExprKind::Select(boxed(from), boxed(index)))
            }
            3 => of(ExprKind::Unary(
                UnaryOp::Not,
                boxed(self.expr(width_bits, less)),
            )),
            4 if width_bits == 1 => {
                let op = self.pick(&[UnaryOp::All, UnaryOp::Any, UnaryOp::Xor]);
                of(ExprKind::Unary(op, boxed(self.expr(any_width, less))))
            }
            5 | 6 if width_bits == 1 => {
                use BinaryOp::*;
                let op = self.pick(&[Eq, Ne, Lt, Le, Gt, Ge]);
                let (a, b) = (self.expr(any_width, less), self.expr(any_width, less));
                of(ExprKind::Binary(op, boxed(a), boxed(b)))
            }
            7 => {
                let op = self.pick(&[BinaryOp::Shl, BinaryOp::Shr]);
                let amount = self.pick(&[1, 5, 7, 8, 70]);
                let (a, b) = (self.expr(width_bits, less), self.expr(amount, less));
                of(ExprKind::Binary(op, boxed(a), boxed(b)))
            }
            _ => {
                use BinaryOp::*;
                let mut op = self.pick(&[Add, Sub, Mul, And, Or, Xor]);
                // Wide products take thousands of gates in lanes: few are enough.
                let is_wide = op == Mul && width_bits > 33;
                if is_wide && (!self.has_wide_products || self.rng.in_range(0, 7) != 0) {
                    op = Add;
                }
                let (a, b) = (self.expr(width_bits, less), self.expr(width_bits, less));
                of(ExprKind::Binary(op, boxed(a), boxed(b)))
            }
        }
    }

    /// Statements that drive a net: a default, then a change of all or a part of it under a condition.
    fn drive(&mut self, net: NetId) {
        let width = self.module.nets[net].width_bits;
        let whole = |value| Statement::Assign {
            docs: vec![],
            net,
            low_bit: 0,
            value,
        };
        let mut statements = vec![whole(self.expr(width, 2))];
        let part = self.rng.in_range(1, width as u64) as usize;
        let low_bit = self.rng.in_range(0, (width - part) as u64) as usize;
        let change = Statement::Assign {
            docs: vec![],
            net,
            low_bit,
            value: self.expr(part, 2),
        };
        // A process depends on an input; otherwise it would be an assignment.
        let input = |name: &str, this: &Self| {
            let nets = &this.module.nets;
            let net = nets.iter().position(|n| n.name == name).unwrap();
            this.module.net_expr(net)
        };
        match self.rng.in_range(0, 2) {
            0 => {}
            1 => statements.push(Statement::If {
                docs: vec![],
                condition: input("in_1", self),
                then: vec![change],
                otherwise: vec![whole(self.expr(width, 2))],
            }),
            _ => statements.push(Statement::Case {
                docs: vec![],
                subject: input("in_2", self),
                arms: vec![
                    (Expr::constant(1, 2), vec![change]),
                    (Expr::constant(3, 2), vec![whole(self.expr(width, 1))]),
                ],
                default: vec![],
            }),
        }
        self.module.processes.push(Process { statements });
    }
}

fn empty_module() -> Module {
    Module {
        name: "random".into(),
        type_name: "Random".into(),
        docs: vec![],
        properties: String::new(),
        nets: vec![],
        ports: vec![],
        parameters: vec![],
        registers: vec![],
        memories: vec![],
        instances: vec![],
        processes: vec![],
    }
}

fn design_of(module: Module) -> Design {
    Design {
        modules: vec![module],
        enums: vec![],
        has_initial_values: true,
    }
}

/// A random design of one module.
fn design(seed: u64, has_wide_products: bool) -> Design {
    let mut m = Maker {
        rng: Rng::new(seed),
        module: empty_module(),
        readable: vec![],
        has_wide_products,
    };
    let clock = m.port("clock", 1, Direction::Input, true);
    let reset = m.port("reset", 1, Direction::Input, false);
    m.readable.push(reset);
    for width in WIDTHS {
        let input = m.port(&format!("in_{width}"), width, Direction::Input, false);
        m.readable.push(input);
    }
    let mut fed = vec![];
    for width in WIDTHS {
        let (q, next) = (
            m.net(&format!("q_{width}"), width),
            m.net(&format!("d_{width}"), width),
        );
        m.readable.push(q);
        fed.push(next);
        let register = Register {
            q,
            next,
            clock,
            reset: m.pick(&[None, Some(reset)]),
            start: m.number() & rtl_design::elaborate::mask(width),
            is_synchroniser: false,
            on_fall: false,
        };
        m.module.registers.push(register);
    }
    for (name, width, address_bits, given, is_read_only) in [
        ("narrow", 9, 2, 0, false),
        ("wide", 100, 3, 8, false),
        ("rom", 65, 4, 11, true),
        ("bits", 1, 1, 2, true),
    ] {
        let start = (0..given).map(|_| m.number() & rtl_design::elaborate::mask(width));
        let start = start.collect();
        let mut pin = |what: &str, width| m.net(&format!("{name}_{what}"), width);
        let memory = Memory {
            name: name.into(),
            width_bits: width,
            words: 1 << address_bits,
            clock,
            read_address: pin("read_address", address_bits),
            read_data: pin("read_data", width),
            write: (!is_read_only).then(|| WritePort {
                enable: pin("write_enable", 1),
                address: pin("write_address", address_bits),
                data: pin("write_data", width),
            }),
            start,
            docs: vec![],
        };
        m.readable.push(memory.read_data);
        fed.extend(memory.inputs().filter(|net| *net != clock));
        m.module.memories.push(memory);
    }
    for n in 0..6 {
        let width = m.pick(&WIDTHS);
        let local = m.net(&format!("local_{n}"), width);
        m.drive(local);
        m.readable.push(local);
    }
    fed.into_iter().for_each(|net| m.drive(net));
    for width in WIDTHS {
        let out = m.port(&format!("out_{width}"), width, Direction::Output, false);
        m.drive(out);
    }
    design_of(m.module)
}

/// Runs a design on every engine, in lanes if `has_lanes`, and as text.
fn check(name: &str, design: &Design, seed: u64, has_lanes: bool) -> Result<(), String> {
    let stimulus = stimulus(design, 40, seed);
    let mut plain = Interpreter::new(design).map_err(|e| e.to_string())?;
    let expected = record(&mut plain, &stimulus);
    for (name, mut engine) in engines(design)? {
        agree(name, &expected, &record(engine.as_mut(), &stimulus))?;
    }
    if has_lanes {
        lanes_agree(design, &stimulus, &expected)?;
    }
    if tools::require("iverilog", "random designs: emitted Verilog") {
        replay(name, design, &stimulus, &expected)?;
    }
    match tools::require("ghdl", "random designs: emitted VHDL") {
        true => ghdl::replay(name, design, &stimulus, &expected),
        false => Ok(()),
    }
}

fn check_random(seed: u64, has_wide_products: bool) -> Result<(), String> {
    let name = format!("random-design-{}", seed % 2);
    check(&name, &design(seed, has_wide_products), seed, true)
}

/// Lanes take minutes to compile wide products: the slow test has some.
#[test]
fn products_of_several_words_agree() {
    let mut m = Maker {
        rng: Rng::new(0),
        module: empty_module(),
        readable: vec![],
        has_wide_products: true,
    };
    m.port("clock", 1, Direction::Input, true);
    m.port("reset", 1, Direction::Input, false);
    for width_bits in WIDTHS {
        let pair = ["a", "b"].map(|name| {
            let input = m.port(
                &format!("{name}_{width_bits}"),
                width_bits,
                Direction::Input,
                false,
            );
            Box::new(m.module.net_expr(input))
        });
        let [a, b] = pair;
        let out = m.port(
            &format!("out_{width_bits}"),
            width_bits,
            Direction::Output,
            false,
        );
        let product = ExprKind::Binary(BinaryOp::Mul, a, b);
        m.module.processes.push(Process {
            statements: vec![Statement::Assign {
                docs: vec![],
                net: out,
                low_bit: 0,
                value: Expr {
                    width_bits,
                    kind: product,
                },
            }],
        });
    }
    check("products", &design_of(m.module), 1, false).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2, failure_persistence: None, max_shrink_iters: 0, ..ProptestConfig::default() })]

    #[test]
    fn random_designs_agree(seed: u64) {
        check_random(seed, false).map_err(TestCaseError::fail)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, max_shrink_iters: 0, ..ProptestConfig::default() })]

    #[test]
    #[ignore = "slow: 24 random designs, with products of up to 128 bits"]
    fn random_designs_with_wide_products_agree(seed: u64) {
        check_random(seed, true).map_err(TestCaseError::fail)?;
    }
}
