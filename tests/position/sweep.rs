//! Every width, command, rate and cable.

use super::rig::*;
use endat_hdl::protocol::POSITION_BITS;
use std::{
    sync::atomic::{AtomicUsize, Ordering},
    thread,
};

/// Runs the jobs on all processors. A panic in one of them is the panic of the test.
fn in_parallel<T: Sync>(jobs: &[T], run: impl Fn(&T) + Sync) {
    let next = AtomicUsize::new(0);
    let count = thread::available_parallelism().map_or(2, usize::from);
    thread::scope(|scope| {
        for _ in 0..count.min(jobs.len()) {
            scope.spawn(|| {
                while let Some(job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
                    run(job);
                }
            });
        }
    });
}

/// 10 rates, 4 cables, 2 commands, 48 widths: the delay is measured once for each rate and cable.
#[test]
fn every_width_rate_cable() {
    let jobs: Vec<(Rates, f64)> = RATES
        .iter()
        .flat_map(|rates| CABLES_M.map(|cable_m| (*rates, cable_m)))
        .collect();
    in_parallel(&jobs, |&(rates, cable_m)| {
        let measured = Setup::new(rates, COMMANDS[1], 29, cable_m).measured();
        for command in COMMANDS {
            for position_bits in POSITION_BITS {
                let setup = Setup::new(rates, command, position_bits, cable_m);
                let mut rig = setup.on(measured.clone());
                good_frame(&mut rig);
                settle(&mut rig);
                assert_sound(&setup, &rig);
            }
        }
    });
}

/// The frame that measures the delay runs at its own clock, whatever the rate: every width of it, then one at the full clock.
#[test]
fn every_width_measures_the_delay() {
    let jobs: Vec<u32> = POSITION_BITS.collect();
    in_parallel(&jobs, |&position_bits| {
        for (command, cable_m) in COMMANDS.into_iter().zip([20.0, 100.0]) {
            let setup = Setup::new((100_000_000, 12_500_000), command, position_bits, cable_m);
            let mut rig = setup.fresh();
            good_frame(&mut rig);
            good_frame(&mut rig);
            settle(&mut rig);
            assert_sound(&setup, &rig);
        }
    });
}
