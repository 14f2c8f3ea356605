//! Macros that generate the boilerplate of a rust-hdl block; `rtl-design` re-exports them, and their output names `rtl_design`.
//!
//! [`macro@Block`] makes a block from its parts, so that its `new` names only the parts with a parameter. [`macro@kernel`] replaces
//! rust-hdl's `#[hdl_gen]`, and connects clock and reset of every register that the kernel assigns.

mod bundle;
mod comments;
mod connect;
mod elsewhere;
mod parts;
mod registers;

use proc_macro::TokenStream;
use proc_macro2::{Ident, TokenStream as TokenStream2};
use quote::{format_ident, quote, quote_spanned};
use syn::punctuated::Punctuated;
use syn::visit::{visit_angle_bracketed_generic_arguments, Visit};
use syn::{
    parse_macro_input, AngleBracketedGenericArguments, Attribute, Data, DeriveInput, Expr, Field,
    Fields, GenericArgument, GenericParam, ImplItem, ItemImpl, Lit, LitStr, Token, Type, TypePath,
};

/// The parts of a block, with their documentation. Signals and bundles begin empty, registers with 0 or the value of `#[start(...)]`,
/// children marked `#[start]` with their default. All other parts (constants, children, lists, and registers marked
/// `#[given]`) must be passed, by name, to `Self::from_parts`:
///
/// ```ignore
/// #[derive(LogicBlock, Block)]
/// struct Timer {
///     clock: Signal<In, Clock>,
///     #[start(true)]
///     level: Reg<Bit>,
///     last: Constant<Bits<8>>,
/// }
///
/// Self::from_parts(TimerParts { last: Constant::new(last.into()) })
/// ```
///
/// A block without such parts implements `Default` instead.
///
/// `#[optional]` on a list of at most one signal: its name is emitted without a number.
///
/// `#[bundle]` on a field whose type comes from [`macro@ports`]: its ports are emitted with their own names, or, for `#[bundle("_now")]`, with that
/// suffix.
///
/// If the block is the only one in its file, the head of the file is its documentation, including a drawing.
///
/// `#[properties("x.sv")]` on the block names the file with its properties, in the folder of the source.
#[proc_macro_derive(Block, attributes(start, given, optional, bundle, properties))]
pub fn block(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    let name = &input.ident;
    let (generics, arguments, bounds) = input.generics.split_for_impl();
    let Data::Struct(data) = &input.data else {
        return refuse(name, "a block is a struct");
    };
    let Fields::Named(fields) = &data.fields else {
        return refuse(name, "the parts of a block have names");
    };
    let described = described(&input, &fields.named);
    let (mut own, mut given) = (vec![], vec![]);
    for field in &fields.named {
        let (part, kind) = (&field.ident, &field.ty);
        let attribute = |name| attribute(&field.attrs, name);
        match attribute("start") {
            Some(start) if start.meta.require_path_only().is_err() => {
                match start.parse_args::<Expr>() {
                    Ok(start) => own.push(quote!(#part: <#kind>::new(#start))),
                    Err(error) => return error.into_compile_error().into(),
                }
            }
            None if attribute("given").is_some()
                || !(begins_empty(kind)
                    || attribute("bundle").is_some() && !bundle::is_list(kind)) =>
            {
                given.push((part, kind))
            }
            _ => own.push(quote!(#part: ::core::default::Default::default())),
        }
    }
    if given.is_empty() {
        return quote! {
            #described

            impl #generics ::core::default::Default for #name #arguments #bounds {
                fn default() -> Self {
                    Self { #(#own),* }
                }
            }
        }
        .into();
    }
    let parts = format_ident!("{name}Parts");
    let (names, kinds): (Vec<_>, Vec<_>) = given.into_iter().unzip();
    quote! {
        #described

        /// The given parts of this block.
        struct #parts #generics #bounds {
            #(#names: #kinds),*
        }

        impl #generics #name #arguments #bounds {
            fn from_parts(parts: #parts #arguments) -> Self {
                Self { #(#names: parts.#names,)* #(#own),* }
            }
        }
    }
    .into()
}

/// Documentation of an enum and its variants.
#[proc_macro_derive(States)]
pub fn states(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    match &input.data {
        Data::Enum(data) => {
            let states = data.variants.iter().map(|v| (&v.ident, &v.attrs[..]));
            docs(&input, states, Special::default()).into()
        }
        _ => refuse(&input.ident, "states are those of an enum"),
    }
}

/// The documentation of a block.
fn described<'a>(
    input: &'a DeriveInput,
    fields: impl IntoIterator<Item = &'a Field> + Clone,
) -> TokenStream2 {
    let parameters = input.generics.params.iter();
    let mut found = Enums {
        parameters: parameters.filter_map(parameter).collect(),
        enums: vec![],
    };
    let mut special = Special::default();
    let mut named = vec![];
    for field in fields {
        let Some(name) = &field.ident else { continue };
        named.push((name, &field.attrs[..]));
        let attribute = |name| attribute(&field.attrs, name);
        if attribute("optional").is_some() {
            special.optional.push(name);
        }
        match attribute("bundle").map(bundle::suffix) {
            None => found.visit_type(&field.ty),
            Some(Err(error)) => return error.into_compile_error(),
            Some(Ok(suffix)) => special.bundles.push((name, bundle::of(&field.ty), suffix)),
        }
    }
    special.enums = found.enums;
    docs(input, named.into_iter(), special)
}

/// Properties that differ between the parts of a type.
#[derive(Default)]
struct Special<'a> {
    optional: Vec<&'a Ident>,
    /// Fields that are bundles, their types, and the suffix of their ports' names.
    bundles: Vec<(&'a Ident, &'a Type, String)>,
    enums: Vec<&'a Ident>,
}

/// The documentation of a type and its parts.
fn docs<'a>(
    input: &DeriveInput,
    parts: impl Iterator<Item = (&'a Ident, &'a [Attribute])>,
    special: Special,
) -> TokenStream2 {
    let Special {
        optional,
        bundles,
        enums,
    } = special;
    let bundles = bundles.iter().map(|(name, kind, suffix)| {
        let docs = quote!(&<#kind as ::rtl_design::elaborate::docs::Described>::DOCS);
        quote!((stringify!(#name), #suffix, #docs))
    });
    let name = &input.ident;
    let (generics, arguments, bounds) = input.generics.split_for_impl();
    let own = match lines_of_file(name) {
        file if file.is_empty() => lines(&input.attrs).into_iter().cloned().collect(),
        file => file,
    };
    let properties =
        match attribute(&input.attrs, "properties").map(Attribute::parse_args::<LitStr>) {
            None => quote!(""),
            Some(Ok(file)) => quote_spanned!(file.span()=> include_str!(#file)),
            Some(Err(error)) => return error.into_compile_error(),
        };
    let parts = parts.map(|(part, attributes)| documented(part, attributes));
    quote! {
        impl #generics ::rtl_design::elaborate::docs::Described for #name #arguments #bounds {
            const DOCS: ::rtl_design::elaborate::docs::TypeDocs = ::rtl_design::elaborate::docs::TypeDocs {
                name: stringify!(#name),
                lines: &[#(#own),*],
                parts: &[#(#parts),*],
                optional: &[#(stringify!(#optional)),*],
                bundles: &[#(#bundles),*],
                properties: #properties,
                enums: &[#(&<#enums as ::rtl_design::elaborate::docs::Described>::DOCS),*],
            };
        }
    }
}

/// The documentation at the head of the file, with its drawing, of a block that is the only one there.
fn lines_of_file(name: &Ident) -> Vec<Lit> {
    let text = source_of(name.span());
    if text.matches("Block)]\n").count() != 1 {
        return vec![];
    }
    let head = text.lines().map_while(|line| line.strip_prefix("//!"));
    let shown = head.filter(|line| !line.trim_start().starts_with("```"));
    shown
        .map(|line| Lit::Str(LitStr::new(line, name.span())))
        .collect()
}

/// Source text of the file of an item; empty if unavailable.
fn source_of(place: proc_macro2::Span) -> String {
    let file = place.unwrap().local_file();
    file.and_then(|file| std::fs::read_to_string(file).ok())
        .unwrap_or_default()
}

/// A part and the lines of its documentation.
fn documented(part: &Ident, attributes: &[Attribute]) -> TokenStream2 {
    let lines = lines(attributes);
    quote!((stringify!(#part), &[#(#lines),*]))
}

/// The attribute of this name, if there is one.
fn attribute<'a>(attributes: &'a [Attribute], name: &str) -> Option<&'a Attribute> {
    attributes.iter().find(|a| a.path().is_ident(name))
}

/// The lines of a documentation.
fn lines(attributes: &[Attribute]) -> Vec<&Lit> {
    let docs = attributes.iter().filter(|a| a.path().is_ident("doc"));
    let values = docs.filter_map(|a| Some(&a.meta.require_name_value().ok()?.value));
    values
        .filter_map(|value| match value {
            Expr::Lit(literal) => Some(&literal.lit),
            _ => None,
        })
        .collect()
}

/// The name of a type or a number that a block is generic over.
fn parameter(parameter: &GenericParam) -> Option<&Ident> {
    match parameter {
        GenericParam::Type(parameter) => Some(&parameter.ident),
        GenericParam::Const(parameter) => Some(&parameter.ident),
        GenericParam::Lifetime(_) => None,
    }
}

/// Enums that signals and registers have as their type.
struct Enums<'a> {
    parameters: Vec<&'a Ident>,
    enums: Vec<&'a Ident>,
}

impl<'a> Visit<'a> for Enums<'a> {
    fn visit_angle_bracketed_generic_arguments(&mut self, all: &'a AngleBracketedGenericArguments) {
        for argument in &all.args {
            let GenericArgument::Type(Type::Path(TypePath { path, .. })) = argument else {
                continue;
            };
            let Some(name) = path.get_ident() else {
                continue;
            };
            let is_known = self.parameters.contains(&name) || self.enums.contains(&name);
            if !is_known && NO_ENUMS.iter().all(|other| name != other) {
                self.enums.push(name);
            }
        }
        visit_angle_bracketed_generic_arguments(self, all);
    }
}

/// Types of signals and directions that are no enums.
const NO_ENUMS: [&str; 6] = ["In", "Out", "Local", "Bit", "bool", "Clock"];

/// Whether a part of this type needs nobody to say with what it begins: signals and registers.
fn begins_empty(kind: &Type) -> bool {
    let Type::Path(path) = kind else { return false };
    let last = path.path.segments.last();
    last.is_some_and(|last| {
        ["Signal", "Reg", "SyncReg", "FallReg"]
            .iter()
            .any(|name| last.ident == name)
    })
}

/// Ports that travel together: of `struct Frame` the types `FrameOut`, for the block that drives them, and `FrameIn`, for one that takes
/// them. Fields are written with what they carry; one marked `#[back]` runs the other way.
///
/// ```ignore
/// /// What a frame brought.
/// #[ports]
/// pub struct Frame {
///     /// Strobe: it is new.
///     pub strobe: Bit,
///     /// The other end takes it.
///     #[back]
///     pub taken: Bit,
/// }
/// ```
///
/// A block has them by `#[bundle]`, see [`macro@Block`]. In a kernel they are wired as rust-hdl's interfaces are: `FrameOut::link` from a
/// child's bundle to the block's own of the same direction, `FrameIn::link` from the block's own to a child's, and `FrameOut::join` from the
/// bundle of one child to that of another.
#[proc_macro_attribute]
pub fn ports(arguments: TokenStream, item: TokenStream) -> TokenStream {
    if !arguments.is_empty() {
        let span = proc_macro2::Span::call_site();
        return refuse(&Ident::new("ports", span), "ports takes no arguments");
    }
    bundle::expand(parse_macro_input!(item as DeriveInput))
        .unwrap_or_else(|error| error.into_compile_error())
        .into()
}

/// The kernel of a block: `#[hdl_gen]` of rust-hdl, in which each register that has its `d.next` assigned holds its value
/// otherwise, has the block's clock, and, unless the kernel assigns its `reset.next`, the block's reset.
///
/// It passes on the notes of [`macro@Block`].
///
/// `connect!(self.receiver <= self.settings; width, command = mode_command)` connects ports to ports: ports with equal names, or the first to the
/// second of a pair.
///
/// `#[kernel(clk_i, rst_i)]` for a clock and a reset with other names than `clock` and `reset`. The kernel connects registers in lists itself.
///
/// Its comments are emitted before the same statements.
///
/// A long kernel is divided into parts: other functions next to `update` are inlined where it, or one of them, calls them, as a statement or
/// as the arm of a match. The documentation of a part is emitted before its first statement.
///
/// ```ignore
/// #[kernel]
/// impl Logic for Timer {
///     fn update(&mut self) {
///         self.count();
///         match self.state.q.val() {
///             State::Waiting => self.wait(),
///             _ => {}
///         }
///     }
///
///     /// Cycles since the start.
///     fn count(&mut self) {
///         self.cycles.d.next = self.cycles.q.val() + 1;
///     }
///
///     /// The end of the time.
///     fn wait(&mut self) { /* ... */ }
/// }
/// ```
///
/// Parts in another file are an `impl` with [`macro@kernel_parts`] and a name there, which the kernel gives: `#[kernel(parts = states::waits)]`.
#[proc_macro_attribute]
pub fn kernel(arguments: TokenStream, item: TokenStream) -> TokenStream {
    let mut item = parse_macro_input!(item as ItemImpl);
    lift_comments(&mut item);
    if let Ok(elsewhere) = syn::parse::<elsewhere::Named>(arguments.clone()) {
        return elsewhere.asked_for(&item).into();
    }
    let parser = Punctuated::<Ident, Token![,]>::parse_terminated;
    let names = parse_macro_input!(arguments with parser);
    finished(names, item)
}

/// Parts of a kernel in another file; the argument is the name by which the kernel includes them.
///
/// ```ignore
/// #[kernel_parts(waits)]
/// impl Timer {
///     /// The end of the time.
///     fn wait(&mut self) { /* ... */ }
/// }
/// ```
#[proc_macro_attribute]
pub fn kernel_parts(arguments: TokenStream, item: TokenStream) -> TokenStream {
    let name = parse_macro_input!(arguments as Ident);
    let mut item = parse_macro_input!(item as ItemImpl);
    lift_comments(&mut item);
    elsewhere::handed_on(&name, &item).into()
}

/// A kernel with parts of another file: the expansion of [`macro@kernel`] and [`macro@kernel_parts`].
#[doc(hidden)]
#[proc_macro]
pub fn kernel_of_parts(both: TokenStream) -> TokenStream {
    let elsewhere::Both(item) = parse_macro_input!(both as elsewhere::Both);
    finished(Punctuated::new(), item)
}

/// Puts the comments of an `impl` into its functions.
fn lift_comments(item: &mut ItemImpl) {
    let source = source_of(item.impl_token.span);
    let source: Vec<String> = source.lines().map(str::to_owned).collect();
    for inner in &mut item.items {
        if let ImplItem::Fn(function) = inner {
            comments::lift(function, &source);
        }
    }
}

/// The kernel, out of an `impl` with all of its parts.
fn finished(names: Punctuated<Ident, Token![,]>, mut item: ItemImpl) -> TokenStream {
    let kernel = parts::kernel_of(&mut item)
        .and_then(|kernel| registers::whole_kernel(names.into_iter().collect(), kernel));
    match kernel {
        Err(wrong) => wrong.into_compile_error().into(),
        Ok(kernel) => {
            item.items.push(ImplItem::Verbatim(kernel));
            quote! {
                // A comment for rust-hdl, and nothing for the compiler.
                #[allow(unused_macros)]
                macro_rules! comment {
                    ($text:literal) => {};
                }

                #item
            }
            .into()
        }
    }
}

fn refuse(place: &Ident, text: &str) -> TokenStream {
    syn::Error::new(place.span(), text)
        .into_compile_error()
        .into()
}
