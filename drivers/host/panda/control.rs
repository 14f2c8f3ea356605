//! The control port: queries of blocks and fields, arming.

use super::data::clean;
use super::Column;
use std::collections::BTreeMap;

/// Action requested by a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// Begin an acquisition.
    Arm,
    /// End it.
    Disarm,
}

/// State of the server for answers.
pub struct State<'a> {
    /// Program and version.
    pub software: &'a str,
    /// Name of the card.
    pub card: &'a str,
    /// Columns of the data.
    pub columns: &'a [Column],
    /// Latest raw number of each column, if there has been a row.
    pub latest: Option<&'a [i64]>,
    /// An acquisition is under way.
    pub is_armed: bool,
    /// End reason of the last acquisition.
    pub completion: &'a str,
    /// Rows of the last or present acquisition.
    pub captured: u64,
}

fn value(text: impl std::fmt::Display) -> String {
    format!("OK ={text}\n")
}

fn lines(lines: impl Iterator<Item = String>) -> String {
    lines.map(|l| format!("!{l}\n")).collect::<String>() + ".\n"
}

const OK: &str = "OK\n";
/// Type of a number with scale, offset and unit.
const POSITION: &str = "pos_out";

/// The answer to a line, and the requested action. Unknown queries get `ERR`.
pub fn answer(line: &str, state: &State<'_>) -> (String, Option<Wish>) {
    let line = line.trim_end_matches('\r');
    match line {
        "*PCAP.ARM=" => return (OK.into(), Some(Wish::Arm)),
        "*PCAP.DISARM=" => return (OK.into(), Some(Wish::Disarm)),
        _ => {}
    }
    let text = match line.strip_suffix('?') {
        Some(name) => query(name, state),
        // The card has no tables and no settings of other blocks.
        None => Err("No such field, or it cannot be written"),
    };
    let text = text.unwrap_or_else(|why| format!("ERR {why}: {}\n", clean(line)));
    (text, None)
}

/// All values of `*CHANGES`, with group, name and value.
fn values(state: &State<'_>) -> Vec<(&'static str, String, String)> {
    let mut all = Vec::new();
    for (block, count) in blocks(state.columns) {
        for n in 1..=count {
            let label = describe(block).unwrap_or_default();
            let name = format!("*METADATA.LABEL_{block}{n}");
            all.push(("METADATA", name, label.to_owned()));
        }
    }
    for (index, column) in state.columns.iter().enumerate() {
        let mut attribute = |name: &str, value: String| {
            all.push(("ATTR", format!("{}.{name}", column.name), value));
        };
        attribute("CAPTURE", "Value".into());
        let field = column.name.rsplit('.').next().unwrap_or_default();
        // Fields with a type of their own have no scale.
        if kind(field) == POSITION {
            attribute("OFFSET", "0".into());
            attribute("SCALE", column.scale.to_string());
            attribute("UNITS", column.unit.to_owned());
            let raw = state.latest.map_or(0, |latest| latest[index]);
            all.push(("POSN", column.name.clone(), raw.to_string()));
        }
    }
    all
}

/// Values reported to a connection.
pub type Seen = BTreeMap<String, String>;

/// The answer to `*CHANGES?` and `*CHANGES.GROUP?`: the changes since the last query of this connection, at first everything. With `=` instead
/// of `?` all values count as reported, with `=E` none. `None` for any other line.
pub fn changes(line: &str, state: &State<'_>, seen: &mut Seen) -> Option<String> {
    let rest = line.trim_end_matches('\r').strip_prefix("*CHANGES")?;
    let at = rest.find(['?', '='])?;
    let (group, action) = rest.split_at(at);
    let group = group.strip_prefix('.').unwrap_or(group);
    let is_known = [
        "", "CONFIG", "BITS", "POSN", "READ", "ATTR", "TABLE", "METADATA",
    ];
    if !is_known.contains(&group) {
        return Some(format!("ERR No such group: {}\n", clean(line)));
    }
    let all = values(state).into_iter();
    let meant = all.filter(|(of, ..)| group.is_empty() || *of == group);
    let mut news = Vec::new();
    for (_, name, value) in meant {
        match action {
            "=E" => drop(seen.remove(&name)),
            _ => {
                if seen.get(&name) != Some(&value) {
                    news.push(format!("{name}={value}"));
                    seen.insert(name, value);
                }
            }
        }
    }
    Some(match action {
        "?" => lines(news.into_iter()),
        "=" | "=S" | "=E" => OK.into(),
        _ => format!("ERR Write =, =S or =E: {}\n", clean(line)),
    })
}

/// Blocks: name and number.
fn blocks(columns: &[Column]) -> Vec<(&str, usize)> {
    let encoders = columns.iter().filter(|c| c.name.ends_with(".VAL")).count();
    vec![("INENC", encoders), ("PCAP", 1), ("TRIGGER", 1)]
}

fn describe(block: &str) -> Option<&'static str> {
    Some(match block {
        "INENC" => "EnDat encoder",
        "PCAP" => "Position capture",
        "TRIGGER" => "Trigger of the card",
        _ => return None,
    })
}

/// `INENC1` and `INENC` are the same block.
fn stem(block: &str) -> &str {
    block.trim_end_matches(|c: char| c.is_ascii_digit())
}

/// Fields of a block, from its first copy.
fn fields<'a>(
    columns: &'a [Column],
    block: &'a str,
) -> impl Iterator<Item = (&'a Column, &'a str)> {
    columns.iter().filter_map(move |c| {
        let (owner, field) = c.name.split_once('.')?;
        let is_first = stem(owner) == block && (owner == block || owner.ends_with('1'));
        is_first.then_some((c, field))
    })
}

fn query(name: &str, state: &State<'_>) -> Result<String, &'static str> {
    let columns = state.columns;
    let names = || columns.iter().map(|c| format!("{} Value", c.name));
    if let Some(text) = name.strip_prefix("*ECHO ") {
        return Ok(value(clean(text)));
    }
    if let Some(place) = name.strip_prefix("*DESC.") {
        let found = match place.split_once('.') {
            None => describe(stem(place)),
            Some((block, field)) => {
                let mut all = fields(columns, stem(block));
                all.find(|(_, f)| *f == field).map(|(c, _)| c.meaning)
            }
        };
        return found.map(value).ok_or("No such block or field");
    }
    if let Some(place) = name.strip_prefix("*ENUMS.") {
        return match place.ends_with(".CAPTURE") {
            true => Ok(lines(["No", "Value"].into_iter().map(String::from))),
            false => Err("No such enumeration"),
        };
    }
    if let Some(rest) = name.strip_prefix("*METADATA") {
        let all = values(state).into_iter().filter(|v| v.0 == "METADATA");
        let mut all = all.filter_map(|v| Some((v.1.split_once('.')?.1.to_owned(), v.2)));
        return match rest.strip_prefix('.') {
            None | Some("*") => Ok(lines(all.map(|(key, _)| key))),
            Some(key) => {
                let found = all.find(|(k, _)| k == key);
                found.map(|(_, text)| value(text)).ok_or("No such metadata")
            }
        };
    }
    match name {
        "*IDN" => Ok(value(format_args!(
            "PandA SW: {} FPGA: {} rootfs: none",
            state.software, state.card
        ))),
        "*BLOCKS" => Ok(lines(
            blocks(columns)
                .into_iter()
                .map(|(name, n)| format!("{name} {n}")),
        )),
        "*CAPTURE" | "*CAPTURE.*" | "*POSITIONS" => Ok(lines(names())),
        "*CAPTURE.OPTIONS" => Ok(lines(["Value".to_owned()].into_iter())),
        "*CAPTURE.ENUMS" => Ok(lines(["No", "Value"].into_iter().map(String::from))),
        "*BITS" => Ok(lines(std::iter::empty())),
        "*PCAP.STATUS" => Ok(value(if state.is_armed {
            "Busy 1 0"
        } else {
            "Idle 0 0"
        })),
        "*PCAP.CAPTURED" => Ok(value(state.captured)),
        "*PCAP.COMPLETION" => Ok(value(if state.is_armed {
            "Busy"
        } else {
            state.completion
        })),
        "PCAP.ACTIVE" => Ok(value(u8::from(state.is_armed))),
        _ => field(name, state),
    }
}

fn field(name: &str, state: &State<'_>) -> Result<String, &'static str> {
    let columns = state.columns;
    let Some((block, rest)) = name.split_once('.') else {
        return Err("No such block or field");
    };
    if rest == "*" {
        let all: Vec<String> = fields(columns, stem(block))
            .enumerate()
            .map(|(n, (_, field))| format!("{field} {n} {}", kind(field)))
            .collect();
        return match all.is_empty() {
            true => Err("No such block"),
            false => Ok(lines(all.into_iter())),
        };
    }
    let (field, attribute) = rest.split_once('.').unwrap_or((rest, ""));
    let place = columns
        .iter()
        .position(|c| c.name == format!("{block}.{field}"));
    // Attributes can be queried with the block name without a number, too.
    let of_block = || {
        fields(columns, stem(block))
            .find(|(_, f)| *f == field)
            .map(|(c, _)| c)
    };
    let column = place
        .map(|p| &columns[p])
        .or_else(of_block)
        .ok_or("No such block or field")?;
    Ok(match attribute {
        "" => value(place.and_then(|p| state.latest.map(|l| l[p])).unwrap_or(0)),
        "SCALED" => {
            let raw = place.and_then(|p| state.latest.map(|l| l[p])).unwrap_or(0);
            value(raw as f64 * column.scale)
        }
        "CAPTURE" => value("Value"),
        "SCALE" => value(column.scale),
        "OFFSET" => value(0),
        "UNITS" => value(column.unit),
        "INFO" => value(kind(field)),
        _ => return Err("No such attribute"),
    })
}

/// Type of a field in the protocol.
fn kind(field: &str) -> &'static str {
    match field {
        "TS_TRIG" => "ext_out timestamp",
        _ => POSITION,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Scale;

    fn columns() -> Vec<Column> {
        let scales = [Scale::singleturn(29), Scale::Linear { step_nm: 10.0 }];
        Column::all(100_000_000, &scales, false)
    }

    /// Catches a server that reports nothing, on which the EPICS driver fails, or repeats unchanged values.
    #[test]
    fn changes_are_everything_at_first_and_then_what_is_new() {
        let columns = columns();
        let mut latest = [1, 2, 1 << 28, 1, 0, 500, 0, 4];
        let mut seen = Seen::new();
        let mut ask = |line: &str, latest: &[i64]| {
            let state = State {
                software: "",
                card: "",
                columns: &columns,
                latest: Some(latest),
                is_armed: false,
                completion: "Ok",
                captured: 0,
            };
            changes(line, &state, &mut seen)
        };
        let first = ask("*CHANGES?", &latest).unwrap();
        for line in [
            "!*METADATA.LABEL_INENC2=EnDat encoder",
            "!*METADATA.LABEL_PCAP1=Position capture",
            "!PCAP.TS_TRIG.CAPTURE=Value",
            "!INENC1.VAL=268435456",
            "!INENC2.VAL.UNITS=mm",
            "!INENC1.CAUSE.SCALE=1",
        ] {
            assert!(first.contains(&format!("{line}\n")), "{line}: {first}");
        }
        assert_eq!(ask("*CHANGES?", &latest).unwrap(), ".\n");
        latest[2] += 1;
        assert_eq!(ask("*CHANGES.ATTR?", &latest).unwrap(), ".\n");
        let news = ask("*CHANGES.POSN?\r", &latest).unwrap();
        assert_eq!(news, "!INENC1.VAL=268435457\n.\n");
        assert_eq!(ask("*CHANGES.TABLE=E", &latest).unwrap(), "OK\n");
        assert_eq!(ask("*CHANGES=E", &latest).unwrap(), "OK\n");
        assert!(ask("*CHANGES?", &latest).unwrap().len() > 100);
        assert!(ask("*CHANGES.NO?", &latest).unwrap().starts_with("ERR "));
        assert_eq!(ask("*IDN?", &latest), None);
    }

    fn ask(line: &str) -> (String, Option<Wish>) {
        let columns = columns();
        let state = State {
            software: "0.1.0",
            card: "cff72a77",
            columns: &columns,
            latest: Some(&[1, 2, 1 << 28, 1, 0, 500, 0, 4]),
            is_armed: false,
            completion: "Ok",
            captured: 12,
        };
        answer(line, &state)
    }

    #[test]
    fn questions_of_clients_have_answers() {
        for (line, expected) in [
            ("*IDN?", "OK =PandA SW: 0.1.0 FPGA: cff72a77 rootfs: none\n"),
            ("*BLOCKS?", "!INENC 2\n!PCAP 1\n!TRIGGER 1\n.\n"),
            ("*DESC.INENC?", "OK =EnDat encoder\n"),
            ("*DESC.INENC.VAL?", "OK =Last good position\n"),
            (
                "INENC.*?",
                "!VAL 0 pos_out\n!FRESH 1 pos_out\n!CAUSE 2 pos_out\n.\n",
            ),
            ("PCAP.*?", "!TS_TRIG 0 ext_out timestamp\n.\n"),
            ("INENC1.VAL?", "OK =268435456\n"),
            ("INENC1.VAL.SCALED?", "OK =180\n"),
            ("INENC2.VAL.UNITS?", "OK =mm\n"),
            ("*PCAP.STATUS?", "OK =Idle 0 0\n"),
            ("INENC2.CAUSE?", "OK =4\n"),
            ("*ECHO hello?", "OK =hello\n"),
            (
                "*METADATA.*?",
                "!LABEL_INENC1\n!LABEL_INENC2\n!LABEL_PCAP1\n!LABEL_TRIGGER1\n.\n",
            ),
            ("*METADATA.LABEL_PCAP1?", "OK =Position capture\n"),
        ] {
            assert_eq!(ask(line), (expected.to_owned(), None), "{line}");
        }
        assert_eq!(ask("*PCAP.ARM="), ("OK\n".into(), Some(Wish::Arm)));
        assert_eq!(ask("*PCAP.DISARM="), ("OK\n".into(), Some(Wish::Disarm)));
    }

    #[test]
    fn what_is_unknown_is_an_error_and_nothing_more() {
        for line in [
            "",
            "x",
            "?",
            "INENC1.NOTHING?",
            "INENC9.VAL.X?",
            "*DESC.?",
            "*METADATA.NO?",
            "TTLOUT1.VAL=ZERO",
            "\u{7}\u{1b}[2J?",
        ] {
            let (text, wish) = ask(line);
            assert!(
                text.starts_with("ERR ") && text.ends_with('\n'),
                "{line:?}: {text:?}"
            );
            assert_eq!(wish, None);
            assert!(!text.contains('\u{1b}'));
        }
    }
}
