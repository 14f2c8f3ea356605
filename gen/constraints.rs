//! Board-dependent files: the board top with the clock manager, the UCF, and the page about both.

use crate::artifact::Artifact;
use crate::board::Assignment;
use crate::config::pins::{PARALLEL_ADDRESS_LINES, PARALLEL_DATA_LINES};
use crate::config::{Kind, Project};
use crate::error::GenError;
use crate::explain;
use crate::template;
use crate::testbench::RESET_CYCLES;
use endat_hdl::bus::HostBus;
use endat_hdl::service::program::CLEAR_CYCLES;
use endat_hdl::timing::ABORT_US;
use endat_sim::decimal;
use minijinja::context;
use minijinja::value::{Serde, Value};
use serde::Serialize;

const TEMPLATES: [(&str, &str); 3] = [
    (
        "top.v",
        include_str!("../constraints/templates/top.v.jinja"),
    ),
    ("ucf", include_str!("../constraints/templates/ucf.jinja")),
    (
        "readme",
        include_str!("../constraints/templates/readme.md.jinja"),
    ),
];

/// A port as the templates see it.
#[derive(Serialize)]
struct Port {
    signal: String,
    pin: String,
    position: String,
    meaning: String,
    direction: &'static str,
    /// The last register belongs into the output cell.
    iob: bool,
    /// UCF attributes beside place and I/O standard.
    attributes: &'static str,
    /// Why the timing is not analysed; empty when it is.
    asynchronous: &'static str,
}

/// What a port is, in words; `t_format` are the channels that speak it.
fn meaning(pin: &Assignment, t_format: &[usize]) -> String {
    let channel: String = pin.signal.chars().filter(char::is_ascii_digit).collect();
    let is_t_format = channel.parse().is_ok_and(|n| t_format.contains(&n));
    match (pin.kind, pin.signal.as_str()) {
        (Kind::Oscillator, _) => "oscillator of the board".into(),
        (Kind::Transceiver, s) if s.ends_with("_oe") => {
            format!("driver enable of the DATA transceiver, channel {channel}")
        }
        (Kind::Transceiver, s) if s.contains("clk") && is_t_format => {
            format!("stays HIGH: channel {channel} speaks T-format, which has no clock")
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
        (Kind::BusInput, "spi_cs_n_i") => "host SPI, selects the card when low".into(),
        (Kind::BusInput, "spi_mosi_i") => "host SPI, from the host".into(),
        (Kind::BusInput, "second_sck_i") => "second controller's SPI, clock, mode 0".into(),
        (Kind::BusInput, "second_cs_n_i") => {
            "second controller's SPI, selects the card when low".into()
        }
        (Kind::BusOutput, "second_miso_o") => {
            "second controller's SPI, to the controller; driven while selected".into()
        }
        (Kind::BusOutput, _) => "host SPI, to the host; driven while selected".into(),
        (Kind::BusInput, "bus_cs_n_i") => "host bus, selects the card when low".into(),
        (Kind::BusInput, "bus_rd_n_i") => "host bus, reads when low".into(),
        (Kind::BusInput, "bus_wr_n_i") => "host bus, writes when low".into(),
        (Kind::BusInput, _) => "host bus, register".into(),
        (Kind::BusData, _) => "host bus, data; driven while read".into(),
        (Kind::Interrupt, _) => "interrupt to the host".into(),
        (Kind::Led, "led_status_o") => "status light".into(),
        (Kind::Led, _) => format!("light of channel {channel}"),
    }
}

fn attributes(kind: Kind, signal: &str) -> &'static str {
    match kind {
        Kind::Oscillator => "",
        // Slow edges are fast enough for 16 MHz and ring less on the wires to the wing.
        Kind::Transceiver => " | SLEW = SLOW | DRIVE = 8 | IOB = TRUE",
        // An unplugged wing then reads like an open line: high, never a start bit after low.
        Kind::EncoderData | Kind::UartInput => " | PULLUP",
        // An open trigger pin must stay quiet.
        Kind::Trigger => " | PULLDOWN",
        // Strobes are low when they act; an open bus must stay quiet.
        Kind::BusInput if signal.ends_with("_n_i") => " | PULLUP",
        Kind::BusInput => " | PULLDOWN",
        Kind::BusData => " | SLEW = SLOW | DRIVE = 8 | PULLDOWN",
        Kind::UartOutput | Kind::BusOutput | Kind::Interrupt => " | SLEW = SLOW | DRIVE = 8",
        Kind::Led => " | SLEW = QUIETIO | DRIVE = 8",
    }
}

impl Port {
    fn new(pin: &Assignment, t_format: &[usize]) -> Self {
        Self {
            signal: pin.signal.clone(),
            pin: pin.pin.clone(),
            position: pin.position.clone(),
            meaning: meaning(pin, t_format),
            direction: pin.kind.direction(),
            iob: pin.kind == Kind::Transceiver,
            attributes: attributes(pin.kind, &pin.signal),
            asynchronous: pin.kind.asynchronous().unwrap_or(""),
        }
    }
}

/// A number of ns as the vendor's tools read it, without needless digits.
fn ns(hz: u64) -> String {
    decimal(1e9 / hz as f64, 4)
}

/// Where an interrupt goes that the configuration does not ask for.
const UNUSED_INTERRUPT: &str = "unused_interrupt";

/// Every front but the UART has the port of the interrupt.
fn has_unused_interrupt(project: &Project) -> bool {
    project.bus != HostBus::Uart && !project.card.outputs.interrupt
}

/// Outputs that others may drive, too, while the card does not; without the end of their names.
fn shared_outputs(project: &Project) -> impl Iterator<Item = &str> {
    let outputs = project.pins.iter().filter(|p| p.kind == Kind::BusOutput);
    outputs.map(|pin| pin.signal.trim_end_matches("_o"))
}

/// What the top connects to a port of the card.
#[derive(Serialize)]
struct Connection {
    port: String,
    net: String,
}

/// All ports of the card but clock and reset. Lines of a bus are pins one by one, and one vector at the card.
fn connections(project: &Project) -> Vec<Connection> {
    let own = project
        .pins
        .iter()
        .filter(|pin| !matches!(pin.kind, Kind::Oscillator | Kind::BusOutput | Kind::BusData))
        .filter(|pin| !pin.signal.starts_with("bus_address"))
        .map(|pin| (pin.signal.clone(), pin.signal.clone()));
    let lines = |name: &str, end: &str, count: usize| {
        let names = (0..count).rev().map(|n| format!("{name}{n}_{end}"));
        format!("{{{}}}", names.collect::<Vec<_>>().join(", "))
    };
    let shared = shared_outputs(project).flat_map(|name| {
        let of = |end: &str| format!("{name}{end}");
        [(of("_o"), of("")), (of("_oe"), of("_oe"))]
    });
    let mut bus = match project.bus {
        HostBus::Parallel => vec![
            (
                "bus_address_i",
                lines("bus_address", "i", PARALLEL_ADDRESS_LINES),
            ),
            ("bus_data_i", lines("bus_data", "io", PARALLEL_DATA_LINES)),
            ("bus_data_o", "bus_data".to_owned()),
            ("bus_data_oe", "bus_data_oe".to_owned()),
        ],
        _ => vec![],
    };
    if has_unused_interrupt(project) {
        bus.push(("irq_o", UNUSED_INTERRUPT.to_owned()));
    }
    let bus = bus.into_iter().map(|(port, net)| (port.to_owned(), net));
    own.chain(shared)
        .chain(bus)
        .map(|(port, net)| Connection { port, net })
        .collect()
}

/// Board top, UCF and README of a project; without a board only a README that says how to use the card.
pub fn artifacts(project: &Project) -> Result<Vec<Artifact>, GenError> {
    let (Some(board), Some(pll)) = (&project.board, &project.pll) else {
        let context = context! {
            name => project.name.as_str(),
            version => env!("CARGO_PKG_VERSION"),
            hash => project.hash.as_str(),
            bus => project.bus.name(),
            internal => project.bus.is_internal(),
            bare => project.bus == HostBus::Bare,
            system_hz => project.card.system_hz,
            channels => project.card.channels.len(),
            second => project.card.safety.second_interface,
            protocols => project.protocols(),
            t_format => project.card.t_format_numbers().collect::<Vec<_>>(),
            quiet_ms => ABORT_US / 1_000,
            initial_values => project.card.initial_values,
            reset_cycles => RESET_CYCLES,
            clear_cycles => project.card.service.requests.then_some(CLEAR_CYCLES),
            timing => explain::report(project).to_string(),
        };
        let text = include_str!("../constraints/templates/readme_bus.md.jinja");
        let text = template::render("readme_bus", text, &context)?;
        return Ok(vec![Artifact::new("README.md", text)]);
    };
    let t_format: Vec<usize> = project.card.t_format_numbers().collect();
    let ports: Vec<Value> = project
        .pins
        .iter()
        .map(|pin| Value::from(Serde(Port::new(pin, &t_format))))
        .collect();
    let context = context! {
        name => project.name.as_str(),
        version => env!("CARGO_PKG_VERSION"),
        hash => project.hash.as_str(),
        initial_values => project.card.initial_values,
        reset_cycles => RESET_CYCLES,
        board => context! { title => board.title.as_str(), name => board.name.as_str(), part => board.part.as_str() },
        iostandard => board.iostandard.as_str(),
        ports => ports,
        bus => project.bus.name(),
        data_lines => PARALLEL_DATA_LINES,
        connections => Serde(connections(project)),
        shared => Serde(shared_outputs(project).collect::<Vec<_>>()),
        unused_interrupt => has_unused_interrupt(project).then_some(UNUSED_INTERRUPT),
        widest => project.pins.iter().map(|p| p.signal.len()).max().unwrap_or(0),
        oscillator_hz => board.oscillator_hz,
        oscillator_ns => ns(board.oscillator_hz),
        system_hz => project.card.system_hz,
        system_ns => ns(project.card.system_hz),
        pll => context! { divide => pll.divide, multiply => pll.multiply, output_divide => pll.output_divide, vco_hz => pll.vco_hz },
        channels => project.card.channels.len(),
        protocols => project.protocols(),
        t_format,
        timing => explain::report(project).to_string(),
    };
    let files = [
        format!("{}_top.v", project.name),
        format!("{}.ucf", project.name),
        "README.md".into(),
    ];
    TEMPLATES
        .iter()
        .zip(files)
        .map(|((name, template), path)| {
            Ok(Artifact::new(
                path,
                template::render(name, template, &context)?,
            ))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn periods_are_written_without_needless_digits() {
        assert_eq!(ns(32_000_000), "31.25");
        assert_eq!(ns(100_000_000), "10");
        assert_eq!(ns(128_000_000), "7.8125");
    }
}
