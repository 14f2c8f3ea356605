//! The commands that talk to a card, real or virtual.

pub mod explain_name;
pub mod id;
pub mod log;
pub mod margin;
pub mod monitor;
pub mod param;
pub mod read;
pub mod reg;
pub mod serve;
pub mod virtual_card;

use super::number::{number, number_if};
use crate::config::{load_file, load_preset, preset_of, DEFAULT_PRESET};
use crate::error::GenError;
use crate::virtual_card::{VirtualCard, VirtualConfig};
use clap::Args;
use endat_host::mailbox::INITIALISATION;
use endat_host::registers::Place;
use endat_host::transport::Port;
use endat_host::units::Scale;
use endat_host::{Bridge, HostError, Transport};
use endat_regs::Part;
use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Baud rate of the cards that come with the program.
const BAUD: u32 = 3_000_000;

/// A card, whatever it is behind.
pub type AnyCard = endat_host::Card<Box<dyn Transport>>;

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

/// What the library says, as a message of this program.
pub fn told(error: HostError) -> GenError {
    match error {
        HostError::Refused(text) => GenError::CheckFailed(vec![text]),
        error @ HostError::Silent { .. } => GenError::CheckFailed(vec![error.to_string()]),
        error => GenError::input(error.to_string()),
    }
}

impl PortArgs {
    /// The port as the user named it.
    pub fn name(&self) -> &str {
        &self.port
    }

    /// Opens the link and finds out who answers.
    pub fn open(&self) -> Result<AnyCard, GenError> {
        let baud = number_if("--baud", &self.baud, 300..=12_000_000)?;
        let baud = baud.map_or(BAUD, |n| n as u32);
        if self.port.is_empty() {
            return Err(GenError::input(
                "--port = \"\": is empty; give the card's serial port, tcp:HOST:PORT or virtual",
            ));
        }
        let transport: Box<dyn Transport> = match self.port.strip_prefix("virtual") {
            Some("") => virtual_card(DEFAULT_PRESET)?,
            Some(rest) if rest.starts_with(':') => virtual_card(&rest[1..])?,
            _ => Box::new(Port::open(&self.port, baud).map_err(told)?),
        };
        endat_host::Card::find(Bridge::new(transport)).map_err(told)
    }
}

fn virtual_card(name: &str) -> Result<Box<dyn Transport>, GenError> {
    let project = match name.ends_with(".toml") {
        true => load_file(Path::new(name))?,
        false => {
            preset_of("virtual:PRESET in --port", name)?;
            load_preset(name)?
        }
    };
    Ok(Box::new(VirtualCard::new(
        &project,
        &VirtualConfig::default(),
    )?))
}

/// The channel that an option names.
pub fn channel(card: &AnyCard, text: Option<&str>) -> Result<usize, GenError> {
    let last = card.identity().channels as u64 - 1;
    let text = text.unwrap_or("0");
    number("--channel", text, 0..=last).map(|n| n as usize)
}

/// What a measuring step of a channel is: as the encoder says, else as if the position were one turn.
fn scale(card: &mut AnyCard, channel: usize) -> Result<Scale, GenError> {
    if card.identity().is_t_format(channel) {
        return Ok(Scale::TFormat);
    }
    if card.identity().has(Part::Initialise) {
        if let Some(scale) = card.name_plate(channel).map_err(told)?.scale() {
            return Ok(scale);
        }
    }
    let place = card.place(&format!("config{channel}.frame.position_bits"));
    let bits = place.and_then(|place| card.read(&place)).map_err(told)?;
    Ok(Scale::singleturn(bits))
}

/// What a measuring step is, of every channel.
pub fn scales(card: &mut AnyCard) -> Result<Vec<Scale>, GenError> {
    let channels = 0..card.identity().channels;
    channels.map(|channel| scale(card, channel)).collect()
}

/// Waits until no encoder is being initialised, or a minute; says so when it takes long.
pub fn initialised(card: &mut AnyCard) -> Result<(), GenError> {
    if !card.identity().has(Part::Initialise) {
        return Ok(());
    }
    let begin = Instant::now();
    let mut is_told = false;
    let identity = *card.identity();
    for channel in (0..identity.channels).filter(|n| !identity.is_t_format(*n)) {
        let running = place(card, &format!("service{channel}.state.initialising"))?;
        while card.read(&running).map_err(told)? == 1 && begin.elapsed() < INITIALISATION {
            if !is_told && begin.elapsed() > Duration::from_secs(1) {
                is_told = true;
                let _ = writeln!(
                    std::io::stderr(),
                    "endat-gen: waiting for the initialisation of the encoders, up to {} s",
                    INITIALISATION.as_secs()
                );
            }
        }
    }
    Ok(())
}

/// Waits until no encoder is being initialised and every channel has had a first result, or has none after a second.
pub fn settled(card: &mut AnyCard) -> Result<(), GenError> {
    initialised(card)?;
    let end = Instant::now() + Duration::from_secs(1);
    while Instant::now() < end {
        let results = card.results().map_err(told)?;
        // The first frame measures the delay; the second one is as all others.
        if results.channels.iter().all(|r| r.sequence > 1) {
            break;
        }
    }
    Ok(())
}

/// Raised by Ctrl-C.
pub fn interrupted() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = flag.clone();
    // Only the first handler counts; a second one in the same process is a test.
    let _ = ctrlc::set_handler(move || raised.store(true, Ordering::Relaxed));
    flag
}

/// A place that is in every map.
pub fn place(card: &AnyCard, name: &str) -> Result<Place, GenError> {
    card.place(name).map_err(told)
}
