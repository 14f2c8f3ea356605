//! What integrators expect beside the sources: FuseSoC core, timing constraints, Vivado packaging, LiteX module,
//! Amaranth component, black box of SpinalHDL, component of Platform Designer, block design for Zynq, instantiation template, C example.

mod interface;

use crate::constraints::top_language;
use crate::language::Language;
use crate::making;
use crate::testbench::RESET_CYCLES;
use crate::zynq;
use endat_config::board::{Board, FUSESOC};
use endat_config::protocols::spoken;
use endat_config::template::render;
use endat_config::{Project, Receiver};
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use endat_draw::{decimal, mhz};
use endat_hdl::card::bus::HostBus;
use endat_hdl::protocols::t_format::protocol::SYSTEM_HZ;
use endat_regs::Protocol;
use minijinja::context;
use minijinja::value::{Serde, Value};
use rtl_design::elaborate::{Design, Direction};
use serde::Serialize;

/// End of the file's name, and its template.
const TEMPLATES: [(&str, &str); 9] = [
    (
        "_ipxact.xml",
        include_str!("templates/integration/ipxact.xml.jinja"),
    ),
    (".sdc", include_str!("templates/integration/sdc.jinja")),
    (".core", include_str!("templates/integration/core.jinja")),
    (
        "_ip.xdc",
        include_str!("templates/integration/ip.xdc.jinja"),
    ),
    (
        "_vivado.tcl",
        include_str!("templates/integration/vivado.tcl.jinja"),
    ),
    (
        "_instance.vh",
        include_str!("templates/integration/instance.vh.jinja"),
    ),
    (
        "_litex.py",
        include_str!("templates/integration/litex.py.jinja"),
    ),
    (
        "_amaranth.py",
        include_str!("templates/integration/amaranth.py.jinja"),
    ),
    (
        "_spinal.scala",
        include_str!("templates/integration/spinal.scala.jinja"),
    ),
];
/// For the buses that Platform Designer connects.
const PLATFORM_DESIGNER: (&str, &str) = (
    "_hw.tcl",
    include_str!("templates/integration/hw.tcl.jinja"),
);
/// A module around the core with the inputs that Platform Designer wants besides.
const WRAPPER: &str = "_axi4lite";
const WRAPPER_VERILOG: &str = include_str!("templates/integration/axi4lite.v.jinja");
const WRAPPER_VHDL: &str = include_str!("templates/integration/axi4lite.vhd.jinja");
/// The example reads the card over the UART.
const EXAMPLE: (&str, &str) = (
    "_example.c",
    include_str!("templates/integration/example.c.jinja"),
);

/// Vendor and library of the names by which FuseSoC and Vivado know a core.
const VENDOR: &str = "endat-gen";
const LIBRARY: &str = "motion";

#[derive(Serialize)]
struct Port {
    name: String,
    direction: &'static str,
    width: usize,
    meaning: String,
}

/// What FuseSoC calls files in a language.
fn file_type(language: Language) -> &'static str {
    match language {
        Language::Verilog => "verilogSource-2005",
        Language::Vhdl => "vhdlSource-2008",
    }
}

/// Words that Python keeps for itself and that begin like a class.
const PYTHON_WORDS: [&str; 3] = ["False", "None", "True"];

/// `s6_two_channel` as the name of a class.
fn class_name(name: &str) -> String {
    let part = |part: &str| {
        let mut letters = part.chars();
        let first = letters.next().map(|c| c.to_ascii_uppercase());
        first.into_iter().chain(letters).collect::<String>()
    };
    let class: String = name.split('_').map(part).collect();
    match PYTHON_WORDS.contains(&class.as_str()) {
        true => class + "Core",
        false => class,
    }
}

/// Classes of Scala and SpinalHDL that the emitted class is made of.
const SCALA_CLASSES: [&str; 6] = ["Bits", "BlackBox", "Bool", "Bundle", "Seq", "String"];

/// The class in Scala.
fn scala_class_name(name: &str) -> String {
    let class = class_name(name);
    match SCALA_CLASSES.contains(&class.as_str()) {
        true => class + "Core",
        false => class,
    }
}

/// What FuseSoC is told about a board.
#[derive(Serialize)]
struct Target<'a> {
    title: &'a str,
    constraints: &'a str,
    file_type: &'a str,
    /// The board top, and its type.
    top: String,
    top_type: &'static str,
    /// Name of the target, padded.
    target: String,
    /// The target itself.
    text: String,
}

impl<'a> Target<'a> {
    /// None when FuseSoC does not know the tools of the board's family.
    fn of(board: &'a Board, name: &str, language: Language) -> Result<Option<Self>, CommandError> {
        let Some(fusesoc) = &board.family.fusesoc else {
            return Ok(None);
        };
        let words: Vec<String> = board.part.split('-').map(str::to_owned).collect();
        let text = board
            .family
            .render(FUSESOC, &context! { name, part => words })?;
        let language = top_language(board, language);
        Ok(Some(Self {
            top: format!("{name}_top{}", language.extension()),
            top_type: file_type(language),
            title: &board.title,
            constraints: &board.family.constraints,
            file_type: &fusesoc.file_type,
            target: format!("{:<12}", fusesoc.target),
            text,
        }))
    }
}

/// What the files say of a core besides its design.
pub struct Core<'a> {
    /// Name of the files and the top module.
    pub name: &'a str,
    /// First 12 hexadecimal digits of the SHA-256 of the resolved configuration.
    pub hash: &'a str,
    /// What it is.
    pub title: String,
    /// The same, and how many channels it has.
    pub description: String,
    /// Whose interface it is compatible with.
    pub standard: String,
    /// What a design calls it.
    pub submodule: &'static str,
    /// System clocks that it takes, in hertz.
    pub system_hz: Vec<u64>,
    /// How often a line without a clock is sampled.
    pub input_hz: u64,
    /// Its Verilog files, the top module's among them.
    pub sources: &'a [String],
    /// There is a test bench with encoders.
    pub has_bench: bool,
    /// What stands between its registers and the host.
    bus: HostBus,
    /// Registers have start values.
    initial_values: bool,
    /// It asks for a processor's attention.
    has_interrupt: bool,
    /// Where a system has its registers; 0 if nobody has said so.
    base_address: u32,
    /// The language of its files.
    pub language: Language,
    /// What the templates of a card's own files need besides.
    card: Value,
}

impl<'a> Core<'a> {
    /// A card.
    pub fn card(
        project: &'a Project,
        sources: &'a [String],
        has_bench: bool,
        language: Language,
    ) -> Result<Self, CommandError> {
        let target = match &project.board {
            Some(board) => Target::of(board, &project.name, language)?,
            None => None,
        };
        let channels = project.card.channels.len();
        let title = format!("{} acquisition card", project.protocols());
        let standards: Vec<&str> = spoken(&project.card).map(|p| p.row().means).collect();
        Ok(Self {
            name: &project.name,
            hash: &project.hash,
            description: format!(
                "{title}, {channels} channel{}",
                if channels == 1 { "" } else { "s" }
            ),
            title,
            standard: standards.join(" and "),
            submodule: "endat",
            system_hz: vec![project.card.system_hz],
            input_hz: making::input_hz(project),
            sources,
            has_bench,
            bus: project.bus,
            initial_values: project.card.initial_values,
            has_interrupt: project.card.outputs.interrupt,
            base_address: project.base_address,
            language,
            card: context! {
                channels,
                board => Value::from(Serde(target)),
            },
        })
    }

    /// A T-format receiver.
    pub fn receiver(receiver: &'a Receiver, sources: &'a [String], language: Language) -> Self {
        let title = "T-format receiver with a bus for a signal processor";
        Self {
            name: &receiver.name,
            hash: &receiver.hash,
            title: title.into(),
            description: title.into(),
            standard: Protocol::TFormat.row().means.into(),
            submodule: "receiver",
            system_hz: SYSTEM_HZ.to_vec(),
            input_hz: SYSTEM_HZ.into_iter().max().unwrap_or_default(),
            sources,
            has_bench: language == Language::Verilog,
            // Its bus is an asynchronous one.
            bus: HostBus::Parallel,
            initial_values: receiver.initial_values,
            has_interrupt: false,
            base_address: 0,
            language,
            card: context! { board => () },
        }
    }

    /// What the first lines of its files say.
    pub fn origin(&self) -> String {
        crate::sources::origin(self.hash)
    }

    /// Whether registers have start values.
    pub fn has_initial_values(&self) -> bool {
        self.initial_values
    }
}

/// The files of a core. `design` has the names of its text: [`crate::sources::named`].
pub fn artifacts(core: &Core<'_>, design: &Design) -> Result<Vec<Artifact>, CommandError> {
    let top = design.top();
    let ports: Vec<Port> = top
        .ports
        .iter()
        .map(|port| {
            let net = &top.nets[port.net];
            Port {
                name: net.name.clone(),
                direction: match port.direction {
                    Direction::Input => "in",
                    Direction::Output => "out",
                },
                width: net.width_bits,
                meaning: net.docs.join(" "),
            }
        })
        .collect();
    let clock = top.ports.iter().find(|p| p.is_clock);
    let clock = clock.map(|p| top.nets[p.net].name.clone());
    let reset = ports
        .iter()
        .find(|p| p.meaning.starts_with("Synchronous reset"));
    let is_asynchronous = |p: &&Port| p.direction == "in" && p.meaning.contains("asynchronous");
    let asynchronous = ports.iter().filter(is_asynchronous);
    let asynchronous: Vec<String> = asynchronous.map(|p| p.name.clone()).collect();
    let interrupt = ports
        .iter()
        .find(|p| core.has_interrupt && p.name == "irq_o");
    let fastest_hz = core.system_hz.iter().copied().max().unwrap_or_default();
    let bus = interface::of(core.bus, &ports);
    let is_in_platform_designer = bus
        .as_ref()
        .is_some_and(|b| !b.platform_designer.is_empty());
    let zynq = match zynq::base(core.bus, core.base_address) {
        Some(base) => {
            let is_wired = |name: &str| {
                clock.as_deref() == Some(name)
                    || reset.is_some_and(|port| port.name == name)
                    || interrupt.is_some_and(|port| port.name == name)
                    || bus.as_ref().is_some_and(|bus| bus.has(name))
            };
            let names = ports.iter().map(|port| port.name.as_str());
            Some(zynq::of(names.filter(|name| !is_wired(name)), base)?)
        }
        None => None,
    };
    let has_wrapper = bus.as_ref().is_some_and(|b| !b.unused.is_empty());
    let wrapper = format!("{}{WRAPPER}", core.name);
    let context = context! {
        unused => Value::from(Serde(bus.as_ref().map_or(&[][..], |b| &b.unused))),
        wrapper => wrapper.as_str(),
        zynq => Value::from(Serde(&zynq)),
        base_address => core.base_address,
        name => core.name,
        scala_class => scala_class_name(core.name),
        class => class_name(core.name),
        macro => core.name.to_ascii_uppercase(),
        origin => core.origin(),
        is_vhdl => core.language == Language::Vhdl,
        file_type => file_type(core.language),
        version => env!("CARGO_PKG_VERSION"),
        vendor => VENDOR,
        library => LIBRARY,
        vlnv => format!("{VENDOR}:{LIBRARY}:{}:{}", core.name, env!("CARGO_PKG_VERSION")),
        mhz => mhz(fastest_hz),
        period_ns => decimal(1e9 / fastest_hz as f64, 3),
        two_samples => core.input_hz > fastest_hz,
        input_ns => decimal(1e9 / core.input_hz as f64, 3),
        asynchronous,
        bus => Value::from(Serde(&bus)),
        interrupt => Value::from(Serde(interrupt)),
        hash => core.hash,
        title => core.title.as_str(),
        description => core.description.as_str(),
        standard => core.standard.as_str(),
        submodule => core.submodule,
        system_hz => core.system_hz.clone(),
        sources => Value::from(Serde(core.sources)),
        has_bench => core.has_bench,
        clock => clock.unwrap_or_default(),
        reset => reset.map(|p| p.name.clone()).unwrap_or_default(),
        ports => Value::from(Serde(&ports)),
        initial_values => core.initial_values,
        reset_cycles => RESET_CYCLES,
        ..core.card.clone()
    };
    let wanted = TEMPLATES
        .iter()
        .chain((core.bus == HostBus::Uart).then_some(&EXAMPLE))
        .chain(is_in_platform_designer.then_some(&PLATFORM_DESIGNER))
        .chain(zynq.is_some().then_some(&zynq::SCRIPT));
    let is_verilog_only = |end: &str| end == "_instance.vh";
    let wrapping = match core.language {
        Language::Verilog => WRAPPER_VERILOG,
        Language::Vhdl => WRAPPER_VHDL,
    };
    let wrapping = (format!("{WRAPPER}{}", core.language.extension()), wrapping);
    wanted
        .filter(|(end, _)| core.language == Language::Verilog || !is_verilog_only(end))
        .map(|(end, template)| ((*end).to_owned(), *template))
        .chain(has_wrapper.then_some(wrapping))
        .map(|(end, template)| {
            let text = render(&end, template, &context)?;
            Ok(Artifact::new(format!("{}{end}", core.name), text))
        })
        .collect()
}
