//! Rows of CSV and of JSON lines.

use super::super::layout::{of_channel, DerivedColumn, INFOS};
use super::super::sheet::ABOUT;
use super::{known_cause, Cell, Head, Parsed, Take, Wrong};
use endat_console::error::shown;
use serde_json::Value;
use std::io::{BufRead, Read};

/// Nothing longer is a line of a recording.
const LINE_BYTES: u64 = 1 << 20;

/// Lines with their numbers. The last one is left out if it does not end: it may be cut off anywhere.
struct Lines<R> {
    from: R,
    line: u64,
    buffer: Vec<u8>,
    is_cut: bool,
}

impl<R: BufRead> Lines<R> {
    fn next(&mut self) -> Result<Option<(u64, &str)>, Wrong> {
        self.buffer.clear();
        self.line += 1;
        let mut limited = (&mut self.from).take(LINE_BYTES);
        let count = limited.read_until(b'\n', &mut self.buffer);
        let count = count.map_err(|e| Wrong::at(self.line, format!("cannot read: {e}")))?;
        if count == 0 {
            return Ok(None);
        }
        if self.buffer.last() != Some(&b'\n') {
            if count as u64 == LINE_BYTES {
                return Err(Wrong::at(
                    self.line,
                    foreign("the line has more than a megabyte"),
                ));
            }
            self.is_cut = true;
            return Ok(None);
        }
        let text = std::str::from_utf8(&self.buffer);
        let text = text.map_err(|_| Wrong::at(self.line, foreign("is no text")))?;
        Ok(Some((self.line, text.trim_end_matches(['\r', '\n']))))
    }
}

fn foreign(why: &str) -> String {
    format!("{why}: this is no recording; give a file of `log` or of the live page")
}

/// Reads a file; what it says before its rows.
pub(super) fn read(
    from: impl BufRead,
    take: Take<'_>,
    notes: &mut Vec<String>,
) -> Result<Head, Wrong> {
    let mut lines = Lines {
        from,
        line: 0,
        buffer: Vec::new(),
        is_cut: false,
    };
    let mut head = Head::default();
    let mut columns = None;
    let mut is_json = false;
    let mut row = Parsed::default();
    while let Some((line, text)) = lines.next()? {
        // A mark of some editors, an empty line at the end.
        let text = text.trim_start_matches('\u{feff}');
        let is_nothing = |c: char| c.is_whitespace() || SEPARATORS.contains(&c);
        if text.chars().all(is_nothing) {
            continue;
        }
        if columns.is_none() && is_separator(text) {
            continue;
        }
        // A spreadsheet puts into quotes what has some.
        let begin = text.trim_start_matches('"');
        if let Some(about) = begin.strip_prefix('#').filter(|_| columns.is_none()) {
            // Comments of others say nothing.
            head.about = serde_json::from_str(about.trim()).unwrap_or(head.about);
            continue;
        }
        if text.starts_with('{') && columns.is_none() {
            is_json = true;
        }
        if is_json {
            json_line(line, text, &mut head, take)?;
            continue;
        }
        match &columns {
            None => columns = Some(Columns::of(line, text, &mut head)?),
            Some(columns) => {
                columns.row(line, text, &mut row)?;
                take(&head, &mut row)?;
            }
        }
    }
    if lines.is_cut {
        notes.push(format!(
            ":{}: the last line does not end: it is cut off, and left out",
            lines.line
        ));
    }
    if columns.is_none() && !is_json {
        return Err(Wrong::at(
            lines.line,
            foreign("there is no whole line with names of columns"),
        ));
    }
    Ok(head)
}

/// Where the columns of a channel are.
struct ChannelColumns {
    raw: usize,
    value: usize,
    turns: usize,
    fresh: usize,
    cause: usize,
}

/// Where columns are.
struct Columns {
    /// Between two fields; where that is no comma, one may be in a number.
    separator: char,
    names: Vec<String>,
    trigger: usize,
    time_s: usize,
    missing: usize,
    channels: Vec<ChannelColumns>,
    derived: Vec<usize>,
}

/// What may be between two fields: spreadsheets take another one where the comma is in numbers.
const SEPARATORS: [char; 3] = [',', ';', '\t'];

fn fields(text: &str, separator: char) -> impl Iterator<Item = &str> {
    // No field of a recording has a separator in it; other programs may have put some into quotes.
    let all = text.split(separator);
    all.map(|field| field.trim().trim_matches('"'))
}

/// The line before the head by which some spreadsheets know the separator.
fn is_separator(text: &str) -> bool {
    let begin = text.trim_start_matches('"').get(..4);
    begin.is_some_and(|begin| begin.eq_ignore_ascii_case("sep="))
}

/// The separator of a head line.
fn separator_of(text: &str) -> char {
    let is_it = |separator: &char| fields(text, *separator).any(|name| name == "trigger");
    SEPARATORS.into_iter().find(is_it).unwrap_or(SEPARATORS[0])
}

impl Columns {
    fn of(line: u64, text: &str, head: &mut Head) -> Result<Self, Wrong> {
        let separator = separator_of(text);
        let names: Vec<String> = fields(text, separator).map(str::to_owned).collect();
        let find = |name: &str| {
            let place = names.iter().position(|n| n == name);
            let why = || Wrong::at(line, foreign(&format!("there is no column {name}")));
            place.ok_or_else(why)
        };
        let (trigger, time_s, missing) = (find("trigger")?, find("time_s")?, find("missing")?);
        let mut known = vec![trigger, time_s, missing];
        let mut channels = Vec::new();
        for n in 0.. {
            let of = |what: &str| find(&of_channel(n, what));
            let raw = match of("raw") {
                Ok(raw) => raw,
                Err(_) if n > 0 => break,
                Err(none) => return Err(none),
            };
            let (turns, fresh, cause) = (of("turns")?, of("fresh")?, of("cause")?);
            // The value has its unit in its name.
            let value = raw + 1;
            let prefix = of_channel(n, "");
            let unit = names.get(value).and_then(|name| name.strip_prefix(&prefix));
            let unit = unit.filter(|_| value != turns).ok_or_else(|| {
                Wrong::at(
                    line,
                    foreign(&format!("there is no value behind column {prefix}raw")),
                )
            })?;
            head.units.push(unit.to_owned());
            known.extend([raw, value, turns, fresh, cause]);
            known.extend(INFOS.iter().filter_map(|name| of(name).ok()));
            channels.push(ChannelColumns {
                raw,
                value,
                turns,
                fresh,
                cause,
            });
        }
        let derived: Vec<usize> = (0..names.len()).filter(|n| !known.contains(n)).collect();
        for n in &derived {
            let unit = head.about["columns"][&names[*n]]["unit"].as_str();
            let column = DerivedColumn {
                name: names[*n].clone(),
                unit: unit.unwrap_or_default().to_owned(),
                digits: None,
            };
            head.derived.push(column);
        }
        Ok(Self {
            separator,
            names,
            trigger,
            time_s,
            missing,
            channels,
            derived,
        })
    }

    fn row(&self, line: u64, text: &str, row: &mut Parsed) -> Result<(), Wrong> {
        let mut all: Vec<&str> = Vec::with_capacity(self.names.len());
        all.extend(fields(text, self.separator));
        if all.len() != self.names.len() {
            let text = format!(
                "has {} fields, the head line {}; delete the line if it is damaged",
                all.len(),
                self.names.len()
            );
            return Err(Wrong::at(line, text));
        }
        let wrong = |n: usize| {
            let (name, text) = (&self.names[n], shown(all[n]));
            Wrong::at(
                line,
                format!("{name} = {text}: is no number; delete the line if it is damaged"),
            )
        };
        let whole = |n: usize| match all[n] {
            "" => Ok(None),
            text => text.parse::<u64>().map(Some).map_err(|_| wrong(n)),
        };
        let number = |n: usize| {
            let text = all[n];
            let parsed = match self.separator != ',' && text.contains(',') {
                true => text.replacen(',', ".", 1).parse::<f64>(),
                false if text.is_empty() => return Ok(None),
                false => text.parse::<f64>(),
            };
            match parsed {
                Ok(x) if x.is_finite() => Ok(Some(x)),
                _ => Err(wrong(n)),
            }
        };
        let needed = |n: usize| wrong(n);
        row.cells.clear();
        for (n, at) in self.channels.iter().enumerate() {
            row.cells.push(Cell {
                raw: whole(at.raw)?,
                value: number(at.value)?,
                turns: whole(at.turns)?,
                fresh: match all[at.fresh] {
                    "1" => true,
                    "0" => false,
                    _ => return Err(wrong(at.fresh)),
                },
                cause: known_cause(line, n, all[at.cause])?,
            });
        }
        row.line = line;
        row.trigger = whole(self.trigger)?;
        row.time_s = number(self.time_s)?.ok_or_else(|| needed(self.time_s))?;
        row.missing = whole(self.missing)?.ok_or_else(|| needed(self.missing))?;
        row.derived.clear();
        for n in &self.derived {
            row.derived.push(number(*n)?);
        }
        Ok(())
    }
}

/// A line of JSON: what the recording is of, or a row.
fn json_line(line: u64, text: &str, head: &mut Head, take: Take<'_>) -> Result<(), Wrong> {
    let wrong = |text: String| Wrong::at(line, text);
    let object: Value = serde_json::from_str(text)
        .map_err(|e| wrong(format!("is no JSON: {e}; delete the line if it is damaged")))?;
    if !object[ABOUT].is_null() {
        head.about = object[ABOUT].clone();
        return Ok(());
    }
    let lacks = |name: &str| wrong(foreign(&format!("there is no {name}")));
    let channels = object["channels"]
        .as_array()
        .ok_or_else(|| lacks("channels"))?;
    let derived = object["derived"].as_object();
    let is_first = head.units.is_empty();
    if is_first {
        let unit = |c: &Value| c["unit"].as_str().map(str::to_owned);
        let units: Option<Vec<String>> = channels.iter().map(unit).collect();
        head.units = units
            .filter(|u| !u.is_empty())
            .ok_or_else(|| lacks("unit"))?;
        for name in derived.into_iter().flat_map(|d| d.keys()) {
            let unit = head.about["columns"][name]["unit"].as_str();
            head.derived.push(DerivedColumn {
                name: name.clone(),
                unit: unit.unwrap_or_default().to_owned(),
                digits: None,
            });
        }
    }
    if channels.len() != head.units.len() {
        return Err(wrong(
            "has another number of channels than the rows before it".into(),
        ));
    }
    let cells = channels.iter().enumerate().map(|(n, c)| {
        Ok(Cell {
            raw: c["raw"].as_u64(),
            value: c["value"].as_f64(),
            turns: c["turns"].as_u64(),
            fresh: c["fresh"].as_bool().ok_or_else(|| lacks("fresh"))?,
            cause: known_cause(line, n, c["cause"].as_str().ok_or_else(|| lacks("cause"))?)?,
        })
    });
    let mut row = Parsed {
        line,
        trigger: object["trigger"].as_u64(),
        time_s: object["time_s"].as_f64().ok_or_else(|| lacks("time_s"))?,
        missing: object["missing"].as_u64().ok_or_else(|| lacks("missing"))?,
        cells: cells.collect::<Result<_, Wrong>>()?,
        derived: (head.derived.iter())
            .map(|one| derived.and_then(|d| d.get(&one.name)?.as_f64()))
            .collect(),
    };
    take(head, &mut row)
}
