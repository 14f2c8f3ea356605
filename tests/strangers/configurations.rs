//! The configurations whose emissions strangers are given: every preset, and cards that have what no preset has.

use endat_config::{parse_any, preset, Configuration, PRESETS, RECEIVER_PRESETS};
use endat_console::artifact::Artifact;
use endat_hdl::card::bus::HostBus;
use endat_regs::Protocol;

/// An EnDat 2.2 channel, and an EnDat 2.1 one.
const NEW: &str = "position_bits = 29\ncommand = \"111000\"";
const OLD: &str = "position_bits = 25\ncommand = \"000111\"";
const T_FORMAT: &str = "protocol = \"t_format\"";

/// A card that is no preset.
struct Card {
    name: &'static str,
    system_hz: u64,
    /// EnDat clock; 0 where no channel speaks EnDat.
    clock_hz: u64,
    bus: &'static str,
    channels: &'static [&'static str],
    /// Further tables.
    more: &'static str,
}

const fn card(
    name: &'static str,
    system_hz: u64,
    clock_hz: u64,
    bus: &'static str,
    channels: &'static [&'static str],
    more: &'static str,
) -> Card {
    Card {
        name,
        system_hz,
        clock_hz,
        bus,
        channels,
        more,
    }
}

const LINK: &str = "[link]\nbaud = 1_000_000\nread_hz = 100\n[board]\nname = \"papilio_pro\"\n";

/// Each bus, part, protocol and extreme at least once, with clocks whose half period is no whole number of picoseconds among them.
const CARDS: [Card; 29] = [
    card("one_bit", 128_000_000, 16_000_000, "uart", &["position_bits = 1\ncommand = \"000111\""], LINK),
    card("widest", 96_000_000, 2_000_000, "uart", &["position_bits = 48\ncommand = \"111000\"", "clock_hz = 8_000_000\nposition_bits = 13\ncommand = \"000111\""], LINK),
    card("apb", 100_000_000, 3_125_000, "apb", &[NEW, OLD], "[outputs]\nparts = [\"position\", \"interrupt\"]\n"),
    card("wishbone", 48_000_000, 3_000_000, "wishbone", &[NEW, OLD], "[outputs]\nparts = [\"interrupt\"]\n"),
    card("axi_lite", 77_000_000, 7_000_000, "axi_lite", &[NEW, OLD], "[outputs]\nparts = [\"position\"]\n[safety]\nparts = [\"recovery_counter\", \"second_interface\"]\n"),
    card("ahb_lite", 90_000_000, 5_000_000, "ahb_lite", &[OLD, NEW], "[outputs]\nparts = [\"interrupt\"]\n"),
    card("spi", 73_728_000, 4_608_000, "spi", &[NEW, OLD], ""),
    card("spi_board", 64_000_000, 8_000_000, "spi", &[NEW, OLD], "[board]\nname = \"papilio_pro\"\n[safety]\nparts = [\"second_interface\"]\n"),
    card("parallel", 240_000_000, 10_000_000, "parallel", &[NEW, OLD], ""),
    card("parallel_board", 80_000_000, 8_000_000, "parallel", &[NEW], "[board]\nname = \"papilio_pro\"\n[outputs]\nparts = [\"interrupt\"]\n"),
    card("bare", 100_000_000, 4_000_000, "none", &[NEW], "[safety]\nparts = [\"second_receiver\"]\n"),
    card("bare_requests", 60_000_000, 4_000_000, "none", &[NEW], "[service]\nparts = [\"requests\"]\n"),
    card("requests", 100_000_000, 3_125_000, "uart", &[NEW, OLD], "[link]\nbaud = 2_000_000\nread_hz = 100\n[board]\nname = \"papilio_pro\"\n[service]\nparts = [\"requests\"]\n"),
    card("diagnosis", 50_000_000, 2_000_000, "apb", &[NEW, OLD], "[service]\nparts = [\"requests\", \"diagnosis\"]\n"),
    card("continuous", 100_000_000, 2_000_000, "apb", &[OLD], "[service]\nparts = [\"requests\", \"continuous\"]\n"),
    card("initialise", 64_000_000, 8_000_000, "apb", &[NEW, NEW], "[service]\nparts = [\"requests\", \"diagnosis\", \"continuous\", \"initialise\"]\n[safety]\nparts = [\"second_receiver\", \"error_test\"]\n"),
    card("infos", 100_000_000, 3_125_000, "wishbone", &[NEW, NEW], "[service]\nparts = [\"requests\"]\ninfos = [0x4C, 0x5B]\n[safety]\nparts = [\"error_test\"]\nerror_test_ms = 10\n"),
    card("alignment", 128_000_000, 8_000_000, "apb", &[NEW, OLD], "[line]\nparts = [\"alignment\"]\n"),
    card("margin", 120_000_000, 3_000_000, "axi_lite", &[NEW, OLD], "[line]\nparts = [\"alignment\", \"margin\"]\nsamples = 3\ndrift_limit_ns = 40\n"),
    card("double_edge", 32_000_000, 16_000_000, "apb", &[NEW, OLD], "[line]\nparts = [\"alignment\", \"margin\", \"double_edge\"]\n"),
    card("long_cable", 25_000_000, 100_000, "wishbone", &["cable_m = 780\nposition_bits = 29\ncommand = \"111000\""], ""),
    card("stream_collect", 100_000_000, 4_000_000, "apb", &[NEW, OLD], "[stream]\nfifo_bytes = 1024\nstart = \"collect\"\n"),
    card("stream_push", 100_000_000, 4_000_000, "uart", &[NEW, OLD], "[link]\nbaud = 3_000_000\nread_hz = 100\n[board]\nname = \"papilio_pro\"\n[stream]\nfifo_bytes = 8192\nstart = \"push\"\n"),
    card("own_triggers", 100_000_000, 4_000_000, "wishbone", &["divider = 3\nposition_bits = 25\ncommand = \"111000\"", "sources = [\"timer\"]\nposition_bits = 25\ncommand = \"111000\"", "enabled = false\nposition_bits = 25\ncommand = \"111000\""], ""),
    card("eight_channels", 100_000_000, 4_000_000, "axi_lite", &[NEW, OLD, NEW, OLD, NEW, OLD, NEW, OLD], ""),
    card("t_format", 100_000_000, 0, "apb", &["protocol = \"t_format\"\nbit_hz = 5_000_000\nrequest = 0", T_FORMAT, "protocol = \"t_format\"\nrequest = 12\nfilter_ns = 0"], ""),
    card("both_protocols", 100_000_000, 3_125_000, "axi_lite", &[NEW, T_FORMAT], "[outputs]\nparts = [\"position\", \"interrupt\"]\n[stream]\nfifo_bytes = 1024\nstart = \"collect\"\n"),
    card("ssi", 33_000_000, 0, "wishbone", &["protocol = \"ssi\"\nposition_bits = 1\nparity = \"even\"\nclock_hz = 500_000", "protocol = \"ssi\"\nposition_bits = 48\nclock_hz = 200_000\ntwice = true\nparity = \"odd\"\nbits_before = [\"not_alarm\", \"ignored\", \"shown\"]\nbits_after = [\"power_fail\", \"valid\", \"ignored\", \"parity_even\", \"crc6\", \"ignored\"]"], "[outputs]\nparts = [\"position\"]\n"),
    card("all_protocols", 70_000_000, 2_500_000, "ahb_lite", &["protocol = \"ssi\"\nposition_bits = 13\ncode = \"gray\"\nclock_hz = 500_000\nend_low = false", NEW, T_FORMAT], ""),
];

/// A bus or a protocol that no emission has would be shown to nobody.
#[test]
fn every_bus_and_protocol_is_among_them() {
    let texts = texts();
    let has = |words: String| texts.iter().any(|(_, text)| text.contains(&words));
    for bus in HostBus::ALL {
        assert!(has(format!("bus = \"{}\"", bus.name())), "{bus:?}");
    }
    for protocol in &Protocol::ALL[1..] {
        let key = protocol.row().word;
        assert!(has(format!("protocol = \"{key}\"")), "{key}");
    }
}

/// A receiver that is no preset.
const RECEIVER: (&str, &str) = (
    "fast_receiver",
    "name = \"fast_receiver\"\n[host]\nbus = \"dsp\"\n[[channel]]\nprotocol = \"t_format\"\nbit_hz = 5_000_000\nrequest = 0\nfilter_cycles = 0\n",
);

impl Card {
    fn text(&self) -> String {
        let endat = match self.clock_hz {
            0 => String::new(),
            // A row's own cable goes first.
            hz => format!("[endat]\nclock_hz = {hz}\ncable_m = 20\n"),
        };
        let channels = self.channels.iter().map(|c| format!("[[channel]]\n{c}\n"));
        format!(
            "name = \"{}_card\"\n[clock]\nsystem_hz = {}\n{endat}{}[trigger]\nsample_hz = 1_000\nsources = [\"pin\", \"register\"]\n[host]\nbus = \"{}\"\n{}",
            self.name,
            self.system_hz,
            channels.collect::<String>(),
            self.bus,
            self.more
        )
    }
}

/// One of the configurations.
pub struct Emission {
    pub configuration: Configuration,
    pub files: Vec<Artifact>,
}

impl Emission {
    /// Name of the top module.
    pub fn top(&self) -> &str {
        match &self.configuration {
            Configuration::Card(card) => &card.name,
            Configuration::Receiver(receiver) => &receiver.name,
        }
    }
}

/// Name and text of each.
pub fn texts() -> Vec<(String, String)> {
    let presets = PRESETS
        .iter()
        .chain(RECEIVER_PRESETS)
        .map(|(name, _)| *name);
    let presets = presets.map(|name| (name.to_owned(), preset(name).unwrap().to_owned()));
    let cards = CARDS.iter().map(|card| (card.name.to_owned(), card.text()));
    let receiver = std::iter::once(RECEIVER).map(|(n, t)| (n.to_owned(), t.to_owned()));
    presets.chain(cards).chain(receiver).collect()
}

/// What is emitted for one of them.
pub fn emission(name: &str, text: &str) -> Emission {
    let configuration = parse_any(&format!("{name}.toml"), text).unwrap();
    let files = match &configuration {
        Configuration::Card(card) => endat_emit::emit(card),
        Configuration::Receiver(receiver) => endat_emit::protocols::t_format::emit(receiver),
    };
    Emission {
        configuration,
        files: files.unwrap(),
    }
}
