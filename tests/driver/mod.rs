//! The C driver: its generated files, strict compilers, and its calls against the fronts of real cards.

mod in_rust;
mod page;
mod rig;
mod ssi;
mod t_format;
mod world;

use crate::program::{self, bad, begun, good, Dir};
use crate::tools;
use endat_config::{parse, Project};
use endat_hdl::card::bus::HostBus;
use endat_sim::encoder::Defect;
use rig::{Rig, ALL_PARTS};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Where the driver lies.
fn home() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("drivers/c")
}

/// Catches a register, cause or step that has changed while the driver has the old one.
#[test]
fn the_driver_has_the_map_and_the_texts_of_the_tables() {
    for file in endat_emit::maps::driver::artifacts() {
        let path = home().join(&file.path);
        tools::assert_committed(&path, &file.text);
    }
}

/// Catches an error that the page does not have, or has with another text than the driver; and one that Rust does not have.
#[test]
fn the_page_has_every_error_with_its_name_in_rust_and_its_text() {
    let read = |path: &Path| std::fs::read_to_string(path).unwrap();
    let (header, source) = (read(&home().join("endat.h")), read(&home().join("endat.c")));
    let rust = read(&home().join("../rust/error.rs"));
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/driver.md");
    let lines = header.lines().filter_map(|line| {
        let (name, _) = line.trim().split_once(',')?;
        name.strip_prefix("ENDAT_ERROR_")
    });
    let (_, texts) = source.split_once("texts[ENDAT_ERRORS] = {").unwrap();
    let (texts, _) = texts.split_once("};").unwrap();
    let texts = texts
        .lines()
        .filter_map(|line| line.trim().strip_prefix('"'));
    let texts = texts.map(|line| line.trim_end_matches("\",").replace("\\\"", "\""));
    // The first two are none.
    let all: Vec<(&str, String)> = lines.zip(texts.skip(2)).collect();
    assert_eq!(all.len(), 18);
    let mut table = String::from("| in C | in Rust | what it is: what helps |\n|---|---|---|\n");
    for (name, text) in all {
        let capital = |word: &str| word[..1].to_owned() + &word[1..].to_lowercase();
        let of_rust = match name {
            "CHECKSUM" => "CheckSum".to_owned(),
            name => name.split('_').map(capital).collect(),
        };
        let is_there = rust.contains(&format!("    {of_rust},\n"))
            || rust.contains(&format!("    {of_rust} {{\n"))
            || rust.contains(&format!("    {of_rust}("));
        assert!(is_there, "{of_rust}");
        table += &format!("| `ENDAT_ERROR_{name}` | `Error::{of_rust}` | {text} |\n");
    }
    let is = read(&page);
    let (before, rest) = is.split_once("\n## Errors\n\n").unwrap();
    let (_, behind) = rest.split_once("\nEach has this text").unwrap();
    let should = format!("{before}\n## Errors\n\n{table}\nEach has this text{behind}");
    tools::assert_committed(&page, &should);
}

/// Catches a call or parameter without a word in its documentation.
#[test]
fn doxygen_finds_every_call_documented() {
    if !tools::require("doxygen", "documentation of the C driver") {
        return;
    }
    let dir = tools::folder("driver-doxygen");
    for file in ["Doxyfile", "endat.h", "endat_transports.h"] {
        std::fs::copy(home().join(file), dir.join(file)).unwrap();
    }
    let (is_content, told) = tools::run("doxygen", &dir, &[]);
    assert!(is_content && !told.contains("warning"), "{told}");
    let page = std::fs::read_to_string(dir.join("html/endat_8h.html")).unwrap();
    for call in ["endat_open", "endat_request_begin", "ENDAT_ERROR_UNPLUGGED"] {
        assert!(page.contains(call), "{call}");
    }
}

/// What the driver has to be clean under.
const STRICT: [&str; 8] = [
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wconversion",
    "-Wshadow",
    "-Werror",
    "-O2",
];

/// The driver's files that are compiled.
fn sources() -> Vec<String> {
    let names = endat_emit::driver::FILES.iter().map(|file| file.0);
    let sources = names.filter(|name| name.ends_with(".c"));
    sources
        .map(|name| home().join(name).display().to_string())
        .collect()
}

/// The scenarios with the driver, compiled once; none without a compiler.
fn compiled() -> Option<&'static Path> {
    static PROGRAM: OnceLock<Option<PathBuf>> = OnceLock::new();
    let compile = || {
        if !tools::require("gcc", "C driver") {
            return None;
        }
        let folder = tools::folder("driver");
        std::fs::write(folder.join("page.c"), block("```c\n", 1)).unwrap();
        write_header(&folder);
        let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/driver");
        let include = format!("-I{}", home().display());
        let own = ["program.c", "alone.c", "t_format.c"]
            .map(|name| tests.join(name).display().to_string());
        let mut arguments: Vec<String> = ["-std=c99", "-Wall", "-Werror", "-O0", "-g", "-o", "run"]
            .map(str::to_owned)
            .to_vec();
        arguments
            .extend(["-fsanitize=address,undefined", "-fno-sanitize-recover"].map(str::to_owned));
        arguments.extend([include, "-I.".into(), "page.c".into()]);
        arguments.extend(own);
        arguments.extend(sources());
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let (is_good, text) = tools::run("gcc", &folder, &arguments);
        assert!(is_good, "{text}");
        Some(folder.join("run"))
    };
    PROGRAM.get_or_init(compile).as_deref()
}

/// A block of the first page.
fn block(fence: &str, number: usize) -> &'static str {
    block_of(include_str!("../../docs/first-driver.md"), fence, number)
}

/// A block of a page.
fn block_of(page: &'static str, fence: &str, number: usize) -> &'static str {
    let blocks = page.split(fence).skip(1);
    let text = |rest: &'static str| rest.split("```").next().unwrap().trim_start();
    blocks.map(text).nth(number).unwrap()
}

/// The card of the page, at a fifth of its clock, which takes a fifth of the time.
fn card_of_the_page() -> Project {
    let mut text = block("```toml", 0).to_owned();
    for (from, to) in [
        ("system_hz = 50_000_000", "system_hz = 10_000_000"),
        ("clock_hz = 5_000_000", "clock_hz = 1_000_000"),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    parse("my_card.toml", &text).unwrap()
}

fn write_header(folder: &Path) {
    let maps = endat_emit::maps::artifacts(&card_of_the_page()).unwrap();
    let header = maps
        .iter()
        .find(|file| file.path.ends_with("_registers.h"))
        .unwrap();
    std::fs::write(folder.join(&header.path), &header.text).unwrap();
}

#[test]
fn the_program_of_the_page_goes_from_power_up_over_a_plug_to_a_position() {
    Rig::of(card_of_the_page()).run("page");
}

/// Catches an example that names what the driver no longer has.
#[test]
fn examples_and_the_page_compile() {
    if let Some(folder) = compiled_examples("driver-examples") {
        std::fs::write(folder.join("map"), [0; endat_regs::MAP_BYTES as usize]).unwrap();
        let program = folder.join("uio").display().to_string();
        let (is_good, text) = tools::run(&program, &folder, &["map"]);
        assert!(!is_good && text.contains("no card answers"), "{text}");
    }
}

#[test]
#[ignore = "slow: the example for Linux at a simulated card, in real time"]
fn the_example_for_linux_works_on_a_simulated_card() {
    if let Some(folder) = compiled_examples("driver-example-card") {
        on_a_simulated_card(&folder.join("uio").display().to_string(), &folder);
    }
}

/// Compiles the examples and the page; a folder with the program `uio`, unless the compiler is missing.
fn compiled_examples(name: &str) -> Option<PathBuf> {
    if !tools::require("gcc", "examples of the C driver") {
        return None;
    }
    let folder = tools::folder(name);
    write_header(&folder);
    std::fs::write(folder.join("hooks.c"), block("```c\n", 0)).unwrap();
    let spi = block_of(include_str!("../../docs/driver.md"), "```c\n", 0);
    let (spi, link) = spi.split_once("endat_link link;").unwrap();
    let spi = format!(
        "#include \"endat_transports.h\"\n\
         endat_error board_transfer(void *context, const uint8_t *sent, uint8_t *received, uint32_t count);\n\
         uint32_t board_us(void *context);\nendat_error open_spi(endat_card *card);\n{spi}\
         endat_error open_spi(endat_card *card) {{ endat_link link; {link} return endat_open(card, &link, 0); }}\n"
    );
    std::fs::write(folder.join("spi.c"), spi).unwrap();
    let shim = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/driver/shim");
    let includes = [home(), shim].map(|path| format!("-I{}", path.display()));
    let example = |name| home().join("examples").join(name).display().to_string();
    let examples = ["bare_metal.c", "freertos.c", "linux_uio.c"].map(example);
    for file in ["hooks.c".into(), "spi.c".into()].iter().chain(&examples) {
        let more = [
            "-I.",
            &includes[0],
            &includes[1],
            "-c",
            "-o",
            "object",
            file,
        ];
        let (is_good, text) = tools::run("gcc", &folder, &[&STRICT[..], &more].concat());
        assert!(is_good && text.is_empty(), "{text}");
    }
    // On a map without a card the one for Linux says so.
    let sources = sources();
    let mut arguments = vec!["-std=c99", &includes[0], "-o", "uio", &examples[2]];
    arguments.extend(sources.iter().map(String::as_str));
    let (is_good, text) = tools::run("gcc", &folder, &arguments);
    assert!(is_good, "{text}");
    Some(folder)
}

/// The same program on a desk, by the command of its first lines: another card, which runs slower than it thinks.
fn on_a_simulated_card(program: &str, folder: &Path) {
    let arguments = [
        "card",
        "--preset",
        "artinchip_endat_if",
        "--tcp",
        "127.0.0.1:0",
    ];
    let (mut card, name) = begun(program::endat().args(arguments));
    let port = name.trim().rsplit(':').next().unwrap();
    let (is_good, text) = tools::run(program, folder, &["tcp", "127.0.0.1", port]);
    card.kill().unwrap();
    card.wait().unwrap();
    assert!(is_good, "{text}");
    for channel in 0..2 {
        assert!(text.contains(&format!("channel {channel}: done")), "{text}");
        let fresh = |line: &&str| {
            line.starts_with(&format!("channel {channel}:")) && line.ends_with(", fresh, none")
        };
        assert_eq!(text.lines().filter(fresh).count(), 10, "{text}");
    }
    assert_eq!(
        text.matches("word 13 of its memory: 0x8019").count(),
        2,
        "{text}"
    );
    let (is_good, text) = tools::run(program, folder, &["tcp", "127.0.0.1", port]);
    assert!(!is_good && text.contains("no card listens there"), "{text}");
}

/// The Verilog as it is emitted, with the encoders of its benches. In `cargo test` the driver works at the same fronts on the bench, and
/// other tests compare the emission with those.
#[test]
#[ignore = "slow: the C driver at emitted cards in Verilator"]
fn the_emitted_cards_are_driven_in_verilator() {
    let check = "C driver at the emitted Verilog";
    if !tools::require_all(&["gcc", "verilator"], check) {
        return;
    }
    let more = "[service]\nparts = [\"requests\", \"diagnosis\"]\n";
    let projects = [HostBus::AxiLite, HostBus::Spi]
        .map(|bus| parse("card.toml", &rig::text(bus, more)).unwrap());
    let emitted = projects.each_ref().map(|p| endat_emit::emit(p).unwrap());
    let emitted = emitted.concat();
    let folder = tools::folder("driver-emitted");
    let mut files = vec![];
    for file in emitted {
        std::fs::write(folder.join(&file.path), &file.text).unwrap();
        if file.path.ends_with(".v") {
            files.push(file.path);
        }
    }
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/driver");
    let own = ["emitted.v", "emitted.cpp"].map(|name| tests.join(name).display().to_string());
    // Warnings of the emission have tests of their own.
    let mut arguments: Vec<&str> =
        "--cc --exe --build --timing -O3 -j 2 -Wno-fatal --top-module emitted -CFLAGS -O1 -o run"
            .split(' ')
            .collect();
    arguments.extend(own.iter().chain(&files).map(String::as_str));
    let (is_good, text) = tools::run("verilator", &folder, &arguments);
    assert!(is_good, "{text}");
    for project in &projects {
        Rig::outside(project, &folder.join("obj_dir/run")).run("emitted");
    }
}

#[test]
fn strict_compilers_have_nothing_to_say_about_the_driver() {
    let folder = tools::folder("driver-strict");
    for compiler in ["gcc", "clang"] {
        // gcc is enough: clang is a second opinion where there is one.
        let is_there = match compiler {
            "gcc" => tools::require(compiler, "C driver"),
            _ => tools::has(compiler),
        };
        for source in sources().iter().filter(|_| is_there) {
            let arguments = [&STRICT[..], &["-c", "-o", "object", source]].concat();
            let (is_good, text) = tools::run(compiler, &folder, &arguments);
            assert!(is_good && text.is_empty(), "{compiler}: {text}");
        }
    }
}

/// Catches a header that only C can read.
#[test]
fn the_headers_are_those_of_cpp_too() {
    if tools::require("g++", "C driver in C++") {
        let folder = tools::folder("driver-cpp");
        let text = "#include \"endat_transports.h\"\nint main() { return endat_error_text(ENDAT_OK) == nullptr; }\n";
        std::fs::write(folder.join("main.cpp"), text).unwrap();
        let include = format!("-I{}", home().display());
        let flags = [
            "-std=c++11",
            "-Wall",
            "-Wextra",
            "-pedantic",
            "-Werror",
            "-fsyntax-only",
        ];
        let (is_good, text) = tools::run(
            "g++",
            &folder,
            &[&flags[..], &[&include, "main.cpp"]].concat(),
        );
        assert!(is_good && text.is_empty(), "{text}");
    }
}

#[test]
fn the_driver_refuses_what_no_card_says() {
    if let Some(program) = compiled() {
        let (is_good, text) =
            tools::run(program.to_str().unwrap(), &home(), &["words", "alone", "0"]);
        assert!(is_good, "{text}");
    }
}

/// Every part that a card behind any bus but the UART can have.
fn everything() -> String {
    format!("{ALL_PARTS}[outputs]\nparts = [\"interrupt\"]\n")
}

#[test]
fn everything_works_over_axi_lite() {
    Rig::new(HostBus::AxiLite, &everything()).run("journey");
}

/// The Rust driver makes this journey in `cargo test`.
#[test]
#[ignore = "slow: the C driver's whole journey over SPI"]
fn everything_works_over_spi() {
    Rig::new(HostBus::Spi, &everything()).run("journey");
}

/// The Rust driver meets this encoder in `cargo test`.
#[test]
#[ignore = "slow: the C driver at an encoder that never answers"]
fn an_encoder_that_never_answers_is_told_with_its_step() {
    let project = parse("card.toml", &rig::text(HostBus::Apb, ALL_PARTS)).unwrap();
    let encoder = |n| match n {
        1 => rig::encoder(n).defects(0..=u64::MAX, Defect::NoStartBit),
        n => rig::encoder(n),
    };
    Rig::with(project, encoder).run("broken");
}

/// Buses over which the drivers do not make the whole journey.
const OTHER_BUSES: [HostBus; 4] = [
    HostBus::Apb,
    HostBus::Wishbone,
    HostBus::Parallel,
    HostBus::Uart,
];

#[test]
fn position_parameter_and_plug_work_over_the_parallel_bus() {
    Rig::new(HostBus::Parallel, ALL_PARTS).run("short");
}

#[test]
#[ignore = "slow: the C driver over every other bus"]
fn position_parameter_and_plug_over_every_other_bus() {
    for bus in OTHER_BUSES {
        Rig::new(bus, ALL_PARTS).run("short");
    }
}

#[test]
fn a_card_without_parts_says_which_one_is_missing() {
    Rig::new(HostBus::AxiLite, "").run("bare");
}

/// Catches words of two results in one snapshot if reads are slow, and a hold that is not released.
#[test]
fn slow_reads_are_of_one_moment() {
    Rig::new(HostBus::Apb, ALL_PARTS).run("torn");
}

#[test]
#[ignore = "slow: the C driver's slow reads over the parallel bus"]
fn slow_reads_over_the_parallel_bus_are_of_one_moment() {
    Rig::new(HostBus::Parallel, ALL_PARTS).run("torn");
}

fn noise_spoils_nothing(scenario: &str, least: u64) {
    let mut rig = Rig::new(HostBus::Spi, ALL_PARTS).noise(20);
    rig.run(scenario);
    let is_enough = rig.flipped > least || compiled().is_none();
    assert!(is_enough, "{}", rig.flipped);
}

#[test]
fn noise_on_spi_spoils_no_position() {
    noise_spoils_nothing("noisy positions", 12);
}

#[test]
#[ignore = "slow: positions, parameters and settings of the C driver over a noisy SPI"]
fn noise_on_spi_spoils_nothing() {
    noise_spoils_nothing("noisy", 50);
}

#[test]
fn emit_hands_the_driver_out_with_a_card() {
    let dir = Dir::new("driver");
    let out = dir.path("o");
    let with = [
        "emit",
        "--preset",
        "s6_two_channel",
        "--out",
        &out,
        "--with",
        "driver",
    ];
    good(&with);
    let folder = dir.0.join("o/s6_two_channel");
    for (name, text) in endat_emit::driver::FILES {
        assert_eq!(std::fs::read_to_string(folder.join(name)).unwrap(), *text);
    }
    let manifest = std::fs::read_to_string(folder.join("MANIFEST")).unwrap();
    assert_eq!(manifest.matches("  endat.h\n").count(), 1);
    let readme = std::fs::read_to_string(folder.join("README.md")).unwrap();
    assert_eq!(readme.matches(endat_emit::driver::ROW).count(), 1);
    good(&[&with[..], &["--check"]].concat());
    let told = bad(
        &with[..5]
            .iter()
            .copied()
            .chain(["--check"])
            .collect::<Vec<_>>(),
        1,
    );
    assert!(told.contains("endat.h: is no longer emitted"), "{told}");
    std::fs::remove_file(folder.join("endat.c")).unwrap();
    let told = bad(&[&with[..], &["--check"]].concat(), 1);
    assert!(
        told.contains("endat.c: is missing") && told.contains(" --with driver"),
        "{told}"
    );
    let told = bad(
        &[
            "emit",
            "--preset",
            "async_dsp",
            "--out",
            &out,
            "--with",
            "driver",
        ],
        2,
    );
    assert!(
        told.starts_with("with = \"driver\": async_dsp has no such file"),
        "{told}"
    );
}
