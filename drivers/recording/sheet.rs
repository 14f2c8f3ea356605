//! The rows of a recording as text.

use super::keep::Entry;
use super::layout::{Layout, INFOS};
use clap::ValueEnum;
use serde_json::{json, Map, Value};
use std::io::{self, Write};

/// Form of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Comma separated values, with a head line
    Csv,
    /// One JSON object a line
    Jsonl,
    /// Columns of integers, small: for long recordings
    Parquet,
}

/// Forms of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Text {
    /// Comma separated values, with a head line.
    Csv,
    /// One JSON object a line.
    Jsonl,
}

/// How a line begins that says what a CSV file is of.
pub const COMMENT: &str = "# ";
/// The only key of a line of JSON that does.
pub const ABOUT: &str = "about";

/// Writes rows.
pub struct Sheet<W: Write> {
    form: Text,
    /// Where they go.
    pub out: W,
    layout: Layout,
    system_hz: f64,
}

impl<W: Write> Sheet<W> {
    /// Begins, with what it is of if that is wanted.
    pub fn new(
        form: Text,
        out: W,
        layout: Layout,
        system_hz: f64,
        about: Option<&Value>,
    ) -> io::Result<Self> {
        let mut sheet = Self {
            form,
            out,
            layout,
            system_hz,
        };
        match (form, about) {
            (Text::Csv, Some(about)) => writeln!(sheet.out, "{COMMENT}{about}")?,
            (Text::Jsonl, Some(about)) => writeln!(sheet.out, "{}", json!({ ABOUT: about }))?,
            (_, None) => {}
        }
        if form == Text::Csv {
            let names = sheet.layout.text();
            sheet.record(&names)?;
        }
        Ok(sheet)
    }

    fn record(&mut self, fields: &[String]) -> io::Result<()> {
        let mut writer = csv::WriterBuilder::new();
        if self.layout.decimal_comma {
            writer.delimiter(b';');
        }
        let mut writer = writer.from_writer(Vec::new());
        writer.write_record(fields)?;
        let line = writer
            .into_inner()
            .map_err(|e| io::Error::other(e.to_string()))?;
        self.out.write_all(&line)
    }

    /// A row.
    pub fn row(&mut self, entry: &Entry) -> io::Result<()> {
        let time_s = entry.row.cycles as f64 / self.system_hz;
        match self.form {
            Text::Csv => {
                let mut fields = self.fields(entry, time_s);
                if self.layout.decimal_comma {
                    // No name of a cause has a point.
                    fields.iter_mut().for_each(|f| *f = f.replace('.', ","));
                }
                self.record(&fields)
            }
            Text::Jsonl => {
                let object = self.object(entry, time_s);
                writeln!(self.out, "{object}")
            }
        }
    }

    fn fields(&self, Entry { row, values }: &Entry, time_s: f64) -> Vec<String> {
        let text = |value: Option<String>| value.unwrap_or_default();
        let mut fields = vec![
            // No trigger asked for a position of a running clock.
            row.run.map_or(row.trigger.to_string(), |_| String::new()),
            format!("{time_s:.9}"),
            row.missing.to_string(),
        ];
        for (cell, scale) in row.cells.iter().zip(&self.layout.scales) {
            let units = cell.position.map(|p| scale.convert(p));
            fields.push(text(cell.position.map(|p| p.to_string())));
            fields.push(text(
                units.map(|u| format!("{:.*}", scale.digits(), u.value)),
            ));
            fields.push(text(units.and_then(|u| u.turns).map(|t| t.to_string())));
            fields.push(u8::from(cell.fresh).to_string());
            fields.push(cell.cause.to_owned());
            for info in cell.infos.iter().filter(|_| self.layout.additional_data) {
                fields.push(text(info.map(|i| i.content.to_string())));
                fields.push(text(info.map(|i| i.status.to_string())));
            }
        }
        let derived = self.layout.derived.iter().zip(values);
        fields.extend(derived.map(|(column, value)| match (value, column.digits) {
            (None, _) => String::new(),
            (Some(value), Some(digits)) => format!("{value:.digits$}"),
            (Some(value), None) => value.to_string(),
        }));
        fields
    }

    fn object(&self, Entry { row, values }: &Entry, time_s: f64) -> Value {
        let cells = row.cells.iter().zip(&self.layout.scales);
        let cells = cells.map(|(cell, scale)| {
            let units = cell.position.map(|p| scale.convert(p));
            let mut object = json!({
                "raw": cell.position,
                "value": units.map(|u| u.value),
                "unit": scale.convert(0).unit,
                "turns": units.and_then(|u| u.turns),
                "fresh": cell.fresh,
                "cause": cell.cause,
            });
            if self.layout.additional_data {
                for (info, name) in cell.infos.iter().zip([INFOS[0], INFOS[2]]) {
                    let good = info.map(|i| json!({ "status": i.status, "content": i.content }));
                    object[name] = json!(good);
                }
            }
            object
        });
        let mut object = json!({
            "trigger": row.run.is_none().then_some(row.trigger),
            "time_s": time_s,
            "missing": row.missing,
            "channels": cells.collect::<Vec<_>>(),
        });
        if !values.is_empty() {
            let derived = self.layout.derived.iter().zip(values);
            let derived = derived.map(|(column, value)| (column.column(), json!(value)));
            object["derived"] = Value::Object(derived.collect::<Map<_, _>>());
        }
        object
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::DerivedColumn;
    use super::*;
    use endat_driver::AdditionalData as Info;
    use endat_host::feed::{Cell, Row};
    use endat_host::units::Scale;

    fn cells(position: u64) -> Vec<Cell> {
        let info = Info {
            came: true,
            good: true,
            status: 0x4C,
            content: 4660,
            ..Info::default()
        };
        let good = Cell {
            position: Some(position),
            fresh: true,
            cause: "none",
            infos: [Some(info), None],
        };
        let none = Cell {
            position: None,
            fresh: false,
            cause: "crc",
            infos: [None; 2],
        };
        vec![good, none]
    }

    fn layout(scales: [Scale; 2], additional_data: bool) -> Layout {
        Layout {
            additional_data,
            ..Layout::of(scales.to_vec())
        }
    }

    fn entry(run: Option<usize>, trigger: u64, cycles: u64, missing: u64) -> Entry {
        let row = Row {
            run,
            trigger,
            cycles,
            missing,
            cells: cells(64),
        };
        Entry {
            row,
            values: Vec::new(),
        }
    }

    fn written(
        form: Text,
        layout: Layout,
        values: &[Option<f64>],
        about: Option<&Value>,
    ) -> String {
        let mut sheet = Sheet::new(form, Vec::new(), layout, 32.0, about).unwrap();
        for (trigger, cycles, missing) in [(65_534, 0, 0), (65_535, 32, 0), (65_538, 64, 2)] {
            let mut entry = entry(None, trigger, cycles, missing);
            entry.values = values.to_vec();
            sheet.row(&entry).unwrap();
        }
        String::from_utf8(sheet.out).unwrap()
    }

    #[test]
    fn a_spreadsheet_with_decimal_commas_has_semicolons() {
        let comma = Layout {
            decimal_comma: true,
            ..layout(
                [Scale::singleturn(8), Scale::Linear { step_nm: 500.0 }],
                false,
            )
        };
        let text = written(Text::Csv, comma, &[], None);
        let mut lines = text.lines();
        assert!(lines.next().unwrap().starts_with("trigger;time_s;missing;"));
        assert_eq!(
            lines.next(),
            Some("65534;0,000000000;0;64;90;0;1;none;;;;0;crc")
        );
    }

    fn scales() -> [Scale; 2] {
        [Scale::singleturn(8), Scale::Linear { step_nm: 10.0 }]
    }

    #[test]
    fn csv_has_units_and_no_position_where_there_is_none() {
        assert_eq!(
            written(Text::Csv, layout(scales(), false), &[], None),
            "trigger,time_s,missing,ch0_raw,ch0_deg,ch0_turns,ch0_fresh,ch0_cause,ch1_raw,ch1_mm,ch1_turns,ch1_fresh,ch1_cause\n\
             65534,0.000000000,0,64,90,0,1,none,,,,0,crc\n\
             65535,1.000000000,0,64,90,0,1,none,,,,0,crc\n\
             65538,2.000000000,2,64,90,0,1,none,,,,0,crc\n"
        );
    }

    #[test]
    fn additional_data_have_columns_and_a_running_clock_no_trigger() {
        let text = written(Text::Csv, layout(scales(), true), &[], None);
        let mut lines = text.lines();
        let head = lines.next().unwrap();
        assert!(
            head.contains(",ch0_cause,ch0_info_1,ch0_info_1_status,ch0_info_2,"),
            "{head}"
        );
        assert_eq!(
            lines.next().unwrap(),
            "65534,0.000000000,0,64,90,0,1,none,4660,76,,,,,,0,crc,,,,"
        );
        let two = layout([Scale::singleturn(8); 2], true);
        let mut sheet = Sheet::new(Text::Jsonl, Vec::new(), two, 32.0, None).unwrap();
        sheet.row(&entry(Some(0), 7, 8, 0)).unwrap();
        let line: serde_json::Value = serde_json::from_slice(&sheet.out).unwrap();
        assert!(line["trigger"].is_null());
        assert_eq!(line["channels"][0]["info_1"]["content"], 4660);
        assert!(line["channels"][0]["info_2"].is_null());
    }

    #[test]
    fn json_lines_have_the_same() {
        let text = written(Text::Jsonl, layout(scales(), false), &[], None);
        let rows: Vec<serde_json::Value> = text
            .lines()
            .map(|l| serde_json::from_str(l).unwrap())
            .collect();
        assert_eq!(rows.len(), 3);
        assert_eq!(rows[2]["missing"], 2);
        assert_eq!(rows[1]["channels"][0]["value"], 90.0);
        assert_eq!(rows[1]["channels"][1]["raw"], serde_json::Value::Null);
    }

    #[test]
    fn what_is_calculated_stands_behind_and_what_it_is_of_before() {
        let mut layout = layout(scales(), false);
        layout.derived = vec![
            DerivedColumn {
                name: "twist".into(),
                unit: "deg".into(),
                digits: Some(3),
            },
            DerivedColumn {
                name: "v".into(),
                unit: "deg/s".into(),
                digits: None,
            },
        ];
        let about = json!({"system_hz": 32});
        let text = written(Text::Csv, layout.clone(), &[Some(0.5), None], Some(&about));
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "# {\"system_hz\":32}");
        assert!(
            lines[1].ends_with(",ch1_cause,twist_deg,v_deg_per_s"),
            "{}",
            lines[1]
        );
        assert!(lines[2].ends_with(",crc,0.500,"), "{}", lines[2]);
        let text = written(Text::Jsonl, layout, &[Some(0.5), None], Some(&about));
        let lines: Vec<Value> = text
            .lines()
            .map(|l| serde_json::from_str(l).unwrap())
            .collect();
        assert_eq!(lines[0][ABOUT]["system_hz"], 32);
        assert_eq!(
            lines[1]["derived"],
            json!({"twist_deg": 0.5, "v_deg_per_s": null})
        );
    }
}
