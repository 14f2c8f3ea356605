//! The files of an emission in VHDL, and what the command line says about them.

use super::{listed, preset};
use endat_config::load_preset;
use endat_console::artifact::Artifact;
use endat_emit::language::Language;

fn text<'f>(files: &'f [Artifact], path: &str) -> &'f str {
    let found = files.iter().find(|f| f.path == path);
    &found.unwrap_or_else(|| panic!("{path} is missing")).text
}

/// Names of the ports in the order of a text in VHDL.
fn ports(text: &str, sign: &str) -> Vec<String> {
    let lines = text.lines().map(str::trim).filter(|l| !l.starts_with("--"));
    let names = lines.filter_map(|line| line.split_once(sign));
    let names = names.map(|(name, _)| name.trim().to_owned());
    names
        .filter(|name| name.ends_with(['i', 'o', 'e']) && !name.contains(' '))
        .collect()
}

/// The list names every source but bench and component, the top last.
#[test]
fn the_list_has_the_core_in_order() {
    let files = preset("s6_two_channel");
    let (name, sources) = listed(&files);
    assert_eq!(sources.first(), Some(&"s6_two_channel_logic.vhd"));
    assert_eq!(sources.last(), Some(&"s6_two_channel.vhd"));
    let others = [
        "_tb.vhd",
        "_replay_tb.vhd",
        "_component.vhd",
        "_registers.vhd",
        "_top.vhd",
    ]
    .map(|end| format!("{name}{end}"));
    let all = files
        .iter()
        .map(|f| f.path.as_str())
        .filter(|p| p.ends_with(".vhd"));
    let core: Vec<&str> = all.filter(|p| !others.iter().any(|o| o == p)).collect();
    assert_eq!(core, sources);
    // No Verilog of the core is among them.
    let verilog = files.iter().filter(|f| f.path.ends_with(".v"));
    assert_eq!(
        verilog.map(|f| f.path.as_str()).collect::<Vec<_>>(),
        [""; 0]
    );
    assert!(text(&files, "s6_two_channel.core").contains("vhdlSource-2008"));
    assert!(text(&files, "s6_two_channel_ipxact.xml").contains("<ipxact:language>vhdl<"));
    let readme = text(&files, "README.md");
    assert!(
        readme.contains("`s6_two_channel_tb.vhd`")
            && readme.contains("`s6_two_channel_replay_tb.vhd`")
            && !readme.contains("`s6_two_channel.v`")
    );
}

/// One component for both languages; the template has its ports.
#[test]
fn component_and_template_have_the_ports_of_the_top() {
    for language in [Language::Verilog, Language::Vhdl] {
        let project = load_preset("s6_two_channel").unwrap();
        let files = endat_emit::emit_in(&project, language).unwrap();
        let component = ports(text(&files, "s6_two_channel_component.vhd"), " : ");
        let template = ports(text(&files, "s6_two_channel_instance.vho"), "=>");
        let design = endat_emit::design(&project).unwrap();
        let top = design.top();
        let own: Vec<&String> = top.ports.iter().map(|p| &top.nets[p.net].name).collect();
        assert_eq!(component.iter().collect::<Vec<_>>(), own);
        assert_eq!(template, component);
    }
}

/// VHDL-93 is Latin-1, and a line that nobody can read is none.
#[test]
fn the_text_is_ascii_with_lines_of_a_bearable_length() {
    for file in preset("s6_two_channel_service")
        .iter()
        .filter(|f| f.path.ends_with(".vhd"))
    {
        assert!(file.text.is_ascii(), "{}", file.path);
        for line in file.text.lines().filter(|l| !l.contains("--")) {
            assert!(line.len() <= 400, "{}: {line}", file.path);
            assert_eq!(line, line.trim_end(), "{}", file.path);
        }
        assert!(!file.text.contains("\n\n\n"), "{}", file.path);
    }
}

/// The run that a bench plays has to be one in which something happens.
#[test]
fn what_the_bench_plays_has_good_positions() {
    for name in ["s6_two_channel", "clb_2mhz", "mixed_protocols"] {
        let project = load_preset(name).unwrap();
        let design = endat_emit::design(&project).unwrap();
        let played = endat_emit::vhdl::card(&project, &design).unwrap();
        assert_eq!(played.good, 2 * project.card.channels.len(), "{name}");
    }
}

#[test]
fn an_unknown_language_is_refused_with_those_there_are() {
    let outcome = endat_gen::cli::run(["endat-gen", "emit", "--language", "ada"]);
    assert_eq!(outcome.exit_code, 2);
    assert_eq!(
        outcome.messages,
        ["--language = ada: is none that is emitted; give verilog or vhdl"]
    );
}

/// Only a card with registers has a bench with encoders; every emission has one that plays a recorded run.
#[test]
fn cards_with_a_bus_have_a_bench_with_encoders() {
    let bare = format!("{}bus = \"none\"\n", super::QUICK_BEGINS);
    let bare = endat_config::parse_any_on("bare.toml", &bare, None).unwrap();
    let cases = [
        (preset("clb_2mhz"), true),
        (preset("ssi_two_channel"), true),
        (preset("async_dsp"), false),
        (super::emission(&bare), false),
    ];
    for (files, has_bench) in cases {
        let (name, _) = listed(&files);
        let has = |end: &str| files.iter().any(|f| f.path == format!("{name}{end}"));
        assert_eq!(has("_tb.vhd"), has_bench, "{name}");
        assert!(has("_replay_tb.vhd") && has("_replay_tb.txt"), "{name}");
        let readme = text(&files, "README.md");
        assert_eq!(
            readme.contains(&format!("`{name}_tb.vhd`")),
            has_bench,
            "{name}"
        );
        let core = text(&files, &format!("{name}.core"));
        assert_eq!(
            core.contains("  replay:\n    <<: *sim"),
            has_bench,
            "{name}"
        );
    }
}
