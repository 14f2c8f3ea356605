//! The page that compares, and the tables that translate for users of other systems.

use crate::program::good;
use crate::tools;
use endat_config::{load_preset, PRESETS};
use endat_hdl::regs::{blocks, present};
use endat_regs::{causes, service::request_state, EVIDENCE_FLAGS, INTERRUPT_EVENTS, LINE_FLAGS};
use endat_tools::area;
use std::path::Path;

/// The section that translates status bits; the tables that compare are before it.
const STATUS: &str = "## Status bits of ENDAT-IF";

/// Catches a figure that was typed, and one that has changed since: in one table of each kind.
#[test]
fn two_tables_of_the_page_are_what_the_command_writes() {
    let page = include_str!("../docs/comparison.md");
    for table in endat_workshop::bench::comparison_sample().unwrap() {
        let head = table.lines().find(|line| line.starts_with("## ")).unwrap();
        let from = page
            .find(head)
            .unwrap_or_else(|| panic!("docs/comparison.md: {head}"));
        let end = (from + table.trim_start().len()).min(page.len());
        let committed = page.get(from..end).unwrap_or(&page[from..]);
        let difference = tools::difference(committed, table.trim_start());
        assert!(
            difference.is_none(),
            "docs/comparison.md (-: committed, +: now)\n{}If the change is meant: cargo run --release -p endat-workshop -- bench comparison > docs/comparison.md",
            difference.unwrap_or_default()
        );
    }
}

#[test]
#[ignore = "slow: every table of the comparison"]
fn the_page_is_what_the_command_writes() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/comparison.md");
    let now = good(&["bench", "comparison"]);
    tools::assert_committed(&path, &now);
}

/// Catches a figure of the data file that was typed.
#[test]
#[ignore = "slow: logic cells that nextpnr packs"]
fn logic_cells_are_what_place_and_route_packs() {
    if !area::is_available() {
        assert!(
            std::env::var_os("CI").is_none(),
            "CI is set: yosys is required"
        );
        return eprintln!("skipped: yosys is not installed");
    }
    let table: toml::Table = include_str!("data/logic_cells.toml").parse().unwrap();
    for (name, cells) in &table {
        let subjects = area::subjects().unwrap();
        let subject = subjects.iter().find(|s| s.name == name).unwrap();
        let files = subject.files();
        let folder = tools::folder(&format!("logic_cells_{name}"));
        let packed = area::logic_cells(&folder, &files, name).unwrap();
        for (what, used) in [("cells", packed.cells), ("rams", packed.rams)] {
            let told = cells.get(what).and_then(|c| c.as_integer());
            assert_eq!(told, Some(used as i64), "{name}: {what}");
        }
    }
}

/// Catches a right side that is said to be measured in words, and a row that does not say.
#[test]
fn the_page_tells_what_is_measured() {
    let page = include_str!("../docs/comparison.md");
    let (tables, _) = page.split_once(STATUS).unwrap();
    let rows = tables
        .lines()
        .filter(|l| l.starts_with("| ") && !l.starts_with("| |"));
    let mut kinds = std::collections::BTreeMap::new();
    for row in rows {
        let cells: Vec<&str> = row.split(" | ").collect();
        let kind = cells.last().unwrap().trim_end_matches('|').trim();
        *kinds.entry(kind).or_insert(0) += 1;
        let is_figure = cells[2].contains(|c: char| c.is_ascii_digit());
        assert!(kind != "measured" || is_figure, "{row}");
        assert!(
            ["measured", "synthesis", "description", "words"].contains(&kind),
            "{row}"
        );
    }
    assert!(kinds["measured"] >= 15 && kinds["words"] < 14, "{kinds:?}");
}

/// Catches a status bit that is left out, and a register, field, cause or flag that does not exist on that card.
#[test]
fn every_status_bit_of_the_peripheral_has_a_place_in_our_map() {
    let page = include_str!("../docs/comparison.md");
    let (_, page) = page.split_once(STATUS).unwrap();
    let card = load_preset("artinchip_endat_if").unwrap().card;
    let blocks: Vec<_> = blocks(&card).collect();
    let words = [
        causes::ENDAT,
        EVIDENCE_FLAGS,
        LINE_FLAGS,
        request_state::ERRORS,
        INTERRUPT_EVENTS,
    ]
    .concat();
    let known = |name: &str| match name.split('.').collect::<Vec<_>>()[..] {
        [word] => words.iter().any(|w| w.name == word),
        [block, register] => blocks
            .iter()
            .any(|b| b.name == block && b.register(register).is_some()),
        [block, register, field] => blocks
            .iter()
            .filter(|b| b.name == block)
            .filter_map(|b| present(b, &card).find(|r| r.name == register))
            .any(|r| r.field(field).is_some()),
        _ => false,
    };
    let mut bits = vec![];
    for row in page.lines().filter(|l| l.starts_with("| ")).skip(1) {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        bits.push(cells[1]);
        let names = cells[3].split('`').skip(1).step_by(2);
        for name in names.clone() {
            assert!(known(name), "{}: {name}", cells[1]);
        }
        assert!(
            names.count() > 0 || cells[3] == "the same" || cells[3].starts_with("the same:"),
            "{row}"
        );
    }
    let theirs = [
        "RX1", "RX2", "RX3", "F1", "F2", "CRC1", "CRC2", "CRC3", "MRSADR", "BUSY", "RM", "WRN",
        "WDG", "RXEND", "MBERR",
    ];
    assert_eq!(bits, theirs);
    let (_, rest) = page.rsplit_once("| MBERR").unwrap();
    let rest = rest.split_once('\n').unwrap().1;
    for name in rest.split('`').skip(1).step_by(2) {
        assert!(
            known(name) || ["service", "error", "result"].contains(&name),
            "{name}"
        );
    }
}

/// Catches a preset that the list forgets, and one whose first lines do not say what it is.
#[test]
fn presets_are_listed_with_a_line_each_and_explain_themselves() {
    let list = good(&["presets"]);
    for (name, text) in PRESETS {
        let line = list.lines().find(|l| l.starts_with(name));
        assert!(
            line.is_some_and(|l| l.len() > name.len() + 20),
            "{name}: {list}"
        );
        assert!(text.starts_with("# "), "{name}");
        good(&["explain", "--preset", name]);
    }
}
