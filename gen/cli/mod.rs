//! The command line: arguments in, an [`Outcome`] out. Results are text for stdout, messages are lines for stderr.

mod area;
mod bench;
mod boards;
mod build;
mod campaign;
pub mod colour;
mod crc_command;
mod doctor;
mod documents;
mod emit;
mod explain_key;
mod flows;
mod glossary;
mod host;
mod new;
mod pictures;
mod prove;
mod recorded;
mod schema;
mod shmoo;
mod sim;
mod work;

use crate::board::Board;
use crate::config::{self, check_name, Configuration};
use crate::error::{shown, GenError};
use crate::explain;
use crate::language::Language;
use clap::{Args, CommandFactory, Parser, Subcommand};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// What a run of the program gives.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Results.
    pub stdout: String,
    /// Messages, one a line.
    pub messages: Vec<String>,
    /// 0 good, 1 a check failed, 2 wrong usage or input.
    pub exit_code: u8,
}

impl Outcome {
    /// A good result.
    fn good(stdout: impl Into<String>) -> Self {
        Self {
            stdout: stdout.into(),
            ..Self::default()
        }
    }
}

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
        /// Build the shipped card with five seeds on each board that open tools know, or on this one, and print what came of it as a table:
        /// takes an hour
        #[arg(long, value_name = "NAME", num_args = 0..=1, conflicts_with = "show")]
        measure: Option<Option<String>>,
        /// Draw how the shipped card is wired on this board (name or file), as SVG
        #[arg(long, value_name = "BOARD", conflicts_with_all = ["show", "measure", "json", "page"])]
        wiring: Option<String>,
        /// As the table of docs/boards.md
        #[arg(long, conflicts_with_all = ["show", "measure", "json"])]
        page: bool,
        /// As JSON
        #[arg(long, conflicts_with_all = ["show", "measure"])]
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
    /// Put a card's Verilog through every synthesis flow of yosys, and count what it complains about
    Flows(flows::FlowsArgs),
    /// Measure the simulators, this project's and others
    Bench(bench::BenchArgs),
    /// Run thousands of cases side by side and check every frame
    Campaign(campaign::CampaignArgs),
    /// Map where frames are good, and by what margin: cable, clock, jitter, noise ...
    Shmoo(shmoo::ShmooArgs),
    /// Move the sample over the bit: how much jitter it stands where; options as those of shmoo
    Eye(shmoo::ShmooArgs),
    /// Run a card without hardware, for this program and others: the core and encoders, simulated, behind a port
    Card(host::virtual_card::CardArgs),
    /// Make a fault in a virtual card that runs: plug, cable, encoder
    Inject(host::inject::InjectArgs),
    /// Ask a card who it is, and what its encoders are
    Id(host::id::IdArgs),
    /// Read the latest position of every channel
    Read(host::read::ReadArgs),
    /// Log positions as CSV, JSON lines or Parquet
    Log(host::log::LogArgs),
    /// Draw a recording: positions over time, faults below them
    Plot(recorded::plot::PlotArgs),
    /// Say what is in a recording: rate, what is missing, noise, drift, faults
    Stats(recorded::stats::StatsArgs),
    /// Watch positions, rate, health and margin live
    Monitor(host::monitor::MonitorArgs),
    /// Watch a card in a browser: positions over time, causes, health, registers; record
    View(host::view::ViewArgs),
    /// Serve a card to PandABlocks clients, which record HDF5
    Serve(host::serve::ServeArgs),
    /// Read and write registers of a card by name
    Reg(host::reg::RegArgs),
    /// Read and write words of the encoder's memory
    Param(host::param::ParamArgs),
    /// Show where the edges of DATA are, as the card has measured it
    Margin(host::margin::MarginArgs),
    /// Say which programs of others are there, and what those are for that are not
    Doctor(doctor::DoctorArgs),
    /// Print the completions of the command line for a shell
    Completions(documents::CompletionsArgs),
    /// Print the manual page, or write those of all commands
    Man(documents::ManArgs),
}

/// Which configuration.
#[derive(Args, Clone, Default)]
struct SourceArgs {
    /// Configuration file; - reads standard input
    #[arg(long, value_name = "FILE", conflicts_with = "preset")]
    config: Option<PathBuf>,
    /// Configuration that comes with the program [default: s6_two_channel]
    #[arg(long, value_name = "NAME")]
    preset: Option<String>,
}

/// On which board.
#[derive(Args, Clone, Default)]
struct TargetArgs {
    /// Board instead of the configuration's: one that comes with the program, or a file [default: as in the configuration]
    #[arg(long, value_name = "NAME|FILE")]
    board: Option<String>,
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
    fn language(&self) -> Result<Language, GenError> {
        let language = self.language.as_deref().map(Language::named);
        Ok(language.transpose()?.unwrap_or_default())
    }

    /// The configuration under its name, and the folder of its files.
    fn load(&self) -> Result<(Configuration, PathBuf), GenError> {
        let board = self.target.load()?;
        let mut configuration = self.source.load_any_on(board.as_ref())?;
        let name = match &mut configuration {
            Configuration::Card(card) => &mut card.name,
            Configuration::Receiver(receiver) => &mut receiver.name,
        };
        if let Some(other) = &self.name {
            check_name(other)
                .map_err(|text| GenError::input(format!("--name = {other:?}: {text}")))?;
            name.clone_from(other);
        }
        let out = self.out.as_deref().unwrap_or(Path::new(OUT));
        if out.as_os_str().is_empty() {
            return Err(GenError::input("--out = \"\": is empty; give a folder"));
        }
        let folder = out.join(name);
        Ok((configuration, folder))
    }
}

impl TargetArgs {
    fn load(&self) -> Result<Option<Board>, GenError> {
        self.board
            .as_deref()
            .map(|word| board_of("--board", word))
            .transpose()
    }
}

/// A board by its name, or in a file.
fn board_of(option: &str, word: &str) -> Result<Board, GenError> {
    if word.contains(['/', '\\', '.']) {
        return Ok(Board::from_file(Path::new(word))?);
    }
    Board::named(word).map_err(|text| {
        GenError::input(format!(
            "{option} = {}: {text}, or give a file of your own, as {option} FILE.toml",
            shown(word)
        ))
    })
}

impl SourceArgs {
    /// Either kind.
    fn load_any(&self) -> Result<Configuration, GenError> {
        self.load_any_on(None)
    }

    /// The same on another board than its own. Without a configuration it is the shipped one, with clocks that suit the board.
    fn load_any_on(&self, board: Option<&Board>) -> Result<Configuration, GenError> {
        let name = self.preset.as_deref().unwrap_or(config::DEFAULT_PRESET);
        match (&self.config, board) {
            (Some(file), board) => config::load_any_file(file, board),
            (None, None) => config::load_any_preset(name),
            (None, Some(board)) => {
                let text = config::preset_for("--preset", name, board)?;
                let file = format!("{name}.toml");
                Ok(config::parse_any_on(&file, &text, Some(board))?)
            }
        }
    }
}

/// The command line: its commands, options and what they say of themselves.
pub fn command_line() -> clap::Command {
    Cli::command()
}

/// Runs the program with these arguments; the first is the program's name.
pub fn run(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Outcome {
    let painted = painted(arguments);
    Outcome {
        stdout: colour::plain(&painted.stdout),
        messages: painted.messages.iter().map(|m| colour::plain(m)).collect(),
        exit_code: painted.exit_code,
    }
}

/// The same with colours, see [`colour`].
pub fn painted(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Outcome {
    match Cli::try_parse_from(arguments) {
        Ok(cli) => execute(cli).unwrap_or_else(|error| Outcome {
            stdout: String::new(),
            messages: error.messages().to_vec(),
            exit_code: error.exit_code(),
        }),
        Err(error) if !error.use_stderr() => Outcome::good(error.render().ansi().to_string()),
        Err(error) => {
            let text = error.to_string();
            let messages = text
                .trim_end()
                .trim_start_matches("error: ")
                .lines()
                .filter(|l| !l.is_empty());
            Outcome {
                stdout: String::new(),
                messages: messages.map(str::to_owned).collect(),
                exit_code: 2,
            }
        }
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

fn execute(cli: Cli) -> Result<Outcome, GenError> {
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
            measure: Some(name),
            ..
        }) => boards::measure(name.as_deref()),
        Some(Command::Boards {
            wiring: Some(name), ..
        }) => boards::wiring(&name),
        Some(Command::Boards { page: true, .. }) => boards::page(),
        Some(Command::Boards { json, .. }) => boards::list(json),
        Some(Command::Presets { json, .. }) => presets(json),
        Some(Command::Explain {
            name: Some(name), ..
        }) => host::explain_name::text(&name).map(Outcome::good),
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
                    shown(&crate::protocols::t_format::report(&receiver))
                }
            }
        }
        Some(Command::Schema(arguments)) => schema::run(&arguments),
        Some(Command::Sim(arguments)) => sim::run(&arguments).map(with_engine),
        Some(Command::Crc(arguments)) => crc_command::run(&arguments),
        Some(Command::Prove(arguments)) => prove::run(&arguments),
        Some(Command::Area(arguments)) => area::run(&arguments),
        Some(Command::Flows(arguments)) => flows::run(&arguments),
        Some(Command::Bench(arguments)) => bench::run(&arguments).map(with_engine),
        Some(Command::Campaign(arguments)) => campaign::run(&arguments).map(with_engine),
        Some(Command::Shmoo(arguments)) => shmoo::run(&arguments).map(with_engine),
        Some(Command::Eye(arguments)) => shmoo::eye(arguments).map(with_engine),
        Some(Command::Card(arguments)) => host::virtual_card::run(&arguments).map(with_engine),
        Some(Command::Inject(arguments)) => host::inject::run(&arguments),
        Some(Command::Id(arguments)) => host::id::run(&arguments),
        Some(Command::Read(arguments)) => host::read::run(&arguments),
        Some(Command::Log(arguments)) => host::log::run(&arguments),
        Some(Command::Plot(arguments)) => recorded::plot::run(&arguments),
        Some(Command::Stats(arguments)) => recorded::stats::run(&arguments),
        Some(Command::Monitor(arguments)) => host::monitor::run(&arguments),
        Some(Command::View(arguments)) => host::view::run(&arguments),
        Some(Command::Serve(arguments)) => host::serve::run(&arguments),
        Some(Command::Reg(arguments)) => host::reg::run(&arguments),
        Some(Command::Param(arguments)) => host::param::run(&arguments),
        Some(Command::Margin(arguments)) => host::margin::run(&arguments),
        Some(Command::Doctor(arguments)) => doctor::run(&arguments),
        Some(Command::Completions(arguments)) => documents::completions(&arguments),
        Some(Command::Man(arguments)) => documents::man(&arguments),
    }
}

/// First line of each preset beside its name.
fn presets(json: bool) -> Result<Outcome, GenError> {
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
    fn shown(&self, json: bool) -> Result<String, GenError>;
}

impl<T: serde::Serialize + ToString> Shown for T {
    fn shown(&self, json: bool) -> Result<String, GenError> {
        match json {
            true => to_json(self),
            false => Ok(self.to_string()),
        }
    }
}

/// Indented JSON with a newline at the end.
fn to_json(value: &impl serde::Serialize) -> Result<String, GenError> {
    let text = serde_json::to_string_pretty(value);
    text.map(|t| t + "\n")
        .map_err(|e| GenError::fault("JSON", &e))
}
