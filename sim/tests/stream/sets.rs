//! Content of a set.

use super::rig::*;
use endat_hdl::endat::transaction::cause;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

/// Positions and statuses with zeros, without, and mixed.
fn patterns(channels: usize) -> Vec<Vec<Channel>> {
    let of = |position: u64, status: u16| Channel {
        position,
        status,
        ..Channel::default()
    };
    let fixed = [
        of(0, 0),
        of(0xffff_ffff_ffff, 0x7fdf),
        of(0x0101_0101_0101, 0x0101),
        of(0x00ff_00ff_00ff, 0x7f00),
        of(0xff00_ff00_ff00, 0x00df),
        of(0x8000_0000_0001, VALID | FRESH),
    ];
    let mut all: Vec<Vec<Channel>> = fixed.iter().map(|c| vec![*c; channels]).collect();
    all.push(fixed.iter().cycle().take(channels).copied().collect());
    all
}

#[test]
fn a_frame_is_what_cobs_and_crc_make_of_the_set() {
    for channels in 1..=8 {
        let mut rig = Rig::new(1024, channels, true, false);
        for push in [false, true] {
            rig.reset();
            rig.write(word::CONTROL, 1 + 2 * u32::from(push));
            let mut expected = Vec::new();
            for (n, pattern) in patterns(channels).iter().enumerate() {
                // Zeros in the head, too: sequence and time stamp.
                rig.triggers = [0, 0xff, 0x100, 0xffff, 0x1_0000, 0x7fff, 0x00fe][n];
                rig.timestamp = [0, 0xffff_fff0, 0x0100_0000, 0x00ff_00ff, 1, 2, 3][n];
                expected.extend(rig.set_of(pattern).frame());
                rig.written();
            }
            let got = if push {
                rig.push_all(7);
                std::mem::take(&mut rig.pushed)
            } else {
                rig.drain()
            };
            assert_eq!(&got[..expected.len()], expected, "{channels} {push}");
            assert!(got[expected.len()..].iter().all(|b| *b == 0));
        }
    }
}

/// Record of a trigger.
struct Truth {
    timestamp: u32,
    parts: Vec<Part>,
    /// First result received, and its time.
    closed: bool,
}

/// One cycle in the random life of a channel.
#[derive(Default, Clone, Copy)]
struct Life {
    result_in: Option<u32>,
    free_in: u32,
    extra_in: Option<u32>,
}

/// Random triggers, results and readers: every received set must match its trigger, and every trigger is received or
/// reported as lost.
fn random_life(channels: usize, seed: u64, gap: u32, push: bool, continuous: bool) {
    let mut state = seed | 1;
    let mut random = move |below: u32| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 33) as u32 % below.max(1)
    };
    let mut rig = Rig::new(1024, channels, true, push);
    let mut truth: Vec<Truth> = Vec::new();
    let mut life = vec![Life::default(); channels];
    let mut bytes = Vec::new();
    let mut lane = 0;
    let mut next_trigger = 1;
    let length = 40_000;
    for cycle in 0..length + 4_000 {
        let is_over = cycle >= length;
        next_trigger -= 1;
        if next_trigger == 0 {
            next_trigger = match random(20) {
                0 => 1,
                1 => 1 + random(60),
                _ => gap / 2 + random(gap),
            };
            rig.trigger = !is_over;
        }
        for (n, (life, channel)) in life.iter_mut().zip(&mut rig.channel).enumerate() {
            // An additional result of a channel with a continuous clock.
            let mut result = false;
            for due in [&mut life.result_in, &mut life.extra_in] {
                *due = match *due {
                    Some(0) => {
                        result = true;
                        None
                    }
                    due => due.map(|d| d - 1),
                };
            }
            if result {
                channel.strobe = true;
                channel.position = (u64::from(random(1 << 31)) << 17) & 0xffff_ffff_ffff;
                channel.status = random(1 << 15) as u16 & !TAKEN;
                let part = Part {
                    position: channel.position,
                    status: channel.status | TAKEN,
                };
                // The first result after the trigger, until the next trigger closes the set.
                if let Some(last) = truth.last_mut().filter(|t| !t.closed) {
                    if last.parts[n].status == TAKEN | MISSING {
                        last.parts[n] = part;
                    }
                }
            }
            if life.free_in > 0 {
                life.free_in -= 1;
            }
            channel.busy = life.free_in > 0;
        }
        if rig.trigger {
            let mut parts = Vec::new();
            for (life, channel) in life.iter_mut().zip(&rig.channel) {
                parts.push(Part::default());
                if !channel.busy {
                    let is_late = random(8) == 0;
                    let result = 1 + random(if is_late { 3 * gap } else { gap / 2 });
                    life.result_in = Some(result);
                    life.free_in = result + 1 + random(gap / 4);
                    if continuous && random(12) == 0 {
                        life.extra_in = Some(result + 1 + random(300));
                    }
                    parts.last_mut().unwrap().status = TAKEN | MISSING;
                }
            }
            truth.push(Truth {
                timestamp: rig.timestamp,
                parts,
                closed: false,
            });
        }
        if push {
            rig.line_free = is_over || random(20) == 0;
        } else if cycle % 6 == 0 && (is_over || random(8) < 6) {
            let word = word::DATA;
            rig.access = Some(Access::Read { word, lane });
            lane = (lane + 1) % 4;
        }
        let reads = rig.access.is_some();
        rig.step();
        if reads {
            bytes.push(rig.stream.get("read_byte") as u8);
        }
    }
    let sets = Set::all(if push { &rig.pushed } else { &bytes });
    let mut last = 0;
    for set in &sets {
        let number = usize::from(set.sequence);
        assert!(number > last, "{number} after {last}");
        assert_eq!(usize::from(set.lost), number - last - 1, "before {number}");
        let truth = &truth[number - 1];
        assert_eq!(set.timestamp, truth.timestamp, "{number}");
        assert_eq!(set.parts, truth.parts, "{number}");
        last = number;
    }
    let lost = truth.len() - sets.len();
    assert!(sets.len() > 3, "{} sets", sets.len());
    // The last set may still be open, or lost without a later one to report it; the count includes all except the open one.
    let counted = (rig.read(word::STATE) >> 16) as usize;
    assert!(
        counted == lost || counted + 1 == lost,
        "{counted} of {lost}"
    );
}

fn sets_are_the_truth(count: u32) {
    let config = Config {
        cases: count,
        ..Config::default()
    };
    let cases = (
        1usize..=8,
        any::<u64>(),
        200u32..3_000,
        any::<bool>(),
        any::<bool>(),
    );
    let mut runner = TestRunner::new_with_rng(
        config,
        proptest::test_runner::TestRng::deterministic_rng(
            proptest::test_runner::RngAlgorithm::ChaCha,
        ),
    );
    runner
        .run(&cases, |(channels, seed, gap, push, continuous)| {
            random_life(channels, seed, gap, push, continuous);
            Ok(())
        })
        .unwrap();
}

#[test]
fn a_set_is_the_truth_about_its_trigger() {
    sets_are_the_truth(4);
}

#[test]
#[ignore = "slow: twelve random runs"]
fn every_set_is_the_truth_about_its_trigger_and_every_trigger_is_reported() {
    sets_are_the_truth(12);
}

fn two() -> Rig {
    Rig::new(1024, 2, true, false)
}

fn result(rig: &mut Rig, channel: usize, position: u64) {
    rig.channel[channel].position = position;
    rig.channel[channel].status = VALID | FRESH;
    rig.channel[channel].strobe = true;
}

#[test]
fn the_next_trigger_closes_a_set_and_marks_who_is_missing() {
    for with_the_trigger in [false, true] {
        let mut rig = two();
        rig.trigger = true;
        rig.step();
        rig.channel.iter_mut().for_each(|c| c.busy = true);
        rig.run(50);
        result(&mut rig, 0, 0x11);
        rig.run(50);
        rig.channel[0].busy = false;
        rig.trigger = true;
        if with_the_trigger {
            result(&mut rig, 1, 0x22);
        }
        rig.step();
        rig.channel[0].busy = true;
        // Too late for the first set, and not part of the second.
        result(&mut rig, 1, 0x33);
        rig.run(100);
        result(&mut rig, 0, 0x44);
        rig.step();
        rig.written();
        rig.written();
        let sets = Set::all(&rig.drain());
        let good = |position| Part {
            position,
            status: TAKEN | VALID | FRESH,
        };
        let missing = Part {
            position: 0,
            status: TAKEN | MISSING,
        };
        let second = if with_the_trigger {
            good(0x22)
        } else {
            missing
        };
        assert_eq!(sets[0].parts, [good(0x11), second]);
        assert_eq!(sets[1].parts, [good(0x44), Part::default()]);
        assert_eq!((sets.len(), sets[1].lost), (2, 0));
    }
}

/// A trigger, accepted or not, and some cycles.
fn trigger(rig: &mut Rig, busy: bool, cycles: u64) {
    rig.channel[0].busy = busy;
    rig.trigger = true;
    rig.step();
    rig.channel[0].busy = true;
    rig.run(cycles - 1);
}

/// Trigger A is missing in its set, and its result waits for a place. B's set is lost, and B's result is not taken for that of A.
#[test]
fn a_late_result_is_never_that_of_a_trigger_whose_set_is_lost() {
    let mut rig = Rig::with_late_results(1024, 1);
    trigger(&mut rig, false, 600); // A
    trigger(&mut rig, true, 600);
    result(&mut rig, 0, 0xA);
    rig.run(50);
    trigger(&mut rig, false, 1); // B, whose set the next trigger drops
    trigger(&mut rig, true, 2);
    result(&mut rig, 0, 0xB);
    rig.run(600);
    trigger(&mut rig, true, 600);
    // A late one with a place in the next set.
    trigger(&mut rig, false, 600); // D
    trigger(&mut rig, true, 600);
    result(&mut rig, 0, 0xD);
    rig.run(50);
    trigger(&mut rig, true, 600);
    let sets = Set::all(&rig.drain());
    let missing = Part {
        position: 0,
        status: TAKEN | MISSING,
    };
    let none = Part::default();
    let late = Part {
        position: 0xD,
        status: VALID | FRESH,
    };
    let parts: Vec<Part> = sets.iter().map(|s| s.parts[0]).collect();
    assert_eq!(parts, [missing, none, none, none, missing, none, late]);
    let lost: Vec<u8> = sets.iter().map(|s| s.lost).collect();
    assert_eq!(lost, [0, 0, 1, 0, 0, 0, 0]);
}

/// Catches a set with a position reported as good that an upset has changed while the set waited for the buffer.
#[test]
fn a_position_that_is_not_of_its_parity_is_told_as_upset() {
    let mut rig = two();
    let good = Channel {
        position: 0x8000_0000_0701,
        status: VALID | FRESH,
        ..Channel::default()
    };
    let upset = Channel {
        is_upset: true,
        ..good
    };
    let sent = rig.set_of(&[good, upset]);
    rig.written();
    let sets = Set::all(&rig.drain());
    assert_eq!(sets[0].parts[0], sent.parts[0]);
    let told = sets[0].parts[1].status;
    assert_eq!(told, TAKEN | cause::UPSET as u16);
}

#[test]
fn a_trigger_that_no_channel_takes_makes_an_empty_set() {
    let mut rig = two();
    rig.channel.iter_mut().for_each(|c| c.busy = true);
    rig.trigger = true;
    rig.step();
    rig.written();
    let sets = Set::all(&rig.drain());
    assert_eq!(sets.len(), 1);
    assert_eq!(sets[0].parts, [Part::default(); 2]);
    assert_eq!(sets[0].sequence, 1);
}

#[test]
fn a_result_that_replaces_that_of_the_trigger_loses_the_set() {
    let mut rig = two();
    rig.trigger = true;
    rig.step();
    rig.channel.iter_mut().for_each(|c| c.busy = true);
    rig.run(9);
    result(&mut rig, 0, 1);
    rig.run(9);
    result(&mut rig, 0, 2);
    rig.run(9);
    result(&mut rig, 1, 3);
    rig.written();
    assert_eq!(rig.read(word::STATE), 1 << 16);
    // Also in the cycle in which the set would be taken.
    rig.channel.iter_mut().for_each(|c| c.busy = false);
    rig.trigger = true;
    rig.step();
    rig.run(9);
    result(&mut rig, 0, 1);
    rig.run(9);
    result(&mut rig, 0, 2);
    result(&mut rig, 1, 3);
    rig.written();
    assert_eq!(rig.read(word::STATE), 2 << 16);
    let channels = [Channel::default(); 2];
    let next = rig.set_of(&channels);
    rig.written();
    assert_eq!(Set::all(&rig.drain()), [Set { lost: 2, ..next }]);
}
