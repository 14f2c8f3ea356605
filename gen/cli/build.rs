//! `build`: makes the bitstream of a card on a board.

use super::work::Steps;
use super::{to_json, EmissionArgs, Outcome};
use crate::artifact;
use crate::bitstream;
use crate::config::{Configuration, RECEIVER_BUS};
use crate::error::GenError;
use clap::Args;

/// Arguments of `build`.
///
/// Exit code 1 when the card is too slow for its clock with every seed; the bitstream of the best one is written all the same.
#[derive(Args)]
pub struct BuildArgs {
    #[command(flatten)]
    emission: EmissionArgs,
    /// Seeds of the placer that are tried, one after another, until timing is met
    #[arg(long, value_name = "N", default_value = "5", value_parser = clap::value_parser!(u32).range(1..=1000))]
    seeds: u32,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(arguments: &BuildArgs) -> Result<Outcome, GenError> {
    let (configuration, folder) = arguments.emission.load()?;
    let project = match configuration {
        Configuration::Card(project) => *project,
        Configuration::Receiver(_) => {
            return Err(GenError::input(format!(
                "host.bus = \"{RECEIVER_BUS}\": is a T-format receiver, which has no board top; choose a card's bus"
            )))
        }
    };
    if project.bus.is_internal() {
        return Err(GenError::input(format!(
            "host.bus = \"{}\": stays inside the chip, so this card is a part of a bitstream of yours; choose \"uart\", \"spi\" or \"parallel\"",
            project.bus.name()
        )));
    }
    let Some(board) = project.board.clone() else {
        return Err(GenError::input(
            "board: the configuration names none, and a bitstream is for a board; add [board], or --board NAME",
        ));
    };
    bitstream::tools(&board)?;
    let artifacts = crate::emit(&project)?;
    let foreign = artifact::foreign(&folder, &artifacts);
    if !foreign.is_empty() {
        return Err(GenError::Input(foreign));
    }
    let remedy = "give another folder with --out";
    artifact::write(&folder, &artifacts, remedy)?;
    let steps = Steps::new(None);
    let mut begin = |step: String| steps.begin(&step);
    let (mut report, bytes) =
        bitstream::build(&project, &board, &artifacts, arguments.seeds, &mut begin)?;
    drop(steps);
    let path = folder.join(&report.bitstream);
    std::fs::write(&path, bytes).map_err(|e| GenError::io("write", &path, &e, remedy))?;
    report.bitstream = path.display().to_string();
    let is_met = report.best.is_met;
    let stdout = match arguments.json {
        true => to_json(&report)?,
        false => report.to_string(),
    };
    let remedy =
        "timing is not met; take a slower clock.system_hz, more --seeds, or a faster device";
    Ok(Outcome {
        messages: if is_met { vec![] } else { vec![remedy.into()] },
        exit_code: u8::from(!is_met),
        ..Outcome::good(stdout)
    })
}
