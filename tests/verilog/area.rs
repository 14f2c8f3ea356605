//! Budgets: the exact area of card, channel and blocks.

use crate::tools;
use endat_tools::area::{self, Family, Subject, Usage, ICE40, XC6S};
use std::fmt::Write as _;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{LazyLock, OnceLock};

const TABLE: &str = "tests/data/area.toml";
const HEAD: &str = "# LUTs and flip-flops after synthesis with yosys 0.70, exact. Renew with: UPDATE_EXPECT=1 cargo test --test emission area -- --ignored\n";

/// Everything that is measured; elaborated once for all tests.
pub fn subjects() -> &'static [Subject] {
    static ALL: LazyLock<Vec<Subject>> = LazyLock::new(|| area::subjects().unwrap());
    &ALL
}

/// The subject of this name.
pub fn subject(name: &str) -> &'static Subject {
    subjects().iter().find(|s| s.name == name).unwrap()
}

/// True if the synthesis tool is installed in the version that the figures are made with.
pub fn require(check: &str) -> bool {
    if !tools::require(area::YOSYS, check) {
        return false;
    }
    let is_right = area::is_available();
    if !is_right {
        let why = format!("{} is not {}", area::YOSYS, area::YOSYS_VERSION);
        tools::lacks(&why, check);
    }
    is_right
}

fn usage(subject: &Subject, family: &Family) -> Usage {
    let folder = tools::folder(&format!("area-{}-{}", subject.name, family.name));
    let found = area::synthesise(&folder, &subject.files(), subject.name, family);
    found.unwrap().usage
}

/// Families that a subject is measured for. Of fronts the pages tell one; `area` measures both.
fn families(subject: &Subject) -> &'static [Family] {
    match subject.name.starts_with("card_") {
        true => &[XC6S],
        false => &[XC6S, ICE40],
    }
}

/// A row of the table.
fn row(family: &Family, Usage { lut, ff }: Usage) -> String {
    format!("{} = {{ lut = {lut}, ff = {ff} }}", family.name)
}

/// Subjects of the quick test, for the family whose flow is the quicker one: a channel, which holds most of the blocks, and blocks that it
/// does not hold.
const QUICK: [&str; 3] = ["channel", "crc5_fixed_31", "set_channel"];

/// Catches a change of a channel's area. The slow test has the other subjects and the other family.
#[test]
fn area_of_a_channel_is_exactly_what_the_table_says() {
    if !require("area budgets") {
        return;
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(TABLE);
    let table = std::fs::read_to_string(&path).unwrap();
    for name in QUICK {
        let rows = table.split(&format!("\n[{name}] ")).nth(1).unwrap();
        let rows = rows.split("\n[").next().unwrap();
        let found = row(&ICE40, usage(subject(name), &ICE40));
        assert!(
            rows.lines().any(|line| line == found),
            "{name}: {found}, table: {rows}\nIf the change is meant: UPDATE_EXPECT=1 cargo test --test emission area -- --ignored"
        );
    }
}

#[test]
#[ignore = "slow: area of every subject in both families"]
fn area_is_exactly_what_the_table_says() {
    if !require("area budgets") {
        return;
    }
    let subjects = subjects();
    let next = AtomicUsize::new(0);
    let measured: Vec<OnceLock<Vec<Usage>>> = subjects.iter().map(|_| OnceLock::new()).collect();
    let work = || loop {
        let index = next.fetch_add(1, Ordering::Relaxed);
        let Some(subject) = subjects.get(index) else {
            return;
        };
        let usages = families(subject).iter().map(|f| usage(subject, f));
        let _ = measured[index].set(usages.collect());
    };
    std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(work))));

    let mut found = String::from(HEAD);
    let mut above = vec![];
    for (subject, usages) in subjects.iter().zip(&measured) {
        let _ = writeln!(found, "\n[{}] # {}", subject.name, subject.title);
        for (family, usage) in families(subject).iter().zip(usages.get().unwrap()) {
            let _ = writeln!(found, "{}", row(family, *usage));
            let ceiling = match (subject.name, family.name) {
                ("channel", "xc6s") => 355,
                // Some 110 of these put the position before back when one is withdrawn; guards take 100 more.
                ("channel_restore", "xc6s") => 465,
                ("channel_guards", "xc6s") => 570,
                // The mapping alone moves this by ten up or down with any change.
                ("card", "xc6s") => 1_250,
                ("card_stream", "xc6s") => 1_480,
                ("card_unguarded", "xc6s") => 2_950,
                // With guards: two parallel CRC5 in each channel, one over the stored word.
                ("card_service", "xc6s") => 3_300,
                _ => continue,
            };
            if usage.lut > ceiling {
                above.push(format!(
                    "{}: {} LUT, aim {ceiling}",
                    subject.name, usage.lut
                ));
            }
        }
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(TABLE);
    tools::assert_committed(&path, &found);
    assert!(above.is_empty(), "{above:?}");
}
