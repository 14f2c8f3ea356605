//! The register map in every format: each file, read by a reader that is not ours, tells what the table tells.
//!
//! What is expected is taken from the table here once more, not from the walk that the writers share.

mod constants;
mod peakrdl;

use crate::program::good;
use crate::tools::{self, require_python};
use endat_config::{load_preset, parse, preset, Project};
use endat_hdl::config::CardConfig;
use endat_hdl::config::{LineParts, OutputParts, PhaseSource, SafetyParts};
use endat_hdl::regs::{start, words};
use endat_regs::{Block, Field, Named, Protocol, Register, Values, BLOCKS};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Both presets, a card whose channels are not alike (its start values differ), one of a single channel, and one of both protocols.
fn projects() -> Vec<Project> {
    let mut projects = ["s6_two_channel", "s6_two_channel_service"]
        .map(|name| load_preset(name).unwrap())
        .to_vec();
    projects[1].card.line = LineParts {
        alignment: true,
        margin: true,
        double_edge: true,
        phase: PhaseSource::Fixed,
        fixed_delay_ns: 400,
        drift_limit_ns: 25,
        samples: 3,
    };
    projects[1].card.outputs = OutputParts {
        position: true,
        interrupt: true,
    };
    projects[1].card.safety = SafetyParts {
        recovery_counter: true,
        second_interface: true,
        second_receiver: true,
        error_test_ms: 500,
        upset_guards: true,
        restore: false,
    };
    let text = preset("s6_two_channel").unwrap();
    // A good name, and a keyword of SystemRDL.
    let text = text.replace("name = \"s6_two_channel\"", "name = \"field\"");
    let (head, tail) = text.rsplit_once("position_bits = 29").unwrap();
    projects.push(parse("unlike.toml", &format!("{head}position_bits = 25{tail}")).unwrap());
    let bits = |p: &Project| p.card.channels[1].position_bits;
    assert_ne!(bits(&projects[0]), bits(&projects[2]));
    let mut single = projects[1].clone();
    single.name = "single".into();
    single.card.channels.truncate(1);
    projects.push(single);
    let mut mixed = projects[1].clone();
    mixed.name = "mixed".into();
    mixed.card.channels[1] = load_preset("mixed_protocols").unwrap().card.channels[1].clone();
    projects.push(mixed);
    projects
}

fn text_of(project: &Project, end: &str) -> String {
    let name = format!("{}{end}", project.name);
    let files = endat_emit::maps::artifacts(project).unwrap();
    let file = files.into_iter().find(|a| a.path == name);
    file.unwrap_or_else(|| panic!("no {name}")).text
}

/// One word of a card.
struct Word {
    block: &'static Block,
    register: &'static Register,
    /// `None` for a word of the card.
    channel: Option<usize>,
}

impl Word {
    fn all(config: &CardConfig) -> Vec<Self> {
        let of = |word: endat_hdl::regs::Word| Self {
            block: word.block,
            register: word.register,
            channel: word.block.per_channel.then_some(word.channel),
        };
        words(config).into_iter().map(of).collect()
    }

    fn address(&self) -> u32 {
        let address = self.block.address(self.register, self.channel.unwrap_or(0));
        address.into()
    }

    fn block_name(&self) -> &'static str {
        self.block.name
    }

    fn name(&self) -> String {
        let block = self.block_name();
        match self.channel {
            Some(n) => format!("{block}[{n}].{}", self.register.name),
            None => format!("{block}.{}", self.register.name),
        }
    }

    /// The one value that a field has after reset, in all channels.
    fn reset(&self, field: &Field, config: &CardConfig) -> Option<u64> {
        let channels = match self.channel {
            Some(_) => 0..config.channels.len(),
            None => 0..1,
        };
        let word = |n| start(self.block, self.register, config, n);
        let values: BTreeSet<u64> = channels.map(|n| field.of(word(n)).into()).collect();
        let is_known = self.block.name != "service" && values.len() == 1;
        values.into_iter().next().filter(|_| is_known)
    }
}

fn codes(field: &Field) -> &'static [Named] {
    match field.values {
        Values::Codes(codes) => codes,
        _ => &[],
    }
}

/// What the table says, one fact a line.
fn expected(config: &CardConfig) -> BTreeSet<String> {
    let mut facts = BTreeSet::new();
    for word in Word::all(config) {
        let (name, access) = (word.name(), word.register.access.short());
        facts.insert(format!("{name} 0x{:04X} {access}", word.address() * 4));
        for f in word.register.fields {
            let reset = word.reset(f, config);
            let reset = reset.map_or("-".into(), |r| r.to_string());
            let msb = f.lsb + f.width - 1;
            let field = format!("{name}.{}", f.name);
            facts.insert(format!("{field} {msb}:{} {access} reset {reset}", f.lsb));
            for c in codes(f) {
                facts.insert(format!("{field} = {} {}: {}", c.number, c.name, c.meaning));
            }
        }
    }
    facts
}

fn same(found: &BTreeSet<String>, project: &Project, file: &str) {
    let wanted = expected(&project.card);
    let missing: Vec<&String> = wanted.difference(found).take(10).collect();
    let too_much: Vec<&String> = found.difference(&wanted).take(10).collect();
    let name = &project.name;
    assert!(
        *found == wanted,
        "{file} of {name}: missing {missing:#?}, too much {too_much:#?}"
    );
}

/// What the SVD says, read by svd-parser.
fn read_svd(text: &str) -> BTreeSet<String> {
    use svd_parser::svd::{Access as SvdAccess, Cluster, RegisterCluster};
    let config = svd_parser::Config::default().validate_level(svd_parser::ValidateLevel::Strict);
    let device = svd_parser::parse_with_config(text, &config).unwrap();
    let short = |access: SvdAccess| match access {
        SvdAccess::ReadOnly => "ro",
        SvdAccess::ReadWrite => "rw",
        SvdAccess::WriteOnly => "strobe",
        other => panic!("{other:?}"),
    };
    assert_eq!((device.address_unit_bits, device.width), (8, 32));
    let [peripheral] = &device.peripherals[..] else {
        panic!("one peripheral");
    };
    let size = peripheral.address_block.as_ref().unwrap()[0].size;
    let mut facts = BTreeSet::new();
    for child in peripheral.registers.as_ref().unwrap() {
        let RegisterCluster::Cluster(cluster) = child else {
            panic!("a register outside of a cluster");
        };
        let places: Vec<(String, u32)> = match cluster {
            Cluster::Single(c) => vec![(c.name.clone(), 0)],
            Cluster::Array(c, dim) => (0..dim.dim)
                .map(|n| (c.name.replace("%s", &n.to_string()), n * dim.dim_increment))
                .collect(),
        };
        for (block, distance) in places {
            for register in cluster.registers() {
                let name = format!("{block}.{}", register.name);
                let address = peripheral.base_address as u32
                    + cluster.address_offset
                    + distance
                    + register.address_offset;
                assert!(address + 4 <= size, "{name}: outside of the address block");
                let properties = &register.properties;
                let access = properties.access.unwrap();
                facts.insert(format!("{name} 0x{address:04X} {}", short(access)));
                let (value, mask) = (
                    properties.reset_value.unwrap(),
                    properties.reset_mask.unwrap(),
                );
                for field in register.fields() {
                    let part = |word: u64| (word & field.bitmask()) >> field.lsb();
                    let reset = match mask & field.bitmask() == field.bitmask() {
                        true => part(value).to_string(),
                        false => "-".into(),
                    };
                    facts.insert(format!(
                        "{name}.{} {}:{} {} reset {reset}",
                        field.name,
                        field.msb(),
                        field.lsb(),
                        short(field.access.unwrap_or(access))
                    ));
                    for v in field.enumerated_values.iter().flat_map(|list| &list.values) {
                        facts.insert(format!(
                            "{name}.{} = {} {}: {}",
                            field.name,
                            v.value.unwrap(),
                            v.name,
                            v.description.as_deref().unwrap_or("")
                        ));
                    }
                }
            }
        }
    }
    facts
}

/// Catches word numbers written as byte addresses, a stride in words, a field with its end for its width, and a start value
/// of channel 0 that is told of all channels.
#[test]
fn the_svd_says_what_the_table_says() {
    let mut interrupts = 0;
    for project in projects() {
        let text = text_of(&project, ".svd");
        same(&read_svd(&text), &project, "SVD");
        let has_interrupt = text.contains("<interrupt>");
        assert_eq!(has_interrupt, project.card.outputs.interrupt);
        interrupts += usize::from(has_interrupt);
    }
    assert!(interrupts > 0, "no card here has one");
}

/// Facts that a Python reader prints.
fn read_in_python(project: &Project, end: &str) -> BTreeSet<String> {
    let folder = tools::folder(&format!("maps-{}{end}", project.name));
    let file = format!("{}{end}", project.name);
    fs::write(folder.join(&file), text_of(project, end)).unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/read_registers.py");
    let script = script.display().to_string();
    let (is_good, text) = tools::run("python3", &folder, &[&script, &file]);
    assert!(is_good, "{file}: {text}");
    text.lines().map(str::to_owned).collect()
}

/// Catches an SVD that only Rust's reader understands: its encoder and its parser share their types.
#[test]
fn cmsis_svd_reads_the_same() {
    if require_python("cmsis_svd", "SVD in cmsis-svd") {
        for project in projects() {
            same(&read_in_python(&project, ".svd"), &project, "SVD in Python");
        }
    }
}

/// Catches a keyword as a name (`all`, `field`), an array without its stride, and an access that stands at the wrong place.
#[test]
fn systemrdl_compiler_reads_what_the_table_says() {
    if require_python("systemrdl", "RDL in systemrdl-compiler") {
        for project in projects() {
            same(&read_in_python(&project, ".rdl"), &project, "RDL");
        }
    }
}

/// Catches a file that does not say which unit its addresses have, and one that is other the next time.
#[test]
fn each_file_tells_its_unit_and_is_the_same_again() {
    let project = &projects()[1];
    for (end, unit) in [
        ("_registers.md", "Word addresses; words are 32 bits wide."),
        (
            "_registers.h",
            "it counts words of 32 bits.\n * ..._BYTE is the same place on a bus that counts bytes",
        ),
        (
            ".svd",
            "Addresses here count bytes. The host link (UART) counts words",
        ),
        (
            ".rdl",
            "// Addresses here count bytes. The host link (UART) counts words",
        ),
    ] {
        let text = text_of(project, end);
        assert!(text.contains(unit), "{end}");
        assert!(text == text_of(project, end), "{end}");
    }
}

/// Catches words of parts that the card does not have, and a field that the page forgets.
#[test]
fn maps_list_every_word_and_field_that_the_card_has() {
    let mut project = projects().remove(0);
    let maps = |project: &Project| endat_emit::maps::artifacts(project).unwrap();
    let has = |project: &Project, name: &str| -> Vec<bool> {
        let maps = maps(project);
        // LiteX's form has words only.
        maps.iter()
            .filter(|a| !a.path.ends_with("_csr.csv"))
            .map(|a| a.text.to_lowercase().contains(name))
            .collect()
    };
    assert_eq!(has(&project, "frames_good"), [false; 6]);
    project.card.service.requests = true;
    for (part, name) in [
        (0, "serial_0"),
        (1, "watchdog_us"),
        (1, "frames_stuck_high"),
        (2, "stop_at_error"),
    ] {
        let mut with = project.clone();
        let parts = &mut with.card.service;
        *[
            &mut parts.initialise,
            &mut parts.diagnosis,
            &mut parts.continuous,
        ][part] = true;
        assert_eq!(has(&project, name), [false; 6], "nobody fills {name}");
        assert_eq!(has(&with, name), [true; 6], "{name}");
    }
    let unlike = &projects()[2];
    let page = text_of(unlike, "_registers.md");
    assert!(page.contains("| 21:16 | `position_bits` | bits | 29, 25 |"));
    let page = text_of(&projects()[4], "_registers.md");
    assert!(page.contains("| 1 | `reset` | reset |") && page.contains("0x456E4474"));
    assert!(page.contains("| 2 | `no_start_bit` | no start bit |"));
    for register in BLOCKS.iter().flat_map(|b| b.registers) {
        assert!(page.contains(&format!("`{}`", register.name)));
        for field in register.fields {
            assert!(page.contains(&format!("`{}`", field.name)));
        }
    }
}

/// Catches a protocol whose causes stand in no table, and a list that is announced and has nothing in it.
#[test]
fn the_page_has_the_causes_of_each_protocol_and_no_empty_list() {
    for name in ["s6_two_channel", "mixed_protocols", "ssi_two_channel"] {
        let project = load_preset(name).unwrap();
        let page = text_of(&project, "_registers.md");
        let header = text_of(&project, "_registers.h");
        let lines: Vec<&str> = header.lines().collect();
        for protocol in Protocol::ALL.iter().filter(|p| project.card.speaks(**p)) {
            for cause in protocol.row().coded {
                let row = format!("| {} | `{}` | ", cause.number, cause.name);
                assert!(page.contains(&row), "{name}: {row}");
            }
            let channel = format!("on {}", protocol.row().channel);
            assert!(!page.contains(&format!("{channel}  |")), "{name}");
            for pair in lines.windows(2) {
                let is_empty = pair[0].contains(&channel) && !pair[1].starts_with("#define");
                assert!(!is_empty, "{name}: {pair:?}");
            }
        }
    }
    let told = good(&["explain", "status.line"]);
    assert!(told.contains("on a T-format channel:"), "{told}");
    assert!(told.contains("on an SSI channel:"), "{told}");
}
