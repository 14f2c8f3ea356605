//! The rows of a log as text, and the file they go into.

use super::count::Judge;
use clap::ValueEnum;
use endat_host::feed::Row;
use endat_host::units::Scale;
use endat_sim::diagram::Series;
use serde_json::json;
use std::fs::File;
use std::io::{self, Write};

/// Form of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Comma separated values, with a head line
    Csv,
    /// One JSON object a line
    Jsonl,
}

/// Writes rows.
pub struct Sheet<W: Write> {
    format: Format,
    pub out: W,
    scales: Vec<Scale>,
    system_hz: f64,
    /// Rows have additional data.
    additional_data: bool,
    /// Time of the last row.
    pub span_s: f64,
    judge: Judge,
    /// What is to be drawn; none if nothing is.
    pub plot: Option<Vec<Series>>,
}

impl<W: Write> Sheet<W> {
    pub fn new(
        format: Format,
        out: W,
        scales: Vec<Scale>,
        system_hz: f64,
        additional_data: bool,
    ) -> io::Result<Self> {
        let mut sheet = Self {
            format,
            out,
            scales,
            system_hz,
            additional_data,
            span_s: 0.0,
            judge: Judge::default(),
            plot: None,
        };
        if format == Format::Csv {
            let mut names = vec!["trigger".to_owned(), "time_s".into(), "missing".into()];
            for (n, scale) in sheet.scales.iter().enumerate() {
                let unit = scale.convert(0).unit;
                names.extend(
                    ["raw", unit, "turns", "fresh", "cause"].map(|name| format!("ch{n}_{name}")),
                );
                if additional_data {
                    let of = ["info_1", "info_1_status", "info_2", "info_2_status"];
                    names.extend(of.map(|name| format!("ch{n}_{name}")));
                }
            }
            sheet.record(&names)?;
        }
        Ok(sheet)
    }

    /// From now on positions are kept for a drawing.
    pub fn keep(&mut self, judge: Judge) {
        self.judge = judge;
        let series = self.scales.iter().enumerate().map(|(n, scale)| Series {
            name: format!("channel {n}"),
            unit: scale.convert(0).unit.into(),
            wraps_at: scale.wraps_at(),
            ..Series::default()
        });
        self.plot = Some(series.collect());
    }

    fn draw(&mut self, row: &Row, time_s: f64) {
        let channels = self.plot.iter_mut().flatten();
        for ((series, cell), scale) in channels.zip(&row.cells).zip(&self.scales) {
            let value = cell
                .position
                .filter(|_| cell.fresh)
                .map(|p| scale.convert(p).value);
            series.points.push((time_s, value));
            if self.judge.is_bad(cell) {
                series.bad.push(time_s);
            }
        }
    }

    fn time_s(&self, row: &Row) -> f64 {
        row.cycles as f64 / self.system_hz
    }

    fn record(&mut self, fields: &[String]) -> io::Result<()> {
        let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
        writer.write_record(fields)?;
        let line = writer
            .into_inner()
            .map_err(|e| io::Error::other(e.to_string()))?;
        self.out.write_all(&line)
    }

    pub fn row(&mut self, row: &Row) -> io::Result<()> {
        let time_s = self.time_s(row);
        self.draw(row, time_s);
        self.span_s = time_s;
        match self.format {
            Format::Csv => {
                let mut fields = vec![
                    // No trigger asked for a position of a running clock.
                    row.run.map_or(row.trigger.to_string(), |_| String::new()),
                    format!("{:.9}", time_s),
                    row.missing.to_string(),
                ];
                for (cell, scale) in row.cells.iter().zip(&self.scales) {
                    let units = cell.position.map(|p| scale.convert(p));
                    let text = |value: Option<String>| value.unwrap_or_default();
                    fields.push(text(cell.position.map(|p| p.to_string())));
                    fields.push(text(
                        units.map(|u| format!("{:.*}", scale.digits(), u.value)),
                    ));
                    fields.push(text(units.and_then(|u| u.turns).map(|t| t.to_string())));
                    fields.push(u8::from(cell.fresh).to_string());
                    fields.push(cell.cause.to_owned());
                    for info in cell.infos.iter().filter(|_| self.additional_data) {
                        fields.push(text(info.map(|i| i.content.to_string())));
                        fields.push(text(info.map(|i| i.status.to_string())));
                    }
                }
                self.record(&fields)
            }
            Format::Jsonl => {
                let cells = row.cells.iter().zip(&self.scales).map(|(cell, scale)| {
                    let units = cell.position.map(|p| scale.convert(p));
                    let mut object = json!({
                        "raw": cell.position,
                        "value": units.map(|u| u.value),
                        "unit": scale.convert(0).unit,
                        "turns": units.and_then(|u| u.turns),
                        "fresh": cell.fresh,
                        "cause": cell.cause,
                    });
                    for (n, info) in cell
                        .infos
                        .iter()
                        .enumerate()
                        .filter(|_| self.additional_data)
                    {
                        let good =
                            info.map(|i| json!({ "status": i.status, "content": i.content }));
                        object[format!("info_{}", n + 1)] = json!(good);
                    }
                    object
                });
                let object = json!({
                    "trigger": row.run.is_none().then_some(row.trigger),
                    "time_s": time_s,
                    "missing": row.missing,
                    "channels": cells.collect::<Vec<_>>(),
                });
                writeln!(self.out, "{object}")
            }
        }
    }
}

/// Collected until so much has come, or until it is flushed.
const CHUNK_BYTES: usize = 1 << 16;

/// Gives whole lines to a file: on a full disk it is cut behind the last one that got in.
pub struct Lines<W> {
    out: W,
    buffer: Vec<u8>,
    written: u64,
    cut: fn(&mut W, u64) -> io::Result<()>,
}

impl Lines<Box<dyn Write>> {
    /// Whatever takes bytes, where what has been written cannot be taken back.
    pub fn to(out: Box<dyn Write>) -> Self {
        Self::new(out, |_, _| Ok(()))
    }
}

impl Lines<File> {
    /// A new file.
    pub fn file(file: File) -> Self {
        Self::new(file, |file, bytes| file.set_len(bytes))
    }
}

impl<W: Write> Lines<W> {
    fn new(out: W, cut: fn(&mut W, u64) -> io::Result<()>) -> Self {
        Self {
            out,
            buffer: Vec::new(),
            written: 0,
            cut,
        }
    }

    /// How many bytes of `all` got in, and why not more.
    fn give(&mut self, all: &[u8]) -> (usize, io::Result<()>) {
        let mut done = 0;
        while done < all.len() {
            match self.out.write(&all[done..]) {
                Ok(0) => return (done, Err(io::ErrorKind::WriteZero.into())),
                Ok(count) => done += count,
                Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
                Err(e) => return (done, Err(e)),
            }
        }
        (done, Ok(()))
    }
}

impl<W: Write> Write for Lines<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.buffer.extend_from_slice(bytes);
        if self.buffer.len() >= CHUNK_BYTES && bytes.ends_with(b"\n") {
            self.flush()?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        // What could not be written is not tried again: a row may never stand twice.
        let all = std::mem::take(&mut self.buffer);
        let (done, result) = self.give(&all);
        if let Err(error) = result {
            let whole = all[..done]
                .iter()
                .rposition(|b| *b == b'\n')
                .map_or(0, |at| at + 1);
            self.written += whole as u64;
            // A device has no length; the first error is the one to tell.
            let _ = (self.cut)(&mut self.out, self.written);
            return Err(error);
        }
        self.written += done as u64;
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use endat_driver::AdditionalData as Info;
    use endat_host::feed::Cell;

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

    fn written(format: Format, additional_data: bool) -> String {
        let scales = vec![Scale::singleturn(8), Scale::Linear { step_nm: 10.0 }];
        let mut sheet = Sheet::new(format, Vec::new(), scales, 32.0, additional_data).unwrap();
        for (trigger, cycles, missing) in [(65_534, 0, 0), (65_535, 32, 0), (65_538, 64, 2)] {
            let row = Row {
                run: None,
                trigger,
                cycles,
                missing,
                cells: cells(64),
            };
            sheet.row(&row).unwrap();
        }
        String::from_utf8(sheet.out).unwrap()
    }

    #[test]
    fn csv_has_units_and_no_position_where_there_is_none() {
        assert_eq!(
            written(Format::Csv, false),
            "trigger,time_s,missing,ch0_raw,ch0_deg,ch0_turns,ch0_fresh,ch0_cause,ch1_raw,ch1_mm,ch1_turns,ch1_fresh,ch1_cause\n\
             65534,0.000000000,0,64,90,0,1,none,,,,0,crc\n\
             65535,1.000000000,0,64,90,0,1,none,,,,0,crc\n\
             65538,2.000000000,2,64,90,0,1,none,,,,0,crc\n"
        );
    }

    #[test]
    fn additional_data_have_columns_and_a_running_clock_no_trigger() {
        let text = written(Format::Csv, true);
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
        let scales = vec![Scale::singleturn(8), Scale::singleturn(8)];
        let mut sheet = Sheet::new(Format::Jsonl, Vec::new(), scales, 32.0, true).unwrap();
        let row = Row {
            run: Some(0),
            trigger: 7,
            cycles: 8,
            missing: 0,
            cells: cells(64),
        };
        sheet.row(&row).unwrap();
        let line: serde_json::Value = serde_json::from_slice(&sheet.out).unwrap();
        assert!(line["trigger"].is_null());
        assert_eq!(line["channels"][0]["info_1"]["content"], 4660);
        assert!(line["channels"][0]["info_2"].is_null());
    }

    /// A disk with room for so many bytes.
    struct Disk(Vec<u8>, usize);

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let room = bytes.len().min(self.1 - self.0.len());
            self.0.extend_from_slice(&bytes[..room]);
            match room {
                0 => Err(io::ErrorKind::StorageFull.into()),
                room => Ok(room),
            }
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_full_disk_keeps_whole_lines() {
        for room in 0..14 {
            let mut lines = Lines::new(Disk(Vec::new(), room), |disk, bytes| {
                disk.0.truncate(bytes as usize);
                Ok(())
            });
            lines.write_all(b"1,2\n").unwrap();
            let first = lines.flush();
            lines.write_all(b"34,56\n7,8\n").unwrap();
            let kind = lines.flush().map_err(|e| e.kind());
            assert_eq!(kind, Err(io::ErrorKind::StorageFull), "{room}");
            let wanted: &[u8] = match room {
                0..4 => b"",
                4..10 => b"1,2\n",
                _ => b"1,2\n34,56\n",
            };
            // After an error nothing more is written: the program ends.
            if first.is_ok() {
                assert_eq!(lines.out.0, wanted, "{room}");
            }
        }
    }

    #[test]
    fn json_lines_have_the_same() {
        let text = written(Format::Jsonl, false);
        let rows: Vec<serde_json::Value> = text
            .lines()
            .map(|l| serde_json::from_str(l).unwrap())
            .collect();
        assert_eq!(rows.len(), 3);
        assert_eq!(rows[2]["missing"], 2);
        assert_eq!(rows[1]["channels"][0]["value"], 90.0);
        assert_eq!(rows[1]["channels"][1]["raw"], serde_json::Value::Null);
    }
}
