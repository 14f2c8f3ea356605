//! Files that are written until something ends it, and what they cost.

use super::super::layout::DerivedColumn;
use super::super::picture::Measurement;
use super::super::read::read_all;
use super::*;
use endat_driver::AdditionalData as Info;
use endat_host::feed::{Cell, Row};
use endat_host::units::Scale;
use serde_json::json;
use std::io::Cursor;

fn about() -> Value {
    let channel = json!({"unit": "deg", "steps_per_turn": 1u64 << 48, "range": 1u64 << 48});
    json!({"system_hz": 1_000, "channels": [channel], "columns": {"v_deg": {"unit": "deg"}}})
}

fn layout() -> Layout {
    Layout {
        scales: vec![Scale::singleturn(48)],
        additional_data: true,
        derived: vec![DerivedColumn {
            name: "v".into(),
            unit: "deg".into(),
            digits: None,
        }],
        decimal_comma: false,
    }
}

fn entry(n: u64) -> Entry {
    let info = Info {
        content: n as u16,
        ..Info::default()
    };
    let is_good = n % 7 != 3;
    Entry {
        row: Row {
            run: (n == 5).then_some(0),
            trigger: n + 1_000,
            cycles: n * 10,
            missing: n % 3,
            cells: vec![Cell {
                position: is_good.then_some((1 << 48) - 50 + n),
                fresh: is_good,
                cause: if is_good { "none" } else { "crc" },
                infos: [Some(info), None],
            }],
        },
        values: vec![is_good.then_some(n as f64 / 8.0)],
    }
}

fn read(bytes: &[u8]) -> Vec<Measurement> {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), bytes).unwrap();
    let mut rows = Vec::new();
    read_all(&[file.path().to_owned()], false, &mut |_, row| {
        rows.push(row.clone())
    })
    .unwrap();
    rows
}

/// The same of what may have none.
fn rows_of(bytes: &[u8]) -> Option<Vec<Measurement>> {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), bytes).unwrap();
    let mut rows = Vec::new();
    read_all(&[file.path().to_owned()], false, &mut |_, row| {
        rows.push(row.clone())
    })
    .ok()?;
    Some(rows)
}

fn assert_rows(rows: &[Measurement], count: u64) {
    assert_eq!(rows.len() as u64, count);
    for (n, row) in rows.iter().enumerate() {
        let Entry {
            row: wanted,
            values,
        } = entry(n as u64);
        let trigger = wanted.run.is_none().then_some(wanted.trigger);
        assert_eq!((row.trigger, row.missing), (trigger, wanted.missing));
        assert!((row.time_s - n as f64 * 0.01).abs() < 1e-12);
        let (cell, other) = (&row.cells[0], &wanted.cells[0]);
        assert_eq!((cell.raw, cell.fresh), (other.position, other.fresh));
        assert_eq!((&*cell.cause, &row.derived), (other.cause, &values));
    }
}

/// A disk with room for so many bytes.
#[derive(Clone)]
struct Small(Cursor<Vec<u8>>, usize);

impl Write for Small {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let room = self.1.saturating_sub(self.0.position() as usize);
        match bytes.len().min(room) {
            0 => Err(io::ErrorKind::StorageFull.into()),
            count => self.0.write(&bytes[..count]),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Small {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

impl Disk for Small {
    fn cut(&mut self, bytes: u64) -> io::Result<()> {
        self.0.get_mut().truncate(bytes as usize);
        Ok(())
    }
}

/// A disk of a computer on which the program is killed behind so many writes.
#[derive(Clone)]
struct Killed(Cursor<Vec<u8>>, usize);

impl Killed {
    fn is_alive(&mut self) -> bool {
        let alive = self.1 > 0;
        self.1 = self.1.saturating_sub(1);
        alive
    }
}

impl Write for Killed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.is_alive() {
            true => self.0.write(bytes),
            false => Ok(bytes.len()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Killed {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

impl Disk for Killed {
    fn cut(&mut self, bytes: u64) -> io::Result<()> {
        if self.is_alive() {
            self.0.get_mut().truncate(bytes as usize);
        }
        Ok(())
    }
}

/// Catches a file that is lost as a whole because its end is written over while the program is killed.
#[test]
fn a_program_that_is_killed_at_any_write_loses_the_last_group_only() {
    for writes in 3..30 {
        let disk = Killed(Cursor::default(), writes);
        let mut file = ParquetFile::new(disk, &layout(), &about()).unwrap();
        let mut wanted = 0;
        for n in 0..500 {
            file.row(&entry(n)).unwrap();
            if n % 100 == 99 {
                file.flush().unwrap();
                // What was alive behind it has all of it.
                wanted = if file.file.1 > 0 { n + 1 } else { wanted };
            }
        }
        let bytes = file.file.0.get_ref();
        let state = seal::state(&mut Cursor::new(bytes)).unwrap();
        assert_eq!(state, seal::State::Whole, "{writes}");
        let kept = rows_of(bytes).map_or(0, |rows| rows.len() as u64);
        assert!(
            (wanted..=wanted + 100).contains(&kept),
            "{writes}: {kept} of {wanted}"
        );
    }
}

/// Catches a file that is lost with its disk, or with the program, and not only with its last group.
#[test]
fn a_file_is_whole_behind_every_group_and_on_a_full_disk() {
    let whole = {
        let disk = Small(Cursor::default(), usize::MAX);
        let mut file = ParquetFile::new(disk, &layout(), &about()).unwrap();
        for n in 0..300 {
            file.row(&entry(n)).unwrap();
            if n % 100 == 99 {
                file.flush().unwrap();
                assert_rows(&read(file.file.0.get_ref()), n + 1);
            }
        }
        file.file.0.into_inner().len()
    };
    for room in (whole / 2..whole).step_by(97) {
        let disk = Small(Cursor::default(), room);
        let mut file = ParquetFile::new(disk, &layout(), &about()).unwrap();
        let mut kept = 0;
        let full = (0..300).try_for_each(|n| {
            file.row(&entry(n))?;
            if n % 100 == 99 {
                file.flush()?;
                kept = n + 1;
            }
            Ok::<(), io::Error>(())
        });
        assert_eq!(
            full.map_err(|e| e.kind()),
            Err(io::ErrorKind::StorageFull),
            "{room}"
        );
        if kept > 0 {
            assert_rows(&read(file.file.0.get_ref()), kept);
        }
    }
}

/// Counts what is written.
#[derive(Default)]
struct Counted(Cursor<Vec<u8>>, u64);

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.1 += bytes.len() as u64;
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Counted {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

impl Disk for Counted {
    fn cut(&mut self, bytes: u64) -> io::Result<()> {
        self.0.get_mut().truncate(bytes as usize);
        Ok(())
    }
}

/// A row of two shafts that turn evenly, at 10 kHz, and jitter by one measuring step.
fn even(n: u64) -> Entry {
    let jitter = |salt: u64| (n * 2 + salt).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 63;
    let cell = |steps: u64| Cell {
        position: Some((n * steps + jitter(steps & 1)) & ((1 << 29) - 1)),
        fresh: true,
        cause: "none",
        infos: [None; 2],
    };
    Entry {
        row: Row {
            run: None,
            trigger: n,
            cycles: n * 10_000,
            missing: 0,
            cells: vec![cell(13_422), cell(20_133)],
        },
        values: Vec::new(),
    }
}

/// A file of two channels, with as much of what it is of as a recording has.
fn counted() -> ParquetFile<Counted> {
    let layout = Layout::of(vec![Scale::singleturn(29); 2]);
    let mut about = about();
    about["causes"] = json!("x".repeat(1_800));
    ParquetFile::new(Counted::default(), &layout, &about).unwrap()
}

/// Catches a file that is written mostly for its ends: of a full one, from one group in small and the growth of its end.
#[test]
fn ends_of_a_full_file_are_below_5_percent_of_what_is_written() {
    let mut file = counted();
    let mut ends = Vec::new();
    let rows = 16_384;
    for n in 0..3 * rows {
        file.row(&even(n)).unwrap();
        if n % rows == rows - 1 {
            file.flush().unwrap();
            ends.push(file.footer.len() as u64);
        }
    }
    let growth = ends[2] - ends[1];
    let end = |n: u64| ends[0] + growth * n.saturating_sub(1);
    let share = |groups: u64, group_rows: u64| {
        // Each end is written once more before the next one takes its place.
        let all: u64 = (0..groups).map(|n| end(n) + end(n + 1)).sum();
        all as f64 / (all + groups * (file.end * group_rows / (3 * rows))) as f64
    };
    let full = share(GROUPS.into(), file.group_rows as u64);
    println!("an end {}, {growth} for each group: {full}", ends[0]);
    assert!(full < 0.05, "{full}");
    // A night in one file, in groups of 13 s.
    let night = share(2_215, 131_072);
    assert!(night > 0.5, "{night}");
}

/// Catches fourteen minutes that are taken for a whole night, since the other files were not copied.
#[test]
fn full_file_without_the_next_one_is_told() {
    let dir = tempfile::tempdir().unwrap();
    for groups in [GROUPS - 1, GROUPS] {
        let path = dir.path().join(format!("night{groups}.parquet"));
        let layout = Layout::of(vec![Scale::singleturn(29); 2]);
        let mut file = ParquetFile::new(File::create(&path).unwrap(), &layout, &about()).unwrap();
        for n in 0..u64::from(groups) {
            file.row(&even(n)).unwrap();
            file.flush().unwrap();
        }
        let told = read_all(&[path], false, &mut |_, _| {}).unwrap().notes;
        let wanted = "night16.parquet: is full: a longer recording goes on in ";
        let is_told = told.iter().any(|note| note.contains(wanted));
        assert_eq!(is_told, groups == GROUPS, "{groups}: {told:?}");
    }
}

#[test]
#[ignore = "slow: a full file of Parquet, of two channels"]
fn ends_of_a_file_that_was_written_are_below_5_percent() {
    let mut file = counted();
    let rows = u64::from(GROUPS) * file.group_rows as u64;
    (0..rows).for_each(|n| file.row(&even(n)).unwrap());
    assert_eq!(file.groups(), GROUPS);
    let share = 1.0 - file.end as f64 / file.file.1 as f64;
    println!(
        "{} bytes written, {} of groups: {share}",
        file.file.1, file.end
    );
    assert!(share < 0.05, "{share}");
}
