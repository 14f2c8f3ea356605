//! `docs/reliability.md` and `campaigns/results/tables.md`, from the results of whole campaigns.

use endat_campaign::card::CardSubject;
use endat_campaign::part::Part;
use endat_campaign::{budget, elements, report};
use endat_console::error::CommandError;
use endat_sim::campaign::Shard;
use std::fmt::Write;

/// Text of the page before the campaigns.
const HEAD: &str = "# Reliability

These campaigns show the effect of a flipped bit, a disturbed line or a wrong frame on a port or a whole card. \
Every figure is from simulation, with encoder models on lines. [campaigns.md](campaigns.md) says how to run the campaigns.

- Results: `campaigns/results/*.csv`.
- All tables, by frame, block, disturbance and condition, with the worst registers: [campaigns/results/tables.md](../campaigns/results/tables.md).
- `campaigns/run` renews results, tables and this page. Tests compare them, and run some of the cases again.

## Classes and marks

Each case is in one class, the worst that occurred:

| class | meaning |
|---|---|
| masked | every result equals that of an undisturbed run |
| detected | a cause is reported, or the position is not `fresh` |
| lost | a trigger has no result, and no cause reports it |
| silent_other | the position is right; time stamp, additional data or answer are wrong, without a cause |
| silent | a wrong position is reported as good |
| hang | the port stays busy, or has no good result in 8 triggers |

A case can also have marks:

| mark | meaning |
|---|---|
| pulses | the encoder saw a wrong number of clock pulses, without a cause in that frame or the next |
| again | the port sent one frame too many, without a cause |
| rules | another rule of the encoder was broken, without a cause |
| conflict | for more than a bit time after the frame, receiver and encoder both drove DATA |
| next | the next frame was not good |
| held_wrong | with a cause: the held position is one that the encoder never sent |
| triggers_2, triggers_3, triggers_more | number of the trigger that began two good results in a row, if it was not the next one |
| slow | the port was busy for longer than its timers allow, but recovered; on a card: a channel or service recovered only after 60 ms of rest |
| config | the configuration of the card changed, and nothing reported it |
| reopened | the host had to open the connection again |

The model host reads a result just before the next trigger. Words in block RAM are not flip-flops and are not inverted. Ages, evidence and delays are not compared.

## The simulated card

The card has two channels with requests and diagnosis, a stream and a UART. The campaign inverts its flip-flops outside the channels; those of the channels are counted with the ports. \
A model host follows [host-link.md](host-link.md), [stream.md](stream.md) and [programming.md](programming.md), decodes with the host library and checks every position against its CRC. An upset occurs in one of six activities:

| activity | what happens |
|---|---|
| idle | nothing, between two triggers |
| frame | a trigger, the frames of both channels, their set of the stream |
| read | the host reads results, and the set from `stream_data` |
| write | the host writes configuration words and reads them back |
| stream | a trigger; the host reads results while the card pushes their set |
| request | the host reads a parameter of the encoder |

Then the host triggers until two rounds in a row are good, and reads the configuration back. After *idle* and *request* it also asks both services for a parameter.

- *detected* on a card: a cause, no answer, unrequested bytes, a wrong CRC, a damaged or missing stream frame, a stale result, a skipped number, a refused request.
- *lost* on a card: a trigger without a result or without a set. *silent_other*: a wrong time stamp, a wrong answer or a changed configuration.
- The host opens the connection again after four triggers without two good ones, or after three reads without an answer. It then writes its configuration again.
- *hang* on a card: no good result in 8 triggers after that, nor in 8 more after 60 ms of rest; or a service that fails four requests, and one more after 60 ms.

Clocks are fast and pauses short: 8 cycles per bit of the link, commands expire after 100 us, and the longest wait of a service is 16 ms.
";

/// Text of the file with all tables before them.
const TABLES: &str = "# Tables of the campaigns

All tables of [reliability.md](../../docs/reliability.md), which explains classes and marks. Columns of classes and marks are per mille of all cases of the row. `campaigns/run` writes this file.
";

/// The line that links to the tables of a campaign.
const LINK: &str = "Tables: [campaigns/results/tables.md](../campaigns/results/tables.md).";

/// Text of the page before the upsets by element.
const ELEMENTS: &str = "By element, as a fault analysis sorts them ([safety.md](safety.md)). This is no FMEDA: it has no failure rates and no permanent faults. Subjects are the EnDat port with all parts, and a card. An upset is

- *safe* if every result equals that of an undisturbed run,
- *reported* if a cause, a position that is not `fresh` or a check of the host shows it,
- *other* if a trigger is lost or a value other than the position is wrong, and nothing reports it.

";

/// Heading of a campaign, and what a case is; none if the page has no place for it.
fn title(part: &Part) -> Option<(&'static str, &'static str)> {
    let is_safety = part
        .tally
        .rows()
        .all(|(row, _)| row.subject == CardSubject::Safety.name());
    Some(match part.identity.campaign.as_str() {
        "upsets" if is_safety => ("Upsets of a card with every monitor", "The same card with all parts of `[safety]` ([safety.md](safety.md)); here the flip-flops of the channels are inverted, too. A second controller reads every result at the second interface. A refused position counts as detected, a wrong one that it accepts as silent. The two controllers do not compare their results. No forced error is due within a case, and nobody reads the recovery counter."),
        "upsets" => ("Upsets", "A case inverts one flip-flop at one moment of a frame, or of an activity of the card. System clock 32 MHz, 8 cycles per bit, 25 bits, 20 m."),
        "faults" => ("Faults of the line", "A fault begins in the frame (on), or ends in it (off), at every quarter of a bit, with each recovery time tm (000111: from 10 us) and cable. The T-format port and the SSI port have a line without delay, and their own faults. A single SSI position has no check sum."),
        "garbage" => ("Spoilt frames", "One spoilt frame in each case, at random. For the T-format port and the SSI port the encoder, the line or a setting is wrong. A random word passes a CRC of 5 bits with a chance of 1 in 32; with F1 and F2, 1 in 128."),
        "accept" => ("Accept set", "Every word that encoders of 1 to 13 bits can send, with error bits and CRC. A predicate that shares no code with the core decides."),
        _ => return None,
    })
}

/// Heading and case of a part that is a whole campaign.
///
/// # Errors
/// If it is only a part, or a campaign without a place on the page.
fn whole(part: &Part) -> Result<(&'static str, &'static str), CommandError> {
    title(part)
        .filter(|_| part.shard == Shard::WHOLE)
        .ok_or_else(|| {
            CommandError::input(format!(
                "{} {}: is not a whole campaign with a place on the page; merge its parts first",
                part.identity.campaign, part.shard
            ))
        })
}

/// The page, from the results of whole campaigns: budgets, and upsets by element.
pub fn page(parts: &[Part]) -> Result<String, CommandError> {
    let mut text = HEAD.to_owned();
    for part in parts {
        let name = &part.identity.campaign;
        let (heading, about) = whole(part)?;
        let _ = write!(
            text,
            "\n## {heading}\n\n{about} {} cases ({}). {LINK}\n\n",
            part.identity.cases, part.identity.plan
        );
        text.push_str("| budget | found | limit, per mille | verdict |\n|---|---|---|---|\n");
        for budget in budget::of(name) {
            let (bad, of) = budget.found(&part.tally);
            // Nothing was tried that could break it.
            if of == 0 {
                continue;
            }
            let verdict = match (budget.holds(&part.tally), budget.is_asserted) {
                (true, true) => "holds, asserted",
                (true, false) => "holds",
                (false, _) => "not reached",
            };
            let _ = writeln!(
                text,
                "| {} | {bad} of {of} | {} | {verdict} |",
                budget.what, budget.limit_per_mille
            );
        }
        if name == "upsets" {
            text.push('\n');
            text.push_str(ELEMENTS);
            text.push_str(&elements::table(&part.tally));
        }
    }
    Ok(text)
}

/// The file with all tables of these campaigns.
///
/// # Errors
/// As [`page`].
pub fn tables(parts: &[Part]) -> Result<String, CommandError> {
    let mut text = TABLES.to_owned();
    for part in parts {
        let (heading, _) = whole(part)?;
        let tables = report::text(&part.identity.campaign, &part.tally);
        let _ = write!(text, "\n## {heading}\n\n{}\n", tables.trim_end());
    }
    Ok(text)
}
