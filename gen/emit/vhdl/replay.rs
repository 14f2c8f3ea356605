//! The VHDL bench that plays a recorded run of a core, and the vectors that it plays.

use super::play::{is_program, Played};
use crate::integration::Core;
use endat_config::template::render;
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use minijinja::context;
use minijinja::value::{Serde, Value};
use rtl_design::elaborate::Design;
use rtl_design::engine::Port;
use rtl_design::vhdl::{as_printed, emitted_name, print_architecture};
use serde::Serialize;
use std::fmt::Write;

/// The architecture of a sequencer in the bench.
const ARCHITECTURE: &str = "bench";

/// A port of the core, and the bits of the vectors that it is.
#[derive(Serialize)]
struct Connection {
    name: String,
    range: String,
    is_output: bool,
}

/// The bench and its vectors.
pub fn artifacts(
    core: &Core<'_>,
    own: &Design,
    played: &Played,
) -> Result<Vec<Artifact>, CommandError> {
    let top = own.top();
    let clock = top.ports.iter().find(|p| p.is_clock);
    let clock = clock.map_or_else(String::new, |p| emitted_name(&top.nets[p.net].name));
    let (inputs, outputs) = (bits(played, true), bits(played, false));
    let context = context! {
        name => core.name,
        origin => core.origin(),
        clock,
        connections => Value::from(Serde(connections(played))),
        input_bits => inputs.max(1),
        output_bits => outputs.max(1),
        steps => played.steps.len(),
        known_from => played.known_from,
        is_double => played.is_double,
        good => played.good,
        half_ps => 500_000_000_000 / played.system_hz,
        initial_values => core.has_initial_values(),
        program => other_program(played),
    };
    let text = render(
        "replay.vhd",
        include_str!("../templates/vhdl/replay.vhd.jinja"),
        &context,
    )?;
    Ok(vec![
        Artifact::new(format!("{}_replay_tb.vhd", core.name), text),
        Artifact::new(format!("{}_replay_tb.txt", core.name), vectors(played)),
    ])
}

/// A second architecture of the modules with the program, if that is not the core's own.
pub fn other_program(played: &Played) -> String {
    if !played.has_program {
        return String::new();
    }
    let design = as_printed(&played.design);
    let has_program = |(_, module): &(usize, &rtl_design::elaborate::Module)| {
        module.memories.iter().any(is_program)
    };
    let modules = design.modules.iter().enumerate().filter(has_program);
    let texts = modules.map(|(index, _)| print_architecture(&design, index, ARCHITECTURE));
    texts.collect::<Vec<_>>().join("\n")
}

fn of(played: &Played, is_input: bool) -> impl Iterator<Item = (usize, &Port)> {
    let ports = played.ports.iter().enumerate();
    ports.filter(move |(_, port)| port.is_input == is_input)
}

fn bits(played: &Played, is_input: bool) -> usize {
    of(played, is_input).map(|(_, port)| port.width_bits).sum()
}

fn connections(played: &Played) -> Vec<Connection> {
    let mut all = vec![];
    for is_input in [true, false] {
        let mut low = 0;
        for (_, port) in of(played, is_input) {
            let range = match port.width_bits {
                1 => low.to_string(),
                width => format!("{} downto {low}", low + width - 1),
            };
            low += port.width_bits;
            all.push(Connection {
                name: emitted_name(&port.name),
                range,
                is_output: !is_input,
            });
        }
    }
    all
}

/// A line for each change: how many steps it stays, all inputs, all outputs; the last port of the list stands first.
fn vectors(played: &Played) -> String {
    let row = |step: &Vec<u128>, is_input: bool| {
        let mut text = String::new();
        for (at, port) in of(played, is_input).collect::<Vec<_>>().into_iter().rev() {
            let _ = write!(text, "{:0width$b}", step[at], width = port.width_bits);
        }
        if text.is_empty() {
            text.push('0');
        }
        text
    };
    let mut out = String::new();
    let mut steps = played.steps.iter().peekable();
    let mut count = 0;
    while let Some(step) = steps.next() {
        count += 1;
        if steps.peek() != Some(&step) {
            let _ = writeln!(out, "{count} {} {}", row(step, true), row(step, false));
            count = 0;
        }
    }
    out
}
