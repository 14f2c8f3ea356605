//! `log`: sample sets into a file, as CSV or JSON lines.

use super::super::number::number_if;
use super::super::pictures::{check_all, write_all, File};
use super::super::Outcome;
use super::{interrupted, place, scales, settled, told, AnyCard, PortArgs};
use crate::error::GenError;
use clap::{Args, ValueEnum};
use endat_host::feed::{Feed, Row};
use endat_host::units::Scale;
use endat_sim::diagram::{is_drawing, series_svg, Series};
use serde_json::json;
use std::collections::VecDeque;
use std::fs;
use std::io::{self, BufWriter, IsTerminal, Write};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Form of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Comma separated values, with a head line
    Csv,
    /// One JSON object a line
    Jsonl,
}

/// Arguments of `log`.
#[derive(Args)]
pub struct LogArgs {
    #[command(flatten)]
    port: PortArgs,
    /// Stop after so many sample sets [default: until Ctrl-C]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    samples: Option<String>,
    /// Stop after so many seconds
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    seconds: Option<String>,
    /// Write into this file [default: to stdout]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Replace the file if it is there
    #[arg(long, requires = "out")]
    force: bool,
    /// Draw the positions over time, at the end
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Form of the file
    #[arg(long, value_enum, default_value = "csv")]
    format: Format,
    /// Read results one after the other, even if the card can stream
    #[arg(long)]
    poll: bool,
}

/// How long an empty stream is waited for before the end is looked for again.
const SLICE: Duration = Duration::from_millis(100);
/// Nothing for this long: something is wrong.
const SILENCE: Duration = Duration::from_secs(20);
/// Between two lines of progress.
const PROGRESS: Duration = Duration::from_secs(2);

/// Writes rows.
struct Sheet<W: Write> {
    format: Format,
    out: W,
    scales: Vec<Scale>,
    system_hz: f64,
    /// What is to be drawn; none if nothing is.
    plot: Option<Vec<Series>>,
}

impl<W: Write> Sheet<W> {
    fn new(format: Format, out: W, scales: Vec<Scale>, system_hz: f64) -> io::Result<Self> {
        let mut sheet = Self {
            format,
            out,
            scales,
            system_hz,
            plot: None,
        };
        if format == Format::Csv {
            let mut names = vec!["trigger".to_owned(), "time_s".into(), "missing".into()];
            for (n, scale) in sheet.scales.iter().enumerate() {
                let unit = scale.convert(0).unit;
                names.extend(
                    ["raw", unit, "turns", "fresh", "cause"].map(|name| format!("ch{n}_{name}")),
                );
            }
            sheet.record(&names)?;
        }
        Ok(sheet)
    }

    /// From now on positions are kept for a drawing.
    fn keep(&mut self) {
        let series = self.scales.iter().enumerate().map(|(n, scale)| Series {
            name: format!("channel {n}"),
            unit: scale.convert(0).unit.into(),
            points: Vec::new(),
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

    fn row(&mut self, row: &Row) -> io::Result<()> {
        let time_s = self.time_s(row);
        self.draw(row, time_s);
        match self.format {
            Format::Csv => {
                let mut fields = vec![
                    row.trigger.to_string(),
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
                }
                self.record(&fields)
            }
            Format::Jsonl => {
                let cells = row.cells.iter().zip(&self.scales).map(|(cell, scale)| {
                    let units = cell.position.map(|p| scale.convert(p));
                    json!({
                        "raw": cell.position,
                        "value": units.map(|u| u.value),
                        "unit": scale.convert(0).unit,
                        "turns": units.and_then(|u| u.turns),
                        "fresh": cell.fresh,
                        "cause": cell.cause,
                    })
                });
                let object = json!({
                    "trigger": row.trigger,
                    "time_s": time_s,
                    "missing": row.missing,
                    "channels": cells.collect::<Vec<_>>(),
                });
                writeln!(self.out, "{object}")
            }
        }
    }
}

/// When to stop.
struct End {
    samples: Option<u64>,
    seconds: Option<u64>,
}

/// Runs the command.
pub fn run(arguments: &LogArgs) -> Result<Outcome, GenError> {
    let limit = |flag, text| number_if(flag, text, 1..=u64::from(u32::MAX));
    let end = End {
        samples: limit("--samples", &arguments.samples)?,
        seconds: limit("--seconds", &arguments.seconds)?,
    };
    let mut card = arguments.port.open()?;
    settled(&mut card)?;
    let sources = place(&card, "card_config.trigger_sources")?;
    if card.read(&sources).map_err(told)? == 0 {
        return Err(GenError::CheckFailed(vec![format!(
            "no trigger is enabled, so there is nothing to log; enable one, as with `endat-gen reg write card_config.trigger_sources.timer 1 --port {}`",
            arguments.port.name()
        )]));
    }
    let scales = scales(&mut card)?;
    let (out, name): (Box<dyn Write>, String) = match &arguments.out {
        None => (Box::new(io::stdout()), "stdout".into()),
        Some(path) => {
            let mut options = fs::File::options();
            options.write(true);
            let options = match arguments.force {
                true => options.create(true).truncate(true),
                false => options.create_new(true),
            };
            let remedy = "give another file with --out, or replace it with --force";
            let file = options
                .open(path)
                .map_err(|e| GenError::io("write", path, &e, remedy))?;
            (Box::new(file), path.display().to_string())
        }
    };
    let failed =
        |e: io::Error| GenError::input(format!("{name}: cannot write: {e}; is the disk full?"));
    let system_hz = f64::from(card.identity().system_hz.max(1));
    let mut sheet =
        Sheet::new(arguments.format, BufWriter::new(out), scales, system_hz).map_err(failed)?;
    let mut drawing = arguments.svg.clone().map(|path| File {
        option: "--svg",
        path,
        text: String::new(),
        is_ours: is_drawing,
    });
    // Refused before the first sample, not after the last.
    check_all(&drawing.iter().collect::<Vec<_>>())?;
    if drawing.is_some() {
        sheet.keep();
    }
    let mut feed = Feed::begin(&mut card, arguments.poll).map_err(told)?;
    let stop = interrupted();
    let result = record(&mut card, &mut feed, &mut sheet, &end, &stop);
    // Whatever ended it: the card is quiet again, and the file whole.
    let (is_stream, lost_in_card) = (feed.streams(), feed.lost_in_card());
    let calm = feed.end(&mut card);
    let flushed = sheet.out.flush();
    let totals = match result {
        // A reader that has gone away (`| head`) is the end, not an error.
        Err(Failure::Write(e)) if e.kind() == io::ErrorKind::BrokenPipe => {
            return Ok(Outcome::default())
        }
        Err(Failure::Write(e)) => return Err(failed(e)),
        Err(Failure::Card(e)) => return Err(e),
        Ok(totals) => totals,
    };
    flushed.map_err(failed)?;
    calm.map_err(told)?;
    let mut messages = Vec::new();
    if let (Some(file), Some(plot)) = (&mut drawing, &sheet.plot) {
        let subtitle = format!(
            "{} sample sets, {} triggers missing",
            totals.rows, totals.missing
        );
        file.text = series_svg(
            plot,
            &format!("Positions of {}", arguments.port.name()),
            &subtitle,
        );
        messages.extend(write_all(&drawing.into_iter().collect::<Vec<_>>())?);
    }
    let damaged = card.bridge().decoder().damaged();
    let mut text = format!(
        "{name}: {} sample sets in {:.3} s of the card's time",
        totals.rows, totals.span_s
    );
    if is_stream {
        text += &format!(
            "; {} triggers missing, {} of them dropped in the card; {damaged} frames damaged on the line",
            totals.missing, lost_in_card
        );
    } else {
        text += &format!(
            "; read one by one: {} results in between not read (a card with [stream] gives them all)",
            totals.missing
        );
    }
    messages.insert(0, text);
    Ok(Outcome {
        messages,
        exit_code: u8::from(is_stream && totals.missing > 0),
        ..Outcome::default()
    })
}

#[derive(Default)]
struct Totals {
    rows: u64,
    missing: u64,
    span_s: f64,
}

enum Failure {
    Card(GenError),
    Write(io::Error),
}

fn record<W: Write>(
    card: &mut AnyCard,
    feed: &mut Feed,
    sheet: &mut Sheet<W>,
    end: &End,
    stop: &AtomicBool,
) -> Result<Totals, Failure> {
    let begin = Instant::now();
    let (mut shown, mut heard, mut flushed) = (begin, begin, begin);
    let mut totals = Totals::default();
    let mut rows = VecDeque::new();
    let shows = io::stderr().is_terminal() || end.samples.is_some();
    loop {
        let filled = feed.fill(card, &mut rows, SLICE);
        filled.map_err(|e| Failure::Card(told(e)))?;
        if !rows.is_empty() {
            heard = Instant::now();
        }
        while let Some(row) = rows.pop_front() {
            sheet.row(&row).map_err(Failure::Write)?;
            totals.rows += 1;
            totals.missing += row.missing;
            totals.span_s = sheet.time_s(&row);
            if end.samples == Some(totals.rows) {
                return Ok(totals);
            }
        }
        let is_over = end
            .seconds
            .is_some_and(|s| begin.elapsed() >= Duration::from_secs(s));
        if is_over || stop.load(Ordering::Relaxed) {
            return Ok(totals);
        }
        if heard.elapsed() > SILENCE {
            return Err(Failure::Card(GenError::CheckFailed(vec![format!(
                "no sample for {} s; is a trigger enabled (`endat-gen reg read card_config`), is the card plugged in? {} sets are in the file",
                SILENCE.as_secs(),
                totals.rows
            )])));
        }
        if flushed.elapsed() >= Duration::from_secs(1) {
            flushed = Instant::now();
            sheet.out.flush().map_err(Failure::Write)?;
        }
        if shows && shown.elapsed() >= PROGRESS {
            shown = Instant::now();
            let of = end.samples.map_or(String::new(), |n| format!(" of {n}"));
            let _ = writeln!(io::stderr(), "{}{of} sample sets", totals.rows);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use endat_host::feed::Cell;

    fn cells(position: u64) -> Vec<Cell> {
        let good = Cell {
            position: Some(position),
            fresh: true,
            cause: "none",
        };
        let none = Cell {
            position: None,
            fresh: false,
            cause: "crc",
        };
        vec![good, none]
    }

    fn written(format: Format) -> String {
        let scales = vec![Scale::singleturn(8), Scale::Linear { step_nm: 10.0 }];
        let mut sheet = Sheet::new(format, Vec::new(), scales, 32.0).unwrap();
        for (trigger, cycles, missing) in [(65_534, 0, 0), (65_535, 32, 0), (65_538, 64, 2)] {
            let row = Row {
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
            written(Format::Csv),
            "trigger,time_s,missing,ch0_raw,ch0_deg,ch0_turns,ch0_fresh,ch0_cause,ch1_raw,ch1_mm,ch1_turns,ch1_fresh,ch1_cause\n\
             65534,0.000000000,0,64,90,0,1,none,,,,0,crc\n\
             65535,1.000000000,0,64,90,0,1,none,,,,0,crc\n\
             65538,2.000000000,2,64,90,0,1,none,,,,0,crc\n"
        );
    }

    #[test]
    fn json_lines_have_the_same() {
        let text = written(Format::Jsonl);
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
