//! The reported recovery time, with few cycles and places in a bit.

use super::Kind;
use endat_sim::campaign::{self, Case, RunOptions, Traces};
use endat_sim::{NS, US};

/// Tolerance: two cycles, as with more cycles in a bit; the place of the last edge; and a CLOCK held for less than a bit.
const CYCLES_OFF: u64 = 4;

/// Also if all pulses are sent before the start bit returns, so that CLOCK waits LOW for the answer, and if cells are shorter than the
/// latency of a sample in the receiver.
fn is_measured(kinds: &[Kind], widths: &[u32]) {
    let tm = 15 * US;
    let mut cases = vec![];
    for &kind in kinds {
        for &bits in widths {
            for delay in 0..24 {
                let mut case = kind.case(0.0, f64::from(delay) * 0.9, 3, cases.len() as u64);
                case.settings.position_bits = bits;
                case.encoder.position_bits = bits;
                case.encoder.tm = tm..=tm;
                cases.push(case);
            }
        }
    }
    let judge = |case: &Case, traces: &Traces<'_>| {
        // DATA rises slightly after the last clock edge, and falls at the end of tm.
        let want = (tm - case.encoder.clock_to_data) * case.system_hz / 1_000_000_000_000;
        // The last result has the recovery time of the previous frame.
        let got = traces.results.last().map_or(0, |r| r.recovery_cycles);
        (got.abs_diff(want) > CYCLES_OFF).then(|| {
            format!(
                "{got} cycles, not {want}: {} Hz, {} bits, {} ns",
                case.system_hz,
                case.settings.position_bits,
                case.line.data_in.transceivers / NS
            )
        })
    };
    let options = RunOptions {
        threads: 2,
        samples: false,
        ..RunOptions::default()
    };
    let outcomes = campaign::run(&cases, options, judge, |_| {}).expect("a design");
    let wrong: Vec<_> = outcomes.into_iter().filter_map(|o| o.verdict).collect();
    assert!(
        wrong.is_empty(),
        "{} of {}: {wrong:#?}",
        wrong.len(),
        cases.len()
    );
}

#[test]
fn the_recovery_time_is_that_of_the_encoder() {
    is_measured(&[Kind::single(4), Kind::double(3)], &[1, 25]);
}

#[test]
#[ignore = "slow: five oversamplings"]
fn the_recovery_time_is_that_of_the_encoder_at_every_oversampling() {
    let kinds = [
        Kind::single(4),
        Kind::single(8),
        Kind::double(2),
        Kind::double(3),
        Kind::double(4),
    ];
    is_measured(&kinds, &[1, 13, 25]);
}
