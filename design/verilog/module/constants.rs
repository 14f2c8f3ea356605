//! Constants of a module: its parameters and states.

use super::expression::{literal, named_literal};
use super::ModulePrinter;
use crate::elaborate::properties::words;
use crate::elaborate::EnumId;
use crate::printing::variant_name;
use crate::verilog::text::{comment, vector, INDENT};

impl ModulePrinter<'_> {
    /// What is named in the logic, with what it is.
    pub(super) fn constants(&self) -> String {
        let mut out = String::new();
        for index in &self.used_parameters {
            out.push_str(&comment(&self.module.parameters[*index].docs, INDENT));
            out.push_str(&format!("{INDENT}{}\n", self.parameter_line(*index)));
        }
        let mut last = None;
        for ((enum_id, variant), name) in &self.variants {
            let enum_type = &self.design.enums[*enum_id];
            if last.replace(*enum_id) != Some(*enum_id) {
                let docs = match enum_type.docs.is_empty() {
                    true => std::slice::from_ref(&enum_type.name),
                    false => &enum_type.docs[..],
                };
                out.push_str(&comment(docs, INDENT));
            }
            let docs = enum_type.variant_docs.get(*variant);
            let doc = docs.and_then(|docs| docs.first());
            let doc = doc.map_or(String::new(), |doc| format!(" // {doc}"));
            let line = self.variant_line(*enum_id, *variant, name);
            out.push_str(&format!("{INDENT}{line}{doc}\n"));
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
        for (index, parameter) in self.module.parameters.iter().enumerate() {
            if words.contains(&*parameter.name) && !self.used_parameters.contains(&index) {
                lines.push(self.parameter_line(index));
            }
        }
        for (enum_id, enum_type) in self.design.enums.iter().enumerate() {
            for variant in 0..enum_type.variants.len() {
                let name = variant_name(enum_type, variant);
                let is_there = self.variants.values().any(|known| *known == name);
                if words.contains(&*name) && !is_there {
                    lines.push(self.variant_line(enum_id, variant, &name));
                }
            }
        }
        lines.push(properties.into());
        lines.join("\n")
    }

    fn parameter_line(&self, index: usize) -> String {
        let parameter = &self.module.parameters[index];
        let width_bits = parameter.width_bits;
        let value = named_literal(&parameter.name, parameter.value, width_bits);
        let vector = vector(width_bits);
        format!("localparam {vector:>7} {} = {value};", parameter.name)
    }

    fn variant_line(&self, enum_id: EnumId, variant: usize, name: &str) -> String {
        let width_bits = self.design.enums[enum_id].width_bits;
        let value = literal(variant as u128, width_bits);
        format!("localparam {:>7} {name} = {value};", vector(width_bits))
    }
}
