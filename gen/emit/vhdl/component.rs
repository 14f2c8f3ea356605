//! What a design in VHDL takes a core in with, whatever language that is in: a package with its component, and an instantiation template.

use crate::integration::Core;
use crate::language::Language;
use crate::testbench::RESET_CYCLES;
use endat_config::template::render;
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use minijinja::context;
use minijinja::value::{Serde, Value};
use rtl_design::elaborate::{Design, Direction, Net};
use rtl_design::vhdl::emitted_name;
use serde::Serialize;

#[derive(Serialize)]
struct Port {
    name: String,
    direction: &'static str,
    subtype: String,
    meaning: String,
}

/// The name of a port in VHDL. A name of the Verilog text that is a word of VHDL is written between backslashes.
fn name_of(net: &Net, language: Language) -> String {
    match language == Language::Vhdl || emitted_name(&net.name) == net.name {
        true => net.name.clone(),
        false => format!("\\{}\\", net.name),
    }
}

/// Both files. `design` has the names of its text: [`crate::sources::named`].
pub fn artifacts(core: &Core<'_>, design: &Design) -> Result<Vec<Artifact>, CommandError> {
    let top = design.top();
    let names = top
        .ports
        .iter()
        .map(|p| name_of(&top.nets[p.net], core.language));
    let width = names.clone().map(|name| name.len()).max().unwrap_or(0);
    let port = |(port, name): (&rtl_design::elaborate::Port, String)| {
        let net = &top.nets[port.net];
        Port {
            name: format!("{name:width$}"),
            direction: match port.direction {
                Direction::Input => "in ",
                Direction::Output => "out",
            },
            subtype: match net.width_bits {
                1 => "std_logic".into(),
                bits => format!("std_logic_vector({} downto 0)", bits - 1),
            },
            meaning: net.docs.join(" "),
        }
    };
    let ports: Vec<Port> = top.ports.iter().zip(names).map(port).collect();
    let context = context! {
        name => core.name,
        origin => core.origin(),
        ports => Value::from(Serde(ports)),
        is_vhdl => core.language == Language::Vhdl,
        initial_values => core.has_initial_values(),
        reset_cycles => RESET_CYCLES,
    };
    let files = [
        (
            "_component.vhd",
            include_str!("../templates/vhdl/component.vhd.jinja"),
        ),
        (
            "_instance.vho",
            include_str!("../templates/vhdl/instance.vho.jinja"),
        ),
    ];
    let file = |(end, text): (&str, &str)| {
        Ok(Artifact::new(
            format!("{}{end}", core.name),
            render(end, text, &context)?,
        ))
    };
    files.into_iter().map(file).collect()
}
