//! Constants of a module: its parameters and states.

use super::ModulePrinter;
use crate::printing::{with_comment, INDENT};
use crate::vhdl::text::{bits, comment, named_literal, plain, subtype, MARK};

impl ModulePrinter<'_> {
    /// Named constants of the logic, with their meaning.
    pub(super) fn constants(&self) -> String {
        let mut out = String::new();
        for parameter in self.scope.parameters() {
            let (name, width_bits) = (&parameter.name, parameter.width_bits);
            let value = named_literal(name, parameter.value, width_bits);
            out.push_str(&comment(&parameter.docs, INDENT));
            let subtype = subtype(width_bits);
            out.push_str(&format!(
                "{INDENT}constant {name} : {subtype} := {value};\n"
            ));
        }
        for state in self.scope.states() {
            out.push_str(&comment(state.docs, INDENT));
            let subtype = subtype(state.width_bits);
            // A string, which a case takes as its choice.
            let value = match state.width_bits {
                1..=3 => super::expression::choice(state.value, state.width_bits),
                width_bits => bits(state.value, width_bits),
            };
            let (name, width) = (state.name, state.name_width);
            let line = format!("constant {name:width$} : {subtype} := {value};");
            out.push_str(&with_comment(
                MARK,
                &line,
                state.doc.map(|line| plain(line)).as_ref(),
                INDENT,
            ));
        }
        match out.is_empty() {
            true => out,
            false => format!("{out}\n"),
        }
    }
}
