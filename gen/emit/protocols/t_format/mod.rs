//! T-format receivers: configuration, report and files. They are no cards: no UART, no register bank, no board.
//!
//! ```text
//! TOML -> Receiver -> emit -> [Artifact]
//!                  -> report
//! ```

mod bench;
mod bench_parts;
pub mod encoder;
mod protocol;

pub use protocol::TFormat;

use crate::integration;
use crate::language::Language;
use crate::sources;
use crate::testbench::RESET_CYCLES;
use crate::vhdl;
use endat_config::explain::receiver::report;
use endat_config::template::render;
use endat_config::Receiver;
use endat_console::artifact::{self, Artifact};
use endat_console::error::CommandError;
use endat_hdl::protocols::t_format::dsp::AsyncDsp;
use endat_hdl::protocols::t_format::protocol::SYSTEM_HZ;
use minijinja::context;
use rtl_design::elaborate::{elaborate, Design};
use rust_hdl::prelude::Block;

/// The receiver's design.
pub fn design(receiver: &Receiver) -> Result<Design, CommandError> {
    let mut block = AsyncDsp::new(&receiver.start, receiver.upset_guards);
    block.connect_all();
    let design =
        elaborate(&block, &receiver.name).map_err(|e| CommandError::fault("design", &e))?;
    Ok(Design {
        has_initial_values: receiver.initial_values,
        ..design
    })
}

/// All files of a receiver, the MANIFEST last.
pub fn emit(receiver: &Receiver) -> Result<Vec<Artifact>, CommandError> {
    emit_in(receiver, Language::Verilog)
}

/// The same with the core in this language.
pub fn emit_in(receiver: &Receiver, language: Language) -> Result<Vec<Artifact>, CommandError> {
    let design = design(receiver)?;
    let report = report(receiver).to_string();
    let title = format!(
        "{}: T-format receiver with a bus for a signal processor.",
        receiver.name
    );
    let header = sources::header(title, &receiver.hash, &report);
    let mut artifacts = sources::artifacts(&design, &header, language);
    let sources = sources::paths(&artifacts, language);
    artifacts.push(sources::list(&receiver.name, &sources));
    let map = include_str!("../../templates/t_format_registers.md");
    let (name, origin) = (&receiver.name, sources::origin(&receiver.hash));
    artifacts.push(Artifact::new(
        format!("{name}_registers.md"),
        format!("# {name}\n\n{origin}\n\n{map}"),
    ));
    let core = integration::Core::receiver(receiver, &sources, language);
    let named = sources::named(&design, language);
    artifacts.extend(integration::artifacts(&core, &named)?);
    artifacts.extend(vhdl::component(&core, &named)?);
    match language {
        Language::Verilog => artifacts.push(bench::artifact(receiver)?),
        Language::Vhdl => {
            let played = vhdl::receiver(receiver, &design)?;
            artifacts.extend(vhdl::replay(&core, &design, &played)?);
        }
    }
    let context = context! {
        name => receiver.name.as_str(),
        version => env!("CARGO_PKG_VERSION"),
        hash => receiver.hash.as_str(),
        clocks_mhz => SYSTEM_HZ.map(|hz| hz / 1_000_000).to_vec(),
        timing => report,
        initial_values => receiver.initial_values,
        reset_cycles => RESET_CYCLES,
        is_vhdl => language == Language::Vhdl,
    };
    let readme = include_str!("../../templates/receiver_readme.md.jinja");
    artifacts.push(Artifact::new(
        endat_console::artifact::README,
        render("receiver_readme", readme, &context)?,
    ));
    sources::wrap_comments(&mut artifacts);
    artifacts.push(artifact::manifest(&artifacts));
    Ok(artifacts)
}
