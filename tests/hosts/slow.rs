//! A host that is slower than the card: what is lost is lost as whole sets, and counted.

use super::{card_of, found, quick, SERVICE};
use endat_card::{Door, VirtualCard};
use endat_host::feed::{Feed, Row};
use endat_host::registers::Place;
use endat_host::stream::Decoder;
use endat_host::{Bridge, Card, Transport};
use std::collections::{BTreeSet, VecDeque};
use std::io;
use std::time::Duration;

/// Catches a write whose effect comes later than anybody would think, and of which nobody is told.
#[test]
fn a_period_that_is_written_while_the_timer_runs_says_when_it_counts() {
    use super::{slow_card, Served};
    use crate::program::{good, run};
    let card = Served::new(slow_card(), || Door::tcp("127.0.0.1:0").unwrap());
    let write = |name: &str, value: &str| {
        let done = run(&["reg", "write", name, value, "--port", &card.name]);
        assert_eq!(done.exit_code, 0, "{done:?}");
        done.messages.join("\n")
    };
    let told = write("card_config.trigger_period", "2000000");
    assert!(
        told.contains("the period under way is the new one"),
        "{told}"
    );
    assert_eq!(write("card_config.trigger_period", "2000000"), "");
    let told = write("card_config.trigger_period.value", "1000000");
    // Its timer has 24 bits.
    assert!(
        told.contains("through all of its 16777216 cycles"),
        "{told}"
    );
    assert!(
        told.contains("write 0 to card_config.trigger_sources.timer"),
        "{told}"
    );
    let timer = "card_config.trigger_sources.timer";
    good(&["reg", "write", timer, "0", "--port", &card.name]);
    assert_eq!(write("card_config.trigger_period", "20000"), "");
    good(&["reg", "write", timer, "1", "--port", &card.name]);
}

/// Bytes that the operating system keeps for a program that does not read: a hundred sets and a part of one.
const ROOM: usize = 100 * 28 + 11;

/// A link whose other end is sometimes busy with something else.
struct Sluggish {
    card: VirtualCard,
    kept: VecDeque<u8>,
    thrown_away: usize,
}

impl Sluggish {
    fn away(&mut self, cycles: u64) {
        self.card.run(cycles);
        for byte in self.card.take_bytes() {
            match self.kept.len() < ROOM {
                true => self.kept.push_back(byte),
                false => self.thrown_away += 1,
            }
        }
    }
}

impl Transport for Sluggish {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.card.send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        if self.kept.is_empty() {
            return self.card.receive(buffer, wait);
        }
        let count = buffer.len().min(self.kept.len());
        for (to, byte) in buffer.iter_mut().zip(self.kept.drain(..count)) {
            *to = byte;
        }
        Ok(count)
    }
}

fn positions_sent(card: &mut VirtualCard) -> [BTreeSet<u64>; 2] {
    [0, 1].map(|channel| {
        let frames = card.bench().frames(channel);
        frames.iter().map(|f| f.position).collect()
    })
}

fn assert_rows(rows: &VecDeque<Row>, sent: &[BTreeSet<u64>; 2]) {
    for (before, row) in rows.iter().zip(rows.iter().skip(1)) {
        assert_eq!(row.trigger, before.trigger + 1 + row.missing);
        // The time stamps are those of the triggers: five thousand a second at 20 MHz.
        let triggers = row.trigger - before.trigger;
        assert_eq!(row.cycles - before.cycles, triggers * 4_000);
    }
    for row in rows {
        for (cell, sent) in row.cells.iter().zip(sent) {
            assert!(
                cell.fresh && sent.contains(&cell.position.unwrap()),
                "{row:?}"
            );
        }
    }
}

/// Catches a torn frame that is taken for a whole one, and sets that vanish without a number.
#[test]
fn a_host_that_is_away_for_long_knows_what_it_has_missed() {
    knows_what_it_has_missed(&[0, 50, 0], 20, &[120]);
}

#[test]
#[ignore = "slow: a host that is away twice"]
fn a_host_that_is_away_twice_knows_what_it_has_missed() {
    knows_what_it_has_missed(&[0, 6, 60, 2, 100, 0], 150, &[150, 350]);
}

/// A host that is away for these milliseconds, and reads so many rows after each; each gap is longer than this.
fn knows_what_it_has_missed(pauses_ms: &[u64], count: usize, gaps: &[u64]) {
    let link = Sluggish {
        card: card_of(&quick(SERVICE)),
        kept: VecDeque::new(),
        thrown_away: 0,
    };
    let mut card = Card::find(Bridge::new(link)).unwrap();
    for channel in [0, 1] {
        card.wait_for_initialisation(channel).unwrap();
    }
    let mut feed = Feed::begin(&mut card, false).unwrap();
    let mut rows = VecDeque::new();
    let wait = Duration::from_millis(2);
    for pause_ms in pauses_ms {
        card.bridge().transport().away(pause_ms * 20_000);
        let until = rows.len() + count;
        while rows.len() < until {
            feed.fill(&mut card, &mut rows, wait).unwrap();
        }
    }
    let least: u64 = gaps.iter().map(|gap| gap * 28).sum();
    assert!(card.bridge().transport().thrown_away as u64 > least.min(4_000));
    // Nothing was lost in the card: it never waits for the host.
    assert_eq!(feed.lost_in_card(), 0);
    let missing: Vec<u64> = rows.iter().map(|r| r.missing).filter(|m| *m > 0).collect();
    assert_eq!(missing.len(), gaps.len(), "{missing:?}");
    let is_long = |(found, least): (&u64, &u64)| found > least;
    assert!(missing.iter().zip(gaps).all(is_long), "{missing:?}");
    let sent = positions_sent(&mut card.bridge().transport().card);
    assert_rows(&rows, &sent);
    feed.end(&mut card).unwrap();
    assert_eq!(card.bridge().read(0, 1).unwrap(), [0x456E_4474]);
}

/// Catches a buffer that overwrites, a count of lost sets that is not that of the gaps, and half a set.
#[test]
fn a_host_that_drains_too_slowly_gets_whole_sets_and_the_number_of_the_others() {
    drains_too_slowly(9, 60, 30);
}

#[test]
#[ignore = "slow: a host that drains too slowly for 160 ms"]
fn a_host_that_drains_too_slowly_for_long_gets_whole_sets_and_the_number_of_the_others() {
    drains_too_slowly(40, 150, 400);
}

/// Drains so often; more sets than this come, and more are missing than this.
fn drains_too_slowly(rounds: u32, least_sets: usize, least_missing: u64) {
    let mut card = found(&quick(SERVICE));
    for channel in [0, 1] {
        card.wait_for_initialisation(channel).unwrap();
    }
    let at = |register: &str| Place::named(&format!("card.{register}"), 2).unwrap();
    card.write(&at("stream_clear"), 1).unwrap();
    card.write(&at("stream_control"), 1).unwrap();
    let mut decoder = Decoder::default();
    // The first byte from a cleared buffer begins a frame.
    decoder.push(0);
    let drain = |card: &mut Card<VirtualCard>, decoder: &mut Decoder, words| {
        let address = at("stream_data").address();
        for word in card.bridge().read_fixed(address, words).unwrap() {
            word.to_be_bytes().into_iter().for_each(|b| decoder.push(b));
        }
    };
    // 112 bytes in 4 ms are four sets; twenty come.
    for _ in 0..rounds {
        card.bridge().transport().run(80_000);
        drain(&mut card, &mut decoder, 28);
    }
    card.write(&at("stream_control"), 0).unwrap();
    (0..30).for_each(|_| drain(&mut card, &mut decoder, 28));
    let sets = decoder.take();
    let counts = decoder.counts();
    let is_enough = sets.len() > least_sets && counts.missing > least_missing;
    assert!(is_enough, "{} sets, {counts:?}", sets.len());
    assert_eq!((counts.damaged, counts.lost_in_card), (0, counts.missing));
    let state = card.read(&at("stream_state")).unwrap();
    // The sets after the last one that fitted are lost, too, and nobody has told of them yet.
    let untold = u64::from(state >> 16) - counts.missing;
    assert!(untold < 30 && state & 0xFFFF == 0, "{state:#x} {untold}");
    for set in &sets {
        assert!(
            set.channels.iter().all(|c| c.fresh && c.cause == 0),
            "{set:?}"
        );
    }
}
