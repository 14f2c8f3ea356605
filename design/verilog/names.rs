//! Names that Verilog-2005 allows but that tools reading every file as SystemVerilog refuse.

use crate::elaborate::Design;

/// Words of SystemVerilog that are none of Verilog-2005.
const LATER_KEYWORDS: &[&str] = &[
    "bit",
    "break",
    "byte",
    "checker",
    "class",
    "clocking",
    "const",
    "continue",
    "cover",
    "do",
    "enum",
    "export",
    "extends",
    "extern",
    "final",
    "global",
    "iff",
    "import",
    "inside",
    "int",
    "interface",
    "logic",
    "longint",
    "mailbox",
    "new",
    "null",
    "package",
    "packed",
    "priority",
    "program",
    "property",
    "protected",
    "pure",
    "rand",
    "randc",
    "ref",
    "return",
    "sequence",
    "shortint",
    "static",
    "string",
    "struct",
    "super",
    "this",
    "throughout",
    "type",
    "typedef",
    "union",
    "unique",
    "var",
    "virtual",
    "void",
    "with",
    "within",
];

/// The name that a net, port or instance has in the emitted text: keywords of SystemVerilog get `_value` appended.
pub fn emitted_name(name: &str) -> String {
    match LATER_KEYWORDS.contains(&name) {
        true => format!("{name}_value"),
        false => name.into(),
    }
}

/// The design with its emitted names.
pub(super) fn with_emitted_names(design: &Design) -> Design {
    let mut design = design.clone();
    for module in &mut design.modules {
        let nets = module.nets.iter_mut().map(|n| &mut n.name);
        for name in nets.chain(module.memories.iter_mut().map(|m| &mut m.name)) {
            *name = emitted_name(name);
        }
        // A net of a child with the name of an instance would hide that instance.
        for instance in &mut module.instances {
            instance.name = format!("u_{}", instance.name);
        }
    }
    design
}
