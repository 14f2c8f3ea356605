//! Families of devices: what their clock manager can do, and how their tools are told about pins. All of it is data.

use super::clock::{ClockManager, Feedback};
use super::keys;
use super::making::{left_out_or_good, read_build, read_vendor, Build, Vendor};
use super::ports::Kind;
use crate::form::document::parse;
use crate::form::key::Key;
use crate::form::reader::{Source, Table};
use crate::template;
use endat_console::error::{CommandError, Diagnostic};
use endat_hdl::config::Limits;
use minijinja::Value;
use std::collections::BTreeMap;
use std::path::Path;
use toml::de::DeTable;

/// The file with the numbers and words.
pub const FILE: &str = "family.toml";
/// Verilog of the clock manager: makes `clk` and `pll_locked` of the port `osc_i`.
pub const CLOCK: &str = "clock.v.jinja";
/// The same in VHDL, rendered once for each `part`: `declarations` and `statements`. A family without it has a top in Verilog only.
pub const CLOCK_VHDL: &str = "clock.vhd.jinja";
/// The constraints file.
pub const CONSTRAINTS: &str = "constraints.jinja";
/// How open tools make a bitstream by hand, for the README of an emission.
pub const README: &str = "readme.md.jinja";
/// The target of FuseSoC that makes a bitstream.
pub const FUSESOC: &str = "fusesoc.jinja";
/// A second constraints file, for tools that take pins and timing apart.
pub const TIMING: &str = "timing.jinja";
/// The script with which the vendor's tool makes a bitstream.
pub const VENDOR: &str = "build.tcl.jinja";
/// Largest factor of a clock manager.
const FACTOR_MAX: u64 = 1_024;
/// Fastest that a clock manager is.
const HZ_MAX: u64 = 20_000_000_000;
/// What every family has.
const TEMPLATES: [&str; 2] = [CLOCK, CONSTRAINTS];

/// What FuseSoC is told about a board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fusesoc {
    /// What it calls the constraints file.
    pub file_type: String,
    /// Name of the target.
    pub target: String,
}

/// A family of devices.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Family {
    /// Name, or folder of one that does not come with the program.
    pub name: String,
    /// Name for people.
    pub title: String,
    /// End of the name of the constraints file.
    pub constraints: String,
    /// What is in that file.
    pub constraints_have: String,
    /// Before the number of a pin, in packages whose pins are numbered.
    pub pin_prefix: String,
    /// Verilog before a port whose last register belongs into the output cell.
    pub output_cell: String,
    /// Verilog before the registers of the reset.
    pub reset_registers: String,
    /// The clock manager.
    pub clock_manager: ClockManager,
    /// Words of the constraints file, by the name of the kind of signal.
    attributes: BTreeMap<&'static str, String>,
    /// The supply that each I/O standard needs, in mV.
    pub supplies: BTreeMap<String, u64>,
    /// What a board has to say about its device, with an example of each.
    pub device: BTreeMap<String, String>,
    /// FuseSoC, if it knows the family's tools.
    pub fusesoc: Option<Fusesoc>,
    /// Open tools, if there are any for it.
    pub build: Option<Build>,
    /// The vendor's, if there is a script for it.
    pub vendor: Option<Vendor>,
    /// End of the name of the second constraints file, if it has one.
    pub timing: Option<String>,
    /// Templates by the name of their file.
    templates: BTreeMap<&'static str, String>,
}

impl Family {
    /// The family that a board's file names; `folder` is that of the board's file. `Err` has the message, or what is wrong with its file.
    pub fn named(name: &str, folder: &Path) -> Result<Self, Vec<Diagnostic>> {
        let plain = |text: String| Diagnostic {
            file: String::new(),
            line: 0,
            text,
        };
        if let Some(files) = endat_constraints::family(name) {
            let text = |part: &str| {
                let found = files.iter().find(|(file, _)| *file == part);
                found.map(|(_, text)| (*text).to_owned())
            };
            return read(name, &format!("constraints/families/{name}"), &|part| {
                text(part).ok_or_else(|| "is missing".to_owned())
            });
        }
        if !name.contains(['/', '\\', '.']) {
            let text = format!(
                "unknown family; known families: {}; a folder of your own is written with a /",
                endat_constraints::families().join(", ")
            );
            return Err(vec![plain(text)]);
        }
        let folder = folder.join(name);
        let text = |part: &str| {
            let bytes = endat_console::artifact::read_regular(&folder.join(part), 1 << 20);
            let bytes = bytes.map_err(|e| format!("cannot read: {e}"))?;
            String::from_utf8(bytes).map_err(|_| "is not UTF-8 text; save it as UTF-8".to_owned())
        };
        read(name, &folder.display().to_string(), &text)
    }

    /// Whether it is a folder of somebody's own.
    pub fn is_own(&self) -> bool {
        endat_constraints::family(&self.name).is_none()
    }

    /// Words of the constraints file for a kind of signal.
    pub fn attributes(&self, kind: Kind) -> &str {
        self.attributes.get(kind.name()).map_or("", String::as_str)
    }

    /// Whether it has a template.
    pub fn has(&self, file: &str) -> bool {
        self.templates.contains_key(file)
    }

    /// One of its templates, filled in.
    pub fn render(&self, file: &str, facts: &Value) -> Result<String, CommandError> {
        let text = self.templates.get(file).map_or("", String::as_str);
        self.fill(&format!("{}/{file}", self.name), text, facts)
    }

    /// The same, or nothing where it has none of this name.
    pub fn render_any(&self, file: &str, facts: &Value) -> Result<Option<String>, CommandError> {
        let has = self.has(file);
        has.then(|| self.render(file, facts)).transpose()
    }

    /// A text of its own, filled in; `place` is where it stands.
    pub fn fill(&self, place: &str, text: &str, facts: &Value) -> Result<String, CommandError> {
        match self.is_own() {
            false => template::render(place, text, facts),
            true => template::render_own(place, text, facts),
        }
    }
}

/// Reads a family's files; `folder` names it in messages.
fn read(
    name: &str,
    folder: &str,
    text_of: &dyn Fn(&str) -> Result<String, String>,
) -> Result<Family, Vec<Diagnostic>> {
    let parts = [FILE].into_iter().chain(TEMPLATES);
    let missing = |part: &'static str, why: String| Diagnostic {
        file: format!("{folder}/{part}"),
        line: 0,
        text: format!("{why}; a family has {FILE}, {}", TEMPLATES.join(", ")),
    };
    let mut wrong = Vec::new();
    let mut templates = BTreeMap::new();
    for part in parts {
        match text_of(part) {
            Ok(text) => drop(templates.insert(part, text)),
            Err(why) => wrong.push(missing(part, why)),
        }
    }
    if !wrong.is_empty() {
        return Err(wrong);
    }
    let (file, text) = (
        format!("{folder}/{FILE}"),
        templates.remove(FILE).unwrap_or_default(),
    );
    let source = Source::new(&file, &text);
    let family = read_file(&source, name, templates);
    let Some(mut family) = family.filter(|_| source.is_good()) else {
        return Err(source.into_diagnostics());
    };
    for part in [CLOCK_VHDL, README] {
        if let Ok(text) = text_of(part) {
            family.templates.insert(part, text);
        }
    }
    let asked = [
        (family.fusesoc.is_some(), FUSESOC),
        (family.timing.is_some(), TIMING),
        (family.vendor.is_some(), VENDOR),
    ];
    for (_, part) in asked.into_iter().filter(|(is_asked, _)| *is_asked) {
        let text = text_of(part).map_err(|why| vec![missing(part, why)])?;
        family.templates.insert(part, text);
    }
    Ok(family)
}

fn read_file(
    source: &Source<'_>,
    name: &str,
    templates: BTreeMap<&'static str, String>,
) -> Option<Family> {
    let document = parse(source, &[])?;
    let empty = DeTable::new();
    let root = Table::root(source, &document);
    let word = |key| root.required_string(key).map(|at| at.value);
    let title = word(&keys::FAMILY_TITLE);
    let constraints = root.required_string(&keys::CONSTRAINTS);
    let constraints_have = word(&keys::CONSTRAINTS_HAVE);
    let optional = |key| root.string(key).map(|at| at.value).unwrap_or_default();
    let pin_prefix = optional(&keys::PIN_PREFIX);
    let output_cell = optional(&keys::OUTPUT_CELL);
    let reset_registers = optional(&keys::RESET_REGISTERS);
    let clock_manager = read_clock_manager(&root.table("clock_manager", &empty));
    let table = root.table("attributes", &empty);
    let mut attributes = BTreeMap::new();
    for (_, kind) in Kind::NAMES {
        if let Some(words) = table.text_of(kind, "\"\"") {
            attributes.insert(kind, words.value);
        }
    }
    table.finish();
    let limits = Limits::new(keys::SUPPLY_MV);
    let supplies = root.table("supplies", &empty).free_numbers(&limits);
    let supplies = supplies
        .into_iter()
        .map(|(standard, at)| (standard, at.value))
        .collect();
    let device = root.table("device", &empty).free_strings();
    let device = device
        .into_iter()
        .map(|(key, at)| (key, at.value))
        .collect();
    let table = root.table("fusesoc", &empty);
    let fusesoc = root.has("fusesoc").then(|| {
        let word = |key| table.required_string(key).map(|at| at.value);
        let (file_type, target) = (word(&keys::FILE_TYPE), word(&keys::TARGET));
        table.finish();
        Some(Fusesoc {
            file_type: file_type?,
            target: target?,
        })
    });
    let table = root.table("build", &empty);
    let build = root.has("build").then(|| read_build(&table));
    let table = root.table("vendor", &empty);
    let vendor = root.has("vendor").then(|| read_vendor(&table));
    let timing = root.string(&keys::TIMING);
    root.finish();
    let constraints = constraints?;
    let plain = |c: char| c.is_ascii_alphanumeric();
    for (key, end) in [
        (keys::CONSTRAINTS.name, Some(&constraints)),
        (keys::TIMING.name, timing.as_ref()),
    ] {
        let Some(end) = end else { continue };
        if end.value.is_empty() || !end.value.chars().all(plain) {
            let text = "is no end of a file's name; use letters and digits";
            root.complain(end.line, key, &format!("{:?}", end.value), text);
        }
    }
    Some(Family {
        name: name.into(),
        title: title?,
        constraints: constraints.value,
        constraints_have: constraints_have?,
        pin_prefix,
        output_cell,
        reset_registers,
        clock_manager: clock_manager?,
        attributes,
        supplies,
        device,
        fusesoc: left_out_or_good(fusesoc)?,
        build: left_out_or_good(build)?,
        vendor: left_out_or_good(vendor)?,
        timing: timing.map(|end| end.value),
        templates,
    })
}

fn read_clock_manager(table: &Table<'_, '_>) -> Option<ClockManager> {
    let feedback = table.required_string(&keys::FEEDBACK);
    let range = |key: &'static Key, most: u64| {
        let limits = format!("outside 1..{most}; choose a value in that range");
        let found = table.integers(key, &limits);
        table.require(key)?;
        let found = found?;
        let example = key.example();
        match found[..] {
            [ref low, ref high] if high.value <= most && (1..=high.value).contains(&low.value) => {
                Some(low.value..=high.value)
            }
            _ => {
                let line = found.first().map_or(table.line, |at| at.line);
                let shown: Vec<String> = found.iter().map(|at| at.value.to_string()).collect();
                let text = format!("is no range; write the least, from 1 on, and the greatest, up to {most}, as {example}");
                table.complain(line, key.name, &format!("[{}]", shown.join(", ")), &text);
                None
            }
        }
    };
    let divide = range(&keys::DIVIDE, FACTOR_MAX);
    let multiply = range(&keys::MULTIPLY, FACTOR_MAX);
    let divides = keys::OUTPUT_DIVIDES.name;
    let output_divides = match table.has(divides) {
        true => {
            let limits = format!("outside 1..{FACTOR_MAX}; choose a value in that range");
            let found = table.integers(&keys::OUTPUT_DIVIDES, &limits);
            table.know(&[&keys::OUTPUT_DIVIDE]);
            table.refuse(
                &keys::OUTPUT_DIVIDE,
                "output_divides has them one by one; remove one of the two",
            );
            for at in found.iter().flatten() {
                if !(1..=FACTOR_MAX).contains(&at.value) {
                    table.complain(at.line, divides, &at.value.to_string(), &limits);
                }
            }
            found.map(|all| all.into_iter().map(|at| at.value).collect())
        }
        false => range(&keys::OUTPUT_DIVIDE, FACTOR_MAX).map(Vec::from_iter),
    };
    let detector_hz = range(&keys::DETECTOR_HZ, HZ_MAX);
    let vco_hz = range(&keys::VCO_HZ, HZ_MAX);
    let output_hz = range(&keys::OUTPUT_HZ, HZ_MAX);
    table.finish();
    let feedback = feedback?;
    let feedback = match feedback.value.as_str() {
        "loop" => Feedback::Loop,
        "output" => Feedback::Output,
        other => {
            let text = "unknown; use loop, if the oscillator of the loop is multiplied, or output";
            table.complain(feedback.line, "feedback", &format!("{other:?}"), text);
            return None;
        }
    };
    Some(ClockManager {
        feedback,
        divide: divide?,
        multiply: multiply?,
        output_divides: output_divides?,
        detector_hz: detector_hz?,
        vco_hz: vco_hz?,
        output_hz: output_hz?,
    })
}
