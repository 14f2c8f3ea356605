//! Additional data of one frame with its position: in the results, and in the sets of the stream.

use crate::desk::Desk;
use endat_card::VirtualConfig;
use endat_config::{parse, preset, Project};
use endat_driver::AdditionalData as Info;
use endat_host::stream::SampleSet;
use endat_sim::{encoder::Defect, US};
use std::time::Duration;

/// Position 2, low word, which is here the low word of the position; and the encoder's clock: other ones in each frame.
const INFOS: &str = "\ninfos = [0x42, 0x5B]";

/// System clock cycles per microsecond.
pub const US_CYCLES: u32 = 25;

/// The preset with service at a quarter of its clock, which takes a quarter of the time; no board has this clock.
pub fn text() -> String {
    let text = preset("s6_two_channel_service").unwrap();
    let mut text = text.split("\n[board]").next().unwrap().to_owned();
    for (from, to) in [
        ("system_hz = 100_000_000", "system_hz = 25_000_000"),
        ("baud = 3_000_000", "baud = 3_125_000"),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    text
}

/// The card of [`text`] with additional data, these keys replaced.
pub fn project(changes: &[(&str, &str)]) -> Project {
    let mut text = text();
    let parts = "parts = [\"requests\", \"diagnosis\", \"continuous\", \"initialise\"]";
    assert!(text.contains(parts));
    // An initialisation takes long, and additional data do not need it.
    let few = parts.replace(", \"initialise\"", "");
    text = text.replacen(parts, &format!("{few}{INFOS} #"), 1);
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    parse("card.toml", &text).unwrap()
}

/// A card at rest whose encoders are known, and send additional data 1 and 2 with each frame.
pub fn desk(project: &Project) -> Desk {
    let config = VirtualConfig {
        speed: 40.0,
        ..VirtualConfig::default()
    };
    let mut desk = Desk::new(project, &config);
    for _ in 0..200 {
        desk.run_ms(1);
        let results = desk.card.results().unwrap().channels;
        if results.iter().all(|r| r.infos.iter().all(|i| i.good)) {
            return desk;
        }
    }
    panic!("the additional data never come");
}

/// Additional data 1 and 2 of the encoder's frame with this position, one of its last 60; and how many of its frames were later.
fn sent(desk: &mut Desk, channel: usize, position: u64) -> ([u16; 2], usize) {
    let bench = desk.card.bridge().transport().bench();
    let frames = bench.frames(channel);
    let mut last = frames.iter().rev().take(60).enumerate();
    let (ago, frame) = last
        .find(|(_, f)| f.position == position)
        .unwrap_or_else(|| panic!("channel {channel}: no frame had {position:#x}"));
    let [second, first] = &frame.infos[..] else {
        panic!("{frame:?}");
    };
    assert_eq!([first.0.code, second.0.code], [0x42, 0x5B]);
    ([first.0.content, second.0.content], ago)
}

fn good(info: Info) -> u16 {
    assert!(info.came && info.good && !info.due, "{info:?}");
    info.content
}

/// Catches a snapshot that takes the position of one frame and the additional data of another one. Triggers come after each of these
/// periods in microseconds; so many results are read.
fn results_are_of_one_frame(periods_us: &[u32], results: usize) {
    for &period_us in periods_us {
        let mut desk = desk(&project(&[("start = \"off\"", "start = \"off\"")]));
        desk.set("card_config.trigger_sources.timer", 0);
        desk.set("card_config.trigger_period", period_us * US_CYCLES);
        desk.set("card_config.trigger_sources.timer", 1);
        desk.run_ms(1);
        let wait_cycles = 200 * u64::from(US_CYCLES);
        let mut state = 0x1234_5678_9abc_def1u64;
        let mut seen = std::collections::BTreeSet::new();
        for n in 0..results {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            desk.card.bridge().transport().run(state % wait_cycles);
            let hold = n % 4 == 0;
            if hold {
                desk.set("card_config.hold.hold", 1);
            }
            let results = desk.card.results().unwrap().channels;
            let stamps: Vec<u32> = results.iter().map(|r| r.timestamp).collect();
            // Where triggers are lost each channel takes its own.
            if period_us == IDLE_US {
                assert_eq!(stamps[0], stamps[1], "both of one trigger");
            }
            for (channel, result) in results.iter().enumerate() {
                assert!(result.fresh, "{result:?}");
                let (infos, ago) = sent(&mut desk, channel, result.position);
                assert_eq!(result.infos.map(good), infos, "{n} {channel} {result:?}");
                // An answer of the link takes seven triggers.
                assert!(ago < 40, "{ago}");
                seen.insert(result.position);
            }
            if hold {
                desk.card.bridge().transport().run(state % wait_cycles);
                let again = desk.card.results().unwrap().channels;
                for (before, now) in results.iter().zip(&again) {
                    assert_eq!((now.position, now.infos), (before.position, before.infos));
                }
                desk.set("card_config.hold.hold", 0);
            }
        }
        assert!(2 * seen.len() > 3 * results, "{}", seen.len());
    }
}

/// The line is idle between frames.
const IDLE_US: u32 = 100;
/// One frame follows the other, and triggers are lost.
const BUSY_US: u32 = 29;

#[test]
fn position_and_additional_data_of_a_result_are_of_one_frame() {
    results_are_of_one_frame(&[BUSY_US], 40);
}

#[test]
#[ignore = "slow: hundreds of results with additional data"]
fn position_and_additional_data_of_hundreds_of_results_are_of_one_frame() {
    results_are_of_one_frame(&[IDLE_US, BUSY_US], 200);
}

/// Catches a result that shows what an earlier frame brought, or the frame of a request after it.
#[test]
fn a_result_has_no_additional_data_of_another_frame() {
    let mut desk = desk(&project(&[]));
    // One trigger at a time.
    desk.set("card_config.trigger_sources", 4);
    desk.run_ms(1);
    let trigger = |desk: &mut Desk| {
        desk.set("card.trigger_now", 1);
        desk.run_ms(1);
        desk.card.results().unwrap().channels[0]
    };
    let before = trigger(&mut desk);
    assert!(before.infos.iter().all(|i| i.good));
    // A request of its own has a frame of its own, which brings none.
    desk.send(0, 0x0E, 0xA1, 0);
    assert_eq!(desk.card.results().unwrap().channels[0].infos, before.infos);
    let spoil = |desk: &mut Desk, defect| {
        let bench = desk.card.bridge().transport().bench();
        bench.link_mut(0).encoder_mut().spoil_next(defect);
    };
    // One with a wrong CRC, and the other one of the same frame.
    for info in [1, 2] {
        spoil(&mut desk, Defect::InfoCrcXor { info, xor: 0b10 });
        let result = trigger(&mut desk);
        assert!(result.fresh, "{result:?}");
        let (infos, _) = sent(&mut desk, 0, result.position);
        for (n, (shown, sent)) in result.infos.into_iter().zip(infos).enumerate() {
            match n + 1 == usize::from(info) {
                true => assert_eq!(
                    shown,
                    Info {
                        came: true,
                        ..Info::default()
                    }
                ),
                false => assert_eq!(good(shown), sent),
            }
        }
    }
    // No answer at all: position and additional data are not of that frame. (A lost delay is measured again, with a pause before that.)
    spoil(&mut desk, Defect::NoStartBit);
    let result = trigger(&mut desk);
    assert!(!result.fresh, "{result:?}");
    assert_eq!(result.infos, [Info::default(); 2]);
    desk.run_ms(40);
    // The frame that measures brings additional data, too: those of the position are of the frame behind it.
    let result = trigger(&mut desk);
    assert!(result.fresh, "{result:?}");
    let (infos, _) = sent(&mut desk, 0, result.position);
    assert_eq!(result.infos.map(good), infos);
    // An encoder that has forgotten them.
    let bench = desk.card.bridge().transport().bench();
    let now = bench.now();
    bench
        .link_mut(0)
        .encoder_mut()
        .unplug(now + US, now + 2 * US);
    desk.run_ms(3);
    let result = trigger(&mut desk);
    assert_eq!(result.infos.map(|i| i.came), [false; 2], "{result:?}");
    let result = trigger(&mut desk);
    assert_eq!(result.infos, [Info::default(); 2], "{result:?}");
}

/// Sets that have been pushed in so many milliseconds.
pub fn pushed(desk: &mut Desk, ms: u64) -> Vec<SampleSet> {
    let mut sets = Vec::new();
    for _ in 0..2 * ms {
        let half_ms = 500 * u64::from(US_CYCLES);
        desk.card.bridge().transport().run(half_ms);
        let new = desk.card.bridge().pushed(Duration::from_micros(1)).unwrap();
        sets.extend(new);
    }
    sets
}

/// The stream begins, and pushes.
pub fn push(desk: &mut Desk) {
    desk.set("card.stream_clear", 1);
    desk.set("card.stream_control", 3);
    desk.card.bridge().set_pushes(true);
}

fn streaming() -> Project {
    project(&[
        ("sample_hz = 10_000", "sample_hz = 5_000"),
        ("start = \"off\"", "additional_data = true\nstart = \"off\""),
    ])
}

/// Catches a set that is closed before its additional data are there, and one that mixes two frames; in so many times 2 ms.
fn sets_have_additional_data_of_their_frame(times: usize) {
    let mut desk = desk(&streaming());
    assert!(desk.card.identity().stream_additional_data);
    push(&mut desk);
    let mut count = 0;
    let mut last = None;
    for _ in 0..times {
        for set in pushed(&mut desk, 2) {
            assert_eq!((set.run, set.lost, set.channels.len()), (None, 0, 2));
            assert!(last.is_none_or(|last: u16| set.sequence == last.wrapping_add(1)));
            last = Some(set.sequence);
            for (channel, sample) in set.channels.iter().enumerate() {
                assert!(sample.fresh && sample.taken && !sample.missing);
                let (infos, _) = sent(&mut desk, channel, sample.position);
                assert_eq!(sample.infos.unwrap().map(good), infos);
            }
            count += 1;
        }
    }
    assert!(2 * count > 15 * times, "{count} sets");
    assert_eq!(desk.card.bridge().decoder().damaged(), 0);
}

#[test]
fn sets_have_additional_data_1_and_2_of_their_frame() {
    sets_have_additional_data_of_their_frame(6);
}

#[test]
#[ignore = "slow: more sets with additional data"]
fn many_sets_have_additional_data_1_and_2_of_their_frame() {
    sets_have_additional_data_of_their_frame(20);
}

#[test]
fn sets_tell_additional_data_that_are_missing_or_wrong() {
    let mut desk = desk(&streaming());
    push(&mut desk);
    pushed(&mut desk, 2);
    for info in [1u8, 2] {
        let bench = desk.card.bridge().transport().bench();
        let encoder = bench.link_mut(1).encoder_mut();
        encoder.spoil_next(Defect::InfoCrcXor { info, xor: 0b10 });
        let sets = pushed(&mut desk, 3);
        let wrong = |s: &&SampleSet| !s.channels[1].infos.unwrap()[usize::from(info) - 1].good;
        let all: Vec<&SampleSet> = sets.iter().filter(wrong).collect();
        assert_eq!(all.len(), 1, "{sets:?}");
        let infos = all[0].channels[1].infos.unwrap();
        let spoilt = Info {
            came: true,
            ..Info::default()
        };
        assert_eq!(infos[usize::from(info) - 1], spoilt);
        let (sent, _) = sent(&mut desk, 1, all[0].channels[1].position);
        let other = usize::from(2 - info);
        assert_eq!(good(infos[other]), sent[other]);
        assert!(all[0].channels[0].infos.unwrap().iter().all(|i| i.good));
    }
    // The encoder forgets what it was asked to send.
    let bench = desk.card.bridge().transport().bench();
    let now = bench.now();
    bench.link_mut(1).encoder_mut().unplug(now, now + 2 * US);
    let sets = pushed(&mut desk, 60);
    let without = |s: &&SampleSet| s.channels[1].infos.unwrap().iter().all(|i| !i.came);
    let all: Vec<&SampleSet> = sets.iter().filter(without).collect();
    assert!(all.len() > 10, "{}", all.len());
    for set in &all {
        let (sample, infos) = (&set.channels[1], set.channels[1].infos.unwrap());
        assert_eq!(infos, [Info::default(); 2], "{sample:?}");
        // Late, not there, or without additional data in good order once that is known.
        let frames = desk.card.bridge().transport().bench().frames(1);
        let brought = frames
            .iter()
            .rev()
            .take(400)
            .find(|f| f.position == sample.position);
        assert!(!sample.fresh || brought.unwrap().infos.is_empty());
    }
    // Frames that were given up are among them.
    assert!(all.iter().any(|s| !s.channels[1].fresh));
    let whole = sets
        .iter()
        .filter(|s| s.channels[0].infos.unwrap().iter().all(|i| i.good));
    assert!(whole.count() > sets.len() - 2);
}
