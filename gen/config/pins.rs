//! Which port of the board top is on which pin.

use super::reader::{Source, Table};
use super::Kind;
use crate::board::{Assignment, Board};
use endat_hdl::bus::HostBus;
use std::collections::BTreeSet;

/// Address lines of the parallel bus.
pub const PARALLEL_ADDRESS_LINES: usize = 3;
/// Data lines of the parallel bus.
pub const PARALLEL_DATA_LINES: usize = 16;

/// The ports of a bus that leaves the device.
fn bus_ports(bus: HostBus) -> Vec<(String, Kind)> {
    let inputs = |names: &[&str]| -> Vec<(String, Kind)> {
        let names = names.iter();
        names.map(|n| ((*n).to_owned(), Kind::BusInput)).collect()
    };
    match bus {
        HostBus::Uart => vec![
            ("uart_rx_i".to_owned(), Kind::UartInput),
            ("uart_tx_o".to_owned(), Kind::UartOutput),
        ],
        HostBus::Spi => {
            let mut ports = inputs(&["spi_sck_i", "spi_cs_n_i", "spi_mosi_i"]);
            ports.push(("spi_miso_o".to_owned(), Kind::BusOutput));
            ports
        }
        HostBus::Parallel => {
            let mut ports = inputs(&["bus_cs_n_i", "bus_rd_n_i", "bus_wr_n_i"]);
            let lines = 0..PARALLEL_ADDRESS_LINES;
            ports.extend(lines.map(|n| (format!("bus_address{n}_i"), Kind::BusInput)));
            let lines = 0..PARALLEL_DATA_LINES;
            ports.extend(lines.map(|n| (format!("bus_data{n}_io"), Kind::BusData)));
            ports
        }
        _ => vec![],
    }
}

/// What decides which ports a card has besides those of its bus and channels.
#[derive(Clone, Copy, Debug, Default)]
pub struct MorePorts {
    /// An interrupt.
    pub interrupt: bool,
    /// The second interface.
    pub second_interface: bool,
}

/// The ports of the board top except the oscillator, in their order.
pub fn card_ports(bus: HostBus, more: MorePorts, channels: usize) -> Vec<(String, Kind)> {
    let mut ports = vec![("trigger_i".to_owned(), Kind::Trigger)];
    ports.extend(bus_ports(bus));
    if more.interrupt {
        ports.push(("irq_o".to_owned(), Kind::Interrupt));
    }
    if more.second_interface {
        ports.push(("second_sck_i".to_owned(), Kind::BusInput));
        ports.push(("second_cs_n_i".to_owned(), Kind::BusInput));
        ports.push(("second_miso_o".to_owned(), Kind::BusOutput));
    }
    for n in 0..channels {
        ports.push((format!("endat_clk{n}_o"), Kind::Transceiver));
        ports.push((format!("endat_data{n}_o"), Kind::Transceiver));
        ports.push((format!("endat_data{n}_oe"), Kind::Transceiver));
        ports.push((format!("endat_data{n}_i"), Kind::EncoderData));
    }
    ports.push(("led_status_o".to_owned(), Kind::Led));
    ports.extend((0..channels).map(|n| (format!("led_channel{n}_o"), Kind::Led)));
    ports
}

/// Name of the oscillator port of the board top.
pub const OSCILLATOR_PORT: &str = "osc_i";

/// The pin of every port; complaints go to `source`.
pub(super) fn assign_pins(
    source: &Source<'_>,
    pins: &Table<'_, '_>,
    board: &Board,
    ports: Vec<(String, Kind)>,
) -> Vec<Assignment> {
    let moved = pins.free_strings();
    for (signal, at) in &moved {
        if !ports.iter().any(|(port, _)| port == signal) {
            let names: Vec<&str> = ports.iter().map(|(port, _)| port.as_str()).collect();
            let text = format!("no such signal; signals: {}", names.join(", "));
            pins.complain(at.line, signal, &format!("{:?}", at.value), &text);
        }
    }
    let taken: BTreeSet<String> = ports
        .iter()
        .filter_map(|(signal, _)| {
            let user = moved.iter().find(|(s, _)| s == signal);
            user.map(|(_, at)| &at.value)
                .or_else(|| board.usual_place(signal))
        })
        .filter_map(|word| board.pin(word).ok())
        .collect();
    let mut free = board.places().filter(|(_, pin)| !taken.contains(*pin));
    let mut all = vec![Assignment {
        signal: OSCILLATOR_PORT.into(),
        kind: Kind::Oscillator,
        pin: board.oscillator_pin.clone(),
        position: String::new(),
    }];
    for (signal, kind) in ports {
        let user = moved.iter().find(|(s, _)| *s == signal).map(|(_, at)| at);
        let Some(word) = user
            .map(|at| &at.value)
            .or_else(|| board.usual_place(&signal))
        else {
            let place = free.next().map_or(String::new(), |(place, _)| place);
            let text = format!(
                "{}: {} has no usual pin for it; add, for example, `{signal} = \"{place}\"` to [pins]",
                pins.name(&signal),
                board.name
            );
            source.complain_line(pins.line, text);
            continue;
        };
        let line = user.map_or(pins.line, |at| at.line);
        let pin = match board.pin(word) {
            Ok(pin) => pin,
            Err(text) => {
                pins.complain(line, &signal, &format!("{word:?}"), &text);
                continue;
            }
        };
        if let Some(other) = all.iter().find(|a: &&Assignment| a.pin == pin) {
            // The one that the file has moved is the one to complain about, whichever comes first.
            let moved_other = moved
                .iter()
                .find(|(s, _)| *s == other.signal)
                .map(|(_, at)| at);
            let (mover, at, place) = match (user, moved_other) {
                (None, Some(at)) => (other.signal.as_str(), at.line, &at.value),
                _ => (signal.as_str(), line, word),
            };
            let taken = if mover == signal {
                &other.signal
            } else {
                &signal
            };
            let text =
                format!("{pin} already carries {taken}; choose a free pin for one of the two");
            pins.complain(at, mover, &format!("{place:?}"), &text);
            continue;
        }
        let position = board.position(&pin);
        all.push(Assignment {
            signal,
            kind,
            pin,
            position,
        });
    }
    all
}
