//! A reset in the middle of an exchange: the next request waits until the encoder has certainly finished, and no wrong position is shown.

use super::rig::Rig;
use endat_sim::rng::Rng;
use endat_sim::t_format::{EncoderConfig, Violation};
use endat_sim::US;

/// Configured longest pause before a reply.
const REPLY_GAP_US: u64 = 20;
/// The line is at rest after power-up.
const READY_US: u64 = 75;
/// Position of the encoder.
const SINGLE_TURN: u32 = 0x65_4321;
const MULTI_TURN: u32 = 0xFE_DCBA;
/// Request 3, with its pause and its reply.
const EXCHANGE_US: u64 = 48 + REPLY_GAP_US;

fn requests_wait_after_a_reset(moments: u64) {
    let mut rng = Rng::new(47);
    let (mut refused, mut collisions, mut wrong) = (0, vec![], vec![]);
    for moment in 0..moments {
        let gap_us = rng.in_range(1, REPLY_GAP_US - 1);
        let config = EncoderConfig {
            reply_gap: gap_us * US,
            status: 0,
            single_turn: SINGLE_TURN,
            multi_turn: MULTI_TURN,
            ..EncoderConfig::default()
        };
        let mut rig = Rig::new(20, config);
        rig.set_gap(REPLY_GAP_US);
        rig.wait_us(READY_US);
        rig.write(0, 3);
        let span = EXCHANGE_US * 20;
        let cycle = rng.in_range(moment * span / moments, (moment + 1) * span / moments);
        rig.steps(cycle);
        rig.pins.reset = true;
        rig.steps(3);
        rig.pins.reset = false;
        rig.set_gap(REPLY_GAP_US);
        // Requests repeatedly, like a controller that waits for its position.
        for _ in 0..16 {
            rig.wait_us(rng.in_range(0, 10));
            rig.write(0, 3);
            let map = rig.finish();
            refused += u64::from(map.cause == 2);
            let shown = (map.single_turn, map.multi_turn);
            if map.fresh && shown != (SINGLE_TURN, MULTI_TURN) {
                wrong.push((cycle, gap_us, shown));
            }
        }
        // A request cut by the reset is not a fault of the next one.
        let seen = rig.encoder.violations().iter().any(Violation::is_collision);
        if seen {
            collisions.push((cycle, gap_us));
        }
        rig.wait_us(READY_US);
        assert!(rig.exchange(3).fresh, "{moment}");
    }
    let count = collisions.len();
    assert_eq!(wrong, [], "of {moments}");
    assert!(count == 0, "{count} of {moments}: {collisions:?}");
    assert!(refused > 2 * moments, "{refused}");
}

#[test]
fn request_is_not_driven_into_a_reply_after_a_reset() {
    requests_wait_after_a_reset(100);
}

#[test]
#[ignore = "slow: a reset at 10 000 moments of an exchange"]
fn request_is_not_driven_into_a_reply_after_a_reset_at_any_moment() {
    requests_wait_after_a_reset(10_000);
}
