//! Bundles: ports that travel together, said once for both ends.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{
    Attribute, Data, DeriveInput, Error, Field, Fields, GenericArgument, LitStr, Meta,
    PathArguments, Result, Type,
};

/// Marks a port that runs the other way.
const BACK: &str = "back";

/// Both ends of these ports.
pub fn expand(input: DeriveInput) -> Result<TokenStream> {
    let refuse = |text| Err(Error::new(input.ident.span(), text));
    let Data::Struct(data) = &input.data else {
        return refuse("ports are the fields of a struct");
    };
    let Fields::Named(fields) = &data.fields else {
        return refuse("ports have names");
    };
    if !input.generics.params.is_empty() {
        return refuse("ports have no parameters");
    }
    let names = ["Out", "In"].map(|end| format_ident!("{}{end}", input.ident));
    let [out, taken] = &names;
    let (visible, attributes) = (&input.vis, &input.attrs);
    let idents: Vec<_> = fields.named.iter().map(|field| &field.ident).collect();
    let ends = [(out, taken, true), (taken, out, false)].map(|(name, other, drives)| {
        let ports = fields.named.iter().map(|field| port(field, drives));
        let pins = fields.named.iter().map(|field| {
            let (ident, is_input) = (&field.ident, !is_driven(field, drives));
            quote!((stringify!(#ident), #is_input, |bundle| &mut bundle.#ident))
        });
        let named = fields.named.iter();
        let named = named.filter_map(|f| Some((f.ident.as_ref()?, &f.attrs)));
        let documented = named.map(|(port, attributes)| super::documented(port, attributes));
        quote! {
            #(#attributes)*
            #[derive(Clone, Debug, Default, LogicInterface)]
            #visible struct #name { #(#ports),* }

            impl #name {
                /// Wires it to the other end, both of them children's.
                #visible fn join(&mut self, other: &mut #other) {
                    #(self.#idents.join(&mut other.#idents);)*
                }
            }

            impl ::rtl_design::engine::Bundle for #name {
                const PINS: &'static [(&'static str, bool, ::rtl_design::engine::Access<Self>)] =
                    &[#(#pins),*];
            }

            impl ::rtl_design::elaborate::docs::Described for #name {
                const DOCS: ::rtl_design::elaborate::docs::TypeDocs = ::rtl_design::elaborate::docs::TypeDocs {
                    parts: &[#(#documented),*],
                    ..::rtl_design::elaborate::docs::TypeDocs::named(stringify!(#name))
                };
            }
        }
    });
    Ok(quote!(#(#ends)*))
}

/// One port at the end that drives the bundle, or at the other.
fn port(field: &Field, drives: bool) -> TokenStream {
    let Field {
        attrs,
        vis,
        ident,
        ty,
        ..
    } = field;
    let kept = attrs.iter().filter(|a| !a.path().is_ident(BACK));
    let direction = match is_driven(field, drives) {
        true => quote!(Out),
        false => quote!(In),
    };
    quote!(#(#kept)* #vis #ident: Signal<#direction, #ty>)
}

/// Whether an end that drives the bundle, or the other one, drives this port.
fn is_driven(field: &Field, drives: bool) -> bool {
    drives == super::attribute(&field.attrs, BACK).is_none()
}

/// Suffix that `#[bundle("_now")]` appends to the names of its ports; empty for `#[bundle]`.
pub fn suffix(attribute: &Attribute) -> Result<String> {
    match &attribute.meta {
        Meta::Path(_) => Ok(String::new()),
        _ => Ok(attribute.parse_args::<LitStr>()?.value()),
    }
}

/// The type of a bundle; of a list of bundles that of one.
pub fn of(kind: &Type) -> &Type {
    element(kind).unwrap_or(kind)
}

/// Whether it is a list of bundles.
pub fn is_list(kind: &Type) -> bool {
    element(kind).is_some()
}

fn element(kind: &Type) -> Option<&Type> {
    let Type::Path(path) = kind else { return None };
    let last = path.path.segments.last()?;
    match &last.arguments {
        PathArguments::AngleBracketed(inner) if last.ident == "Vec" => match inner.args.first() {
            Some(GenericArgument::Type(inner)) => Some(inner),
            _ => None,
        },
        _ => None,
    }
}
