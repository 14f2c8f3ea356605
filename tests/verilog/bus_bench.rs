//! The emitted test bench on every bus: passes on the card, and fails on a broken front or output.

use super::mutations::{mutation, Mutation};
use super::testbench::{bench_passes, check_mutations, fit};
use endat_config::parse;
use endat_console::artifact::Artifact;
use endat_hdl::card::bus::HostBus;

pub const APB: &[Mutation] = &[
    mutation(
        "APB: byte address taken for a word address",
        "apb_front",
        "address <= paddr[12:2];",
        "address <= paddr[10:0];",
    ),
    mutation(
        "APB: answer before the word is there",
        "apb_front",
        "assign pready = ready;",
        "assign pready = ready | busy;",
    ),
    mutation(
        "APB: writes only read",
        "apb_front",
        ".write_in(writing)",
        ".write_in(1'b0)",
    ),
    mutation(
        "APB: every answer is an error",
        "apb_front",
        "assign pslverr = error;",
        "assign pslverr = ready;",
    ),
    mutation(
        "interrupt: clear clears nothing",
        "interrupt",
        "status <= (status & ~write_data) | events_0;",
        "status <= status | events_0;",
    ),
    mutation(
        "interrupt: mask stays",
        "interrupt",
        "mask <= write_data;",
        "mask <= mask;",
    ),
    mutation(
        "interrupt: channels at the wrong bits",
        "interrupt",
        "assign events_0 = {events_1[27:0], 4'd0}",
        "assign events_0 = {events_1[26:0], 5'd0}",
    ),
    mutation(
        "direct output: told anew after a bad result",
        "direct_output_pair_64",
        "running <= fresh;",
        "running <= 1'b1;",
    ),
    mutation(
        "direct output: one bit too far",
        "direct_output_pair_68",
        "assign next_bit = wide[at]",
        "assign next_bit = wide[at + 6'd1]",
    ),
    mutation(
        "direct output: no strobe",
        "direct_output_pair_64",
        "strobe <= 1'b1;",
        "strobe <= 1'b0;",
    ),
    mutation(
        "direct output: causes one off",
        "direct_output_pair_64",
        "error <= error_causes[cause];",
        "error <= error_causes[0];",
    ),
];

const WISHBONE: &[Mutation] = &[
    mutation(
        "Wishbone: address of the word behind",
        "wishbone_front",
        "address <= adr;",
        "address <= adr + 11'd1;",
    ),
    mutation(
        "Wishbone: whole words are refused",
        "wishbone_front",
        "assign refused = we & !(&sel);",
        "assign refused = we & (&sel);",
    ),
    mutation(
        "Wishbone: acknowledged before the word is there",
        "wishbone_front",
        "assign ack = acknowledge;",
        "assign ack = acknowledge | busy;",
    ),
    mutation(
        "Wishbone: reads write",
        "wishbone_front",
        "writing <= we;",
        "writing <= 1'b1;",
    ),
];

const AXI_LITE: &[Mutation] = &[
    mutation(
        "AXI4-Lite: reads at the address of a write",
        "axi_lite_front",
        "read_address <= araddr[12:2];",
        "read_address <= awaddr[12:2];",
    ),
    mutation(
        "AXI4-Lite: bytes in another order",
        "axi_lite_front",
        "data <= wdata;",
        "data <= {wdata[23:0], wdata[31:24]};",
    ),
    mutation(
        "AXI4-Lite: whole words are refused",
        "axi_lite_front",
        "error <= (|strobes) & !(&strobes);",
        "error <= |strobes;",
    ),
    mutation(
        "AXI4-Lite: writes only read",
        "axi_lite_front",
        "writing <= 1'b1;",
        "writing <= 1'b0;",
    ),
];

const SPI: &[Mutation] = &[
    mutation(
        "SPI: wrong polynomial",
        "spi_front",
        "POLYNOMIAL = 16'h1021;",
        "POLYNOMIAL = 16'h1020;",
    ),
    mutation(
        "SPI: no check sum behind the words",
        "spi_front",
        "load_crc_next = 1'b1;",
        "load_crc_next = 1'b0;",
    ),
    mutation(
        "SPI: upper part of the address at the wrong place",
        "spi_front",
        "address_next = {byte_in[2:0], 8'd0};",
        "address_next = {1'b0, byte_in[2:0], 7'd0};",
    ),
    mutation(
        "SPI: one word too many",
        "spi_front",
        "words_left_next = byte_in;",
        "words_left_next = byte_in + 8'd1;",
    ),
    mutation(
        "SPI: all writes are told as refused",
        "spi_front",
        "refused_next = (|crc) | waits;",
        "refused_next = 1'b1;",
    ),
];

const PARALLEL: &[Mutation] = &[
    mutation(
        "parallel: address of the window one bit off",
        "parallel_front",
        "window_address <= strobes_written_data[10:0];",
        "window_address <= strobes_written_data[11:1];",
    ),
    mutation(
        "parallel: low half twice",
        "parallel_front",
        "window_high <= words_read_data[31:16];",
        "window_high <= words_read_data[15:0];",
    ),
    mutation(
        "parallel: nothing is written",
        "parallel_front",
        "wants_write <= 1'b1;",
        "wants_write <= 1'b0;",
    ),
    mutation(
        "parallel: the lines are never free",
        "parallel_front",
        "assign data_enable = !cs_n & !rd_n;",
        "assign data_enable = !rd_n | cs_n;",
    ),
    mutation(
        "parallel: the word is read whatever bit 14 says",
        "parallel_front",
        "wants_read <= !strobes_written_data[14];",
        "wants_read <= strobes_written_data[14];",
    ),
];

/// A card of two channels with every output next to the bus; its clock is slow, so that it is simulated soon.
pub fn files(bus: HostBus) -> Vec<Artifact> {
    emitted(&text(bus))
}

fn text(bus: HostBus) -> String {
    let outputs = "[outputs]\nparts = [\"position\", \"interrupt\"]\n";
    crate::bus_card::text(bus, outputs)
        .replace("= [\"register\"]", "= [\"pin\", \"timer\"]")
        .replace("100_000_000", "25_000_000")
        .replace("3_125_000", "2_500_000")
        .replace("sample_hz = 10_000", "sample_hz = 5_000")
}

/// The first channel of that card alone: all steps of its bench take a third of the time.
pub fn one_channel(bus: HostBus) -> Vec<Artifact> {
    let text = text(bus);
    let (first, second) = text.rsplit_once("[[channel]]").unwrap();
    let (_, after) = second.split_once("[trigger]").unwrap();
    let text = format!("{first}[trigger]{after}")
        .replace("25_000_000", "16_000_000")
        .replace("2_500_000", "2_000_000");
    emitted(&text)
}

fn emitted(text: &str) -> Vec<Artifact> {
    endat_emit::emit(&parse("card.toml", text).unwrap()).unwrap()
}

fn check(bus: HostBus, mutations: &[Mutation]) {
    check_mutations(&format!("bus-{}", bus.name()), &files(bus), mutations);
}

/// Needs no outside tool. The quick bench is that of APB, see `bench_of_a_quick_card_passes_and_fails_on_broken_cards`.
#[test]
fn mutations_of_every_front_fit() {
    for (bus, mutations) in [
        (HostBus::Wishbone, WISHBONE),
        (HostBus::AxiLite, AXI_LITE),
        (HostBus::Spi, SPI),
        (HostBus::Parallel, PARALLEL),
    ] {
        fit(&files(bus), mutations);
    }
}

#[test]
#[ignore = "slow: every mutation of the front"]
fn bench_behind_apb_passes_only_as_it_stands() {
    check(HostBus::Apb, APB);
}

#[test]
#[ignore = "slow: every mutation of the front"]
fn bench_behind_wishbone_passes_only_as_it_stands() {
    check(HostBus::Wishbone, WISHBONE);
}

#[test]
#[ignore = "slow: every mutation of the front"]
fn bench_behind_axi_lite_passes_only_as_it_stands() {
    check(HostBus::AxiLite, AXI_LITE);
}

#[test]
#[ignore = "slow: every mutation of the front"]
fn bench_behind_spi_passes_only_as_it_stands() {
    check(HostBus::Spi, SPI);
}

#[test]
#[ignore = "slow: every mutation of the front"]
fn bench_behind_the_parallel_bus_passes_only_as_it_stands() {
    check(HostBus::Parallel, PARALLEL);
}

/// Steps of both protocols count the strobes of the outputs.
#[test]
#[ignore = "slow: bench of a card with both protocols"]
fn bench_behind_a_bus_passes_on_a_card_with_both_protocols() {
    let outputs = "[outputs]\nparts = [\"position\", \"interrupt\"]\n";
    let text = crate::bus_card::text(HostBus::Apb, outputs);
    let second = "[[channel]]\nposition_bits = 25\ncommand = \"000111\"\n";
    assert!(text.contains(second));
    let text = text.replace(second, "[[channel]]\nprotocol = \"t_format\"\n");
    let text = text.replace("sample_hz = 10_000", "sample_hz = 1_000");
    let files = endat_emit::emit(&parse("card.toml", &text).unwrap()).unwrap();
    bench_passes("bus-both", &files, &[]);
}

/// A fast front triggers before the services' programs have begun, unless the bench waits for them.
#[test]
#[ignore = "slow: bench of a card with services and a fast bus"]
fn bench_behind_a_fast_bus_waits_for_the_services() {
    let channel = "[[channel]]\nposition_bits = 25\ncommand = \"111000\"\n";
    let text = format!(
        "name = \"gantry_pos\"\n\
         [clock]\nsystem_hz = 50_000_000\n\
         [endat]\nclock_hz = 6_250_000\ncable_m = 20\n\
         {channel}{channel}\
         [trigger]\nsample_hz = 10_000\nsources = [\"register\"]\n\
         [host]\nbus = \"axi_lite\"\nbase_address = 0x43C00000\n\
         [service]\nparts = [\"requests\", \"diagnosis\", \"initialise\"]\n\
         [outputs]\nparts = [\"interrupt\"]\n"
    );
    let files = endat_emit::emit(&parse("gantry.toml", &text).unwrap()).unwrap();
    bench_passes("bus-services", &files, &[]);
}
