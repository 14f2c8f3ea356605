//! Times when the held results follow the channels, and their content in between.

use super::*;

/// Words of both results, without the age.
fn results(host: &mut Host) -> Vec<u32> {
    host.read(RESULT.base, 14)
}

/// `stale` of a channel's result.
fn is_stale(words: &[u32], channel: usize) -> bool {
    words[8 * channel + 5] >> 30 & 1 == 1
}

#[test]
fn results_follow_when_two_channels_are_half_a_frame_apart() {
    // Triggers come faster than frames; no encoder answers, so every frame is long.
    let mut host = Host::new(false, 2);
    // Channel 1 gets out of step: its frames fail at once until channel 0 is in the middle of one.
    host.set_data(1, true);
    host.idle(3_000);
    host.set_data(1, false);
    host.idle(3_000);
    let (mut owing, mut last) = (0, [0; 2]);
    let at_first = [0, 1].map(|i| host.sequence(i));
    for _ in 0..5 {
        for _ in 0..7_000 {
            host.step(true);
            let owes = host.is_busy(0) || host.is_busy(1);
            owing += u32::from(owes);
        }
        let words = results(&mut host);
        for (channel, last) in last.iter_mut().enumerate() {
            let sequence = status(words[8 * channel]).0;
            assert!(sequence > *last, "channel {channel} is stuck at {sequence}");
            *last = sequence;
        }
    }
    let at_last = [0, 1].map(|i| host.sequence(i));
    assert!(at_last
        .iter()
        .zip(at_first)
        .all(|(now, then)| now - then > 3));
    assert!(
        owing > 30_000,
        "one channel was nearly always busy: {owing}"
    );
}

#[test]
fn results_follow_when_the_host_polls_in_step_with_the_timer() {
    // Channel 0 fails at once, channel 1 waits long: between their results the snapshot is incomplete.
    let mut host = Host::new(false, 4);
    host.set_data(0, true);
    let now = address(CARD, "trigger_now", 0);
    host.idle(100);
    host.write(now, &[1]);
    let (triggered, results_before) = (host.cycle, host.sequence(1));
    while host.sequence(1) == results_before {
        host.step(true);
    }
    let frame = host.cycle - triggered;
    host.idle(1_000);
    // Each read begins before channel 1's result and ends after the next trigger.
    let period = (frame + 2_500) as u32;
    host.write(address(CARD_CONFIG, "trigger_period", 0), &[period]);
    host.write(address(CARD_CONFIG, "trigger_sources", 0), &[2]);
    let count = host.net("core.trigger_trigger_count");
    while host.net("core.trigger_trigger_count") == count {
        host.step(true);
    }
    let first = host.cycle;
    let mut seen = Vec::new();
    for n in 0..5 {
        let start = first + n * u64::from(period) + frame - 1_000;
        host.idle((start - host.cycle) as usize);
        let words = results(&mut host);
        let ended = (host.cycle - first) % u64::from(period);
        assert!(ended < frame, "the read ends within a frame");
        seen.push(status(words[0]).0);
        if n > 1 {
            assert!(is_stale(&words, 1), "channel 1 owes a result");
        }
    }
    assert!(
        seen.windows(3).all(|w| w[2] > w[0]),
        "the second trigger at the latest: {seen:?}"
    );
}

#[test]
fn held_results_grow_old_and_tell_of_newer_triggers() {
    let mut host = Host::new(true, 4);
    let hold = address(CARD_CONFIG, "hold", 0);
    let now = address(CARD, "trigger_now", 0);
    host.write(now, &[1]);
    host.write(hold, &[1]);
    let before = results(&mut host);
    assert!(!is_stale(&before, 0) && !is_stale(&before, 1));
    let read_at = host.cycle;
    host.idle(3_000);
    let later = results(&mut host);
    let us = (host.cycle - read_at) / 100;
    for at in [5, 13] {
        let age = u64::from((later[at] & 0xffff) - (before[at] & 0xffff));
        assert!((us - 2..=us + 2).contains(&age), "{age} us of {us}");
    }
    host.write(now, &[1]);
    let newer = results(&mut host);
    assert_eq!(newer[0], before[0], "held");
    assert!(is_stale(&newer, 0) && is_stale(&newer, 1));
    host.write(hold, &[0]);
    let words = results(&mut host);
    assert_eq!(status(words[0]).0, status(before[0]).0 + 1);
    assert!(!is_stale(&words, 0) && !is_stale(&words, 1));
}
