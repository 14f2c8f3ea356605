//! The file that a campaign, or a part of one, leaves: a line for each class of cases, and in each line what it is a part of.
//!
//! Counts only add up, so parts put together are byte for byte what one run writes.

use endat_console::error::{shown, CommandError};
use endat_sim::campaign::{count, run_shard, Campaign};
use endat_sim::campaign::{Row, Shard, Tally};
use endat_terminal::work::progress;
use std::collections::BTreeMap;
use std::path::Path;

/// What a campaign is: runs with the same one count the same cases.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    /// Its name.
    pub campaign: String,
    /// Version of the program, and a digest of the designs that it runs.
    pub version: String,
    /// What was asked for: which cases, and the seed.
    pub plan: String,
    /// Cases of the whole campaign.
    pub cases: u64,
}

/// A part of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Of what.
    pub identity: Identity,
    /// Which part.
    pub shard: Shard,
    /// What it counted.
    pub tally: Tally,
}

const COLUMNS: [&str; 10] = [
    "campaign", "version", "plan", "cases", "part", "subject", "kind", "place", "class", "count",
];
/// Most parts of a campaign.
pub const PARTS_MAX: u64 = 1_000_000;

impl Part {
    /// Runs a part of a campaign.
    pub fn run(
        name: &str,
        plan: String,
        campaign: &dyn Campaign,
        shard: Shard,
        threads: usize,
    ) -> Self {
        let all = count(campaign);
        let cases = shard.cases(all);
        let cases = cases.end - cases.start;
        let show = progress(cases.max(1) as usize, "cases");
        let tally = run_shard(campaign, shard, threads, |done| show(done as usize));
        Self {
            identity: Identity {
                campaign: name.into(),
                version: format!("{}-{:016x}", env!("CARGO_PKG_VERSION"), campaign.digest()),
                plan,
                cases: all,
            },
            shard,
            tally,
        }
    }

    /// As CSV.
    pub fn to_csv(&self) -> Result<String, CommandError> {
        let mut writer = csv::Writer::from_writer(vec![]);
        let fault = |e: &dyn std::fmt::Display| CommandError::input(format!("CSV: {e}"));
        writer.write_record(COLUMNS).map_err(|e| fault(&e))?;
        let (cases, part) = (self.identity.cases.to_string(), self.shard.to_string());
        let ran = self.shard.cases(self.identity.cases);
        // So a part in which nothing is counted still says what it is.
        let all = Row {
            subject: "all".into(),
            kind: "all".into(),
            place: "all".into(),
            class: "cases".into(),
        };
        let first = std::iter::once((&all, ran.end - ran.start));
        for (row, count) in first.chain(self.tally.rows()) {
            let count = count.to_string();
            let Identity {
                campaign,
                version,
                plan,
                ..
            } = &self.identity;
            let record = [
                campaign,
                version,
                plan,
                &cases,
                &part,
                &row.subject,
                &row.kind,
                &row.place,
                &row.class,
                &count,
            ];
            writer.write_record(record).map_err(|e| fault(&e))?;
        }
        let bytes = writer.into_inner().map_err(|e| fault(&e))?;
        String::from_utf8(bytes).map_err(|e| fault(&e))
    }

    /// Reads one; `name` is what messages call it.
    pub fn from_csv(name: &str, text: &str) -> Result<Self, CommandError> {
        let wrong = |line: usize, what: &str| {
            CommandError::input(format!(
                "{name}:{line}: {what}; give files that campaign --out has written"
            ))
        };
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let columns = reader.headers().map_err(|_| wrong(1, "is no CSV"))?;
        if columns != COLUMNS.as_slice() {
            return Err(wrong(1, "has not the columns of a campaign"));
        }
        let mut part: Option<Self> = None;
        let mut ran = None;
        for (index, record) in reader.records().enumerate() {
            let line = index + 2;
            let record = record.map_err(|_| wrong(line, "has not all columns"))?;
            let number = |column: usize| {
                let value = record[column].parse::<u64>();
                value.map_err(|_| {
                    wrong(
                        line,
                        &format!(
                            "{} = {}: is no number",
                            COLUMNS[column],
                            shown(&record[column])
                        ),
                    )
                })
            };
            let identity = Identity {
                campaign: record[0].to_owned(),
                version: record[1].to_owned(),
                plan: record[2].to_owned(),
                cases: number(3)?,
            };
            let shard = shard(&record[4]).map_err(|e| wrong(line, &e))?;
            let count = number(9)?;
            let part = part.get_or_insert_with(|| Self {
                identity: identity.clone(),
                shard,
                tally: Tally::default(),
            });
            if part.identity != identity || part.shard != shard {
                return Err(wrong(line, "is of another part than the lines above it"));
            }
            if &record[8] == "cases" {
                ran = Some(count);
                continue;
            }
            let row = Row {
                subject: record[5].to_owned(),
                kind: record[6].to_owned(),
                place: record[7].to_owned(),
                class: record[8].to_owned(),
            };
            part.tally.add(row, count);
        }
        let part = part.ok_or_else(|| wrong(2, "is missing: there are no results"))?;
        let cases = part.shard.cases(part.identity.cases);
        match ran == Some(cases.end - cases.start) {
            true => Ok(part),
            false => Err(wrong(2, "has another number of cases than that part")),
        }
    }

    /// Reads a file.
    pub fn read(path: &Path) -> Result<Self, CommandError> {
        let text = std::fs::read_to_string(path).map_err(|e| {
            CommandError::io("read", path, &e, "give a part that --out has written")
        })?;
        Self::from_csv(&path.display().to_string(), &text)
    }

    /// Writes a file: whole, or not at all.
    pub fn write(&self, path: &Path) -> Result<(), CommandError> {
        let text = self.to_csv()?;
        let mut scratch = path.as_os_str().to_owned();
        scratch.push(".tmp");
        let scratch = Path::new(&scratch);
        let written = std::fs::write(scratch, text).and_then(|()| std::fs::rename(scratch, path));
        written.map_err(|e| {
            let _ = std::fs::remove_file(scratch);
            CommandError::io(
                "write",
                path,
                &e,
                "give --out a file in a folder that can be written",
            )
        })
    }
}

/// A part as it is written: `I/N`.
pub fn shard(text: &str) -> Result<Shard, String> {
    let fail = || {
        format!(
            "{}: is no part, 1/1 to {PARTS_MAX}/{PARTS_MAX}; write I/N, for example 3/16",
            shown(text)
        )
    };
    let (index, of) = text.split_once('/').ok_or_else(fail)?;
    let number = |text: &str| match text.chars().all(|c| c.is_ascii_digit()) {
        true => text.parse::<u64>().map_err(|_| fail()),
        false => Err(fail()),
    };
    let (index, of) = (number(index)?, number(of)?);
    match (1..=PARTS_MAX).contains(&of) && (1..=of).contains(&index) {
        true => Ok(Shard { index, of }),
        false => Err(fail()),
    }
}

/// Puts all parts of one campaign together; the names are for messages.
pub fn merge(parts: Vec<(String, Part)>) -> Result<Part, CommandError> {
    let Some((first_name, first)) = parts.first().cloned() else {
        return Err(CommandError::input(
            "merge: there are no parts, at least one is needed; name the files that --out has written",
        ));
    };
    let mut seen: BTreeMap<u64, String> = BTreeMap::new();
    let mut tally = Tally::default();
    for (name, part) in parts {
        let (a, b) = (&first.identity, &part.identity);
        let differs = [
            ("campaign", &a.campaign, &b.campaign),
            ("version", &a.version, &b.version),
            ("plan", &a.plan, &b.plan),
            ("cases", &a.cases.to_string(), &b.cases.to_string()),
            (
                "parts",
                &first.shard.of.to_string(),
                &part.shard.of.to_string(),
            ),
        ]
        .into_iter()
        .find(|(_, a, b)| a != b)
        .map(|(what, a, b)| (what, a.clone(), b.clone()));
        if let Some((what, a, b)) = differs {
            return Err(CommandError::input(format!(
                "{name}: {what} = {b}: is not of the same campaign as {first_name}, which has {a}; merge parts of one run"
            )));
        }
        if let Some(other) = seen.insert(part.shard.index, name.clone()) {
            return Err(CommandError::input(format!(
                "{name}: part = {}: is in {other} already, each may be there once; leave one of them out",
                part.shard
            )));
        }
        tally.merge(part.tally);
    }
    let missing: Vec<String> = (1..=first.shard.of)
        .filter(|index| !seen.contains_key(index))
        .take(8)
        .map(|index| format!("{index}/{}", first.shard.of))
        .collect();
    if !missing.is_empty() {
        return Err(CommandError::input(format!(
            "merge: {} of {} parts: not there: {}; run them alone, with --shard",
            seen.len(),
            first.shard.of,
            missing.join(", ")
        )));
    }
    Ok(Part {
        identity: first.identity,
        shard: Shard::WHOLE,
        tally,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(index: u64, of: u64) -> Part {
        let mut tally = Tally::default();
        let row = |class: &str| Row {
            subject: "port".into(),
            kind: "position".into(),
            place: "delay.pulses".into(),
            class: class.into(),
        };
        tally.add(row("masked"), 10 + index);
        if index.is_multiple_of(2) {
            tally.add(row("hang"), 1);
        }
        Part {
            identity: Identity {
                campaign: "upsets".into(),
                version: "0.1.0".into(),
                plan: "seed 1".into(),
                cases: 100,
            },
            shard: Shard { index, of },
            tally,
        }
    }

    fn named(parts: Vec<Part>) -> Vec<(String, Part)> {
        let name = |(i, part)| (format!("{i}.csv"), part);
        parts.into_iter().enumerate().map(name).collect()
    }

    fn refused(parts: Vec<Part>) -> String {
        merge(named(parts)).unwrap_err().to_string()
    }

    #[test]
    fn parts_are_read_as_they_were_written_and_add_up_in_any_order() {
        let parts = [part(1, 3), part(2, 3), part(3, 3)];
        for part in &parts {
            let text = part.to_csv().unwrap();
            assert_eq!(&Part::from_csv("a.csv", &text).unwrap(), part);
        }
        let [a, b, c] = parts;
        let one = merge(named(vec![a.clone(), b.clone(), c.clone()])).unwrap();
        let other = merge(named(vec![c, a, b])).unwrap();
        assert_eq!(one.to_csv().unwrap(), other.to_csv().unwrap());
        assert_eq!(one.tally.count(|r| r.class == "masked"), 36);
    }

    #[test]
    fn parts_that_do_not_belong_together_are_refused_with_the_reason() {
        let change = |change: &dyn Fn(&mut Part)| {
            let mut other = part(2, 2);
            change(&mut other);
            refused(vec![part(1, 2), other])
        };
        for (text, wanted) in [
            (change(&|p| p.identity.campaign = "faults".into()), "1.csv: campaign = faults: is not of the same campaign as 0.csv, which has upsets; merge parts of one run"),
            (change(&|p| p.identity.plan = "seed 2".into()), "1.csv: plan = seed 2: is not of"),
            (change(&|p| p.identity.version = "0.2.0".into()), "1.csv: version = 0.2.0: is not of"),
            (change(&|p| p.identity.cases = 7), "1.csv: cases = 7: is not of"),
            (change(&|p| p.shard = Shard { index: 2, of: 3 }), "1.csv: parts = 3: is not of"),
            (change(&|p| p.shard.index = 1), "1.csv: part = 1/2: is in 0.csv already, each may be there once; leave one of them out"),
            (refused(vec![part(1, 3), part(3, 3)]), "merge: 2 of 3 parts: not there: 2/3; run them alone, with --shard"),
            (refused(vec![]), "merge: there are no parts"),
        ] {
            assert!(text.starts_with(wanted), "{text}");
        }
    }

    #[test]
    fn a_file_that_is_no_part_is_named_with_its_line() {
        let good = part(1, 1).to_csv().unwrap();
        let lines: Vec<&str> = good.lines().collect();
        for (text, wanted) in [
            ("a,b\n1,2\n".to_owned(), "a.csv:1: has not the columns"),
            (lines[..1].join("\n"), "a.csv:2: is missing"),
            (good.replace("1/1", "2/1"), "a.csv:2: 2/1: is no part"),
            (
                good.replace(",cases,100", ",cases,99"),
                "a.csv:2: has another number",
            ),
            (
                good.replace("masked,11", "masked,x"),
                "a.csv:3: count = x: is no number",
            ),
        ] {
            let message = Part::from_csv("a.csv", &text).unwrap_err().to_string();
            assert!(message.starts_with(wanted), "{message}");
        }
    }
}
