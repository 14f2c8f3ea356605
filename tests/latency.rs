//! `bench latency`: trigger to clock edge, sample to result, result to host.

use crate::program::good;
use endat_hdl::endat::channel::{TAIL_SAMPLE_TO_RESULT_CYCLES, TRIGGER_TO_FIRST_FALL_CYCLES};
use endat_sim::campaign::SAMPLE_LATENCY_CYCLES;
use serde_json::Value;
use std::sync::OnceLock;

/// What the command prints, run once.
fn report() -> &'static Value {
    static REPORT: OnceLock<Value> = OnceLock::new();
    REPORT.get_or_init(|| serde_json::from_str(&good(&["bench", "latency", "--json"])).unwrap())
}

fn page() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/size.md");
    std::fs::read_to_string(path).unwrap()
}

fn rows<'a>(report: &'a Value, kind: &str) -> &'a [Value] {
    report[kind].as_array().unwrap()
}

fn row<'a>(report: &'a Value, kind: &str, key: &str, name: &str) -> &'a Value {
    let found = rows(report, kind).iter().find(|row| row[key] == name);
    found.unwrap()
}

/// Cycles of a time, which must be the same time in ns.
fn cycles(row: &Value, key: &str) -> f64 {
    let figure = |unit: &str| row[key][unit].as_f64().unwrap();
    let ns = figure("cycles") * 1e9 / row["system_hz"].as_f64().unwrap();
    assert!((figure("ns") - ns).abs() < 1e-6, "{key}: {row}");
    figure("cycles")
}

#[test]
fn measured_latencies_of_every_preset_are_the_constants() {
    let report = report();
    let channels = rows(report, "channels");
    assert!(channels.len() >= 7, "{channels:?}");
    assert_eq!(report["not_measured"], serde_json::json!([]));
    for row in channels {
        let fall = cycles(row, "trigger_to_fall");
        assert_eq!(fall, TRIGGER_TO_FIRST_FALL_CYCLES as f64, "{row}");
        let result = cycles(row, "sample_to_result");
        assert_eq!(result, TAIL_SAMPLE_TO_RESULT_CYCLES as f64, "{row}");
        let pin = cycles(row, "pin_to_sample");
        assert!(pin >= SAMPLE_LATENCY_CYCLES as f64, "{row}");
        assert_eq!(cycles(row, "pin_to_result"), pin + result, "{row}");
    }
    // Its filter takes 20 ns, two cycles.
    let card = row(report, "channels", "preset", "s6_two_channel");
    let pin = cycles(card, "pin_to_sample");
    assert_eq!(pin, SAMPLE_LATENCY_CYCLES as f64 + 2.0);
}

#[test]
fn hosts_at_every_link_read_the_position_in_the_time_of_the_page() {
    let report = report();
    let page = page();
    let names = [
        "uart", "parallel", "apb", "wishbone", "axi_lite", "ahb_lite", "spi",
    ];
    assert_eq!(rows(report, "links").len(), names.len());
    for name in names {
        let row = row(report, "links", "bus", name);
        assert!(row["failure"].is_null(), "{row}");
        let host = cycles(row, "result_to_host");
        let ns = row["result_to_host"]["ns"].as_f64().unwrap();
        let wanted = format!("| `{name}` | {host} | {:.2} us |", ns / 1e3);
        assert!(page.lines().any(|line| line == wanted), "{wanted}");
    }
}

#[test]
fn latencies_on_the_page_are_the_constants_at_its_clocks() {
    let page = page();
    let ns = |cycles: u64, mhz: u64| cycles as f64 * 1e3 / mhz as f64;
    for (what, before, now) in [
        (
            "trigger to the first falling clock edge",
            3,
            TRIGGER_TO_FIRST_FALL_CYCLES,
        ),
        (
            "sample of the bit after the CRC to the result strobe",
            2,
            TAIL_SAMPLE_TO_RESULT_CYCLES,
        ),
        (
            "the same from the pin, without filter",
            2 + SAMPLE_LATENCY_CYCLES,
            TAIL_SAMPLE_TO_RESULT_CYCLES + SAMPLE_LATENCY_CYCLES,
        ),
        (
            "the same from the pin, with a filter of two cycles",
            4 + SAMPLE_LATENCY_CYCLES,
            TAIL_SAMPLE_TO_RESULT_CYCLES + SAMPLE_LATENCY_CYCLES + 2,
        ),
    ] {
        let wanted = format!(
            "| {what} | {before} cycles, {:.0} ns | {now} cycles, {:.0} ns |",
            ns(before, 107),
            ns(now, 130),
        );
        assert!(page.lines().any(|line| line == wanted), "{wanted}");
    }
}
