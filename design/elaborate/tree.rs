//! The block tree, as rust-hdl's probe walks it, kept as plain data.

use super::design::MAX_WIDTH_BITS;
use super::docs::{self, Docs};
use super::names::verilog_name;
use super::ElaborateError;
use rust_hdl::prelude::*;

/// A signal or constant of a block.
#[derive(Clone, Debug)]
pub(super) struct AtomNode {
    /// Path within the block, parts joined with `$`, array elements as `name$0`.
    pub key: String,
    /// Name in Verilog.
    pub name: String,
    pub kind: AtomKind,
    pub width_bits: usize,
    pub descriptor: TypeDescriptor,
    /// Present value: the start value of a register, the value of a constant.
    pub value: u128,
}

/// A block with everything in it.
#[derive(Clone, Debug)]
pub(super) struct BlockNode {
    pub name: String,
    /// Instance path from the top, for messages.
    pub path: String,
    pub atoms: Vec<AtomNode>,
    pub children: Vec<BlockNode>,
    /// Field names in declaration order; the elements of an array count once.
    pub fields: Vec<String>,
    pub hdl: Verilog,
    pub timing: Vec<TimingInfo>,
    /// Documentation of the block, if any, and of its enums.
    pub docs: Vec<Docs>,
    /// Lists of at most one signal.
    optional: Vec<String>,
    /// Bundles, and the suffix of their ports' names.
    bundles: Vec<(String, String)>,
    /// Properties to prove.
    pub properties: String,
}

impl BlockNode {
    fn new(name: &str, parent: Option<&BlockNode>, node: &dyn Block) -> Self {
        let timing = node.timing();
        Self {
            name: name.into(),
            path: parent.map_or_else(|| name.into(), |p| format!("{}.{name}", p.path)),
            atoms: vec![],
            children: vec![],
            fields: vec![],
            hdl: node.hdl(),
            docs: docs::of(&timing),
            optional: docs::optional_of(&timing),
            bundles: docs::bundles_of(&timing),
            properties: docs::properties_of(&timing),
            timing,
        }
    }

    pub fn error(
        &self,
        field: &str,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> ElaborateError {
        ElaborateError {
            block: self.path.clone(),
            field: field.into(),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }

    pub fn atom(&self, key: &str) -> Option<&AtomNode> {
        self.atoms.iter().find(|a| a.key == key)
    }

    /// Its constants, in order.
    pub fn constants(&self) -> impl Iterator<Item = &AtomNode> {
        let is_constant = |a: &&AtomNode| matches!(a.kind, AtomKind::Constant);
        self.atoms.iter().filter(is_constant)
    }

    /// The Verilog name of a field.
    fn verilog_name(&self, key: &str) -> String {
        if let Some(field) = key.strip_suffix("$0") {
            if self.optional.iter().any(|optional| optional == field) {
                return verilog_name(field);
            }
        }
        let Some((field, rest)) = key.split_once('$') else {
            return verilog_name(key);
        };
        let Some((_, suffix)) = self.bundles.iter().find(|(bundle, _)| bundle == field) else {
            return verilog_name(key);
        };
        // A port of a list of bundles has its number after its name.
        match rest.split_once('$') {
            Some((number, port)) => verilog_name(&format!("{port}{suffix}${number}")),
            None => verilog_name(&format!("{rest}{suffix}")),
        }
    }

    fn push_field(&mut self, name: &str) {
        let base = name.split('$').next().unwrap_or(name);
        if self.fields.last().is_none_or(|last| last != base) {
            self.fields.push(base.into());
        }
    }
}

/// Walks a block.
pub(super) fn read(top: &dyn Block, name: &str) -> Result<BlockNode, ElaborateError> {
    let mut reader = Reader::default();
    top.accept(name, &mut reader);
    if let Some(error) = reader.error {
        return Err(error);
    }
    reader.top.ok_or_else(|| ElaborateError {
        block: name.into(),
        field: String::new(),
        problem: "is not a block".into(),
        remedy: "derive LogicBlock for it".into(),
    })
}

#[derive(Default)]
struct Reader {
    open: Vec<BlockNode>,
    namespaces: Vec<String>,
    top: Option<BlockNode>,
    error: Option<ElaborateError>,
}

impl Probe for Reader {
    fn visit_start_scope(&mut self, name: &str, node: &dyn Block) {
        if let Some(parent) = self.open.last_mut() {
            parent.push_field(name);
        }
        let block = BlockNode::new(name, self.open.last(), node);
        self.open.push(block);
    }

    fn visit_end_scope(&mut self, _name: &str, _node: &dyn Block) {
        if let Some(block) = self.open.pop() {
            match self.open.last_mut() {
                Some(parent) => parent.children.push(block),
                None => self.top = Some(block),
            }
        }
    }

    fn visit_start_namespace(&mut self, name: &str, _node: &dyn Block) {
        if let (true, Some(block)) = (self.namespaces.is_empty(), self.open.last_mut()) {
            block.push_field(name);
        }
        self.namespaces.push(name.into());
    }

    fn visit_end_namespace(&mut self, _name: &str, _node: &dyn Block) {
        self.namespaces.pop();
    }

    fn visit_atom(&mut self, name: &str, signal: &dyn Atom) {
        let Some(block) = self.open.last_mut() else {
            return;
        };
        if self.namespaces.is_empty() {
            block.push_field(name);
        }
        let key = self
            .namespaces
            .iter()
            .map(String::as_str)
            .chain([name])
            .collect::<Vec<_>>()
            .join("$");
        let name = block.verilog_name(&key);
        let width_bits = signal.bits();
        if width_bits == 0 || width_bits > MAX_WIDTH_BITS {
            let error = block.error(
                &key,
                format!("is {width_bits} bits wide, the limit is 1 to {MAX_WIDTH_BITS}"),
                "split it into several signals, or give the enum a second variant",
            );
            self.error.get_or_insert(error);
            return;
        }
        let Some(value) = literal_value(&signal.verilog()) else {
            let error = block.error(
                &key,
                "has a negative start value",
                "use Bits<N>, signed types are not supported",
            );
            self.error.get_or_insert(error);
            return;
        };
        block.atoms.push(AtomNode {
            key,
            name,
            kind: signal.kind(),
            width_bits,
            descriptor: signal.descriptor(),
            value,
        });
    }
}

/// The value of a literal, if it is not negative and fits.
pub(super) fn literal_value(literal: &VerilogLiteral) -> Option<u128> {
    let text = format!("{literal:x}");
    let (_, digits) = text.split_once("'h")?;
    u128::from_str_radix(digits, 16).ok()
}

/// The width of a literal as its Rust type has it: 1 for `true` and `false`.
pub(super) fn literal_width(literal: &VerilogLiteral) -> usize {
    let text = format!("{literal:x}");
    text.split('\'')
        .next()
        .and_then(|w| w.parse().ok())
        .unwrap_or(0)
}
