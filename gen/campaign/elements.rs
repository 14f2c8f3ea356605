//! The upsets by element, as a fault analysis (FMEDA) asks for them: what is safe, what is reported, what nothing reports.

use super::card::{in_channel, CardSubject};
use super::report::{block, flips, grouped, Counts};
use endat_sim::campaign::port::Class;
use endat_sim::campaign::{Row, Tally};
use std::fmt::Write;

/// An element: prefixes of its blocks, its name, and the check that reports an upset in it.
struct Element(&'static [&'static str], &'static str, &'static str);

const PORT: &str = "port_all";

/// Elements of a port, and of a channel of a card. A block belongs to the first element with a matching prefix.
#[rustfmt::skip]
const OF_PORT: &[Element] = &[
    Element(&["clock_gen", "sender"], "clock and mode command", "the encoder's answer: start bit, CRC, state of the line after the frame"),
    Element(&["receiver.check", "receiver.serial"], "the two CRCs", "each other"),
    Element(&["receiver", "add_info"], "receiver", "CRC in parallel and serially, state of the line"),
    Element(&["second"], "second receiver", "the first one"),
    Element(&["delay", "filter"], "line delay and input filter", "CRC, start window, parity of the delay"),
    Element(&["settings"], "settings of the frame", "parity"),
    Element(&["snapshot"], "result that is held", "parity of the position, of both copies"),
    Element(&["transaction", "own_asked", "ride_asked"], "order of a frame, verdict", "second look at the state of the line, limits of every wait"),
    Element(&["(top)"], "wiring of the channel", "CRC, causes"),
];

/// Elements of a card outside its channels.
#[rustfmt::skip]
const OF_CARD: &[Element] = &[
    Element(&["bridge"], "UART link", "no answer, unrequested bytes; an upset of the address: nothing"),
    Element(&["core.bank.ring", "core.registers_0.ring", "core.registers_1.ring"], "configuration", "parity on the ring, reported in every result"),
    Element(&["core.bank", "core.registers"], "register bank, results for the host", "CRC5 of the position, stale"),
    Element(&["core.whole"], "results with additional data", "CRC5 of the position"),
    Element(&["core.set", "core.stream"], "stream", "parity of each set, CRC-16 of each frame, count of triggers"),
    Element(&["core.service", "core.port"], "services", "answer of the encoder, its state"),
    Element(&["core.trigger"], "trigger", "count of triggers"),
    Element(&["core.timebase"], "time base", "nothing: time stamps are wrong"),
    Element(&["core.second", "core.record"], "second interface", "CRC-16 of each channel, CRC5 of the position, count of answers"),
    Element(&["core.recovery"], "recovery counter", "limits of the control that reads it; not read in the campaign"),
];

/// The element that a register is in; none if its subject is not sorted by element.
fn element(row: &Row) -> Option<&'static Element> {
    let (elements, block) = match (row.subject.as_str(), CardSubject::named(&row.subject)) {
        (PORT, _) => (OF_PORT, block(&row.place)),
        (_, Some(_)) => match in_channel(&row.place) {
            Some(place) => (OF_PORT, block(place)),
            None => (OF_CARD, block(&row.place)),
        },
        _ => return None,
    };
    let fits = |e: &&Element| e.0.iter().any(|begin| block.starts_with(begin));
    elements.iter().find(fits)
}

/// Part of a whole, per cent.
fn percent(part: u64, all: u64) -> String {
    match (part, all) {
        (0, _) | (_, 0) => "0".into(),
        _ => format!("{:.2}", 100.0 * part as f64 / all as f64),
    }
}

fn line(text: &mut String, subject: &str, name: &str, counts: &Counts, reported_by: &str) {
    let of = |class: Class| counts.get(class.name()).copied().unwrap_or(0);
    let all = flips(counts);
    let (masked, silent) = (of(Class::Masked), of(Class::Silent));
    let other = of(Class::Lost) + of(Class::SilentOther) + of(Class::Hang);
    let acting = all - masked;
    let _ = writeln!(
        text,
        "| {subject} | {name} | {all} | {} | {} | {} | {} | {} | {} | {reported_by} |",
        percent(masked, all),
        percent(of(Class::Detected), all),
        percent(other, all),
        percent(silent, all),
        percent(of(Class::Detected), acting),
        percent(acting - silent, acting),
    );
}

/// The table: a line for each element of the port with everything and of the cards, and their sums.
pub fn table(tally: &Tally) -> String {
    let mut text = String::from(
        "| subject | element | upsets | safe, % | reported, % | other, % | wrong position reported as good, % | reported, share of unsafe, % | no wrong position, share of unsafe, % | reported by |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    let mut sums = String::new();
    let subjects = [PORT]
        .into_iter()
        .chain(CardSubject::ALL.map(CardSubject::name));
    for subject in subjects {
        let of = |r: &Row| match r.subject == subject {
            true => element(r).map(|e| e.1),
            false => None,
        };
        let groups = grouped(tally, of);
        for Element(_, name, reported_by) in OF_PORT.iter().chain(OF_CARD) {
            if let Some(counts) = groups.get(&Some(*name)) {
                line(&mut text, subject, name, counts, reported_by);
            }
        }
        let all = grouped(tally, |r| of(r).is_some());
        if let Some(counts) = all.get(&true) {
            line(&mut sums, subject, "all", counts, "");
        }
    }
    text + &sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::part::Part;
    use std::path::Path;

    /// Catches a block that is new and in no element, or in a wrong one.
    #[test]
    fn every_block_is_in_an_element() {
        let read = |name: &str| {
            let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../campaigns/results");
            Part::read(&file.join(name)).unwrap().tally
        };
        for (file, subject) in [
            ("upsets.csv", PORT),
            ("upsets.csv", CardSubject::Plain.name()),
            ("upsets_safety.csv", CardSubject::Safety.name()),
        ] {
            let tally = read(file);
            let of = |r: &Row| r.subject == subject;
            let without: Vec<&Row> = (tally.rows().map(|(row, _)| row))
                .filter(|r| of(r) && element(r).is_none())
                .collect();
            assert_eq!(without, Vec::<&Row>::new());
            let all = tally.count(|r| of(r) && Class::ALL.iter().any(|c| c.name() == r.class));
            let sum = format!("| {subject} | all | {all} |");
            assert!(table(&tally).contains(&sum), "{sum}");
        }
        let name = |subject: &str, place: &str| {
            let row = Row {
                subject: subject.into(),
                kind: "frame".into(),
                place: place.into(),
                class: Class::Masked.name().into(),
            };
            element(&row).map(|e| e.1)
        };
        assert_eq!(name(PORT, "receiver.check.sum"), Some("the two CRCs"));
        assert_eq!(name(PORT, "receiver.word"), Some("receiver"));
        let safety = CardSubject::Safety.name();
        assert_eq!(name(safety, "core.bank.ring.w0"), Some("configuration"));
        let bank = Some("register bank, results for the host");
        assert_eq!(name(safety, "core.bank.word"), bank);
        let held = "core.port_1.channel_0.snapshot.held";
        assert_eq!(name(safety, held), Some("result that is held"));
    }
}
