//! Ways to break the emitted VHDL of a card: one text in one file becomes another.

use crate::verilog::mutations::{mutation, Mutation};

/// All of them.
pub const MUTATIONS: &[Mutation] = &[
    mutation(
        "parallel CRC: wrong polynomial",
        "crc5_word",
        "\"110\" & x\"e14\"",
        "\"110\" & x\"e15\"",
    ),
    mutation(
        "parallel CRC: a part of the word is not in it",
        "crc5_word",
        "word(14 downto 0) xor word(29 downto 15)",
        "word(14 downto 0)",
    ),
    mutation(
        "parallel CRC: compared the other way",
        "receiver",
        "'1' when crc_bits = crc_calc else '0'",
        "'1' when crc_bits /= crc_calc else '0'",
    ),
    mutation(
        "a clock pulse more",
        "receiver",
        "'1' when to_send = 0 else '0'",
        "'1' when to_send = 1 else '0'",
    ),
    mutation(
        "payload a bit too long",
        "receiver",
        "payload_ends <= to_sl(left = 7);",
        "payload_ends <= to_sl(left = 6);",
    ),
    mutation(
        "F2 is not waited for",
        "receiver",
        "field_next <= FIELD_F2;",
        "field_next <= FIELD_PAYLOAD;",
    ),
    mutation(
        "a cell fewer around the payload",
        "receiver",
        "FIXED_CELLS : unsigned(6 downto 0) := to_unsigned(17, 7)",
        "FIXED_CELLS : unsigned(6 downto 0) := to_unsigned(16, 7)",
    ),
    mutation(
        "position moved by a bit",
        "receiver",
        "payload <= word(47 downto 0);",
        "payload <= word(48 downto 1);",
    ),
    mutation(
        "mode command: bits are not sent",
        "command_sender",
        "data <= cells(to_integer(cell_now));",
        "data <= '0';",
    ),
    mutation(
        "driver stays on for a bit",
        "command_sender",
        "cells_left <= \"1000\";",
        "cells_left <= \"1001\";",
    ),
    mutation(
        "delay measured a cycle too long",
        "line_delay",
        "since_rise <= to_unsigned(1, 11);",
        "since_rise <= to_unsigned(2, 11);",
    ),
    mutation(
        "samples at the edges of a bit",
        "line_delay",
        "half_tick and not second_half and cells_run",
        "half_tick and second_half and cells_run",
    ),
    mutation(
        "bus: the answer comes at once",
        "apb_front",
        "else\n                ready <= '0';",
        "else\n                ready <= '1';",
    ),
    mutation(
        "bus: address of another word",
        "apb_front",
        "paddr(12 downto 2)",
        "paddr(11 downto 1)",
    ),
    mutation(
        "bus: a write is a read",
        "apb_front",
        "writing <= pwrite;",
        "writing <= '0';",
    ),
    mutation(
        "bytes of a word turned round",
        "word_access",
        "data <= data(23 downto 0) & read_byte;",
        "data <= read_byte & data(31 downto 8);",
    ),
    mutation(
        "results are taken too early",
        "word_access",
        "settle <= \"11\";",
        "settle <= \"10\";",
    ),
    mutation(
        "setting: start value",
        "config_ring_2",
        ":= x\"38190014\"",
        ":= x\"38180014\"",
    ),
    mutation(
        "setting: bytes the other way round",
        "config_ring_2",
        "w2(23 downto 0) & byte_in(7 downto 0)",
        "byte_in(7 downto 0) & w2(31 downto 8)",
    ),
    mutation(
        "direct output: cropped at the wrong end",
        "direct_output",
        "next_bit & bits(31 downto 1)",
        "bits(30 downto 0) & next_bit",
    ),
    mutation(
        "direct output: strobe missing",
        "direct_output",
        "strobe <= '1';",
        "strobe <= '0';",
    ),
    mutation(
        "trigger: of every level",
        "trigger",
        "sync1 and not sync2",
        "sync1 and sync2",
    ),
];
