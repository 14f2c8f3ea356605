//! A port for SSI at work with its encoder: kernels, engines and emitted Verilog agree in every cycle.

use super::{bench, block, design, link};
use crate::three_way::{three_way, Stimulus};
use endat_hdl::protocols::ssi::cause;
use endat_hdl::protocols::ssi::port::frame;
use endat_sim::rng::Rng;
use endat_sim::ssi::{Defect, EncoderConfig};
use endat_sim::{NS, US};
use rtl_design::kernel_engine;

/// Triggers at any time, defects, other settings.
fn recorded() -> Stimulus {
    let mut rng = Rng::new(3);
    let encoder = EncoderConfig {
        position_bits: 14,
        tm: 12 * US,
        ..EncoderConfig::default()
    };
    let mut bench = bench(&design(), 20_000_000, encoder, 60 * NS);
    bench.record_cycles();
    for (name, value) in [
        ("period_cycles", 21),
        ("position_bits", 14),
        ("filter_cycles", 1),
        ("recovery_limit_cycles", 400),
        ("command", 6),
    ] {
        bench.set(name, value);
    }
    bench.power_up();
    bench.run_for(5 * US);
    for round in 0..60 {
        if bench.get("busy") == 0 {
            let command = [6, 7, 4, 12, 14, 5, 30, 7, 0][round % 9];
            bench.set("command", command);
            bench.set(
                "first_low_extra_cycles",
                u128::from(rng.in_range(0, 1)) * 13,
            );
            let odd = command >> frame::ODD & 1 == 1;
            let config = &mut link(&mut bench).encoder_mut().config;
            config.parity = (command >> frame::PARITY & 1 == 1).then_some(odd);
        }
        let copy = rng.in_range(0, 1) as usize;
        link(&mut bench).encoder_mut().config.defect = match rng.in_range(0, 7) {
            0 => Defect::Silent,
            1 => Defect::StuckLow,
            2 => Defect::Longer(2),
            3 => Defect::Flip { copy, bit: 3 },
            _ => Defect::None,
        };
        bench.run_for(rng.in_range(0, 3) * US);
        bench.trigger();
        bench.run_for(rng.in_range(4, 70) * US);
    }
    let cycles = bench.cycles().unwrap();
    let inputs: Vec<usize> = (0..cycles.ports.len())
        .filter(|i| cycles.ports[*i].is_input)
        .collect();
    Stimulus {
        middle: vec![],
        inputs: (inputs.iter())
            .map(|i| cycles.ports[*i].name.clone())
            .collect(),
        cycles: (cycles.rows.iter())
            .map(|row| inputs.iter().map(|i| row[*i]).collect())
            .collect(),
    }
}

#[test]
fn kernels_engines_and_verilog_agree_on_an_ssi_port() {
    let mut kernel = kernel_engine!(block(); clock;
        in reset, tick_us, timestamp, trigger, calibrate, request_id, field_gap_us;
        out recovery_cycles, delay_cycles, busy, sample_strobe, request_runs, line_high, displaced, reply, calibrated, alarm;
        bundles line, settings, window, result, end, record);
    let seen = three_way("ssi_port", &mut kernel, &design(), &recorded()).unwrap();
    assert!(*seen.output("sequence").last().unwrap() > 10);
    let causes = seen.output("cause");
    for cause in 0..cause::COUNT {
        let is_upset = cause == cause::UPSET;
        assert_eq!(causes.contains(&cause.into()), !is_upset, "{cause}");
    }
    assert!(seen.output("fresh").contains(&1));
    assert!(
        seen.output("data_oe").iter().all(|oe| *oe == 0),
        "nobody drives DATA"
    );
    assert!(seen.output("endat_clk").contains(&0));
}
