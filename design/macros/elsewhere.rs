//! Parts of a kernel in another file. A macro sees only its own item, so the parts become a macro themselves, which inserts them
//! before the kernel.

use proc_macro2::{Group, Span, TokenStream, TokenTree};
use quote::quote;
use syn::parse::{Parse, ParseStream};
use syn::{braced, Ident, ItemImpl, Path, Result, Token};

/// `parts = path::of::the::parts`.
pub struct Named(Path);

impl Parse for Named {
    fn parse(input: ParseStream) -> Result<Self> {
        let name: Ident = input.parse()?;
        if name != "parts" {
            return Err(syn::Error::new(name.span(), "not parts"));
        }
        input.parse::<Token![=]>()?;
        input.parse().map(Self)
    }
}

impl Named {
    /// The parts are asked to write themselves down before this kernel.
    pub fn asked_for(&self, kernel: &ItemImpl) -> TokenStream {
        let Self(parts) = self;
        quote!(#parts! { #kernel })
    }
}

/// Parts as a macro, which writes them down before the kernel that it is given.
pub fn handed_on(name: &Ident, parts: &ItemImpl) -> TokenStream {
    quote! {
        macro_rules! #name {
            ($($kernel:tt)*) => {
                ::rtl_design::kernel_of_parts! { { #parts } $($kernel)* }
            };
        }
        pub(super) use #name;
    }
}

/// Parts and their kernel as one `impl`.
pub struct Both(pub ItemImpl);

impl Parse for Both {
    fn parse(input: ParseStream) -> Result<Self> {
        let parts;
        braced!(parts in input);
        let parts: ItemImpl = syn::parse2(as_written_here(parts.parse()?))?;
        let mut kernel: ItemImpl = syn::parse2(as_written_here(input.parse()?))?;
        kernel.items.extend(parts.items);
        Ok(Self(kernel))
    }
}

/// The same text with one origin: `self` from a macro differs from that of `update`.
fn as_written_here(tokens: TokenStream) -> TokenStream {
    let here = |token: TokenTree| match token {
        TokenTree::Group(group) => {
            let mut inner = Group::new(group.delimiter(), as_written_here(group.stream()));
            inner.set_span(group.span());
            inner.into()
        }
        mut other => {
            other.set_span(other.span().resolved_at(Span::call_site()));
            other
        }
    };
    tokens.into_iter().map(here).collect()
}
