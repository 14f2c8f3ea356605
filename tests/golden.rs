//! Committed texts that the program makes. A difference is printed by lines, with the command that renews the file.

use std::fs;
use std::path::Path;

/// Equal lines shown before the first difference.
const BEFORE: usize = 2;
/// Most lines shown of either text.
const SHOWN: usize = 12;
/// Most characters shown of a line.
const COLUMNS: usize = 160;

/// Compares a committed file with the text that it must have. With `UPDATE_EXPECT` set, writes the file first.
///
/// # Panics
/// If the texts differ: with the lines that differ and the command that renews the file.
#[track_caller]
pub fn assert_committed(path: &Path, now: &str) {
    let read = || fs::read_to_string(path).unwrap_or_default();
    if std::env::var_os("UPDATE_EXPECT").is_some() && read() != now {
        fs::write(path, now).unwrap();
    }
    let Some(difference) = difference(&read(), now) else {
        return;
    };
    panic!(
        "{}: is not what the program makes now (-: committed, +: now)\n{difference}If the change is meant: {}",
        path.display(),
        renewing()
    );
}

/// The command that runs the current test again and lets it write its files.
pub fn renewing() -> String {
    let (package, binary) = (env!("CARGO_PKG_NAME"), env!("CARGO_CRATE_NAME"));
    let target = match package.replace('-', "_") == binary {
        true => "--lib".to_owned(),
        false => format!("--test {binary}"),
    };
    let command = format!("UPDATE_EXPECT=1 cargo test -p {package} {target}");
    // The harness names its threads after their tests, but with one thread it has none.
    match std::thread::current().name() {
        Some(test) if test != "main" => {
            format!("{command} -- --include-ignored --exact {test}")
        }
        _ => command,
    }
}

/// Lines that differ, with those before; none if the texts are equal.
pub fn difference(committed: &str, now: &str) -> Option<String> {
    if committed == now {
        return None;
    }
    let [old, new] = [committed, now].map(|text| text.split_inclusive('\n').collect::<Vec<_>>());
    let same = |pair: &(&&str, &&str)| pair.0 == pair.1;
    let first = old.iter().zip(&new).take_while(same).count();
    let (rest_old, rest_new) = (&old[first..], &new[first..]);
    let tail = rest_old.iter().rev().zip(rest_new.iter().rev());
    let tail = tail.take_while(same).count();
    let rest_old = &rest_old[..rest_old.len() - tail];
    let rest_new = &rest_new[..rest_new.len() - tail];
    let mut text = format!("  line {}:\n", first + 1);
    for line in &old[first.saturating_sub(BEFORE)..first] {
        text += &shown(' ', line, 0);
    }
    if rest_old.len() == rest_new.len() {
        // Changed lines, one against the other.
        let pairs = rest_old.iter().zip(rest_new).filter(|pair| !same(pair));
        let count = pairs.clone().count();
        for (old, new) in pairs.take(SHOWN) {
            let equal = old.chars().zip(new.chars()).take_while(|(a, b)| a == b);
            let from = equal.count();
            text += &(shown('-', old, from) + &shown('+', new, from));
        }
        text += &more(' ', count);
    } else {
        for (mark, lines) in [('-', rest_old), ('+', rest_new)] {
            let all = lines.iter().take(SHOWN);
            text.extend(all.map(|line| shown(mark, line, 0)));
            text += &more(mark, lines.len());
        }
    }
    Some(text)
}

/// A line, cut so that the character `from` is in it.
fn shown(mark: char, line: &str, from: usize) -> String {
    let body = line.strip_suffix('\n');
    let end = match body {
        Some(_) => "",
        None => " (no newline)",
    };
    let body = body.unwrap_or(line);
    let skipped = match body.chars().count() > COLUMNS {
        true => from.saturating_sub(COLUMNS / 4),
        false => 0,
    };
    let dots = |is_cut: bool| if is_cut { "..." } else { "" };
    let cut: String = body.chars().skip(skipped).take(COLUMNS).collect();
    let is_cut = body.chars().count() > skipped + COLUMNS;
    let (before, after) = (dots(skipped > 0), dots(is_cut));
    format!("{mark} {before}{cut}{after}{end}\n")
}

fn more(mark: char, count: usize) -> String {
    match count.saturating_sub(SHOWN) {
        0 => String::new(),
        more => format!("{mark} and {more} more lines\n"),
    }
}
