//! Parts of a kernel: functions next to `update`, inlined where they are called.

use proc_macro2::Ident;
use quote::ToTokens;
use syn::visit_mut::{visit_block_mut, visit_expr_mut, VisitMut};
use syn::{Block, Error, Expr, ExprBlock, ImplItem, ImplItemFn, ItemFn, ItemImpl, Result, Stmt};

/// The one kernel of `impl Logic for ...`, with its parts written out; its other items are taken out.
pub fn kernel_of(item: &mut ItemImpl) -> Result<ItemFn> {
    let mut parts = Vec::new();
    for inner in std::mem::take(&mut item.items) {
        match inner {
            ImplItem::Fn(function) => parts.push(Part::of(function)),
            other => item.items.push(other),
        }
    }
    let Some(at) = parts.iter().position(|p| p.function.sig.ident == "update") else {
        return Err(Error::new_spanned(&item.self_ty, "a kernel has `update`"));
    };
    let mut kernel = parts.remove(at).function;
    let mut writer = Writer {
        parts,
        within: Vec::new(),
        wrong: None,
    };
    writer.visit_block_mut(&mut kernel.block);
    if let Some(wrong) = writer.wrong {
        return Err(wrong);
    }
    if let Some(part) = writer.parts.iter().find(|part| !part.is_called) {
        let name = &part.function.sig.ident;
        return Err(Error::new_spanned(
            name,
            "a part that the kernel never calls",
        ));
    }
    syn::parse2(kernel.into_token_stream())
}

struct Part {
    function: ImplItemFn,
    is_called: bool,
}

impl Part {
    fn of(function: ImplItemFn) -> Self {
        Self {
            function,
            is_called: false,
        }
    }
}

struct Writer {
    parts: Vec<Part>,
    /// Parts that are being written out, the outermost first.
    within: Vec<Ident>,
    wrong: Option<Error>,
}

impl Writer {
    /// Statements of the part with this name, if it is called.
    fn written(&mut self, called: &Expr) -> Option<Block> {
        let name = called_part(called).filter(|_| self.wrong.is_none())?;
        let Some(part) = (self.parts.iter_mut()).find(|part| part.function.sig.ident == *name)
        else {
            return self.refuse(name, "no part of this kernel");
        };
        part.is_called = true;
        let mut block = part.function.block.clone();
        if self.within.contains(name) {
            return self.refuse(name, "a part that calls itself");
        }
        self.within.push(name.clone());
        self.visit_block_mut(&mut block);
        self.within.pop();
        Some(block)
    }

    fn refuse(&mut self, name: &Ident, text: &str) -> Option<Block> {
        self.wrong.get_or_insert(Error::new_spanned(name, text));
        None
    }
}

impl VisitMut for Writer {
    fn visit_block_mut(&mut self, block: &mut Block) {
        let mut all = Vec::with_capacity(block.stmts.len());
        for statement in std::mem::take(&mut block.stmts) {
            let written = match &statement {
                Stmt::Expr(called, _) => self.written(called),
                _ => None,
            };
            match written {
                Some(part) => all.extend(part.stmts),
                None => all.push(statement),
            }
        }
        block.stmts = all;
        visit_block_mut(self, block);
    }

    /// The rest is not a statement of a block, but the arm of a match.
    fn visit_expr_mut(&mut self, expr: &mut Expr) {
        if let Some(block) = self.written(expr) {
            *expr = Expr::Block(ExprBlock {
                attrs: Vec::new(),
                label: None,
                block,
            });
        }
        visit_expr_mut(self, expr);
    }
}

/// The part that `self.part()` calls.
fn called_part(expr: &Expr) -> Option<&Ident> {
    match expr {
        Expr::MethodCall(call) => {
            let is_self = matches!(&*call.receiver, Expr::Path(p) if p.path.is_ident("self"));
            (is_self && call.args.is_empty()).then_some(&call.method)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use syn::parse_quote;

    fn written(mut block: ItemImpl) -> std::result::Result<String, String> {
        kernel_of(&mut block)
            .map(|kernel| kernel.block.to_token_stream().to_string())
            .map_err(|wrong| wrong.to_string())
    }

    /// Catches a part that is inlined at a wrong place, or in a separate block between statements.
    #[test]
    fn parts_stand_where_they_are_called() {
        let in_parts = written(parse_quote! {
            impl Logic for Lamp {
                fn update(&mut self) {
                    self.first.next = false;
                    self.middle();
                    match self.state.q.val() {
                        State::On => self.lit(),
                        _ => {}
                    }
                }
                /// Said by nobody.
                fn middle(&mut self) {
                    self.second.next = true;
                    if self.first.val() {
                        self.lit();
                    }
                }
                fn lit(&mut self) {
                    self.lamp.next = true;
                }
            }
        });
        let whole: Block = parse_quote!({
            self.first.next = false;
            self.second.next = true;
            if self.first.val() {
                self.lamp.next = true;
            }
            match self.state.q.val() {
                State::On => {
                    self.lamp.next = true;
                }
                _ => {}
            }
        });
        // A comma after an arm has no meaning, nor have spaces.
        let plain = |text: String| text.replace([',', ' '], "");
        assert_eq!(
            in_parts.map(plain),
            Ok(plain(whole.to_token_stream().to_string()))
        );
    }

    #[test]
    fn a_part_that_is_none_of_the_kernel_is_refused() {
        let wrong = |body: Block, part: ImplItemFn| {
            written(parse_quote!(impl Logic for Lamp { fn update(&mut self) #body #part }))
        };
        let lit: ImplItemFn = parse_quote!(
            fn lit(&mut self) {}
        );
        assert_eq!(
            wrong(parse_quote!({ self.dark() }), lit.clone()),
            Err("no part of this kernel".into())
        );
        assert_eq!(
            wrong(parse_quote!({}), lit),
            Err("a part that the kernel never calls".into())
        );
        assert_eq!(
            wrong(
                parse_quote!({ self.lit() }),
                parse_quote!(
                    fn lit(&mut self) {
                        self.lit();
                    }
                )
            ),
            Err("a part that calls itself".into())
        );
        assert_eq!(
            written(parse_quote!(impl Logic for Lamp { fn lit(&mut self) {} })),
            Err("a kernel has `update`".into())
        );
    }
}
