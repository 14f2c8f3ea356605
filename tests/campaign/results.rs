//! Results of campaigns, as programs that count read them: the very lines of `docs/campaigns.md`.

use super::run;
use crate::tools;
use endat_campaign::part::Part;
use std::collections::BTreeMap;

const PAGE: &str = include_str!("../../docs/campaigns.md");

/// The lines of the page that begin with this.
fn lines(start: &str) -> Vec<&'static str> {
    let found: Vec<&str> = PAGE.lines().filter(|l| l.starts_with(start)).collect();
    assert!(!found.is_empty(), "{start}");
    found
}

/// Catches a file that they take for other columns or numbers, and a line of the page that does not run.
#[test]
fn duckdb_and_pandas_count_what_the_campaign_counted() {
    let check = "results in DuckDB and pandas";
    if !tools::require("duckdb", check) || !tools::require_python("pandas", check) {
        return;
    }
    let folder = tools::folder("campaign_results");
    let out = folder.join("upsets.csv");
    // Elsewhere an upset is seldom silent, and the page's question has no answer.
    let words = "campaign upsets --subject port --only clk_pin,clock_gen. --moments 30";
    let campaign: Vec<&str> = words.split(' ').collect();
    let outcome = run(&[&campaign[..], &["--out", out.to_str().unwrap()]].concat());
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    let tally = Part::read(&out).unwrap().tally;
    let mut silent: BTreeMap<String, u64> = BTreeMap::new();
    let mut kinds: BTreeMap<String, u64> = BTreeMap::new();
    for (row, count) in tally.rows() {
        if row.class == "silent" {
            *silent.entry(row.place.clone()).or_default() += count;
        }
        if row.class == "masked" {
            *kinds.entry(row.kind.clone()).or_default() += count;
        }
    }
    assert!(silent.len() > 1 && kinds.len() > 1, "{outcome:?}");
    let shell = |line: &str| {
        let (is_good, told) = tools::run("bash", &folder, &["-c", line]);
        assert!(is_good, "{line}: {told}");
        told
    };
    let [question, parquet] = lines("duckdb ")[..] else {
        panic!("two lines with duckdb");
    };
    let count = |text: &str| {
        let rows = text.lines().skip(1).filter_map(|l| l.split_once(','));
        let rows = rows.map(|(place, count)| (place.to_owned(), count.parse::<u64>().unwrap()));
        rows.collect::<BTreeMap<_, _>>()
    };
    assert_eq!(
        count(&shell(&question.replacen("duckdb", "duckdb -csv", 1))),
        silent
    );
    // The same from the Parquet file that the page makes.
    shell(parquet);
    let from_parquet = question.replacen("duckdb", "duckdb -csv", 1);
    let from_parquet = from_parquet.replace("upsets.csv", "upsets.parquet");
    assert_eq!(count(&shell(&from_parquet)), silent);
    let table = shell(lines("python3 ")[0]);
    let heads: Vec<&str> = table.lines().next().unwrap().split_whitespace().collect();
    let column = heads.iter().position(|head| *head == "masked").unwrap();
    for (kind, count) in kinds {
        let row = table
            .lines()
            .find(|l| l.starts_with(&format!("{kind} ")))
            .unwrap();
        let cells: Vec<&str> = row[kind.len()..].split_whitespace().collect();
        // The first head is that of the classes.
        let found: f64 = cells[column - 1].parse().unwrap();
        assert_eq!(found, count as f64, "{kind}: {table}");
    }
}
