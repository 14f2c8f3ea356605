//! Files of boards and families, as a user writes them.

use crate::program::{bad, good, Dir};
use endat_config::board::Board;
use std::fs;
use std::path::Path;

const PAPILIO: &str = include_str!("../../constraints/boards/papilio_pro.toml");
const ULX3S: &str = include_str!("../../constraints/boards/ulx3s.toml");
const TANG_NANO: &str = include_str!("../../constraints/boards/tang_nano_9k.toml");
const DE10_NANO: &str = include_str!("../../constraints/boards/de10_nano.toml");

/// The text with one place changed, and the line of the change.
fn changed(text: &str, from: &str, to: &str) -> (String, usize) {
    let at = text.find(from).unwrap_or_else(|| panic!("no {from}"));
    let line = text[..at].matches('\n').count() + 1;
    (text.replacen(from, to, 1), line)
}

#[test]
fn wrong_board_files_are_refused_with_line_and_remedy() {
    let rows = [
        // pins
        (PAPILIO, "led_status_o = \"P112\"", "led_status_o = \"P94\"", "fixed.led_status_o = \"P94\": already stands at oscillator_pin; a pin has one place, remove one of the two"),
        (PAPILIO, "A = [\"P48\"", "A = [\"P51\"", "connectors.A = \"P51\": already stands at connectors.A"),
        (PAPILIO, "endat_data0_o = \"C1\"", "endat_data0_o = \"C0\"", "wing.endat_data0_o = \"C0\": P114 already carries endat_clk0_o; choose a free pin"),
        (PAPILIO, "spi_cs_n_i = \"B1\"", "spi_cs_n_i = \"B0\"", "wing.spi_cs_n_i = \"B0\": P99 already carries spi_sck_i"),
        (PAPILIO, "A = [\"P48\"", "A = [\"P145\"", "connectors.A = \"P145\": no such pin; the package of xc6slx9-tqg144-2 has P1..P144"),
        (PAPILIO, "oscillator_pin = \"P94\"", "oscillator_pin = \"E3\"", "oscillator_pin = \"E3\": no such pin; the package of xc6slx9-tqg144-2 has P1..P144"),
        (PAPILIO, "trigger_i = \"C8\"", "trigger_i = \"P3\"", "wing.trigger_i = \"P3\": is not on a connector of mine; use A0..A15"),
        (PAPILIO, "trigger_i = \"C8\"", "trigger_in = \"C8\"", "wing.trigger_in = \"C8\": no such signal; did you mean trigger_i?"),
        (PAPILIO, "A = [\"P48\"", "A1 = [\"P48\"", "connectors.A1: is no name of a connector; use capital letters"),
        (ULX3S, "GP = [\"B11\"", "GP = [\"Z11\"", "connectors.GP = \"Z11\": no such pin; the package of LFE5U-85F-6BG381C has A1..Y20"),
        (ULX3S, "GP = [\"B11\"", "GP = [\"B21\"", "connectors.GP = \"B21\": no such pin"),
        (ULX3S, "GP = [", "G = [", "connectors.G: G1 is a pin of the package, too; give the connector another name, G_ for example"),
        (ULX3S, "package_rows = \"ABC", "package_rows = \"abc", "package_rows = \"abcDEFGHJKLMNPRTUVWY\": is no list of rows"),
        (ULX3S, "package_columns = 20", "package_columns = 0", "package_columns = 0: outside 1..4096; choose a value in that range"),
        // clock
        (PAPILIO, "oscillator_hz = 32_000_000", "oscillator_hz = 1_000_000", "oscillator_hz = 1000000: the clock manager of Spartan-6 makes no system clock of it; its phase detector takes 19000000..500000000 Hz"),
        (PAPILIO, "oscillator_hz = 32_000_000", "oscillator_hz = -1", "oscillator_hz = -1: outside 1000..1000000000"),
        (PAPILIO, "[wing]", "[start]\nsystem_hz = 96_000_000\nclock_hz = 3_000_000\nchannels = 3\n[wing]", "start.channels = 3: outside 1..2"),
        (PAPILIO, "[wing]", "[start]\nsystem_hz = 99_999_999\nclock_hz = 3_000_000\n[wing]", "start.system_hz = 99999999: the clock manager cannot make it from the board's 32000000 Hz; use 99200000 or 100000000 Hz"),
        // banks
        (TANG_NANO, "10 = \"LVCMOS18\"", "10 = \"LVCMOS33\"", "iostandards.10 = \"LVCMOS33\": needs a supply of 3300 mV, and banks.3 has 1800 mV; give the pin one for that in [iostandards]: LVCMOS18"),
        (TANG_NANO, "led_status_o = \"10\"", "led_status_o = \"14\"", "fixed.led_status_o = \"14\": LVCMOS33, its standard by `iostandard`, needs a supply of 3300 mV, and banks.3 has 1800 mV; give the pin one for that in [iostandards]: LVCMOS18"),
        (TANG_NANO, "oscillator_pin = \"52\"", "oscillator_pin = \"4\"", "oscillator_pin = \"4\": LVCMOS33, its standard by `iostandard`, needs a supply of 3300 mV"),
        (TANG_NANO, "J6_ = [\"-\", \"38\"", "J6_ = [\"15\", \"38\"", "connectors.J6_ = \"15\": LVCMOS33, its standard by `iostandard`, needs a supply of 3300 mV"),
        (PAPILIO, "[fixed]", "[iostandards]\nP105 = \"LVCMOS18\"\n[fixed]", "iostandards.P105 = \"LVCMOS18\": needs a supply of 1800 mV, and banks.all has 3300 mV; give the pin one for that in [iostandards]: LVCMOS33, LVTTL"),
        (TANG_NANO, "pins = [\"3\", \"4\"", "pins = [\"3\", \"89\"", "banks.3.pins = \"89\": no such pin; the package of GW1NR-LV9QN88PC6/I5 has 1..88"),
        (TANG_NANO, "[iostandards]", "[banks.4]\nsupply_mv = 1_800\npins = [\n\"10\"]\n[iostandards]", "banks.4.pins = \"10\": already stands at banks.3.pins; a pin has one bank, remove one of the two"),
        (TANG_NANO, "supply_mv = 1_800", "supply_mv = 18", "banks.3.supply_mv = 18: outside 1000..3300; choose a value in that range"),
        (TANG_NANO, "supply_mv = 1_800", "supply_mv = 1_850", "banks.3.supply_mv = 1850: no I/O standard of Gowin GW1NR is for that; write one of: 1200, 1500, 1800, 2500, 3300"),
        (TANG_NANO, "supply_mv = 1_800", "supply = 1_800", "banks.3.supply: unknown key; did you mean supply_mv?"),
        (TANG_NANO, "[banks.3]\n", "[banks]\n3 = 1_800\n[elsewhere]\n", "banks.3 = 1_800: is an integer, must be a table headed [banks.3]"),
        (TANG_NANO, "iostandard = \"LVCMOS33\"", "iostandard = \"LVCMOS34\"", "iostandard = \"LVCMOS34\": Gowin GW1NR has no such standard; write one of its: LVCMOS12, LVCMOS15, LVCMOS18, LVCMOS25, LVCMOS33, LVTTL33"),
        (TANG_NANO, "11 = \"LVCMOS18\"", "11 = \"lvcmos18\"", "iostandards.11 = \"lvcmos18\": Gowin GW1NR has no such standard; write one of its: LVCMOS12"),
        // keys and families
        (PAPILIO, "uart_baud_max = 3_000_000", "uart_baud = 3_000_000", "uart_baud: unknown key; did you mean uart_baud_max?"),
        (PAPILIO, "family = \"spartan6\"", "family = \"spartan7\"", "family = \"spartan7\": unknown family; known families: cyclone5, ecp5, gowin, ice40, spartan6, xc7"),
        (PAPILIO, "family = \"spartan6\"", "family = 6", "family = 6: is an integer, must be text in quotes"),
        (ULX3S, "idcode = ", "id = ", "device.id = \"0x41113043\": unknown key; known keys here: idcode, package, size, speed"),
        (ULX3S, "[device]\n", "", "device.idcode: is missing, ECP5 asks for it; add, for example, `idcode = \"0x41111043\"` below `[device]`"),
        // what goes into emitted files
        (PAPILIO, "title = \"Gadget Factory", "title = \"Gadget\\nmodule x; Factory", "has the character '\\n'; use letters, digits"),
        (PAPILIO, "iostandard = \"LVCMOS33\"", "iostandard = \"LVCMOS33; \"", "iostandard = \"LVCMOS33; \": has the character ';'"),
        (PAPILIO, "part = \"xc6slx9-tqg144-2\"", "part = \"\"", "part = \"\": is empty; write what the vendor calls it"),
        // form
        (PAPILIO, "[fixed]", "[fixed", "not TOML:"),
        (PAPILIO, "A = [\"P48\"", "A = 5 # [\"P48\"", "connectors.A = 5: is an integer, must be a list of texts in quotes"),
        (PAPILIO, "trigger_i = \"C8\"", "trigger_i = 8", "wing.trigger_i = 8: is an integer, must be text in quotes"),
    ];
    let dir = Dir::new("board-files");
    for (text, from, to, wanted) in rows {
        let (text, line) = changed(text, from, to);
        let file = dir.write("mine.toml", text.as_bytes());
        let wrong = Board::from_file(Path::new(&file)).expect_err(to);
        let hit = wrong.iter().find(|d| d.text.contains(wanted));
        let hit = hit.unwrap_or_else(|| panic!("{to:?}: no message has {wanted:?}\n{wrong:#?}"));
        let lines = line..=line + to.matches('\n').count();
        // What is missing has no line but that of its table.
        let is_there = lines.contains(&hit.line) || wanted.contains("is missing");
        assert!(is_there, "{to:?}: line {} instead of {lines:?}", hit.line);
        assert_eq!(hit.file, file);
    }
}

#[test]
fn a_board_that_is_no_text_at_all_is_told_so() {
    let dir = Dir::new("board-bytes");
    let binary = dir.write("mine.toml", b"a\0b");
    assert!(bad(&["emit", "--board", &binary], 2).contains("mine.toml:1: has a zero byte"));
    let empty = dir.write("empty.toml", b"");
    let told = bad(&["emit", "--board", &empty], 2);
    for key in [
        "title",
        "family",
        "part",
        "oscillator_pin",
        "oscillator_hz",
        "uart_baud_max",
        "iostandard",
    ] {
        assert!(
            told.contains(&format!("{key}: is missing; add")),
            "{key}\n{told}"
        );
    }
    let none = dir.path("none.toml");
    assert!(bad(&["emit", "--board", &none], 2).contains("none.toml: cannot read:"));
    assert!(bad(&["emit", "--board", "ulx4s"], 2)
        .contains("--board = ulx4s: unknown board; known boards: arty_a7_35, de10_nano"));
    assert!(bad(&["boards", "--show", "x"], 2).contains("--show = x: unknown board"));
}

#[test]
fn a_board_of_ones_own_gives_what_the_shipped_one_gives() {
    let dir = Dir::new("board-own");
    let file = dir.write("mine.toml", good(&["boards", "--show", "ulx3s"]).as_bytes());
    let out = dir.path("o");
    good(&["emit", "--board", "ulx3s", "--name", "card", "--out", &out]);
    let shipped = fs::read(dir.0.join("o/card/card.lpf")).unwrap();
    let top = fs::read(dir.0.join("o/card/card_top.v")).unwrap();
    // Only the board's name is another.
    let told = bad(
        &[
            "emit", "--board", &file, "--name", "card", "--out", &out, "--check",
        ],
        1,
    );
    let is_other = |name: &str| told.contains(&format!("card/{name}: "));
    assert!(
        is_other("README.md") && !is_other("card.lpf") && !is_other("card_top.v"),
        "{told}"
    );
    // The same by the configuration, which names the file from its own folder.
    let text = good(&["presets", "--show", "s6_two_channel", "--board", "ulx3s"]);
    let text = text.replace("name = \"ulx3s\"", "file = \"mine.toml\"");
    let config = dir.write("card.toml", text.as_bytes());
    good(&[
        "emit",
        "--config",
        &config,
        "--name",
        "card",
        "--out",
        &dir.path("p"),
    ]);
    assert_eq!(fs::read(dir.0.join("p/card/card.lpf")).unwrap(), shipped);
    assert_eq!(fs::read(dir.0.join("p/card/card_top.v")).unwrap(), top);
    // What is wrong in it is told with its own line, whoever names it.
    let (wrong, line) = changed(ULX3S, "oscillator_pin = \"G2\"", "oscillator_pin = \"G21\"");
    dir.write("mine.toml", wrong.as_bytes());
    let told = bad(&["explain", "--config", &config], 2);
    assert!(
        told.contains(&format!(
            "mine.toml:{line}: oscillator_pin = \"G21\": no such pin"
        )),
        "{told}"
    );
    let twice = dir.write(
        "twice.toml",
        text.replace("file = ", "name = \"ulx3s\"\nfile = ")
            .as_bytes(),
    );
    assert!(bad(&["explain", "--config", &twice], 2)
        .contains("board.name = \"ulx3s\": file names a board, too; remove one"));
}

#[test]
fn a_card_on_another_board_is_checked_against_that_board() {
    let dir = Dir::new("board-other");
    let text = good(&["presets", "--show", "s6_two_channel"]);
    let file = dir.write("card.toml", text.as_bytes());
    let told = bad(&["explain", "--config", &file, "--board", "hx8k_b_evn"], 2);
    assert!(told.contains("card.toml:8: clock.system_hz = 100000000: the clock manager cannot make it from the board's 12000000 Hz; use 99000000 or 100500000 Hz"), "{told}");
    assert!(good(&["explain", "--config", &file, "--board", "ulx3s"])
        .contains("25000000 Hz * 4 / 1 / 1"));
    let moved = dir.write(
        "moved.toml",
        text.replace("[pins]", "[pins]\ntrigger_i = \"C9\"")
            .as_bytes(),
    );
    let told = bad(&["explain", "--config", &moved, "--board", "ulx3s"], 2);
    assert!(
        told.contains(
            "pins.trigger_i = \"C9\": is not on a connector of ulx3s; use GN0..GN27, GP0..GP27"
        ),
        "{told}"
    );
    // What has no board top has no board.
    let inside = "name = \"card\"\n[host]\nbus = \"apb\"\n[clock]\nsystem_hz = 100_000_000\n[[channel]]\nclock_hz = 3_125_000\nposition_bits = 29\ncommand = \"111000\"\n[trigger]\nsample_hz = 10_000\n";
    let inside = dir.write("inside.toml", inside.as_bytes());
    let told = bad(&["emit", "--config", &inside, "--board", "ulx3s"], 2);
    assert!(told.contains("host.bus = \"apb\": stays inside the chip, so the card has no board top; leave --board ulx3s out"), "{told}");
    let told = bad(&["emit", "--preset", "async_dsp", "--board", "ulx3s"], 2);
    assert!(
        told.contains("is a T-format receiver, which has no board top; leave --board ulx3s out"),
        "{told}"
    );
}

/// A family of one's own beside a board of one's own: copies of these.
pub fn own_family(dir: &Dir, family: &str, board: &str) -> String {
    let families = Path::new(env!("CARGO_MANIFEST_DIR")).join("constraints/families");
    let from = families.join(family);
    fs::create_dir_all(dir.0.join("mine")).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, dir.0.join("mine").join(path.file_name().unwrap())).unwrap();
    }
    dir.write(
        "board.toml",
        board
            .replace(&format!("family = \"{family}\""), "family = \"./mine\"")
            .as_bytes(),
    )
}

/// Catches an assignment that Quartus never sees.
#[test]
fn an_assignment_without_a_value_is_not_left_out_in_silence() {
    let dir = Dir::new("family-assignments");
    let board = own_family(&dir, "cyclone5", DE10_NANO);
    let emit = ["emit", "--board", &board, "--out", &dir.path("o")];
    good(&emit);
    let text = fs::read_to_string(dir.0.join("mine/family.toml")).unwrap();
    let (text, _) = changed(&text, "FAST_OUTPUT_REGISTER ON", "FAST_OUTPUT_REGISTER");
    dir.write("mine/family.toml", text.as_bytes());
    let told = bad(&emit, 2);
    assert!(
        told.contains("./mine/constraints.jinja: undefined value"),
        "{told}"
    );
}

#[test]
fn a_family_of_ones_own_is_a_folder_and_what_is_wrong_with_it_is_told() {
    let dir = Dir::new("family");
    let board = own_family(&dir, "ecp5", ULX3S);
    let explain = ["explain", "--board", &board];
    assert!(good(&explain).contains("25000000 Hz * 4"));
    let rows = [
        ("divide = [1, 128]", "divide = [128, 1]", "clock_manager.divide = [128, 1]: is no range; write the least, from 1 on, and the greatest, up to 1024"),
        ("divide = [1, 128]", "divide = [1, 99999]", "clock_manager.divide = [1, 99999]: is no range"),
        ("feedback = \"output\"", "feedback = \"out\"", "clock_manager.feedback = \"out\": unknown; use loop"),
        ("vco_hz = [400_000_000, 800_000_000]\n", "", "clock_manager.vco_hz: is missing; add"),
        ("constraints = \"lpf\"", "constraints = \"../lpf\"", "constraints = \"../lpf\": is no end of a file's name"),
        ("LVCMOS18 = 1_800", "LVCMOS18 = 18", "supplies.LVCMOS18 = 18: outside 1000..3300; choose a value in that range"),
        ("LVCMOS18 = 1_800", "LVCMOS18 = \"1.8 V\"", "supplies.LVCMOS18 = \"1.8 V\": is a string, must be a whole number"),
        ("\"ioff_dir=output\"", "\"ioff dir=output\"", "build.output_registers = \"ioff dir=output\": is no attribute, NAME=VALUE of letters, digits and _; write, for example, ioff_dir=output"),
        ("led = ", "leds = ", "attributes.led: is missing; add"),
        ("pack = [\"ecppack\"", "pack = [\"rm\"", "build.pack = \"rm\": does not begin with a tool for it"),
        ("    \"nextpnr-ecp5\"", "    \"/bin/nextpnr-ecp5\"", "build.place = \"/bin/nextpnr-ecp5\": does not begin with a tool for it"),
        ("\"diamondc\"", "\"sh\"", "vendor.run = \"sh\": does not begin with a tool for it"),
        ("constraints = \"lpf\"", "timing = \"../sdc\"\nconstraints = \"lpf\"", "timing = \"../sdc\": is no end of a file's name"),
        ("synth_ecp5 -nowidelut", "synth_ecp5; exec -- ls", "build.synthesis = \"synth_ecp5; exec -- ls\": is no synthesis command"),
    ];
    let good_text = fs::read_to_string(dir.0.join("mine/family.toml")).unwrap();
    for (from, to, wanted) in rows {
        let (text, line) = changed(&good_text, from, to);
        dir.write("mine/family.toml", text.as_bytes());
        let told = bad(&explain, 2);
        assert!(told.contains(wanted), "{to}: {told}");
        let place = format!("mine/family.toml:{line}: {wanted}");
        assert!(
            told.contains(&place) || wanted.contains("missing"),
            "{place}\n{told}"
        );
    }
    // A family that says nothing of supplies has boards without banks.
    let from = good_text.find("[supplies]").unwrap();
    let to = from + good_text[from..].find("\n\n").unwrap();
    let silent = format!("{}{}", &good_text[..from], &good_text[to..]);
    dir.write("mine/family.toml", silent.as_bytes());
    assert!(good(&explain).contains("25000000 Hz * 4"));
    let with_bank =
        fs::read_to_string(&board).unwrap() + "[banks.0]\nsupply_mv = 3_300\npins = []\n";
    let with_bank = dir.write("bank.toml", with_bank.as_bytes());
    let told = bad(&["explain", "--board", &with_bank], 2);
    assert!(
        told.contains("banks: ECP5 does not say which supplies its I/O standards need; add, for example, `LVCMOS18 = 1800` below `[supplies]` of its family.toml"),
        "{told}"
    );
    dir.write("mine/family.toml", good_text.as_bytes());
    // A script from elsewhere may do anything: it is not run.
    let out = dir.path("o");
    let told = bad(&["build", "--vendor", "--board", &board, "--out", &out], 2);
    assert!(
        told.contains("./mine: its script is not one of this program, so you run it: `diamondc "),
        "{told}"
    );
    // Two files of one name.
    let twice = good_text.replace("constraints = \"lpf\"", "constraints = \"sdc\"");
    dir.write("mine/family.toml", twice.as_bytes());
    let told = bad(&["emit", "--board", &board, "--out", &dir.path("o")], 2);
    assert!(
        told.contains(".sdc: two files have this name; give constraints or timing"),
        "{told}"
    );
    dir.write("mine/family.toml", good_text.as_bytes());
    dir.write("mine/clock.v.jinja", b"{{ pll.divide");
    let told = bad(&["emit", "--board", &board, "--out", &dir.path("o")], 2);
    assert!(told.contains("./mine/clock.v.jinja"), "{told}");
    dir.write("mine/clock.v.jinja", b"{{ pll.divider }}");
    let told = bad(&["emit", "--board", &board, "--out", &dir.path("o")], 2);
    assert!(
        told.contains("./mine/clock.v.jinja") && !told.contains("report it"),
        "{told}"
    );
    fs::remove_file(dir.0.join("mine/clock.v.jinja")).unwrap();
    let told = bad(&explain, 2);
    assert!(
        told.contains("mine/clock.v.jinja: cannot read:")
            && told.contains("; a family has family.toml, clock.v.jinja, constraints.jinja"),
        "{told}"
    );
}
