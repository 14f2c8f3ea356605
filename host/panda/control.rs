//! The control port: questions about blocks and fields, arming.

use super::data::clean;
use super::Column;

/// What a command wants of the server.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// Begin an acquisition.
    Arm,
    /// End it.
    Disarm,
}

/// What the server knows when it answers.
pub struct State<'a> {
    /// Program and version.
    pub software: &'a str,
    /// Which card.
    pub card: &'a str,
    /// Columns of the data.
    pub columns: &'a [Column],
    /// Latest raw number of each column, if there has been a row.
    pub latest: Option<&'a [i64]>,
    /// An acquisition is under way.
    pub is_armed: bool,
    /// How the last one ended.
    pub completion: &'a str,
    /// Rows of the last one, or of the one under way.
    pub captured: u64,
}

fn value(text: impl std::fmt::Display) -> String {
    format!("OK ={text}\n")
}

fn lines(lines: impl Iterator<Item = String>) -> String {
    lines.map(|l| format!("!{l}\n")).collect::<String>() + ".\n"
}

const OK: &str = "OK\n";

/// The answer to a line, and what is to be done. Unknown questions get `ERR`.
pub fn answer(line: &str, state: &State<'_>) -> (String, Option<Wish>) {
    let line = line.trim_end_matches('\r');
    match line {
        "*PCAP.ARM=" => return (OK.into(), Some(Wish::Arm)),
        "*PCAP.DISARM=" => return (OK.into(), Some(Wish::Disarm)),
        _ => {}
    }
    let text = match line.strip_suffix('?') {
        Some(name) => query(name, state),
        // Tables and settings of other blocks do not exist here.
        None => Err("No such field, or it cannot be written"),
    };
    let text = text.unwrap_or_else(|why| format!("ERR {why}: {}\n", clean(line)));
    (text, None)
}

/// Blocks: name and how many.
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

/// Fields of a block: those of its first copy.
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
    if name.starts_with("*CHANGES") || name.starts_with("*METADATA") {
        return Ok(lines(std::iter::empty()));
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
    // Attributes are asked of the block without a number, too.
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

/// Type of a field, as the clients know them.
fn kind(field: &str) -> &'static str {
    match field {
        "TS_TRIG" => "ext_out timestamp",
        _ => "pos_out",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Scale;

    fn ask(line: &str) -> (String, Option<Wish>) {
        let columns = Column::all(
            100_000_000,
            &[Scale::singleturn(29), Scale::Linear { step_nm: 10.0 }],
        );
        let state = State {
            software: "0.1.0",
            card: "cff72a77",
            columns: &columns,
            latest: Some(&[1, 2, 1 << 28, 1, 500, 0]),
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
            ("INENC.*?", "!VAL 0 pos_out\n!FRESH 1 pos_out\n.\n"),
            ("PCAP.*?", "!TS_TRIG 0 ext_out timestamp\n.\n"),
            ("INENC1.VAL?", "OK =268435456\n"),
            ("INENC1.VAL.SCALED?", "OK =180\n"),
            ("INENC2.VAL.UNITS?", "OK =mm\n"),
            ("*PCAP.STATUS?", "OK =Idle 0 0\n"),
            ("*CHANGES?", ".\n"),
            ("*ECHO hello?", "OK =hello\n"),
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
