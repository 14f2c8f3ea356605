//! Both edges of the clock on rust-hdl's kernels, on every engine, and in the emitted Verilog.

use super::Kind;
use crate::three_way::{three_way, Stimulus};
use crate::tools::third;
use endat_hdl::endat::channel::{Channel, FixedTimes};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::Compiled;
use rtl_design::kernel_engine;
use rust_hdl::prelude::Block;

#[test]
fn double_edge_agrees_on_a_line_with_jitter() {
    let all = [
        ("double_edge_2", Kind::double(2), false),
        ("double_edge_5", Kind::double(5), true),
    ];
    let receiver = include_str!("../../../hdl/endat/receiver.rs");
    for &(name, kind, majority) in third(&all, receiver.len()) {
        let mut case = kind.case(0.1, 2.2, 1, 5);
        case.settings.majority = majority;
        case.settings.filter_cycles = u64::from(majority);
        let times = FixedTimes {
            abort_us: case.settings.abort_us,
            ready_low_cycles: case.settings.ready_low_cycles,
            calibration_period_cycles: 40 * kind.cycles,
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
        // The two looks differ: without the falling edge the rest would be another run.
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
