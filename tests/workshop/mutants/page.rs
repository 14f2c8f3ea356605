//! The page of the results.

use super::stimulus::CYCLES;
use super::{reasons, subjects, Fate, NAME};
use endat_campaign::budget;
use endat_campaign::part::{Identity, Part};
use endat_campaign::report::{grouped, Counts};
use endat_console::error::CommandError;
use endat_sim::campaign::{Shard, Tally};
use std::fmt::Write;

const HEAD: &str = "# Mutants

Who would notice if the Verilog were wrong? yosys's `mutate` changes one bit of one cell of a block (inverts it, makes it 0 or 1, or lets it follow a neighbour), \
again and again, and each of these mutants is given to those who should see it, in this order:

| | sees a mutant when |
|---|---|
| bench | the self-checking bench that is emitted beside the card does not end with PASS |
| ports | in a cycle of that bench a port of the block, or of one directly below it, has another value than in the card as it is |
| alone | the same while the block stands alone, with random inputs for {cycles} cycles, among them what the block compares something with; a microsecond is a few cycles |
| proof | a property of [proofs.md](proofs.md) that holds from the start values does not hold any more |

What the ports do is compared with the design, for the unchanged Verilog, by `tests/verilog/ports.rs`: in the suite for the T-format receiver in its bench and the first part of the rows of each block of the shipped \
card alone; with `-- --ignored` for all rows and the others, but for benches that set registers inside their card. A mutant of the columns *ports* and *alone* would turn these tests red.

A mutant that none of them sees may change nothing at all: where yosys proves, with all inputs free, that no port ever differs, it is *equivalent*, and does not count. \
yosys's own solver is asked first, then ABC for signals that are always alike (`scorr`) and for invariants that no short induction has (`pdr`). All others survive, and are listed below; that a solver finds no proof in its time, half a minute or ten, \
does not say that something changes.

Each block is mutated by itself, in the first card of the table that has it, in all its places at once. yosys spreads mutants evenly; those at the output of a register are \
left out, as `mutate` would take the start value away (its input and its readers have their own), and so are contents of memories. Properties that hold from any state, whole frames \
(`prove --frames`) and all other tests of the project are not asked.

The cards are presets, and four that are made for it (`tests/workshop/mutants/cards`). Not counted, as no card has them: `Crc5Fixed`, `TFormatChannel`.

`spi` and `artinchip_endat_if` have been counted with these random inputs, the other cards with simpler ones, for 24000 cycles.

The command is in [campaigns.md](campaigns.md), the results are `campaigns/results/mutants_*.csv`, and a test compares this page with them.

";

/// Counts of some classes.
fn sums(counts: &Counts) -> ([u64; 6], u64, u64) {
    let found = Fate::ALL.map(|f| counts.get(f.name()).copied().unwrap_or(0));
    let all: u64 = found.iter().sum();
    let killed = Fate::ALL.iter().zip(found).filter(|(f, _)| f.is_killed());
    (found, all, killed.map(|(_, n)| n).sum())
}

fn line(text: &mut String, name: &str, counts: &Counts) {
    let (found, all, killed) = sums(counts);
    let equivalent = counts.get(Fate::Equivalent.name()).copied().unwrap_or(0);
    let share = match all - equivalent {
        0 => "-".into(),
        changing => format!("{:.1} %", 100.0 * killed as f64 / changing as f64),
    };
    let found = found.map(|n| n.to_string()).join(" | ");
    let _ = writeln!(text, "| {name} | {all} | {found} | {share} |");
}

/// Blocks, what saw their mutants, and those that nothing saw.
pub fn table(tally: &Tally) -> String {
    let names = Fate::ALL.map(Fate::name).join(" | ");
    let mut text = format!(
        "| card | block | mutants | {names} | killed |\n|---|---|{}---|\n",
        "---|".repeat(7)
    );
    for ((subject, block), counts) in grouped(tally, |r| (&r.subject, &r.kind)) {
        line(&mut text, &format!("{subject} | {block}"), &counts);
    }
    for (_, counts) in grouped(tally, |_| ()) {
        line(&mut text, "all | all", &counts);
    }
    text.push('\n');
    for (row, _) in tally.rows().filter(|(r, _)| r.class == "not_run") {
        let _ = writeln!(
            text,
            "not run: {}: {}: {}",
            row.subject, row.kind, row.place
        );
    }
    text
}

/// The page `docs/mutants.md`, from the results of one card or more.
pub fn page(parts: &[Part]) -> Result<String, CommandError> {
    let mut text = HEAD.replace("{cycles}", &CYCLES.to_string());
    let mut tally = Tally::default();
    for part in parts {
        let Identity {
            campaign,
            plan,
            cases,
            ..
        } = &part.identity;
        if campaign != NAME || part.shard != Shard::WHOLE {
            return Err(CommandError::input(format!(
                "{campaign} {}: is not a whole campaign {NAME}; merge its parts first, and give {NAME} a page of its own",
                part.shard
            )));
        }
        let _ = writeln!(text, "- {cases} mutants: {plan}");
        tally.merge(part.tally.clone());
    }
    for card in subjects().filter(|card| tally.rows().all(|(row, _)| row.subject != *card)) {
        let _ = writeln!(text, "- not run: `{card}`, and the blocks that only it has");
    }
    for budget in budget::of(NAME) {
        let (bad, of) = budget.found(&tally);
        let verdict = match budget.holds(&tally) {
            true => "holds",
            false => "not reached",
        };
        let (what, limit) = (budget.what, budget.limit_per_mille);
        let _ = writeln!(
            text,
            "- {what}: {bad} of {of}, limit {limit} per mille: {verdict}"
        );
    }
    let survivors = tally
        .rows()
        .filter(|(r, _)| r.class == Fate::Survivor.name());
    let reasons = survivors.filter_map(|(r, _)| reasons::reason(&r.kind, &r.place));
    let nothing = reasons
        .filter(|reason| reason.starts_with(reasons::NOTHING))
        .count();
    let _ = writeln!(
        text,
        "- of the survivors, that change nothing by what people have found, without a proof: {nothing}"
    );
    text.push('\n');
    text += &table(&tally);
    text += "\n## Survivors\n\nThe line is that of the emitted file; the reasons are typed by people who have looked (`tests/workshop/mutants/reasons.rs`).\n\n\
             | card | block | mutant | reason |\n|---|---|---|---|\n";
    for (row, _) in tally
        .rows()
        .filter(|(r, _)| r.class == Fate::Survivor.name())
    {
        let reason = reasons::reason(&row.kind, &row.place).unwrap_or("not looked into");
        let place = row.place.replace('|', "\\|");
        let _ = writeln!(
            text,
            "| {} | {} | {place} | {reason} |",
            row.subject, row.kind
        );
    }
    Ok(text)
}
