//! The names of a module while it is printed: those in use, and the constants that its text says.

use super::{used_parameters, variant_name, Names};
use crate::elaborate::{Design, EnumId, Expr, ExprKind, Module, Parameter, Register};
use std::collections::{BTreeMap, BTreeSet};

/// A module's names.
pub(crate) struct Scope<'a> {
    design: &'a Design,
    module: &'a Module,
    names: Names,
    /// Names of the states that are said.
    states: BTreeMap<(EnumId, usize), String>,
    parameters: BTreeSet<usize>,
    /// Replacement for a reserved name.
    emitted: fn(&str) -> String,
}

/// A state that the text says.
pub(crate) struct State<'a> {
    /// Name.
    pub name: &'a str,
    pub value: u128,
    pub width_bits: usize,
    /// Meaning, in one line.
    pub doc: Option<&'a String>,
    /// Documentation of its type, at the first use.
    pub docs: &'a [String],
    /// The longest name of a state of its type.
    pub name_width: usize,
}

impl<'a> Scope<'a> {
    pub fn new(design: &'a Design, module: &'a Module, emitted: fn(&str) -> String) -> Self {
        let names = module.nets.iter().map(|n| &n.name);
        let names = names.chain(module.parameters.iter().map(|p| &p.name));
        let names = names.chain(module.instances.iter().map(|i| &i.name));
        let names = names.chain(module.memories.iter().map(|m| &m.name));
        Self {
            design,
            module,
            names: Names::new(names),
            states: BTreeMap::new(),
            parameters: used_parameters(module),
            emitted,
        }
    }

    /// `base`, or `base` with a number if that is taken.
    pub fn unique(&mut self, base: &str) -> String {
        self.names.unique(base)
    }

    /// The constant of a state.
    pub fn state(&mut self, enum_id: EnumId, variant: usize) -> String {
        if let Some(name) = self.states.get(&(enum_id, variant)) {
            return name.clone();
        }
        let base = (self.emitted)(&variant_name(&self.design.enums[enum_id], variant));
        let name = self.unique(&base);
        self.states.insert((enum_id, variant), name.clone());
        name
    }

    /// The constant of the state that a register starts with, if it holds one.
    pub fn start_state(&mut self, register: &Register) -> Option<String> {
        let enum_id = self.module.nets[register.q].enum_id?;
        let variant = register.start as usize;
        let is_one = variant < self.design.enums[enum_id].variants.len();
        is_one.then(|| self.state(enum_id, variant))
    }

    /// The value of an expression that is a constant with a name.
    pub fn named_value(&self, expr: &Expr) -> Option<u128> {
        match expr.kind {
            ExprKind::Variant(_, variant) => Some(variant as u128),
            ExprKind::Parameter(index) => Some(self.module.parameters[index].value),
            _ => None,
        }
    }

    /// The parameters that are said.
    pub fn parameters(&self) -> impl Iterator<Item = &'a Parameter> + '_ {
        let module = self.module;
        self.parameters
            .iter()
            .map(move |index| &module.parameters[*index])
    }

    /// Those that are not.
    pub fn other_parameters(&self) -> impl Iterator<Item = &'a Parameter> + '_ {
        let all = self.module.parameters.iter().enumerate();
        all.filter(|(index, _)| !self.parameters.contains(index))
            .map(|(_, parameter)| parameter)
    }

    /// Whether a state of this name is said.
    pub fn says(&self, name: &str) -> bool {
        self.states.values().any(|known| known == name)
    }

    /// The states that are said, type by type.
    pub fn states(&self) -> Vec<State<'_>> {
        let width = |id: EnumId| {
            let states = self.states.iter().filter(|((other, _), _)| *other == id);
            states.map(|(_, name)| name.len()).max().unwrap_or(0)
        };
        let mut last = None;
        let mut found = vec![];
        for ((enum_id, variant), name) in &self.states {
            let enum_type = &self.design.enums[*enum_id];
            let docs = match enum_type.docs.is_empty() {
                true => std::slice::from_ref(&enum_type.name),
                false => &enum_type.docs[..],
            };
            let is_first = last.replace(*enum_id) != Some(*enum_id);
            let lines = enum_type.variant_docs.get(*variant);
            found.push(State {
                name,
                value: *variant as u128,
                width_bits: enum_type.width_bits,
                doc: lines.and_then(|lines| lines.first()),
                docs: if is_first { docs } else { &[] },
                name_width: width(*enum_id),
            });
        }
        found
    }
}
