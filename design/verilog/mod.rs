//! Verilog-2005 from a [`Design`]: one module per block type, meant to be read.
//!
//! Every printed operator has operands of the width of its result, so Verilog's rules for the width of an expression
//! never change a value. Constructs that Verilog cannot express at once (bits of an expression) get a separate net.

mod clocked;
mod module;
mod names;
mod text;

pub use crate::printing::Header;
pub use names::{emitted_name, named};

use crate::elaborate::{Design, Module};
use text::MARK;

/// The design that the text is of: with the names of the text, and without what its configuration never uses.
pub fn as_printed(design: &Design) -> Design {
    named(design).trimmed()
}

/// Prints a design as one file, the top module first.
pub fn print(design: &Design, header: &Header) -> String {
    let design = &as_printed(design);
    let mut out = header.long(MARK, design);
    out.push_str(PROLOGUE);
    for module in &design.modules {
        out.push('\n');
        out.push_str(&module::print(design, module));
    }
    out.push_str(EPILOGUE);
    out
}

/// The file of a module.
pub fn file_name(module: &str) -> String {
    format!("{module}.v")
}

/// Prints a design as one file per module, the top module first: file names and texts. Linters want a module in a file of its name.
pub fn print_files(design: &Design, header: &Header) -> Vec<(String, String)> {
    let design = &as_printed(design);
    let file = |(index, module): (usize, &Module)| {
        let mut out = match index {
            0 => header.long(MARK, design),
            _ => header.short(MARK, &module.name),
        };
        out.push_str(PROLOGUE);
        out.push('\n');
        out.push_str(&module::print(design, module));
        out.push_str(EPILOGUE);
        (file_name(&module.name), out)
    };
    design.modules.iter().enumerate().map(file).collect()
}

const PROLOGUE: &str = "\n`timescale 1ns / 1ps\n`default_nettype none\n";
const EPILOGUE: &str = "\n`default_nettype wire\n";
