//! A complete card with a stream: full rate, interleaved answers, switching, overflow.

use super::line::{card, words_of, Item, Line};
use super::rig::{Set, FRESH, MISSING, TAKEN, VALID};
use endat_hdl::config::StreamStart::{Collect, Off, Push};
use endat_hdl::regs::{CARD, CARD_CONFIG, VERSION};

/// Cause of a result whose channel has missed a trigger.
const OVERRUN: u16 = endat_hdl::endat::transaction::cause::TRIGGER_OVERRUN as u16;

/// Sets of a run without loss: complete, consecutive from the first trigger on, at the timer period, with the encoders' positions.
/// The first frame measures the delay slowly, so at first a channel may be missing, or busy. Returns the number of sets after that.
fn check(line: &Line, sets: &[Set], period: u64) -> usize {
    // The first frame has measured.
    let mut frames = [1; 2];
    let mut good = 0;
    for (n, set) in sets.iter().enumerate() {
        assert_eq!((usize::from(set.sequence), set.lost), (n + 1, 0));
        let since = set.timestamp.wrapping_sub(sets[0].timestamp);
        assert_eq!(u64::from(since), n as u64 * period);
        for (channel, part) in set.parts.iter().enumerate() {
            let frame = line.bench.frames(channel).get(frames[channel]);
            frames[channel] += usize::from(part.status & TAKEN != 0);
            // The next good result reports triggers lost meanwhile.
            let overrun = if n < 6 { OVERRUN } else { 0 };
            if part.status & !overrun == TAKEN | VALID | FRESH {
                assert_eq!(part.position, frame.unwrap().position, "{n} {channel}");
            } else {
                assert!(n < 6 && [0, TAKEN | MISSING].contains(&part.status));
                assert_eq!(part.position, 0, "{n} {channel}");
            }
        }
        good += usize::from(set.parts.iter().all(|p| p.status & FRESH != 0));
    }
    good
}

fn split(items: Vec<Item>) -> (Vec<Set>, Vec<Vec<u32>>) {
    let (mut sets, mut answers) = (Vec::new(), Vec::new());
    for item in items {
        match item {
            Item::Set(set) => sets.push(set),
            Item::Answer(words) => answers.push(words),
        }
    }
    (sets, answers)
}

/// The word `version` of every card.
fn version() -> u32 {
    let [major, minor, patch] = VERSION.map(u32::from);
    major << 24 | minor << 16 | patch
}

/// Sample rates, baud rates, and numbers of sets.
fn sets_come(rates: &[(u64, u64, u64)]) {
    for &(sample_hz, baud, sets_wanted) in rates {
        let config = card(96_000_000, sample_hz, baud, Push);
        let mut line = Line::new(&config);
        let period = config.sample_period_cycles;
        let mut reads = 0;
        for n in 0..sets_wanted {
            // Anywhere within a period; the answers fit into the gaps.
            line.run(n * 37 % period);
            match n % 10 {
                3 if n % 20 == 3 => line.read(2, 0, 2),
                7 if n % 50 == 7 => line.read(2, 0x180, 14),
                9 => line.write(&CARD_CONFIG, "hold", (n as u32) << 8),
                _ => {}
            }
            reads += usize::from(n % 20 == 3 || n % 50 == 7);
            line.run(period - n * 37 % period);
        }
        line.run(6 * period);
        let (sets, answers) = split(line.marked());
        assert!(sets.len() as u64 >= sets_wanted, "{} sets", sets.len());
        assert_eq!(usize::from(sets[0].sequence), 1);
        assert!(check(&line, &sets, period) as u64 > sets_wanted - 6);
        assert_eq!(answers.len(), reads);
        for answer in answers.iter().filter(|a| a.len() == 2) {
            assert_eq!(answer[..], [0x456e_4474, version()]);
        }
        for answer in answers.iter().filter(|a| a.len() == 14) {
            assert_eq!(answer[3], answer[11], "both of one trigger");
        }
        // The falling edge comes a constant few cycles after the set's time.
        let results = answers.iter().filter(|a| a.len() == 14 && a[3] != 0);
        let behind = results.filter_map(|a| {
            let set = sets.iter().rfind(|s| s.timestamp <= a[3])?;
            Some(a[3] - set.timestamp)
        });
        let behind: Vec<u32> = behind.collect();
        assert!(behind.len() > 2 && behind.iter().all(|b| *b == behind[0]));
        assert!((1..10).contains(&behind[0]), "{behind:?}");
    }
}

/// 93 per cent of the line's rate.
#[test]
fn every_set_comes_at_full_rate_with_register_accesses_in_between() {
    sets_come(&[(10_000, 3_000_000, 160)]);
}

/// 93 per cent of 3 Mbit/s, 75 of 6.
#[test]
#[ignore = "slow: hundreds of sets at two rates"]
fn every_set_comes_at_every_full_rate_with_register_accesses_in_between() {
    sets_come(&[(10_000, 3_000_000, 250), (16_000, 6_000_000, 300)]);
}

fn too_much_is_asked(reads: usize) {
    let config = card(96_000_000, 10_000, 3_000_000, Push);
    let mut line = Line::new(&config);
    // Reads all results repeatedly, one command after the other's answer: frames get less than their share.
    for n in 1..=reads {
        line.read(2, 0x180, 62);
        let mut waited = 0;
        while line.answers_heard() < n {
            line.run(320);
            waited += 1;
            assert!(waited < 2_000, "no answer");
        }
    }
    line.run(200 * config.sample_period_cycles);
    let (sets, answers) = split(line.marked());
    assert_eq!(answers.len(), reads);
    let mut next = 1;
    for set in &sets {
        next += u16::from(set.lost);
        assert_eq!(set.sequence, next);
        next += 1;
    }
    assert!(sets.iter().any(|s| s.lost > 0));
    // After it stops reading, all sets arrive again.
    assert!(sets[sets.len() - 20..].iter().all(|s| s.lost == 0));
}

#[test]
fn a_host_that_asks_for_too_much_loses_whole_sets() {
    too_much_is_asked(30);
}

#[test]
#[ignore = "slow: twice as many reads"]
fn a_host_that_asks_for_too_much_loses_whole_sets_and_sees_it() {
    too_much_is_asked(60);
}

#[test]
fn switching_off_leaves_the_plain_link_and_marks_the_first_answer() {
    let config = card(96_000_000, 10_000, 3_000_000, Off);
    let mut line = Line::new(&config);
    // Without stream at first.
    line.read(2, 0, 1);
    line.settle(100);
    assert_eq!(line.heard, 0x456e_4474u32.to_be_bytes());
    line.heard.clear();
    line.asked.clear();
    for delay in (0..2_400).step_by(97) {
        line.control(3);
        line.run(4 * config.sample_period_cycles + delay);
        line.control(1);
        line.read(2, 0, 1);
        line.settle(600);
        let items = line.marked();
        assert!(line.heard.is_empty(), "half a frame");
        let (_, answers) = split(items.clone());
        assert_eq!(answers, [[0x456e_4474]]);
        assert!(matches!(items.last(), Some(Item::Answer(_))), "{delay}");
        assert!(items.len() >= 4);
        // From here on only UARTBone.
        line.read(2, 1, 1);
        line.settle(600);
        assert_eq!(line.heard, version().to_be_bytes());
        line.heard.clear();
        line.asked.clear();
        line.write(&CARD, "stream_clear", 1);
        line.settle(20);
    }
}

#[test]
fn a_client_that_polls_gets_the_same_stream() {
    let config = card(96_000_000, 2_000, 3_000_000, Collect);
    let mut line = Line::new(&config);
    let mut bytes = Vec::new();
    for words in [7, 1, 30, 2, 64, 3].into_iter().cycle().take(60) {
        line.heard.clear();
        line.read(4, 0x00e, words);
        line.settle(40);
        assert_eq!(line.heard.len(), 4 * words);
        bytes.extend(&line.heard);
    }
    line.asked.clear();
    while bytes.last() != Some(&0) {
        bytes.pop();
    }
    let sets = Set::all(&bytes);
    assert!(sets.len() > 30, "{}", sets.len());
    assert!(check(&line, &sets, config.sample_period_cycles) > 30);
    // A blocked client: the buffer fills, then sets are lost and counted.
    line.run(100 * config.sample_period_cycles);
    line.heard.clear();
    line.read(2, 0x00d, 1);
    line.settle(40);
    let [state] = words_of(&line.heard)[..] else {
        panic!("one word");
    };
    assert!(state & 0xffff > 2047 - 28 && state >> 16 > 20, "{state:x}");
}
