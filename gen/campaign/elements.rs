//! The upsets by element, as a fault analysis (FMEDA) asks for them: what is safe, what is told, what nothing tells.

use super::report::{block, flips, grouped, Counts};
use endat_sim::campaign::port::Class;
use endat_sim::campaign::{Row, Tally};
use std::fmt::Write;

/// An element: subject, how its blocks begin, what it is, and what tells an upset of it.
struct Element(
    &'static str,
    &'static [&'static str],
    &'static str,
    &'static str,
);

const PORT: &str = "port_all";
const CARD: &str = "card";

/// Every block is in the first that fits.
#[rustfmt::skip]
const ELEMENTS: &[Element] = &[
    Element(PORT, &["clock_gen", "sender"], "clock and mode command", "the encoder's answer: start bit, CRC, state of the line behind the frame"),
    Element(PORT, &["receiver.check", "receiver.serial"], "the two CRCs", "each other"),
    Element(PORT, &["receiver", "add_info"], "receiver", "CRC in parallel and serially, state of the line"),
    Element(PORT, &["delay", "filter"], "line delay and input filter", "CRC, start window, parity of the delay"),
    Element(PORT, &["settings"], "settings of the frame", "parity"),
    Element(PORT, &["snapshot"], "result that is held", "parity of the position, of both copies"),
    Element(PORT, &["transaction", "own_asked", "ride_asked"], "order of a frame, verdict", "second look at the state of the line, limits of every wait"),
    Element(PORT, &["(top)"], "wiring of the channel", "CRC, causes"),
    Element(CARD, &["bridge"], "UART link", "no answer, bytes that nobody asked for; of the address: nothing"),
    Element(CARD, &["core.bank.ring", "core.registers_0.ring", "core.registers_1.ring"], "configuration", "ring with parity, told in every result"),
    Element(CARD, &["core.bank", "core.registers"], "register bank, results for the host", "CRC5 of the position, stale"),
    Element(CARD, &["core.whole"], "results with additional data", "CRC5 of the position"),
    Element(CARD, &["core.set", "core.stream"], "stream", "parity of each set, CRC-16 of each frame, count of triggers"),
    Element(CARD, &["core.service", "core.port"], "services", "answer of the encoder, its state"),
    Element(CARD, &["core.trigger"], "trigger", "count of triggers"),
    Element(CARD, &["core.timebase"], "time base", "nothing: time stamps are another moment's"),
];

fn element(subject: &str, block: &str) -> Option<usize> {
    let fits = |e: &Element| e.0 == subject && e.1.iter().any(|begin| block.starts_with(begin));
    ELEMENTS.iter().position(fits)
}

/// Part of a whole, per cent.
fn percent(part: u64, all: u64) -> String {
    match (part, all) {
        (0, _) | (_, 0) => "0".into(),
        _ => format!("{:.2}", 100.0 * part as f64 / all as f64),
    }
}

fn line(text: &mut String, subject: &str, name: &str, counts: &Counts, told_by: &str) {
    let of = |class: Class| counts.get(class.name()).copied().unwrap_or(0);
    let all = flips(counts);
    let (masked, silent) = (of(Class::Masked), of(Class::Silent));
    let other = of(Class::Lost) + of(Class::SilentOther) + of(Class::Hang);
    let acting = all - masked;
    let _ = writeln!(
        text,
        "| {subject} | {name} | {all} | {} | {} | {} | {} | {} | {} | {told_by} |",
        percent(masked, all),
        percent(of(Class::Detected), all),
        percent(other, all),
        percent(silent, all),
        percent(of(Class::Detected), acting),
        percent(acting - silent, acting),
    );
}

/// The table: a line for each element of the port with everything and of the card, and their sums.
pub fn table(tally: &Tally) -> String {
    let of = |r: &Row| element(&r.subject, block(&r.place));
    let mut text = String::from(
        "| subject | element | upsets | safe, % | told, % | other, % | wrong position told as good, % | told of those that are not safe, % | without a wrong position, of the same, % | told by |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    for (index, counts) in grouped(tally, of) {
        if let Some(index) = index {
            let Element(subject, _, name, told_by) = ELEMENTS[index];
            line(&mut text, subject, name, &counts, told_by);
        }
    }
    for (subject, counts) in grouped(tally, |r| of(r).map(|index| ELEMENTS[index].0)) {
        if let Some(subject) = subject {
            line(&mut text, subject, "all", &counts, "");
        }
    }
    text
}

/// Blocks of the port with everything and of the card that no element has.
#[cfg(test)]
fn without_element(tally: &Tally) -> Vec<(&str, &str)> {
    let blocks = grouped(tally, |r| (r.subject.as_str(), block(&r.place)));
    let blocks = blocks.into_keys().filter(|(s, _)| [PORT, CARD].contains(s));
    blocks.filter(|(s, b)| element(s, b).is_none()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::part::Part;
    use std::path::Path;

    /// Catches a block that is new and in no element, or in a wrong one.
    #[test]
    fn every_block_is_in_an_element() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns/results/upsets.csv");
        let part = Part::read(&file).unwrap();
        assert_eq!(without_element(&part.tally), []);
        let all = |subject| {
            part.tally
                .count(|r| r.subject == subject && Class::ALL.iter().any(|c| c.name() == r.class))
        };
        let text = table(&part.tally);
        for subject in [PORT, CARD] {
            let sum = format!("| {subject} | all | {} |", all(subject));
            assert!(text.contains(&sum), "{sum} {text}");
        }
        assert!(element(CARD, "core.bank.ring") != element(CARD, "core.bank"));
        assert!(element(PORT, "receiver.check") != element(PORT, "receiver"));
    }
}
