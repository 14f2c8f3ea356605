//! Random configurations. Which keys there are, and what may stand there, is what the reader asks for; what is wrong with a draw is what it
//! complains about, and is drawn again. So a new key is drawn as soon as the reader knows it.

use endat_config::asked::{Asked, Kind};
use endat_config::asked_of;
use endat_config::keys::KEYS;
use endat_console::error::Diagnostic;
use endat_hdl::config::{Limits, CHANNELS};
use endat_sim::rng::Rng;
use std::collections::BTreeSet;

/// Rounds of drawing again before a draw is given up for another one.
const ROUNDS: usize = 300;
/// Draws before there is none.
const DRAWS: u64 = 50;
/// Numbers are looked for below two to the power of this; no key has more.
const NUMBER_BITS: u64 = 34;
/// Texts for keys that take any: some that are harmless, and some that end comments and strings elsewhere.
const TEXTS: [&str; 8] = [
    "one",
    "Card_7",
    "RCN 8510",
    "a */ b",
    "a \\",
    "\"quoted\"",
    "été",
    "`x` // $y",
];

/// A key and what stands there.
struct Entry {
    table: String,
    key: &'static str,
    value: String,
}

/// What stands on a line.
enum Line {
    /// The head of this table.
    Head(String),
    /// The entry with this index.
    Entry(usize),
}

/// A configuration under way.
struct Draft {
    entries: Vec<Entry>,
    channels: usize,
}

impl Draft {
    /// Its text, and what is on each line.
    fn text(&self) -> (String, Vec<Line>) {
        let (mut text, mut lines) = (String::new(), vec![]);
        let channels = (0..self.channels).map(|n| format!("channel[{n}]"));
        let mut tables: BTreeSet<String> = channels.collect();
        tables.extend(self.entries.iter().map(|e| e.table.clone()));
        tables.insert(String::new());
        for table in &tables {
            if !table.is_empty() {
                match table.split_once('[') {
                    Some((name, _)) => text += &format!("[[{name}]]\n"),
                    None => text += &format!("[{table}]\n"),
                }
                lines.push(Line::Head(table.clone()));
            }
            for (index, entry) in self.entries.iter().enumerate() {
                if entry.table == *table {
                    text += &format!("{} = {}\n", entry.key, entry.value);
                    lines.push(Line::Entry(index));
                }
            }
        }
        (text, lines)
    }

    fn has(&self, asked: &Asked) -> bool {
        let is_it = |e: &Entry| e.table == asked.table && e.key == asked.key;
        self.entries.iter().any(is_it)
    }

    fn add(&mut self, rng: &mut Rng, asked: &Asked) {
        if let Some(value) = value(rng, asked) {
            self.entries.push(Entry {
                table: asked.table.clone(),
                key: asked.key,
                value,
            });
        }
    }

    /// Takes an entry away, or draws it again.
    fn change(&mut self, rng: &mut Rng, index: usize, all: &[Asked]) {
        let entry = &mut self.entries[index];
        let of_it = |a: &&Asked| a.table == entry.table && a.key == entry.key;
        let drawn = all.iter().find(of_it).and_then(|a| value(rng, a));
        match drawn.filter(|_| !is_one_of(rng, 3)) {
            Some(value) => entry.value = value,
            None => drop(self.entries.remove(index)),
        }
    }

    /// Does something about a complaint: where it stands, or anywhere if it stands at no key.
    fn answer(&mut self, rng: &mut Rng, complaint: &Diagnostic, all: &[Asked]) {
        let (_, lines) = self.text();
        let missing = all.iter().find(|a| {
            let dot = if a.table.is_empty() { "" } else { "." };
            let name = format!("{}{dot}{}: is missing", a.table, a.key);
            complaint.text.starts_with(&name) && !self.has(a)
        });
        if let Some(missing) = missing {
            return self.add(rng, missing);
        }
        let line = complaint.line.checked_sub(1);
        let there = line.and_then(|line| lines.get(line));
        // Often another key is the one that has to give way.
        match there.filter(|_| !is_one_of(rng, 3)) {
            Some(Line::Entry(index)) => self.change(rng, *index, all),
            Some(Line::Head(table)) => self.entries.retain(|e| e.table != *table),
            None if self.channels > 1 && is_one_of(rng, 4) => {
                self.channels -= 1;
                let gone = format!("channel[{}]", self.channels);
                self.entries.retain(|e| e.table != gone);
            }
            None if !self.entries.is_empty() => {
                let index = rng.in_range(0, self.entries.len() as u64 - 1) as usize;
                self.change(rng, index, all);
            }
            None => {}
        }
    }
}

fn is_one_of(rng: &mut Rng, n: u64) -> bool {
    rng.in_range(1, n) == 1
}

fn pick<'a, T: ?Sized>(rng: &mut Rng, all: &[&'a T]) -> &'a T {
    all[rng.in_range(0, all.len() as u64 - 1) as usize]
}

/// Text as TOML has it.
fn quoted(text: &str) -> String {
    toml::Value::String(text.into()).to_string()
}

/// What may stand there; none for what is no value.
fn value(rng: &mut Rng, asked: &Asked) -> Option<String> {
    let words: Vec<&str> = asked.words.iter().map(String::as_str).collect();
    Some(match &asked.kind {
        Kind::Tables => return None,
        Kind::Integer(_) if !words.is_empty() => pick(rng, &words).to_owned(),
        Kind::Integer(limits) => number(rng, limits)?.to_string(),
        Kind::Boolean => is_one_of(rng, 2).to_string(),
        Kind::Text if words.is_empty() => quoted(pick(rng, &TEXTS)),
        Kind::Text => quoted(pick(rng, &words)),
        // A few in any order; one may repeat.
        Kind::Texts if KEYS.iter().any(|k| k.name == asked.key && k.repeats) => {
            let some = (0..rng.in_range(0, 4)).map(|_| quoted(pick(rng, &words)));
            format!("[{}]", some.collect::<Vec<_>>().join(", "))
        }
        Kind::Texts => {
            // Parts build on the ones before them more often than not.
            let some = words.iter().filter(|_| !is_one_of(rng, 3));
            let some: Vec<String> = some.map(|word| quoted(word)).collect();
            format!("[{}]", some.join(", "))
        }
        Kind::Integers => {
            let count = rng.in_range(0, 2);
            let some = (0..count).map(|_| format!("0x{:02X}", rng.in_range(0, 0x7F)));
            format!("[{}]", some.collect::<Vec<_>>().join(", "))
        }
    })
}

/// A number within limits, of any size, round or not; now and then the smallest or the greatest one.
fn number(rng: &mut Rng, limits: &Limits) -> Option<u64> {
    let mut any = || {
        let highest = 1 << rng.in_range(0, NUMBER_BITS);
        let number = rng.in_range(0, highest);
        match is_one_of(rng, 2) {
            true => number,
            false => {
                let step = 10u64.pow(number.checked_ilog10().unwrap_or(0).saturating_sub(1));
                number / step * step
            }
        }
    };
    let good = (0..1_000).map(|_| any()).find(|n| limits.contains(*n))?;
    Some(match rng.in_range(0, 9) {
        0 => edge(good, limits, |n, step| n.checked_sub(step)),
        1 => edge(good, limits, |n, step| n.checked_add(step)),
        _ => good,
    })
}

/// The last number within limits in one direction.
fn edge(from: u64, limits: &Limits, go: impl Fn(u64, u64) -> Option<u64>) -> u64 {
    let steps = (0..=NUMBER_BITS).rev().map(|bit| 1 << bit);
    steps.fold(from, |at, step| {
        let next = go(at, step).filter(|n| limits.contains(*n));
        next.unwrap_or(at)
    })
}

/// A configuration that the reader takes; the same for the same seed.
pub fn valid(seed: u64) -> Option<String> {
    (0..DRAWS).find_map(|draw| drawn(&mut Rng::new(seed ^ draw << 56)))
}

fn drawn(rng: &mut Rng) -> Option<String> {
    let most = if is_one_of(rng, 4) {
        *CHANNELS.end()
    } else {
        2
    };
    let mut draft = Draft {
        entries: vec![],
        channels: rng.in_range(*CHANNELS.start() as u64, most as u64) as usize,
    };
    let density_percent = rng.in_range(10, 90);
    let mut seen = BTreeSet::new();
    for _ in 0..ROUNDS {
        let (text, _) = draft.text();
        let (all, complaints) = asked_of(&text);
        let mut is_new = false;
        for asked in &all {
            let is_first = seen.insert((asked.table.clone(), asked.key));
            // A word decides what else there is, so that the usual one must not be the most.
            let is_choice = asked.kind == Kind::Text && !asked.words.is_empty();
            let wants = is_choice || rng.in_range(1, 100) <= density_percent;
            if is_first && !draft.has(asked) && wants {
                draft.add(rng, asked);
                is_new = true;
            }
        }
        if is_new {
            continue;
        }
        if complaints.is_empty() {
            return Some(text);
        }
        let index = rng.in_range(0, complaints.len() as u64 - 1) as usize;
        draft.answer(rng, &complaints[index], &all);
    }
    None
}

/// Numbers at the ends of what programs can hold, and what looks like one.
const NUMBERS: [&str; 12] = [
    "0",
    "-1",
    "1",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "9223372036854775808",
    "18446744073709551616",
    "99999999999999999999999999999999999999999",
    "1e400",
    "nan",
    "0xFFFF_FFFF",
];
/// What is put between other characters.
const BITS: [&str; 14] = [
    "[",
    "]",
    "[[",
    "=",
    "\"",
    "'",
    "#",
    "\n",
    "\r",
    "\0",
    ".",
    "\u{202e}",
    "{",
    "\u{1F600}",
];

/// A text with up to eight spoilt places.
pub fn mutated(text: &str, seed: u64) -> String {
    let mut rng = Rng::new(seed);
    let mut text = text.to_owned();
    for _ in 0..rng.in_range(1, 8) {
        text = spoilt(&mut rng, &text);
    }
    text
}

fn spoilt(rng: &mut Rng, text: &str) -> String {
    let mut lines: Vec<String> = text.split('\n').map(str::to_owned).collect();
    let last = lines.len() as u64 - 1;
    let (one, other) = (
        rng.in_range(0, last) as usize,
        rng.in_range(0, last) as usize,
    );
    match rng.in_range(0, 6) {
        0 => drop(lines.remove(one)),
        1 => lines.insert(other, lines[one].clone()),
        2 => lines.swap(one, other),
        3 => {
            if let Some((key, _)) = lines[one].split_once('=') {
                lines[one] = format!("{key}= {}", pick(rng, &NUMBERS));
            }
        }
        4 => {
            // The value of another key.
            let taken = lines[other]
                .split_once('=')
                .map(|(_, value)| value.to_owned());
            if let (Some((key, _)), Some(value)) = (lines[one].split_once('='), taken) {
                lines[one] = format!("{key}={value}");
            }
        }
        kind => {
            let mut letters: Vec<char> = lines[one].chars().collect();
            let at = rng.in_range(0, letters.len() as u64) as usize;
            match kind {
                5 if at < letters.len() => drop(letters.remove(at)),
                _ => drop(letters.splice(at..at, pick(rng, &BITS).chars())),
            }
            lines[one] = letters.into_iter().collect();
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use endat_config::parse_any;
    use std::ops::Range;

    /// Catches a draw that depends on more than its seed, one that the reader refuses, and a key that is never drawn.
    fn check_draws(seeds: Range<u64>, rare: &[&str]) {
        let (mut keys, mut drawn) = (BTreeSet::new(), BTreeSet::new());
        for seed in seeds {
            let text = valid(seed).unwrap();
            if seed.is_multiple_of(20) {
                assert_eq!(valid(seed).as_ref(), Some(&text));
            }
            if let Err(complaints) = parse_any("drawn.toml", &text) {
                panic!("{complaints:?}: {text}");
            }
            for asked in asked_of(&text).0.iter().filter(|a| a.kind != Kind::Tables) {
                keys.insert(asked.key);
            }
            drawn.extend(
                text.lines()
                    .filter_map(|l| Some(l.split_once(" =")?.0.to_owned())),
            );
        }
        let never: Vec<_> = (keys.iter())
            .filter(|key| !drawn.contains(**key) && !rare.contains(key))
            .collect();
        assert!(
            never.is_empty() && keys.contains("filter_cycles"),
            "{never:?} of {keys:?}"
        );
    }

    #[test]
    fn draws_are_valid_the_same_again_and_have_every_key() {
        // Few draws keep this one; the slow check has it.
        check_draws(0..200, &["bits_after"]);
    }

    #[test]
    #[ignore = "slow: 1600 drawn configurations"]
    fn many_draws_are_valid_and_the_same_again() {
        check_draws(0..1600, &[]);
    }

    /// Catches a panic of the reader, and spoilt texts that are all alike to it. Returns how many were accepted and rejected.
    fn check_spoilt(seeds: Range<u64>) -> (u32, u32) {
        let (mut taken, mut refused) = (0, 0);
        for seed in seeds {
            let text = valid(seed).unwrap();
            for spoiling in 0..10 {
                let spoilt = mutated(&text, 1_000 * seed + spoiling);
                match parse_any("spoilt.toml", &spoilt) {
                    Ok(_) => taken += 1,
                    Err(complaints) => {
                        refused += 1;
                        assert!(!complaints.is_empty(), "{spoilt}");
                    }
                }
            }
        }
        (taken, refused)
    }

    #[test]
    fn spoilt_configurations_are_taken_or_refused_in_words() {
        let (taken, refused) = check_spoilt(0..40);
        assert!(
            taken > 4 && refused > 200,
            "{taken} taken, {refused} refused"
        );
    }

    #[test]
    #[ignore = "slow: 2000 spoilt configurations"]
    fn two_thousand_spoilt_configurations_are_taken_or_refused_in_words() {
        let (taken, refused) = check_spoilt(0..200);
        assert!(
            taken > 20 && refused > 1_000,
            "{taken} taken, {refused} refused"
        );
    }

    #[test]
    fn edges_are_the_ends_of_the_limits() {
        let limits = endat_hdl::config::limits("position_bits", None);
        assert_eq!(edge(20, &limits, |n, step| n.checked_add(step)), 48);
        assert_eq!(edge(20, &limits, |n, step| n.checked_sub(step)), 1);
    }
}
