//! The buffer: overflow, clear, on and off, all kinds of readers.

use super::rig::*;
use endat_hdl::card::stream::buffer::{frame_bytes, BUFFER_BYTES};

fn channels(n: usize, position: u64) -> Vec<Channel> {
    let one = Channel {
        position,
        status: VALID | FRESH,
        ..Channel::default()
    };
    vec![one; n]
}

/// A set that is written before the test continues.
fn whole(rig: &mut Rig, position: u64) -> Set {
    let set = rig.set_of(&channels(rig.set.len(), position));
    rig.written();
    set
}

fn read_bytes(rig: &mut Rig, lane: &mut u8, count: usize) -> Vec<u8> {
    let read = |_| {
        let word = word::DATA;
        rig.access = Some(Access::Read { word, lane: *lane });
        *lane = (*lane + 1) % 4;
        rig.step();
        let byte = rig.stream.get("read_byte") as u8;
        rig.run(4);
        byte
    };
    (0..count).map(read).collect()
}

/// Fills the buffer with sets of these channels. The reader stops at places of a frame that `is_wanted` selects by place and
/// frame length.
fn fill(all_channels: &[usize], is_wanted: impl Fn(usize, usize) -> bool) {
    for &n in all_channels {
        let frame = frame_bytes(n, false) as usize;
        let mut rig = Rig::new(1024, n, true, false);
        for taken in (0..=frame).filter(|place| is_wanted(*place, frame)) {
            rig.reset();
            let (mut expected, mut got, mut lane) = (Vec::new(), Vec::new(), 0);
            for i in 0..3 {
                expected.push(whole(&mut rig, i));
            }
            got.extend(read_bytes(&mut rig, &mut lane, taken));
            let mut used = 3 * frame - taken;
            let mut lost = 0;
            for i in 0..1024 / frame as u64 + 3 {
                let set = whole(&mut rig, 0x0100_0001 * i);
                if used + frame < 1024 {
                    expected.push(set);
                    used += frame;
                } else {
                    lost += 1;
                }
                assert_eq!(
                    rig.read(word::STATE),
                    (lost << 16) + used as u32,
                    "{n} {taken}"
                );
            }
            assert!(lost >= 1);
            got.extend(rig.drain());
            expected.push(Set {
                lost: lost as u8,
                ..whole(&mut rig, 5)
            });
            got.extend(rig.drain());
            assert_eq!(Set::all(&got), expected, "{n} {taken}");
        }
    }
}

#[test]
fn a_set_that_does_not_fit_is_dropped_whole() {
    fill(&[1, 2, 8], |place, frame| {
        [0, 1, frame / 2 + 1, frame].contains(&place)
    });
}

/// The reader stops at every place of a frame, so a set meets every fill level of the buffer.
#[test]
#[ignore = "slow: every place in a frame"]
fn what_does_not_fit_is_dropped_whole_at_every_fill_level() {
    fill(&[1, 2, 8], |_, _| true);
}

fn carry_many_times_their_bytes(sizes: impl Iterator<Item = u64>) {
    for bytes in sizes {
        let mut rig = Rig::new(bytes, 2, true, true);
        let mut expected = Vec::new();
        // First completely full, then with wrapping addresses.
        for i in 0..bytes / 28 + 20 {
            let set = rig.set_of(&channels(2, i));
            rig.written();
            if i < (bytes - 1) / 28 {
                expected.extend(set.frame());
            }
        }
        rig.push_all(3);
        for i in 0..bytes / 10 {
            let mut set = rig.set_of(&channels(2, 0xff00_ff00_ff00 | i));
            set.lost = if i == 0 {
                (bytes / 28 + 20 - (bytes - 1) / 28) as u8
            } else {
                0
            };
            rig.written();
            expected.extend(set.frame());
            rig.push_all(3);
        }
        assert_eq!(rig.pushed, expected, "{bytes}");
    }
}

#[test]
fn the_smallest_buffers_carry_many_times_their_bytes() {
    carry_many_times_their_bytes(BUFFER_BYTES.into_iter().take(2));
}

#[test]
#[ignore = "slow: every size"]
fn every_size_carries_many_times_its_bytes() {
    carry_many_times_their_bytes(BUFFER_BYTES.into_iter());
}

#[test]
fn a_stuck_reader_loses_sets_and_nothing_else() {
    let mut rig = Rig::new(1024, 1, true, true);
    let mut expected: Vec<Set> = (0..51).map(|i| whole(&mut rig, i)).collect();
    for i in 0..300 {
        whole(&mut rig, i);
    }
    assert_eq!(rig.read(word::STATE), (300 << 16) + 51 * 20);
    rig.push_all(2);
    expected.push(Set {
        lost: 255,
        ..whole(&mut rig, 7)
    });
    expected.push(whole(&mut rig, 8));
    rig.push_all(2);
    assert_eq!(Set::all(&rig.pushed), expected);
    rig.write(word::CLEAR, 1);
    rig.run(4);
    assert_eq!(rig.read(word::STATE), 0);
}

#[test]
fn the_count_of_lost_sets_stops_at_its_end() {
    let mut rig = Rig::new(1024, 1, true, false);
    // A set in each pair of cycles, without a channel. Writing one takes 400 cycles.
    rig.channel[0].busy = true;
    for _ in 0..70_000 {
        rig.trigger = true;
        rig.run(2);
    }
    assert_eq!(rig.read(word::STATE) >> 16, 0xffff);
}

#[test]
fn an_empty_buffer_reads_as_zeros_and_another_word_takes_nothing() {
    let mut rig = Rig::new(2048, 2, true, false);
    assert_eq!(rig.read(word::DATA), 0);
    let set = whole(&mut rig, 0xabcd);
    for word in [word::CONTROL, word::STATE, word::CLEAR] {
        rig.read(word);
    }
    rig.write(word::DATA, 0xffff_ffff);
    rig.access = Some(Access::Elsewhere);
    rig.step();
    assert_eq!(rig.stream.get("read_byte"), 0, "another word");
    rig.run(3);
    assert_eq!(rig.read(word::CONTROL), 1);
    assert_eq!(rig.read(word::STATE), 28);
    assert_eq!(rig.drain(), set.frame());
}

#[test]
fn the_state_is_of_one_moment() {
    let mut rig = Rig::new(1024, 2, true, true);
    for i in 0..10 {
        whole(&mut rig, i);
    }
    // 280 bytes = 0x118; the line takes 40 while its bytes are read.
    let mut bytes = [0; 4];
    for (lane, byte) in (0u8..).zip(&mut bytes) {
        let word = word::STATE;
        rig.access = Some(Access::Read { word, lane });
        rig.step();
        *byte = rig.stream.get("read_byte") as u8;
        for _ in 0..20 {
            rig.line_free = true;
            rig.run(2);
        }
    }
    assert_eq!(u32::from_be_bytes(bytes), 280);
    assert_eq!(rig.read(word::STATE), 200);
}

#[test]
fn collect_decides_at_the_trigger() {
    let mut rig = Rig::new(1024, 2, false, false);
    whole(&mut rig, 1);
    assert_eq!(rig.read(word::STATE), 0);
    rig.write(word::CONTROL, 1);
    let set = rig.set_of(&channels(2, 2));
    // Off while the set is being written, and while one is open.
    rig.write(word::CONTROL, 0);
    rig.written();
    rig.write(word::CONTROL, 1);
    rig.trigger = true;
    rig.step();
    rig.write(word::CONTROL, 0);
    rig.run(20);
    rig.channel.iter_mut().for_each(|c| c.strobe = true);
    rig.step();
    rig.written();
    whole(&mut rig, 4);
    let sets = Set::all(&rig.drain());
    assert_eq!(sets.len(), 2);
    assert_eq!(sets[0], set);
    assert_eq!((sets[1].sequence, sets[1].lost), (3, 0));
    assert_eq!(rig.read(word::CONTROL), 0);
}

/// Sends `count` bytes over the line.
fn push_some(rig: &mut Rig, count: usize) {
    let end = rig.pushed.len() + count;
    for _ in 0..count * 10 {
        rig.line_free = rig.pushed.len() < end;
        rig.step();
    }
}

#[test]
fn push_switched_off_or_cleared_in_mid_frame_ends_the_frame_first() {
    let mut rig = Rig::new(1024, 2, true, true);
    for taken in 0..=28 {
        for clear in [false, true] {
            rig.reset();
            let sets: Vec<Set> = (0..3).map(|i| whole(&mut rig, i << 20)).collect();
            push_some(&mut rig, taken);
            if clear {
                rig.write(word::CLEAR, 1);
            } else {
                rig.write(word::CONTROL, 1);
            }
            // The register gets no byte while the frame is being sent.
            if (1..28).contains(&taken) {
                assert_eq!(rig.read(word::DATA), 0, "{taken}");
            }
            rig.push_all(5);
            rig.run(300);
            let whole_frames = usize::from(taken > 0);
            assert_eq!(
                Set::all(&rig.pushed),
                sets[..whole_frames],
                "{taken} {clear}"
            );
            let left = if clear { 0 } else { 3 - whole_frames };
            assert_eq!(rig.read(word::STATE) as usize, 28 * left, "{taken} {clear}");
            // The next frame is complete again.
            let next = whole(&mut rig, 77);
            rig.write(word::CONTROL, 3);
            rig.push_all(5);
            let all = Set::all(&rig.pushed);
            assert_eq!(all.len(), whole_frames + left + 1);
            assert_eq!(all.last(), Some(&next));
        }
    }
}

#[test]
fn a_frame_that_the_host_has_read_half_of_is_not_pushed_and_a_clear_ends_it() {
    let mut rig = Rig::new(1024, 2, true, false);
    for taken in 0..=28 {
        for clear in [false, true] {
            rig.reset();
            let sets: Vec<Set> = (0..3).map(|i| whole(&mut rig, i << 20)).collect();
            let mut lane = 0;
            let half = read_bytes(&mut rig, &mut lane, taken);
            assert_eq!(half, sets[0].frame()[..taken]);
            let expected: &[Set] = match (clear, taken) {
                (true, _) => &[],
                (false, 0) => &sets,
                (false, _) => &sets[1..],
            };
            if clear {
                rig.write(word::CLEAR, 1);
                // No reads in between, for any time.
                assert!(read_bytes(&mut rig, &mut lane, 20).iter().all(|b| *b == 0));
                rig.run(200);
                assert_eq!(rig.read(word::STATE), 0);
            }
            rig.write(word::CONTROL, 3);
            rig.push_all(4);
            let next = whole(&mut rig, 5);
            rig.push_all(4);
            let all = Set::all(&rig.pushed);
            assert_eq!(&all[..all.len() - 1], expected, "{taken} {clear}");
            assert_eq!(all.last(), Some(&next));
        }
    }
}

fn clear_at(moments: impl Iterator<Item = u64>) {
    let mut rig = Rig::new(1024, 2, true, false);
    for moment in moments {
        rig.reset();
        whole(&mut rig, 1);
        let second = rig.set_of(&channels(2, 2));
        rig.run(moment);
        rig.write(word::CLEAR, 1);
        rig.written();
        let third = whole(&mut rig, 3);
        let sets = Set::all(&rig.drain());
        assert!(
            sets == [second.clone(), third.clone()] || sets == [third],
            "{moment}: {sets:?}"
        );
    }
}

#[test]
fn a_clear_within_a_set_leaves_whole_frames() {
    clear_at((0..500).step_by(7));
}

#[test]
#[ignore = "slow: every cycle of a set"]
fn a_clear_at_any_moment_of_a_set_leaves_whole_frames() {
    clear_at(0..500);
}
