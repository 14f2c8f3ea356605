//! Positions of running clocks in the stream, each in a set of its own.

use super::infos::{push, pushed, text, US_CYCLES};
use crate::desk::Desk;
use endat_card::VirtualConfig;
use endat_config::parse;
use endat_host::feed::Feed;
use endat_host::stream::SampleSet;
use endat_sim::US;
use std::collections::VecDeque;
use std::time::Duration;

/// A card at rest whose channels send 000111 at these periods; sets have additional data or not.
fn desk(periods: [u32; 2], additional_data: bool) -> Desk {
    // An initialisation takes long, and the clock does not need it.
    let mut text = text().replacen(", \"initialise\"]", "]", 1);
    if additional_data {
        text = text.replacen(
            "start = \"off\"",
            "additional_data = true\nstart = \"off\"",
            1,
        );
        text = text.replacen("sample_hz = 10_000", "sample_hz = 1_000", 1);
    }
    let project = parse("card.toml", &text).unwrap();
    let config = VirtualConfig {
        speed: 40.0,
        ..VirtualConfig::default()
    };
    let mut desk = Desk::new(&project, &config);
    desk.set("card_config.trigger_sources", 4);
    desk.run_ms(1);
    for (channel, period) in periods.into_iter().enumerate() {
        desk.set(&format!("config{channel}.frame.command"), 7);
        desk.set(&format!("config{channel}.frame.period_cycles"), period);
    }
    desk.set("card.trigger_now", 1);
    desk.run_ms(2);
    desk
}

/// Sets of a channel's running clock.
fn run_of(sets: &[SampleSet], channel: usize) -> Vec<&SampleSet> {
    sets.iter().filter(|s| s.run == Some(channel)).collect()
}

/// They are the encoder's positions in their order with the moments at which it took them; how many of them were left out, by their numbers.
fn check(desk: &mut Desk, channel: usize, run: &[&SampleSet]) -> u64 {
    let bench = desk.card.bridge().transport().bench();
    let frames: Vec<_> = bench.frames(channel).iter().collect();
    let first = run[0].channels[0].position;
    let begin = frames
        .iter()
        .position(|f| f.continuous && f.position == first);
    let frames = &frames[begin.expect("the first position is one of the encoder's")..];
    let mut left_out = 0;
    for set in run {
        let sample = set.channels[0];
        assert!(sample.taken && sample.fresh && !sample.missing, "{set:?}");
        let steps = usize::from(set.sequence.wrapping_sub(run[0].sequence));
        let frame = frames[steps];
        assert_eq!(sample.position, frame.position, "{steps}");
        let ps = frame.first_fall - frames[0].first_fall;
        let cycles = i64::from(set.timestamp.wrapping_sub(run[0].timestamp));
        let apart = cycles - (ps * u64::from(US_CYCLES) / US) as i64;
        assert!(apart.abs() <= 3, "{steps}: {apart} cycles");
    }
    for pair in run.windows(2) {
        left_out += u64::from(pair[1].sequence.wrapping_sub(pair[0].sequence)) - 1;
    }
    left_out
}

/// Catches a position that is left out, comes twice or with another's moment, and one in the set of a trigger.
fn each_position_has_a_set(additional_data: bool) {
    let mut desk = desk([50, 50], additional_data);
    desk.set("service0.continuous", 1);
    desk.run_ms(1);
    push(&mut desk);
    desk.set("card.trigger_now", 1);
    let sets = pushed(&mut desk, 10);
    let run = run_of(&sets, 0);
    assert!(run.len() > 100, "{} positions", run.len());
    assert_eq!(check(&mut desk, 0, &run), 0);
    assert!(sets.iter().all(|s| s.lost == 0));
    // The trigger's own set has the position before them, and the other channel's.
    let triggered: Vec<&SampleSet> = sets.iter().filter(|s| s.run.is_none()).collect();
    let [own] = triggered[..] else {
        panic!("{triggered:?}");
    };
    assert!(own.channels.iter().all(|c| c.fresh && c.taken), "{own:?}");
    assert_eq!(own.channels[0].infos.is_some(), additional_data);
    let bench = desk.card.bridge().transport().bench();
    let all: Vec<u64> = bench.frames(0).iter().map(|f| f.position).collect();
    let at = |position| all.iter().rposition(|p| *p == position).unwrap();
    assert_eq!(
        at(own.channels[0].position) + 1,
        at(run[0].channels[0].position)
    );
    assert_eq!(desk.card.bridge().decoder().damaged(), 0);
    // No more after its end.
    desk.set("service0.continuous", 0);
    pushed(&mut desk, 2);
    assert!(run_of(&pushed(&mut desk, 2), 0).is_empty());
}

#[test]
fn each_position_of_a_running_clock_has_a_set_of_its_own() {
    each_position_has_a_set(false);
}

#[test]
fn each_position_of_a_running_clock_has_a_set_with_additional_data() {
    each_position_has_a_set(true);
}

/// Catches a set that has one clock's position with another's moment or number, and a loss that is not reported; in so many
/// milliseconds with more than `least` sets of triggers.
fn two_running_clocks_share_the_stream(ms: u64, least: usize) {
    // Both together would fill it two times over.
    let mut desk = desk([25, 35], false);
    for channel in [0, 1] {
        desk.set(&format!("service{channel}.continuous"), 1);
    }
    desk.run_ms(1);
    push(&mut desk);
    desk.set("card.trigger_now", 1);
    desk.set("card_config.trigger_period", 500 * US_CYCLES);
    desk.set("card_config.trigger_sources.timer", 1);
    let sets = pushed(&mut desk, ms);
    let (mut left_out, mut received) = (0, 0);
    for channel in [0, 1] {
        let run = run_of(&sets, channel);
        assert!(run.len() > 100, "{channel}: {}", run.len());
        left_out += check(&mut desk, channel, &run);
        received += run.len();
    }
    assert!(left_out > 5 * ms / 2, "{left_out} of {received}");
    let lost: u64 = sets.iter().map(|s| u64::from(s.lost)).sum();
    let all = u64::from(desk.reg("card.stream_state.lost"));
    let triggered: Vec<&SampleSet> = sets.iter().filter(|s| s.run.is_none()).collect();
    assert!(triggered.len() > least, "{}", triggered.len());
    // Sets of triggers are lost, too.
    for pair in triggered.windows(2) {
        left_out += u64::from(pair[1].sequence.wrapping_sub(pair[0].sequence)) - 1;
    }
    // Behind the last set of each kind nobody knows whose they were.
    assert!(
        lost.abs_diff(left_out) < 10 && all >= lost,
        "{lost} {left_out} {all}"
    );
    // Whose clock runs takes no part.
    for set in &triggered[1..] {
        assert!(
            set.channels.iter().all(|c| !c.taken && c.position == 0),
            "{set:?}"
        );
    }
}

#[test]
fn two_running_clocks_and_triggers_share_the_stream() {
    two_running_clocks_share_the_stream(20, 25);
}

#[test]
#[ignore = "slow: two running clocks for longer"]
fn two_running_clocks_and_triggers_share_the_stream_for_long() {
    two_running_clocks_share_the_stream(40, 60);
}

#[test]
fn a_feed_has_a_row_for_each_position_of_a_running_clock() {
    let mut desk = desk([50, 50], false);
    desk.set("service1.continuous", 1);
    desk.run_ms(1);
    let mut feed = Feed::begin(&mut desk.card, false).unwrap();
    desk.set("card.trigger_now", 1);
    let mut rows = VecDeque::new();
    while rows.len() < 50 {
        let half_ms = 500 * u64::from(US_CYCLES);
        desk.card.bridge().transport().run(half_ms);
        feed.fill(&mut desk.card, &mut rows, Duration::from_micros(1))
            .unwrap();
    }
    feed.end(&mut desk.card).unwrap();
    assert_eq!(rows[0].run, None);
    for (before, row) in rows.iter().zip(rows.iter().skip(1)) {
        assert_eq!(
            (row.run, row.trigger, row.missing),
            (Some(1), rows[0].trigger, 0)
        );
        assert!(row.cells[1].fresh && row.cells[0].position.is_none());
        let cycles = row.cycles - before.cycles;
        assert!((750..5_000).contains(&cycles), "{cycles}");
    }
}
