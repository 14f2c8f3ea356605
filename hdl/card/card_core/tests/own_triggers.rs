//! Channels with separate triggers.

use super::*;
use crate::config::{OwnTrigger, TriggerSources};
use crate::regs::CHANNEL_CONFIG;

/// A card with these channels, whose frames all fail at once, with all sources except the pin.
fn host(own: &[Option<OwnTrigger>]) -> Host {
    let mut config = test_config();
    config.channels = config
        .channels
        .into_iter()
        .cycle()
        .take(own.len())
        .collect();
    for (channel, own) in config.channels.iter_mut().zip(own) {
        channel.spec.trigger = *own;
    }
    Host::of(true, 0b110, config)
}

/// Cycles of the next `cycles` in which each channel is triggered, and all triggers.
fn triggers(host: &mut Host, cycles: usize) -> (Vec<Vec<u64>>, Vec<u64>) {
    let (mut own, mut all) = (vec![Vec::new(); host.falls.len()], Vec::new());
    for _ in 0..cycles {
        host.step(true);
        for (i, own) in own.iter_mut().enumerate() {
            if host.net(&format!("core.trigger_of_{i}")) == 1 {
                own.push(host.cycle);
            }
        }
        if host.net("core.trigger_trigger") == 1 {
            all.push(host.cycle);
        }
    }
    (own, all)
}

fn every(all: &[u64], n: usize) -> Vec<u64> {
    all.iter().copied().step_by(n).collect()
}

#[test]
fn each_channel_takes_the_triggers_that_are_its_own() {
    let own = OwnTrigger::default();
    let register = TriggerSources {
        register: true,
        ..TriggerSources::default()
    };
    let mut host = host(&[
        None,
        Some(OwnTrigger { divider: 3, ..own }),
        Some(OwnTrigger {
            sources: register,
            ..own
        }),
        Some(OwnTrigger {
            enabled: false,
            ..own
        }),
    ]);
    let (taken, all) = triggers(&mut host, 8_000);
    assert!(all.len() > 9);
    assert_eq!(taken[0], all);
    // Three of the timer are one of the divided channel: from the first after reset on.
    let phase = all
        .iter()
        .position(|at| Some(at) == taken[1].first())
        .unwrap();
    assert_eq!(taken[1], every(&all[phase..], 3));
    assert!(phase < 3);
    assert!(taken[2].is_empty() && taken[3].is_empty());
    host.write(address(CARD_CONFIG, "trigger_sources", 0), &[4 | 8 << 8]);
    let before = host.sequence(2);
    host.write(address(CARD, "trigger_now", 0), &[1]);
    host.idle(50);
    let sequence = [0, 1, 2, 3].map(|i| host.sequence(i));
    assert_eq!(sequence[2], before + 1);
    assert_eq!(sequence[3], 0);
    // The line of the disabled channel is bad, too, but the card does not report it.
    assert_eq!(host.net("core.faulty_3"), 1);
    assert!(sequence[0] > sequence[1] && sequence[1] > sequence[2]);
}

#[test]
fn channels_with_equal_settings_trigger_together_whenever_they_were_written() {
    let own = Some(OwnTrigger::default());
    let mut host = host(&[own, own]);
    let frame = |i| address(CHANNEL_CONFIG, "frame", i);
    let word = |host: &mut Host, i| host.read(frame(i), 1)[0] & !0xf800;
    // One of four, written while the other still accepts all, and in the middle of its frame.
    let words = [word(&mut host, 0), word(&mut host, 1)];
    host.write(frame(0), &[words[0] | 3 << 11]);
    host.idle(1_900);
    host.set_data(1, false);
    host.idle(900);
    host.write(frame(1), &[words[1] | 3 << 11]);
    assert!(host.is_busy(1));
    let (taken, all) = triggers(&mut host, 12_000);
    assert!(taken[0].len() > 2);
    assert_eq!(taken[0], taken[1], "in the same cycles");
    let phase = all.iter().position(|at| *at == taken[0][0]).unwrap();
    assert_eq!(taken[0], every(&all[phase..], 4));
    // Reading, and writing other words, does not restart the count.
    let hold = address(CARD_CONFIG, "hold", 0);
    let between = (0..8).map(|_| {
        host.write(hold, &[1]);
        host.write(hold, &[0]);
        host.read(frame(0), 1);
        triggers(&mut host, 300).0[0].len()
    });
    let seen: usize = between.sum();
    assert!(seen <= 2, "{seen} of 2 400 cycles, one in 2 800");
}

#[test]
fn a_disabled_channel_is_not_waited_for_and_says_nothing() {
    let own = Some(OwnTrigger::default());
    let mut host = host(&[own, own]);
    host.set_data(1, false);
    let sources = address(CARD_CONFIG, "trigger_sources", 0);
    // Channel 1 has a long frame under way, and is disabled in the middle of it.
    host.idle(1_500);
    assert!(host.is_busy(1));
    host.write(sources, &[2 | 2 << 8]);
    assert_eq!(host.read(sources, 1), [2 | 2 << 8]);
    let first = status(host.read(RESULT.base, 1)[0]).0;
    host.idle(1_400);
    let words = host.read(RESULT.base, 9);
    assert!(
        status(words[0]).0 > first,
        "the read did not wait for its frame"
    );
    let frames = host.falls[1].len();
    host.idle(10_000);
    let after = host.falls[1].len();
    let (taken, _) = triggers(&mut host, 3_000);
    assert!(taken[1].is_empty() && !taken[0].is_empty());
    assert!(
        after >= frames && host.falls[1].len() == after,
        "no frame follows"
    );
    assert_ne!(host.net("core.port_1_cause"), 0, "its last frame was bad");
    assert_eq!(host.net("core.faulty_1"), host.net("core.faulty_2"));
    assert_eq!(host.net("led_channel1_o"), 0);
}
