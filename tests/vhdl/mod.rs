//! The emitted VHDL under GHDL: every preset in both languages, and its benches, which have to see what is broken.

mod bench;
mod files;
mod mutations;

use crate::strangers::on_both_cores;
use crate::tools;
use crate::verilog::mutations::Mutation;
use endat_config::board::{self, Board};
use endat_config::{self as config, Configuration};
use endat_console::artifact::Artifact;
use endat_emit::language::Language;
use mutations::MUTATIONS;
use rtl_design::elaborate::block_name;
use std::path::{Path, PathBuf};

/// Both languages that the text is in.
const STANDARDS: [&str; 2] = ["--std=93", "--std=08"];

/// Everything that is emitted for a configuration in VHDL.
fn emission(configuration: &Configuration) -> Vec<Artifact> {
    match configuration {
        Configuration::Card(card) => endat_emit::emit_in(card, Language::Vhdl),
        Configuration::Receiver(receiver) => {
            endat_emit::protocols::t_format::emit_in(receiver, Language::Vhdl)
        }
    }
    .unwrap()
}

fn preset(name: &str) -> Vec<Artifact> {
    emission(&config::load_any_preset(name).unwrap())
}

fn presets() -> impl Iterator<Item = &'static str> {
    let all = config::PRESETS.iter().chain(config::RECEIVER_PRESETS);
    all.map(|preset| preset.0)
}

/// What an emission is called, and the files that its list names.
fn listed(files: &[Artifact]) -> (&str, Vec<&str>) {
    let find = |f: &'_ Artifact| f.path.ends_with(".f");
    let list = files.iter().find(|f| find(f)).unwrap();
    let name = list.path.trim_end_matches(".f");
    (name, list.text.lines().collect())
}

/// Writes an emission into a folder of its own.
fn write(test: &str, files: &[Artifact]) -> PathBuf {
    let folder = tools::folder(&format!("vhdl-{test}"));
    for file in files
        .iter()
        .filter(|f| f.path.contains(".vhd") || f.path.ends_with(".txt"))
    {
        std::fs::write(folder.join(&file.path), &file.text).unwrap();
    }
    folder
}

/// Analyses the files of a list and more, and runs a unit with options.
fn ghdl(
    folder: &Path,
    files: &[Artifact],
    standard: &str,
    more: &[&str],
    run: &[&str],
) -> (bool, String) {
    let (_, sources) = listed(files);
    // Only board tops have components that nobody binds: the vendors' primitives.
    let options = ["-c", standard, "-Wno-binding"];
    let arguments = [&options[..], &sources, more, &["-r"], run].concat();
    tools::run("ghdl", folder, &arguments)
}

/// Output of the bench that plays a recorded run.
fn replay(folder: &Path, files: &[Artifact], standard: &str) -> (bool, String) {
    let (name, _) = listed(files);
    let (bench, file) = (format!("{name}_replay_tb"), format!("{name}_replay_tb.vhd"));
    let run = [&bench[..], "--ieee-asserts=disable-at-0"];
    ghdl(folder, files, standard, &[&file], &run)
}

fn assert_passes(test: &str, files: &[Artifact], standard: &str) {
    let folder = write(test, files);
    let (is_good, text) = replay(&folder, files, standard);
    // Without one warning of numeric_std.
    assert!(
        is_good && text.trim() == "PASS",
        "{test} {standard}: {text}"
    );
}

/// No warning, with the component and with the bench.
fn is_elaborated(test: &str, name: &str, standards: &[&str]) {
    if !tools::require("ghdl", "VHDL of the presets") {
        return;
    }
    let files = preset(name);
    let folder = write(&format!("{test}-{name}"), &files);
    let (bench, component) = (format!("{name}_replay_tb"), format!("{name}_component.vhd"));
    let more = [&component[..], &format!("{bench}.vhd")];
    for standard in standards {
        let (is_good, text) = ghdl(&folder, &files, standard, &more, &[&bench, "--no-run"]);
        assert!(is_good && text.is_empty(), "{name} {standard}: {text}");
    }
}

#[test]
fn presets_are_analysed_and_elaborated_in_a_language() {
    is_elaborated("elaborated", "ssi_two_channel", &STANDARDS[..1]);
    is_elaborated("elaborated", "clb_2mhz", &STANDARDS[1..]);
}

#[test]
#[ignore = "slow: every preset"]
fn every_preset_is_analysed_and_elaborated_in_both_languages() {
    for name in presets() {
        is_elaborated("all-elaborated", name, &STANDARDS);
    }
}

#[test]
fn replay_benches_of_quick_presets_pass() {
    if tools::require("ghdl", "VHDL benches") {
        assert_passes("async_dsp-93", &preset("async_dsp"), STANDARDS[0]);
    }
}

#[test]
#[ignore = "slow: every preset's bench"]
fn every_replay_bench_passes_in_both_languages() {
    if !tools::require("ghdl", "VHDL benches") {
        return;
    }
    let names: Vec<&str> = presets().collect();
    on_both_cores(&names, |_, name| {
        let files = preset(name);
        for standard in STANDARDS {
            assert_passes(&format!("all-{name}"), &files, standard);
        }
        None
    });
}

/// Presets have a UART, APB and AXI4-Lite. These cards have the other buses, and registers without start values.
#[test]
#[ignore = "slow: benches of cards on other buses and without start values"]
fn replay_benches_of_other_cards_pass() {
    if !tools::require("ghdl", "VHDL benches") {
        return;
    }
    let unknown = "[device]\ninitial_values = false\n";
    let cards = [
        ("wishbone", ""),
        ("spi", ""),
        ("parallel", ""),
        ("none", ""),
        ("apb", unknown),
        ("none", unknown),
    ];
    for (index, (bus, more)) in cards.into_iter().enumerate() {
        let text = format!("{QUICK_BEGINS}bus = \"{bus}\"\n{more}");
        let card = config::parse_any_on("other.toml", &text, None).unwrap();
        let files = emission(&card);
        let folder = write(&format!("other-{index}"), &files);
        let (is_good, said) = replay(&folder, &files, STANDARDS[index % 2]);
        let passes = said.lines().any(|line| line == "PASS");
        assert!(is_good && passes, "{bus} {more}: {said}");
        // Before the reset numeric_std may say that values are none.
        assert!(!more.is_empty() || said.trim() == "PASS", "{bus}: {said}");
    }
}

/// A synthesis finds neither a latch nor a text that is no hardware.
#[test]
fn ghdl_makes_netlists_of_the_presets() {
    if !tools::require("ghdl", "netlists of the VHDL") {
        return;
    }
    for name in ["s6_two_channel_service", "clb_2mhz", "async_dsp"] {
        makes_a_netlist(name, &preset(name));
    }
}

fn makes_a_netlist(name: &str, files: &[Artifact]) {
    let folder = write(&format!("netlist-{name}"), files);
    let (_, sources) = listed(files);
    let arguments = [&["--synth", "--std=08"][..], &sources, &["-e", name]].concat();
    let (is_good, text) = tools::run("ghdl", &folder, &arguments);
    let complaints = text
        .lines()
        .filter(|line| line.contains("error") || line.contains("latch"));
    let complaints: Vec<&str> = complaints.filter(|line| line.contains(".vhd:")).collect();
    assert!(is_good && complaints.is_empty(), "{name}: {complaints:?}");
    assert!(text.contains(&format!("entity {name} is")), "{name}");
}

/// Not a warning about the top of a card on a board.
fn assert_top(test: &str, configuration: &Configuration, standard: &str) {
    let files = emission(configuration);
    let (name, _) = listed(&files);
    let folder = write(&format!("top-{test}"), &files);
    let (top, file) = (format!("{name}_top"), format!("{name}_top.vhd"));
    let (is_good, text) = ghdl(&folder, &files, standard, &[&file], &[&top, "--no-run"]);
    assert!(is_good && text.is_empty(), "{test}: {text}");
}

fn board_top(name: &str, standard: &str) {
    let board = Board::named(name).unwrap();
    let text = config::preset_for("--preset", config::DEFAULT_PRESET, &board).unwrap();
    let card = config::parse_any_on("card.toml", &text, Some(&board)).unwrap();
    assert_top(name, &card, standard);
}

#[test]
fn the_top_of_a_board_is_elaborated() {
    if tools::require("ghdl", "board tops in VHDL") {
        board_top("ulx3s", STANDARDS[0]);
    }
}

#[test]
#[ignore = "slow: every board"]
fn board_tops_are_elaborated() {
    if !tools::require("ghdl", "board tops in VHDL") {
        return;
    }
    for (index, name) in board::names().into_iter().enumerate() {
        board_top(name, STANDARDS[index % 2]);
    }
    for (bus, standard) in ["spi", "parallel"].into_iter().zip(STANDARDS) {
        let more = format!("bus = \"{bus}\"\n[board]\nname = \"papilio_pro\"\n");
        let text = format!("{QUICK_BEGINS}{more}").replace("50_000_000", "100_000_000");
        let card = config::parse_any_on("card.toml", &text, None).unwrap();
        assert_top(bus, &card, standard);
    }
}

/// A family of somebody's own may have its clock manager in Verilog alone: then the top stays what it is.
#[test]
fn a_family_without_a_clock_manager_in_vhdl_keeps_its_top() {
    let folder = tools::folder("vhdl-family");
    let own = folder.join("own");
    std::fs::create_dir(&own).unwrap();
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("constraints/families/ecp5");
    for entry in std::fs::read_dir(shipped).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap();
        if name != "clock.vhd.jinja" {
            std::fs::copy(&path, own.join(name)).unwrap();
        }
    }
    let text = Board::text("ulx3s").unwrap();
    let file = folder.join("board.toml");
    std::fs::write(&file, text.replace("\"ecp5\"", "\"./own\"")).unwrap();
    let board = Board::from_file(&file).unwrap();
    let text = config::preset_for("--preset", config::DEFAULT_PRESET, &board).unwrap();
    let files = emission(&config::parse_any_on("card.toml", &text, Some(&board)).unwrap());
    let tops = files.iter().filter(|f| f.path.contains("_top."));
    let tops: Vec<&str> = tops.map(|f| f.path.as_str()).collect();
    assert_eq!(tops, ["board_two_channel_top.v"]);
    let readme = files.iter().find(|f| f.path == "README.md").unwrap();
    assert!(readme.text.contains("`board_two_channel_top.v`"));
}

/// What a design in VHDL takes the Verilog in with, in both languages.
#[test]
fn the_component_of_the_verilog_is_analysed() {
    if !tools::require("ghdl", "VHDL component of the Verilog") {
        return;
    }
    let folder = tools::folder("vhdl-component");
    for name in ["ti_three_channel", "s6_two_channel"] {
        let files = endat_emit::emit(&config::load_preset(name).unwrap()).unwrap();
        let path = format!("{name}_component.vhd");
        let file = files.iter().find(|f| f.path == path).unwrap();
        std::fs::write(folder.join(&path), &file.text).unwrap();
        for standard in STANDARDS {
            let (is_good, text) = tools::run("ghdl", &folder, &["-s", standard, &path]);
            assert!(is_good && text.is_empty(), "{name} {standard}: {text}");
        }
    }
}

/// A card whose frames take few cycles.
const QUICK_BEGINS: &str = "name = \"quick\"
[clock]
system_hz = 50_000_000
[endat]
clock_hz = 2_500_000
[[channel]]
position_bits = 25
command = \"111000\"
[trigger]
sample_hz = 5_000
[host]
";
const QUICK_ENDS: &str = "bus = \"apb\"\n[outputs]\nparts = [\"position\", \"interrupt\"]\n";

/// A broken emission.
fn mutant(files: &[Artifact], mutation: &Mutation) -> Result<Vec<Artifact>, String> {
    let (name, _) = listed(files);
    let path = match mutation.block {
        "" => format!("{name}.vhd"),
        block => format!("{}.vhd", block_name(name, block)),
    };
    let mut files = files.to_vec();
    let file = files.iter_mut().find(|f| f.path == path);
    let file = file.ok_or(format!("{}: there is no {path}", mutation.name))?;
    file.text = mutation.applied(&file.text)?;
    Ok(files)
}

fn quick() -> Vec<Artifact> {
    let text = format!("{QUICK_BEGINS}{QUICK_ENDS}");
    emission(&config::parse_any_on("quick.toml", &text, None).unwrap())
}

#[test]
fn the_replay_bench_passes_on_a_quick_card_and_fails_on_broken_ones() {
    assert!(MUTATIONS.len() >= 20);
    let files = quick();
    for mutation in MUTATIONS {
        mutant(&files, mutation).unwrap();
    }
    if tools::require("ghdl", "mutations of the emitted VHDL") {
        assert_passes("whole", &files, STANDARDS[0]);
        fails_on_broken("mutant", &files, &MUTATIONS[..3]);
    }
}

#[test]
#[ignore = "slow: every mutation"]
fn the_replay_bench_fails_on_twenty_broken_cards() {
    if tools::require("ghdl", "mutations of the emitted VHDL") {
        fails_on_broken("all-mutant", &quick(), MUTATIONS);
    }
}

fn fails_on_broken(test: &str, files: &[Artifact], mutations: &[Mutation]) {
    let survivors = on_both_cores(mutations, |index, mutation| {
        let broken = mutant(files, mutation).unwrap();
        let folder = write(&format!("{test}{index}"), &broken);
        let (is_good, text) = replay(&folder, &broken, STANDARDS[index % 2]);
        // The bench has to see it, not a compiler.
        (is_good || !text.contains("FAIL: cycle")).then(|| format!("{}: {text}", mutation.name))
    });
    assert!(survivors.is_empty(), "not noticed: {survivors:#?}");
}
