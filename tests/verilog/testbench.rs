//! The emitted test bench on the emitted card: passes on the card, and fails on every broken card.

use super::mutations::{Mutation, MUTATIONS};
use super::{
    bus_bench, compile, file_of, has_block, preset_files, quick_files, quick_project, write,
};
use crate::strangers::on_both_cores;
use crate::tools;
use endat_config::{parse, preset};
use endat_console::artifact::Artifact;
use endat_hdl::card::bus::HostBus;
use endat_hdl::config::{ServiceParts, LIST};
use endat_hdl::endat::service::program::{program, ServiceTimes};
pub use endat_tools::readers::passes;

/// The bench has passed.
fn assert_passes(text: &str) {
    assert!(passes(text), "{text}");
}

/// Runs a card's own test bench; what it prints. Its exit code says the same.
pub fn run_bench(test: &str, files: &[Artifact], plusargs: &[&str]) -> String {
    let (folder, mut sources) = write(test, files);
    let bench = files.iter().find(|f| f.path.ends_with("_tb.v")).unwrap();
    sources.insert(0, bench.path.clone());
    compile(
        &folder,
        bench.path.trim_end_matches(".v"),
        &sources,
        &["-Wall"],
    );
    let (good, text) = tools::run("vvp", &folder, &[&["-n", "sim.vvp"], plusargs].concat());
    assert_eq!(good, passes(&text), "{}: {text}", folder.display());
    text
}

/// A card's own test bench passes.
pub fn bench_passes(test: &str, files: &[Artifact], plusargs: &[&str]) {
    if tools::require("iverilog", "emitted test bench") {
        assert_passes(&run_bench(test, files, plusargs));
    }
}

#[test]
#[ignore = "slow: bench of the shipped card"]
fn bench_passes_on_the_preset() {
    bench_passes("preset", preset_files(), &[]);
}

/// Other channel counts, commands, widths, rates and cables; one channel, and a system clock with a fractional period.
#[test]
#[ignore = "slow: benches of other widths, rates and cables"]
fn bench_passes_on_other_cards() {
    let other = |name: &str, text: String| {
        let project = parse("other.toml", &text).unwrap();
        let files = endat_emit::emit(&project).unwrap();
        bench_passes(name, &files, &[]);
    };
    let frame = "[clock]\nsystem_hz = 64_000_000\n[trigger]\nsample_hz = 1_000\nsources = [\"register\"]\n[link]\nbaud = 3_000_000\nread_hz = 100\n[board]\nname = \"papilio_pro\"\n";
    other(
        "one_channel",
        format!("name = \"one\"\n{frame}[endat]\nclock_hz = 16_000_000\ncable_m = 20\n[[channel]]\nposition_bits = 1\ncommand = \"000111\"\n"),
    );
    other(
        "mixed",
        format!("name = \"mixed\"\n{frame}[endat]\nclock_hz = 2_000_000\n[[channel]]\nposition_bits = 48\ncommand = \"111000\"\n[[channel]]\nposition_bits = 13\ncommand = \"000111\"\nclock_hz = 8_000_000\n"),
    );
}

/// A cable whose delay needs all 11 bits, and on which a frame of a run fits: case `bench_780_m`.
fn long_cable() -> Vec<Artifact> {
    let text =
        "name = \"long_cable\"\n[clock]\nsystem_hz = 160_000_000\n[endat]\nclock_hz = 16_000_000\n\
        [[channel]]\nposition_bits = 31\ncommand = \"000111\"\ncable_m = 780\n\
        [trigger]\nsample_hz = 1_000\nsources = [\"pin\"]\n[host]\nbus = \"parallel\"\n\
        [service]\nparts = [\"requests\", \"continuous\"]\n[outputs]\nparts = [\"interrupt\"]\n";
    endat_emit::emit(&parse("long_cable.toml", text).unwrap()).unwrap()
}

#[test]
#[ignore = "slow: bench of a card with a cable of 780 m"]
fn bench_passes_on_a_cable_of_780_m() {
    bench_passes("long_cable", &long_cable(), &[]);
}

/// Catches a delay of which the bench reads 10 bits, and a run that is expected to end in the moment in which the receiver ends it.
#[test]
fn the_bench_of_a_long_cable_reads_the_whole_delay_and_knows_what_is_on_the_cable() {
    let files = long_cable();
    let bench = files.iter().find(|f| f.path.ends_with("_tb.v")).unwrap();
    for part in [
        "field(age, AGE_RECOVERY_DELAY_HIGH_LSB, AGE_RECOVERY_DELAY_HIGH_BITS) << EVIDENCE_DELAY_CYCLES_BITS",
        "count_run(0, 1);",
        "0: delay_cycles = 1282;",
    ] {
        assert!(bench.text.contains(part), "{part}");
    }
}

/// The bench lets every channel take every trigger, whatever the card starts with.
#[test]
#[ignore = "slow: bench with triggers for each channel"]
fn bench_passes_on_a_card_whose_channels_have_triggers_of_their_own() {
    if tools::require("iverilog", "emitted test bench") {
        let channel =
            |keys: &str| format!("[[channel]]\nposition_bits = 25\ncommand = \"111000\"\n{keys}");
        let text = format!(
            "name = \"own\"\n[clock]\nsystem_hz = 100_000_000\n[endat]\nclock_hz = 4_000_000\ncable_m = 20\n{}{}{}\
             [trigger]\nsample_hz = 10_000\nsources = [\"register\", \"timer\"]\n[host]\nbus = \"wishbone\"\n",
            channel("divider = 3\n"),
            channel("sources = [\"timer\"]\n"),
            channel("enabled = false\n")
        );
        let files = endat_emit::emit(&parse("own.toml", &text).unwrap()).unwrap();
        assert!(has_block(&files, "channel_trigger"));
        bench_passes("own_triggers", &files, &[]);
    }
}

/// A preset's text at a clock that is simulated sooner.
pub fn at_50_mhz(text: &str) -> String {
    let usual = "system_hz = 100_000_000";
    assert_eq!(text.matches(usual).count(), 1);
    text.replace(usual, "system_hz = 50_000_000")
}

/// With everything about the line delay, double edge included: four frames measure the delay.
#[test]
#[ignore = "slow: bench with all line parts"]
fn bench_passes_on_a_card_with_all_line_parts() {
    if tools::require("iverilog", "emitted test bench") {
        let text = at_50_mhz(preset("s6_two_channel").unwrap());
        let (head, tail) = text.split_once("[line]").unwrap();
        let parts = "parts = [\"alignment\", \"margin\", \"double_edge\"]";
        let text = format!("{head}[line]{}", tail.replacen("parts = []", parts, 1));
        let files = endat_emit::emit(&parse("line.toml", &text).unwrap()).unwrap();
        assert!(has_block(&files, "line_monitor"));
        bench_passes("line", &files, &[]);
    }
}

/// Positions of a card that also takes requests are those of one that does not.
#[test]
#[ignore = "slow: bench with requests"]
fn bench_passes_on_a_card_with_requests() {
    if tools::require("iverilog", "emitted test bench") {
        let mut project = quick_project();
        project.card.service.requests = true;
        let files = endat_emit::emit(&project).unwrap();
        assert!(has_block(&files, "service"));
        bench_passes("requests", &files, &[]);
    }
}

/// A card that initialises its encoders: power-up, then everything else. It notices what is wrong with either.
#[test]
#[ignore = "slow: bench with initialisation, and three broken programs"]
fn bench_passes_on_a_card_with_initialisation_only_as_it_stands() {
    if !tools::require("iverilog", "emitted test bench") {
        return;
    }
    let mut project = quick_project();
    project.card.service = ServiceParts {
        infos: [0; LIST],
        requests: true,
        diagnosis: true,
        continuous: true,
        initialise: true,
    };
    let files = endat_emit::emit(&project).unwrap();
    bench_passes("initialise", &files, &[]);
    type Change = fn(&mut ServiceTimes);
    let times = |change: Change| {
        let mut times = ServiceTimes::at(project.card.system_hz);
        change(&mut times);
        program(&times)
    };
    let right = times(|_| ());
    let rows: [(&str, Change, &str); 3] = [
        (
            "power-up",
            |t| t.power_up_ms -= 3,
            "channels that did not wait",
        ),
        (
            "pulse",
            |t| t.after_pulse_ms -= 3,
            "channels that did not wait",
        ),
        ("late", |t| t.power_up_ms += 3, "pulses after power-up"),
    ];
    for (name, change, complaint) in rows {
        let wrong = times(change);
        let mut broken = files.clone();
        let path = file_of(&files, "sequencer");
        let file = broken.iter_mut().find(|f| f.path == path);
        let text = &mut file.unwrap().text;
        let mut count = 0;
        for (k, (from, to)) in right.iter().zip(&wrong).enumerate() {
            if from != to {
                let line = |word: &u32| format!("program_value[{k}] = 20'h{word:x};");
                assert_eq!(text.matches(&line(from)).count(), 1, "{}", line(from));
                *text = text.replace(&line(from), &line(to));
                count += 1;
            }
        }
        assert_eq!(count, 1, "{name}");
        let test = format!("initialise-{name}");
        let said = run_bench(&test, &broken, &["+first"]);
        assert!(said.contains(complaint), "{name}: {said}");
    }
}

/// The files with a mutation; what does not stand there exactly once is an error.
fn mutant(files: &[Artifact], mutation: &Mutation) -> Result<Vec<Artifact>, String> {
    let mut files = files.to_vec();
    let file = file_of(&files, mutation.block);
    let Some(target) = files.iter_mut().find(|f| f.path == file) else {
        return Err(format!("{}: no file {file}", mutation.name));
    };
    target.text = mutation.applied(&target.text)?;
    Ok(files)
}

/// Checks that each mutation fits the files, without an outside tool.
pub fn fit(files: &[Artifact], mutations: &[Mutation]) {
    let absent = mutations.iter().filter_map(|m| mutant(files, m).err());
    let absent: Vec<_> = absent.collect();
    assert!(absent.is_empty(), "{absent:#?}");
}

/// Checks that the bench of `files` passes, and fails with each mutation.
pub fn check_mutations(test: &str, files: &[Artifact], mutations: &[Mutation]) {
    fit(files, mutations);
    if tools::require("iverilog", "mutations of the emitted card") {
        assert_passes(&run_bench(test, files, &[]));
        notices(test, files, mutations.iter());
    }
}

/// Checks that the bench of `files` passes, and fails with the mutations of these names. All mutations fit.
pub fn check_some(test: &str, files: &[Artifact], mutations: &[Mutation], names: &[&str]) {
    fit(files, mutations);
    if tools::require("iverilog", "mutations of the emitted card") {
        assert_passes(&run_bench(test, files, &[]));
        notices(test, files, named(mutations, names));
    }
}

/// The mutations of these names.
pub fn named<'m>(
    mutations: &'m [Mutation],
    names: &'m [&str],
) -> impl Iterator<Item = &'m Mutation> {
    let of = |name: &&str| mutations.iter().find(|m| m.name == *name);
    names
        .iter()
        .map(move |name| of(name).unwrap_or_else(|| panic!("{name}: no mutation")))
}

/// Checks that the bench of `files` fails with each of these mutations.
pub fn notices<'m>(test: &str, files: &[Artifact], mutations: impl Iterator<Item = &'m Mutation>) {
    let tried: Vec<_> = mutations.collect();
    assert!(!tried.is_empty());
    let survivors = on_both_cores(&tried, |index, mutation| {
        let broken = mutant(files, mutation).unwrap();
        let text = run_bench(&format!("{test}-mutant{index}"), &broken, &["+first"]);
        passes(&text).then(|| format!("{}: {text}", mutation.name))
    });
    assert!(survivors.is_empty(), "not noticed: {survivors:?}");
}

/// Cards whose bench is quick to simulate: their system clock is slow, their host has a bus. All steps on one channel, the first ones on two
/// channels, which notice mutations of every kind.
#[test]
fn bench_of_a_quick_card_passes_and_fails_on_broken_cards() {
    fit(quick_files(), MUTATIONS);
    let files = bus_bench::files(HostBus::Apb);
    fit(&files, bus_bench::APB);
    if !tools::require("iverilog", "emitted test bench") {
        return;
    }
    let one_channel = bus_bench::one_channel(HostBus::Apb);
    assert_passes(&run_bench("one-channel", &one_channel, &[]));
    assert_passes(&run_bench("quick-card", &files, &["+quick"]));
    let core = [
        "CRC: its first bit not compared",
        "a bad frame replaces the last good position",
        "hold has no effect",
    ];
    let bus = [
        "APB: byte address taken for a word address",
        "direct output: no strobe",
    ];
    let all = named(MUTATIONS, &core).chain(named(bus_bench::APB, &bus));
    notices("quick-card", &files, all);
}

#[test]
#[ignore = "slow: every mutation of the card of the preset"]
fn bench_fails_on_every_broken_card() {
    check_mutations("quick", quick_files(), MUTATIONS);
}
