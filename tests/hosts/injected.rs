//! Faults of a virtual card that runs, and what a host sees of them.

use super::{card_of, slow_card, Served};
use crate::program::{bad, good};
use crate::tools;
use endat_card::Door;
use endat_host::feed::{Cell, Feed, Row};
use endat_host::transport::Port;
use endat_host::{Bridge, Card};
use endat_recording::count::Judge;
use endat_recording::picture::{Counter, Extras, Picture};
use std::collections::VecDeque;
use std::time::Duration;

/// A host that takes rows of a card, while faults are made beside it.
struct Watcher {
    port: String,
    card: Card<Port>,
    feed: Feed,
    rows: VecDeque<Row>,
}

/// Rows in which what is waited for must have come.
const ROWS_MAX: usize = 2_000;

impl Watcher {
    fn new(port: &str) -> Self {
        let link = Port::open(port, 2_000_000).unwrap();
        let mut card = Card::find(Bridge::new(link)).unwrap();
        Self {
            port: port.to_owned(),
            feed: Feed::begin(&mut card, false).unwrap(),
            card,
            rows: VecDeque::new(),
        }
    }

    fn inject(&self, words: &str) -> String {
        let words = words.split(' ');
        let all: Vec<&str> = ["inject", "--port", &self.port]
            .into_iter()
            .chain(words)
            .collect();
        good(&all)
    }

    fn next(&mut self) -> Row {
        while self.rows.is_empty() {
            let wait = Duration::from_millis(50);
            self.feed
                .fill(&mut self.card, &mut self.rows, wait)
                .unwrap();
        }
        self.rows.pop_front().unwrap()
    }

    /// The first row from now on in which a channel is so.
    fn wait(&mut self, channel: usize, is_so: impl Fn(&Cell) -> bool) -> Row {
        let mut last = None;
        for _ in 0..ROWS_MAX {
            let row = self.next();
            if is_so(&row.cells[channel]) {
                return row;
            }
            last = Some(row);
        }
        panic!("never: {last:?}");
    }
}

fn is_good(cell: &Cell) -> bool {
    cell.fresh && cell.cause == "none"
}

/// Catches a fault that is told and not made, one that does not go, and one that the other channel has, too.
#[test]
fn a_plug_that_is_pulled_and_put_in_again_is_seen_and_gone() {
    let card = Served::new(slow_card(), || Door::tcp("127.0.0.1:0").unwrap());
    let mut host = Watcher::new(&card.name);
    host.wait(0, is_good);
    let told = host.inject("unplug 0");
    assert!(told.starts_with("unplug 0 at "), "{told}");
    // The frame that loses its encoder ends with whatever it has met. In those after it nobody drives DATA, and the receiver's bias is HIGH.
    let seen = host.wait(0, |cell| cell.cause == "data_not_low");
    assert!(is_good(&seen.cells[1]), "{seen:?}");
    host.inject("plug 0");
    host.wait(0, is_good);
    for (fault, cause) in [
        ("crc 1", "crc"),
        ("f1 1 2", "f1"),
        ("silent 1", "no_start_bit"),
        ("alarm 1 4", "f1"),
        ("line 1 stuck_low", "no_start_bit"),
    ] {
        host.inject(fault);
        host.wait(1, |cell| cell.cause == cause);
        host.inject("heal 1");
        host.wait(1, is_good);
        assert!(
            host.rows.iter().all(|row| is_good(&row.cells[0])),
            "{fault}"
        );
    }
}

/// Catches somebody who is taken for a host, and a host that waits for one who makes faults.
#[test]
fn wrong_faults_and_wrong_cards_are_told() {
    let card = Served::new(slow_card(), || Door::tcp("127.0.0.1:0").unwrap());
    let inject = |words: &[&str]| {
        let begin = ["inject", "--port", card.name.as_str()];
        bad(&[&begin[..], words].concat(), 2)
    };
    assert!(inject(&["unplgu", "0"]).contains("did you mean unplug?"));
    for channel in ["2", "7", "8", "0x99999999999"] {
        let told = inject(&["unplug", channel]);
        let right = format!("channel = {channel}: this card has channels 0 to 1; give one of");
        assert!(told.contains(&right), "{told}");
    }
    // What looks like an option is a value.
    let negative = inject(&["jitter", "0", "-20ns"]);
    assert!(
        negative.contains("-20: outside 0..1000; give"),
        "{negative}"
    );
    let behind = bad(&["inject", "slow", "0", "-5us", "--port", &card.name], 2);
    assert!(behind.contains("-5: outside 0..10000; give"), "{behind}");
    let preset = bad(&["log", "--port", "load:nothere", "--samples", "1"], 2);
    assert!(
        preset.contains("load:PRESET in --port = nothere: unknown preset"),
        "{preset}"
    );
    let elsewhere = bad(
        &["inject", "--port", "tcp:192.0.2.1:7700", "unplug", "0"],
        2,
    );
    assert!(elsewhere.contains("is another machine"), "{elsewhere}");
    let serial = bad(&["inject", "--port", "/dev/ttyUSB1", "unplug", "0"], 2);
    assert!(serial.contains("give tcp:HOST:PORT"), "{serial}");
    // Another server says something else, or nothing.
    let other = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = format!("tcp:{}", other.local_addr().unwrap());
    let end = std::thread::spawn(move || drop(other.accept().unwrap()));
    let told = bad(&["inject", "--port", &port, "unplug", "0"], 1);
    end.join().unwrap();
    assert!(
        told.contains("no virtual card of this program answers")
            || told.contains("is the card running?"),
        "{told}"
    );
    let all = good(&["inject", "--list"]);
    assert!(
        all.lines().count() > 10 && all.contains("slow CHANNEL TIME"),
        "{all}"
    );
}

/// In a card's own time the same faults give the same rows: the drawing of the page, which shows each of them.
#[test]
fn the_drawing_of_a_rehearsal_shows_gaps_and_causes() {
    let mut card = Card::find(Bridge::new(card_of(&slow_card()))).unwrap();
    let scales = card.scales().unwrap();
    let units: Vec<String> = scales
        .iter()
        .map(|s| s.convert(0).unit.to_owned())
        .collect();
    let mut counter = Counter::new(&scales);
    let extras = Extras {
        difference: true,
        velocity: false,
    };
    let mut picture = Picture::new(&units, &[], Judge::default(), extras);
    let mut feed = Feed::begin(&mut card, false).unwrap();
    let mut rows = VecDeque::new();
    let mut count = 0;
    while count < 400 {
        feed.fill(&mut card, &mut rows, Duration::from_millis(1))
            .unwrap();
        for row in rows.drain(..) {
            let fault = match count {
                60 => "crc 1",
                120 => "unplug 0",
                200 => "plug 0",
                260 => "f1 1 5",
                320 => "silent 0",
                _ => "",
            };
            if !fault.is_empty() {
                card.bridge().transport().inject(fault).unwrap();
            }
            count += 1;
            let time_s = row.cycles as f64 / f64::from(card.identity().system_hz);
            picture.push(&counter.measurement(&row, time_s, Vec::new()));
        }
    }
    let drawn = picture.svg("A rehearsal", "crc 1, unplug 0, plug 0, f1 1 5, silent 0");
    for lane in [
        "channel 0 data_not_low: 3<",
        "channel 0 no_start_bit: 1<",
        "channel 1 crc: 1<",
        "channel 1 f1: 5<",
    ] {
        assert!(drawn.contains(lane), "{lane}");
    }
    // Before, between and behind the two gaps.
    assert_eq!(drawn.matches("class=\"series-0\"").count(), 3);
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/recording.svg");
    tools::assert_committed(&path, &drawn);
}

/// Catches a fault of a T-format encoder that is none, another one, or does not end.
#[test]
fn a_t_format_encoder_takes_faults_and_heals() {
    let project = super::changed(
        "mixed_protocols",
        &[
            ("fifo_bytes = 0", "fifo_bytes = 2048"),
            ("sample_hz = 10_000", "sample_hz = 5_000"),
        ],
    );
    let mut card = super::found(&project);
    let mut feed = Feed::begin(&mut card, false).unwrap();
    let mut rows = VecDeque::new();
    // The delays are measured first.
    while rows.len() < 20 {
        feed.fill(&mut card, &mut rows, Duration::from_millis(1))
            .unwrap();
    }
    let mut next = |card: &mut Card<_>, count: usize| -> Vec<&'static str> {
        rows.clear();
        // Behind what was on its way when the fault was made.
        while rows.len() < count + 10 {
            feed.fill(card, &mut rows, Duration::from_millis(1))
                .unwrap();
        }
        let other = rows.iter().map(|row| row.cells[0].cause);
        assert!(
            other.clone().all(|c| c == "none"),
            "{:?}",
            other.collect::<Vec<_>>()
        );
        rows.iter().map(|row| row.cells[1].cause).collect()
    };
    for (words, cause, times) in [
        ("crc 1 3", "reply_crc", Some(3)),
        ("silent 1 2", "no_answer", Some(2)),
        ("slow 1 60us", "no_answer", None),
        ("line 1 stuck_low", "line_not_idle", None),
        ("line 1 open", "no_answer", None),
        ("unplug 1", "no_answer", None),
        ("alarm 1 4", "counting_error", None),
        ("alarm 1 0x40", "multi_turn_alarm", None),
    ] {
        card.bridge().transport().inject(words).unwrap();
        let causes = next(&mut card, 20);
        let count = causes.iter().filter(|c| **c == cause).count();
        let is_so = times.map_or(count > 15, |times| count == times);
        assert!(is_so, "{words}: {causes:?}");
        card.bridge().transport().inject("heal 1").unwrap();
        next(&mut card, 5);
        assert_eq!(next(&mut card, 5), ["none"; 15], "{words}");
    }
    card.bridge().transport().inject("jitter 1 20ns").unwrap();
    assert!(next(&mut card, 5).iter().all(|cause| *cause == "none"));
    for words in ["f1 1", "warning 1", "noise 1 1e-3", "line 1 short"] {
        let error = card.bridge().transport().inject(words).unwrap_err();
        assert!(error.contains("speaks T-format, which knows unplug, plug, crc"));
    }
}
