//! Constants of a module: its parameters and states.

use super::ModulePrinter;
use crate::printing::INDENT;
use crate::vhdl::text::{bits, comment, named_literal, subtype};

impl ModulePrinter<'_> {
    /// What is named in the logic, with what it is.
    pub(super) fn constants(&self) -> String {
        let mut out = String::new();
        for index in &self.used_parameters {
            let parameter = &self.module.parameters[*index];
            let (name, width_bits) = (&parameter.name, parameter.width_bits);
            let value = named_literal(name, parameter.value, width_bits);
            out.push_str(&comment(&parameter.docs, INDENT));
            let subtype = subtype(width_bits);
            out.push_str(&format!(
                "{INDENT}constant {name} : {subtype} := {value};\n"
            ));
        }
        let names = |enum_id| {
            self.variants
                .iter()
                .filter(move |((id, _), _)| *id == enum_id)
        };
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
            let width = names(*enum_id).map(|(_, name)| name.len()).max();
            let width = width.unwrap_or(0);
            let docs = enum_type.variant_docs.get(*variant);
            let doc = docs.and_then(|docs| docs.first());
            let doc = doc.map_or(String::new(), |doc| {
                comment(std::slice::from_ref(doc), " ")
                    .trim_end()
                    .to_string()
            });
            let subtype = subtype(enum_type.width_bits);
            // A string, which a case takes as its choice.
            let value = match enum_type.width_bits {
                1..=3 => super::expression::choice(*variant as u128, enum_type.width_bits),
                width_bits => bits(*variant as u128, width_bits),
            };
            out.push_str(&format!(
                "{INDENT}constant {name:width$} : {subtype} := {value};{doc}\n"
            ));
        }
        match out.is_empty() {
            true => out,
            false => format!("{out}\n"),
        }
    }
}
