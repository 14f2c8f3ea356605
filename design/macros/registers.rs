//! Clock, hold and reset of the registers that a kernel assigns.

use super::connect;
use proc_macro2::TokenStream as TokenStream2;
use quote::quote;
use std::collections::BTreeSet;
use syn::visit::{visit_expr_field, Visit};
use syn::{Expr, ExprField, Ident, ItemFn, Member};

/// Replaces the kernel in the block.
pub fn whole_kernel(names: Vec<Ident>, mut item: ItemFn) -> syn::Result<TokenStream2> {
    connect::expand(&mut item.block)?;
    let usual = || ["clock", "reset"].map(|name| Ident::new(name, proc_macro2::Span::call_site()));
    let [clock, reset] = match &names[..] {
        [] => usual(),
        [clock, reset] => [clock.clone(), reset.clone()],
        [one, ..] => {
            let text = "kernel takes two names, of clock and reset";
            return Err(syn::Error::new(one.span(), text));
        }
    };
    let mut found = Assigned::default();
    found.visit_block(&item.block);
    let Assigned {
        registers, resets, ..
    } = found;
    let reset_here: Vec<&Ident> = registers.iter().filter(|r| !resets.contains(r)).collect();
    let statements = &item.block.stmts;
    let setup = match registers.is_empty() {
        true => quote!(),
        false => quote! {
            #(self.#registers.clock.next = self.#clock.val();)*
            #(self.#registers.d.next = self.#registers.q.val();)*
            #(self.#reset_here.reset.next = self.#reset.val();)*
        },
    };
    *item.block = syn::parse_quote!({ #setup #(#statements)* });
    Ok(quote! {
        #[hdl_gen]
        #item

        fn timing(&self) -> Vec<TimingInfo> {
            ::rtl_design::elaborate::docs::timing(&<Self as ::rtl_design::elaborate::docs::Described>::DOCS)
        }
    })
}

/// The registers that a kernel assigns, in the order in which it does.
#[derive(Default)]
struct Assigned {
    registers: Vec<Ident>,
    known: BTreeSet<String>,
    /// Those whose reset it assigns itself.
    resets: BTreeSet<Ident>,
}

impl<'ast> Visit<'ast> for Assigned {
    fn visit_expr_field(&mut self, field: &'ast ExprField) {
        if let Some((part, port)) = next_of(field) {
            if port == "d" && self.known.insert(part.to_string()) {
                self.registers.push(part.clone());
            }
            if port == "reset" {
                self.resets.insert(part.clone());
            }
        }
        visit_expr_field(self, field);
    }
}

/// Owner and name of a field.
fn split(field: &ExprField) -> Option<(&Expr, &Ident)> {
    match &field.member {
        Member::Named(name) => Some((&field.base, name)),
        Member::Unnamed(_) => None,
    }
}

fn as_field(expr: &Expr) -> Option<&ExprField> {
    match expr {
        Expr::Field(field) => Some(field),
        _ => None,
    }
}

/// `self.part.port.next`: part and port.
fn next_of(field: &ExprField) -> Option<(&Ident, &Ident)> {
    let (port, next) = split(field)?;
    let (part, port) = split(as_field(port)?)?;
    let (block, part) = split(as_field(part)?)?;
    let is_self = matches!(block, Expr::Path(path) if path.path.is_ident("self"));
    (next == "next" && is_self).then_some((part, port))
}
