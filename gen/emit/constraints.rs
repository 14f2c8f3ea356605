//! Board-dependent files: the board top with the clock manager, the constraints, and the page about both.

use crate::language::Language;
use crate::making::{self, Maker};
use crate::testbench::RESET_CYCLES;
use crate::wiring;
use crate::zynq;
use endat_config::board::{
    Assignment, Board, Kind, Pll, CLOCK, CLOCK_VHDL, CONSTRAINTS, PARALLEL_ADDRESS_LINES,
    PARALLEL_DATA_LINES, README, TIMING, VENDOR,
};
use endat_config::explain;
use endat_config::template;
use endat_config::Project;
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use endat_constraints::templates;
use endat_draw::{decimal, mhz};
use endat_hdl::card::bus::HostBus;
use endat_hdl::endat::service::program::CLEAR_CYCLES;
use endat_hdl::endat::timing::ABORT_US;
use endat_regs::Protocol;
use minijinja::context;
use minijinja::value::{Serde, Value};
use serde::Serialize;

/// A port as the templates see it.
#[derive(Serialize)]
struct Port {
    signal: String,
    pin: String,
    position: String,
    meaning: String,
    direction: &'static str,
    /// The direction in VHDL.
    mode: &'static str,
    iostandard: String,
    /// The last register belongs into the output cell.
    output_cell: bool,
    /// Words of the constraints file beside place and I/O standard.
    attributes: String,
    /// Why the timing is not analysed; empty when it is.
    asynchronous: &'static str,
    /// The most from the pin to the first register of such an input, in ns.
    bound_ns: String,
}

/// The channels that speak another protocol than EnDat, for texts.
fn others(project: &Project) -> Vec<Value> {
    let there = Protocol::ALL.iter().filter(|p| **p != Protocol::Endat);
    let named = there.filter_map(|p| {
        let channels: Vec<usize> = project.card.speakers(*p).collect();
        (!channels.is_empty()).then(|| context! { name => p.name(), channels })
    });
    named.collect()
}

impl Port {
    fn new(pin: &Assignment, project: &Project, board: &Board) -> Self {
        Self {
            signal: pin.signal.clone(),
            pin: pin.pin.clone(),
            position: pin.position.clone(),
            meaning: pin.meaning(project.card.protocols()),
            direction: pin.kind.direction(),
            mode: match pin.kind.direction().split(' ').next() {
                Some("input") => "in",
                Some("output") => "out",
                _ => "inout",
            },
            iostandard: board.iostandard_of(&pin.pin).to_owned(),
            output_cell: pin.kind == Kind::Transceiver,
            attributes: board.family.attributes(pin.kind).to_owned(),
            asynchronous: pin.kind.asynchronous().unwrap_or(""),
            bound_ns: ns(match pin.kind {
                Kind::EncoderData => making::input_hz(project),
                _ => project.card.system_hz,
            }),
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

/// Lights whose pin is low while they shine.
fn inverted<'p>(project: &'p Project, board: &Board) -> Vec<&'p str> {
    let low = project.pins.iter().filter(|pin| board.inverts(pin));
    low.map(|pin| pin.signal.as_str()).collect()
}

/// What the top connects to a port of the card.
#[derive(Serialize)]
struct Connection {
    port: String,
    net: String,
}

/// All ports of the card but clock and reset. Lines of a bus are pins one by one, and one vector at the card.
fn connections(project: &Project, inverted: &[&str], is_vhdl: bool) -> Vec<Connection> {
    let own = project
        .pins
        .iter()
        .filter(|pin| !matches!(pin.kind, Kind::Oscillator | Kind::BusOutput | Kind::BusData))
        .filter(|pin| !pin.signal.starts_with("bus_address"))
        .map(|pin| match inverted.contains(&pin.signal.as_str()) {
            true => (pin.signal.clone(), format!("{}_high", pin.signal)),
            false => (pin.signal.clone(), pin.signal.clone()),
        });
    let lines = |name: &str, end: &str, count: usize| {
        let names = (0..count).rev().map(|n| format!("{name}{n}_{end}"));
        format!("{{{}}}", names.collect::<Vec<_>>().join(", "))
    };
    let shared = shared_outputs(project).flat_map(|name| {
        let of = |end: &str| format!("{name}{end}");
        [(of("_o"), of("")), (of("_oe"), of("_oe"))]
    });
    let mut bus = match project.bus {
        HostBus::Parallel if is_vhdl => vec![
            ("bus_address_i", "bus_address".to_owned()),
            ("bus_data_i", "bus_data_in".to_owned()),
            ("bus_data_o", "bus_data".to_owned()),
            ("bus_data_oe", "bus_data_oe".to_owned()),
        ],
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
        let net = if is_vhdl { "open" } else { UNUSED_INTERRUPT };
        bus.push(("irq_o", net.to_owned()));
    }
    let bus = bus.into_iter().map(|(port, net)| (port.to_owned(), net));
    own.chain(shared)
        .chain(bus)
        .map(|(port, net)| Connection { port, net })
        .collect()
}

/// Board top, constraints and README of a project; without a board only a README that says how to use the card.
pub fn artifacts(project: &Project, language: Language) -> Result<Vec<Artifact>, CommandError> {
    let is_vhdl = language == Language::Vhdl;
    match (&project.board, &project.pll) {
        (Some(board), Some(pll)) => of_board(project, board, pll, language),
        _ => without_board(project, is_vhdl),
    }
}

fn without_board(project: &Project, is_vhdl: bool) -> Result<Vec<Artifact>, CommandError> {
    let context = context! {
        is_vhdl,
        name => project.name.as_str(),
        version => env!("CARGO_PKG_VERSION"),
        hash => project.hash.as_str(),
        bus => project.bus.name(),
        zynq => zynq::base(project.bus, project.base_address).is_some(),
        internal => project.bus.is_internal(),
        bare => project.bus == HostBus::Bare,
        system_hz => project.card.system_hz,
        channels => project.card.channels.len(),
        second => project.card.safety.second_interface,
        protocols => project.protocols(),
        others => others(project),
        quiet_ms => ABORT_US / 1_000,
        initial_values => project.card.initial_values,
        reset_cycles => RESET_CYCLES,
        clear_cycles => project.card.service.requests.then_some(CLEAR_CYCLES),
        timing => explain::report(project).to_string(),
    };
    let text = templates::README_BUS;
    let text = template::render("readme_bus", text, &context)?;
    Ok(vec![Artifact::new(endat_console::artifact::README, text)])
}

/// The language of the board top where the core is in this one: the clock manager of a family of somebody's own may be in Verilog
/// alone. Tools that take both languages put the two together.
pub fn top_language(board: &Board, core: Language) -> Language {
    match board.family.has(CLOCK_VHDL) {
        true => core,
        false => Language::Verilog,
    }
}

/// A Verilog attribute, for VHDL.
#[derive(Serialize)]
struct Attribute<'a> {
    name: &'a str,
    value: &'a str,
}

/// The attributes of a family's words, as `(* IOB = "TRUE" *)`.
fn attributes(words: &str) -> Vec<Attribute<'_>> {
    let inside = words.trim().trim_start_matches("(*").trim_end_matches("*)");
    let pairs = inside.split(',').filter_map(|one| one.split_once('='));
    pairs
        .map(|(name, value)| {
            let name = name.trim();
            let value = value.trim().trim_matches('"');
            Attribute { name, value }
        })
        .collect()
}

/// What the templates know, a family's own among them; docs/boards.md lists it.
fn of_board(
    project: &Project,
    board: &Board,
    pll: &Pll,
    language: Language,
) -> Result<Vec<Artifact>, CommandError> {
    let name = &project.name;
    let family = &board.family;
    let top_language = top_language(board, language);
    let has_vhdl_top = top_language == Language::Vhdl;
    let top = format!("{name}_top{}", top_language.extension());
    let ports: Vec<Value> = (project.pins.iter())
        .map(|pin| Value::from(Serde(Port::new(pin, project, board))))
        .collect();
    let inverted = inverted(project, board);
    let facts = context! {
        is_vhdl => language == Language::Vhdl,
        top => top.as_str(),
        name => name.as_str(),
        version => env!("CARGO_PKG_VERSION"),
        hash => project.hash.as_str(),
        initial_values => project.card.initial_values,
        reset_cycles => RESET_CYCLES,
        board => context! { title => board.title.as_str(), name => board.name.as_str(), part => board.part.as_str() },
        device => Serde(&board.device),
        ports => ports,
        bus => project.bus.name(),
        address_lines => PARALLEL_ADDRESS_LINES,
        data_lines => PARALLEL_DATA_LINES,
        connections => Serde(connections(project, &inverted, has_vhdl_top)),
        shared => Serde(shared_outputs(project).collect::<Vec<_>>()),
        inverted => Serde(&inverted),
        unused_interrupt => has_unused_interrupt(project).then_some(UNUSED_INTERRUPT),
        oscillator_hz => board.oscillator_hz,
        oscillator_ns => ns(board.oscillator_hz),
        oscillator_mhz => mhz(board.oscillator_hz),
        system_hz => project.card.system_hz,
        system_ns => ns(project.card.system_hz),
        system_mhz => mhz(project.card.system_hz),
        pll => context! {
            divide => pll.divide,
            multiply => pll.multiply,
            output_divide => pll.output_divide,
            output_divide_log2 => pll.output_divide.ilog2(),
            detector_hz => pll.detector_hz,
            vco_hz => pll.vco_hz,
        },
        channels => project.card.channels.len(),
        protocols => project.protocols(),
        others => others(project),
        timing => explain::report(project).to_string(),
        constraints => family.constraints.as_str(),
        constraints_have => family.constraints_have.as_str(),
        output_cell => family.output_cell.as_str(),
        reset_registers => family.reset_registers.as_str(),
    };
    let of_family = |part: &str| family.render(part, &facts);
    let vhdl_clock = |part: &str| {
        let facts = context! { part, ..facts.clone() };
        family.render(CLOCK_VHDL, &facts)
    };
    let (clock_manager, clock_declarations) = match has_vhdl_top {
        true => (vhdl_clock("statements")?, vhdl_clock("declarations")?),
        false => (of_family(CLOCK)?, String::new()),
    };
    let build_name = format!("{name}_build.tcl");
    let vendor = match &family.vendor {
        Some(vendor) => Some(context! {
            tool => vendor.tool.as_str(),
            command => making::fill(project, board, &vendor.run)?.join(" "),
            bitstream => making::file_name(project, board, Maker::Vendor(vendor))?,
        }),
        None => None,
    };
    let facts = context! { vendor, ..facts.clone() };
    let script = match family.has(VENDOR) {
        true => {
            let report = template::render("report.tcl", templates::REPORT, &facts)?;
            let facts = context! { report, ..facts.clone() };
            Some(family.render(VENDOR, &facts)?)
        }
        false => None,
    };
    let timing = family.render_any(TIMING, &facts)?;
    let timing_name = family
        .timing
        .as_ref()
        .map(|end| format!("{name}_top.{end}"));
    let facts = context! {
        timing_name => timing_name.clone(),
        clock_manager,
        clock_declarations,
        output_attributes => Serde(attributes(&family.output_cell)),
        reset_attributes => Serde(attributes(&family.reset_registers)),
        bitstream => family.render_any(README, &facts)?.unwrap_or_default(),
        ..facts.clone()
    };
    let mut artifacts = vec![
        Artifact::new(
            top.as_str(),
            match has_vhdl_top {
                true => template::render("top.vhd", templates::TOP_VHDL, &facts)?,
                false => template::render("top.v", templates::TOP, &facts)?,
            },
        ),
        Artifact::new(
            format!("{name}.{}", family.constraints),
            of_family(CONSTRAINTS)?,
        ),
        Artifact::new(
            endat_console::artifact::README,
            template::render("readme", templates::README, &facts)?,
        ),
    ];
    let drawing = wiring::drawing(project, board);
    artifacts.push(Artifact::new(format!("{name}_wiring.svg"), drawing));
    artifacts.extend(script.map(|text| Artifact::new(build_name, text)));
    artifacts.extend(
        timing_name
            .zip(timing)
            .map(|(name, text)| Artifact::new(name, text)),
    );
    Ok(artifacts)
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
