//! Recordings in files: parts, limits, an hour.

use super::super::count::Judge;
use super::super::keep::Faults;
use super::super::read::read_all;
use super::super::stats::Stats;
use super::*;
use endat_host::card::Identity;
use endat_host::feed::Cell;
use endat_host::units::Scale;
use endat_regs::Protocols;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

const SYSTEM_HZ: u32 = 100_000_000;
const TURN: u64 = 1 << 29;

fn wishes(target: Target, format: Format, keep: Keep, limits: Limits) -> Wishes {
    let scales = vec![Scale::singleturn(29); 2];
    Wishes {
        target,
        format,
        layout: Layout::of(scales),
        about: About {
            port: "test".into(),
            identity: Identity {
                version: [1, 0, 0],
                channels: 2,
                max_position_bits: 48,
                features: 0,
                system_hz: SYSTEM_HZ,
                configuration_hash: 0,
                protocols: Protocols::ENDAT,
                stream_additional_data: false,
            },
            plates: vec![None, None],
            every: 1,
            events: Vec::new(),
            start: SystemTime::UNIX_EPOCH + Duration::from_secs(1_700_000_000),
        },
        about_in_text: true,
        derivation: Derivation::default(),
        keep,
        limits,
        drawing: None,
    }
}

/// A row of a card at 10 kHz: two shafts that turn, and noise of some steps.
fn row(n: u64) -> Row {
    let noise = |salt: u64| {
        let mut x = (n * 2 + salt).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        x ^= x >> 29;
        x.wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 61
    };
    let swing = ((n as f64 * 1e-4).sin() * 1e6) as i64;
    let position = |channel: u64| {
        let even = n * 13_422 * (channel + 2) / 2 + noise(channel);
        (even as i64 + swing).rem_euclid(TURN as i64) as u64
    };
    let cell = |channel| Cell {
        position: Some(position(channel)),
        fresh: n != 777,
        cause: if n == 777 { "crc" } else { "none" },
        infos: [None; 2],
    };
    Row {
        run: None,
        trigger: n,
        cycles: n * 10_000,
        missing: 0,
        cells: vec![cell(0), cell(1)],
    }
}

fn record(wishes: Wishes, rows: impl IntoIterator<Item = u64>) -> Recorder {
    let mut recorder = Recorder::begin(wishes).unwrap();
    for n in rows {
        recorder.row(row(n)).unwrap();
    }
    recorder.end().unwrap();
    recorder
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap();
    let mut all: Vec<PathBuf> = entries.map(|e| e.unwrap().path()).collect();
    all.sort();
    all
}

fn stats(files: &[PathBuf]) -> Stats {
    let mut all = None;
    read_all(files, false, &mut |head, row| {
        all.get_or_insert_with(|| Stats::new(head, 100)).push(row);
    })
    .unwrap();
    all.unwrap()
}

/// Catches a row that is in two files or in none, and a file that cannot be read alone.
#[test]
fn a_recording_in_parts_has_every_row_once_and_goes_on_when_resumed() {
    for (name, format, limits) in [
        ("r.csv", Format::Csv, Limits::of(Some(40_000), None)),
        ("r.jsonl", Format::Jsonl, Limits::of(None, Some(3_000_000))),
        (
            "r.parquet",
            Format::Parquet,
            Limits::of(None, Some(5_000_000)),
        ),
    ] {
        let dir = tempfile::tempdir().unwrap();
        let target = |resume| Target::Numbered {
            path: dir.path().join(name),
            resume,
        };
        let recorder = record(wishes(target(false), format, Keep::All, limits), 0..2_000);
        let parts = files(dir.path());
        assert!(parts.len() > 3, "{parts:?}");
        assert_eq!(parts.len() as u32, recorder.parts());
        if let Some(cycles) = limits.cycles {
            assert_eq!(
                parts.len() as u64,
                20_000_000u64.div_ceil(cycles),
                "{parts:?}"
            );
        }
        let each: u64 = parts
            .iter()
            .map(|p| stats(std::slice::from_ref(p)).rows)
            .sum();
        let all = stats(&parts);
        assert_eq!((each, all.rows, all.bad_rows), (2_000, 2_000, 1), "{name}");
        assert!((all.duration_s() - 0.1999).abs() < 1e-9);
        assert_eq!(all.channels[0].tally.bad["crc"], 1);
        let before: Vec<Vec<u8>> = parts.iter().map(|p| fs::read(p).unwrap()).collect();
        assert!(Recorder::begin(wishes(target(false), format, Keep::All, limits)).is_err());
        let mut again = wishes(target(true), format, Keep::All, limits);
        again.about.start += Duration::from_secs(60);
        record(again, 0..500);
        let now = files(dir.path());
        assert!(now.len() > parts.len());
        let same = now
            .iter()
            .zip(&before)
            .all(|(p, b)| &fs::read(p).unwrap() == b);
        assert!(same, "{name}: what was there has changed");
        let both = stats(&now);
        assert_eq!(both.rows, 2_500);
        assert!(
            (both.duration_s() - 60.0499).abs() < 1e-6,
            "{}",
            both.duration_s()
        );
    }
}

/// Catches a file that grows without end, a row that is lost where the next one begins, and a file of another recording replaced.
#[test]
fn behind_a_file_with_all_its_groups_another_one_begins() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("long.parquet");
    fs::write(dir.path().join("long-0004.parquet"), "of another one").unwrap();
    let target = Target::One { path, force: false };
    let limits = Limits {
        groups: Some(1),
        ..Limits::of(None, None)
    };
    let rows = 524_288 + 10;
    let recorder = record(wishes(target, Format::Parquet, Keep::All, limits), 0..rows);
    assert_eq!(recorder.parts(), 2);
    let names = ["long.parquet", "long-0005.parquet"].map(|name| dir.path().join(name));
    assert_eq!(recorder.name(), names[1].display().to_string());
    let turned = [names[1].clone(), names[0].clone()];
    for given in [&names[..], &turned, &names[..1]] {
        let all = stats(given);
        assert_eq!((all.rows, all.missing), (rows, 0), "{given:?}");
    }
    let notes = read_all(&names[..1], false, &mut |_, _| {}).unwrap().notes;
    assert!(notes[0].contains("long-0004.parquet: is cut off, or of another"));
    assert!(
        notes[1].contains("goes on in 1 more")
            && notes[1].ends_with("long-0005.parquet: read, too"),
        "{notes:?}"
    );
    assert_eq!(stats(&names[1..]).rows, 10);
    let alone = read_all(&names[1..], false, &mut |_, _| {}).unwrap().notes;
    assert!(
        alone[0].contains("long-0005.parquet: goes on behind") && alone[0].contains("long.parquet"),
        "{alone:?}"
    );
    assert_eq!(alone.len(), 1);
    let misfits = read_all(&names, false, &mut |_, _| {}).unwrap().misfits;
    assert_eq!(misfits.rows, 0, "{misfits:?}");
    // One that is gone is no pause.
    let third = dir.path().join("third.parquet");
    let target = Target::One {
        path: third.clone(),
        force: false,
    };
    record(
        wishes(target, Format::Parquet, Keep::All, limits),
        rows + 7..rows + 20,
    );
    // A copy of the first file under another name has no numbered files.
    let first = dir.path().join("first.parquet");
    fs::copy(&names[0], &first).unwrap();
    let gone = read_all(&[first, third], false, &mut |_, _| {}).unwrap();
    assert_eq!((gone.misfits.rows, gone.misfits.triggers), (1, 17));
}

#[test]
fn an_event_has_a_file_with_what_was_before_it() {
    let dir = tempfile::tempdir().unwrap();
    let target = Target::One {
        path: dir.path().join("event.parquet"),
        force: false,
    };
    let faults = Faults::named(&["crc".into()], Judge::default()).unwrap();
    let keep = Keep::around(faults, 100, 50, 1);
    let waiting = wishes(target, Format::Parquet, keep, Limits::of(None, None));
    let mut recorder = Recorder::begin(waiting).unwrap();
    for n in 0..777 {
        recorder.row(row(n)).unwrap();
    }
    assert_eq!(files(dir.path()), [] as [PathBuf; 0]);
    for n in 777..900 {
        if !recorder.is_over() {
            recorder.row(row(n)).unwrap();
        }
    }
    let mut triggers = Vec::new();
    read_all(&files(dir.path()), false, &mut |_, row| {
        triggers.extend(row.trigger)
    })
    .unwrap();
    assert_eq!(triggers, (677..828).collect::<Vec<u64>>());
}

/// An hour of two channels at 10 kHz, as far as these rows go.
fn hour(rows: u64) -> f64 {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("hour.parquet");
    let target = Target::One {
        path: path.clone(),
        force: false,
    };
    let recorder = record(
        wishes(target, Format::Parquet, Keep::All, Limits::of(None, None)),
        0..rows,
    );
    assert_eq!(recorder.written(), rows);
    // The reader finds the other files of the hour by itself.
    let found = stats(&[path]);
    assert_eq!((found.rows, found.missing), (rows, 0));
    assert_eq!(found.channels[0].track.count, rows - 1);
    let noise = found.channels[0].track.noise().unwrap().0 / (360.0 / TURN as f64);
    assert!((2.0..2.8).contains(&noise), "{noise} steps");
    let sizes = files(dir.path());
    let sizes = sizes.iter().map(|file| fs::metadata(file).unwrap().len());
    let bytes = sizes.sum::<u64>() as f64;
    bytes / rows as f64 * 36e6 / 1e6
}

/// Catches columns that are not packed: plain ones take 1.5 GB.
#[test]
fn an_hour_of_two_channels_is_below_300_megabytes() {
    let megabytes = hour(140_000);
    assert!(megabytes < 300.0, "{megabytes:.0} MB");
}

/// All of it: a minute with `--release`. Memory is that of a group of rows, however long it takes.
#[test]
#[ignore = "slow: an hour of rows in a Parquet file"]
fn a_whole_hour_is_recorded_in_constant_memory() {
    let megabytes = hour(36_000_000);
    assert!(megabytes < 300.0, "{megabytes:.0} MB");
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    let peak: Option<u64> = peak.and_then(|l| l.trim().trim_end_matches(" kB").parse().ok());
    assert!(peak.is_none_or(|kb| kb < 400_000), "{peak:?} kB");
    println!("an hour: {megabytes:.0} MB, at most {peak:?} kB of memory");
}
