//! `connect!` in a kernel: ports that are wired to ports, by name.

use proc_macro2::Ident;
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::visit_mut::{visit_block_mut, VisitMut};
use syn::{parse_quote, BinOp, Block, Error, Expr, ExprBinary, Result, Stmt, Token};

/// `target, target <= source; port, port = other, ...`
struct Connect {
    targets: Vec<Expr>,
    source: Expr,
    ports: Punctuated<Port, Token![,]>,
}

/// A port of the target, and the source's name for it.
struct Port {
    name: Ident,
    other: Ident,
}

impl Parse for Port {
    fn parse(input: ParseStream<'_>) -> Result<Self> {
        let name: Ident = input.parse()?;
        let other = match input.parse::<Option<Token![=]>>()? {
            Some(_) => input.parse()?,
            None => name.clone(),
        };
        Ok(Self { name, other })
    }
}

impl Parse for Connect {
    fn parse(input: ParseStream<'_>) -> Result<Self> {
        let wrong = "connect!(target, target <= source; port, port = other, ...)";
        let mut targets = Vec::new();
        let source = loop {
            match input.parse()? {
                Expr::Binary(ExprBinary {
                    left,
                    op: BinOp::Le(_),
                    right,
                    ..
                }) => {
                    targets.push(*left);
                    break *right;
                }
                target if input.peek(Token![,]) => targets.push(target),
                _ => return Err(input.error(wrong)),
            }
            input.parse::<Token![,]>()?;
        };
        input.parse::<Token![;]>()?;
        Ok(Self {
            targets,
            source,
            ports: Punctuated::parse_terminated(input)?,
        })
    }
}

/// Writes out every `connect!` of a kernel.
pub fn expand(block: &mut Block) -> Result<()> {
    let mut writer = Writer { wrong: None };
    writer.visit_block_mut(block);
    writer.wrong.map_or(Ok(()), Err)
}

struct Writer {
    wrong: Option<Error>,
}

impl VisitMut for Writer {
    fn visit_block_mut(&mut self, block: &mut Block) {
        let mut all = Vec::with_capacity(block.stmts.len());
        for statement in std::mem::take(&mut block.stmts) {
            match statement {
                Stmt::Macro(call) if call.mac.path.is_ident("connect") => {
                    match call.mac.parse_body::<Connect>() {
                        Ok(connect) => all.extend(connect.statements()),
                        Err(wrong) => {
                            self.wrong.get_or_insert(wrong);
                        }
                    }
                }
                other => all.push(other),
            }
        }
        block.stmts = all;
        visit_block_mut(self, block);
    }
}

impl Connect {
    fn statements(&self) -> Vec<Stmt> {
        let Self {
            targets, source, ..
        } = self;
        let of_one = |target| {
            self.ports.iter().map(move |Port { name, other }| {
                parse_quote!(#target.#name.next = #source.#other.val();)
            })
        };
        targets.iter().flat_map(of_one).collect()
    }
}
