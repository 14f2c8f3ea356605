//! Ways to break the T-format channels of an emitted card.

use super::mutations::{mutation, Mutation};

const EXCHANGE: &str = "exchange";
const ORDER: &str = "field_order";
const REPLY: &str = "reply";
const PORT: &str = "tformat_port";

/// All of them.
pub const T_FORMAT_MUTATIONS: &[Mutation] = &[
    mutation(
        "wrong parity of the request",
        "request_bits",
        "request_id[2] ^ request_id[3];",
        "request_id[2];",
    ),
    mutation(
        "wrong sync code",
        "request_bits",
        "{parity, request_id, 3'd2}",
        "{parity, request_id, 3'd6}",
    ),
    mutation(
        "CRC: wrong tap",
        EXCHANGE,
        "summed = wire_bit ^ (check[0] & !order_is_crc);",
        "summed = wire_bit ^ (check[1] & !order_is_crc);",
    ),
    mutation(
        "CRC of the reply not compared",
        EXCHANGE,
        "bad_crc_next = bad_crc | differs;",
        "bad_crc_next = bad_crc;",
    ),
    mutation(
        "CRC: only the last bit counts",
        EXCHANGE,
        "bad_crc_next = bad_crc | differs;",
        "bad_crc_next = differs;",
    ),
    mutation(
        "echo of the ID not compared",
        EXCHANGE,
        "{level, echo[3:1]};\n                                bad_echo_next = bad_echo | differs;",
        "{level, echo[3:1]};",
    ),
    mutation(
        "parity of the reply not checked",
        EXCHANGE,
        "bad_parity_next = bad_parity ^ level;",
        "bad_parity_next = bad_parity;",
    ),
    mutation(
        "delimiter not checked",
        EXCHANGE,
        "bad_delimiter_next = !level;",
        "bad_delimiter_next = 1'b0;",
    ),
    mutation(
        "header not checked",
        EXCHANGE,
        "if (differs) begin",
        "if (1'b0) begin",
    ),
    mutation(
        "silence taken for a spoilt header",
        EXCHANGE,
        "is_headless = missed & order_is_control & heard;",
        "is_headless = missed & order_is_control;",
    ),
    mutation(
        "reply gap too long",
        EXCHANGE,
        "timer_next = {1'b0, reply_gap_us};",
        "timer_next = {1'b0, reply_gap_us} + 7'd4;",
    ),
    mutation(
        "reply gap too short",
        EXCHANGE,
        "timer_next = {1'b0, reply_gap_us};",
        "timer_next = {1'b0, reply_gap_us} - 7'd3;",
    ),
    mutation(
        "pause between fields too long",
        EXCHANGE,
        "timer_next = {4'd0, field_gap_us};",
        "timer_next = {4'd0, field_gap_us} + 7'd4;",
    ),
    mutation(
        "no pause between fields",
        EXCHANGE,
        "timer_next = {4'd0, field_gap_us};",
        "timer_next = 7'd127;",
    ),
    mutation(
        "no time-out at all",
        EXCHANGE,
        "expired = timer[6] & !timer[1];",
        "expired = 1'b0;",
    ),
    mutation(
        "a line that is LOW not noticed",
        EXCHANGE,
        "!order_is_known | !level | unsettled",
        "!order_is_known | unsettled",
    ),
    mutation(
        "driver not released",
        EXCHANGE,
        "if (strobe) begin\n                    in_request = 1'b0;",
        "if (expired) begin\n                    in_request = 1'b0;",
    ),
    mutation(
        "driver released a bit too soon",
        EXCHANGE,
        "order_first = 1'b1;\n                            phase_next = PHASE_RELEASE;",
        "order_first = 1'b1;\n                            drives_next = 1'b0;\n                            phase_next = PHASE_RELEASE;",
    ),
    mutation(
        "complaint about the delimiter not taken for a fault",
        EXCHANGE,
        "is_good = is_whole & !(|raised[11:9]);",
        "is_good = is_whole & !(raised[9] | raised[11]);",
    ),
    mutation(
        "alarms hold the position",
        EXCHANGE,
        "is_good = is_whole & !(|raised[11:9]);",
        "is_good = is_whole & !(|raised[12:9]);",
    ),
    mutation(
        "EEPROM busy not noticed",
        EXCHANGE,
        "memory_busy_next = level;",
        "memory_busy_next = 1'b0;",
    ),
    mutation(
        "a bit one cycle too long",
        "bit_grid",
        "left <= bit_cycles;",
        "left <= bit_cycles + 7'd1;",
    ),
    mutation(
        "start bit half a bit late",
        "bit_grid",
        "left <= {1'b0, bit_cycles[6:1]};",
        "left <= bit_cycles;",
    ),
    mutation(
        "multi-turn before single-turn position",
        ORDER,
        "kind <= FIELD_KIND_SINGLE0;",
        "kind <= FIELD_KIND_MULTI0;",
    ),
    mutation(
        "no alarm field",
        ORDER,
        "kind <= FIELD_KIND_ALARM;",
        "kind <= FIELD_KIND_CRC;",
    ),
    mutation(
        "EEPROM data of a write not sent",
        ORDER,
        "if (sending & !is_write) begin",
        "if (sending) begin",
    ),
    mutation(
        "request 12 unknown",
        ORDER,
        "            4'd12: begin\n            end\n",
        "",
    ),
    mutation(
        "single-turn position MSB first",
        REPLY,
        "single_bits <= {level, single_bits[23:1]};",
        "single_bits <= {single_bits[22:0], level};",
    ),
    mutation(
        "status taken as it was before",
        REPLY,
        "take & is_status",
        "take & is_alarm",
    ),
    mutation(
        "a bad reply replaces the position",
        PORT,
        "takes = over & good & !is_own &",
        "takes = over & !is_own &",
    ),
    mutation(
        "a reply to the host gives a result",
        PORT,
        "snapshot_publish = over & !is_own;",
        "snapshot_publish = over;",
    ),
    mutation(
        "positions exchanged",
        PORT,
        "snapshot_position_in = {multi, single};",
        "snapshot_position_in = {single, multi};",
    ),
    mutation(
        "trigger overrun not told",
        PORT,
        "lost <= 1'b1;",
        "lost <= 1'b0;",
    ),
    mutation(
        "trigger within a request of the host not told",
        PORT,
        "if (loses) begin",
        "if (loses & !is_own) begin",
    ),
    mutation(
        "a trigger sends the host's last request",
        PORT,
        "if (own_now) begin",
        "if (own_now | done) begin",
    ),
    mutation(
        "causes of the flag below",
        PORT,
        ".cause_told(code)",
        ".cause_told({code[4:1], 1'b0})",
    ),
    mutation(
        "T-format channel not triggered",
        "card_core",
        ".trigger(trigger_of_0),\n        .period_cycles(",
        ".trigger(1'b0),\n        .period_cycles(",
    ),
];

/// What takes another channel, or an encoder whose clock is fast, to be seen: the second channel of the preset.
pub const MIXED_MUTATIONS: &[Mutation] = &[
    mutation(
        "fields not timed from their start bits",
        EXCHANGE,
        "heard_next = 1'b1;\n                    grid_restart = 1'b1;",
        "heard_next = 1'b1;",
    ),
    mutation(
        "time stamp of another edge",
        PORT,
        "snapshot_first_fall = !data_o & !started;",
        "snapshot_first_fall = !data_o;",
    ),
];
