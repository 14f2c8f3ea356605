//! Simulated cards, where the program is built with them.

#[cfg(feature = "virtual")]
pub use endat_card::{card_at, is_virtual, virtual_card_at, FAULTS};

#[cfg(not(feature = "virtual"))]
pub use without::{card_at, is_virtual, virtual_card_at, FAULTS};

#[cfg(not(feature = "virtual"))]
mod without {
    use endat_console::error::CommandError;
    use endat_host::owner::AnyCard;
    use endat_host::transport::Port;
    use endat_host::{Bridge, HostError, Transport};

    /// Faults that can be made.
    pub const FAULTS: [(&str, &str, &str); 0] = [];

    /// Whether the port is a card simulated in this process.
    pub fn is_virtual(_: &str) -> bool {
        false
    }

    /// The simulated card of a port: an error where one is asked for, none for other ports.
    pub fn virtual_card_at(port: &str) -> Result<Option<Box<dyn Transport>>, CommandError> {
        let is_asked = ["virtual", "load"].iter().any(|word| {
            let rest = port.strip_prefix(word);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(':'))
        });
        match is_asked {
            true => Err(CommandError::input(format!(
                "--port = {port}: this program is built without simulated cards; install it with `cargo install --path drivers/cli`, or give the port of a card"
            ))),
            false => Ok(None),
        }
    }

    /// Finds the card of a port.
    pub fn card_at(port: &str, baud: u32) -> Result<AnyCard, HostError> {
        let checked = virtual_card_at(port);
        checked.map_err(|e| HostError::Name(e.messages().join("\n")))?;
        AnyCard::find(Bridge::new(Box::new(Port::open(port, baud)?)))
    }
}
