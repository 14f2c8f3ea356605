//! Where the card is, and what every command does with it first.

use crate::simulated::virtual_card_at;
use clap::Args;
use endat_console::error::CommandError;
use endat_console::number::{number, number_if};
use endat_host::mailbox::INITIALISATION;
pub use endat_host::owner::AnyCard;
use endat_host::range::Ranges;
use endat_host::registers::Place;
use endat_host::transport::Port;
use endat_host::units::Scale;
use endat_host::{Bridge, HostError, Transport};
use endat_terminal::work::say;
use std::ops::Deref;
use std::sync::mpsc::{channel as channel_of_threads, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// Baud rate of the cards that come with the program.
const BAUD: u32 = 3_000_000;

/// Where the card is.
#[derive(Args, Clone)]
pub struct PortArgs {
    /// Serial port, tcp:HOST:PORT, or virtual, virtual:PRESET, virtual:FILE.toml for a simulated card in the program itself
    #[arg(long, value_name = "PORT")]
    port: String,
    /// Baud rate of a serial port [default: 3000000]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    baud: Option<String>,
}

/// Ranges given by the user, where card and name plates lack them or are wrong.
#[derive(Args, Clone)]
pub struct RangeArgs {
    /// What positions of a channel are, as its encoder's data sheet has it: 0=17+16 for 17 bits of angle and 16 that count turns, 1=linear for a scale [default: as the encoder or the card's configuration says]
    #[arg(long, value_name = "CHANNEL=SINGLE+MULTI")]
    range: Vec<String>,
}

impl RangeArgs {
    /// The parsed ranges.
    pub fn ranges(&self) -> Result<Ranges, CommandError> {
        Ranges::parse(&self.range).map_err(told)
    }
}

/// Where a card is whose positions are wanted.
#[derive(Args, Clone)]
pub struct RangedPort {
    #[command(flatten)]
    port: PortArgs,
    #[command(flatten)]
    range: RangeArgs,
}

impl Deref for RangedPort {
    type Target = PortArgs;

    fn deref(&self) -> &PortArgs {
        &self.port
    }
}

impl RangedPort {
    /// The ranges that the user has given.
    pub fn ranges(&self) -> Result<Ranges, CommandError> {
        self.range.ranges()
    }

    /// Opens the link, finds out who answers, and lets it know what is said.
    pub fn open(&self) -> Result<AnyCard, CommandError> {
        // A wrong word is refused before the link is opened.
        let ranges = self.ranges()?;
        let mut card = self.port.open()?;
        card.set_ranges(ranges).map_err(told)?;
        Ok(card)
    }
}

/// The scale of every channel; prints notes about contradictions.
pub fn scales(card: &mut AnyCard) -> Result<Vec<Scale>, CommandError> {
    let notes = card.scale_notes().map_err(told)?;
    notes.iter().for_each(|note| say(note));
    card.scales().map_err(told)
}

/// What the library says, as a message of this program.
pub fn told(error: HostError) -> CommandError {
    match error {
        HostError::Refused(text) => CommandError::CheckFailed(vec![text]),
        error @ (HostError::Silent { .. } | HostError::NoSample { .. }) => {
            CommandError::CheckFailed(vec![error.to_string()])
        }
        error => CommandError::input(error.to_string()),
    }
}

impl PortArgs {
    /// The port as the user named it.
    pub fn name(&self) -> &str {
        &self.port
    }

    /// The port, if it has a name.
    pub fn checked_name(&self) -> Result<&str, CommandError> {
        match self.port.is_empty() {
            false => Ok(&self.port),
            true => Err(CommandError::input(
                "--port = \"\": is empty; give the card's serial port, tcp:HOST:PORT or virtual",
            )),
        }
    }

    /// Baud rate of a serial port.
    pub fn baud(&self) -> Result<u32, CommandError> {
        let baud = number_if("--baud", &self.baud, 300..=12_000_000)?;
        Ok(baud.map_or(BAUD, |n| n as u32))
    }

    /// Opens the link and finds out who answers.
    pub fn open(&self) -> Result<AnyCard, CommandError> {
        let (name, baud) = (self.checked_name()?, self.baud()?);
        let transport = match virtual_card_at(name)? {
            Some(card) => Box::new(card) as Box<dyn Transport>,
            None => {
                let open = || Port::open(name, baud).map_err(told);
                Box::new(patiently(name, open)?) as Box<dyn Transport>
            }
        };
        let find = || endat_host::Card::find(Bridge::new(transport)).map_err(told);
        patiently(name, find)
    }
}

/// The channel that an option names.
pub fn channel(card: &AnyCard, text: Option<&str>) -> Result<usize, CommandError> {
    let last = card.identity().channels as u64 - 1;
    let text = text.unwrap_or("0");
    number("--channel", text, 0..=last).map(|n| n as usize)
}

/// What takes longer is told.
const PATIENCE: Duration = Duration::from_millis(1_500);

/// Does something that waits for a card, and says so if it takes long.
pub fn patiently<T>(port: &str, work: impl FnOnce() -> T) -> T {
    let (done, wait) = channel_of_threads::<()>();
    let text = format!(
        "waiting for the card at {port}: it does not answer yet; another program, or one that has been killed, may still have it"
    );
    thread::spawn(move || {
        if wait.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
            say(&text);
        }
    });
    let result = work();
    drop(done);
    result
}

/// Says once that an initialisation takes long.
pub fn long() {
    say(&format!(
        "waiting for the initialisation of the encoders, up to {} s",
        INITIALISATION.as_secs()
    ));
}

/// Waits until no encoder is being initialised and every channel has had a first result, or has none after a second.
pub fn settled(card: &mut AnyCard) -> Result<(), CommandError> {
    card.settle(long).map_err(told)
}

/// Refuses a card that nothing triggers, with the command that mends it.
pub fn needs_trigger(card: &mut AnyCard, port: &PortArgs) -> Result<(), CommandError> {
    let remedy = format!(
        "as with `endat reg write card_config.trigger_sources.timer 1 --port {}`",
        port.name()
    );
    card.needs_trigger(&remedy).map_err(told)
}

/// A place that is in every map.
pub fn place(card: &AnyCard, name: &str) -> Result<Place, CommandError> {
    card.place(name).map_err(told)
}
