//! Places of the register table, by name, in a kernel:
//!
//! | macro | value |
//! |---|---|
//! | `field!(word, block.register.field)` | that field of a word; a bit, if one bit wide |
//! | `half!(half, block.register.field)` | that field of the half word of 16 bits that contains it |
//! | `place!(value, block.register.field)` | a word with the value in that place, and 0 in all other bits |
//! | `offset!(block.register)` | the word's place in its block; as a pattern, too |
//!
//! rust-hdl's kernels accept only literals, so this macro replaces the names by numbers first.

use endat_regs::{Field, Register};
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use syn::parse::{Parse, ParseStream};
use syn::visit_mut::{visit_expr_mut, VisitMut};
use syn::{Expr, Ident, ItemImpl, Macro, Pat, Token};

/// `block.register`.
struct Word(&'static Register);

impl Parse for Word {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        let block = one(endat_regs::BLOCKS, &input.parse()?, |b| b.name)?;
        input.parse::<Token![.]>()?;
        one(block.registers, &input.parse()?, |r| r.name).map(Self)
    }
}

/// Arguments of a macro about a field.
struct Named {
    value: Expr,
    field: &'static Field,
}

impl Parse for Named {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        let value = input.parse()?;
        input.parse::<Token![,]>()?;
        let Word(register) = input.parse()?;
        input.parse::<Token![.]>()?;
        let field = one(register.fields, &input.parse()?, |f| f.name)?;
        input.parse::<Option<Token![,]>>()?;
        Ok(Self { value, field })
    }
}

/// One of `all` by its name; the error lists the alternatives.
fn one<T>(
    all: &'static [T],
    name: &Ident,
    name_of: impl Fn(&T) -> &'static str,
) -> syn::Result<&'static T> {
    let found = all.iter().find(|one| name == name_of(one));
    found.ok_or_else(|| {
        let names: Vec<&str> = all.iter().map(name_of).collect();
        let text = format!(
            "`{name}` is not in the register table; there are {}",
            names.join(", ")
        );
        syn::Error::new(name.span(), text)
    })
}

/// Bits of half a word, as in a RAM.
const HALF_BITS: usize = 16;

impl Named {
    fn read(self, word_bits: usize) -> TokenStream {
        let (lsb, width) = self.bits();
        let (word, at) = (self.value, Literal::usize_unsuffixed(lsb % word_bits));
        match width {
            1 => quote!(#word.get_bit(#at)),
            _ => {
                let width = Literal::usize_unsuffixed(width);
                quote!(#word.get_bits::<#width>(#at))
            }
        }
    }

    fn written(self) -> TokenStream {
        let (lsb, width) = self.bits();
        let value = self.value;
        let value = match width {
            1 => quote!(#value.into()),
            _ => quote!(#value),
        };
        let width = Literal::usize_unsuffixed(width);
        let at = Literal::usize_unsuffixed(lsb);
        match lsb {
            0 => quote!(bit_cast::<32, #width>(#value)),
            _ => quote!((bit_cast::<32, #width>(#value) << #at)),
        }
    }

    fn bits(&self) -> (usize, usize) {
        (self.field.lsb as usize, self.field.width as usize)
    }
}

/// Replacement of a macro call; `None` for other macros.
fn number(call: &Macro) -> Option<syn::Result<TokenStream>> {
    let named = || call.parse_body::<Named>();
    let is = |name| call.path.is_ident(name);
    Some(if is("field") {
        named().map(|n| n.read(2 * HALF_BITS))
    } else if is("half") {
        named().map(|n| n.read(HALF_BITS))
    } else if is("place") {
        named().map(Named::written)
    } else if is("offset") {
        call.parse_body().map(|Word(register)| {
            let offset = Literal::u16_unsuffixed(register.offset);
            quote!(#offset)
        })
    } else {
        return None;
    })
}

#[derive(Default)]
struct Places {
    wrong: Option<syn::Error>,
}

impl Places {
    fn replaced<T: Parse>(&mut self, call: &Macro) -> Option<T> {
        let plain = number(call)?.and_then(syn::parse2);
        plain.map_err(|wrong| self.wrong.get_or_insert(wrong)).ok()
    }
}

impl VisitMut for Places {
    fn visit_expr_mut(&mut self, expr: &mut Expr) {
        if let Expr::Macro(call) = expr {
            if let Some(plain) = self.replaced(&call.mac) {
                *expr = plain;
            }
        }
        // The placed value may contain such macros, too.
        visit_expr_mut(self, expr);
    }

    fn visit_pat_mut(&mut self, pattern: &mut Pat) {
        if let Pat::Macro(call) = pattern {
            if let Some(plain) = self.replaced::<Expr>(&call.mac) {
                *pattern = syn::parse_quote!(#plain);
            }
        }
    }
}

/// Replaces the names by numbers.
pub fn resolve(kernel: &mut ItemImpl) -> syn::Result<()> {
    let mut places = Places::default();
    places.visit_item_impl_mut(kernel);
    places.wrong.map_or(Ok(()), Err)
}

#[cfg(test)]
mod tests {
    use super::*;
    use quote::ToTokens;
    use syn::{parse_quote, Block};

    fn resolved(block: Block) -> Result<String, String> {
        let mut kernel = parse_quote!(impl Logic for Block { fn update(&mut self) #block });
        resolve(&mut kernel).map_err(|e| e.to_string())?;
        Ok(kernel.to_token_stream().to_string())
    }

    fn same(named: Block, numbered: Block) {
        assert_eq!(resolved(named), resolved(numbered));
    }

    /// Catches a wrong width or place, a bit read as a vector, and the wrong half of a word.
    #[test]
    fn names_are_the_numbers_of_the_table() {
        same(
            parse_quote!({ a.next = field!(w.val(), config.frame.position_bits) }),
            parse_quote!({ a.next = w.val().get_bits::<6>(16) }),
        );
        same(
            parse_quote!({ if field!(w.val(), config.timing.filter_half) {} }),
            parse_quote!({ if w.val().get_bit(23) {} }),
        );
        same(
            parse_quote!({ half!(w.val(), line.limits.offset) }),
            parse_quote!({ w.val().get_bits::<7>(0) }),
        );
        same(
            parse_quote!({
                place!(a.val(), result.status.sequence) | place!(b.val(), result.status.fresh)
            }),
            parse_quote!({
                bit_cast::<32, 16>(a.val()) | (bit_cast::<32, 1>(b.val().into()) << 23)
            }),
        );
        same(
            parse_quote!({ place!(field!(w.val(), config.frame.skip), config.frame.skip) }),
            parse_quote!({ (bit_cast::<32, 5>(w.val().get_bits::<5>(11)) << 11) }),
        );
        same(
            parse_quote!({
                match a {
                    offset!(line.worst) => {}
                    _ => {}
                }
            }),
            parse_quote!({
                match a {
                    41 => {}
                    _ => {}
                }
            }),
        );
    }

    #[test]
    fn a_wrong_name_is_answered_with_the_right_ones() {
        let wrong = |block| resolved(block).unwrap_err();
        let field = wrong(parse_quote!({ field!(w.val(), config.limits.field_gap) }));
        assert_eq!(field, "`field_gap` is not in the register table; there are start_timeout_us, range, recovery_limit_cycles, field_gap_us");
        let block = wrong(parse_quote!({ offset!(lines.worst) }));
        assert!(
            block.starts_with("`lines` is not in the register table; there are card, "),
            "{block}"
        );
    }
}
