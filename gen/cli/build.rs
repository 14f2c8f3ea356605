//! `build` and `flash`: the bitstream of a card on a board, and the command that loads it.

use super::colour;
use super::work::Steps;
use super::{to_json, EmissionArgs, Outcome};
use clap::Args;
use endat_config::board::Board;
use endat_config::{Configuration, Project, RECEIVER_BUS};
use endat_console::artifact::{self, Artifact};
use endat_console::error::CommandError;
use endat_emit::language::Language;
use endat_emit::making::{file_name, Maker};
use endat_emit::with::Whole;
use endat_tools::bitstream::{self, Effort};
use std::path::{Path, PathBuf};

/// Arguments of `build`.
///
/// Exit code 1 when the card is too slow for its clock with every seed; the bitstream of the best one is written all the same.
#[derive(Args)]
pub struct BuildArgs {
    #[command(flatten)]
    emission: EmissionArgs,
    /// Seeds of the placer that are tried, one after another, until timing is met
    #[arg(long, value_name = "N", default_value = "5", value_parser = endat_console::number::parser(1, 1000), allow_negative_numbers = true)]
    seeds: u32,
    /// With the vendor's tool, also where open tools know the board
    #[arg(long)]
    vendor: bool,
    /// Build nothing: read the report that the script of the emission has written with the vendor's tool, here or elsewhere
    #[arg(long)]
    read: bool,
    /// Read the result back and compare it with the card, on every pin in each of 60 000 cycles of its own bench; exit code 1 when
    /// they differ
    #[arg(long, conflicts_with_all = ["vendor", "read"])]
    simulate: bool,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Arguments of `flash`.
#[derive(Args)]
pub struct FlashArgs {
    #[command(flatten)]
    emission: EmissionArgs,
    /// Into the board's flash memory, where it stays without power
    #[arg(long)]
    write_flash: bool,
}

/// Prints the command that loads a bitstream that has been built.
pub fn flash(arguments: &FlashArgs) -> Result<Outcome, CommandError> {
    let (project, board, folder) = on_board(&arguments.emission)?;
    let language = arguments.emission.language()?;
    // Open tools read Verilog.
    let maker = Maker::of(&board, language == Language::Vhdl)?;
    let name = file_name(&project, &board, maker)?;
    let path = folder.join(&name);
    let Some(command) = bitstream::loading(&board, &path, arguments.write_flash) else {
        return Err(CommandError::input(format!(
            "board = {}: its file does not say how openFPGALoader calls it; add loader = \"...\" (`openFPGALoader --list-boards`), or load the file with the vendor's program",
            board.name
        )));
    };
    let build = match language {
        Language::Vhdl => "build --vendor",
        Language::Verilog => "build",
    };
    let make = format!("make it: the same command with `{build}` instead of `flash`");
    let is_there = std::fs::metadata(&path).is_ok_and(|file| file.is_file() && file.len() > 0);
    if !is_there {
        return Err(CommandError::input(format!(
            "{}: is not there; {make}",
            path.display()
        )));
    }
    let whole = Whole::of_card(&project, language)?;
    be_of(&path, &folder, &whole, &whole.with(&project.with)?, &make)?;
    bitstream::report_of(&project, &board, &folder, &name)?;
    Ok(Outcome::good(command + "\n"))
}

/// An error if the files next to a bitstream are those of another emission. Each extra may be there or not: it makes no other bitstream, and
/// changes the page and the list of files only.
fn be_of(
    path: &Path,
    folder: &Path,
    whole: &Whole,
    artifacts: &[Artifact],
    remedy: &str,
) -> Result<(), CommandError> {
    let lists = [artifact::MANIFEST, artifact::README];
    let is_there = |file: &Artifact| {
        let is_card = artifacts.iter().any(|of_card| of_card.path == file.path);
        !lists.contains(&&file.path[..]) && (is_card || folder.join(&file.path).exists())
    };
    let there = whole.artifacts().iter().filter(|file| is_there(file));
    let there: Vec<Artifact> = there.cloned().collect();
    let changed = artifact::changed(folder, &there).into_iter();
    let mut other = changed.chain(artifact::stale(folder, whole.artifacts()));
    match other.next() {
        None => Ok(()),
        Some(other) => Err(CommandError::input(format!(
            "{}: is of another configuration, board, version or --language ({other}); {remedy}",
            path.display()
        ))),
    }
}

/// The card that is meant, its board, and the folder of its files.
fn on_board(emission: &EmissionArgs) -> Result<(Project, Board, PathBuf), CommandError> {
    let (configuration, folder) = emission.load()?;
    let project = match configuration {
        Configuration::Card(project) => *project,
        Configuration::Receiver(_) => {
            return Err(CommandError::input(format!(
                "host.bus = \"{RECEIVER_BUS}\": is a T-format receiver, which has no board top; choose a card's bus"
            )))
        }
    };
    if project.bus.is_internal() {
        return Err(CommandError::input(format!(
            "host.bus = \"{}\": stays inside the chip, so this card is a part of a bitstream of yours; choose \"uart\", \"spi\" or \"parallel\"",
            project.bus.name()
        )));
    }
    let Some(board) = project.board.clone() else {
        return Err(CommandError::input(
            "board: the configuration names none, and a bitstream is for a board; add [board], or --board NAME",
        ));
    };
    Ok((project, board, folder))
}

/// Runs the command.
pub fn run(arguments: &BuildArgs) -> Result<Outcome, CommandError> {
    let (project, board, folder) = on_board(&arguments.emission)?;
    let maker = Maker::of(&board, arguments.vendor || arguments.read)?;
    let way_back = match (maker, arguments.simulate) {
        (Maker::Open(build), true) => Some(bitstream::way_back(&project, &board, build)?),
        (Maker::Vendor(vendor), true) => {
            return Err(CommandError::input(format!(
                "--simulate: {} makes this bitstream, and it cannot be read back; leave it out",
                vendor.tool
            )))
        }
        (_, false) => None,
    };
    let language = arguments.emission.language()?;
    if let (Maker::Open(_), Language::Vhdl) = (maker, language) {
        let vendor = match board.family.vendor {
            Some(_) => ", or take the vendor's tool with --vendor",
            None => "",
        };
        return Err(CommandError::input(format!(
            "--language = vhdl: open tools read Verilog; leave it out{vendor}"
        )));
    }
    let whole = Whole::of_card(&project, language)?;
    let artifacts = whole.with(&project.with)?;
    let bitstream = file_name(&project, &board, maker)?;
    if artifacts.iter().any(|a| a.path == bitstream) {
        return Err(CommandError::input(format!(
            "bitstream = {bitstream:?}: is a file of the emission; give it another name in the family's file"
        )));
    }
    let foreign = artifact::foreign(&folder, &artifacts);
    if !foreign.is_empty() {
        return Err(CommandError::Input(foreign));
    }
    let remedy = "give another folder with --out";
    if arguments.read {
        let make = "emit it, and run the script there";
        be_of(&folder, &folder, &whole, &artifacts, make)?;
    } else {
        artifact::write(&folder, &artifacts, remedy)?;
    }
    let steps = Steps::new(None);
    let mut begin = |step: String| steps.begin(&step);
    let (mut report, bytes) = match maker {
        Maker::Open(build) => {
            let effort = Effort {
                seeds: arguments.seeds,
                until_met: true,
                way_back,
            };
            bitstream::build(&project, &board, build, &artifacts, effort, &mut begin)?
        }
        Maker::Vendor(vendor) if arguments.read => {
            bitstream::read(&project, &board, vendor, &folder)?
        }
        Maker::Vendor(vendor) => {
            bitstream::run_vendor(&project, &board, vendor, &artifacts, &folder, &mut begin)?
        }
    };
    drop(steps);
    let path = folder.join(&report.bitstream);
    if !arguments.read {
        let (name, text) = bitstream::report_file(&project, &report, &bytes);
        let about = folder.join(name);
        std::fs::write(&about, text).map_err(|e| CommandError::io("write", &about, &e, remedy))?;
        std::fs::write(&path, bytes).map_err(|e| CommandError::io("write", &path, &e, remedy))?;
    }
    report.load = bitstream::loading(&board, &path, false);
    report.bitstream = path.display().to_string();
    let is_met = report.best.is_met;
    let read_back = report.read_back.as_ref();
    let is_same = read_back.is_none_or(|comparison| comparison.difference.is_none());
    let stdout = match arguments.json {
        true => to_json(&report)?,
        false => colour::verdicts(&report.to_string(), &["timing met"], &["timing NOT met"]),
    };
    let seeds = match maker {
        Maker::Open(_) => ", more --seeds",
        Maker::Vendor(_) => "",
    };
    let remedy =
        format!("timing is not met; take a slower clock.system_hz{seeds}, or a faster device");
    let other = "what was read back is not the card; do not load this bitstream, and try another version of the tools".to_owned();
    let messages = [(is_met, remedy), (is_same, other)].into_iter();
    Ok(Outcome {
        messages: messages
            .filter(|(is_good, _)| !is_good)
            .map(|(_, text)| text)
            .collect(),
        exit_code: u8::from(!(is_met && is_same)),
        ..Outcome::good(stdout)
    })
}
