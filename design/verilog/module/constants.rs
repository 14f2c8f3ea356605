//! Constants of a module: its parameters and states.

use super::expression::{literal, named_literal};
use super::ModulePrinter;
use crate::elaborate::properties::words;
use crate::elaborate::Parameter;
use crate::printing::{variant_name, with_comment};
use crate::verilog::text::{comment, vector, INDENT, MARK};

impl ModulePrinter<'_> {
    /// Named constants of the logic, with their meaning.
    pub(super) fn constants(&self) -> String {
        let mut out = String::new();
        for parameter in self.scope.parameters() {
            out.push_str(&comment(&parameter.docs, INDENT));
            out.push_str(&format!("{INDENT}{}\n", parameter_line(parameter)));
        }
        for state in self.scope.states() {
            out.push_str(&comment(state.docs, INDENT));
            let line = state_line(state.value, state.width_bits, state.name);
            out.push_str(&with_comment(MARK, &line, state.doc, INDENT));
        }
        match out.is_empty() {
            true => out,
            false => format!("{out}\n"),
        }
    }

    /// Properties, below the constants that nothing but they name.
    pub(super) fn with_constants(&self, properties: &str) -> String {
        let words = words(properties);
        let mut lines = vec![];
        for parameter in self.scope.other_parameters() {
            if words.contains(&*parameter.name) {
                lines.push(parameter_line(parameter));
            }
        }
        for enum_type in &self.design.enums {
            for variant in 0..enum_type.variants.len() {
                let name = variant_name(enum_type, variant);
                if words.contains(&*name) && !self.scope.says(&name) {
                    lines.push(state_line(variant as u128, enum_type.width_bits, &name));
                }
            }
        }
        lines.push(properties.into());
        lines.join("\n")
    }
}

fn parameter_line(parameter: &Parameter) -> String {
    let width_bits = parameter.width_bits;
    let value = named_literal(&parameter.name, parameter.value, width_bits);
    let vector = vector(width_bits);
    format!("localparam {vector:>7} {} = {value};", parameter.name)
}

fn state_line(value: u128, width_bits: usize, name: &str) -> String {
    let value = literal(value, width_bits);
    format!("localparam {:>7} {name} = {value};", vector(width_bits))
}
