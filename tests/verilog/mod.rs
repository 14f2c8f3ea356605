//! Outside tools over the emitted card: simulators, linters, synthesis, formal equivalence, gate level.

pub mod area;
mod bus_bench;
mod edits;
mod formal;
mod lint;
pub mod mutations;
pub mod netlist;
mod ports;
mod purpose_bench;
mod t_format_bench;
mod t_format_mutations;
pub mod testbench;
mod wrong_designs;

pub use crate::emitted::{file_of, has_block, name_of};
use crate::tools;
use endat_config::{load_preset, Project, DEFAULT_PRESET};
use endat_console::artifact::Artifact;
pub use endat_tools::readers::is_core;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A card with the fastest host link that the core takes, and no timer: what is simulated most is the host's bytes.
pub fn quick(mut project: Project) -> Project {
    project.card.uart_bit_cycles = endat_hdl::config::UART_BIT_CYCLES_MIN;
    project.card.baud = project.card.system_hz / project.card.uart_bit_cycles;
    project.card.sources.timer = false;
    project
}

/// The preset, made quick, and without its stream: block RAMs have no model among the cells of open tools.
pub fn quick_project() -> Project {
    let mut project = load_preset(DEFAULT_PRESET).unwrap();
    project.card.stream = Default::default();
    quick(project)
}

/// Everything that is emitted for [`quick_project`]; made once.
pub fn quick_files() -> &'static [Artifact] {
    static FILES: OnceLock<Vec<Artifact>> = OnceLock::new();
    FILES.get_or_init(|| endat_emit::emit(&quick_project()).unwrap())
}

/// Everything that is emitted for the preset; made once.
pub fn preset_files() -> &'static [Artifact] {
    static FILES: OnceLock<Vec<Artifact>> = OnceLock::new();
    FILES.get_or_init(|| endat_emit::emit(&load_preset(DEFAULT_PRESET).unwrap()).unwrap())
}

/// Writes the Verilog files of a card into a folder of its own; the folder, and the names of those of the card itself.
pub fn write(test: &str, files: &[Artifact]) -> (PathBuf, Vec<String>) {
    let folder = tools::folder(&format!("verilog-{test}"));
    let verilog = files.iter().filter(|f| f.path.ends_with(".v"));
    verilog.for_each(|f| std::fs::write(folder.join(&f.path), &f.text).unwrap());
    let core = files.iter().filter(|f| is_core(f));
    let core = core.map(|f| f.path.clone()).collect();
    (folder, core)
}

/// Compiles files with iverilog, which must have nothing to say.
pub fn compile(folder: &Path, top: &str, files: &[String], options: &[&str]) {
    let mut arguments = vec!["-g2005", "-o", "sim.vvp", "-s", top];
    arguments.extend(options);
    arguments.extend(files.iter().map(String::as_str));
    let (good, text) = tools::run("iverilog", folder, &arguments);
    assert!(good && text.is_empty(), "{}: {text}", folder.display());
}
