//! The register table in kernels.

mod places;

use proc_macro::TokenStream;
use quote::quote;
use syn::{parse_macro_input, ItemImpl};

/// `rtl_design::kernel` with access to the register table by name. `field!(word, config.frame.skip)` is
/// a field of a word (a bit, if one bit wide), `place!(value, config.frame.skip)` a word of 32 bits with the value in that place.
#[proc_macro_attribute]
pub fn kernel(arguments: TokenStream, item: TokenStream) -> TokenStream {
    let mut item = parse_macro_input!(item as ItemImpl);
    if let Err(wrong) = places::resolve(&mut item) {
        return wrong.into_compile_error().into();
    }
    let arguments = proc_macro2::TokenStream::from(arguments);
    quote! {
        #[::rtl_design::kernel(#arguments)]
        #item
    }
    .into()
}
