//! Tables of a campaign.

use endat_sim::campaign::port::{Class, Mark};
use endat_sim::campaign::{Row, Tally};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Registers that are named as the worst ones.
const WORST: usize = 20;

/// Cases by class.
pub type Counts<'a> = BTreeMap<&'a str, u64>;

/// The block that a register is in.
pub(super) fn block(place: &str) -> &str {
    place.rsplit_once('.').map_or("(top)", |(block, _)| block)
}

/// How many cases there are: each is in one class.
pub(super) fn flips(counts: &Counts) -> u64 {
    Class::ALL
        .iter()
        .map(|c| counts.get(c.name()).unwrap_or(&0))
        .sum()
}

/// The counts of every group of rows.
pub fn grouped<'a, K: Ord>(
    tally: &'a Tally,
    key: impl Fn(&'a Row) -> K,
) -> BTreeMap<K, Counts<'a>> {
    let mut groups: BTreeMap<K, Counts> = BTreeMap::new();
    for (row, count) in tally.rows() {
        *groups
            .entry(key(row))
            .or_default()
            .entry(&row.class)
            .or_default() += count;
    }
    groups
}

/// A line of the table: per mille of all flips of the group.
fn line(text: &mut String, name: &str, counts: &Counts) {
    let all = flips(counts);
    let _ = write!(text, "| {name} | {all} |");
    let classes = Class::ALL.iter().map(|c| c.name());
    for class in classes.chain(Mark::ALL.iter().map(|m| m.name())) {
        let count = counts.get(class).copied().unwrap_or(0);
        match count {
            0 => text.push_str(" 0 |"),
            _ => {
                let _ = write!(text, " {:.2} |", 1000.0 * count as f64 / all as f64);
            }
        }
    }
    text.push('\n');
}

fn heading(text: &mut String, first: &str) {
    let names: Vec<&str> = (Class::ALL.iter().map(|c| c.name()))
        .chain(Mark::ALL.iter().map(|m| m.name()))
        .collect();
    let _ = writeln!(text, "| {first} | flips | {} |", names.join(" | "));
    let _ = writeln!(text, "|---|{}", "---|".repeat(names.len() + 1));
}

/// The tables of a campaign.
pub fn text(campaign: &str, tally: &Tally) -> String {
    match campaign {
        "upsets" => upsets(tally),
        "accept" => accept(tally),
        "configurations" => configurations(tally),
        _ => disturbed(tally),
    }
}

/// Words by width: taken, refused, and what is wrong.
pub fn accept(tally: &Tally) -> String {
    let classes = ["taken", "refused", "taken_wrongly", "refused_wrongly"];
    let mut text = format!(
        "| frame | words | {} |\n|---|---|---|---|---|---|\n",
        classes.join(" | ")
    );
    for (kind, counts) in grouped(tally, |r| &r.kind) {
        let found = classes.map(|c| counts.get(c).copied().unwrap_or(0));
        let all: u64 = found.iter().sum();
        let found = found.map(|n| n.to_string()).join(" | ");
        let _ = writeln!(text, "| {kind} | {all} | {found} |");
    }
    text + "\n"
}

/// Configurations by bus, and the cases that are wrong.
pub fn configurations(tally: &Tally) -> String {
    const CLASSES: [&str; 8] = [
        "clean",
        "unclean",
        "refused",
        "taken",
        "panic",
        "not_found",
        "bench_passed",
        "bench_failed",
    ];
    let mut text = format!("| bus | {} |\n", CLASSES.join(" | "));
    let _ = writeln!(text, "|---|{}", "---|".repeat(CLASSES.len()));
    for (subject, counts) in grouped(tally, |r| &r.subject) {
        let found = CLASSES.map(|c| counts.get(c).copied().unwrap_or(0).to_string());
        let _ = writeln!(text, "| {subject} | {} |", found.join(" | "));
    }
    text.push('\n');
    for (row, _) in tally.rows().filter(|(row, _)| row.place != "all") {
        let _ = writeln!(text, "{}: {}: {}", row.class, row.subject, row.place);
    }
    text
}

/// Per mille of all cases, for each disturbance, for each port and, if they are different, for each condition.
pub fn disturbed(tally: &Tally) -> String {
    let mut text = String::new();
    heading(&mut text, "disturbance");
    for (kind, counts) in grouped(tally, |r| &r.kind) {
        line(&mut text, kind, &counts);
    }
    text.push('\n');
    heading(&mut text, "port, frame");
    for (subject, counts) in grouped(tally, |r| &r.subject) {
        line(&mut text, subject, &counts);
    }
    text.push('\n');
    heading(&mut text, "conditions");
    for (place, counts) in grouped(tally, |r| &r.place) {
        line(&mut text, place, &counts);
    }
    text.push('\n');
    text
}

/// Per mille of all flips, for each kind of frame, for each block, and the worst registers.
pub fn upsets(tally: &Tally) -> String {
    let mut text = String::new();
    heading(&mut text, "port, frame");
    for ((subject, kind), counts) in grouped(tally, |r| (&r.subject, &r.kind)) {
        line(&mut text, &format!("{subject}, {kind}"), &counts);
    }
    for (subject, counts) in grouped(tally, |r| &r.subject) {
        line(&mut text, &format!("{subject}, all"), &counts);
    }
    text.push('\n');
    heading(&mut text, "port, block");
    for ((subject, block), counts) in grouped(tally, |r| (&r.subject, block(&r.place))) {
        line(&mut text, &format!("{subject}, {block}"), &counts);
    }
    for class in [
        Class::Silent.name(),
        Class::SilentOther.name(),
        Class::Lost.name(),
        Class::Hang.name(),
        Mark::Pulses.name(),
        Mark::Conflict.name(),
        Mark::TriggersMore.name(),
    ] {
        let mut worst: Vec<(u64, u64, String)> = grouped(tally, |r| (&r.subject, &r.place))
            .into_iter()
            .filter_map(|((subject, place), counts)| {
                let found = *counts.get(class)?;
                Some((found, flips(&counts), format!("{subject} {place}")))
            })
            .collect();
        worst.sort_by(|a, b| b.0.cmp(&a.0).then(a.2.cmp(&b.2)));
        if !worst.is_empty() {
            let _ = writeln!(text, "\nworst registers, {class}:");
        }
        for (found, of, name) in worst.into_iter().take(WORST) {
            let _ = writeln!(text, "    {found:>7} of {of:>7}  {name}");
        }
    }
    text.push('\n');
    text
}
