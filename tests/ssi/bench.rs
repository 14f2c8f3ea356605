//! The emitted bench of cards with SSI channels: it passes on the card, and fails on every broken port.

use crate::verilog::mutations::{mutation, Mutation};
use crate::verilog::testbench::{bench_passes, check_mutations, check_some};
use endat_config::parse;
use endat_console::artifact::Artifact;
use endat_hdl::protocols::ssi::cause;

const SSI: &str = "protocol = \"ssi\"\n";

fn emitted(system_hz: u64, channels: &[&str], more: &str) -> Vec<Artifact> {
    let channels: String = channels
        .iter()
        .map(|c| format!("[[channel]]\n{c}"))
        .collect();
    let text = format!(
        "name = \"ssi\"\n[clock]\nsystem_hz = {system_hz}\n{channels}\
         [trigger]\nsample_hz = 500\nsources = [\"pin\", \"register\"]\n{more}"
    );
    endat_emit::emit(&parse("ssi.toml", &text).unwrap()).unwrap()
}

const GRAY: &str =
    "protocol = \"ssi\"\nposition_bits = 17\nclock_hz = 500_000\ncode = \"gray\"\nparity = \"odd\"\ntwice = true\n";

const UART: &str = "[link]\nbaud = 2_000_000\nread_hz = 50\n";
/// Simulated sooner than with a UART.
const APB: &str = "[host]\nbus = \"apb\"\n";

/// Widths, codes and clocks, alone and with the other protocols.
#[test]
#[ignore = "slow: benches of cards with a UART, other protocols and a service"]
fn it_passes_on_cards() {
    let one =
        format!("{SSI}position_bits = 1\nclock_hz = 400_000\ncable_m = 10\nparity = \"even\"\n");
    let wide =
        format!("{SSI}position_bits = 48\nclock_hz = 500_000\ntwice = true\ntst_ns = 3_000\n");
    let endat = "position_bits = 25\nclock_hz = 2_000_000\ncommand = \"111000\"\n";
    let t_format = "protocol = \"t_format\"\n";
    bench_passes("ssi-alone", &emitted(32_000_000, &[&one, &wide], UART), &[]);
    let three = emitted(50_000_000, &[GRAY, endat, t_format], UART);
    bench_passes("ssi-three-protocols", &three, &[]);
    let served = emitted(
        24_000_000,
        &[endat, GRAY],
        &format!("{UART}[service]\nparts = [\"requests\"]\n[device]\ninitial_values = false\n[host]\nbus = \"uart\"\n"),
    );
    bench_passes("ssi-beside-a-service", &served, &[]);
}

/// Narrow channels: one with Gray code, parity and two copies, one with none of these.
fn narrow() -> Vec<Artifact> {
    let all = format!("{SSI}position_bits = 7\nclock_hz = 1_000_000\ncable_m = 10\ncode = \"gray\"\nparity = \"odd\"\ntwice = true\n");
    let none = format!("{SSI}position_bits = 5\nclock_hz = 1_000_000\ncable_m = 10\n");
    emitted(32_000_000, &[&all, &none], APB)
}

#[test]
fn it_passes_on_a_narrow_card_and_fails_on_broken_ports() {
    let names = [
        "no last clock",
        "clock too fast",
        "driver on in the frame",
        "copies not compared",
        "no LOW bit between copies looked at",
        "a position not withdrawn",
    ];
    check_some("ssi-quick", &narrow(), MUTATIONS, &names);
}

/// Channels with special bits on both sides of the position, and one of an encoder that keeps its last bit on the line.
fn special() -> Vec<Artifact> {
    let all = format!("{SSI}position_bits = 6\nclock_hz = 1_000_000\ncable_m = 10\ncode = \"gray\"\nparity = \"odd\"\ntwice = true\n\
        bits_before = [\"ignored\", \"not_alarm\", \"shown\"]\nbits_after = [\"valid\", \"power_fail\", \"parity_odd\", \"crc6\"]\n");
    let held =
        format!("{SSI}position_bits = 5\nclock_hz = 1_000_000\ncable_m = 10\nend_low = false\n");
    emitted(32_000_000, &[&all, &held], APB)
}

/// Catches logic, or a line of text, that every SSI channel pays for.
#[test]
fn a_channel_without_special_bits_has_no_text_of_them() {
    let text = |files: &[Artifact]| -> String {
        let of = |f: &&Artifact| f.path.contains("ssi_port") || f.path.ends_with("_tb.v");
        files.iter().filter(of).map(|f| f.text.clone()).collect()
    };
    let words = ["special", "shown", "holds_end", "HELD"];
    let (none, all) = (narrow(), special());
    assert!(!none.iter().any(|f| f.path.contains("special")));
    assert!(all.iter().any(|f| f.path.ends_with("_special_bits.v")));
    for word in words {
        let is_there = (text(&none).contains(word), text(&all).contains(word));
        assert_eq!(is_there, (false, true), "{word}");
    }
}

#[test]
fn it_passes_on_special_bits_and_fails_without_them() {
    let names = [
        "bits before the position taken for it",
        "bits after the position taken for it",
        "no alarm",
        "CRC not looked at",
        "no recovery time of an encoder that keeps its last bit",
    ];
    check_some("ssi-special", &special(), SPECIAL_MUTATIONS, &names);
}

/// Catches a cause that the bench forgets: its encoders can give a reason for all but these of settings and upsets.
#[test]
fn bench_tries_every_cause_of_an_ssi_encoder() {
    let files = special();
    let bench = files.iter().find(|f| f.path.ends_with("_tb.v")).unwrap();
    let without = [cause::NONE, cause::UNKNOWN_FRAME, cause::UPSET];
    for cause in cause::ALL.iter().filter(|c| !without.contains(&c.code)) {
        let name = format!("SSI_{};", cause.name.to_uppercase());
        let name = name.replace("POSITION_NOT_VALID", "NOT_VALID");
        let is_wanted = |line: &str| line.contains(&name) && line.contains("cause");
        let count = bench.text.lines().filter(|line| is_wanted(line)).count();
        assert!(count > 0, "{name}");
    }
}

#[test]
#[ignore = "slow: every mutation of special bits"]
fn it_fails_on_every_broken_port_with_special_bits() {
    check_mutations("ssi-specials", &special(), SPECIAL_MUTATIONS);
}

/// Catches a bench encoder that ignores the configured delay, and a port that takes bits too soon for it.
#[test]
fn the_bench_has_encoders_as_late_as_configured_and_passes() {
    let late =
        format!("{SSI}position_bits = 5\nclock_hz = 1_000_000\ncable_m = 0\nbit_delay_ns = 800\n");
    let soon =
        format!("{SSI}position_bits = 4\nclock_hz = 2_000_000\ncable_m = 5\nbit_delay_ns = 150\n");
    let files = emitted(32_000_000, &[&late, &soon], APB);
    let bench = files.iter().find(|f| f.path.ends_with("_tb.v")).unwrap();
    for delay in [".BIT_DELAY_NS(800.0)", ".BIT_DELAY_NS(150.0)"] {
        assert!(bench.text.contains(delay), "{delay}");
    }
    bench_passes("ssi-delays", &files, &[]);
}

#[test]
#[ignore = "slow: every mutation of the SSI port"]
fn it_fails_on_every_broken_port() {
    check_mutations("ssi", &narrow(), MUTATIONS);
}

const PORT: &str = "ssi_port";

const SPECIAL: &str = "special_bits";
/// The port of an encoder that keeps its last bit on the line.
const HELD_PORT: &str = "ssi_port_holds_end";

/// Ways to break what is there of special bits, and of an end that is not LOW.
const SPECIAL_MUTATIONS: &[Mutation] = &[
    mutation(
        "bits before the position taken for it",
        SPECIAL,
        "assign is_position = !is_before & !is_after;",
        "assign is_position = !is_after;",
    ),
    mutation(
        "bits after the position taken for it",
        SPECIAL,
        "assign is_position = !is_before & !is_after;",
        "assign is_position = !is_before;",
    ),
    mutation(
        "no alarm",
        SPECIAL,
        "localparam  [13:0] ALARM_MASK = 14'd8;",
        "localparam  [13:0] ALARM_MASK = 14'd0;",
    ),
    mutation(
        "CRC not looked at",
        SPECIAL,
        "is_wrong <= is_wrong | (|crc_shifted);",
        "is_wrong <= is_wrong;",
    ),
    mutation(
        "no recovery time of an encoder that keeps its last bit",
        HELD_PORT,
        "timer <= recovery_limit_cycles;",
        "timer <= 13'd0;",
    ),
];

/// Ways to break the port.
const MUTATIONS: &[Mutation] = &[
    mutation(
        "no last clock",
        PORT,
        "assign ends_copy = !(|left[5:1]);",
        "assign ends_copy = !(|left[5:2]);",
    ),
    mutation(
        "a copy only",
        PORT,
        "(second | !frame[1])",
        "1'b1",
    ),
    mutation(
        "Gray code as it came",
        PORT,
        "filter_level ^ (bit_before & frame[0])",
        "filter_level",
    ),
    mutation(
        "the second copy begins in the code of the first",
        PORT,
        "bit_before = again[0];",
        "bit_before = word[0];",
    ),
    mutation(
        "parity of both copies together",
        PORT,
        "first <= 1'b1;\n                    ones <= 1'b0;\n                    left <= bits;",
        "first <= 1'b1;\n                    left <= bits;",
    ),
    mutation(
        "parity not looked at",
        PORT,
        "not_even <= not_even | (ones ^ filter_level ^ frame[4]);",
        "not_even <= not_even;",
    ),
    mutation(
        "no LOW bit between copies looked at",
        PORT,
        "if (second) begin\n                        not_low <= not_low | filter_level;",
        "if (second) begin\n                        not_low <= not_low;",
    ),
    mutation(
        "end not looked at",
        PORT,
        "timer <= recovery_limit_cycles;\n                        not_low <= not_low | filter_level;",
        "timer <= recovery_limit_cycles;\n                        not_low <= not_low;",
    ),
    mutation(
        "copies not compared",
        PORT,
        "assign is_other = frame[1] & (word != again);",
        "assign is_other = 1'b0;",
    ),
    mutation(
        "the second copy shown",
        PORT,
        ".position_in(word),",
        ".position_in(again),",
    ),
    mutation(
        "clock begins on a line that is LOW",
        PORT,
        "if (frame[2] & filter_level) begin",
        "if (frame[2]) begin",
    ),
    mutation(
        "LOW line not told",
        PORT,
        "unknown <= !frame[2];\n                    not_high <= !filter_level;",
        "unknown <= !frame[2];\n                    not_high <= 1'b0;",
    ),
    mutation(
        "a trigger in the frame not told",
        PORT,
        "if (loses) begin\n                lost <= 1'b1;",
        "if (loses) begin\n                lost <= 1'b0;",
    ),
    mutation(
        "clock too fast",
        PORT,
        "assign low_cycles = {1'b0, period[10:1]};",
        "assign low_cycles = {2'b0, period[10:2]};",
    ),
    mutation(
        "least significant bit first",
        PORT,
        "word <= {word[46:0], value};",
        "word <= {value, word[47:1]};",
    ),
    mutation(
        "the last position stays in front",
        PORT,
        "trigger) begin\n                word <= 48'd0;",
        "trigger) begin\n                word <= word;",
    ),
    mutation(
        "a bit taken at the falling edge",
        PORT,
        "assign takes_bit = (state == AT_LOW) & is_due & !first;",
        "assign takes_bit = (state == AT_HIGH) & is_due & !first;",
    ),
    mutation(
        "a position not withdrawn",
        PORT,
        ".withdraw(is_late),",
        ".withdraw(1'b0),",
    ),
    mutation(
        "driver on in the frame",
        "encoder_port",
        "assign data_oe = 1'b0;",
        "assign data_oe = !endat_clk;",
    ),
    mutation(
        "a wrong position taken",
        PORT,
        "assign snapshot_good = publishes & good;",
        "assign snapshot_good = publishes;",
    ),
    mutation(
        "time stamp with each falling edge",
        PORT,
        "fallen <= (fallen | !clk) & (state != AT_REST);",
        "fallen <= !clk;",
    ),
];
