//! Pages: figures in the documentation are those of the program.

use crate::tools;
use endat_hdl::config::{needed_baud, read_bytes, CHANNELS};
use endat_hdl::endat::transaction::cause;
use endat_hdl::protocol::ModeCommand;
use endat_hdl::regs::{result_words, CARD, CARD_CONFIG, RESULT};
use endat_tools::area::XC6S;

const SIZE: &str = include_str!("../docs/size.md");

/// Cells of the first row that begins with this text.
fn row<'p>(page: &'p str, head: &str) -> Vec<&'p str> {
    let row = page.lines().find(|l| l.starts_with(head));
    let row = row.unwrap_or_else(|| panic!("no row {head}"));
    row.trim_matches('|').split('|').map(str::trim).collect()
}

/// A page with figures that come from elsewhere; `UPDATE_EXPECT=1` writes them into it.
struct Figures {
    path: std::path::PathBuf,
    text: String,
}

impl Figures {
    fn of(page: &str) -> Self {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(page);
        let text = std::fs::read_to_string(&path).unwrap();
        Figures { path, text }
    }

    /// Cells of the row that begins with `head`, from its second on.
    fn cells(&mut self, head: &str, cells: &[String]) {
        let old = self.text.lines().find(|l| l.starts_with(head));
        let old = old.unwrap_or_else(|| panic!("no row {head}")).to_owned();
        let mut found: Vec<String> = old.split('|').map(str::to_owned).collect();
        for (at, cell) in cells.iter().enumerate() {
            found[at + 2] = format!(" {cell} ");
        }
        self.text = self.text.replacen(&old, &found.join("|"), 1);
    }

    fn check(self) {
        tools::assert_committed(&self.path, &self.text);
    }
}

/// Figures of a subject for a family, of `tests/data/area.toml`.
fn area(subject: &str, family: &str) -> [i64; 2] {
    let text = Figures::of("tests/data/area.toml").text;
    let table: toml::Table = text.parse().unwrap();
    ["lut", "ff"].map(|kind| table[subject][family][kind].as_integer().unwrap())
}

#[test]
fn the_sizes_are_those_of_the_area_table() {
    let mut page = Figures::of("docs/size.md");
    for (head, subject) in [
        ("| one port", "channel"),
        ("| the same that shows", "channel_restore"),
        ("| this with guards", "channel_guards"),
        ("| one port with all mode commands", "channel_requests"),
        ("| the same with line diagnosis", "channel_diagnosis"),
        ("| the same with continuous", "channel_continuous"),
        ("| the same with the three", "channel_all"),
        ("| the same with alignment |", "channel_alignment"),
        (
            "| the same with alignment and double edge",
            "channel_double_edge",
        ),
        ("| a port with alignment and margin", "port_margin"),
        ("| a port with requests", "port_service"),
        ("| a port with everything", "port_all"),
        ("| two-channel card", "card"),
        ("| the same without guards", "card_unguarded"),
        ("| the same with a stream", "card_stream"),
        ("| the card behind APB3", "card_apb"),
        ("| the same behind Wishbone", "card_wishbone"),
        ("| the same behind AXI4-Lite", "card_axi_lite"),
        ("| the same behind SPI", "card_spi"),
        ("| the same behind the parallel bus", "card_parallel"),
        ("| recovery counter", "recovery_counter"),
        ("| second receiver", "second_receiver"),
        ("| card with everything", "card_service"),
    ] {
        page.cells(head, &area(subject, XC6S.name).map(|n| n.to_string()));
    }
    for (head, one, other) in [
        ("| direct outputs", "direct_output", "irq"),
        ("| second interface", "second_interface", "second_record"),
    ] {
        let [ours, theirs] = [one, other].map(|subject| area(subject, XC6S.name));
        page.cells(head, &[0, 1].map(|n| format!("{}; {}", ours[n], theirs[n])));
    }
    let peer = [1, 2].map(|cell| row(SIZE, "| public peer")[cell].parse::<f64>().unwrap());
    let of_peer = |[lut, ff]: [i64; 2]| {
        let [lut, ff] = [lut as f64 / peer[0], ff as f64 / peer[1]];
        format!("LUT {lut:.2}, FF {ff:.2} of the public position-only receiver's")
    };
    let of_device = |[lut, _]: [i64; 2]| format!("{:.1} %", lut as f64 / 57.20);
    for (head, subject, third) in [
        (
            "| one port",
            "channel",
            &of_peer as &dyn Fn([i64; 2]) -> String,
        ),
        ("| two-channel card", "card", &|area| {
            of_device(area) + " of the LX9's 5720 LUTs"
        }),
        ("| card with everything", "card_service", &of_device),
    ] {
        let [lut, ff] = area(subject, XC6S.name);
        page.cells(head, &[lut.to_string(), ff.to_string(), third([lut, ff])]);
    }
    page.check();

    let mut page = Figures::of("README.md");
    for (head, subject, third) in [
        (
            "| one port",
            "channel",
            &of_peer as &dyn Fn([i64; 2]) -> String,
        ),
        ("| two-channel card", "card_stream", &|area| {
            of_device(area) + " of the LX9"
        }),
    ] {
        let [lut, ff] = area(subject, XC6S.name);
        page.cells(head, &[lut.to_string(), ff.to_string(), third([lut, ff])]);
    }
    page.cells("| public position-only", &peer.map(|n| n.to_string()));
    page.check();
}

#[test]
fn the_burst_in_the_host_link_page_is_the_one_that_is_counted() {
    let page = include_str!("../docs/host-link.md");
    let table = page.split_once("| channels |").unwrap().1;
    for channels in CHANNELS {
        let figures = [
            result_words(channels, false),
            read_bytes(channels, false),
            2_000_000 / needed_baud(1, channels, false),
        ];
        let cells = row(table, &format!("| {channels} |"));
        assert_eq!(cells[1..], figures.map(|n| n.to_string()));
    }
    assert!(page.contains(&format!("02 {:02X} 00 00 01 80", result_words(2, false))));
}

#[test]
fn every_command_is_on_the_page() {
    let page = include_str!("../docs/command-line.md");
    let mut count = 0;
    for program in [endat_gen::cli::command_line(), endat::command_line()] {
        for command in program.get_subcommands() {
            let row = format!("| `{}` ", command.get_name());
            assert!(page.contains(&row), "{row}");
            count += 1;
        }
    }
    assert!(count >= 30, "{count}");
}

#[test]
fn every_key_of_the_preset_is_on_the_page() {
    let page = include_str!("../docs/configuration.md");
    for words in ["1 to 8 of them", "`[]`", "6 at 100 MHz", "--name my_card"] {
        assert!(page.contains(words), "{words}");
    }
}

/// The line above the generated table of causes.
const CAUSES_MARK: &str =
    "<!-- From the table of causes: UPDATE_EXPECT=1 cargo test --test delivery causes writes it. -->\n";

#[test]
fn the_causes_in_the_programming_guide_are_those_of_the_table() {
    let mut page = Figures::of("docs/programming.md");
    let mut table = "| cause | name | meaning | remedy |\n|---|---|---|---|\n".to_owned();
    for row in cause::ALL {
        let [means, helps] = row.advice.expect("advice");
        table += &format!("| {} | `{}` | {means} | {helps} |\n", row.code, row.name);
    }
    let (before, rest) = page.text.split_once(CAUSES_MARK).expect("the mark");
    let end = rest.find("\n\n").expect("the end of the table") + 1;
    page.text = format!("{before}{CAUSES_MARK}{table}{}", &rest[end..]);
    page.check();
}

/// Drawings of the programming guide, each with the scenario that it shows.
const DRAWINGS: [(&str, &[&str]); 3] = [
    ("frame.svg", &["paper"]),
    ("supplement.svg", &["additional-data", "--frame", "5"]),
    ("parameter.svg", &["parameter", "--frame", "4"]),
];
/// Those of scenarios that last seconds.
const LONG_DRAWINGS: [(&str, &[&str]); 3] = [
    ("initialise.svg", &["initialise", "--frame", "all"]),
    ("no-answer.svg", &["no-answer", "--frame", "3"]),
    ("no-answer-pause.svg", &["no-answer", "--frame", "all"]),
];

fn docs(name: &str) -> std::path::PathBuf {
    let docs = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    docs.join(name)
}

#[test]
fn the_drawings_in_the_programming_guide_are_the_program_s() {
    drawings_are_the_program_s("pages-drawings", &DRAWINGS);
}

#[test]
#[ignore = "slow: drawings of scenarios that last seconds"]
fn the_long_drawings_in_the_programming_guide_are_the_program_s() {
    drawings_are_the_program_s("pages-long-drawings", &LONG_DRAWINGS);
}

fn drawings_are_the_program_s(test: &str, drawings: &[(&str, &[&str])]) {
    let page = include_str!("../docs/programming.md");
    let folder = tools::folder(test);
    for (name, scenario) in drawings {
        let command = format!("cargo run -- sim {} --svg {name}", scenario.join(" "));
        assert!(page.contains(&format!("`{command}`")), "{command}");
        assert!(page.contains(&format!("]({name})](")), "{name}");
        let file = folder.join(name);
        let svg = ["--svg", file.to_str().unwrap()];
        let outcome = crate::program::run(&[&["sim"], *scenario, &svg[..]].concat());
        assert_eq!(outcome.exit_code, 0, "{outcome:?}");
        let drawn = std::fs::read_to_string(file).unwrap();
        tools::assert_committed(&docs(name), &drawn);
    }
}

#[test]
fn the_eye_in_the_page_on_margin_is_the_program_s() {
    maps_are_the_program_s("pages-eye", &["eye.svg"]);
}

#[test]
#[ignore = "slow: maps of cables and of jitter"]
fn the_maps_in_the_page_on_margin_are_the_program_s() {
    maps_are_the_program_s("pages-maps", &["shmoo.svg", "jitter.svg"]);
}

fn maps_are_the_program_s(test: &str, names: &[&str]) {
    let page = include_str!("../docs/margin.md");
    let folder = tools::folder(test);
    for name in names {
        assert!(page.contains(&format!("]({name})](")), "{name}");
        let line = page.lines().find(|l| l.contains(&format!("--svg {name}")));
        let command = line.unwrap().split('`').nth(1).unwrap();
        let words = command.strip_prefix("cargo run --release -- ").unwrap();
        let file = |word: &str| match word.contains('.') && !word.contains('=') {
            true => folder.join(word).to_str().unwrap().to_owned(),
            false => word.to_owned(),
        };
        let words: Vec<String> = words.split(' ').map(file).collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let outcome = crate::program::run(&words);
        assert_eq!(outcome.exit_code, 0, "{outcome:?}");
        let drawn = std::fs::read_to_string(folder.join(name)).unwrap();
        tools::assert_committed(&docs(name), &drawn);
    }
}

/// The status word of a result, as four bytes.
fn status(cause: u64, is_fresh: bool, sequence: u64) -> String {
    let register = RESULT.register("status").unwrap();
    let put = |name: &str, value: u64| {
        let field = register.fields.iter().find(|f| f.name == name).unwrap();
        value << field.lsb
    };
    let word = put("cause", cause)
        | put("valid", 1)
        | put("fresh", is_fresh.into())
        | put("sequence", sequence);
    let bytes = (word as u32).to_be_bytes().map(|b| format!("{b:02X}"));
    bytes.join(" ")
}

#[test]
fn results_in_the_programming_guide_are_as_the_register_map_has_them() {
    let page = include_str!("../docs/programming.md");
    let good = status(cause::NONE, true, 2);
    assert!(page.contains(&format!("-> {good}   valid, fresh, cause 0, number 2")));
    let held = status(cause::NO_START_BIT, false, 3);
    assert!(page.contains(&format!("-> {held}   cause 2, valid, not fresh, number 3")));
    let sources = CARD_CONFIG.register("trigger_sources").unwrap();
    let bit = |name: &str| 1 << sources.fields.iter().find(|f| f.name == name).unwrap().lsb;
    let wanted = format!("00 00 00 {:02X}", bit("pin") | bit("register"));
    assert!(page.contains(&format!("01 01 00 00 01 00  {wanted}    trigger_sources")));
    for (block, name, bytes) in [
        (&CARD_CONFIG, "trigger_sources", "01 01 00 00 01 00"),
        (&CARD, "trigger_now", "01 01 00 00 00 09"),
        (&RESULT, "status", "02 03 00 00 01 80"),
    ] {
        let address = block.address(block.register(name).unwrap(), 0);
        let tail = format!("{:02X} {:02X}", address >> 8, address & 0xFF);
        assert!(bytes.ends_with(&tail) && page.contains(bytes), "{name}");
    }
}

#[test]
fn names_in_the_programming_guide_are_those_of_the_registers() {
    let page = include_str!("../docs/programming.md");
    let map = endat_hdl::regs::SERVICE;
    for name in [
        "request",
        "request_state",
        "answer",
        "control",
        "force",
        "progress",
        "state",
        "threshold",
        "tolerance",
        "list_length",
        "frames_position_2",
        "info_status",
        "bad_infos",
    ] {
        assert!(
            map.register(name).is_some() && page.contains(&format!("`{name}")),
            "{name}"
        );
    }
    for (address, name) in [
        (0x407, "progress"),
        (0x408, "state"),
        (0x405, "control"),
        (0x432, "frames_no_start_bit"),
        (0x446, "position_bits"),
        (0x400, "request"),
        (0x402, "answer"),
        (0x417, "continuous"),
        (0x418, "list_0"),
        (0x414, "list_length"),
        (0x420, "slot_0"),
    ] {
        let register = map.register(name).unwrap();
        assert_eq!(map.address(register, 0), address, "{name}");
        let bytes = format!("00 00 {:02X} {:02X}", address >> 8, address & 0xFF);
        assert!(page.contains(&bytes), "{name}: {bytes}");
    }
}

#[test]
fn the_table_for_artinchip_s_drivers_names_the_commands_that_are_not_watched() {
    let page = include_str!("../docs/comparison.md");
    let row = row(page, "| WDG |").join(" ");
    // `the_watchdog_leaves_three_commands_alone` shows it.
    let theirs = ["101010", "100011", "011100"];
    for command in ModeCommand::ALL {
        let code = format!("{:06b}", command.code());
        let is_exempt = theirs.contains(&code.as_str());
        assert_eq!(row.contains(&code), is_exempt, "{code}: {row}");
    }
    for word in ["strobe", "first falling edge", "recovery time"] {
        assert!(row.contains(word), "{word}: {row}");
    }
}

/// The first block behind these words, as it stands.
fn block<'p>(page: &'p str, words: &str, language: &str) -> &'p str {
    let behind = page.split_once(words).expect(words).1;
    let begin = format!("```{language}\n");
    let block = behind.split_once(&begin).expect("a block").1;
    block.split_once("```").expect("its end").0
}

#[test]
fn the_whole_card_on_the_page_on_buses_is_one() {
    let page = include_str!("../docs/bus.md");
    let text = block(page, "A whole card on a bus", "toml");
    let project = endat_config::parse("page.toml", text).unwrap();
    let files = endat_emit::emit(&project).unwrap();
    assert!(files.iter().any(|f| f.path.ends_with("my_card_tb.v")));
    let names = |name: &str, address: u16| {
        let of = |block: &endat_hdl::regs::Block| {
            let found = block.registers.iter().find(|r| r.name == name);
            found.map(|r| block.address(r, 0))
        };
        assert_eq!(of(&CARD).or(of(&RESULT)), Some(address), "{name}");
        assert!(page.contains(&format!("0x{address:03X}")), "{name}");
    };
    names("age_recovery", 0x185);
    names("trigger_now", 0x009);
    names("status", 0x180);
    names("position_low", 0x181);
}

/// Catches an example that does not compile, an encoder that does not answer the card of the page, and a latch in it where an input is tied.
#[test]
fn the_bench_of_one_s_own_on_the_page_on_buses_has_a_position() {
    let test = "the_bench_of_one_s_own_on_the_page_on_buses_has_a_position";
    if !tools::require("iverilog", test) {
        return;
    }
    let page = include_str!("../docs/bus.md");
    let text = block(page, "A whole card on a bus", "toml");
    let project = endat_config::parse("page.toml", text).unwrap();
    let folder = tools::folder("own_bench");
    let card = folder.join("card");
    endat_console::artifact::write(&card, &endat_emit::emit(&project).unwrap(), "").unwrap();
    let encoder = block(page, "For a bench of your own", "verilog");
    let bench = include_str!("data/own_bench.v").replace("@ENCODER@", encoder);
    std::fs::write(folder.join("own_bench.v"), bench).unwrap();
    // From another folder than the card's, as the README of an emission says.
    let files = ["own_bench.v", "card/my_card_tb.v", "card/my_card.v"];
    let run = |tool: &str, words: &[&str]| tools::run(tool, &folder, words);
    let compile = ["-g2005", "-y", "card", "-s", "own_bench", "-o", "own.vvp"];
    let (good, said) = run("iverilog", &[&compile[..], &files].concat());
    assert!(good, "{said}");
    let (good, said) = run("vvp", &["-n", "own.vvp"]);
    assert!(
        good && said.contains("PASS") && !said.contains("FAIL"),
        "{said}"
    );
    if tools::require("verilator", test) {
        let lint = [
            "--lint-only",
            "--timing",
            "-Wno-fatal",
            "-y",
            "card",
            "--top-module",
            "own_bench",
        ];
        let (good, said) = run("verilator", &[&lint[..], &files].concat());
        assert!(good && !said.contains("LATCH"), "{said}");
    }
}
