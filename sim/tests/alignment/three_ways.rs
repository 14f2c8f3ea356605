//! Both edges of the clock on rust-hdl's kernels, on every engine, and in the emitted Verilog.

use super::Kind;
use crate::three_way::{three_way, Stimulus};
use endat_hdl::endat::channel::{Channel, FixedTimes};
use endat_sim::{Time, US};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::Compiled;
use rtl_design::kernel_engine;
use rust_hdl::prelude::Block;

/// A line with jitter, and a channel on it.
struct Play {
    name: &'static str,
    kind: Kind,
    majority: bool,
    position_bits: u32,
    /// Bits of the frame in one bit of a frame that measures the delay.
    calibration_bits: u64,
    /// Calculation time of the encoder.
    tcal: Time,
}

impl Play {
    /// Records the pins of a run and plays them to every execution.
    fn agrees(&self) {
        let &Self {
            name,
            kind,
            majority,
            ..
        } = self;
        let mut case = kind.case(0.1, 2.2, 1, 5);
        case.settings.position_bits = self.position_bits;
        case.encoder.position_bits = self.position_bits;
        case.encoder.tcal = self.tcal;
        case.settings.majority = majority;
        case.settings.filter_cycles = u64::from(majority);
        let times = FixedTimes {
            abort_us: case.settings.abort_us,
            ready_low_cycles: case.settings.ready_low_cycles,
            calibration_period_cycles: self.calibration_bits * kind.cycles,
            ..FixedTimes::at(case.system_hz)
        };
        let mut block = Channel::with(times, case.features);
        block.connect_all();
        let design = elaborate(&block, "channel").unwrap();
        let mut bench = case.bench(Compiled::new(&design).unwrap());
        bench.record_cycles();
        case.drive(&mut bench);
        let recorded = bench.cycles().unwrap();
        let is_input = |i: &usize| recorded.ports[*i].is_input;
        let inputs: Vec<usize> = (0..recorded.ports.len()).filter(is_input).collect();
        let columns = |rows: &[Vec<u128>]| -> Vec<Vec<u128>> {
            let row = |row: &Vec<u128>| inputs.iter().map(|i| row[*i]).collect();
            rows.iter().map(row).collect()
        };
        let stimulus = Stimulus {
            inputs: inputs
                .iter()
                .map(|i| recorded.ports[*i].name.clone())
                .collect(),
            cycles: columns(&recorded.rows),
            middle: columns(&recorded.middle),
        };
        assert_eq!(stimulus.middle.len(), stimulus.cycles.len());
        // The two samples of a cycle differ: without the falling edge the run would be another one.
        assert!(stimulus
            .middle
            .iter()
            .zip(&stimulus.cycles)
            .any(|(a, b)| a != b));
        let mut kernel = kernel_engine!(block; clock;
        in reset, tick_us, timestamp, trigger, calibrate, phase_mode, fixed_delay, majority;
        out recovery_cycles, delay_cycles, phase, edge_measured, edge_offset, glitch, busy, sample_strobe, sample_second, request_runs, line_high, displaced, reply, calibrated;
        bundles line, settings_in, orders, result, end, record);
        let recording = three_way(name, &mut kernel, &design, &stimulus).unwrap();
        let fresh: u128 = recording.output("result_strobe").iter().sum();
        assert_eq!(fresh, case.frames as u128, "{name}");
        assert!(recording.output("cause").iter().all(|cause| *cause == 0));
    }
}

#[test]
fn double_edge_agrees_on_a_line_with_jitter() {
    let short = Play {
        name: "double_edge_2_short",
        kind: Kind::double(2),
        majority: false,
        position_bits: 3,
        calibration_bits: 10,
        tcal: US / 2,
    };
    short.agrees();
}

#[test]
#[ignore = "slow: 25 position bits and slow frames that measure the delay"]
fn double_edge_agrees_in_long_frames() {
    let long = Play {
        name: "double_edge_2",
        kind: Kind::double(2),
        majority: false,
        position_bits: 25,
        calibration_bits: 40,
        tcal: 5 * US,
    };
    long.agrees();
}

#[test]
#[ignore = "slow: a majority of samples, five cycles in a bit"]
fn double_edge_agrees_with_a_majority_of_samples() {
    let long = Play {
        name: "double_edge_5",
        kind: Kind::double(5),
        majority: true,
        position_bits: 25,
        calibration_bits: 40,
        tcal: 5 * US,
    };
    long.agrees();
}
