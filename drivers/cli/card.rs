//! `card`: a card without hardware, for other programs.

use clap::Args;
use endat_card::{serve, Door, VirtualCard, VirtualConfig, CABLE_M};
use endat_config::arguments::SourceArgs;
use endat_config::Configuration;
use endat_console::error::CommandError;
use endat_console::number::decimal_if;
use endat_hdl::card::bus::HostBus;
use endat_terminal::outcome::Outcome;
use endat_terminal::work::interrupted;
use endat_terminal::work::say;
use std::io::Write;
use std::time::Duration;

/// Arguments of `card`.
#[derive(Args)]
pub struct CardArgs {
    #[command(flatten)]
    source: SourceArgs,
    /// Listen at this address, for example 127.0.0.1:7700
    #[arg(long, value_name = "HOST:PORT", conflicts_with = "pty")]
    tcp: Option<String>,
    /// Make a pseudo terminal, to be opened as a serial port [default, where there are any]
    #[arg(long)]
    pty: bool,
    /// Encoder at each port, or one for all that speak its protocol: a device such as RCN-8510, or none [default: as in the configuration]
    #[arg(long, value_name = "DEVICE")]
    encoder: Vec<String>,
    /// Cable to each encoder in metres [default: 10]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    cable_m: Option<String>,
    /// Jitter of the DATA edges, to both sides, in nanoseconds [default: 0]
    #[arg(long, value_name = "NS", allow_negative_numbers = true)]
    jitter_ns: Option<String>,
    /// Turns per second of the shafts [default: 0.25]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    speed: Option<String>,
    /// Make the sets of the stream by arithmetic, in real time: to see what a host does with as many as a real card sends
    #[arg(long)]
    load: bool,
    /// Stop after so many seconds [default: at Ctrl-C]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    seconds: Option<String>,
}

/// Longest cable of a virtual card, in metres.
const CABLE_M_MAX: f64 = 780.0;
/// Most jitter of a virtual card, in nanoseconds.
const JITTER_NS_MAX: f64 = 1_000.0;
/// Fastest shaft.
const SPEED_MAX: f64 = 1_000.0;

#[cfg(unix)]
fn usual_door() -> Result<Door, CommandError> {
    Door::terminal()
}

#[cfg(not(unix))]
fn usual_door() -> Result<Door, CommandError> {
    Err(CommandError::input(
        "--pty: there are no pseudo terminals here; use --tcp 127.0.0.1:7700",
    ))
}

/// How a host's words come to a card without a UART.
fn way_in(configuration: &Configuration) -> Option<String> {
    let told = match configuration {
        Configuration::Receiver(_) => {
            "host.bus = \"dsp\": words 0 to 7 of the port are its addresses, each an access over the pins; it has no registers of a card"
        }
        Configuration::Card(project) => match project.bus {
            HostBus::Uart => return None,
            HostBus::Bare => {
                "host.bus = \"none\": the virtual card has a UART and the registers of a card, so that somebody can look"
            }
            bus => {
                let name = bus.name();
                return Some(format!(
                    "host.bus = \"{name}\": a controller on that bus does what the host asks for, each word an access over the pins"
                ));
            }
        },
    };
    Some(told.into())
}

/// Runs the command.
pub fn run(arguments: &CardArgs) -> Result<Outcome, CommandError> {
    let configuration = arguments.source.load_any()?;
    let within = |flag, text, usual, most| -> Result<f64, CommandError> {
        Ok(decimal_if(flag, text, 0.0..=most)?.unwrap_or(usual))
    };
    let config = VirtualConfig {
        encoders: arguments.encoder.clone(),
        cable_m: within("--cable-m", &arguments.cable_m, CABLE_M, CABLE_M_MAX)?,
        jitter_ns: within("--jitter-ns", &arguments.jitter_ns, 0.0, JITTER_NS_MAX)?.round() as u64,
        speed: within(
            "--speed",
            &arguments.speed,
            VirtualConfig::default().speed,
            SPEED_MAX,
        )?,
        makes_sets: arguments.load,
        ..VirtualConfig::default()
    };
    let seconds = decimal_if("--seconds", &arguments.seconds, 0.0..=1e9)?;
    let seconds = seconds.map(Duration::from_secs_f64);
    let mut door = match &arguments.tcp {
        Some(address) => Door::tcp(address)?,
        None => usual_door()?,
    };
    let (mut card, name) = match &configuration {
        Configuration::Card(project) => (VirtualCard::new(project, &config)?, &project.name),
        Configuration::Receiver(receiver) => {
            (VirtualCard::of_receiver(receiver, &config)?, &receiver.name)
        }
    };
    // The one line that a program which starts this one reads.
    let mut stdout = std::io::stdout();
    let _ = writeln!(stdout, "{}", door.name());
    let _ = stdout.flush();
    say(&format!(
        "virtual card {name} at {}: simulated, nothing is measured; Ctrl-C ends it",
        door.name()
    ));
    if let Some(told) = way_in(&configuration) {
        say(&told);
    }
    let stop = interrupted();
    let mut is_first = true;
    serve(&mut card, &mut door, &stop, seconds, |pace| {
        if is_first {
            say(&format!(
                "the card's time runs at {:.3} of real time ({})",
                pace.ratio().min(1.0),
                if pace.ratio() > 0.98 {
                    "as a real card"
                } else {
                    "as fast as this machine simulates"
                }
            ));
            is_first = false;
        }
    });
    say("virtual card ended");
    Ok(Outcome::default())
}
