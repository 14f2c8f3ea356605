//! A port for SSI at work with its encoder: kernels, engines and emitted Verilog agree in every cycle.

use super::{bench, block, link, power_up};
use crate::three_way::{three_way, Stimulus};
use endat_hdl::protocols::ssi::cause;
use endat_hdl::protocols::ssi::port::frame;
use endat_hdl::protocols::ssi::specials::{Special, Specials};
use endat_hdl::protocols::SsiSpec;
use endat_sim::rng::Rng;
use endat_sim::ssi::{Defect, EncoderConfig, Extra};
use endat_sim::{Time, NS, US};
use rtl_design::elaborate::elaborate;
use rtl_design::kernel_engine;

/// Frames of a recorded run.
struct Frames {
    position_bits: u32,
    period_cycles: u128,
    /// Recovery time of the encoder, and its limit in cycles.
    tm: Time,
    recovery_limit_cycles: u128,
    /// Waiting times from a trigger to the next round.
    waits_us: [u64; 2],
    rounds: usize,
    seed: u64,
    /// The channel of the port.
    asked: SsiSpec,
}

/// Special bits of an encoder, each sometimes at the level of its cause.
fn extras(specials: &Specials, rng: &mut Rng) -> Vec<Extra> {
    let mut extra = |special: Special| match special {
        Special::ParityEven => Extra::Parity(false),
        Special::ParityOdd => Extra::Parity(true),
        Special::Crc6 => Extra::Crc6,
        special => {
            let is_bad = rng.in_range(0, 7) == 0;
            let level = special.cause().is_some_and(|(_, level)| level);
            Extra::Level(level == is_bad)
        }
    };
    specials.iter().map(&mut extra).collect()
}

/// Triggers at any time, defects, other settings.
fn recorded(frames: &Frames) -> Stimulus {
    let mut rng = Rng::new(frames.seed);
    let encoder = EncoderConfig {
        position_bits: frames.position_bits,
        tm: frames.tm,
        ..EncoderConfig::default()
    };
    let design = elaborate(&block(&frames.asked), "encoder_port").unwrap();
    let mut bench = bench(&design, 20_000_000, encoder, 60 * NS);
    bench.record_cycles();
    for (name, value) in [
        ("period_cycles", frames.period_cycles),
        ("position_bits", frames.position_bits.into()),
        ("filter_cycles", 1),
        ("recovery_limit_cycles", frames.recovery_limit_cycles),
        ("command", 6),
    ] {
        bench.set(name, value);
    }
    power_up(&mut bench);
    bench.run_for(5 * US);
    for round in 0..frames.rounds {
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
            config.before = extras(&frames.asked.before, &mut rng);
            config.after = extras(&frames.asked.after, &mut rng);
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
        bench.run_for(rng.in_range(frames.waits_us[0], frames.waits_us[1]) * US);
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

fn agree(name: &str, frames: &Frames, sequence_min: u128) {
    let design = elaborate(&block(&frames.asked), "encoder_port").unwrap();
    let mut kernel = kernel_engine!(block(&frames.asked); clock;
        in reset, tick_us, timestamp, trigger, calibrate, request_id, field_gap_us;
        out recovery_cycles, delay_cycles, busy, sample_strobe, request_runs, line_high, trigger_lost, reply, calibrated, alarm;
        bundles line, settings, window, result, end, record);
    let seen = three_way(name, &mut kernel, &design, &recorded(frames)).unwrap();
    assert!(*seen.output("sequence").last().unwrap() > sequence_min);
    let causes = seen.output("cause");
    let flags = seen.output("flags");
    for cause in cause::ALARM..cause::COUNT {
        let comes = flags
            .iter()
            .any(|f| f & u128::from(cause::flag(cause)) != 0);
        assert_eq!(comes, frames.asked.has_specials(), "{cause}");
    }
    for cause in 0..cause::ALARM {
        let comes = match cause {
            cause::UPSET => false,
            // Settings of the port alone belong to the other run.
            1.. if frames.asked.has_specials() => continue,
            _ => true,
        };
        assert_eq!(causes.contains(&cause.into()), comes, "{cause}");
    }
    assert!(seen.output("fresh").contains(&1));
    assert!(
        seen.output("data_oe").iter().all(|oe| *oe == 0),
        "DATA is never driven"
    );
    assert!(seen.output("endat_clk").contains(&0));
}

#[test]
fn kernels_engines_and_verilog_agree_on_an_ssi_port() {
    let short = Frames {
        position_bits: 5,
        period_cycles: 13,
        tm: 4 * US,
        recovery_limit_cycles: 120,
        waits_us: [2, 24],
        rounds: 24,
        // Each cause occurs.
        seed: 21,
        asked: SsiSpec::default(),
    };
    agree("ssi_port", &short, 5);
}

/// Special bits of every kind, on both sides of the position.
#[test]
fn kernels_engines_and_verilog_agree_on_special_bits() {
    let list = |specials: &[Special]| Specials::new(specials).unwrap();
    let special = Frames {
        position_bits: 4,
        period_cycles: 13,
        tm: 4 * US,
        recovery_limit_cycles: 120,
        waits_us: [14, 36],
        rounds: 40,
        seed: 4,
        asked: SsiSpec {
            before: list(&[Special::NotAlarm, Special::Ignored]),
            after: list(&[
                Special::PowerFail,
                Special::Valid,
                Special::Shown,
                Special::ParityOdd,
                Special::Crc6,
            ]),
            ..SsiSpec::default()
        },
    };
    agree("ssi_special", &special, 5);
}

#[test]
#[ignore = "slow: sixty triggers, 14 bits"]
fn kernels_engines_and_verilog_agree_on_longer_frames() {
    let long = Frames {
        position_bits: 14,
        period_cycles: 21,
        tm: 12 * US,
        recovery_limit_cycles: 400,
        waits_us: [4, 70],
        rounds: 60,
        seed: 0,
        asked: SsiSpec::default(),
    };
    agree("ssi_port_long", &long, 10);
}
