//! Boards and families: those that come with the program, those of a user, and what is wrong with a file.

mod bitstream;
mod files;
mod readback;
mod vendor;

use crate::constraints::{lint_top, play};
use crate::program::good;
use endat_config::board::{self, Board};
use endat_config::{parse_on, preset_for, Project, DEFAULT_PRESET};

/// The shipped card on a board.
fn card_on(board: &Board) -> Project {
    let text = preset_for("--preset", DEFAULT_PRESET, board).unwrap();
    parse_on("card.toml", &text, Some(board)).unwrap()
}

fn boards() -> Vec<Board> {
    let boards: Vec<Board> = board::names()
        .into_iter()
        .map(|name| Board::named(name).unwrap())
        .collect();
    assert!(boards.len() >= 10);
    boards
}

/// Boards of three families, each with its own form of clock manager and constraints.
fn few_boards() -> Vec<Board> {
    let names = ["papilio_pro", "ulx3s", "hx8k_b_evn"];
    names.map(|name| Board::named(name).unwrap()).into()
}

fn tops_are_clean(boards: &[Board]) {
    for board in boards {
        lint_top(&card_on(board), &format!("board-{}", board.name));
    }
}

#[test]
fn the_top_of_a_few_boards_is_clean() {
    tops_are_clean(&few_boards());
}

#[test]
#[ignore = "slow: the top of every board under Verilator"]
fn the_top_of_every_board_is_clean() {
    tops_are_clean(&boards());
}

/// How the format of a family says that a signal is on a pin.
fn statement(format: &str, signal: &str, pin: &str) -> String {
    match format {
        "ucf" => format!("NET \"{signal}\" LOC = \"{pin}\" | IOSTANDARD = "),
        "lpf" => {
            format!("LOCATE COMP \"{signal}\" SITE \"{pin}\";\nIOBUF PORT \"{signal}\" IO_TYPE=")
        }
        "pcf" => format!(" {signal} {pin}\n"),
        "cst" => format!("IO_LOC \"{signal}\" {pin};\nIO_PORT \"{signal}\" IO_TYPE="),
        "xdc" => format!("set_property -dict {{PACKAGE_PIN {pin} IOSTANDARD "),
        "qsf" => format!("set_location_assignment PIN_{pin} -to {signal}\n"),
        other => panic!("{other}: write down how it names a pin"),
    }
}

/// What begins such a statement, in any line.
const PLACES: [&str; 6] = [
    "\" LOC = ",
    "LOCATE COMP ",
    "set_io",
    "IO_LOC ",
    "PACKAGE_PIN ",
    "set_location_assignment ",
];

#[test]
fn constraints_place_every_port_on_its_pin_and_nothing_else() {
    for board in boards() {
        let project = card_on(&board);
        let end = board.family.constraints.as_str();
        let file = format!("{}.{end}", project.name);
        let files = endat_emit::emit(&project).unwrap();
        let file = files.iter().find(|f| f.path == file).unwrap();
        for pin in &project.pins {
            let wanted = statement(end, &pin.signal, &pin.pin);
            assert_eq!(
                file.text.matches(&wanted).count(),
                1,
                "{}: {wanted}",
                board.name
            );
        }
        let is_place = |line: &&str| PLACES.iter().any(|place| line.contains(place));
        let count = file.text.lines().filter(is_place).count();
        assert_eq!(count, project.pins.len(), "{}", board.name);
        // Where a place stands in a line with its port, it is that port's.
        let of_port = |l: &&str| l.contains("PACKAGE_PIN");
        for (line, pin) in file.text.lines().filter(of_port).zip(&project.pins) {
            assert!(
                line.ends_with(&format!("[get_ports {}]", pin.signal)),
                "{line}"
            );
        }
    }
}

#[test]
fn no_input_floats_unless_its_family_cannot_help_it() {
    for board in boards() {
        for kind in [
            "encoder_data",
            "trigger",
            "uart_input",
            "bus_strobe",
            "bus_input",
        ] {
            let kinds = board::Kind::NAMES;
            let (kind, _) = kinds.iter().find(|(_, name)| *name == kind).unwrap();
            let words = board.family.attributes(*kind).to_ascii_uppercase();
            let is_pulled = ["PULLUP", "PULLDOWN", "PULL_UP", "MODE=UP", "MODE=DOWN"]
                .iter()
                .any(|w| words.contains(w));
            assert!(is_pulled, "{}: {kind:?} {words:?}", board.name);
        }
    }
}

/// Counts the card's clock from 5 us to 105 us, and looks at its reset and a light at the end.
const BENCH: &str = r#"
`timescale 1ns / 1ps
module bench;
    reg osc = 0;
    always #(HALF) osc = ~osc;
    wire light;
    NAME_top top (.osc_i(osc), .led_status_o(light)PORTS);
    integer cycles = 0;
    always @(posedge top.card.clk_i) cycles = cycles + 1;
    initial begin
        #5000 cycles = 0;
        #100000 $display("%0d reset %b light %b of %b", cycles, top.card.rst_i, light, top.card.led_status_o);
        $finish;
    end
endmodule
"#;

#[test]
fn clock_managers_make_the_system_clock_and_lights_shine_the_right_way() {
    clock_managers_are_right(&few_boards());
}

#[test]
#[ignore = "slow: the clock manager of every board under Icarus Verilog"]
fn every_clock_manager_makes_the_system_clock_and_lights_shine_the_right_way() {
    clock_managers_are_right(&boards());
}

fn clock_managers_are_right(boards: &[Board]) {
    for board in boards {
        let project = card_on(board);
        let half = format!("{:?}", 5e8 / board.oscillator_hz as f64);
        let mut ports = String::new();
        for pin in &project.pins {
            ports += &match pin.signal.as_str() {
                "osc_i" | "led_status_o" => continue,
                "uart_rx_i" => ", .uart_rx_i(1'b1)".to_owned(),
                signal if pin.kind.is_input() => format!(", .{signal}(1'b0)"),
                signal => format!(", .{signal}()"),
            };
        }
        let bench = BENCH.replace("NAME", &project.name).replace("HALF", &half);
        let bench = bench.replace("PORTS", &ports);
        let folder = format!("board-clock-{}", board.name);
        let Some(said) = play(&project, &folder, &bench) else {
            return;
        };
        let words: Vec<&str> = said.split_whitespace().collect();
        let [cycles, "reset", "0", "light", pin, "of", light] = words[..] else {
            panic!("{}: {said}", board.name);
        };
        // Half a cycle at either end, and picoseconds that periods are rounded to.
        let wanted = project.card.system_hz / 10_000;
        let cycles: u64 = cycles.parse().unwrap();
        assert!(
            cycles.abs_diff(wanted) <= 2,
            "{}: {cycles} cycles instead of {wanted}",
            board.name
        );
        let pin_of_light = &project
            .pins
            .iter()
            .find(|p| p.signal == "led_status_o")
            .unwrap()
            .pin;
        assert_eq!(
            pin != light,
            board.low_active.contains(pin_of_light),
            "{}",
            board.name
        );
    }
}

#[test]
fn the_page_has_the_table_of_the_boards() {
    let page = include_str!("../../docs/boards.md");
    assert!(
        page.contains(&good(&["boards", "--page"])),
        "cargo run -- boards --page"
    );
    // What was measured is of the clocks that the boards have now.
    let measured = page.split_once("| board | system clock, MHz |").unwrap().1;
    for board in boards().iter().filter(|b| b.family.build.is_some()) {
        let head = format!("| `{}` | ", board.name);
        let row = measured.lines().find(|l| l.starts_with(&head));
        let row = row.unwrap_or_else(|| panic!("{}: no measured row", board.name));
        let clock = card_on(board).card.system_hz as f64 / 1e6;
        assert!(row.starts_with(&format!("{head}{clock} | ")), "{row}");
    }
}

/// Catches a port that is drawn nowhere or twice, and a page whose pictures are of other pins.
#[test]
fn every_port_of_every_board_is_in_its_drawing() {
    for board in boards() {
        let drawing = good(&["boards", "--wiring", &board.name]);
        for pin in &card_on(&board).pins {
            let name = format!(">{}</text>", pin.signal);
            assert_eq!(drawing.matches(&name).count(), 1, "{}: {name}", board.name);
            assert!(
                drawing.contains(&format!(">{}</text>", pin.place())),
                "{}",
                board.name
            );
        }
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let file = root.join(format!("docs/boards/{}.svg", board.name));
        crate::tools::assert_committed(&file, &drawing);
    }
    // The channel that speaks T-format has no CLOCK, and its pair is called so.
    let dir = crate::program::Dir::new("wiring");
    let text = good(&["presets", "--show", "mixed_protocols"]);
    let config = dir.write("card.toml", text.as_bytes());
    let out = dir.path("o");
    good(&["emit", "--config", &config, "--out", &out, "--name", "card"]);
    let drawing = std::fs::read_to_string(dir.0.join("o/card/card_wiring.svg")).unwrap();
    assert_eq!(drawing.matches(">CLOCK+</text>").count(), 1);
    assert_eq!(drawing.matches(">SD+</text>").count(), 1);
}
