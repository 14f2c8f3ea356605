//! The emitted test bench of the receiver: passes as it stands, and fails on every broken receiver.

use crate::tools;
use crate::verilog::mutations::{mutation, Mutation};
use crate::verilog::testbench::{assert_passes, check_mutations, run_bench};
use endat_gen::artifact::Artifact;
use endat_gen::config::{parse_any, preset, Configuration};
use endat_gen::t_format::emit;

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

/// Both rates first, every kind of request at the pin, the shortest and the longest pauses and filters.
#[test]
fn it_passes_on_receivers() {
    if !tools::require("iverilog", "test bench of the receiver") {
        return;
    }
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
        assert_passes(&run_bench(&name, &emitted(changes), &[]));
    }
}

const TOP: &str = "";
const STROBES: &str = "bus_strobes";
const EXCHANGE: &str = "exchange";
const OUTCOME: &str = "outcome";

#[test]
fn it_fails_on_every_broken_receiver() {
    if tools::require("iverilog", "mutations of the receiver") {
        check_mutations("receiver", &emitted(&[]), MUTATIONS);
    }
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
        "3'd6: begin\n                    settings_next = strobes_written_data;",
        "3'd6: begin\n                    settings_next = settings;",
    ),
    mutation(
        "settings taken within an exchange",
        TOP,
        "can_write = !channel_busy & !start;",
        "can_write = 1'b1;",
    ),
    mutation(
        "trigger pin dead",
        TOP,
        "start_next = trigger_1 & !trigger_2;",
        "start_next = 1'b0;",
    ),
    mutation(
        "trigger pin: both edges",
        TOP,
        "start_next = trigger_1 & !trigger_2;",
        "start_next = trigger_1 ^ trigger_2;",
    ),
    mutation(
        "data one clock later",
        TOP,
        "assign bus_data_o = out_data;",
        "reg [15:0] later;\n    always @(posedge clk_i) later <= out_data;\n    assign bus_data_o = later;",
    ),
    mutation(
        "data one clock sooner",
        TOP,
        "assign bus_data_o = out_data;",
        "assign bus_data_o = chosen;",
    ),
    mutation(
        "data driven without chip select",
        TOP,
        "bus_data_oe = !bus_cs_n_i & !bus_rd_n_i;",
        "bus_data_oe = !bus_rd_n_i;",
    ),
    mutation(
        "no moment: address 0 takes nothing",
        TOP,
        "if (is_first & !was_first) begin",
        "if (1'b1) begin",
    ),
    mutation(
        "bytes of the multi-turn position exchanged",
        TOP,
        "chosen_next = seen_multi[23:8];",
        "chosen_next = {seen_multi[15:8], seen_multi[23:16]};",
    ),
    mutation(
        "communication alarm: delimiter missing",
        TOP,
        "({7'd0, seen_flags[6]} << 2'd3)",
        "8'd0",
    ),
    mutation(
        "another ID taken for that of the request",
        TOP,
        "repeats = !(|seen_flags[5:0]);",
        "repeats = !(|seen_flags[4:0]);",
    ),
    mutation(
        "busy not shown",
        TOP,
        "({15'd0, channel_busy} << 4'd15)",
        "16'd0",
    ),
    mutation(
        "data of a write taken after the strobe",
        STROBES,
        "assign written_data = last_data;",
        "assign written_data = data_1;",
    ),
    mutation(
        "a bad reply replaces the positions",
        OUTCOME,
        "take = publish & good;",
        "take = publish;",
    ),
    mutation(
        "overrun not kept",
        OUTCOME,
        "overrun_next = flags_in[15];",
        "overrun_next = 1'b0;",
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
