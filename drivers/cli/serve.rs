//! `serve`: a card for PandABlocks clients.

use crate::port::{scales, settled, told, RangedPort};
use crate::simulated::is_virtual;
use clap::Args;
use endat_console::error::CommandError;
use endat_console::number::number_if;
use endat_host::panda::{Column, Ports, Server, CONTROL_PORT, DATA_PORT};
use endat_regs::Part;
use endat_terminal::outcome::Outcome;
use endat_terminal::work::interrupted;
use endat_terminal::work::say;
use std::io::Write;
use std::sync::atomic::Ordering;

/// Arguments of `serve`.
#[derive(Args)]
pub struct ServeArgs {
    #[command(flatten)]
    port: RangedPort,
    /// Address to listen at [default: 127.0.0.1]
    #[arg(long, value_name = "ADDRESS")]
    host: Option<String>,
    /// Port for commands, 0 = a free one [default: 8888]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    control_port: Option<String>,
    /// Port for data, 0 = a free one [default: 8889]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    data_port: Option<String>,
    /// End each acquisition after so many samples [default: when it is disarmed]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    samples: Option<String>,
}

/// Runs the command.
pub fn run(arguments: &ServeArgs) -> Result<Outcome, CommandError> {
    let port = |flag, text, usual: u16| -> Result<u16, CommandError> {
        let port = number_if(flag, text, 0..=u16::MAX.into())?;
        Ok(port.map_or(usual, |n| n as u16))
    };
    let control = port("--control-port", &arguments.control_port, CONTROL_PORT)?;
    let data = port("--data-port", &arguments.data_port, DATA_PORT)?;
    let limit = number_if("--samples", &arguments.samples, 1..=u64::from(u32::MAX))?;
    let host = arguments.host.as_deref().unwrap_or("127.0.0.1");
    let open = || {
        Ports::open(host, control, data).map_err(|e| {
            CommandError::input(format!(
                "--host = {host}, ports {control} and {data}: {e}; give an address of this machine with --host, or other ports with --control-port and --data-port"
            ))
        })
    };
    // Ports that are taken are told at once. While encoders are initialised clients are refused, and try again: nobody would answer.
    drop(open()?);
    let mut card = arguments.port.open()?;
    settled(&mut card)?;
    let scales = scales(&mut card)?;
    let additional_data = card.identity().stream_additional_data;
    let columns = Column::all(card.identity().system_hz, &scales, additional_data);
    let ports = open()?;
    let mut stdout = std::io::stdout();
    if let Ok([control, data]) = ports.addresses() {
        let _ = writeln!(stdout, "control {control}\ndata {data}");
        let _ = stdout.flush();
    }
    if !card.identity().has(Part::Stream) {
        say(
            "the card has no part stream: results are read one by one, and not every trigger has a sample"
        );
    }
    let stop = interrupted();
    let mut server = Server::new(&mut card, columns, ports, limit);
    if is_virtual(arguments.port.name()) {
        server.set_waits();
    }
    server.run(|| stop.load(Ordering::Relaxed)).map_err(told)?;
    Ok(Outcome::default())
}
