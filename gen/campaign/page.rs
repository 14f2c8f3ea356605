//! The page that says what the core stands: tables from the results of whole campaigns.

use super::card::CardSubject;
use super::part::Part;
use super::{budget, elements, report};
use crate::error::GenError;
use endat_sim::campaign::Shard;
use std::fmt::Write;

/// Where the page, the results and the command that makes both are told.
const HEAD: &str = "# Reliability

What becomes of a port, and of a whole card, when something goes wrong. Every figure here is counted by a campaign in simulation: encoder models on lines, an own \
mishap in each frame. `campaigns/run` runs them and writes this page; the results are in `campaigns/results/`, a test compares the page \
with them, and another one runs some of the cases again. How campaigns are run, on one machine or many: [campaigns.md](campaigns.md).

Tables are per mille of all cases. Each case is in one class, the worst that was seen:

| class | |
|---|---|
| masked | every result is as without the mishap |
| detected | a cause is told, or a position that is not fresh |
| lost | a trigger has no result, and no cause says so |
| silent_other | the position is right, but time stamp, additional data or answer are wrong, without a cause |
| silent | a wrong position is told as good |
| hang | busy for ever, or not good in 8 triggers |

Beside its class, a case may have these marks:

| mark | |
|---|---|
| pulses | the encoder saw a wrong number of clock pulses, and no cause in that frame or the next |
| again | a whole frame more than the trigger needs was sent, and no cause |
| rules | another rule of the encoder was broken, and no cause |
| conflict | for more than a bit time after the frame the driver was against the encoder's |
| next | the next frame was not good |
| held_wrong | with a cause: the position that is held is none that the encoder sent |
| triggers_2, triggers_3, triggers_more | which trigger after the frame was the first of two good ones in a row, if not the next; so a case may be here without `next`: good, bad, good, good |
| slow | busy for longer than the timers allow, but not for ever; of a card: a channel or a service came back only after 60 ms of rest |
| config | of a card: its configuration is not what the host wrote, and nothing has said so |
| reopened | of a card: the host had to open the connection anew |

Results are read just before the next trigger, as a host does that reads late. Blocks are those of [ARCHITECTURE.md](../ARCHITECTURE.md); words in block RAM are \
not flip-flops, and are not inverted.

**The card** has two channels with requests and diagnosis, a stream and the link with a UART; it is made of the same blocks as what is emitted. The flip-flops of \
the channels themselves are those of the ports and are not inverted again; all others are: link, register bank, held results, ring of configuration, \
triggers, time base, services and stream. Beside it runs a host that sends and takes bits of the line, does what [host-link.md](host-link.md), \
[stream.md](stream.md) and [programming.md](programming.md) say, and decodes with the host's library, which checks positions against their CRC once more. The flip comes \
in one of six activities:

| activity | |
|---|---|
| idle | between two triggers |
| frame | a trigger, the frames of both channels, their set of the stream |
| read | results are read, and the set from `stream_data` |
| write | configuration words are written and read back |
| stream | a trigger; results are read while its set is pushed |
| request | a parameter of the encoder is asked for |

After it the host goes on: a trigger at the pin, results of both channels, their set, until two rounds in a row are good; at the end it reads the configuration back, and after idle \
and request asks both services for a parameter. What it is told counts as detected: a cause, no answer, bytes that nobody asked for, a CRC that does not fit, a damaged or missing \
frame of the stream, a result that is stale, a number that is skipped, a request that is refused. Lost is a trigger without a result, or without a set; silent_other is a wrong time \
stamp, a wrong answer, a configuration that is another one. After four triggers without two good ones, or three reads without an answer, the host opens the connection anew, as \
[stream.md](stream.md) says, and writes its configuration again, settings of the services among it; a hang is no good result in 8 triggers after that, nor in 8 more after 60 ms of rest, or a service that fulfils no request, four times, and then once more after 60 ms.
Ages, evidence and delays are not compared. The clocks are fast and pauses short: 8 cycles to a bit of the link, commands forgotten after 100 us, the longest wait of a service 16 ms.
";

/// What stands above the upsets by element.
const ELEMENTS: &str = "By element, as a fault analysis sorts them ([safety.md](safety.md); no FMEDA, which has rates and faults that stay): an upset is safe where every result is as without it; told by a cause, a position that is not fresh, or a check of \
the host; other where a trigger is lost or something beside the position is wrong, and nothing tells it. \
Subjects are the EnDat port with everything, and a card behind the UART.

";

/// What stands above the tables of a campaign.
fn title(part: &Part) -> Option<(&'static str, &'static str)> {
    let is_safety = part
        .tally
        .rows()
        .all(|(row, _)| row.subject == CardSubject::Safety.name());
    Some(match part.identity.campaign.as_str() {
        "upsets" if is_safety => ("Upsets of a card with every monitor", "The card from above with all parts of `[safety]` ([safety.md](safety.md)); of this one the flip-flops of the channels are inverted, too. A second controller reads every result at the second interface: what it refuses counts as told, a wrong position that it takes as silent; the two controllers do not compare what they have. No forced error is due within a case, nor is the recovery counter read."),
        "upsets" => ("Upsets", "Every flip-flop inverted, at so many moments of every kind of frame, and of the card of every activity; system clock 32 MHz, 8 cycles to a bit, 25 bits, 20 m."),
        "faults" => ("Faults of the line", "Each begins in the frame and ends behind it, or ends in it, at every quarter of a bit; with each recovery time tm (000111: from 10 us) and cable. The T-format port and the SSI port have a line without delay, and faults of their own; the positions of an SSI port that asks for one copy have no check sum."),
        "garbage" => ("Spoilt frames", "One in each case, at random. Of the T-format port and the SSI port the encoder, the line or a setting is wrong; causes are codes of the protocol. A word is taken by a CRC of 5 bits with 1 in 32, with F1 and F2 besides with 1 in 128."),
        "accept" => ("Accept set", "Every word that encoders of 1 to 13 bits can send, error bits and CRC included, against a predicate that shares no code with the core."),
        _ => return None,
    })
}

/// The page, from the results of whole campaigns.
pub fn page(parts: &[Part]) -> Result<String, GenError> {
    let mut text = HEAD.to_owned();
    for part in parts {
        let name = &part.identity.campaign;
        let Some((heading, about)) = title(part).filter(|_| part.shard == Shard::WHOLE) else {
            return Err(GenError::input(format!(
                "{name} {}: is not a whole campaign with a place on the page; merge its parts first",
                part.shard
            )));
        };
        let _ = write!(
            text,
            "\n## {heading}\n\n{about} {} cases ({}).\n\n",
            part.identity.cases, part.identity.plan
        );
        text.push_str("| budget | found | limit, per mille | |\n|---|---|---|---|\n");
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
        text.push('\n');
        if name == "upsets" {
            text.push_str(ELEMENTS);
            text.push_str(&elements::table(&part.tally));
            text.push('\n');
        }
        text.push_str(report::text(name, &part.tally).trim_end());
        text.push('\n');
    }
    Ok(text)
}
