//! Both edges of the clock on rust-hdl's kernels, on every engine, and in the emitted Verilog.

use super::Kind;
use crate::three_way::{three_way, Stimulus};
use endat_hdl::channel::{Channel, FixedTimes};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::Compiled;
use rtl_design::kernel_engine;
use rust_hdl::prelude::Block;

#[test]
fn double_edge_agrees_on_a_line_with_jitter() {
    for (name, kind, majority) in [
        ("double_edge_2", Kind::double(2), false),
        ("double_edge_5", Kind::double(5), true),
    ] {
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
            in reset, tick_us, timestamp, trigger, calibrate, data_i, period_cycles, first_low_extra_cycles, command,
            position_bits, filter_cycles, filter_half, phase_mode, fixed_delay, majority, start_window_cycles, start_timeout_us, recovery_limit_cycles,
            recovery_min_cycles, watchdog_us, continuous, stop_at_error, request_command, request_parameter, request_ride, request_own, request_cancel, hold_off, clock_low, forced;
            out endat_clk, data_o, data_oe, result_strobe, position, position_valid, fresh, sequence,
            first_fall_timestamp, age_us, cause, flags, crc_received, crc_computed, position_crc, position_width, position_has_f2, recovery_cycles, delay_cycles, phase, edge_measured, edge_offset, glitch, busy,
            sample_strobe, sample_second, request_runs, line_high, displaced, over, over_request, over_cause, over_flags, reply, answer, reply_good, info_active, info_1, info_2,
            info_came, info_good, info_crcs, calibrated);
        let recording = three_way(name, &mut kernel, &design, &stimulus).unwrap();
        let fresh: u128 = recording.output("result_strobe").iter().sum();
        assert_eq!(fresh, case.frames as u128, "{name}");
        assert!(recording.output("cause").iter().all(|cause| *cause == 0));
    }
}
