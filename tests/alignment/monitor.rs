//! The line's words behind the host link of a card: settings, edges, alarms.

use endat_hdl::endat::line_delay::mode;
use endat_hdl::{
    card::service_times,
    config::{CardConfig, LineParts},
    regs::{BLOCKS, LINE, RESULT},
};
use endat_sim::{
    bench::Link,
    encoder::EncoderConfig,
    line::{Jitter, LineConfig},
    MS, NS, US,
};

/// The line's words behind it.
struct Host(crate::host::Host);

impl Host {
    /// A card at 100 MHz with a sound line on channel 0, and one with jitter on channel 1.
    fn new(jitter_ns: u64, drift: i64) -> Self {
        Self::of(
            crate::host::card("s6_two_channel", 100_000),
            jitter_ns,
            drift,
        )
    }

    /// A card at 25 MHz with a bit of 16 cycles and sound lines.
    fn slow() -> Self {
        let config = crate::host::card_with("s6_two_channel", 25_000, |text| {
            text.replacen("clock_hz = 3_125_000", "clock_hz = 1_562_500", 1)
        });
        Self::of(config, 0, 0)
    }

    fn of(mut config: CardConfig, jitter_ns: u64, drift: i64) -> Self {
        config.line = LineParts {
            alignment: true,
            margin: true,
            double_edge: false,
            ..LineParts::default()
        };
        for channel in &mut config.channels {
            (channel.filter_cycles, channel.start_window_cycles) = (0, 15);
        }
        let link = |jitter_ns: u64, drift| {
            let mut encoder = EncoderConfig::endat22(29).seed(4);
            encoder.tm = 10 * US..=12 * US;
            let mut line = LineConfig::cable(10.0);
            line.data_in.jitter = Jitter::Uniform(jitter_ns * NS);
            line.data_in.drift = drift;
            Link::new(line, encoder)
        };
        let card = crate::made::uart_card(&config, &service_times(&config), 100);
        let links = vec![link(0, 0), link(jitter_ns, drift)];
        Self(crate::host::Host::new(card, config.system_hz, links))
    }

    fn read(&mut self, name: &str, channel: usize) -> u32 {
        self.0.read(&LINE, name, channel)
    }

    fn write(&mut self, name: &str, channel: usize, value: u32) {
        self.0.write(&LINE, name, channel, value);
    }

    fn field(&mut self, name: &str, field: &str, channel: usize) -> u32 {
        let field = *LINE
            .register(name)
            .and_then(|r| r.field(field))
            .expect("a field");
        (self.read(name, channel) & field.mask()) >> field.lsb
    }

    fn offset(&mut self, name: &str, field: &str, channel: usize) -> i8 {
        self.field(name, field, channel) as u8 as i8
    }

    fn histogram(&mut self, channel: usize) -> Vec<u32> {
        let bins = LINE
            .registers
            .iter()
            .filter(|r| r.name.starts_with("edges_"));
        bins.map(|r| self.read(r.name, channel)).collect()
    }
}

#[test]
fn edges_are_counted_and_the_worst_ones_kept() {
    let mut host = Host::new(60, 0);
    host.0.bench.run_for(3 * MS);
    // 10 ns cycles: jitter of 60 ns is 6 places to either side.
    for (channel, least, most) in [(0, 0, 1), (1, 4, 7)] {
        host.write("clear", channel, 1);
        host.0.bench.run_for(2 * MS);
        let (earliest, latest) = (
            host.offset("worst", "earliest", channel),
            host.offset("worst", "latest", channel),
        );
        assert!((-1 - most..=-1 - least).contains(&earliest), "{earliest}");
        assert!((least - 1..=most).contains(&latest), "{latest}");
        assert_eq!(host.field("worst", "valid", channel), 1);
        let frame = host.offset("frame", "earliest", channel);
        assert!(frame >= earliest && host.offset("frame", "latest", channel) <= latest);
        let bins = host.histogram(channel);
        let at = |offset: i8| bins[(offset + 16) as usize];
        assert!(at(earliest) > 0 && at(latest) > 0, "{bins:?}");
        assert_eq!(bins.iter().take((earliest + 16) as usize).sum::<u32>(), 0);
        assert_eq!(bins.iter().skip((latest + 17) as usize).sum::<u32>(), 0);
        let frames = host.read("frames", channel);
        assert!((15..60).contains(&frames), "{frames}");
        assert!(bins.iter().sum::<u32>() > 4 * frames, "{bins:?}");
        assert_eq!(host.read("counts", channel), 0);
    }
    // The delay that is tracked is the one of the result, with its part of a cycle.
    let delay = host.0.read(&RESULT, "evidence", 0) >> 10 & 0x3FF;
    assert_eq!(host.field("phase", "tracked", 0) >> 4, delay);
    host.write("clear", 1, 1);
    let sum: u32 = host.histogram(1).iter().sum();
    assert!(sum < 200, "{sum}");
}

#[test]
fn drift_and_jitter_give_alarm_beyond_their_limits() {
    let mut host = Host::new(60, 8);
    host.0.bench.run_for(3 * MS);
    for channel in [0, 1] {
        // 12 places, 3 cycles of drift.
        host.write("limits", channel, (12 << 16) | (3 * 16));
        host.write("clear", channel, 3);
        assert_eq!(host.field("worst", "drift_alarm", channel), 0);
    }
    host.0.bench.run_for(10 * MS);
    assert_eq!(host.field("worst", "drift_alarm", 0), 0);
    assert_eq!(host.field("worst", "drift_alarm", 1), 1);
    assert_eq!(host.field("worst", "offset_alarm", 1), 0);
    host.write("limits", 1, 2 << 16);
    host.write("clear", 1, 1);
    host.0.bench.run_for(MS);
    assert_eq!(host.field("worst", "drift_alarm", 1), 0);
    assert_eq!(host.field("worst", "offset_alarm", 1), 1);
}

#[test]
fn the_host_chooses_where_the_phase_comes_from() {
    // Aborted frames cost tens of milliseconds.
    let mut host = Host::slow();
    host.0.bench.run_for(3 * MS);
    let tracked = host.field("phase", "tracked", 0);
    let modes = [
        (mode::FRAME, 0, true),
        (mode::FIXED, tracked, true),
        (mode::FIXED, tracked + 16, true),
        (mode::FIXED, tracked + 2 * 16, true),
        // Half a bit of 16 cycles off: on the edges.
        (mode::FIXED, tracked + 8 * 16, false),
        (mode::FIXED, tracked - 5 * 16, true),
        (mode::TRACKED, 0, true),
    ];
    for (mode, delay, is_good) in modes {
        host.write("fixed_delay", 0, delay);
        host.write("alignment", 0, mode as u32);
        assert_eq!(host.read("alignment", 0), mode as u32);
        assert_eq!(host.read("fixed_delay", 0), delay);
        host.0.bench.run_for(MS);
        if !is_good {
            // What an aborted frame costs.
            host.0.bench.run_for(35 * MS);
        }
        host.write("clear", 0, 1);
        host.0.bench.run_for(MS);
        let bad = host.field("counts", "bad_frames", 0);
        assert_eq!(bad == 0, is_good, "mode {mode}, delay {delay}");
        // The other channel does not mind.
        assert_eq!(host.field("counts", "bad_frames", 1), 0);
        if !is_good {
            host.write("alignment", 0, mode::TRACKED as u32);
            host.0.bench.run_for(35 * MS);
        }
    }
}

#[test]
fn the_words_of_all_blocks_are_apart() {
    let mut seen = std::collections::BTreeSet::new();
    for block in BLOCKS {
        let channels = if block.per_channel { 8 } else { 1 };
        for (register, channel) in
            (block.registers.iter()).flat_map(|r| (0..channels).map(move |c| (r, c)))
        {
            assert!(
                seen.insert(block.address(register, channel)),
                "{}",
                register.name
            );
        }
    }
}
