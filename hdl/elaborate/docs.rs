//! Documentation of blocks, fields and states, read from the sources: rust-hdl's tree does not carry it.
//!
//! The tree does not carry type names either. A block is found here by its fields: their names in order, and
//! direction and width where the source says them plainly.

use super::tree::BlockNode;
use rust_hdl::prelude::AtomKind;
use std::sync::OnceLock;

/// The sources of every block of this crate. A test names a block that is missing here.
pub const SOURCES: &[&str] = &[
    include_str!("../add_info.rs"),
    include_str!("../bus/apb.rs"),
    include_str!("../bus/axi_lite.rs"),
    include_str!("../bus/parallel.rs"),
    include_str!("../bus/spi.rs"),
    include_str!("../bus/wishbone.rs"),
    include_str!("../bus/word_access.rs"),
    include_str!("../card.rs"),
    include_str!("../card/uart.rs"),
    include_str!("../channel.rs"),
    include_str!("../channel_registers.rs"),
    include_str!("../channel_trigger.rs"),
    include_str!("../clock_gen.rs"),
    include_str!("../command_sender.rs"),
    include_str!("../command_shape.rs"),
    include_str!("../config_ring.rs"),
    include_str!("../crc5.rs"),
    include_str!("../direct.rs"),
    include_str!("../encoder_port.rs"),
    include_str!("../frame_settings.rs"),
    include_str!("../half_period.rs"),
    include_str!("../input_filter.rs"),
    include_str!("../interrupt.rs"),
    include_str!("../line_delay.rs"),
    include_str!("../line_monitor.rs"),
    include_str!("../phase_tracker.rs"),
    include_str!("../line_health.rs"),
    include_str!("../sure_bit.rs"),
    include_str!("../memory.rs"),
    include_str!("../receiver.rs"),
    include_str!("../reg.rs"),
    include_str!("../register_bank.rs"),
    include_str!("../sequencer.rs"),
    include_str!("../service.rs"),
    include_str!("../service/channel.rs"),
    include_str!("../snapshot.rs"),
    include_str!("../stream.rs"),
    include_str!("../stream/buffer.rs"),
    include_str!("../stream/channel.rs"),
    include_str!("../stream/run.rs"),
    include_str!("../t_format/bit_grid.rs"),
    include_str!("../t_format/channel.rs"),
    include_str!("../t_format/dsp.rs"),
    include_str!("../t_format/exchange.rs"),
    include_str!("../t_format/field_order.rs"),
    include_str!("../t_format/outcome.rs"),
    include_str!("../t_format/port.rs"),
    include_str!("../t_format/primary.rs"),
    include_str!("../t_format/reply.rs"),
    include_str!("../t_format/request_bits.rs"),
    include_str!("../timebase.rs"),
    include_str!("../transaction.rs"),
    include_str!("../transaction/primary.rs"),
    include_str!("../transaction/verdict.rs"),
    include_str!("../trigger.rs"),
    include_str!("../uart.rs"),
    include_str!("../uart_bridge.rs"),
    include_str!("../whole_result.rs"),
];

/// A struct or enum of the sources.
#[derive(Clone, Debug)]
pub(super) struct TypeDocs {
    pub name: String,
    pub docs: Vec<String>,
    pub fields: Vec<FieldDocs>,
    pub is_enum: bool,
}

/// A field or variant.
#[derive(Clone, Debug)]
pub(super) struct FieldDocs {
    pub name: String,
    pub docs: Vec<String>,
    /// The type as written, without spaces.
    pub type_text: String,
}

/// Every struct and enum of the sources.
pub(super) fn types() -> &'static [TypeDocs] {
    static TYPES: OnceLock<Vec<TypeDocs>> = OnceLock::new();
    TYPES.get_or_init(|| SOURCES.iter().flat_map(|source| parse(source)).collect())
}

fn parse(source: &str) -> Vec<TypeDocs> {
    let Ok(file) = syn::parse_file(source) else {
        return vec![]; // a source that compiled also parses
    };
    file.items
        .iter()
        .filter_map(|item| match item {
            syn::Item::Struct(item) => Some(TypeDocs {
                name: item.ident.to_string(),
                docs: docs(&item.attrs),
                fields: item.fields.iter().filter_map(field).collect(),
                is_enum: false,
            }),
            syn::Item::Enum(item) => Some(TypeDocs {
                name: item.ident.to_string(),
                docs: docs(&item.attrs),
                fields: item
                    .variants
                    .iter()
                    .map(|variant| FieldDocs {
                        name: variant.ident.to_string(),
                        docs: docs(&variant.attrs),
                        type_text: String::new(),
                    })
                    .collect(),
                is_enum: true,
            }),
            _ => None,
        })
        .collect()
}

fn field(field: &syn::Field) -> Option<FieldDocs> {
    use quote::ToTokens;
    Some(FieldDocs {
        name: field.ident.as_ref()?.to_string(),
        docs: docs(&field.attrs),
        type_text: field.ty.to_token_stream().to_string().replace(' ', ""),
    })
}

fn docs(attributes: &[syn::Attribute]) -> Vec<String> {
    attributes
        .iter()
        .filter(|attribute| attribute.path().is_ident("doc"))
        .filter_map(|attribute| match &attribute.meta {
            syn::Meta::NameValue(pair) => match &pair.value {
                syn::Expr::Lit(syn::ExprLit {
                    lit: syn::Lit::Str(text),
                    ..
                }) => Some(plain(&text.value())),
                _ => None,
            },
            _ => None,
        })
        .collect()
}

/// A line of documentation without Rust's link brackets: `[`Reg`]` and `[text](target)` become their text.
fn plain(line: &str) -> String {
    let mut out = String::new();
    let mut rest = line.trim_end().strip_prefix(' ').unwrap_or(line.trim_end());
    while let Some((before, after)) = rest.split_once("[`") {
        let Some((name, after)) = after.split_once("`]") else {
            break;
        };
        out.push_str(before);
        out.push_str(name.rsplit("::").next().unwrap_or(name));
        rest = match after
            .strip_prefix('(')
            .and_then(|link| link.split_once(')'))
        {
            Some((_, after)) => after,
            None => after,
        };
    }
    out.push_str(rest);
    out.replace('`', "")
}

/// The block type that `block` is an instance of: `Ok(None)` if it is not in the sources, the candidates if it could be several.
pub(super) fn find(block: &BlockNode) -> Result<Option<&'static TypeDocs>, Vec<&'static str>> {
    let found: Vec<&TypeDocs> = types()
        .iter()
        .filter(|t| !t.is_enum && fits(t, block))
        .collect();
    match found[..] {
        [] => Ok(None),
        [found] => Ok(Some(found)),
        _ => Err(found.iter().map(|t| t.name.as_str()).collect()),
    }
}

/// The enum of the sources with this name and these variants.
pub(super) fn find_enum(name: &str, variants: &[String]) -> Option<&'static TypeDocs> {
    types()
        .iter()
        .find(|t| t.is_enum && t.name == name && t.fields.iter().map(|f| &f.name).eq(variants))
}

fn fits(candidate: &TypeDocs, block: &BlockNode) -> bool {
    let mut visited = block.fields.iter().peekable();
    for field in candidate.fields.iter().filter(|f| !f.name.starts_with('_')) {
        if visited.peek() == Some(&&field.name) {
            visited.next();
            if !fits_type(&field.type_text, &field.name, block) {
                return false;
            }
        } else if !field.type_text.starts_with("Vec<") {
            return false; // only an array without elements leaves no trace
        }
    }
    visited.next().is_none()
}

/// Whether the type as written can be that of the visited field.
fn fits_type(type_text: &str, name: &str, block: &BlockNode) -> bool {
    let Some(atom) = block.atom(name) else {
        return true;
    };
    let kind_text = match atom.kind {
        AtomKind::InputParameter => "Signal<In,",
        AtomKind::OutputParameter => "Signal<Out,",
        AtomKind::LocalSignal => "Signal<Local,",
        AtomKind::Constant => "Constant<",
        _ => return true,
    };
    let Some(inner) = type_text.strip_prefix(kind_text) else {
        return false;
    };
    let inner = inner.strip_suffix('>').unwrap_or(inner);
    match inner
        .strip_prefix("Bits<")
        .and_then(|width| width.strip_suffix('>'))
    {
        Some(width) => width
            .parse()
            .map_or(true, |width: usize| width == atom.width_bits),
        None => !matches!(inner, "Bit" | "bool" | "Clock") || atom.width_bits == 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_in_documentation_become_plain_text() {
        assert_eq!(
            plain(" Like [`crate::reg::Reg`], see [`x`](y)."),
            "Like Reg, see x."
        );
        assert_eq!(plain("  `a` [b]"), " a [b]");
    }

    #[test]
    fn every_block_of_the_crate_is_listed() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"));
        let missing: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|e| e == "rs"))
            .filter(|path| {
                let text = std::fs::read_to_string(path).unwrap();
                text.contains("LogicBlock") && !SOURCES.contains(&text.as_str())
            })
            .map(|path| path.display().to_string())
            .collect();
        assert!(
            missing.is_empty(),
            "add to elaborate::docs::SOURCES: {missing:?}"
        );
    }
}
