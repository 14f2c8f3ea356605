//! The command line: arguments in, an [`Outcome`] out. Results are text for stdout, messages are lines for stderr.

mod area;
mod boards;
mod build;
mod campaign;
mod crc_command;
mod doctor;
mod emit;
mod explain_key;
mod explain_name;
mod glossary;
mod moved;
mod new;
mod pictures;
mod prove;
mod schema;
mod shmoo;
mod sim;

use clap::{Args, CommandFactory, Parser, Subcommand};
use endat_config::arguments::{board_of, SourceArgs, TargetArgs};
use endat_config::explain;
use endat_config::{self as config, check_name, Configuration};
use endat_console::error::CommandError;
use endat_emit::language::Language;
use endat_terminal::outcome::{to_json, Outcome};
use endat_terminal::{colour, documents, work};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Makes the Verilog or VHDL, the constraints and the register map of an EnDat receiver card from one configuration.
///
/// Without a command: emit the preset s6_two_channel into out/. Exit code 0: good; 1: a check failed; 2: wrong usage or input.
#[derive(Parser)]
#[command(name = "endat-gen", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// Write the files of a card, or check that they are up to date
    Emit(emit::EmitArgs),
    /// Make the bitstream of a card on a board: synthesis, place and route, timing, with open tools
    Build(build::BuildArgs),
    /// Print the command that loads the bitstream that `build` has made onto its board (openFPGALoader)
    Flash(build::FlashArgs),
    /// Ask a few questions, and write a configuration with every key explained
    New(new::NewArgs),
    /// List the configurations that come with the program, or print one
    Presets {
        /// Print the file of this preset, to start an own configuration from
        #[arg(long, value_name = "NAME")]
        show: Option<String>,
        /// With the board of this name or file, and the shipped one with clocks that suit it
        #[arg(long, value_name = "BOARD", requires = "show")]
        board: Option<String>,
        /// As JSON
        #[arg(long, conflicts_with = "show")]
        json: bool,
    },
    /// List the boards that come with the program, or print the file of one
    Boards {
        /// Print the file of this board, to start one of your own from
        #[arg(long, value_name = "NAME")]
        show: Option<String>,
        /// Draw how the shipped card is wired on this board (name or file), as SVG
        #[arg(long, value_name = "BOARD", conflicts_with_all = ["show", "json", "page"])]
        wiring: Option<String>,
        /// As the table of docs/boards.md
        #[arg(long, conflicts_with_all = ["show", "json"])]
        page: bool,
        /// As JSON
        #[arg(long, conflicts_with = "show")]
        json: bool,
    },
    /// Show what a configuration becomes: clocks, timing, frame lengths, sampling rates, link load; or what a key of it, a cause,
    /// register or field means
    Explain {
        /// Name of a key, table, cause, register or field, for example endat.clock_hz, safety, crc, result.status or tracked
        #[arg(value_name = "NAME", conflicts_with_all = ["config", "preset", "board", "json"])]
        name: Option<String>,
        #[command(flatten)]
        source: SourceArgs,
        #[command(flatten)]
        target: TargetArgs,
        /// As JSON
        #[arg(long)]
        json: bool,
    },
    /// Print the JSON Schema of configurations, or of boards' files, for editors that complete and check TOML
    Schema(schema::SchemaArgs),
    /// Run a scenario of the bench
    Sim(sim::SimArgs),
    /// Compute and explain the CRC of a frame
    Crc(crc_command::CrcArgs),
    /// Prove on the Verilog what its blocks promise, in every cycle and for all inputs
    Prove(prove::ProveArgs),
    /// Measure the area, and the speed, of card, channel and blocks with yosys and nextpnr
    Area(area::AreaArgs),
    /// Run thousands of cases side by side and check every frame
    Campaign(campaign::CampaignArgs),
    /// Map where frames are good, and by what margin: cable, clock, jitter, noise ...
    Shmoo(shmoo::ShmooArgs),
    /// Move the sample over the bit: how much jitter it stands where; options as those of shmoo
    Eye(shmoo::ShmooArgs),
    /// Say which programs of others are there, and what those are for that are not
    Doctor(doctor::DoctorArgs),
    /// Print the completions of the command line for a shell
    Completions(documents::CompletionsArgs),
    /// Print the manual page, or write those of all commands
    Man(documents::ManArgs),
}

/// Folder that everything is emitted into unless another is given.
const OUT: &str = "out";

/// A card, on which board, and where its files go.
#[derive(Args, Default)]
struct EmissionArgs {
    #[command(flatten)]
    source: SourceArgs,
    #[command(flatten)]
    target: TargetArgs,
    /// Folder to write into; the files go to DIR/PREFIX [default: out]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Name of the folder, the files and the top module [default: the name in the configuration]
    #[arg(long, value_name = "PREFIX")]
    name: Option<String>,
    /// Language of the core: verilog, or vhdl, which is VHDL-93 and VHDL-2008 at once [default: verilog]
    #[arg(long, value_name = "LANGUAGE")]
    language: Option<String>,
}

impl EmissionArgs {
    fn language(&self) -> Result<Language, CommandError> {
        let language = self.language.as_deref().map(Language::named);
        Ok(language.transpose()?.unwrap_or_default())
    }

    /// The configuration under its name, and the folder of its files.
    fn load(&self) -> Result<(Configuration, PathBuf), CommandError> {
        let board = self.target.load()?;
        let mut configuration = self.source.load_any_on(board.as_ref())?;
        let name = match &mut configuration {
            Configuration::Card(card) => &mut card.name,
            Configuration::Receiver(receiver) => &mut receiver.name,
        };
        if let Some(other) = &self.name {
            check_name(other)
                .map_err(|text| CommandError::input(format!("--name = {other:?}: {text}")))?;
            name.clone_from(other);
        }
        let out = self.out.as_deref().unwrap_or(Path::new(OUT));
        if out.as_os_str().is_empty() {
            return Err(CommandError::input("--out = \"\": is empty; give a folder"));
        }
        let folder = out.join(name);
        Ok((configuration, folder))
    }
}

/// The command line: its commands, options and what they say of themselves.
pub fn command_line() -> clap::Command {
    Cli::command()
}

/// Runs the program with these arguments; the first is the program's name.
pub fn run(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Outcome {
    painted(arguments).plain()
}

/// The same with colours, see [`colour`].
pub fn painted(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Outcome {
    let words: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    let moved = moved::run(words.get(1..).unwrap_or_default());
    match moved {
        Some(ran) => ran.unwrap_or_else(|error| Outcome::failed(&error)),
        None => Outcome::of(words, execute),
    }
}

/// Says so if the simulation was not at its full speed.
fn with_engine(mut outcome: Outcome) -> Outcome {
    if let Err(why) = rtl_design::engine::has_native_code() {
        let text =
            format!("no native code on this machine ({why}): simulated in the slower interpreter");
        outcome.messages.push(text);
    }
    outcome
}

fn execute(cli: Cli) -> Result<Outcome, CommandError> {
    match cli.command {
        None => emit::run(&emit::EmitArgs::default()),
        Some(Command::Emit(arguments)) => emit::run(&arguments),
        Some(Command::Build(arguments)) => build::run(&arguments),
        Some(Command::Flash(arguments)) => build::flash(&arguments),
        Some(Command::New(arguments)) => new::run(&arguments),
        Some(Command::Presets {
            show: Some(name),
            board: Some(board),
            ..
        }) => config::preset_for("--show", &name, &board_of("--board", &board)?).map(Outcome::good),
        Some(Command::Presets {
            show: Some(name), ..
        }) => config::preset_of("--show", &name).map(Outcome::good),
        Some(Command::Boards {
            show: Some(name), ..
        }) => boards::show(&name),
        Some(Command::Boards {
            wiring: Some(name), ..
        }) => boards::wiring(&name),
        Some(Command::Boards { page: true, .. }) => boards::page(),
        Some(Command::Boards { json, .. }) => boards::list(json),
        Some(Command::Presets { json, .. }) => presets(json),
        Some(Command::Explain {
            name: Some(name), ..
        }) => explain_name::text(&name).map(Outcome::good),
        Some(Command::Explain {
            source,
            target,
            json,
            ..
        }) => {
            let shown = |report: &dyn Shown| report.shown(json).map(Outcome::good);
            match source.load_any_on(target.load()?.as_ref())? {
                Configuration::Card(card) => shown(&explain::report(&card)),
                Configuration::Receiver(receiver) => {
                    shown(&endat_config::explain::receiver::report(&receiver))
                }
            }
        }
        Some(Command::Schema(arguments)) => schema::run(&arguments),
        Some(Command::Sim(arguments)) => sim::run(&arguments).map(with_engine),
        Some(Command::Crc(arguments)) => crc_command::run(&arguments),
        Some(Command::Prove(arguments)) => prove::run(&arguments),
        Some(Command::Area(arguments)) => area::run(&arguments),
        Some(Command::Campaign(arguments)) => campaign::run(&arguments).map(with_engine),
        Some(Command::Shmoo(arguments)) => shmoo::run(&arguments).map(with_engine),
        Some(Command::Eye(arguments)) => shmoo::eye(arguments).map(with_engine),
        Some(Command::Doctor(arguments)) => doctor::run(&arguments),
        Some(Command::Completions(arguments)) => documents::completions(command_line(), &arguments),
        Some(Command::Man(arguments)) => documents::man(command_line(), &arguments),
    }
}

/// First line of each preset beside its name.
fn presets(json: bool) -> Result<Outcome, CommandError> {
    let summary = |text: &'static str| {
        text.lines()
            .next()
            .unwrap_or("")
            .trim_start_matches(['#', ' '])
    };
    let list = (config::PRESETS.iter())
        .chain(config::RECEIVER_PRESETS)
        .map(|(name, text)| (*name, summary(text)));
    if json {
        let objects: Vec<_> = list
            .map(|(name, summary)| serde_json::json!({"name": name, "summary": summary}))
            .collect();
        return Ok(Outcome::good(to_json(&objects)?));
    }
    Ok(Outcome::good(
        list.map(|(name, summary)| format!("{name:<24} {summary}\n"))
            .collect::<String>(),
    ))
}

/// A report that can be shown as text and as JSON.
trait Shown {
    fn shown(&self, json: bool) -> Result<String, CommandError>;
}

impl<T: serde::Serialize + ToString> Shown for T {
    fn shown(&self, json: bool) -> Result<String, CommandError> {
        match json {
            true => to_json(self),
            false => Ok(self.to_string()),
        }
    }
}
