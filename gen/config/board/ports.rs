//! Ports of a board top: what each is for, and which a card has.

use endat_hdl::card::bus::HostBus;
use endat_hdl::config::CHANNELS;
use endat_regs::{Protocol, Protocols};
use std::collections::BTreeSet;

/// What a port of the top level is for; decides its constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Board oscillator.
    Oscillator,
    /// Output to a transceiver: clock, data, driver enable.
    Transceiver,
    /// Answer of the encoder, asynchronous.
    EncoderData,
    /// Trigger pin, asynchronous.
    Trigger,
    /// UART input, asynchronous.
    UartInput,
    /// UART output.
    UartOutput,
    /// Input from a bus outside the device, asynchronous.
    BusInput,
    /// The same, low when it acts.
    BusStrobe,
    /// Output to a bus outside the device, driven only while the card is read.
    BusOutput,
    /// Data line of a bus outside the device, driven by either side.
    BusData,
    /// Interrupt to a processor outside the device.
    Interrupt,
    /// Light.
    Led,
}

impl Kind {
    /// All of them, with the names by which a family's file gives their attributes.
    pub const NAMES: [(Self, &'static str); 12] = [
        (Self::Oscillator, "oscillator"),
        (Self::Transceiver, "transceiver"),
        (Self::EncoderData, "encoder_data"),
        (Self::Trigger, "trigger"),
        (Self::UartInput, "uart_input"),
        (Self::UartOutput, "uart_output"),
        (Self::BusInput, "bus_input"),
        (Self::BusStrobe, "bus_strobe"),
        (Self::BusOutput, "bus_output"),
        (Self::BusData, "bus_data"),
        (Self::Interrupt, "interrupt"),
        (Self::Led, "led"),
    ];

    /// Its name in a family's file.
    pub fn name(self) -> &'static str {
        let found = Self::NAMES.iter().find(|(kind, _)| *kind == self);
        found.map_or("", |(_, name)| name)
    }

    /// Whether the port is an input of the device.
    pub const fn is_input(self) -> bool {
        matches!(
            self,
            Self::Oscillator
                | Self::EncoderData
                | Self::Trigger
                | Self::UartInput
                | Self::BusInput
                | Self::BusStrobe
        )
    }

    /// Its direction in a module's port list, padded.
    pub const fn direction(self) -> &'static str {
        match self {
            Self::BusData => "inout  wire",
            kind if kind.is_input() => "input  wire",
            _ => "output wire",
        }
    }

    /// Why the timing of the port must not be analysed; `None` when it must.
    pub const fn asynchronous(self) -> Option<&'static str> {
        match self {
            Self::EncoderData => Some("answers arrive with the delay of the cable, in any phase; synchronised and tracked inside"),
            Self::Trigger => Some("belongs to no clock; synchronised inside, one system clock of jitter is documented"),
            Self::UartInput => Some("belongs to the host's clock; synchronised and sampled in mid bit inside"),
            Self::BusInput | Self::BusStrobe | Self::BusData => Some("belongs to the clock of the other end; synchronised inside, see the rules of its bus for set-up times"),
            _ => None,
        }
    }
}

/// One signal of the top level on one pin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assignment {
    /// Port of the top level.
    pub signal: String,
    /// What the signal is for.
    pub kind: Kind,
    /// Package pin.
    pub pin: String,
    /// Connector and position, or empty.
    pub position: String,
}

impl Assignment {
    /// What it is, in words, on a card whose channels speak these.
    pub fn meaning(&self, protocols: Protocols) -> String {
        let channel: String = self.signal.chars().filter(char::is_ascii_digit).collect();
        let spoken = channel.parse().map_or(Protocol::Endat, |n| protocols.of(n));
        match (self.kind, self.signal.as_str()) {
            (Kind::Oscillator, _) => "oscillator of the board".into(),
            (Kind::Transceiver, s) if s.ends_with("_oe") => {
                format!("driver enable of the DATA transceiver, channel {channel}")
            }
            (Kind::Transceiver, s) if s.contains("clk") && !spoken.row().has_clock => {
                let name = spoken.name();
                format!("stays HIGH: channel {channel} speaks {name}, which has no clock")
            }
            (Kind::Transceiver, s) if s.contains("clk") => {
                format!("EnDat CLOCK to its driver, channel {channel}; idles high")
            }
            (Kind::Transceiver, _) => format!("DATA to the encoder, channel {channel}"),
            (Kind::EncoderData, _) => format!("DATA from the encoder, channel {channel}"),
            (Kind::Trigger, _) => "external trigger, rising edge".into(),
            (Kind::UartInput, _) => "host UART, from the host".into(),
            (Kind::UartOutput, _) => "host UART, to the host".into(),
            (Kind::BusInput, "spi_sck_i") => "host SPI, clock, mode 0".into(),
            (Kind::BusStrobe, "spi_cs_n_i") => "host SPI, selects the card when low".into(),
            (Kind::BusInput, "spi_mosi_i") => "host SPI, from the host".into(),
            (Kind::BusInput, "second_sck_i") => "second controller's SPI, clock, mode 0".into(),
            (Kind::BusStrobe, "second_cs_n_i") => {
                "second controller's SPI, selects the card when low".into()
            }
            (Kind::BusOutput, "second_miso_o") => {
                "second controller's SPI, to the controller; driven while selected".into()
            }
            (Kind::BusOutput, _) => "host SPI, to the host; driven while selected".into(),
            (Kind::BusStrobe, "bus_cs_n_i") => "host bus, selects the card when low".into(),
            (Kind::BusStrobe, "bus_rd_n_i") => "host bus, reads when low".into(),
            (Kind::BusStrobe, "bus_wr_n_i") => "host bus, writes when low".into(),
            (Kind::BusInput | Kind::BusStrobe, _) => "host bus, register".into(),
            (Kind::BusData, _) => "host bus, data; driven while read".into(),
            (Kind::Interrupt, _) => "interrupt to the host".into(),
            (Kind::Led, "led_status_o") => "status light".into(),
            (Kind::Led, _) => format!("light of channel {channel}"),
        }
    }

    /// Connector and pin, as people look for them.
    pub fn place(&self) -> String {
        match self.position.as_str() {
            "" => self.pin.clone(),
            position => format!("{position} ({})", self.pin),
        }
    }
}

/// Address lines of the parallel bus.
pub const PARALLEL_ADDRESS_LINES: usize = 3;
/// Data lines of the parallel bus.
pub const PARALLEL_DATA_LINES: usize = 16;
/// Name of the oscillator port of the board top.
pub const OSCILLATOR_PORT: &str = "osc_i";

/// Buses that leave the device.
pub const BUSES: [HostBus; 3] = [HostBus::Uart, HostBus::Spi, HostBus::Parallel];

/// The ports of a bus that leaves the device.
pub fn bus_ports(bus: HostBus) -> Vec<(String, Kind)> {
    let inputs = |names: &[&str]| -> Vec<(String, Kind)> {
        let kind = |name: &str| match name.ends_with("_n_i") {
            true => Kind::BusStrobe,
            false => Kind::BusInput,
        };
        let names = names.iter();
        names.map(|n| ((*n).to_owned(), kind(n))).collect()
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
        ports.push(("second_cs_n_i".to_owned(), Kind::BusStrobe));
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

/// All signals that any card has on a board.
pub fn signals() -> Vec<String> {
    let more = MorePorts {
        interrupt: true,
        second_interface: true,
    };
    let ports = BUSES.map(|bus| card_ports(bus, more, *CHANNELS.end()));
    let all: BTreeSet<String> = (ports.into_iter().flatten())
        .map(|(signal, _)| signal)
        .collect();
    all.into_iter().collect()
}
