//! VHDL from a [`Design`]: one entity per block type, meant to be read. The text is VHDL-93 and VHDL-2008 at once.
//!
//! One bit is `std_logic`, more are `unsigned`; ports of the top are `std_logic_vector`, as everyone expects them at an entity that is
//! instantiated. Every operator has operands of the width of its result. A small package has functions for constructs missing in VHDL-93 (bits of an
//! expression, a comparison as a bit).
//!
//! Named constants are constants here, too, not generics: a module has one set of values, and its widths may follow from them.

mod clocked;
mod module;
mod names;
mod package;
mod text;

pub use crate::printing::Header;
pub use names::{emitted_name, named};
pub use package::package_name;

use crate::elaborate::{Design, Module, ModuleId};
use text::MARK;

/// The design that the text is of: with the names of the text, and without what its configuration never uses.
pub fn as_printed(design: &Design) -> Design {
    named(design).trimmed()
}

/// Prints a design as one file, in the order in which compilers want it: the package, then each entity below those that it instantiates.
pub fn print(design: &Design, header: &Header) -> String {
    let design = &as_printed(design);
    let mut out = header.long(MARK, design);
    out.push('\n');
    out.push_str(&package::text(design));
    for module in design.modules.iter().rev() {
        out.push('\n');
        out.push_str(&module::print(design, module));
    }
    out
}

/// The file of an entity or a package.
pub fn file_name(unit: &str) -> String {
    format!("{unit}.vhd")
}

/// Prints a design as one file for the package and one for each entity, in the order in which compilers want them, the top last: file
/// names and texts.
pub fn print_files(design: &Design, header: &Header) -> Vec<(String, String)> {
    let design = &as_printed(design);
    let package = package_name(design);
    let head = header.short(MARK, &package);
    let first = format!("{head}\n{}", package::text(design));
    let file = |(index, module): (usize, &Module)| {
        let head = match index {
            0 => header.long(MARK, design),
            _ => header.short(MARK, &module.name),
        };
        let text = module::print(design, module);
        (file_name(&module.name), format!("{head}\n{text}"))
    };
    let entities = design.modules.iter().enumerate().rev().map(file);
    std::iter::once((file_name(&package), first))
        .chain(entities)
        .collect()
}

/// Another architecture of a module, for a simulation: `design` is as [`as_printed`] gives it, and differs from what has been printed inside
/// that module only.
pub fn print_architecture(design: &Design, module: ModuleId, name: &str) -> String {
    module::print_architecture(design, &design.modules[module], name)
}
