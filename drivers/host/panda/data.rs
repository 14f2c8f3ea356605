//! The data port: header, frames of samples, end.

use super::Column;
use crate::feed::Row;
use humantime::format_rfc3339_nanos;
use std::time::SystemTime;

/// Data format requested by a client.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Form {
    /// Binary frames with their length; otherwise lines of text.
    pub is_framed: bool,
    /// 64-bit floating point, scaled; otherwise integers that the client scales.
    pub is_scaled: bool,
    /// A header comes first.
    pub has_header: bool,
    /// The header is XML.
    pub is_xml: bool,
}

/// The answer to the first line of a client.
pub fn form(line: &str) -> Result<Form, String> {
    let mut form = Form {
        is_framed: false,
        is_scaled: true,
        has_header: true,
        is_xml: false,
    };
    for word in line.split_whitespace() {
        match word {
            "XML" => form.is_xml = true,
            "FRAMED" => form.is_framed = true,
            "ASCII" => form.is_framed = false,
            "SCALED" | "DEFAULT" => form.is_scaled = true,
            "RAW" | "UNSCALED" => form.is_scaled = false,
            "NO_HEADER" | "BARE" => form.has_header = false,
            "NO_STATUS" | "ONE_SHOT" => {}
            _ => return Err(format!("ERR Invalid option {}", clean(word))),
        }
    }
    Ok(form)
}

/// A word that is safe to return to the client.
pub fn clean(word: &str) -> String {
    let graphic = word.chars().filter(char::is_ascii_graphic);
    graphic.take(40).collect()
}

/// Time of arming, and of the first row if there is one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Times {
    /// Armed.
    pub arm: SystemTime,
    /// First row.
    pub start: Option<SystemTime>,
}

impl Times {
    /// Names and times in the format of the protocol.
    fn told(self) -> Vec<(&'static str, String)> {
        let start = self.start.map(|time| ("start_time", time));
        let all = std::iter::once(("arm_time", self.arm)).chain(start);
        all.map(|(name, time)| (name, format_rfc3339_nanos(time).to_string()))
            .collect()
    }
}

/// Header of an acquisition.
pub fn header(form: Form, columns: &[Column], times: Times) -> String {
    if !form.has_header {
        return String::new();
    }
    let process = if form.is_scaled { "Scaled" } else { "Raw" };
    let kind = if form.is_scaled { "double" } else { "int64" };
    let format = if form.is_framed { "Framed" } else { "ASCII" };
    let bytes = 8 * columns.len();
    if !form.is_xml {
        let fields = columns.iter().map(|c| {
            format!(
                " {} {kind} Value Scale: {} Offset: 0 Units: {}\n",
                c.name, c.scale, c.unit
            )
        });
        let fields: String = fields.collect();
        let times = times.told().into_iter();
        let times: String = times
            .map(|(name, time)| format!("{name}: {time}\n"))
            .collect();
        return format!(
            "{times}missed: 0\nprocess: {process}\nformat: {format}\nfields:\n{fields}\n"
        );
    }
    let fields = columns.iter().map(|c| {
        format!(
            "<field name=\"{}\" type=\"{kind}\" capture=\"Value\" scale=\"{:e}\" offset=\"0\" units=\"{}\" />\n",
            c.name, c.scale, c.unit
        )
    });
    let fields: String = fields.collect();
    let times = times.told().into_iter();
    let times: String = times
        .map(|(name, time)| format!("{name}=\"{time}\" "))
        .collect();
    format!(
        "<header>\n<data {times}missed=\"0\" process=\"{process}\" format=\"{format}\" sample_bytes=\"{bytes}\" />\n<fields>\n{fields}</fields>\n</header>\n\n"
    )
}

/// Rows in the requested format.
pub fn rows(form: Form, columns: &[Column], rows: &[Row]) -> Vec<u8> {
    if !form.is_framed {
        let line = |row: &Row| {
            let numbers = columns.iter().map(|c| match form.is_scaled {
                true => format!(" {}", c.raw(row) as f64 * c.scale),
                false => format!(" {}", c.raw(row)),
            });
            numbers.collect::<String>() + "\n"
        };
        return rows.iter().map(line).collect::<String>().into_bytes();
    }
    let mut bytes = b"BIN ".to_vec();
    let length = 8 + rows.len() * 8 * columns.len();
    bytes.extend((length as u32).to_le_bytes());
    for row in rows {
        for column in columns {
            let raw = column.raw(row);
            bytes.extend(match form.is_scaled {
                true => (raw as f64 * column.scale).to_le_bytes(),
                false => raw.to_le_bytes(),
            });
        }
    }
    bytes
}

/// The last line of an acquisition.
pub fn end(samples: u64, reason: &str) -> String {
    format!("END {samples} {reason}\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feed::Cell;
    use crate::units::Scale;
    use std::time::Duration;

    fn columns() -> Vec<Column> {
        Column::all(100, &[Scale::singleturn(4)], false)
    }

    fn row() -> Row {
        Row {
            run: None,
            trigger: 7,
            cycles: 50,
            missing: 0,
            cells: vec![Cell {
                position: Some(8),
                fresh: true,
                cause: "none",
                infos: [None; 2],
            }],
        }
    }

    #[test]
    fn frames_say_how_long_they_are() {
        let raw = form("XML FRAMED RAW").unwrap();
        let bytes = rows(raw, &columns(), &[row(), row()]);
        assert_eq!(&bytes[..8], b"BIN \x58\0\0\0");
        assert_eq!(bytes.len(), 8 + 2 * 5 * 8);
        let number = |i: usize| i64::from_le_bytes(bytes[8 + 8 * i..][..8].try_into().unwrap());
        assert_eq!([0, 1, 2, 3, 4].map(number), [50, 7, 8, 1, 0]);
        let scaled = rows(form("XML FRAMED SCALED").unwrap(), &columns(), &[row()]);
        let deg = f64::from_le_bytes(scaled[8 + 16..][..8].try_into().unwrap());
        assert_eq!(deg, 180.0);
    }

    #[test]
    fn text_is_for_people() {
        let ascii = form("").unwrap();
        assert_eq!(rows(ascii, &columns(), &[row()]), b" 0.5 7 180 1 0\n");
        let arm = SystemTime::UNIX_EPOCH + Duration::from_millis(86_400_500);
        let mut times = Times { arm, start: None };
        let told = header(ascii, &columns(), times);
        assert!(told.starts_with("arm_time: 1970-01-02T00:00:00.500000000Z\nmissed: 0\n"));
        assert!(told.contains(" INENC1.VAL double Value Scale: 22.5 Offset: 0 Units: deg\n"));
        assert!(form("XML BASE64").is_err());
        assert_eq!(
            header(form("XML FRAMED BARE").unwrap(), &columns(), times),
            ""
        );
        times.start = Some(arm + Duration::from_secs(1));
        let told = header(form("XML").unwrap(), &columns(), times);
        assert!(
            told.contains(" start_time=\"1970-01-02T00:00:01.500000000Z\" missed="),
            "{told}"
        );
    }
}
