//! Turns a configuration into the files of an EnDat receiver card, as texts.
//!
//! ```text
//! config (TOML) -> Project -> emit -> [Artifact] -> artifact::write
//!                          -> explain
//! ```

pub mod buses;
pub mod constraints;
pub mod driver;
pub mod encoders;
pub mod front;
pub mod integration;
pub mod language;
pub mod making;
pub mod maps;
pub mod protocols;
pub mod sources;
pub mod testbench;
pub mod vhdl;
pub mod wiring;
pub mod with;
mod zynq;

use buses::front;
use endat_config::{explain, Project};
use endat_console::artifact::{self, Artifact};
use endat_console::error::CommandError;
use endat_hdl::card::bus::HostBus;
use endat_hdl::card::service_times;
use endat_hdl::card::uart_bridge::TIMEOUT_US;
use endat_hdl::endat::service::program::ServiceTimes;
use language::Language;
use rtl_design::elaborate::Design;
use std::collections::BTreeSet;

/// All files of a project, the MANIFEST last.
pub fn emit(project: &Project) -> Result<Vec<Artifact>, CommandError> {
    emit_in(project, Language::Verilog)
}

/// The same with the core in this language.
pub fn emit_in(project: &Project, language: Language) -> Result<Vec<Artifact>, CommandError> {
    let design = design(project)?;
    let mut artifacts = sources_of(project, &design, language);
    let sources = sources::paths(&artifacts, language);
    if project.bus != HostBus::Bare {
        artifacts.extend(maps::artifacts(project)?);
    }
    artifacts.push(sources::list(&project.name, &sources));
    let bench = match language {
        Language::Verilog => testbench::artifact(project)?,
        Language::Vhdl => None,
    };
    let has_bench = project.bus != HostBus::Bare;
    let core = integration::Core::card(project, &sources, has_bench, language)?;
    let named = sources::named(&design, language);
    artifacts.extend(integration::artifacts(&core, &named)?);
    artifacts.extend(vhdl::component(&core, &named)?);
    artifacts.extend(constraints::artifacts(project, language)?);
    artifacts.extend(bench);
    if language == Language::Vhdl {
        let played = vhdl::card(project, &design)?;
        let program = vhdl::other_program(&played);
        artifacts.extend(vhdl::bench(project, &core, &program)?);
        artifacts.extend(vhdl::replay(&core, &design, &played)?);
    }
    let mut names = BTreeSet::new();
    if let Some(twice) = artifacts.iter().find(|a| !names.insert(&a.path)) {
        return Err(CommandError::input(format!(
            "{}: two files have this name; give constraints or timing in the family's file another end",
            twice.path
        )));
    }
    sources::wrap_comments(&mut artifacts);
    artifacts.push(artifact::manifest(&artifacts));
    Ok(artifacts)
}

/// The card with the front that its configuration asks for.
pub fn design(project: &Project) -> Result<Design, CommandError> {
    design_with(project, &service_times(&project.card), TIMEOUT_US)
}

/// The same with other waits of its services, and another limit on pauses within a command over the UART, for quick simulations.
pub fn design_with(
    project: &Project,
    times: &ServiceTimes,
    link_timeout_us: u64,
) -> Result<Design, CommandError> {
    let (card, name) = (&project.card, &project.name);
    let design = (front(project.bus).design)(card, name, times, link_timeout_us)?;
    Ok(Design {
        has_initial_values: card.initial_values,
        ..design
    })
}

/// The card in a language, and its register map in every format.
pub fn sources_of(project: &Project, design: &Design, language: Language) -> Vec<Artifact> {
    let report = explain::report(project).to_string();
    let channels = project.card.channels.len();
    let title = match project.bus {
        HostBus::Bare => format!("{}: {} encoder port.", project.name, project.protocols()),
        _ => format!(
            "{}: {} acquisition card, {channels} channel{}.",
            project.name,
            project.protocols(),
            if channels == 1 { "" } else { "s" }
        ),
    };
    let header = sources::header(title, &project.hash, &report);
    sources::artifacts(design, &header, language)
}
