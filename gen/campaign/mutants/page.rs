//! The page of the results.

use super::{reasons, Fate};
use crate::campaign::part::Part;
use crate::campaign::report::{grouped, Counts};
use endat_sim::campaign::Tally;
use std::fmt::Write;

const HEAD: &str = "# Mutants

Who would notice if the Verilog were wrong? yosys's `mutate` changes one bit of one cell of a block (inverts it, makes it 0 or 1, or lets it follow its neighbour), \
again and again, and each of these mutants is given to those who should see it, in this order:

| | sees a mutant when |
|---|---|
| bench | the self-checking bench that is emitted beside the card does not end with PASS |
| ports | in a cycle of that bench a port of the block, or of one directly below it, has another value than in the card as it is: `tests/verilog/ports.rs` \
compares these ports with the design, in every cycle |
| proof | a property of [proofs.md](proofs.md) that holds from the start values does not hold any more |

A mutant that none of them sees may change nothing at all: where yosys proves, with all inputs free, that no output ever differs, it is *equivalent*, and is not counted. \
All others survive, and are listed below; that a solver finds no proof of equivalence in half a minute does not say that they change something.

Each block is mutated by itself, in the first card of the table that has it, in all its places at once. Mutants are spread evenly by yosys; those at the output of a register are \
left out, as `mutate` would take the start value away: its input and its readers have their own. Properties that hold from any state, whole frames (`prove --frames`), and all other \
tests of the project are not asked.
";

/// Counts of some classes.
fn sums(counts: &Counts) -> ([u64; 5], u64, u64) {
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
        "---|".repeat(6)
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

/// The page `docs/mutants.md`.
pub fn page(part: &Part) -> String {
    let mut text = format!(
        "{HEAD}\n{} mutants ({}), of which those that change something are killed to at least 97 % where the budget holds. The command is in [campaigns.md](campaigns.md), the results are in \
         `campaigns/results/mutants.csv`, and a test compares this page with them.\n\n",
        part.identity.cases, part.identity.plan
    );
    text += &table(&part.tally);
    text += "\n## Survivors\n\nThe line is that of the emitted file; the reasons are typed by people who have looked (`gen/campaign/mutants/reasons.rs`).\n\n\
             | card | block | mutant | reason |\n|---|---|---|---|\n";
    for (row, _) in part
        .tally
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
    text
}
