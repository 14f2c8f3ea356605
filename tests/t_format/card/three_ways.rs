//! A port for T-format at work with its encoder: kernels, engines and emitted Verilog agree in every cycle.

use super::shaft;
use crate::three_way::{agree, record, three_way, Stimulus};
use endat_hdl::encoder_port::EncoderPort;
use endat_hdl::protocols::t_format::cause;
use endat_hdl::protocols::t_format::port::word;
use endat_hdl::regs::Protocol;
use endat_sim::bench::{Bench, PinNames, TFormatLink};
use endat_sim::rng::Rng;
use endat_sim::t_format::{Defect, EncoderConfig};
use endat_sim::US;
use rtl_design::elaborate::elaborate;
use rtl_design::engine::{Compiled, KernelEngine};
use rtl_design::kernel_engine;
use rust_hdl::prelude::Block;

fn block() -> EncoderPort {
    let mut block = EncoderPort::speaking(Protocol::TFormat, true, false);
    block.connect_all();
    block
}

/// Triggers and requests of the host in any order, defects, other settings, words that are read; in so many rounds.
fn recorded(system_mhz: u64, rounds: usize) -> Stimulus {
    let design = elaborate(&block(), "encoder_port").unwrap();
    let mut rng = Rng::new(11);
    let mut bench = Bench::new(
        Compiled::new(&design).unwrap(),
        system_mhz * 1_000_000,
        vec![],
    );
    let mut link = TFormatLink::new(EncoderConfig::default(), US / 20);
    link.set_motion(std::sync::Arc::new(shaft));
    bench.add_t_format(&PinNames::channel(), link);
    bench.record_cycles();
    for (name, value) in [
        ("period_cycles", u128::from(system_mhz) * 2 / 5),
        ("start_timeout_us", 6),
        ("field_gap_us", 1),
        ("filter_cycles", 1),
    ] {
        bench.set(name, value);
    }
    bench.power_up();
    bench.run_for(75 * US);
    for round in 0..rounds {
        if bench.get("busy") == 0 {
            bench.set("request_id", [3, 0, 1, 2, 4, 3, 13][round % 7]);
        }
        let encoder = bench.t_format_mut(0).encoder_mut();
        encoder.config.defect = match rng.in_range(0, 6) {
            // The first reply is good in any number of rounds.
            _ if round == 0 => Defect::None,
            0 => Defect::Flip {
                field: rng.in_range(0, 3) as usize,
                bit: rng.in_range(0, 7) as usize,
            },
            1 => Defect::Delimiter { field: 1 },
            2 => Defect::Short { fields: 2 },
            _ => Defect::None,
        };
        if round % 3 != 1 {
            bench.trigger();
        }
        bench.run_for(rng.in_range(1, 20) * US);
        if round % 4 != 3 {
            bench.set("host_address", word::SEND.into());
            for half in [1, 0] {
                bench.set("host_half", half);
                let id = [6, 2, 13, 3][round % 4];
                let low = rng.next_u64() as u16;
                bench.set("host_data", if half == 1 { id } else { low.into() });
                bench.set("host_write", 1);
                bench.run_cycles(1);
                bench.set("host_write", 0);
                bench.run_cycles(5);
            }
        }
        bench.run_for(rng.in_range(20, 110) * US);
        for at in [word::ANSWER, word::FIELDS, word::PARTS] {
            bench.set("host_address", at.into());
            bench.set("host_read", 1);
            bench.run_cycles(1);
            bench.set("host_read", 0);
            bench.run_cycles(3);
        }
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

fn kernels() -> KernelEngine<EncoderPort> {
    kernel_engine!(block(); clock;
        in reset, tick_us, timestamp, trigger, calibrate, request_id, field_gap_us;
        out recovery_cycles, delay_cycles, busy, sample_strobe, request_runs, line_high, trigger_lost, reply, calibrated, alarm;
        bundles line, settings, window, result, end, record)
}

#[test]
fn kernels_and_native_code_agree_on_exchanges_of_a_t_format_port() {
    let stimulus = recorded(20, 3);
    let expected = record(&mut kernels(), &stimulus);
    let design = elaborate(&block(), "encoder_port").unwrap();
    let mut compiled = Compiled::new(&design).unwrap();
    agree("compiled", &expected, &record(&mut compiled, &stimulus)).unwrap();
    assert!(*expected.output("sequence").last().unwrap() > 1);
    assert!(expected.output("fresh").contains(&1));
}

#[test]
#[ignore = "slow: kernels, engines and simulators on 24 rounds of a T-format port"]
fn kernels_engines_and_verilog_agree_on_a_t_format_port() {
    let design = elaborate(&block(), "encoder_port").unwrap();
    let seen = three_way("t_format_port", &mut kernels(), &design, &recorded(40, 24)).unwrap();
    assert!(*seen.output("sequence").last().unwrap() > 10);
    // Good and bad, by triggers and by the host.
    let causes = seen.output("cause");
    for cause in [cause::NONE, cause::UNKNOWN_REQUEST].map(u128::from) {
        assert!(causes.contains(&cause), "{cause}");
    }
    assert!(causes.iter().any(|c| *c > cause::UNKNOWN_REQUEST.into()));
    assert!(seen.output("fresh").contains(&1));
    assert!(seen.output("over_request").contains(&1));
    assert!(seen.output("endat_clk").iter().all(|c| *c == 1));
}
