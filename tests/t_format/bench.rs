//! The emitted test bench of the receiver: passes on the receiver, and fails on every broken receiver.

use crate::verilog::mutations::{mutation, Mutation};
use crate::verilog::testbench::{bench_passes, check_mutations, check_some};
use endat_config::{parse_any, preset, Configuration};
use endat_console::artifact::Artifact;
use endat_emit::protocols::t_format::emit;

/// The preset with other keys.
fn emitted(changes: &[(&str, &str)]) -> Vec<Artifact> {
    let mut text = preset("async_dsp").unwrap().to_owned();
    for (from, to) in changes {
        assert_eq!(text.matches(from).count(), 1, "{from}");
        text = text.replacen(from, to, 1);
    }
    match parse_any("receiver.toml", &text).unwrap() {
        Configuration::Receiver(receiver) => emit(&receiver).unwrap(),
        Configuration::Card(_) => panic!("a card"),
    }
}

/// Both rates, every kind of request at the pin, the shortest and the longest pauses and filters.
#[test]
#[ignore = "slow: benches of three receivers"]
fn it_passes_on_receivers() {
    let rows: [&[(&str, &str)]; 3] = [
        &[],
        &[
            ("bit_hz = 2_500_000  ", "bit_hz = 5_000_000  "),
            ("request = 3 ", "request = 13 "),
            ("reply_gap_us = 20", "reply_gap_us = 1"),
            ("field_gap_us = 2", "field_gap_us = 0"),
            ("filter_cycles = 1 ", "filter_cycles = 0 "),
        ],
        &[
            ("request = 3 ", "request = 6 "),
            ("reply_gap_us = 20", "reply_gap_us = 63"),
            ("field_gap_us = 2", "field_gap_us = 7"),
            ("filter_cycles = 1 ", "filter_cycles = 3 "),
        ],
    ];
    for (index, changes) in rows.into_iter().enumerate() {
        let name = format!("receiver{index}");
        bench_passes(&name, &emitted(changes), &[]);
    }
}

const TOP: &str = "";
const STROBES: &str = "bus_strobes";
const EXCHANGE: &str = "exchange";
const BANKS: &str = "result_banks";
const VERDICT: &str = "verdict_bytes";

#[test]
fn it_passes_on_the_preset_and_fails_on_broken_receivers() {
    let names = ["data one clock sooner", "CRC of a request wrong"];
    check_some("receiver-quick", &emitted(&[]), MUTATIONS, &names);
}

#[test]
#[ignore = "slow: every mutation of the receiver"]
fn it_fails_on_every_broken_receiver() {
    check_mutations("receiver", &emitted(&[]), MUTATIONS);
}

/// Ways to break the receiver; those of [`EXCHANGE`] are a card's, too, and mostly tried there.
const MUTATIONS: &[Mutation] = &[
    mutation(
        "clk_select ignored",
        TOP,
        "select_1 <= select_0;",
        "select_1 <= 1'b0;",
    ),
    mutation(
        "a microsecond of another clock",
        TOP,
        "US_CYCLES_1 = 6'd59;",
        "US_CYCLES_1 = 6'd47;",
    ),
    mutation(
        "5 Mbit/s at 60 MHz too slow",
        TOP,
        "BIT_CYCLES_3 = 5'd12;",
        "BIT_CYCLES_3 = 5'd13;",
    ),
    mutation(
        "rate not to be set",
        TOP,
        "3'd6: begin\n                        settings <= strobes_written_data;",
        "3'd6: begin\n                        settings <= settings;",
    ),
    mutation(
        "settings taken within an exchange",
        TOP,
        "can_write = !exchange_busy & !start;",
        "can_write = 1'b1;",
    ),
    mutation(
        "trigger pin dead",
        TOP,
        "start <= trigger_1 & !trigger_2;",
        "start <= 1'b0;",
    ),
    mutation(
        "trigger pin: both edges",
        TOP,
        "start <= trigger_1 & !trigger_2;",
        "start <= trigger_1 ^ trigger_2;",
    ),
    mutation(
        "data one clock later",
        BANKS,
        "assign word = out_data;",
        "reg [15:0] later;\n    always @(posedge clock) later <= out_data;\n    assign word = later;",
    ),
    mutation(
        "data one clock sooner",
        BANKS,
        "assign word = out_data;",
        "assign word = {high_byte, low_byte};",
    ),
    mutation(
        "data driven without chip select",
        TOP,
        "bus_data_oe = !bus_cs_n_i & !bus_rd_n_i;",
        "bus_data_oe = !bus_rd_n_i;",
    ),
    mutation(
        "no moment: the last result is shown",
        BANKS,
        "takes = is_first & !was_first;",
        "takes = 1'b1;",
    ),
    mutation(
        "bytes of the multi-turn position exchanged",
        "reply_bytes",
        "byte_bits <= multi_bits[7:0];",
        "byte_bits <= multi_bits[15:8];",
    ),
    mutation(
        "communication alarm: delimiter missing",
        VERDICT,
        "flags[5:4], flags[6],",
        "flags[5:4], 1'b0,",
    ),
    mutation(
        "another ID taken for that of the request",
        VERDICT,
        "repeats = !(|flags[5:0]);",
        "repeats = !(|flags[4:0]);",
    ),
    mutation(
        "busy not shown",
        TOP,
        ".busy(exchange_busy),\n        .word(",
        ".busy(1'b0),\n        .word(",
    ),
    mutation(
        "data of a write taken after the strobe",
        STROBES,
        "if (!cs_n & !wr_n) begin",
        "if (1'b1) begin",
    ),
    mutation(
        "a bad reply replaces the positions",
        BANKS,
        "takes_single = good & has_single;",
        "takes_single = has_single;",
    ),
    mutation(
        "overrun not kept",
        EXCHANGE,
        "overrun_next = overrun;\n                        index_next",
        "overrun_next = 1'b0;\n                        index_next",
    ),
    mutation(
        "CRC of a request wrong",
        EXCHANGE,
        "summed = wire_bit ^ (check[0] & !order_is_crc);",
        "summed = wire_bit ^ check[0];",
    ),
    mutation(
        "CRC of the reply not compared",
        EXCHANGE,
        "bad_crc_next = bad_crc | differs;",
        "bad_crc_next = bad_crc;",
    ),
    mutation(
        "sends into what the encoder still says",
        EXCHANGE,
        "!order_is_known | !level | unsettled",
        "!order_is_known",
    ),
];
