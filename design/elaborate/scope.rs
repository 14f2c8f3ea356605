//! The names of one block while it is elaborated, and its statements.

mod expr;

use super::design::{
    hand_on, Direction, EnumId, EnumType, Expr, ExprKind, Net, NetId, Parameter, Statement,
};
use super::docs;
use super::tree::BlockNode;
use super::ElaborateError;
use expr::Value;
use rust_hdl::ast::{
    VerilogBlock, VerilogBlockOrConditional, VerilogCase, VerilogConditional,
    VerilogExpression as Ast, VerilogLink, VerilogLinkDetails, VerilogMatch, VerilogStatement,
};
use std::collections::HashMap;

type Result<T> = std::result::Result<T, ElaborateError>;

/// Meaning of a name in a kernel.
#[derive(Clone, Debug)]
pub(super) enum Symbol {
    Net {
        net: NetId,
        is_assignable: bool,
        is_readable: bool,
    },
    Parameter(usize),
}

/// The names of one block.
pub(super) struct Scope<'a> {
    pub block: &'a BlockNode,
    pub symbols: HashMap<String, Symbol>,
    pub nets: Vec<Net>,
    pub parameters: Vec<Parameter>,
    pub enums: &'a [EnumType],
    /// Enum types of this block's signals and of its children's ports.
    pub block_enums: Vec<EnumId>,
    /// Variables of the loops around the present statement.
    pub loops: Vec<(String, usize)>,
    /// Within a loop after its first round: its comments have been emitted.
    pub is_repeated: bool,
}

impl Scope<'_> {
    pub fn net_expr(&self, net: NetId) -> Expr {
        Expr {
            width_bits: self.nets[net].width_bits,
            kind: ExprKind::Net(net),
        }
    }

    /// The name of a signal as the tree has it: `self.a[i].b.next` is `a$2$b`.
    pub fn key(&self, path: &str, field: &str) -> Result<String> {
        let path = path
            .trim_start_matches('.')
            .replace("::", "$")
            .replace('.', "$");
        let path = path.trim_end_matches("$next");
        let mut key = String::new();
        let mut rest = path;
        while let Some((before, after)) = rest.split_once('[') {
            let (index, after) = split_bracket(after).ok_or_else(|| {
                self.block.error(
                    field,
                    format!("index in {path} is not closed"),
                    "close the bracket",
                )
            })?;
            let index = super::index::evaluate(index, &self.loops).ok_or_else(|| {
                self.block.error(
                    field,
                    format!("index [{index}] is not an integer expression of loop variables"),
                    "index arrays with literals and loop variables; choose between elements with if or match",
                )
            })?;
            key.push_str(before);
            key.push_str(&format!("${index}"));
            rest = after;
        }
        key.push_str(rest);
        Ok(key)
    }

    pub fn statements(&mut self, block: &VerilogBlock) -> Result<Vec<Statement>> {
        let mut out = vec![];
        let mut docs = vec![];
        for statement in block {
            if let VerilogStatement::Comment(text) = statement {
                docs.extend((!self.is_repeated).then(|| docs::comment(text)));
                continue;
            }
            let first = out.len();
            self.statement(statement, &mut out)?;
            hand_on(&docs, &mut out[first..]);
            docs.clear();
        }
        Ok(out)
    }

    fn statement(&mut self, statement: &VerilogStatement, out: &mut Vec<Statement>) -> Result<()> {
        match statement {
            VerilogStatement::Assignment(target, value) => {
                let (net, field) = self.target(target)?;
                let value = self.expr(value, self.nets[net].width_bits, &field)?;
                out.push(Statement::Assign {
                    docs: vec![],
                    net,
                    low_bit: 0,
                    value,
                });
            }
            VerilogStatement::SliceAssignment {
                base,
                width,
                offset,
                replacement,
            } => {
                let (net, field) = self.target(base)?;
                let low_bit = match self.value(offset, &field)? {
                    Value::Integer(low_bit)
                        if low_bit + *width as u128 <= self.nets[net].width_bits as u128 =>
                    {
                        low_bit as usize
                    }
                    _ => {
                        return Err(self.block.error(
                            &field,
                            "assigns bits that are not a constant range of the signal",
                            "use replace_bit or a struct field",
                        ))
                    }
                };
                let value = self.expr(replacement, *width, &field)?;
                out.push(Statement::Assign {
                    docs: vec![],
                    net,
                    low_bit,
                    value,
                });
            }
            VerilogStatement::If(conditional) => self.conditional(conditional, out)?,
            VerilogStatement::Match(m) => self.case(m, out)?,
            VerilogStatement::Loop(l) => {
                let is_repeated = self.is_repeated;
                for index in l.from.as_usize()..l.to.as_usize() {
                    self.loops.push((l.index.clone(), index));
                    let body = self.statements(&l.block);
                    self.loops.pop();
                    out.extend(body?);
                    self.is_repeated = true;
                }
                self.is_repeated = is_repeated;
            }
            // Passed on to the next statement.
            VerilogStatement::Comment(_) => {}
            VerilogStatement::Link(links) => {
                for link in links {
                    out.push(self.link(link)?);
                }
            }
            VerilogStatement::Macro(block) => out.extend(self.statements(block)?),
        }
        Ok(())
    }

    fn link(&self, link: &VerilogLink) -> Result<Statement> {
        let (target, source) = match link {
            VerilogLink::Forward(d) => (joined(&d.other_name, d), joined(&d.owner_name, d)),
            VerilogLink::Backward(d) => (joined(&d.owner_name, d), joined(&d.other_name, d)),
            VerilogLink::Bidirectional(d) => {
                return Err(self.block.error(
                    &joined(&d.owner_name, d),
                    "is bidirectional",
                    "use three signals: value out, output enable, value in",
                ))
            }
        };
        let (net, field) = self.target(&Ast::Signal(target))?;
        let value = self.expr(&Ast::Signal(source), self.nets[net].width_bits, &field)?;
        Ok(Statement::Assign {
            docs: vec![],
            net,
            low_bit: 0,
            value,
        })
    }

    fn target(&self, target: &Ast) -> Result<(NetId, String)> {
        let Ast::Signal(path) = target else {
            return Err(self.block.error(
                "",
                "assigns to an expression",
                "assign to self.signal.next",
            ));
        };
        let key = self.key(path, path)?;
        match self.symbols.get(&key) {
            Some(Symbol::Net {
                net,
                is_assignable: true,
                ..
            }) => Ok((*net, key)),
            Some(_) => Err(self.block.error(
                &key,
                "is assigned but is driven from elsewhere",
                "assign only outputs, locals and inputs of child blocks",
            )),
            None => Err(self.block.error(
                &key,
                "is assigned but is no signal of this block",
                "declare it as a field, without a leading underscore",
            )),
        }
    }

    fn conditional(&mut self, c: &VerilogConditional, out: &mut Vec<Statement>) -> Result<()> {
        let condition = self.expr(&c.test, 1, "if")?;
        let then = self.statements(&c.then)?;
        let mut otherwise = vec![];
        match &c.otherwise {
            VerilogBlockOrConditional::Block(block) => otherwise = self.statements(block)?,
            VerilogBlockOrConditional::Conditional(inner) => {
                self.statement(inner, &mut otherwise)?
            }
            VerilogBlockOrConditional::None => {}
        }
        match condition.kind {
            ExprKind::Constant(0) => out.extend(otherwise),
            ExprKind::Constant(_) => out.extend(then),
            _ => out.push(Statement::If {
                docs: vec![],
                condition,
                then,
                otherwise,
            }),
        }
        Ok(())
    }

    fn case(&mut self, m: &VerilogMatch, out: &mut Vec<Statement>) -> Result<()> {
        let Value::Typed(subject) = self.value(&m.test, "match")? else {
            return Err(self
                .block
                .error("match", "matches a literal", "match a signal"));
        };
        let mut arms: Vec<(Expr, Vec<Statement>)> = vec![];
        let mut default = vec![];
        for case in &m.cases {
            if case.condition == "default" {
                default = self.statements(&case.block)?;
                break; // later arms can never match
            }
            let value = self.pattern(case, &subject)?;
            let body = self.statements(&case.block)?;
            if arms.iter().all(|(other, _)| *other != value) {
                arms.push((value, body));
            }
        }
        out.push(Statement::Case {
            docs: vec![],
            subject,
            arms,
            default,
        });
        Ok(())
    }

    fn pattern(&self, case: &VerilogCase, subject: &Expr) -> Result<Expr> {
        let text = case.condition.replace("::", "$");
        let value = match text.as_str() {
            "true" => Ast::Literal(true.into()),
            "false" => Ast::Literal(false.into()),
            _ => match integer(&text) {
                Some(value) => Ast::Literal(value.into()),
                None => match (text.contains('$'), self.subject_enum(subject)) {
                    // a variant imported with `use Type::*`
                    (false, Some(id)) if self.enums[id].variants.contains(&text) => {
                        Ast::Signal(format!("{}${text}", self.enums[id].name))
                    }
                    (true, _) => Ast::Signal(text.clone()),
                    _ => {
                        return Err(self.block.error(
                            "match",
                            format!("pattern {text} is no variant and no literal"),
                            "write Type::Variant, an integer, or _",
                        ))
                    }
                },
            },
        };
        self.expr(&value, subject.width_bits, "match")
    }

    fn subject_enum(&self, subject: &Expr) -> Option<EnumId> {
        match subject.kind {
            ExprKind::Net(net) => self.nets[net].enum_id,
            _ => None,
        }
    }
}

/// Removes defaults that are always replaced before anything reads them.
pub(super) fn drop_replaced(statements: &mut Vec<Statement>, nets: &[Net]) {
    let full_target = |statement: &Statement| match statement {
        Statement::Assign { net, value, .. } if value.width_bits == nets[*net].width_bits => {
            Some(*net)
        }
        _ => None,
    };
    let is_replaced = |at: usize| {
        let Some(net) = full_target(&statements[at]) else {
            return false;
        };
        for later in &statements[at + 1..] {
            let mut is_read = false;
            later.for_each_expr(&mut |expr| expr.for_each_net(&mut |read| is_read |= read == net));
            if is_read {
                return false;
            }
            if full_target(later) == Some(net) {
                return true;
            }
        }
        false
    };
    let keep: Vec<bool> = (0..statements.len()).map(|at| !is_replaced(at)).collect();
    let mut keep = keep.into_iter();
    statements.retain(|_| keep.next().unwrap_or(true));
}

/// Whether a port of a child may be assigned and read by the parent.
pub(super) fn child_port(net: NetId, direction: Direction) -> Symbol {
    Symbol::Net {
        net,
        is_assignable: direction == Direction::Input,
        is_readable: direction == Direction::Output,
    }
}

fn joined(base: &str, details: &VerilogLinkDetails) -> String {
    format!("{base}{}", details.my_name)
}

/// Splits `i+1].x` into `i+1` and `.x`; brackets inside are allowed.
fn split_bracket(text: &str) -> Option<(&str, &str)> {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        match c {
            '[' => depth += 1,
            ']' if depth == 0 => return Some((&text[..at], &text[at + 1..])),
            ']' => depth -= 1,
            _ => {}
        }
    }
    None
}

/// An integer literal as Rust writes it.
fn integer(text: &str) -> Option<u128> {
    let text = text.replace('_', "");
    let text = ["usize", "u128", "u64", "u32", "u16", "u8", "i32"]
        .iter()
        .find_map(|suffix| text.strip_suffix(suffix))
        .unwrap_or(&text);
    match text.get(..2) {
        Some("0x") => u128::from_str_radix(&text[2..], 16).ok(),
        Some("0b") => u128::from_str_radix(&text[2..], 2).ok(),
        Some("0o") => u128::from_str_radix(&text[2..], 8).ok(),
        _ => text.parse().ok(),
    }
}
