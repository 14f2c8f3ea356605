//! What the published systems are for, in the emitted bench: usual clock rates, cropped positions, selected causes, the watchdog,
//! requests, continuous clock.

use super::mutations::{mutation, Mutation};
use super::testbench::{bench_passes, check_mutations, fit};
use endat_config::{load_preset, parse};
use endat_console::artifact::Artifact;
use endat_hdl::card::bus::HostBus;

const BROKEN: &[Mutation] = &[
    mutation(
        "crop begins at the first bit",
        "direct_output_pair_64",
        "at <= first_bit;",
        "at <= 6'd0;",
    ),
    mutation(
        "crop has no end",
        "direct_output_pair_68",
        "(taken < length_bits)",
        "(taken < 6'd32)",
    ),
    mutation(
        "selected causes stay",
        "direct_output_pair_64",
        "error_causes <= write_data;",
        "error_causes <= error_causes;",
    ),
    mutation(
        "watchdog never ends a frame",
        "line_health",
        "over <= under_way & (|watchdog_us)",
        "over <= under_way & (&watchdog_us)",
    ),
    mutation(
        "watchdog: the service does not tell it",
        "service_channel",
        "out_watchdog <= io_out[11:0];",
        "out_watchdog <= out_watchdog;",
    ),
    mutation(
        "recovery counter: kept at the falling edge of the clock",
        "recovery_counter_pair_32",
        "endat_clk & !clk_before",
        "!endat_clk & clk_before",
    ),
    mutation(
        "recovery counter: stands still",
        "recovery_counter_pair_36",
        "counter <= counter + 16'd1;",
        "counter <= counter;",
    ),
    mutation(
        "a written clock rate is not taken",
        "channel_registers_1",
        "period_cycles = config0[10:0];",
        "period_cycles = 11'd20;",
    ),
];

/// Shown by requests, and by runs of the continuous clock.
const BROKEN_SERVICES: &[Mutation] = &[
    mutation(
        "one bit of the parameter too few",
        "command_sender",
        "bits_left <= PARAMETER_BITS;",
        "bits_left <= PARAMETER_BITS - 5'd1;",
    ),
    mutation(
        "driver off while the parameter is sent",
        "command_sender",
        "oe = 1'b1;",
        "oe = 1'b0;",
    ),
    mutation(
        "address of a request one place too low",
        "service_channel",
        "{out_address, out_data}",
        "{1'b0, out_address, 15'd0} | {8'd0, out_data}",
    ),
    mutation(
        "a run that ends behind its first position",
        "transaction",
        "(!continuous | line_wanted",
        "(1'b1 | line_wanted",
    ),
    mutation(
        "receivers that disagree, and nobody tells it",
        "second_receiver",
        "different <= 1'b1;",
        "different <= 1'b0;",
    ),
    mutation(
        "a run that the host cannot end",
        "transaction",
        "(!continuous | line_wanted",
        "(1'b0 | line_wanted",
    ),
];

fn card() -> Vec<Artifact> {
    let more =
        "[service]\nparts = [\"requests\", \"diagnosis\"]\n[outputs]\nparts = [\"position\"]\n[safety]\nparts = [\"recovery_counter\"]\n";
    // Half a clock period more or less is to be seen in a recovery time.
    slow("50_000_000", more)
}

/// A card whose clock is slow: the bench waits for milliseconds, each of which costs simulated cycles.
fn slow(system_hz: &str, more: &str) -> Vec<Artifact> {
    let text = crate::bus_card::text(HostBus::Apb, more)
        .replace("100_000_000", system_hz)
        .replace("3_125_000", "2_500_000")
        .replace("= [\"register\"]", "= [\"pin\"]");
    endat_emit::emit(&parse("card.toml", &text).unwrap()).unwrap()
}

/// Needs no outside tool. `bench_of_a_quick_card_passes_and_fails_on_broken_cards` runs the steps of the outputs.
#[test]
fn mutations_of_what_systems_are_for_fit() {
    fit(&card(), BROKEN);
    fit(&slow("25_000_000", SERVED), BROKEN_SERVICES);
    fit(&without_initial_values(ASKED), BROKEN_START);
    fit(&without_initial_values(LISTED), BROKEN_INFOS);
}

#[test]
#[ignore = "slow: every mutation of outputs, watchdog and clock rates"]
fn bench_of_a_card_for_a_control_loop_passes_only_as_it_stands() {
    check_mutations("purpose", &card(), BROKEN);
}

/// Requests, runs of the continuous clock, a second receiver and forced errors.
const SERVED: &str = "[service]\nparts = [\"requests\", \"continuous\"]\n[safety]\nparts = [\"second_receiver\", \"error_test\"]\n";

#[test]
#[ignore = "slow: every mutation of requests and runs"]
fn bench_of_a_card_with_services_passes_only_as_it_stands() {
    check_mutations("services", &slow("25_000_000", SERVED), BROKEN_SERVICES);
}

/// Shown by additional data.
const BROKEN_INFOS: &[Mutation] = &[
    mutation(
        "a LOW bit too few before the supplement",
        "command_sender",
        "cells_left <= 4'd9;",
        "cells_left <= 4'd8;",
    ),
    mutation(
        "additional data that have ended are waited for",
        "add_info",
        "is_off = &mrs[3:0];",
        "is_off = 1'b0;",
    ),
    mutation(
        "additional data 2 taken for additional data 1",
        "add_info",
        "second <= word;",
        "first <= word;",
    ),
];

/// Of a device that gives nothing a start value: seen by unknown values, of which this simulator's registers and RAM are full.
const BROKEN_START: &[Mutation] = &[
    mutation(
        "the histogram is not cleared",
        "line_monitor",
        "frames <= 32'd0;\n                clearing <= 1'b1;",
        "frames <= 32'd0;\n                clearing <= 1'b0;",
    ),
    mutation(
        "only some of the services' RAM is cleared",
        "sequencer",
        "program_read_data <= 20'hff;",
        "program_read_data <= 20'h7;",
    ),
    mutation(
        "a register that no reset sets",
        "timebase",
        "cycles <= 32'd0;",
        "",
    ),
];

/// Parts of the service: requests and diagnosis, or requests with a list of additional data.
const ASKED: &str = "\"requests\", \"diagnosis\"";
const LISTED: &str = "\"requests\"]\ninfos = [0x4C, 0x59";

/// A card with these parts of the service, and without start values.
fn without_initial_values(parts: &str) -> Vec<Artifact> {
    let more = format!(
        "[service]\nparts = [{parts}]\n[line]\nparts = [\"alignment\", \"margin\"]\n\
         [outputs]\nparts = [\"interrupt\"]\n[device]\ninitial_values = false\n"
    );
    let text = crate::bus_card::text(HostBus::Wishbone, &more)
        .replace("100_000_000", "12_500_000")
        .replace("= [\"register\"]", "= [\"pin\"]");
    let card = endat_emit::emit(&parse("card.toml", &text).unwrap()).unwrap();
    for file in card
        .iter()
        .filter(|f| f.path.ends_with(".v") && !f.path.contains("_tb"))
    {
        // Below the FORMAL line stand the properties, which no hardware keeps.
        let hardware = file.text.split("`ifdef FORMAL").next().unwrap();
        assert!(!hardware.contains("initial "), "{}", file.path);
    }
    card
}

/// Catches a card for Synplify, which ignores them, that has start values in a memory; and a page that no longer says so.
#[test]
fn what_synplify_ignores_is_in_no_card_without_initial_values() {
    let page = include_str!("../../docs/boards.md");
    let said = page.lines().find(|l| l.starts_with("**Synplify**"));
    assert!(said.is_some_and(|l| l.contains("`[device] initial_values = false` avoids that")));
    without_initial_values(ASKED);
    // The same card with start values has them where Synplify reads none.
    let text = crate::bus_card::text(HostBus::Wishbone, "");
    let card = endat_emit::emit(&parse("card.toml", &text).unwrap()).unwrap();
    assert!(card.iter().any(|file| file.text.contains("initial ")));
}

/// Catches what only start values bring to life, and a bench that does not see it.
#[test]
#[ignore = "slow: bench without start values, and its mutations"]
fn a_card_without_initial_values_comes_to_life_by_its_reset() {
    let card = without_initial_values(ASKED);
    check_mutations("start", &card, BROKEN_START);
}

/// The same where the bench gives the services another list, and another program.
#[test]
#[ignore = "slow: services without start values"]
fn services_without_initial_values_come_to_life_by_their_reset() {
    let list = without_initial_values(LISTED);
    check_mutations("start-list", &list, BROKEN_INFOS);
    let initialise = without_initial_values("\"requests\", \"initialise\"");
    bench_passes("start-initialise", &initialise, &[]);
}

/// Catches a bench that leaves out what a published system is for.
#[test]
fn benches_of_the_published_systems_do_what_those_are_for() {
    let wanted: [(&str, &[&str]); 5] = [
        (
            "artinchip_endat_if",
            &[
                "clock rates",
                "cropped position",
                "selected causes",
                "watchdog",
                "requests",
                "additional data",
                "continuous clock",
                "interrupt",
            ],
        ),
        (
            "clb_2mhz",
            &[
                "clock rates",
                "cropped position",
                "selected causes",
                "interrupt",
            ],
        ),
        (
            "ti_three_channel",
            &[
                "clock rates",
                "cropped position",
                "selected causes",
                "watchdog",
                "requests",
                "continuous clock",
                "power-up",
            ],
        ),
        ("mixed_protocols", &["clock rates"]),
        (
            "s6_two_channel_service",
            &[
                "clock rates",
                "watchdog",
                "requests",
                "continuous clock",
                "power-up",
            ],
        ),
    ];
    for (name, steps) in wanted {
        let files = endat_emit::emit(&load_preset(name).unwrap()).unwrap();
        let bench = files.iter().find(|f| f.path.ends_with("_tb.v")).unwrap();
        for step in steps {
            let told = format!("tell(\"{step}\");");
            assert_eq!(bench.text.matches(&told).count(), 1, "{name}: {step}");
        }
        if name == "artinchip_endat_if" {
            // All seven rates of the peripheral.
            assert_eq!(bench.text.matches("            check_periods(").count(), 7);
        }
    }
}

#[test]
#[ignore = "slow: bench of a preset with slow clock rates"]
fn bench_of_a_control_loop_passes_at_slow_clock_rates() {
    let files = endat_emit::emit(&load_preset("clb_2mhz").unwrap()).unwrap();
    bench_passes("purpose-clb", &files, &["+slow"]);
}
