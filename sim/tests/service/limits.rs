//! Host settings for the limits of a frame and for the continuous clock.

use super::rig::{hasty, quick, Make, Rig, SYSTEM_HZ};
use endat_hdl::endat::{
    service::map::{word, COUNTER_POSITION_2},
    timing::{recovery_min_cycles, RECOVERY_MIN_NS, SHORT_RECOVERY_MIN_NS},
    transaction::cause,
};
use endat_hdl::protocol::ModeCommand::*;
use endat_sim::{
    encoder::{Defect, EncoderConfig, LatchEdge},
    MS, US,
};

fn recovery_min(rig: &mut Rig) -> u64 {
    u64::from(rig.read(word::LIMITS) >> 16)
}

fn of_range(ns: u64) -> u64 {
    recovery_min_cycles(ns, SYSTEM_HZ)
}

fn count(rig: &mut Rig, cause: u64) -> u32 {
    rig.read(word::COUNTERS + cause as u8)
}

#[test]
fn the_shortest_recovery_time_is_that_of_the_range_in_use() {
    for wants_short in [false, true] {
        let make = Make {
            wants_short,
            ..Make::usual(false)
        };
        let wanted = match wants_short {
            true => SHORT_RECOVERY_MIN_NS,
            false => RECOVERY_MIN_NS,
        };
        let mut rig = Rig::with(make, 2_000_000, quick(EncoderConfig::endat22(25)), 25);
        assert_eq!(recovery_min(&mut rig), of_range(wanted));
        // An encoder with EnDat 2.1 only, or with only a slow clock, has the long range.
        for (encoder, ns) in [
            (EncoderConfig::endat22(25), wanted),
            (EncoderConfig::endat21(25), RECOVERY_MIN_NS),
        ] {
            let make = Make {
                wants_short,
                ..Make::hasty()
            };
            let mut rig = Rig::with(make, 2_000_000, hasty(encoder), 25);
            assert_eq!(rig.initialised(), 0);
            assert_eq!(recovery_min(&mut rig), of_range(ns), "{wants_short}");
            rig.good_position();
        }
    }
}

#[test]
fn a_hasty_encoder_is_counted_and_its_positions_are_good() {
    let mut encoder = quick(EncoderConfig::endat22(25));
    encoder.tm = 5 * US..=5 * US;
    let mut rig = Rig::new(false, encoder, 25);
    // The first trigger's frame measures the delay, and takes longer than the trigger period.
    rig.frames(3);
    let before = count(&mut rig, cause::RECOVERY_TOO_SHORT);
    rig.frames(5);
    assert_eq!(count(&mut rig, cause::RECOVERY_TOO_SHORT), before + 5);
    assert!(rig.bench.results().iter().all(|r| r.fresh));
    // A request still gets an answer.
    assert_eq!(rig.request(SelectMemory, 0xA1, 0).0, 0);
    rig.write(word::LIMITS, 0);
    // It applies from the first frame that begins after the program has read it.
    rig.bench.run_cycles(20_000);
    let before = count(&mut rig, cause::NONE);
    rig.frames(5);
    assert_eq!(count(&mut rig, cause::NONE), before + 5);
}

#[test]
fn the_watchdog_is_set_by_the_host() {
    let mut rig = Rig::new(false, quick(EncoderConfig::endat22(25)), 25);
    rig.good_position();
    let off = rig.read(word::LIMITS);
    rig.write(word::LIMITS, off | 20);
    // It applies from the first frame that begins after the program has read it.
    rig.bench.run_cycles(20_000);
    rig.frames(3);
    assert_eq!(count(&mut rig, cause::WATCHDOG), 3);
    rig.write(word::LIMITS, off);
    rig.bench.run_cycles(20_000);
    rig.good_position();
    rig.good_position();
}

#[test]
fn positions_flow_from_the_host_s_word_on() {
    let encoder = quick(EncoderConfig::endat22(25)).continuous(LatchEdge::AfterLow);
    let mut rig = Rig::new(false, encoder.defect(10, Defect::CrcXor(1)), 25);
    rig.bench.set("command", SendPosition.code().into());
    rig.frames(1);
    rig.write(word::CONTINUOUS, 1);
    rig.bench.run_for(MS);
    rig.bench.trigger();
    rig.bench.run_for(2 * MS);
    let results = rig.bench.results().len() as u32;
    assert!(results > 40, "{results}");
    // Each position is counted once, the corrupted one with its cause, and so is the frame that measured the delay.
    let counted: u32 = (0..COUNTER_POSITION_2)
        .map(|c| count(&mut rig, c.into()))
        .sum();
    let now = rig.bench.results().len() as u32;
    assert!(
        // The last one may not be counted yet.
        (results..=now + 1).contains(&counted),
        "{results} {counted} {now}"
    );
    assert_eq!(count(&mut rig, cause::CRC), 1);
    rig.write(word::CONTINUOUS, 0);
    rig.bench.run_for(MS);
    assert_eq!(rig.bench.get("busy"), 0);
    let counts = (0..COUNTER_POSITION_2).map(|c| count(&mut rig, c.into()));
    let counted: u32 = counts.sum();
    assert_eq!(counted, rig.bench.results().len() as u32 + 1);
    rig.assert_clean();
}
