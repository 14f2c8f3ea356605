//! The encoder receives exactly the clock pulses of its frame; otherwise a cause reports it.

use super::{
    doubt::{open_rig, register},
    rig::*,
};
use endat_hdl::endat::transaction::cause;
use endat_sim::{encoder::FrameLog, Time, MS, NS, US};

/// A count inverted in one place makes the frame longer or shorter, and the other counts detect it.
#[test]
fn a_count_of_pulses_that_is_upset_is_told() {
    let mut rig = open_rig();
    let ready = rig.engine().clone();
    for name in ["receiver.left", "receiver.to_send", "receiver.under_way"] {
        let (net, width) = register(&ready, name);
        let mut told = 0;
        for bit in 0..width {
            for after in (0..16).map(|n| n * US + 100 * NS * n) {
                let mut rig = Setup::card().on(ready.clone());
                rig.trigger();
                rig.run_for(after);
                rig.engine().flip(net, bit);
                assert!(rig.run_until_done(MS, |b| !b.results().is_empty()));
                settle(&mut rig);
                let is_whole = rig.frames(0).iter().all(FrameLog::is_whole);
                let cause = rig.get("cause");
                assert!(
                    cause != 0 || is_whole,
                    "{name} {bit}, {after} ps after the trigger: {:?}",
                    rig.frames(0)
                );
                told += usize::from(cause == u128::from(cause::UPSET));
            }
        }
        assert!(told > width, "{name}: {told}");
    }
}

/// A delay that is wrong by whole periods does not affect the answer: only the encoder notices the additional pulses.
#[test]
fn a_tracked_delay_that_is_upset_is_measured_again() {
    let mut rig = open_rig();
    let ready = rig.engine().clone();
    let (net, width) = register(&ready, "delay.delay");
    for bit in 0..width {
        let mut rig = Setup::card().on(ready.clone());
        rig.run_for(US);
        rig.engine().flip(net, bit);
        rig.run_cycles(4);
        good_frame(&mut rig);
        good_frame(&mut rig);
        settle(&mut rig);
        let periods: Vec<Time> = rig.frames(0).iter().map(|f| f.period).collect();
        assert_eq!(periods, [5 * US, 320 * NS, 320 * NS], "bit {bit}");
        assert!(rig.frames(0).iter().all(FrameLog::is_whole), "bit {bit}");
    }
}

/// A request during a frame remains pending when that frame ends normally.
#[test]
fn calibrate_in_the_middle_of_a_frame_measures_with_the_next_one() {
    for after in [US, 5 * US, 10 * US, 15 * US] {
        let mut rig = Setup::card().ready();
        rig.run_for(US);
        rig.trigger();
        rig.run_for(after);
        rig.set("calibrate", 1);
        rig.tick();
        rig.set("calibrate", 0);
        assert!(rig.run_until_done(MS, |b| b.get("busy") == 0));
        good_frame(&mut rig);
        settle(&mut rig);
        let periods: Vec<Time> = rig.frames(0).iter().map(|f| f.period).collect();
        assert_eq!(periods[1], 5 * US, "{after} ps after the trigger");
    }
}
