//! Cards with SPI or the parallel bus on a board: pins, top, and a host at the pins of the top.

use crate::bus_card::text;
use crate::constraints::{judge, lint_top, play};
use endat_config::{parse, Project};
use endat_hdl::card::bus::HostBus;
use endat_hdl::regs::ID;

const BOARD: &str = "[board]\nname = \"papilio_pro\"\n";

fn project(bus: HostBus, more: &str) -> Project {
    parse("card.toml", &text(bus, &format!("{BOARD}{more}"))).unwrap()
}

const INTERRUPT: &str = "[outputs]\nparts = [\"interrupt\"]\n";
/// Cards, and how many pins each has.
const CARDS: [(HostBus, &str, usize); 5] = [
    (HostBus::Spi, "", 17),
    (HostBus::Spi, INTERRUPT, 18),
    (HostBus::Parallel, "", 35),
    (HostBus::Parallel, INTERRUPT, 36),
    (HostBus::Parallel, "[pins]\nbus_data3_io = \"C15\"\n", 35),
];

#[test]
fn every_signal_has_a_pin_and_the_tops_with_an_interrupt_are_clean() {
    for (bus, more, pins) in CARDS {
        let project = project(bus, more);
        assert_eq!(project.pins.len(), pins, "{bus:?} {more}");
        judge(&project);
        if more == INTERRUPT {
            lint_top(&project, &format!("board-{}-{pins}", bus.name()));
        }
    }
}

#[test]
#[ignore = "slow: the top of every card on a board under Verilator"]
fn the_top_of_every_card_on_a_board_is_clean() {
    for (number, (bus, more, _)) in CARDS.into_iter().enumerate() {
        let folder = format!("board-{}-all-{number}", bus.name());
        lint_top(&project(bus, more), &folder);
    }
}

#[test]
fn the_emission_says_what_it_has() {
    for bus in [HostBus::Spi, HostBus::Parallel] {
        let files = endat_emit::emit(&project(bus, "")).unwrap();
        let readme = &files.iter().find(|f| f.path == "README.md").unwrap().text;
        let listed: Vec<&str> = (readme.lines())
            .filter_map(|l| l.strip_prefix("| `")?.split_once("` |"))
            .map(|(name, _)| name)
            .take_while(|name| *name != "osc_i")
            .collect();
        let is_block = |name: &str| {
            let card = crate::emitted::name_of(&files);
            let list = files
                .iter()
                .find(|f| f.path == format!("{card}.f"))
                .unwrap();
            name != format!("{card}.v") && list.text.lines().any(|line| line == name)
        };
        for file in files.iter().filter(|f| !is_block(&f.path)) {
            let name = file.path.as_str();
            assert!(name == "README.md" || listed.contains(&name), "{name}");
        }
        for name in listed.into_iter().filter(|n| !n.contains('*')) {
            assert!(files.iter().any(|f| f.path == name), "{bus:?}: {name}");
        }
    }
}

#[test]
fn what_a_board_has_no_place_for_is_refused() {
    for (bus, more, told) in [
        (
            HostBus::Spi,
            "[outputs]\nparts = [\"position\"]\n",
            ":20: outputs.parts = \"position\": a card with a board top is the whole device",
        ),
        (
            HostBus::Spi,
            "[outputs]\nparts = [\"position\", \"interrupt\"]\n",
            ":20: outputs.parts = \"position\": a card with a board top is the whole device",
        ),
        (
            HostBus::Spi,
            "[pins]\nuart_rx_i = \"A0\"\n",
            ":20: pins.uart_rx_i = \"A0\": no such signal; signals: trigger_i, spi_sck_i",
        ),
        (
            HostBus::Parallel,
            "[pins]\ntrigger_i = \"A3\"\n",
            ":20: pins.trigger_i = \"A3\": P58 already carries bus_data3_io",
        ),
        (
            HostBus::Spi,
            "[link]\nbaud = 9600\n",
            "[link]: host.bus = \"spi\" has no UART",
        ),
    ] {
        let all = parse("card.toml", &text(bus, &format!("{BOARD}{more}"))).unwrap_err();
        let found: Vec<String> = all.iter().map(ToString::to_string).collect();
        assert!(
            found.len() == 1 && found[0].contains(told),
            "{told}\n{found:?}"
        );
    }
    let mut slow = text(HostBus::Spi, BOARD);
    slow = slow
        .replace("100_000_000", "99_999_999")
        .replace("3_125_000", "3_124_999");
    let all = parse("card.toml", &slow).unwrap_err();
    assert!(
        all.iter()
            .any(|d| d.to_string().contains("the clock manager cannot make it")),
        "{all:?}"
    );
}

/// What surrounds both masters: oscillator, idle encoders, pull-ups on what is released.
const FRAME: &str = "`timescale 1ns / 1ps
module bench;
    reg osc = 0;
    always #15.625 osc = ~osc;
    integer i;
    reg [31:0] word;
";

/// Reads word 0 over the pins of the top; says whether the data line is free before, and after.
const SPI: &str = r#"
    reg sck = 0, cs_n = 1, mosi = 0;
    wire miso;
    NAME_top top (.osc_i(osc), .trigger_i(1'b0), .endat_data0_i(1'b0), .endat_data1_i(1'b0),
        .spi_sck_i(sck), .spi_cs_n_i(cs_n), .spi_mosi_i(mosi), .spi_miso_o(miso));
    task send(input [7:0] value);
        for (i = 7; i >= 0; i = i - 1) begin
            mosi = value[i];
            #100 sck = 1;
            word = {word[30:0], miso};
            #100 sck = 0;
        end
    endtask
    initial begin
        #3000;
        if (miso !== 1'bz) $display("not free before");
        cs_n = 0;
        #100;
        send(8'h03); send(8'h00); send(8'h00); send(8'h01); send(8'h00);
        send(8'h00); send(8'h00); send(8'h00); send(8'h00);
        #100 cs_n = 1;
        #10;
        if (miso !== 1'bz) $display("not free after");
        $display("%08x", word);
        $finish;
    end
endmodule
"#;

const PARALLEL: &str = r#"
    reg cs_n = 1, rd_n = 1, wr_n = 1;
    reg [2:0] address = 0;
    reg [15:0] value = 0;
    reg driven = 0;
    wire [15:0] data;
    assign data = driven ? value : 16'bz;
    NAME_top top (.osc_i(osc), .trigger_i(1'b0), .endat_data0_i(1'b0), .endat_data1_i(1'b0),
        .bus_cs_n_i(cs_n), .bus_rd_n_i(rd_n), .bus_wr_n_i(wr_n),
        .bus_address0_i(address[0]), .bus_address1_i(address[1]), .bus_address2_i(address[2]),
        .bus_data0_io(data[0]), .bus_data1_io(data[1]), .bus_data2_io(data[2]), .bus_data3_io(data[3]),
        .bus_data4_io(data[4]), .bus_data5_io(data[5]), .bus_data6_io(data[6]), .bus_data7_io(data[7]),
        .bus_data8_io(data[8]), .bus_data9_io(data[9]), .bus_data10_io(data[10]), .bus_data11_io(data[11]),
        .bus_data12_io(data[12]), .bus_data13_io(data[13]), .bus_data14_io(data[14]), .bus_data15_io(data[15]));
    task read(input [2:0] at);
        begin
            address = at;
            cs_n = 0;
            #40 rd_n = 0;
            #60 word = {word[15:0], data};
            rd_n = 1;
            #1 if (data !== 16'bz) $display("not free after");
            cs_n = 1;
            #60;
        end
    endtask
    task write(input [2:0] at, input [15:0] what);
        begin
            address = at;
            value = what;
            cs_n = 0;
            #40 wr_n = 0;
            driven = 1;
            #60 wr_n = 1;
            #40 driven = 0;
            cs_n = 1;
            #60;
        end
    endtask
    initial begin
        #3000;
        if (data !== 16'bz) $display("not free before");
        write(3'd5, 16'd0);
        #5000;
        read(3'd7);
        read(3'd6);
        $display("%08x", word);
        $finish;
    end
endmodule
"#;

/// Catches lines in a wrong order, a three-state that is stuck or the wrong way round, a reset that does not end.
#[test]
fn a_host_at_the_pins_reads_the_identification() {
    for (bus, master) in [(HostBus::Spi, SPI), (HostBus::Parallel, PARALLEL)] {
        let project = project(bus, "");
        let bench = format!("{FRAME}{master}").replace("NAME", &project.name);
        let Some(said) = play(&project, &format!("pins-{}", bus.name()), &bench) else {
            return;
        };
        assert_eq!(said.trim(), format!("{ID:08x}"), "{bus:?}");
    }
}
