//! The record of additional data resynchronises after any frame, for any recovery time, calculation time and clock.

use super::lanes::*;
use endat_hdl::endat::transaction::cause;
use endat_hdl::protocol::ModeCommand::{PositionSelectMemory, SendPositionAddInfo};
use endat_sim::{
    bench::ChannelSettings,
    encoder::{Defect, EncoderConfig},
    Time, NS, US,
};

/// A frame that measures the delay, two good ones, two selections: the next one has the fault.
const MISHAP_FRAME: u64 = 5;
/// Triggers after the fault that may be bad.
const TRIGGERS: usize = 2;
/// Long and short recovery times, around half a period of the calibration clock.
const RECOVERIES: [Time; 11] = [
    1_250 * NS,
    1_300 * NS,
    2_000 * NS,
    2_300 * NS,
    2_500 * NS,
    2_600 * NS,
    3_750 * NS,
    5 * US,
    10 * US,
    20 * US,
    30 * US,
];
/// Combined recovery times, calculation times and EnDat clocks.
struct Times {
    recovery: &'static [Time],
    calculation: &'static [Time],
    endat_hz: &'static [u64],
}

/// All recovery times, with three calculation times at five rates.
const ALL: Times = Times {
    recovery: &RECOVERIES,
    calculation: &[US, 5 * US, 12 * US],
    endat_hz: &[200_000, 500_000, 1_000_000, 2_000_000, 4_000_000],
};
/// The shortest, the longest, and those around half a period of the calibration clock.
const SOME: Times = Times {
    recovery: &[1_250 * NS, 2_300 * NS, 2_600 * NS, 30 * US],
    calculation: &[5 * US],
    endat_hz: &[200_000, 1_000_000, 4_000_000],
};

/// Recovery times below 10 us exist only with a clock of at least 1 MHz.
const LONG_RECOVERY: Time = 10 * US;

struct Story {
    encoder: EncoderConfig,
    endat_hz: u64,
    what: String,
}

/// Every recovery time with every calculation time and rate, and these defects.
fn stories(times: &Times, defects: &[Defect]) -> Vec<Story> {
    let mut stories = vec![];
    for &tm in times.recovery {
        for &tcal in times.calculation {
            for &endat_hz in times.endat_hz {
                if tm < LONG_RECOVERY && endat_hz < 1_000_000 {
                    continue;
                }
                for defect in defects {
                    let mut encoder = encoder().defect(MISHAP_FRAME, defect.clone());
                    encoder.tm = tm..=tm;
                    encoder.tcal = tcal;
                    let what = format!("tm {tm} tcal {tcal} at {endat_hz} Hz: {defect:?}");
                    stories.push(Story {
                        encoder,
                        endat_hz,
                        what,
                    });
                }
            }
        }
    }
    stories
}

/// Runs them with these additional data selected; all are good again after at most two triggers.
fn run(times: &Times, codes: [u8; 2], defects: &[Defect]) {
    let stories = stories(times, defects);
    for stories in stories.chunks(LANES) {
        let cases: Vec<_> = stories
            .iter()
            .map(|s| (s.encoder.clone(), line()))
            .collect();
        let mut rig = Rig::on(engine(), &cases);
        for (lane, story) in stories.iter().enumerate() {
            let bits = POSITION_BITS;
            let settings =
                ChannelSettings::new(SYSTEM_HZ, story.endat_hz, SendPositionAddInfo, bits);
            rig.bench.configure(lane, &settings);
        }
        rig.reset();
        rig.settle(100);
        (0..2).for_each(|_| rig.position(1_000));
        for code in codes {
            rig.put(PositionSelectMemory, code, 0);
            rig.position(1_000);
        }
        for (lane, story) in stories.iter().enumerate() {
            let result = rig.bench.results(lane).last().expect("a result");
            let good = (result.cause, result.fresh) == (cause::NONE, true);
            assert!(good, "{} {result:?}", story.what);
        }
        rig.position(1_000);
        rig.run_for(40 * US);
        rig.settle(1_000);
        let (lost, _) = rig.recovered(TRIGGERS, &|lane| stories[lane].what.clone());
        let (count, of) = (lost.len(), stories.len());
        assert!(lost.is_empty(), "{count} of {of}, the first: {}", lost[0]);
    }
}

fn stuck_low(bits: &[u32]) -> Vec<Defect> {
    let stuck = |bit: &u32| Defect::StuckFrom {
        bit: *bit,
        level: false,
    };
    bits.iter().map(stuck).collect()
}

/// DATA LOW in an answer looks like additional data after it.
fn zeros(times: &Times) {
    // 0x4F and 0x5F deselect.
    run(times, [0x4F, 0x5F], &stuck_low(&[1, 3, 10, 17, 20, 21]));
}

#[test]
fn a_frame_of_zeros_teaches_no_additional_data() {
    zeros(&SOME);
}

#[test]
#[ignore = "slow: every recovery time, calculation time and rate"]
fn a_frame_of_zeros_teaches_no_additional_data_at_any_recovery_time() {
    zeros(&ALL);
}

/// The encoder has lost its selection, and a short recovery time ends before half a period of the calibration clock.
fn gone(times: &Times, selections: &[[u8; 2]]) {
    let lost = Defect::BrownOut {
        after: 9 * US,
        length: 3 * US,
    };
    let defects = [
        lost,
        Defect::StuckFrom {
            bit: 4,
            level: true,
        },
    ];
    for codes in selections {
        run(times, *codes, &defects);
    }
}

/// Additional data 1, 2, and both.
const SELECTIONS: [[u8; 2]; 3] = [[0x4C, 0x5F], [0x5B, 0x4F], [0x4C, 0x5B]];

#[test]
fn additional_data_that_are_gone_are_forgotten() {
    gone(&SOME, &SELECTIONS);
}

#[test]
#[ignore = "slow: every recovery time, calculation time and rate"]
fn additional_data_that_are_gone_are_forgotten_at_any_recovery_time() {
    gone(&ALL, &SELECTIONS);
}

/// The additional data are always sent; wrong conclusions from a disturbed frame do not last.
fn present(times: &Times, selections: &[[u8; 2]]) {
    for codes in selections {
        run(times, *codes, &stuck_low(&[2, 18, 21, 22, 40, 51]));
    }
}

#[test]
fn additional_data_that_are_there_are_found() {
    present(&SOME, &SELECTIONS[2..]);
}

#[test]
#[ignore = "slow: every recovery time, calculation time and rate"]
fn additional_data_that_are_there_are_found_at_any_recovery_time() {
    present(&ALL, &SELECTIONS);
}
